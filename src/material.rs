//! The plane-stress stiffness of the material.

use crate::InvalidInput;

/// Largest ratio of the stiffnesses of bending, twisting and stretching.
const LARGEST_RATIO: f64 = 1e12;

/// Plane-stress stiffness with the ribbon's axes as material axes,
///
/// ```text
/// sigma33 = Q33 e33 + Q23 e22,   sigma22 = Q23 e33 + Q22 e22,   sigma23 = 2 G e23.
/// ```
///
/// Only ratios matter: energies are measured in `Y = E33 = Q33 - Q23^2/Q22`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaneStress {
    q33: f64,
    q22: f64,
    q23: f64,
    g: f64,
}

impl PlaneStress {
    /// The four constants, any common unit.
    ///
    /// # Errors
    /// If a constant is not finite, the stiffness is not positive definite, or `Q22` or `G` differs from the
    /// Young modulus by more than twelve orders of magnitude.
    pub fn new(q33: f64, q22: f64, q23: f64, g: f64) -> Result<Self, InvalidInput> {
        let definite = q22 > 0.0 && g > 0.0 && q33 > 0.0 && (q23 / q22) * (q23 / q33) < 1.0;
        if !definite || ![q33, q22, q23, g].iter().all(|q| q.is_finite()) {
            let value = format!("({q33}, {q22}, {q23}, {g})");
            return Err(InvalidInput::new(
                "stiffness (Q33, Q22, Q23, G)",
                value,
                "finite constants, positive definite",
            ));
        }
        let stiffness = Self { q33, q22, q23, g };
        let c = stiffness.section_constants();
        if [c.beta2, c.twist].iter().any(|ratio| !(1.0 / LARGEST_RATIO..=LARGEST_RATIO).contains(ratio)) {
            let value = format!("({q33}, {q22}, {q23}, {g})");
            let expected = "constants within twelve orders of magnitude of Q33 - Q23^2/Q22";
            return Err(InvalidInput::new("stiffness (Q33, Q22, Q23, G)", value, expected));
        }
        Ok(stiffness)
    }

    /// Isotropic material of Poisson ratio `nu`, in units of its Young modulus:
    /// `Q33 = Q22 = 1/(1-nu^2)`, `Q23 = nu Q33`, `G = 1/(2(1+nu))`.
    ///
    /// # Errors
    /// If `nu` is outside `(-1, 1/2]`.
    pub fn isotropic(nu: f64) -> Result<Self, InvalidInput> {
        if !(nu > -1.0 && nu <= 0.5) {
            return Err(InvalidInput::new("nu", nu, "a number in (-1, 0.5]"));
        }
        let q = 1.0 / (1.0 - nu * nu);
        Self::new(q, q, nu * q, 0.5 / (1.0 + nu))
    }

    /// Incompressible isotropic material, the case of the paper: `Q33 = Q22 = 4/3`, `Q23 = 2/3`, `G = 1/3`.
    #[must_use]
    pub const fn incompressible() -> Self {
        Self { q33: 4.0 / 3.0, q22: 4.0 / 3.0, q23: 2.0 / 3.0, g: 1.0 / 3.0 }
    }

    /// The three numbers through which the stiffness enters the section energy.
    ///
    /// With `E33 = Q33 - Q23^2/Q22` the bending energy of the section,
    /// `eta^2/(24 E33) [Q33 b33^2 + 2 Q23 b33 b22 + Q22 b22^2 + 4 G b23^2]`, is
    /// `eta^2/24 b33^2 + eta^2 beta^2/2 (b22 + nu b33)^2 + eta^2 g b23^2`.
    #[must_use]
    pub fn section_constants(&self) -> SectionConstants {
        let nu = self.q23 / self.q22;
        let e33 = self.q33 - self.q23 * nu;
        SectionConstants { nu, beta2: self.q22 / (12.0 * e33), twist: self.g / (6.0 * e33) }
    }
}

/// Dimensionless constants of the section energy; `1/2, 1/9, 1/18` for the incompressible material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SectionConstants {
    /// `nu = Q23/Q22`: transverse curvature that a unit axial curvature calls for, with opposite sign.
    pub nu: f64,
    /// `beta^2 = Q22/(12 E33)`: transverse bending stiffness over `eta^2`.
    pub beta2: f64,
    /// `g = G/(6 E33)`: half the torsional stiffness over `eta^2`.
    pub twist: f64,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn incompressible_is_isotropic_with_nu_one_half() {
        let c = PlaneStress::incompressible().section_constants();
        let i = PlaneStress::isotropic(0.5).unwrap().section_constants();
        for (value, other, exact) in
            [(c.nu, i.nu, 0.5), (c.beta2, i.beta2, 1.0 / 9.0), (c.twist, i.twist, 1.0 / 18.0)]
        {
            assert!((value - exact).abs() <= f64::EPSILON * exact);
            assert!((other - exact).abs() <= 2.0 * f64::EPSILON * exact);
        }
    }

    #[test]
    fn indefinite_stiffness_is_refused() {
        assert!(PlaneStress::new(1.0, 1.0, 1.0, 1.0).is_err());
        assert!(PlaneStress::new(1.0, 1.0, 0.5, 0.0).is_err());
        assert!(PlaneStress::new(f64::NAN, 1.0, 0.5, 1.0).is_err());
        assert!(PlaneStress::isotropic(-1.0).is_err());
        assert!(PlaneStress::new(1.0, 1.0, 0.5, 1e300).is_err());
    }
}
