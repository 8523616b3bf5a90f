//! Along a branch: step by step, on meshes that are fine enough for what lies there, to where it ends.

use super::advance::{Advanced, advanced};
use super::branch::{BranchOf, Ended, Limits, Special, SpecialKind, is_closed};
use super::correct::{EXACTLY, Guess, Point, PointOf, corrected};
use super::equations::{Direction, Equations, Failed, Stability};
use super::locate::{Found, special_points, unlike};
use super::switch::{Off, across, stepped};
use super::value::at_value;

/// The first step.
const FIRST_STEP: f64 = 0.02;
/// A step that is too short, and by how much one that failed is shortened.
const SHORTEST: f64 = 1e-7;
const SHORTENED: f64 = 0.3;
/// Points that a prediction uses.
const MEMORY: usize = 4;
/// Steps after which the mesh is looked at.
const CHECKED: usize = 4;
/// Change of the parameter along a branch, of its arclength, above which a point may be corrected at its value.
const STEEP: f64 = 1e-2;
/// Looks at a mesh in a row that may be postponed.
const MOST_POSTPONED: usize = 3;
/// Meshes of a branch that are too many.
const MOST_MESHES: usize = 20;
/// Errors on which special points are not found, of the tolerance of points, and at most.
const DISTINCT: f64 = 0.5;
pub const MOST_DISTINCT: f64 = 1e-8;
/// Distance of two special points, in the span, that may be one.
const APART: f64 = 1e-6;
/// Finer meshes in a row that do not come to that: rounding keeps them.
const MOST_SHARPENED: usize = 2;

/// Whether a special point ends a branch.
type Stop<'s, E> = dyn FnMut(&mut E, &PointOf<E>, SpecialKind) -> bool + 's;

/// Follows the branch through a point along its tangent. `stop` tells whether a special point ends it.
pub fn follow<E: Equations>(
    equations: &mut E,
    first: PointOf<E>,
    limits: &Limits,
    mut stop: impl FnMut(&mut E, &PointOf<E>, SpecialKind) -> bool,
) -> BranchOf<E> {
    let mut walk = Walk::from(first, limits);
    let mut ended = loop {
        if let Err(ended) = walk.turn(equations, &mut stop) {
            break ended;
        }
    };
    if matches!(ended, Ended::Section | Ended::Failed(_)) && ended != Ended::Failed(Failed::Interrupted) {
        walk.drop_coarse(equations);
        // What is left may end where a section gives way, if what was dropped was beyond.
        if let Ended::Failed(failed) = ended {
            ended = walk.ended_by(failed);
        }
    }
    walk.branch.ended[1] = ended;
    walk.branch
}

/// A branch while it is followed.
struct Walk<'a, E: Equations> {
    limits: &'a Limits,
    /// What was passed.
    branch: BranchOf<E>,
    /// The free motions of all its points.
    motions: usize,
    /// Whether the first had more.
    singular: bool,
    /// The length of the next step.
    step: f64,
    /// The last regular points, on this mesh, by which the next is predicted.
    memory: Vec<PointOf<E>>,
    /// Whether the last point is where the range of the parameter ends.
    at_end: bool,
    /// Steps so far, and those since the mesh was looked at.
    steps: usize,
    since: usize,
    /// The last point whose mesh is known to be fine enough.
    fine: Fine<E>,
    /// Finer meshes so far, and those in a row for the sake of what lies within the next step.
    meshes: usize,
    sharpened: usize,
    /// Looks at the mesh in a row that were postponed.
    postponed: usize,
    /// The last branch point for which the mesh was too coarse: its parameter, and the error of that.
    unresolved: Option<(f64, f64)>,
}

/// A point whose mesh is fine enough, as it was on that: its place on the branch, the points by which the next was predicted, and the step to
/// that.
struct Fine<E: Equations> {
    place: usize,
    point: PointOf<E>,
    memory: Vec<PointOf<E>>,
    step: f64,
}

/// What a step comes to.
enum Attempt<E: Equations> {
    /// The next point, and the special points before it.
    Next(Advanced<E>, Vec<Found<E>>),
    /// A state on a finer mesh, which what lies within the step needs.
    Coarse(E::State),
}

