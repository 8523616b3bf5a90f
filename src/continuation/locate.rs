//! Special points between two points of a branch.

use super::branch::{Limits, SpecialKind};
use super::correct::{Guess, PointOf, corrected};
use super::equations::{Equations, Failed, Stability};

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
pub fn special_points<E: Equations>(
    equations: &mut E,
    a: &PointOf<E>,
    b: &PointOf<E>,
    limits: &Limits,
) -> Vec<Found<E>> {
    let mut found = Vec::new();
    between(equations, a, b, 0, &mut found);
    for &value in &limits.values {
        let mut ends: Vec<&PointOf<E>> = vec![a];
        ends.extend(found.iter().map(|special| &special.point));
        ends.push(b);
        let met: Vec<_> = ends
            .windows(2)
            .filter(|pair| (pair[0].t - value) * (pair[1].t - value) < 0.0)
            .filter_map(|pair| at_value(equations, pair[0], pair[1], value))
            .collect();
        found.extend(met.into_iter().map(|point| Found { point, kind: SpecialKind::Value, multiplicity: 0 }));
        found.sort_by(|a, b| a.point.s.total_cmp(&b.point.s));
    }
    found
}

/// Bifurcations between two points.
fn between<E: Equations>(
    equations: &mut E,
    a: &PointOf<E>,
    b: &PointOf<E>,
    depth: usize,
    found: &mut Vec<Found<E>>,
) {
    let unstable = [a, b].map(|point| point.stability.section_index);
    let turns = a.along.t * b.along.t < 0.0;
    let index = [a, b].map(|point| point.stability.index);
    let change = index[0].zip(index[1]).map(|(a, b)| b as isize - a as isize);
    let (kind, multiplicity) = if unstable[0] != unstable[1] {
        (SpecialKind::SectionInstability, unstable[0].abs_diff(unstable[1]))
    } else {
        match (turns, change) {
            (true, None | Some(1 | -1)) => (SpecialKind::Fold, 1),
            (true, Some(0)) => (SpecialKind::BranchPoint, 1),
            (false, None | Some(0)) => return,
            (_, Some(change)) => (SpecialKind::BranchPoint, change.unsigned_abs()),
        }
    };
    // Several in one interval are told apart by halves of it.
    let several = depth < DEEPEST && turns && (unstable[0] != unstable[1] || multiplicity > 1);
    if several && let Some(middle) = at(equations, a, b, 0.5 * (b.s - a.s)) {
        between(equations, a, &middle, depth + 1, found);
        between(equations, &middle, b, depth + 1, found);
        return;
    }
    let Some(point) = located(equations, a, b, kind, turns, multiplicity) else { return };
    // Those that are not at the same place.
    let aside = ASIDE * (b.s - a.s);
    let right = (multiplicity > 1 && depth < DEEPEST && point.s + aside < b.s)
        .then(|| at(equations, a, b, point.s + aside - a.s))
        .flatten();
    let changed = |from: &Stability, to: &Stability| match kind {
        SpecialKind::SectionInstability => from.section_index.abs_diff(to.section_index),
        _ => from.index.unwrap_or(0).abs_diff(to.index.unwrap_or(0)),
    };
    let multiplicity =
        right.as_ref().map_or(multiplicity, |right| changed(&a.stability, &right.stability).max(1));
    found.push(Found { point, kind, multiplicity });
    if let Some(right) = right {
        between(equations, &right, b, depth + 1, found);
    }
}

/// How far beside a special point, of the interval it was found in, others are not told from it.
const ASIDE: f64 = 1e-5;

/// The point a `length` from `a` toward `b`.
pub fn at<E: Equations>(
    equations: &mut E,
    a: &PointOf<E>,
    b: &PointOf<E>,
    length: f64,
) -> Option<PointOf<E>> {
    tried(equations, a, b, length).ok()
}

