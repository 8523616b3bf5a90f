//! Gaussian elimination on small dense blocks, stored by rows.

/// Eliminates the first `pivots` columns of a block of rows of length `stride`, with partial pivoting.
///
/// The multipliers stay in the place of what they eliminated, the rows are exchanged as a whole, and `swaps`
/// takes the pivot row of each column. Returns the least pivot relative to the largest entry its column had:
/// of the order of rounding where the block is singular.
pub fn eliminate(block: &mut [f64], stride: usize, pivots: usize, swaps: &mut [usize]) -> f64 {
    let rows = block.len() / stride;
    let mut least = f64::INFINITY;
    for k in 0..pivots {
        let scale = block.iter().skip(k).step_by(stride).fold(0.0, |m: f64, x| m.max(x.abs()));
        let size = |row: usize| block[row * stride + k].abs();
        let pivot = (k..rows).fold(k, |best, row| if size(row) > size(best) { row } else { best });
        swaps[k] = pivot;
        if pivot != k {
            let (head, tail) = block.split_at_mut(pivot * stride);
            head[k * stride..(k + 1) * stride].swap_with_slice(&mut tail[..stride]);
        }
        let (head, tail) = block.split_at_mut((k + 1) * stride);
        let row = &head[k * stride..];
        least = least_of(least, row[k].abs() / scale);
        if row[k] == 0.0 {
            return 0.0;
        }
        let inverse = 1.0 / row[k];
        for other in tail.chunks_exact_mut(stride) {
            let factor = other[k] * inverse;
            other[k] = factor;
            if factor != 0.0 {
                for (x, y) in other[k + 1..].iter_mut().zip(&row[k + 1..]) {
                    *x -= factor * y;
                }
            }
        }
    }
    least
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
    for k in 0..swaps.len() {
        let value = rhs[k];
        for (row, x) in rhs.iter_mut().enumerate().skip(k + 1) {
            *x -= block[row * stride + k] * value;
        }
    }
}

/// Solves with the upper triangle of the first `rhs.len()` rows and columns.
pub fn backward(block: &[f64], stride: usize, rhs: &mut [f64]) {
    for k in (0..rhs.len()).rev() {
        let row = &block[k * stride..];
        let known: f64 = row[k + 1..rhs.len()].iter().zip(&rhs[k + 1..]).map(|(a, x)| a * x).sum();
        rhs[k] = (rhs[k] - known) / row[k];
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
        let mut rhs: Vec<f64> =
            matrix.chunks(3).map(|row| row.iter().zip(&solution).map(|(a, x)| a * x).sum()).collect();
        let (mut block, mut swaps) = (matrix, [0; 3]);
        assert!(eliminate(&mut block, 3, 3, &mut swaps) > 0.1);
        forward(&block, 3, &swaps, &mut rhs);
        backward(&block, 3, &mut rhs);
        for (x, y) in rhs.iter().zip(solution) {
            assert!((x - y).abs() < 1e-15);
        }
    }

    #[test]
    fn a_singular_block_is_told() {
        let mut block = [1.0, 2.0, 2.0, 4.0 * (1.0 + 1e-16)];
        assert!(eliminate(&mut block, 2, 2, &mut [0; 2]) < 1e-15);
        assert_eq!(eliminate(&mut [0.0; 4], 2, 2, &mut [0; 2]), 0.0);
        assert!(eliminate(&mut [f64::NAN, 1.0, 1.0, 1.0], 2, 2, &mut [0; 2]).is_nan());
        for (a, b) in [(f64::NAN, 1.0), (1.0, f64::NAN)] {
            assert!(least_of(a, b).is_nan());
        }
        assert_eq!(least_of(1.0, 2.0), least_of(2.0, 1.0));
    }
}
