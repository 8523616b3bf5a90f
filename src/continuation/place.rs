//! Where something changes between two points of a branch.

use super::advance::TURN;
use super::between::{at, between_tangents, between_two, in_plane};
use super::branch::{Limits, SpecialKind};
use super::change::Change;
use super::correct::{EXACTLY, PointOf};
use super::equations::{Equations, dot};
use super::locate::unlike;
use super::near_miss::{around, pass_by};
use super::root::{MEMORY, monotone, root};

/// Evaluations of a search that are too many.
const MOST: usize = 60;

/// Estimate of an error of a search that is small enough, and the same of the tolerance of points.
const EXACT: f64 = 2e-12;
const LOCATED: f64 = 0.05;
/// The same of the distance from the ends of the interval.
const FROM_ENDS: f64 = 0.1;
/// Steps from beyond so many of the distances at which values are taken come from afar.
const FAR: f64 = 4.0;
/// Of the parameter, where rounding keeps it larger, and the same of the tolerance of points.
const ROUNDING: f64 = 1e-10;
const KEPT: f64 = 0.1;
/// An interval that is no longer divided.
const NEAREST: f64 = 1e-7;

/// The same over how far they are apart along a branch, at most.
const GAP: f64 = 3.0;
/// An interval in which places are measured along its first tangent, and how far beyond the place of a change it is to end.
const SHORT: f64 = 0.05;
const BEYOND: f64 = 0.4 * SHORT;
/// A ratio of values at its ends by which it is rather divided by halves.
const EVEN: f64 = 0.01;
/// How far around a root values are taken.
const SPREAD: f64 = 1.5e-3;
/// How well the place is known, of that, once it is asked whether two branches meet there, and how far it may be from where those points tell.
const KNOWN: f64 = 0.25;
const WITHIN: f64 = 0.4;

/// The place of a change between two points.
///
/// Both sides are told apart by what changes. Where to look is told by inverse interpolation of what vanishes there. At the point itself
/// the equations are singular, and another branch is as near: values are taken around it, and the last step, along the tangents, is
/// not corrected.
pub fn located<E: Equations>(
    equations: &mut E,
    [a, b]: [&PointOf<E>; 2],
    change: (SpecialKind, usize),
    turns: bool,
    limits: &Limits,
) -> Option<PointOf<E>> {
    let change = Change::between([a, b], change, turns);
    let mut seen = vec![a.clone(), b.clone()];
    let [low, high] = narrowed(equations, &change, &mut seen)?;
    // Else what changes, changes from one branch to another, or on another.
    let others = change.simple && (unlike(a, &low) || unlike(&high, b));
    if others || gap(equations, &low, &high) > GAP * (high.s - low.s) {
        return None;
    }
    polished(equations, &change, [&low, &high], &seen, limits)
}

/// The ends of a short interval in which the change is, from the first two points that were seen, with those between them: to where rotations add as
/// vectors do, a little beyond where the change is expected, or by halves.
fn narrowed<E: Equations>(
    equations: &mut E,
    change: &Change,
    seen: &mut Vec<PointOf<E>>,
) -> Option<[PointOf<E>; 2]> {
    let (mut low, mut high) = (seen[0].clone(), seen[1].clone());
    let mut lengths = [f64::INFINITY; 2];
    while high.s - low.s > SHORT {
        let length = high.s - low.s;
        let multiplicity = change.multiplicity([&low, &high]);
        let value = |point: &PointOf<E>| (point.s, change.value(point, multiplicity));
        let ends = [&low, &high].map(value);
        let (place, error) = root(&monotone(&seen.iter().map(value).collect::<Vec<_>>(), ends));
        let ratio = (ends[0].1 / ends[1].1).abs();
        let half = 0.5 * (low.s + high.s);
        let even = EVEN < ratio && ratio < 1.0 / EVEN;
        let next = if length > 0.5 * lengths[0] || !even {
            half
        } else if error < BEYOND {
            place + BEYOND.copysign(half - place)
        } else {
            place
        };
        let ahead = if low.s < next && next < high.s { next } else { half } - low.s;
        lengths = [lengths[1], length];
        let middle = at(equations, &low, &high, ahead)?;
        if change.is_ahead_of(&middle) {
            low = middle.clone()
        } else {
            high = middle.clone()
        }
        seen.push(middle);
    }
    Some([low, high])
}

