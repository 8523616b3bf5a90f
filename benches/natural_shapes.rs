//! All natural shapes of one growth, with the law built anew each time.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use ribbonrs::equilibrium::natural_shapes;
use ribbonrs::growth::Growth;
use ribbonrs::material::PlaneStress;
use ribbonrs::section::{Form, Section};

fn shapes(c: &mut Criterion) {
    let eta = 0.1;
    let edge = |x: f64| Growth::edge(x * eta * eta);
    let chiral = |omega: f64| Growth::chiral(2.0 * eta * omega);
    let profile = Growth {
        gamma33: vec![0.0, 0.01, 0.3, 0.2, -0.5, 0.1, 0.6].into(),
        d33: vec![0.1, 0.3, -0.2].into(),
        d22: vec![-0.05, 0.0, 0.4].into(),
        d23: vec![0.05, 0.1].into(),
        g21: vec![0.0, 0.02, 0.1].into(),
        ..Growth::default()
    };
    // The same growth strains in ever thinner ribbons.
    let strong = Growth {
        gamma33: vec![0.0, 0.1, 0.4, -0.3, 0.8].into(),
        d33: vec![0.2, 0.1].into(),
        d23: vec![0.1].into(),
        ..Growth::default()
    };
    let mut group = c.benchmark_group("natural shapes");
    for eta in [1e-2, 1e-3, 1e-4, 1e-6] {
        group.bench_function(format!("strong growth in three fields, eta = {eta:e}"), |b| {
            let law = Section::new(eta, &strong, &PlaneStress::incompressible(), Form::Auto);
            let law = law.expect("a law for this growth");
            b.iter(|| natural_shapes(black_box(&law)));
        });
    }
    for (name, growth) in [
        ("edge growth, xi = 6 eta^2", edge(6.0)),
        ("edge growth and chirality, xi = 6 eta^2, omega = 0.2", edge(6.0) + chiral(0.2)),
        ("edge growth and chirality, xi = 100 eta^2, omega = 0.2", edge(100.0) + chiral(0.2)),
        ("edge, thickness gradient and chirality", edge(6.0) + Growth::thickness(0.2, 0.0) + chiral(0.2)),
        ("general profile, six fields", profile),
    ] {
        group.bench_function(name, |b| {
            b.iter(|| {
                let law = Section::new(eta, black_box(&growth), &PlaneStress::incompressible(), Form::Auto);
                natural_shapes(&law.expect("a law for this growth"))
            });
        });
    }
    group.finish();
}

criterion_group!(benches, shapes);
criterion_main!(benches);
