//! Onto the branches that meet at a branch point.

use super::branch::Limits;
use super::correct::{DirectionOf, EXACTLY, Guess, Point, PointOf, corrected};
use super::equations::{Direction, Equations, dot, plus, scaled, unit};

/// A step off a branch point of multiplicity one.
#[derive(Clone, Debug)]
pub struct Off<S, C> {
    /// Across the branch.
    pub direction: Direction<C>,
    /// The first point in that direction.
    pub point: Point<S, C>,
}

/// The step of a problem.
pub type OffOf<E> = Off<<E as Equations>::State, <E as Equations>::Change>;

/// First points of the branches that leave a branch point along others than the one it was found on, one of mirror images.
pub struct Leaving<E: Equations> {
    /// The point.
    pub point: PointOf<E>,
    /// Whether a mirror image leaves, too.
    pub mirrored: bool,
}

/// Change of the parameter along a unit direction below which it is from the side.
pub const FROM_THE_SIDE: f64 = 1e-3;
/// The step off the branch, and how often it is halved where Newton's method fails.
const STEP: f64 = 0.05;
const HALVINGS: usize = 6;
/// How far a branch bends away within the step, of that, that is little.
const LITTLE: f64 = 0.012;
/// Directions that are tried where more than two branches may meet.
const SPOKES: usize = 12;
/// Relative difference of what mirror images have in common.
const ALIKE: f64 = 1e-6;

/// Steps off a branch point of some multiplicity, one of which may be known.
pub fn leaving<E: Equations>(
    equations: &mut E,
    at: &PointOf<E>,
    multiplicity: usize,
    off: Option<Box<OffOf<E>>>,
    limits: &Limits,
) -> Vec<Leaving<E>> {
    let (across, known) = match off.filter(|_| multiplicity == 1) {
        Some(off) => (vec![off.direction], Some(off.point)),
        None => (across(equations, at, multiplicity), None),
    };
    let directions = match across.as_slice() {
        [] => Vec::new(),
        [one] => {
            let mut both = vec![(one.clone(), known), (scaled(equations, one, -1.0), None)];
            // Toward greater parameters first, where the two differ in that.
            if one.t < -FROM_THE_SIDE {
                both.reverse();
            }
            both
        }
        // A free motion turns one into all others.
        [one, ..] if at.stability.free_motions > 0 => vec![(one.clone(), None)],
        [first, second, ..] => (0..SPOKES)
            .map(|i| {
                let (sin, cos) = (2.0 * std::f64::consts::PI * i as f64 / SPOKES as f64).sin_cos();
                (plus(equations, &scaled(equations, first, cos), sin, second), None)
            })
            .collect(),
    };
    steps(equations, at, directions, limits)
}

/// Steps in some directions, where they are not known, one of mirror images.
fn steps<E: Equations>(
    equations: &mut E,
    at: &PointOf<E>,
    directions: Vec<(DirectionOf<E>, Option<PointOf<E>>)>,
    limits: &Limits,
) -> Vec<Leaving<E>> {
    let mut found: Vec<(Leaving<E>, Vec<f64>)> = Vec::new();
    for (direction, known) in directions {
        let Some(point) = known.or_else(|| stepped(equations, at, &direction, limits)) else { continue };
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
    steps(equations, at, vec![(direction, None), (back, None)], limits)
}

/// Whether two lists of invariants are of mirror images.
pub fn alike(a: &[f64], b: &[f64]) -> bool {
    let size = a.iter().chain(b).fold(1.0, |m: f64, x| m.max(x.abs()));
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() <= ALIKE * size)
}

/// Unit directions at right angles to the branch, and to its free motions, in which the equations are singular.
pub fn across<E: Equations>(equations: &mut E, at: &PointOf<E>, multiplicity: usize) -> Vec<DirectionOf<E>> {
    let motions = at.stability.free_motions;
    let mut known = vec![at.along.clone()];
    if motions > 0 {
        // A little before, where the equations are singular for no other reason.
        let x = equations.moved(&at.x, &at.along.x, -BEFORE);
        let aside = at.t - BEFORE * at.along.t;
        extend(equations, &x, aside, &at.along, (motions + 1, motions + 1), &mut known);
    }
    let first = known.len();
    extend(equations, &at.x, at.t, &at.along, (multiplicity + known.len(), first + multiplicity), &mut known);
    known.split_off(first)
}

/// How far before a branch point.
const BEFORE: f64 = 1e-3;

/// Extends orthonormal directions, to at most so many, by those in which the equations are most nearly singular.
fn extend<E: Equations>(
    equations: &mut E,
    x: &E::State,
    t: f64,
    along: &DirectionOf<E>,
    (singular, most): (usize, usize),
    known: &mut Vec<DirectionOf<E>>,
) {
    if equations.linearise(x, t, Some(along)).is_err() {
        return;
    }
    let kernel = equations.kernel(singular);
    let mut left: Vec<DirectionOf<E>> = kernel.iter().map(|direction| unit(equations, direction)).collect();
    while known.len() < most {
        // Where one branch changes the ribbon much more than the other does all of them are nearly along it: twice, and the largest first.
        for direction in &mut left {
            for other in known.iter().chain(known.iter()) {
                let part = dot(equations, direction, other);
                *direction = plus(equations, direction, -part, other);
            }
        }
        let sizes: Vec<f64> = left.iter().map(|direction| dot(equations, direction, direction)).collect();
        let Some(largest) = (0..left.len()).max_by(|&i, &k| sizes[i].total_cmp(&sizes[k])) else { return };
        if sizes[largest] < NOTHING {
            return;
        }
        known.push(unit(equations, &left.swap_remove(largest)));
    }
}

/// Square of what is left of a unit direction that is nothing.
const NOTHING: f64 = 1e-12;

/// The first point in a direction: where it bends little, if nearer ones bend less, for so near shapes are those of buckling and need no
/// finer mesh.
pub fn stepped<E: Equations>(
    equations: &mut E,
    at: &PointOf<E>,
    direction: &DirectionOf<E>,
    limits: &Limits,
) -> Option<PointOf<E>> {
    let mut step = STEP;
    let mut found: Option<(PointOf<E>, f64)> = None;
    for _ in 0..HALVINGS {
        let x = equations.moved(&at.x, &direction.x, step);
        let guess =
            Guess { x, t: at.t + step * direction.t, across: Some(direction), sense: Some(direction) };
        // A branch may have motions that the one it leaves has not.
        equations.expect_motions(None);
        if let Ok(done) = corrected(equations, guess, limits.tolerance, EXACTLY)
            && done.first < 0.5 * step
            && (0.0..=1.0).contains(&done.point.t)
        {
            let bend = done.first / step;
            if found.as_ref().is_some_and(|(_, before)| bend > 0.5 * before) {
                break;
            }
            let mut point = done.point;
            point.s = step;
            found = Some((point, bend));
            if bend < LITTLE {
                break;
            }
        }
        step *= 0.5;
    }
    found.map(|(point, _)| point)
}
