//! A ribbon that is held and loaded: the boundary-value problem with one parameter.

use std::sync::Arc;
use std::time::{Duration, Instant};

use super::equations::{Direction, Equations, Failed, Stability, dot, plus};
use super::held_state::HeldState;
use super::locus::Plane;
use super::motions::Motions;
use crate::InvalidInput;
use crate::boundary::{
    Bordered, Correction, Defects, Failure, Family, Hold, Layout, Line, Problem, SelfStress, System, Units,
    defects, goal, transferred,
};

/// How long the parts of the work took, but for the rest.
#[derive(Clone, Copy, Debug, Default)]
pub struct Work {
    /// How often the equations were linearised.
    pub linearisations: usize,
    /// Residuals and Jacobians.
    pub assembly: Duration,
    /// Elimination of strains and nodes, and factors of the last panel.
    pub factorisation: Duration,
    /// Stability indices.
    pub index: Duration,
}

/// The equations of a family of problems.
pub struct Held {
    family: Family,
    /// The other parameter, if there are two, and whether it is the first.
    other: f64,
    exchanged: bool,
    degree: usize,
    /// The states that the loads need anywhere in the family.
    layout: Layout,
    tolerance: f64,
    at: Option<(f64, Arc<Problem>)>,
    nodes: Arc<Vec<f64>>,
    /// In a box, for it is taken out and put back each time it is used.
    system: Option<Box<System>>,
    /// By which changes are measured all along: those of the first problem.
    units: Option<Units>,
    bordered: Option<Bordered>,
    /// Where the equations were linearised.
    linearised: Option<(HeldState, f64)>,
    motions: Option<usize>,
    /// What changes nothing where the equations were linearised.
    free: Motions<Correction>,
    /// Wrenches that move nothing, where it was last linearised, if there are any.
    stress: Option<SelfStress>,
    /// What it took so far.
    pub work: Work,
}

/// Change of the parameter by which the equations are differentiated: in twist, length and thickness they are not linear.
const DIFFERENCE: f64 = 1e-7;
/// A distance, in the norm of changes, at which the equations are nearly the same.
const NEAR: f64 = 2e-5;
/// Error that may be that of rounding.
const LARGEST_ROUNDING: f64 = 1e-7;
/// Error that a finer mesh is made for, of the tolerance.
const MARGIN: f64 = 0.02;

impl From<Failure> for Failed {
    fn from(failure: Failure) -> Self {
        match failure {
            Failure::Refused(refused) => Self::Refused(refused),
            other => Self::Equations(other.to_string()),
        }
    }
}

impl Held {
    /// The equations of a family, to a tolerance.
    #[must_use]
    pub fn new(family: Family, other: f64, degree: usize, tolerance: f64) -> Self {
        let (layout, nodes) = (family.layout(), Arc::new(Vec::new()));
        Self {
            family,
            other,
            exchanged: false,
            degree,
            layout,
            tolerance,
            at: None,
            nodes,
            system: None,
            units: None,
            bordered: None,
            linearised: None,
            motions: None,
            free: Motions::default(),
            stress: None,
            work: Work::default(),
        }
    }

    /// Of the collocation.
    #[must_use]
    pub fn degree(&self) -> usize {
        self.degree
    }

    /// The problem at a parameter.
    ///
    /// # Errors
    /// Where it is refused.
    pub fn problem(&mut self, t: f64) -> Result<Arc<Problem>, InvalidInput> {
        match &self.at {
            Some((known, problem)) if *known == t => Ok(Arc::clone(problem)),
            _ => {
                let problem = self.family.at(self.in_order(t))?;
                self.at = Some((t, Arc::clone(&problem)));
                Ok(problem)
            }
        }
    }

    /// Both parameters, in the order of the family.
    fn in_order(&self, t: f64) -> [f64; 2] {
        if self.exchanged { [self.other, t] } else { [t, self.other] }
    }

