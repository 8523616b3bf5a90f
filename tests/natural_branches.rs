//! Natural shapes along ribbons that vary, against those of each section and against known thresholds.

use ribbonrs::equilibrium::{EventKind, NaturalBranch, Phase, natural_branches};
use ribbonrs::frame::{Pose, helix, integrate_segments};
use ribbonrs::growth::Growth;
use ribbonrs::material::PlaneStress;
use ribbonrs::piecewise::Piecewise;
use ribbonrs::section::{Amplitude, Form, RibbonLaw, RibbonSpec, Strain};

const ETA: f64 = 0.1;
const LENGTH: f64 = 10.0;

fn line(from: f64, to: f64) -> Amplitude {
    let (mean, rise) = (0.5 * (from + to), 0.5 * (to - from));
    Amplitude::Along(Piecewise::from_legendre(vec![0.0, LENGTH], vec![vec![mean, rise]]).unwrap())
}

fn law(growth: Vec<(Amplitude, Growth)>, width: Amplitude) -> RibbonLaw {
    let stiffness = PlaneStress::incompressible();
    let thickness = Amplitude::Constant(1.0);
    RibbonLaw::new(RibbonSpec { eta: ETA, stiffness, form: Form::Auto, growth, width, thickness }).unwrap()
}

fn start() -> Pose {
    Pose::new([0.0; 3], [1.0, 0.0, 0.0, 0.0])
}

fn places(n: usize) -> Vec<f64> {
    (0..=n).map(|i| LENGTH * i as f64 / n as f64).collect()
}

/// Every strain of the branch is that of a stable natural shape of the section there.
fn is_pointwise_stable(law: &RibbonLaw, branch: &NaturalBranch) {
    for s in places(73) {
        let strain = branch.strain(s);
        let shapes = law.station(s).unwrap().natural_shapes();
        let nearest = shapes
            .iter()
            .filter(|shape| shape.section_index == 0)
            .map(|shape| (shape.strain - strain).amax())
            .fold(f64::INFINITY, f64::min);
        // The tolerance of the elements' polynomials, evaluated between their nodes.
        assert!(nearest < 1e-11, "S = {s}: {nearest:e}");
    }
}

#[test]
fn a_branch_of_constant_growth_is_a_helix() {
    let growth = vec![
        (Amplitude::Constant(0.06), Growth::edge(1.0)),
        (Amplitude::Constant(0.04), Growth::chiral(1.0)),
    ];
    let law = law(growth, line(1.0, 1.0));
    let branches = natural_branches(&law, LENGTH).unwrap();
    assert_eq!((branches.len(), branches[0].events.len()), (2, 0));
    assert_eq!(branches[0].phases, [Phase::Helical]);
    let shape = law.station(0.0).unwrap().natural_shapes()[0];
    assert!((branches[0].energy - shape.energy).abs() < 1e-14 * shape.energy);
    let s = places(20);
    for (a, b) in branches[0].poses(&s, &start()).iter().zip(helix(&s, &shape.strain, &start())) {
        assert!((a.position - b.position).norm() < 1e-12 && (a.rotation - b.rotation).norm() < 1e-12);
    }
}

#[test]
fn growth_that_rises_bends_where_flat_becomes_unstable() {
    let law = law(vec![(line(0.0, 0.08), Growth::edge(1.0))], Amplitude::Constant(1.0));
    let branch = &natural_branches(&law, LENGTH).unwrap()[0];
    assert_eq!(branch.phases, [Phase::Flat, Phase::Bent]);
    let event = branch.events[0];
    assert_eq!((branch.events.len(), event.kind), (1, EventKind::Bifurcation));
    // Flat is unstable beyond xi = (sqrt(259) - 7)/2 eta^2.
    let threshold = LENGTH * (259f64.sqrt() - 7.0) / 2.0 * ETA * ETA / 0.08;
    assert!((event.s - threshold).abs() < 1e-11, "{} {threshold}", event.s);
    assert!(branch.strain(LENGTH)[2] > 0.0);
    is_pointwise_stable(&law, branch);
}

