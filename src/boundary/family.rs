//! Problems between problems: a scene whose parameters vary.
//!
//! All that a parameter of a scene changes (amplitudes of growth, thickness ratio, length, places and turns of the ends, loads,
//! natural strains) enters a [`Problem`] linearly. So the problems at the ends of its range say all, and those of two
//! parameters follow from the corners of a rectangle.

use std::sync::Arc;

use super::ends::End;
use super::iterate::Layout;
use super::law::{Law, Rod};
use super::problem::{LineLoad, PointLoad, Problem};
use crate::InvalidInput;
use crate::section::{Amplitude, RibbonLaw, RibbonSpec, blend, corner_weights};

/// Problems that depend on one or two parameters, each from 0 to 1.
#[derive(Clone, Debug)]
pub struct Family {
    /// At (0), (1), or (0, 0), (1, 0), (0, 1), (1, 1).
    corners: Vec<Arc<Problem>>,
    law_varies: bool,
    ends_alone: bool,
    /// Where sections of different phases meet, over the length.
    kinks: Vec<f64>,
}

impl Family {
    /// The family between two problems, or four.
    ///
    /// # Errors
    /// If they differ in what is not interpolated: kinds of ends and of law, profiles of growth, places of loads.
    pub fn new(corners: Vec<Arc<Problem>>) -> Result<Self, InvalidInput> {
        if !matches!(corners.len(), 2 | 4) {
            return Err(InvalidInput::new("corners", corners.len(), "two problems, or four"));
        }
        let first = &corners[0];
        let alike = |other: &Problem| {
            let holds =
                first.ends.iter().zip(&other.ends).all(|(a, b)| a.hold == b.hold && a.rotation == b.rotation);
            let points = first.points.len() == other.points.len()
                && first.points.iter().zip(&other.points).all(|(a, b)| a.s == b.s);
            let laws = match (&*first.law, &*other.law) {
                (Law::Relaxed(a), Law::Relaxed(b)) | (Law::Linearised(a), Law::Linearised(b)) => {
                    a.spec().is_like(b.spec())
                }
                (Law::Rod(_), Law::Rod(_)) => true,
                _ => false,
            };
            let fixed = first.length == other.length || first.breaks().len() == 2;
            holds && points && laws && fixed
        };
        if !corners.iter().all(|other| alike(other)) {
            let expected = "problems that differ in growth, dimensions, places and loads alone";
            return Err(InvalidInput::new("corners", "different kinds", expected));
        }
        let law_varies = corners.iter().any(|other| !same_law(&first.law, &other.law));
        let same = |other: &Problem| {
            let points = first
                .points
                .iter()
                .zip(&other.points)
                .all(|(a, b)| a.force == b.force && a.moment == b.moment);
            points && first.line == other.line && first.length == other.length
        };
        let ends_alone = !law_varies && corners.iter().all(|other| same(other));
        Ok(Self { corners, law_varies, ends_alone, kinks: Vec::new() })
    }

    /// The family with elements that end at these places, over the length, where strains jump.
    #[must_use]
    pub fn with_kinks(self, kinks: Vec<f64>) -> Self {
        Self { kinks, ..self }
    }

    /// The states that the loads need anywhere in the family.
    #[must_use]
    pub fn layout(&self) -> Layout {
        let loaded = self.corners.iter().any(|corner| Layout::of(corner) == Layout::Moment);
        if loaded { Layout::Moment } else { Layout::Constant }
    }

    /// Whether the problems differ in what is asked of their ends alone.
    #[must_use]
    pub fn ends_alone(&self) -> bool {
        self.ends_alone
    }

    /// The length at these parameters.
    #[must_use]
    pub fn length(&self, at: [f64; 2]) -> f64 {
        let weights = corner_weights(self.corners.len(), at);
        let others = weights.iter().zip(&self.corners[1..]).map(|(w, other)| (*w, other.length));
        blend(self.corners[0].length, others)
    }