/// The place of the change in a short interval.
fn polished<E: Equations>(
    equations: &mut E,
    change: &Change,
    [a, b]: [&PointOf<E>; 2],
    seen: &[PointOf<E>],
    limits: &Limits,
) -> Option<PointOf<E>> {
    let (mut low, mut high) = (a.clone(), b.clone());
    // Places are measured along the tangent at a, at right angles to which all points are corrected: b's may be a little less.
    let beside = |equations: &mut E, tried: &[PointOf<E>], s: f64, spread: f64| {
        // All by steps from a, on which their places depend a little, toward the end that is not as near.
        [s, s - 0.3 * spread, s + 0.3 * spread].into_iter().find_map(|s| {
            let apart = |point: &&PointOf<E>| (point.s - s).abs();
            let from = tried.iter().chain([a]).min_by(|p, q| apart(p).total_cmp(&apart(q)))?;
            let to = if from.s - a.s < b.s - from.s { b } else { a };
            // From afar the guess is not as good.
            let aside = if apart(&from) < FAR * spread { EXACTLY } else { EXACT };
            in_plane(equations, (from, to), s, (&a.along, aside), a)
        })
    };
    let narrow = |[low, high]: [&mut PointOf<E>; 2], point: &PointOf<E>| {
        if low.s < point.s && point.s < high.s {
            *(if change.is_ahead_of(point) { low } else { high }) = point.clone();
        }
    };
    let mut tried: Vec<PointOf<E>> = Vec::new();
    let mut lengths = [f64::INFINITY; 2];
    let mut previous: Option<f64> = None;
    let mut spread = SPREAD.min(0.1 * (b.s - a.s));
    // The least error so far, its place, and how many values it is of; the least with values taken as near as now, and the two times before, and whether that helped.
    let mut best = (f64::INFINITY, 0.0, 0);
    let (mut least, mut rounding) = ([f64::INFINITY; 3], false);
    // Whether two branches meet there, as far as can be told.
    let mut meet = change.kind != SpecialKind::BranchPoint;
    for _ in 0..MOST {
        let length = high.s - low.s;
        let multiplicity = change.multiplicity([&low, &high]);
        let value = |point: &PointOf<E>| (point.s, change.value(point, multiplicity));
        // By the last values near the root; the first time by those before.
        let (place, error) = root(&if tried.len() < 2 {
            monotone(&seen.iter().map(value).collect::<Vec<_>>(), [&low, &high].map(value))
        } else {
            tried.iter().rev().take(MEMORY).map(value).collect()
        });
        let error = previous.map_or(error, |before| error.max((place - before).abs()));
        previous = Some(place);
        let inside = low.s - NEAREST < place && place < high.s + NEAREST;
        if tried.len() >= MEMORY && inside {
            least[2] = error.min(least[2]);
            if error < best.0 {
                best = (error, place, tried.len());
            }
        }
        if !meet && (error < KNOWN * spread || length < KNOWN * spread) {
            let (places, apart) = around(place, spread, limits);
            let before = tried.len();
            for s in places {
                tried.push(beside(equations, &tried, s, apart)?);
            }
            let points = tried.split_off(before);
            // Farther ones may lie beyond other special points.
            let (refined, error) = root(&points.iter().map(value).collect::<Vec<_>>());
            let near = apart == spread && (refined - place).abs() < WITHIN * spread;
            let place = if near { refined } else { place };
            if points.iter().any(|point| dot(equations, &a.along, &point.along) < TURN)
                || pass_by(equations, &points, place, change.from_the_side, limits)
            {
                return None;
            }
            meet = true;
            if near {
                points.iter().for_each(|point| narrow([&mut low, &mut high], point));
                tried.extend(points);
                if low.s < place && place < high.s && error < best.0 {
                    best = (error, place, tried.len());
                }
            }
        }
        // Around the root, not at it: there the equations are singular, and another branch is as near.
        let near = tried.iter().filter(|point| (point.s - place).abs() < 2.0 * spread).count();
        if near >= MEMORY {
            spread *= 0.4;
            // What does not get better nearer the root is rounding.
            rounding = least[1].min(least[2]) > 0.5 * least[0]
                && best.0 * a.along.t.abs().max(b.along.t.abs()) < ROUNDING.max(KEPT * limits.tolerance);
            least = [least[0].min(least[1]), least[2], f64::INFINITY];
        }
        // Next to an end that is itself next to a root values agree on that one, until they are taken as near.
        let from_ends = (best.1 - a.s).abs().min((b.s - best.1).abs());
        let enough = EXACT.max((LOCATED * limits.tolerance).min(FROM_ENDS * from_ends));
        // What was told of another root before.
        if !(low.s - NEAREST..=high.s + NEAREST).contains(&best.1) {
            best.0 = f64::INFINITY;
        }
        if meet && best.0.is_finite() && (best.0 < enough || rounding) {
            if gap(equations, &low, &high) > GAP * (high.s - low.s).max(NEAREST) {
                return None;
            }
            // Nearer ones did not help.
            tried.truncate(best.2);
            let apart = |point: &PointOf<E>| (point.s - best.1).abs();
            tried.sort_by(|p, q| apart(p).total_cmp(&apart(q)));
            // Of two that are too near to each other rounding is what they tell.
            let near = &tried[0];
            let other = tried.iter().find(|other| (other.s - near.s).abs() > 0.5 * apart(near));
            let mut point = between_two(equations, other.unwrap_or(&tried[1]), near, best.1, &a.along);
            if change.kind == SpecialKind::BranchPoint && !change.turns {
                // So near the other branch the least error, as of the mesh, turns the tangent toward it.
                point.along = between_tangents(equations, a, b, (point.s - a.s) / (b.s - a.s));
            }
            return Some(point);
        }
        if length < NEAREST {
            let one = meet && gap(equations, &low, &high) < GAP * NEAREST;
            return if one { tried.pop() } else { None };
        }
        let mut next = place + [0.5, -0.5, 1.0, -1.0, 1.5][near % MEMORY] * spread;
        // By halves where the interval does not shrink so fast, and is not small yet, and where the values tell of a root elsewhere.
        let inside = low.s < next && next < high.s;
        let slow = length > 8.0 * spread && length > 0.5 * lengths[0];
        let astray = place.is_nan() || place < low.s - spread || place > high.s + spread;
        if slow || astray || !inside && length > 4.0 * spread {
            next = 0.5 * (low.s + high.s);
        }
        let next = next.clamp(low.s - spread, high.s + spread).clamp(a.s, b.s);
        lengths = [lengths[1], length];
        let point = beside(equations, &tried, next, spread)?;
        narrow([&mut low, &mut high], &point);
        tried.push(point);
    }
    None
}

/// How far apart two points are in space.
fn gap<E: Equations>(equations: &mut E, a: &PointOf<E>, b: &PointOf<E>) -> f64 {
    let [from, to] = [a, b].map(|point| equations.coordinates(&point.x, point.t));
    from.iter().zip(&to).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max)
}
