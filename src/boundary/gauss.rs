//! Gauss collocation on one element.

use std::sync::OnceLock;

use crate::legendre;

/// The highest degree: the number of stages of an element.
pub const MAX_DEGREE: usize = 8;

/// The Runge-Kutta coefficients of Gauss collocation with `degree` stages on `[0, 1]`.
///
/// Of order `2 degree` at the ends of the elements and `degree + 1` between; it conserves quadratic invariants,
/// `b_i a_ij + b_j a_ji = b_i b_j` (Hairer, Lubich & Wanner, *Geometric numerical integration*, IV.2).
#[derive(Clone, Debug)]
pub struct Gauss {
    /// Number of stages.
    pub degree: usize,
    /// Where the stages are, in (0, 1).
    pub nodes: Vec<f64>,
    /// `b_j`: weights of the integral over the element.
    pub weights: Vec<f64>,
    /// `a[j][k]`: weights of the integral from 0 to node `j`.
    pub integral: [[f64; MAX_DEGREE]; MAX_DEGREE],
    /// `derivative[j][k]`: weights of the values at 0 (`k = 0`) and at the nodes (`k - 1`) in the derivative, at node `j`,
    /// of the polynomial of degree `degree` through them.
    pub derivative: Vec<Vec<f64>>,
    barycentric: Vec<f64>,
}

impl Gauss {
    /// The coefficients for a degree from 1 to [`MAX_DEGREE`], computed once.
    ///
    /// # Panics
    /// If the degree is out of range.
    #[must_use]
    pub fn of(degree: usize) -> &'static Self {
        static ALL: [OnceLock<Gauss>; MAX_DEGREE] = [const { OnceLock::new() }; MAX_DEGREE];
        ALL[degree - 1].get_or_init(|| Self::new(degree))
    }

    fn new(degree: usize) -> Self {
        let (centred, weights) = legendre::rule(degree);
        let mut order: Vec<usize> = (0..degree).collect();
        order.sort_by(|&i, &j| centred[i].total_cmp(&centred[j]));
        let nodes: Vec<f64> = order.iter().map(|&i| 0.5 + centred[i]).collect();
        let weights: Vec<f64> = order.iter().map(|&i| weights[i]).collect();
        let mut gauss = Self {
            degree,
            barycentric: barycentric(&nodes),
            derivative: derivative(&nodes),
            nodes,
            weights,
            integral: [[0.0; MAX_DEGREE]; MAX_DEGREE],
        };
        // The rule itself integrates the basis from 0 to each node exactly.
        for (j, &end) in gauss.nodes.iter().enumerate() {
            for (&x, &weight) in gauss.nodes.iter().zip(&gauss.weights) {
                let basis = gauss.basis(end * x);
                for (a, l) in gauss.integral[j].iter_mut().zip(basis) {
                    *a += end * weight * l;
                }
            }
        }
        gauss
    }

    /// The Lagrange basis of the nodes at `x`: weights of values at the nodes, padded by zeros.
    #[must_use]
    pub fn basis(&self, x: f64) -> [f64; MAX_DEGREE] {
        let mut basis = [0.0; MAX_DEGREE];
        if let Some(node) = self.nodes.iter().position(|&node| node == x) {
            basis[node] = 1.0;
            return basis;
        }
        let mut sum = 0.0;
        for (l, (&node, &weight)) in basis.iter_mut().zip(self.nodes.iter().zip(&self.barycentric)) {
            *l = weight / (x - node);
            sum += *l;
        }
        basis.iter_mut().for_each(|l| *l /= sum);
        basis
    }
}

fn barycentric(nodes: &[f64]) -> Vec<f64> {
    let weight = |&x: &f64| 1.0 / nodes.iter().filter(|&&y| y != x).map(|&y| x - y).product::<f64>();
    nodes.iter().map(weight).collect()
}

/// Differentiation of the polynomial through 0 and the nodes (Berrut & Trefethen 2004, eq. (9.4)).
fn derivative(nodes: &[f64]) -> Vec<Vec<f64>> {
    let points: Vec<f64> = std::iter::once(0.0).chain(nodes.iter().copied()).collect();
    let weights = barycentric(&points);
    let row = |j: usize| {
        let mut row: Vec<f64> = (0..points.len())
            .map(|k| if k == j { 0.0 } else { weights[k] / weights[j] / (points[j] - points[k]) })
            .collect();
        row[j] = -row.iter().sum::<f64>();
        row
    };
    (1..points.len()).map(row).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_stages_are_the_known_ones() {
        let gauss = Gauss::of(2);
        let offset = 3f64.sqrt() / 6.0;
        let expected = [[0.25, 0.25 - offset], [0.25 + offset, 0.25]];
        for (j, row) in expected.iter().enumerate() {
            assert!((gauss.nodes[j] - row[0] - row[1]).abs() < 1e-16);
            for (k, a) in row.iter().enumerate() {
                assert!((gauss.integral[j][k] - a).abs() < 2e-16);
            }
        }
    }

    #[test]
    fn monomials_are_integrated_and_differentiated() {
        for degree in 1..=MAX_DEGREE {
            let gauss = Gauss::of(degree);
            for power in 0..degree as i32 {
                let values: Vec<f64> = gauss.nodes.iter().map(|x| x.powi(power)).collect();
                for (j, x) in gauss.nodes.iter().enumerate() {
                    let sum: f64 = gauss.integral[j].iter().zip(&values).map(|(a, v)| a * v).sum();
                    assert!((sum - x.powi(power + 1) / f64::from(power + 1)).abs() < 4e-16, "{degree}");
                    let slope: f64 = gauss.derivative[j][1..]
                        .iter()
                        .zip(&gauss.nodes)
                        .map(|(d, y)| d * y.powi(power + 1))
                        .sum();
                    // The weights grow like the square of the degree.
                    assert!((slope - f64::from(power + 1) * x.powi(power)).abs() < 1e-13, "{degree}");
                }
            }
        }
    }

    #[test]
    fn quadratic_invariants_are_conserved() {
        for degree in 1..=MAX_DEGREE {
            let Gauss { weights: b, integral: a, .. } = Gauss::of(degree);
            for i in 0..degree {
                for j in 0..degree {
                    let lost = b[i] * a[i][j] + b[j] * a[j][i] - b[i] * b[j];
                    assert!(lost.abs() < 2e-16, "{degree}: {lost}");
                }
            }
        }
    }
}
