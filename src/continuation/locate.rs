//! Special points between two points of a branch.

use super::advance::TURN;
use super::branch::{Limits, SpecialKind};
use super::correct::{
    Corrected, DirectionOf, EXACTLY, Guess, Point, PointOf, arclength, corrected, difference,
};
use super::equations::{Direction, Equations, Failed, Stability, dot, plus, scaled, unit};
use super::walk::MOST_DISTINCT;

/// A special point that was found.
pub struct Found<E: Equations> {
    /// Where.
    pub point: PointOf<E>,
    /// What.
    pub kind: SpecialKind,
    /// By how much the index, or that of sections, changes.
    pub multiplicity: usize,
}

/// Evaluations of a search that are too many.
const MOST: usize = 60;
/// Depth to which an interval with several special points is divided.
const DEEPEST: usize = 12;

/// The special points between two points, in order.
///
/// # Errors
/// Where there is one that is not found: the two are too far apart.
pub fn special_points<E: Equations>(
    equations: &mut E,
    a: &PointOf<E>,
    b: &PointOf<E>,
    limits: &Limits,
) -> Result<Vec<Found<E>>, Failed> {
    let mut found = Vec::new();
    between(equations, a, b, limits, 0, &mut found)?;
    let mut ends: Vec<&PointOf<E>> = vec![a];
    ends.extend(found.iter().map(|special| &special.point));
    ends.push(b);
    let values = values_between(equations, &ends, limits)?;
    found.extend(values);
    found.sort_by(|a, b| a.point.s.total_cmp(&b.point.s));
    Ok(found)
}

/// The values asked for that are met between points in a row.
///
/// # Errors
/// If one is not found.
pub fn values_between<E: Equations>(
    equations: &mut E,
    points: &[&PointOf<E>],
    limits: &Limits,
) -> Result<Vec<Found<E>>, Failed> {
    let mut found = Vec::new();
    for &value in &limits.values {
        for pair in points.windows(2).filter(|pair| (pair[0].t - value) * (pair[1].t - value) < 0.0) {
            let point = at_value(equations, pair[0], pair[1], value).ok_or(Failed::Jumped)?;
            found.push(Found { point, kind: SpecialKind::Value, multiplicity: 1 });
        }
    }
    Ok(found)
}

/// Bifurcations between two points.
fn between<E: Equations>(
    equations: &mut E,
    a: &PointOf<E>,
    b: &PointOf<E>,
    limits: &Limits,
    depth: usize,
    found: &mut Vec<Found<E>>,
) -> Result<(), Failed> {
    let Some((kind, multiplicity)) = change(a, b) else { return Ok(()) };
    let unstable = [a, b].map(|point| point.stability.section_index);
    let turns = a.along.t * b.along.t < 0.0;
    // Several in one interval are told apart by halves of it.
    let several = depth < DEEPEST && turns && (unstable[0] != unstable[1] || multiplicity > 1);
    if several && let Some(middle) = at(equations, a, b, 0.5 * (b.s - a.s)) {
        between(equations, a, &middle, limits, depth + 1, found)?;
        return between(equations, &middle, b, limits, depth + 1, found);
    }
    let point = located(equations, [a, b], (kind, multiplicity), turns, limits).ok_or(Failed::Jumped)?;
    let changed = |from: &Stability, to: &Stability| match kind {
        SpecialKind::SectionInstability => from.section_index.abs_diff(to.section_index),
        _ => from.index.unwrap_or(0).abs_diff(to.index.unwrap_or(0)),
    };
    // Those that are not at the same place: as near as what changes here is told beyond it, or as near as may be.
    let mut right = None;
    for part in ASIDE.iter().filter(|_| multiplicity > 1 && depth < DEEPEST) {
        let s = point.s + part * (b.s - a.s);
        let beyond = if s < b.s { at(equations, a, b, s - a.s) } else { None };
        let told = beyond.as_ref().is_some_and(|beyond| changed(&a.stability, &beyond.stability) > 0);
        if told || right.is_none() {
            right = beyond;
        }
        if told {
            break;
        }
    }
    let multiplicity =
        right.as_ref().map_or(multiplicity, |right| changed(&a.stability, &right.stability).max(1));
    found.push(Found { point, kind, multiplicity });
    right.map_or(Ok(()), |right| between(equations, &right, b, limits, depth + 1, found))
}

