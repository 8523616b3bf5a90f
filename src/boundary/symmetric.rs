//! Small symmetric matrices, of either sign: `P A P^T = L D L^T` with complete pivoting (Bunch & Parlett 1971).

#![expect(clippy::needless_range_loop, reason = "indices of rows and columns")]

use nalgebra::{SMatrix, SVector};

/// The factors of a symmetric matrix.
pub struct Symmetric<const N: usize> {
    /// `L` below the diagonal, `D` on and beside it.
    factors: [[f64; N]; N],
    order: [usize; N],
    /// Whether a pivot of two rows begins at a row.
    paired: [bool; N],
}

/// `(1 + sqrt(17))/8`, which bounds the growth of the factors.
const ALPHA: f64 = 0.640_388_203_202_208_4;

impl<const N: usize> Symmetric<N> {
    /// Factorises; `None` where a number is not finite.
    #[must_use]
    pub fn new(matrix: &SMatrix<f64, N, N>) -> Option<Self> {
        if !matrix.iter().all(|x| x.is_finite()) {
            return None;
        }
        let mut a: [[f64; N]; N] = std::array::from_fn(|i| std::array::from_fn(|k| matrix[(i, k)]));
        let (mut order, mut paired) = (std::array::from_fn(|i| i), [false; N]);
        let mut k = 0;
        while k < N {
            let (mut on, mut off) = ((0.0, k), (0.0, k, k));
            for i in k..N {
                if a[i][i].abs() > on.0 {
                    on = (a[i][i].abs(), i);
                }
                for j in k..i {
                    if a[i][j].abs() > off.0 {
                        off = (a[i][j].abs(), i, j);
                    }
                }
            }
            if on.0 >= ALPHA * off.0 {
                exchange(&mut a, &mut order, k, on.1);
                if a[k][k] == 0.0 {
                    break;
                }
                for i in k + 1..N {
                    let factor = a[i][k] / a[k][k];
                    for j in k + 1..N {
                        a[i][j] -= factor * a[k][j];
                    }
                    a[i][k] = factor;
                }
                k += 1;
            } else {
                exchange(&mut a, &mut order, k, off.2);
                exchange(&mut a, &mut order, k + 1, off.1);
                paired[k] = true;
                let (d, b, e) = (a[k][k], a[k + 1][k], a[k + 1][k + 1]);
                let determinant = d * e - b * b;
                for i in k + 2..N {
                    let (x, y) = (a[i][k], a[i][k + 1]);
                    let factors = [(e * x - b * y) / determinant, (d * y - b * x) / determinant];
                    for j in k + 2..N {
                        a[i][j] -= factors[0] * a[k][j] + factors[1] * a[k + 1][j];
                    }
                    (a[i][k], a[i][k + 1]) = (factors[0], factors[1]);
                }
                k += 2;
            }
        }
        Some(Self { factors: a, order, paired })
    }

    /// Number of eigenvalues of `D` below minus the tolerance: by Sylvester's law those of the matrix, if it is 0.
    #[must_use]
    pub fn negative(&self, tolerance: f64) -> usize {
        let mut count = 0;
        let mut k = 0;
        while k < N {
            let d = self.factors[k][k];
            if self.paired[k] {
                let (b, e) = (self.factors[k + 1][k], self.factors[k + 1][k + 1]);
                let (mean, radius) = (0.5 * (d + e), (0.5 * (d - e)).hypot(b));
                count += usize::from(mean - radius < -tolerance) + usize::from(mean + radius < -tolerance);
                k += 2;
            } else {
                count += usize::from(d < -tolerance);
                k += 1;
            }
        }
        count
    }

    /// `G` and the diagonal of `S`, of 1 and -1, of `A = G S G^T`.
    #[must_use]
    pub fn root(&self) -> (SMatrix<f64, N, N>, SVector<f64, N>) {
        let a = &self.factors;
        let (mut root, mut signs) = (SMatrix::zeros(), SVector::repeat(1.0));
        let mut put = |k: usize, value: f64, column: [f64; N]| {
            signs[k] = 1.0_f64.copysign(value);
            let scale = value.abs().sqrt();
            for (&place, x) in self.order.iter().zip(column) {
                root[(place, k)] = scale * x;
            }
        };
        let mut k = 0;
        while k < N {
            let width = self.width(k);
            let column = |k: usize, first: [f64; 2]| -> [f64; N] {
                std::array::from_fn(|i| match i {
                    _ if i < k => 0.0,
                    _ if i < k + width => first[i - k],
                    _ => first[0] * a[i][k] + if width == 2 { first[1] * a[i][k + 1] } else { 0.0 },
                })
            };
            if width == 2 {
                let (values, vectors) = eigen(a[k][k], a[k + 1][k], a[k + 1][k + 1]);
                put(k, values[0], column(k, vectors[0]));
                put(k + 1, values[1], column(k, vectors[1]));
            } else {
                put(k, a[k][k], column(k, [1.0, 0.0]));
            }
            k += width;
        }
        (root, signs)
    }

