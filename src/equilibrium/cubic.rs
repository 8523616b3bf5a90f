//! Real roots of the torsion equation.

/// Real roots of `a q^3 + e q = h` with `a >= 0`, `e != 0` if `a = 0`.
///
/// Multiple roots may come out once or separated by rounding; callers polish.
pub fn real_roots(a: f64, e: f64, h: f64) -> Vec<f64> {
    if h == 0.0 {
        let squared = -e / a;
        return if squared > 0.0 { vec![0.0, squared.sqrt(), -squared.sqrt()] } else { vec![0.0] };
    }
    if a == 0.0 {
        return vec![h / e];
    }
    // q = 2 r u with r^2 = |e|/(3a) makes it 4u^3 + 3 sign(e) u = v.
    let r = (e.abs() / (3.0 * a)).sqrt();
    let v = 0.5 * h / (a * r * r * r);
    if !v.is_finite() || v.abs() > 1e100 {
        return vec![(h / a).cbrt()];
    }
    if e > 0.0 {
        return vec![2.0 * r * (v.asinh() / 3.0).sinh()];
    }
    if v.abs() > 1.0 {
        return vec![2.0 * r * v.signum() * (v.abs().acosh() / 3.0).cosh()];
    }
    let third = v.acos() / 3.0;
    let turn = 2.0 * std::f64::consts::FRAC_PI_3;
    [0.0, turn, -turn].map(|shift| 2.0 * r * (third + shift).cos()).to_vec()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_satisfy_the_cubic() {
        for (a, e, h, count) in [
            (1.0, -3.0, 1.0, 3),
            (1.0, -3.0, 2.5, 1),
            (0.01, 0.05, 0.3, 1),
            (2.0, -1.0, 0.0, 3),
            (2.0, 1.0, 0.0, 1),
            (0.0, 2.0, 1.0, 1),
            (1.0, 1e-300, 8.0, 1),
            (1.0, -7.0, -6.0, 3),
        ] {
            let roots = real_roots(a, e, h);
            assert_eq!(roots.len(), count);
            for q in roots {
                let size = (a * q * q * q).abs() + (e * q).abs() + h.abs();
                assert!((a * q * q * q + e * q - h).abs() <= 1e-15 * size * 4.0);
            }
        }
    }
}
