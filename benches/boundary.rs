//! Run times of the boundary-value solver: whole scenes to a tolerance, and one Newton iteration.

use std::hint::black_box;
use std::sync::Arc;

use criterion::{Criterion, criterion_group, criterion_main};
use nalgebra::{Quaternion, Vector3};
use ribbonrs::boundary::{
    End, Hold, Known, Law, Layout, LineLoad, Mesh, Path, Problem, Rod, Settings, Solution, System,
};
use ribbonrs::growth::Growth;
use ribbonrs::material::PlaneStress;
use ribbonrs::section::{Amplitude, Form, RibbonLaw, RibbonSpec, Strain};

type Vector = Vector3<f64>;

fn end(hold: Hold, position: Vector) -> End {
    End {
        hold,
        position,
        rotation: Quaternion::new(1.0, 0.0, 0.0, 0.0),
        turns: 0.0,
        force: Vector::zeros(),
        moment: Vector::zeros(),
    }
}

fn line(force: Vector) -> LineLoad {
    LineLoad {
        force: std::array::from_fn(|i| Amplitude::Constant(force[i])),
        moment: [0.0; 3].map(Amplitude::Constant),
    }
}

/// An inextensible cantilever under a dead load at its tip, `P L^2/EI = 10`.
fn elastica() -> Arc<Problem> {
    let rod = Rod { compliance: Strain::new(0.0, 0.01, 1.0, 1.0), intrinsic: Strain::zeros() };
    let tip = End { force: Vector::new(10.0, 0.0, 0.0), ..end(Hold::Free, Vector::zeros()) };
    let ends = [end(Hold::Clamped, Vector::zeros()), tip];
    Arc::new(Problem::new(Law::Rod(rod), 1.0, ends, vec![], line(Vector::zeros())).unwrap())
}

fn relaxed(growth: Growth) -> Law {
    let spec = RibbonSpec {
        eta: 0.1,
        stiffness: PlaneStress::incompressible(),
        form: Form::Auto,
        growth: vec![(Amplitude::Constant(1.0), growth)],
        width: Amplitude::Constant(1.0),
        thickness: Amplitude::Constant(1.0),
    };
    Law::Relaxed(RibbonLaw::new(spec).unwrap())
}

/// A ribbon clamped at its start that droops under its weight, `p L^3/EI2 = 10`, across its soft side.
fn drooping() -> Arc<Problem> {
    let ends = [end(Hold::Clamped, Vector::zeros()), end(Hold::Free, Vector::zeros())];
    let weight = 10.0 * (0.01 / 12.0) / 1000.0;
    let law = relaxed(Growth::default());
    Arc::new(Problem::new(law, 10.0, ends, vec![], line(Vector::new(-weight, 0.0, 0.0))).unwrap())
}

/// A ribbon with grown edges, `xi = 2 eta^2`, clamped at both ends half a turn apart and shortened by 10 %.
fn grown() -> Arc<Problem> {
    let far = End { turns: 0.5, ..end(Hold::Clamped, Vector::new(0.0, 0.0, 9.0)) };
    let ends = [end(Hold::Clamped, Vector::zeros()), far];
    Arc::new(Problem::new(relaxed(Growth::edge(0.02)), 10.0, ends, vec![], line(Vector::zeros())).unwrap())
}

fn whole(c: &mut Criterion) {
    let scenes =
        [("elastica", elastica(), 1e-11), ("drooping", drooping(), 1e-10), ("grown", grown(), 1e-10)];
    for (name, problem, tolerance) in scenes {
        for degree in 2..=8 {
            let settings = Settings { tolerance, degree, ..Settings::default() };
            let solve = || Solution::of(Arc::clone(&problem), &settings, None).unwrap();
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
        let mesh = Mesh::new(&problem, nodes, degree).unwrap();
        let path = Path::new(&mesh, &Known::Natural(1.0)).unwrap();
        let targets = path.targets(&problem, 0.5);
        for (states, layout) in [(7, Layout::Constant), (10, Layout::Moment), (13, Layout::Full)] {
            let mut system = System::with_layout(&mesh, layout).unwrap();
            let name = format!("iteration, 100 elements, degree {degree}, {states} states");
            c.bench_function(&name, |b| {
                b.iter(|| {
                    system.linearise(&path.x, &targets).unwrap();
                    black_box(system.correction())
                });
            });
        }
    }
}

criterion_group!(benches, whole, iteration);
criterion_main!(benches);
