//! Frame integration along a ribbon of 10,000 segments.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use ribbonrs::frame::{Pose, helix, integrate_gauss, integrate_nodal, integrate_segments};
use ribbonrs::section::Strain;

fn frame(c: &mut Criterion) {
    let n = 10_000;
    let s: Vec<f64> = (0..=n).map(|i| 10.0 * f64::from(i) / f64::from(n)).collect();
    let strains: Vec<Strain> = s.iter().map(|s| Strain::new(0.0, 0.1, s.cos(), 0.3)).collect();
    let at_points: Vec<[Strain; 3]> = strains[1..].iter().map(|&strain| [strain; 3]).collect();
    let start = Pose::new([0.0; 3], [1.0, 0.0, 0.0, 0.0]);
    let mut group = c.benchmark_group("frame, 10,000 segments");
    group.bench_function("helix", |b| b.iter(|| helix(black_box(&s), &strains[0], &start)));
    group.bench_function("piecewise constant", |b| {
        b.iter(|| integrate_segments(black_box(&s), &strains[1..], &start));
    });
    group.bench_function("nodal, order 4", |b| b.iter(|| integrate_nodal(black_box(&s), &strains, &start)));
    group.bench_function("Gauss points, order 6", |b| {
        b.iter(|| integrate_gauss(black_box(&s), &at_points, &start));
    });
    group.finish();
}

criterion_group!(benches, frame);
criterion_main!(benches);
