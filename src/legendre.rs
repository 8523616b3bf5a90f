//! Orthonormal Legendre series on the width `[-1/2, 1/2]`.
//!
//! `p_n(x) = sqrt(2n+1) P_n(2x)`, so that `int p_n p_m dx = delta_nm`. A series is the slice of its
//! coefficients, lowest degree first.

use std::sync::OnceLock;

/// Degrees below which the recurrence is tabulated: beyond any series of this crate.
const TABULATED: usize = 2048;

/// `a_n` in `x p_n = a_{n+1} p_{n+1} + a_n p_{n-1}`, `a_n = n / (2 sqrt|4n^2-1|)`, so that `a_0 = 0`.
fn multiplication(n: usize) -> f64 {
    recurrence()[n].0
}

/// `a_n`, `1/a_n` and `a_n/a_{n+1}`, with which sums over the recurrence need no division.
fn recurrence() -> &'static [(f64, f64, f64)] {
    static TABLE: OnceLock<Vec<(f64, f64, f64)>> = OnceLock::new();
    TABLE.get_or_init(|| {
        let a = |n: usize| {
            let n = n as f64;
            n / (2.0 * (4.0 * n * n - 1.0).abs().sqrt())
        };
        (0..TABULATED).map(|n| (a(n), 1.0 / a(n), a(n) / a(n + 1))).collect()
    })
}

/// The Legendre series of the polynomial `sum_k c_k x^k` (Horner's rule, stable since all `a_n > 0`).
#[must_use]
pub fn from_monomials(coefficients: &[f64]) -> Vec<f64> {
    let mut series = vec![0.0; coefficients.len()];
    for (&c, used) in coefficients.iter().rev().zip(0..) {
        let mut old_below = 0.0;
        for n in 0..=used {
            let old = series[n];
            let below = if n > 0 { multiplication(n) * old_below } else { 0.0 };
            let above = series.get(n + 1).map_or(0.0, |o| multiplication(n + 1) * o);
            series[n] = below + above;
            old_below = old;
        }
        if let Some(first) = series.first_mut() {
            *first += c;
        }
    }
    series
}

/// The polynomial derivative, as monomial coefficients.
#[must_use]
pub fn monomial_derivative(coefficients: &[f64]) -> Vec<f64> {
    let derived = coefficients.iter().enumerate().skip(1);
    derived.map(|(k, c)| k as f64 * c).collect()
}

/// The derivative of the series.
///
/// From `(2n+1) P_n = P'_{n+1} - P'_{n-1}`, downwards.
#[must_use]
pub fn derivative(series: &[f64]) -> Vec<f64> {
    let norm = |n: usize| (2.0 * n as f64 + 1.0).sqrt();
    let mut derived = vec![0.0; series.len().saturating_sub(1)];
    // `carried[parity]` is the sum of the coefficients above of one parity, in units of P_n.
    let mut carried = [0.0; 2];
    for n in (1..series.len()).rev() {
        carried[n % 2] += series[n] * norm(n);
        derived[n - 1] = 2.0 * norm(n - 1) * carried[n % 2];
    }
    derived
}

/// Value of the series at `x`, by Clenshaw's rule on the three-term recurrence.
#[must_use]
pub fn evaluate(series: &[f64], x: f64) -> f64 {
    let table = &recurrence()[..series.len() + 1];
    let (mut next, mut after) = (0.0, 0.0);
    for (n, c) in series.iter().enumerate().rev() {
        let (_, inverse, ratio) = table[n + 1];
        let value = c + x * inverse * next - ratio * after;
        (next, after) = (value, next);
    }
    next
}

/// The primitive of the series that has zero mean over the width.
///
/// From `int P_n = (P_{n+1} - P_{n-1})/(2n+1)`; the constant of integration drops out with the mean.
#[must_use]
pub fn integrate_zero_mean(series: &[f64]) -> Vec<f64> {
    let mut primitive = vec![0.0; series.len() + 1];
    for (n, c) in series.iter().enumerate() {
        let m = 2.0 * n as f64;
        primitive[n + 1] += 0.5 * c / ((m + 1.0) * (m + 3.0)).sqrt();
        if n >= 2 {
            primitive[n - 1] -= 0.5 * c / ((m + 1.0) * (m - 1.0)).sqrt();
        }
    }
    primitive
}

/// The series of `x f(x)`.
#[must_use]
pub fn multiply_by_x(series: &[f64]) -> Vec<f64> {
    let mut product = vec![0.0; series.len() + 1];
    for (n, c) in series.iter().enumerate() {
        product[n + 1] += multiplication(n + 1) * c;
        if n > 0 {
            product[n - 1] += multiplication(n) * c;
        }
    }
    product
}

