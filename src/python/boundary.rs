//! The boundary-value solver. `S` is the arc length, named as in the public interface.
#![allow(non_snake_case)]

use std::sync::Arc;

use nalgebra::{Quaternion, Vector3};
use numpy::ndarray::Array2;
use numpy::{IntoPyArray, PyArray1, PyArray2, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;

use super::interrupt::{detached, interrupted};
use super::section::{Along, SectionLaw};
use super::{rows_from, strains_from};
use crate::InvalidInput;
use crate::boundary::{
    At, DEGREE, End, Guess, Hold, Iterate, Law, LineLoad, MAX_DEGREE, PointLoad, Problem, Report, Rod,
    SectionState, Settings, Solution, Status,
};
use crate::section::{RibbonLaw, Strain};

type Vector = Vector3<f64>;
type Three = [f64; 3];
/// Kind, position, rotation before twist, turns, axis, force, moment.
type EndParts = (String, Three, [f64; 4], f64, Three, Three, Three);
type Arrays<'py> = (
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray2<f64>>,
);
type GuessArrays<'py> = (
    PyReadonlyArray1<'py, f64>,
    PyReadonlyArray2<'py, f64>,
    PyReadonlyArray2<'py, f64>,
    PyReadonlyArray2<'py, f64>,
    PyReadonlyArray2<'py, f64>,
    PyReadonlyArray2<'py, f64>,
);

/// A linear law of a rod: inverse stiffnesses (1/EA, 1/EI1, 1/EI2, 1/GJ) and strains without load.
#[pyclass(frozen, module = "ribbonrs._core")]
pub struct LinearLaw {
    rod: Rod,
}

#[pymethods]
impl LinearLaw {
    #[new]
    fn new(compliance: [f64; 4], intrinsic: [f64; 4]) -> PyResult<Self> {
        let bad = compliance.iter().any(|c| !(*c >= 0.0 && c.is_finite())) || compliance[1..] == [0.0; 3];
        if bad || intrinsic.iter().any(|e| !e.is_finite()) {
            let found = format!("{compliance:?}, {intrinsic:?}");
            let expected = "finite numbers >= 0, one of bending or twist above, and finite strains";
            return Err(InvalidInput::new("compliance, intrinsic", found, expected).into());
        }
        Ok(Self { rod: Rod { compliance: compliance.into(), intrinsic: intrinsic.into() } })
    }
}

