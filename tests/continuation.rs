//! Branches and their special points against what is known.

use std::sync::Arc;
use std::time::Instant;

use nalgebra::Vector3;
use ribbonrs::boundary::{End, Family, Hold, Law, LineLoad, Problem, Rod, Settings, Solution};
use ribbonrs::continuation::*;
use ribbonrs::equilibrium::natural_shapes;
use ribbonrs::growth::Growth;
use ribbonrs::section::{Amplitude, RibbonSpec, Strain};

fn natural(from: f64, to: f64, chirality: f64) -> Diagram<Natural> {
    let spec = |xi: f64| RibbonSpec {
        growth: vec![
            (Amplitude::Constant(xi), Growth::edge(1.0)),
            (Amplitude::Constant(chirality), Growth::chiral(1.0)),
        ],
        ..RibbonSpec::uniform(0.1, Growth::default())
    };
    let family = NaturalFamily::new([spec(from), spec(to)]).unwrap();
    let mut equations = Natural::new(family);
    let limits = Limits { longest: 10.0, ..Limits::default() };
    let mut starts = Vec::new();
    for shape in natural_shapes(equations.station(0.0).unwrap().section()) {
        let x = [shape.strain[2] / 0.1, shape.strain[3] / 0.1];
        starts.push(begin(&mut equations, x, 0.0, &limits).unwrap());
    }
    diagram(&mut equations, starts, 3, &limits)
}

fn show<E: Equations>(diagram: &Diagram<E>, scale: f64, from: f64)
where
    E::State: std::fmt::Debug,
{
    for (i, branch) in diagram.branches.iter().enumerate() {
        println!(
            "branch {i}: {} points, {:?}, origin {:?} mirrored {}",
            branch.points.len(),
            branch.ended,
            branch.origin,
            branch.mirrored
        );
        for special in &branch.special {
            let p = &branch.points[special.place];
            println!(
                "   {:?} x{} at {:.13} index {:?} sec {}",
                special.kind,
                special.multiplicity,
                from + scale * p.t,
                p.stability.index,
                p.stability.section_index
            );
        }
        let idx: Vec<_> = branch
            .points
            .iter()
            .map(|p| (format!("{:.4}", p.t), p.stability.index, p.stability.section_index))
            .collect();
        println!("   {idx:?}");
    }
}

#[test]
fn edge() {
    let diagram = natural(0.0, 0.08, 0.0);
    show(&diagram, 0.08, 0.0);
    let t = Instant::now();
    for _ in 0..100 {
        natural(0.0, 0.08, 0.0);
    }
    println!("{:?}", t.elapsed() / 100);
    let diagram = natural(0.0, 0.08, 0.04);
    show(&diagram, 0.08, 0.0);
}

#[test]
fn lateral() {
    let rod = Rod { compliance: Strain::new(0.0, 0.0, 1.0, 1.0), intrinsic: Strain::zeros() };
    let problem = |p: f64| {
        let tip = End { force: Vector3::new(0.0, p, 0.0), ..End::new(Hold::Free) };
        Arc::new(
            Problem::new(
                Law::Rod(rod),
                1.0,
                [End::new(Hold::Clamped), tip],
                vec![],
                LineLoad::uniform([0.0; 3]),
            )
            .unwrap(),
        )
    };
    let run = || {
        let family = Family::new(vec![problem(0.0), problem(8.025)]).unwrap();
        let mut equations = Held::new(family, 0.0, 5, 1e-10);
        let limits = Limits::default();
        let start = Solution::of(problem(0.0), &Settings::default(), None).unwrap();
        let x = HeldState {
            nodes: Arc::new((0..=8).map(|i| f64::from(i) / 8.0).collect()),
            x: start.iterate().clone(),
        };
        let x = remesh(&start, x);
        let start = begin(&mut equations, x, 0.0, &limits).unwrap();
        let d = diagram(&mut equations, vec![start], 1, &limits);
        (d, equations.work)
    };
    let (diagram, work) = run();
    println!("{work:#?}");
    println!("{:?}", diagram.branches[1].points.iter().map(|p| p.x.nodes.len()).collect::<Vec<_>>());
    show(&diagram, 8.025, 0.0);
    let t = Instant::now();
    for _ in 0..20 {
        run();
    }
    println!("{:?}", t.elapsed() / 20);
}

fn remesh(start: &Solution, _x: HeldState) -> HeldState {
    let nodes = start.nodes();
    let length = nodes[nodes.len() - 1];
    HeldState { nodes: Arc::new(nodes.iter().map(|s| s / length).collect()), x: start.iterate().clone() }
}
