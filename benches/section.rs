//! Section laws: value, gradient and Hessian at one strain.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use ribbonrs::growth::Growth;
use ribbonrs::material::PlaneStress;
use ribbonrs::section::{Form, Section, Strain};

const ETA: f64 = 0.1;

fn law(growth: &Growth, form: Form) -> Section {
    Section::new(ETA, growth, &PlaneStress::incompressible(), form).expect("a law for this growth")
}

fn at(k2: f64) -> Strain {
    Strain::new(0.01, 0.002, k2 * ETA, 0.8 * ETA)
}

fn section(c: &mut Criterion) {
    let edge = Growth::edge(0.06) + Growth::chiral(0.04);
    // An even profile of degree 6: eight modes up to |K2| = 7.5 eta or so.
    let even = Growth { gamma33: vec![0.0, 0.0, 0.3, 0.0, -0.5, 0.0, 1.0].into(), ..Growth::default() };
    let odd = Growth { gamma33: vec![0.0, 0.01, 0.3, 0.2, -0.5].into(), ..Growth::default() };
    let mut group = c.benchmark_group("value, gradient and Hessian");
    for (name, law, k2) in [
        ("closed form, |K2| = 2.4 eta", law(&edge, Form::Closed), 2.4),
        ("closed form, |K2| = 40 eta", law(&edge, Form::Closed), 40.0),
        ("general law, 8 modes", law(&even, Form::General), 2.4),
        ("general law, 16 modes (8 even, 8 odd)", law(&odd, Form::General), 2.4),
        ("general law, 16 modes (even)", law(&even, Form::General), 40.0),
        ("general law, 32 modes (even)", law(&even, Form::General), 400.0),
        ("second-order form", law(&edge, Form::SecondOrder), 2.4),
    ] {
        let strain = at(k2);
        group.bench_function(name, |b| b.iter(|| law.evaluate(black_box(&strain))));
    }
    group.finish();
    let mut group = c.benchmark_group("value alone");
    for (name, law) in
        [("closed form", law(&edge, Form::Closed)), ("general law, 8 modes", law(&even, Form::General))]
    {
        let strain = at(2.4);
        group.bench_function(name, |b| b.iter(|| law.energy(black_box(&strain))));
    }
    group.finish();
}

criterion_group!(benches, section);
criterion_main!(benches);
