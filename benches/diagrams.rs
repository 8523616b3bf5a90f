//! Four scenes whose diagrams are followed through the boundary-value solver.

use std::hint::black_box;
use std::sync::Arc;

use nalgebra::Vector3;
use ribbonrs::boundary::{End, Family, Hold, Law, LineLoad, Problem, Rod, Settings, Solution};
use ribbonrs::continuation::{Held, HeldState, Limits, begin, diagram, reversed};
use ribbonrs::growth::Growth;
use ribbonrs::section::{Amplitude, RibbonLaw, RibbonSpec, Strain};

type Vector = Vector3<f64>;

/// A scene from one end of a parameter to the other, where it starts and to what depth branches are followed.
pub struct Scene {
    /// What is followed.
    #[allow(dead_code, reason = "not all that use the scenes name them")]
    pub name: &'static str,
    problem: fn(f64) -> Arc<Problem>,
    start: f64,
    depth: usize,
}

/// All of them.
pub const SCENES: [Scene; 4] = [
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

impl Scene {
    /// The state that the diagram starts with.
    pub fn state(&self) -> HeldState {
        let problem = (self.problem)(self.start);
        let solution = Solution::of(problem.clone(), &Settings::default(), None).expect("a state");
        assert!(solution.report.status.is_solved());
        let nodes = solution.nodes().iter().map(|s| s / problem.length).collect();
        HeldState { nodes: Arc::new(nodes), x: solution.iterate().clone() }
    }

    /// Follows the diagram from there.
    pub fn follow(&self, state: &HeldState) {
        let limits = Limits::default();
        let family = Family::new(vec![(self.problem)(0.0), (self.problem)(1.0)]).expect("two of a kind");
        let mut equations = Held::new(family, 0.0, 5, 1e-10);
        let first = begin(&mut equations, state.clone(), self.start, &limits).expect("an equilibrium");
        let first = if self.start > 0.0 { reversed(&equations, first) } else { first };
        black_box(diagram(&mut equations, vec![first], self.depth, &limits));
    }
}
