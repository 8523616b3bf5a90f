//! Equilibria of the second-order form, known in closed form.

use super::cubic;
use crate::section::{Section, Square};

/// `(K2/eta, K3/eta)` of every unloaded equilibrium of eq. (59), up to mirror images.
///
/// The energy is `k^2 (1/24 + b C - a C^2)` plus terms without `k = K2/eta`, with `C = q^2/2 + C0`,
/// `b = nu/360` and `a = 1/(181440 beta^2)`. Either `k = 0`, or its coefficient vanishes: `C` is one of two
/// constants, `q` follows from it and `k^2` from the torsion equation.
pub fn equilibria(section: &Section) -> Vec<(f64, f64)> {
    let r = section.reduction();
    let (eta, g) = (section.eta(), r.material.twist);
    let q0 = r.k3 / eta;
    let (a, b) = (1.0 / (181_440.0 * r.material.beta2), r.material.nu / 360.0);
    let flat = section.relaxation().derivatives(0.0, Square::of(0.0));
    let unbent = cubic::real_roots(flat.dpp, flat.dp + g, g * q0);
    let mut found: Vec<(f64, f64)> = unbent.iter().map(|&q| (0.0, q)).collect();
    let c0 = -0.5 * r.offset / (eta * eta);
    let root = (b * b + a / 6.0).sqrt();
    for c in [(b - root) / (2.0 * a), (b + root) / (2.0 * a)] {
        let squared = 2.0 * (c - c0);
        if squared <= 0.0 {
            continue;
        }
        for q in [squared.sqrt(), -squared.sqrt()] {
            let k_squared = -(c / 360.0 + g * (1.0 - q0 / q)) / (0.5 * b - a * c);
            // Without natural twist the images in q are added with the other mirror images.
            if k_squared > 0.0 && (q0 != 0.0 || q > 0.0) {
                found.push((k_squared.sqrt(), q));
            }
        }
    }
    found
}
