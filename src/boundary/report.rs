//! How a solve went and how it ended.

/// How a solve ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// The error is below the tolerance.
    Converged,
    /// Rounding keeps the error above the tolerance; it is what it can be.
    RoundingLimited,
    /// The equations are singular on the way.
    Singular,
    /// Newton's method fails on the way, at the least step, or the independent check does not confirm.
    Diverged,
    /// The elements allowed do not suffice.
    Unresolved,
    /// It was asked to stop.
    Interrupted,
}

impl Status {
    /// All of them.
    pub const ALL: [Self; 6] = [
        Self::Converged,
        Self::RoundingLimited,
        Self::Singular,
        Self::Diverged,
        Self::Unresolved,
        Self::Interrupted,
    ];

    /// The name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Converged => "converged",
            Self::RoundingLimited => "rounding_limited",
            Self::Singular => "singular",
            Self::Diverged => "diverged",
            Self::Unresolved => "unresolved",
            Self::Interrupted => "interrupted",
        }
    }

    /// Whether there is a solution.
    #[must_use]
    pub fn is_solved(self) -> bool {
        matches!(self, Self::Converged | Self::RoundingLimited)
    }
}

/// How the solve went.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// How it ended.
    pub status: Status,
    /// Why not at a solution.
    pub reason: String,
    /// How much of loads and displacements was reached.
    pub fraction: f64,
    /// Estimate of the largest error of position/L, of angles, and of strains (`eps`, `K L`).
    pub error: f64,
    /// The largest residual of the independent check.
    pub residual: f64,
    /// Condition number of the conditions at the ends.
    pub condition: f64,
    /// Newton iterations.
    pub iterations: usize,
    /// Factorisations.
    pub factorisations: usize,
    /// Meshes.
    pub meshes: usize,
    /// Solves on the way to the loads.
    pub load_steps: usize,
    /// Norms of the corrections of the last solve.
    pub norms: Vec<f64>,
}
