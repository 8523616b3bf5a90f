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
    /// How fast the mode that vanishes there changes with the parameter.
    pub slope: Option<f64>,
}

/// Evaluations of a search that are too many.
const MOST: usize = 60;
/// Error of the parameter that is small enough.
const TOLERANCE: f64 = 2e-12;
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
        found.extend(met.into_iter().map(|point| Found {
            point,
            kind: SpecialKind::Value,
            multiplicity: 0,
            slope: None,
        }));
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
    let Some((point, slope)) = located(equations, a, b, kind, turns) else { return };
    let slope = slope.filter(|_| kind == SpecialKind::BranchPoint && !turns);
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
    found.push(Found { point, kind, multiplicity, slope });
    if let Some(right) = right {
        between(equations, &right, b, depth + 1, found);
    }
}

/// How far beside a special point, of the interval it was found in, others are not told from it.
const ASIDE: f64 = 1e-5;

/// The mode that is the first to change sign.
fn first_mode<S, C>(a: &super::Point<S, C>, b: &super::Point<S, C>) -> usize {
    let negative =
        |point: &super::Point<S, C>| point.stability.modes().iter().filter(|mode| **mode < 0.0).count();
    negative(a).min(negative(b))
}

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

/// The place of a change between two points, and the slope there of a function that vanishes: what is on its two sides decides, a smooth function of it where to look.
fn located<E: Equations>(
    equations: &mut E,
    a: &PointOf<E>,
    b: &PointOf<E>,
    kind: SpecialKind,
    turns: bool,
) -> Option<(PointOf<E>, Option<f64>)> {
    let first = a.stability.clone();
    let mode = first_mode(a, b);
    let function = |point: &PointOf<E>| match kind {
        SpecialKind::SectionInstability => point.stability.section,
        _ if turns => point.along.t,
        _ => point.stability.modes().get(mode).copied().unwrap_or(0.0),
    };
    let before = |point: &PointOf<E>| match kind {
        SpecialKind::SectionInstability => point.stability.section_index == first.section_index,
        _ if turns => point.along.t * a.along.t > 0.0,
        _ => point.stability.index == first.index,
    };
    let (mut low, mut high) = (a.clone(), b.clone());
    let (mut f_low, mut f_high) = (function(a), function(b));
    let mut best: Option<PointOf<E>> = None;
    let (mut last, mut slope) = (None, None);
    for tries in 0..MOST {
        let length = high.s - low.s;
        let smooth = f_low * f_high < 0.0;
        let secant = length * f_low / (f_low - f_high);
        // Now and then by halves, lest one end stays.
        let step =
            if smooth && tries % 4 != 3 { secant.clamp(1e-3 * length, 0.999 * length) } else { 0.5 * length };
        let Some(mut point) = at(equations, &low, &high, step) else {
            return best.map(|best| (best, slope));
        };
        point.s = low.s + step;
        let value = function(&point);
        let moved = best
            .as_ref()
            .map_or(f64::INFINITY, |best| (best.t - point.t).abs() + 1e-3 * (best.s - point.s).powi(2));
        let far = best.as_ref().map_or(f64::INFINITY, |best| (best.s - point.s).abs());
        let is_before = before(&point);
        best = Some(point.clone());
        if let Some((t, before)) = last.replace((point.t, value)) {
            slope = Some((value - before) / (point.t - t))
                .filter(|slope| slope.is_finite() && *slope != 0.0)
                .or(slope);
        }
        if is_before {
            // Illinois: the value of an end that stays is halved.
            (low, f_low, f_high) = (point, value, 0.5 * f_high);
        } else {
            (high, f_high, f_low) = (point, value, 0.5 * f_low);
        }
        if value == 0.0 || far < 1e-9 && moved < TOLERANCE || (high.s - low.s) < 1e-11 || turns && far < 1e-6
        {
            break;
        }
    }
    best.map(|best| (best, slope))
}
