//! Equilibrium of the unloaded section, reduced to one function of one curvature.
//!
//! In units of the thickness ratio, `k = K2/eta`, `q = K3/eta`, the relaxed energy at fixed `k` is a
//! quadratic in `p = q^2`, with curvature `A(k) > 0`, and natural twist `q0` costs `g (q - q0)^2`. With
//! `p0(k)` the place where `dPi/dp = 0` without natural twist, the two equations are
//!
//! ```text
//! torsion:  A q (q^2 - p0) = g q0,
//! bending:  F + B (p - p0) + G (p - p0)^2 = 0,      F = dPi/dk at p0,  B = d^2 Pi/(dk dp),  G = A'/2.
//! ```
//!
//! Without natural twist there are two sheets, `q = 0` with the bending equation `F0` and `p = p0` with
//! `F`. With it, the first equation turns the second into `F q^2 + h B q + h^2 G = 0`, `h = g q0/A`, and
//! an equilibrium is a common root of a quadratic and the cubic. Its `k` is a root of their resultant,
//!
//! ```text
//! F^2 F0 + h^2 [B^2 (B - p0 G) - F G (3B - 2 p0 G)] + h^4 G^3      (over h^2),
//! ```
//!
//! one analytic function of `k` in which all sheets of the cubic meet without folds. Where
//! `K2 -> -K2` is a symmetry the bending equation is divided by `k`, which takes out the roots at `k = 0`.
//!
//! The functions have poles on the imaginary axis only, none with `|k| < 7.4578` (incompressible
//! material: the zeros of `sinh z + sin z`; in proportion to `beta` for others), so Chebyshev series on
//! intervals no longer than their distance from the axis converge like `5.8^-n` or faster.

use super::cubic;
use crate::section::{Section, Square};

/// The bending equation on the sheets of the torsion equation, at one `k`.
#[derive(Clone, Copy, Debug)]
pub struct Sheets {
    /// `F0`: on the sheet `q = 0`.
    pub untwisted: f64,
    /// `F`: on the sheet `q^2 = p0`.
    pub twisted: f64,
    /// `p0`; no equilibrium on the twisted sheet where it is negative.
    pub twist_squared: f64,
    mixed: f64,
    half_slope: f64,
    h: f64,
}

impl Sheets {
    /// The sheets at `k = K2/eta`, with the bending equation divided by `k` if asked.
    pub fn at(section: &Section, k: f64, over_k: bool) -> Self {
        let r = section.reduction();
        let (eta, g) = (section.eta(), r.material.twist);
        let k2 = k * eta;
        let divisor = if over_k { k } else { 1.0 };
        let bend = (k2 + r.d33) / eta / 12.0;
        let flat = section.relaxation().derivatives(k2, Square::of(0.0));
        let twist_squared = -(flat.dp + g) / flat.dpp;
        let sheet = section.relaxation().derivatives(k2, Square::from_value(twist_squared * eta * eta));
        Self {
            untwisted: (bend + flat.d2) / divisor,
            twisted: (bend + sheet.d2) / divisor,
            twist_squared,
            mixed: sheet.d2p / divisor,
            half_slope: 0.5 * sheet.d2pp / divisor,
            h: g * (r.k3 / eta) / flat.dpp,
        }
    }

    /// The resultant of bending and torsion.
    pub fn resultant(&self) -> f64 {
        let Self { untwisted: f0, twisted: f, twist_squared: p0, mixed: b, half_slope: g, h } = *self;
        let h2 = h * h;
        let first_order = b * b * (b - p0 * g) - f * g * (3.0 * b - 2.0 * p0 * g);
        f * f * f0 + h2 * (first_order + h2 * g * g * g)
    }
}

/// The twists `q = K3/eta` that satisfy the torsion equation at `k = K2/eta`.
pub fn twists(section: &Section, k: f64) -> Vec<f64> {
    let r = section.reduction();
    let g = r.material.twist;
    let flat = section.relaxation().derivatives(k * section.eta(), Square::of(0.0));
    cubic::real_roots(flat.dpp, flat.dp + g, g * r.k3 / section.eta())
}
