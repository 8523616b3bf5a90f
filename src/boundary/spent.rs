//! The work of a solve.

use super::path::Reached;
use super::report::{Report, Status};
use super::system::System;

/// Work done so far.
#[derive(Clone, Copy, Debug, Default)]
pub struct Spent {
    /// Newton iterations.
    pub iterations: usize,
    factorisations: usize,
    load_steps: usize,
    /// Meshes.
    pub meshes: usize,
    /// Factorised elements.
    pub work: usize,
    /// How many may be.
    pub allowed: usize,
}

/// Factorised elements, those whose sections differ counted as a quarter more, for what it takes to make these, and sparse factors as many more.
#[must_use]
pub fn work(system: &System) -> usize {
    let factorisations = system.factorisations + (SPARSE - 1) * system.sparse_factorisations;
    let elements = factorisations * system.mesh.elements();
    if system.mesh.problem.law.varies() { elements + elements / 4 } else { elements }
}

impl Spent {
    /// Counts the work of a mesh.
    pub fn factorised(&mut self, system: &System) {
        self.factorisations += system.factorisations;
        self.work += work(system);
    }

    /// Counts the steps of a way.
    pub fn went(&mut self, reached: &Reached) {
        self.iterations += reached.iterations;
        self.load_steps += reached.steps;
    }

    /// Work that is still allowed.
    #[must_use]
    pub fn left(&self) -> usize {
        self.allowed.saturating_sub(self.work)
    }

    /// A report of it.
    #[must_use]
    pub fn report(&self, status: Status, reason: String, fraction: f64, norms: Vec<f64>) -> Report {
        Report {
            status,
            reason,
            fraction,
            error: f64::INFINITY,
            residual: f64::INFINITY,
            condition: f64::INFINITY,
            iterations: self.iterations,
            factorisations: self.factorisations,
            meshes: self.meshes,
            load_steps: self.load_steps,
            norms,
        }
    }
}

/// How many condensed factorisations a sparse one takes as long as.
const SPARSE: usize = 10;
