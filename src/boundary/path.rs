//! From a shape that is known to the one that is asked for, by load steps.
//!
//! Ends move from where the known shape has them to where they are to be, dead loads grow from zero, and the
//! residual of the law at the known shape fades, all in proportion to `t` from 0 to 1. The known shape carries a
//! slight imperfection, which fades too: past a buckling load the ribbon goes the way that a real one does.

use std::f64::consts::PI;

use nalgebra::Quaternion;

use super::ends::{At, End, Hold};
use super::iterate::{Iterate, at_rest};
use super::law::Law;
use super::mesh::Mesh;
use super::newton::{Control, Failed, newton};
use super::problem::{Problem, turned};
use super::step::Stepper;
use super::system::{System, Targets};
use crate::InvalidInput;
use crate::equilibrium::natural_branches;
use crate::section::Strain;

/// A shape to start from, at places from 0 to `L`.
#[derive(Clone, Debug)]
pub struct Guess {
    /// Places, ascending.
    pub s: Vec<f64>,
    /// Strains there.
    pub strains: Vec<Strain>,
    /// States there.
    pub states: Vec<At>,
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
/// The least step of `t`.
const LEAST_STEP: f64 = 1.0 / 512.0;
/// Solves on a way that are too many.
const MOST_STEPS: usize = 400;

/// A known shape as a function of `S`: its strains, whether its start or its end is where it belongs.
pub enum Known<'a> {
    /// The natural shape, straight or closed, with an imperfection of this size.
    Natural(f64),
    /// One that is given.
    Given(&'a Guess),
}

/// The strains of the known shape at any `S`, without imperfection.
///
/// # Errors
/// Where a section is refused.
pub fn known_strains(problem: &Problem) -> Result<Box<dyn Fn(f64) -> Strain + '_>, InvalidInput> {
    let length = problem.length;
    let [start, end] = [0, 1].map(|i| problem.ends[i].hold);
    if end == Hold::Closed {
        let (k, link) = (2.0 * PI / length, problem.ends[1].turns);
        return Ok(Box::new(move |s| {
            let psi = 2.0 * PI * link * s / length;
            Strain::new(0.0, k * psi.sin(), k * psi.cos(), 2.0 * PI * link / length)
        }));
    }
    if start != Hold::Free && end != Hold::Free {
        return Ok(Box::new(|_| Strain::zeros()));
    }
    if let (true, Law::Relaxed(law)) = (problem.law.varies(), &problem.law) {
        return Ok(match natural_branches(law, length) {
            Ok(branches) if !branches.is_empty() => {
                let branch = branches.into_iter().next();
                Box::new(move |s| branch.as_ref().map_or_else(Strain::zeros, |b| b.strain(s)))
            }
            _ => Box::new(|_| Strain::zeros()),
        });
    }
    if problem.law.varies() {
        return Ok(Box::new(|s| problem.law.at(s).map_or_else(|_| Strain::zeros(), |law| law.natural())));
    }
    let natural = problem.law.at(0.0)?.natural();
    Ok(Box::new(move |_| natural))
}

/// A slight bend and twist that favours no symmetry, positive on the whole.
fn imperfection(x: f64, length: f64) -> Strain {
    let bend = IMPERFECTION * (0.3 + 0.2 * x - (2.0 * PI * x).cos());
    let twist = 0.25 * IMPERFECTION * (1.0 - 0.3 * x + (PI * x).cos());
    Strain::new(0.0, 0.0, bend / length, twist / length)
}

