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
//! as far as the steps allow: where an equilibrium ends at a fold, the ribbon creeps to another, and where sections become unstable
//! they go over to another phase, one after the other, which leaves kinks.

use super::adapt::{Estimate, defects, refined, transferred};
use super::iterate::Iterate;
use super::kinks::Phases;
use super::known::Known;
use super::mesh::Mesh;
use super::newton::{Control, Ended, Failed, newton};
use super::path::{LARGEST_ERROR, Path, Reached, largest_turn};
use super::solve::{Settings, new_system};
use super::spent::{Spent, work};
use super::system::{System, Targets};
use crate::InvalidInput;
use crate::section::Strain;

/// Drag of the first step, relative to the elasticity of the ungrown section.
const FIRST_DRAG: f64 = 1.0;
/// Drag so small that only slow motions are left: kinks are looked for then.
const SMALL_DRAG: f64 = 1e-2;
/// Drag that is as good as none: what is left is Newton's method.
const LEAST_DRAG: f64 = 1e-8;
/// Drag that nothing moves against.
const LARGEST_DRAG: f64 = 1e5;
/// Drag above which steps of ends and loads, too, are made shorter.
const STIFF_DRAG: f64 = 10.0;
/// By how much a step that fails makes the drag larger, and one that is quick makes it smaller.
const MORE: f64 = 4.0;
const LESS: f64 = 0.3;
/// Steps after a failure in which the drag does not become smaller.
const REST: usize = 2;
/// Newton iterations of a quick step.
const QUICK: usize = 5;
/// Radians that a section turns at most in one step, and by how much it stretches.
const LARGEST_STEP_TURN: f64 = 1.5;
const LARGEST_STRETCH: f64 = 0.02;
/// The least step of ends and loads.
const LEAST_STEP: f64 = 1e-7;
/// Steps that are too many.
const MOST_STEPS: usize = 1000;
/// How often kinks are put elsewhere.
const MOST_MOVES: usize = 3;
/// Steps between looks at the error of the mesh.
const LOOK: usize = 4;
/// Error that a mesh is made for, and elements that are too many for that.
const ERROR: f64 = 1e-2;
const MOST_ELEMENTS: usize = 1000;
/// Relative change of the strains, times the drag, of a ribbon at rest, and the size of a disturbance of one that is not stable there.
const AT_REST: f64 = 1e-5;
const KICK: f64 = 1e-2;

/// The pace of creeping.
struct Pace {
    drag: f64,
    /// The next step of ends and loads, of the whole way, and the largest.
    step: f64,
    most: f64,
    /// Steps that are still to be made before the drag becomes smaller.
    rest: usize,
    /// How often kinks may still be put elsewhere.
    moves: usize,
    /// Whether the mesh is made finer.
    refines: bool,
}

/// Why creeping pauses.
enum Pause {
    /// The ribbon is at rest at the goal, without drag.
    There,
    /// The mesh is too coarse.
    Coarse(Estimate),
    /// Elements are to end elsewhere: the mesh where they do, and the iterate there.
    Remade(Box<(Mesh, Iterate)>),
    /// It does not go on; [`Reached::failure`] says why.
    Failed,
}

/// Creeps from the known shape to a stable equilibrium on a mesh that follows it.
///
/// # Errors
/// Where a section is refused.
pub fn crept(
    settings: &Settings,
    mesh: Mesh,
    known: &Known<'_>,
    spent: &mut Spent,
) -> Result<(Mesh, Reached), InvalidInput> {
    let path = Path::new(&mesh, known)?;
    let reached = Reached::start(&path);
    let most = mesh.problem.largest_step(known);
    crept_along(settings, mesh, path, reached, most, spent)
}

/// Creeps from an unstable equilibrium, disturbed, to a stable one.
///
/// # Errors
/// Where a section is refused.
pub fn crept_from(
    settings: &Settings,
    mesh: Mesh,
    mut x: Iterate,
    spent: &mut Spent,
) -> Result<(Mesh, Reached), InvalidInput> {
    kick(&mesh, &mut x)?;
    crept_on(settings, mesh, x, spent)
}

/// Creeps on from a shape near one of rest, as on a finer mesh.
///
/// # Errors
/// Where a section is refused.
pub fn crept_on(
    settings: &Settings,
    mesh: Mesh,
    x: Iterate,
    spent: &mut Spent,
) -> Result<(Mesh, Reached), InvalidInput> {
    let path = Path::at_goal(&mesh, x);
    let reached = Reached { fraction: 1.0, ..Reached::start(&path) };
    crept_along(settings, mesh, path, reached, 1.0, spent)
}

