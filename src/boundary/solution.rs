//! A solution: its state anywhere, and what follows from it.

use std::sync::Arc;

use nalgebra::Vector3;

use super::adapt::estimate;
use super::check;
use super::ends::{At, Hold, directors};
use super::extremes::Extremes;
use super::gauss::Gauss;
use super::inside::Inside;
use super::iterate::Iterate;
use super::kinks::Phases;
use super::known::Guess;
use super::law::Response;
use super::mesh::Mesh;
use super::problem::Problem;
use super::report::{Report, Status};
use super::sections::sections_at;
use super::solve::{Settings, Solved, goal, solve};
use super::step::{Stepper, solved_pointwise};
use super::system::System;
use crate::InvalidInput;
use crate::section::Strain;

type Vector = Vector3<f64>;

/// Error inside an element, of that of the solution: as good as at its ends; that of a solution that counts, and rounding.
const AS_GOOD: f64 = 0.1;
const MOST_INSIDE: f64 = 1e-6;
const ROUNDING: f64 = 2e-15;

/// The solution of a [`Problem`], or the last state that was reached.
#[derive(Debug)]
pub struct Solution {
    problem: Arc<Problem>,
    degree: usize,
    nodes: Vec<f64>,
    x: Iterate,
    /// How it was found.
    pub report: Report,
    /// Elastic energy, over the whole ribbon.
    pub energy: f64,
    /// Minus the work of dead forces, on displacements from the origin.
    pub load_potential: f64,
    /// Largest number of negative eigenvalues of the tangent stiffness of a section, at stages and nodes.
    pub section_index: usize,
    /// Between which values the strains at nodes are, on both sides of them.
    at_nodes: Extremes,
    /// The same at stages.
    at_stages: Extremes,
    /// Number of independent ways to lower the energy under the end conditions, where every section is stable and the
    /// loads have a potential; gliding and rolling of a closed ribbon are none.
    pub index: Option<usize>,
}

/// The state of one section.
#[derive(Clone, Copy, Debug)]
pub struct SectionState {
    /// Strains.
    pub strain: Strain,
    /// Position, orientation, and resultants in the fixed basis.
    pub at: At,
}

/// A force and a moment.
pub type Wrench = (Vector, Vector);

impl SectionState {
    /// Force and moment on the directors.
    #[must_use]
    pub fn on_directors(&self) -> Wrench {
        let frame = directors(&self.at.rotation);
        (frame.tr_mul(&self.at.force), frame.tr_mul(&self.at.moment()))
    }

    /// `(n3, m1, m2, m3)`.
    pub(super) fn resultants(at: &At) -> Strain {
        let frame = directors(&at.rotation);
        let m = frame.tr_mul(&at.moment());
        Strain::new(frame.column(2).dot(&at.force), m.x, m.y, m.z)
    }
}

/// Energies of a whole ribbon.
#[derive(Clone, Copy, Debug)]
pub struct Energies {
    /// Of its sections.
    pub elastic: f64,
    /// Minus the work of dead forces, on displacements from the origin.
    pub load: f64,
}

/// The energies of a discrete solution.
///
/// # Errors
/// Where a section is refused.
pub fn energies(mesh: &Mesh, x: &Iterate) -> Result<Energies, InvalidInput> {
    let (problem, degree) = (&mesh.problem, mesh.gauss.degree);
    let (mut elastic, mut load) = (0.0, 0.0);
    // Only a force along the line asks where the stages are.
    let mut stepper = problem.has_line_force().then(|| Stepper::new(problem, mesh.gauss)).transpose()?;
    for i in 0..mesh.elements() {
        let mut made = Vec::new();
        let responses = mesh.responses(i, &mut made)?;
        let (s, h) = (mesh.nodes[i], mesh.length(i));
        for (j, &c) in mesh.gauss.nodes.iter().enumerate() {
            let response = &responses[if responses.len() == 1 { 0 } else { j }];
            let strain = x.strains[i * degree + j];
            let weight = h * mesh.gauss.weights[j];
            // A stage is as accurate as the polynomial: what follows is not more.
            let resultants = response.value_alone(&strain);
            let resultants =
                resultants.zip_map(&response.compliance, |v, c| if c > 0.0 { v / c } else { 0.0 });
            elastic += weight * response.energy(&strain, &resultants);
            if let Some(stepper) = &mut stepper {
                let strains = |y: f64| x.strain(mesh, i, c * y);
                let (at, _) = stepper.step(&x.nodes[i], s, c * h, strains, false)?;
                load -= weight * problem.line_load(s + c * h).0.dot(&at.position);
            }
        }
        if let Some((force, _)) = mesh.points[i + 1] {
            load -= force.dot(&x.nodes[i + 1].position);
        }
    }
    for (end, at) in problem.ends.iter().zip([&x.nodes[0], &x.nodes[x.nodes.len() - 1]]) {
        if matches!(end.hold, Hold::Free | Hold::Sliding(_)) {
            load -= end.force.dot(&at.position);
        }
    }
    Ok(Energies { elastic, load })
}

