//! Damped Newton with an affine-invariant test: Deuflhard, *Newton methods for nonlinear problems* (2004), NLEQ-ERR.
//!
//! A step is judged by the simplified correction at its end, with the factors of its start, in the norm of the
//! unknowns: multiplying the equations by any matrix changes nothing.

#![expect(clippy::neg_cmp_op_on_partial_ord, reason = "what is not a number fails every test")]

use super::ends::is_upright;
use super::iterate::{Correction, Iterate};
use super::mesh::Mesh;
use super::system::{Failure, System, Targets};

/// When to stop.
#[derive(Clone, Copy, Debug)]
pub struct Control {
    /// Size of the correction that is small enough; what rounding forbids is not waited for.
    pub tolerance: f64,
    /// Factorisations that are too many.
    pub iterations: usize,
    /// The least fraction of a correction.
    pub least_step: f64,
}

/// How the iteration ended.
#[derive(Clone, Debug)]
pub struct Ended {
    /// The last iterate.
    pub x: Iterate,
    /// Norms of the Newton corrections.
    pub norms: Vec<f64>,
    /// Why not, if it did not converge.
    pub failure: Option<Failed>,
}

/// Why the iteration did not converge.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Failed {
    /// The equations could not be solved.
    #[error(transparent)]
    Equations(#[from] Failure),
    /// No fraction of a correction brings the iterate closer.
    #[error("Newton's method does not come closer: the last correction is {0:.1e}")]
    Stuck(f64),
    /// It converged to a shape that is not near the last.
    #[error("the shape jumps")]
    Jumped,
    /// Asked to stop.
    #[error("interrupted")]
    Interrupted,
    /// Too much work.
    #[error("the way there is too long, {0:.2} of it are gone")]
    Far(f64),
    /// Too many steps.
    #[error("the ribbon does not come to rest in {0} steps of creeping")]
    Restless(usize),
    /// Too many.
    #[error("Newton's method is too slow: the last correction is {0:.1e}")]
    Slow(f64),
}

/// Corrections that no longer shrink count as rounding below this.
const ROUNDING: f64 = 1e-8;

/// Iterates from `x` until the correction is small.
pub fn newton(system: &mut System, x: Iterate, targets: &Targets, control: &Control) -> Ended {
    let mut ended = iterated(system, x, targets, control);
    let nodes = [0, ended.x.nodes.len() - 1];
    if ended.failure.is_none() && !(0..2).all(|i| is_upright(&targets.ends[i], &ended.x.nodes[nodes[i]])) {
        ended.failure = Some(Failed::Jumped);
    }
    ended
}

fn iterated(system: &mut System, x: Iterate, targets: &Targets, control: &Control) -> Ended {
    let mut norms = Vec::new();
    let mut x = x;
    system.settle(&mut x, targets.load);
    // What the last step tells about the next: its correction, the simplified one, its fraction.
    let mut last: Option<(f64, Correction, f64)> = None;
    loop {
        if let Err(failure) = system.linearise(&x, targets) {
            return Ended { x, norms, failure: Some(failure.into()) };
        }
        let full = system.correction();
        let size = full.norm(&system.mesh);
        norms.push(size);
        if !size.is_finite() {
            let failure = Failure::NotFinite("in a correction".to_owned());
            return Ended { x, norms, failure: Some(failure.into()) };
        }
        let mut fraction = 1.0;
        if let Some((before, simplified, step)) = &last {
            let difference = distance(simplified, 1.0, &full, &system.mesh);
            let predicted = before * simplified.norm(&system.mesh) / (difference * size) * step;
            fraction = predicted.min(1.0);
        }
        let step = |system: &mut System, fraction: f64| {
            let mut trial = x.moved(&full, fraction, &system.units);
            system.settle(&mut trial, targets.load);
            let shorter = system.evaluate(&trial, targets).map(|()| system.correction());
            (trial, shorter)
        };
        let mut grown = false;
        let (trial, simplified) = loop {
            if fraction < control.least_step {
                return Ended { x, norms, failure: Some(Failed::Stuck(size)) };
            }
            let (trial, simplified) = step(system, fraction);
            let simplified = match simplified {
                Ok(simplified) => simplified,
                Err(Failure::Refused(refused)) => {
                    let failure = Failure::Refused(refused);
                    return Ended { x, norms, failure: Some(failure.into()) };
                }
                Err(_) => {
                    fraction *= 0.5;
                    continue;
                }
            };
            let shorter = simplified.norm(&system.mesh);
            if fraction == 1.0 && shorter <= control.tolerance && shorter < size {
                let mut done = trial.moved(&simplified, 1.0, &system.units);
                system.settle(&mut done, targets.load);
                norms.push(shorter);
                return Ended { x: done, norms, failure: None };
            }
            if size < ROUNDING && !(shorter < 0.25 * size) {
                return Ended { x: trial, norms, failure: None };
            }
            let difference = distance(&simplified, 1.0 - fraction, &full, &system.mesh);
            let possible = 0.5 * size * fraction * fraction / difference;
            if !(shorter < size) {
                fraction = if possible < 0.5 * fraction { possible } else { 0.5 * fraction };
                grown = true;
                continue;
            }
            if !grown && possible.min(1.0) >= 4.0 * fraction {
                fraction = possible.min(1.0);
                grown = true;
                continue;
            }
            break (trial, simplified);
        };
        x = trial;
        last = Some((size, simplified, fraction));
        if norms.len() >= control.iterations {
            return Ended { x, norms, failure: Some(Failed::Slow(size)) };
        }
    }
}

/// Norm of `a - factor b`.
fn distance(a: &Correction, factor: f64, b: &Correction, mesh: &Mesh) -> f64 {
    a.plus(-factor, b).norm(mesh)
}
