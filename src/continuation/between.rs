//! Points between two points of a branch, by Hermite's cubic.

use super::correct::{DirectionOf, EXACTLY, Guess, PointOf, arclength, corrected, difference};
use super::equations::{Direction, Equations, dot, plus, scaled, unit};

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
    let mut point = stepped_along(equations, (from, to), s - from.s, (&across, EXACTLY), a)?.0;
    point.s = s;
    Some(point)
}

/// The point at a place that is measured along a direction, in the plane across it, by a step from a point whose place is known toward
/// another; its stability is taken no farther aside than this.
pub fn in_plane<E: Equations>(
    equations: &mut E,
    (from, to): (&PointOf<E>, &PointOf<E>),
    place: f64,
    (across, aside): (&DirectionOf<E>, f64),
    sense: &PointOf<E>,
) -> Option<PointOf<E>> {
    let (mut point, moved) = stepped_along(equations, (from, to), place - from.s, (across, aside), sense)?;
    point.s = from.s + moved;
    Some(point)
}

/// A step from one of two points toward, or away from, the other, corrected across a direction: the point, and how far it is along that
/// direction.
fn stepped_along<E: Equations>(
    equations: &mut E,
    (from, to): (&PointOf<E>, &PointOf<E>),
    step: f64,
    (across, aside): (&DirectionOf<E>, f64),
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
    Some((corrected(equations, guess, 1e-11, aside).ok()?.point, moved))
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

/// The unit tangent of Hermite's cubic part of the way from one point to another. They are so near that rotations add as vectors do, which leaves an
/// error of second order in their distance.
pub fn between_tangents<E: Equations>(
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
pub fn between_two<E: Equations>(
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
