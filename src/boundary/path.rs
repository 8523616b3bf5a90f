//! From a shape that is known to the one that is asked for, by load steps.
//!
//! Ends move from where the known shape has them to where they are to be, dead loads grow from zero, and the
//! residual of the law at the known shape fades, all in proportion to `t` from 0 to 1. The known shape carries a
//! slight imperfection, which fades too: past a buckling load the ribbon goes the way that a real one does.

use std::f64::consts::PI;

use nalgebra::{DMatrix, DVector, Quaternion, Vector3};

use super::adapt::{Estimate, estimate, transferred_strains};
use super::arclength::Point;
use super::ends::{At, End, Hold};
use super::iterate::{Iterate, Layout, at_rest, settle};
use super::law::Law;
use super::mesh::Mesh;
use super::newton::{Control, Failed, newton};
use super::problem::{Problem, turned};
use super::step::Stepper;
use super::system::{System, Targets};
use crate::InvalidInput;
use crate::equilibrium::natural_branches;
use crate::section::Strain;

type Vector = Vector3<f64>;

/// A shape to start from, at places from 0 to `L`.
#[derive(Clone, Debug)]
pub struct Guess {
    /// Places, ascending.
    pub s: Vec<f64>,
    /// Strains there.
    pub strains: Vec<Strain>,
    /// States there.
    pub states: Vec<At>,
    /// Whether their forces and moments are known; else they are those that fit the strains best.
    pub has_wrench: bool,
}

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
/// Rotation over the whole ribbon that an imperfection of size 1 is of.
const IMPERFECTION: f64 = 0.2;
/// A step of `t` below which a fold is supposed.
const FOLD_STEP: f64 = 1e-3;
/// The longest step along the way, in the norm of the unknowns.
const LONGEST_STEP: f64 = 2.0;
/// Error of the mesh that is too large on a careful way.
const LARGEST_ERROR: f64 = 1e-2;
/// Radians that a section turns at most in one step: more may be another solution.
pub const LARGEST_STEP_TURN: f64 = 2.0;
/// The least step of `t`.
const LEAST_STEP: f64 = 1e-5;
/// Solves on a way that are too many.
const MOST_STEPS: usize = 100;

/// A known shape.
#[derive(Clone, Copy, Debug)]
pub enum Known<'a> {
    /// The natural shape, with an imperfection of this size.
    Natural(f64),
    /// Straight, or a closed circle, without the stress that this takes, with an imperfection of this size.
    Straight(f64),
    /// The same with the twist of its ends.
    Twisted(f64),
    /// One that is given.
    Given(&'a Guess),
}

type Strains<'p> = Box<dyn Fn(f64) -> Strain + 'p>;

/// The strains of a straight ribbon twisted by `turns`, or of a closed circle, at any `S`.
fn straight_strains(problem: &Problem, turns: f64) -> Strains<'_> {
    let length = problem.length;
    if problem.ends[1].hold == Hold::Closed {
        let (k, link) = (2.0 * PI / length, problem.ends[1].turns);
        return Box::new(move |s| {
            let psi = 2.0 * PI * link * s / length;
            Strain::new(0.0, k * psi.sin(), k * psi.cos(), 2.0 * PI * link / length)
        });
    }
    let twist = 2.0 * PI * turns / length;
    Box::new(move |s| {
        let straight = problem.law.at(s).map_or_else(|_| Strain::zeros(), |law| law.straight());
        straight + Strain::new(0.0, 0.0, 0.0, twist)
    })
}

/// The strains of the natural shape at any `S`.
fn natural_strains(problem: &Problem) -> Result<Strains<'_>, InvalidInput> {
    if !problem.law.varies() {
        let natural = problem.law.at(0.0)?.natural();
        return Ok(Box::new(move |_| natural));
    }
    if let Law::Relaxed(law) = &problem.law
        && let Some(branch) = natural_branches(law, problem.length)?.into_iter().next()
    {
        return Ok(Box::new(move |s| branch.strain(s)));
    }
    Ok(Box::new(|s| problem.law.at(s).map_or_else(|_| Strain::zeros(), |law| law.natural())))
}

impl Known<'_> {
    /// The strains of the known shape at any `S`, without imperfection.
    ///
    /// # Errors
    /// Where a section is refused.
    pub fn strains<'s>(&'s self, problem: &'s Problem) -> Result<Strains<'s>, InvalidInput> {
        match self {
            Self::Straight(_) => Ok(straight_strains(problem, 0.0)),
            Self::Twisted(_) => Ok(straight_strains(problem, problem.twist().unwrap_or(0.0))),
            // Of a ribbon whose shape cannot be followed along it, the straight one will have to do.
            Self::Natural(_) => {
                Ok(natural_strains(problem).unwrap_or_else(|_| straight_strains(problem, 0.0)))
            }
            Self::Given(guess) => Ok(Box::new(|s| guess.strain(s))),
        }
    }
}