impl Solution {
    /// Solves the problem; [`Report::status`] tells how it ended.
    ///
    /// # Errors
    /// Where a section is refused.
    ///
    /// # Example
    /// A clamped rod under a dead force at its tip, bent through 82 degrees (Mattiasson 1981).
    /// ```
    /// use std::sync::Arc;
    /// use nalgebra::Vector3;
    /// use ribbonrs::boundary::{End, Hold, Law, LineLoad, Problem, Rod, Settings, Solution};
    /// use ribbonrs::section::Strain;
    /// let rod = Rod { compliance: Strain::new(0.0, 1.0, 1.0, 1.0), intrinsic: Strain::zeros() };
    /// let tip = End { force: Vector3::new(10.0, 0.0, 0.0), ..End::new(Hold::Free) };
    /// let (ends, line) = ([End::new(Hold::Clamped), tip], LineLoad::uniform([0.0; 3]));
    /// let problem = Arc::new(Problem::new(Law::Rod(rod), 1.0, ends, vec![], line)?);
    /// let solution = Solution::of(problem, &Settings::default(), None)?;
    /// let tip = solution.at(1.0)?.at.position;
    /// assert!((tip.x - 0.81060902).abs() < 1e-8 && (1.0 - tip.z - 0.55499560).abs() < 1e-8);
    /// # Ok::<(), ribbonrs::InvalidInput>(())
    /// ```
    pub fn of(
        problem: Arc<Problem>,
        settings: &Settings,
        guess: Option<&Guess>,
    ) -> Result<Self, InvalidInput> {
        let Solved { nodes, x, report, index } = solve(&problem, settings, guess)?;
        let Some(index) = index else {
            return Self::from_parts(problem, settings.degree, nodes, x, report);
        };
        let mesh = Mesh::new(&problem, nodes, settings.degree)?;
        let solution = Self::on(&mesh, x, report)?;
        let index = if solution.section_index == 0 { index } else { None };
        Ok(Self { index, ..solution })
    }

    /// A solution from its parts.
    ///
    /// # Errors
    /// If their numbers do not match, or a section is refused.
    pub fn from_parts(
        problem: Arc<Problem>,
        degree: usize,
        nodes: Vec<f64>,
        x: Iterate,
        report: Report,
    ) -> Result<Self, InvalidInput> {
        let count = nodes.len();
        if count < 2 || x.nodes.len() != count || x.strains.len() != (count - 1) * degree {
            let found = format!("{count} nodes, {} states, {} strains", x.nodes.len(), x.strains.len());
            return Err(InvalidInput::new("parts", found, "a state a node and `degree` strains an element"));
        }
        let mesh = Mesh::new(&problem, nodes, degree)?;
        let mut solution = Self::on(&mesh, x, report)?;
        if solution.section_index == 0 && solution.report.fraction == 1.0 {
            solution.index = System::new(mesh)?.index(&solution.x, &goal(&problem));
        }
        Ok(solution)
    }

    /// The solution on a mesh, without its stability index.
    fn on(mesh: &Mesh, x: Iterate, report: Report) -> Result<Self, InvalidInput> {
        let (problem, degree) = (Arc::clone(&mesh.problem), mesh.gauss.degree);
        let Energies { elastic: energy, load: load_potential } = energies(mesh, &x)?;
        let mut section_index = 0;
        let (mut at_nodes, mut at_stages) = (Extremes::default(), Extremes::default());
        let mut take = |extremes: &mut Extremes, response: &Response, strain: &Strain| {
            section_index = section_index.max(response.index(strain));
            extremes.take(strain);
        };
        for (response, strain) in (0..mesh.nodes.len()).flat_map(|node| sections_at(mesh, &x, node)) {
            take(&mut at_nodes, &response, &strain);
        }
        for i in 0..mesh.elements() {
            let mut made = Vec::new();
            let responses = mesh.responses(i, &mut made)?;
            let strains = &x.strains[i * degree..(i + 1) * degree];
            // A uniform ribbon has one law for all stages.
            for (response, strain) in responses.iter().cycle().zip(strains) {
                take(&mut at_stages, response, strain);
            }
        }
        let nodes = mesh.nodes.clone();
        let index = None;
        Ok(Self {
            problem,
            degree,
            nodes,
            x,
            report,
            energy,
            load_potential,
            section_index,
            at_nodes,
            at_stages,
            index,
        })
    }