    /// Whether all are rods that bend in all directions alike.
    #[must_use]
    pub fn isotropic(&self) -> bool {
        self.corners.iter().all(|corner| corner.law.isotropic())
    }

    /// The problem at these parameters, of which the second counts if there are two.
    ///
    /// # Errors
    /// As [`Problem::new`].
    pub fn at(&self, at: [f64; 2]) -> Result<Arc<Problem>, InvalidInput> {
        let (first, others) = (&self.corners[0], &self.corners[1..]);
        let weights = corner_weights(self.corners.len(), at);
        let between = |field: &dyn Fn(&Problem) -> f64| {
            blend(field(first), weights.iter().zip(others).map(|(w, other)| (*w, field(other))))
        };
        let vector = |field: &dyn Fn(&Problem) -> nalgebra::Vector3<f64>| {
            nalgebra::Vector3::from_fn(|i, _| between(&|problem| field(problem)[i]))
        };
        let end = |i: usize| End {
            position: vector(&|problem| problem.ends[i].position),
            turns: between(&|problem| problem.ends[i].turns),
            force: vector(&|problem| problem.ends[i].force),
            moment: vector(&|problem| problem.ends[i].moment),
            ..first.ends[i]
        };
        let point = |i: usize| PointLoad {
            s: first.points[i].s,
            force: vector(&|problem| problem.points[i].force),
            moment: vector(&|problem| problem.points[i].moment),
        };
        let along = |field: fn(&LineLoad) -> &[Amplitude; 3]| {
            let component = |i: usize| {
                let others = weights.iter().zip(others).map(|(w, other)| (*w, &field(&other.line)[i]));
                Amplitude::blend(&field(&first.line)[i], others)
            };
            Ok::<_, InvalidInput>([component(0)?, component(1)?, component(2)?])
        };
        let line = LineLoad { force: along(|line| &line.force)?, moment: along(|line| &line.moment)? };
        let law = if self.law_varies { Arc::new(self.law(&weights)?) } else { Arc::clone(&first.law) };
        let points = (0..first.points.len()).map(point).collect();
        let length = self.length(at);
        let mut problem = Problem::new(law, length, [end(0), end(1)], points, line)?;
        problem.kinks = self.kinks.iter().map(|kink| kink * length).collect();
        Ok(Arc::new(problem))
    }

    fn law(&self, weights: &[f64]) -> Result<Law, InvalidInput> {
        let others = &self.corners[1..];
        let ribbon = |first: &RibbonSpec| {
            let others: Vec<_> =
                weights.iter().zip(others).filter_map(|(w, other)| Some((*w, other.law.spec()?))).collect();
            RibbonLaw::new(RibbonSpec::blend(first, &others)?)
        };
        match &*self.corners[0].law {
            Law::Relaxed(law) => Ok(Law::Relaxed(ribbon(law.spec())?)),
            Law::Linearised(law) => Ok(Law::Linearised(ribbon(law.spec())?)),
            Law::Rod(first) => {
                let mut rod = *first;
                for (w, other) in weights.iter().zip(others) {
                    if let Law::Rod(other) = &*other.law {
                        rod.compliance += *w * (other.compliance - first.compliance);
                        rod.intrinsic += *w * (other.intrinsic - first.intrinsic);
                    }
                }
                Ok(Law::Rod(rod))
            }
        }
    }
}

fn same_law(a: &Law, b: &Law) -> bool {
    let same = |a: &RibbonSpec, b: &RibbonSpec| {
        let amplitudes = a.growth.iter().zip(&b.growth).all(|(a, b)| a.0 == b.0);
        amplitudes && a.eta == b.eta && a.width == b.width && a.thickness == b.thickness
    };
    match (a, b) {
        (Law::Rod(Rod { compliance, intrinsic }), Law::Rod(b)) => {
            *compliance == b.compliance && *intrinsic == b.intrinsic
        }
        _ => a.spec().zip(b.spec()).is_some_and(|(a, b)| same(a, b)),
    }
}
