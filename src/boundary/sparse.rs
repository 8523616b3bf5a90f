//! The Newton equations as one sparse matrix, for faer's LU.
//!
//! Nothing is eliminated beforehand: the strains are unknowns beside the states, element by element,
//!
//! ```text
//!        x_0   e_0   x_1   e_1   ..   x_N  |  p
//!      [  S                                | S_p ]
//!      [ B_0   J_0                         | B_0p]   4 s rows: the law at the stages
//!      [ -A_0  -R_0   1                    | -P_0]   n rows: continuity
//!      [              B_1   J_1            |  :  ]
//!      [                          ..   F   | F_p ]
//! ```
//!
//! It pivots across elements, and so solves where the stages of one element alone are singular, as those of a section at
//! the bifurcation of its law are. It is the reference for [`super::chain::Chain`], which takes a fifth to a third of the time.

#![expect(clippy::neg_cmp_op_on_partial_ord, reason = "what is not a number fails every test")]

use faer::prelude::*;
use faer::sparse::linalg::solvers::Lu;
use faer::sparse::{SparseColMat, Triplet};

use super::chain::{CARRIED, Changes};
use super::system::System;
use super::transfer::Anchor;

/// The equations, by their entries, then their factors.
pub struct Sparse {
    n: usize,
    m: usize,
    strains: usize,
    elements: usize,
    entries: Vec<Triplet<usize, usize, f64>>,
    /// Row, element, constant and value of what multiplies the constants to the right of the element's start.
    constants: Vec<(usize, usize, usize, f64)>,
    jumps: Vec<(usize, Vec<f64>)>,
    factors: Option<(SparseColMat<usize, f64>, Lu<usize, f64>)>,
}

/// One element: matrices by rows.
pub struct Blocks<'a> {
    /// `J`: strains by strains.
    pub jacobian: Vec<f64>,
    /// Of the law: strains by states and constants.
    pub inputs: Vec<f64>,
    /// `R`: states by strains.
    pub readout: Vec<f64>,
    /// Of the continuity at fixed strains: of the state at the start, at the end, and of the constants.
    pub continuity: [&'a [f64]; 3],
}

/// A relative residual above this tells that the factors are those of a singular matrix.
const SINGULAR: f64 = 1e-6;

impl Sparse {
    /// Empty equations of `elements` elements with `n` states, `m` constants, and `strains` strains an element.
    #[must_use]
    pub fn new(n: usize, m: usize, strains: usize, elements: usize) -> Self {
        let (entries, constants, jumps) = (Vec::new(), Vec::new(), Vec::new());
        Self { n, m, strains, elements, entries, constants, jumps, factors: None }
    }

    fn state(&self, node: usize) -> usize {
        node * (self.n + self.strains)
    }

    fn row(&self, element: usize) -> usize {
        CARRIED + element * (self.n + self.strains)
    }

    fn size(&self) -> usize {
        self.state(self.elements) + self.n + self.m
    }

    fn add(&mut self, row: usize, column: usize, width: usize, values: &[f64], factor: f64) {
        for (i, &value) in values.iter().enumerate().filter(|(_, value)| **value != 0.0) {
            self.entries.push(Triplet::new(row + i / width, column + i % width, factor * value));
        }
    }

    /// Conditions at the first or last node, rows of states and constants.
    pub fn conditions(&mut self, node: usize, values: &[f64]) {
        let (n, m) = (self.n, self.m);
        let first = if node == 0 { 0 } else { self.row(self.elements) };
        for (i, row) in values.chunks_exact(n + m).enumerate() {
            self.add(first + i, self.state(node), n, &row[..n], 1.0);
            let constants = row[n..].iter().enumerate();
            self.constants.extend(constants.map(|(k, &value)| (first + i, node, k, value)));
        }
    }

    /// An element.
    pub fn element(&mut self, i: usize, blocks: &Blocks<'_>) {
        let (n, m, strains) = (self.n, self.m, self.strains);
        let (row, column) = (self.row(i), self.state(i));
        let [a, j, b] = blocks.continuity;
        self.add(row, column + n, strains, &blocks.jacobian, 1.0);
        for (k, inputs) in blocks.inputs.chunks_exact(n + m).enumerate() {
            self.add(row + k, column, n, &inputs[..n], 1.0);
            let constants = inputs[n..].iter().enumerate();
            self.constants.extend(constants.map(|(c, &value)| (row + k, i, c, value)));
        }
        let next = row + strains;
        self.add(next, column, n, a, -1.0);
        self.add(next, column + n, strains, &blocks.readout, -1.0);
        self.add(next, self.state(i + 1), n, j, 1.0);
        let constants = b.iter().enumerate();
        self.constants.extend(constants.map(|(k, &value)| (next + k / m, i, k % m, -value)));
    }

