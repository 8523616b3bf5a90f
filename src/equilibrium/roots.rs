//! Every real root of an analytic function on an interval, from its Chebyshev series.
//!
//! The function is replaced on the interval by its interpolant at Chebyshev points, to rounding; the
//! interval is then bisected until each piece is shown, by bounds on the coefficients, to hold no root
//! or to be monotone. What cannot be decided (roots closer than the tolerance, or values lost in
//! rounding) is returned as a cluster, never dropped.

use std::sync::OnceLock;

/// Points of the interpolant. Enough for the functions of [`super::reduced`] on intervals no longer
/// than their distance from the imaginary axis, see there.
const POINTS: usize = 30;

/// Pieces narrower than this (in `K2/eta`, relative beyond 1) are not bisected further.
const NARROWEST: f64 = 1e-8;

/// A root, or a place where roots could not be told apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Root {
    /// Where.
    pub x: f64,
    /// Whether the function changes sign here exactly once.
    pub simple: bool,
}

/// How often the function is sampled anew on a smaller interval before its values count as lost.
const DEEPEST: usize = 14;

/// Pieces that are sampled anew reach over their ends by this part of their length: a root on a border
/// is then inside one of its neighbours, whatever rounding does to the sign on the border itself.
const OVERLAP: f64 = 1e-3;

/// All roots of `f` in `[a, b]` and a little beyond; one near the border of two pieces may come twice.
pub fn roots(f: impl Fn(f64) -> f64, a: f64, b: f64) -> Vec<Root> {
    let mut found = Vec::new();
    resolve(&f, a, b, 0, &mut found);
    found
}

/// Samples `f` on `[a, b]` and isolates the roots of its interpolant, bisecting first if needed.
///
/// The coefficients of an analytic function fall until they reach the rounding errors of its values and
/// stay there: that floor is the noise below which signs mean nothing.
fn resolve(f: &impl Fn(f64) -> f64, a: f64, b: f64, depth: usize, found: &mut Vec<Root>) {
    let reach = OVERLAP * (b - a);
    let (a, b) = (a - reach, b + reach);
    let values = points().map(|t| f(0.5 * (a + b) + 0.5 * (b - a) * t));
    if values.iter().any(|v| !v.is_finite()) {
        found.push(Root { x: 0.5 * (a + b), simple: false });
        return;
    }
    let series = interpolate(&values);
    let largest = |c: &[f64]| c.iter().fold(0.0, |m: f64, c| m.max(c.abs()));
    let size = largest(&series);
    let (before, tail) = (largest(&series[POINTS - 9..POINTS - 6]), largest(&series[POINTS - 3..]));
    let resolved = tail <= 1e-14 * size;
    // Six coefficients further a converging series would have fallen by 5.8^6 = 4e4.
    let floor = tail >= 1e-2 * before && tail <= 1e-3 * size;
    if resolved || floor {
        let noise = 1e-14 * size + 4.0 * if resolved { tail } else { before.max(tail) };
        isolate(f, &trimmed(&series, 0.1 * noise), (a, b), noise, depth, found);
    } else if depth < DEEPEST && b - a > narrowest(a) {
        let middle = 0.5 * (a + b);
        resolve(f, a, middle, depth + 1, found);
        resolve(f, middle, b, depth + 1, found);
    } else {
        found.push(Root { x: 0.5 * (a + b), simple: false });
    }
}

fn narrowest(x: f64) -> f64 {
    NARROWEST * x.abs().max(1.0)
}

/// Roots on `[a, b]` of a function with this Chebyshev series, its values known to `noise`.
fn isolate(
    f: &impl Fn(f64) -> f64,
    series: &[f64],
    (a, b): (f64, f64),
    noise: f64,
    depth: usize,
    found: &mut Vec<Root>,
) {
    let rest = |c: &[f64]| c.iter().skip(1).map(|c| c.abs()).sum::<f64>();
    let spread = rest(series);
    if series[0].abs() > spread + noise {
        return;
    }
    let middle = 0.5 * (a + b);
    let slope = derivative(series);
    let monotone = slope[0].abs() > rest(&slope);
    let (left, right) = (clenshaw(series, -1.0), clenshaw(series, 1.0));
    if spread <= noise || (monotone && left.abs().min(right.abs()) <= noise) {
        // Lost in the rounding of larger values elsewhere: smaller ones here may be known better.
        if depth < DEEPEST && b - a > narrowest(middle) {
            resolve(f, a, b, depth + 1, found);
        } else {
            found.push(Root { x: middle, simple: false });
        }
        return;
    }
    if monotone {
        if left.signum() != right.signum() {
            let t = bracketed_newton(series, &slope, left);
            found.push(Root { x: middle + 0.5 * (b - a) * t, simple: true });
        }
        return;
    }
    if b - a < narrowest(middle) {
        found.push(Root { x: middle, simple: false });
        return;
    }
    // Off the middle, where symmetric functions like to vanish.
    let cut = 0.031;
    for (from, to) in [(-1.0, cut), (cut, 1.0)] {
        let (centre, half) = (0.5 * (from + to), 0.5 * (to - from));
        let values = points().map(|t| clenshaw(series, centre + half * t));
        let piece = trimmed(&interpolate(&values), 0.1 * noise);
        let at = |t: f64| middle + 0.5 * (b - a) * t;
        isolate(f, &piece, (at(from), at(to)), noise, depth, found);
    }
}

