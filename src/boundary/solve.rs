//! The solver: a way to the solution on a coarse mesh, then meshes until the error is small enough.

use super::adapt::{Estimate, estimate, refined, transferred};
use super::check;
use super::iterate::{Iterate, Layout};
use super::mesh::Mesh;
use super::newton::{Control, newton};
use super::path::{Guess, Known, Path, Reached, known_strains};
use super::problem::Problem;
use super::system::System;
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
        }
    }
}

/// The degree of the least time to an error of 1e-10; see `benches/boundary.rs`.
pub const DEGREE: usize = 5;

/// How a solve ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// The error is below the tolerance.
    Converged,
    /// Rounding keeps the error above the tolerance; it is what it can be.
    RoundingLimited,
    /// The equations are singular on the way.
    Singular,
    /// Newton's method fails on the way, at the least step, or the independent check does not confirm.
    Diverged,
    /// The elements allowed do not suffice.
    Unresolved,
}

impl Status {
    /// All of them.
    pub const ALL: [Self; 5] =
        [Self::Converged, Self::RoundingLimited, Self::Singular, Self::Diverged, Self::Unresolved];

    /// The name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Converged => "converged",
            Self::RoundingLimited => "rounding_limited",
            Self::Singular => "singular",
            Self::Diverged => "diverged",
            Self::Unresolved => "unresolved",
        }
    }

    /// Whether there is a solution.
    #[must_use]
    pub fn is_solved(self) -> bool {
        matches!(self, Self::Converged | Self::RoundingLimited)
    }
}

/// How the solve went.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// How it ended.
    pub status: Status,
    /// Why not at a solution.
    pub reason: String,
    /// How much of loads and displacements was reached.
    pub fraction: f64,
    /// Estimate of the largest error of position/L, of angles, and of strains (`eps`, `K L`).
    pub error: f64,
    /// The largest residual of the independent check.
    pub residual: f64,
    /// Condition number of the conditions at the ends.
    pub condition: f64,
    /// Newton iterations.
    pub iterations: usize,
    /// Factorisations.
    pub factorisations: usize,
    /// Meshes.
    pub meshes: usize,
    /// Solves on the way to the loads.
    pub load_steps: usize,
    /// Norms of the corrections of the last solve.
    pub norms: Vec<f64>,
}

/// A discrete solution.
pub struct Solved {
    /// Ends of the elements.
    pub nodes: Vec<f64>,
    /// The unknowns.
    pub x: Iterate,
    /// How it was found.
    pub report: Report,
}

/// First meshes and imperfections that are tried in turn.
const ATTEMPTS: [(usize, f64); 4] = [(1, 1.0), (4, 1.0), (4, -3.0), (16, 0.3)];
/// Meshes that are too many.
const MOST_MESHES: usize = 25;

/// Solves a problem, from a guess or from its natural shape.
///
/// # Errors
/// Where a section is refused.
pub fn solve(problem: &Problem, settings: &Settings, guess: Option<&Guess>) -> Result<Solved, InvalidInput> {
    let turn = first_turn(problem, guess)?;
    let mut best: Option<Solved> = None;
    let mut spent = Spent::default();
    for (finer, size) in ATTEMPTS {
        let nodes = problem.first_nodes((finer * settings.first_elements) as f64, turn);
        if nodes.len() > settings.most_elements + 1 {
            break;
        }
        let mesh = Mesh::new(problem, nodes, settings.degree)?;
        let known = guess.map_or(Known::Natural(size), Known::Given);
        let mut path = Path::new(&mesh, &known)?;
        let mut system = new_system(&mesh, settings)?;
        let reached = path.follow(&mut system, if guess.is_some() { 1.0 } else { 0.5 });
        spent.take(&reached, &system);
        drop(system);
        let solved = if reached.failure.is_none() {
            adapted(problem, settings, mesh, reached.x, &mut spent)?
        } else {
            unfinished(mesh, reached, &spent)
        };
        if solved.report.status.is_solved() {
            return Ok(solved);
        }
        if best.as_ref().is_none_or(|b| solved.report.fraction > b.report.fraction) {
            best = Some(solved);
        }
    }
    best.ok_or_else(|| InvalidInput::new("length", problem.length, "a ribbon that fewer elements resolve"))
}

/// Work done so far.
#[derive(Clone, Copy, Debug, Default)]
struct Spent {
    iterations: usize,
    factorisations: usize,
    load_steps: usize,
    meshes: usize,
}

impl Spent {
    fn take(&mut self, reached: &Reached, system: &System<'_, '_>) {
        self.iterations += reached.iterations;
        self.load_steps += reached.steps;
        self.factorisations += system.factorisations;
        self.meshes += 1;
    }