/// What changes between two points, and by how much the index, or that of sections.
fn change<S, C>(a: &Point<S, C>, b: &Point<S, C>) -> Option<(SpecialKind, usize)> {
    let unstable = [a, b].map(|point| point.stability.section_index);
    if unstable[0] != unstable[1] {
        return Some((SpecialKind::SectionInstability, unstable[0].abs_diff(unstable[1])));
    }
    let turns = a.along.t * b.along.t < 0.0;
    let sign = signs(a, b);
    let index = a.stability.index.zip(b.stability.index);
    // The determinant tells whether the index changes by an odd number: next to a fold, and to a branch point from the side, it is that of
    // rounding.
    let change = index.map(|(a, b)| match b.abs_diff(a) {
        change if sign != 0.0 && turns == (sign < 0.0) && change % 2 == 1 => change - 1,
        change if sign != 0.0 && turns != (sign < 0.0) && change % 2 == 0 => change + 1,
        change => change,
    });
    match (turns, change) {
        // Without a potential the sign of the determinant tells of an odd number; beyond a section instability it changes with
        // every section.
        (_, None) if unstable == [0, 0] && sign < 0.0 => Some((SpecialKind::BranchPoint, 1)),
        (true, None | Some(1)) => Some((SpecialKind::Fold, 1)),
        (true, Some(0)) => Some((SpecialKind::BranchPoint, 1)),
        (false, None | Some(0)) => None,
        (_, Some(change)) => Some((SpecialKind::BranchPoint, change)),
    }
}

/// Whether there is a special point between two, other than values of the parameter.
pub fn unlike<S, C>(a: &Point<S, C>, b: &Point<S, C>) -> bool {
    change(a, b).is_some()
}

/// The product of the signs of the determinants; 0 if one is not known.
fn signs<S, C>(a: &Point<S, C>, b: &Point<S, C>) -> f64 {
    a.stability.determinant.zip(b.stability.determinant).map_or(0.0, |(a, b)| a.sign * b.sign)
}

/// How far beside a special point, of the interval it was found in, others are not told from it.
const ASIDE: [f64; 4] = [1e-5, 1e-4, 1e-3, 1e-2];

/// The point a `length` from `a` toward `b`, across the tangent that turns from one to the other.
pub fn at<E: Equations>(
    equations: &mut E,
    a: &PointOf<E>,
    b: &PointOf<E>,
    length: f64,
) -> Option<PointOf<E>> {
    let part = length / (b.s - a.s);
    let (from, to) = if part <= 0.5 { (a, b) } else { (b, a) };
    let across = if equations.on_one_mesh(&a.x, &b.x) {
        plus(equations, &scaled(equations, &a.along, 1.0 - part), part, &b.along)
    } else {
        from.along.clone()
    };
    let s = a.s + length;
    let mut point = stepped_along(equations, (from, to), s - from.s, &across, a)?.0;
    point.s = s;
    Some(point)
}

/// The point at a place that is measured along a direction, in the plane across it, by a step from a point whose place is known toward
/// another.
fn in_plane<E: Equations>(
    equations: &mut E,
    (from, to): (&PointOf<E>, &PointOf<E>),
    place: f64,
    across: &DirectionOf<E>,
    sense: &PointOf<E>,
) -> Option<PointOf<E>> {
    let (mut point, moved) = stepped_along(equations, (from, to), place - from.s, across, sense)?;
    point.s = from.s + moved;
    Some(point)
}

/// A step from one of two points toward, or away from, the other, corrected across a direction: the point, and how far it is along that
/// direction.
fn stepped_along<E: Equations>(
    equations: &mut E,
    (from, to): (&PointOf<E>, &PointOf<E>),
    step: f64,
    across: &DirectionOf<E>,
    sense: &PointOf<E>,
) -> Option<(PointOf<E>, f64)> {
    let change = if equations.on_one_mesh(&from.x, &to.x) && to.s != from.s {
        on_cubic(equations, from, to, step / (to.s - from.s))
    } else {
        scaled(equations, &from.along, step)
    };
    let x = equations.moved(&from.x, &change.x, 1.0);
    let moved = dot(equations, across, &change);
    equations.expect_motions(Some(from.stability.free_motions));
    let guess = Guess { x, t: from.t + change.t, across: Some(across), sense: Some(&sense.along) };
    Some((corrected(equations, guess, 1e-11, EXACTLY).ok()?.point, moved))
}

