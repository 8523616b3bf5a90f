//! The closed form, for growth whose mismatch is parabolic across the width.

use super::relaxation::{Mismatch, Relaxation, Relaxed, Square};
use super::{Reduction, sigma};

/// Relaxed energy of edge growth, thickness gradients and chirality, in any combination,
///
/// ```text
/// Phi = (sigma(y)/8) W^2,   W = [K3^2 + K2 (nu K2 + delta) - 8 xi]/eta^2,   y = K2^2/(4 beta^2 eta^2),
/// ```
///
/// with `xi` the edge growth and `delta = d22 + nu d33`. For `nu = 1/2` and `delta = 0` this is
/// `(sigma/32)(k2^2 + 4 C/eta^2)^2` with `C = K3^2/2 - 4 xi`: eqs. (57), (58) less their bending and
/// twisting terms; for `d33 = xi`, `d22 = 0` it is eqs. (49), (50) with the thickness gradient kept in
/// the edge condition of the deflection. Written as a square it has no cancellation at any `K2`.
#[derive(Clone, Debug)]
pub struct ClosedForm {
    mismatch: Mismatch,
    /// `1/(4 beta^2 eta^2)`, so that `y = scale K2^2`.
    scale: f64,
    eta: f64,
}

impl ClosedForm {
    /// The closed form for this growth; `None` if its mismatch is not parabolic.
    #[must_use]
    pub fn new(reduction: &Reduction, eta: f64) -> Option<Self> {
        reduction.is_parabolic().then(|| Self {
            mismatch: Mismatch::new(reduction, eta),
            scale: 0.25 / (reduction.material.beta2 * eta * eta),
            eta,
        })
    }
}

impl Relaxation for ClosedForm {
    fn energy(&self, k2: f64, k3_squared: Square) -> f64 {
        let w = self.mismatch.value(k2, k3_squared);
        0.125 * sigma::value(self.scale * k2 * k2) * w * w
    }

    fn derivatives(&self, k2: f64, k3_squared: Square) -> Relaxed {
        let sigma = sigma::derivatives(self.scale * k2 * k2);
        // s = sigma/4 as a function of k2 = K2/eta, y = c k2^2.
        let c = self.scale * self.eta * self.eta;
        let y1 = 2.0 * c * (k2 / self.eta);
        let s = 0.25 * sigma.value;
        let s1 = 0.25 * sigma.first * y1;
        let s2 = 0.25 * (sigma.second * y1 * y1 + sigma.first * 2.0 * c);
        let w = self.mismatch.value(k2, k3_squared);
        let (w1, w2) = (self.mismatch.slope(k2), self.mismatch.curvature());
        Relaxed {
            energy: 0.5 * s * w * w,
            d2: w * (0.5 * s1 * w + s * w1),
            dp: s * w,
            d22: w * (0.5 * s2 * w + 2.0 * s1 * w1 + s * w2) + s * w1 * w1,
            d2p: s1 * w + s * w1,
            dpp: s,
            d2pp: s1,
        }
    }
}
