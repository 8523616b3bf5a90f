//! The Jacobian against differences, and the chain against faer.

use std::sync::Arc;

use super::*;
use crate::boundary::ends::Hold;
use crate::boundary::iterate::at_rest;
use crate::boundary::law::Law;
use crate::boundary::problem::{LineLoad, PointLoad, Problem};
use crate::growth::Growth;
use crate::section::{Amplitude, RibbonLaw, RibbonSpec};
use nalgebra::Quaternion;

/// Reproducible numbers in [-1, 1].
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    fn vector(&mut self, size: f64) -> Vector {
        Vector::from_fn(|_, _| size * self.next())
    }

    fn rotation(&mut self) -> Quaternion<f64> {
        // Near the identity, so that none is a half turn from another.
        let random = Quaternion::new(self.next(), self.next(), self.next(), self.next()).normalize();
        (random * 0.2 + Quaternion::new(1.0, 0.0, 0.0, 0.0)).normalize()
    }
}

/// A problem with every kind of load and these ends.
fn problem(holds: [Hold; 2], force: bool, numbers: &mut Numbers) -> Problem {
    let growth = Growth::edge(0.06) + Growth::chiral(0.04);
    let law = RibbonLaw::new(RibbonSpec::uniform(0.1, growth));
    let ends = holds.map(|hold| End {
        hold,
        position: numbers.vector(1.0),
        rotation: numbers.rotation(),
        turns: 0.3,
        force: numbers.vector(1e-4),
        moment: numbers.vector(1e-4),
    });
    let mut load = |size: f64| {
        std::array::from_fn(|_| Amplitude::Constant(if size > 0.0 { size * numbers.next() } else { 0.0 }))
    };
    let line = LineLoad { force: load(if force { 1e-4 } else { 0.0 }), moment: load(1e-4) };
    let points =
        [2.0, 2.0, 5.0].map(|s| PointLoad { s, force: numbers.vector(1e-4), moment: numbers.vector(1e-4) });
    Problem::new(Law::Relaxed(law.unwrap()), 7.0, ends, points.to_vec(), line).unwrap()
}

fn iterate(mesh: &Mesh, numbers: &mut Numbers) -> Iterate {
    let mut node = |&s: &f64| {
        let mut at = at_rest(Vector::new(0.0, 0.0, s) + numbers.vector(0.2), numbers.rotation());
        (at.force, at.about_origin) = (numbers.vector(1e-3), numbers.vector(1e-3));
        at
    };
    let nodes = mesh.nodes.iter().map(&mut node).collect();
    let strains = (0..mesh.stages()).map(|_| Strain::from_fn(|_, _| 0.1 * numbers.next())).collect();
    Iterate { nodes, strains, slack: Default::default() }
}

/// Every residual, none multiplied by a matrix that changes: of rotations the vector part of the quaternion.
fn all(residual: &Residual, holds: [Hold; 2]) -> Vec<f64> {
    let sine = |half: [f64; 3]| {
        let half = Vector::from(half);
        (half / (1.0 + 0.25 * half.norm_squared()).sqrt()).data.0[0]
    };
    let strains = residual.strains.iter().flat_map(|e| e.map(|x| -x).data.0[0]);
    let gaps = residual.gaps.iter().flat_map(|gap| {
        let mut gap = *gap;
        let turn = sine([gap[3], gap[4], gap[5]]);
        gap[3..6].copy_from_slice(&turn);
        gap
    });
    let ends = holds.iter().zip([residual.start, residual.end]).flat_map(|(hold, mut end)| {
        let first = match hold {
            Hold::Clamped => 3,
            Hold::Sliding(_) => 2,
            _ => return end,
        };
        let turn = sine([end[first], end[first + 1], end[first + 2]]);
        end[first..first + 3].copy_from_slice(&turn);
        end
    });
    strains.chain(gaps).chain(ends).collect()
}

