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
    growth: Growth,
}

impl Reduction {
    /// Integrates the fields of `growth`, which must have passed [`Growth::validate`].
    #[must_use]
    pub fn new(growth: Growth, stiffness: &PlaneStress) -> Self {
        Self::on(Mesh::of(&growth), growth, stiffness)
    }

    /// The same on a finer mesh.
    #[must_use]
    pub fn on(mesh: Mesh, growth: Growth, stiffness: &PlaneStress) -> Self {
        let material = stiffness.section_constants();
        let d33 = || mesh.profile(&growth.d33);
        let (d33, d33_variance) = match growth.d33.constant() {
            Some(constant) => (constant, 0.0),
            None => mean_and_variance(&mesh, &d33()),
        };
        let twist = || {
            axpy(-0.5, &mesh.derivative(&growth.g31), &axpy(0.5, &mesh.profile(&growth.d23), &mesh.zero()))
        };
        let (k3, k3_variance) = match growth.d23.constant() {
            Some(constant) if growth.g31.is_zero() => (0.5 * constant, 0.0),
            _ => mean_and_variance(&mesh, &twist()),
        };
        let (mut s, mut delta) = (mesh.zero(), 0.0);
        let bent = natural_bending(&mesh, &growth, material.nu);
        if bent.iter().any(|piece| !piece.is_empty()) {
            // The mean is `t` itself and enters exactly; only the rest goes through the basis.
            delta = mesh.mean(&bent);
            s = mesh.double_integral(&axpy(-delta, &mesh.polynomial(&[1.0]), &bent));
        }
        if !growth.g21.is_zero() {
            s = axpy(-1.0, &mesh.integral(&mesh.profile(&growth.g21)), &s);
        }
        delta += mesh.take_parabola(&mut s);
        // Moments of monomials are rational up to a power of two and more exact than those of the series.
        let axial = &growth.gamma33.polynomial;
        let mut reduction = Self {
            material,
            eps: monomial_sum(axial, |k| even(k) / (k + 1.0)),
            eps_constant: axial.first().copied().unwrap_or(0.0),
            eps_spread: monomial_sum(axial, |k| if k > 0.0 { 24.0 * even(k) / (k + 1.0) } else { 0.0 }),
            k1: monomial_sum(axial, |k| 6.0 * odd(k) / (k + 2.0)),
            d33,
            d33_variance,
            k3,
            k3_variance,
            offset: monomial_sum(axial, |k| even(k) * 60.0 * k / ((k + 1.0) * (k + 3.0))),
            delta,
            gamma: mesh.zero(),
            s,
            growth,
            mesh,
        };
        let axial = &reduction.growth.gamma33;
        if axial.polynomial.len() > 3 || axial.pieces.is_some() {
            reduction.gamma = reduction.gamma33();
            reduction.mesh.take_parabola(&mut reduction.gamma);
        }
        if let Some(pieces) = &reduction.growth.gamma33.pieces {
            let part = pieces.refined(reduction.mesh.breaks());
            reduction.add_moments(part.pieces());
        }
        reduction
    }

    /// Adds the moments of a part of `gamma33` that is given on pieces.
    fn add_moments(&mut self, part: &[Vec<f64>]) {
        let mean = self.mesh.mean(part);
        self.eps += mean;
        self.eps_constant += mean;
        self.k1 += 12.0 * self.mesh.mean(&self.mesh.multiply_by_x(part));
        self.offset += self.mesh.dot(part, &self.mesh.parabola()) / (basis::PARABOLA * basis::PARABOLA);
    }

    /// `gamma33`.
    #[must_use]
    pub fn gamma33(&self) -> Series {
        self.mesh.profile(&self.growth.gamma33)
    }

    /// `gamma22`.
    #[must_use]
    pub fn gamma22(&self) -> Series {
        self.mesh.profile(&self.growth.gamma22)
    }

    /// `gamma23`.
    #[must_use]
    pub fn gamma23(&self) -> Series {
        self.mesh.profile(&self.growth.gamma23)
    }

    /// `g21`.
    #[must_use]
    pub fn g21(&self) -> Series {
        self.mesh.profile(&self.growth.g21)
    }

    /// `g21'`; where `g21` jumps, that of its pieces.
    #[must_use]
    pub fn g21_slope(&self) -> Series {
        self.mesh.derivative(&self.growth.g21)
    }

    /// `d22 + nu d33`: the natural transverse curvature but for `g21'`.
    #[must_use]
    pub fn bending(&self) -> Series {
        natural_bending(&self.mesh, &self.growth, self.material.nu)
    }

    /// Norm of `r = d22 + nu d33 - g21'` over the width; infinite where `g21` jumps.
    #[must_use]
    pub fn curvature(&self) -> f64 {
        if self.growth.g21.pieces.as_ref().is_some_and(|pieces| pieces.jumps().next().is_some()) {
            return f64::INFINITY;
        }
        let r = axpy(-1.0, &self.g21_slope(), &self.bending());
        self.mesh.dot(&r, &r).sqrt()
    }

    /// Norm of `gamma33''` over the width; infinite where growth jumps.
    #[must_use]
    pub fn gamma33_curvature(&self) -> f64 {
        if !self.mesh.is_single() {
            return f64::INFINITY;
        }
        let second = legendre::derivative(&legendre::derivative(&self.gamma33()[0]));
        second.iter().map(|c| c * c).sum::<f64>().sqrt()
    }

    /// `gamma33` less its components on `1` and `x`.
    #[must_use]
    pub fn growth_mismatch(&self) -> Series {
        axpy(self.offset, &self.mesh.parabola(), &self.gamma)
    }

    /// The mismatch that natural transverse curvature makes, per unit of `K2`.
    #[must_use]
    pub fn natural_mismatch(&self) -> Series {
        axpy(self.delta, &self.mesh.parabola(), &self.s)
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

/// `d22 + nu d33`.
fn natural_bending(mesh: &Mesh, growth: &Growth, nu: f64) -> Series {
    if growth.d33.is_zero() && growth.d22.is_zero() {
        return mesh.zero();
    }
    axpy(nu, &mesh.profile(&growth.d33), &mesh.profile(&growth.d22))
}

fn mean_and_variance(mesh: &Mesh, series: &Series) -> (f64, f64) {
    (mesh.mean(series), mesh.variance(series))
}