#[derive(FromPyObject)]
enum AnyLaw<'py> {
    Section(Bound<'py, SectionLaw>),
    Rod(Bound<'py, LinearLaw>),
}

/// A ribbon that is held and loaded.
#[pyclass(frozen, module = "ribbonrs._core")]
pub struct BoundaryProblem {
    problem: Arc<Problem>,
}

/// The solution of a boundary-value problem, or the last state that was reached.
#[pyclass(frozen, module = "ribbonrs._core")]
pub struct BoundarySolution {
    solution: Solution,
}

impl BoundaryProblem {
    /// The problem.
    pub fn problem(&self) -> Arc<Problem> {
        Arc::clone(&self.problem)
    }
}

impl From<Solution> for BoundarySolution {
    fn from(solution: Solution) -> Self {
        Self { solution }
    }
}

impl BoundarySolution {
    /// The solution.
    pub fn solution(&self) -> &Solution {
        &self.solution
    }
}

#[pymethods]
impl BoundaryProblem {
    #[new]
    #[expect(clippy::too_many_arguments, reason = "the parts of a scene")]
    fn new(
        law: AnyLaw<'_>,
        linear: bool,
        length: f64,
        start: EndParts,
        end: EndParts,
        points: Vec<(f64, Three, Three)>,
        force: [Along; 3],
        moment: [Along; 3],
    ) -> PyResult<Self> {
        let law = match law {
            AnyLaw::Rod(rod) => Law::Rod(rod.get().rod),
            AnyLaw::Section(section) => {
                let law = RibbonLaw::new(section.get().law().spec().clone())?;
                if linear { Law::Linearised(law) } else { Law::Relaxed(law) }
            }
        };
        let points = points.into_iter().map(|(s, force, moment)| PointLoad {
            s,
            force: force.into(),
            moment: moment.into(),
        });
        let [fx, fy, fz] = force;
        let [mx, my, mz] = moment;
        let line = LineLoad {
            force: [fx.amplitude()?, fy.amplitude()?, fz.amplitude()?],
            moment: [mx.amplitude()?, my.amplitude()?, mz.amplitude()?],
        };
        let ends = [end_from(start)?, end_from(end)?];
        let problem = Problem::new(law, length, ends, points.collect(), line)?;
        Ok(Self { problem: Arc::new(problem) })
    }

    /// Solves from the natural shape, or from a guess: S (k,), strains (k, 4), position (k, 3), quaternion (k, 4), and
    /// force and moment (k, 3) in the fixed basis, or (0, 3) where they are not known.
    #[pyo3(signature = (tol, degree = None, guess = None))]
    fn solve(
        &self,
        py: Python<'_>,
        tol: f64,
        degree: Option<usize>,
        guess: Option<GuessArrays<'_>>,
    ) -> PyResult<BoundarySolution> {
        let degree = checked_degree(degree)?;
        let guess = guess.map(|arrays| guess_from(&arrays)).transpose()?;
        let settings =
            Settings { tolerance: tol, degree, interrupted: Some(interrupted), ..Settings::default() };
        let problem = Arc::clone(&self.problem);
        let solution = detached(py, || Solution::of(problem, &settings, guess.as_ref()))?;
        Ok(BoundarySolution { solution })
    }

    /// Several equilibria, at most so many, that differ in more than a reflection; what solves the problem from zero load first.
    fn find(
        &self,
        py: Python<'_>,
        tol: f64,
        degree: Option<usize>,
        most: usize,
    ) -> PyResult<Vec<BoundarySolution>> {
        let degree = checked_degree(degree)?;
        let settings =
            Settings { tolerance: tol, degree, interrupted: Some(interrupted), ..Settings::default() };
        let problem = Arc::clone(&self.problem);
        let solutions = detached(py, || {
            let found = crate::boundary::find(&problem, &settings, most)?;
            let solution = |one: crate::boundary::Solved| {
                Solution::from_parts(Arc::clone(&problem), degree, one.nodes, one.x, one.report)
            };
            found.into_iter().map(solution).collect::<Result<Vec<_>, InvalidInput>>()
        })?;
        Ok(solutions.into_iter().map(BoundarySolution::from).collect())
    }

    /// The solution that has these parts, as `BoundarySolution.parts` gave them.
    fn restored(&self, parts: Parts) -> PyResult<BoundarySolution> {
        let (degree, nodes, states, strains, (status, reason), numbers, counts, norms) = parts;
        let status = Status::ALL.into_iter().find(|one| one.name() == status);
        let status =
            status.ok_or_else(|| InvalidInput::new("status", "unknown", "a name that the core gives"))?;
        let [fraction, error, residual, condition] = numbers;
        let [iterations, factorisations, meshes, load_steps] = counts;
        let report = Report {
            status,
            reason,
            fraction,
            error,
            residual,
            condition,
            iterations,
            factorisations,
            meshes,
            load_steps,
            norms,
        };
        let state = |(position, rotation, force, about_origin): State| At {
            position: position.into(),
            rotation: quaternion(rotation),
            force: force.into(),
            about_origin: about_origin.into(),
        };
        let x = Iterate {
            nodes: states.into_iter().map(state).collect(),
            strains: strains.into_iter().map(Strain::from).collect(),
            slack: Default::default(),
        };
        let solution = Solution::from_parts(Arc::clone(&self.problem), degree, nodes, x, report)?;
        Ok(BoundarySolution { solution })
    }
}

/// Position, quaternion, force, moment about the origin.
type State = (Three, [f64; 4], Three, Three);
/// Degree, nodes, states, strains, status and reason, numbers and counts of the report, norms.
type Parts = (usize, Vec<f64>, Vec<State>, Vec<[f64; 4]>, (String, String), [f64; 4], [usize; 4], Vec<f64>);

#[pymethods]
impl BoundarySolution {
    /// How the solve ended.
    #[getter]
    fn status(&self) -> &'static str {
        self.solution.report.status.name()
    }

    /// Why it failed, empty if it did not.
    #[getter]
    fn reason(&self) -> &str {
        &self.solution.report.reason
    }

    /// Whether this is a solution.
    #[getter]
    fn converged(&self) -> bool {
        self.solution.report.status.is_solved()
    }

    /// How much of loads and displacements of the ends was reached.
    #[getter]
    fn fraction(&self) -> f64 {
        self.solution.report.fraction
    }

    /// Ends of the elements.
    #[getter]
    fn breaks<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.solution.nodes().to_vec().into_pyarray(py)
    }

    /// Where strains jump since sections on both sides are in different phases.
    #[getter]
    fn kinks(&self) -> PyResult<Vec<f64>> {
        Ok(self.solution.kinks()?)
    }

    /// Degree of the collocation.
    #[getter]
    fn degree(&self) -> usize {
        self.solution.degree()
    }

    /// Elastic energy over the ribbon.
    #[getter]
    fn energy(&self) -> f64 {
        self.solution.energy
    }

    /// Minus the work of the dead forces.
    #[getter]
    fn load_potential(&self) -> f64 {
        self.solution.load_potential
    }

    /// Largest number of negative eigenvalues of the section's tangent stiffness.
    #[getter]
    fn section_index(&self) -> usize {
        self.solution.section_index
    }

    /// The least and the greatest of each strain, at the stages and at the nodes.
    #[getter]
    fn extremes(&self) -> [[f64; 4]; 2] {
        let extremes = self.solution.extremes();
        [extremes.least.into(), extremes.greatest.into()]
    }

    /// Whether no strain differs by more than this along the ribbon.
    fn is_uniform(&self, py: Python<'_>, most: [f64; 4]) -> PyResult<bool> {
        Ok(py.detach(|| self.solution.is_uniform(&most.into()))?)
    }

    /// The stability index under the end conditions; None where it cannot be told.
    #[getter]
    fn index(&self) -> Option<usize> {
        self.solution.index
    }

    /// Number of independent motions that change nothing.
    fn free_motions(&self) -> PyResult<usize> {
        Ok(self.solution.free_motions()?)
    }

    /// Estimated error.
    #[getter]
    fn error(&self) -> f64 {
        self.solution.report.error
    }

    /// Residual of the independent check.
    #[getter]
    fn residual(&self) -> f64 {
        self.solution.report.residual
    }

    /// Condition number of the conditions at the ends.
    #[getter]
    fn condition(&self) -> f64 {
        self.solution.report.condition
    }

    /// Newton iterations.
    #[getter]
    fn iterations(&self) -> usize {
        self.solution.report.iterations
    }

    /// Factorisations.
    #[getter]
    fn factorisations(&self) -> usize {
        self.solution.report.factorisations
    }

    /// Meshes.
    #[getter]
    fn meshes(&self) -> usize {
        self.solution.report.meshes
    }

    /// Solves on the way to the loads.
    #[getter]
    fn load_steps(&self) -> usize {
        self.solution.report.load_steps
    }

    /// Norms of the Newton corrections of the last solve.
    #[getter]
    fn residuals(&self) -> Vec<f64> {
        self.solution.report.norms.clone()
    }

    /// Strains (m, 4), positions (m, 3), quaternions (m, 4), and forces and moments (m, 3) on the directors at S (m,).
    fn at<'py>(&self, py: Python<'py>, S: PyReadonlyArray1<'py, f64>) -> PyResult<Arrays<'py>> {
        let s = S.as_array().to_vec();
        let states = py.detach(|| self.solution.many(&s))?;
        let wrenches: Vec<_> = states.iter().map(SectionState::on_directors).collect();
        let rotation = |i: usize, c: usize| {
            let q = &states[i].at.rotation;
            [q.w, q.i, q.j, q.k][c]
        };
        let table = |columns: usize, f: &dyn Fn(usize, usize) -> f64| {
            Array2::from_shape_fn((states.len(), columns), |(i, c)| f(i, c)).into_pyarray(py)
        };
        Ok((
            table(4, &|i, c| states[i].strain[c]),
            table(3, &|i, c| states[i].at.position[c]),
            table(4, &rotation),
            table(3, &|i, c| wrenches[i].0[c]),
            table(3, &|i, c| wrenches[i].1[c]),
        ))
    }

    /// Force and moment that the start, then the end, exert on the ribbon, in the fixed basis, about the end itself.
    fn reactions<'py>(&self, py: Python<'py>) -> [Bound<'py, PyArray1<f64>>; 4] {
        let [start, end] = self.solution.reactions();
        [start.0, start.1, end.0, end.1].map(|v| v.as_slice().to_vec().into_pyarray(py))
    }

    /// What `BoundaryProblem.restored` makes the same solution of.
    fn parts(&self) -> Parts {
        let (solution, report) = (&self.solution, &self.solution.report);
        let x = solution.iterate();
        let state = |at: &At| {
            let q = &at.rotation;
            (at.position.into(), [q.w, q.i, q.j, q.k], at.force.into(), at.about_origin.into())
        };
        (
            solution.degree(),
            solution.nodes().to_vec(),
            x.nodes.iter().map(state).collect(),
            x.strains.iter().map(|&e| e.into()).collect(),
            (report.status.name().to_owned(), report.reason.clone()),
            [report.fraction, report.error, report.residual, report.condition],
            [report.iterations, report.factorisations, report.meshes, report.load_steps],
            report.norms.clone(),
        )
    }
}

