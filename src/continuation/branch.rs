//! A branch: its points, what is special about some of them, and how it ends.

use super::correct::{Corrected, EXACTLY, Guess, Point, PointOf, corrected, reversed};
use super::equations::{Equations, Failed, unit};
use super::switch::Off;
use super::value::at_value;

/// How far a branch is followed, and how well.
#[derive(Clone, Debug)]
pub struct Limits {
    /// Steps.
    pub steps: usize,
    /// Error of a point, in the norm of states and in the parameter.
    pub tolerance: f64,
    /// The longest step.
    pub longest: f64,
    /// Values of the parameter that are met exactly, ascending.
    pub values: Vec<f64>,
    /// Asked now and then whether to stop.
    pub interrupted: Option<fn() -> bool>,
}

impl Default for Limits {
    fn default() -> Self {
        Self { steps: 1000, tolerance: 1e-11, longest: 2.0, values: Vec::new(), interrupted: None }
    }
}

/// Why a branch is not followed further.
#[derive(Clone, Debug, PartialEq)]
pub enum Ended {
    /// It begins at a special point of another.
    Switched,
    /// It begins where it was asked to, and is not followed the other way.
    Start,
    /// The end of the range of the parameter.
    Span,
    /// So many steps as were allowed.
    Steps,
    /// It is closed.
    Closed,
    /// It meets a branch point that is known, beyond which it repeats itself.
    Joined,
    /// A section becomes unstable, and with it the equations singular.
    Section,
    /// No further equilibrium was found.
    Failed(Failed),
}

impl Ended {
    /// The name.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Switched => "branch point",
            Self::Start => "start",
            Self::Span => "span",
            Self::Steps => "steps",
            Self::Closed => "closed",
            Self::Joined => "joined",
            Self::Section => "section instability",
            Self::Failed(Failed::Interrupted) => "interrupted",
            Self::Failed(_) => "failed",
        }
    }
}

/// What is special about a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpecialKind {
    /// The parameter turns back.
    Fold,
    /// Branches meet.
    BranchPoint,
    /// A section becomes unstable, or stable.
    SectionInstability,
    /// A value of the parameter that was asked for.
    Value,
}

impl SpecialKind {
    /// The name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Fold => "fold",
            Self::BranchPoint => "branch point",
            Self::SectionInstability => "section instability",
            Self::Value => "value",
        }
    }
}

/// A special point of a branch.
#[derive(Clone, Debug)]
pub struct Special<S, C> {
    /// What.
    pub kind: SpecialKind,
    /// Which of the branch's points.
    pub place: usize,
    /// By how much the index changes at a branch point, or that of sections.
    pub multiplicity: usize,
    /// A step off a branch point, if one was made already.
    pub off: Option<Box<Off<S, C>>>,
}

/// A branch of equilibria.
#[derive(Clone, Debug)]
pub struct Branch<S, C> {
    /// Its points, along it.
    pub points: Vec<Point<S, C>>,
    /// Those that are special, along it.
    pub special: Vec<Special<S, C>>,
    /// How it ended: its beginning and its end.
    pub ended: [Ended; 2],
    /// The special point of another branch that it begins at: number of the branch, and of the special point there.
    pub origin: Option<(usize, usize)>,
    /// Whether its mirror image is a branch, too, which is not followed.
    pub mirrored: bool,
}

/// The special point of a problem.
pub type SpecialOf<E> = Special<<E as Equations>::State, <E as Equations>::Change>;
/// The branch of a problem.
pub type BranchOf<E> = Branch<<E as Equations>::State, <E as Equations>::Change>;

/// The first point of a branch: the equilibrium at `t` near `x`.
///
/// # Errors
/// If none is near.
pub fn begin<E: Equations>(
    equations: &mut E,
    x: E::State,
    t: f64,
    limits: &Limits,
) -> Result<PointOf<E>, Failed> {
    within(equations, x, t, NEAR, limits)
}

/// The same where the state is no farther from the equilibrium than this.
///
/// # Errors
/// If none is as near.
pub fn within<E: Equations>(
    equations: &mut E,
    x: E::State,
    t: f64,
    near: f64,
    limits: &Limits,
) -> Result<PointOf<E>, Failed> {
    equations.expect_motions(None);
    let guess = Guess { x: x.clone(), t, across: None, sense: None };
    let at_value = corrected(equations, guess, limits.tolerance, EXACTLY);
    let Corrected { mut point, first, .. } = match at_value {
        Ok(Corrected { point, first, aside }) => {
            Corrected { point: PointOf::<E> { t, ..point }, first, aside }
        }
        Err(failed) => at_fold(equations, x, t, limits).ok_or(failed)?,
    };
    if first > near {
        return Err(Failed::Jumped);
    }
    // Toward greater parameters.
    if point.along.t < 0.0 {
        point = reversed(equations, point);
    }
    Ok(point)
}

/// The equilibrium near a state that may be at a fold: across the direction in which the equations with the parameter are most nearly singular.
fn at_fold<E: Equations>(equations: &mut E, x: E::State, t: f64, limits: &Limits) -> Option<Corrected<E>> {
    equations.linearise(&x, t, None).ok()?;
    let kernel = equations.kernel(1).into_iter().next()?;
    let along = unit(equations, &kernel);
    let guess = Guess { x, t, across: Some(&along), sense: None };
    let found = corrected(equations, guess, limits.tolerance, EXACTLY).ok()?;
    (0.0..=1.0).contains(&found.point.t).then_some(found)
}

/// A first correction above this was no equilibrium.
const NEAR: f64 = 1e-4;

/// Whether the branch has come back to its first point.
pub fn is_closed<E: Equations>(equations: &mut E, branch: &BranchOf<E>, last: usize) -> bool {
    let (first, a, b) = (&branch.points[0], &branch.points[last], &branch.points[branch.points.len() - 1]);
    if last < 4 || (first.t - a.t) * (first.t - b.t) > 0.0 || first.along.t * b.along.t < 0.0 {
        return false;
    }
    // Where the branch has the parameter of its first point.
    let part = (first.t - a.t) / (b.t - a.t);
    let points = [first, a, b];
    let [coordinates, invariants] = [E::coordinates, E::invariants]
        .map(|numbers| points.map(|point| numbers(equations, &point.x, point.t)));
    let near = [&coordinates, &invariants].into_iter().all(|[here, from, to]| {
        let there: Vec<f64> = from.iter().zip(to).map(|(a, b)| a + part * (b - a)).collect();
        apart(here, &there) < NEARLY_CLOSED
    });
    near && at_value(equations, a, b, first.t).is_some_and(|there| {
        apart(&coordinates[0], &equations.coordinates(&there.x, there.t)) < CLOSED
            && apart(&invariants[0], &equations.invariants(&there.x, there.t)) < CLOSED
    })
}

/// The largest difference of numbers, relative to the largest of the first or one.
fn apart(here: &[f64], there: &[f64]) -> f64 {
    let size = here.iter().fold(1.0, |m: f64, x| m.max(x.abs()));
    here.iter().zip(there).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max) / size
}

/// Difference of what a closed branch comes back to, and of what lies between two points of it, by linear interpolation.
const CLOSED: f64 = 1e-4;
const NEARLY_CLOSED: f64 = 0.05;
