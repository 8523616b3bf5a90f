//! The parts of the growth tensor `G = I + g` that reach the ribbon at the order of the theory.

use crate::InvalidInput;

/// The most coefficients that a polynomial field may have: beyond, monomials are a poor basis.
pub const MAX_COEFFICIENTS: usize = 33;

/// Growth fields over the width, polynomials in `x = X2/a`, lowest power first; empty means zero.
///
/// An axial growth `g33 = gamma33(x) + (X1/a) d33(x)` is split into its mid-surface value and its
/// thickness gradient; `g22` likewise. `d23` and `gamma23` belong to the sum `g23 + g32`.
/// `g11` changes only the thickness and is left out.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Growth {
    /// Axial growth `g33` of the mid-surface.
    pub gamma33: Vec<f64>,
    /// Thickness gradient of the axial growth.
    pub d33: Vec<f64>,
    /// Thickness gradient of the transverse growth.
    pub d22: Vec<f64>,
    /// Thickness gradient of the shear growth `g23 + g32`.
    pub d23: Vec<f64>,
    /// Transverse shear growth `g21`; acts through its derivative in `x`.
    pub g21: Vec<f64>,
    /// Transverse shear growth `g31`; acts through its derivative in `x`.
    pub g31: Vec<f64>,
    /// Transverse growth `g22` of the mid-surface; changes only the displacement `u2`.
    pub gamma22: Vec<f64>,
    /// Shear growth `g23 + g32` of the mid-surface; changes only the displacement `u3`.
    pub gamma23: Vec<f64>,
}

impl Growth {
    /// Edge growth `g33 = xi (2 X2/a)^2`, eq. (51).
    #[must_use]
    pub fn edge(xi: f64) -> Self {
        Self { gamma33: vec![0.0, 0.0, 4.0 * xi], ..Self::default() }
    }

    /// Thickness gradient `g33 = xi X1/a`, eq. (44), with `g22 = transverse X1/a`.
    #[must_use]
    pub fn thickness(xi: f64, transverse: f64) -> Self {
        Self { d33: vec![xi], d22: vec![transverse], ..Self::default() }
    }

    /// Through-thickness shear growth `g23 + g32 = d X1/a`, as of oblique fibres: chirality `omega = d/(2 eta)`.
    #[must_use]
    pub fn chiral(d: f64) -> Self {
        Self { d23: vec![d], ..Self::default() }
    }

    /// Field by its name.
    pub fn field_mut(&mut self, name: &str) -> Option<&mut Vec<f64>> {
        Some(match name {
            "gamma33" => &mut self.gamma33,
            "d33" => &mut self.d33,
            "d22" => &mut self.d22,
            "d23" => &mut self.d23,
            "g21" => &mut self.g21,
            "g31" => &mut self.g31,
            "gamma22" => &mut self.gamma22,
            "gamma23" => &mut self.gamma23,
            _ => return None,
        })
    }

    /// All fields with their names.
    #[must_use]
    pub fn fields(&self) -> [(&'static str, &Vec<f64>); 8] {
        [
            ("gamma33", &self.gamma33),
            ("d33", &self.d33),
            ("d22", &self.d22),
            ("d23", &self.d23),
            ("g21", &self.g21),
            ("g31", &self.g31),
            ("gamma22", &self.gamma22),
            ("gamma23", &self.gamma23),
        ]
    }

    /// Checks that every coefficient is finite and no field has too many.
    ///
    /// # Errors
    /// The first field that is refused, and why.
    pub fn validate(&self) -> Result<(), InvalidInput> {
        for (name, field) in self.fields() {
            if let Some(bad) = field.iter().find(|c| !c.is_finite()) {
                return Err(InvalidInput::new(name, bad, "finite coefficients"));
            }
            if field.len() > MAX_COEFFICIENTS {
                let expected = format!("at most {MAX_COEFFICIENTS} coefficients");
                return Err(InvalidInput::new(name, format!("{} coefficients", field.len()), &expected));
            }
        }
        Ok(())
    }
}

impl std::ops::Add for Growth {
    type Output = Self;

    /// Growths add field by field.
    fn add(mut self, other: Self) -> Self {
        for (name, field) in other.fields() {
            if let Some(mine) = self.field_mut(name) {
                mine.resize(mine.len().max(field.len()), 0.0);
                mine.iter_mut().zip(field).for_each(|(m, c)| *m += c);
            }
        }
        self
    }
}
