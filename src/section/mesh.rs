//! Functions over the width, and their integrals, where growth may jump.
//!
//! A [`Mesh`] divides the width at the jumps. On a piece of length `h` about `m` a function is a series in
//! the orthonormal Legendre polynomials `p_n((x - m)/h)`, so that `int f g dx = sum_pieces h sum_n f_n g_n`.
//! Without jumps there is one piece and the series is the Legendre series over the width.

use super::basis;
use crate::growth::{Growth, Profile};
use crate::legendre;
use crate::piecewise::union;

/// The pieces into which the width is divided.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    breaks: Vec<f64>,
}

/// A function on a [`Mesh`]: the Legendre coefficients on each of its pieces.
pub type Series = Vec<Vec<f64>>;

impl Mesh {
    /// The mesh of all jumps of a growth.
    #[must_use]
    pub fn of(growth: &Growth) -> Self {
        let mut breaks = vec![-0.5, 0.5];
        for (_, field) in growth.fields() {
            if let Some(pieces) = &field.pieces {
                breaks = union(&breaks, pieces.breaks());
            }
        }
        Self { breaks }
    }

    /// The breaks, from edge to edge.
    #[must_use]
    pub fn breaks(&self) -> &[f64] {
        &self.breaks
    }

    /// Whether there are no jumps.
    #[must_use]
    pub fn is_single(&self) -> bool {
        self.breaks.len() == 2
    }

    /// Middle and length of each piece.
    pub fn pieces(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        self.breaks.windows(2).map(|w| (0.5 * (w[0] + w[1]), w[1] - w[0]))
    }

    /// The zero function.
    #[must_use]
    pub fn zero(&self) -> Series {
        vec![Vec::new(); self.breaks.len() - 1]
    }

    /// The series of `sum_k c_k x^k`.
    #[must_use]
    pub fn polynomial(&self, coefficients: &[f64]) -> Series {
        if self.is_single() {
            return vec![legendre::from_monomials(coefficients)];
        }
        if coefficients.is_empty() {
            return self.zero();
        }
        if let Some(&[c0, c1, c2]) = coefficients.first_chunk().filter(|_| coefficients.len() == 3) {
            let shifted = |(m, h): (f64, f64)| [c0 + m * (c1 + m * c2), h * (c1 + 2.0 * m * c2), h * h * c2];
            return self.pieces().map(|piece| legendre::from_monomials(&shifted(piece))).collect();
        }
        let horner = |x: f64| coefficients.iter().rev().fold(0.0, |sum, c| sum * x + c);
        self.sampled(coefficients.len(), |_, m, h, y| horner(m + h * y))
    }

    /// The series of a growth field.
    #[must_use]
    pub fn profile(&self, profile: &Profile) -> Series {
        let polynomial = self.polynomial(&profile.polynomial);
        match &profile.pieces {
            Some(pieces) => axpy(1.0, pieces.refined(&self.breaks).pieces(), &polynomial),
            None => polynomial,
        }
    }

    /// The series of the derivative of a continuous growth field.
    #[must_use]
    pub fn derivative(&self, profile: &Profile) -> Series {
        let polynomial = self.polynomial(&legendre::monomial_derivative(&profile.polynomial));
        let Some(pieces) = &profile.pieces else { return polynomial };
        let pieces = pieces.refined(&self.breaks);
        let scaled = |(series, (_, h)): (&Vec<f64>, (f64, f64))| -> Vec<f64> {
            legendre::derivative(series).iter().map(|c| c / h).collect()
        };
        let derived: Series = pieces.pieces().iter().zip(self.pieces()).map(scaled).collect();
        axpy(1.0, &derived, &polynomial)
    }

    /// The series, with `n` coefficients on each piece, of a function of `(piece, middle, length, y)` at
    /// `x = middle + length y`.
    pub fn sampled(&self, n: usize, f: impl Fn(usize, f64, f64, f64) -> f64) -> Series {
        let (nodes, weights) = legendre::rule(n);
        let series = |(piece, (m, h)): (usize, (f64, f64))| {
            let values: Vec<f64> = nodes.iter().map(|&y| f(piece, m, h, y)).collect();
            legendre::project(&values, nodes, weights, n)
        };
        self.pieces().enumerate().map(series).collect()
    }

    /// `int f g dx`.
    #[must_use]
    pub fn dot(&self, f: &[Vec<f64>], g: &[Vec<f64>]) -> f64 {
        let on_piece = |(f, g): (&Vec<f64>, &Vec<f64>)| f.iter().zip(g).map(|(f, g)| f * g).sum::<f64>();
        self.pieces().zip(f.iter().zip(g)).map(|((_, h), pair)| h * on_piece(pair)).sum()
    }

    /// `int f dx`, the mean over the width.
    #[must_use]
    pub fn mean(&self, f: &[Vec<f64>]) -> f64 {
        self.pieces().zip(f).map(|((_, h), series)| h * series.first().copied().unwrap_or(0.0)).sum()
    }

    /// `int (f - mean)^2 dx`.
    #[must_use]
    pub fn variance(&self, f: &[Vec<f64>]) -> f64 {
        let mean = self.mean(f);
        let on_piece = |series: &Vec<f64>| {
            let constant = series.first().copied().unwrap_or(0.0) - mean;
            constant * constant + series.iter().skip(1).map(|c| c * c).sum::<f64>()
        };
        self.pieces().zip(f).map(|((_, h), series)| h * on_piece(series)).sum()
    }