fn tried<E: Equations>(
    equations: &mut E,
    a: &PointOf<E>,
    b: &PointOf<E>,
    length: f64,
) -> Result<PointOf<E>, Failed> {
    let whole = b.s - a.s;
    // From the nearer end, along the tangent that turns from one to the other.
    let (from, to, step) = if length <= 0.5 * whole { (a, b, length) } else { (b, a, length - whole) };
    let turning = 0.5 * step * step.abs() / whole;
    let change = equations.sum(&[(step - turning, &from.along.x), (turning, &to.along.x)]);
    let x = equations.moved(&from.x, &change, 1.0);
    let t = from.t + (step - turning) * from.along.t + turning * to.along.t;
    let guess = Guess { x, t, across: Some(&from.along), sense: Some(&a.along) };
    let mut point = corrected(equations, guess, 1e-11, true)?.point;
    point.s = a.s + length;
    Ok(point)
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
    // Near enough for Newton's method at fixed t.
    for _ in 0..4 {
        let part = (value - a.t) / (b.t - a.t);
        let middle = at(equations, &a, &b, part * (b.s - a.s))?;
        let near = (middle.t - value).abs() < 0.1;
        if near || middle.t == value {
            let guess = Guess { x: middle.x.clone(), t: value, across: None, sense: Some(&a.along) };
            let mut point = corrected(equations, guess, 1e-11, true).ok()?.point;
            (point.t, point.s) = (value, middle.s);
            return Some(point);
        }
        if (middle.t - value) * (a.t - value) < 0.0 { b = middle } else { a = middle }
    }
    None
}

/// The place of a change between two points.
///
/// Both sides are told apart by what changes, and a secant tells where to look: of the determinant at a branch point, to the power at
/// which it grows in proportion. At the point itself the equations are singular, and near it another branch is as near: the last
/// step, along the tangent, is not corrected.
fn located<E: Equations>(
    equations: &mut E,
    a: &PointOf<E>,
    b: &PointOf<E>,
    kind: SpecialKind,
    turns: bool,
    multiplicity: usize,
) -> Option<PointOf<E>> {
    let start = a.stability.clone();
    let before = |point: &PointOf<E>| match kind {
        SpecialKind::SectionInstability => point.stability.section_index == start.section_index,
        _ if turns => point.along.t * a.along.t > 0.0,
        _ => point.stability.index == start.index,
    };
    let function = |point: &PointOf<E>| match kind {
        SpecialKind::SectionInstability => point.stability.section,
        _ if turns => point.along.t,
        _ => {
            let log = (point.stability.log_determinant - start.log_determinant) / multiplicity as f64;
            // Where it is not known halves are left.
            let size = if log.is_nan() { 1.0 } else { log.exp() };
            if before(point) { size } else { -size }
        }
    };
    let (mut low, mut high) = (a.clone(), b.clone());
    let (mut f_low, mut f_high) = (function(a), function(b));
    // The last two points that were tried.
    let mut tried: Vec<(PointOf<E>, f64)> = Vec::new();
    for tries in 0..MOST {
        let length = high.s - low.s;
        let mut step = 0.5 * length;
        let smooth = f_low * f_high < 0.0;
        if smooth && tries % 4 != 3 {
            step = length * f_low / (f_low - f_high);
        }
        if let [(before, f_before), (last, f_last)] =
            tried.as_slice().last_chunk::<2>().map_or(&[][..], |last| last)
        {
            let gap = last.s - before.s;
            let ahead = -f_last * gap / (f_last - f_before);
            let place = last.s + ahead;
            let inside = low.s < place && place < high.s;
            // The error of a secant is of the order of the product.
            if inside && (ahead * gap).abs() < EXACT || length < NEAREST {
                let ahead = if inside { ahead } else { 0.0 };
                let mut point = last.clone();
                point.x = equations.moved(&last.x, &last.along.x, ahead);
                point.t += ahead * last.along.t;
                point.s += ahead;
                return Some(point);
            }
            if inside && smooth && tries % 4 != 3 {
                step = place - low.s;
            }
        }
        let step = step.clamp(1e-3 * length, 0.999 * length);
        let found = at(equations, &low, &high, step).or_else(|| at(equations, &low, &high, 0.5 * length));
        let Some(point) = found else { break };
        let value = function(&point);
        if before(&point) {
            // Illinois: the value of an end that stays is halved.
            (low, f_low, f_high) = (point.clone(), value, 0.5 * f_high);
        } else {
            (high, f_high, f_low) = (point.clone(), value, 0.5 * f_low);
        }
        tried.push((point, value));
    }
    tried.pop().map(|(point, _)| point)
}

/// Product of the last two steps of a search that is small enough.
const EXACT: f64 = 1e-12;
/// An interval that is no longer divided.
const NEAREST: f64 = 1e-7;