fn crept_along(
    settings: &Settings,
    mut mesh: Mesh,
    mut path: Path,
    mut reached: Reached,
    most: f64,
    spent: &mut Spent,
) -> Result<(Mesh, Reached), InvalidInput> {
    let step = most.min(0.5);
    let mut pace = Pace { drag: FIRST_DRAG, step, most, rest: 0, moves: MOST_MOVES, refines: true };
    loop {
        let mut system = new_system(mesh, settings)?;
        if let Err(failure) = path.begin(&mut system, &reached) {
            reached.failure = Some(failure.into());
            return Ok((system.mesh, reached));
        }
        let pause = creep(&path, &mut system, &mut reached, &mut pace, settings, spent.left())?;
        spent.factorised(&system);
        spent.meshes += 1;
        mesh = system.mesh;
        let (finer, x) = match pause {
            Pause::Remade(split) => *split,
            Pause::Coarse(estimate) => {
                let nodes = refined(&mesh, &estimate, ERROR);
                if nodes.len() > MOST_ELEMENTS + 1 {
                    pace.refines = false;
                    continue;
                }
                let finer = Mesh::new(&mesh.problem, nodes, settings.degree)?;
                let x = transferred(&reached.x, &mesh, &finer)?;
                (finer, x)
            }
            Pause::There | Pause::Failed => {
                spent.went(&reached);
                return Ok((mesh, reached));
            }
        };
        path.transfer(&mesh, &finer);
        (mesh, reached.x) = (finer, x);
    }
}

/// Creeps on from what was reached, as far as the mesh will do and no more than this much work.
fn creep(
    path: &Path,
    system: &mut System,
    reached: &mut Reached,
    pace: &mut Pace,
    settings: &Settings,
    most_work: usize,
) -> Result<Pause, InvalidInput> {
    let control = Control { tolerance: 1e-6, iterations: 12, least_step: 1e-2 };
    loop {
        if settings.interrupted.is_some_and(|asks| asks()) {
            reached.failure = Some(Failed::Interrupted);
            return Ok(Pause::Failed);
        }
        if reached.steps >= MOST_STEPS || work(system) >= most_work {
            reached.failure = Some(Failed::Restless(reached.steps));
            return Ok(Pause::Failed);
        }
        let t = (reached.fraction + pace.step).min(1.0);
        let targets = viscous(path, system, reached, t, pace.drag);
        let ended = newton(system, reached.x.clone(), &targets, &control);
        reached.steps += 1;
        reached.iterations += ended.norms.len();
        if let Some(failure) = refused(system, &reached.x, &ended, &targets) {
            let stays = ended.failure.is_none() && targets.drag * changed(&reached.x, &ended.x) < AT_REST;
            if stays {
                if let Some(divided) = divided(system, &ended.x, &targets)? {
                    return Ok(Pause::Remade(Box::new(divided)));
                }
                kick(&system.mesh, &mut reached.x)?;
            }
            if !pace.slower(t - reached.fraction) {
                reached.failure = Some(failure);
                return Ok(Pause::Failed);
            }
            continue;
        }
        let turned = largest_turn(&reached.x, &ended.x);
        let iterations = ended.norms.len();
        (reached.x, reached.fraction, reached.norms) = (ended.x, t, ended.norms);
        let there = t == 1.0 && pace.drag == 0.0;
        let slow = t == 1.0 && pace.drag < SMALL_DRAG && turned < SMALL_DRAG;
        if slow && let Some(split) = pace.kinked(system, reached)? {
            return Ok(Pause::Remade(Box::new(split)));
        }
        if pace.refines && (reached.steps.is_multiple_of(LOOK) || there) {
            let estimate = resolvable(system, &reached.x, &targets)?;
            // While it moves the shape need not be more than roughly right.
            if estimate.error > LARGEST_ERROR * if slow { 1.0 } else { 10.0 } {
                pace.drag = pace.drag.max(0.1 * SMALL_DRAG);
                return Ok(Pause::Coarse(estimate));
            }
        }
        if there {
            return Ok(Pause::There);
        }
        pace.faster(iterations);
    }
}

/// What is asked for at `t` of a ribbon that was at `reached`.
fn viscous(path: &Path, system: &System, reached: &Reached, t: f64, drag: f64) -> Targets {
    let mut targets = path.targets(&system.mesh.problem, t);
    if drag > 0.0 {
        targets.offset.resize(reached.x.strains.len(), Strain::zeros());
        for (offset, strain) in targets.offset.iter_mut().zip(&reached.x.strains) {
            *offset += drag * strain;
        }
    }
    Targets { drag, ..targets }
}

/// Why a step is not made, if it is not.
fn refused(system: &System, from: &Iterate, ended: &Ended, targets: &Targets) -> Option<Failed> {
    if let Some(failure) = &ended.failure {
        return Some(failure.clone());
    }
    let stretch = |(a, b): (&Strain, &Strain)| (b[0] - a[0]).abs();
    let stretched = from.strains.iter().zip(&ended.x.strains).map(stretch).fold(0.0, f64::max);
    let far = largest_turn(from, &ended.x) > LARGEST_STEP_TURN || stretched > LARGEST_STRETCH;
    let minimum =
        || system.sections.index == 0 && system.index_here(&ended.x, targets.load).is_none_or(|i| i == 0);
    (far || !minimum()).then_some(Failed::Jumped)
}

