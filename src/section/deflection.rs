//! The shape of the cross-section: `u1` and the in-plane displacements.

use super::basis::{self, SIZES};
use super::general::{largest_curvatures, level};
use super::mesh::{Mesh, Series, axpy};
use super::{Reach, Reduction, Strain};
use crate::legendre;

/// Deflection of the section in units of `a`, as Legendre series in `x` between the jumps of the growth.
///
/// With `D_j = 1/(1 + mu_j k2^2)` the relaxed deflection has in the modes of [`basis`] the components
/// `eta D_j [k2 mu_j g_j - h_j]`, where `g` is the mismatch without `K2` and `h` the double integral of
/// the natural transverse curvature: neither small nor large `K2` cancels.
#[derive(Clone, Debug)]
pub struct Deflection {
    mesh: Mesh,
    u1: Series,
    slope: Series,
    curvature: Series,
}

impl Deflection {
    pub(super) fn new(r: &Reduction, reach: Option<&Reach>, eta: f64, strain: &Strain) -> Self {
        // The energy is stationary in the deflection and takes its errors squared; the deflection itself,
        // and more so its second derivative, needs the next truncation for the same accuracy.
        let finer = |largest: Vec<f64>| (level(strain[2] / eta, &largest) + 1).min(largest.len() - 1);
        let (bending, g21, g21_slope) = (r.bending(), r.g21(), r.g21_slope());
        let (u1, relaxed) = match reach {
            None => {
                // The curvature series must hold the growth as well as the relaxed part.
                let degree = r.degree().max(bending[0].len()).max(g21_slope[0].len());
                in_smooth_modes(r, eta, strain, finer(largest_curvatures(r.material.beta2, degree)))
            }
            Some(reach) => in_reach(r, reach, eta, strain, finer(reach.largest_curvatures())),
        };
        // U'' - g21', which stays finite where g21 jumps: the section folds through that angle.
        let unfolded =
            axpy(-1.0, &axpy(1.0, &r.mesh.polynomial(&[r.material.nu * strain[2]]), &bending), &relaxed);
        let mut slope = axpy(1.0, &g21, &r.mesh.integral(&unfolded));
        // int U' = U(1/2) - U(-1/2).
        let rise = r.mesh.evaluate(&u1, 0.5) - r.mesh.evaluate(&u1, -0.5) - r.mesh.mean(&slope);
        slope.iter_mut().for_each(|series| series[0] += rise);
        let curvature = axpy(1.0, &g21_slope, &unfolded);
        Self { mesh: r.mesh.clone(), u1, slope, curvature }
    }

    /// `u1/a` at `x`.
    #[must_use]
    pub fn u1(&self, x: f64) -> f64 {
        self.mesh.evaluate(&self.u1, x)
    }

    /// `d(u1/a)/dx`.
    #[must_use]
    pub fn slope(&self, x: f64) -> f64 {
        self.mesh.evaluate(&self.slope, x)
    }

    /// `d^2(u1/a)/dx^2`, between jumps of `g21`.
    #[must_use]
    pub fn curvature(&self, x: f64) -> f64 {
        self.mesh.evaluate(&self.curvature, x)
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
    mesh: Mesh,
    u2: Series,
    u3: Series,
}

impl InPlane {
    pub(super) fn new(r: &Reduction, strain: &Strain, deflection: &Deflection) -> Self {
        let arm = axpy(-1.0, &r.mesh.multiply_by_x(&deflection.slope), &deflection.u1);
        let shear = axpy(-strain[3], &arm, &r.gamma23());
        Self {
            u2: r.mesh.integral_of_zero_mean(&transverse_strain(r, strain, deflection)),
            u3: r.mesh.integral_of_zero_mean(&shear),
            mesh: r.mesh.clone(),
        }
    }

    /// `u2/a` at `x`, of zero mean.
    #[must_use]
    pub fn u2(&self, x: f64) -> f64 {
        self.mesh.evaluate(&self.u2, x)
    }

