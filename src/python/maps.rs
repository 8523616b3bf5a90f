//! Phase diagrams.

use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

use numpy::ndarray::{Array1, Array2, Array3};
use numpy::{IntoPyArray, PyArray1, PyArray2, PyArray3, PyReadonlyArray2};
use pyo3::exceptions::{PyKeyboardInterrupt, PyValueError};
use pyo3::prelude::*;

use super::section::SectionLaw;
use crate::InvalidInput;
use crate::maps::{self, Class, Crossing, Nodes, PhaseMap, Plane, Progress, Sample};

/// How often Python's signals are answered and progress is told.
const POLL: Duration = Duration::from_millis(20);

/// Number of the phase of a class without a stable state.
const NONE_STABLE: i8 = 4;

/// Number of the lowest phase and counts of stable states of each, which Python gets as bytes.
type Side = Option<(i8, [u8; 4])>;
type Line<'py, S> = (Bound<'py, PyArray2<f64>>, Bound<'py, PyArray1<f64>>, S, S);
type Map<'py> = (
    Bound<'py, PyArray2<i8>>,
    Bound<'py, PyArray3<u8>>,
    Bound<'py, PyArray3<f64>>,
    Bound<'py, PyArray2<bool>>,
    Vec<Line<'py, Side>>,
    bool,
);

/// Stable states of unloaded uniform ribbons between those at the corners (0, 0), (1, 0), (0, 1), (1, 1).
///
/// `report(nodes)` is called now and then with how many nodes are done. Phases (ny, nx), numbered as flat, bent,
/// twisted, helical, 4 where no state is stable and -1 where the map was interrupted before; numbers of stable states
/// of each phase (ny, nx, 4); energy, K2 and K3 of the lowest (ny, nx, 3); whether all states are told apart
/// (ny, nx); lines (points, jumps, left, right); whether it was interrupted.
#[pyfunction]
#[pyo3(signature = (laws, xs, ys, tol, report = None))]
pub fn phase_map<'py>(
    py: Python<'py>,
    laws: [Py<SectionLaw>; 4],
    xs: Vec<f64>,
    ys: Vec<f64>,
    tol: f64,
    report: Option<Py<PyAny>>,
) -> PyResult<Map<'py>> {
    let plane = Plane::new(laws.map(|law| law.get().law().spec().clone()))?;
    let progress = Progress::default();
    let run = || maps::phase_map(&plane, &xs, &ys, tol, &progress);
    let (map, ended) = py.detach(|| watched(run, &progress, report.as_ref()));
    let map = map?;
    let interrupted = match ended {
        Ok(()) => false,
        Err(error) if Python::attach(|py| error.is_instance_of::<PyKeyboardInterrupt>(py)) => true,
        Err(error) => return Err(error),
    };
    Ok(arrays(py, &map, [ys.len(), xs.len()], interrupted))
}

/// Runs a map in another thread while this one answers signals; what a handler or `report` raises stops it.
fn watched(
    run: impl FnOnce() -> Result<PhaseMap, InvalidInput> + Send,
    progress: &Progress,
    report: Option<&Py<PyAny>>,
) -> (Result<PhaseMap, InvalidInput>, PyResult<()>) {
    let mut ended = Ok(());
    let (sender, receiver) = channel();
    let result = thread::scope(|scope| {
        let worker = scope.spawn(move || {
            // Dropped at the end, however that comes: it wakes the thread that waits.
            let _sender: std::sync::mpsc::Sender<()> = sender;
            run()
        });
        while let Err(RecvTimeoutError::Timeout) = receiver.recv_timeout(POLL) {
            if ended.is_ok() {
                ended = Python::attach(|py| {
                    py.check_signals()?;
                    report.map_or(Ok(()), |report| report.call1(py, (progress.done(),)).map(drop))
                });
                if ended.is_err() {
                    progress.stop();
                }
            }
        }
        worker.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
    });
    (result, ended)
}

fn side(class: Option<Class>) -> Side {
    class.map(|class| (class.lowest.map_or(NONE_STABLE, |phase| phase as i8), class.stable))
}