/// The error of the mesh, but for elements within which strains jump: none resolves them.
fn resolvable(system: &System, x: &Iterate, targets: &Targets) -> Result<Estimate, InvalidInput> {
    let mesh = &system.mesh;
    let mut defects = defects(system, x, targets, 0.0)?;
    for s in Phases::of(mesh, x)?.kinks {
        let next = mesh.nodes.partition_point(|&node| node < s);
        if mesh.nodes[next] != s {
            defects.leave_out(next - 1);
        }
    }
    let correction = system.correction_for(defects.gaps.clone());
    Ok(defects.estimate(&correction, &mesh.problem))
}

/// The mesh with elements halved that have unstable sections though the ribbon as a whole is stable, and the iterate there: a stage that
/// stands for too long a part is kept from what a section does.
fn divided(system: &System, x: &Iterate, targets: &Targets) -> Result<Option<(Mesh, Iterate)>, InvalidInput> {
    let mesh = &system.mesh;
    if system.sections.index == 0 || system.index_here(x, targets.load).is_some_and(|index| index > 0) {
        return Ok(None);
    }
    let degree = mesh.gauss.degree;
    let mut nodes = mesh.nodes.clone();
    for i in 0..mesh.elements() {
        let mut made = Vec::new();
        let responses = mesh.responses(i, &mut made)?;
        let strains = &x.strains[i * degree..(i + 1) * degree];
        if responses.iter().cycle().zip(strains).any(|(response, strain)| response.index(strain) > 0) {
            nodes.push(0.5 * (mesh.nodes[i] + mesh.nodes[i + 1]));
        }
    }
    if nodes.len() == mesh.nodes.len() || nodes.len() > MOST_ELEMENTS + 1 {
        return Ok(None);
    }
    nodes.sort_by(f64::total_cmp);
    let finer = Mesh::new(&mesh.problem, nodes, degree)?;
    let x = transferred(x, mesh, &finer)?;
    Ok(Some((finer, x)))
}

impl Pace {
    /// After a step of this length of ends and loads that failed, zero if they are at their goal; whether there is a slower pace.
    fn slower(&mut self, step: f64) -> bool {
        self.rest = REST;
        self.drag = (MORE * self.drag).max(10.0 * LEAST_DRAG);
        if step == 0.0 {
            return self.drag <= LARGEST_DRAG;
        }
        if self.drag > STIFF_DRAG {
            self.step = 0.25 * step;
        }
        self.drag = self.drag.min(LARGEST_DRAG);
        self.step >= LEAST_STEP
    }

    /// After a step that took so many iterations.
    fn faster(&mut self, iterations: usize) {
        self.rest = self.rest.saturating_sub(1);
        if iterations > QUICK {
            return;
        }
        self.step = (2.0 * self.step).min(self.most);
        if self.rest == 0 {
            self.drag = if self.drag < LEAST_DRAG { 0.0 } else { LESS * self.drag };
        }
    }

    /// The mesh and iterate with elements that end at kinks, if they do not yet.
    fn kinked(
        &mut self,
        system: &System,
        reached: &Reached,
    ) -> Result<Option<(Mesh, Iterate)>, InvalidInput> {
        let phases = Phases::of(&system.mesh, &reached.x)?;
        let kinks = if self.moves > 0 { phases.moved()? } else { phases.kinks.clone() };
        if kinks.iter().all(|s| system.mesh.problem.kinks.contains(s)) {
            return Ok(None);
        }
        self.moves = self.moves.saturating_sub(1);
        self.drag = SMALL_DRAG;
        phases.split(&reached.x, &kinks).map(Some)
    }
}

/// Largest change of a strain over the largest strain.
fn changed(from: &Iterate, to: &Iterate) -> f64 {
    let largest = |x: f64, e: Strain| x.max(e.amax());
    let change = from.strains.iter().zip(&to.strains).map(|(a, b)| b - a).fold(0.0, largest);
    change / to.strains.iter().copied().fold(f64::MIN_POSITIVE, largest)
}

/// Moves the strains a little in the softest direction of each section, by a wave along the ribbon that favours no symmetry; of a
/// rod, whose sections have none, in bending and twist.
fn kick(mesh: &Mesh, x: &mut Iterate) -> Result<(), InvalidInput> {
    let length = mesh.problem.length;
    let size = KICK * x.strains.iter().map(|e| e.amax()).fold(1.0 / length, f64::max);
    let mut before: Option<Strain> = None;
    for (k, s) in (0..mesh.elements()).flat_map(|i| mesh.places(i)).enumerate() {
        let softest = mesh.problem.law.at(s)?.neutral(&x.strains[k]);
        let mut softest = softest.map_or(Strain::new(0.0, 0.0, 1.0, 0.5), |e| e / e.amax());
        if before.is_some_and(|before| before.dot(&softest) < 0.0) {
            softest = -softest;
        }
        before = Some(softest);
        x.strains[k] += softest * (size * (1.0 + 0.5 * (3.0 * s / length).cos()));
    }
    Ok(())
}
