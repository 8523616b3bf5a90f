//! The last panel, also with the column of a parameter, factorised; also where it is singular.
//!
//! A rod that is the same in all directions may turn about the line of its loads and ends, and a closed one along itself: then a singular
//! value vanishes at every point of a branch, and of all solutions that with the least change is taken.

use nalgebra::{DMatrix, DVector};

use super::dense::{Determinant, Factors};

/// The factors.
#[derive(Clone, Debug)]
pub enum Panel {
    /// Of a regular matrix.
    Regular(Factors),
    /// Of one that is singular but for rounding.
    Singular {
        /// The inverse on what is regular.
        inverse: DMatrix<f64>,
        /// What it maps to nothing.
        kernel: Vec<Vec<f64>>,
        /// Logarithm of the product of the others, and of what the columns were divided by.
        log: f64,
    },
}

/// Size of a column, of the largest, that is none.
const NONE: f64 = 1e-10;
/// A solution so much larger than its right-hand side tells of a small singular value.
const LARGE: f64 = 1e4;
/// Singular values below this part of the next vanish: at points of a branch, and of what is known no better, and at a solution, which is
/// as singular where it buckles.
pub const VANISHING: f64 = 1e-5;
pub const VANISHING_AT_SOLUTION: f64 = 1e-9;
/// Steps of a singular value decomposition that are too many.
pub const SVD_STEPS: usize = 1000;
/// The most singular values that may.
const MOST: usize = 3;

impl Panel {
    /// Factorises a matrix whose columns are of these sizes if nothing cancels in them. So many of its singular values vanish, or, if
    /// that is not known, as many as are below this part of the next.
    #[must_use]
    pub fn new(matrix: &DMatrix<f64>, sizes: &[f64], nullity: Option<usize>, vanishing: f64) -> Self {
        let size = matrix.nrows();
        let own = matrix.column_iter().map(|column| column.amax());
        let scale = sizes.iter().zip(own).map(|(size, own)| size.max(own));
        let scale = DVector::from_iterator(size, scale);
        // Nothing is divided by a size that is none but for rounding, as those of forces that bend nothing.
        let none = NONE * scale.max();
        let scale = scale.map(|size| if size > none { size } else { 1.0 });
        let regular = Self::Regular(Factors::of(matrix.transpose().as_slice(), size));
        // Of no particular direction.
        let trial = regular.solve((0..size).map(|i| 1.0 + 0.1 * i as f64).collect());
        let largest = trial.iter().zip(scale.iter()).map(|(x, size)| (x * size).abs()).fold(0.0, f64::max);
        if nullity == Some(0) || nullity.is_none() && largest < LARGE || !matrix.iter().all(|x| x.is_finite())
        {
            return regular;
        }
        Self::singular(matrix, &scale, nullity, vanishing).unwrap_or(regular)
    }

    fn singular(
        matrix: &DMatrix<f64>,
        scale: &DVector<f64>,
        nullity: Option<usize>,
        vanishing: f64,
    ) -> Option<Self> {
        let mut scaled = matrix.clone();
        for (mut column, size) in scaled.column_iter_mut().zip(scale.iter()) {
            column /= *size;
        }
        if !scaled.iter().all(|x| x.is_finite()) {
            return None;
        }
        let svd = scaled.try_svd(true, true, 5.0 * f64::EPSILON, SVD_STEPS)?;
        let (u, v) = (svd.u?, svd.v_t?);
        let mut order: Vec<usize> = (0..scale.len()).collect();
        order.sort_by(|&i, &k| svd.singular_values[i].total_cmp(&svd.singular_values[k]));
        let value = |rank: usize| svd.singular_values[order[rank]];
        let count = || (1..=MOST.min(scale.len() - 1)).rev().find(|&k| value(k - 1) < vanishing * value(k));
        let nullity = nullity.or_else(count)?;
        let mut inverse = DMatrix::zeros(scale.len(), scale.len());
        let mut log = scale.iter().map(|size| size.ln()).sum::<f64>();
        for &i in &order[nullity..] {
            log += svd.singular_values[i].ln();
            inverse += v.row(i).transpose() * u.column(i).transpose() / svd.singular_values[i];
        }
        for (mut row, size) in inverse.row_iter_mut().zip(scale.iter()) {
            row /= *size;
        }
        let kernel = order[..nullity]
            .iter()
            .map(|&i| v.row(i).iter().zip(scale.iter()).map(|(y, size)| y / size).collect());
        Some(Self::Singular { inverse, kernel: kernel.collect(), log })
    }

    /// Solves.
    #[must_use]
    pub fn solve(&self, rhs: Vec<f64>) -> Vec<f64> {
        match self {
            Self::Regular(factors) => factors.solve(rhs),
            Self::Singular { inverse, .. } => (inverse * DVector::from_vec(rhs)).as_slice().to_vec(),
        }
    }

    /// What it maps to nothing.
    #[must_use]
    pub fn kernel(&self) -> &[Vec<f64>] {
        match self {
            Self::Regular(_) => &[],
            Self::Singular { kernel, .. } => kernel,
        }
    }

    /// The least relative pivot; 1 where what is singular was set aside.
    #[must_use]
    pub fn pivot(&self) -> f64 {
        match self {
            Self::Regular(factors) => factors.pivot,
            Self::Singular { .. } => 1.0,
        }
    }

    /// The determinant, without those singular values; its sign is then not known, 0.
    #[must_use]
    pub fn determinant(&self) -> Determinant {
        match self {
            Self::Regular(factors) => factors.determinant(),
            Self::Singular { log, .. } => Determinant { sign: 0.0, log: *log },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_a_singular_matrix_the_least_solution() {
        let matrix = DMatrix::from_row_slice(3, 3, &[2.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 1.0, 1.0 + 1e-15]);
        let panel = Panel::new(&matrix, &vec![1.0; matrix.ncols()], None, VANISHING);
        assert_eq!(panel.kernel().len(), 1);
        let x = panel.solve(vec![4.0, 3.0, 3.0]);
        for (x, exact) in x.iter().zip([2.0, 1.5, 1.5]) {
            assert!((x - exact).abs() < 1e-14);
        }
        // 2 and 2, without the singular value that vanishes.
        assert!((panel.determinant().log - 4f64.ln()).abs() < 1e-14);
    }

    #[test]
    fn of_a_regular_matrix_its_solution() {
        let matrix = DMatrix::from_row_slice(2, 2, &[0.0, 2.0, 3.0, 1e-9]);
        let panel = Panel::new(&matrix, &vec![1.0; matrix.ncols()], None, VANISHING);
        assert_eq!((panel.kernel().len(), panel.determinant().sign), (0, -1.0));
        assert_eq!(panel.solve(vec![2.0, 3.0 + 1e-9]), vec![1.0, 1.0]);
    }
}
