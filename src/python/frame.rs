//! Frame integrators. `S` is the arc length, named as in the public interface.
#![allow(non_snake_case)]

use numpy::ndarray::Array2;
use numpy::{IntoPyArray, PyArray2, PyReadonlyArray1, PyReadonlyArray2, PyReadonlyArray3};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use super::strains_from;
use crate::frame::{self, Pose};
use crate::section::Strain;

pub type Poses<'py> = (Bound<'py, PyArray2<f64>>, Bound<'py, PyArray2<f64>>);

/// Positions (n, 3) and quaternions (n, 4) that an integrator finds, without the interpreter's lock.
pub fn poses(py: Python<'_>, integrate: impl FnOnce() -> Vec<Pose> + Send) -> Poses<'_> {
    let poses = py.detach(integrate);
    let position = Array2::from_shape_fn((poses.len(), 3), |(i, c)| poses[i].position[c]);
    let quaternion = Array2::from_shape_fn((poses.len(), 4), |(i, c)| poses[i].quaternion()[c]);
    (position.into_pyarray(py), quaternion.into_pyarray(py))
}

fn expect(what: &str, found: usize, expected: usize) -> PyResult<()> {
    if found == expected {
        return Ok(());
    }
    Err(PyValueError::new_err(format!("{what}: {found}, expected {expected}")))
}

/// Exact poses at each S for a constant strain, from the pose at S = 0.
#[pyfunction]
pub fn helix<'py>(
    py: Python<'py>,
    S: PyReadonlyArray1<'py, f64>,
    strain: [f64; 4],
    position: [f64; 3],
    quaternion: [f64; 4],
) -> Poses<'py> {
    let s = S.as_array().to_vec();
    poses(py, move || frame::helix(&s, &Strain::from(strain), &Pose::new(position, quaternion)))
}

/// Poses at the nodes S for strains (n-1, 4) constant on each segment.
#[pyfunction]
pub fn integrate_segments<'py>(
    py: Python<'py>,
    S: PyReadonlyArray1<'py, f64>,
    strains: PyReadonlyArray2<'py, f64>,
    position: [f64; 3],
    quaternion: [f64; 4],
) -> PyResult<Poses<'py>> {
    let (s, strains) = (S.as_array().to_vec(), strains_from(&strains)?);
    expect("rows of strains", strains.len() + 1, s.len())?;
    Ok(poses(py, move || frame::integrate_segments(&s, &strains, &Pose::new(position, quaternion))))
}

/// Poses at the nodes S for nodal strains (n, 4): cubic interpolation, order 4.
#[pyfunction]
pub fn integrate_nodal<'py>(
    py: Python<'py>,
    S: PyReadonlyArray1<'py, f64>,
    strains: PyReadonlyArray2<'py, f64>,
    position: [f64; 3],
    quaternion: [f64; 4],
) -> PyResult<Poses<'py>> {
    let (s, strains) = (S.as_array().to_vec(), strains_from(&strains)?);
    expect("rows of strains", strains.len(), s.len())?;
    Ok(poses(py, move || frame::integrate_nodal(&s, &strains, &Pose::new(position, quaternion))))
}

/// The (n-1, 3) points at which integrate_gauss needs the strains.
#[pyfunction]
pub fn gauss_points<'py>(py: Python<'py>, S: PyReadonlyArray1<'py, f64>) -> Bound<'py, PyArray2<f64>> {
    let points = frame::gauss_points(&S.as_array().to_vec());
    Array2::from_shape_fn((points.len(), 3), |(i, c)| points[i][c]).into_pyarray(py)
}

/// Poses at the nodes S for strains (n-1, 3, 4) at the Gauss points: order 6.
#[pyfunction]
pub fn integrate_gauss<'py>(
    py: Python<'py>,
    S: PyReadonlyArray1<'py, f64>,
    strains: PyReadonlyArray3<'py, f64>,
    position: [f64; 3],
    quaternion: [f64; 4],
) -> PyResult<Poses<'py>> {
    let s = S.as_array().to_vec();
    let array = strains.as_array();
    let (segments, points, components) = array.dim();
    expect("segments of strains", segments + 1, s.len())?;
    expect("points per segment", points, 3)?;
    expect("strain components", components, 4)?;
    let strain = |i, p| Strain::from_fn(|c, _| array[(i, p, c)]);
    let strains: Vec<[Strain; 3]> = (0..segments).map(|i| std::array::from_fn(|p| strain(i, p))).collect();
    Ok(poses(py, move || frame::integrate_gauss(&s, &strains, &Pose::new(position, quaternion))))
}