impl Path {
    /// The way from the known shape on a mesh.
    ///
    /// # Errors
    /// Where a section is refused.
    pub fn new(mesh: &Mesh<'_>, known: &Known<'_>) -> Result<Self, InvalidInput> {
        let mut path = match known {
            Known::Natural(size) => Self::from_natural(mesh, *size)?,
            Known::Given(guess) => Self::from_guess(mesh, guess),
        };
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

    fn from_natural(mesh: &Mesh<'_>, size: f64) -> Result<Self, InvalidInput> {
        let problem = mesh.problem;
        let strain = known_strains(problem)?;
        let flawed = |s: f64| strain(s) + imperfection(s / problem.length, problem.length) * size;
        let start = &problem.ends[0];
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
            let (end, last) = (&problem.ends[1], nodes[mesh.elements()]);
            let turn = end.rotation * last.rotation.conjugate();
            for node in &mut nodes {
                let away = Quaternion::from_imag(node.position - last.position);
                let position = end.position + (turn * away * turn.conjugate()).imag();
                *node = at_rest(position, turn * node.rotation);
            }
        }
        let places = (0..mesh.elements()).flat_map(|i| mesh.places(i));
        let strains = places.map(flawed).collect();
        Ok(Self {
            x: Iterate { nodes, strains, slack: 0.0 },
            base: problem.ends,
            load: 0.0,
            offset: Vec::new(),
            winds: true,
        })
    }

    fn from_guess(mesh: &Mesh<'_>, guess: &Guess) -> Self {
        let between = |s: f64| {
            let i = guess.s.partition_point(|&place| place <= s).clamp(1, guess.s.len() - 1);
            let x = (s - guess.s[i - 1]) / (guess.s[i] - guess.s[i - 1]);
            (i, x)
        };
        let state = |&s: &f64| {
            let (i, x) = between(s);
            let (a, b) = (&guess.states[i - 1], &guess.states[i]);
            At {
                position: a.position.lerp(&b.position, x),
                rotation: slerp(&a.rotation, &b.rotation, x),
                force: a.force.lerp(&b.force, x),
                about_origin: a.about_origin.lerp(&b.about_origin, x),
            }
        };
        let strain = |s: f64| {
            let (i, x) = between(s);
            guess.strains[i - 1].lerp(&guess.strains[i], x)
        };
        let nodes = mesh.nodes.iter().map(state).collect();
        let strains = (0..mesh.elements()).flat_map(|i| mesh.places(i)).map(strain).collect();
        let x = Iterate { nodes, strains, slack: 0.0 };
        Self { x, base: mesh.problem.ends, load: 1.0, offset: Vec::new(), winds: false }
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

    /// Goes the way, the first step of length `first`.
    pub fn follow(&mut self, system: &mut System<'_, '_>, first: f64) -> Reached {
        let problem = system.mesh.problem;
        let mut reached = Reached {
            x: self.x.clone(),
            fraction: 0.0,
            steps: 0,
            iterations: 0,
            norms: Vec::new(),
            failure: None,
        };
        self.offset.clear();
        system.settle(&mut reached.x, self.load);
        let mut targets = self.targets(problem, 0.0);
        match system.evaluate(&reached.x, &targets) {
            Ok(()) => self.offset.extend_from_slice(system.law_residual()),
            Err(failure) => {
                reached.failure = Some(failure.into());
                return reached;
            }
        }
        let control = Control { tolerance: 1e-6, iterations: 25, least_step: 1e-2 };
        let mut step: f64 = first;
        while reached.fraction < 1.0 {
            let t = if reached.fraction + 1.001 * step >= 1.0 { 1.0 } else { reached.fraction + step };
            targets = self.targets(problem, t);
            let ended = newton(system, reached.x.clone(), &targets, &control);
            reached.steps += 1;
            reached.iterations += ended.norms.len();
            match ended.failure {
                None => {
                    step *= if ended.norms.len() <= 6 { 2.0 } else { 1.0 };
                    reached.x = ended.x;
                    reached.fraction = t;
                    reached.norms = ended.norms;
                }
                Some(failure) => {
                    step = 0.25 * (t - reached.fraction);
                    if step < LEAST_STEP || reached.steps >= MOST_STEPS {
                        reached.norms = ended.norms;
                        reached.failure = Some(failure);
                        return reached;
                    }
                }
            }
        }
        reached
    }
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
