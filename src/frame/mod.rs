//! From the strains along the ribbon to its position and orientation in space.
//!
//! # Conventions
//! - Quaternions are Hamilton's, `i j = k`, stored scalar first: `(q0, q1, q2, q3)`.
//! - A unit quaternion takes body to space: the directors `d1` (thickness), `d2` (width), `d3`
//!   (tangent) are the images of the fixed basis vectors, the rows of eq. (65).
//! - Curvatures are components on the directors: `d_i' = omega x d_i`, `omega = K1 d1 + K2 d2 + K3 d3`,
//!   so that `q' = (1/2) q (0, K1, K2, K3)`, eq. (67): multiplication from the right, and rotations
//!   compose from left to right along the ribbon.
//! - `r' = (1 + eps) d3`, eq. (66); `S` and positions are in units of the width.
//!
//! Position and orientation together are one element `g` of the group of rigid motions, with
//! `g' = g xi` and the twist `xi = (K; (1 + eps) e3)`. Every integrator here advances by exponentials
//! in that group: constant strain is exact, and no constraint can drift.

mod integrate;
mod motion;

pub use integrate::{gauss_points, helix, integrate_gauss, integrate_nodal, integrate_segments};
pub use motion::{Pose, Twist};
