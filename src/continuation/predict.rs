//! The next point of a branch, from the tangents at the last ones: Adams and Bashforth's formulas for uneven steps.

/// Weights `w_j` of the tangents at `places[j]`, the last of which the step of `length` starts from:
/// `x(s + length) = x(s) + sum_j w_j x'(places[j])` to the order of their number, at most four.
#[must_use]
pub fn weights(places: &[f64], length: f64) -> Vec<f64> {
    let Some(&from) = places.last() else { return Vec::new() };
    // The Lagrange polynomials, of degree at most three, integrated by two Gauss points.
    let gauss = 0.5 / 3f64.sqrt();
    let points = [0.5 - gauss, 0.5 + gauss].map(|y| from + length * y);
    let lagrange = |j: usize, s: f64| -> f64 {
        let others = places.iter().enumerate().filter(|(k, _)| *k != j);
        others.map(|(_, &other)| (s - other) / (places[j] - other)).product()
    };
    (0..places.len()).map(|j| points.map(|s| 0.5 * length * lagrange(j, s)).iter().sum()).collect()
}

#[cfg(test)]
mod tests {
    use super::weights;

    #[test]
    fn integrates_cubics() {
        let places = [-1.0, -0.3, 0.1, 0.4];
        for count in 1..=4 {
            let places = &places[4 - count..];
            for power in 0..count as i32 {
                let sum: f64 = weights(places, 0.7).iter().zip(places).map(|(w, s)| w * s.powi(power)).sum();
                let exact = (1.1f64.powi(power + 1) - 0.4f64.powi(power + 1)) / f64::from(power + 1);
                assert!((sum - exact).abs() < 1e-14);
            }
        }
    }
}