impl<'a, E: Equations> Walk<'a, E> {
    /// At the first point.
    fn from(first: PointOf<E>, limits: &'a Limits) -> Self {
        let (step, motions) = (first.s.max(FIRST_STEP), first.stability.free_motions);
        let memory = vec![first.clone()];
        let branch = BranchOf::<E> {
            points: vec![first],
            special: Vec::new(),
            ended: [Ended::Start, Ended::Steps],
            origin: None,
            mirrored: false,
        };
        Self {
            limits,
            branch,
            motions,
            singular: false,
            step,
            fine: Fine { place: 0, point: memory[0].clone(), memory: memory.clone(), step },
            memory,
            at_end: false,
            steps: 0,
            // The first mesh is looked at, too.
            since: 0,
            meshes: 0,
            sharpened: 0,
            postponed: 0,
            unresolved: None,
        }
    }

    /// Looks at the mesh if it is time to, and attempts a step.
    ///
    /// # Errors
    /// How the branch ends, where it does.
    fn turn(&mut self, equations: &mut E, stop: &mut Stop<'_, E>) -> Result<(), Ended> {
        if self.meshes > MOST_MESHES {
            return Err(Ended::Failed(Failed::Unresolved(self.meshes)));
        }
        if self.since >= CHECKED || self.at_end {
            self.look_at_mesh(equations)?;
        }
        self.goes_on()?;
        match self.attempt(equations) {
            Ok(Attempt::Next(next, found)) => self.advance(equations, next, found, stop),
            Ok(Attempt::Coarse(finer)) => {
                self.steps += 1;
                self.restart(equations, &finer)?;
                // That mesh is looked at, too.
                self.since = CHECKED;
                Ok(())
            }
            Err(failed) => self.shorten(failed),
        }
    }

    /// Notes that the mesh is fine enough for the last point, or goes back to where it was on a finer one.
    ///
    /// # Errors
    /// If there is none.
    fn look_at_mesh(&mut self, equations: &mut E) -> Result<(), Ended> {
        self.since = 0;
        let last = self.last();
        match equations.refined(&last.x, last.t, &last.along, f64::INFINITY) {
            Ok(None) => {
                let place = self.branch.points.len() - 1;
                let point = self.last().clone();
                self.fine = Fine { place, point, memory: self.memory.clone(), step: self.step };
                self.postponed = 0;
                Ok(())
            }
            Ok(Some(finer)) => self.restart(equations, &finer),
            // Next to a branch point errors are large in one direction only: the next points tell more.
            Err(Failed::Fine(_)) if self.postponed < MOST_POSTPONED && !self.at_end => {
                self.postponed += 1;
                Ok(())
            }
            Err(failed) => Err(self.ended_by(failed)),
        }
    }

    /// Drops the last points if their mesh is too coarse, back to where it was last found fine enough, and to the point as it was there.
    fn drop_coarse(&mut self, equations: &mut E) {
        let fine = |walk: &Self, equations: &mut E| {
            let last = walk.last();
            matches!(equations.refined(&last.x, last.t, &last.along, f64::INFINITY), Ok(None))
        };
        while !fine(self, equations) {
            self.branch.points.pop();
            if self.branch.points.len() == self.fine.place {
                self.branch.points.push(self.fine.point.clone());
                break;
            }
        }
        let count = self.branch.points.len();
        self.branch.special.retain(|special| special.place < count);
    }

    /// Refuses another step where the range of the parameter ends, after as many as were allowed, and where asked to stop.
    fn goes_on(&self) -> Result<(), Ended> {
        if self.at_end {
            Err(Ended::Span)
        } else if self.steps >= self.limits.steps {
            Err(Ended::Steps)
        } else if self.limits.interrupted.is_some_and(|asks| asks()) {
            Err(Ended::Failed(Failed::Interrupted))
        } else {
            Ok(())
        }
    }

    /// The next point, and what lies before it, or a finer mesh to look for that on.
    fn attempt(&mut self, equations: &mut E) -> Result<Attempt<E>, Failed> {
        if self.steps == 0 && self.motions > 0 {
            self.begin(equations)?;
        }
        equations.expect_motions(Some(self.motions));
        let mut next = advanced(equations, self.last(), &self.memory, self.step, self.limits)?;
        let found = special_points(equations, self.last(), &next.point, self.limits);
        if found.as_ref().map_or(true, |found| are_near(found))
            && let Some(finer) = self.sharper(equations, &next.point)
        {
            self.sharpened += 1;
            return Ok(Attempt::Coarse(finer));
        }
        let mut found = found?;
        if let Some(beyond) = found.iter().position(|found| is_outside(found.point.t)) {
            // It turns back there: its way led beyond the range of the parameter.
            let turning = found.swap_remove(beyond).point;
            found.truncate(beyond);
            let before = found.last().map_or(self.last(), |found| &found.point);
            let end = if turning.t > 0.5 { 1.0 } else { 0.0 };
            let point = at_value(equations, before, &turning, end).filter(|_| before.t != end);
            next = next.ending(PointOf::<E> { t: end, ..point.ok_or(Failed::Jumped)? });
        }
        self.sharpened = 0;
        let coarse =
            found.iter_mut().find_map(|found| unresolved(equations, found, self.limits, self.unresolved));
        Ok(match coarse {
            Some((finer, place, error)) => {
                self.unresolved = Some((place, error));
                Attempt::Coarse(finer)
            }
            None => Attempt::Next(next, found),
        })
    }

