//! What a scene saves by not using something: pairs of the short way and the long way round.
//!
//! That both give the same is tested in tests/pays.rs; the table is in docs/performance.md.

use std::hint::black_box;
use std::sync::Arc;

use criterion::{Criterion, criterion_group, criterion_main};
use nalgebra::Vector3;
use ribbonrs::boundary::{
    End, Hold, Known, Law, Layout, LineLoad, Mesh, Path, Problem, Settings, Solution, System,
};
use ribbonrs::equilibrium::{natural_branches, natural_shapes};
use ribbonrs::frame::{Pose, helix};
use ribbonrs::growth::Growth;
use ribbonrs::material::PlaneStress;
use ribbonrs::piecewise::Piecewise;
use ribbonrs::section::{Amplitude, Form, RibbonLaw, RibbonSpec, Section, Strain};

const ETA: f64 = 0.1;
const LENGTH: f64 = 10.0;

fn section(growth: &Growth, form: Form) -> Section {
    Section::new(ETA, growth, &PlaneStress::incompressible(), form).expect("a law for this growth")
}

fn axial(gamma33: &[f64]) -> Growth {
    Growth { gamma33: gamma33.to_vec().into(), ..Growth::default() }
}

fn steps() -> Growth {
    let pieces = vec![vec![0.1], vec![0.0], vec![0.2]];
    let steps = Piecewise::from_legendre(vec![-0.5, -0.1, 0.3, 0.5], pieces).expect("pieces");
    Growth { gamma33: steps.into(), ..Growth::default() }
}

fn along(coefficients: &[f64]) -> Amplitude {
    let line = Piecewise::from_legendre(vec![0.0, LENGTH], vec![coefficients.to_vec()]);
    Amplitude::Along(line.expect("a line"))
}

fn ribbon(amplitude: Amplitude, growth: Growth) -> RibbonLaw {
    let spec =
        RibbonSpec { growth: vec![(amplitude, growth)], ..RibbonSpec::uniform(ETA, Growth::default()) };
    RibbonLaw::new(spec).expect("a law for this growth")
}

/// Laws at one strain: value, gradient and Hessian unless said.
fn sections(c: &mut Criterion) {
    let strain = Strain::new(0.01, 0.002, 2.4 * ETA, 0.8 * ETA);
    let edge = Growth::edge(0.06) + Growth::chiral(0.04);
    let even = axial(&[0.0, 0.0, 0.3, 0.0, -0.5, 0.0, 1.0]);
    let nearly_even = axial(&[0.0, 0.0, 0.3, 1e-20, -0.5, 0.0, 1.0]);
    let uncut = axial(&[0.0, 0.0, 0.3, 0.2]);
    let zero = Growth { gamma33: Piecewise::zero(&[-0.5, 0.1, 0.5]).into(), ..Growth::default() };
    let mut group = c.benchmark_group("pays");
    for (name, law) in [
        ("closed form", section(&edge, Form::Closed)),
        ("the same growth in modes", section(&edge, Form::General)),
        ("even growth", section(&even, Form::General)),
        ("even growth with the odd modes", section(&nearly_even, Form::General)),
        ("growth without jumps", section(&uncut, Form::General)),
        ("the same in the modes of two pieces", section(&(uncut.clone() + zero), Form::General)),
    ] {
        group.bench_function(name, |b| b.iter(|| law.evaluate(black_box(&strain))));
    }
    let law = section(&edge, Form::Auto);
    group.bench_function("energy alone", |b| b.iter(|| law.energy(black_box(&strain))));
    group.bench_function("energy and gradient", |b| {
        b.iter(|| (law.energy(black_box(&strain)), law.gradient(black_box(&strain))));
    });
    group.bench_function("energy, gradient and Hessian", |b| b.iter(|| law.evaluate(black_box(&strain))));
    group.bench_function("deflection", |b| b.iter(|| law.deflection(black_box(&strain))));
    group.bench_function("deflection and displacements in the plane", |b| {
        b.iter(|| law.deflection(black_box(&strain)).map(|u| law.in_plane(&strain, &u)));
    });
    group.bench_function("a law of one field", |b| {
        b.iter(|| section(black_box(&Growth::edge(0.06)), Form::Auto))
    });
    let zeros = || vec![0.0; 3].into();
    let all = Growth { d33: zeros(), d22: zeros(), g21: zeros(), g31: zeros(), ..edge.clone() };
    group.bench_function("a law of six fields, zero but two", |b| {
        b.iter(|| section(black_box(&all), Form::Auto));
    });
    group.finish();
}

