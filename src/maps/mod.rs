//! Phase diagrams: which natural shapes are stable over a rectangle of two parameters.
//!
//! At every node of a grid [`crate::equilibrium::natural_shapes`] finds all equilibria anew, so no node owes anything to its
//! neighbours. Where the nodes at the ends of an edge of the grid differ in their [`Class`], the places of change between
//! them are found to a tolerance, each enclosed by two complete searches that are no farther apart. The
//! places are joined to lines cell by cell; a cell is quartered where they are not straight or meet.
//!
//! A line that crosses an edge twice between its nodes is looked for beside the lines that are found, and where what is inside a
//! cell does not agree with its border. A region that holds no node at all is not seen.

mod cell;
mod chain;
mod class;
mod crossing;
mod followed;
mod grid;
mod meeting;
mod outline;
mod plane;
mod progress;
mod root;

pub use class::{Class, Sample};
pub use crossing::Crossing;
pub use grid::{Edges, PhaseMap, phase_map};
pub use meeting::Field;
pub use outline::{Hidden, Nodes, Outline, Polyline, outline};
pub use plane::Plane;
pub use progress::Progress;
