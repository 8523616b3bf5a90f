//! A discrete equilibrium of a ribbon that is held, and meshes for it.

use std::sync::Arc;

use super::branch::{Limits, begin, within};
use super::correct::PointOf;
use super::equations::Failed;
use super::held::Held;
use crate::InvalidInput;
use crate::boundary::{
    At, Correction, Estimate, Iterate, Mesh, Problem, Solution, Stepper, Units, divided, parts_for_waves,
    refined, symmetrised, transferred,
};
use crate::section::Strain;

/// Elements that are too many.
const MOST_ELEMENTS: usize = 1000;

/// A discrete equilibrium with its mesh.
#[derive(Clone, Debug)]
pub struct HeldState {
    /// Ends of the elements, over the length.
    pub nodes: Arc<Vec<f64>>,
    /// The unknowns.
    pub x: Iterate,
}

/// The first point of the branch through a solution: its own, then that on a mesh which is symmetric, if its own nearly is; or that on elements
/// of another degree. Between its stages the error of strains is larger than that of the solution.
///
/// # Errors
/// If it is no equilibrium there, or a section is refused.
pub fn begin_with(
    equations: &mut Held,
    solution: &Solution,
    t: f64,
    limits: &Limits,
) -> Result<PointOf<Held>, Failed> {
    let (problem, nodes) = (solution.problem(), solution.nodes().to_vec());
    let symmetric = symmetrised(nodes.clone(), problem);
    let mesh = Mesh::new(problem, nodes, solution.degree())?;
    if mesh.gauss.degree != equations.degree() {
        let other = on_mesh(&mesh, solution.iterate(), symmetric, equations.degree())?;
        return within(equations, other, t, BETWEEN, limits);
    }
    let moved = mesh.nodes.iter().zip(&symmetric).map(|(from, to)| (from - to).abs()).fold(0.0, f64::max);
    if mesh.nodes.len() == symmetric.len() && moved < ROUNDING * problem.length {
        return begin(equations, on_nodes(&mesh, solution.iterate(), symmetric)?, t, limits);
    }
    let own = on_nodes(&mesh, solution.iterate(), mesh.nodes.clone())?;
    let first = begin(equations, own, t, limits)?;
    within(equations, on_nodes(&mesh, &first.x.x, symmetric)?, t, BETWEEN, limits)
}

/// Distance of nodes, over the length, that changes nothing between stages.
const ROUNDING: f64 = 1e-12;
/// Distance, in strains and angles, of a state that was interpolated from the equilibrium.
const BETWEEN: f64 = 0.1;

impl HeldState {
    /// Ends of the elements where the ribbon has this length.
    #[must_use]
    pub fn places(&self, length: f64) -> Vec<f64> {
        let mut places: Vec<f64> = self.nodes.iter().map(|s| s * length).collect();
        places.last_mut().into_iter().for_each(|s| *s = length);
        places
    }

    /// Its mesh, for a problem.
    ///
    /// # Errors
    /// Where a section is refused.
    pub fn mesh(&self, problem: &Arc<Problem>, degree: usize) -> Result<Mesh, InvalidInput> {
        Mesh::new(problem, self.places(problem.length), degree)
    }

    /// The state on a mesh on which its error meets a tolerance.
    ///
    /// # Errors
    /// Where that has too many elements, or a section is refused.
    pub fn refined(&self, mesh: &Mesh, estimated: &Estimate, tolerance: f64) -> Result<Self, Failed> {
        self.on_finer(mesh, refined(mesh, estimated, tolerance))
    }

    /// The state on a mesh that shows all ways in which it may buckle, or the first ten where they crowd; `None` if its own does.
    ///
    /// # Errors
    /// Where that has too many elements, or a section is refused.
    pub fn showing_waves(&self, mesh: &Mesh) -> Result<Option<Self>, Failed> {
        let Some(parts) = parts_for_waves(mesh, &self.x, false)? else { return Ok(None) };
        let count = parts.iter().fold(0_usize, |sum, parts| sum.saturating_add(*parts));
        if count > MOST_ELEMENTS {
            return Err(Failed::Fine(count));
        }
        self.on_finer(mesh, divided(mesh, &parts)).map(Some)
    }

