//! A branch of equilibria, what is told of its points, and what can be asked of it further.

use std::sync::{Arc, Mutex, PoisonError};

use nalgebra::Vector3;
use numpy::ndarray::Array2;
use numpy::{IntoPyArray, PyArray1, PyArray2};
use pyo3::prelude::*;

use super::boundary::{BoundaryProblem, BoundarySolution};
use super::interrupt::{detached, interrupted};
use super::section::SectionLaw;
use crate::InvalidInput;
use crate::boundary::{Correction, Family, Solution, energies};
use crate::continuation::{
    Branch, Ended, Equations, Held, HeldState, Limits, Natural, NaturalFamily, Point, SpecialKind, at_value,
    between, locus,
};
use crate::frame::{Pose, helix};
use crate::section::Strain;

type HeldPoint = Point<HeldState, Correction>;
type NaturalPoint = Point<[f64; 2], [f64; 2]>;
/// A branch of a ribbon that is held.
pub type HeldBranch = Branch<HeldState, Correction>;
/// A branch of natural shapes.
pub type NaturalBranch = Branch<[f64; 2], [f64; 2]>;

/// Both parameters (m, 2), and how the curve ended.
type Curve<'py> = (Bound<'py, PyArray2<f64>>, (&'static str, &'static str));

/// Problems or laws at the corners of the plane of two parameters.
#[derive(FromPyObject)]
enum Corners<'py> {
    Problems(Vec<Bound<'py, BoundaryProblem>>),
    Laws(Vec<Bound<'py, SectionLaw>>),
}

/// What is told of a point of a branch.
struct Row {
    parameter: f64,
    energy: f64,
    load_potential: f64,
    section_index: usize,
    index: f64,
    strains: Strain,
    position: Vector3<f64>,
    reactions: [f64; 12],
}

/// The points of a branch and the equations they solve.
enum Points {
    Natural(Arc<Mutex<Natural>>, Vec<NaturalPoint>),
    Held(Arc<Mutex<Held>>, Vec<HeldPoint>),
}

/// Equilibria along a branch.
#[pyclass(frozen, module = "ribbonrs._core")]
pub struct TracedBranch {
    span: [f64; 2],
    degree: usize,
    points: Points,
    rows: Vec<Row>,
    ended: [Ended; 2],
    origin: Option<usize>,
    mirrored: bool,
}

#[pymethods]
impl TracedBranch {
    /// The parameter (k,).
    #[getter]
    fn parameter<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.column(py, |row| row.parameter)
    }

    /// Elastic energy (k,) over the ribbon.
    #[getter]
    fn energy<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.column(py, |row| row.energy)
    }

    /// Minus the work of dead forces (k,).
    #[getter]
    fn load_potential<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.column(py, |row| row.load_potential)
    }

    /// Largest number of negative eigenvalues of a section's tangent stiffness (k,).
    #[getter]
    fn section_index<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        let indices: Vec<i64> = self.rows.iter().map(|row| row.section_index as i64).collect();
        indices.into_pyarray(py)
    }

    /// The stability index (k,): infinite where a section is unstable, NaN where it cannot be told.
    #[getter]
    fn index<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.column(py, |row| row.index)
    }

    /// Means of the strains over the ribbon (k, 4).
    #[getter]
    fn strains<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<f64>> {
        self.table(py, 4, |row, c| row.strains[c])
    }

    /// Where the end is (k, 3).
    #[getter]
    fn position<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<f64>> {
        self.table(py, 3, |row, c| row.position[c])
    }

    /// Force and moment that the start, then the end, exert on the ribbon, in the fixed basis (k, 12).
    #[getter]
    fn reactions<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<f64>> {
        self.table(py, 12, |row, c| row.reactions[c])
    }

    /// How it ended: its beginning and its end.
    #[getter]
    fn ended(&self) -> (&'static str, &'static str) {
        (self.ended[0].name(), self.ended[1].name())
    }

    /// Why it was not followed further, empty if it was.
    #[getter]
    fn reason(&self) -> String {
        let told = self.ended.iter().filter_map(|ended| match ended {
            Ended::Failed(failed) => Some(failed.to_string()),
            _ => None,
        });
        told.collect::<Vec<_>>().join("; ")
    }

    /// The special point at which it leaves another branch.
    #[getter]
    fn origin(&self) -> Option<usize> {
        self.origin
    }

    /// Whether its mirror image is a branch, too.
    #[getter]
    fn mirrored(&self) -> bool {
        self.mirrored
    }

    /// The equilibrium at a point; None if its strains say all.
    fn solution(&self, py: Python<'_>, i: usize) -> PyResult<Option<BoundarySolution>> {
        match &self.points {
            Points::Natural(..) => Ok(None),
            Points::Held(equations, points) => {
                let point = points.get(i).ok_or_else(|| self.no_point(i))?;
                Ok(Some(py.detach(|| solution(&mut lock(equations), point, self.degree))?))
            }
        }
    }

    /// The special point at a place of the branch as another parameter varies over a span: both parameters (m, 2), and how
    /// the curve ended. The corners are the problems, or laws, at both ends of both spans.
    #[expect(clippy::too_many_arguments, reason = "what is asked of a locus")]
    fn locus<'py>(
        &self,
        py: Python<'py>,
        place: usize,
        kind: &str,
        corners: Corners<'_>,
        other_span: [f64; 2],
        other_value: f64,
        max_steps: usize,
        tol: f64,
    ) -> PyResult<Curve<'py>> {
        let kinds = [SpecialKind::Fold, SpecialKind::BranchPoint, SpecialKind::SectionInstability];
        let kind = kinds.into_iter().find(|one| one.name() == kind);
        let kind = kind.ok_or_else(|| InvalidInput::new("kind", "unknown", "a name that the core gives"))?;
        let u = (other_value - other_span[0]) / (other_span[1] - other_span[0]);
        let limits = Limits { tolerance: (0.1 * tol).max(1e-14), ..limits(self.span, &[], max_steps) };
        let (places, ended) = match (&self.points, corners) {
            (Points::Natural(_, points), Corners::Laws(laws)) => {
                let specs = laws.iter().map(|law| law.get().law().spec().clone()).collect();
                let mut equations = Natural::new(NaturalFamily::new(specs)?);
                let point = points.get(place).ok_or_else(|| self.no_point(place))?;
                let found = detached(py, || Ok(locus(&mut equations, point, u, kind, &limits)))?;
                (found.places, found.ended)
            }
            (Points::Held(_, points), Corners::Problems(problems)) => {
                let family = Family::new(problems.iter().map(|problem| problem.get().problem()).collect())?;
                let point = points.get(place).ok_or_else(|| self.no_point(place))?;
                let mut equations = Held::new(family, u, self.degree, tol);
                let found = detached(py, || Ok(locus(&mut equations, point, u, kind, &limits)))?;
                (found.places, found.ended)
            }
            _ => return Err(InvalidInput::new("corners", "of another kind", "those of the branch").into()),
        };
        let spans = [self.span, other_span];
        let table = Array2::from_shape_fn((places.len(), 2), |(i, c)| parameter(spans[c], places[i][c]));
        Ok((table.into_pyarray(py), (ended[0].name(), ended[1].name())))
    }

    /// The equilibrium at a fraction of the way from a point to the next: its parameter, mean strains, and solution.
    fn between<'py>(&self, py: Python<'py>, i: usize, fraction: f64) -> PyResult<Inside<'py>> {
        self.inside(py, i, Place::Fraction(fraction))
    }

    /// The equilibrium between a point and the next at a value of the parameter: that, mean strains, and solution.
    fn at_value<'py>(&self, py: Python<'py>, i: usize, value: f64) -> PyResult<Inside<'py>> {
        let t = (value - self.span[0]) / (self.span[1] - self.span[0]);
        self.inside(py, i, Place::Value(t))
    }
}