/// The change from a point to part of the way to another, on Hermite's cubic that has their tangents.
fn on_cubic<E: Equations>(
    equations: &mut E,
    from: &PointOf<E>,
    to: &PointOf<E>,
    part: f64,
) -> DirectionOf<E> {
    let change = difference(equations, from, to);
    let arriving = equations.added(&change.x, &to.along.x);
    let length = arclength(equations, [from, to], &change).copysign(to.s - from.s);
    let (left, square) = (1.0 - part, part * part);
    let weights = [length * part * left * left, square * (3.0 - 2.0 * part), -length * square * left];
    let parts = [(weights[0], &from.along.x), (weights[1], &change.x), (weights[2], &arriving)];
    let t = weights[0] * from.along.t + weights[1] * change.t + weights[2] * to.along.t;
    Direction { x: equations.sum(&parts), t }
}

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
    let (mut a, mut b) = (a.clone(), b.clone());
    let mut by_newton = true;
    for trial in 0..MOST {
        // By a secant, then by halves: next to a fold the parameter is not linear.
        let part = if trial < 4 { (value - a.t) / (b.t - a.t) } else { 0.5 };
        let middle = at(equations, &a, &b, part * (b.s - a.s))?;
        // From near enough by Newton's method at this value; at a fold or a branch point that fails.
        if by_newton && (middle.t - value).abs() < 0.1 {
            by_newton = false;
            let guess = Guess { x: middle.x.clone(), t: value, across: None, sense: Some(&middle.along) };
            let there = corrected(equations, guess, 1e-11, EXACTLY).ok().filter(|c| c.first < b.s - a.s);
            if let Some(Corrected { mut point, .. }) = there {
                (point.t, point.s) = (value, middle.s);
                return Some(point);
            }
        }
        if (middle.t - value).abs() < EXACT || b.s - a.s < NEAREST {
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
fn located<E: Equations>(
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
        let known: Vec<_> =
            seen.iter().rev().take(MEMORY).map(|point| (point.s, function(point, multiplicity))).collect();
        let place = root(&known).0;
        let next = place + BEYOND.copysign(0.5 * (low.s + high.s) - place);
        let good = low.s < next && next < high.s && length <= 0.5 * lengths[0];
        let ahead = if good { next - low.s } else { 0.5 * length };
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
            in_plane(equations, (from, to), s, &a.along, &a)
        })
    };
    let narrow = |[low, high]: [&mut PointOf<E>; 2], point: &PointOf<E>| {
        if low.s < point.s && point.s < high.s {
            *(if before(point) { low } else { high }) = point.clone();
        }
    };
    let mut tried: Vec<PointOf<E>> = Vec::new();
    let mut lengths = [f64::INFINITY; 2];
    let mut previous = f64::INFINITY;
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
        // By the last values near the root; the first time by those at the ends.
        let mut known: Vec<(f64, f64)> = tried.iter().rev().take(MEMORY).map(&value).collect();
        if known.len() < 2 {
            known = vec![value(&low), value(&high)];
        }
        let (place, error) = root(&known);
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
            let apart = spread.max(CORNERS * unresolved(limits).sqrt());
            let mut around = Vec::with_capacity(AROUND.len());
            for part in AROUND {
                around.push(beside(equations, &tried, place + part * apart, apart)?);
            }
            if around.iter().any(|point| dot(equations, &a.along, &point.along) < TURN)
                || from_the_side && !is_singular(&around)
                || miss(equations, &around, place) > unresolved(limits)
            {
                return None;
            }
            meet = true;
            let (place, error) = root(&around.iter().map(value).collect::<Vec<_>>());
            around.iter().for_each(|point| narrow([&mut low, &mut high], point));
            tried.extend(around);
            if low.s < place && place < high.s && error < best.0 {
                best = (error, place, tried.len());
            }
        }
        // Around the root, not at it: there the equations are singular, and another branch is as near.
        let near = tried.iter().filter(|point| (point.s - place).abs() < 2.0 * spread).count();
        if near >= MEMORY {
            spread *= 0.4;
            // What does not get better nearer the root is rounding.
            rounding = least[1].min(least[2]) > 0.5 * least[0]
                && best.0 * a.along.t.abs().max(b.along.t.abs()) < ROUNDING;
            least = [least[0].min(least[1]), least[2], f64::INFINITY];
        }
        if meet && (best.0 < EXACT.max(LOCATED * limits.tolerance) || rounding) {
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
        // By halves where the interval does not shrink so fast, and is not small yet.
        let inside = low.s < next && next < high.s;
        let slow = length > 8.0 * spread && length > 0.5 * lengths[0];
        if slow || !inside && length > 4.0 * spread {
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

/// What keeps two branches apart that pass by each other at a place, as the half axis of a hyperbola squared: what is not smooth in points
/// around it, `x(s) = p(s) + miss/(s - place)`, by their last divided difference.
fn miss<E: Equations>(equations: &mut E, points: &[PointOf<E>], place: f64) -> f64 {
    let first = &points[0];
    let whole: f64 = points.iter().map(|point| place - point.s).product();
    let others = |i: usize| (0..points.len()).filter(move |k| *k != i);
    let weight = |i: usize| whole / others(i).map(|k| points[i].s - points[k].s).product::<f64>();
    let changes: Vec<DirectionOf<E>> =
        points.iter().map(|point| difference(equations, first, point)).collect();
    let parts: Vec<_> = changes.iter().enumerate().map(|(i, change)| (weight(i), &change.x)).collect();
    let t = changes.iter().enumerate().map(|(i, change)| weight(i) * change.t).sum();
    let miss = Direction { x: equations.sum(&parts), t };
    dot(equations, &miss, &miss).sqrt()
}

/// What keeps branches apart, the same, that is not told from the error of points and of their mesh.
fn unresolved(limits: &Limits) -> f64 {
    limits.tolerance.min(2.0 * MOST_DISTINCT)
}

/// Whether the equations become singular between points around a place, where they are known to: they do not at a fold.
fn is_singular<S, C>(around: &[Point<S, C>]) -> bool {
    let sizes = around[0].stability.determinant.zip(around[around.len() / 2].stability.determinant);
    sizes.is_none_or(|(outer, inner)| outer.log - inner.log > SINGULAR)
}

/// How far apart two points are in space.
fn gap<E: Equations>(equations: &mut E, a: &PointOf<E>, b: &PointOf<E>) -> f64 {
    let [from, to] = [a, b].map(|point| equations.coordinates(&point.x, point.t));
    from.iter().zip(&to).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max)
}

/// The same over how far they are apart along a branch, at most.
const GAP: f64 = 3.0;
/// An interval in which places are measured along its first tangent, and how far beyond the place of a change it is to end.
const SHORT: f64 = 0.05;
const BEYOND: f64 = 0.4 * SHORT;
/// Values by which a root is interpolated, and how far around it they are taken.
const MEMORY: usize = 5;
const SPREAD: f64 = 1e-3;
/// Where values are taken that tell whether two branches meet, of how far, once the place is known to so much of that.
const AROUND: [f64; 6] = [-1.5, -1.0, -0.5, 0.5, 1.0, 1.5];
const KNOWN: f64 = 0.1;
/// How far that is at least, of the size of the corners that keep branches apart which are not told from none.
const CORNERS: f64 = 10.0;
/// By how much the logarithm of the determinant at least grows from the inner of them to the outer where it vanishes between, a third as near.
const SINGULAR: f64 = 0.5;

/// The root of a function by inverse interpolation of its values, and an estimate of its error: by how much the last value counts.
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
    (place, (place - interpolated(&values[..values.len() - 1])).abs())
}

