//! The problem: a law, ends and loads.

use std::sync::Arc;

use nalgebra::{Quaternion, Vector3};

use super::ends::{End, Hold, Units};
use super::law::Law;
use crate::InvalidInput;
use crate::section::Amplitude;

type Vector = Vector3<f64>;

/// A dead force and moment at one section, in the fixed basis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointLoad {
    /// Where, inside the ribbon.
    pub s: f64,
    /// Force.
    pub force: Vector,
    /// Moment.
    pub moment: Vector,
}

/// A dead force and couple per unit `S`, by their components in the fixed basis.
#[derive(Clone, Debug, PartialEq)]
pub struct LineLoad {
    /// Force.
    pub force: [Amplitude; 3],
    /// Couple.
    pub moment: [Amplitude; 3],
}

impl LineLoad {
    /// The same force everywhere, and no couple.
    #[must_use]
    pub fn uniform(force: [f64; 3]) -> Self {
        Self { force: force.map(Amplitude::Constant), moment: [0.0; 3].map(Amplitude::Constant) }
    }
}

/// A ribbon that is held and loaded.
///
/// ```text
/// N' + p = 0,   M' + r' x N + c = 0,   r' = (1 + eps) d3,   q' = q (0, K)/2,   n = dPi/de     eqs. (40), (60), (66), (67)
/// ```
#[derive(Clone, Debug)]
pub struct Problem {
    /// The law of its sections.
    pub law: Arc<Law>,
    /// Length `L` in units of the width.
    pub length: f64,
    /// How the ends at `S = 0` and `S = L` are held.
    pub ends: [End; 2],
    /// Loads at points, by ascending `S`.
    pub points: Vec<PointLoad>,
    /// Load along the ribbon.
    pub line: LineLoad,
    /// Where strains may jump though nothing that is given does: sections on both sides are in different phases.
    pub kinks: Vec<f64>,
}

impl Problem {
    /// A problem whose numbers are finite and whose loads are on the ribbon.
    ///
    /// # Errors
    /// If the length is not positive, a number is not finite, a quaternion is not of unit length, or a point load
    /// is not inside.
    pub fn new(
        law: impl Into<Arc<Law>>,
        length: f64,
        ends: [End; 2],
        mut points: Vec<PointLoad>,
        line: LineLoad,
    ) -> Result<Self, InvalidInput> {
        if !(length > 0.0 && length.is_finite()) {
            return Err(InvalidInput::new("length", length, "a positive finite number"));
        }
        for (name, end) in ["start", "end"].iter().zip(&ends) {
            let vectors = [end.position, end.force, end.moment];
            if !(vectors.iter().all(finite) && end.turns.is_finite()) {
                return Err(InvalidInput::new(name, "not finite", "finite numbers"));
            }
            if (end.rotation.norm() - 1.0).abs() > 1e-8 {
                return Err(InvalidInput::new(name, end.rotation.norm(), "a quaternion of unit length"));
            }
            if let Hold::Sliding(axis) = end.hold
                && (axis.norm() - 1.0).abs() > 1e-8
            {
                return Err(InvalidInput::new(name, axis.norm(), "an axis of unit length"));
            }
        }
        if ends[0].hold == Hold::Closed || ends[1].hold == Hold::Closed && ends[0].hold != Hold::Clamped {
            return Err(InvalidInput::new(
                "start",
                "closed",
                "an end that closes a ribbon clamped at its start",
            ));
        }
        for point in &points {
            if !(point.s > 0.0 && point.s < length && finite(&point.force) && finite(&point.moment)) {
                return Err(InvalidInput::new("point load", point.s, "finite, inside the ribbon"));
            }
        }
        points.sort_by(|a, b| a.s.total_cmp(&b.s));
        let mut problem = Self { law: law.into(), length, ends, points, line, kinks: Vec::new() };
        for end in &mut problem.ends {
            end.rotation *= 1.0 / end.rotation.norm();
        }
        problem.law.at(0.0)?;
        Ok(problem)
    }

    /// Whether a force acts along the ribbon.
    #[must_use]
    pub fn has_line_force(&self) -> bool {
        self.line.force.iter().any(acts)
    }

    /// Whether a couple acts along the ribbon.
    #[must_use]
    pub fn has_line_couple(&self) -> bool {
        self.line.moment.iter().any(acts)
    }

