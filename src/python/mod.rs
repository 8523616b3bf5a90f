//! The extension module `ribbonrs._core`: arrays in, arrays out, no policy.
//!
//! Checks of what a user writes, names and units are the Python package's; here only what could make
//! the core panic or mislead is refused, as `ValueError`.

mod boundary;
mod branch;
mod frame;
mod interrupt;
mod maps;
mod section;
mod trace;
mod traced;

use numpy::PyReadonlyArray2;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::InvalidInput;
use crate::section::Strain;

impl From<InvalidInput> for PyErr {
    fn from(error: InvalidInput) -> Self {
        PyValueError::new_err(error.to_string())
    }
}

/// Rows of an `(m, 4)` array as strains.
fn strains_from(array: &PyReadonlyArray2<'_, f64>) -> PyResult<Vec<Strain>> {
    let array = array.as_array();
    if array.ncols() != 4 {
        let message = format!("strains have {} columns: expected 4", array.ncols());
        return Err(PyValueError::new_err(message));
    }
    Ok(array.rows().into_iter().map(|r| Strain::new(r[0], r[1], r[2], r[3])).collect())
}

/// Rows of an `(m, N)` array.
fn rows_from<const N: usize>(field: &str, array: &PyReadonlyArray2<'_, f64>) -> PyResult<Vec<[f64; N]>> {
    let array = array.as_array();
    if array.ncols() != N {
        return Err(PyValueError::new_err(format!("{field} has {} columns: expected {N}", array.ncols())));
    }
    Ok(array.rows().into_iter().map(|row| std::array::from_fn(|i| row[i])).collect())
}

/// Numerical core of ribbonrs.
#[pymodule]
mod _core {
    use numpy::PyArray1;
    use pyo3::prelude::*;

    #[pymodule_export]
    use super::boundary::{BoundaryProblem, BoundarySolution, LinearLaw};
    #[pymodule_export]
    use super::branch::NaturalBranch;
    #[pymodule_export]
    use super::frame::{gauss_points, helix, integrate_gauss, integrate_nodal, integrate_segments};
    #[pymodule_export]
    use super::maps::{map_outline, phase_map};
    #[pymodule_export]
    use super::section::{SectionLaw, natural_shapes_of};
    #[pymodule_export]
    use super::trace::{Trace, trace, trace_natural};
    #[pymodule_export]
    use super::traced::TracedBranch;

    /// Looks up numpy's C interface now: the crate panics if that fails, as it would at an interrupt later.
    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        PyArray1::<f64>::zeros(module.py(), 0, false);
        Ok(())
    }
}