/// The unit tangent of Hermite's cubic part of the way from one point to another. They are so near that rotations add as vectors do, which leaves an
/// error of second order in their distance.
fn between_tangents<E: Equations>(
    equations: &mut E,
    a: &PointOf<E>,
    b: &PointOf<E>,
    part: f64,
) -> DirectionOf<E> {
    let change = difference(equations, a, b);
    let length = arclength(equations, [a, b], &change);
    let square = part * part;
    let weights =
        [1.0 - 4.0 * part + 3.0 * square, 6.0 * (part - square) / length, 3.0 * square - 2.0 * part];
    let parts = [(weights[0], &a.along.x), (weights[1], &change.x), (weights[2], &b.along.x)];
    let t = weights[0] * a.along.t + weights[1] * change.t + weights[2] * b.along.t;
    let x = equations.sum(&parts);
    unit(equations, &Direction { x, t })
}

/// The point near two others at a place measured along a direction, by their tangents; it is not corrected.
fn between_two<E: Equations>(
    equations: &mut E,
    a: &PointOf<E>,
    b: &PointOf<E>,
    place: f64,
    across: &DirectionOf<E>,
) -> PointOf<E> {
    let whole = b.s - a.s;
    let step = place - b.s;
    // What the place changes by along the tangents.
    let [rate_a, rate_b] = [a, b].map(|point| 1.0 / dot(equations, across, &point.along));
    // From b, along the tangent that turns to that at a.
    let turning = -0.5 * step * step / whole;
    let parts = [((step - turning) * rate_b, &b.along.x), (turning * rate_a, &a.along.x)];
    let change = equations.sum(&parts);
    let mut point = b.clone();
    point.x = equations.moved(&b.x, &change, 1.0);
    let y = step / whole;
    point.along = unit(
        equations,
        &Direction {
            x: equations.sum(&[(1.0 + y, &b.along.x), (-y, &a.along.x)]),
            t: (1.0 + y) * b.along.t - y * a.along.t,
        },
    );
    // Hermite's cubic.
    let [from, to] = [(b, rate_b), (a, rate_a)].map(|(point, rate)| whole * rate * point.along.t);
    let (rise, bend) = (a.t - b.t + from, to - from);
    point.t = b.t + y * (from + y * (3.0 * rise + bend + y * (2.0 * rise + bend)));
    point.s = place;
    point
}

/// Estimate of an error of a search that is small enough, and the same of the tolerance of points.
const EXACT: f64 = 2e-12;
const LOCATED: f64 = 0.05;
/// Of the parameter, where rounding keeps it larger.
const ROUNDING: f64 = 1e-10;
/// An interval that is no longer divided.
const NEAREST: f64 = 1e-7;
