//! Onto the branches that meet at a branch point.

use super::branch::Limits;
use super::correct::{DirectionOf, Guess, PointOf, corrected};
use super::equations::{Equations, dot, plus, scaled, unit};

/// First points of the branches that leave a branch point along others than the one it was found on, one of mirror images.
pub struct Leaving<E: Equations> {
    /// The point.
    pub point: PointOf<E>,
    /// Whether a mirror image leaves, too.
    pub mirrored: bool,
}

/// The step off the branch, and how often it is halved where Newton's method fails.
const STEP: f64 = 0.05;
const HALVINGS: usize = 6;
/// Directions that are tried where more than two branches may meet.
const SPOKES: usize = 12;
/// Relative difference of what mirror images have in common.
const ALIKE: f64 = 1e-6;

/// Steps off a branch point of some multiplicity.
pub fn leaving<E: Equations>(
    equations: &mut E,
    at: &PointOf<E>,
    multiplicity: usize,
    limits: &Limits,
) -> Vec<Leaving<E>> {
    let across = across(equations, at, multiplicity);
    let directions: Vec<DirectionOf<E>> = match across.as_slice() {
        [] => Vec::new(),
        [one] => vec![one.clone(), scaled(equations, one, -1.0)],
        [first, second, ..] => (0..SPOKES)
            .map(|i| {
                let (sin, cos) = (2.0 * std::f64::consts::PI * i as f64 / SPOKES as f64).sin_cos();
                plus(equations, &scaled(equations, first, cos), sin, second)
            })
            .collect(),
    };
    steps(equations, at, &directions, limits)
}

/// Steps in some directions, one of mirror images.
fn steps<E: Equations>(
    equations: &mut E,
    at: &PointOf<E>,
    directions: &[DirectionOf<E>],
    limits: &Limits,
) -> Vec<Leaving<E>> {
    let mut found: Vec<(Leaving<E>, Vec<f64>)> = Vec::new();
    for direction in directions {
        let Some(point) = stepped(equations, at, direction, limits) else { continue };
        let mut numbers = equations.invariants(&point.x, point.t);
        numbers.push(point.t);
        match found.iter_mut().find(|(_, known)| alike(known, &numbers)) {
            Some((known, _)) => known.mirrored = true,
            None => found.push((Leaving { point, mirrored: false }, numbers)),
        }
    }
    found.into_iter().map(|(leaving, _)| leaving).collect()
}

/// The step off a branch where a section becomes unstable, the same all along the ribbon.
pub fn leaving_with_section<E: Equations>(
    equations: &mut E,
    at: &PointOf<E>,
    limits: &Limits,
) -> Vec<Leaving<E>> {
    let Some(direction) = equations.section_direction(&at.x, at.t) else { return Vec::new() };
    let direction = unit(equations, &direction);
    let back = scaled(equations, &direction, -1.0);
    steps(equations, at, &[direction, back], limits)
}

/// Whether two lists of invariants are of mirror images.
pub fn alike(a: &[f64], b: &[f64]) -> bool {
    let size = a.iter().chain(b).fold(1.0, |m: f64, x| m.max(x.abs()));
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() <= ALIKE * size)
}

/// Unit directions at right angles to the branch in which the equations are singular.
pub fn across<E: Equations>(equations: &mut E, at: &PointOf<E>, multiplicity: usize) -> Vec<DirectionOf<E>> {
    if equations.linearise(&at.x, at.t, Some(&at.along)).is_err() {
        return Vec::new();
    }
    let kernel = equations.kernel(multiplicity + 1);
    let mut across: Vec<DirectionOf<E>> = Vec::new();
    for direction in kernel {
        let mut direction = unit(equations, &direction);
        for known in std::iter::once(&at.along).chain(&across.clone()) {
            let part = dot(equations, &direction, known);
            direction = plus(equations, &direction, -part, known);
        }
        // What is left of the tangent itself is nothing.
        if dot(equations, &direction, &direction) > 1e-4 && across.len() < multiplicity {
            across.push(unit(equations, &direction));
        }
    }
    across
}

/// The first point in a direction.
pub fn stepped<E: Equations>(
    equations: &mut E,
    at: &PointOf<E>,
    direction: &DirectionOf<E>,
    limits: &Limits,
) -> Option<PointOf<E>> {
    let mut step = STEP;
    for _ in 0..HALVINGS {
        let x = equations.moved(&at.x, &direction.x, step);
        let guess =
            Guess { x, t: at.t + step * direction.t, across: Some(direction), sense: Some(direction) };
        if let Ok(done) = corrected(equations, guess, limits.tolerance, true)
            && done.first < 0.5 * step
        {
            let mut point = done.point;
            point.s = step;
            return Some(point);
        }
        step *= 0.5;
    }
    None
}
