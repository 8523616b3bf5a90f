//! Diagrams of equilibria: branches and what branches off.

use std::sync::{Arc, Mutex};
use std::time::Instant;

use pyo3::prelude::*;

use super::boundary::{BoundaryProblem, BoundarySolution, checked_degree};
use super::interrupt::detached;
use super::section::SectionLaw;
use super::traced::{Asked, HeldBranch, NaturalBranch, TracedBranch, limits};
use crate::InvalidInput;
use crate::boundary::Family;
use crate::continuation::{
    Branch, Held, Limits, Natural, NaturalFamily, Point, Work, begin, begin_with, diagram, reversed,
};
use crate::equilibrium::natural_shapes;

/// Kind, branch, place among its points, parameter, multiplicity.
type SpecialPoint = (String, usize, usize, f64, usize);

/// How often a boundary-value problem was linearised, and seconds: assembly, factorisation, stability index, all.
type Effort = (usize, f64, f64, f64, f64);

/// Branches of equilibria and their special points: kind, branch, point, parameter, multiplicity.
#[pyclass(frozen, module = "ribbonrs._core")]
pub struct Trace {
    branches: Vec<Py<TracedBranch>>,
    special: Vec<SpecialPoint>,
    work: Option<Effort>,
}

#[pymethods]
impl Trace {
    /// The branches, in the order in which they were found.
    #[getter]
    fn branches(&self, py: Python<'_>) -> Vec<Py<TracedBranch>> {
        self.branches.iter().map(|branch| branch.clone_ref(py)).collect()
    }

    /// Kind, branch, place among its points, parameter, multiplicity.
    #[getter]
    fn special_points(&self) -> Vec<SpecialPoint> {
        self.special.clone()
    }

    /// How often the boundary-value problem was linearised, and seconds of assembly, factorisation, stability index, and all.
    #[getter]
    fn work(&self) -> Option<Effort> {
        self.work
    }
}

/// The special points of all branches, in order, and the number of the first of each branch.
fn specials<S, C>(branches: &[Branch<S, C>], asked: &Asked<'_>) -> (Vec<SpecialPoint>, Vec<usize>) {
    let (mut special, mut first) = (Vec::new(), Vec::new());
    for (i, branch) in branches.iter().enumerate() {
        first.push(special.len());
        for one in &branch.special {
            let t = branch.points[one.place].t;
            let value = asked.parameter(t);
            special.push((one.kind.name().to_owned(), i, one.place, value, one.multiplicity));
        }
    }
    (special, first)
}

/// Branches of equilibria of a ribbon between two problems: from `start` at `start_value`, and what branches off.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "what is asked of a trace")]
pub fn trace(
    py: Python<'_>,
    problems: (PyRef<'_, BoundaryProblem>, PyRef<'_, BoundaryProblem>),
    span: [f64; 2],
    start: PyRef<'_, BoundarySolution>,
    start_value: f64,
    values: Vec<f64>,
    depth: usize,
    max_steps: usize,
    tol: f64,
    degree: Option<usize>,
) -> PyResult<Trace> {
    let degree = checked_degree(degree)?;
    let solution = start.solution();
    let length = solution.problem().length;
    let kinks = solution.kinks()?.into_iter().map(|s| s / length).collect();
    let family = Family::new(vec![problems.0.problem(), problems.1.problem()])?.with_kinks(kinks);
    let t = (start_value - span[0]) / (span[1] - span[0]);
    let limits = Limits { tolerance: (0.1 * tol).max(1e-14), ..limits(span, &values, max_steps) };
    let asked = Asked { span, values: &values };
    let (branches, special, work) = detached(py, || {
        let started = Instant::now();
        let mut equations = Held::new(family, 0.0, degree, tol);
        let begun = begin_with(&mut equations, solution, t, &limits);
        let first = begun.map_err(|failed| {
            InvalidInput::new("start", start_value, &format!("an equilibrium: {failed}"))
        })?;
        let first = if t >= 1.0 { reversed(&equations, first) } else { first };
        let found = diagram(&mut equations, vec![first], depth, &limits);
        let (special, first) = specials(&found.branches, &asked);
        let Work { linearisations, assembly, factorisation, index } = equations.work;
        let [assembly, factorisation, index, all] =
            [assembly, factorisation, index, started.elapsed()].map(|part| part.as_secs_f64());
        let work = (linearisations, assembly, factorisation, index, all);
        let equations = Arc::new(Mutex::new(equations));
        let branch = |branch: HeldBranch| {
            let origin = branch.origin.map(|(number, i)| first[number] + i);
            TracedBranch::held(&equations, branch, degree, &asked, origin)
        };
        let branches: Vec<_> = found.branches.into_iter().map(branch).collect::<Result<_, _>>()?;
        Ok((branches, special, work))
    })?;
    let branches = branches.into_iter().map(|branch| Py::new(py, branch)).collect::<PyResult<_>>()?;
    Ok(Trace { branches, special, work: Some(work) })
}

/// Branches of natural shapes of a uniform ribbon between two laws: through all there are at both ends, and what branches off.
#[pyfunction]
pub fn trace_natural(
    py: Python<'_>,
    laws: (PyRef<'_, SectionLaw>, PyRef<'_, SectionLaw>),
    span: [f64; 2],
    values: Vec<f64>,
    depth: usize,
    max_steps: usize,
) -> PyResult<Trace> {
    let family = NaturalFamily::new(vec![laws.0.law().spec().clone(), laws.1.law().spec().clone()])?;
    // Curvatures over the thickness ratio may be large.
    let limits = Limits { longest: 10.0, ..limits(span, &values, max_steps) };
    let (branches, special) = detached(py, || {
        let mut equations = Natural::new(family);
        let mut starts = Vec::new();
        let mut known: Vec<(f64, [f64; 2])> = Vec::new();
        for t in [0.0, 1.0] {
            let station = equations.station(t)?;
            let section = station.section();
            for shape in natural_shapes(section) {
                let x = [shape.strain[2] / section.eta(), shape.strain[3] / section.eta()];
                known.push((t, x));
                if let Ok(point) = begin(&mut equations, x, t, &limits) {
                    starts.push(if t == 1.0 { reversed(&equations, point) } else { point });
                }
            }
        }
        let found = diagram(&mut equations, starts, depth, &limits);
        let asked = Asked { span, values: &values };
        let (special, first) = specials(&found.branches, &asked);
        // An image differs in a sign alone.
        let image = |point: &Point<[f64; 2], [f64; 2]>| {
            known.iter().any(|(t, x)| {
                let same = |i: usize| (x[i].abs() - point.x[i].abs()).abs() <= 1e-9 * (1.0 + x[i].abs());
                *t == point.t && same(0) && same(1) && (0..2).any(|i| (x[i] - point.x[i]).abs() > 1e-6)
            })
        };
        let equations = Arc::new(Mutex::new(equations));
        let branch = |mut branch: NaturalBranch| {
            branch.mirrored = branch.mirrored || branch.points.iter().any(image);
            let origin = branch.origin.map(|(number, i)| first[number] + i);
            TracedBranch::natural(&equations, branch, &asked, origin)
        };
        let branches: Vec<_> = found.branches.into_iter().map(branch).collect::<Result<_, _>>()?;
        Ok((branches, special))
    })?;
    let branches = branches.into_iter().map(|branch| Py::new(py, branch)).collect::<PyResult<_>>()?;
    Ok(Trace { branches, special, work: None })
}
