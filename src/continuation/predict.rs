//! The next point of a branch, by the polynomial through the last ones that has the last tangent.

/// Weights of the states at `places`, the last of which the step of `length` starts from, relative to that state, and of the tangent there:
/// `x(s + length) - x(s) = sum_j w_j (x(places[j]) - x(s)) + w x'(s)` to the order of their number.
#[must_use]
pub fn weights(places: &[f64], length: f64) -> (Vec<f64>, f64) {
    let Some((&from, before)) = places.split_last() else { return (Vec::new(), length) };
    // The polynomials that are one at one of these places, and zero at the others and twice at the last.
    let lagrange = |j: usize| -> f64 {
        let own = before[j] - from;
        let others = before.iter().enumerate().filter(|(k, _)| *k != j);
        others.map(|(_, &other)| (from + length - other) / (before[j] - other)).product::<f64>()
            * (length / own).powi(2)
    };
    let tangent = before.iter().map(|&other| 1.0 + length / (from - other)).product::<f64>() * length;
    ((0..before.len()).map(lagrange).collect(), tangent)
}

#[cfg(test)]
mod tests {
    use super::weights;

    #[test]
    fn continues_polynomials() {
        let places = [-1.0, -0.3, 0.1, 0.4];
        for count in 1..=4 {
            let places = &places[4 - count..];
            for power in 1..=count as i32 {
                let value = |s: f64| (s + 2.0).powi(power);
                let (weights, tangent) = weights(places, 0.7);
                let change = |s: f64| value(s) - value(0.4);
                let sum: f64 = weights.iter().zip(places).map(|(w, &s)| w * change(s)).sum();
                let slope = f64::from(power) * 2.4f64.powi(power - 1);
                assert!((sum + tangent * slope - change(1.1)).abs() < 1e-12);
            }
        }
    }
}
