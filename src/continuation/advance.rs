//! A step along a branch: the next point, predicted by the last ones and corrected.

use super::branch::Limits;
use super::correct::{Corrected, EXACTLY, Guess, PointOf, ROUGHLY, arclength, corrected, difference};
use super::equations::{Direction, Equations, Failed, Stability, dot};
use super::predict::weights;

/// The error of a prediction that steps are made for.
const PREDICTION: f64 = 5e-3;
/// Distance of a parameter from the end of its range that is rounding.
const NEAR_END: f64 = 1e-12;
/// An error of a prediction that no step may have.
const FAR: f64 = 8.0 * PREDICTION;
/// The least cosine of the angle between the tangents of points in a row.
pub const TURN: f64 = 0.7;
/// How far ahead along the last tangent a step must lead, of its length: where a branch turns as fast as steps change a prediction may be
/// behind.
const AHEAD: f64 = 0.5;
/// How far from a point its tangent may be taken, of the step; its change of the parameter below which it may have the wrong sign, over how far
/// that was, and at most.
const ASIDE: f64 = 1e-3;
const TURNED: f64 = 1e4;
const SHALLOW: f64 = 1e-2;

/// A point that a step led to.
pub struct Advanced<E: Equations> {
    /// The point.
    pub point: PointOf<E>,
    /// Whether the range of the parameter ends there.
    pub at_end: bool,
    /// Points that the prediction used, and its error.
    order: usize,
    error: f64,
}

impl<E: Equations> Advanced<E> {
    /// The same step, no farther than to this point, where the range of the parameter ends.
    pub fn ending(self, point: PointOf<E>) -> Self {
        Self { point, at_end: true, ..self }
    }

    /// The length of the next step after one of this length, by the error of the prediction.
    pub fn next_step(&self, step: f64, limits: &Limits) -> f64 {
        let factor = (PREDICTION / self.error.max(1e-12)).powf(1.0 / (self.order as f64 + 1.0));
        (step * (0.9 * factor).clamp(0.3, 4.0)).min(limits.longest)
    }
}

/// The next point, a step away, or where the range of the parameter ends.
///
/// # Errors
/// Where no point is found that is the next one.
pub fn advanced<E: Equations>(
    equations: &mut E,
    last: &PointOf<E>,
    memory: &[PointOf<E>],
    step: f64,
    limits: &Limits,
) -> Result<Advanced<E>, Failed> {
    let places: Vec<f64> = memory.iter().map(|point| point.s).collect();
    let before = &memory[..memory.len() - 1];
    let changes: Vec<E::Change> =
        before.iter().map(|point| equations.difference(&last.x, &point.x)).collect();
    let predicted = |equations: &mut E, length: f64| {
        let (weights, tangent) = weights(&places, length);
        let mut parts: Vec<_> = weights.iter().copied().zip(&changes).collect();
        parts.push((tangent, &last.along.x));
        let change = equations.sum(&parts);
        let ahead: f64 = weights.iter().zip(before).map(|(w, point)| w * (point.t - last.t)).sum();
        (equations.moved(&last.x, &change, 1.0), last.t + ahead + tangent * last.along.t)
    };
    let (x, t) = predicted(equations, step);
    let outside = |t: f64| !(0.0..=1.0).contains(&t);
    if outside(t) && (t - last.t) * last.along.t > 0.0 {
        // To the end of the range, exactly.
        let end = if t > 0.5 { 1.0 } else { 0.0 };
        if last.t == end {
            return Err(Failed::Jumped);
        }
        let mut length = step * (end - last.t) / (t - last.t);
        let mut guess = predicted(equations, length);
        for _ in 0..4 {
            let slope = (guess.1 - last.t) / length;
            length = (length + (end - guess.1) / slope).clamp(0.0, step);
            guess = predicted(equations, length);
        }
        let there = |equations: &mut E| {
            let (mut point, first) = reached(equations, last, (guess.0.clone(), end), None, length, limits)?;
            point.t = end;
            point.s = last.s + near(equations, last, &point, first, length)?;
            Ok(Advanced { point, order: memory.len(), error: first, at_end: true })
        };
        // There may be states that are freer to move than those of the branch.
        equations.expect_motions(None);
        let motions = last.stability.free_motions;
        return match there(equations) {
            Ok(ended) if ended.point.stability.free_motions >= motions => Ok(as_free(ended, last)),
            Err(failed) if motions == 0 => Err(failed),
            _ => {
                equations.expect_motions(Some(motions));
                there(equations)
            }
        };
    }
    let (mut point, first) = reached(equations, last, (x, t), Some(&last.along), step, limits)?;
    let length = near(equations, last, &point, first, step)?;
    if !(NEAR_END..=1.0 - NEAR_END).contains(&point.t) {
        // A shorter step meets the end.
        return Err(Failed::Jumped);
    }
    point.s = last.s + length;
    Ok(Advanced { point, order: memory.len(), error: first, at_end: false })
}

/// What ends a branch. One that is freer to move than the last point is a branch point and has the stability of that.
fn as_free<E: Equations>(mut ended: Advanced<E>, last: &PointOf<E>) -> Advanced<E> {
    if ended.point.stability.free_motions > last.stability.free_motions {
        ended.point.stability = Stability { determinant: None, ..last.stability.clone() };
    }
    ended
}

/// The point that a step leads to, and the error of its prediction. Where the branch lies across the parameter the tangent is exact: by its
/// sign folds are told.
fn reached<E: Equations>(
    equations: &mut E,
    last: &PointOf<E>,
    (x, t): (E::State, f64),
    across: Option<&Direction<E::Change>>,
    step: f64,
    limits: &Limits,
) -> Result<(PointOf<E>, f64), Failed> {
    let sense = Some(&last.along);
    let aside = ROUGHLY.min(ASIDE * step);
    let Corrected { point, first, aside } =
        corrected(equations, Guess { x, t, across, sense }, limits.tolerance, aside)?;
    if point.along.t.abs() > (TURNED * aside).min(SHALLOW) {
        return Ok((point, first));
    }
    let again = Guess { x: point.x, t: point.t, across, sense };
    Ok((corrected(equations, again, limits.tolerance, EXACTLY)?.point, first))
}

/// The arclength from a point to the next, a step away.
///
/// # Errors
/// If that is not the next one.
fn near<E: Equations>(
    equations: &mut E,
    last: &PointOf<E>,
    point: &PointOf<E>,
    first: f64,
    step: f64,
) -> Result<f64, Failed> {
    let change = difference(equations, last, point);
    let ahead = dot(equations, &last.along, &change);
    let turned = dot(equations, &last.along, &point.along);
    if first > FAR.min(0.5 * step) || turned < TURN || ahead < AHEAD * step {
        return Err(Failed::Jumped);
    }
    Ok(arclength(equations, [last, point], &change))
}