/// The chain and faer's sparse LU give the same corrections.
#[test]
fn the_sparse_matrix_gives_the_same() {
    let mut numbers = Numbers(7);
    for (holds, force, layout) in [
        ([Hold::Clamped, Hold::Free], false, Layout::Constant),
        ([Hold::Hinged(0), Hold::Clamped], false, Layout::Constant),
        ([Hold::Clamped, Hold::Clamped], true, Layout::Moment),
        ([Hold::Pinned, Hold::Sliding(Vector::z())], false, Layout::Full),
    ] {
        let problem = Arc::new(problem(holds, force, &mut numbers));
        let nodes = vec![0.0, 1.0, 2.0, 3.5, 5.0, 7.0];
        let mesh = Mesh::new(&problem, nodes, 3).unwrap();
        let mut system = System::with_layout(mesh.clone(), layout).unwrap();
        let mut x = iterate(&mesh, &mut numbers);
        let ends = [0, 1].map(|i| problem.goal(&problem.ends[i]));
        let targets = Targets { ends, load: 0.7, offset: Vec::new(), drag: 0.0 };
        system.settle(&mut x, targets.load);
        system.linearise(&x, &targets).unwrap();
        let by_chain = system.correction();
        system.linearise_sparsely(&x, &targets).unwrap();
        let by_faer = system.correction();
        let size = by_chain.norm(&mesh);
        for (a, b) in by_chain.nodes.iter().flatten().zip(by_faer.nodes.iter().flatten()) {
            // The condition of random states times rounding.
            assert!((a - b).abs() < 1e-9 * size, "{holds:?} {layout:?}: {a} {b}");
        }
        for (a, b) in by_chain.strains.iter().zip(&by_faer.strains) {
            assert!((a - b).amax() < 1e-9 * size, "{holds:?} {layout:?}");
        }
    }
}

/// Along the Newton correction the residual changes by minus itself.
#[test]
fn the_jacobian_is_exact() {
    let mut numbers = Numbers(1);
    let sliding = Hold::Sliding(Vector::new(0.6, 0.0, 0.8));
    for (holds, force, layouts) in [
        ([Hold::Clamped, Hold::Free], false, vec![Layout::Constant, Layout::Moment]),
        ([Hold::Free, Hold::Hinged(1)], true, vec![Layout::Moment]),
        ([Hold::Pinned, sliding], true, vec![Layout::Moment]),
        ([Hold::Hinged(0), Hold::Clamped], false, vec![Layout::Constant, Layout::Moment]),
    ] {
        let problem = Arc::new(problem(holds, force, &mut numbers));
        for layout in layouts {
            for degree in [1, 2, 4] {
                let nodes = vec![0.0, 1.0, 2.0, 3.5, 5.0, 7.0];
                let mesh = Mesh::new(&problem, nodes, degree).unwrap();
                let mut system = System::with_layout(mesh.clone(), layout).unwrap();
                let mut x = iterate(&mesh, &mut numbers);
                let targets = Targets {
                    ends: [0, 1].map(|i| problem.goal(&problem.ends[i])),
                    load: 0.7,
                    offset: vec![Strain::repeat(0.01); mesh.stages()],
                    drag: 0.3,
                };
                system.settle(&mut x, targets.load);
                system.linearise(&x, &targets).unwrap();
                let (here, correction) = (all(&system.residual, holds), system.correction());
                let mut at = |fraction: f64| {
                    let mut moved = x.moved(&correction, fraction, &system.units);
                    system.settle(&mut moved, targets.load);
                    system.evaluate(&moved, &targets).unwrap();
                    all(&system.residual, holds)
                };
                let step = 1e-5 / correction.norm(&mesh);
                let (ahead, behind) = (at(step), at(-step));
                let size = here.iter().fold(0.0, |m: f64, f| m.max(f.abs()));
                for ((f, a), b) in here.iter().zip(&ahead).zip(&behind) {
                    let slope = (a - b) / (2.0 * step);
                    // Central differences: of the order of the step squared and of rounding over the step.
                    assert!((slope + f).abs() < 1e-6 * size, "{holds:?} {layout:?} {degree}: {slope} {f}");
                }
            }
        }
    }
}

#[test]
fn ends_that_move_change_their_conditions_alone() {
    let mut numbers = Numbers(5);
    for holds in [[Hold::Clamped, Hold::Pinned], [Hold::Free, Hold::Clamped]] {
        let problem = Arc::new(problem(holds, true, &mut numbers));
        let nodes = vec![0.0, 2.0, 3.5, 5.0, 7.0];
        let mut system = System::new(Mesh::new(&problem, nodes, 3).unwrap()).unwrap();
        let x = iterate(&system.mesh, &mut numbers);
        let mut targets = Targets { ends: problem.ends, load: 1.0, offset: Vec::new(), drag: 0.0 };
        system.evaluate(&x, &targets).unwrap();
        let (before, from) = (system.residual.clone(), targets.ends);
        for end in &mut targets.ends {
            end.position += numbers.vector(0.1);
            end.rotation = numbers.rotation();
            (end.force, end.moment) = (numbers.vector(1e-4), numbers.vector(1e-4));
        }
        system.evaluate(&x, &targets).unwrap();
        let found = system.by_ends(&x, [&from, &targets.ends], 0.5);
        system.residual.subtract(&before, 0.5);
        assert_eq!((&found.start, &found.end), (&system.residual.start, &system.residual.end));
        assert_eq!((&found.strains, &found.gaps), (&system.residual.strains, &system.residual.gaps));
        assert!(found.start.iter().chain(&found.end).any(|x| x.abs() > 1e-3));
    }
}
