//! The point of a branch at a value of the parameter.

use super::between::at;
use super::correct::{Corrected, EXACTLY, Guess, PointOf, corrected};
use super::equations::Equations;

/// Trials that are too many, and those by secants.
const MOST: usize = 60;
const SECANTS: usize = 4;
/// Error of the parameter that is small enough, and an interval that is no longer divided.
const EXACT: f64 = 2e-12;
const NEAREST: f64 = 1e-7;
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
        let part = if trial < SECANTS { (value - a.t) / (b.t - a.t) } else { 0.5 };
        let Some(middle) = at(equations, &a, &b, part * (b.s - a.s)) else {
            return directly(equations, [&a, &b], value);
        };
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

/// The same by Newton's method at the value, from along the tangents of both, where the way along the branch fails, as next to a section that becomes
/// unstable.
fn directly<E: Equations>(equations: &mut E, ends: [&PointOf<E>; 2], value: f64) -> Option<PointOf<E>> {
    let [a, b] = ends;
    ends.into_iter().filter(|end| end.along.t.abs() > STEEP).find_map(|end| {
        let length = (value - end.t) / end.along.t;
        let x = equations.moved(&end.x, &end.along.x, length);
        equations.expect_motions(Some(end.stability.free_motions));
        let guess = Guess { x, t: value, across: None, sense: Some(&end.along) };
        let found = corrected(equations, guess, 1e-11, EXACTLY).ok()?;
        let part = (value - a.t) / (b.t - a.t);
        let s = a.s + part * (b.s - a.s);
        (found.first < NEAR * (b.s - a.s)).then_some(PointOf::<E> { t: value, s, ..found.point })
    })
}

/// Change of the parameter along a branch, of its arclength, above which its value tells where.
const STEEP: f64 = 1e-2;
