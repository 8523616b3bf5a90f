//! Several equilibria of one problem, by deflation.
//!
//! Newton's method for `M(x) F(x) = 0` with `M = prod_i (1/|x - x_i|^2 + 1)` does not converge to the solutions `x_i` that are known
//! (Farrell, Birkisson & Funke 2015). Its step is the ordinary one times `1/(1 - g)`, with `g` the derivative of `ln M` along that.

use std::sync::Arc;

use nalgebra::Quaternion;

use super::ends::{At, End};
use super::fallen::{BOWS, DISTURBANCES, disturbed};
use super::iterate::Iterate;
use super::known::Known;
use super::mesh::Mesh;
use super::meshes::adapted;
use super::path::Path;
use super::problem::Problem;
use super::solve::{Settings, Solved, goal, solve};
use super::spent::{Spent, work};
use super::system::{System, Targets};
use crate::InvalidInput;

/// Elements of the mesh on which equilibria are told apart.
const ELEMENTS: f64 = 16.0;
/// Steps that are too many, and the longest.
const STEPS: usize = 60;
const LONGEST: f64 = 2.0;
/// A step that ends the search, and a distance at which two equilibria are one.
const SHORT: f64 = 1e-7;
const NEAR: f64 = 1e-3;
/// Difference by which `ln M` is differentiated.
const DIFFERENCE: f64 = 1e-6;
/// Relative difference of energies and mean squares that mirror images may have.
const ALIKE: f64 = 1e-7;

/// Equilibria, at most so many, that differ in more than a reflection: first the one from zero load, if there is one, then those that
/// deflation finds from disturbances of all that are known.
///
/// # Errors
/// Where a section is refused.
pub fn find(problem: &Arc<Problem>, settings: &Settings, most: usize) -> Result<Vec<Solved>, InvalidInput> {
    let nodes = problem.first_nodes(ELEMENTS, 0.0);
    let mesh = Mesh::new(problem, nodes, settings.degree)?;
    let goal = goal(problem);
    let mut search = Search {
        system: System::new(mesh.clone())?,
        goal,
        known: Vec::new(),
        found: Vec::new(),
        turned: None,
    };
    let first = solve(problem, settings, None)?;
    if first.report.status.is_solved() {
        if problem.ends.iter().all(|end| end.hold.holds_rotation()) {
            search.turned = Some(turned_over(&first.x, &search.goal.ends));
        }
        search.keep(settings, first)?;
    }
    let mut bases: Vec<Iterate> = Vec::new();
    for known in [Known::Natural(0.0), Known::Straight(0.0), Known::Twisted(0.0)] {
        bases.extend(Path::new(&mesh, &known).ok().map(|path| path.x));
    }
    let (mut next, mut refining) = (0, 0);
    loop {
        bases.extend(search.known[next..].iter().cloned());
        next = search.known.len();
        for base in std::mem::take(&mut bases) {
            for disturbance in DISTURBANCES.iter().chain(&BOWS) {
                let spent = refining + work(&search.system) >= LARGEST_WORK * (most + 1);
                if search.found.len() >= most || spent || settings.interrupted.is_some_and(|asks| asks()) {
                    return Ok(search.found);
                }
                let guess = disturbed(&mesh, &base, disturbance)?;
                let Ok(path) = Path::new(&mesh, &Known::Given(&guess)) else { continue };
                if let Some(x) = search.deflated(path.x) {
                    let mut spent = Spent::default();
                    spent.allowed = ALLOWED;
                    search.known.push(x.clone());
                    let solved = adapted(settings, mesh.clone(), x, &mut spent)?;
                    refining += spent.work;
                    if solved.report.status.is_solved() {
                        search.keep(settings, solved)?;
                    }
                }
            }
        }
        if search.known.len() == next {
            return Ok(search.found);
        }
    }
}

/// Factorised elements of a refinement that are too many.
const ALLOWED: usize = 50_000;
/// The same of all of the search, for every equilibrium that is asked for and one more: some two seconds.
const LARGEST_WORK: usize = 100_000;

struct Search {
    system: System,
    goal: Targets,
    /// Equilibria on the mesh of the search, mirror images included.
    known: Vec<Iterate>,
    /// Those that are told apart.
    found: Vec<Solved>,
    /// Whether the ribbon turns the quaternion of its start into minus that of its end, if both are held: with a turn more or less it is the
    /// other way round.
    turned: Option<bool>,
}