    /// At a node, `p_left = p_right + K x`.
    pub fn jump(&mut self, node: usize, k: Vec<f64>) {
        self.jumps.push((node, k));
    }

    /// Factorises; false if the matrix is singular in its pattern or faer says so.
    pub fn factorise(&mut self) -> bool {
        let (n, last) = (self.n, self.state(self.elements) + self.n);
        let constants = std::mem::take(&mut self.constants);
        for &(row, element, k, value) in constants.iter().filter(|entry| entry.3 != 0.0) {
            self.entries.push(Triplet::new(row, last + k, value));
            // Seen from its left, a constant at the end is less by all jumps between.
            for (node, jump) in self.jumps.iter().filter(|(node, _)| *node > element) {
                let column = node * (n + self.strains);
                let row_of_jump = jump[k * n..(k + 1) * n].iter().enumerate();
                self.entries.extend(row_of_jump.map(|(c, x)| Triplet::new(row, column + c, value * x)));
            }
        }
        let size = self.size();
        let matrix = SparseColMat::try_new_from_triplets(size, size, &self.entries).ok();
        self.factors = matrix.and_then(|matrix| matrix.sp_lu().ok().map(|lu| (matrix, lu)));
        self.factors.is_some()
    }

    /// Solves for right-hand sides at the start, of the law and of the continuity by elements, and at the end: the
    /// changes of states and constants, and of the strains. `None` if the result does not solve the equations.
    #[must_use]
    pub fn solve(
        &self,
        start: &[f64],
        law: &[f64],
        gaps: &[f64],
        end: &[f64],
    ) -> Option<(Changes, Vec<f64>)> {
        let (n, m, strains) = (self.n, self.m, self.strains);
        let (matrix, lu) = self.factors.as_ref()?;
        let mut rhs = start.to_vec();
        for (law, gap) in law.chunks_exact(strains).zip(gaps.chunks_exact(n)) {
            rhs.extend_from_slice(law);
            rhs.extend_from_slice(gap);
        }
        rhs.extend_from_slice(end);
        let rhs = Col::from_fn(self.size(), |i| rhs[i]);
        let x = lu.solve(&rhs);
        // faer does not tell of a pivot that is only numerically zero.
        let left = (matrix * &x - &rhs).norm_max();
        if !(left <= SINGULAR * rhs.norm_max()) {
            return None;
        }
        let at = |first: usize, count: usize| (first..first + count).map(|i| x[i]);
        let mut changes = Changes::default();
        let mut own: Vec<f64> = at(self.size() - m, m).collect();
        let mut constants = vec![own.clone()];
        for node in (0..self.elements).rev() {
            for (_, k) in self.jumps.iter().filter(|(place, _)| *place == node + 1) {
                let next: Vec<f64> = at(self.state(node + 1), n).collect();
                for (value, k) in own.iter_mut().zip(k.chunks_exact(n)) {
                    *value += k.iter().zip(&next).map(|(k, x)| k * x).sum::<f64>();
                }
            }
            constants.push(own.clone());
        }
        changes.constants = constants.into_iter().rev().flatten().collect();
        changes.states = (0..=self.elements).flat_map(|node| at(self.state(node), n)).collect();
        let strains = (0..self.elements).flat_map(|i| at(self.state(i) + n, strains)).collect();
        Some((changes, strains))
    }
}

impl System {
    /// Of an element whose strains are not eliminated: the derivatives of the law in the strains, and in states and
    /// constants, and of the states at the end in the strains.
    pub(super) fn uneliminated(&self, i: usize, anchor: &Anchor) -> [Vec<f64>; 3] {
        let element = &self.elements[i];
        let columns = self.layout.states().iter().chain(self.layout.constants());
        // What a unit change at the start is to the element.
        let changes: Vec<[f64; 9]> = columns
            .map(|&column| {
                let mut change = [0.0; 12];
                change[column] = 1.0;
                anchor.inputs(&change, &self.units)
            })
            .collect();
        let (mut jacobian, mut inputs) = (Vec::new(), Vec::new());
        for (own, by_input) in element.jacobian() {
            jacobian.extend_from_slice(own);
            inputs.extend(changes.iter().map(|u| by_input.iter().zip(u).map(|(x, u)| x * u).sum::<f64>()));
        }
        let mut readout = Vec::new();
        let [arm, turn] = [0, 1].map(|output| element.readout(output));
        for &state in self.layout.states() {
            let value = |k: usize| match state {
                0..3 => arm[state][k] / self.units.length,
                3..6 => (0..3).map(|c| anchor.turn[(state - 3, c)] * turn[c][k]).sum(),
                9.. if element.loaded() => -element.readout(2)[state - 9][k] / self.units.moment,
                _ => 0.0,
            };
            readout.extend((0..4 * self.mesh.gauss.degree).map(value));
        }
        [jacobian, inputs, readout]
    }
}