/// A degree of the collocation, or the one that is best.
pub fn checked_degree(degree: Option<usize>) -> Result<usize, InvalidInput> {
    let degree = degree.unwrap_or(DEGREE);
    if (1..=MAX_DEGREE).contains(&degree) {
        return Ok(degree);
    }
    Err(InvalidInput::new("degree", degree, &format!("a whole number from 1 to {MAX_DEGREE}")))
}

fn quaternion([w, i, j, k]: [f64; 4]) -> Quaternion<f64> {
    Quaternion::new(w, i, j, k)
}

fn end_from((kind, position, rotation, turns, axis, force, moment): EndParts) -> Result<End, InvalidInput> {
    let axis = Vector::from(axis);
    let hold = match kind.as_str() {
        "clamped" => Hold::Clamped,
        "free" => Hold::Free,
        "pinned" => Hold::Pinned,
        "hinged" => Hold::Hinged(axis.iamax()),
        "sliding" => Hold::Sliding(axis),
        "closed" => Hold::Closed,
        _ => {
            let expected = "clamped, free, pinned, hinged, sliding or closed";
            return Err(InvalidInput::new("kind", kind, expected));
        }
    };
    let rotation = quaternion(rotation);
    Ok(End { hold, position: position.into(), rotation, turns, force: force.into(), moment: moment.into() })
}

