//! Run times of whole diagrams through the boundary-value solver, on four scenes; `cargo bench --bench continuation`.

use std::hint::black_box;
use std::sync::Arc;

use criterion::{Criterion, criterion_group, criterion_main};
use nalgebra::Vector3;
use ribbonrs::boundary::{End, Family, Hold, Law, LineLoad, Problem, Rod, Settings, Solution};
use ribbonrs::continuation::{Held, HeldState, Limits, begin, diagram, reversed};
use ribbonrs::growth::Growth;
use ribbonrs::section::{Amplitude, RibbonLaw, RibbonSpec, Strain};

type Vector = Vector3<f64>;

/// A scene from one end of a parameter to the other, where it starts and to what depth branches are followed.
struct Scene {
    name: &'static str,
    problem: fn(f64) -> Arc<Problem>,
    start: f64,
    depth: usize,
}

const SCENES: [Scene; 4] = [
    Scene { name: "edges that grow, free end", problem: edges, start: 0.0, depth: 2 },
    Scene { name: "lateral buckling to twice its load", problem: cantilever, start: 0.0, depth: 1 },
    Scene { name: "elastica to P L^2/EI = 10", problem: elastica, start: 0.0, depth: 1 },
    Scene { name: "grown, half a turn, shortened by 10 %", problem: strip, start: 1.0, depth: 0 },
];

fn problem(law: Law, length: f64, end: End) -> Arc<Problem> {
    let ends = [End::new(Hold::Clamped), end];
    Arc::new(Problem::new(law, length, ends, vec![], LineLoad::uniform([0.0; 3])).expect("a problem"))
}

fn grown(xi: f64) -> Law {
    let growth = vec![(Amplitude::Constant(xi), Growth::edge(1.0))];
    let spec = RibbonSpec { growth, ..RibbonSpec::uniform(0.1, Growth::default()) };
    Law::Relaxed(RibbonLaw::new(spec).expect("a law for this growth"))
}

fn edges(t: f64) -> Arc<Problem> {
    problem(grown(0.08 * t), 10.0, End::new(Hold::Free))
}

fn cantilever(t: f64) -> Arc<Problem> {
    let rod = Rod { compliance: Strain::new(0.0, 0.0, 1.0, 1.0), intrinsic: Strain::zeros() };
    let tip = End { force: Vector::new(0.0, 8.0252 * t, 0.0), ..End::new(Hold::Free) };
    problem(Law::Rod(rod), 1.0, tip)
}

fn elastica(t: f64) -> Arc<Problem> {
    let rod = Rod { compliance: Strain::new(0.0, 0.01, 1.0, 1.0), intrinsic: Strain::zeros() };
    let tip = End { force: Vector::new(0.0, 0.0, -10.0 * t), ..End::new(Hold::Free) };
    problem(Law::Rod(rod), 1.0, tip)
}

fn strip(t: f64) -> Arc<Problem> {
    let far = End { position: Vector::new(0.0, 0.0, 9.0 + t), turns: 0.5, ..End::new(Hold::Clamped) };
    problem(grown(0.02), 10.0, far)
}

fn diagrams(c: &mut Criterion) {
    for Scene { name, problem, start, depth } in SCENES {
        let solution = Solution::of(problem(start), &Settings::default(), None).expect("a state");
        assert!(solution.report.status.is_solved());
        let length = problem(start).length;
        let nodes = solution.nodes().iter().map(|s| s / length).collect();
        let state = HeldState { nodes: Arc::new(nodes), x: solution.iterate().clone() };
        let limits = Limits::default();
        c.bench_function(name, |b| {
            b.iter(|| {
                let family = Family::new(vec![problem(0.0), problem(1.0)]).expect("two of a kind");
                let mut equations = Held::new(family, 0.0, 5, 1e-10);
                let first = begin(&mut equations, state.clone(), start, &limits).expect("an equilibrium");
                let first = if start > 0.0 { reversed(&equations, first) } else { first };
                black_box(diagram(&mut equations, vec![first], depth, &limits))
            });
        });
    }
}

criterion_group!(benches, diagrams);
criterion_main!(benches);
