//! Natural shapes along a ribbon. `S` is the arc length, named as in the public interface.
#![allow(non_snake_case)]

use numpy::ndarray::Array2;
use numpy::{IntoPyArray, PyArray1, PyArray2, PyReadonlyArray1};
use pyo3::prelude::*;
use pyo3::types::PyType;

use super::frame::{Poses, poses};
use crate::InvalidInput;
use crate::equilibrium::{self, EventKind, Phase};
use crate::frame::Pose;
use crate::section::Strain;

/// A stable natural shape all along a ribbon that varies.
#[pyclass(frozen, module = "ribbonrs._core")]
pub struct NaturalBranch {
    branch: equilibrium::NaturalBranch,
}

/// The parts of a branch: breaks, series of each element, events, energy, phases.
type Parts = (Vec<f64>, Vec<[Vec<f64>; 4]>, Vec<Event>, f64, Vec<String>);
/// S, kind, strains before and after.
type Event = (f64, String, [f64; 4], [f64; 4]);

impl From<equilibrium::NaturalBranch> for NaturalBranch {
    fn from(branch: equilibrium::NaturalBranch) -> Self {
        Self { branch }
    }
}

#[pymethods]
impl NaturalBranch {
    /// A branch from its parts, as `__reduce__` gives them: it can be pickled.
    #[new]
    fn new(
        breaks: Vec<f64>,
        series: Vec<[Vec<f64>; 4]>,
        events: Vec<Event>,
        energy: f64,
        phases: Vec<String>,
    ) -> PyResult<Self> {
        let phase = |name: &String| named(&Phase::ALL, Phase::name, "phases", name);
        let event = |(s, kind, before, after): Event| {
            let kind = named(&EventKind::ALL, EventKind::name, "events", &kind)?;
            Ok(equilibrium::Event { s, kind, before: before.into(), after: after.into() })
        };
        let events = events.into_iter().map(event).collect::<Result<_, InvalidInput>>()?;
        let phases = phases.iter().map(phase).collect::<Result<_, _>>()?;
        let branch = equilibrium::NaturalBranch::from_parts(&breaks, series, events, energy, phases)?;
        Ok(Self { branch })
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> (Bound<'py, PyType>, Parts) {
        let phases = self.branch.phases.iter().map(|phase| phase.name().to_owned()).collect();
        let parts = (self.branch.breaks(), self.branch.series(), self.events(), self.branch.energy, phases);
        (py.get_type::<Self>(), parts)
    }

    /// Ends of the elements on which the strains are polynomials.
    #[getter]
    fn breaks<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.branch.breaks().into_pyarray(py)
    }

    /// Mean energy over the length.
    #[getter]
    fn energy(&self) -> f64 {
        self.branch.energy
    }

    /// The phases met along the ribbon, each run once.
    #[getter]
    fn phases(&self) -> Vec<&'static str> {
        self.branch.phases.iter().map(|phase| phase.name()).collect()
    }

    /// Where the strains are not smooth: S, kind, strains before and after.
    #[getter]
    fn events(&self) -> Vec<Event> {
        let event = |e: &equilibrium::Event| (e.s, e.kind.name().to_owned(), e.before.into(), e.after.into());
        self.branch.events.iter().map(event).collect()
    }

    /// Strains (m, 4) at S (m,).
    fn strains<'py>(&self, py: Python<'py>, S: PyReadonlyArray1<'py, f64>) -> Bound<'py, PyArray2<f64>> {
        let strains: Vec<Strain> = S.as_array().iter().map(|&s| self.branch.strain(s)).collect();
        Array2::from_shape_fn((strains.len(), 4), |(i, c)| strains[i][c]).into_pyarray(py)
    }

    /// Positions (m, 3) and unit quaternions (m, 4), scalar first, at ascending S (m,).
    fn poses<'py>(
        &self,
        py: Python<'py>,
        S: PyReadonlyArray1<'py, f64>,
        position: [f64; 3],
        quaternion: [f64; 4],
    ) -> PyResult<Poses<'py>> {
        let s = S.as_array().to_vec();
        if s.windows(2).any(|w| w[0] > w[1]) {
            return Err(InvalidInput::new("S", "descending", "ascending numbers").into());
        }
        Ok(poses(py, || self.branch.poses(&s, &Pose::new(position, quaternion))))
    }
}

/// The one of `all` with this name.
fn named<T: Copy>(
    all: &[T],
    name: impl Fn(T) -> &'static str,
    field: &'static str,
    wanted: &str,
) -> Result<T, InvalidInput> {
    let found = all.iter().copied().find(|&one| name(one) == wanted);
    found.ok_or_else(|| InvalidInput::new(field, format!("{wanted:?}"), "a name that the core gives"))
}
