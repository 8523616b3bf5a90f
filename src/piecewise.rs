//! Piecewise polynomials: growth across the width with its jumps, amplitudes along the ribbon.

use crate::{InvalidInput, legendre};

/// Polynomials between ascending breaks, free to jump at them.
///
/// On the piece of length `h` about `m` the function is `sum_n c_n p_n((t - m)/h)` with the orthonormal
/// Legendre polynomials of [`legendre`], so that its square integrates to `h sum_n c_n^2`.
#[derive(Clone, Debug, PartialEq)]
pub struct Piecewise {
    breaks: Vec<f64>,
    pieces: Vec<Vec<f64>>,
}

/// The most coefficients of a piece: with so many Gauss nodes products of two pieces are still exact.
pub const MAX_PIECE_COEFFICIENTS: usize = 512;

impl Piecewise {
    /// The function with these breaks and, on each piece, Legendre coefficients `sum_n c_n P_n`, lowest first.
    ///
    /// # Errors
    /// If the breaks are not ascending and finite, a coefficient is not finite, there are too many on a
    /// piece, or the numbers of breaks and pieces do not match.
    pub fn from_legendre(breaks: Vec<f64>, mut pieces: Vec<Vec<f64>>) -> Result<Self, InvalidInput> {
        if breaks.len() < 2 || pieces.len() + 1 != breaks.len() {
            let found = format!("{} breaks and {} pieces", breaks.len(), pieces.len());
            return Err(InvalidInput::new("pieces", found, "one break more than pieces"));
        }
        if let Some(pair) = breaks.windows(2).find(|w| !(w[0] < w[1] && (w[1] - w[0]).is_finite())) {
            return Err(InvalidInput::new("breaks", pair[1], "finite ascending numbers"));
        }
        for piece in &mut pieces {
            if let Some(bad) = piece.iter().find(|c| !c.is_finite()) {
                return Err(InvalidInput::new("coefficients", bad, "finite numbers"));
            }
            if piece.len() > MAX_PIECE_COEFFICIENTS {
                let expected = format!("at most {MAX_PIECE_COEFFICIENTS} on a piece");
                return Err(InvalidInput::new("coefficients", piece.len(), &expected));
            }
            let norms = (0..).map(|n: u32| f64::from(2 * n + 1).sqrt());
            piece.iter_mut().zip(norms).for_each(|(c, norm)| *c /= norm);
        }
        Ok(Self { breaks, pieces })
    }

    /// The function that is zero on the pieces between these breaks.
    #[must_use]
    pub fn zero(breaks: &[f64]) -> Self {
        Self { breaks: breaks.to_vec(), pieces: vec![Vec::new(); breaks.len() - 1] }
    }

    /// Where the function starts and ends.
    #[must_use]
    pub fn range(&self) -> (f64, f64) {
        (self.breaks[0], self.breaks[self.breaks.len() - 1])
    }

