//! A branch, from a point of it as far as it is asked for.

use super::correct::{
    Corrected, EXACTLY, Guess, Point, PointOf, ROUGHLY, arclength, corrected, difference, reversed,
};
use super::equations::{Direction, Equations, Failed, dot};
use super::locate::{Found, special_points, unlike};
use super::predict::weights;
use super::switch::{across, stepped};

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
pub struct Special {
    /// What.
    pub kind: SpecialKind,
    /// Which of the branch's points.
    pub place: usize,
    /// By how much the index changes at a branch point, or that of sections.
    pub multiplicity: usize,
}

/// A branch of equilibria.
#[derive(Clone, Debug)]
pub struct Branch<S, C> {
    /// Its points, along it.
    pub points: Vec<Point<S, C>>,
    /// Those that are special, along it.
    pub special: Vec<Special>,
    /// How it ended: its beginning and its end.
    pub ended: [Ended; 2],
    /// The special point of another branch that it begins at: number of the branch, and of the special point there.
    pub origin: Option<(usize, usize)>,
    /// Whether its mirror image is a branch, too, which is not followed.
    pub mirrored: bool,
}

/// The branch of a problem.
pub type BranchOf<E> = Branch<<E as Equations>::State, <E as Equations>::Change>;

/// The first step, and the error of a prediction that steps are made for.
const FIRST_STEP: f64 = 0.02;
const PREDICTION: f64 = 5e-3;
/// An error of a prediction, and a cosine of the angle between tangents, that no step may have.
const FAR: f64 = 8.0 * PREDICTION;
const TURN: f64 = 0.7;
/// A step that is too short.
const SHORTEST: f64 = 1e-7;
/// Points that a prediction uses.
const MEMORY: usize = 4;
/// Looks at a mesh in a row that may be postponed.
const MOST_POSTPONED: usize = 3;
/// Meshes of a branch that are too many.
const MOST_MESHES: usize = 20;
/// Errors where there are special points, of the tolerance of points, and at most: by its third root two branches that meet may miss one
/// another.
const DISTINCT: f64 = 0.5;
const MOST_DISTINCT: f64 = 1e-8;
/// Finer meshes in a row that do not come to that: rounding keeps them.
const MOST_SHARPENED: usize = 2;
/// Steps after which the mesh is looked at.
const CHECKED: usize = 4;

