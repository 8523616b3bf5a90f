//! Equilibria of the unloaded ribbon.
//!
//! Without load and with a free end the force and moment vanish everywhere, so the strains of a
//! uniformly growing ribbon are a stationary point of the section energy: no boundary-value problem.
//! `dPi/d eps = dPi/dK1 = 0` give `eps = <gamma33> - K3^2/24` and `K1 = 12 <x gamma33>`; what remains
//! are two equations in `K2` and `K3`, of which [`natural_shapes`] finds every solution. Where the ribbon varies
//! along its length, [`natural_branches`] follows the stable ones.

mod along;
mod bound;
mod branch;
mod cubic;
mod natural;
mod phase;
mod reduced;
mod roots;
mod second_order;

pub use along::{TOLERANCE, natural_branches};
pub use branch::{Event, EventKind, NaturalBranch};
pub use natural::{Balance, Equilibrium, balance, natural_shapes};
pub use phase::{PHASE_TOLERANCE, Phase};

pub(crate) use natural::settle;
