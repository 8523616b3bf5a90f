//! A Gauss step from a node: the initial-value problem on part of an element.
//!
//! From a node, where the solution is accurate to twice the degree, a step of the same method is so anywhere in the
//! element: it gives the dense output and, in two halves, the defect of the element.

#![expect(clippy::neg_cmp_op_on_partial_ord, reason = "what is not a number fails every test")]

use std::sync::Arc;

use nalgebra::Vector3;

use super::element::{Entry, Exit, Span, Stages};
use super::eliminated::Eliminated;
use super::ends::At;
use super::gauss::{Gauss, MAX_DEGREE};
use super::law::Response;
use super::problem::Problem;
use crate::InvalidInput;
use crate::section::Strain;

/// Steps of one degree, with room for their work.
pub struct Stepper {
    problem: Arc<Problem>,
    gauss: &'static Gauss,
    stages: Box<Stages>,
    eliminated: Eliminated,
    uniform: Option<Response>,
    /// Offset of the law at the stages of the next steps, by fractions of an element; none if empty.
    offset: Vec<Strain>,
    drag: f64,
    /// Error of strains that are solved for, over the length of the ribbon, that may be left.
    accuracy: f64,
}

/// Newton iterations of the stages, and changes, relative to the strains or to the last, below which factors are kept.
const ITERATIONS: usize = 12;
const CHORD: f64 = 1e-2;

impl Stepper {
    /// A stepper.
    ///
    /// # Errors
    /// Where the section is refused.
    pub fn new(problem: &Arc<Problem>, gauss: &'static Gauss) -> Result<Self, InvalidInput> {
        let uniform = if problem.law.varies() { None } else { Some(problem.law.at(0.0)?) };
        Ok(Self {
            problem: Arc::clone(problem),
            gauss,
            stages: Box::default(),
            eliminated: Eliminated::default(),
            uniform,
            offset: Vec::new(),
            drag: 0.0,
            accuracy: 0.0,
        })
    }

    /// The same that leaves an error of strains, over the length of the ribbon, if that is not less than rounding.
    #[must_use]
    pub fn to(self, accuracy: f64) -> Self {
        Self { accuracy: accuracy / self.problem.length, ..self }
    }

    /// Violates the law by these strains at the stages of the next step, with a viscosity.
    pub fn offset_by(&mut self, offset: impl Iterator<Item = Strain>, drag: f64) {
        self.offset.clear();
        self.offset.extend(offset);
        self.drag = drag;
    }

    /// From `at` over `length` from `s`, with strains that are solved for, starting from those of `guess` at the fractions
    /// of the step, or, if they cannot be, are those of `guess`. Returns the end and whether they were solved for.
    ///
    /// # Errors
    /// Where a section is refused.
    pub fn step(
        &mut self,
        at: &At,
        s: f64,
        length: f64,
        guess: impl Fn(f64) -> Strain,
        solve: bool,
    ) -> Result<(At, bool), InvalidInput> {
        let gauss = self.gauss;
        let degree = gauss.degree;
        let places = gauss.nodes.iter().map(|c| s + c * length);
        let made: Vec<Response>;
        let responses = match &self.uniform {
            Some(response) => std::slice::from_ref(response),
            None => {
                made = places.clone().map(|s| self.problem.law.at(s)).collect::<Result<_, _>>()?;
                &made
            }
        };
        let load: Vec<_> = if self.problem.has_line_load() {
            places.map(|s| self.problem.line_load(s)).collect()
        } else {
            Vec::new()
        };
        let span = Span { gauss, length, responses, offset: &self.offset, drag: self.drag, load: &load };
        let entry = Entry { rotation: at.rotation, force: at.force, moment: at.moment() };
        let mut strains = [Strain::zeros(); MAX_DEGREE];
        for (strain, &c) in strains.iter_mut().zip(&gauss.nodes) {
            *strain = guess(c);
        }
        let first = strains;
        let strains = &mut strains[..degree];
        let mut solved = false;
        let mut before = f64::INFINITY;
        if solve {
            let mut factors = false;
            for _ in 0..ITERATIONS {
                let exit = self.stages.evaluate(&span, &entry, strains);
                if !factors {
                    self.stages.linearise(&span, &exit, strains, &mut self.eliminated);
                    self.eliminated.factorise();
                }
                let mut changes = [Strain::zeros(); MAX_DEGREE];
                self.eliminated.solve(&self.stages.residual, &mut changes[..degree]);
                let size = changes[..degree].iter().map(|e| e.amax()).fold(0.0, f64::max);
                if !(size < before.max(1e-10)) {
                    break;
                }
                for (strain, change) in strains.iter_mut().zip(&changes) {
                    *strain += change;
                }
                let scale = strains.iter().map(|e| e.amax()).fold(0.0, f64::max);
                // With new factors the next change would be of the square of this one, with known ones as much less as this one is.
                let rate = if factors { size / before } else { size / scale };
                let left = if factors { rate * size } else { 1e-7 * size };
                if left <= self.accuracy.max(1e-16 * scale) || size < 1e-15 * scale.max(1.0) {
                    solved = true;
                    break;
                }
                factors = rate < CHORD;
                before = size;
            }
            if !solved {
                strains.copy_from_slice(&first[..degree]);
            }
        }
        let exit = self.stages.evaluate(&span, &entry, strains);
        Ok((left(at, &exit), solved))
    }
}

/// The state where an element ends, before any point load.
#[must_use]
pub fn left(at: &At, exit: &Exit) -> At {
    let position: Vector3<f64> = at.position + exit.arm;
    At {
        position,
        rotation: exit.rotation,
        force: at.force - exit.force_drop,
        about_origin: at.about_origin - at.position.cross(&exit.force_drop) - exit.lever - exit.couple_drop,
    }
}

/// The strains at which the law gives the resultants, from a guess; the guess itself where that fails.
#[must_use]
pub fn pointwise(response: &Response, resultants: &Strain, guess: Strain) -> Strain {
    solved_pointwise(response, resultants, guess).unwrap_or(guess)
}

/// The same; `None` where Newton's method comes no closer. Where it is slow, as next to where the section gives way, what it comes to is nearer
/// than the guess.
#[must_use]
pub fn solved_pointwise(response: &Response, resultants: &Strain, guess: Strain) -> Option<Strain> {
    let mut strain = guess;
    let mut before = f64::INFINITY;
    for _ in 0..20 {
        let (value, tangent) = response.value(&strain);
        let residual = value - response.compliance.component_mul(resultants);
        let change = tangent.lu().solve(&residual)?;
        let size = change.amax();
        if !(size < before) {
            // Rounding, unless it never came close.
            return (before < 1e-8).then_some(strain);
        }
        strain -= change;
        if size <= 1e-15 * strain.amax() {
            return Some(strain);
        }
        before = size;
    }
    Some(strain)
}
