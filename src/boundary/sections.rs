//! The stability of sections.

use nalgebra::Matrix4;

use crate::section::Strain;

/// What the tangent stiffnesses of sections say of their stability.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sections {
    /// The largest number of negative eigenvalues.
    pub index: usize,
    /// The least determinant, of the stiffness relative to that of the ungrown section; it changes sign with the first
    /// eigenvalue.
    pub least: f64,
}

impl Default for Sections {
    fn default() -> Self {
        Self { index: 0, least: f64::INFINITY }
    }
}

impl Sections {
    /// Takes a tangent stiffness into account, its rows times a compliance.
    pub(super) fn add(&mut self, tangent: &Matrix4<f64>, compliance: &Strain) {
        // A rigid section is stable.
        if compliance.min() == 0.0 {
            return;
        }
        let scale = compliance.map(f64::sqrt);
        let mut a = tangent.map_with_location(|i, k, x| x * scale[k] / scale[i]);
        let (mut negative, mut determinant) = (0, 1.0);
        // The stiffnesses in eps and K1 come first and are positive: no pivoting is needed.
        for k in 0..4 {
            let pivot = a[(k, k)];
            negative += usize::from(pivot < 0.0);
            determinant *= pivot;
            for i in k + 1..4 {
                let factor = a[(i, k)] / pivot;
                for j in k + 1..4 {
                    a[(i, j)] -= factor * a[(k, j)];
                }
            }
        }
        self.index = self.index.max(negative);
        self.least = if determinant < self.least { determinant } else { self.least };
    }
}
