//! Past a fold of the way: its arclength in place of `t` (Keller 1977).
//!
//! With the tangent `(x', t')` at a point of the way, a step goes along it, and Newton's method returns to the way at
//! right angles, by the bordered equations solved with the factors of the others,
//!
//! ```text
//! [ J    F_t ] [dx]     [F]            dx = v + dt w,  v = -J^-1 F,  w = -J^-1 F_t,
//! [ x'^T  t' ] [dt] = - [0],           dt = -<x', v>/(<x', w> + t').
//! ```

#![expect(clippy::neg_cmp_op_on_partial_ord, reason = "what is not a number fails every test")]

use std::sync::Arc;

use super::iterate::{Correction, Iterate};
use super::path::{LARGEST_STEP_TURN, Path, largest_turn};
use super::system::{Failure, System};

/// A point of the way and its tangent, of unit length in the norm of the unknowns and `t`.
pub struct Point {
    /// The unknowns.
    pub x: Iterate,
    /// `t`.
    pub t: f64,
    along: Correction,
    ahead: f64,
}

/// Half the difference of `t` by which the equations are differentiated: of second order, its error and rounding are
/// about the same.
const DIFFERENCE: f64 = 1e-5;
/// Size of a correction that is small enough, as for steps of `t`.
const TOLERANCE: f64 = 1e-6;
/// Corrections of a step that are too many.
const ITERATIONS: usize = 8;

impl Point {
    /// The point `x` at `t`, looking ahead if `forward`, or else along `before`.
    ///
    /// # Errors
    /// Where the equations are singular, as they are at a bifurcation, or a section is refused.
    pub fn new(
        path: &Path,
        system: &mut System,
        x: Iterate,
        t: f64,
        before: Option<&Self>,
    ) -> Result<Self, Failure> {
        system.linearise(&x, &path.targets(&system.mesh.problem, t))?;
        let slope = slope(path, system, &x, t)?;
        let length = slope.norm(&system.mesh).hypot(1.0);
        let forward = before.is_none_or(|b| b.along.dot(&slope, &system.mesh) + b.ahead >= 0.0);
        let scale = if forward { 1.0 / length } else { -1.0 / length };
        let along = slope.scaled(scale);
        Ok(Self { x, t, along, ahead: scale })
    }

    /// `dt` along the way.
    #[must_use]
    pub fn ahead(&self) -> f64 {
        self.ahead
    }

    /// The unknowns where the tangent reaches `t`.
    #[must_use]
    pub fn extrapolated(&self, t: f64, system: &System) -> Iterate {
        self.x.moved(&self.along, (t - self.t) / self.ahead, &system.units)
    }

    /// The next point, a step of `length` away, and the number of corrections; `None` if there is none near.
    pub fn next(&self, path: &Path, system: &mut System, length: f64) -> Option<(Self, usize)> {
        let problem = Arc::clone(&system.mesh.problem);
        let mut x = self.x.moved(&self.along, length, &system.units);
        let mut t = self.t + length * self.ahead;
        let mut before = f64::INFINITY;
        for iteration in 1..=ITERATIONS {
            let targets = path.targets(&problem, t);
            system.settle(&mut x, targets.load);
            system.linearise(&x, &targets).ok()?;
            let v = system.correction();
            let w = slope(path, system, &x, t).ok()?;
            let dt = -self.along.dot(&v, &system.mesh) / (self.along.dot(&w, &system.mesh) + self.ahead);
            let correction = v.plus(dt, &w);
            let size = correction.norm(&system.mesh).hypot(dt);
            // NaN is refused, too.
            if !(size < 2.0 * before.min(length)) {
                return None;
            }
            x = x.moved(&correction, 1.0, &system.units);
            t += dt;
            before = size;
            if size <= TOLERANCE {
                system.settle(&mut x, path.targets(&problem, t).load);
                if largest_turn(&self.x, &x) > LARGEST_STEP_TURN {
                    return None;
                }
                return Some((Self::new(path, system, x, t, Some(self)).ok()?, iteration));
            }
        }
        None
    }
}

/// `dx/dt` at fixed residual, by the factors at `x`.
fn slope(path: &Path, system: &mut System, x: &Iterate, t: f64) -> Result<Correction, Failure> {
    let problem = Arc::clone(&system.mesh.problem);
    let ends = [t - DIFFERENCE, t + DIFFERENCE].map(|t| path.targets(&problem, t));
    system.difference(x, &ends, 2.0 * DIFFERENCE)?;
    Ok(system.correction())
}
