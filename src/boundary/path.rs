//! From a shape that is known to the one that is asked for, by load steps.
//!
//! Ends move from where the known shape has them to where they are to be, dead loads grow from zero, and the
//! residual of the law at the known shape fades, all in proportion to `t` from 0 to 1. The known shape carries a
//! slight imperfection, which fades too: past a buckling load the ribbon goes the way that a real one does.

use std::f64::consts::PI;
use std::sync::Arc;

use nalgebra::{Quaternion, Vector3};

use super::adapt::{Estimate, estimate, transferred_strains};
use super::arclength::Point;
use super::ends::{At, End, Hold};
use super::iterate::{Iterate, Layout, settle};
use super::known::{Known, slerp};
use super::mesh::Mesh;
use super::newton::{Control, Failed, newton};
use super::problem::{Problem, turned};
use super::spent::work;
use super::system::{Failure, System, Targets};
use crate::InvalidInput;
use crate::section::Strain;

type Vector = Vector3<f64>;

/// The known shape at `t = 0` and the way from it.
pub struct Path {
    /// The known shape.
    pub x: Iterate,
    base: [End; 2],
    load: f64,
    offset: Vec<Strain>,
    /// Whether twist is wound up on the way; a guess has it already.
    winds: bool,
}

/// What was reached.
pub struct Reached {
    /// The iterate at `fraction`.
    pub x: Iterate,
    /// How much of the way.
    pub fraction: f64,
    /// Solves on the way.
    pub steps: usize,
    /// Newton iterations.
    pub iterations: usize,
    /// Norms of the corrections of the last solve.
    pub norms: Vec<f64>,
    /// Why no further, if not to the goal.
    pub failure: Option<Failed>,
    /// The state before the last step: its fraction, nodes and unknowns.
    pub before: Option<(f64, Vec<f64>, Iterate)>,
}

impl Problem {
    /// An end as it is to be, its twist included in its orientation.
    #[must_use]
    pub fn goal(&self, end: &End) -> End {
        let rotation = match end.hold {
            Hold::Closed => self.goal(&self.ends[0]).rotation * turned(end.turns, 2),
            _ => turned(end.turns, 2) * end.rotation,
        };
        let position = if end.hold == Hold::Closed { self.ends[0].position } else { end.position };
        End { rotation, position, ..*end }
    }

    /// Turns of the end against the start if they are a twist about a straight ribbon's axis.
    #[must_use]
    pub fn twist(&self) -> Option<f64> {
        let aligned = |end: &End| {
            let tangent = super::ends::directors(&end.rotation).column(2).into_owned();
            end.hold.holds_rotation() && (tangent - Vector::z()).norm() < 1e-9
        };
        self.ends.iter().all(aligned).then(|| self.ends[1].turns - self.ends[0].turns)
    }

    /// Turns that are wound up on the way from a known shape.
    fn wound(&self, known: &Known<'_>) -> f64 {
        let built_in = matches!(known, Known::Twisted(_)) && self.twist().is_some();
        if built_in || matches!(known, Known::Given(_)) || self.ends[1].hold == Hold::Closed {
            return 0.0;
        }
        self.ends
            .iter()
            .filter(|end| end.hold.holds_rotation())
            .map(|end| end.turns.abs())
            .fold(0.0, f64::max)
    }

    /// The largest step of `t` from a known shape: none winds up more than a fifth of a turn, which would be
    /// mistaken for less.
    #[must_use]
    pub fn largest_step(&self, known: &Known<'_>) -> f64 {
        (0.2 / self.wound(known)).min(1.0)
    }

    /// Elements to begin with: at least `least`, and none that turns far at these curvatures.
    #[must_use]
    pub fn first_nodes(&self, least: f64, turn: f64) -> Vec<f64> {
        let wound = self.ends.iter().map(|end| end.turns.abs() * 2.0 * PI).fold(0.0, f64::max);
        let density = least.max((turn + wound) / LARGEST_TURN) / self.length;
        let mut nodes = vec![0.0];
        for pair in self.breaks().windows(2) {
            let parts = ((pair[1] - pair[0]) * density).ceil().clamp(1.0, 1e6);
            let step = (pair[1] - pair[0]) / parts;
            nodes.extend((1..parts as usize).map(|i| pair[0] + step * i as f64));
            nodes.push(pair[1]);
        }
        nodes
    }
}

/// Radians that an element turns at most on a first mesh.
const LARGEST_TURN: f64 = 1.5;
/// A step of `t` below which a fold is supposed.
const FOLD_STEP: f64 = 1e-3;
/// The longest step along the way, in the norm of the unknowns.
const LONGEST_STEP: f64 = 2.0;
/// Error of the mesh that is too large on a careful way.
pub const LARGEST_ERROR: f64 = 1e-2;
/// Radians that a section turns at most in one step: more may be another solution.
pub const LARGEST_STEP_TURN: f64 = 2.0;
/// The least step of `t`, of `t` or of the first place that counts: loads a million times those of buckling bend a ribbon within that.
const LEAST_STEP: f64 = 2e-5;
const FIRST_FRACTION: f64 = 5e-5;
/// Solves on a way that are too many.
const MOST_STEPS: usize = 300;