    /// The equations at a parameter, on the mesh of a state.
    fn system(&mut self, x: &HeldState, t: f64) -> Result<&mut System, Failed> {
        let problem = self.problem(t)?;
        let known = Arc::ptr_eq(&self.nodes, &x.nodes);
        match self.system.take().filter(|_| known) {
            Some(mut system) => {
                system.turn_to(&problem)?;
                Ok(self.system.insert(system))
            }
            None => {
                let mesh = x.mesh(&problem, self.degree)?;
                let mut system = Box::new(System::with_layout(mesh, self.layout)?);
                // Free motions are found, whatever they are.
                system.holds_gliding = false;
                system.units = *self.units.get_or_insert(system.units);
                self.free = Motions::default();
                self.stress = None;
                self.linearised = None;
                self.nodes = Arc::clone(&x.nodes);
                Ok(self.system.insert(system))
            }
        }
    }

    fn evaluated(&mut self, x: &HeldState, t: f64) -> Result<(), Failed> {
        let problem = self.problem(t)?;
        let system = self.system(x, t)?;
        let mut settled = x.x.clone();
        system.settle(&mut settled, 1.0);
        let begun = Instant::now();
        let done = system.evaluate(&settled, &goal(&problem));
        self.work.assembly += begun.elapsed();
        Ok(done?)
    }
}

impl Plane for Held {
    fn hold(&mut self, other: f64, exchanged: bool) {
        (self.other, self.exchanged, self.at, self.linearised) = (other, exchanged, None, None);
    }
}

impl Equations for Held {
    type State = HeldState;
    type Change = Correction;

    fn expect_motions(&mut self, count: Option<usize>) {
        self.motions = count;
    }

    fn moved(&mut self, x: &HeldState, change: &Correction, factor: f64) -> HeldState {
        let t = self.at.as_ref().map_or(0.0, |(t, _)| *t);
        let Ok(system) = self.system(x, t) else { return x.clone() };
        HeldState { nodes: Arc::clone(&x.nodes), x: x.x.moved(change, factor, &system.units) }
    }

    fn difference(&mut self, from: &HeldState, to: &HeldState) -> Correction {
        let t = self.at.as_ref().map_or(0.0, |(t, _)| *t);
        let Ok(system) = self.system(from, t) else { return no_direction().x };
        let x = from.x.difference(&to.x, &system.units);
        self.free.without(self, Direction { x, t: 0.0 }).x
    }

    fn added(&self, first: &Correction, then: &Correction) -> Correction {
        first.before(then)
    }

    fn settled(&mut self, mut x: HeldState, t: f64) -> Result<HeldState, Failed> {
        let system = self.system(&x, t)?;
        system.settle(&mut x.x, 1.0);
        if let Some(stress) = &self.stress {
            x.x = stress.relieved(x.x);
        }
        Ok(x)
    }

    fn sum(&self, parts: &[(f64, &Correction)]) -> Correction {
        let mut sum = parts[0].1.scaled(parts[0].0);
        for (factor, part) in &parts[1..] {
            sum = sum.plus(*factor, part);
        }
        sum
    }

    fn dot(&self, a: &Correction, b: &Correction) -> f64 {
        let fits = |system: &&System| [a, b].iter().all(|c| c.nodes.len() == system.mesh.nodes.len());
        self.system.as_deref().filter(fits).map_or(f64::NAN, |system| {
            // Of the family, not of the ribbon that was last asked for.
            a.dot_over(b, &system.mesh, system.units.length)
        })
    }

    fn forces(&self, change: &Correction) -> f64 {
        change.nodes.iter().flat_map(|node| &node[6..]).fold(0.0, |most, part| part.abs().max(most))
    }