/// Follows the branch through a point along its tangent. `stop` tells whether a special point ends it.
pub fn follow<E: Equations>(
    equations: &mut E,
    first: PointOf<E>,
    limits: &Limits,
    mut stop: impl FnMut(&mut E, &PointOf<E>, SpecialKind) -> bool,
) -> BranchOf<E> {
    let mut branch = Branch {
        points: vec![first],
        special: Vec::new(),
        ended: [Ended::Start, Ended::Steps],
        origin: None,
        mirrored: false,
    };
    let mut step = branch.points[0].s.max(FIRST_STEP);
    let motions = branch.points[0].stability.free_motions;
    // The last regular points, on this mesh, by which the next is predicted.
    let mut memory = vec![branch.points[0].clone()];
    // The last point whose mesh is known to be fine enough, what was remembered there, and how many steps ago that was.
    let mut fine = Fine { place: 0, memory: memory.clone(), step };
    let mut since = CHECKED;
    let mut steps = 0;
    let mut at_end = false;
    let (mut meshes, mut unresolved_before) = (0, None);
    // Finer meshes in a row for the sake of what lies within the next step.
    let mut sharpened = 0;
    let mut postponed = 0;
    loop {
        if meshes > MOST_MESHES {
            branch.ended[1] = Ended::Failed(Failed::Unresolved(meshes));
            break;
        }
        if since >= CHECKED || at_end {
            since = 0;
            let last = &branch.points[branch.points.len() - 1];
            match equations.refined(&last.x, last.t, &last.along, f64::INFINITY) {
                Ok(None) => {
                    (fine, postponed) =
                        (Fine { place: branch.points.len() - 1, memory: memory.clone(), step }, 0)
                }
                Ok(Some(finer)) => match restart(equations, &mut branch, &mut fine, &finer, limits) {
                    Ok(remembered) => {
                        (memory, step, at_end, meshes) = (remembered, fine.step, false, meshes + 1)
                    }
                    Err(failed) => {
                        branch.ended[1] = ended_by(branch.points.last(), failed);
                        break;
                    }
                },
                // Next to a branch point errors are large in one direction only: the next points tell more.
                Err(Failed::Fine(_)) if postponed < MOST_POSTPONED && !at_end => postponed += 1,
                Err(failed) => {
                    branch.ended[1] = ended_by(branch.points.last(), failed);
                    break;
                }
            }
        }
        if at_end {
            branch.ended[1] = Ended::Span;
            break;
        }
        if steps >= limits.steps {
            break;
        }
        if limits.interrupted.is_some_and(|asks| asks()) {
            branch.ended[1] = Ended::Failed(Failed::Interrupted);
            break;
        }
        equations.expect_motions(Some(motions));
        let last = branch.points.len() - 1;
        let next = advanced(equations, &branch.points[last], &memory, step, limits);
        // What happens on a mesh that is too coarse is looked for in vain.
        let most = (DISTINCT * limits.tolerance).min(MOST_DISTINCT);
        let looks =
            |next: &&Advanced<E>| sharpened < MOST_SHARPENED && unlike(&branch.points[last], &next.point);
        let finer = next.as_ref().ok().filter(looks).and_then(|next| {
            let Point { x, t, along, .. } = &next.point;
            equations.refined(x, *t, along, most).ok().flatten()
        });
        let next = next.and_then(|next| {
            if finer.is_some() {
                return Ok((next, Vec::new()));
            }
            let found = special_points(equations, &branch.points[last], &next.point, limits)?;
            Ok((next, found))
        });
        let (next, found) = match next {
            Ok(next) => next,
            Err(failed) => {
                step *= 0.3;
                memory.drain(..memory.len().saturating_sub(2));
                if step < SHORTEST || matches!(failed, Failed::Refused(_)) {
                    branch.ended[1] = ended_by(branch.points.last(), failed);
                    break;
                }
                continue;
            }
        };
        (steps, since) = (steps + 1, since + 1);
        let mut stopped = false;
        sharpened = if finer.is_some() { sharpened + 1 } else { 0 };
        let coarse = found.iter().find_map(|found| unresolved(equations, found, limits, unresolved_before));
        let finer = finer.or_else(|| {
            let (finer, place, error) = coarse?;
            unresolved_before = Some((place, error));
            Some(finer)
        });
        if let Some(finer) = finer {
            match restart(equations, &mut branch, &mut fine, &finer, limits) {
                Ok(remembered) => (memory, step) = (remembered, fine.step),
                Err(failed) => {
                    branch.ended[1] = ended_by(branch.points.last(), failed);
                    break;
                }
            }
            (since, meshes) = (CHECKED, meshes + 1);
            continue;
        }
        for found in found {
            stopped = stop(equations, &found.point, found.kind);
            let place = branch.points.len();
            branch.points.push(found.point);
            branch.special.push(Special { kind: found.kind, place, multiplicity: found.multiplicity });
            if stopped {
                break;
            }
        }
        if stopped {
            branch.ended[1] = Ended::Joined;
            break;
        }
        at_end = next.at_end;
        memory.drain(..(memory.len() + 1).saturating_sub(MEMORY));
        memory.push(next.point.clone());
        branch.points.push(next.point);
        if is_closed(equations, &branch, last) {
            branch.ended[1] = Ended::Closed;
            break;
        }
        let factor = (PREDICTION / next.error.max(1e-12)).powf(1.0 / (next.order as f64 + 1.0));
        step = (step * (0.9 * factor).clamp(0.3, 2.5)).min(limits.longest);
    }
    branch
}

/// A point whose mesh is fine enough: its place on the branch, the points by which the next was predicted, and the step to that.
struct Fine<E: Equations> {
    place: usize,
    memory: Vec<PointOf<E>>,
    step: f64,
}

struct Advanced<E: Equations> {
    point: PointOf<E>,
    order: usize,
    error: f64,
    at_end: bool,
}

