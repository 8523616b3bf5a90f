//! Gaussian elimination on small dense blocks, stored by rows.

use pulp::{Arch, NullaryFnOnce};

/// Numbers that are worked on at once: rows are as long as a multiple of it.
const WIDE: usize = 4;

/// Does work by the widest instructions of this processor. They give the same bits: nothing is fused or summed in another order.
pub fn wide<W: NullaryFnOnce>(work: W) -> W::Output {
    if cfg!(feature = "baseline") { work.call() } else { Arch::new().dispatch(work) }
}

/// So many numbers, and those that pad them to the length of a row.
#[must_use]
pub const fn padded(count: usize) -> usize {
    count.next_multiple_of(WIDE)
}

/// Eliminates the first `pivots` columns of a block of rows of length `stride`, which is [`padded`], with partial pivoting.
///
/// The multipliers stay in the place of what they eliminated, the rows are exchanged as a whole, and `swaps`
/// takes the pivot row of each column. Returns the least pivot relative to the largest entry its column had:
/// of the order of rounding where the block is singular.
///
/// # Panics
/// If the rows have another length, or are longer than 44.
pub fn eliminate(block: &mut [f64], stride: usize, pivots: usize, swaps: &mut [usize]) -> f64 {
    macro_rules! of_width {
        ($($width:literal)*) => {
            match stride {
                $($width => wide(Elimination::<$width> { rows: block.as_chunks_mut().0, pivots, swaps }),)*
                // Rows are made by this crate alone, for degrees up to the highest.
                _ => unreachable!("rows of {stride} numbers"),
            }
        };
    }
    of_width!(4 8 12 16 20 24 28 32 36 40 44)
}

struct Elimination<'a, const WIDTH: usize> {
    rows: &'a mut [[f64; WIDTH]],
    pivots: usize,
    swaps: &'a mut [usize],
}

impl<const WIDTH: usize> NullaryFnOnce for Elimination<'_, WIDTH> {
    type Output = f64;

    #[inline(always)]
    fn call(self) -> f64 {
        let Self { rows, pivots, swaps } = self;
        let mut least = f64::INFINITY;
        // Of each column, in the pivot rows so far.
        let mut largest = [0.0_f64; WIDTH];
        for k in 0..pivots {
            let (mut pivot, mut size) = (k, 0.0);
            for (row, entries) in rows.iter().enumerate().skip(k) {
                if entries[k].abs() > size {
                    (pivot, size) = (row, entries[k].abs());
                }
            }
            swaps[k] = pivot;
            rows.swap(k, pivot);
            let (head, tail) = rows.split_at_mut(k + 1);
            // What is left of the row, in whole pieces: nothing is added to the multipliers.
            let mut rest = head[k];
            least = least_of(least, rest[k].abs() / largest[k].max(size));
            if rest[k] == 0.0 {
                return 0.0;
            }
            for (largest, x) in largest.iter_mut().zip(&rest) {
                *largest = if x.abs() > *largest { x.abs() } else { *largest };
            }
            let inverse = 1.0 / rest[k];
            rest[..=k].fill(0.0);
            let first = (k + 1) / WIDE;
            let rest = &rest.as_chunks::<WIDE>().0[first..];
            for other in tail {
                let factor = other[k] * inverse;
                other[k] = factor;
                if factor != 0.0 {
                    for (piece, rest) in other.as_chunks_mut::<WIDE>().0[first..].iter_mut().zip(rest) {
                        for i in 0..WIDE {
                            piece[i] -= factor * rest[i];
                        }
                    }
                }
            }
        }
        least
    }
}

/// A determinant as a sign and a logarithm, for products of many factors neither overflow nor vanish in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Determinant {
    /// 1 or -1, 0 if it vanishes.
    pub sign: f64,
    /// Of its absolute value.
    pub log: f64,
}

impl Determinant {
    /// Of a number.
    #[must_use]
    pub fn of(value: f64) -> Self {
        let sign = if value == 0.0 { 0.0 } else { value.signum() };
        Self { sign, log: value.abs().ln() }
    }

    /// The product.
    #[must_use]
    pub fn times(self, other: Self) -> Self {
        Self { sign: self.sign * other.sign, log: self.log + other.log }
    }
}

/// The determinant of what [`eliminate`] eliminated.
#[must_use]
pub fn determinant(block: &[f64], stride: usize, swaps: &[usize]) -> Determinant {
    let pivots: f64 = (0..swaps.len()).map(|k| block[k * stride + k]).product();
    let odd = swaps.iter().enumerate().filter(|(k, pivot)| k != *pivot).count() % 2 == 1;
    Determinant::of(if odd { -pivots } else { pivots })
}

/// The lesser of two, or what is not a number, which callers refuse: `min` would drop it.
#[must_use]
pub fn least_of(a: f64, b: f64) -> f64 {
    if a.is_nan() || a <= b { a } else { b }
}