impl Search {
    /// Keeps an equilibrium if it is no mirror image of another, and has the turns that are asked for.
    fn keep(&mut self, settings: &Settings, solved: Solved) -> Result<(), InvalidInput> {
        let problem = &self.system.mesh.problem;
        let mesh = Mesh::new(problem, solved.nodes.clone(), settings.degree)?;
        if self.known.is_empty() {
            self.known.push(super::adapt::transferred(&solved.x, &mesh, &self.system.mesh)?);
        }
        if self.turned.is_some_and(|turned| turned != turned_over(&solved.x, &self.goal.ends)) {
            return Ok(());
        }
        let numbers = mean_squares(&mesh, &solved.x);
        for other in &self.found {
            let mesh = Mesh::new(problem, other.nodes.clone(), settings.degree)?;
            let theirs = mean_squares(&mesh, &other.x);
            if numbers.iter().zip(theirs).all(|(a, b)| (a - b).abs() <= ALIKE * (1.0 + a.abs())) {
                return Ok(());
            }
        }
        self.found.push(solved);
        Ok(())
    }

    /// Newton's method away from what is known.
    fn deflated(&mut self, mut x: Iterate) -> Option<Iterate> {
        for _ in 0..STEPS {
            self.system.settle(&mut x, 1.0);
            self.system.linearise(&x, &self.goal).ok()?;
            let change = self.system.correction();
            let size = change.norm(&self.system.mesh);
            if !size.is_finite() {
                return None;
            }
            let beside = x.moved(&change, DIFFERENCE / size.max(1.0), &self.system.units);
            let slope: f64 = self
                .known
                .iter()
                .map(|other| {
                    let [here, there] = [&x, &beside].map(|x| distance(&self.system.mesh, x, other));
                    (here - there) * size.max(1.0) / DIFFERENCE / (here * (1.0 + here))
                })
                .sum();
            let factor = 1.0 / (1.0 - slope);
            let step = factor.signum() * factor.abs().min(LONGEST / size);
            x = x.moved(&change, step, &self.system.units);
            if step.abs() * size < SHORT && size < SHORT {
                let near = |other: &Iterate| distance(&self.system.mesh, &x, other) < NEAR * NEAR;
                let known = self.known.iter().any(near);
                return (!known && x.strains.iter().all(|e| e[0].abs() < LARGEST_STRAIN)).then_some(x);
            }
        }
        None
    }
}

/// Whether the quaternion of the first end becomes minus that of the other along the ribbon: no element turns by more than half a turn.
fn turned_over(x: &Iterate, ends: &[End; 2]) -> bool {
    let opposite = |a: &At, b: &Quaternion<f64>| a.rotation.dot(b) < 0.0;
    let between = x.nodes.windows(2).filter(|pair| opposite(&pair[0], &pair[1].rotation)).count();
    let at_ends = [(&x.nodes[0], &ends[0]), (&x.nodes[x.nodes.len() - 1], &ends[1])];
    let signs = at_ends.iter().filter(|(at, end)| opposite(at, &end.rotation)).count();
    (between + signs) % 2 == 1
}

/// Axial strain beyond which a solution of the equations is no ribbon.
const LARGEST_STRAIN: f64 = 0.5;

/// The square of the distance of two states: the mean over the length of differences of position/L, `eps` and `K L`. What is the same in all
/// directions may be turned about the line of its ends: of that the size of bending counts, and no position.
fn distance(mesh: &Mesh, a: &Iterate, b: &Iterate) -> f64 {
    let (length, degree) = (mesh.problem.length, mesh.gauss.degree);
    let isotropic = mesh.problem.law.isotropic();
    let mut sum = 0.0;
    for i in 0..mesh.elements() {
        let place = |node: usize| (a.nodes[node].position - b.nodes[node].position).norm_squared();
        let mut local = if isotropic { 0.0 } else { 0.5 * (place(i) + place(i + 1)) / (length * length) };
        for (j, weight) in mesh.gauss.weights.iter().enumerate() {
            let (own, other) = (&a.strains[i * degree + j], &b.strains[i * degree + j]);
            let mut e = own - other;
            if isotropic {
                (e[1], e[2]) = (own[1].hypot(own[2]) - other[1].hypot(other[2]), 0.0);
            }
            local += weight * (e[0] * e[0] + length * length * e.rows(1, 3).norm_squared());
        }
        sum += local * mesh.length(i) / length;
    }
    sum
}

/// Means over the length of the squares of `eps` and `K L`: the same for mirror images. What is the same in all directions has one of bending.
fn mean_squares(mesh: &Mesh, x: &Iterate) -> [f64; 4] {
    let (length, degree) = (mesh.problem.length, mesh.gauss.degree);
    let mut sums = [0.0; 4];
    for i in 0..mesh.elements() {
        for (j, weight) in mesh.gauss.weights.iter().enumerate() {
            let e = x.strains[i * degree + j];
            for (k, sum) in sums.iter_mut().enumerate() {
                let scale = if k == 0 { 1.0 } else { length };
                *sum += weight * mesh.length(i) / length * (scale * e[k]).powi(2);
            }
        }
    }
    if mesh.problem.law.isotropic() {
        (sums[1], sums[2]) = (sums[1] + sums[2], 0.0);
    }
    sums
}
