//! Roots of functions that are known at a few places.

/// Values by which a root is interpolated.
pub const MEMORY: usize = 5;

/// Of values of a function, with two of opposite sign, the nearest to those that are monotone outward from them: by the others another root is
/// told.
pub fn monotone(values: &[(f64, f64)], [low, high]: [(f64, f64); 2]) -> Vec<(f64, f64)> {
    let mut known = vec![low, high];
    for (end, outward) in [(low, -1.0), (high, 1.0)] {
        let distance = |value: &(f64, f64)| outward * (value.0 - end.0);
        let mut beyond: Vec<_> = values.iter().filter(|value| distance(value) > 0.0).collect();
        beyond.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
        let mut last = end.1;
        known.extend(
            beyond.into_iter().take_while(|value| value.1 / std::mem::replace(&mut last, value.1) > 1.0),
        );
    }
    let middle = 0.5 * (low.0 + high.0);
    known[2..].sort_by(|a, b| (a.0 - middle).abs().total_cmp(&(b.0 - middle).abs()));
    known.truncate(MEMORY);
    known
}

/// The root of a function by inverse interpolation of its values, and an estimate of its error: by how much the last value counts, or the third.
pub fn root(values: &[(f64, f64)]) -> (f64, f64) {
    let interpolated = |values: &[(f64, f64)]| -> f64 {
        (0..values.len())
            .map(|i| {
                let others = (0..values.len()).filter(|k| *k != i);
                values[i].0 * others.map(|k| values[k].1 / (values[k].1 - values[i].1)).product::<f64>()
            })
            .sum()
    };
    let place = interpolated(values);
    let without = |dropped: usize| {
        let others: Vec<_> = (0..values.len()).filter(|k| *k != dropped).map(|k| values[k]).collect();
        (place - interpolated(&others)).abs()
    };
    let last = values.len() - 1;
    (place, if last == 1 { (values[1].0 - values[0].0).abs() } else { without(last).max(without(2)) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_beyond_another_root_tell_of_that() {
        let ends = [(0.4, 1.0), (0.7, -2.1)];
        // The determinant turns back at 0.8.
        let values =
            [(0.4, 1.0), (1.0, -0.01), (0.97, -2.7), (0.7, -2.1), (0.2, 1.5), (0.1, 1.2), (0.8, -2.8)];
        assert_eq!(monotone(&values, ends), [ends[0], ends[1], (0.8, -2.8), (0.2, 1.5)]);
        let cube = |s: f64| (s, (s - 0.5).powi(3) + 0.1 * (s - 0.5));
        let values: Vec<_> = [0.3, 0.42, 0.53, 0.6, 0.8].map(cube).to_vec();
        let known = monotone(&values, [values[1], values[2]]);
        assert_eq!(known.len(), MEMORY);
        let (place, error) = root(&known);
        assert!((place - 0.5).abs() < error && error < 2e-2, "{place} {error}");
        // Of two values any place between is the root.
        assert_eq!(root(&known[..2]).1, values[2].0 - values[1].0);
    }
}
