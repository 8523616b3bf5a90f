//! The solver: a way to the solution on a coarse mesh, then meshes until the error is small enough.

use std::sync::Arc;

use super::adapt::{refined, transferred};
use super::creep::{crept, crept_on};
use super::ends::{At, End, Hold, conditions};
use super::fallen::{fallen, is_unstable};
use super::iterate::{Iterate, Layout};
use super::kinks::kinked_by;
use super::known::{Guess, Known};
use super::mesh::Mesh;
use super::meshes::adapted;
use super::newton::Failed;
use super::path::{Bounds, Path, Reached, Stop, Stride};
use super::problem::Problem;
use super::report::{Report, Status};
use super::spent::Spent;
use super::system::{System, Targets};
use crate::InvalidInput;

/// What is asked of the solver.
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// Error of positions/L, angles, and strains (`eps`, `K L`).
    pub tolerance: f64,
    /// Degree of the collocation.
    pub degree: usize,
    /// Elements of the first mesh, at least.
    pub first_elements: usize,
    /// Elements that are too many.
    pub most_elements: usize,
    /// The states to carry; those that the loads need if `None`.
    pub layout: Option<Layout>,
    /// Whether the mesh adapts to the tolerance, or the first is the last.
    pub adaptive: bool,
    /// Asked now and then whether to stop.
    pub interrupted: Option<fn() -> bool>,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            tolerance: 1e-10,
            degree: DEGREE,
            first_elements: 4,
            most_elements: 200_000,
            layout: None,
            adaptive: true,
            interrupted: None,
        }
    }
}

/// A degree of nearly the least time to an error of 1e-10, from 4 to 7 all are; see `benches/boundary.rs`.
pub const DEGREE: usize = 5;

/// A discrete solution.
pub struct Solved {
    /// Ends of the elements.
    pub nodes: Vec<f64>,
    /// The unknowns.
    pub x: Iterate,
    /// How it was found.
    pub report: Report,
    /// Its stability index, if that was asked for, which may not be told.
    pub index: Option<Option<usize>>,
}

/// A try: how much finer the first mesh is, the size of the imperfection, what the way begins with, and how it is gone.
struct Attempt {
    finer: usize,
    imperfection: f64,
    from: From,
    gait: Gait,
}

/// The shape that a way begins with.
#[derive(Clone, Copy, PartialEq, Eq)]
enum From {
    /// The first, second or third choice of [`Problem::known`], or a guess in place of the first.
    Choice(usize),
    /// The natural shape of a ribbon on which nothing acts, if it fits between its ends.
    Rest,
    /// The natural shape, or a guess.
    Natural,
    /// The straight one.
    Straight,
}

/// How a way is gone.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Gait {
    /// By equilibria, on the first mesh.
    Quick,
    /// By equilibria, on meshes that follow them, and past folds.
    Careful,
    /// Creeping.
    Creeping,
}

/// What is tried in turn.
const ATTEMPTS: [Attempt; 11] = [
    Attempt { finer: 1, imperfection: 0.0, from: From::Rest, gait: Gait::Quick },
    Attempt { finer: 1, imperfection: 1.0, from: From::Choice(0), gait: Gait::Quick },
    Attempt { finer: 4, imperfection: 1.0, from: From::Choice(0), gait: Gait::Careful },
    Attempt { finer: 4, imperfection: 1.0, from: From::Natural, gait: Gait::Creeping },
    Attempt { finer: 4, imperfection: 1.0, from: From::Straight, gait: Gait::Creeping },
    Attempt { finer: 8, imperfection: -3.0, from: From::Natural, gait: Gait::Creeping },
    Attempt { finer: 8, imperfection: -3.0, from: From::Straight, gait: Gait::Creeping },
    Attempt { finer: 4, imperfection: 1.0, from: From::Choice(1), gait: Gait::Careful },
    Attempt { finer: 4, imperfection: -3.0, from: From::Choice(0), gait: Gait::Careful },
    Attempt { finer: 4, imperfection: 1.0, from: From::Choice(2), gait: Gait::Careful },
    Attempt { finer: 8, imperfection: 0.0, from: From::Choice(0), gait: Gait::Careful },
];