    fn linearise(
        &mut self,
        x: &HeldState,
        t: f64,
        across: Option<&Direction<Correction>>,
    ) -> Result<(), Failed> {
        // Until it is done there are no factors.
        self.linearised = None;
        let problem = self.problem(t)?;
        let mut settled = x.x.clone();
        let system = self.system(x, t)?;
        system.settle(&mut settled, 1.0);
        let (begun, before) = (Instant::now(), system.factorising);
        system.linearise_open(&settled, &goal(&problem))?;
        let factorising = system.factorising - before;
        self.work.linearisations += 1;
        self.work.factorisation += factorising;
        self.work.assembly += begun.elapsed() - factorising;
        let slope = if self.family.ends_alone() {
            let ahead = self.family.at(self.in_order(t + DIFFERENCE))?;
            let [from, to] = [&problem, &ahead].map(|problem| goal(problem).ends);
            self.system(x, t)?.by_ends(&settled, [&from, &to], DIFFERENCE)
        } else {
            let here = self.system(x, t)?.residual.clone();
            let before = self.at.take();
            self.evaluated(x, t + DIFFERENCE)?;
            self.at = before;
            let system = self.system(x, t)?;
            let mut slope = std::mem::replace(&mut system.residual, here);
            slope.subtract(&system.residual, DIFFERENCE);
            slope
        };
        let motions = self.motions;
        let system = self.system(x, t)?;
        let line = across.map(|across| Line { x: across.x.clone(), t: across.t });
        let begun = Instant::now();
        let mut bordered = match motions {
            Some(count) if count > 0 => system.bordered_but_for(&slope, motions),
            _ => system.bordered(&slope, line.as_ref(), motions),
        };
        let mut nothing = system.mapped_to_nothing(&bordered);
        if motions.is_none() && !nothing.is_empty() {
            // At a fold there are none.
            bordered = system.bordered_but_for(&slope, None);
            nothing = system.mapped_to_nothing(&bordered);
        }
        self.work.factorisation += begun.elapsed();
        self.bordered = Some(bordered);
        self.linearised = Some((x.clone(), t));
        let nothing = nothing.into_iter().map(|Line { x, t }| Direction { x, t });
        self.free = Motions::apart(self, nothing.collect(), across, Correction::is_idle);
        let units = self.system(x, t)?.units;
        let idle = &self.free.idle;
        self.stress = (!idle.is_empty()).then(|| SelfStress::new(&settled.nodes, idle, units));
        if let Some(Direction { x, t }) = self.free.tangent.take() {
            self.free.tangent = Some(self.relieved(Direction { x, t }));
        }
        Ok(())
    }

    fn evaluate(&mut self, x: &HeldState, t: f64) -> Result<(), Failed> {
        self.evaluated(x, t)
    }

    fn particular(&mut self) -> Direction<Correction> {
        self.solved(|system, bordered| system.particular(bordered))
    }

    fn line(&mut self) -> Direction<Correction> {
        if let Some(tangent) = &self.free.tangent {
            return tangent.clone();
        }
        self.solved(|system, bordered| system.direction(bordered))
    }

    fn kernel(&mut self, count: usize) -> Vec<Direction<Correction>> {
        let (Some(system), Some(bordered)) = (&self.system, &self.bordered) else { return Vec::new() };
        let lines = system.directions(bordered, count);
        lines.into_iter().map(|Line { x, t }| Direction { x, t }).collect()
    }

    fn stability(&mut self, x: &HeldState, _: f64) -> Stability {
        let Some(system) = &self.system else { return Stability::default() };
        let sections = system.sections.with_nodes(&system.mesh, &x.x);
        let free = self.free.all.len() + self.free.idle.len();
        let motions: Vec<Correction> = self.free.all.iter().map(|motion| motion.x.clone()).collect();
        let index = if sections.index > 0 {
            None
        } else {
            let begun = Instant::now();
            let index = system.index_without(&x.x, 1.0, &motions);
            self.work.index += begun.elapsed();
            index
        };
        let determinant = self.bordered.as_ref().and_then(|bordered| system.determinant(bordered));
        let section = [sections.least, sections.second].map(|value| value.min(1e300));
        Stability { section_index: sections.index, section, index, free_motions: free, determinant }
    }

