//! Ribbons between ribbons: what enters the law of a section linearly is interpolated, `first + sum_i w_i (other_i - first)`.

use super::{Amplitude, RibbonSpec};
use crate::InvalidInput;

/// The number between numbers; exactly the first where all agree.
#[must_use]
pub fn blend(first: f64, others: impl Iterator<Item = (f64, f64)>) -> f64 {
    first + others.map(|(weight, other)| weight * (other - first)).sum::<f64>()
}

/// Weights of all corners but the first of a range of one parameter, (0), (1), or of a rectangle of two, (0, 0), (1, 0), (0, 1),
/// (1, 1).
#[must_use]
pub fn corner_weights(corners: usize, [t, u]: [f64; 2]) -> Vec<f64> {
    if corners == 2 { vec![t] } else { vec![t * (1.0 - u), u * (1.0 - t), t * u] }
}

impl Amplitude {
    /// The amplitude between amplitudes, all numbers or all functions of one range.
    ///
    /// # Errors
    /// If there are both.
    pub fn blend<'a>(
        first: &Self,
        others: impl Iterator<Item = (f64, &'a Self)>,
    ) -> Result<Self, InvalidInput> {
        let mut sum = first.clone();
        for (weight, other) in others.filter(|(_, other)| *other != first) {
            sum = match (sum, other, first) {
                (Self::Constant(sum), Self::Constant(other), Self::Constant(first)) => {
                    Self::Constant(sum + weight * (other - first))
                }
                (Self::Along(sum), Self::Along(other), Self::Along(first)) => {
                    Self::Along(sum.plus(weight, other).plus(-weight, first))
                }
                _ => {
                    let expected = "numbers alone or functions along the ribbon alone";
                    return Err(InvalidInput::new("amplitude", "numbers and functions", expected));
                }
            };
        }
        Ok(sum)
    }
}

impl RibbonSpec {
    /// Whether nothing differs but what [`RibbonSpec::blend`] interpolates.
    #[must_use]
    pub fn is_like(&self, other: &Self) -> bool {
        let profiles = |spec: &Self| spec.growth.len();
        let mut pairs = self.growth.iter().zip(&other.growth);
        self.stiffness == other.stiffness
            && self.form == other.form
            && profiles(self) == profiles(other)
            && pairs.all(|((_, mine), (_, theirs))| mine == theirs)
    }

    /// The ribbon between ribbons that differ in thickness ratio, amplitudes, width and thickness.
    ///
    /// # Errors
    /// As [`Amplitude::blend`].
    pub fn blend(first: &Self, others: &[(f64, &Self)]) -> Result<Self, InvalidInput> {
        let of = |field: fn(&Self) -> &Amplitude| {
            Amplitude::blend(field(first), others.iter().map(|(w, spec)| (*w, field(spec))))
        };
        let growth = first.growth.iter().enumerate().map(|(i, (amplitude, profile))| {
            let others = others.iter().map(|(w, spec)| (*w, &spec.growth[i].0));
            Ok((Amplitude::blend(amplitude, others)?, profile.clone()))
        });
        Ok(Self {
            eta: blend(first.eta, others.iter().map(|(w, spec)| (*w, spec.eta))),
            stiffness: first.stiffness,
            form: first.form,
            growth: growth.collect::<Result<_, InvalidInput>>()?,
            width: of(|spec| &spec.width)?,
            thickness: of(|spec| &spec.thickness)?,
        })
    }
}