    /// Looks at a second point: if it has fewer free motions than the first that is a branch point, and takes the stability of its neighbour.
    ///
    /// # Errors
    /// If there is none.
    fn begin(&mut self, equations: &mut E) -> Result<(), Failed> {
        equations.expect_motions(None);
        let next = advanced(equations, self.last(), &self.memory, self.step, self.limits)?.point;
        // What is a little beside the equilibrium is not as singular.
        let across = self.last().along.clone();
        let guess = Guess { x: next.x, t: next.t, across: Some(&across), sense: Some(&across) };
        let second = corrected(equations, guess, self.limits.tolerance, EXACTLY)?.point.stability;
        if second.free_motions < self.motions {
            (self.motions, self.singular) = (second.free_motions, true);
            let fine = &mut self.fine;
            for first in
                [&mut self.branch.points[0], &mut self.memory[0], &mut fine.memory[0], &mut fine.point]
            {
                first.stability = Stability { determinant: None, ..second.clone() };
            }
        }
        Ok(())
    }

    /// The next point on a finer mesh, where something special before it was looked for in vain: by the third root of its error two branches
    /// that meet may miss one another. It also tells apart what is nearly one.
    fn sharper(&self, equations: &mut E, next: &PointOf<E>) -> Option<E::State> {
        if self.sharpened >= MOST_SHARPENED || !unlike(self.last(), next) {
            return None;
        }
        let most = (DISTINCT * self.limits.tolerance).min(MOST_DISTINCT);
        equations.refined(&next.x, next.t, &next.along, most).ok().flatten()
    }

    /// Goes to the next point, past the special points before it.
    ///
    /// # Errors
    /// If one of those ends the branch, or if it is closed.
    fn advance(
        &mut self,
        equations: &mut E,
        next: Advanced<E>,
        found: Vec<Found<E>>,
        stop: &mut Stop<'_, E>,
    ) -> Result<(), Ended> {
        (self.steps, self.since) = (self.steps + 1, self.since + 1);
        let before = self.branch.points.len() - 1;
        for found in found {
            self.pass(equations, found, stop)?;
        }
        (self.step, self.at_end) = (next.next_step(self.step, self.limits), next.at_end);
        self.memory.drain(..(self.memory.len() + 1).saturating_sub(MEMORY));
        self.memory.push(next.point.clone());
        self.branch.points.push(next.point);
        if is_closed(equations, &self.branch, before) { Err(Ended::Closed) } else { Ok(()) }
    }

    /// Takes a special point.
    ///
    /// # Errors
    /// If it ends the branch.
    fn pass(&mut self, equations: &mut E, found: Found<E>, stop: &mut Stop<'_, E>) -> Result<(), Ended> {
        let Found { point, kind, multiplicity, off } = found;
        let stopped = stop(equations, &point, kind);
        self.branch.special.push(Special { kind, place: self.branch.points.len(), multiplicity, off });
        self.branch.points.push(point);
        if stopped { Err(Ended::Joined) } else { Ok(()) }
    }

    /// Makes the next step shorter than one that failed, and predicts it by fewer points.
    ///
    /// # Errors
    /// If it is too short, or no step helps.
    fn shorten(&mut self, failed: Failed) -> Result<(), Ended> {
        self.step *= SHORTENED;
        self.memory.drain(..self.memory.len().saturating_sub(2));
        if self.step < SHORTEST {
            return Err(self.ended_by(failed));
        }
        Ok(())
    }

    /// Drops all points since the mesh was last found fine enough, and puts that one, and what was remembered there, on a finer one.
    ///
    /// # Errors
    /// If it is no equilibrium there.
    fn restart(&mut self, equations: &mut E, like: &E::State) -> Result<(), Ended> {
        let memory = self.remembered(equations, like).map_err(|failed| self.ended_by(failed))?;
        let place = self.fine.place;
        self.branch.points.truncate(place);
        self.branch.points.extend(memory.last().cloned());
        self.branch.special.retain(|special| special.place < place);
        self.fine.memory.clone_from(&memory);
        (self.memory, self.step, self.at_end) = (memory, self.fine.step, false);
        self.meshes += 1;
        Ok(())
    }

