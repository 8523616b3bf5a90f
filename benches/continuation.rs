//! Run times of whole diagrams through the boundary-value solver, on four scenes; `cargo bench --bench continuation`.

use criterion::{Criterion, criterion_group, criterion_main};

mod diagrams;

fn all(c: &mut Criterion) {
    for scene in diagrams::SCENES {
        let state = scene.state();
        c.bench_function(scene.name, |b| b.iter(|| scene.follow(&state)));
    }
}

criterion_group!(benches, all);
criterion_main!(benches);