/// The next point, a step away, or where the range of the parameter ends.
fn advanced<E: Equations>(
    equations: &mut E,
    last: &PointOf<E>,
    memory: &[PointOf<E>],
    step: f64,
    limits: &Limits,
) -> Result<Advanced<E>, Failed> {
    let places: Vec<f64> = memory.iter().map(|point| point.s).collect();
    let before = &memory[..memory.len() - 1];
    let changes: Vec<E::Change> =
        before.iter().map(|point| equations.difference(&last.x, &point.x)).collect();
    let predicted = |equations: &mut E, length: f64| {
        let (weights, tangent) = weights(&places, length);
        let mut parts: Vec<_> = weights.iter().copied().zip(&changes).collect();
        parts.push((tangent, &last.along.x));
        let change = equations.sum(&parts);
        let ahead: f64 = weights.iter().zip(before).map(|(w, point)| w * (point.t - last.t)).sum();
        (equations.moved(&last.x, &change, 1.0), last.t + ahead + tangent * last.along.t)
    };
    let (x, t) = predicted(equations, step);
    let outside = |t: f64| !(0.0..=1.0).contains(&t);
    if outside(t) && (t - last.t) * last.along.t > 0.0 {
        // To the end of the range, exactly.
        let end = if t > 0.5 { 1.0 } else { 0.0 };
        if last.t == end {
            return Err(Failed::Jumped);
        }
        let mut length = step * (end - last.t) / (t - last.t);
        let mut guess = predicted(equations, length);
        for _ in 0..4 {
            let slope = (guess.1 - last.t) / length;
            length = (length + (end - guess.1) / slope).clamp(0.0, step);
            guess = predicted(equations, length);
        }
        let guess = Guess { x: guess.0, t: end, across: None, sense: Some(&last.along) };
        let Corrected { mut point, first } = corrected(equations, guess, limits.tolerance, ROUGHLY)?;
        point.t = end;
        near(equations, last, &point, first, length)?;
        point.s = last.s + arc(equations, last, &point);
        return Ok(Advanced { point, order: memory.len(), error: first, at_end: true });
    }
    let guess = Guess { x, t, across: Some(&last.along), sense: Some(&last.along) };
    let Corrected { mut point, first } = corrected(equations, guess, limits.tolerance, ROUGHLY)?;
    near(equations, last, &point, first, step)?;
    if outside(point.t) {
        // A shorter step meets the end.
        return Err(Failed::Jumped);
    }
    point.s = last.s + arc(equations, last, &point);
    Ok(Advanced { point, order: memory.len(), error: first, at_end: false })
}

/// The arclength from a point to the next.
fn arc<E: Equations>(equations: &mut E, from: &PointOf<E>, to: &PointOf<E>) -> f64 {
    let change = difference(equations, from, to);
    arclength(equations, [from, to], &change)
}

/// Refuses a point that is not the next one.
fn near<E: Equations>(
    equations: &E,
    last: &PointOf<E>,
    point: &PointOf<E>,
    first: f64,
    step: f64,
) -> Result<(), Failed> {
    let turned = dot(equations, &last.along, &point.along);
    if first > FAR.min(0.5 * step) || turned < TURN { Err(Failed::Jumped) } else { Ok(()) }
}

fn ended_by<S, C>(last: Option<&Point<S, C>>, failed: Failed) -> Ended {
    // Equations are singular where a section is about to become unstable.
    let soft = last.is_some_and(|point| point.stability.section_index == 0 && point.stability.section < 1e-3);
    if soft && !matches!(failed, Failed::Interrupted | Failed::Refused(_)) {
        Ended::Section
    } else {
        Ended::Failed(failed)
    }
}