/// Where an equilibrium between two points is.
#[derive(Clone, Copy)]
enum Place {
    /// At this part of the way.
    Fraction(f64),
    /// At this parameter.
    Value(f64),
}

impl Place {
    /// The equilibrium there.
    fn of<E: Equations>(
        self,
        equations: &mut E,
        a: &Point<E::State, E::Change>,
        b: &Point<E::State, E::Change>,
    ) -> Result<Point<E::State, E::Change>, InvalidInput> {
        let (field, place, found) = match self {
            Self::Fraction(part) => {
                let found = between(equations, a, b, part * (b.s - a.s));
                // Next to a special point the point itself.
                ("fraction", part, found.or_else(|| next_to(part, a, b)))
            }
            Self::Value(t) => ("parameter", t, at_value(equations, a, b, t)),
        };
        found.ok_or_else(|| InvalidInput::new(field, place, "a place at which there is an equilibrium"))
    }
}

/// An equilibrium: its parameter, mean strains, and solution.
type Inside<'py> = (f64, Bound<'py, PyArray1<f64>>, Option<BoundarySolution>);

impl TracedBranch {
    /// The equilibrium between a point and the next.
    fn inside<'py>(&self, py: Python<'py>, i: usize, place: Place) -> PyResult<Inside<'py>> {
        let (row, solution) = py.detach(|| match &self.points {
            Points::Natural(equations, points) => {
                let [a, b] = pair(points, i).ok_or_else(|| self.no_point(i))?;
                let mut equations = lock(equations);
                let point = place.of(&mut *equations, a, b)?;
                Ok::<_, InvalidInput>((natural_row(&mut equations, &point, self.span)?, None))
            }
            Points::Held(equations, points) => {
                let [a, b] = pair(points, i).ok_or_else(|| self.no_point(i))?;
                let mut equations = lock(equations);
                let point = place.of(&mut *equations, a, b)?;
                let row = held_row(&mut equations, &point, self.span, self.degree)?;
                Ok((row, Some(solution(&mut equations, &point, self.degree)?)))
            }
        })?;
        Ok((row.parameter, row.strains.as_slice().to_vec().into_pyarray(py), solution))
    }

    /// A branch of a ribbon that is held, `origin` the number of the special point that it leaves.
    ///
    /// # Errors
    /// Where a section is refused.
    pub fn held(
        equations: &Arc<Mutex<Held>>,
        branch: HeldBranch,
        degree: usize,
        asked: &Asked<'_>,
        origin: Option<usize>,
    ) -> Result<Self, InvalidInput> {
        let Branch { points, ended, mirrored, .. } = branch;
        let span = asked.span;
        let rows = points.iter().map(|point| held_row(&mut lock(equations), point, span, degree));
        let rows = asked.exactly(rows.collect::<Result<_, _>>()?);
        let points = Points::Held(Arc::clone(equations), points);
        Ok(Self { span, degree, points, rows, ended, origin, mirrored })
    }

    /// The same of natural shapes.
    ///
    /// # Errors
    /// Where a section is refused.
    pub fn natural(
        equations: &Arc<Mutex<Natural>>,
        branch: NaturalBranch,
        asked: &Asked<'_>,
        origin: Option<usize>,
    ) -> Result<Self, InvalidInput> {
        let Branch { points, ended, mirrored, .. } = branch;
        let span = asked.span;
        let rows = points.iter().map(|point| natural_row(&mut lock(equations), point, span));
        let rows = asked.exactly(rows.collect::<Result<_, _>>()?);
        let points = Points::Natural(Arc::clone(equations), points);
        Ok(Self { span, degree: 0, points, rows, ended, origin, mirrored })
    }

    fn column<'py>(&self, py: Python<'py>, of: impl Fn(&Row) -> f64) -> Bound<'py, PyArray1<f64>> {
        self.rows.iter().map(of).collect::<Vec<_>>().into_pyarray(py)
    }

    fn table<'py>(
        &self,
        py: Python<'py>,
        columns: usize,
        of: impl Fn(&Row, usize) -> f64,
    ) -> Bound<'py, PyArray2<f64>> {
        Array2::from_shape_fn((self.rows.len(), columns), |(i, c)| of(&self.rows[i], c)).into_pyarray(py)
    }

    fn no_point(&self, i: usize) -> InvalidInput {
        InvalidInput::new("point", i, &format!("a number below {}", self.rows.len()))
    }
}

