//! Dense output: the states inside an element, from those at a few places of it.
//!
//! A step from the node gives the state at one place as accurately as those at the nodes, for the price of an iteration of the
//! element. Where many are asked for, steps to the Gauss nodes `x_j` on `[0, 1]` are enough. With `l_j` their Lagrange polynomials
//! and `P_s` that of Legendre
//!
//! ```text
//! y(x) = P_s(2x-1)^2 ((1-x) y_0 + x y_1) + sum_j l_j(x)^2 x (1-x) / (x_j (1-x_j)) (y_j + (x-x_j) y_j')
//! ```
//!
//! is the polynomial of degree `2s + 1` with these values and slopes. Its error is one order beyond that of a step; the weights of
//! values are positive and sum to one, so that no error is amplified (Egerváry & Turán 1958, Acta Math. Acad. Sci. Hung. 9, 259).

use nalgebra::{Quaternion, Vector3};

use super::ends::{At, directors};
use super::gauss::{Gauss, MAX_DEGREE};
use crate::section::Strain;

/// Position, rotation, force, and moment about the origin.
type Row = [f64; 13];

/// A state inside an element, its strains, and the distributed force and couple there.
pub type Known = (At, Strain, (Vector3<f64>, Vector3<f64>));

/// The states inside an element.
#[derive(Clone, Debug)]
pub struct Inside {
    gauss: &'static Gauss,
    ends: [Row; 2],
    values: [Row; MAX_DEGREE],
    slopes: [Row; MAX_DEGREE],
}

fn row(position: Vector3<f64>, q: Quaternion<f64>, force: Vector3<f64>, moment: Vector3<f64>) -> Row {
    let mut row = [0.0; 13];
    row[..3].copy_from_slice(position.as_slice());
    row[3..7].copy_from_slice(&[q.w, q.i, q.j, q.k]);
    row[7..10].copy_from_slice(force.as_slice());
    row[10..].copy_from_slice(moment.as_slice());
    row
}

fn of(at: &At) -> Row {
    row(at.position, at.rotation, at.force, at.about_origin)
}

/// Change along the ribbon, under distributed force and couple.
fn slope(at: &At, strain: &Strain, (p, c): (Vector3<f64>, Vector3<f64>)) -> Row {
    let d3 = directors(&at.rotation).column(2).into_owned();
    let turning = at.rotation * Quaternion::new(0.0, strain[1], strain[2], strain[3]) * 0.5;
    row((1.0 + strain[0]) * d3, turning, -p, -(at.position.cross(&p) + c))
}

impl Inside {
    /// From the states at both ends, and what is known at the Gauss nodes; `length` is that of the element.
    #[must_use]
    pub fn new(gauss: &'static Gauss, ends: [&At; 2], length: f64, at_nodes: &[Known]) -> Self {
        let (mut values, mut slopes) = ([[0.0; 13]; MAX_DEGREE], [[0.0; 13]; MAX_DEGREE]);
        for (j, (at, strain, load)) in at_nodes.iter().enumerate() {
            values[j] = of(at);
            slopes[j] = slope(at, strain, *load).map(|x| length * x);
        }
        Self { gauss, ends: ends.map(of), values, slopes }
    }

    /// The state a part `x` of the way.
    #[must_use]
    pub fn at(&self, x: f64) -> At {
        let (mut y, mut left) = ([0.0; 13], 1.0);
        let basis = self.gauss.basis(x);
        for (j, &node) in self.gauss.nodes.iter().enumerate() {
            let weight = basis[j] * basis[j] * (x * (1.0 - x)) / (node * (1.0 - node));
            left -= weight;
            for (i, y) in y.iter_mut().enumerate() {
                *y += weight * (self.values[j][i] + (x - node) * self.slopes[j][i]);
            }
        }
        // The square of Legendre's polynomial.
        for (i, y) in y.iter_mut().enumerate() {
            *y += left * ((1.0 - x) * self.ends[0][i] + x * self.ends[1][i]);
        }
        let vector = |i: usize| Vector3::new(y[i], y[i + 1], y[i + 2]);
        let rotation = Quaternion::new(y[3], y[4], y[5], y[6]);
        At {
            position: vector(0),
            rotation: rotation * (1.0 / rotation.norm()),
            force: vector(7),
            about_origin: vector(10),
        }
    }

    /// Where the error is largest, or nearly: in the middle between two nodes.
    #[must_use]
    pub fn farthest(&self) -> f64 {
        let nodes = &self.gauss.nodes;
        let middle = (nodes.len() - 1) / 2;
        0.5 * (nodes[middle] + nodes.get(middle + 1).unwrap_or(&1.0))
    }

    /// By how much the state at `x` misses a known one: position over the length of the ribbon, angle, and force and moment about the
    /// origin over the largest.
    #[must_use]
    pub fn misses(&self, known: &At, x: f64, length: f64) -> f64 {
        let at = self.at(x);
        let of_largest = |misses: Vector3<f64>, part: std::ops::Range<usize>| {
            let largest =
                self.ends.iter().flat_map(|end| &end[part.clone()]).fold(0.0_f64, |m, x| m.max(x.abs()));
            if largest > 0.0 { misses.amax() / largest } else { misses.amax() }
        };
        let angle = 2.0 * (at.rotation - known.rotation).norm();
        ((at.position - known.position).amax() / length)
            .max(angle)
            .max(of_largest(at.force - known.force, 7..10))
            .max(of_largest(at.about_origin - known.about_origin, 10..13))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A straight ribbon, stretched as a polynomial of degree `2 s + 1`, from `s = 1` over a length of 3; it is that, to rounding.
    #[test]
    fn polynomials_are_exact() {
        for degree in 1..=MAX_DEGREE {
            let gauss = Gauss::of(degree);
            let power = 2 * degree as i32 + 1;
            let at = |x: f64| At {
                position: Vector3::new(0.0, 0.0, x.powi(power)),
                rotation: Quaternion::new(1.0, 0.0, 0.0, 0.0),
                force: Vector3::new(0.5 - x, 0.0, 0.0),
                about_origin: Vector3::zeros(),
            };
            let at_nodes: Vec<_> = gauss
                .nodes
                .iter()
                .map(|&x| {
                    let strain = Strain::new(f64::from(power) * x.powi(power - 1) / 3.0 - 1.0, 0.0, 0.0, 0.0);
                    (at(x), strain, (Vector3::new(1.0 / 3.0, 0.0, 0.0), Vector3::zeros()))
                })
                .collect();
            let inside = Inside::new(gauss, [&at(0.0), &at(1.0)], 3.0, &at_nodes);
            for i in 0..=20 {
                let x = f64::from(i) / 20.0;
                let (there, exact) = (inside.at(x), at(x));
                assert!((there.position - exact.position).amax() < 4e-15);
                assert!((there.force - exact.force).amax() < 4e-15);
                assert!((there.rotation - exact.rotation).norm() < 4e-15);
            }
        }
    }
}
