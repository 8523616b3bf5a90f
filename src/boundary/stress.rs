//! Wrenches that move nothing.
//!
//! What is rigid bears any moment, and between ends that hold it nothing tells which: an unloaded rod that does not bend
//! about `d1` may be held by opposite couples about that. Of all such states the one with the least sum of squares of
//! force and moment is meant, the limit of what is ever stiffer.

use nalgebra::Vector3;

use super::ends::{At, Units};
use super::iterate::{Correction, Iterate};

type Vector = Vector3<f64>;

/// Force and moment about the node itself at each node, in units.
type Wrenches = Vec<[Vector; 2]>;

/// Part of a self-stress beside the others that is nothing.
const NOTHING: f64 = 1e-10;

/// Self-stresses at a state, orthonormal: changes of force and of moment about the origin, and as wrenches.
pub struct SelfStress {
    basis: Vec<(Vec<[Vector; 2]>, Wrenches)>,
    units: Units,
}

impl SelfStress {
    /// Those that these changes span.
    #[must_use]
    pub fn new(nodes: &[At], changes: &[Correction], units: Units) -> Self {
        let mut basis: Vec<(Vec<[Vector; 2]>, Wrenches)> = Vec::new();
        for change in changes {
            let mut change: Vec<[Vector; 2]> = change.nodes.iter().map(parts).collect();
            let mut own: Wrenches =
                nodes.iter().zip(&change).map(|(at, [n, c])| about(at, n, c, &units)).collect();
            let whole = product(&own, &own);
            // Twice, for they may be nearly parallel.
            for (other, wrenches) in basis.iter().chain(&basis) {
                let part = product(&own, wrenches);
                subtract(&mut change, part, other);
                subtract(&mut own, part, wrenches);
            }
            let square = product(&own, &own);
            if square > NOTHING * NOTHING * whole {
                let size = square.sqrt();
                change.iter_mut().chain(&mut own).flatten().for_each(|x| *x /= size);
                basis.push((change, own));
            }
        }
        Self { basis, units }
    }

    /// The state without them.
    #[must_use]
    pub fn relieved(&self, mut x: Iterate) -> Iterate {
        let Units { force, moment, .. } = self.units;
        for (change, wrenches) in &self.basis {
            let own = |at: &At| about(at, &(at.force / force), &(at.about_origin / moment), &self.units);
            let here: Wrenches = x.nodes.iter().map(own).collect();
            let part = product(&here, wrenches);
            for (at, [n, c]) in x.nodes.iter_mut().zip(change) {
                at.force -= part * force * n;
                at.about_origin -= part * moment * c;
            }
        }
        x
    }

    /// The change of a state without them.
    #[must_use]
    pub fn relieved_change(&self, nodes: &[At], mut x: Correction) -> Correction {
        let Units { length, force, moment } = self.units;
        for (change, wrenches) in &self.basis {
            let own = |(at, node): (&At, &[f64; 12])| {
                let [n, c] = parts(node);
                let [n, m] = about(at, &n, &c, &self.units);
                // The node itself moves.
                let moved = Vector::from_column_slice(&node[..3]) * (length * force / moment);
                [n, m - moved.cross(&(at.force / force))]
            };
            let here: Wrenches = nodes.iter().zip(&x.nodes).map(own).collect();
            let part = product(&here, wrenches);
            for (node, [n, c]) in x.nodes.iter_mut().zip(change) {
                for k in 0..3 {
                    node[6 + k] -= part * n[k];
                    node[9 + k] -= part * c[k];
                }
            }
        }
        x
    }
}

/// Changes of force and of moment about the origin.
fn parts(node: &[f64; 12]) -> [Vector; 2] {
    [Vector::from_column_slice(&node[6..9]), Vector::from_column_slice(&node[9..])]
}

/// Force, and moment about the node.
fn about(at: &At, force: &Vector, about_origin: &Vector, units: &Units) -> [Vector; 2] {
    [*force, about_origin - (at.position * (units.force / units.moment)).cross(force)]
}

fn product(a: &[[Vector; 2]], b: &[[Vector; 2]]) -> f64 {
    a.iter().flatten().zip(b.iter().flatten()).map(|(a, b)| a.dot(b)).sum()
}

fn subtract(a: &mut [[Vector; 2]], part: f64, b: &[[Vector; 2]]) {
    a.iter_mut().flatten().zip(b.iter().flatten()).for_each(|(a, b)| *a -= part * b);
}
