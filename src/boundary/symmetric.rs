//! Small symmetric matrices, of either sign: `P A P^T = L D L^T` with complete pivoting (Bunch & Parlett 1971).

#![expect(clippy::needless_range_loop, reason = "indices of rows and columns")]

use nalgebra::SMatrix;

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

    /// Solves; not finite where the matrix is singular.
    #[must_use]
    pub fn solve(&self, rhs: &[f64; N]) -> [f64; N] {
        let a = &self.factors;
        let mut x: [f64; N] = self.order.map(|i| rhs[i]);
        let width = |k: usize| if self.paired[k] { 2 } else { 1 };
        let mut k = 0;
        while k < N {
            for i in k + width(k)..N {
                for column in k..k + width(k) {
                    x[i] -= a[i][column] * x[column];
                }
            }
            k += width(k);
        }
        let mut k = 0;
        while k < N {
            if self.paired[k] {
                let (d, b, e) = (a[k][k], a[k + 1][k], a[k + 1][k + 1]);
                let determinant = d * e - b * b;
                (x[k], x[k + 1]) =
                    ((e * x[k] - b * x[k + 1]) / determinant, (d * x[k + 1] - b * x[k]) / determinant);
            } else {
                x[k] /= a[k][k];
            }
            k += width(k);
        }
        for column in (0..N).rev() {
            let first = column + if self.paired[column] { 2 } else { 1 };
            for i in first..N {
                x[column] -= a[i][column] * x[i];
            }
        }
        let mut solution = [0.0; N];
        for (value, &place) in x.iter().zip(&self.order) {
            solution[place] = *value;
        }
        solution
    }
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
    use nalgebra::SVector;
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
                let rhs: [f64; 6] = std::array::from_fn(|i| numbers[i]);
                let x = SVector::<f64, 6>::from(factors.solve(&rhs));
                let residual = (matrix * x - SVector::from(rhs)).amax();
                // Backward stable.
                prop_assert!(residual <= 1e-14 * (1.0 + x.amax()), "{residual} {}", x.amax());
            }
        }
    }
}
