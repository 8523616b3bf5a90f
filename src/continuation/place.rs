//! Where something changes between two points of a branch.

use super::advance::TURN;
use super::between::{at, between_tangents, between_two, in_plane};
use super::branch::{Limits, SpecialKind};
use super::correct::{Corrected, EXACTLY, Guess, PointOf, corrected};
use super::equations::{Equations, dot};
use super::locate::{signs, unlike};
use super::near_miss::{around, pass_by};

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
/// Values by which a root is interpolated, and how far around it they are taken.
const MEMORY: usize = 5;
const SPREAD: f64 = 1.5e-3;
/// How well the place is known, of that, once it is asked whether two branches meet there, and how far it may be from where those points tell.
const KNOWN: f64 = 0.25;
const WITHIN: f64 = 0.4;

/// How far Newton's method at a value may go, of the distance from the ends of the interval: a branch that crosses this one at an end is as far.
const NEAR: f64 = 0.02;

/// The point between at this value of the parameter.
pub fn at_value<E: Equations>(
    equations: &mut E,
    a: &PointOf<E>,
    b: &PointOf<E>,
    value: f64,
) -> Option<PointOf<E>> {
    if let Some(end) = [a, b].into_iter().find(|end| end.t == value) {
        return Some(end.clone());
    }
    let ends = [a.s, b.s];
    let (mut a, mut b) = (a.clone(), b.clone());
    for trial in 0..MOST {
        // By a secant, then by halves: next to a fold the parameter is not linear.
        let part = if trial < 4 { (value - a.t) / (b.t - a.t) } else { 0.5 };
        let middle = at(equations, &a, &b, part * (b.s - a.s))?;
        let most = NEAR * (middle.s - ends[0]).min(ends[1] - middle.s);
        let missed = (middle.t - value).abs();
        if missed < most * middle.along.t.abs() {
            let guess = Guess { x: middle.x.clone(), t: value, across: None, sense: Some(&middle.along) };
            let there = corrected(equations, guess, 1e-11, EXACTLY).ok().filter(|c| c.first < 2.0 * most);
            if let Some(Corrected { point, .. }) = there {
                let slope = 0.5 * (middle.along.t + point.along.t);
                return Some(PointOf::<E> { t: value, s: middle.s + (value - middle.t) / slope, ..point });
            }
        }
        if missed < EXACT || b.s - a.s < NEAREST {
            return Some(middle);
        }
        if (middle.t - value) * (a.t - value) < 0.0 { b = middle } else { a = middle }
    }
    None
}