    /// `u3/a` at `x`, of zero mean.
    #[must_use]
    pub fn u3(&self, x: f64) -> f64 {
        self.mesh.evaluate(&self.u3, x)
    }
}

/// What the modes of a section hold of its strains: the mismatch without `K2`, and the double integral of
/// the natural transverse curvature, as multiples of `t` and of the rest.
struct Drive {
    eta: f64,
    k2: f64,
    beta2: f64,
    along_t: f64,
    natural: f64,
}

impl Drive {
    fn new(r: &Reduction, eta: f64, strain: &Strain) -> Self {
        Self {
            eta,
            k2: strain[2] / eta,
            beta2: r.material.beta2,
            along_t: (strain[3] * strain[3] - r.offset) / (eta * eta),
            natural: (r.material.nu * strain[2] + r.delta) / eta,
        }
    }

    /// Deflection and curvature in a mode of singular value `sigma` from the components of `t`, `s`, `gamma`.
    fn response(&self, sigma: f64, [t, s, gamma]: [f64; 3]) -> (f64, f64) {
        let Self { eta, k2, beta2, .. } = *self;
        let g = self.along_t * t - gamma / (eta * eta);
        let h = self.natural * t + s / eta;
        let mu = sigma * sigma / beta2;
        let d = 1.0 / (1.0 + mu * k2 * k2);
        // The curvature is eta k2 sigma w d/beta^2 with w = g + k2 h.
        (eta * d * (k2 * mu * g - h), eta * k2 * (sigma / beta2) * d * (g + k2 * h))
    }
}

/// Series of `U` and of `U'' + nu K2 + (d22 + nu d33 - g21')` in the modes of the smooth basis.
fn in_smooth_modes(r: &Reduction, eta: f64, strain: &Strain, level: usize) -> (Series, Series) {
    let drive = Drive::new(r, eta, strain);
    let size = SIZES[level];
    let mut u = vec![0.0; 2 * size + 2];
    let mut curvature = vec![0.0; 2 * size];
    let parities = if r.has_odd_part() { 0..2 } else { 0..1 };
    for parity in parities {
        let modes = basis::modes(level, parity);
        let t = if parity == 0 { basis::PARABOLA } else { 0.0 };
        for (j, &sigma) in modes.sigma.iter().enumerate() {
            let [s, gamma] = [&r.s, &r.gamma].map(|f| modes.component(&f[0], parity, j));
            let (deflection, bent) = drive.response(sigma, [t * modes.right[(0, j)], s, gamma]);
            for i in 0..size {
                u[2 * i + 2 + parity] += modes.right[(i, j)] * deflection;
                curvature[2 * i + parity] += modes.left[(i, j)] * bent;
            }
        }
    }
    (vec![u], vec![curvature])
}

/// The same in the modes that growth with jumps reaches.
fn in_reach(r: &Reduction, reach: &Reach, eta: f64, strain: &Strain, level: usize) -> (Series, Series) {
    let drive = Drive::new(r, eta, strain);
    let modes = reach.modes(level);
    let t = r.mesh.parabola();
    let (mut u, mut curvature) = (r.mesh.zero(), r.mesh.zero());
    for (j, &sigma) in modes.sigma.iter().enumerate() {
        let components = [&t, &r.s, &r.gamma].map(|f| r.mesh.dot(f, &modes.right[j]));
        let (deflection, bent) = drive.response(sigma, components);
        u = axpy(deflection, &modes.right[j], &u);
        if let Some(left) = modes.left.get(j) {
            curvature = axpy(bent, left, &curvature);
        }
    }
    (u, curvature)
}

/// Series of `u2' = -nu m - U'^2/2 + gamma22`.
fn transverse_strain(r: &Reduction, strain: &Strain, deflection: &Deflection) -> Series {
    let mesh = &r.mesh;
    let section = mesh.polynomial(&[strain[0], strain[1], 0.5 * strain[3] * strain[3]]);
    let membrane = axpy(-1.0, &r.gamma33(), &axpy(-strain[2], &deflection.u1, &section));
    // As many coefficients as the square has, and no fewer than the growth.
    let lengths = deflection.slope.iter().map(|slope| 2 * slope.len() - 1);
    let squares = mesh.sampled(lengths.fold(1, usize::max), |piece, _, _, y| {
        legendre::evaluate(&deflection.slope[piece], y).powi(2)
    });
    axpy(-r.material.nu, &membrane, &axpy(-0.5, &squares, &r.gamma22()))
}