impl Guess {
    /// The place before which, and how far before which, `s` is.
    fn between(&self, s: f64) -> (usize, f64) {
        let i = self.s.partition_point(|&place| place <= s).clamp(1, self.s.len() - 1);
        (i, (s - self.s[i - 1]) / (self.s[i] - self.s[i - 1]))
    }

    fn strain(&self, s: f64) -> Strain {
        let (i, x) = self.between(s);
        self.strains[i - 1].lerp(&self.strains[i], x)
    }

    fn state(&self, s: f64) -> At {
        let (i, x) = self.between(s);
        let (a, b) = (&self.states[i - 1], &self.states[i]);
        At {
            position: a.position.lerp(&b.position, x),
            rotation: slerp(&a.rotation, &b.rotation, x),
            force: a.force.lerp(&b.force, x),
            about_origin: a.about_origin.lerp(&b.about_origin, x),
        }
    }
}

/// A slight bend and twist that favours no symmetry, positive on the whole: a rotation of [`IMPERFECTION`] over the
/// ribbon, but no curvature that is large against those at which a thin section changes its shape.
fn imperfection(problem: &Problem, natural: &Strain) -> Result<impl Fn(f64) -> Strain + use<>, InvalidInput> {
    let length = problem.length;
    let compliance = problem.law.at(0.0)?.compliance;
    // EI2 = eta^2/12 where EA = 1.
    let eta = if compliance[0] > 0.0 { (12.0 * compliance[0] / compliance[2]).sqrt() } else { f64::INFINITY };
    let curved = natural.rows(2, 2).amax() > 1e-3 * eta;
    let largest = eta * if curved { SLIGHT_IF_CURVED } else { SLIGHT };
    let size = (IMPERFECTION / length).min(largest);
    Ok(move |s: f64| {
        let x = s / length;
        let bend = 0.3 + 0.2 * x - (2.0 * PI * x).cos();
        let twist = 0.25 * (1.0 - 0.3 * x + (PI * x).cos());
        Strain::new(0.0, 0.0, bend, twist) * size
    })
}

/// Curvature of an imperfection at most, over the thickness ratio: of a flat shape, and of one that has no symmetry
/// left to break.
const SLIGHT: f64 = 0.3;
const SLIGHT_IF_CURVED: f64 = 0.02;

