//! How far a natural shape can bend.

use crate::section::{Form, Section};

/// A bound on `|K2|/eta` of every unloaded equilibrium: the lesser of two.
pub fn bound(section: &Section) -> f64 {
    let small = bound_by_energy(section);
    match section.form() {
        // The published law is not the energy of a relaxed section, from which the other bound follows.
        Form::PublishedSaddle => small,
        _ => small.min(bound_by_curvature(section)),
    }
}

/// From scaling curvatures and deflection together by `1 + delta`, which leaves the energy stationary.
///
/// With `Q` the bending energy of the deformed section, `Q_g` that of the growth's natural curvatures and
/// `gamma` the part of `gamma33` beyond `1` and `x`, this gives `Q - (Q Q_g)^(1/2) <= |gamma|^2/4`, and
/// `Q >= eta^2 K2^2/24`. Sharp for small growth.
fn bound_by_energy(section: &Section) -> f64 {
    let r = section.reduction();
    let eta = section.eta();
    let natural = (r.d33 * r.d33 + r.d33_variance) / 24.0
        + 0.5 * r.material.beta2 * r.curvature().powi(2)
        + r.material.twist * (r.k3 * r.k3 + r.k3_variance);
    let natural = natural * eta * eta;
    let membrane = r.growth_mismatch();
    let root = 0.5 * (natural.sqrt() + (natural + r.mesh.dot(&membrane, &membrane)).sqrt());
    24f64.sqrt() * root / (eta * eta)
}

/// From the balance of bending and torsion together, `k dPi/dk + q dPi/dq = 0`. Sharp for large growth.
///
/// In the modes of the section let `w = M + L - gamma` with `M` quadratic in `k` and `q` and `L = k s`. Since
/// `w (2M + L) - (1 - D) w^2 >= (M + L - gamma)(M + gamma) >= -(L/2 - gamma)^2`, and `D_j <= 1/(mu_j k^2)`,
///
/// ```text
/// k (k + d)/12 - g q0^2/2 <= sum_j D_j (L_j/2 - gamma_j)^2 <= (k S(k)^(1/2)/2 + G(k)^(1/2))^2,
/// S = sum_j D_j s_j^2,   G = sum_j D_j gamma_j^2,
/// ```
///
/// all growth scaled by the thickness ratio. Divided by `k^2`, the left side grows beyond `|d|` and the right side
/// falls. Where growth is smooth, `k S^(1/2) <= beta |r|` with `r = d22 + nu d33 - g21'`, whose double integral
/// is `s`, and `G <= (beta |gamma33''|/k)^2`; where it jumps, `S` and `G` are summed over the modes.
fn bound_by_curvature(section: &Section) -> f64 {
    let r = section.reduction();
    let eta = section.eta();
    let (d, q0) = (r.d33.abs() / eta, r.k3 / eta);
    let beta = r.material.beta2.sqrt();
    let (natural, mismatch) = (r.natural_mismatch(), r.growth_mismatch());
    let (curvature, smooth) = (beta * r.curvature(), beta * r.gamma33_curvature());
    // k S^(1/2) and G^(1/2).
    let relaxed = |k: f64| match section.reach() {
        Some(reach) => (k * reach.relaxed(&natural, k).sqrt(), reach.relaxed(&mismatch, k).sqrt()),
        None => (curvature, smooth / k),
    };
    let excluded = |k: f64| {
        let (bent, stretched) = relaxed(k);
        let softness = 0.5 * bent / eta + stretched / (eta * eta);
        k > d && k * (k - d) / 12.0 > 0.5 * r.material.twist * q0 * q0 + softness * softness
    };
    let (mut low, mut high) = (0.0, d.max(1.0));
    while !excluded(high) && high.is_finite() {
        (low, high) = (high, 2.0 * high);
    }
    for _ in 0..10 {
        let middle = 0.5 * (low + high);
        if excluded(middle) { high = middle } else { low = middle }
    }
    high
}
