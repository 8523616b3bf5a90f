//! The general law: any growth, in the modes of the relaxed section.

use std::sync::{Arc, OnceLock};

use super::basis::{self, SIZES};
use super::relaxation::{Mismatch, Relaxation, Relaxed, Square};
use super::{Reach, Reduction};

/// Relaxed energy of any growth,
///
/// ```text
/// Phi = (1/2) sum_j w_j^2 / (1 + mu_j k2^2),    w_j = W t_j + k2 s_j - gamma_j,    mu_j = sigma_j^2/beta^2,
/// ```
///
/// a sum of squares over the singular values `sigma_j` of [`basis`], or of [`Reach`] where growth jumps: the mismatch `w` in the modes of
/// the section, each relaxed by its own factor. `W` is the parabolic mismatch of the closed form.
///
/// The number of modes follows from `|K2|/eta` and the degree of the growth, so that the truncation
/// error stays below rounding (see `largest_curvatures`); modes of a parity the growth does not have are left out.
#[derive(Debug)]
pub struct GeneralLaw {
    reduction: Reduction,
    reach: Option<Arc<Reach>>,
    mismatch: Mismatch,
    eta: f64,
    largest: Vec<f64>,
    levels: [OnceLock<Vec<Group>>; SIZES.len()],
}

/// Modes handled together, so that the compiler can use vector instructions.
const LANES: usize = 4;

/// `mu_j`, `t_j`, `s_j/eta` and `gamma_j/eta^2` of a few modes; padding is zero.
#[derive(Clone, Copy, Debug, Default)]
struct Group {
    mu: [f64; LANES],
    t: [f64; LANES],
    s: [f64; LANES],
    gamma: [f64; LANES],
}

/// Largest `|K2|/eta` that each truncation resolves to rounding, for a mismatch of Legendre degree `degree`.
///
/// The edge layers of the deflection have width `(eta/|K2|)^(1/2)`; Legendre functions resolve them to
/// rounding with `n >~ (|K2|/eta)^(1/4)` of them, and `n` functions of one parity reach degree `2n`
/// exactly. Thresholds measured against twice as many functions (see the tests).
#[must_use]
pub(super) fn largest_curvatures(beta2: f64, degree: usize) -> Vec<f64> {
    let largest = SIZES.iter().map(|&size| {
        let spare = size as f64 - (degree / 2) as f64 + 1.0;
        if spare < LEAST_SPARE {
            return -1.0;
        }
        // The same layer forms at K2 proportional to beta; beta = 1/3 for the incompressible material.
        3.0 * beta2.sqrt() * CURVATURE_AT_EIGHT * (spare / 8.0).powf(GROWTH_OF_CURVATURE)
    });
    largest.collect()
}

/// The smallest sufficient truncation, or the largest there is.
#[must_use]
pub(super) fn level(k2: f64, largest: &[f64]) -> usize {
    let enough = largest.iter().position(|&k| k2.abs() <= k);
    enough.unwrap_or(largest.len() - 1)
}

/// Largest `|K2|/eta` that eight functions of a parity resolve to rounding.
const CURVATURE_AT_EIGHT: f64 = 20.0;
/// Exponent with which it grows with their number.
const GROWTH_OF_CURVATURE: f64 = 4.0;
/// Functions needed beyond the degree of the mismatch at any curvature.
const LEAST_SPARE: f64 = 4.0;

impl GeneralLaw {
    /// The law for the growth reduced in `reduction`; `reach` holds the modes where it jumps.
    #[must_use]
    pub fn new(reduction: &Reduction, reach: Option<Arc<Reach>>, eta: f64) -> Self {
        let smooth = || largest_curvatures(reduction.material.beta2, reduction.degree());
        Self {
            largest: reach.as_ref().map_or_else(smooth, |reach| reach.largest_curvatures()),
            reduction: reduction.clone(),
            reach,
            mismatch: Mismatch::new(reduction, eta),
            eta,
            levels: Default::default(),
        }
    }