    /// What was remembered at the point whose mesh was last found fine enough, on the mesh of another state; the last is that point.
    fn remembered(&self, equations: &mut E, like: &E::State) -> Result<Vec<PointOf<E>>, Failed> {
        let again = self.fine_again(equations, like)?;
        let mut memory = Vec::new();
        for point in &self.fine.memory[..self.fine.memory.len() - 1] {
            let (x, along) = equations.remeshed(&point.x, &point.along.x, like, point.t)?;
            memory.push(Point { x, along: Direction { x: along, t: point.along.t }, ..point.clone() });
        }
        memory.push(again);
        Ok(memory)
    }

    /// The point whose mesh was last found fine enough, corrected on the mesh of another state.
    fn fine_again(&self, equations: &mut E, like: &E::State) -> Result<PointOf<E>, Failed> {
        let point = &self.branch.points[self.fine.place];
        let (x, along) = equations.remeshed(&point.x, &point.along.x, like, point.t)?;
        let along = Direction { x: along, t: point.along.t };
        // What the branch begins with is at a value of the parameter, which it keeps, unless that is at a fold.
        let kept = self.fine.place == 0 && along.t.abs() > STEEP;
        let across = if kept { None } else { Some(&along) };
        let guess = Guess { x, t: point.t, across, sense: Some(&along) };
        let singular = self.singular && self.fine.place == 0;
        if singular {
            equations.expect_motions(None);
        }
        let mut again = corrected(equations, guess, self.limits.tolerance, EXACTLY)?.point;
        if kept {
            again.t = point.t;
        }
        if singular {
            again.stability = point.stability.clone();
        }
        again.s = point.s;
        Ok(again)
    }

    /// How the branch ends where a step or a mesh fails.
    fn ended_by(&self, failed: Failed) -> Ended {
        // Equations are singular where a section is about to become unstable.
        let soft = self.last().stability.section[0] < SOFT || self.softens();
        if self.last().stability.section_index == 0
            && soft
            && !matches!(failed, Failed::Interrupted | Failed::Refused(_))
        {
            Ended::Section
        } else {
            Ended::Failed(failed)
        }
    }

    /// Whether a section alone becomes unstable just ahead: as at a fold of what it bears, the square of its softness vanishes in proportion.
    fn softens(&self) -> bool {
        let last = self.last();
        let square = |point: &PointOf<E>| point.stability.section[0].powi(2);
        let before = self.branch.points.iter().rev().find(|point| square(point) > 4.0 * square(last));
        last.stability.section[0] < SOFTER
            && before.is_some_and(|before| {
                let ahead = (last.t - before.t) * square(last) / (square(before) - square(last));
                before.stability.section_index == 0 && ahead.abs() < JUST_AHEAD
            })
    }

    /// The last point.
    fn last(&self) -> &PointOf<E> {
        &self.branch.points[self.branch.points.len() - 1]
    }
}

/// Softness of a section, of the ungrown one, that is about to become unstable; one that may be, and how far ahead in the span that is.
const SOFT: f64 = 1e-3;
const SOFTER: f64 = 0.1;
const JUST_AHEAD: f64 = 1e-3;

/// Whether a parameter is beyond its range, by more than rounding.
fn is_outside(t: f64) -> bool {
    !(-BEYOND..=1.0 + BEYOND).contains(&t)
}

/// What rounding is.
const BEYOND: f64 = 1e-12;

/// Whether two special points are so near that they may be one, which the error of the mesh divides.
fn are_near<E: Equations>(found: &[Found<E>]) -> bool {
    found.windows(2).any(|pair| (pair[1].point.t - pair[0].point.t).abs() < APART)
}

/// The state at a branch point on a finer mesh, if this one is too coarse: a straight ribbon is exact on any mesh, but not the shape into
/// which it buckles. With it the place, and the error of the parameter there.
fn unresolved<E: Equations>(
    equations: &mut E,
    found: &mut Found<E>,
    limits: &Limits,
    before: Option<(f64, f64)>,
) -> Option<(E::State, f64, f64)> {
    let Found { point, kind: SpecialKind::BranchPoint, multiplicity, off } = found else { return None };
    let direction = across(equations, point, *multiplicity).into_iter().next();
    *off = direction.and_then(|direction| {
        let point = stepped(equations, point, &direction, limits)?;
        Some(Box::new(Off { direction, point }))
    });
    let (error, finer) = match off {
        Some(off) => {
            let moved = MOVED.max(LOCATED * limits.tolerance);
            equations.resolved(&off.point.x, off.point.t, &off.direction, moved).ok()?
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
