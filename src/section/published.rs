//! The saddle law as it was published, kept to reproduce the paper's figures.

use super::relaxation::{Relaxation, Relaxed, Square};
use super::sigma;
use crate::growth::Growth;

/// Eqs. (47)-(50) for the thickness gradient `g33 = xi X1/a`, with two repairs and no more.
///
/// ```text
/// Pi = (eta^2/18) [(K2 + xi)^2 - K2 (K2 + 2 xi) tau/4]
///    = (eta^2/24) (K2 + xi)^2 + (eta^2/72) xi^2 + (sigma/32) K2^3 (K2 + 2 xi)
/// ```
///
/// Repairs: the root in eq. (50) reads `sqrt(K2 (K2 + 2 xi))` in print, which is neither of the right
/// dimension nor real between `-2 xi` and `0`; eq. (48) leads to `K2 (K2 + 2 xi)/sqrt|K2|`. The factor
/// `sign(K2)` in eq. (47) would make the deflection even in `K2`, where it is odd.
///
/// Not repaired: the edge condition (35), which leaves the growth gradient out. The result is the
/// energy of no growth field `g33 = xi X1/a`; the consistent law is [`super::ClosedForm`].
#[derive(Clone, Debug)]
pub struct PublishedSaddle {
    xi: f64,
    eta: f64,
}

impl PublishedSaddle {
    /// The published law; `None` unless the growth is a thickness gradient of `g33` alone.
    #[must_use]
    pub fn new(growth: &Growth, eta: f64) -> Option<Self> {
        let d33 = &growth.d33.polynomial;
        let xi = d33.first().copied().unwrap_or(0.0);
        let alone = growth.fields().iter().all(|(name, field)| *name == "d33" || field.is_zero());
        let constant = growth.d33.pieces.is_none() && d33.iter().skip(1).all(|&c| c == 0.0);
        (alone && constant).then_some(Self { xi, eta })
    }
}

impl Relaxation for PublishedSaddle {
    fn energy(&self, k2: f64, k3_squared: Square) -> f64 {
        self.derivatives(k2, k3_squared).energy
    }

    fn derivatives(&self, k2: f64, _k3_squared: Square) -> Relaxed {
        let (k, x) = (k2 / self.eta, self.xi / self.eta);
        // y = (9/4) k^2 for the incompressible material.
        let sigma = sigma::derivatives(2.25 * k * k);
        let y1 = 4.5 * k;
        let s1 = sigma.first * y1;
        let s2 = sigma.second * y1 * y1 + sigma.first * 4.5;
        let sum = (k2 + 2.0 * self.xi) / self.eta;
        let (f, f1, f2) = (k * k * k * sum, k * k * (3.0 * sum + k), 6.0 * k * (sum + k));
        Relaxed {
            energy: x * x / 72.0 + sigma.value * f / 32.0,
            d2: (s1 * f + sigma.value * f1) / 32.0,
            d22: (s2 * f + 2.0 * s1 * f1 + sigma.value * f2) / 32.0,
            ..Relaxed::default()
        }
    }
}
