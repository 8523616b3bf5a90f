//! A fold, a branch point or a section instability followed as a second parameter varies: a curve in the plane of both.
//!
//! At each value of the second parameter the branch through the special point is found anew, a little to both sides of where the last two
//! tell it to be, and the point located between. Where the curve is steep the two parameters change places.

use super::branch::{Ended, Limits, SpecialKind};
use super::correct::{DirectionOf, EXACTLY, Guess, PointOf, corrected, difference};
use super::equations::{Direction, Equations, Failed, dot, scaled};
use super::locate::{Found, special_points};
use super::switch::across;

/// Equations of two parameters, one of which is followed.
pub trait Plane: Equations {
    /// Sets the parameter that is not followed; the two are exchanged or not.
    fn hold(&mut self, other: f64, exchanged: bool);
}

/// A curve of special points.
pub struct Locus<S> {
    /// Both parameters, from 0 to 1.
    pub places: Vec<[f64; 2]>,
    /// The states.
    pub states: Vec<S>,
    /// How it ended: its beginning and its end.
    pub ended: [Ended; 2],
}

/// Half the piece of a branch in which a special point is looked for, and how often it is doubled.
const REACH: f64 = 2e-4;
const DOUBLINGS: usize = 10;
/// The part of it in which it is to be.
const INSIDE: f64 = 0.7;
/// The first step of the second parameter, the longest, and one that is too short.
const FIRST: f64 = 1e-3;
const LONGEST: f64 = 0.05;
const SHORTEST: f64 = 1e-5;
/// Error of a predicted place that steps are made for.
const ERROR: f64 = 5e-4;
/// Steeper than this the parameters change places.
const STEEP: f64 = 2.0;

/// Where the curve is: the special point, the two parameters in their own order, and the direction of what branches off there, which
/// tells it from other special points.
struct Here<E: Equations> {
    point: PointOf<E>,
    place: [f64; 2],
    off: Option<DirectionOf<E>>,
    /// By how much the index changes, if that is known.
    multiplicity: Option<usize>,
}

/// Follows the special point both ways.
pub fn locus<E: Plane>(
    equations: &mut E,
    start: &PointOf<E>,
    other: f64,
    kind: SpecialKind,
    limits: &Limits,
) -> Locus<E::State> {
    let first = [start.t, other];
    let (ahead, end) = walked(equations, start, first, kind, 1.0, limits);
    let (back, begin) = walked(equations, start, first, kind, -1.0, limits);
    let mut locus = Locus { places: Vec::new(), states: Vec::new(), ended: [begin, end] };
    let own = Here::<E> { point: start.clone(), place: first, off: None, multiplicity: None };
    for here in back.into_iter().rev().chain([own]).chain(ahead) {
        locus.places.push(here.place);
        locus.states.push(here.point.x);
    }
    locus
}

fn walked<E: Plane>(
    equations: &mut E,
    start: &PointOf<E>,
    place: [f64; 2],
    kind: SpecialKind,
    sense: f64,
    limits: &Limits,
) -> (Vec<Here<E>>, Ended) {
    let mut found: Vec<Here<E>> = Vec::new();
    equations.hold(place[1], false);
    let mut point = start.clone();
    let mut off = directions(equations, start, kind, 1).into_iter().next();
    // Of the two branches that meet there the one along which the parameter changes, and the other.
    if let Some(other) = off.take_if(|off| off.t.abs() > point.along.t.abs()) {
        off = Some(std::mem::replace(&mut point.along, other));
    }
    let mut here = Here::<E> { point, place, off, multiplicity: None };
    // Which parameter is held, and how fast the state and the other change with it.
    let (mut held, mut sense) = (1_usize, sense);
    let mut rate = scaled(equations, &here.point.along, 0.0);
    let mut step = FIRST;
    for _ in 0..limits.steps {
        if limits.interrupted.is_some_and(|asks| asks()) {
            return (found, Ended::Failed(Failed::Interrupted));
        }
        let now = here.place[held];
        if now <= 0.0 && sense < 0.0 || now >= 1.0 && sense > 0.0 {
            return (found, Ended::Span);
        }
        let next = (now + sense * step).clamp(0.0, 1.0);
        let moved = next - now;
        let expected = here.place[1 - held] + rate.t * moved;
        equations.hold(next, held == 0);
        let shift = scaled(equations, &rate, moved);
        let Some((point, off, multiplicity)) = near(equations, &here, &shift, kind, limits) else {
            step *= 0.5;
            if step < SHORTEST {
                return (found, Ended::Failed(Failed::Jumped));
            }
            continue;
        };
        let mut place = [point.t; 2];
        place[held] = next;
        place[1 - held] = point.t;
        let error = (point.t - expected).abs();
        if error > 4.0 * ERROR && step > 16.0 * SHORTEST {
            step *= 0.5;
            continue;
        }
        if !(0.0..=1.0).contains(&point.t) {
            return match to_end(equations, &here, held, (place, &rate), kind, limits) {
                Some(last) => {
                    found.push(last);
                    (found, Ended::Span)
                }
                None => (found, Ended::Failed(Failed::Jumped)),
            };
        }
        let change = difference(equations, &here.point, &point);
        rate = Direction { t: point.t - here.place[1 - held], ..change };
        rate = scaled(equations, &rate, 1.0 / moved);
        step = (step * (ERROR / error.max(1e-6)).sqrt().clamp(0.5, 2.0)).min(LONGEST);
        here = Here { point, place, off, multiplicity: Some(multiplicity) };
        found.push(Here { point: here.point.clone(), place, off: None, multiplicity: None });
        if rate.t.abs() > STEEP
            && let Some(along) = exchanged(equations, &here, held, kind)
        {
            sense *= rate.t.signum();
            held = 1 - held;
            // Of the state and of the parameter that was held, by the one that is.
            rate = Direction { t: 1.0 / rate.t, ..scaled(equations, &rate, 1.0 / rate.t) };
            here.point.along = along;
            here.point.t = here.place[1 - held];
        }
    }
    (found, Ended::Steps)
}

