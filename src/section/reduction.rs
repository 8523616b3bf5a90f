//! What the growth fields leave in the section energy.
//!
//! Integrals over the width of every term that does not involve the deflection, and the part of the
//! membrane mismatch that the deflection can relieve, as a Legendre series.

use super::basis;
use crate::growth::Growth;
use crate::legendre;
use crate::material::{PlaneStress, SectionConstants};

/// The growth seen by the section: means, variances, and the mismatch left for the deflection.
///
/// With `t = (x^2/2)~` (the tilde removes the components on `1` and `x`), which is also the double
/// integral of `1`, the mismatch between the axial membrane strain and the growth is
///
/// ```text
/// w = [K3^2 + K2 (nu K2 + delta) - offset] t + K2 s(x) - gamma(x),     s, gamma of degree >= 3.
/// ```
#[derive(Clone, Debug)]
pub struct Reduction {
    /// Constants of the material.
    pub material: SectionConstants,
    /// Mean axial growth: natural `eps` of the untwisted section.
    pub eps: f64,
    /// The constant part of `gamma33`.
    pub eps_constant: f64,
    /// 24 times the mean of the rest of `gamma33`: the square of the twist at which `eps_constant` is natural.
    pub eps_spread: f64,
    /// Natural curvature `12 <x gamma33>` in the plane of the ribbon.
    pub k1: f64,
    /// Mean of `d33`: `-d33` is the natural curvature of bending alone.
    pub d33: f64,
    /// Variance of `d33` over the width.
    pub d33_variance: f64,
    /// Natural twist `<d23/2 - g31'/2>` of the section.
    pub k3: f64,
    /// Variance of `d23/2 - g31'/2` over the width.
    pub k3_variance: f64,
    /// `offset`: the parabolic part of `gamma33` in units of `t`; `8 xi` for edge growth.
    pub offset: f64,
    /// `delta`: the part of the natural transverse curvature whose double integral is along `t`.
    pub delta: f64,
    /// Legendre coefficients, degree 0 up, of the rest of `gamma33`; those below degree 3 are zero.
    pub gamma: Vec<f64>,
    /// Legendre coefficients of `s`; those below degree 3 are zero.
    pub s: Vec<f64>,
    /// Legendre coefficients of `d22 + nu d33 - g21'`.
    pub curvature: Vec<f64>,
    /// Legendre coefficients of `gamma33`.
    pub gamma33: Vec<f64>,
    /// Legendre coefficients of `gamma33''`.
    pub gamma33_curvature: Vec<f64>,
    /// Legendre coefficients of `gamma22`.
    pub gamma22: Vec<f64>,
    /// Legendre coefficients of `gamma23`.
    pub gamma23: Vec<f64>,
}