impl Problem {
    /// The shape to begin with.
    fn known(&self, from: From, size: f64) -> Option<Known<'static>> {
        let (natural, straight, twisted) =
            (Known::Natural(size), Known::Straight(size), Known::Twisted(size));
        let choice = match from {
            From::Rest => return (self.rests() && self.ends[1].hold != Hold::Closed).then_some(natural),
            From::Straight => return Some(straight),
            From::Natural => return (self.ends[1].hold != Hold::Closed).then_some(natural),
            From::Choice(choice) => choice,
        };
        let choices = if self.ends[1].hold == Hold::Closed {
            [Some(straight), None, None]
        } else if self.ends.iter().any(|end| end.hold == Hold::Free) {
            [Some(natural), Some(straight), None]
        } else {
            match self.twist() {
                // A turn is soon wound up, which takes the shape gently along.
                Some(turns) if turns.abs() > 1.0 => [Some(twisted), Some(straight), Some(natural)],
                Some(turns) if turns != 0.0 => [Some(straight), Some(twisted), Some(natural)],
                _ => [Some(straight), Some(natural), None],
            }
        };
        choices[choice]
    }
}

/// Solves a problem, from a guess or from its natural shape.
///
/// # Errors
/// Where a section is refused.
pub fn solve(
    problem: &Arc<Problem>,
    settings: &Settings,
    guess: Option<&Guess>,
) -> Result<Solved, InvalidInput> {
    let mut best: Option<Solved> = None;
    let mut spent = Spent::default();
    for attempt in ATTEMPTS {
        spent.allowed = (spent.work + MOST_WORK).min(MOST_WORK_OF_ALL);
        if spent.left() == 0 {
            break;
        }
        let known = match (guess, problem.known(attempt.from, attempt.imperfection)) {
            (Some(guess), _) if matches!(attempt.from, From::Choice(0) | From::Natural) => {
                Known::Given(guess)
            }
            (None, Some(known)) => known,
            _ => continue,
        };
        let kinked = match &known {
            Known::Given(guess) => kinked_by(problem, guess)?,
            _ => Arc::clone(problem),
        };
        let turn = first_turn(problem, &known)?;
        let nodes = kinked.first_nodes((attempt.finer * settings.first_elements) as f64, turn);
        if nodes.len() > settings.most_elements + 1 {
            break;
        }
        let mesh = Mesh::new(&kinked, nodes, settings.degree)?;
        if attempt.from == From::Rest && !fits(&mesh, &known)? {
            continue;
        }
        let (mesh, reached) = if attempt.gait == Gait::Creeping {
            crept(settings, mesh, &known, &mut spent)?
        } else {
            let step = if guess.is_some() || attempt.from == From::Rest { 1.0 } else { 0.5 };
            let most = problem.largest_step(&known);
            let stride =
                Stride { step: most.min(step), most, careful: attempt.gait == Gait::Careful, again: false };
            followed(settings, mesh, &known, stride, &mut spent)?
        };
        let mut solved = if reached.failure.is_none() {
            let before = reached.before;
            let mut solved = if attempt.gait == Gait::Creeping {
                crept_and_adapted(settings, mesh, reached.x, &mut spent)?
            } else {
                adapted(settings, mesh, reached.x, &mut spent)?
            };
            // What a mesh finds and a finer one does not confirm is no state: the one before is.
            if let (Status::Diverged, Some((fraction, nodes, x))) = (solved.report.status, before) {
                solved = Solved { nodes, x, report: Report { fraction, ..solved.report }, index: None };
            }
            solved
        } else {
            unfinished(mesh, reached, &spent)
        };
        // A mesh that is given is not made finer.
        if !settings.adaptive || solved.report.status == Status::Interrupted {
            return Ok(solved);
        }
        if solved.report.status.is_solved() {
            // A guess is for the state near it, whatever that is.
            if guess.is_some() || !is_unstable(problem, settings, &mut solved)? {
                return Ok(solved);
            }
            if attempt.from == From::Rest {
                continue;
            }
            return fallen(problem, settings, solved, &mut spent);
        }
        if best.as_ref().is_none_or(|b| solved.report.fraction > b.report.fraction) {
            best = Some(solved);
        }
    }
    best.ok_or_else(|| InvalidInput::new("length", problem.length, "a ribbon that fewer elements resolve"))
}

/// Whether a known shape at rest meets the end conditions.
fn fits(mesh: &Mesh, known: &Known<'_>) -> Result<bool, InvalidInput> {
    let (problem, x) = (&mesh.problem, Path::new(mesh, known)?.x);
    let (units, ends) = (problem.units()?, goal(problem).ends);
    let met = |end: &End, at: &At, outward: f64| {
        conditions(end, at, outward, &units).iter().all(|(_, missed)| missed.abs() < FITS)
    };
    Ok(met(&ends[0], &x.nodes[0], -1.0) && met(&ends[1], &x.nodes[mesh.elements()], 1.0))
}

/// What an end misses, in units, that is rounding or the error of a mesh.
const FITS: f64 = 1e-6;