fn arrays<'py>(py: Python<'py>, map: &PhaseMap, [ny, nx]: [usize; 2], interrupted: bool) -> Map<'py> {
    let at = |j: usize, i: usize| map.samples[j * nx + i];
    let number = |sample: Sample, k: usize| [sample.energy, sample.k2, sample.k3][k];
    let phase = |(j, i)| side(at(j, i).map(|sample| sample.class)).map_or(-1, |(phase, _)| phase);
    let stable = |(j, i, k): (usize, usize, usize)| at(j, i).map_or(0, |sample| sample.class.stable[k]);
    let numbers = |(j, i, k)| at(j, i).map_or(f64::NAN, |sample| number(sample, k));
    let resolved = |(j, i)| at(j, i).is_some_and(|sample| sample.resolved);
    (
        Array2::from_shape_fn((ny, nx), phase).into_pyarray(py),
        Array3::from_shape_fn((ny, nx, 4), stable).into_pyarray(py),
        Array3::from_shape_fn((ny, nx, 3), numbers).into_pyarray(py),
        Array2::from_shape_fn((ny, nx), resolved).into_pyarray(py),
        lines(py, &map.outline, side),
        interrupted,
    )
}

fn lines<'py, C: Copy, S>(
    py: Python<'py>,
    outline: &[maps::Polyline<C>],
    side: impl Fn(Option<C>) -> S,
) -> Vec<Line<'py, S>> {
    let line = |line: &maps::Polyline<C>| {
        let points = Array2::from_shape_fn((line.points.len(), 2), |(i, k)| line.points[i][k]);
        let jumps = Array1::from(line.jumps.clone());
        (points.into_pyarray(py), jumps.into_pyarray(py), side(line.left), side(line.right))
    };
    outline.iter().map(line).collect()
}

/// Number of an edge, and its changes: x, y, class before and class after.
type Changes = Vec<(usize, Vec<(f64, f64, i64, i64)>)>;

/// Lines between classes at the nodes of a grid, -1 where none is known, whose changes along edges are given.
///
/// `classes` (ny, nx); edge i along x from node (j, i) is number j (nx - 1) + i, along y number j nx + i; an edge
/// that is not among those given has no change if the classes at its ends are the same, else it is not known.
#[pyfunction]
pub fn map_outline<'py>(
    py: Python<'py>,
    classes: PyReadonlyArray2<'py, i64>,
    xs: Vec<f64>,
    ys: Vec<f64>,
    along_x: Changes,
    along_y: Changes,
) -> PyResult<Vec<Line<'py, i64>>> {
    let (nx, ny) = (xs.len(), ys.len());
    let classes = classes.as_array();
    if classes.dim() != (ny, nx) || nx < 2 || ny < 2 {
        return Err(PyValueError::new_err("classes: expected (ny, nx), at least (2, 2)"));
    }
    let classes: Vec<Option<i64>> = classes.iter().map(|&class| (class >= 0).then_some(class)).collect();
    let same = |a: usize, b: usize| classes[a].is_some() && classes[a] == classes[b];
    let mut x: Vec<Option<Vec<Crossing<i64>>>> = (0..(nx - 1) * ny)
        .map(|k| {
            let node = k / (nx - 1) * nx + k % (nx - 1);
            same(node, node + 1).then(Vec::new)
        })
        .collect();
    let mut y: Vec<Option<Vec<Crossing<i64>>>> =
        (0..nx * (ny - 1)).map(|k| same(k, k + nx).then(Vec::new)).collect();
    for (edges, given) in [(&mut x, along_x), (&mut y, along_y)] {
        for (edge, changes) in given {
            let slot = edges.get_mut(edge).ok_or_else(|| PyValueError::new_err("no such edge"))?;
            let crossing = |(x, y, before, after)| Crossing { at: [x, y], before, after, jump: f64::NAN };
            *slot = Some(changes.into_iter().map(crossing).collect());
        }
    }
    let nodes = Nodes { xs: &xs, ys: &ys, classes: &classes, along_x: &x, along_y: &y };
    let (outline, _) = py.detach(|| maps::outline(&nodes, None))?;
    Ok(lines(py, &outline, |side| side.unwrap_or(-1)))
}