    /// A solution that was found otherwise, with its error and its residual.
    ///
    /// # Errors
    /// Where a section is refused, or the equations are singular.
    pub fn found(
        problem: Arc<Problem>,
        degree: usize,
        nodes: Vec<f64>,
        x: Iterate,
    ) -> Result<Self, InvalidInput> {
        let mesh = Mesh::new(&problem, nodes, degree)?;
        let residual = check::residual(&mesh, &x)?;
        let mut system = System::new(mesh)?;
        let goal = goal(&problem);
        let regular = system.linearise(&x, &goal).is_ok();
        // Where the equations are singular the error is not known.
        let error = if regular { estimate(&mut system, &x, &goal, 0.0)?.error } else { f64::INFINITY };
        let report = Report {
            status: Status::Converged,
            reason: String::new(),
            fraction: 1.0,
            error,
            residual,
            condition: system.condition(),
            iterations: 0,
            factorisations: 0,
            meshes: 1,
            load_steps: 0,
            norms: Vec::new(),
        };
        let mut solution = Self::on(&system.mesh, x, report)?;
        if solution.section_index == 0 {
            solution.index = if regular {
                system.index_here(&solution.x, goal.load)
            } else {
                system.index(&solution.x, &goal)
            };
        }
        Ok(solution)
    }

    /// Number of independent motions that change nothing; none where the equations are singular otherwise.
    ///
    /// # Errors
    /// Where a section is refused.
    pub fn free_motions(&self) -> Result<usize, InvalidInput> {
        let mesh = Mesh::new(&self.problem, self.nodes.clone(), self.degree)?;
        let mut system = System::new(mesh)?;
        let regular = system.linearise(&self.x, &goal(&self.problem)).is_ok();
        Ok(if regular { system.motions().len() } else { 0 })
    }

    /// The problem.
    #[must_use]
    pub fn problem(&self) -> &Arc<Problem> {
        &self.problem
    }

    /// Degree of the collocation.
    #[must_use]
    pub fn degree(&self) -> usize {
        self.degree
    }

    /// Ends of the elements.
    #[must_use]
    pub fn nodes(&self) -> &[f64] {
        &self.nodes
    }

    /// Nodes at which the sections on both sides are in different phases, so that strains jump though nothing that is given does.
    ///
    /// # Errors
    /// Where a section is refused.
    pub fn kinks(&self) -> Result<Vec<f64>, InvalidInput> {
        let mesh = Mesh::new(&self.problem, self.nodes.clone(), self.degree)?;
        let kinks = Phases::of(&mesh, &self.x)?.kinks;
        Ok(kinks.into_iter().filter(|s| self.nodes.contains(s)).collect())
    }

    /// Between which values the strains are, at stages and nodes.
    #[must_use]
    pub fn extremes(&self) -> Extremes {
        self.at_nodes.with(&self.at_stages)
    }

    /// Whether no strain differs by more than this along the ribbon.
    ///
    /// # Errors
    /// Where a section is refused.
    pub fn is_uniform(&self, most: &Strain) -> Result<bool, InvalidInput> {
        // Most states that vary do so at the nodes, and of most others the stages are alike, too.
        let at_nodes = self.at_nodes.alike(most);
        if !at_nodes || self.extremes().alike(most) {
            return Ok(at_nodes);
        }
        // Stages may differ by the error of a polynomial alone, which the states there do not have.
        let gauss = Gauss::of(self.degree);
        let within = |pair: &[f64]| {
            let (from, length) = (pair[0], pair[1] - pair[0]);
            gauss.nodes.iter().map(move |c| from + c * length)
        };
        let places: Vec<f64> = self.nodes.windows(2).flat_map(within).collect();
        let mut extremes = self.at_nodes;
        self.many(&places)?.iter().for_each(|state| extremes.take(&state.strain));
        Ok(extremes.alike(most))
    }

    /// States at the nodes and strains at the stages.
    #[must_use]
    pub fn iterate(&self) -> &Iterate {
        &self.x
    }

    /// The state at `s` in `[0, L]`, right of a point load.
    ///
    /// # Errors
    /// Where a section is refused.
    pub fn at(&self, s: f64) -> Result<SectionState, InvalidInput> {
        Ok(self.many(&[s])?[0])
    }

