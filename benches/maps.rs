//! A phase diagram of 200 x 200 points with refined boundaries: `cargo bench --bench maps --features rayon`.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use ribbonrs::growth::Growth;
use ribbonrs::maps::{Plane, Progress, phase_map};
use ribbonrs::section::{Amplitude, RibbonSpec};

fn maps(c: &mut Criterion) {
    let profile = Growth { gamma33: vec![0.0, 0.0, 0.0, 0.01, 0.1].into(), ..Growth::default() };
    let corner = |xi: f64, d: f64, other: f64| {
        let terms = [(xi, Growth::edge(1.0)), (d, Growth::chiral(1.0)), (other, profile.clone())];
        RibbonSpec {
            growth: terms.into_iter().map(|(a, growth)| (Amplitude::Constant(a), growth)).collect(),
            ..RibbonSpec::uniform(0.1, Growth::default())
        }
    };
    let grid: Vec<f64> = (0..200).map(|i| f64::from(i) / 199.0).collect();
    let mut group = c.benchmark_group("phase diagram, 200 x 200");
    group.sample_size(10);
    for (name, other) in [("edge growth and chirality", 0.0), ("with a profile of degree 4", 1.0)] {
        let corners = [(0.0, 0.0), (0.0, 0.1), (0.1, 0.0), (0.1, 0.1)];
        let plane = Plane::new(corners.map(|(xi, d)| corner(xi, d, other))).expect("ribbons of one kind");
        group.bench_function(name, |b| {
            b.iter(|| phase_map(black_box(&plane), &grid, &grid, 1e-10, &Progress::default()));
        });
    }
    group.finish();
}

criterion_group!(benches, maps);
criterion_main!(benches);