fn guess_from((s, strains, position, rotation, force, moment): &GuessArrays<'_>) -> PyResult<Guess> {
    let s = s.as_array().to_vec();
    let strains = strains_from(strains)?;
    let position: Vec<Three> = rows_from("position", position)?;
    let rotation: Vec<[f64; 4]> = rows_from("quaternion", rotation)?;
    let (mut force, mut moment): (Vec<Three>, Vec<Three>) =
        (rows_from("force", force)?, rows_from("moment", moment)?);
    let has_wrench = !force.is_empty();
    if !has_wrench {
        (force, moment) = (vec![[0.0; 3]; s.len()], vec![[0.0; 3]; s.len()]);
    }
    let lengths = [strains.len(), position.len(), rotation.len(), force.len(), moment.len()];
    if s.len() < 2 || lengths.iter().any(|&n| n != s.len()) || !s.windows(2).all(|w| w[0] < w[1]) {
        let found = format!("{} places, {lengths:?} rows", s.len());
        return Err(
            InvalidInput::new("guess", found, "ascending places, two or more, and as many rows").into()
        );
    }
    let state = |i: usize| {
        let (position, force) = (Vector::from(position[i]), Vector::from(force[i]));
        At {
            position,
            rotation: quaternion(rotation[i]).normalize(),
            force,
            about_origin: Vector::from(moment[i]) + position.cross(&force),
        }
    };
    Ok(Guess { states: (0..s.len()).map(state).collect(), strains, s, has_wrench })
}