impl Path {
    /// The way from the known shape on a mesh.
    ///
    /// # Errors
    /// Where a section is refused.
    pub fn new(mesh: &Mesh<'_>, known: &Known<'_>) -> Result<Self, InvalidInput> {
        let mut path = match known {
            Known::Natural(size) | Known::Straight(size) | Known::Twisted(size) => {
                let winds = mesh.problem.wound(known) > 0.0;
                Self::at_rest(mesh, &known.strains(mesh.problem)?, *size, winds)?
            }
            Known::Given(guess) => Self::from_guess(mesh, guess)?,
        };
        settle(mesh, Layout::of(mesh.problem), &mut path.x, path.load);
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

    fn at_rest(mesh: &Mesh<'_>, strain: &Strains<'_>, size: f64, winds: bool) -> Result<Self, InvalidInput> {
        let problem = mesh.problem;
        let flaw = imperfection(problem, &strain(0.5 * problem.length))?;
        let flawed = |s: f64| strain(s) + flaw(s) * size;
        let start = if winds { problem.ends[0] } else { problem.goal(&problem.ends[0]) };
        let mut nodes = vec![at_rest(start.position, start.rotation)];
        let mut stepper = Stepper::new(problem, mesh.gauss)?;
        for i in 0..mesh.elements() {
            let (s, h) = (mesh.nodes[i], mesh.length(i));
            let (at, _) = stepper.step(&nodes[i], s, h, |c| flawed(s + c * h), false)?;
            let unit = at.rotation * (1.0 / at.rotation.norm());
            nodes.push(at_rest(at.position, unit));
        }
        if start.hold == Hold::Free {
            // The end is where it belongs instead.
            let end = if winds { problem.ends[1] } else { problem.goal(&problem.ends[1]) };
            let last = nodes[mesh.elements()];
            let turn = end.rotation * last.rotation.conjugate();
            for node in &mut nodes {
                let away = Quaternion::from_imag(node.position - last.position);
                let position = end.position + (turn * away * turn.conjugate()).imag();
                *node = at_rest(position, turn * node.rotation);
            }
        }
        hang(mesh, &mut nodes);
        let places = (0..mesh.elements()).flat_map(|i| mesh.places(i));
        let strains = places.map(flawed).collect();
        Ok(Self {
            x: Iterate { nodes, strains, slack: Default::default() },
            base: problem.ends,
            load: 0.0,
            offset: Vec::new(),
            winds,
        })
    }

    fn from_guess(mesh: &Mesh<'_>, guess: &Guess) -> Result<Self, InvalidInput> {
        let nodes = mesh.nodes.iter().map(|&s| guess.state(s)).collect();
        let strains = (0..mesh.elements()).flat_map(|i| mesh.places(i)).map(|s| guess.strain(s)).collect();
        let mut x = Iterate { nodes, strains, slack: Default::default() };
        if !guess.has_wrench {
            fit_wrench(mesh, guess, &mut x)?;
        }
        let base = mesh.problem.ends;
        Ok(Self { x, base, load: 1.0, offset: Vec::new(), winds: false })
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
        Targets { ends: [toward(0), toward(1)], load: self.load + t * (1.0 - self.load), offset }
    }

    /// Goes on from what was reached, as far as the mesh will do.
    pub fn follow(
        &mut self,
        system: &mut System<'_, '_>,
        reached: &mut Reached,
        stride: &mut Stride,
    ) -> Result<Stop, InvalidInput> {
        let problem = system.mesh.problem;
        if self.offset.is_empty() {
            let targets = self.targets(problem, 0.0);
            match system.evaluate(&reached.x, &targets) {
                Ok(()) => self.offset.extend_from_slice(system.law_residual()),
                Err(failure) => {
                    reached.failure = Some(failure.into());
                    return Ok(Stop::Failed);
                }
            }
        }
        let control = Control { tolerance: 1e-6, iterations: 25, least_step: 1e-2 };
        while reached.fraction < 1.0 || stride.again {
            let ahead = if stride.again { 0.0 } else { stride.step };
            let t = if reached.fraction + 1.001 * ahead >= 1.0 { 1.0 } else { reached.fraction + ahead };
            let targets = self.targets(problem, t);
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
                    let estimate = estimate(system, &reached.x, &targets.offset)?;
                    if estimate.error > LARGEST_ERROR {
                        stride.again = true;
                        return Ok(Stop::Coarse(estimate));
                    }
                }
                continue;
            };
            stride.step = 0.25 * (t - reached.fraction);
            if stride.step < FOLD_STEP && stride.careful && reached.fraction > 0.0 {
                return Ok(self.past_folds(system, reached, failure));
            }
            if stride.step < LEAST_STEP || reached.steps >= MOST_STEPS {
                reached.norms = ended.norms;
                reached.failure = Some(failure);
                return Ok(Stop::Failed);
            }
        }
        Ok(Stop::There)
    }

    /// Goes on along the arclength of the way, forth and back in `t`, until `t` is 1.
    fn past_folds(&self, system: &mut System<'_, '_>, reached: &mut Reached, failure: Failed) -> Stop {
        let control = Control { tolerance: 1e-6, iterations: 12, least_step: 1e-1 };
        let goal = self.targets(system.mesh.problem, 1.0);
        reached.failure = Some(failure);
        let (x, t) = (reached.x.clone(), reached.fraction);
        let Ok(mut point) = Point::new(self, system, x, t, None) else { return Stop::Failed };
        let mut length = 0.05;
        for _ in 0..MOST_STEPS {
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
    pub fn transfer(&mut self, from: &Mesh<'_>, to: &Mesh<'_>) {
        let offset = std::mem::take(&mut self.offset);
        self.offset = transferred_strains(&offset, from, to);
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

/// Gives a shape the force and moment at its start that, with the loads, fit its strains best by the law.
fn fit_wrench(mesh: &Mesh<'_>, guess: &Guess, x: &mut Iterate) -> Result<(), InvalidInput> {
    let units = mesh.problem.units()?;
    let layout = Layout::of(mesh.problem);
    for node in &mut x.nodes {
        *node = at_rest(node.position, node.rotation);
    }
    settle(mesh, layout, x, 1.0);
    let count = x.nodes.len();
    let (mut rows, mut rhs) = (DMatrix::zeros(4 * count, 6), DVector::zeros(4 * count));
    for (i, (at, &s)) in x.nodes.iter().zip(&mesh.nodes).enumerate() {
        let response = mesh.problem.law.at(s)?;
        let resultants = |force: Vector, about_origin: Vector| {
            let at = At { force, about_origin, ..*at };
            let frame = super::ends::directors(&at.rotation);
            let m = frame.tr_mul(&at.moment());
            let n = Strain::new(frame.column(2).dot(&force), m.x, m.y, m.z);
            // Strains over the whole ribbon, as the solver measures them.
            let strain = response.compliance.component_mul(&n);
            strain.component_mul(&Strain::new(1.0, units.length, units.length, units.length))
        };
        let strain = guess.strain(s);
        let scale = Strain::new(1.0, units.length, units.length, units.length);
        let wanted =
            response.value_alone(&strain).component_mul(&scale) - resultants(at.force, at.about_origin);
        rhs.rows_mut(4 * i, 4).copy_from(&wanted);
        for k in 0..3 {
            let unit = Vector::ith(k, 1.0);
            rows.view_mut((4 * i, k), (4, 1)).copy_from(&resultants(units.force * unit, Vector::zeros()));
            rows.view_mut((4 * i, 3 + k), (4, 1))
                .copy_from(&resultants(Vector::zeros(), units.moment * unit));
        }
    }
    // What the strains do not tell is left zero.
    let svd = rows.svd(true, true);
    let least = 1e-8 * svd.singular_values.max();
    if let Ok(fit) = svd.solve(&rhs, least) {
        let first = &mut x.nodes[0];
        first.force += units.force * Vector::new(fit[0], fit[1], fit[2]);
        first.about_origin += units.moment * Vector::new(fit[3], fit[4], fit[5]);
        if layout != Layout::Constant {
            let (force, about) = (first.force, first.about_origin);
            for node in &mut x.nodes[1..] {
                node.force += force;
                node.about_origin += about;
            }
        }
    }
    Ok(())
}

/// Turns a shape that is free to turn about an axis to where its load is lowest.
fn hang(mesh: &Mesh<'_>, nodes: &mut [At]) {
    let problem = mesh.problem;
    let [start, end] = [0, 1].map(|i| problem.ends[i].hold);
    let (first, last) = (nodes[0].position, nodes[mesh.elements()].position);
    let along = (last - first).try_normalize(0.0);
    let spins = |hold: Hold, axis: &Vector| match hold {
        Hold::Pinned => true,
        Hold::Hinged(director) => axis[director].abs() > 1.0 - 1e-12,
        _ => false,
    };
    let (axis, through) = match (start, end, along) {
        (Hold::Hinged(director), Hold::Free, _) => (Vector::ith(director, 1.0), first),
        (Hold::Free, Hold::Hinged(director), _) => (Vector::ith(director, 1.0), last),
        (_, _, Some(along)) if spins(start, &along) && spins(end, &along) => (along, first),
        _ => return,
    };
    // The work of all forces when the shape turns by phi is a cos phi + b sin phi.
    let (mut a, mut b) = (0.0, 0.0);
    let mut take = |position: &Vector, force: &Vector| {
        let arm = position - through;
        a += force.dot(&(arm - axis * axis.dot(&arm)));
        b += force.dot(&axis.cross(&arm));
    };
    for i in 0..mesh.elements() {
        let middle = 0.5 * (nodes[i].position + nodes[i + 1].position);
        let (p, _) = problem.line_load(0.5 * (mesh.nodes[i] + mesh.nodes[i + 1]));
        take(&middle, &(p * mesh.length(i)));
        if let Some((force, _)) = mesh.points[i + 1] {
            take(&nodes[i + 1].position, &force);
        }
    }
    for (hold, end, node) in [(start, &problem.ends[0], 0), (end, &problem.ends[1], mesh.elements())] {
        if hold == Hold::Free {
            take(&nodes[node].position, &end.force);
        }
    }
    let half = 0.5 * b.atan2(a);
    let turn = Quaternion::from_parts(half.cos(), axis * half.sin());
    for node in nodes {
        let arm = Quaternion::from_imag(node.position - through);
        *node = at_rest(through + (turn * arm * turn.conjugate()).imag(), turn * node.rotation);
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

/// The rotation between two, by the shorter way.
fn slerp(a: &Quaternion<f64>, b: &Quaternion<f64>, x: f64) -> Quaternion<f64> {
    let w = b * a.conjugate();
    let w = if w.w < 0.0 { -w } else { w };
    let angle = w.imag().norm().atan2(w.w);
    let part = w.imag().try_normalize(0.0).map_or_else(
        || Quaternion::new(1.0, 0.0, 0.0, 0.0),
        |axis| Quaternion::from_parts((x * angle).cos(), axis * (x * angle).sin()),
    );
    part * a
}
