//! The parts of the growth tensor `G = I + g` that reach the ribbon at the order of the theory.

use crate::InvalidInput;
use crate::piecewise::Piecewise;

/// The most coefficients that a polynomial field may have: beyond, monomials are a poor basis.
pub const MAX_COEFFICIENTS: usize = 33;

/// A function of `x = X2/a` on the width: a polynomial, pieces with jumps, or their sum.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Profile {
    /// Coefficients, lowest power first; empty means zero.
    pub polynomial: Vec<f64>,
    /// Polynomials on pieces of the width, from `-1/2` to `1/2`.
    pub pieces: Option<Piecewise>,
}

impl From<Vec<f64>> for Profile {
    fn from(polynomial: Vec<f64>) -> Self {
        Self { polynomial, pieces: None }
    }
}

impl From<Piecewise> for Profile {
    fn from(pieces: Piecewise) -> Self {
        Self { polynomial: Vec::new(), pieces: Some(pieces) }
    }
}

impl Profile {
    /// Whether the profile is zero everywhere.
    #[must_use]
    pub fn is_zero(&self) -> bool {
        let zero = |series: &Vec<f64>| series.iter().all(|&c| c == 0.0);
        zero(&self.polynomial) && self.pieces.as_ref().is_none_or(|p| p.pieces().iter().all(zero))
    }

    /// The value of a profile that is the same all over the width.
    #[must_use]
    pub fn constant(&self) -> Option<f64> {
        match (self.polynomial.as_slice(), &self.pieces) {
            ([], None) => Some(0.0),
            (&[constant], None) => Some(constant),
            _ => None,
        }
    }

    fn add(&mut self, factor: f64, other: &Self) {
        let mine = &mut self.polynomial;
        mine.resize(mine.len().max(other.polynomial.len()), 0.0);
        mine.iter_mut().zip(&other.polynomial).for_each(|(m, c)| *m += factor * c);
        if let Some(theirs) = &other.pieces {
            let zero = || Piecewise::zero(theirs.breaks());
            self.pieces = Some(self.pieces.take().unwrap_or_else(zero).plus(factor, theirs));
        }
    }

    fn validate(&self, name: &'static str) -> Result<(), InvalidInput> {
        if let Some(bad) = self.polynomial.iter().find(|c| !c.is_finite()) {
            return Err(InvalidInput::new(name, bad, "finite coefficients"));
        }
        let count = self.polynomial.len();
        if count > MAX_COEFFICIENTS {
            let expected = format!("at most {MAX_COEFFICIENTS} coefficients");
            return Err(InvalidInput::new(name, format!("{count} coefficients"), &expected));
        }
        let Some(pieces) = &self.pieces else { return Ok(()) };
        let (first, last) = pieces.range();
        if (first, last) != (-0.5, 0.5) {
            let range = format!("pieces from {first} to {last}");
            return Err(InvalidInput::new(name, range, "pieces from -1/2 to 1/2"));
        }
        if let Some(x) = pieces.jumps().next().filter(|_| name == "g31") {
            let found = format!("a jump at x = {x}");
            return Err(InvalidInput::new(
                name,
                found,
                "a continuous field: the energy of a jump is infinite",
            ));
        }
        Ok(())
    }
}

/// Growth fields over the width.
///
/// An axial growth `g33 = gamma33(x) + (X1/a) d33(x)` is split into its mid-surface value and its
/// thickness gradient; `g22` likewise. `d23` and `gamma23` belong to the sum `g23 + g32`.
/// `g11` changes only the thickness and is left out.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Growth {
    /// Axial growth `g33` of the mid-surface.
    pub gamma33: Profile,
    /// Thickness gradient of the axial growth.
    pub d33: Profile,
    /// Thickness gradient of the transverse growth.
    pub d22: Profile,
    /// Thickness gradient of the shear growth `g23 + g32`.
    pub d23: Profile,
    /// Transverse shear growth `g21`; acts through its derivative in `x`.
    pub g21: Profile,
    /// Transverse shear growth `g31`; acts through its derivative in `x`.
    pub g31: Profile,
    /// Transverse growth `g22` of the mid-surface; changes only the displacement `u2`.
    pub gamma22: Profile,
    /// Shear growth `g23 + g32` of the mid-surface; changes only the displacement `u3`.
    pub gamma23: Profile,
}

impl Growth {
    /// Edge growth `g33 = xi (2 X2/a)^2`, eq. (51).
    #[must_use]
    pub fn edge(xi: f64) -> Self {
        Self { gamma33: vec![0.0, 0.0, 4.0 * xi].into(), ..Self::default() }
    }

    /// Thickness gradient `g33 = xi X1/a`, eq. (44), with `g22 = transverse X1/a`.
    #[must_use]
    pub fn thickness(xi: f64, transverse: f64) -> Self {
        Self { d33: vec![xi].into(), d22: vec![transverse].into(), ..Self::default() }
    }

    /// Through-thickness shear growth `g23 + g32 = d X1/a`, as of oblique fibres: chirality `omega = d/(2 eta)`.
    #[must_use]
    pub fn chiral(d: f64) -> Self {
        Self { d23: vec![d].into(), ..Self::default() }
    }

    /// Field by its name.
    pub fn field_mut(&mut self, name: &str) -> Option<&mut Profile> {
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
    pub fn fields(&self) -> [(&'static str, &Profile); 8] {
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

    /// Adds `factor` times another growth, field by field, with the gradients through the thickness
    /// taken `lever` times.
    pub fn add_scaled(&mut self, factor: f64, lever: f64, other: &Self) {
        for (name, field) in other.fields() {
            let factor = if name.starts_with('d') { factor * lever } else { factor };
            if let Some(mine) = self.field_mut(name) {
                mine.add(factor, field);
            }
        }
    }

    /// The gradients through the thickness, and the rest.
    #[must_use]
    pub fn split(mut self) -> [Self; 2] {
        let take = std::mem::take;
        let gradients = Self {
            d33: take(&mut self.d33),
            d22: take(&mut self.d22),
            d23: take(&mut self.d23),
            ..Self::default()
        };
        [gradients, self]
    }

    /// Checks that every field is finite, not too long, given on the whole width, and `g31` continuous, since
    /// the energy takes the square of its derivative.
    ///
    /// # Errors
    /// The first field that is refused, and why.
    pub fn validate(&self) -> Result<(), InvalidInput> {
        self.fields().into_iter().try_for_each(|(name, field)| field.validate(name))
    }
}

impl std::ops::Add for Growth {
    type Output = Self;

    /// Growths add field by field.
    fn add(mut self, other: Self) -> Self {
        self.add_scaled(1.0, 1.0, &other);
        self
    }
}
