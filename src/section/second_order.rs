//! The second-order form in `K2`, for comparison with the paper.

use super::Reduction;
use super::relaxation::Mismatch;
use super::relaxation::{Relaxation, Relaxed, Square};

/// Second-order Taylor polynomial in `K2` of the closed form for edge growth and chirality, eq. (59):
///
/// ```text
/// Phi = C^2/360 + K2^2 [nu C/360 - C^2/(181440 beta^2 eta^2)] + O(K2^4),   C = K3^2/2 - 4 xi,
/// ```
///
/// the bending term `eta^2 K2^2/24` being counted with the unrelaxed section. `K2 ~ eta` does not make
/// the rest small: the next term is of the same size at `K2 = 2.4 eta`, the series diverges beyond
/// `|K2| = 7.46 eta` (in the incompressible material; `22.4 beta eta` in others), and past the first instability this form is unbounded below.
#[derive(Clone, Debug)]
pub struct SecondOrder {
    mismatch: Mismatch,
    nu: f64,
    beta2: f64,
    eta: f64,
}

impl SecondOrder {
    /// The form for this growth; `None` unless it is edge growth and chirality alone.
    #[must_use]
    pub fn new(reduction: &Reduction, eta: f64) -> Option<Self> {
        let applies = reduction.is_parabolic() && reduction.delta == 0.0 && reduction.d33 == 0.0;
        applies.then(|| Self {
            mismatch: Mismatch::new(reduction, eta),
            nu: reduction.material.nu,
            beta2: reduction.material.beta2,
            eta,
        })
    }
}

impl Relaxation for SecondOrder {
    fn energy(&self, k2: f64, k3_squared: Square) -> f64 {
        self.derivatives(k2, k3_squared).energy
    }

    fn derivatives(&self, k2: f64, k3_squared: Square) -> Relaxed {
        // C/eta^2, with dC/dp = 1/2.
        let c = 0.5 * self.mismatch.value(0.0, k3_squared);
        let k = k2 / self.eta;
        let a = 1.0 / (181_440.0 * self.beta2);
        let b = self.nu / 360.0;
        let coefficient = c * (b - a * c);
        Relaxed {
            energy: c * c / 360.0 + k * k * coefficient,
            d2: 2.0 * k * coefficient,
            dp: c / 360.0 + k * k * (0.5 * b - a * c),
            d22: 2.0 * coefficient,
            d2p: 2.0 * k * (0.5 * b - a * c),
            dpp: 1.0 / 720.0 - 0.5 * a * k * k,
            d2pp: -a * k,
        }
    }
}
