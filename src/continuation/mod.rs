//! Continuation: how equilibria change with a parameter, where they lose stability, and what branches off.
//!
//! Solutions of `F(x, t) = 0` form curves, followed by their arclength (Keller 1977). One implementation serves the section of a
//! ribbon that hangs free, two equations, and the boundary-value problem: what they have in common is [`Equations`].
//!
//! | file | role |
//! |---|---|
//! | `equations` | what is to be known of a problem |
//! | `natural`, `held`, `held_state` | a free section, and a ribbon that is held and loaded |
//! | `motions` | what tells a branch from motions that change nothing |
//! | `predict`, `correct`, `advance` | a step along a branch |
//! | `branch` | a branch, its beginning and its ends |
//! | `walk` | along a branch, as far as it is asked for |
//! | `locate`, `change`, `between` | special points between two points of a branch: what changes there |
//! | `place`, `root`, `value`, `near_miss` | their places, points at a value of the parameter, and branches that nearly meet |
//! | `locus` | a special point as a second parameter varies |
//! | `switch`, `diagram` | what branches off, and all branches that hang together |

mod advance;
mod between;
mod branch;
mod change;
mod correct;
mod diagram;
mod equations;
mod held;
mod held_state;
mod locate;
mod locus;
mod motions;
mod natural;
mod near_miss;
mod place;
mod predict;
mod root;
mod switch;
mod value;
mod walk;

pub use between::at as between;
pub use branch::{Branch, Ended, Limits, Special, SpecialKind, begin};
pub use correct::{Point, reversed};
pub use diagram::{Diagram, diagram};
pub use equations::{Direction, Equations, Failed, Stability};
pub use held::{Held, Work};
pub use held_state::{HeldState, begin_with};
pub use locus::{Locus, Plane, locus};
pub use natural::{Natural, NaturalFamily};
pub use value::at_value;
