//! What the growth fields leave in the section energy.
//!
//! Integrals over the width of every term that does not involve the deflection, and the part of the
//! membrane mismatch that the deflection can relieve, as a Legendre series.

use super::basis;
use super::mesh::{Mesh, Series, axpy};
use crate::growth::Growth;
use crate::legendre;
use crate::material::{PlaneStress, SectionConstants};

/// The growth seen by the section: means, variances, and the mismatch left for the deflection.
///
/// With `t = (x^2/2)~` (the tilde removes the components on `1` and `x`), which is also the double
/// integral of `1`, the mismatch between the axial membrane strain and the growth is
///
/// ```text
/// w = [K3^2 + K2 (nu K2 + delta) - offset] t + K2 s(x) - gamma(x),
/// ```
///
/// `s` and `gamma` having no component on `1`, `x` and `t`: without jumps, of Legendre degree 3 and more.
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
    /// The pieces between the jumps of the growth, on which the following are given.
    pub mesh: Mesh,
    /// The rest of `gamma33`.
    pub gamma: Series,
    /// `s`.
    pub s: Series,
    /// `d22 + nu d33 - g21'`.
    pub curvature: Series,
    /// `gamma33`.
    pub gamma33: Series,
    /// Norm of `gamma33''` over the width; infinite where growth jumps.
    pub gamma33_curvature: f64,
    /// `gamma22`.
    pub gamma22: Series,
    /// `gamma23`.
    pub gamma23: Series,
}

impl Reduction {
    /// Integrates the fields of `growth`, which must have passed [`Growth::validate`].
    #[must_use]
    pub fn new(growth: &Growth, stiffness: &PlaneStress) -> Self {
        Self::on(Mesh::of(growth), growth, stiffness)
    }

    /// The same on a finer mesh.
    #[must_use]
    pub fn on(mesh: Mesh, growth: &Growth, stiffness: &PlaneStress) -> Self {
        let material = stiffness.section_constants();
        let d33 = mesh.profile(&growth.d33);
        let twist =
            axpy(-0.5, &mesh.derivative(&growth.g31), &axpy(0.5, &mesh.profile(&growth.d23), &mesh.zero()));
        let curvature =
            axpy(-1.0, &mesh.derivative(&growth.g21), &axpy(material.nu, &d33, &mesh.profile(&growth.d22)));
        // The mean is `t` itself and enters exactly; only the rest goes through the basis.
        let mean = mesh.mean(&curvature);
        let mut s = mesh.double_integral(&axpy(-mean, &mesh.polynomial(&[1.0]), &curvature));
        let delta = mean + mesh.take_parabola(&mut s);
        // Moments of monomials are rational up to a power of two and more exact than those of the series.
        let axial = &growth.gamma33.polynomial;
        let gamma33 = mesh.profile(&growth.gamma33);
        let mut gamma = gamma33.clone();
        mesh.take_parabola(&mut gamma);
        let stepped = match &growth.gamma33.pieces {
            Some(pieces) => pieces.refined(mesh.breaks()).pieces().to_vec(),
            None => mesh.zero(),
        };
        let stepped_mean = mesh.mean(&stepped);
        let stepped_slope = mesh.mean(&mesh.multiply_by_x(&stepped));
        let stepped_parabola = mesh.dot(&stepped, &mesh.parabola()) / (basis::PARABOLA * basis::PARABOLA);
        Self {
            material,
            eps: stepped_mean + monomial_sum(axial, |k| even(k) / (k + 1.0)),
            eps_constant: stepped_mean + axial.first().copied().unwrap_or(0.0),
            eps_spread: monomial_sum(axial, |k| if k > 0.0 { 24.0 * even(k) / (k + 1.0) } else { 0.0 }),
            k1: 12.0 * stepped_slope + monomial_sum(axial, |k| 6.0 * odd(k) / (k + 2.0)),
            d33: mesh.mean(&d33),
            d33_variance: mesh.variance(&d33),
            k3: mesh.mean(&twist),
            k3_variance: mesh.variance(&twist),
            offset: stepped_parabola + monomial_sum(axial, |k| even(k) * 60.0 * k / ((k + 1.0) * (k + 3.0))),
            delta,
            gamma,
            s,
            curvature,
            gamma33_curvature: if mesh.is_single() {
                norm(&legendre::derivative(&legendre::derivative(&gamma33[0])))
            } else {
                f64::INFINITY
            },
            gamma33,
            gamma22: mesh.profile(&growth.gamma22),
            gamma23: mesh.profile(&growth.gamma23),
            mesh,
        }
    }

    /// `gamma33` less its components on `1` and `x`.
    #[must_use]
    pub fn growth_mismatch(&self) -> Series {
        axpy(self.offset, &self.mesh.parabola(), &self.gamma)
    }

    /// Whether the mismatch is along `t` alone, so that the closed form holds.
    #[must_use]
    pub fn is_parabolic(&self) -> bool {
        let zero = |f: &Series| f.iter().flatten().all(|&c| c == 0.0);
        zero(&self.gamma) && zero(&self.s)
    }

    /// Whether the mismatch may have a part odd in `x`.
    #[must_use]
    pub fn has_odd_part(&self) -> bool {
        let odd = |f: &Series| f[0].iter().skip(1).step_by(2).any(|&c| c != 0.0);
        !self.mesh.is_single() || odd(&self.gamma) || odd(&self.s)
    }

    /// Highest Legendre degree of the mismatch on any piece.
    #[must_use]
    pub fn degree(&self) -> usize {
        let lengths = self.gamma.iter().chain(&self.s).map(Vec::len);
        lengths.fold(3, usize::max) - 1
    }

    /// Whether `K2 -> -K2` leaves the energy unchanged.
    ///
    /// Only cross products of what is even and odd in `K2` break the symmetry: bending against
    /// `<d33>`, and within each parity in `x` the shape `s` against `t` and `gamma`.
    #[must_use]
    pub fn is_symmetric_in_bending(&self) -> bool {
        let zero = |f: &Series, parity| f[0].iter().skip(parity).step_by(2).all(|&c| c == 0.0);
        let opposite = if self.mesh.is_single() {
            zero(&self.s, 0) && (zero(&self.s, 1) || zero(&self.gamma, 1))
        } else {
            self.s.iter().flatten().all(|&c| c == 0.0)
        };
        self.d33 == 0.0 && self.delta == 0.0 && opposite
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

fn norm(series: &[f64]) -> f64 {
    series.iter().map(|c| c * c).sum::<f64>().sqrt()
}
