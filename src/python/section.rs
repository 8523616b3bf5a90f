//! The section law.

use std::collections::HashMap;

use numpy::ndarray::{Array1, Array2, Array3};
use numpy::{IntoPyArray, PyArray1, PyArray2, PyArray3, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use super::strains_from;
use crate::InvalidInput;
use crate::equilibrium::natural_shapes;
use crate::growth::Growth;
use crate::material::PlaneStress;
use crate::section::{Form, Section, Strain};

/// Relaxed cross-section energy of a growing ribbon.
#[pyclass(frozen, module = "ribbonrs._core")]
pub struct SectionLaw {
    section: Section,
}

#[pymethods]
impl SectionLaw {
    #[new]
    #[pyo3(signature = (eta, stiffness, fields, form = "auto"))]
    fn new(
        eta: f64,
        stiffness: (f64, f64, f64, f64),
        fields: HashMap<String, Vec<f64>>,
        form: &str,
    ) -> PyResult<Self> {
        let mut growth = Growth::default();
        for (name, coefficients) in fields {
            match growth.field_mut(&name) {
                Some(field) => *field = coefficients,
                None => return Err(PyValueError::new_err(format!("unknown growth field {name:?}"))),
            }
        }
        let (q33, q22, q23, g) = stiffness;
        let named = Form::NAMES.iter().find(|(name, _)| *name == form);
        let (_, form) = named.ok_or_else(|| {
            let names = Form::NAMES.map(|(name, _)| name).join(", ");
            InvalidInput::new("form", format!("{form:?}"), &format!("one of {names}"))
        })?;
        let stiffness = PlaneStress::new(q33, q22, q23, g)?;
        let section = Section::new(eta, &growth, &stiffness, *form)?;
        Ok(Self { section })
    }

    /// The form in use.
    #[getter]
    fn form(&self) -> &'static str {
        self.section.form().name()
    }

    /// Thickness ratio h/a.
    #[getter]
    fn eta(&self) -> f64 {
        self.section.eta()
    }

    /// Energies (m,) at strains (m, 4).
    fn energy<'py>(
        &self,
        py: Python<'py>,
        strains: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let strains = strains_from(&strains)?;
        let energy = |s: &Strain| self.section.energy(s);
        let values: Array1<f64> = py.detach(|| strains.iter().map(energy).collect());
        Ok(values.into_pyarray(py))
    }

    /// Gradients (m, 4) at strains (m, 4).
    fn gradient<'py>(
        &self,
        py: Python<'py>,
        strains: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let strains = strains_from(&strains)?;
        let gradient = |s: &Strain| self.section.gradient(s);
        let rows: Vec<_> = py.detach(|| strains.iter().map(gradient).collect());
        Ok(Array2::from_shape_fn((rows.len(), 4), |(i, c)| rows[i][c]).into_pyarray(py))
    }

    /// Hessians (m, 4, 4) at strains (m, 4).
    fn hessian<'py>(
        &self,
        py: Python<'py>,
        strains: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<Bound<'py, PyArray3<f64>>> {
        let strains = strains_from(&strains)?;
        let hessian = |s: &Strain| self.section.evaluate(s).hessian;
        let blocks: Vec<_> = py.detach(|| strains.iter().map(hessian).collect());
        let shape = (blocks.len(), 4, 4);
        Ok(Array3::from_shape_fn(shape, |(i, r, c)| blocks[i][(r, c)]).into_pyarray(py))
    }

    /// u1/a at x (nx,) for one strain, or its first or second derivative in x.
    #[pyo3(signature = (strain, x, derivative = 0))]
    fn deflection<'py>(
        &self,
        py: Python<'py>,
        strain: [f64; 4],
        x: PyReadonlyArray1<'py, f64>,
        derivative: usize,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let x = x.as_array().to_owned();
        let values = py.detach(|| {
            let shape = self.section.deflection(&Strain::from(strain))?;
            Ok(match derivative {
                0 => x.map(|&x| shape.u1(x)),
                1 => x.map(|&x| shape.slope(x)),
                2 => x.map(|&x| shape.curvature(x)),
                _ => return Err(InvalidInput::new("derivative", derivative, "0, 1 or 2")),
            })
        });
        Ok(values?.into_pyarray(py))
    }

    /// u1, u2, u3 (nx, 3) in units of a at x (nx,) for one strain.
    fn displacements<'py>(
        &self,
        py: Python<'py>,
        strain: [f64; 4],
        x: PyReadonlyArray1<'py, f64>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let x = x.as_array().to_owned();
        let displacements = py.detach(|| {
            let strain = Strain::from(strain);
            let deflection = self.section.deflection(&strain)?;
            let in_plane = self.section.in_plane(&strain, &deflection);
            Ok::<_, InvalidInput>(Array2::from_shape_fn((x.len(), 3), |(i, c)| match c {
                0 => deflection.u1(x[i]),
                1 => in_plane.u2(x[i]),
                _ => in_plane.u3(x[i]),
            }))
        });
        Ok(displacements?.into_pyarray(py))
    }

    /// Every unloaded equilibrium, lowest energy first: strains (m, 4), energies (m,), numbers of
    /// negative Hessian eigenvalues (m,), phases, and whether each is told apart from the others.
    fn natural_shapes<'py>(&self, py: Python<'py>) -> Shapes<'py> {
        let shapes = py.detach(|| natural_shapes(&self.section));
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
}

type Shapes<'py> = (
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray1<i64>>,
    Vec<&'static str>,
    Bound<'py, PyArray1<bool>>,
);