    /// The inner breaks at which the function jumps by more than rounding.
    pub fn jumps(&self) -> impl Iterator<Item = f64> + '_ {
        let size = |series: &Vec<f64>| series.iter().map(|c| c.abs()).sum::<f64>();
        let scale = self.pieces.iter().map(size).fold(0.0, f64::max);
        let neighbours = self.breaks[1..].iter().zip(self.pieces.windows(2));
        neighbours.filter_map(move |(&x, pair)| {
            let jump = legendre::evaluate(&pair[1], -0.5) - legendre::evaluate(&pair[0], 0.5);
            (jump.abs() > 1e-12 * scale).then_some(x)
        })
    }

    /// The breaks, from the first end to the last.
    #[must_use]
    pub fn breaks(&self) -> &[f64] {
        &self.breaks
    }

    /// The function's series on each piece.
    #[must_use]
    pub fn pieces(&self) -> &[Vec<f64>] {
        &self.pieces
    }

    /// The value at `t`, at an inner break that of the piece to its right; beyond an end that of the end.
    #[must_use]
    pub fn evaluate(&self, t: f64) -> f64 {
        let piece = self.breaks[1..self.breaks.len() - 1].partition_point(|&b| b <= t);
        let (from, to) = (self.breaks[piece], self.breaks[piece + 1]);
        legendre::evaluate(&self.pieces[piece], (t.clamp(from, to) - 0.5 * (from + to)) / (to - from))
    }

    /// The same function with further breaks, which lie within its range.
    #[must_use]
    pub fn refined(&self, breaks: &[f64]) -> Self {
        if self.breaks == breaks {
            return self.clone();
        }
        let pieces = breaks.windows(2).map(|w| self.series_on(w[0], w[1])).collect();
        Self { breaks: breaks.to_vec(), pieces }
    }

    /// The series on an interval that no break divides.
    fn series_on(&self, from: f64, to: f64) -> Vec<f64> {
        let middle = 0.5 * (from + to);
        let piece = self.breaks[1..self.breaks.len() - 1].partition_point(|&b| b <= middle);
        let (start, end) = (self.breaks[piece], self.breaks[piece + 1]);
        let series = &self.pieces[piece];
        if (start, end) == (from, to) {
            return series.clone();
        }
        let (nodes, weights) = legendre::rule(series.len());
        let place = |y: f64| (middle + y * (to - from) - 0.5 * (start + end)) / (end - start);
        let values: Vec<f64> = nodes.iter().map(|&y| legendre::evaluate(series, place(y))).collect();
        legendre::project(&values, nodes, weights, series.len())
    }

    /// Adds `factor` times another function of the same range; the breaks of both divide the sum.
    #[must_use]
    pub fn plus(self, factor: f64, other: &Self) -> Self {
        if self.breaks == other.breaks {
            let mut sum = self;
            for (mine, theirs) in sum.pieces.iter_mut().zip(&other.pieces) {
                mine.resize(mine.len().max(theirs.len()), 0.0);
                mine.iter_mut().zip(theirs).for_each(|(m, c)| *m += factor * c);
            }
            return sum;
        }
        let breaks = union(&self.breaks, &other.breaks);
        self.refined(&breaks).plus(factor, &other.refined(&breaks))
    }
}

/// All breaks of both, ascending; those that differ by rounding are one.
#[must_use]
pub fn union(a: &[f64], b: &[f64]) -> Vec<f64> {
    if a == b || b.is_empty() {
        return a.to_vec();
    }
    let mut all: Vec<f64> = a.iter().chain(b).copied().collect();
    all.sort_by(f64::total_cmp);
    let least = 1e-14 * all.last().map_or(0.0, |last| last - all[0]);
    let last = all.last().copied();
    all.dedup_by(|next, kept| *next - *kept <= least);
    // Of two ends that differ by rounding the first is kept: both ranges are the same but for that.
    if let (Some(end), Some(last)) = (all.last_mut(), last) {
        *end = last;
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    fn example() -> Piecewise {
        Piecewise::from_legendre(vec![-0.5, 0.1, 0.5], vec![vec![1.0, 2.0, 0.5], vec![-1.0]]).unwrap()
    }

    #[test]
    fn values_are_those_of_legendre_polynomials() {
        let f = example();
        for x in [-0.5, -0.3, 0.0999] {
            let xi: f64 = (2.0 * x + 0.4) / 0.6;
            let exact = 1.0 + 2.0 * xi + 0.25 * (3.0 * xi * xi - 1.0);
            assert!((f.evaluate(x) - exact).abs() < 1e-15);
        }
        assert!((f.evaluate(0.1) + 1.0).abs() < 1e-16 && (f.evaluate(0.6) + 1.0).abs() < 1e-16);
    }

    #[test]
    fn refining_changes_nothing() {
        let f = example();
        let finer = f.refined(&union(f.breaks(), &[-0.5, -0.2, 0.1 + 1e-16, 0.3, 0.5]));
        assert_eq!(finer.breaks(), [-0.5, -0.2, 0.1, 0.3, 0.5]);
        let doubled = f.clone().plus(1.0, &finer);
        for x in [-0.5, -0.2, -0.1, 0.09, 0.2, 0.5] {
            assert!((finer.evaluate(x) - f.evaluate(x)).abs() < 2e-15);
            assert!((doubled.evaluate(x) - 2.0 * f.evaluate(x)).abs() < 4e-15);
        }
    }

    #[test]
    fn what_is_no_function_is_refused() {
        for (breaks, pieces) in [
            (vec![0.0], vec![]),
            (vec![0.0, 1.0], vec![vec![1.0], vec![1.0]]),
            (vec![0.0, 0.0], vec![vec![1.0]]),
            (vec![0.0, f64::NAN], vec![vec![1.0]]),
            (vec![0.0, 1.0], vec![vec![f64::INFINITY]]),
            (vec![0.0, 1.0], vec![vec![0.0; 513]]),
        ] {
            assert!(Piecewise::from_legendre(breaks, pieces).is_err());
        }
    }
}