/// Whole ribbons.
fn ribbons(c: &mut Criterion) {
    let growth = Growth::edge(0.06) + Growth::chiral(0.04);
    let s: Vec<f64> = (0..=100).map(|i| LENGTH * f64::from(i) / 100.0).collect();
    let start = Pose::new([0.0; 3], [1.0, 0.0, 0.0, 0.0]);
    let mut group = c.benchmark_group("pays");
    group.sample_size(30);
    group.bench_function("uniform growth: one point and a helix of 101 nodes", |b| {
        b.iter(|| {
            let shapes = natural_shapes(&section(black_box(&growth), Form::Auto));
            helix(&s, &shapes[0].strain, &start)
        });
    });
    group.bench_function("the same growth, followed along the ribbon", |b| {
        let law = ribbon(along(&[1.0]), growth.clone());
        b.iter(|| natural_branches(black_box(&law), LENGTH).map(|branches| branches[0].poses(&s, &start)));
    });
    let stations: Vec<f64> = (0..100).map(|i| LENGTH * (f64::from(i) + 0.5) / 100.0).collect();
    let strain = Strain::new(0.01, 0.0, 2.4 * ETA, 0.8 * ETA);
    group.bench_function("100 sections with jumps that share their modes", |b| {
        b.iter(|| {
            let law = ribbon(along(&[0.5, 0.5]), black_box(steps()));
            stations.iter().map(|&s| law.station(s).map_or(0.0, |here| here.energy(&strain))).sum::<f64>()
        });
    });
    group.bench_function("100 sections with jumps, each with modes of its own", |b| {
        b.iter(|| {
            let energy = |&s: &f64| {
                let mut growth = Growth::default();
                growth.add_scaled(0.1 * s, 1.0, black_box(&steps()));
                section(&growth, Form::Auto).energy(&strain)
            };
            stations.iter().map(energy).sum::<f64>()
        });
    });
    group.finish();
}

/// A ribbon without loads, clamped at its start, and free or clamped after some turns at its end.
fn problem(law: RibbonLaw, hold: Hold, z: f64, turns: f64) -> Arc<Problem> {
    let end = End { position: Vector3::new(0.0, 0.0, z), turns, ..End::new(hold) };
    let (ends, line) = ([End::new(Hold::Clamped), end], LineLoad::uniform([0.0; 3]));
    Arc::new(Problem::new(Law::Relaxed(law), LENGTH, ends, vec![], line).expect("a problem"))
}

/// What needs no boundary-value problem, or fewer states of one.
fn held(c: &mut Criterion) {
    let s: Vec<f64> = (0..=100).map(|i| LENGTH * f64::from(i) / 100.0).collect();
    let start = Pose::new([0.0; 3], [1.0, 0.0, 0.0, 0.0]);
    let settings = Settings { tolerance: 1e-12, ..Settings::default() };
    let growth = || black_box(Growth::edge(0.06) + Growth::chiral(0.04));
    let mut group = c.benchmark_group("pays");
    group.sample_size(30);
    let solved = |law| Solution::of(problem(law, Hold::Free, 0.0, 0.0), &settings, None).map(|x| x.many(&s));
    group.bench_function("free end, uniform growth: the boundary-value problem", |b| {
        b.iter(|| solved(ribbon(Amplitude::Constant(1.0), growth())));
    });
    group.bench_function("free end, growth that varies: the natural shape", |b| {
        b.iter(|| {
            let branches = natural_branches(&ribbon(along(&[1.0, 0.1]), growth()), LENGTH);
            branches.map(|branches| branches[0].poses(&s, &start))
        });
    });
    group.bench_function("free end, growth that varies: the boundary-value problem", |b| {
        b.iter(|| solved(ribbon(along(&[1.0, 0.1]), growth())));
    });
    let law = ribbon(Amplitude::Constant(1.0), Growth::edge(0.02));
    let problem = problem(law, Hold::Clamped, 9.0, 0.5);
    let rough = Settings { tolerance: 1e-4, ..Settings::default() };
    let solution = Solution::of(Arc::clone(&problem), &rough, None).expect("a solution");
    group.bench_function("both ends held, 101 poses: from a few of each element", |b| {
        b.iter(|| black_box(solution.many(&s)));
    });
    group.bench_function("both ends held, 101 poses: by a step each", |b| {
        b.iter(|| {
            s.iter().map(|&s| black_box(solution.at(s)).map_or(0.0, |state| state.at.position.x)).sum::<f64>()
        });
    });
    for (states, layout) in [(7, Layout::Constant), (13, Layout::Full)] {
        let settings = Settings { layout: Some(layout), ..Settings::default() };
        group.bench_function(format!("both ends held, {states} states"), |b| {
            b.iter(|| Solution::of(Arc::clone(&problem), &settings, None));
        });
        let mesh = Mesh::new(&problem, s.clone(), settings.degree).expect("a mesh");
        let path = Path::new(&mesh, &Known::Straight(1.0)).expect("a shape");
        let targets = path.targets(&problem, 0.5);
        let mut system = System::with_layout(mesh.clone(), layout).expect("a system");
        group.bench_function(format!("an iteration on 100 elements, {states} states"), |b| {
            b.iter(|| {
                system.linearise(&path.x, &targets).expect("a regular matrix");
                black_box(system.correction())
            });
        });
        group.bench_function(format!("the same as one sparse matrix, {states} states"), |b| {
            b.iter(|| {
                system.linearise_sparsely(&path.x, &targets).expect("a regular matrix");
                black_box(system.correction())
            });
        });
    }
    group.finish();
}

criterion_group!(benches, sections, ribbons, held);
criterion_main!(benches);