/// What a panic elsewhere left behind is whole: each method begins anew.
fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The end of a piece of a branch that a fraction of it is next to.
fn next_to<S: Clone, C: Clone>(fraction: f64, a: &Point<S, C>, b: &Point<S, C>) -> Option<Point<S, C>> {
    match fraction {
        ..1e-3 => Some(a.clone()),
        0.999.. => Some(b.clone()),
        _ => None,
    }
}

fn pair<T>(points: &[T], i: usize) -> Option<[&T; 2]> {
    Some([points.get(i)?, points.get(i + 1)?])
}

fn solution(
    equations: &mut Held,
    point: &HeldPoint,
    degree: usize,
) -> Result<BoundarySolution, InvalidInput> {
    let problem = equations.problem(point.t)?;
    let nodes = point.x.places(problem.length);
    let solution = Solution::found(problem, degree, nodes, point.x.x.clone())?;
    Ok(BoundarySolution::from(solution))
}

/// What a trace was asked for.
#[derive(Clone, Copy)]
pub struct Asked<'a> {
    /// Ends of the range of the parameter.
    pub span: [f64; 2],
    /// Its values at which points are to be.
    pub values: &'a [f64],
}

impl Asked<'_> {
    /// The parameter at `t`: where it is a value that was asked for but for rounding, that.
    pub fn parameter(&self, t: f64) -> f64 {
        self.exact(parameter(self.span, t))
    }

    fn exact(&self, value: f64) -> f64 {
        let near = |one: &&f64| (**one - value).abs() <= 1e-12 * (self.span[1] - self.span[0]);
        self.values.iter().find(near).copied().unwrap_or(value)
    }

    fn exactly(&self, mut rows: Vec<Row>) -> Vec<Row> {
        rows.iter_mut().for_each(|row| row.parameter = self.exact(row.parameter));
        rows
    }
}