    fn coordinates(&mut self, x: &HeldState, t: f64) -> Vec<f64> {
        let length = self.family.length(self.in_order(t));
        // Places of a few sections, joined by lines.
        let place = |part: f64| {
            let i = x.nodes.partition_point(|&node| node <= part).clamp(1, x.nodes.len() - 1);
            let (from, to) = (x.nodes[i - 1], x.nodes[i]);
            x.x.nodes[i - 1].position.lerp(&x.x.nodes[i].position, (part - from) / (to - from)) / length
        };
        [0.25, 0.5, 0.75, 1.0].into_iter().flat_map(|part| place(part).data.0[0]).collect()
    }

    fn invariants(&mut self, x: &HeldState, t: f64) -> Vec<f64> {
        let Some(system) = &self.system else { return Vec::new() };
        let length = self.family.length(self.in_order(t));
        let weights = &system.mesh.gauss.weights;
        // Means of squares, and those weighted toward both ends, which tell one shifted along the ribbon apart; a closed ribbon has none.
        let closed = system.mesh.problem.ends[1].hold == Hold::Closed;
        let (mut sums, mut outside) = ([0.0; 4], [0.0; 4]);
        for (i, pair) in x.nodes.windows(2).enumerate() {
            let strains = &x.x.strains[i * self.degree..(i + 1) * self.degree];
            let h = pair[1] - pair[0];
            for ((strain, weight), c) in strains.iter().zip(weights).zip(&system.mesh.gauss.nodes) {
                let from_middle = if closed { 0.0 } else { 2.0 * (pair[0] + c * h) - 1.0 };
                for k in 0..4 {
                    let scale = if k == 0 { 1.0 } else { length };
                    let part = h * weight * (scale * strain[k]).powi(2);
                    sums[k] += part;
                    outside[k] += part * from_middle.powi(2);
                }
            }
        }
        // A rod that is the same in all directions may be turned by any angle.
        if self.family.isotropic() {
            for sums in [&mut sums, &mut outside] {
                sums[1] += sums[2];
                sums[2] = 0.0;
            }
        }
        [sums, outside].concat()
    }

    fn refined(
        &mut self,
        x: &HeldState,
        t: f64,
        along: &Direction<Correction>,
        most: f64,
    ) -> Result<Option<HeldState>, Failed> {
        if !self.linearised_near(x, t) {
            self.linearise(x, t, Some(along))?;
        }
        self.system(x, t)?;
        let Some(defects) = self.defects(x, MARGIN * self.tolerance.min(most))? else { return Ok(None) };
        // At right angles to the branch: along it nothing is held.
        let line = self.line();
        let some = self.error_for(defects.gaps.clone());
        let error = plus(self, &some, -dot(self, along, &some) / dot(self, along, &line), &line);
        let tolerance = self.tolerance;
        let system = self.system(x, t)?;
        let mut estimated = defects.estimate(&error.x, &system.mesh.problem);
        estimated.error = estimated.error.max(error.t.abs());
        let rounding = estimated.error < LARGEST_ROUNDING && estimated.is_rounding(&x.x, &system.units);
        if estimated.error <= tolerance.min(most) || rounding {
            return x.showing_waves(&system.mesh);
        }
        x.refined(&system.mesh, &estimated, (MARGIN * tolerance).min(0.5 * most)).map(Some)
    }

    fn resolved(
        &mut self,
        x: &HeldState,
        t: f64,
        across: &Direction<Correction>,
        tolerance: f64,
    ) -> Result<(f64, Option<HeldState>), Failed> {
        self.linearise(x, t, Some(across))?;
        let Some(defects) = self.defects(x, MARGIN * tolerance)? else { return Ok((0.0, None)) };
        let moved = self.error_for(defects.gaps.clone());
        let error = moved.t.abs();
        if error <= tolerance {
            return Ok((error, None));
        }
        let system = self.system(x, t)?;
        let mut estimated = defects.estimate(&moved.x, &system.mesh.problem);
        estimated.error = error;
        if error < LARGEST_ROUNDING && estimated.is_rounding(&x.x, &system.units) {
            return Ok((error, None));
        }
        Ok((error, Some(x.refined(&system.mesh, &estimated, MARGIN * tolerance)?)))
    }

