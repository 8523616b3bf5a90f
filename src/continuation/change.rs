//! What changes at a special point, and a function that vanishes there.

use super::branch::SpecialKind;
use super::correct::Point;
use super::equations::Stability;

/// A change between two points of a branch.
pub struct Change {
    /// What.
    pub kind: SpecialKind,
    /// Whether branches meet there, two of them, and whether the parameter turns on the one that is followed, which meets the other from the side.
    pub simple: bool,
    pub from_the_side: bool,
    /// Whether what tells is that the parameter turns.
    pub turns: bool,
    /// Or the sign of the determinant.
    crosses: bool,
    /// Stability at the first point, and the change of the parameter along the branch.
    start: Stability,
    slope: f64,
    /// In how many directions sections are unstable on both sides.
    unstable: usize,
}

impl Change {
    /// What changes from one point to another, by how much the index does, and whether the parameter turns between.
    pub fn between<S, C>(
        [a, b]: [&Point<S, C>; 2],
        (kind, multiplicity): (SpecialKind, usize),
        turns: bool,
    ) -> Self {
        let simple = kind == SpecialKind::BranchPoint && multiplicity == 1;
        // Where two branches cross the determinant changes its sign. From the side where the parameter turns tells less: what keeps them apart
        // moves that by its third root.
        let crosses = simple && a.stability.signs(&b.stability) < 0.0;
        Self {
            kind,
            simple,
            from_the_side: simple && turns,
            turns: turns && !crosses,
            crosses,
            start: a.stability.clone(),
            slope: a.along.t,
            unstable: a.stability.section_index.min(b.stability.section_index),
        }
    }

    /// Whether it is still to come at a point.
    pub fn is_ahead_of<S, C>(&self, point: &Point<S, C>) -> bool {
        match self.kind {
            SpecialKind::SectionInstability => point.stability.section_index == self.start.section_index,
            _ if self.turns => point.along.t * self.slope > 0.0,
            _ if self.crosses => self.start.signs(&point.stability) >= 0.0,
            _ => point.stability.index == self.start.index,
        }
    }

    /// What vanishes where the index changes by so much: the change of the parameter at a fold, the determinant at a branch point to the power at
    /// which it grows in proportion.
    pub fn value<S, C>(&self, point: &Point<S, C>, multiplicity: usize) -> f64 {
        match self.kind {
            SpecialKind::SectionInstability => point.stability.section[usize::from(self.unstable == 1)],
            _ if self.turns => point.along.t,
            _ => {
                let side = if self.is_ahead_of(point) { 1.0 } else { -1.0 };
                let determinants = point.stability.determinant.zip(self.start.determinant);
                // Where the determinant is not known halves are left.
                let Some((here, first)) = determinants else { return side };
                let size = ((here.log - first.log) / multiplicity as f64).exp();
                // Of an even multiplicity, or where its sign is not known, it has none.
                let sign = if multiplicity.is_multiple_of(2) { 0.0 } else { here.sign * first.sign };
                size * if sign == 0.0 { side } else { sign }
            }
        }
    }

    /// By how much the index changes between two points.
    pub fn multiplicity<S, C>(&self, [low, high]: [&Point<S, C>; 2]) -> usize {
        let [low, high] = [low, high].map(|point| point.stability.index.unwrap_or(0));
        if self.crosses { 1 } else { low.abs_diff(high).max(1) }
    }
}