    /// Solves for all columns; not finite where the matrix is singular.
    #[must_use]
    pub fn solve<const M: usize>(&self, rhs: &SMatrix<f64, N, M>) -> SMatrix<f64, N, M> {
        let a = &self.factors;
        let mut x: [[f64; M]; N] = self.order.map(|i| std::array::from_fn(|c| rhs[(i, c)]));
        let subtract = |x: &mut [[f64; M]; N], i: usize, factor: f64, k: usize| {
            let known = x[k];
            x[i].iter_mut().zip(known).for_each(|(x, known)| *x -= factor * known);
        };
        let mut k = 0;
        while k < N {
            let width = self.width(k);
            for i in k + width..N {
                for column in k..k + width {
                    subtract(&mut x, i, a[i][column], column);
                }
            }
            k += width;
        }
        let mut k = 0;
        while k < N {
            let d = a[k][k];
            if self.paired[k] {
                let (b, e) = (a[k + 1][k], a[k + 1][k + 1]);
                let determinant = d * e - b * b;
                for c in 0..M {
                    let (y, z) = (x[k][c], x[k + 1][c]);
                    (x[k][c], x[k + 1][c]) = ((e * y - b * z) / determinant, (d * z - b * y) / determinant);
                }
            } else {
                x[k].iter_mut().for_each(|x| *x /= d);
            }
            k += self.width(k);
        }
        for column in (0..N).rev() {
            for i in column + self.width(column)..N {
                subtract(&mut x, column, a[i][column], i);
            }
        }
        let mut solution = SMatrix::zeros();
        for (row, &place) in x.iter().zip(&self.order) {
            row.iter().enumerate().for_each(|(c, value)| solution[(place, c)] = *value);
        }
        solution
    }

    /// Rows of the pivot that begins at a row.
    fn width(&self, k: usize) -> usize {
        if self.paired[k] { 2 } else { 1 }
    }
}

/// Eigenvalues and orthonormal eigenvectors of `[[d, b], [b, e]]` (Jacobi's rotation).
fn eigen(d: f64, b: f64, e: f64) -> ([f64; 2], [[f64; 2]; 2]) {
    if b == 0.0 {
        return ([d, e], [[1.0, 0.0], [0.0, 1.0]]);
    }
    let half = 0.5 * (e - d) / b;
    let t = 1.0_f64.copysign(half) / (half.abs() + half.hypot(1.0));
    let c = 1.0 / t.hypot(1.0);
    let s = t * c;
    ([d - t * b, e + t * b], [[c, -s], [s, c]])
}

fn exchange<const N: usize>(a: &mut [[f64; N]; N], order: &mut [usize; N], i: usize, k: usize) {
    if i != k {
        a.swap(i, k);
        a.iter_mut().for_each(|row| row.swap(i, k));
        order.swap(i, k);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn counts_and_solves_as_eigenvalues_and_lu_do(numbers in prop::collection::vec(-1.0..1.0_f64, 36)) {
            let half = SMatrix::<f64, 6, 6>::from_column_slice(&numbers);
            // Without a diagonal pivots come in pairs.
            for matrix in [half + half.transpose(), half + half.transpose() - SMatrix::from_diagonal(&(2.0 * half.diagonal()))] {
                let factors = Symmetric::new(&matrix).unwrap();
                let values = matrix.symmetric_eigenvalues();
                prop_assert_eq!(factors.negative(0.0), values.iter().filter(|x| **x < 0.0).count());
                let rhs = half.fixed_columns::<2>(0).into_owned();
                let x = factors.solve(&rhs);
                let residual = (matrix * x - rhs).amax();
                // Backward stable.
                prop_assert!(residual <= 1e-14 * (1.0 + x.amax()), "{residual} {}", x.amax());
                let (root, signs) = factors.root();
                prop_assert!((root * SMatrix::from_diagonal(&signs) * root.transpose() - matrix).amax() < 1e-14);
            }
        }
    }
}
