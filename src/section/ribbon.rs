//! The section law along a ribbon whose growth, width and thickness vary.
//!
//! The growth is a sum of profiles times amplitudes of `S`, `sum_i a_i(S) g_i(x)`, and the width and the
//! thickness are factors `w(S)`, `t(S)` of those of reference. At each `S` the section is that of a uniform
//! ribbon of thickness ratio `eta t/w`; nothing is interpolated. In units of the reference width `a` and
//! thickness `h`,
//!
//! ```text
//! Pi(eps, K) = w t Pi_local(eps, w K),
//! ```
//!
//! and a gradient through the thickness `g = (X1/a) d` is locally `w d`. What does not depend on `S` is
//! shared: the smooth basis by all, the modes of growth with jumps by all sections that sum the same profiles.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

use super::{Evaluation, Form, Mesh, Reach, Reduction, Section, Strain};
use crate::InvalidInput;
use crate::growth::Growth;
use crate::material::PlaneStress;
use crate::piecewise::{Piecewise, union};

/// A number, or a function of `S`.
#[derive(Clone, Debug, PartialEq)]
pub enum Amplitude {
    /// The same all along.
    Constant(f64),
    /// Varying with `S`.
    Along(Piecewise),
}

impl Amplitude {
    /// The value at `s`.
    #[must_use]
    pub fn at(&self, s: f64) -> f64 {
        match self {
            Self::Constant(value) => *value,
            Self::Along(function) => function.evaluate(s),
        }
    }

    fn breaks(&self) -> &[f64] {
        match self {
            Self::Constant(_) => &[],
            Self::Along(function) => function.breaks(),
        }
    }

    fn is_constant(&self) -> bool {
        matches!(self, Self::Constant(_))
    }
}

/// What a ribbon is made of and how it grows; see the module.
#[derive(Clone, Debug)]
pub struct RibbonSpec {
    /// Thickness ratio `h/a` of reference.
    pub eta: f64,
    /// Stiffness of the material.
    pub stiffness: PlaneStress,
    /// The law.
    pub form: Form,
    /// Profiles across the width and their amplitudes along the ribbon.
    pub growth: Vec<(Amplitude, Growth)>,
    /// Factor of the width.
    pub width: Amplitude,
    /// Factor of the thickness.
    pub thickness: Amplitude,
}

impl RibbonSpec {
    /// An incompressible ribbon of thickness ratio `eta` that grows the same all along.
    #[must_use]
    pub fn uniform(eta: f64, growth: Growth) -> Self {
        Self {
            eta,
            stiffness: PlaneStress::incompressible(),
            form: Form::Auto,
            growth: vec![(Amplitude::Constant(1.0), growth)],
            width: Amplitude::Constant(1.0),
            thickness: Amplitude::Constant(1.0),
        }
    }
}

/// The law of every section of a ribbon.
#[derive(Debug)]
pub struct RibbonLaw {
    spec: RibbonSpec,
    uniform: Option<Arc<Station>>,
    /// Modes of the profiles with these places in `spec.growth`.
    reaches: Mutex<HashMap<Vec<usize>, Arc<Reach>>>,
}

/// The law of the section at one `S`, in units of the ribbon's reference dimensions.
#[derive(Debug)]
pub struct Station {
    section: Section,
    width: f64,
    weight: f64,
}

impl RibbonLaw {
    /// The law for a ribbon.
    ///
    /// # Errors
    /// As [`Section::new`], at the start of the ribbon.
    ///
    /// # Example
    /// Edge growth that rises along the ribbon, 10 widths long: bent from where it exceeds `4.5467 eta^2`.
    /// ```
    /// use ribbonrs::{equilibrium::Phase, growth::Growth, material::PlaneStress, piecewise::Piecewise};
    /// use ribbonrs::section::{Amplitude, Form, RibbonLaw, RibbonSpec};
    /// let rising = Piecewise::from_legendre(vec![0.0, 10.0], vec![vec![0.03, 0.03]])?;
    /// let law = RibbonLaw::new(RibbonSpec {
    ///     eta: 0.1,
    ///     stiffness: PlaneStress::incompressible(),
    ///     form: Form::Auto,
    ///     growth: vec![(Amplitude::Along(rising), Growth::edge(1.0))],
    ///     width: Amplitude::Constant(1.0),
    ///     thickness: Amplitude::Constant(1.0),
    /// })?;
    /// let phase = |s| Ok::<_, ribbonrs::InvalidInput>(law.station(s)?.natural_shapes()[0].phase);
    /// assert_eq!((phase(7.5)?, phase(7.6)?), (Phase::Flat, Phase::Bent));
    /// # Ok::<(), ribbonrs::InvalidInput>(())
    /// ```
    pub fn new(spec: RibbonSpec) -> Result<Self, InvalidInput> {
        for (_, profile) in &spec.growth {
            profile.validate()?;
        }
        let mut law = Self { spec, uniform: None, reaches: Mutex::default() };
        let first = law.make(law.breaks().first().copied().unwrap_or(0.0))?;
        if !law.varies() {
            law.uniform = Some(Arc::new(first));
        }
        Ok(law)
    }

    /// What the law is for.
    #[must_use]
    pub fn spec(&self) -> &RibbonSpec {
        &self.spec
    }

    /// Whether anything varies along the ribbon.
    #[must_use]
    pub fn varies(&self) -> bool {
        let spec = &self.spec;
        let constant = spec.growth.iter().all(|(amplitude, _)| amplitude.is_constant());
        !(constant && spec.width.is_constant() && spec.thickness.is_constant())
    }

