//! Kinks: places where the strains jump since the sections on both sides are in different phases.
//!
//! The law of a grown section may not be convex: the same resultants then belong to several strains, and an equilibrium may pass
//! from one to another at any place where both are stable. Two strains are of one phase if the law is convex on the line that joins
//! them. On a mesh that knows nothing of it a kink is between two stages; elements that end there make the solution smooth on both sides.

use std::sync::Arc;

use super::adapt::placed_states;
use super::iterate::Iterate;
use super::known::Guess;
use super::law::Response;
use super::mesh::Mesh;
use super::problem::Problem;
use super::step::pointwise;
use crate::InvalidInput;
use crate::section::Strain;

/// Stages of a mesh, divided into runs of one phase.
pub struct Phases<'m> {
    mesh: &'m Mesh,
    strains: &'m [Strain],
    places: Vec<f64>,
    /// The last stage of each run but the last.
    ends: Vec<usize>,
    /// Where the next run begins: half-way to its first stage, or at the node between.
    pub kinks: Vec<f64>,
}

impl<'m> Phases<'m> {
    /// The phases of an iterate.
    ///
    /// # Errors
    /// Where a section is refused.
    pub fn of(mesh: &'m Mesh, x: &'m Iterate) -> Result<Self, InvalidInput> {
        let degree = mesh.gauss.degree;
        let places: Vec<f64> = (0..mesh.elements()).flat_map(|i| mesh.places(i)).collect();
        let given = mesh.problem.law.breaks();
        let least = LEAST_JUMP * x.strains.iter().map(|e| e.amax()).fold(0.0, f64::max);
        let (mut ends, mut kinks) = (Vec::new(), Vec::new());
        for (k, pair) in x.strains.windows(2).enumerate() {
            if (pair[1] - pair[0]).amax() <= least {
                continue;
            }
            let node = (k + 1).is_multiple_of(degree).then(|| mesh.nodes[(k + 1) / degree]);
            // Where the growth jumps, strains do so anyway.
            if node.is_some_and(|s| given.contains(&s)) || !differ(&mesh.problem.law.at(places[k])?, pair) {
                continue;
            }
            ends.push(k);
            kinks.push(node.unwrap_or_else(|| 0.5 * (places[k] + places[k + 1])));
        }
        Ok(Self { mesh, strains: &x.strains, places, ends, kinks })
    }

    /// The kinks moved towards where both phases have the same enthalpy `Pi - n.e` (Maxwell's rule), half of the way and by less
    /// than turns the ribbon much: creeping leaves them at the end of the range of a phase, where the strains of that phase grow like a square root.
    ///
    /// # Errors
    /// Where a section is refused.
    pub fn moved(&self) -> Result<Vec<f64>, InvalidInput> {
        let mut moved = self.kinks.clone();
        for (i, &end) in self.ends.iter().enumerate() {
            let first = if i == 0 { 0 } else { self.ends[i - 1] + 1 };
            let last = self.ends.get(i + 1).copied().unwrap_or(self.places.len() - 1);
            let back = self.better((first..=end).rev(), self.strains[end + 1])?;
            let forth = self.better(end + 1..=last, self.strains[end])?;
            let Some(to) = back.or(forth) else { continue };
            let turn = (self.strains[end + 1] - self.strains[end]).rows(1, 3).norm();
            let most = LARGEST_MOVE / turn;
            moved[i] += (0.5 * (self.places[to] - self.kinks[i])).clamp(-most, most);
        }
        Ok(moved)
    }