    fn groups(&self, k2: f64) -> &[Group] {
        self.groups_at(level(k2 / self.eta, &self.largest))
    }

    fn groups_at(&self, level: usize) -> &[Group] {
        self.levels[level].get_or_init(|| {
            if let Some(reach) = &self.reach {
                return growth_in_reach(&self.reduction, reach, level, self.eta);
            }
            let mut groups = modal_growth(&self.reduction, level, 0, self.eta);
            if self.reduction.has_odd_part() {
                groups.extend(modal_growth(&self.reduction, level, 1, self.eta));
            }
            groups
        })
    }

    fn sum_derivatives(&self, groups: &[Group], k2: f64, k3_squared: Square) -> Relaxed {
        let big_w = self.mismatch.value(k2, k3_squared);
        let (slope, curvature) = (self.mismatch.slope(k2), self.mismatch.curvature());
        let k = k2 / self.eta;
        let kk = k * k;
        let zero = [0.0; LANES];
        let (mut energy, mut d2, mut dp, mut d22) = (zero, zero, zero, zero);
        let (mut d2p, mut dpp, mut d2pp) = (zero, zero, zero);
        for g in groups {
            for l in 0..LANES {
                let (t, mu) = (g.t[l], g.mu[l]);
                let w = big_w * t + (k * g.s[l] - g.gamma[l]);
                let w1 = slope * t + g.s[l];
                let w2 = curvature * t;
                // d = 1/(1 + mu k^2),  d' = -2 f d  with f = k mu d,  d'' = 2 mu d^2 (4 k f - 1).
                let d = 1.0 / (1.0 + mu * kk);
                let md = mu * d;
                let f = k * md;
                let dw = d * w;
                let dt = d * t;
                let dw1 = d * w1 - 2.0 * f * dw;
                energy[l] += w * dw;
                d2[l] += dw * (w1 - f * w);
                dp[l] += dw * t;
                d22[l] += dw1 * w1 + dw * (w2 - 2.0 * f * w1 + (4.0 * k * f - 1.0) * md * w);
                d2p[l] += dw1 * t;
                dpp[l] += dt * t;
                d2pp[l] -= 2.0 * f * dt * t;
            }
        }
        let sum = |lanes: [f64; LANES]| lanes.iter().sum::<f64>();
        Relaxed {
            energy: 0.5 * sum(energy),
            d2: sum(d2),
            dp: sum(dp),
            d22: sum(d22),
            d2p: sum(d2p),
            dpp: sum(dpp),
            d2pp: sum(d2pp),
        }
    }
}

/// The growth in the modes of one parity.
fn modal_growth(r: &Reduction, level: usize, parity: usize, eta: f64) -> Vec<Group> {
    let modes = basis::modes(level, parity);
    let mut groups = vec![Group::default(); SIZES[level].div_ceil(LANES)];
    for (mode, sigma) in modes.sigma.iter().enumerate() {
        let (group, lane) = (&mut groups[mode / LANES], mode % LANES);
        group.mu[lane] = sigma * sigma / r.material.beta2;
        if parity == 0 {
            group.t[lane] = basis::PARABOLA * modes.right[(0, mode)];
        }
        group.s[lane] = modes.component(&r.s[0], parity, mode) / eta;
        group.gamma[lane] = modes.component(&r.gamma[0], parity, mode) / (eta * eta);
    }
    groups
}

/// The growth in the modes of its reach.
fn growth_in_reach(r: &Reduction, reach: &Reach, level: usize, eta: f64) -> Vec<Group> {
    let modes = reach.modes(level);
    let t = r.mesh.parabola();
    let mut groups = vec![Group::default(); modes.sigma.len().div_ceil(LANES)];
    for (mode, sigma) in modes.sigma.iter().enumerate() {
        let (group, lane) = (&mut groups[mode / LANES], mode % LANES);
        let component = |f| r.mesh.dot(f, &modes.right[mode]);
        group.mu[lane] = sigma * sigma / r.material.beta2;
        group.t[lane] = component(&t);
        group.s[lane] = component(&r.s) / eta;
        group.gamma[lane] = component(&r.gamma) / (eta * eta);
    }
    groups
}