/// Does to a right-hand side, one number a row, what [`eliminate`] did to the block.
pub fn forward(block: &[f64], stride: usize, swaps: &[usize], rhs: &mut [f64]) {
    // Rows were exchanged with the multipliers they had by then.
    for (k, &pivot) in swaps.iter().enumerate() {
        rhs.swap(k, pivot);
    }
    wide(Forward { block, stride, pivots: swaps.len(), rhs });
}

struct Forward<'a> {
    block: &'a [f64],
    stride: usize,
    pivots: usize,
    rhs: &'a mut [f64],
}

impl NullaryFnOnce for Forward<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        // By columns: no sum waits for the last one.
        for k in 0..self.pivots {
            let (known, rest) = self.rhs.split_at_mut(k + 1);
            let rows = self.block[(k + 1) * self.stride..].chunks_exact(self.stride);
            for (y, row) in rest.iter_mut().zip(rows) {
                *y -= row[k] * known[k];
            }
        }
    }
}

/// Solves with the upper triangle of the first `rhs.len()` rows and columns.
pub fn backward(block: &[f64], stride: usize, rhs: &mut [f64]) {
    wide(Backward { block, stride, rhs });
}

struct Backward<'a> {
    block: &'a [f64],
    stride: usize,
    rhs: &'a mut [f64],
}

impl NullaryFnOnce for Backward<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        for k in (0..self.rhs.len()).rev() {
            let (rest, known) = self.rhs.split_at_mut(k);
            known[0] /= self.block[k * self.stride + k];
            for (y, row) in rest.iter_mut().zip(self.block.chunks_exact(self.stride)) {
                *y -= row[k] * known[0];
            }
        }
    }
}

/// The sum of products, padded.
#[inline(always)]
#[must_use]
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; WIDE];
    for (a, b) in a.as_chunks::<WIDE>().0.iter().zip(b.as_chunks::<WIDE>().0) {
        for i in 0..WIDE {
            sums[i] += a[i] * b[i];
        }
    }
    sums[0] + sums[1] + (sums[2] + sums[3])
}

/// The factors of a square matrix.
#[derive(Clone, Debug, Default)]
pub struct Factors {
    /// Padded rows.
    block: Vec<f64>,
    swaps: Vec<usize>,
    /// The least relative pivot.
    pub pivot: f64,
}

impl Factors {
    /// Of a matrix of this size, given by rows.
    #[must_use]
    pub fn of(matrix: &[f64], size: usize) -> Self {
        let stride = padded(size);
        let mut block = vec![0.0; size * stride];
        for (padded, row) in block.chunks_exact_mut(stride).zip(matrix.chunks_exact(size)) {
            padded[..size].copy_from_slice(row);
        }
        let mut swaps = vec![0; size];
        let pivot = eliminate(&mut block, stride, size, &mut swaps);
        Self { block, swaps, pivot }
    }

    /// Solves.
    #[must_use]
    pub fn solve(&self, mut rhs: Vec<f64>) -> Vec<f64> {
        let stride = padded(self.swaps.len());
        forward(&self.block, stride, &self.swaps, &mut rhs);
        backward(&self.block, stride, &mut rhs);
        rhs
    }

    /// The determinant.
    #[must_use]
    pub fn determinant(&self) -> Determinant {
        determinant(&self.block, padded(self.swaps.len()), &self.swaps)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solves_what_it_eliminated() {
        // Rows of a system whose first pivot is zero.
        let matrix = [0.0, 2.0, 1.0, 1.0, 1.0, 0.0, 2.0, 0.0, 3.0];
        let solution = [1.0, -2.0, 3.0];
        let rhs = matrix.chunks(3).map(|row| row.iter().zip(&solution).map(|(a, x)| a * x).sum()).collect();
        let factors = Factors::of(&matrix, 3);
        assert!(factors.pivot > 0.1);
        for (x, y) in factors.solve(rhs).iter().zip(solution) {
            assert!((x - y).abs() < 1e-15);
        }
        let Determinant { sign, log } = factors.determinant();
        assert!(sign == -1.0 && (log - 8f64.ln()).abs() < 1e-15);
    }

    #[test]
    fn a_singular_block_is_told() {
        let pivot = |matrix: [f64; 4]| Factors::of(&matrix, 2).pivot;
        assert!(pivot([1.0, 2.0, 2.0, 4.0 * (1.0 + 1e-16)]) < 1e-15);
        assert_eq!(pivot([0.0; 4]), 0.0);
        assert!(pivot([f64::NAN, 1.0, 1.0, 1.0]).is_nan());
        for (a, b) in [(f64::NAN, 1.0), (1.0, f64::NAN)] {
            assert!(least_of(a, b).is_nan());
        }
        assert_eq!(least_of(1.0, 2.0), least_of(2.0, 1.0));
    }
}
