//! What tells the points of a map apart.

use crate::equilibrium::{Equilibrium, Phase};

/// The stable states at a point: which is lowest in energy, and how many there are of each phase.
///
/// Mirror images count; which of them is the lowest does not matter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Class {
    /// Phase of the stable state of lowest energy; `None` where no state is stable, as the second-order law has it.
    pub lowest: Option<Phase>,
    /// Stable states of each phase, in the order of [`Phase::ALL`].
    pub stable: [u8; 4],
}

/// A class with numbers of its state of lowest energy, in the ribbon's units; not-a-number where none is stable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// The class.
    pub class: Class,
    /// `Pi`.
    pub energy: f64,
    /// Curvature.
    pub k2: f64,
    /// Twist.
    pub k3: f64,
    /// Whether all equilibria here are told apart.
    pub resolved: bool,
}

/// The stable states among shapes; those that stand for several if no other is.
pub(super) fn stable(shapes: &[Equilibrium]) -> impl Iterator<Item = &Equilibrium> {
    let strictly = shapes.iter().any(|shape| shape.section_index == 0);
    shapes.iter().filter(move |shape| if strictly { shape.section_index == 0 } else { !shape.resolved })
}

impl Class {
    /// The class of all equilibria at a point, lowest energy first.
    #[must_use]
    pub fn of(shapes: &[Equilibrium]) -> Self {
        let mut class = Self { lowest: None, stable: [0; 4] };
        for shape in stable(shapes) {
            class.lowest.get_or_insert(shape.phase);
            class.stable[shape.phase as usize] += 1;
        }
        class
    }

    /// How many states are stable.
    #[must_use]
    pub fn count(&self) -> usize {
        self.stable.iter().map(|&count| usize::from(count)).sum()
    }
}

impl Sample {
    /// What is kept of all equilibria at a point.
    #[must_use]
    pub fn of(shapes: &[Equilibrium]) -> Self {
        let lowest = stable(shapes).next();
        let number = |of: fn(&Equilibrium) -> f64| lowest.map_or(f64::NAN, of);
        Self {
            class: Class::of(shapes),
            energy: number(|shape| shape.energy),
            k2: number(|shape| shape.strain[2]),
            k3: number(|shape| shape.strain[3]),
            resolved: shapes.iter().all(|shape| shape.resolved),
        }
    }
}