/// Drops all points since the mesh was last found fine enough, and puts that one, and what was remembered there, on a finer one.
fn restart<E: Equations>(
    equations: &mut E,
    branch: &mut BranchOf<E>,
    fine: &mut Fine<E>,
    like: &E::State,
    limits: &Limits,
) -> Result<Vec<PointOf<E>>, Failed> {
    let place = fine.place;
    let point = &branch.points[place];
    let (x, along) = equations.remeshed(&point.x, &point.along.x, like, point.t)?;
    let along = Direction { x: along, t: point.along.t };
    // What the branch begins with is at a value of the parameter, which it keeps, unless that is at a fold.
    let kept = place == 0 && along.t.abs() > 0.1;
    let across = if kept { None } else { Some(&along) };
    let guess = Guess { x, t: point.t, across, sense: Some(&along) };
    let mut again = corrected(equations, guess, limits.tolerance, EXACTLY)?.point;
    if kept {
        again.t = point.t;
    }
    again.s = point.s;
    let mut memory = Vec::new();
    for point in &fine.memory[..fine.memory.len() - 1] {
        let (x, along) = equations.remeshed(&point.x, &point.along.x, like, point.t)?;
        memory.push(Point { x, along: Direction { x: along, t: point.along.t }, ..point.clone() });
    }
    memory.push(again.clone());
    fine.memory.clone_from(&memory);
    branch.points.truncate(place);
    branch.points.push(again);
    branch.special.retain(|special| special.place < place);
    Ok(memory)
}

/// The state at a branch point on a finer mesh, if this one is too coarse: a straight ribbon is exact on any mesh, but not the shape into
/// which it buckles. With it the place, and the error of the parameter there.
fn unresolved<E: Equations>(
    equations: &mut E,
    found: &Found<E>,
    limits: &Limits,
    before: Option<(f64, f64)>,
) -> Option<(E::State, f64, f64)> {
    let Found { point, kind: SpecialKind::BranchPoint, multiplicity } = found else { return None };
    let off = across(equations, point, *multiplicity).into_iter().next();
    let aside = off.and_then(|off| Some((stepped(equations, point, &off, limits)?, off)));
    let (error, finer) = match aside {
        Some((aside, off)) => {
            let moved = MOVED.max(LOCATED * limits.tolerance);
            equations.resolved(&aside.x, aside.t, &off, moved).ok()?
        }
        // No other branch is found: once more on a finer mesh.
        None => (UNKNOWN, equations.doubled(&point.x, point.t).ok()?),
    };
    // What a finer mesh did not help is rounding.
    let again = |(place, before): (f64, f64)| (place - point.t).abs() < 2.0 * before && error > 0.25 * before;
    if before.is_some_and(again) {
        return None;
    }
    finer.map(|finer| (finer, point.t, error))
}

/// Error of the parameter at a branch point that is too large, the same of the tolerance of points, and one that stands for an unknown one.
const MOVED: f64 = 2e-11;
const LOCATED: f64 = 0.1;
const UNKNOWN: f64 = 1.0;

/// Whether the branch has come back to its first point.
fn is_closed<E: Equations>(equations: &mut E, branch: &BranchOf<E>, last: usize) -> bool {
    let (first, a, b) = (&branch.points[0], &branch.points[last], &branch.points[branch.points.len() - 1]);
    if last < 4 || (first.t - a.t) * (first.t - b.t) > 0.0 || first.along.t * b.along.t < 0.0 {
        return false;
    }
    // Where the branch has the parameter of its first point.
    let part = (first.t - a.t) / (b.t - a.t);
    let apart = |numbers: [Vec<f64>; 3]| {
        let [here, from, to] = numbers;
        let size = here.iter().fold(1.0, |m: f64, x| m.max(x.abs()));
        let there = from.iter().zip(&to).map(|(a, b)| a + part * (b - a));
        here.iter().zip(there).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max) / size
    };
    let points = [first, a, b];
    apart(points.map(|point| equations.coordinates(&point.x, point.t))) < CLOSED
        && apart(points.map(|point| equations.invariants(&point.x, point.t))) < CLOSED
}

/// Relative difference of what a closed branch comes back to, by linear interpolation.
const CLOSED: f64 = 0.02;

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
    equations.expect_motions(None);
    let guess = Guess { x, t, across: None, sense: None };
    let Corrected { mut point, first } = corrected(equations, guess, limits.tolerance, EXACTLY)?;
    if first > NEAR {
        return Err(Failed::Jumped);
    }
    point.t = t;
    // Toward greater parameters.
    if point.along.t < 0.0 {
        point = reversed(equations, point);
    }
    Ok(point)
}

/// A first correction above this was no equilibrium.
const NEAR: f64 = 1e-4;