    /// The last of these stages, one after the other, where another phase has less enthalpy.
    fn better(
        &self,
        stages: impl Iterator<Item = usize>,
        mut phase: Strain,
    ) -> Result<Option<usize>, InvalidInput> {
        let mut reached = None;
        let given = self.mesh.problem.law.breaks();
        for k in stages {
            let crosses = |from: usize| {
                let (a, b) = (self.places[from.min(k)], self.places[from.max(k)]);
                given.iter().any(|&s| a < s && s < b)
            };
            if reached.is_some_and(crosses) {
                break;
            }
            let own = self.strains[k];
            let response = self.mesh.problem.law.at(self.places[k])?;
            let n = response.value_alone(&own).component_div(&response.compliance);
            let other = pointwise(&response, &n, phase);
            let misses = response.value_alone(&other) - response.compliance.component_mul(&n);
            let enthalpy = |e: &Strain| response.energy(e, &n) - n.dot(e);
            let better = misses.amax() <= SOLVED * other.amax()
                && response.index(&other) == 0
                && differ(&response, &[own, other])
                && enthalpy(&other) < enthalpy(&own);
            if !better {
                break;
            }
            (reached, phase) = (Some(k), other);
        }
        Ok(reached)
    }

    /// The problem, mesh and iterate with elements that end where the kinks are put, and strains that jump there.
    ///
    /// # Errors
    /// Where a section is refused.
    pub fn split(&self, x: &Iterate, kinks: &[f64]) -> Result<(Mesh, Iterate), InvalidInput> {
        let mesh = self.mesh;
        let mut problem = Problem::clone(&mesh.problem);
        // A kink that is as good as at a node is there: no element is shorter.
        let near = |s: f64| move |node: &&f64| (*node - s).abs() < SHORTEST * mesh.problem.length;
        let kinks: Vec<f64> = kinks.iter().map(|&s| *mesh.nodes.iter().find(near(s)).unwrap_or(&s)).collect();
        let mut nodes: Vec<f64> = mesh.nodes.iter().chain(&kinks).copied().collect();
        nodes.sort_by(f64::total_cmp);
        nodes.dedup();
        problem.kinks.clone_from(&kinks);
        let finer = Mesh::new(&Arc::new(problem), nodes, mesh.gauss.degree)?;
        let states = placed_states(x, mesh, &finer)?;
        // Each of the nearest stage of its run.
        let strain = |s: f64| {
            let run = kinks.partition_point(|&kink| kink < s);
            let first = if run == 0 { 0 } else { self.ends[run - 1] + 1 };
            let last = self.ends.get(run).copied().unwrap_or(self.places.len() - 1);
            let after = self.places.partition_point(|&place| place < s).clamp(first, last);
            let before = after.saturating_sub(1).max(first);
            let nearer = |k: usize| (self.places[k] - s).abs();
            self.strains[if nearer(before) < nearer(after) { before } else { after }]
        };
        let strains = (0..finer.elements()).flat_map(|i| finer.places(i)).map(strain).collect();
        Ok((finer, Iterate { nodes: states, strains, slack: Default::default() }))
    }
}

/// Change of the strains from a stage to the next that is none, over the largest strain.
const LEAST_JUMP: f64 = 1e-3;
/// The problem with the kinks that a guess has: where its strains jump from one place to the next number.
///
/// # Errors
/// Where a section is refused.
pub fn kinked_by(problem: &Arc<Problem>, guess: &Guess) -> Result<Arc<Problem>, InvalidInput> {
    let mut kinks = Vec::new();
    for (places, strains) in guess.s.windows(2).zip(guess.strains.windows(2)) {
        let next = places[1] - places[0] < SHORTEST * problem.length;
        if next && differ(&problem.law.at(places[1])?, strains) {
            kinks.push(places[1]);
        }
    }
    if kinks.is_empty() {
        return Ok(Arc::clone(problem));
    }
    Ok(Arc::new(Problem { kinks, ..Problem::clone(problem) }))
}

/// The shortest element that a kink makes, over the length of the ribbon.
const SHORTEST: f64 = 1e-9;
/// Radians that a kink turns the ribbon by at most when it is moved.
const LARGEST_MOVE: f64 = 0.2;
/// What a law may miss of the resultants, of its strain.
const SOLVED: f64 = 1e-9;
/// Places on the line between two strains where the law is asked whether it is convex.
const BETWEEN: [f64; 3] = [0.25, 0.5, 0.75];

/// Whether two strains are in different phases.
fn differ(response: &Response, pair: &[Strain]) -> bool {
    BETWEEN.iter().any(|&part| response.index(&pair[0].lerp(&pair[1], part)) > 0)
}
