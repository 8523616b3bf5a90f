//! Ribbons over a rectangle of two parameters.

use crate::InvalidInput;
use crate::equilibrium::Equilibrium;
use crate::piecewise::Piecewise;
use crate::section::{Amplitude, RibbonLaw, RibbonSpec, Station, Strain};

/// Uniform ribbons whose amplitudes of growth, thickness ratio, width and thickness are bilinear over the unit square.
#[derive(Debug)]
pub struct Plane {
    corners: [RibbonSpec; 4],
    /// A ribbon along which the profiles vary that do so here: every mixture of them is a section of it.
    law: RibbonLaw,
}

impl Plane {
    /// The ribbons between those at (0, 0), (1, 0), (0, 1), (1, 1).
    ///
    /// # Errors
    /// If they differ in material, law or profiles, vary along their length, or one of them is refused.
    pub fn new(corners: [RibbonSpec; 4]) -> Result<Self, InvalidInput> {
        if !corners[1..].iter().all(|other| corners[0].is_like(other)) {
            let expected = "ribbons that differ in amplitudes of growth and dimensions alone";
            return Err(InvalidInput::new("corners", "different kinds", expected));
        }
        for spec in &corners {
            let amplitudes = spec.growth.iter().map(|(amplitude, _)| amplitude);
            for amplitude in amplitudes.chain([&spec.width, &spec.thickness]) {
                constant(amplitude)?;
            }
            RibbonLaw::new(spec.clone())?;
        }
        let mut all = corners[0].clone();
        for (i, (amplitude, _)) in all.growth.iter_mut().enumerate() {
            let values = corners.each_ref().map(|spec| spec.growth[i].0.at(0.0));
            if values.iter().any(|value| *value != values[0]) {
                let some = values.into_iter().find(|value| *value != 0.0).unwrap_or_default();
                *amplitude = Amplitude::Along(Piecewise::from_legendre(vec![0.0, 1.0], vec![vec![some]])?);
            }
        }
        let plane = Self { law: RibbonLaw::new(all)?, corners };
        plane.station([0.0, 0.0])?;
        Ok(plane)
    }

    /// The section at a point of the unit square.
    ///
    /// # Errors
    /// As [`crate::section::Section::new`].
    pub fn station(&self, at: [f64; 2]) -> Result<Station, InvalidInput> {
        let number = |of: &dyn Fn(&RibbonSpec) -> f64| {
            let [c00, c10, c01, c11] = std::array::from_fn(|i| of(&self.corners[i]));
            // One direction after the other: what depends on one parameter alone is exact in it.
            between(between(c00, c10, at[0]), between(c01, c11, at[0]), at[1])
        };
        let value = |amplitude: &Amplitude| amplitude.at(0.0);
        let profiles = 0..self.corners[0].growth.len();
        let amplitudes: Vec<f64> =
            profiles.map(|i| number(&|spec: &RibbonSpec| value(&spec.growth[i].0))).collect();
        let (width, thickness) = (number(&|spec| value(&spec.width)), number(&|spec| value(&spec.thickness)));
        self.law.mixed(number(&|spec| spec.eta), &amplitudes, width, thickness)
    }

    /// Every equilibrium at a point, lowest energy first.
    ///
    /// # Errors
    /// As [`Plane::station`].
    pub fn shapes(&self, at: [f64; 2]) -> Result<Vec<Equilibrium>, InvalidInput> {
        Ok(self.station(at)?.natural_shapes())
    }
}

/// The number from `a` at 0 to `b` at 1; exactly `a` where both agree.
fn between(a: f64, b: f64, t: f64) -> f64 {
    if t == 1.0 { b } else { a + t * (b - a) }
}

fn constant(amplitude: &Amplitude) -> Result<(), InvalidInput> {
    match amplitude {
        Amplitude::Constant(_) => Ok(()),
        Amplitude::Along(_) => {
            Err(InvalidInput::new("amplitude", "a function of S", "a number: the ribbon is uniform"))
        }
    }
}

/// `(K2, K3)` over the thickness ratio.
pub(super) fn scaled(station: &Station, strain: &Strain) -> [f64; 2] {
    let (local, eta) = (station.local(strain), station.section().eta());
    [local[2] / eta, local[3] / eta]
}
