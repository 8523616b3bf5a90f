//! The shape of the cross-section: `u1` and the in-plane displacements.

use std::sync::OnceLock;

use super::basis::{self, SIZES};
use super::general::{largest_curvatures, level};
use super::{Reduction, Strain};
use crate::legendre;

/// Deflection of the section in units of `a`, as Legendre series in `x`.
///
/// With `D_j = 1/(1 + mu_j k2^2)` the relaxed deflection has in the modes of [`basis`] the components
/// `eta D_j [k2 mu_j g_j - h_j]`, where `g` is the mismatch without `K2` and `h` the double integral of
/// the natural transverse curvature: neither small nor large `K2` cancels.
#[derive(Clone, Debug)]
pub struct Deflection {
    level: usize,
    u1: Vec<f64>,
    slope: Vec<f64>,
    curvature: Vec<f64>,
}

impl Deflection {
    pub(super) fn new(r: &Reduction, eta: f64, strain: &Strain) -> Self {
        // The curvature series must hold the growth as well as the relaxed part.
        let largest = largest_curvatures(r.material.beta2, r.degree().max(r.curvature.len()));
        // The energy is stationary in the deflection and takes its errors squared; the deflection itself,
        // and more so its second derivative, needs the next truncation for the same accuracy.
        let level = (level(strain[2] / eta, &largest) + 1).min(SIZES.len() - 1);
        let (u1, curvature) = relaxed_deflection(r, eta, strain, level);
        let mut slope = legendre::integrate_zero_mean(&curvature);
        // int U' = U(1/2) - U(-1/2): twice the odd part of U at the edge.
        slope[0] = legendre::evaluate(&u1, 0.5) - legendre::evaluate(&u1, -0.5);
        Self { level, u1, slope, curvature }
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
}

/// Displacements of the mid-surface in its plane, in units of `a`, as Legendre series of zero mean.
///
/// They follow from the deflection by `e22 = -nu e33` and `e23 = 0`:
///
/// ```text
/// u2' = -nu m - U'^2/2 + gamma22,     u3' = gamma23 - K3 (U - x U').
/// ```
#[derive(Clone, Debug)]
pub struct InPlane {
    u2: Vec<f64>,
    u3: Vec<f64>,
}

impl InPlane {
    pub(super) fn new(r: &Reduction, strain: &Strain, deflection: &Deflection) -> Self {
        let u1 = &deflection.u1;
        let moment_arm = legendre::multiply_by_x(&deflection.slope);
        let shear: Vec<f64> = (0..moment_arm.len().max(u1.len()).max(r.gamma23.len()))
            .map(|n| at(&r.gamma23, n) - strain[3] * (at(u1, n) - at(&moment_arm, n)))
            .collect();
        Self {
            u2: legendre::integrate_zero_mean(&transverse_strain(r, strain, deflection)),
            u3: legendre::integrate_zero_mean(&shear),
        }
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
fn relaxed_deflection(r: &Reduction, eta: f64, strain: &Strain, level: usize) -> (Vec<f64>, Vec<f64>) {
    let k2 = strain[2] / eta;
    let material = r.material;
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
            let g = along_t * first - modes.component(&r.gamma, parity, j) / (eta * eta);
            let h = natural * first + modes.component(&r.s, parity, j) / eta;
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

/// Series of `u2' = -nu m - U'^2/2 + gamma22`.
fn transverse_strain(r: &Reduction, strain: &Strain, deflection: &Deflection) -> Vec<f64> {
    let Deflection { level, u1, slope, .. } = deflection;
    let parabola = legendre::from_monomials(&[strain[0], strain[1], 0.5 * strain[3] * strain[3]]);
    let membrane = |n: usize| at(&parabola, n) - strain[2] * at(u1, n) - at(&r.gamma33, n);
    let (nodes, weights) = gauss_rule(*level);
    let squares: Vec<f64> = nodes.iter().map(|&x| legendre::evaluate(slope, x).powi(2)).collect();
    let squares = legendre::project(&squares, nodes, weights, nodes.len());
    (0..nodes.len()).map(|n| at(&r.gamma22, n) - r.material.nu * membrane(n) - 0.5 * squares[n]).collect()
}

/// As many Gauss nodes as `U'^2` has coefficients, which integrate its products with them exactly; never
/// fewer than the growth has.
fn gauss_rule(level: usize) -> &'static (Vec<f64>, Vec<f64>) {
    static RULES: [OnceLock<(Vec<f64>, Vec<f64>)>; SIZES.len()] = [const { OnceLock::new() }; SIZES.len()];
    RULES[level].get_or_init(|| legendre::gauss(2 * (2 * SIZES[level] + 1)))
}