#[test]
fn a_tapering_ribbon_flattens_towards_its_tip() {
    // The local thickness ratio is ETA/w: flat where xi < 4.5467 (ETA/w)^2.
    let law = law(vec![(Amplitude::Constant(0.06), Growth::edge(1.0))], line(1.0, 0.5));
    let branch = &natural_branches(&law, LENGTH).unwrap()[0];
    assert_eq!(branch.phases, [Phase::Bent, Phase::Flat]);
    let width = ETA * ((259f64.sqrt() - 7.0) / 2.0 / 0.06).sqrt();
    assert!((branch.events[0].s - LENGTH * (1.0 - width) / 0.5).abs() < 1e-10);
    is_pointwise_stable(&law, branch);
}

#[test]
fn a_shape_that_ends_at_a_fold_jumps() {
    let growth =
        vec![(Amplitude::Constant(0.08), Growth::edge(1.0)), (line(-0.3, 0.6), Growth::thickness(1.0, 0.0))];
    let law = law(growth, Amplitude::Constant(1.0));
    let branches = natural_branches(&law, LENGTH).unwrap();
    // Bent towards the face that grows less it stays; bent the other way it snaps over.
    let jumps: Vec<usize> =
        branches.iter().map(|b| b.events.iter().filter(|e| e.kind == EventKind::Jump).count()).collect();
    assert!(jumps.windows(2).all(|w| w[0] <= w[1]) && jumps.contains(&1), "{jumps:?}");
    for branch in &branches {
        is_pointwise_stable(&law, branch);
        for event in &branch.events {
            let station = law.station(event.s).unwrap();
            let hessian = station.evaluate(&event.before).hessian;
            let soft = hessian.symmetric_eigenvalues().min();
            // At a fold the stiffness vanishes like the root of the distance from it.
            assert!(soft.abs() < 1e-5 * ETA * ETA, "{soft:e}");
            assert!((event.after[2] - event.before[2]).abs() > 0.1);
        }
    }
}

#[test]
fn growth_that_jumps_is_told() {
    let steps = Piecewise::from_legendre(vec![0.0, 4.0, 10.0], vec![vec![0.03], vec![0.06]]).unwrap();
    let law = law(
        vec![(Amplitude::Along(steps), Growth::edge(1.0)), (Amplitude::Constant(0.02), Growth::chiral(1.0))],
        Amplitude::Constant(1.0),
    );
    let branch = &natural_branches(&law, LENGTH).unwrap()[0];
    assert_eq!(
        (branch.events.len(), branch.events[0].kind, branch.events[0].s),
        (1, EventKind::GrowthJump, 4.0)
    );
    is_pointwise_stable(&law, branch);
    let exact = integrate_segments(&[0.0, 4.0, 10.0], &[branch.strain(2.0), branch.strain(6.0)], &start());
    let poses = branch.poses(&[0.0, 4.0, 10.0], &start());
    for (a, b) in poses.iter().zip(exact) {
        assert!((a.position - b.position).norm() < 1e-12);
    }
}

/// The poses do not depend on where they are asked for, and are those of many short helices.
#[test]
fn poses_are_converged() {
    let law = law(
        vec![
            (line(0.02, 0.09), Growth::edge(1.0)),
            (line(0.06, 0.01), Growth::chiral(1.0)),
            (Amplitude::Constant(-0.1), Growth::thickness(1.0, 0.0)),
        ],
        line(1.2, 0.8),
    );
    let branch = &natural_branches(&law, LENGTH).unwrap()[0];
    let (few, many) = (branch.poses(&[LENGTH], &start()), branch.poses(&places(997), &start()));
    let (a, b) = (few[0], many[997]);
    assert!((a.position - b.position).norm() < 1e-11 && (a.rotation - b.rotation).norm() < 1e-11);
    // Midpoint helices of order two, extrapolated.
    let end = |n: usize| {
        let s = places(n);
        let strains: Vec<Strain> = s.windows(2).map(|w| branch.strain(0.5 * (w[0] + w[1]))).collect();
        integrate_segments(&s, &strains, &start())[n].position
    };
    let (coarse, fine) = (end(4000), end(8000));
    let limit = fine + (fine - coarse) / 3.0;
    assert!((a.position - limit).norm() < 1e-10, "{:e}", (a.position - limit).norm());
}

