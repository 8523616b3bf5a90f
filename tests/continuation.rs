//! Branches and their special points against what is known in closed form.

use std::sync::Arc;

use nalgebra::Vector3;
use ribbonrs::boundary::{End, Family, Hold, Law, LineLoad, Problem, Rod, Settings, Solution};
use ribbonrs::continuation::{
    Diagram, Ended, Held, HeldState, Limits, Natural, NaturalFamily, SpecialKind, begin, diagram, locus,
};
use ribbonrs::equilibrium::natural_shapes;
use ribbonrs::growth::Growth;
use ribbonrs::section::{Amplitude, RibbonSpec, Strain};

const ETA: f64 = 0.1;

/// A leaf whose edges grow by `xi`, with oblique fibres.
fn leaf(xi: f64, chirality: f64) -> RibbonSpec {
    RibbonSpec {
        growth: vec![
            (Amplitude::Constant(xi), Growth::edge(1.0)),
            (Amplitude::Constant(chirality), Growth::chiral(1.0)),
        ],
        ..RibbonSpec::uniform(ETA, Growth::default())
    }
}

/// All branches of natural shapes as the edges grow from nothing to `8 eta^2`.
fn natural(chirality: f64) -> Diagram<Natural> {
    let family = NaturalFamily::new(vec![leaf(0.0, chirality), leaf(8.0 * ETA * ETA, chirality)]).unwrap();
    let mut equations = Natural::new(family);
    let limits = Limits { longest: 10.0, ..Limits::default() };
    let shapes = natural_shapes(equations.station(0.0).unwrap().section());
    let starts = shapes.iter().map(|shape| {
        let x = [shape.strain[2] / ETA, shape.strain[3] / ETA];
        begin(&mut equations, x, 0.0, &limits).unwrap()
    });
    let starts = starts.collect();
    diagram(&mut equations, starts, 3, &limits)
}

fn special(branch: usize, kind: SpecialKind, diagram: &Diagram<Natural>) -> Vec<f64> {
    let branch = &diagram.branches[branch];
    let of_kind = branch.special.iter().filter(|special| special.kind == kind);
    of_kind.map(|special| 8.0 * branch.points[special.place].t).collect()
}

#[test]
fn edges_bend_then_twist_a_leaf() {
    let diagram = natural(0.0);
    let found = special(0, SpecialKind::BranchPoint, &diagram);
    let exact = [0.5 * (259f64.sqrt() - 7.0), 5.0];
    for (found, exact) in found.iter().zip(exact) {
        assert!((found - exact).abs() < 1e-10, "{found} {exact}");
    }
    assert_eq!((found.len(), diagram.branches.len()), (2, 3));
    for (branch, index) in diagram.branches[1..].iter().zip([0, 1]) {
        // Bent ones are stable, twisted ones not; nothing more happens on either.
        assert!(branch.points[1..].iter().all(|point| point.stability.index == Some(index)));
        assert!(branch.special.is_empty() && branch.mirrored);
        assert_eq!(branch.ended, [Ended::Switched, Ended::Span]);
    }
}

#[test]
fn oblique_fibres_twist_a_leaf_into_a_helix() {
    // C/eta^2 = 14 - sqrt(1036) = -20 (1 - omega/k3) where the twisted leaf bends.
    let omega = 0.2;
    let k3 = omega / (1.0 + (14.0 - 1036f64.sqrt()) / 20.0);
    let exact = 0.5 * (259f64.sqrt() - 7.0) + k3 * k3 / 8.0;
    let diagram = natural(2.0 * ETA * omega);
    let found = special(0, SpecialKind::BranchPoint, &diagram);
    assert!(found.len() == 1 && (found[0] - exact).abs() < 1e-10, "{found:?} {exact}");
    assert!(diagram.branches[1].points[1..].iter().all(|point| point.stability.index == Some(0)));
}

#[test]
fn where_a_leaf_becomes_a_helix_for_all_fibres() {
    let corner = |xi: f64, omega: f64| leaf(xi * ETA * ETA, 2.0 * ETA * omega);
    let corners = vec![corner(0.0, 0.1), corner(8.0, 0.1), corner(0.0, 0.4), corner(8.0, 0.4)];
    let diagram = natural(2.0 * ETA * 0.2);
    let branch = &diagram.branches[0];
    let start = &branch.points[branch.special[0].place];
    let mut equations = Natural::new(NaturalFamily::new(corners).unwrap());
    let limits = Limits { longest: 10.0, ..Limits::default() };
    let curve = locus(&mut equations, start, 1.0 / 3.0, SpecialKind::BranchPoint, &limits);
    assert_eq!(curve.ended, [Ended::Span, Ended::Span]);
    for [t, u] in curve.places {
        let k3 = (0.1 + 0.3 * u) / (1.0 + (14.0 - 1036f64.sqrt()) / 20.0);
        let exact = 0.5 * (259f64.sqrt() - 7.0) + k3 * k3 / 8.0;
        assert!((8.0 * t - exact).abs() < 1e-8, "{} {exact}", 8.0 * t);
    }
}

/// A cantilever strip under a force across its tip, in the plane in which it is stiff.
fn cantilever(load: f64) -> Arc<Problem> {
    let rod = Rod { compliance: Strain::new(0.0, 0.0, 1.0, 1.0), intrinsic: Strain::zeros() };
    let tip = End { force: Vector3::new(0.0, load, 0.0), ..End::new(Hold::Free) };
    let ends = [End::new(Hold::Clamped), tip];
    Arc::new(Problem::new(Law::Rod(rod), 1.0, ends, vec![], LineLoad::uniform([0.0; 3])).unwrap())
}

#[test]
fn a_cantilever_buckles_laterally() {
    let most = 8.0;
    let start = Solution::of(cantilever(0.0), &Settings::default(), None).unwrap();
    let state = HeldState { nodes: Arc::new(start.nodes().to_vec()), x: start.iterate().clone() };
    let family = Family::new(vec![cantilever(0.0), cantilever(most)]).unwrap();
    let mut equations = Held::new(family, 0.0, 5, 1e-10);
    let limits = Limits::default();
    let first = begin(&mut equations, state, 0.0, &limits).unwrap();
    let diagram = diagram(&mut equations, vec![first], 1, &limits);
    let [straight, buckled] = diagram.branches.as_slice() else { panic!("two branches") };
    let at = &straight.points[straight.special[0].place];
    // Twice the first zero of the Bessel function of order -1/4 (Prandtl 1899; Michell 1899).
    assert!((most * at.t - 4.012_599_343_578_901).abs() < 1e-9, "{}", most * at.t);
    assert!(buckled.mirrored && buckled.special.is_empty());
    assert!(buckled.points[1..].iter().all(|point| point.stability.index == Some(0)));
    assert_eq!(straight.points.last().and_then(|point| point.stability.index), Some(1));
}
