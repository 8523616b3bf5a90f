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
}

/// Linearisations that are too many.
const ITERATIONS: usize = 10;
/// After a correction below this, one more with the same factors is tried.
const SMALL: f64 = 1e-2;
/// Tangent and stability are exact enough if the last correction before them was below this, or if Newton's method has not come as
/// near in half of its steps: then rounding keeps it.
const EXACT: f64 = 1e-10;
/// Below this corrections that no longer shrink are rounding, which a branch point near by amplifies along the other branch.
const ROUNDING: [f64; 2] = [1e-8, 1e-7];

/// The equilibrium near a guess, to `tolerance`. Tangent and stability are those where the equations were last linearised, before
/// a correction below [`SMALL`], or, if `exactly`, below [`EXACT`].
///
/// # Errors
/// Where Newton's method fails.
pub fn corrected<E: Equations>(
    equations: &mut E,
    guess: Guess<'_, E>,
    tolerance: f64,
    exactly: bool,
) -> Result<Corrected<E>, Failed> {
    let Guess { mut x, mut t, across, sense } = guess;
    let negligible = ROUNDING[usize::from(exactly)];
    let (mut before, mut first) = (f64::INFINITY, f64::INFINITY);
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
        if size > SMALL {
            continue;
        }
        equations.evaluate(&x, t)?;
        let (change, again) = step(equations)?;
        x = equations.moved(&x, &change.x, 1.0);
        t += change.t;
        let rounding = size < negligible && again < negligible && again >= 0.25 * size;
        if !(again <= 0.5 * size || rounding) {
            return Err(Failed::Diverged(again));
        }
        before = again;
        if (again <= tolerance || rounding)
            && (rounding || !exactly || size <= EXACT || iteration > ITERATIONS / 2)
        {
            let x = equations.settled(x, t)?;
            let place = equations.settled(linearised.0, linearised.1)?;
            let mut stability = equations.stability(&place, linearised.1);
            let along = unit(equations, &line);
            let backward = sense.is_some_and(|sense| dot(equations, sense, &along) < 0.0);
            let along = scaled(equations, &along, if backward { -1.0 } else { 1.0 });
            // The determinant is that with the plane as its last row: let it face along the branch.
            let facing = across.map_or(along.t, |across| dot(equations, across, &along));
            if let Some(determinant) = &mut stability.determinant {
                determinant.sign *= facing.signum();
            }
            return Ok(Corrected { point: Point { x, t, s: 0.0, along, stability }, first });
        }
    }
    Err(Failed::Diverged(before))
}
