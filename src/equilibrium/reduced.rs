//! Equilibrium of the unloaded section, reduced to one function of one curvature.
//!
//! In units of the thickness ratio, `k = K2/eta`, `q = K3/eta`, the energy at fixed `k` is a quartic
//! in `q`, `Pi/eta^4 = g (q - q0)^2 + c(k) + b(k) q^2 + A(k) q^4/2 + (k + d)^2/24 + const`, so that
//!
//! ```text
//! torsion:  A q^3 + (b + g) q - g q0 = 0,
//! bending:  (k + d)/12 + c' + b' q^2 + A' q^4/2 = 0.
//! ```
//!
//! An equilibrium is a common root in `q`. Its `k` is a root of the resultant of the two polynomials,
//! one analytic function of `k`, on which all sheets of the cubic meet without folds. Without natural
//! twist (`q0 = 0`) the resultant has a double factor and the two sheets `q = 0` and
//! `q^2 = -(b + g)/A` are used instead, each analytic by itself. Where `K2 -> -K2` is a symmetry the
//! bending equation is divided by `k`, which takes out the roots at `k = 0`.
//!
//! `A`, `b`, `c` have poles on the imaginary axis only, none with `|k| < 7.4578` (incompressible
//! material: the zeros of `sinh z + sin z`; in proportion to `beta` for others), so Chebyshev series on
//! intervals no longer than their distance from the axis converge like `5.8^-n` or faster.

use super::cubic;
use crate::section::Section;

/// The coefficient functions at one `k`.
#[derive(Clone, Copy, Debug)]
pub struct Coefficients {
    a: f64,
    a1: f64,
    b1: f64,
    /// `b + g`
    e: f64,
    /// `(k + d)/12 + c'`
    c1: f64,
    /// `g q0`
    h: f64,
}

impl Coefficients {
    /// The coefficient functions of the law at `k = K2/eta`.
    pub fn at(section: &Section, k: f64) -> Self {
        let reduction = section.reduction();
        let (eta, g) = (section.eta(), reduction.material.twist);
        let k2 = k * eta;
        let relaxed = section.relaxation().derivatives(k2, 0.0);
        Self {
            a: relaxed.dpp,
            a1: relaxed.d2pp,
            b1: relaxed.d2p,
            e: relaxed.dp + g,
            c1: (k2 + reduction.d33) / eta / 12.0 + relaxed.d2,
            h: g * reduction.k3 / eta,
        }
    }

    /// The same with the bending equation divided by `k`.
    pub fn bending_over(self, k: f64) -> Self {
        Self { a1: self.a1 / k, b1: self.b1 / k, c1: self.c1 / k, ..self }
    }

    /// The twists `q` that satisfy the torsion equation at this `k`.
    pub fn twists(&self) -> Vec<f64> {
        cubic::real_roots(self.a, self.e, self.h)
    }

    /// Bending equation on the sheet `q = 0`, an equilibrium in torsion if `q0 = 0`.
    pub fn untwisted(&self) -> f64 {
        self.c1
    }

    /// `A^2` times the bending equation on the sheet `q^2 = -(b + g)/A`.
    pub fn twisted(&self) -> f64 {
        let Self { a, a1, b1, e, c1, .. } = *self;
        0.5 * a1 * e * e - a * b1 * e + a * a * c1
    }

    /// `q^2` on the twisted sheet; no equilibrium where it is negative.
    pub fn twist_squared(&self) -> f64 {
        -self.e / self.a
    }

    /// Resultant in `q` of the torsion equation and the remainder `alpha q^2 + beta q + gamma` of `2A`
    /// times the bending equation divided by it.
    pub fn resultant(&self) -> f64 {
        let Self { a, a1, b1, e, c1, h } = *self;
        let (alpha, beta, gamma) = (2.0 * a * b1 - a1 * e, a1 * h, 2.0 * a * c1);
        a * a * gamma.powi(3)
            + a * e * gamma * (beta * beta - 2.0 * alpha * gamma)
            + a * h * beta * (beta * beta - 3.0 * alpha * gamma)
            + alpha * alpha * (e * e * gamma + e * h * beta + h * h * alpha)
    }
}

/// A bound on `|K2|/eta` of every unloaded equilibrium.
///
/// Scaling curvatures and deflection together by `1 + delta` leaves the energy stationary, so with `Q`
/// the bending energy of the deformed section, `Q_g` that of the growth's natural curvatures and
/// `gamma` the part of `gamma33` beyond `1` and `x`: `Q - (Q Q_g)^(1/2) <= |gamma|^2/4`, and
/// `Q >= eta^2 K2^2/24`.
pub fn bound(section: &Section) -> f64 {
    let r = section.reduction();
    let eta = section.eta();
    let norm2 = |series: &[f64]| series.iter().map(|c| c * c).sum::<f64>();
    let gamma2 = norm2(r.gamma33.get(2..).unwrap_or_default());
    let natural = (r.d33 * r.d33 + r.d33_variance) / 24.0
        + 0.5 * r.material.beta2 * norm2(&r.curvature)
        + r.material.twist * (r.k3 * r.k3 + r.k3_variance);
    let natural = natural * eta * eta;
    let root = 0.5 * (natural.sqrt() + (natural + gamma2).sqrt());
    24f64.sqrt() * root / (eta * eta)
}
