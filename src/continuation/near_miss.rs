//! Two branches that pass by each other: what keeps them apart.
//!
//! Something small that keeps two branches from meeting makes them hyperbolas next to where they would meet: along one the other
//! direction is `h/s`. A step may cross from one to the other as if they met, and nothing on both sides tells; but what is not smooth in
//! points between does.

use super::branch::Limits;
use super::correct::{DirectionOf, Point, PointOf, difference};
use super::equations::{Direction, Equations, dot};
use super::walk::MOST_DISTINCT;

/// How far around a place points are taken that tell, of a spread.
const AROUND: [f64; 6] = [-1.5, -1.0, -0.5, 0.5, 1.0, 1.5];
/// What that is at least, of the size of the corners that keep branches apart which are not told from none.
const CORNERS: f64 = 10.0;
/// By how much the logarithm of the determinant at least grows from the inner of them to the outer where it vanishes between, a third as near.
const SINGULAR: f64 = 0.5;

/// The places around one, so far apart, that tell whether two branches meet there; and how far apart they are.
pub fn around(place: f64, spread: f64, limits: &Limits) -> ([f64; 6], f64) {
    let spread = spread.max(CORNERS * unresolved(limits).sqrt());
    (AROUND.map(|part| place + part * spread), spread)
}

/// Whether two branches pass by each other at a place, by the points around it; from the side, what is met may also be a fold.
pub fn pass_by<E: Equations>(
    equations: &mut E,
    around: &[PointOf<E>],
    place: f64,
    from_the_side: bool,
    limits: &Limits,
) -> bool {
    from_the_side && !is_singular(around) || miss(equations, around, place) > unresolved(limits)
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