fn parameter(span: [f64; 2], t: f64) -> f64 {
    if t == 1.0 { span[1] } else { span[0] + t * (span[1] - span[0]) }
}

/// The index where sections are stable, else infinite.
fn index(section_index: usize, index: Option<usize>) -> f64 {
    match (section_index, index) {
        (0, Some(index)) => index as f64,
        (0, None) => f64::NAN,
        _ => f64::INFINITY,
    }
}

fn natural_row(equations: &mut Natural, point: &NaturalPoint, span: [f64; 2]) -> Result<Row, InvalidInput> {
    let station = equations.station(point.t)?;
    let section = station.section();
    let (eta, r) = (section.eta(), section.reduction());
    let [k, q] = point.x;
    let local = Strain::new(r.eps - (q * eta).powi(2) / 24.0, r.k1, k * eta, q * eta);
    let strains = station.reference(&local);
    // The energy is stationary: the sections' own index is that of the ribbon.
    let section_index = point.stability.index.unwrap_or(0);
    let start = Pose::new([0.0; 3], [1.0, 0.0, 0.0, 0.0]);
    Ok(Row {
        parameter: parameter(span, point.t),
        energy: station.energy(&strains),
        load_potential: 0.0,
        section_index,
        index: index(section_index, Some(0)),
        strains,
        position: helix(&[1.0], &strains, &start)[0].position,
        reactions: [0.0; 12],
    })
}

fn held_row(
    equations: &mut Held,
    point: &HeldPoint,
    span: [f64; 2],
    degree: usize,
) -> Result<Row, InvalidInput> {
    let problem = equations.problem(point.t)?;
    let mesh = point.x.mesh(&problem, degree)?;
    let x = &point.x.x;
    let energies = energies(&mesh, x)?;
    let mut strains = Strain::zeros();
    for i in 0..mesh.elements() {
        for (strain, weight) in x.strains[i * degree..].iter().zip(&mesh.gauss.weights) {
            strains += strain * (weight * mesh.length(i) / problem.length);
        }
    }
    let (start, end) = (&x.nodes[0], &x.nodes[x.nodes.len() - 1]);
    let mut reactions = [0.0; 12];
    for (i, v) in [-start.force, -start.moment(), end.force, end.moment()].iter().enumerate() {
        reactions[3 * i..3 * i + 3].copy_from_slice(v.as_slice());
    }
    let stability = &point.stability;
    Ok(Row {
        parameter: parameter(span, point.t),
        energy: energies.elastic,
        load_potential: energies.load,
        section_index: stability.section_index,
        index: index(stability.section_index, stability.index),
        strains,
        position: end.position,
        reactions,
    })
}

/// How far and how finely a branch over a span of the parameter is followed.
pub fn limits(span: [f64; 2], values: &[f64], steps: usize) -> Limits {
    let mut values: Vec<f64> = values.iter().map(|value| (value - span[0]) / (span[1] - span[0])).collect();
    values.sort_by(f64::total_cmp);
    Limits { steps, values, interrupted: Some(interrupted), ..Limits::default() }
}