/// The place of a change between two points.
///
/// Both sides are told apart by what changes. Where to look is told by inverse interpolation of what vanishes there: the change of
/// the parameter at a fold, of the determinant at a branch point to the power at which it grows in proportion. At the point itself
/// the equations are singular, and another branch is as near: values are taken around it, and the last step, along the tangents, is
/// not corrected.
pub fn located<E: Equations>(
    equations: &mut E,
    [a, b]: [&PointOf<E>; 2],
    (kind, multiplicity): (SpecialKind, usize),
    turns: bool,
    limits: &Limits,
) -> Option<PointOf<E>> {
    let start = a.stability.clone();
    let simple = kind == SpecialKind::BranchPoint && multiplicity == 1;
    let from_the_side = simple && turns;
    // Where two branches cross the determinant changes its sign. From the side where the parameter turns tells less: what keeps them apart moves
    // that by its third root.
    let crosses = simple && signs(a, b) < 0.0;
    let turns = turns && !crosses;
    let before = |point: &PointOf<E>| match kind {
        SpecialKind::SectionInstability => point.stability.section_index == start.section_index,
        _ if turns => point.along.t * a.along.t > 0.0,
        _ if crosses => signs(a, point) >= 0.0,
        _ => point.stability.index == start.index,
    };
    let function = |point: &PointOf<E>, multiplicity: usize| match kind {
        SpecialKind::SectionInstability => point.stability.section,
        _ if turns => point.along.t,
        _ => {
            let side = if before(point) { 1.0 } else { -1.0 };
            // Where the determinant is not known halves are left.
            let Some((here, first)) = point.stability.determinant.zip(start.determinant) else { return side };
            let size = ((here.log - first.log) / multiplicity as f64).exp();
            // Of an even multiplicity, or where its sign is not known, it has none.
            let sign = if multiplicity.is_multiple_of(2) { 0.0 } else { here.sign * first.sign };
            size * if sign == 0.0 { side } else { sign }
        }
    };
    let index = |point: &PointOf<E>| point.stability.index.unwrap_or(0);
    let multiplicity = |low: &PointOf<E>, high: &PointOf<E>| match crosses {
        true => 1,
        false => index(low).abs_diff(index(high)).max(1),
    };
    let (mut low, mut high) = (a.clone(), b.clone());
    // To where rotations add as vectors do: a little beyond where the change is expected, or by halves.
    let (mut seen, mut lengths) = (vec![low.clone(), high.clone()], [f64::INFINITY; 2]);
    while high.s - low.s > SHORT {
        let length = high.s - low.s;
        let multiplicity = multiplicity(&low, &high);
        let value = |point: &PointOf<E>| (point.s, function(point, multiplicity));
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
        if before(&middle) {
            low = middle.clone()
        } else {
            high = middle.clone()
        }
        seen.push(middle);
    }
    // Else what changes, changes from one branch to another, or on another.
    if simple && (unlike(a, &low) || unlike(&high, b)) || gap(equations, &low, &high) > GAP * (high.s - low.s)
    {
        return None;
    }
    let (a, b) = (low.clone(), high.clone());
    // Places are measured along the tangent at a, at right angles to which all points are corrected: b's may be a little less.
    let beside = |equations: &mut E, tried: &[PointOf<E>], s: f64, spread: f64| {
        // All by steps from a, on which their places depend a little, toward the end that is not as near.
        [s, s - 0.3 * spread, s + 0.3 * spread].into_iter().find_map(|s| {
            let apart = |point: &&PointOf<E>| (point.s - s).abs();
            let from = tried.iter().chain([&a]).min_by(|p, q| apart(p).total_cmp(&apart(q)))?;
            let to = if from.s - a.s < b.s - from.s { &b } else { &a };
            // From afar the guess is not as good.
            let aside = if apart(&from) < FAR * spread { EXACTLY } else { EXACT };
            in_plane(equations, (from, to), s, (&a.along, aside), &a)
        })
    };
    let narrow = |[low, high]: [&mut PointOf<E>; 2], point: &PointOf<E>| {
        if low.s < point.s && point.s < high.s {
            *(if before(point) { low } else { high }) = point.clone();
        }
    };
    let mut tried: Vec<PointOf<E>> = Vec::new();
    let mut lengths = [f64::INFINITY; 2];
    let mut previous = f64::NAN;
    let mut spread = SPREAD.min(0.1 * (b.s - a.s));
    // The least error so far, its place, and how many values it is of; the least with values taken as near as now, and the two times before, and whether that helped.
    let mut best = (f64::INFINITY, 0.0, 0);
    let (mut least, mut rounding) = ([f64::INFINITY; 3], false);
    // Whether two branches meet there, as far as can be told.
    let mut meet = kind != SpecialKind::BranchPoint;
    for _ in 0..MOST {
        let length = high.s - low.s;
        let multiplicity = multiplicity(&low, &high);
        let value = |point: &PointOf<E>| (point.s, function(point, multiplicity));
        // By the last values near the root; the first time by those before.
        let (place, error) = root(&if tried.len() < 2 {
            monotone(&seen.iter().map(value).collect::<Vec<_>>(), [&low, &high].map(value))
        } else {
            tried.iter().rev().take(MEMORY).map(value).collect()
        });
        let error = error.max((place - previous).abs());
        previous = place;
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
                || pass_by(equations, &points, place, from_the_side, limits)
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
            if kind == SpecialKind::BranchPoint && !turns {
                // So near the other branch the least error, as of the mesh, turns the tangent toward it.
                point.along = between_tangents(equations, &a, &b, (point.s - a.s) / (b.s - a.s));
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

/// Of values of a function, with two of opposite sign, the nearest to those that are monotone outward from them: by the others another root is
/// told.
fn monotone(values: &[(f64, f64)], [low, high]: [(f64, f64); 2]) -> Vec<(f64, f64)> {
    let mut known = vec![low, high];
    for (end, outward) in [(low, -1.0), (high, 1.0)] {
        let distance = |value: &(f64, f64)| outward * (value.0 - end.0);
        let mut beyond: Vec<_> = values.iter().filter(|value| distance(value) > 0.0).collect();
        beyond.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
        let mut last = end.1;
        known.extend(
            beyond.into_iter().take_while(|value| value.1 / std::mem::replace(&mut last, value.1) > 1.0),
        );
    }
    let middle = 0.5 * (low.0 + high.0);
    known[2..].sort_by(|a, b| (a.0 - middle).abs().total_cmp(&(b.0 - middle).abs()));
    known.truncate(MEMORY);
    known
}

/// The root of a function by inverse interpolation of its values, and an estimate of its error: by how much the last value counts, or the third.
fn root(values: &[(f64, f64)]) -> (f64, f64) {
    let interpolated = |values: &[(f64, f64)]| -> f64 {
        (0..values.len())
            .map(|i| {
                let others = (0..values.len()).filter(|k| *k != i);
                values[i].0 * others.map(|k| values[k].1 / (values[k].1 - values[i].1)).product::<f64>()
            })
            .sum()
    };
    let place = interpolated(values);
    let without = |dropped: usize| {
        let others: Vec<_> = (0..values.len()).filter(|k| *k != dropped).map(|k| values[k]).collect();
        (place - interpolated(&others)).abs()
    };
    let last = values.len() - 1;
    (place, if last == 1 { (values[1].0 - values[0].0).abs() } else { without(last).max(without(2)) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_beyond_another_root_tell_of_that() {
        let ends = [(0.4, 1.0), (0.7, -2.1)];
        // The determinant turns back at 0.8.
        let values =
            [(0.4, 1.0), (1.0, -0.01), (0.97, -2.7), (0.7, -2.1), (0.2, 1.5), (0.1, 1.2), (0.8, -2.8)];
        assert_eq!(monotone(&values, ends), [ends[0], ends[1], (0.8, -2.8), (0.2, 1.5)]);
        let cube = |s: f64| (s, (s - 0.5).powi(3) + 0.1 * (s - 0.5));
        let values: Vec<_> = [0.3, 0.42, 0.53, 0.6, 0.8].map(cube).to_vec();
        let known = monotone(&values, [values[1], values[2]]);
        assert_eq!(known.len(), MEMORY);
        let (place, error) = root(&known);
        assert!((place - 0.5).abs() < error && error < 2e-2, "{place} {error}");
        // Of two values any place between is the root.
        assert_eq!(root(&known[..2]).1, values[2].0 - values[1].0);
    }
}
