//! The shape of the cross-section: `u1` and the in-plane displacements.

use super::basis::{self, Modes, SIZES};
use super::general::{largest_curvatures, level};
use super::{Reduction, Strain};
use crate::legendre;

/// Displacements of the mid-surface across the width, in units of `a`, as Legendre series in `x`.
///
/// With `D_j = 1/(1 + mu_j k2^2)` the relaxed deflection has in the modes of [`basis`] the components
/// `eta D_j [k2 mu_j g_j - h_j]`, where `g` is the mismatch without `K2` and `h` the double integral of
/// the natural transverse curvature: neither small nor large `K2` cancels.
/// `u2` and `u3` follow from `e22 = -nu e33` and `e23 = 0`:
///
/// ```text
/// u2' = -nu m - U'^2/2 + gamma22,     u3' = gamma23 - K3 (U - x U'),     both of zero mean.
/// ```
#[derive(Clone, Debug)]
pub struct Deflection {
    u1: Vec<f64>,
    slope: Vec<f64>,
    curvature: Vec<f64>,
    u2: Vec<f64>,
    u3: Vec<f64>,
}

impl Deflection {
    pub(super) fn new(r: &Reduction, eta: f64, strain: &Strain) -> Self {
        let (u1, curvature) = relaxed_deflection(r, eta, strain);
        let mut slope = legendre::integrate_zero_mean(&curvature);
        // int U' = U(1/2) - U(-1/2): twice the odd part of U at the edge.
        slope[0] = legendre::evaluate(&u1, 0.5) - legendre::evaluate(&u1, -0.5);
        let u2 = legendre::integrate_zero_mean(&transverse_strain(r, strain, &u1, &slope));
        let moment_arm = legendre::multiply_by_x(&slope);
        let shear: Vec<f64> = (0..moment_arm.len().max(u1.len()).max(r.gamma23.len()))
            .map(|n| at(&r.gamma23, n) - strain[3] * (at(&u1, n) - at(&moment_arm, n)))
            .collect();
        Self { u3: legendre::integrate_zero_mean(&shear), u1, slope, curvature, u2 }
    }

    /// `u1/a` at `x`.
    #[must_use]
    pub fn u1(&self, x: f64) -> f64 {
        legendre::evaluate(&self.u1, x)
    }

    /// `d(u1/a)/dx`.
    #[must_use]
    pub fn slope(&self, x: f64) -> f64 {
        legendre::evaluate(&self.slope, x)
    }

    /// `d^2(u1/a)/dx^2`.
    #[must_use]
    pub fn curvature(&self, x: f64) -> f64 {
        legendre::evaluate(&self.curvature, x)
    }

    /// `u2/a` at `x`, of zero mean.
    #[must_use]
    pub fn u2(&self, x: f64) -> f64 {
        legendre::evaluate(&self.u2, x)
    }

    /// `u3/a` at `x`, of zero mean.
    #[must_use]
    pub fn u3(&self, x: f64) -> f64 {
        legendre::evaluate(&self.u3, x)
    }
}

fn at(series: &[f64], n: usize) -> f64 {
    series.get(n).copied().unwrap_or(0.0)
}

/// Legendre series of `U` and `U''`.
fn relaxed_deflection(r: &Reduction, eta: f64, strain: &Strain) -> (Vec<f64>, Vec<f64>) {
    let k2 = strain[2] / eta;
    let material = r.material;
    // The curvature series must hold the growth as well as the relaxed part.
    let degree = r.degree().max(r.curvature.len());
    // The energy is stationary in the deflection and takes its errors squared; the deflection itself,
    // and more so its second derivative, needs the next truncation for the same accuracy.
    let level = (level(k2, &largest_curvatures(material.beta2, degree)) + 1).min(SIZES.len() - 1);
    let size = SIZES[level];
    let mut u = vec![0.0; 2 * size + 2];
    let mut curvature = vec![0.0; 2 * size];
    let along_t = (strain[3] * strain[3] - r.offset) / (eta * eta);
    let natural = (material.nu * strain[2] + r.delta) / eta;
    let parities = if r.has_odd_part() { 0..2 } else { 0..1 };
    for parity in parities {
        let modes = basis::modes(level, parity);
        let t = if parity == 0 { basis::PARABOLA } else { 0.0 };
        for (j, sigma) in modes.sigma.iter().enumerate() {
            let first = t * modes.right[(0, j)];
            let g = along_t * first - in_mode(modes, &r.gamma, parity, j) / (eta * eta);
            let h = natural * first + in_mode(modes, &r.s, parity, j) / eta;
            let mu = sigma * sigma / material.beta2;
            let d = 1.0 / (1.0 + mu * k2 * k2);
            let component = eta * d * (k2 * mu * g - h);
            // b = eta k2 sigma w d/beta^2 with w = g + k2 h.
            let moment = eta * k2 * (sigma / material.beta2) * d * (g + k2 * h);
            for i in 0..size {
                u[2 * i + 2 + parity] += modes.right[(i, j)] * component;
                curvature[2 * i + parity] += modes.left[(i, j)] * moment;
            }
        }
    }
    curvature[0] -= material.nu * strain[2];
    for (c, natural) in curvature.iter_mut().zip(&r.curvature) {
        *c -= natural;
    }
    (u, curvature)
}

/// Component of a Legendre series in mode `j`.
fn in_mode(modes: &Modes, series: &[f64], parity: usize, j: usize) -> f64 {
    let of_parity = series.iter().skip(2 + parity).step_by(2).enumerate();
    of_parity.map(|(i, c)| modes.right[(i, j)] * c).sum()
}

/// Series of `u2' = -nu m - U'^2/2 + gamma22`.
fn transverse_strain(r: &Reduction, strain: &Strain, u1: &[f64], slope: &[f64]) -> Vec<f64> {
    let mut parabola = legendre::from_monomials(&[strain[0], strain[1], 0.5 * strain[3] * strain[3]]);
    parabola.resize(u1.len().max(r.gamma33.len()), 0.0);
    let membrane = |n: usize| at(&parabola, n) - strain[2] * at(u1, n) - at(&r.gamma33, n);
    // U'^2 has twice the degree of U'; as many Gauss nodes as coefficients integrate it exactly.
    let terms = (2 * slope.len()).max(parabola.len()).max(r.gamma22.len());
    let (nodes, weights) = legendre::gauss(terms);
    let squares: Vec<f64> = nodes.iter().map(|&x| legendre::evaluate(slope, x).powi(2)).collect();
    let squares = legendre::project(&squares, &nodes, &weights, terms);
    (0..terms).map(|n| at(&r.gamma22, n) - r.material.nu * membrane(n) - 0.5 * squares[n]).collect()
}