impl Relaxation for GeneralLaw {
    #[expect(clippy::needless_range_loop, reason = "one index over all lanes is what vectorises")]
    fn energy(&self, k2: f64, k3_squared: Square) -> f64 {
        let big_w = self.mismatch.value(k2, k3_squared);
        let k = k2 / self.eta;
        let kk = k * k;
        let mut energy = [0.0; LANES];
        for g in self.groups(k2) {
            for l in 0..LANES {
                let w = big_w * g.t[l] + (k * g.s[l] - g.gamma[l]);
                energy[l] += w * w / (1.0 + g.mu[l] * kk);
            }
        }
        0.5 * energy.iter().sum::<f64>()
    }

    fn derivatives(&self, k2: f64, k3_squared: Square) -> Relaxed {
        self.sum_derivatives(self.groups(k2), k2, k3_squared)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::growth::Growth;
    use crate::material::PlaneStress;

    /// At the largest curvature of each truncation, twice as many functions change nothing.
    #[test]
    fn truncation_is_below_rounding() {
        let eta = 0.125;
        for degree in [2, 3, 6, 9, 14, 20, 32] {
            let mut gamma33 = vec![0.0; degree + 1];
            gamma33[degree] = 2f64.powi(degree as i32);
            let growth = Growth { gamma33: gamma33.into(), ..Growth::default() };
            let reduction = Reduction::new(growth.clone(), &PlaneStress::incompressible());
            let law = GeneralLaw::new(&reduction, None, eta);
            for level in 0..SIZES.len() - 1 {
                for fraction in [1.0, 0.5, 0.1, 1e-3] {
                    let k2 = fraction * law.largest[level] * eta;
                    if k2 < 0.0 {
                        continue;
                    }
                    let a = law.sum_derivatives(law.groups_at(level), k2, Square::of(0.3 * k2));
                    let b = law.sum_derivatives(law.groups_at(level + 1), k2, Square::of(0.3 * k2));
                    // Rounding of sums of up to 256 terms.
                    for (a, b) in [(a.energy, b.energy), (a.d2, b.d2), (a.d22, b.d22), (a.dp, b.dp)] {
                        assert!((a - b).abs() <= 1e-14 * b.abs(), "{degree} {level} {fraction}: {a} {b}");
                    }
                }
            }
        }
    }

    /// Where both apply, the modes give the closed form.
    #[test]
    fn general_law_is_the_closed_form() {
        let growth = Growth::edge(0.7) + Growth::thickness(0.2, -0.1);
        let eta = 0.1;
        for stiffness in [PlaneStress::incompressible(), PlaneStress::new(1.0, 2.0, 0.3, 0.2).unwrap()] {
            let reduction = Reduction::new(growth.clone(), &stiffness);
            let general = GeneralLaw::new(&reduction, None, eta);
            let closed = super::super::ClosedForm::new(&reduction, eta).unwrap();
            for k in [0.0, 1e-12, 1e-3, 1.0, 7.5, 23.9, 24.1, 300.0, 1e4, 1e6] {
                for k2 in [k * eta, -k * eta] {
                    let (a, b) =
                        (general.derivatives(k2, Square::of(0.4)), closed.derivatives(k2, Square::of(0.4)));
                    for (a, b, scale) in [
                        (a.energy, b.energy, b.energy),
                        (a.d2, b.d2, b.energy.sqrt() * b.d22.abs().sqrt()),
                        (a.dp, b.dp, b.dp),
                        (a.dpp, b.dpp, b.dpp),
                        (a.d2pp, b.d2pp, b.d2pp),
                    ] {
                        assert!((a - b).abs() <= 2e-14 * scale.abs(), "{k2}: {a} {b}");
                    }
                }
            }
        }
    }
}
