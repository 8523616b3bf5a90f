//! From a known shape to a stable equilibrium, as a viscous ribbon creeps there.
//!
//! Sections that are viscous as well as elastic (Kelvin & Voigt) resist a change of their strains. A step of the implicit Euler
//! method asks for
//!
//! ```text
//! value(e) + drag (e - e_before) - compliance n = 0,
//! ```
//!
//! stationary for the energy plus `drag/2 sum (e - e_before)^2/compliance`. If it is a minimum of that, which the index of
//! the damped equations tells, the energy has become less. Ends and loads move to where they are to be meanwhile, and the drag fades
//! as far as the steps allow: where an equilibrium ends at a fold, the ribbon creeps to another.

use std::sync::Arc;

use super::adapt::defects;
use super::iterate::Iterate;
use super::mesh::Mesh;
use super::kinks::Phases;
use super::newton::{Control, Failed, newton};
use super::path::{LARGEST_ERROR, Path, Reached, Stop, Stride, largest_turn};
use super::system::{System, Targets};
use crate::InvalidInput;
use crate::section::Strain;

/// Drag of the first step, relative to the elasticity of the ungrown section.
pub const FIRST_DRAG: f64 = 1.0;
/// Drag that is as good as none: what is left is Newton's method.
const LEAST_DRAG: f64 = 1e-8;
/// Drag so small that nothing but slow motions are left.
const SMALL_DRAG: f64 = 1e-2;
/// Drag that nothing moves against.
const LARGEST_DRAG: f64 = 1e5;
/// How often kinks are moved.
const MOST_ROUNDS: usize = 3;
/// Steps that are too many.
const MOST_STEPS: usize = 1000;
/// Radians that a section turns at most in one step.
const LARGEST_STEP_TURN: f64 = 1.5;

impl Path {
    /// What is asked for at `t` of a ribbon that was at `reached`.
    fn viscous(&self, system: &System, reached: &Reached, t: f64, drag: f64) -> Targets {
        let mut targets = self.targets(&system.mesh.problem, t);
        if drag > 0.0 {
            targets.offset.resize(reached.x.strains.len(), crate::section::Strain::zeros());
            for (offset, strain) in targets.offset.iter_mut().zip(&reached.x.strains) {
                *offset += drag * strain;
            }
        }
        targets.drag = drag;
        targets
    }

