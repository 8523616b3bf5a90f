//! The section law.

use std::collections::HashMap;
use std::sync::Arc;

use numpy::ndarray::{Array1, Array2};
use numpy::{IntoPyArray, PyArray1, PyArray2, PyArray3, PyArrayMethods, PyReadonlyArray1};
use numpy::{PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use rayon::prelude::*;

use super::branch::NaturalBranch;
use super::strains_from;
use crate::InvalidInput;
use crate::equilibrium::{self, Equilibrium};
use crate::growth::{Growth, Profile};
use crate::material::PlaneStress;
use crate::piecewise::Piecewise;
use crate::section::{Amplitude, Form, RibbonLaw, RibbonSpec, Station, Strain};

/// Relaxed cross-section energy of a growing ribbon.
#[pyclass(frozen, module = "ribbonrs._core")]
pub struct SectionLaw {
    law: RibbonLaw,
}

/// A number, or breaks and the Legendre coefficients of the pieces between them.
#[derive(FromPyObject)]
pub enum Along {
    Constant(f64),
    Pieces(Vec<f64>, Vec<Vec<f64>>),
}

impl Along {
    pub fn amplitude(self) -> Result<Amplitude, InvalidInput> {
        Ok(match self {
            Self::Constant(value) => Amplitude::Constant(value),
            Self::Pieces(breaks, pieces) => Amplitude::Along(Piecewise::from_legendre(breaks, pieces)?),
        })
    }
}

/// Polynomial coefficients in `x`, or pieces as for [`Along`].
#[derive(FromPyObject)]
enum Across {
    Polynomial(Vec<f64>),
    Pieces(Vec<f64>, Vec<Vec<f64>>),
}

type Term = (Along, HashMap<String, Across>);

/// Rows that one core takes at a time: of a uniform ribbon, and where each row may need its own section.
const ROWS: [usize; 2] = [4096, 32];

impl SectionLaw {
    /// The law in the core.
    pub fn law(&self) -> &RibbonLaw {
        &self.law
    }

    /// `N` numbers for each of the strains (m, 4), at `S` (m,) if the ribbon varies; on all cores if many.
    fn rows<const N: usize>(
        &self,
        strains: &[Strain],
        s: Option<&[f64]>,
        f: impl Fn(&Station, &Strain) -> [f64; N] + Sync,
    ) -> Result<Vec<f64>, InvalidInput> {
        if s.is_some_and(|s| s.len() != strains.len()) {
            return Err(InvalidInput::new("S", "another length", "as many as strains"));
        }
        let at = |row: usize| s.map_or(0.0, |s| s[row]);
        let mut values = vec![0.0; N * strains.len()];
        let rows = ROWS[usize::from(self.law.varies())];
        let chunk = |(first, values): (usize, &mut [f64])| {
            let mut known: Option<(f64, Arc<Station>)> = None;
            for (row, value) in (first * rows..).zip(values.chunks_exact_mut(N)) {
                // Neighbours at one `S` share a section.
                let station = match known.take() {
                    Some((place, station)) if place == at(row) => station,
                    _ => self.law.station(at(row))?,
                };
                value.copy_from_slice(&f(&station, &strains[row]));
                known = Some((at(row), station));
            }
            Ok(())
        };
        if strains.len() <= rows {
            values.chunks_mut(N * rows).enumerate().try_for_each(chunk)?;
        } else {
            values.par_chunks_mut(N * rows).enumerate().try_for_each(chunk)?;
        }
        Ok(values)
    }

    /// [`SectionLaw::rows`] of arrays, with the GIL released, as an array (m, N).
    fn table<'py, const N: usize>(
        &self,
        py: Python<'py>,
        strains: &PyReadonlyArray2<'py, f64>,
        s: Option<&PyReadonlyArray1<'py, f64>>,
        f: impl Fn(&Station, &Strain) -> [f64; N] + Sync + Send,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let strains = strains_from(strains)?;
        let s = s.map(|s| s.as_array().to_vec());
        let values = py.detach(|| self.rows(&strains, s.as_deref(), f))?;
        values.into_pyarray(py).reshape([strains.len(), N])
    }
}