impl Path {
    /// The way from the known shape on a mesh.
    ///
    /// # Errors
    /// Where a section is refused.
    pub fn new(mesh: &Mesh, known: &Known<'_>) -> Result<Self, InvalidInput> {
        // What is loaded from the first is a guess; it has its twist, too.
        let given = matches!(known, Known::Given(_));
        let winds = mesh.problem.wound(known) > 0.0;
        let x = known.shape(mesh, winds)?;
        let load = if given { 1.0 } else { 0.0 };
        let mut path = Self { x, base: mesh.problem.ends, load, offset: Vec::new(), winds };
        settle(mesh, Layout::of(&mesh.problem), &mut path.x, path.load);
        let count = mesh.elements();
        for (i, end) in path.base.iter_mut().enumerate() {
            let at = &path.x.nodes[i * count];
            let outward = if i == 0 { -1.0 } else { 1.0 };
            end.position = at.position;
            end.rotation = at.rotation;
            (end.force, end.moment) = (outward * at.force, outward * at.moment());
        }
        Ok(path)
    }

    /// The way that is at its goal already, with a shape near one that is asked for.
    #[must_use]
    pub fn at_goal(mesh: &Mesh, x: Iterate) -> Self {
        Self { x, base: mesh.problem.ends, load: 1.0, offset: Vec::new(), winds: false }
    }

    /// Takes note of what the known shape, that was reached as yet, misses the law by, which fades on the way.
    ///
    /// # Errors
    /// A residual that is not finite, a section that is refused.
    pub fn begin(&mut self, system: &mut System, reached: &Reached) -> Result<(), Failure> {
        if self.offset.is_empty() && reached.fraction < 1.0 {
            system.evaluate(&reached.x, &self.targets(&system.mesh.problem, 0.0))?;
            self.offset.extend_from_slice(system.law_residual());
        }
        Ok(())
    }

    /// What is asked for at `t`.
    #[must_use]
    pub fn targets(&self, problem: &Problem, t: f64) -> Targets {
        let toward = |i: usize| {
            let (base, goal) = (&self.base[i], problem.goal(&problem.ends[i]));
            if t >= 1.0 {
                return goal;
            }
            let end = &problem.ends[i];
            let rotation = match end.hold {
                Hold::Closed => goal.rotation,
                _ if self.winds => turned(end.turns * t, 2) * slerp(&base.rotation, &end.rotation, t),
                _ => slerp(&base.rotation, &goal.rotation, t),
            };
            End {
                rotation,
                position: base.position.lerp(&goal.position, t),
                force: base.force.lerp(&goal.force, t),
                moment: base.moment.lerp(&goal.moment, t),
                ..goal
            }
        };
        let offset = if t < 1.0 { self.offset.iter().map(|e| e * (1.0 - t)).collect() } else { Vec::new() };
        Targets { ends: [toward(0), toward(1)], load: self.load + t * (1.0 - self.load), offset, drag: 0.0 }
    }

    /// Goes on from what was reached, as far as the mesh will do.
    pub fn follow(
        &mut self,
        system: &mut System,
        reached: &mut Reached,
        stride: &mut Stride,
        bounds: &Bounds,
    ) -> Result<Stop, InvalidInput> {
        let problem = Arc::clone(&system.mesh.problem);
        if let Err(failure) = self.begin(system, reached) {
            reached.failure = Some(failure.into());
            return Ok(Stop::Failed);
        }
        let control = Control { tolerance: 1e-6, iterations: 25, least_step: 1e-2 };
        while reached.fraction < 1.0 || stride.again {
            if let Some(failure) = bounds.passed(system, reached.fraction) {
                reached.failure = Some(failure);
                return Ok(Stop::Failed);
            }
            let ahead = if stride.again { 0.0 } else { stride.step };
            let t = if reached.fraction + 1.001 * ahead >= 1.0 { 1.0 } else { reached.fraction + ahead };
            let targets = self.targets(&problem, t);
            let ended = newton(system, reached.x.clone(), &targets, &control);
            reached.steps += 1;
            reached.iterations += ended.norms.len();
            let jumped = largest_turn(&reached.x, &ended.x) > LARGEST_STEP_TURN;
            let failure = ended.failure.or(jumped.then_some(Failed::Jumped));
            let Some(failure) = failure else {
                if !stride.again && ended.norms.len() <= 6 {
                    stride.step = (2.0 * stride.step).min(stride.most);
                }
                stride.again = false;
                let last = std::mem::replace(&mut reached.x, ended.x);
                if t > reached.fraction {
                    reached.before = Some((reached.fraction, system.mesh.nodes.clone(), last));
                }
                reached.fraction = t;
                reached.norms = ended.norms;
                if stride.careful {
                    let estimate = estimate(system, &reached.x, &targets, 0.0)?;
                    if estimate.error > LARGEST_ERROR {
                        stride.again = true;
                        return Ok(Stop::Coarse(estimate));
                    }
                }
                continue;
            };
            stride.step = 0.25 * (t - reached.fraction);
            if stride.step < FOLD_STEP && stride.careful && reached.fraction > 0.0 {
                return Ok(self.past_folds(system, reached, bounds, failure));
            }
            let least = LEAST_STEP * reached.fraction.max(FIRST_FRACTION);
            if stride.step < least || reached.steps >= MOST_STEPS {
                reached.norms = ended.norms;
                reached.failure = Some(failure);
                return Ok(Stop::Failed);
            }
        }
        Ok(Stop::There)
    }

