//! Run times of the boundary-value solver: whole scenes to a tolerance, and one Newton iteration.

use std::hint::black_box;
use std::sync::Arc;

use criterion::{Criterion, criterion_group, criterion_main};
use nalgebra::Vector3;
use ribbonrs::boundary::{
    End, Hold, Known, Law, Layout, LineLoad, Mesh, Path, Problem, Rod, Settings, Solution, System,
};
use ribbonrs::growth::Growth;
use ribbonrs::section::{RibbonLaw, RibbonSpec, Strain};

type Vector = Vector3<f64>;

fn problem(law: Law, length: f64, ends: [End; 2], line: LineLoad) -> Arc<Problem> {
    Arc::new(Problem::new(law, length, ends, vec![], line).expect("a problem"))
}

/// An inextensible cantilever under a dead load at its tip, `P L^2/EI = 10`.
fn elastica() -> Arc<Problem> {
    let rod = Rod { compliance: Strain::new(0.0, 0.01, 1.0, 1.0), intrinsic: Strain::zeros() };
    let tip = End { force: Vector::new(10.0, 0.0, 0.0), ..End::new(Hold::Free) };
    problem(Law::Rod(rod), 1.0, [End::new(Hold::Clamped), tip], LineLoad::uniform([0.0; 3]))
}

fn relaxed(growth: Growth) -> Law {
    Law::Relaxed(RibbonLaw::new(RibbonSpec::uniform(0.1, growth)).expect("a law for this growth"))
}

/// A ribbon clamped at its start that droops under its weight, `p L^3/EI2 = 10`, across its soft side.
fn drooping() -> Arc<Problem> {
    let weight = 10.0 * (0.01 / 12.0) / 1000.0;
    let ends = [Hold::Clamped, Hold::Free].map(End::new);
    problem(relaxed(Growth::default()), 10.0, ends, LineLoad::uniform([-weight, 0.0, 0.0]))
}

/// A ribbon with grown edges, `xi = 2 eta^2`, clamped at both ends half a turn apart and shortened by 10 %.
fn grown() -> Arc<Problem> {
    let far = End { position: Vector::new(0.0, 0.0, 9.0), turns: 0.5, ..End::new(Hold::Clamped) };
    let ends = [End::new(Hold::Clamped), far];
    problem(relaxed(Growth::edge(0.02)), 10.0, ends, LineLoad::uniform([0.0; 3]))
}

fn whole(c: &mut Criterion) {
    let scenes =
        [("elastica", elastica(), 1e-11), ("drooping", drooping(), 1e-10), ("grown", grown(), 1e-10)];
    for (name, problem, tolerance) in scenes {
        for degree in 2..=8 {
            let settings = Settings { tolerance, degree, ..Settings::default() };
            let solve = || Solution::of(Arc::clone(&problem), &settings, None).expect("a state");
            assert!(solve().report.status.is_solved());
            c.bench_function(&format!("{name} to {tolerance:e}, degree {degree}"), |b| {
                b.iter(|| black_box(solve()))
            });
        }
    }
}

/// One linearisation and correction on 100 elements; divide by 100 and the degree for a stage.
fn iteration(c: &mut Criterion) {
    let problem = grown();
    for degree in 2..=8 {
        let nodes = (0..=100).map(|i| 0.1 * f64::from(i)).collect();
        let mesh = Mesh::new(&problem, nodes, degree).expect("a mesh");
        let path = Path::new(&mesh, &Known::Straight(1.0)).expect("a shape");
        let targets = path.targets(&problem, 0.5);
        for (states, layout) in [(7, Layout::Constant), (10, Layout::Moment), (13, Layout::Full)] {
            let mut system = System::with_layout(mesh.clone(), layout).expect("a system");
            let name = format!("iteration, 100 elements, degree {degree}, {states} states");
            c.bench_function(&name, |b| {
                b.iter(|| {
                    system.linearise(&path.x, &targets).expect("a regular matrix");
                    black_box(system.correction())
                });
            });
        }
    }
}

criterion_group!(benches, whole, iteration);
criterion_main!(benches);