    /// The states at many `s`, each as accurate as the nodes: by a step of the method from the node before or, where there are
    /// many in an element, from those at a few places of it; the strains from the resultants there.
    ///
    /// # Errors
    /// Where a section is refused.
    pub fn many(&self, places: &[f64]) -> Result<Vec<SectionState>, InvalidInput> {
        let mut stepper = Stepper::new(&self.problem, Gauss::of(self.degree))?;
        let count = self.nodes.len() - 1;
        let element = |s: f64| self.nodes.partition_point(|&node| node <= s).clamp(1, count) - 1;
        let mut counts = vec![0; count];
        places.iter().for_each(|&s| counts[element(s)] += 1);
        let mut known: Vec<Option<Box<Inside>>> = vec![None; count];
        let mut states = Vec::with_capacity(places.len());
        for &s in places {
            let i = element(s);
            // As many steps are made for the others.
            if counts[i] > self.degree + 2 {
                known[i] = self.inside(&mut stepper, i)?.map(Box::new);
                counts[i] = 0;
            }
            let x = ((s - self.nodes[i]) / (self.nodes[i + 1] - self.nodes[i])).clamp(0.0, 1.0);
            let at = match &known[i] {
                _ if x == 0.0 => self.x.nodes[i],
                _ if x == 1.0 => self.x.nodes[i + 1],
                Some(inside) => inside.at(x),
                None => self.within(&mut stepper, i, x)?.0,
            };
            states.push(self.section(s, at, i, x)?);
        }
        Ok(states)
    }

    /// What tells all states inside an element, if that is as accurate as its ends.
    fn inside(&self, stepper: &mut Stepper, i: usize) -> Result<Option<Inside>, InvalidInput> {
        let gauss = Gauss::of(self.degree);
        let (start, h) = (self.nodes[i], self.nodes[i + 1] - self.nodes[i]);
        let mut at_nodes = Vec::with_capacity(self.degree);
        for &x in &gauss.nodes {
            let (at, solved) = self.within(stepper, i, x)?;
            if !solved {
                return Ok(None);
            }
            let s = start + x * h;
            at_nodes.push((at, self.section(s, at, i, x)?.strain, self.problem.line_load(s)));
        }
        let strain = |x: f64| self.strain(i, x);
        // Before a point load.
        let (end, _) = stepper.step(&self.x.nodes[i], start, h, strain, false)?;
        let inside = Inside::new(gauss, [&self.x.nodes[i], &end], h, &at_nodes);
        let x = inside.farthest();
        let (there, _) = self.within(stepper, i, x)?;
        let most = (AS_GOOD * self.report.error.min(MOST_INSIDE)).max(ROUNDING);
        Ok(if inside.misses(&there, x, self.problem.length) <= most { Some(inside) } else { None })
    }

    /// The state a part `x` of the way through an element, by a step, and whether its strains were solved for.
    fn within(&self, stepper: &mut Stepper, i: usize, x: f64) -> Result<(At, bool), InvalidInput> {
        let (start, h) = (self.nodes[i], self.nodes[i + 1] - self.nodes[i]);
        let (mut at, solved) =
            stepper.step(&self.x.nodes[i], start, x * h, |c| self.strain(i, x * c), true)?;
        at.rotation *= 1.0 / at.rotation.norm();
        Ok((at, solved))
    }

    /// The collocation polynomial of the strains of an element.
    fn strain(&self, i: usize, x: f64) -> Strain {
        let strains = &self.x.strains[i * self.degree..(i + 1) * self.degree];
        strains.iter().zip(Gauss::of(self.degree).basis(x)).map(|(e, l)| e * l).sum()
    }

    /// The section at `s`, a part `x` of the way through an element, with the strains that its resultants ask for: near the polynomial, or, where
    /// it leads from one phase to another, those of the nearest stage whose phase there is.
    fn section(&self, s: f64, at: At, i: usize, x: f64) -> Result<SectionState, InvalidInput> {
        let response = self.problem.law.at(s)?;
        let (resultants, guess) = (SectionState::resultants(&at), self.strain(i, x));
        let strain = solved_pointwise(&response, &resultants, guess).unwrap_or_else(|| {
            let gauss = Gauss::of(self.degree);
            let mut stages: Vec<usize> = (0..self.degree).collect();
            stages.sort_by(|&j, &k| (gauss.nodes[j] - x).abs().total_cmp(&(gauss.nodes[k] - x).abs()));
            let from =
                |j: usize| solved_pointwise(&response, &resultants, self.x.strains[i * self.degree + j]);
            stages.into_iter().find_map(from).unwrap_or(guess)
        });
        Ok(SectionState { strain, at })
    }

    /// Force and moment that the start and the end exert on the ribbon, in the fixed basis, moments about the end itself.
    #[must_use]
    pub fn reactions(&self) -> [Wrench; 2] {
        let wrench = |at: &At, outward: f64| (outward * at.force, outward * at.moment());
        [wrench(&self.x.nodes[0], -1.0), wrench(&self.x.nodes[self.nodes.len() - 1], 1.0)]
    }
}
