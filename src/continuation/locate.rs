//! Special points between two points of a branch.

use super::branch::{Limits, SpecialKind};
use super::correct::{Guess, PointOf, corrected};
use super::equations::{Direction, Equations, Failed, Stability, unit};

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
            // Without a potential the sign of the determinant tells of an odd number.
            (false, None) if sign_changes(a, b) => (SpecialKind::BranchPoint, 1),
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
    let Some(point) = located(equations, a, b, kind, turns) else { return };
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

/// Whether the determinant has another sign, where it is known.
fn sign_changes<S, C>(a: &super::Point<S, C>, b: &super::Point<S, C>) -> bool {
    let signs = a.stability.determinant.zip(b.stability.determinant);
    signs.is_some_and(|(a, b)| a.sign * b.sign < 0.0)
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
    let turning = if equations.on_one_mesh(&a.x, &b.x) { 0.5 * step * step.abs() / whole } else { 0.0 };
    let parts = [(step - turning, &from.along.x), (turning, &to.along.x)];
    let change = equations.sum(if turning == 0.0 { &parts[..1] } else { &parts });
    let x = equations.moved(&from.x, &change, 1.0);
    let t = from.t + (step - turning) * from.along.t + turning * to.along.t;
    equations.expect_motions(Some(from.stability.free_motions));
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
) -> Option<PointOf<E>> {
    let start = a.stability.clone();
    let before = |point: &PointOf<E>| match kind {
        SpecialKind::SectionInstability => point.stability.section_index == start.section_index,
        _ if turns => point.along.t * a.along.t > 0.0,
        // Without a potential the determinant decides alone.
        _ if start.index.is_none() => !sign_changes(a, point),
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
    let (mut low, mut high) = (a.clone(), b.clone());
    let mut tried: Vec<PointOf<E>> = Vec::new();
    let mut lengths = [f64::INFINITY; 2];
    for _ in 0..MOST {
        let length = high.s - low.s;
        let multiplicity = index(&low).abs_diff(index(&high)).max(1);
        let value = |point: &PointOf<E>| (point.s, function(point, multiplicity));
        let mut place = low.s + length * value(&low).1 / (value(&low).1 - value(&high).1);
        if let Some([one, two, three]) = tried.last_chunk() {
            let (there, error) = root(&[value(one), value(two), value(three)]);
            // The index may be late by rounding.
            let inside = low.s - NEAREST < there && there < high.s + NEAREST;
            if inside && error < EXACT || length < NEAREST {
                return Some(between_two(equations, two, three, if inside { there } else { three.s }));
            }
            place = there;
        }
        // By halves where the interval does not shrink so fast.
        let inside = low.s < place && place < high.s;
        if !inside || length > 0.5 * lengths[0] {
            place = low.s + 0.5 * length;
        }
        lengths = [lengths[1], length];
        let found =
            at(equations, &low, &high, place - low.s).or_else(|| at(equations, &low, &high, 0.5 * length));
        let Some(point) = found else { break };
        if before(&point) {
            low = point.clone()
        } else {
            high = point.clone()
        }
        tried.push(point);
    }
    tried.pop()
}

/// The root of a function by inverse quadratic interpolation of three values, and an estimate of its error.
fn root(values: &[(f64, f64); 3]) -> (f64, f64) {
    let [(a, fa), (b, fb), (c, fc)] = *values;
    let secant = c - fc * (c - b) / (fc - fb);
    let quadratic = a * fb * fc / ((fa - fb) * (fa - fc))
        + b * fa * fc / ((fb - fa) * (fb - fc))
        + c * fa * fb / ((fc - fa) * (fc - fb));
    let distances = [a, b, c].map(|place| (place - quadratic).abs());
    // Of the order of the distances' product, and of what the last value changes times the last distance.
    let error = distances.iter().product::<f64>().max((quadratic - secant).abs() * distances[2]);
    (quadratic, error)
}

/// The point at `s` near two others, by their tangents; it is not corrected.
fn between_two<E: Equations>(equations: &mut E, a: &PointOf<E>, b: &PointOf<E>, s: f64) -> PointOf<E> {
    let whole = b.s - a.s;
    let step = s - b.s;
    // From b, along the tangent that turns to that at a.
    let turning = -0.5 * step * step / whole;
    let change = equations.sum(&[(step - turning, &b.along.x), (turning, &a.along.x)]);
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
    let [from, to] = [b, a].map(|point| whole * point.along.t);
    let (rise, bend) = (a.t - b.t + from, to - from);
    point.t = b.t + y * (from + y * (3.0 * rise + bend + y * (2.0 * rise + bend)));
    point.s = s;
    point
}

/// Estimate of an error of a search that is small enough.
const EXACT: f64 = 1e-12;
/// An interval that is no longer divided.
const NEAREST: f64 = 1e-7;