/// Where the parameter that is not held comes to the end of its range, between a place and one beyond, by secants.
fn to_end<E: Plane>(
    equations: &mut E,
    here: &Here<E>,
    held: usize,
    (beyond, rate): ([f64; 2], &DirectionOf<E>),
    kind: SpecialKind,
    limits: &Limits,
) -> Option<Here<E>> {
    let end = beyond[1 - held].clamp(0.0, 1.0);
    // The parameter that is held, and how far the other is beyond.
    let of = |place: [f64; 2]| (place[held], place[1 - held] - end);
    let (mut before, mut last) = (of(here.place), of(beyond));
    let rate = Direction { t: (last.1 - before.1) / (last.0 - before.0), x: rate.x.clone() };
    for _ in 0..MOST_TO_END {
        let next = last.0 - last.1 * (last.0 - before.0) / (last.1 - before.1);
        equations.hold(next, held == 0);
        let shift = scaled(equations, &rate, next - here.place[held]);
        let (point, off, multiplicity) = near(equations, here, &shift, kind, limits)?;
        (before, last) = (last, (next, point.t - end));
        if last.1.abs() < ENDED {
            let mut place = [end; 2];
            place[held] = next;
            return Some(Here { point, place, off, multiplicity: Some(multiplicity) });
        }
    }
    None
}

/// Special points of that search that are too many, and the distance from the end that ends it.
const MOST_TO_END: usize = 10;
const ENDED: f64 = 1e-11;

/// The directions of what branches off at a branch point of this multiplicity, orthonormal.
fn directions<E: Plane>(
    equations: &mut E,
    point: &PointOf<E>,
    kind: SpecialKind,
    multiplicity: usize,
) -> Vec<DirectionOf<E>> {
    match kind {
        SpecialKind::BranchPoint => across(equations, point, multiplicity),
        _ => Vec::new(),
    }
}

/// Cosine of the angle of such a direction with those at the next point of the same curve, at least.
const ALIKE: f64 = 0.95;

/// The special point near another, where it is expected to be shifted.
fn near<E: Plane>(
    equations: &mut E,
    Here { point: last, off, multiplicity, .. }: &Here<E>,
    shift: &DirectionOf<E>,
    kind: SpecialKind,
    limits: &Limits,
) -> Option<(PointOf<E>, Option<DirectionOf<E>>, usize)> {
    let mut reach = REACH;
    let expected = equations.moved(&last.x, &shift.x, 1.0);
    for _ in 0..=DOUBLINGS {
        let sides = [-reach, reach].map(|s| {
            let x = equations.moved(&expected, &last.along.x, s);
            let t = last.t + shift.t + s * last.along.t;
            equations.expect_motions(Some(last.stability.free_motions));
            let guess = Guess { x, t, across: Some(&last.along), sense: Some(&last.along) };
            let mut point = corrected(equations, guess, limits.tolerance, EXACTLY).ok()?.point;
            point.s = s;
            Some(point)
        });
        let [Some(before), Some(after)] = sides else { return None };
        let within = Limits { values: Vec::new(), ..limits.clone() };
        let found = special_points(equations, &before, &after, &within).unwrap_or_default();
        // Near an end of the piece that end is nearly singular, and may be on another branch.
        let inside = |special: &Found<E>| special.kind == kind && special.point.s.abs() < INSIDE * reach;
        for Found { point, multiplicity: count, .. } in found.into_iter().filter(inside) {
            let here = directions(equations, &point, kind, count);
            // Where several branch off they span a plane, of which any may be given.
            let within = |off: &DirectionOf<E>| {
                let parts = here.iter().map(|other| dot(equations, off, other));
                here.is_empty() || parts.map(|part| part * part).sum::<f64>().sqrt() > ALIKE
            };
            if off.as_ref().is_none_or(within) && multiplicity.is_none_or(|known| known == count) {
                return Some((point, here.into_iter().next(), count));
            }
        }
        reach *= 2.0;
    }
    None
}

/// The tangent of the branch that the other parameter gives through the special point.
fn exchanged<E: Plane>(
    equations: &mut E,
    here: &Here<E>,
    held: usize,
    kind: SpecialKind,
) -> Option<DirectionOf<E>> {
    if kind == SpecialKind::Fold {
        // It is a fold either way.
        return Some(Direction { x: here.point.along.x.clone(), t: 0.0 });
    }
    // A little beside, where the equations are regular.
    equations.hold(here.place[1 - held] + BESIDE, held == 1);
    equations.linearise(&here.point.x, here.place[held], None).ok()?;
    let line = equations.line();
    Some(super::equations::unit(equations, &line))
}

/// How far beside.
const BESIDE: f64 = 1e-4;
