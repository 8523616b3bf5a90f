//! Where a function along an edge vanishes: proposals, which a complete search confirms or not.

/// Most evaluations of a function.
const MOST: usize = 60;

/// A root in `[a, b]` of a continuous function by regula falsi (Illinois), to `width`.
///
/// `None` if the values at the ends have one sign or the function is lost on the way.
pub fn bracketed(mut f: impl FnMut(f64) -> Option<f64>, a: f64, b: f64, width: f64) -> Option<f64> {
    let (mut low, mut high) = ((a, f(a)?), (b, f(b)?));
    if low.1 == 0.0 || high.1 == 0.0 || low.1.signum() == high.1.signum() {
        return None;
    }
    let (mut last, mut side) = (f64::NAN, 0);
    for round in 0..MOST {
        let ((x0, f0), (x1, f1)) = (low, high);
        let secant = x1 - f1 * (x1 - x0) / (f1 - f0);
        // Every few rounds a bisection, should the function be far from a line.
        let x = if round % 8 == 7 || !(secant > x0 && secant < x1) { 0.5 * (x0 + x1) } else { secant };
        let value = f(x)?;
        if value == 0.0 || (x - last).abs() < 0.01 * width || x1 - x0 < 0.1 * width {
            return Some(x);
        }
        // An end that stays twice counts half.
        if value.signum() == f0.signum() {
            low = (x, value);
            high.1 *= if side == 1 { 0.5 } else { 1.0 };
            side = 1;
        } else {
            high = (x, value);
            low.1 *= if side == -1 { 0.5 } else { 1.0 };
            side = -1;
        }
        last = x;
    }
    None
}

/// Where a state ends between `a`, where it exists, and `b`, from a function that falls there to zero like a line.
///
/// The function is `None` beyond the end; it is extrapolated from this side.
pub fn ending(mut f: impl FnMut(f64) -> Option<f64>, a: f64, b: f64, width: f64) -> Option<f64> {
    let mut far = (a, f(a)?);
    let mut beyond = b;
    let mut x = a + 0.25 * (b - a);
    let mut near: Option<(f64, f64)> = None;
    for _ in 0..MOST {
        match f(x).filter(|&value| value > 0.0) {
            Some(value) => {
                if let Some(point) = near {
                    far = point;
                }
                near = Some((x, value));
            }
            None => beyond = x,
        }
        let (x1, f1) = near.unwrap_or(far);
        if (beyond - x1).abs() < 0.1 * width {
            return Some(0.5 * (beyond + x1));
        }
        let end = match near {
            Some(_) => x1 + f1 * (x1 - far.0) / (far.1 - f1),
            None => f64::NAN,
        };
        let inside = (end - x1) * (b - a) > 0.0 && (end - beyond) * (b - a) < 0.0;
        if inside && (end - x1).abs() < 0.1 * width {
            return Some(end);
        }
        // A little short of it, to stay where the state exists.
        x = if inside { x1 + 0.998 * (end - x1) } else { 0.5 * (x1 + beyond) };
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_of_a_smooth_function_in_few_steps() {
        let mut calls = 0;
        let f = |x: f64| {
            calls += 1;
            Some(x.exp() - 1.5)
        };
        let root = bracketed(f, 0.0, 1.0, 1e-14).unwrap();
        assert!((root - 1.5f64.ln()).abs() < 1e-14);
        assert!(calls < 16, "{calls}");
        assert_eq!(bracketed(Some, 1.0, 2.0, 1e-9), None);
    }

    #[test]
    fn ends_of_a_state_from_either_side() {
        // As the square of the softness at a fold: analytic in the square root of the distance.
        let fold = |d: f64| (d > 0.0).then(|| d + 0.7 * d.powf(1.5));
        for (a, b) in [(0.0, 1.0), (1.0, 0.0)] {
            let mut calls = 0;
            let end = ending(
                |x| {
                    calls += 1;
                    fold(if a < b { 0.4321 - x } else { x - 0.4321 })
                },
                a,
                b,
                1e-10,
            );
            assert!((end.unwrap() - 0.4321).abs() < 1e-10);
            assert!(calls < 24, "{calls}");
        }
    }
}