impl Reduction {
    /// Integrates the fields of `growth`, which must have passed [`Growth::validate`].
    #[must_use]
    pub fn new(growth: &Growth, stiffness: &PlaneStress) -> Self {
        let material = stiffness.section_constants();
        let d33 = legendre::from_monomials(&growth.d33);
        let twist = axpy(
            -0.5,
            &legendre::from_monomials(&legendre::monomial_derivative(&growth.g31)),
            &scaled(0.5, &legendre::from_monomials(&growth.d23)),
        );
        let curvature = axpy(
            -1.0,
            &legendre::from_monomials(&legendre::monomial_derivative(&growth.g21)),
            &axpy(material.nu, &d33, &legendre::from_monomials(&growth.d22)),
        );
        // The constant part is `t` itself and enters exactly; only the rest goes through the basis.
        let mut varying = curvature.clone();
        let constant = varying.first_mut().map_or(0.0, std::mem::take);
        let mut s = basis::double_integral(&varying);
        let delta = constant + s.get(2).map_or(0.0, |s2| s2 / basis::PARABOLA);
        let mut gamma = legendre::from_monomials(&growth.gamma33);
        let gamma33 = gamma.clone();
        for series in [&mut s, &mut gamma] {
            series.iter_mut().take(3).for_each(|c| *c = 0.0);
            while series.last() == Some(&0.0) {
                series.pop();
            }
        }
        Self {
            material,
            eps: monomial_sum(&growth.gamma33, |k| even(k) / (k + 1.0)),
            eps_constant: growth.gamma33.first().copied().unwrap_or(0.0),
            eps_spread: monomial_sum(
                &growth.gamma33,
                |k| if k > 0.0 { 24.0 * even(k) / (k + 1.0) } else { 0.0 },
            ),
            k1: monomial_sum(&growth.gamma33, |k| 6.0 * odd(k) / (k + 2.0)),
            d33: monomial_sum(&growth.d33, |k| even(k) / (k + 1.0)),
            d33_variance: variance(&d33),
            k3: twist.first().copied().unwrap_or(0.0),
            k3_variance: variance(&twist),
            offset: monomial_sum(&growth.gamma33, |k| even(k) * 60.0 * k / ((k + 1.0) * (k + 3.0))),
            delta,
            gamma,
            s,
            curvature,
            gamma33,
            gamma33_curvature: legendre::from_monomials(&legendre::monomial_derivative(
                &legendre::monomial_derivative(&growth.gamma33),
            )),
            gamma22: legendre::from_monomials(&growth.gamma22),
            gamma23: legendre::from_monomials(&growth.gamma23),
        }
    }

    /// Whether the mismatch is along `t` alone, so that the closed form holds.
    #[must_use]
    pub fn is_parabolic(&self) -> bool {
        self.gamma.is_empty() && self.s.is_empty()
    }

    /// Whether the mismatch has a part odd in `x`.
    #[must_use]
    pub fn has_odd_part(&self) -> bool {
        let odd = |series: &[f64]| series.iter().skip(1).step_by(2).any(|&c| c != 0.0);
        odd(&self.gamma) || odd(&self.s)
    }

    /// Highest Legendre degree of the mismatch.
    #[must_use]
    pub fn degree(&self) -> usize {
        self.gamma.len().max(self.s.len()).max(3) - 1
    }

    /// Whether `K2 -> -K2` leaves the energy unchanged.
    ///
    /// Only cross products of what is even and odd in `K2` break the symmetry: bending against
    /// `<d33>`, and within each parity in `x` the shape `s` against `t` and `gamma`.
    #[must_use]
    pub fn is_symmetric_in_bending(&self) -> bool {
        let zero = |series: &[f64], parity| series.iter().skip(parity).step_by(2).all(|&c| c == 0.0);
        self.d33 == 0.0 && self.delta == 0.0 && zero(&self.s, 0) && (zero(&self.s, 1) || zero(&self.gamma, 1))
    }
}

/// `sum_k c_k m(k) / 2^k`, for moments that are rational up to the power of two.
fn monomial_sum(coefficients: &[f64], moment: impl Fn(f64) -> f64) -> f64 {
    let terms = coefficients.iter().zip(0..);
    terms.map(|(c, k)| c * (moment(f64::from(k)) / 2f64.powi(k))).sum()
}

fn even(k: f64) -> f64 {
    1.0 - k % 2.0
}

fn odd(k: f64) -> f64 {
    k % 2.0
}

fn variance(series: &[f64]) -> f64 {
    series.iter().skip(1).map(|c| c * c).sum()
}

fn scaled(factor: f64, series: &[f64]) -> Vec<f64> {
    series.iter().map(|c| factor * c).collect()
}

/// `a u + v` for series of any lengths.
fn axpy(a: f64, u: &[f64], v: &[f64]) -> Vec<f64> {
    let mut sum = v.to_vec();
    sum.resize(u.len().max(v.len()), 0.0);
    sum.iter_mut().zip(u).for_each(|(s, u)| *s += a * u);
    sum
}
