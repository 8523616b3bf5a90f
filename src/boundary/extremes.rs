//! Between which values strains are.

use crate::section::Strain;

/// The least and the greatest of each strain at some places.
#[derive(Clone, Copy, Debug)]
pub struct Extremes {
    /// The least.
    pub least: Strain,
    /// The greatest.
    pub greatest: Strain,
}

impl Default for Extremes {
    fn default() -> Self {
        Self { least: Strain::repeat(f64::INFINITY), greatest: Strain::repeat(f64::NEG_INFINITY) }
    }
}

impl Extremes {
    /// Takes the strains of one more place into account.
    pub fn take(&mut self, strain: &Strain) {
        self.least = self.least.inf(strain);
        self.greatest = self.greatest.sup(strain);
    }

    /// The same with other places taken into account.
    #[must_use]
    pub fn with(mut self, other: &Self) -> Self {
        self.take(&other.least);
        self.take(&other.greatest);
        self
    }

    /// Whether no strain differs by more than this from place to place.
    #[must_use]
    pub fn alike(&self, most: &Strain) -> bool {
        (self.greatest - self.least).iter().zip(most).all(|(difference, most)| difference <= most)
    }
}