    /// Goes on along the arclength of the way, forth and back in `t`, until `t` is 1.
    fn past_folds(
        &self,
        system: &mut System,
        reached: &mut Reached,
        bounds: &Bounds,
        failure: Failed,
    ) -> Stop {
        let control = Control { tolerance: 1e-6, iterations: 12, least_step: 1e-1 };
        let goal = self.targets(&system.mesh.problem, 1.0);
        reached.failure = Some(failure);
        let (x, t) = (reached.x.clone(), reached.fraction);
        let Ok(mut point) = Point::new(self, system, x, t, None) else { return Stop::Failed };
        let mut length = 0.05;
        for _ in 0..MOST_STEPS {
            if let Some(failure) = bounds.passed(system, reached.fraction) {
                reached.failure = Some(failure);
                break;
            }
            // What is ahead within a step may be reached at once.
            if point.ahead() > 0.0 && point.t + length * point.ahead() >= 1.0 {
                let start = point.extrapolated(1.0, system);
                let ended = newton(system, start, &goal, &control);
                reached.iterations += ended.norms.len();
                if ended.failure.is_none() && largest_turn(&point.x, &ended.x) < LARGEST_STEP_TURN {
                    let last = std::mem::replace(&mut reached.x, ended.x);
                    reached.before = Some((reached.fraction, system.mesh.nodes.clone(), last));
                    (reached.fraction, reached.norms, reached.failure) = (1.0, ended.norms, None);
                    return Stop::There;
                }
                length *= 0.5;
            }
            reached.steps += 1;
            match point.next(self, system, length) {
                Some((next, iterations)) => {
                    reached.iterations += iterations;
                    if iterations <= 4 {
                        length = (1.5 * length).min(LONGEST_STEP);
                    }
                    point = next;
                    if point.t > reached.fraction {
                        (reached.x, reached.fraction) = (point.x.clone(), point.t.min(1.0));
                    }
                }
                None => length *= 0.25,
            }
            if length < LEAST_STEP || !(-1.0..=2.0).contains(&point.t) {
                break;
            }
        }
        Stop::Failed
    }

    /// The way on another mesh.
    pub fn transfer(&mut self, from: &Mesh, to: &Mesh) {
        if !self.offset.is_empty() {
            self.offset = transferred_strains(&self.offset, from, to);
        }
    }
}

/// How the way is gone.
#[derive(Clone, Copy, Debug)]
pub struct Stride {
    /// The next step of `t`.
    pub step: f64,
    /// The largest.
    pub most: f64,
    /// Whether the error of the mesh is looked at after each step.
    pub careful: bool,
    /// Whether the place that was reached is solved for once more, on a new mesh.
    pub again: bool,
}

/// What ends a way before it is gone.
#[derive(Clone, Copy, Debug)]
pub struct Bounds {
    /// Factorised elements that are too many.
    pub most_work: usize,
    /// Asked before each step whether to stop.
    pub interrupted: Option<fn() -> bool>,
}

impl Bounds {
    /// Why no other step is made from this fraction of the way, if none is.
    fn passed(&self, system: &System, fraction: f64) -> Option<Failed> {
        if self.interrupted.is_some_and(|asks| asks()) {
            Some(Failed::Interrupted)
        } else if work(system) >= self.most_work {
            Some(Failed::Far(fraction))
        } else {
            None
        }
    }
}

/// Why the way is not gone on.
#[derive(Clone, Debug)]
pub enum Stop {
    /// The goal is reached.
    There,
    /// The mesh is too coarse.
    Coarse(Estimate),
    /// It could not be; [`Reached::failure`] says why.
    Failed,
}

impl Reached {
    /// The known shape.
    #[must_use]
    pub fn start(path: &Path) -> Self {
        let (x, norms) = (path.x.clone(), Vec::new());
        Self { x, fraction: 0.0, steps: 0, iterations: 0, norms, failure: None, before: None }
    }
}

/// Largest angle by which a node turned, followed from the start: a whole turn is not none.
#[must_use]
pub fn largest_turn(from: &Iterate, to: &Iterate) -> f64 {
    let mut before = Quaternion::new(1.0, 0.0, 0.0, 0.0);
    let angle = |(a, b): (&At, &At)| {
        let w = b.rotation * a.rotation.conjugate();
        let w = if w.dot(&before) < 0.0 { -w } else { w };
        before = w;
        2.0 * w.imag().norm().atan2(w.w)
    };
    from.nodes.iter().zip(&to.nodes).map(angle).fold(0.0, f64::max)
}