    fn on_finer(&self, mesh: &Mesh, nodes: Vec<f64>) -> Result<Self, Failed> {
        let nodes = symmetrised(nodes, &mesh.problem);
        if nodes.len() > MOST_ELEMENTS {
            return Err(Failed::Fine(nodes.len()));
        }
        Ok(on_nodes(mesh, &self.x, nodes)?)
    }

    /// The state with every element halved; `None` where there are too many.
    ///
    /// # Errors
    /// Where a section is refused.
    pub fn doubled(&self, mesh: &Mesh) -> Result<Option<Self>, InvalidInput> {
        if mesh.elements() >= MOST_ELEMENTS {
            return Ok(None);
        }
        let halves = mesh.nodes.windows(2).flat_map(|ends| [ends[0], 0.5 * (ends[0] + ends[1])]);
        on_nodes(mesh, &self.x, halves.chain([mesh.problem.length]).collect()).map(Some)
    }

    /// The nodes of the ribbon whose strains change all along by the same, from its start.
    pub fn turned(&self, mesh: &Mesh, by: &Strain) -> Option<Vec<At>> {
        let mut stepper = Stepper::new(&mesh.problem, mesh.gauss).ok()?;
        let mut nodes = vec![self.x.nodes[0]];
        for i in 0..mesh.elements() {
            let strain = |c: f64| self.x.strain(mesh, i, c) + by;
            let (at, _) = stepper.step(&nodes[i], mesh.nodes[i], mesh.length(i), strain, false).ok()?;
            nodes.push(at);
        }
        Some(nodes)
    }
}

/// Radians by which a ribbon is bent or twisted to see where that leads.
const TURN: f64 = 1e-6;
/// Force and moment, in units, that are none.
const NOTHING: f64 = 1e-6;

impl HeldState {
    /// The change in which sections that are about to become unstable give way, the same all along, if the ribbon is free to: uniform, and
    /// without forces.
    #[must_use]
    pub fn giving_way(&self, problem: &Arc<Problem>, degree: usize, units: &Units) -> Option<Correction> {
        let mesh = self.mesh(problem, degree).ok()?;
        let bears =
            |at: &At| at.force.norm() > NOTHING * units.force || at.moment().norm() > NOTHING * units.moment;
        if problem.law.varies() || self.x.nodes.iter().any(bears) {
            return None;
        }
        let soft = problem.law.at(0.0).ok()?.neutral(&self.x.strains[0])?;
        let soft = soft / (soft.rows(1, 3).norm() * problem.length);
        let turned = self.turned(&mesh, &(soft * TURN))?;
        let nodes = turned.iter().zip(&self.x.nodes).map(|(to, from)| {
            let shift = (to.position - from.position) / (units.length * TURN);
            let turn = (to.rotation * from.rotation.conjugate()).imag() * (2.0 / TURN);
            let mut change = [0.0; 12];
            change[..3].copy_from_slice(shift.as_slice());
            change[3..6].copy_from_slice(turn.as_slice());
            change
        });
        let (nodes, strains) = (nodes.collect(), vec![soft; self.x.strains.len()]);
        Some(Correction { nodes, strains, slack: Default::default() })
    }
}

/// The state on a mesh of these nodes.
fn on_nodes(mesh: &Mesh, x: &Iterate, nodes: Vec<f64>) -> Result<HeldState, InvalidInput> {
    on_mesh(mesh, x, nodes, mesh.gauss.degree)
}

/// The state on a mesh of these nodes and this degree.
fn on_mesh(mesh: &Mesh, x: &Iterate, nodes: Vec<f64>, degree: usize) -> Result<HeldState, InvalidInput> {
    let other = Mesh::new(&mesh.problem, nodes, degree)?;
    let moved = transferred(x, mesh, &other)?;
    let length = mesh.problem.length;
    Ok(HeldState { nodes: Arc::new(other.nodes.iter().map(|s| s / length).collect()), x: moved })
}
