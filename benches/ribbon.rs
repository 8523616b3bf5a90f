//! Sections along a ribbon that varies, and its natural shape.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use ribbonrs::equilibrium::natural_branches;
use ribbonrs::growth::Growth;
use ribbonrs::material::PlaneStress;
use ribbonrs::piecewise::Piecewise;
use ribbonrs::section::{Amplitude, Form, RibbonLaw, RibbonSpec, Strain};

const ETA: f64 = 0.1;
const LENGTH: f64 = 10.0;

fn line(from: f64, to: f64) -> Amplitude {
    let pieces = vec![vec![0.5 * (from + to), 0.5 * (to - from)]];
    Amplitude::Along(Piecewise::from_legendre(vec![0.0, LENGTH], pieces).expect("a line"))
}

fn step(count: u32) -> Growth {
    let breaks = (0..=count).map(|i| f64::from(i) / f64::from(count) - 0.5).collect();
    let pieces = (0..count).map(|i| vec![0.02 * f64::from((i * 5) % 7)]).collect();
    Growth { gamma33: Piecewise::from_legendre(breaks, pieces).expect("pieces").into(), ..Growth::default() }
}

fn law(growth: Vec<(Amplitude, Growth)>) -> RibbonLaw {
    let spec = RibbonSpec {
        eta: ETA,
        stiffness: PlaneStress::incompressible(),
        form: Form::Auto,
        growth,
        width: Amplitude::Constant(1.0),
        thickness: Amplitude::Constant(1.0),
    };
    RibbonLaw::new(spec).expect("a law for this growth")
}

fn ribbon(c: &mut Criterion) {
    let even = Growth { gamma33: vec![0.0, 0.0, 0.3, 0.0, -0.5, 0.0, 1.0].into(), ..Growth::default() };
    let constant = |value| Amplitude::Constant(value);
    let cases = [
        (
            "edge and chiral growth",
            law(vec![(line(0.03, 0.08), Growth::edge(1.0)), (constant(0.04), Growth::chiral(1.0))]),
        ),
        ("a profile of degree 6", law(vec![(line(0.5, 1.0), even), (constant(0.04), Growth::chiral(1.0))])),
        ("steps, 3 pieces", law(vec![(line(0.5, 1.0), step(3)), (constant(0.04), Growth::chiral(1.0))])),
        ("steps, 40 pieces", law(vec![(line(0.5, 1.0), step(40)), (constant(0.04), Growth::chiral(1.0))])),
    ];
    let strain = Strain::new(0.01, 0.0, 0.2, 0.1);
    let mut group = c.benchmark_group("a section along the ribbon, with its energy");
    for (name, law) in &cases {
        group.bench_function(*name, |b| {
            b.iter(|| law.station(black_box(3.0)).map(|station| station.energy(&strain)));
        });
    }
    group.finish();
    let mut group = c.benchmark_group("natural branches");
    group.sample_size(20);
    for (name, law) in &cases {
        group.bench_function(*name, |b| b.iter(|| natural_branches(black_box(law), LENGTH)));
    }
    group.finish();
}

criterion_group!(benches, ribbon);
criterion_main!(benches);