/// Gauss-Legendre nodes and weights on the width, exact for polynomials of degree `2n-1`.
///
/// Newton's method on `p_n` from Tricomi's asymptotic nodes; weights `1/sum_k p_k(x)^2`.
#[must_use]
pub fn gauss(n: usize) -> (Vec<f64>, Vec<f64>) {
    let (mut nodes, mut weights) = (vec![0.0; n], vec![0.0; n]);
    for i in 0..n {
        let theta = std::f64::consts::PI * (4.0 * i as f64 + 3.0) / (4.0 * n as f64 + 2.0);
        let mut x = -0.5 * theta.cos();
        // Quadratic convergence from an error of O(n^-3): five steps reach rounding for every n.
        for _ in 0..5 {
            let (value, slope, _) = value_slope_sum(n, x);
            x -= value / slope;
        }
        nodes[i] = x;
        weights[i] = 1.0 / value_slope_sum(n, x).2;
    }
    (nodes, weights)
}

/// The rule of `n` nodes below 2048, computed once.
#[must_use]
pub fn rule(n: usize) -> &'static (Vec<f64>, Vec<f64>) {
    static RULES: [OnceLock<(Vec<f64>, Vec<f64>)>; TABULATED] = [const { OnceLock::new() }; TABULATED];
    RULES[n].get_or_init(|| gauss(n))
}

/// `p_n(x)`, `p_n'(x)` and `sum_{k<n} p_k(x)^2`.
fn value_slope_sum(n: usize, x: f64) -> (f64, f64, f64) {
    let (mut p, mut below) = (1.0, 0.0);
    let (mut d, mut d_below) = (0.0, 0.0);
    let mut sum = 0.0;
    for pair in recurrence()[..n + 1].windows(2) {
        sum += p * p;
        let (a, inverse) = (pair[0].0, pair[1].1);
        let next = (x * p - a * below) * inverse;
        let d_next = (p + x * d - a * d_below) * inverse;
        (below, p) = (p, next);
        (d_below, d) = (d, d_next);
    }
    (p, d, sum)
}

/// The first `n` coefficients of a function from its values at the nodes of [`gauss`]`(values.len())`.
#[must_use]
pub fn project(values: &[f64], nodes: &[f64], weights: &[f64], n: usize) -> Vec<f64> {
    let mut series = vec![0.0; n];
    for ((&f, &x), &w) in values.iter().zip(nodes).zip(weights) {
        let (mut p, mut below) = (1.0, 0.0);
        for (c, pair) in series.iter_mut().zip(recurrence().windows(2)) {
            *c += w * f * p;
            let next = (x * p - pair[0].0 * below) * pair[1].1;
            (below, p) = (p, next);
        }
    }
    series
}

#[cfg(test)]
mod tests {
    use super::*;

    fn horner(c: &[f64], x: f64) -> f64 {
        c.iter().rev().fold(0.0, |sum, c| sum * x + c)
    }

    #[test]
    fn series_reproduces_polynomial() {
        let c = [0.3, -1.0, 2.0, 0.5, -4.0, 7.0, 1.0];
        let series = from_monomials(&c);
        for x in [-0.5, -0.31, 0.0, 0.123, 0.5] {
            assert!((evaluate(&series, x) - horner(&c, x)).abs() < 4e-16 * 10.0);
        }
        assert!((from_monomials(&[0.0, 0.0, 1.0])[2] - 1.0 / (6.0 * 5f64.sqrt())).abs() < 1e-17);
    }

    #[test]
    fn primitive_and_product_are_exact() {
        let c = [0.3, -1.0, 2.0, 0.5, -4.0];
        let series = from_monomials(&c);
        let primitive = integrate_zero_mean(&series);
        let product = multiply_by_x(&series);
        let exact = |x: f64| (0..5).map(|k| c[k] * x.powi(k as i32 + 1) / (k as f64 + 1.0)).sum::<f64>();
        let mean = evaluate(&primitive, 0.0) - exact(0.0);
        for x in [-0.5, -0.2, 0.4] {
            assert!((evaluate(&primitive, x) - exact(x) - mean).abs() < 1e-15);
            assert!((evaluate(&product, x) - x * horner(&c, x)).abs() < 1e-15);
        }
        assert!(primitive[0].abs() < 1e-16);
        for (a, b) in derivative(&primitive).iter().zip(&series) {
            assert!((a - b).abs() < 1e-15);
        }
    }

    #[test]
    fn gauss_rule_is_exact_and_projects() {
        for n in [1, 2, 5, 40, 300] {
            let (nodes, weights) = gauss(n);
            assert!((weights.iter().sum::<f64>() - 1.0).abs() < 1e-14);
            let second: f64 = nodes.iter().zip(&weights).map(|(x, w)| w * x * x).sum();
            if n > 1 {
                assert!((second - 1.0 / 12.0).abs() < 1e-15);
            }
        }
        let (nodes, weights) = gauss(6);
        let c = [0.3, -1.0, 2.0, 0.5];
        let values: Vec<f64> = nodes.iter().map(|&x| horner(&c, x)).collect();
        let projected = project(&values, &nodes, &weights, 4);
        for (p, s) in projected.iter().zip(from_monomials(&c)) {
            assert!((p - s).abs() < 1e-15);
        }
    }
}
