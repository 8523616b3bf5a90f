//! Special points between two points of a branch.

use super::between::at;
use super::branch::{Limits, SpecialKind};
use super::correct::{Point, PointOf};
use super::equations::{Equations, Failed, Stability};
use super::place::located;
use super::switch::OffOf;
use super::value::at_value;

/// A special point that was found.
pub struct Found<E: Equations> {
    /// Where.
    pub point: PointOf<E>,
    /// What.
    pub kind: SpecialKind,
    /// By how much the index, or that of sections, changes.
    pub multiplicity: usize,
    /// A step off a branch point, if one was made.
    pub off: Option<Box<OffOf<E>>>,
}

/// Depth to which an interval with several special points is divided, and how many in a row are not noise.
const DEEPEST: usize = 12;
const MANY_IN_A_ROW: usize = 100;

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
            found.push(Found { point, kind: SpecialKind::Value, multiplicity: 1, off: None });
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
    if kind == SpecialKind::SectionInstability && hides(equations, [a, b], &point) {
        return Err(Failed::Jumped);
    }
    let changed = |from: &Stability, to: &Stability| match kind {
        SpecialKind::SectionInstability => from.section_index.abs_diff(to.section_index),
        _ => from.index.unwrap_or(0).abs_diff(to.index.unwrap_or(0)),
    };
    // Those that are not at the same place: as near as what changes here is told beyond it, or as near as may be.
    let (mut right, mut told) = (None, false);
    for part in ASIDE.iter().filter(|_| multiplicity > 1 && depth < DEEPEST) {
        let s = point.s + part * (b.s - a.s);
        let beyond = if s < b.s { at(equations, a, b, s - a.s) } else { None };
        told = beyond.as_ref().is_some_and(|beyond| changed(&a.stability, &beyond.stability) > 0);
        if told || right.is_none() {
            right = beyond;
        }
        if told {
            break;
        }
    }
    let multiplicity =
        right.as_ref().map_or(multiplicity, |right| changed(&a.stability, &right.stability).max(1));
    found.push(Found { point, kind, multiplicity, off: None });
    // Many in a row are no deeper than one, up to as many as may be noise.
    let deeper = depth + usize::from(!told || found.len() >= MANY_IN_A_ROW);
    right.map_or(Ok(()), |right| between(equations, &right, b, limits, deeper, found))
}

/// Whether other special points lie between a section instability and that of two points where sections are stable: the index there
/// is another, or is not told, as where the mesh, or the step, is too coarse for a soft section. As a section softens they crowd: where
/// the index is large already no more are looked for.
fn hides<E: Equations>(equations: &mut E, [a, b]: [&PointOf<E>; 2], point: &PointOf<E>) -> bool {
    let stable = match [a, b].map(|end| end.stability.section_index) {
        [0, _] => a,
        [_, 0] => b,
        _ => return false,
    };
    let Some(index) = stable.stability.index.filter(|index| *index < MANY) else { return false };
    if (stable.s - point.s).abs() < NEAREST {
        return false;
    }
    let mut told = false;
    for part in NEARBY {
        let s = point.s + part * (stable.s - point.s);
        let beside = if a.s < s && s < b.s { at(equations, a, b, s - a.s) } else { None };
        let stability = beside.map(|beside| beside.stability).filter(|there| there.section_index == 0);
        if let Some(there) = stability.and_then(|there| there.index) {
            if there != index {
                return true;
            }
            told = true;
        }
    }
    !told
}

/// How far beside a section instability the index is looked at, of the way to a point.
const NEARBY: [f64; 4] = [0.3, 0.03, 3e-3, 3e-4];
/// A distance in which nothing is looked for.
const NEAREST: f64 = 1e-6;
/// An index that is large: after so many ways to buckle the others before the section instability are passed over.
const MANY: usize = 10;

/// What changes between two points, and by how much the index, or that of sections.
fn change<S, C>(a: &Point<S, C>, b: &Point<S, C>) -> Option<(SpecialKind, usize)> {
    let unstable = [a, b].map(|point| point.stability.section_index);
    if unstable[0] != unstable[1] {
        return Some((SpecialKind::SectionInstability, unstable[0].abs_diff(unstable[1])));
    }
    let turns = a.along.t * b.along.t < 0.0;
    let sign = a.stability.signs(&b.stability);
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

/// How far beside a special point, of the interval it was found in, others are not told from it.
const ASIDE: [f64; 4] = [1e-5, 1e-4, 1e-3, 1e-2];