    fn report(&self, status: Status, reason: String, fraction: f64, norms: Vec<f64>) -> Report {
        Report {
            status,
            reason,
            fraction,
            error: f64::INFINITY,
            residual: f64::INFINITY,
            condition: f64::INFINITY,
            iterations: self.iterations,
            factorisations: self.factorisations,
            meshes: self.meshes,
            load_steps: self.load_steps,
            norms,
        }
    }
}

fn new_system<'m, 'p>(mesh: &'m Mesh<'p>, settings: &Settings) -> Result<System<'m, 'p>, InvalidInput> {
    match settings.layout {
        Some(layout) => System::with_layout(mesh, layout),
        None => System::new(mesh),
    }
}

/// How far the known shape turns.
fn first_turn(problem: &Problem, guess: Option<&Guess>) -> Result<f64, InvalidInput> {
    let rate = |e: &crate::section::Strain| e.rows(1, 3).norm();
    let rates: Vec<f64> = if let Some(guess) = guess {
        guess.strains.iter().map(rate).collect()
    } else {
        let strain = known_strains(problem)?;
        (0..=16).map(|i| rate(&strain(problem.length * f64::from(i) / 16.0))).collect()
    };
    Ok(rates.into_iter().fold(0.0, f64::max) * problem.length)
}

fn unfinished(mesh: Mesh<'_>, reached: Reached, spent: &Spent) -> Solved {
    use super::newton::Failed;
    use super::system::Failure;
    let failure = reached.failure.as_ref();
    let status = match failure {
        Some(Failed::Equations(Failure::Singular(_))) => Status::Singular,
        _ => Status::Diverged,
    };
    let reason = failure.map_or_else(String::new, ToString::to_string);
    let report = spent.report(status, reason, reached.fraction, reached.norms);
    Solved { nodes: mesh.nodes, x: reached.x, report }
}

/// Meshes until the estimated error is below the tolerance.
fn adapted<'p>(
    problem: &'p Problem,
    settings: &Settings,
    mut mesh: Mesh<'p>,
    mut x: Iterate,
    spent: &mut Spent,
) -> Result<Solved, InvalidInput> {
    let mut before: Option<(f64, usize)> = None;
    let control =
        Control { tolerance: (1e-2 * settings.tolerance).max(1e-15), iterations: 25, least_step: 1e-2 };
    let goal = super::system::Targets {
        ends: [0, 1].map(|i| problem.goal(&problem.ends[i])),
        load: 1.0,
        offset: Vec::new(),
    };
    loop {
        let mut system = new_system(&mesh, settings)?;
        let ended = newton(&mut system, x.clone(), &goal, &control);
        spent.iterations += ended.norms.len();
        spent.factorisations += system.factorisations;
        if let Some(failure) = ended.failure {
            drop(system);
            let reason = format!("on a mesh of {} elements {failure}", mesh.elements());
            let report = spent.report(Status::Diverged, reason, 1.0, ended.norms);
            return Ok(Solved { nodes: mesh.nodes, x, report });
        }
        x = ended.x;
        let Estimate { error, defects } = estimate(&mut system, &x)?;
        let condition = system.condition();
        let count = mesh.elements();
        let stalled = before.is_some_and(|(e, n)| error > 0.5 * e && error < 1e-6 && count > n);
        let status = if error <= settings.tolerance {
            Some(Status::Converged)
        } else if stalled || (!settings.adaptive && error <= 1e-6) {
            Some(Status::RoundingLimited)
        } else if !settings.adaptive || count >= settings.most_elements || spent.meshes >= MOST_MESHES {
            Some(Status::Unresolved)
        } else {
            None
        };
        drop(system);
        if let Some(status) = status {
            let reason = match status {
                Status::Unresolved => format!("{count} elements leave an error of {error:.1e}"),
                _ => String::new(),
            };
            let residual = check::residual(&mesh, &x)?;
            let mut report = spent.report(status, reason, 1.0, ended.norms);
            (report.error, report.residual, report.condition) = (error, residual, condition);
            // NaN is refused, too.
            if status.is_solved() && !(residual <= 10.0 * error.max(1e-9).max(settings.tolerance)) {
                report.status = Status::Diverged;
                report.reason = format!("the independent check finds a residual of {residual:.1e}");
            }
            return Ok(Solved { nodes: mesh.nodes, x, report });
        }
        before = Some((error, count));
        let mut nodes = refined(&mesh, &Estimate { error, defects }, settings.tolerance);
        nodes.truncate(nodes.len().max(2));
        let finer = Mesh::new(problem, nodes, settings.degree)?;
        x = transferred(&x, &mesh, &finer)?;
        mesh = finer;
        spent.meshes += 1;
    }
}
