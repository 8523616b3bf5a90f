//! What a Newton iteration of the boundary-value solver costs: time, operations and memory, as tables.
//!
//! `cargo bench --bench boundary_cost`. Medians of several runs on one thread; operations are counted from the algorithm,
//! not measured. The scene is a ribbon with grown edges, clamped half a turn apart and shortened.

use std::hint::black_box;
use std::sync::Arc;
use std::time::Instant;

use nalgebra::{DMatrix, Vector3};
use ribbonrs::boundary::{End, Hold, Known, Law, Layout, LineLoad, Mesh, Path, Problem, System, Targets};
use ribbonrs::growth::Growth;
use ribbonrs::section::{RibbonLaw, RibbonSpec};

fn problem() -> Arc<Problem> {
    let law = RibbonLaw::new(RibbonSpec::uniform(0.1, Growth::edge(0.02))).expect("a law for this growth");
    let far = End { position: Vector3::new(0.0, 0.0, 9.0), turns: 0.5, ..End::new(Hold::Clamped) };
    let (ends, line) = ([End::new(Hold::Clamped), far], LineLoad::uniform([0.0; 3]));
    Arc::new(Problem::new(Law::Relaxed(law), 10.0, ends, vec![], line).expect("a problem"))
}

/// Median of the seconds that `run` takes.
fn median(repeats: usize, mut run: impl FnMut()) -> f64 {
    let mut times: Vec<f64> = (0..repeats)
        .map(|_| {
            let start = Instant::now();
            run();
            start.elapsed().as_secs_f64()
        })
        .collect();
    times.sort_by(f64::total_cmp);
    times[repeats / 2]
}

/// Seconds of a linearisation and a correction.
fn iteration(problem: &Arc<Problem>, elements: usize, degree: usize, layout: Layout, repeats: usize) -> f64 {
    let nodes = (0..=elements).map(|i| 10.0 * i as f64 / elements as f64).collect();
    let mesh = Mesh::new(problem, nodes, degree).expect("a mesh");
    let path = Path::new(&mesh, &Known::Straight(1.0)).expect("a shape");
    let targets: Targets = path.targets(problem, 0.5);
    let mut system = System::with_layout(mesh.clone(), layout).expect("a system");
    median(repeats, || {
        system.linearise(&path.x, &targets).expect("a regular matrix");
        black_box(system.correction());
    })
}

/// Additions and multiplications of an iteration, an element: leading terms of `element.rs` and `chain.rs`.
fn operations(degree: usize, states: usize) -> f64 {
    let s = degree as f64;
    // Inverse over the quaternions, propagators, and what moves with them.
    let kinematics = 32.0 * s.powi(3) + 8.0 * s.powi(3) + 18.0 * s.powi(3) + 200.0 * s * s;
    // Rows of the law: moments of the shifts, on the directors.
    let law = 150.0 * s * s + 300.0 * s;
    let elimination = 2.0 / 3.0 * (4.0 * s).powi(3) + 2.0 * (4.0 * s).powi(2) * 6.0 + 2.0 * 36.0 * 4.0 * s;
    // A quaternion has three unknowns; six rows are carried.
    let (n, m) = (states as f64 - 1.0, 13.0 - states as f64);
    let mut chain = 0.0;
    for k in 0..states - 1 {
        let (rows, columns) = (n + 5.0 - k as f64, 2.0 * n + m - k as f64);
        chain += 2.0 * rows * columns;
    }
    let solves = 4.0 * (4.0 * s).powi(2) + 2.0 * n * (2.0 * n + m + 6.0);
    kinematics + law + elimination + chain + solves
}

/// Operations a second of a factorisation of a dense matrix as large as the stages' of an element.
fn dense_rate(size: usize) -> f64 {
    let matrix =
        DMatrix::from_fn(size, size, |i, j| if i == j { 4.0 } else { 1.0 / (1.0 + (i + 2 * j) as f64) });
    let seconds = median(200, || {
        black_box(black_box(matrix.clone()).lu());
    });
    2.0 / 3.0 * (size as f64).powi(3) / seconds
}

/// Resident memory of the process in bytes, where the system tells.
fn resident() -> Option<f64> {
    let pages = std::fs::read_to_string("/proc/self/statm").ok()?;
    Some(4096.0 * pages.split_whitespace().nth(1)?.parse::<f64>().ok()?)
}

fn main() {
    let problem = problem();
    println!("| degree | states | us/element | us/stage | operations/element | Gflop/s | of dense LU |");
    println!("|---|---|---|---|---|---|---|");
    for degree in 2..=8 {
        let dense = dense_rate(4 * degree);
        for (states, layout) in [(7, Layout::Constant), (10, Layout::Moment), (13, Layout::Full)] {
            let seconds = iteration(&problem, 100, degree, layout, 31) / 100.0;
            let operations = operations(degree, states);
            let rate = operations / seconds;
            println!(
                "| {degree} | {states} | {:.2} | {:.2} | {:.0} | {:.2} | {:.0} % |",
                1e6 * seconds,
                1e6 * seconds / degree as f64,
                operations,
                1e-9 * rate,
                100.0 * rate / dense
            );
        }
    }
    println!("\n| elements | us/element | bytes/stage |\n|---|---|---|");
    let (mut logs, mut bytes) = (Vec::new(), 0.0);
    for elements in [10, 100, 1000, 10_000, 100_000] {
        let before = resident();
        let seconds =
            iteration(&problem, elements, 5, Layout::Constant, if elements < 10_000 { 31 } else { 5 });
        // What the largest mesh adds; small ones live in memory that is already there.
        if let (Some(before), Some(after)) = (before, resident()) {
            bytes = (after - before).max(bytes);
        }
        println!(
            "| {elements} | {:.2} | {:.0} |",
            1e6 * seconds / elements as f64,
            bytes / (5 * elements) as f64
        );
        logs.push(((elements as f64).ln(), seconds.ln()));
    }
    let mean = |f: &dyn Fn(&(f64, f64)) -> f64| logs.iter().map(f).sum::<f64>() / logs.len() as f64;
    let (x, y) = (mean(&|p| p.0), mean(&|p| p.1));
    let exponent = mean(&|p| (p.0 - x) * (p.1 - y)) / mean(&|p| (p.0 - x).powi(2));
    println!("\ntime grows with the number of elements to the power {exponent:.3}");
}
