//! Newton's method across a branch: to the point of it in a plane.

use super::equations::{Direction, Equations, Failed, Stability, dot, plus, scaled, unit};

/// An equilibrium on a branch.
#[derive(Clone, Debug)]
pub struct Point<S, C> {
    /// The state.
    pub x: S,
    /// The parameter.
    pub t: f64,
    /// Arclength from the first point of the branch.
    pub s: f64,
    /// The unit tangent.
    pub along: Direction<C>,
    /// Its stability.
    pub stability: Stability,
}

/// The point of a problem.
pub type PointOf<E> = Point<<E as Equations>::State, <E as Equations>::Change>;
/// The direction of a problem.
pub type DirectionOf<E> = Direction<<E as Equations>::Change>;

/// The point on its branch the other way.
pub fn reversed<E: Equations>(equations: &E, mut point: PointOf<E>) -> PointOf<E> {
    point.along = scaled(equations, &point.along, -1.0);
    // With the plane that it is the determinant with.
    if let Some(determinant) = &mut point.stability.determinant {
        determinant.sign = -determinant.sign;
    }
    point
}

/// The change from one point to another on the same mesh.
pub fn difference<E: Equations>(equations: &mut E, from: &PointOf<E>, to: &PointOf<E>) -> DirectionOf<E> {
    Direction { x: equations.difference(&from.x, &to.x), t: to.t - from.t }
}

/// The arclength between two points, from their difference and their tangents: that of a cubic but for terms of the fifth order.
pub fn arclength<E: Equations>(
    equations: &E,
    [from, to]: [&PointOf<E>; 2],
    difference: &DirectionOf<E>,
) -> f64 {
    let turned = 1.0 - dot(equations, &from.along, &to.along);
    dot(equations, difference, difference).sqrt() * (1.0 + turned / 12.0)
}

/// Where a correction starts, and across what it goes.
pub struct Guess<'a, E: Equations> {
    /// State.
    pub x: E::State,
    /// Parameter.
    pub t: f64,
    /// The plane at right angles to it is not left; `None` for fixed `t`.
    pub across: Option<&'a DirectionOf<E>>,
    /// The sense of the tangent.
    pub sense: Option<&'a DirectionOf<E>>,
}

/// What a correction leads to.
pub struct Corrected<E: Equations> {
    /// The equilibrium.
    pub point: PointOf<E>,
    /// Size of the first correction: the error of the guess.
    pub first: f64,
    /// Size of the last with new factors: how far from the equilibrium its tangent and stability were taken.
    pub aside: f64,
}

/// Linearisations that are too many.
const ITERATIONS: usize = 10;
/// After a correction below this, more with the same factors are tried, as many as this as long as each is below a tenth of the last.
const SMALL: f64 = 1e-2;
const CHORDS: usize = 4;
const FAST: f64 = 0.1;
/// How far from the equilibrium its tangent and stability may be taken: for the next step, and for their own sake. Next to a branch point
/// the tangent changes with that a thousand times as much.
pub const ROUGHLY: f64 = 1e-5;
pub const EXACTLY: f64 = 1e-10;
/// The same of forces, which buckle a ribbon whatever its shape, over that of shapes.
const FORCES: f64 = 1e3;
/// Below this corrections that no longer shrink are rounding, which a branch point near by amplifies along the other branch.
const ROUNDING: [f64; 2] = [1e-8, 1e-7];

/// The equilibrium near a guess, to `tolerance`. Tangent and stability are those where the equations were last linearised, at most `aside`
/// of it, or, if Newton's method has not come as near in half of its steps, where rounding keeps it.
///
/// # Errors
/// Where Newton's method fails.
pub fn corrected<E: Equations>(
    equations: &mut E,
    guess: Guess<'_, E>,
    tolerance: f64,
    aside: f64,
) -> Result<Corrected<E>, Failed> {
    let Guess { mut x, mut t, across, sense } = guess;
    let negligible = ROUNDING[usize::from(aside < ROUGHLY)];
    let (mut before, mut first, mut off) = (f64::INFINITY, f64::INFINITY, f64::INFINITY);
    for iteration in 0..ITERATIONS {
        equations.linearise(&x, t, across)?;
        let line = equations.line();
        // To where the line of solutions meets the plane.
        let step = |equations: &mut E| {
            let some = equations.particular();
            let (ahead, slope) = match across {
                Some(across) => (dot(equations, across, &some), dot(equations, across, &line)),
                None => (some.t, line.t),
            };
            let change = plus(equations, &some, -ahead / slope, &line);
            let size = dot(equations, &change, &change).sqrt();
            if size.is_finite() { Ok((change, size)) } else { Err(Failed::Diverged(size)) }
        };
        let (change, size) = step(equations)?;
        if first == f64::INFINITY {
            first = size;
        }
        if !(size < 0.5 * before || size < negligible) {
            return Err(Failed::Diverged(size));
        }
        let linearised = (x.clone(), t);
        x = equations.moved(&x, &change.x, 1.0);
        t += change.t;
        before = size;
        // Of forces as far as rounding lets them.
        let forces = equations.forces(&change.x);
        let still = forces <= FORCES * aside || size < negligible && forces >= 0.25 * off;
        off = forces;
        // What a correction with new factors leaves is of the second order in it.
        if size <= tolerance.min(aside) && still {
            let point = reached(equations, (x, t), linearised, &line, sense)?;
            return Ok(Corrected { point, first, aside: size });
        }
        if size > SMALL {
            continue;
        }
        let close = size <= aside && still || iteration > ITERATIONS / 2;
        for chord in 0..if close { CHORDS } else { 1 } {
            equations.evaluate(&x, t)?;
            let (change, again) = step(equations)?;
            x = equations.moved(&x, &change.x, 1.0);
            t += change.t;
            let rounding = before < negligible && again < negligible && again >= 0.25 * before;
            let rate = again / before;
            if chord == 0 && !(rate <= 0.5 || rounding) {
                return Err(Failed::Diverged(again));
            }
            before = again;
            // What is left is the next correction.
            let left = if rate < FAST { rate * again } else { again };
            let enough = rounding && size < negligible || close && (rounding || left <= tolerance);
            if enough {
                let point = reached(equations, (x, t), linearised, &line, sense)?;
                return Ok(Corrected { point, first, aside: size });
            }
            if rate.is_nan() || rate >= FAST {
                break;
            }
        }
    }
    Err(Failed::Diverged(before))
}

/// The equilibrium, with the tangent and the stability where the equations were linearised.
fn reached<E: Equations>(
    equations: &mut E,
    (x, t): (E::State, f64),
    linearised: (E::State, f64),
    line: &DirectionOf<E>,
    sense: Option<&DirectionOf<E>>,
) -> Result<PointOf<E>, Failed> {
    let x = equations.settled(x, t)?;
    let place = equations.settled(linearised.0, linearised.1)?;
    let mut stability = equations.stability(&place, linearised.1);
    let along = unit(equations, line);
    let backward = sense.is_some_and(|sense| dot(equations, sense, &along) < 0.0);
    let along = scaled(equations, &along, if backward { -1.0 } else { 1.0 });
    // The line has a positive part across the last row of the determinant: let that face along the branch.
    if let Some(determinant) = &mut stability.determinant {
        determinant.sign *= if backward { -1.0 } else { 1.0 };
    }
    Ok(Point { x, t, s: 0.0, along, stability })
}
