//! The Galerkin basis of the deflection, and the modes in which relaxing costs nothing.
//!
//! The deflection is expanded in `phi_n` with `phi_n'' = p_n` (orthonormal Legendre polynomials) and
//! the components on `1` and `x` removed, so that the constraints `int U = int x U = 0` hold exactly
//! and the bending matrix is the identity. From `int P_n = (P_{n+1}-P_{n-1})/(2n+1)`,
//!
//! ```text
//! phi_n = sum_{j>=2} F_nj p_j,        F = [ f02                      ]   rows n = 0, 2, 4, ... of one parity,
//!                                         [ f22 f24                  ]   columns j = 2, 4, 6, ...
//!                                         [ f42 f44 f46              ]
//!                                         [     f64 f66 f68          ]
//! f_{n,n+2} = f_{n+2,n} = 1/(4 (2n+3) sqrt((2n+1)(2n+5))),   f_{n,n} = -1/(2 (2n+3)(2n-1)).
//! ```
//!
//! The mass matrix is `M = F F^T`. Its small eigenvalues are the squares of the singular values of
//! `F`, which are computed from `F` itself: squaring first would lose half the digits.

use std::sync::OnceLock;

use faer::Mat;

/// `|t| = f02`, the norm of `(x^2/2)~`: `1/(12 sqrt 5)`.
pub const PARABOLA: f64 = 0.037_267_799_624_996_496;

fn off_diagonal(n: usize) -> f64 {
    let n = n as f64;
    0.25 / ((2.0 * n + 3.0) * ((2.0 * n + 1.0) * (2.0 * n + 5.0)).sqrt())
}

fn diagonal(n: usize) -> f64 {
    let n = n as f64;
    -0.5 / ((2.0 * n + 3.0) * (2.0 * n - 1.0))
}

/// The double integral of a Legendre series without its components on `1` and `x`: `F^T r`.
#[must_use]
pub fn double_integral(series: &[f64]) -> Vec<f64> {
    if series.is_empty() {
        return Vec::new();
    }
    let at = |n: usize| series.get(n).copied().unwrap_or(0.0);
    let component = |j: usize| match j {
        0 | 1 => 0.0,
        _ => off_diagonal(j - 2) * at(j - 2) + diagonal(j) * at(j) + off_diagonal(j) * at(j + 2),
    };
    (0..series.len() + 2).map(component).collect()
}

/// Singular value decomposition `F = Q diag(sigma) R^T` of the first `n` functions of one parity.
#[derive(Debug)]
pub struct Modes {
    /// Singular values, largest first.
    pub sigma: Vec<f64>,
    /// `R`: row `i` belongs to the Legendre degree `2i + 2 + parity`, column `j` to the mode.
    pub right: Mat<f64>,
    /// `Q`: row `i` belongs to the degree `2i + parity` of the curvature, column `j` to the mode.
    pub left: Mat<f64>,
}

impl Modes {
    /// Component in mode `j` of a Legendre series, of which it takes the degrees of its `parity`.
    #[must_use]
    pub fn component(&self, series: &[f64], parity: usize, j: usize) -> f64 {
        let of_parity = series.iter().skip(2 + parity).step_by(2).enumerate();
        of_parity.map(|(i, c)| self.right[(i, j)] * c).sum()
    }
}

/// Sizes of the truncations in use, functions of each parity.
pub const SIZES: [usize; 6] = [8, 16, 32, 64, 128, 256];

/// Modes of truncation `SIZES[level]`; `parity` 0 for even, 1 for odd. Computed once.
#[must_use]
pub fn modes(level: usize, parity: usize) -> &'static Modes {
    static TABLES: [[OnceLock<Modes>; 2]; SIZES.len()] =
        [const { [const { OnceLock::new() }; 2] }; SIZES.len()];
    TABLES[level][parity].get_or_init(|| decompose(SIZES[level], parity))
}

fn decompose(size: usize, parity: usize) -> Modes {
    let f = Mat::from_fn(size, size, |row, column| {
        let (n, j) = (2 * row + parity, 2 * column + 2 + parity);
        match j as isize - n as isize {
            2 => off_diagonal(n),
            0 => diagonal(n),
            -2 => off_diagonal(j),
            _ => 0.0,
        }
    });
    // F is finite and well scaled; the QR iteration of a matrix of fixed entries does not fail.
    let svd = f.svd().expect("singular values of a fixed finite matrix");
    Modes {
        sigma: svd.S().column_vector().iter().copied().collect(),
        right: svd.V().to_owned(),
        left: svd.U().to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::legendre;

    #[test]
    fn parabola_is_the_double_integral_of_one() {
        let t = double_integral(&[1.0]);
        assert_eq!(t.len(), 3);
        assert!((t[2] - PARABOLA).abs() < 1e-17);
        let x2 = legendre::from_monomials(&[0.0, 0.0, 0.5]);
        assert!((x2[2] - PARABOLA).abs() < 1e-17);
    }

    #[test]
    fn double_integral_inverts_second_derivative() {
        // U = x^5 - projection; U'' = 20 x^3.
        let mut u = legendre::from_monomials(&[0.0, 0.0, 0.0, 0.0, 0.0, 1.0]);
        u[0] = 0.0;
        u[1] = 0.0;
        let from_curvature = double_integral(&legendre::from_monomials(&[0.0, 0.0, 0.0, 20.0]));
        for (a, b) in u.iter().zip(&from_curvature) {
            assert!((a - b).abs() < 1e-17);
        }
    }

    #[test]
    fn decomposition_reproduces_the_matrix() {
        for parity in 0..2 {
            let m = modes(1, parity);
            for row in 0..SIZES[1] {
                let n = 2 * row + parity;
                let mut unit = vec![0.0; n + 1];
                unit[n] = 1.0;
                let phi = double_integral(&unit);
                for column in 0..SIZES[1] {
                    let sum: f64 =
                        (0..SIZES[1]).map(|k| m.left[(row, k)] * m.sigma[k] * m.right[(column, k)]).sum();
                    let exact = phi.get(2 * column + 2 + parity).copied().unwrap_or(0.0);
                    assert!((sum - exact).abs() < 1e-16);
                }
            }
        }
    }
}
