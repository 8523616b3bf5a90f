//! The edge-layer function `sigma` of the closed forms, without cancellation or overflow.
//!
//! ```text
//! tau(z) = (2/z) (cosh z - cos z)/(sinh z + sin z),     sigma(y) = (1 - tau)/y,     y = z^4.
//! ```
//!
//! `sigma` is a Stieltjes function of `y >= 0`: a sum of `c_j/(1 + mu_j y)` with positive `c_j`, `mu_j`.
//! Below `z = 6` it is evaluated as its Galerkin approximant with eight such terms (relative error
//! 4e-19 at the switch, 2e-17 in the second derivative): every term has the sign of the sum, so value
//! and derivatives lose nothing. Above, `1 - tau` no longer cancels and the quotient is used with
//! `exp(-z)` taken out.

/// `sigma`, `d sigma/dy` and `d^2 sigma/dy^2`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sigma {
    /// `sigma(y)`.
    pub value: f64,
    /// First derivative in `y`.
    pub first: f64,
    /// Second derivative in `y`.
    pub second: f64,
}

/// `(c_j, mu_j)`: squared projections and eigenvalues of the even part of the matrix `F` of [`super::basis`]
/// with eight functions, `4 F_j2^2` and `4 sigma_j^2`, computed with 60 digits.
const TERMS: [(f64, f64); 8] = [
    (0.005_516_425_522_614_611, 0.007_990_987_736_215_545),
    (3.621_057_150_797_412e-5, 0.000_273_642_167_992_903_54),
    (2.404_943_830_136_363e-6, 4.487_553_760_216_459e-5),
    (3.747_093_701_476_993_5e-7, 1.297_287_630_819_636_2e-5),
    (9.892_146_992_431_697e-8, 4.854_317_890_787_263e-6),
    (3.497_313_273_518_072e-8, 1.556_213_787_923_496_5e-6),
    (5.760_363_308_987_93e-9, 2.252_512_074_856_554_4e-7),
    (1.532_667_185_210_707e-10, 5.796_524_235_301_085e-9),
];

/// `y = z^4` at the switch.
const SWITCH: f64 = 1296.0;

/// The value alone.
#[must_use]
pub fn value(y: f64) -> f64 {
    if y < SWITCH {
        TERMS.iter().map(|(c, mu)| c / (1.0 + mu * y)).sum()
    } else {
        (1.0 - tau(y.sqrt().sqrt()).0) / y
    }
}

/// Value and two derivatives.
#[must_use]
pub fn derivatives(y: f64) -> Sigma {
    if y < SWITCH {
        let (mut value, mut first, mut second) = (0.0, 0.0, 0.0);
        for (c, mu) in TERMS {
            let d = 1.0 / (1.0 + mu * y);
            let cd = c * d;
            let m = mu * d;
            value += cd;
            first -= cd * m;
            second += 2.0 * cd * (m * m);
        }
        return Sigma { value, first, second };
    }
    let z = y.sqrt().sqrt();
    let (tau, slope, curvature) = tau(z);
    // d/dy = (1/(4 z^3)) d/dz
    let tau_y = slope * z / (4.0 * y);
    let tau_yy = (z * z * curvature - 3.0 * z * slope) / (16.0 * y * y);
    let value = (1.0 - tau) / y;
    let first = -(tau_y + value) / y;
    Sigma { value, first, second: -(tau_yy + 2.0 * first) / y }
}

/// `tau` and its derivatives in `z`, for `z` not small.
///
/// With `N = cosh z - cos z`, `D = sinh z + sin z = N'`, and `q = N/D`: `q' = 1 - q D'/D`,
/// `q'' = -q' D'/D - q (D''/D - (D'/D)^2)`.
fn tau(z: f64) -> (f64, f64, f64) {
    let e = (-z).exp();
    let (sin, cos) = z.sin_cos();
    // Both scaled by 2 exp(-z).
    let denominator = 1.0 - e * e + 2.0 * e * sin;
    let q = (1.0 + e * e - 2.0 * e * cos) / denominator;
    let d1 = (1.0 + e * e + 2.0 * e * cos) / denominator;
    let d2 = (1.0 - e * e - 2.0 * e * sin) / denominator;
    let q1 = 1.0 - q * d1;
    let q2 = -q1 * d1 - q * (d2 - d1 * d1);
    let tau = 2.0 * q / z;
    let slope = (2.0 * q1 - tau) / z;
    (tau, slope, 2.0 * (q2 - slope) / z)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn terms_have_the_taylor_coefficients_of_sigma() {
        // 1 - tau = y/180 - y^2/22680 + 2879 y^3/8172964800 - 3911 y^4/1389404016000 + ...
        let taylor = [1.0 / 180.0, 1.0 / 22680.0, 2879.0 / 8_172_964_800.0, 3911.0 / 1_389_404_016_000.0];
        for (k, exact) in taylor.iter().enumerate() {
            let moment: f64 = TERMS.iter().map(|(c, mu)| c * mu.powi(k as i32)).sum();
            assert!((moment / exact - 1.0).abs() < 1e-15);
        }
    }

    #[test]
    fn both_branches_agree_across_the_switch() {
        let below = derivatives(SWITCH.next_down());
        let above = derivatives(SWITCH);
        // Rounding of a dozen operations; the second derivative divides differences by y twice.
        assert!((below.value / above.value - 1.0).abs() < 1e-15);
        assert!((below.first / above.first - 1.0).abs() < 2e-15);
        assert!((below.second / above.second - 1.0).abs() < 4e-15);
    }

    #[test]
    fn limits() {
        assert!((value(0.0) * 180.0 - 1.0).abs() < 1e-15);
        let z = 1e3;
        let far = derivatives(1e12);
        assert!((far.value - (1.0 - 2.0 / z) / 1e12).abs() < 1e-27);
        assert!((far.first * 1e24 + (1.0 - 2.5 / z)).abs() < 1e-14);
        assert!(derivatives(1e40).second.is_finite());
    }
}