/// What is asked for in the end.
#[must_use]
pub fn goal(problem: &Problem) -> Targets {
    Targets { ends: [0, 1].map(|i| problem.goal(&problem.ends[i])), load: 1.0, offset: Vec::new(), drag: 0.0 }
}

/// The way from the known shape, on meshes that follow it if asked.
pub fn followed(
    settings: &Settings,
    mut mesh: Mesh,
    known: &Known<'_>,
    mut stride: Stride,
    spent: &mut Spent,
) -> Result<(Mesh, Reached), InvalidInput> {
    let mut path = Path::new(&mesh, known)?;
    let mut reached = Reached::start(&path);
    loop {
        let mut system = new_system(mesh, settings)?;
        let bounds = Bounds { most_work: spent.left().max(LEAST_WORK), interrupted: settings.interrupted };
        let stop = path.follow(&mut system, &mut reached, &mut stride, &bounds)?;
        spent.factorised(&system);
        spent.meshes += 1;
        mesh = system.mesh;
        match stop {
            Stop::Coarse(estimate) if mesh.elements() < MOST_ON_THE_WAY && spent.work < spent.allowed => {
                let finer =
                    Mesh::new(&mesh.problem, refined(&mesh, &estimate, ERROR_ON_THE_WAY), settings.degree)?;
                reached.x = transferred(&reached.x, &mesh, &finer)?;
                path.transfer(&mesh, &finer);
                mesh = finer;
            }
            _ => {
                spent.went(&reached);
                return Ok((mesh, reached));
            }
        }
    }
}

/// Factorised elements of an attempt, and of all, that are too many: some four and seven seconds.
const MOST_WORK: usize = 250_000;
const MOST_WORK_OF_ALL: usize = 420_000;
/// What a way on one mesh may take anyway.
const LEAST_WORK: usize = 20_000;
/// Error that a mesh on a careful way is made for.
const ERROR_ON_THE_WAY: f64 = 1e-3;
/// Elements of a mesh on the way that are no longer refined.
const MOST_ON_THE_WAY: usize = 1000;

/// The equations on a mesh, with the states that are asked for.
///
/// # Errors
/// Where a section is refused.
pub fn new_system(mesh: Mesh, settings: &Settings) -> Result<System, InvalidInput> {
    match settings.layout {
        Some(layout) => System::with_layout(mesh, layout),
        None => System::new(mesh),
    }
}

/// How far the known shape turns.
pub fn first_turn(problem: &Problem, known: &Known<'_>) -> Result<f64, InvalidInput> {
    let strain = known.strains(problem)?;
    let rate = |i: i32| strain(problem.length * f64::from(i) / 16.0).rows(1, 3).norm();
    Ok((0..=16).map(rate).fold(0.0, f64::max) * problem.length)
}

/// The state that was reached, and why no further.
pub fn unfinished(mesh: Mesh, reached: Reached, spent: &Spent) -> Solved {
    use super::system::Failure;
    let failure = reached.failure.as_ref();
    let status = match failure {
        Some(Failed::Equations(Failure::Singular(_))) => Status::Singular,
        Some(Failed::Interrupted) => Status::Interrupted,
        _ => Status::Diverged,
    };
    let reason = failure.map_or_else(String::new, ToString::to_string);
    let report = spent.report(status, reason, reached.fraction, reached.norms);
    Solved { nodes: mesh.nodes, x: reached.x, report, index: None }
}

/// As [`adapted`], and where a finer mesh does not confirm what the ribbon came to on a coarse one it creeps on there.
fn crept_and_adapted(
    settings: &Settings,
    mesh: Mesh,
    x: Iterate,
    spent: &mut Spent,
) -> Result<Solved, InvalidInput> {
    let mut problem = Arc::clone(&mesh.problem);
    let mut solved = adapted(settings, mesh, x, spent)?;
    for _ in 0..MOST_RETURNS {
        if solved.report.status != Status::Diverged {
            break;
        }
        let mesh = Mesh::new(&problem, solved.nodes.clone(), settings.degree)?;
        let (mesh, reached) = crept_on(settings, mesh, solved.x.clone(), spent)?;
        if reached.failure == Some(Failed::Interrupted) {
            return Ok(unfinished(mesh, reached, spent));
        }
        if reached.failure.is_some() {
            break;
        }
        problem = Arc::clone(&mesh.problem);
        solved = adapted(settings, mesh, reached.x, spent)?;
    }
    Ok(solved)
}

/// How often a ribbon creeps on after a finer mesh.
const MOST_RETURNS: usize = 4;