    /// Where along the ribbon anything is not smooth, and the ends of what is given; ascending.
    #[must_use]
    pub fn breaks(&self) -> Vec<f64> {
        let amplitudes = self.spec.growth.iter().map(|(amplitude, _)| amplitude);
        let all = amplitudes.chain([&self.spec.width, &self.spec.thickness]);
        all.fold(Vec::new(), |breaks, amplitude| union(&breaks, amplitude.breaks()))
    }

    /// The law of the section at `s`.
    ///
    /// # Errors
    /// As [`Section::new`], where dimensions or growth of this section are refused.
    pub fn station(&self, s: f64) -> Result<Arc<Station>, InvalidInput> {
        match &self.uniform {
            Some(station) => Ok(Arc::clone(station)),
            None => Ok(Arc::new(self.make(s)?)),
        }
    }

    /// Whether growth or a dimension jumps at `s`.
    #[must_use]
    pub fn jumps(&self, s: f64) -> bool {
        let amplitudes = self.spec.growth.iter().map(|(amplitude, _)| amplitude);
        amplitudes.chain([&self.spec.width, &self.spec.thickness]).any(|amplitude| match amplitude {
            Amplitude::Constant(_) => false,
            Amplitude::Along(function) => function.jumps().any(|place| place == s),
        })
    }

    fn make(&self, s: f64) -> Result<Station, InvalidInput> {
        let spec = &self.spec;
        let amplitudes: Vec<f64> = spec.growth.iter().map(|(amplitude, _)| amplitude.at(s)).collect();
        self.mixed(spec.eta, &amplitudes, spec.width.at(s), spec.thickness.at(s))
    }

    /// The law of a section with these amplitudes of the profiles, of which only those that vary may differ from the
    /// ribbon's.
    pub(crate) fn mixed(
        &self,
        eta: f64,
        amplitudes: &[f64],
        width: f64,
        thickness: f64,
    ) -> Result<Station, InvalidInput> {
        let spec = &self.spec;
        let active: Vec<usize> = (0..amplitudes.len()).filter(|&i| amplitudes[i] != 0.0).collect();
        let mut growth = Growth::default();
        for &i in &active {
            growth.add_scaled(amplitudes[i], width, &spec.growth[i].1);
        }
        let eta = eta * thickness / width;
        let reach = self.reach(&growth, &active);
        let section = Section::with_reach(eta, growth, &spec.stiffness, spec.form, reach)?;
        Ok(Station { section, width, weight: width * thickness })
    }

    /// The modes for sums of the active profiles, if they jump.
    fn reach(&self, growth: &Growth, active: &[usize]) -> Option<Arc<Reach>> {
        let mesh = Mesh::of(growth);
        if mesh.is_single() {
            return None;
        }
        // What the lock guards is whole at any time: a map of finished entries.
        let mut reaches = self.reaches.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) = reaches.get(active) {
            return Some(Arc::clone(known));
        }
        // Gradients through the thickness scale with the width, the rest does not.
        let parts = self.summands(active).into_iter().flat_map(Growth::split);
        let reduce = |part: Growth| Reduction::on(mesh.clone(), part, &self.spec.stiffness);
        let reductions: Vec<Reduction> = parts.map(reduce).collect();
        let reach = Arc::new(Reach::new(&reductions)?);
        reaches.insert(active.to_vec(), Arc::clone(&reach));
        Some(reach)
    }

    /// Growths of which every sum of the active profiles is made: what is constant along the ribbon is one of them.
    fn summands(&self, active: &[usize]) -> Vec<Growth> {
        let mut constant = Growth::default();
        let mut summands = Vec::new();
        for &i in active {
            match &self.spec.growth[i] {
                (Amplitude::Constant(amplitude), profile) => constant.add_scaled(*amplitude, 1.0, profile),
                (Amplitude::Along(_), profile) => summands.push(profile.clone()),
            }
        }
        summands.push(constant);
        summands
    }
}

impl Station {
    /// The section in its own units: its width and thickness.
    #[must_use]
    pub fn section(&self) -> &Section {
        &self.section
    }

    /// Width over that of reference.
    #[must_use]
    pub fn width(&self) -> f64 {
        self.width
    }

    /// The strains in the section's own units, curvatures times its width.
    #[must_use]
    pub fn local(&self, strain: &Strain) -> Strain {
        let w = self.width;
        Strain::new(strain[0], w * strain[1], w * strain[2], w * strain[3])
    }

    /// The strains in the ribbon's units from those in the section's own.
    #[must_use]
    pub fn reference(&self, strain: &Strain) -> Strain {
        let w = self.width;
        Strain::new(strain[0], strain[1] / w, strain[2] / w, strain[3] / w)
    }

    /// Width times thickness, over those of reference: the factor of the energy.
    #[must_use]
    pub fn weight(&self) -> f64 {
        self.weight
    }

    /// `Pi` at the strains.
    #[must_use]
    pub fn energy(&self, strain: &Strain) -> f64 {
        self.weight * self.section.energy(&self.local(strain))
    }

    /// `dPi/d(eps, K1, K2, K3)` at the strains.
    #[must_use]
    pub fn gradient(&self, strain: &Strain) -> Strain {
        self.weight * self.local(&self.section.gradient(&self.local(strain)))
    }

    /// Energy, gradient and Hessian at the strains.
    #[must_use]
    pub fn evaluate(&self, strain: &Strain) -> Evaluation {
        let local = self.section.evaluate(&self.local(strain));
        let scale = self.local(&Strain::repeat(1.0));
        Evaluation {
            energy: self.weight * local.energy,
            gradient: self.weight * self.local(&local.gradient),
            hessian: self.weight * local.hessian.component_mul(&(scale * scale.transpose())),
        }
    }
}