#[pymethods]
impl SectionLaw {
    #[new]
    #[pyo3(signature = (eta, stiffness, terms, form = "auto", width = None, thickness = None))]
    fn new(
        eta: f64,
        stiffness: (f64, f64, f64, f64),
        terms: Vec<Term>,
        form: &str,
        width: Option<Along>,
        thickness: Option<Along>,
    ) -> PyResult<Self> {
        let named = Form::NAMES.iter().find(|(name, _)| *name == form);
        let (_, form) = named.ok_or_else(|| {
            let names = Form::NAMES.map(|(name, _)| name).join(", ");
            InvalidInput::new("form", format!("{form:?}"), &format!("one of {names}"))
        })?;
        let (q33, q22, q23, g) = stiffness;
        let law = RibbonLaw::new(RibbonSpec {
            eta,
            stiffness: PlaneStress::new(q33, q22, q23, g)?,
            form: *form,
            growth: terms.into_iter().map(term).collect::<PyResult<_>>()?,
            width: factor(width)?,
            thickness: factor(thickness)?,
        })?;
        Ok(Self { law })
    }

    /// The form in use, of a ribbon that varies at its start.
    #[getter]
    fn form(&self) -> PyResult<&'static str> {
        let start = self.law.breaks().first().copied().unwrap_or(0.0);
        Ok(self.law.station(start)?.section().form().name())
    }

    /// Thickness ratio h/a of reference.
    #[getter]
    fn eta(&self) -> f64 {
        self.law.spec().eta
    }

    /// Whether growth, width or thickness vary along the ribbon.
    #[getter]
    fn varies(&self) -> bool {
        self.law.varies()
    }

    /// |K2| up to which the energy of the section at S is resolved to rounding.
    #[pyo3(signature = (S = 0.0))]
    #[expect(non_snake_case, reason = "the name in Python")]
    fn resolved_curvature(&self, S: f64) -> PyResult<f64> {
        let station = self.law.station(S)?;
        Ok(station.section().resolved_curvature() / station.width())
    }

    /// Energies (m,) at strains (m, 4), for a ribbon that varies at S (m,).
    #[pyo3(signature = (strains, S = None))]
    #[expect(non_snake_case, reason = "the name in Python")]
    fn energy<'py>(
        &self,
        py: Python<'py>,
        strains: PyReadonlyArray2<'py, f64>,
        S: Option<PyReadonlyArray1<'py, f64>>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let table = self.table(py, &strains, S.as_ref(), |law, strain| [law.energy(strain)])?;
        table.reshape(table.shape()[0])
    }

    /// Gradients (m, 4) at strains (m, 4), for a ribbon that varies at S (m,).
    #[pyo3(signature = (strains, S = None))]
    #[expect(non_snake_case, reason = "the name in Python")]
    fn gradient<'py>(
        &self,
        py: Python<'py>,
        strains: PyReadonlyArray2<'py, f64>,
        S: Option<PyReadonlyArray1<'py, f64>>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.table(py, &strains, S.as_ref(), |law, strain| law.gradient(strain).into())
    }

    /// Hessians (m, 4, 4) at strains (m, 4), for a ribbon that varies at S (m,).
    #[pyo3(signature = (strains, S = None))]
    #[expect(non_snake_case, reason = "the name in Python")]
    fn hessian<'py>(
        &self,
        py: Python<'py>,
        strains: PyReadonlyArray2<'py, f64>,
        S: Option<PyReadonlyArray1<'py, f64>>,
    ) -> PyResult<Bound<'py, PyArray3<f64>>> {
        let hessian = |law: &Station, strain: &Strain| {
            // Symmetric: the order of rows and columns is the same.
            let matrix = law.evaluate(strain).hessian;
            std::array::from_fn::<f64, 16, _>(|i| matrix[(i / 4, i % 4)])
        };
        let table = self.table(py, &strains, S.as_ref(), hessian)?;
        table.reshape([table.shape()[0], 4, 4])
    }

    /// u1/a at x (nx,) for one strain, or its first or second derivative in x.
    #[pyo3(signature = (strain, x, derivative = 0, S = 0.0))]
    #[expect(non_snake_case, reason = "the name in Python")]
    fn deflection<'py>(
        &self,
        py: Python<'py>,
        strain: [f64; 4],
        x: PyReadonlyArray1<'py, f64>,
        derivative: usize,
        S: f64,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let x = x.as_array().to_owned();
        let values = py.detach(|| {
            let station = self.law.station(S)?;
            let shape = station.section().deflection(&station.local(&Strain::from(strain)))?;
            // x = X2 over the local width, u1 and the derivatives over that of reference.
            let w = station.width();
            Ok(match derivative {
                0 => x.map(|&x| w * shape.u1(x)),
                1 => x.map(|&x| shape.slope(x)),
                2 => x.map(|&x| shape.curvature(x) / w),
                _ => return Err(InvalidInput::new("derivative", derivative, "0, 1 or 2")),
            })
        });
        Ok(values?.into_pyarray(py))
    }

    /// u1, u2, u3 (nx, 3) in units of a at x (nx,) for one strain.
    #[pyo3(signature = (strain, x, S = 0.0))]
    #[expect(non_snake_case, reason = "the name in Python")]
    fn displacements<'py>(
        &self,
        py: Python<'py>,
        strain: [f64; 4],
        x: PyReadonlyArray1<'py, f64>,
        S: f64,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let x = x.as_array().to_owned();
        let displacements = py.detach(|| {
            let station = self.law.station(S)?;
            let strain = station.local(&Strain::from(strain));
            let deflection = station.section().deflection(&strain)?;
            let in_plane = station.section().in_plane(&strain, &deflection);
            let w = station.width();
            Ok::<_, InvalidInput>(Array2::from_shape_fn((x.len(), 3), |(i, c)| match c {
                0 => w * deflection.u1(x[i]),
                1 => w * in_plane.u2(x[i]),
                _ => w * in_plane.u3(x[i]),
            }))
        });
        Ok(displacements?.into_pyarray(py))
    }

    /// Every unloaded equilibrium of the section at S, lowest energy first: strains (m, 4), energies (m,),
    /// numbers of negative Hessian eigenvalues (m,), phases, and whether each is told apart from the others.
    #[pyo3(signature = (S = 0.0))]
    #[expect(non_snake_case, reason = "the name in Python")]
    fn natural_shapes<'py>(&self, py: Python<'py>, S: f64) -> PyResult<Shapes<'py>> {
        let shapes = py.detach(|| Ok::<_, InvalidInput>(self.law.station(S)?.natural_shapes()))?;
        Ok(arrays(py, &shapes))
    }

    /// Every shape that is stable at S = 0, followed to S = `length`: fewest jumps, then lowest energy first.
    fn natural_branches(&self, py: Python<'_>, length: f64) -> PyResult<Vec<NaturalBranch>> {
        let branches = py.detach(|| equilibrium::natural_branches(&self.law, length))?;
        Ok(branches.into_iter().map(NaturalBranch::from).collect())
    }
}