    /// Whether a force or a couple acts along the ribbon.
    #[must_use]
    pub fn has_line_load(&self) -> bool {
        self.has_line_force() || self.has_line_couple()
    }

    /// Whether nothing acts on the ribbon.
    #[must_use]
    pub fn rests(&self) -> bool {
        let none = |force: &Vector, moment: &Vector| *force == Vector::zeros() && *moment == Vector::zeros();
        self.ends.iter().all(|end| none(&end.force, &end.moment))
            && self.points.iter().all(|point| none(&point.force, &point.moment))
            && !self.has_line_load()
    }

    /// Whether the ribbon is the same everywhere, unloaded, and clamped to itself, so that it may glide along itself: the
    /// two ends at one place, turned by full or half turns about the tangent.
    #[must_use]
    pub fn glides(&self) -> bool {
        let clamped = |end: &End| matches!(end.hold, Hold::Clamped | Hold::Closed);
        let loaded = !self.points.is_empty() || self.has_line_load();
        if self.law.varies() || loaded || !self.ends.iter().all(clamped) {
            return false;
        }
        let [start, end] = [0, 1].map(|i| self.goal(&self.ends[i]));
        let turn = start.rotation.conjugate() * end.rotation;
        let none = |x: f64| x.abs() < 1e-9;
        let apart = (start.position - end.position).norm() / self.length;
        none(apart) && none(turn.i) && none(turn.j) && (none(turn.w) || none(turn.k))
    }

    /// Units of the unknowns: the ribbon's length, and what its soft bending stiffness resists it with.
    ///
    /// # Errors
    /// As [`Law::at`].
    pub fn units(&self) -> Result<Units, InvalidInput> {
        let compliance = self.law.at(0.0)?.compliance;
        let softest = compliance[1].max(compliance[2]).max(compliance[3]);
        let moment = 1.0 / (softest * self.length);
        Ok(Units { length: self.length, force: moment / self.length, moment })
    }

    /// Distributed force and couple at `s`.
    #[must_use]
    pub fn line_load(&self, s: f64) -> (Vector, Vector) {
        let vector = |along: &[Amplitude; 3]| Vector::from_fn(|i, _| along[i].at(s));
        (vector(&self.line.force), vector(&self.line.moment))
    }

    /// Where elements must end: both ends, point loads, and where the law or the loads are not smooth.
    #[must_use]
    pub fn breaks(&self) -> Vec<f64> {
        let mut breaks = vec![0.0, self.length];
        breaks.extend(self.points.iter().map(|point| point.s));
        let loads = self.line.force.iter().chain(&self.line.moment);
        let along = loads.filter_map(|amplitude| match amplitude {
            Amplitude::Along(function) => Some(function.breaks()),
            Amplitude::Constant(_) => None,
        });
        let inner = along.flatten().copied().chain(self.law.breaks()).chain(self.kinks.iter().copied());
        breaks.extend(inner.filter(|&s| s > 0.0 && s < self.length));
        breaks.sort_by(f64::total_cmp);
        let loaded = |s: f64| self.points.iter().any(|point| point.s == s) || s == self.length;
        // What differs by rounding is one place: that of a load, if one is there.
        let mut kept: Vec<f64> = vec![0.0];
        for &s in &breaks[1..] {
            let last = kept.len() - 1;
            if s - kept[last] > 1e-13 * self.length {
                kept.push(s);
            } else if loaded(s) && last > 0 && !loaded(kept[last]) {
                kept[last] = s;
            } else if loaded(s) && s != kept[last] {
                kept.push(s);
            }
        }
        kept
    }
}

fn finite(v: &Vector) -> bool {
    v.iter().all(|x| x.is_finite())
}

fn acts(amplitude: &Amplitude) -> bool {
    *amplitude != Amplitude::Constant(0.0)
}

/// Rotation by `turns` about a basis vector of number `axis`, exact at quarter turns but for sign.
#[must_use]
pub fn turned(turns: f64, axis: usize) -> Quaternion<f64> {
    let half = std::f64::consts::PI * (turns % 2.0);
    let (sin, cos) = half.sin_cos();
    Quaternion::from_parts(cos, Vector::ith(axis, sin))
}