    fn doubled(&mut self, x: &HeldState, t: f64) -> Result<Option<HeldState>, Failed> {
        let problem = self.problem(t)?;
        Ok(x.doubled(&x.mesh(&problem, self.degree)?)?)
    }

    fn on_one_mesh(&self, a: &HeldState, b: &HeldState) -> bool {
        Arc::ptr_eq(&a.nodes, &b.nodes)
    }

    fn remeshed(
        &mut self,
        x: &HeldState,
        change: &Correction,
        like: &HeldState,
        t: f64,
    ) -> Result<(HeldState, Correction), Failed> {
        let problem = self.problem(t)?;
        let (from, to) = (x.mesh(&problem, self.degree)?, like.mesh(&problem, self.degree)?);
        let moved = transferred(&x.x, &from, &to)?;
        Ok((HeldState { nodes: Arc::clone(&like.nodes), x: moved }, change.on(&from, &to)))
    }

    fn section_direction(&mut self, x: &HeldState, t: f64) -> Option<Direction<Correction>> {
        let problem = self.problem(t).ok()?;
        let x = x.giving_way(&problem, self.degree, &self.system.as_ref()?.units)?;
        Some(Direction { x, t: 0.0 })
    }
}

impl Held {
    /// What the elements of the mesh miss.
    fn defects(&self, x: &HeldState, tolerance: f64) -> Result<Option<Defects>, Failed> {
        let Some(system) = &self.system else { return Ok(None) };
        Ok(Some(defects(system, &x.x, &goal(&system.mesh.problem), tolerance)?))
    }

    /// Whether the equations were linearised so near to a point that an error is told as well by those factors.
    fn linearised_near(&mut self, x: &HeldState, t: f64) -> bool {
        let Some((there, before)) = self.linearised.take() else { return false };
        let known = Arc::ptr_eq(&there.nodes, &x.nodes) && (t - before).abs() < NEAR && {
            let change = self.difference(&there, x);
            self.dot(&change, &change) < NEAR * NEAR
        };
        self.linearised = Some((there, before));
        known
    }

    /// The change of state and parameter that these gaps stand for.
    fn error_for(&mut self, gaps: Vec<[f64; 9]>) -> Direction<Correction> {
        match (&mut self.system, &self.bordered) {
            (Some(system), Some(bordered)) => {
                let Line { x, t } = system.particular_for(bordered, gaps);
                let error = self.free.without(self, self.relieved(Direction { x, t }));
                // At right angles to the branch, where no plane sees to that.
                match &self.free.tangent {
                    Some(tangent) => plus(self, &error, -dot(self, tangent, &error), tangent),
                    None => error,
                }
            }
            _ => no_direction(),
        }
    }

    fn solved(&self, solve: impl Fn(&System, &Bordered) -> Line) -> Direction<Correction> {
        match (&self.system, &self.bordered) {
            (Some(system), Some(bordered)) => {
                let Line { x, t } = solve(system, bordered);
                self.free.without(self, self.relieved(Direction { x, t }))
            }
            _ => no_direction(),
        }
    }

    /// A direction without wrenches that move nothing.
    fn relieved(&self, direction: Direction<Correction>) -> Direction<Correction> {
        match (&self.stress, &self.linearised) {
            (Some(stress), Some((at, _))) => {
                let x = stress.relieved_change(&at.x.nodes, direction.x);
                Direction { x, t: direction.t }
            }
            _ => direction,
        }
    }
}

/// None, which no norm mistakes for small.
fn no_direction() -> Direction<Correction> {
    let x = Correction { nodes: Vec::new(), strains: Vec::new(), slack: [f64::NAN; 2] };
    Direction { x, t: f64::NAN }
}
