//! Names of the shapes.

use crate::section::Strain;

/// `|K2|/eta` or `|K3|/eta` below which a ribbon is called unbent or untwisted.
pub const PHASE_TOLERANCE: f64 = 1e-6;

/// What a uniform ribbon looks like, by its bending `K2` and its twist `K3`.
///
/// In-plane curvature `K1` does not change the name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// `K2 = K3 = 0`: in one plane.
    Flat,
    /// `K2` alone.
    Bent,
    /// `K3` alone: a helicoid, if `K1 = 0`.
    Twisted,
    /// Both: the centreline is a helix.
    Helical,
}

impl Phase {
    /// All phases.
    pub const ALL: [Self; 4] = [Self::Flat, Self::Bent, Self::Twisted, Self::Helical];

    /// The phase of a strain in a ribbon of thickness ratio `eta`.
    #[must_use]
    pub fn of(strain: &Strain, eta: f64) -> Self {
        let nonzero = |k: f64| k.abs() > PHASE_TOLERANCE * eta;
        match (nonzero(strain[2]), nonzero(strain[3])) {
            (false, false) => Self::Flat,
            (true, false) => Self::Bent,
            (false, true) => Self::Twisted,
            (true, true) => Self::Helical,
        }
    }

    /// Lower-case name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Flat => "flat",
            Self::Bent => "bent",
            Self::Twisted => "twisted",
            Self::Helical => "helical",
        }
    }
}