    /// Creeps on from what was reached, as far as the mesh will do.
    pub fn creep(
        &mut self,
        system: &mut System,
        reached: &mut Reached,
        stride: &mut Stride,
        work: usize,
    ) -> Result<Stop, InvalidInput> {
        let problem = Arc::clone(&system.mesh.problem);
        if self.offset.is_empty() {
            let targets = self.targets(&problem, 0.0);
            match system.evaluate(&reached.x, &targets) {
                Ok(()) => self.offset.extend_from_slice(system.law_residual()),
                Err(failure) => {
                    reached.failure = Some(failure.into());
                    return Ok(Stop::Failed);
                }
            }
        }
        let control = Control { tolerance: 1e-6, iterations: 12, least_step: 1e-2 };
        let mut rest = 0_usize;
        let mut drag = stride.drag.unwrap_or(FIRST_DRAG);
        loop {
            if stride.interrupted.is_some_and(|asks| asks()) {
                reached.failure = Some(Failed::Interrupted);
                return Ok(Stop::Failed);
            }
            let t = (reached.fraction + stride.step).min(1.0);
            let targets = self.viscous(system, reached, t, drag);
            let ended = newton(system, reached.x.clone(), &targets, &control);
            reached.steps += 1;
            reached.iterations += ended.norms.len();
            let turned = largest_turn(&reached.x, &ended.x);
            let minimum = || {
                let index = system.index_here(&ended.x, targets.load, &[]);
                system.sections.index == 0 && index.is_none_or(|index| index == 0)
            };
            let failed = ended.failure.is_some();
            let failure = ended.failure.clone().or_else(|| (turned > LARGEST_STEP_TURN || stretched(&reached.x, &ended.x) > 0.02 || !minimum()).then_some(Failed::Jumped));
            if std::env::var("CREEP").is_ok() {
                eprintln!("t {t:.4} drag {drag:.1e} turned {turned:.2e} it {} index {:?} sec {} el {} {:?}", ended.norms.len(), system.index_here(&ended.x, targets.load, &[]), system.sections.index, system.mesh.elements(), failure);
            }
            let Some(failure) = failure else {
                let quick = ended.norms.len() <= 5;
                reached.x = ended.x;
                reached.fraction = t;
                reached.norms = ended.norms;
                let settled = t == 1.0 && drag < SMALL_DRAG && turned < 1e-2;
                if settled {
                    let phases = Phases::of(&system.mesh, &reached.x)?;
                    let moves = !phases.kinks.is_empty() && stride.rounds < MOST_ROUNDS;
                    let kinks = if moves { phases.moved()? } else { phases.kinks.clone() };
                    if kinks.iter().any(|s| !problem.kinks.contains(s)) {
                        if std::env::var("CREEP").is_ok() { eprintln!("kinks {:?} -> {kinks:?}", phases.kinks); }
                        stride.rounds += 1;
                        let split = phases.split(&reached.x, &kinks)?;
                        stride.drag = Some(SMALL_DRAG);
                        return Ok(Stop::Kinked(Box::new(split)));
                    }
                }
                if stride.careful && (reached.steps % 4 == 0 || drag == 0.0 && t == 1.0) {
                    let mut defects = defects(system, &reached.x, &targets)?;
                    // No mesh resolves what jumps within an element.
                    for s in Phases::of(&system.mesh, &reached.x)?.kinks {
                        if system.mesh.nodes.binary_search_by(|node| node.total_cmp(&s)).is_err() {
                            defects.leave_out(system.mesh.nodes.partition_point(|&node| node <= s) - 1);
                        }
                    }
                    let correction = system.correction_for(defects.gaps.clone());
                    let estimate = defects.estimate(&correction, &problem);
                    if estimate.error > if settled { LARGEST_ERROR } else { 10.0 * LARGEST_ERROR } {
                        stride.drag = Some(drag.max(1e-3));
                        return Ok(Stop::Coarse(estimate));
                    }
                }
                if drag == 0.0 && t == 1.0 {
                    if let Ok(path) = std::env::var("DUMP") {
                        let mut out = String::new();
                        for (k, e) in reached.x.strains.iter().enumerate() {
                            let d = system.mesh.gauss.degree;
                            out += &format!("{} {} {} {} {} {}\n", k / d, system.mesh.places(k / d)[k % d], e[0], e[1], e[2], e[3]);
                        }
                        std::fs::write(path, out).unwrap();
                    }
                    return Ok(Stop::There);
                }
                rest = rest.saturating_sub(1);
                if quick {
                    stride.step = (2.0 * stride.step).min(stride.most);
                }
                if quick && rest == 0 {
                    drag = if drag < LEAST_DRAG { 0.0 } else { 0.3 * drag };
                }
                continue;
            };
            if !failed && changed(&reached.x, &ended.x) < 1e-6 {
                // At rest, but not at a minimum.
                if std::env::var("CREEP").is_ok() { eprintln!("kick"); }
                kick(&system.mesh, &mut reached.x)?;
            }
            rest = 2;
            let moves = reached.fraction < 1.0;
            drag = (4.0 * drag).max(10.0 * LEAST_DRAG);
            if moves && drag > 10.0 {
                stride.step = 0.25 * (t - reached.fraction);
            }
            if moves {
                drag = drag.min(LARGEST_DRAG);
            }
            if drag > LARGEST_DRAG || stride.step < 1e-7 || reached.steps >= MOST_STEPS || system.factorisations * system.mesh.elements() >= work {
                reached.failure = Some(failure);
                return Ok(Stop::Failed);
            }
        }
    }
}

/// Largest change of the axial strain.
fn stretched(from: &Iterate, to: &Iterate) -> f64 {
    from.strains.iter().zip(&to.strains).map(|(a, b)| (b[0] - a[0]).abs()).fold(0.0, f64::max)
}

/// Largest change of a strain over the largest strain.
fn changed(from: &Iterate, to: &Iterate) -> f64 {
    let largest = |x: f64, e: Strain| x.max(e.amax());
    let change = from.strains.iter().zip(&to.strains).map(|(a, b)| b - a).fold(0.0, largest);
    change / to.strains.iter().copied().fold(f64::MIN_POSITIVE, largest)
}

/// Moves the strains a little in the softest direction of each section, and with a wave along the ribbon.
fn kick(mesh: &Mesh, x: &mut Iterate) -> Result<(), InvalidInput> {
    let size = KICK * x.strains.iter().map(|e| e.amax()).fold(0.0, f64::max);
    let mut before: Option<Strain> = None;
    for (k, s) in (0..mesh.elements()).flat_map(|i| mesh.places(i)).enumerate() {
        let Some(softest) = mesh.problem.law.at(s)?.neutral(&x.strains[k]) else { continue };
        let mut softest = softest / softest.amax();
        if before.is_some_and(|before| before.dot(&softest) < 0.0) {
            softest = -softest;
        }
        before = Some(softest);
        x.strains[k] += softest * (size * (1.0 + 0.5 * (3.0 * s / mesh.problem.length).cos()));
    }
    Ok(())
}

/// Size of a kick over the largest strain.
const KICK: f64 = 1e-2;
