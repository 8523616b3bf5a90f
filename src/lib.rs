//! Equilibrium shapes of thin growing ribbons.
//!
//! A ribbon of length `l0`, width `a` and thickness `h`, with `h << a << l0`, whose material grows
//! unevenly across its width or thickness bends, twists or coils. This crate is the numerical core:
//!
//! - [`material`], [`growth`]: what the ribbon is made of and how it grows;
//! - [`section`]: the energy of the relaxed cross-section, its derivatives and its deflection;
//! - [`equilibrium`]: every unloaded equilibrium of a uniformly growing ribbon;
//! - [`maps`]: phase diagrams over two parameters;
//! - [`boundary`]: ribbons that are held and loaded, by Gauss collocation;
//! - [`continuation`]: branches of equilibria as a parameter varies, and what is special on them;
//! - [`maps`]: phase diagrams of two parameters;
//! - [`frame`]: from the strains along the ribbon to its position and orientation in space.
//!
//! # Conventions
//! Lengths are measured in the width `a`; `eta = h/a`; the strains are `(eps, K1, K2, K3)`: axial
//! strain, curvature in the plane of the ribbon (stiff), out of it (soft), and twist, in units of `1/a`.
//! Energies per unit length are in units of `Y h a`, with `Y` the Young modulus along the ribbon.
//! Equation numbers refer to H. Liu, M. Li and D. Liu, *Morphoelastic ribbons: Differential
//! growth-induced curvature and torsion*.

pub mod boundary;
pub mod continuation;
pub mod equilibrium;
pub mod frame;
pub mod growth;
pub mod legendre;
pub mod maps;
pub mod material;
pub mod piecewise;
pub mod section;

#[cfg(feature = "python")]
mod python;

mod error;
pub use error::InvalidInput;