    /// The value at `x`, at a break that of the piece to its right.
    #[must_use]
    pub fn evaluate(&self, f: &[Vec<f64>], x: f64) -> f64 {
        let piece = self.breaks[1..self.breaks.len() - 1].partition_point(|&b| b <= x);
        let (from, to) = (self.breaks[piece], self.breaks[piece + 1]);
        legendre::evaluate(&f[piece], (x - 0.5 * (from + to)) / (to - from))
    }

    /// The series of `x f(x)`.
    #[must_use]
    pub fn multiply_by_x(&self, f: &[Vec<f64>]) -> Series {
        let on_piece = |((m, h), series): ((f64, f64), &Vec<f64>)| {
            let mut product = legendre::multiply_by_x(series);
            product.iter_mut().for_each(|c| *c *= h);
            product.iter_mut().zip(series).for_each(|(p, c)| *p += m * c);
            product
        };
        self.pieces().zip(f).map(on_piece).collect()
    }

    /// The integral of `f` from the left edge.
    #[must_use]
    pub fn integral(&self, f: &[Vec<f64>]) -> Series {
        let mut left = 0.0;
        let on_piece = |((_, h), series): ((f64, f64), &Vec<f64>)| {
            let mut primitive = legendre::integrate_zero_mean(series);
            primitive.iter_mut().for_each(|c| *c *= h);
            let at = |n: usize| series.get(n).copied().unwrap_or(0.0);
            // From the left end of the piece, int p_0 = y + 1/2 and int p_1 has the mean -1/(2 sqrt 3).
            primitive[0] = left + h * (0.5 * at(0) - at(1) / 12f64.sqrt());
            left += h * at(0);
            primitive
        };
        self.pieces().zip(f).map(on_piece).collect()
    }

    /// The integral of `f` that has zero mean over the width.
    #[must_use]
    pub fn integral_of_zero_mean(&self, f: &[Vec<f64>]) -> Series {
        let mut primitive = self.integral(f);
        let mean = self.mean(&primitive);
        primitive.iter_mut().for_each(|series| series[0] -= mean);
        primitive
    }

    /// The double integral of `f` without its components on `1` and `x`.
    #[must_use]
    pub fn double_integral(&self, f: &[Vec<f64>]) -> Series {
        if self.is_single() {
            return vec![basis::double_integral(&f[0])];
        }
        let mut double = self.integral(&self.integral(f));
        self.remove_linear(&mut double);
        double
    }

    /// Takes out the components on `1` and `x`, twice: what is left is orthogonal to rounding.
    pub fn remove_linear(&self, f: &mut Series) {
        // On a piece x = m + h y, and y = p_1/sqrt 12.
        let slant = 1.0 / 12f64.sqrt();
        f.iter_mut().for_each(|series| series.resize(series.len().max(2), 0.0));
        for _ in 0..2 {
            let mean = self.mean(f);
            f.iter_mut().for_each(|series| series[0] -= mean);
            let moments = self.pieces().zip(f.iter()).map(|((m, h), s)| h * (m * s[0] + h * slant * s[1]));
            let slope = 12.0 * moments.sum::<f64>();
            for ((m, h), series) in self.pieces().zip(f.iter_mut()) {
                series[0] -= slope * m;
                series[1] -= slope * h * slant;
            }
        }
    }

    /// Takes out the components on `1`, `x` and `t` and gives the one on `t`, in units of it.
    ///
    /// What remains of functions that have no other components is zero exactly.
    pub fn take_parabola(&self, f: &mut Series) -> f64 {
        if self.is_single() {
            let series = &mut f[0];
            let component = series.get(2).map_or(0.0, |c| c / basis::PARABOLA);
            series.iter_mut().take(3).for_each(|c| *c = 0.0);
            while series.last() == Some(&0.0) {
                series.pop();
            }
            return component;
        }
        if f.iter().flatten().all(|&c| c == 0.0) {
            return 0.0;
        }
        let t = self.parabola();
        let size = self.dot(f, f);
        let mut component = 0.0;
        for _ in 0..2 {
            self.remove_linear(f);
            let again = self.dot(f, &t) / (basis::PARABOLA * basis::PARABOLA);
            *f = axpy(-again, &t, f);
            component += again;
        }
        if self.dot(f, f) <= 1e-30 * size {
            *f = self.zero();
        }
        component
    }

    /// `(x^2/2)~`, free of its components on `1` and `x`: the double integral of `1`.
    #[must_use]
    pub fn parabola(&self) -> Series {
        self.polynomial(&[-1.0 / 24.0, 0.0, 0.5])
    }
}

/// `a f + g`, for series of any lengths.
#[must_use]
pub fn axpy(a: f64, f: &[Vec<f64>], g: &[Vec<f64>]) -> Series {
    let on_piece = |(f, g): (&Vec<f64>, &Vec<f64>)| {
        let mut sum = g.clone();
        sum.resize(f.len().max(g.len()), 0.0);
        sum.iter_mut().zip(f).for_each(|(s, f)| *s += a * f);
        sum
    };
    f.iter().zip(g).map(on_piece).collect()
}