/// Root in `[-1, 1]` of a monotone series with value `left` at `-1` and the opposite sign at `1`.
fn bracketed_newton(series: &[f64], slope: &[f64], left: f64) -> f64 {
    let (mut low, mut high, mut t) = (-1.0, 1.0, 0.0);
    for _ in 0..60 {
        let value = clenshaw(series, t);
        if value == 0.0 {
            break;
        }
        if value.signum() == left.signum() {
            low = t;
        } else {
            high = t;
        }
        let step = value / clenshaw(slope, t);
        let newton = t - step;
        let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        if (next - t).abs() <= 1e-16 {
            break;
        }
        t = next;
    }
    t
}

/// Chebyshev points of the first kind.
fn points() -> [f64; POINTS] {
    static TABLE: OnceLock<[f64; POINTS]> = OnceLock::new();
    *TABLE.get_or_init(|| std::array::from_fn(|i| angle(i).cos()))
}

fn angle(i: usize) -> f64 {
    std::f64::consts::PI * (i as f64 + 0.5) / POINTS as f64
}

/// Chebyshev coefficients of the interpolant of values at [`points`].
fn interpolate(values: &[f64; POINTS]) -> [f64; POINTS] {
    static TABLE: OnceLock<Vec<[f64; POINTS]>> = OnceLock::new();
    let cosines = TABLE.get_or_init(|| {
        let row = |k: usize| {
            let weight = if k == 0 { 1.0 } else { 2.0 } / POINTS as f64;
            std::array::from_fn(|i| weight * (k as f64 * angle(i)).cos())
        };
        (0..POINTS).map(row).collect()
    });
    std::array::from_fn(|k| cosines[k].iter().zip(values).map(|(c, v)| c * v).sum())
}

/// The series without its last coefficients, as long as they add up to less than `negligible`.
fn trimmed(series: &[f64; POINTS], negligible: f64) -> Vec<f64> {
    let mut dropped = 0.0;
    let mut length = POINTS;
    while length > 2 && dropped + series[length - 1].abs() < negligible {
        dropped += series[length - 1].abs();
        length -= 1;
    }
    series[..length].to_vec()
}

fn clenshaw(series: &[f64], t: f64) -> f64 {
    let (mut next, mut after) = (0.0, 0.0);
    for c in series.iter().skip(1).rev() {
        (next, after) = (c + 2.0 * t * next - after, next);
    }
    series[0] + t * next - after
}

/// Series of the derivative in `t`: `c'_{k-1} = c'_{k+1} + 2 k c_k`.
fn derivative(series: &[f64]) -> Vec<f64> {
    let n = series.len();
    let mut slope = vec![0.0; n + 1];
    for k in (1..n).rev() {
        slope[k - 1] = slope[k + 1] + 2.0 * k as f64 * series[k];
    }
    slope.truncate(n.max(2) - 1);
    slope[0] *= 0.5;
    slope
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sorted(f: impl Fn(f64) -> f64, a: f64, b: f64) -> Vec<Root> {
        let mut found = roots(f, a, b);
        found.sort_by(|p, q| p.x.total_cmp(&q.x));
        found.dedup_by(|p, q| p.simple && q.simple && (p.x - q.x).abs() < 1e-12);
        found
    }

    #[test]
    fn finds_every_root_of_an_oscillation() {
        let found = sorted(|x| (3.0 * x).sin(), -4.0, 9.0);
        let exact: Vec<f64> = (-3..=8).map(|k| f64::from(k) * std::f64::consts::PI / 3.0).collect();
        assert_eq!(found.len(), exact.len());
        for (root, exact) in found.iter().zip(exact) {
            assert!(root.simple && (root.x - exact).abs() < 1e-13);
        }
    }

    #[test]
    fn separates_close_roots_and_reports_what_it_cannot() {
        let pair = |gap: f64| move |x: f64| (x - 0.3 - gap) * (x - 0.3 + gap) * (2.0 + x.cos());
        assert_eq!(sorted(pair(1e-5), 0.0, 1.0).len(), 2);
        for gap in [1e-9, 0.0] {
            let found = sorted(pair(gap), 0.0, 1.0);
            assert!(!found.is_empty());
            assert!(found.iter().all(|r| (r.x - 0.3).abs() < 1e-6));
        }
        assert!(sorted(|x| (x - 0.3).powi(2) + 1e-6, 0.0, 1.0).is_empty());
    }

    #[test]
    fn a_root_on_the_border_is_in_one_of_the_neighbours() {
        for x in [0.0, 1e-300, 1e-16, -1e-14, 1e-9] {
            let f = |k: f64| (k - x) * (3.0 + k.sin());
            let both = [sorted(f, -4.0, 0.0), sorted(f, 0.0, 4.0)].concat();
            assert!(both.iter().any(|root| root.simple && (root.x - x).abs() < 1e-14));
        }
    }
}