/// Edge growth that exceeds the threshold of bending over an eighth of the ribbon only, by two per cent.
#[test]
fn a_window_of_instability_is_not_stepped_over() {
    let threshold = (259f64.sqrt() - 7.0) / 2.0 * ETA * ETA;
    // amplitude = 1.02 threshold (1 - (y - 0.35)^2) with y from -1 to 1.
    let (top, y0) = (1.02 * threshold, 0.35);
    let legendre = vec![top * (1.0 - y0 * y0 - 1.0 / 3.0), top * 2.0 * y0, -top * 2.0 / 3.0];
    let hump = Piecewise::from_legendre(vec![0.0, LENGTH], vec![legendre]).unwrap();
    let law = law(vec![(Amplitude::Along(hump), Growth::edge(1.0))], Amplitude::Constant(1.0));
    let branch = &natural_branches(&law, LENGTH).unwrap()[0];
    assert_eq!(branch.phases, [Phase::Flat, Phase::Bent, Phase::Flat]);
    let half = (1.0 - 1.0 / 1.02f64).sqrt();
    for (event, y) in branch.events.iter().zip([y0 - half, y0 + half]) {
        assert_eq!(event.kind, EventKind::Bifurcation);
        assert!((event.s - 0.5 * LENGTH * (1.0 + y)).abs() < 1e-10, "{event:?}");
    }
    is_pointwise_stable(&law, branch);
}

/// Growth exactly at a threshold, where flat shapes are degenerate, all along or up to a place.
#[test]
fn growth_may_stay_at_a_bifurcation() {
    for (xi, stable) in [(5.0, 2), ((259f64.sqrt() - 7.0) / 2.0, 1)] {
        let at = Piecewise::from_legendre(vec![0.0, 5.0, 10.0], vec![vec![xi], vec![xi]]).unwrap();
        let on = Piecewise::from_legendre(vec![0.0, 5.0, 10.0], vec![vec![xi], vec![xi + 0.5, 0.5]]).unwrap();
        for amplitude in [at, on] {
            let growth = vec![(Amplitude::Along(amplitude), Growth::edge(ETA * ETA))];
            let law = law(growth, Amplitude::Constant(1.0));
            let branches = natural_branches(&law, LENGTH).unwrap();
            assert_eq!(branches.len(), stable);
            assert!(branches[0].breaks().len() < 100 && branches[0].events.len() <= 1);
        }
    }
}

/// A helix that untwists its bending and takes it up again: both corners are told.
#[test]
fn a_helix_becomes_a_twisted_ribbon_and_back() {
    // xi = 0.06 + 0.02 (y^2 - 1) crosses the threshold of the twisted shape at omega = 0.2 twice.
    let dip =
        Piecewise::from_legendre(vec![0.0, LENGTH], vec![vec![0.04 + 0.02 / 3.0, 0.0, 0.04 / 3.0]]).unwrap();
    let growth = vec![
        (Amplitude::Along(dip.clone()), Growth::edge(1.0)),
        (Amplitude::Constant(0.04), Growth::chiral(1.0)),
    ];
    let law = law(growth, Amplitude::Constant(1.0));
    let branch = &natural_branches(&law, LENGTH).unwrap()[0];
    assert_eq!(branch.phases, [Phase::Helical, Phase::Twisted, Phase::Helical]);
    assert_eq!(branch.events.len(), 2, "{:?} {:?}", branch.events, branch.breaks());
    // Twisted is unstable beyond k3 = omega/(1 + C/20), C = 14 - sqrt(1036), xi = (k3^2 - 2 C)/8 in units of eta^2.
    let c = 14.0 - 1036f64.sqrt();
    let k3 = 0.2 / (1.0 + c / 20.0);
    let threshold = (k3 * k3 - 2.0 * c) / 8.0 * ETA * ETA;
    for event in &branch.events {
        assert_eq!(event.kind, EventKind::Bifurcation);
        assert!((dip.evaluate(event.s) - threshold).abs() < 1e-12, "{event:?}");
    }
    is_pointwise_stable(&law, branch);
}

/// A jump of growth that changes only the curvature in the plane of the ribbon.
#[test]
fn growth_that_jumps_in_the_plane_is_told() {
    let on = Piecewise::from_legendre(vec![0.0, 5.0, 10.0], vec![vec![], vec![1.0]]).unwrap();
    let slope = Growth { gamma33: vec![0.0, 0.03].into(), ..Growth::default() };
    let law = law(vec![(Amplitude::Along(on), slope)], Amplitude::Constant(1.0));
    let branch = &natural_branches(&law, LENGTH).unwrap()[0];
    assert_eq!(
        (branch.events.len(), branch.events[0].kind, branch.events[0].s),
        (1, EventKind::GrowthJump, 5.0)
    );
    assert!((branch.events[0].after[1] - 0.03).abs() < 1e-16);
}