/// [`SectionLaw::natural_shapes`] of many uniform ribbons, on all cores.
#[pyfunction]
pub fn natural_shapes_of<'py>(py: Python<'py>, laws: Vec<Py<SectionLaw>>) -> PyResult<Vec<Shapes<'py>>> {
    let shapes = |law: &Py<SectionLaw>| Ok::<_, InvalidInput>(law.get().law.station(0.0)?.natural_shapes());
    let all: Result<Vec<_>, _> = py.detach(|| laws.par_iter().map(shapes).collect());
    Ok(all?.iter().map(|shapes| arrays(py, shapes)).collect())
}

fn arrays<'py>(py: Python<'py>, shapes: &[Equilibrium]) -> Shapes<'py> {
    let strains = Array2::from_shape_fn((shapes.len(), 4), |(i, c)| shapes[i].strain[c]);
    let energies: Array1<f64> = shapes.iter().map(|s| s.energy).collect();
    let indices: Array1<i64> = shapes.iter().map(|s| s.section_index as i64).collect();
    let resolved: Array1<bool> = shapes.iter().map(|s| s.resolved).collect();
    (
        strains.into_pyarray(py),
        energies.into_pyarray(py),
        indices.into_pyarray(py),
        shapes.iter().map(|s| s.phase.name()).collect(),
        resolved.into_pyarray(py),
    )
}

/// A factor of a dimension, 1 if not given.
fn factor(along: Option<Along>) -> Result<Amplitude, InvalidInput> {
    along.map_or(Ok(Amplitude::Constant(1.0)), Along::amplitude)
}

fn term((amplitude, fields): Term) -> PyResult<(Amplitude, Growth)> {
    let mut growth = Growth::default();
    for (name, field) in fields {
        let Some(mine) = growth.field_mut(&name) else {
            return Err(PyValueError::new_err(format!("unknown growth field {name:?}")));
        };
        *mine = match field {
            Across::Polynomial(coefficients) => Profile::from(coefficients),
            Across::Pieces(breaks, pieces) => Profile::from(Piecewise::from_legendre(breaks, pieces)?),
        };
    }
    Ok((amplitude.amplitude()?, growth))
}

type Shapes<'py> = (
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray1<i64>>,
    Vec<&'static str>,
    Bound<'py, PyArray1<bool>>,
);
