//! Corrections: what the factorised equations make of a residual, also where a parameter is unknown beside the state.
//!
//! With `F_t` the change of the residual with the parameter, the equations `J dx + F_t dt = -F` have a line of solutions. All nodes
//! but the last are eliminated as ever; in the last panel `t` is one more column, and a row tells where on the line,
//!
//! ```text
//! [ B   b ] [y ]   [ r ]
//! [ c  c_t] [dt] = [ 0 ],
//! ```
//!
//! regular at a fold, where `B` alone is not, and singular at a branch point only.

use nalgebra::DMatrix;

use super::chain::Reduced;
use super::dense::Determinant;
use super::eliminated::{Change, Eliminated, by_component, by_stage};
use super::iterate::Correction;
use super::panel::{Panel, SVD_STEPS, VANISHING};
use super::system::{Residual, System};
use super::transfer::joined;
use crate::section::Strain;

/// A change of the state and of the parameter.
#[derive(Clone, Debug)]
pub struct Line {
    /// Of the state.
    pub x: Correction,
    /// Of the parameter.
    pub t: f64,
}

/// A residual with the strains and all nodes but the last eliminated.
#[derive(Clone, Debug)]
struct Rhs {
    strains: Vec<Strain>,
    nodes: Reduced,
}

/// The factors of the equations with a parameter.
pub struct Bordered(Kind);

enum Kind {
    Chain {
        by_parameter: Rhs,
        panel: Panel,
    },
    /// The change of the state with the parameter.
    Sparse(Correction),
}

impl System {
    /// The Newton correction for the residual last evaluated, by the factors last computed.
    #[must_use]
    pub fn correction(&self) -> Correction {
        self.correction_of(&self.residual)
    }

    fn correction_of(&self, residual: &Residual) -> Correction {
        if self.sparse.is_some() {
            return self.sparse_correction(residual);
        }
        let rhs = self.reduced(residual);
        let last = self.chain.solve_last(&rhs.nodes.last);
        self.expanded(rhs, &last)
    }

    /// Unit motions that change nothing, at right angles to one another: a rod that is the same in all directions may turn about the line of
    /// its ends and loads, a closed ribbon glide along itself. Wrenches that move nothing are none, see [`System::self_stresses`].
    #[must_use]
    pub fn motions(&self) -> Vec<Correction> {
        self.free().0
    }

    /// Wrenches that move nothing: what is rigid bears any of them between ends that hold it.
    #[must_use]
    pub fn self_stresses(&self) -> Vec<Correction> {
        self.free().1
    }

    fn free(&self) -> (Vec<Correction>, Vec<Correction>) {
        let (mut motions, mut stresses): (Vec<Correction>, Vec<Correction>) = (Vec::new(), Vec::new());
        for mut line in self.kernel() {
            for other in &motions {
                line = line.plus(-line.dot(other, &self.mesh), other);
            }
            let square = line.dot(&line, &self.mesh);
            if line.is_idle(square) {
                stresses.push(line);
            } else {
                motions.push(line.scaled(1.0 / square.sqrt()));
            }
        }
        (motions, stresses)
    }

    /// What the equations map to nothing.
    fn kernel(&self) -> Vec<Correction> {
        let none = || Rhs {
            strains: vec![Strain::zeros(); self.mesh.stages()],
            nodes: Reduced {
                kept: vec![0.0; self.layout.states().len() * self.mesh.elements()],
                last: Vec::new(),
            },
        };
        self.chain.kernel().into_iter().map(|last| self.expanded(none(), &last)).collect()
    }

    /// The correction that gives each element another end: what its position, rotation and moment about the origin
    /// are to change by, other residuals being zero.
    #[must_use]
    pub fn correction_for(&self, defects: Vec<[f64; 9]>) -> Correction {
        let strains = vec![Strain::zeros(); self.mesh.stages()];
        self.correction_of(&Residual { strains, gaps: defects, ..Residual::default() })
    }

    /// Eliminates the strains of a residual, then all nodes but the last.
    fn reduced(&self, residual: &Residual) -> Rhs {
        let s = self.mesh.gauss.degree;
        let mut strains = vec![Strain::zeros(); self.mesh.stages()];
        let mut rhs = Vec::with_capacity(self.layout.states().len() * self.mesh.elements());
        for (i, gap) in residual.gaps.iter().enumerate() {
            let (own, element) = (i * s..(i + 1) * s, &self.elements[i]);
            let (law, strains) = (&residual.strains[own.clone()], &mut strains[own]);
            let change = if residual.eliminated == Some(self.factorisations) {
                element.solved(strains)
            } else if law.iter().all(|e| *e == Strain::zeros()) {
                Change::default()
            } else {
                element.solve(law, strains)
            };
            self.join_gap(&mut rhs, i, gap, &change);
        }
        Rhs { strains, nodes: self.chain.reduce(&residual.start, &rhs, &residual.end) }
    }

    /// The right-hand side of the continuity of an element.
    fn join_gap(&self, rhs: &mut Vec<f64>, i: usize, gap: &[f64; 9], change: &Change) {
        let full = joined(gap, change, &self.anchors[i].turn, &self.units);
        rhs.extend(self.layout.states().iter().map(|&state| match state {
            0..6 => full[state],
            6..9 => 0.0,
            _ => full[state - 3],
        }));
    }

    /// The correction of all from that of the last panel.
    fn expanded(&self, rhs: Rhs, last: &[f64]) -> Correction {
        let s = self.mesh.gauss.degree;
        let changes = self.chain.expand(&rhs.nodes.kept, last);
        let nodes = self.placed_nodes(&changes.states, &changes.constants);
        let mut strains = rhs.strains;
        for (i, (anchor, element)) in self.anchors.iter().zip(&self.elements).enumerate() {
            let inputs = anchor.inputs(&nodes[i], &self.units);
            element.respond(&inputs, &mut strains[i * s..(i + 1) * s]);
        }
        Correction { nodes, strains, slack: changes.slack }
    }

    /// Changes of all twelve at the nodes from those of states and constants.
    fn placed_nodes(&self, states: &[f64], constants: &[f64]) -> Vec<[f64; 12]> {
        let (n, m) = (self.layout.states().len(), self.layout.constants().len());
        let node = |i: usize| {
            let mut change = [0.0; 12];
            for (&place, value) in self.layout.states().iter().zip(&states[i * n..]) {
                change[place] = *value;
            }
            for (&place, value) in self.layout.constants().iter().zip(&constants[i * m..]) {
                change[place] = *value;
            }
            change
        };
        (0..=self.mesh.elements()).map(node).collect()
    }

    fn sparse_correction(&self, residual: &Residual) -> Correction {
        let mut rhs = Vec::new();
        for (i, gap) in residual.gaps.iter().enumerate() {
            self.join_gap(&mut rhs, i, gap, &Change::default());
        }
        let degree = self.mesh.gauss.degree;
        let law: Vec<f64> =
            residual.strains.chunks_exact(degree).flat_map(|c| by_component(c, -1.0)).collect();
        let solved =
            self.sparse.as_ref().and_then(|sparse| sparse.solve(&residual.start, &law, &rhs, &residual.end));
        let Some((changes, own)) = solved else {
            // No correction, which no norm mistakes for small.
            let nodes = vec![[f64::NAN; 12]; self.mesh.elements() + 1];
            let strains = vec![Strain::zeros(); self.mesh.stages()];
            return Correction { nodes, strains, slack: Default::default() };
        };
        let strains = own.chunks_exact(4 * degree).flat_map(by_stage).collect();
        let nodes = self.placed_nodes(&changes.states, &changes.constants);
        Correction { nodes, strains, slack: changes.slack }
    }

    /// Borders the factors with a parameter, what it does to the residual, and the last node's part of a line that the
    /// solutions of the equations cross; of so many free motions, if that is known.
    #[must_use]
    pub fn bordered(
        &self,
        by_parameter: &Residual,
        across: Option<&Line>,
        nullity: Option<usize>,
    ) -> Bordered {
        if self.sparse.is_some() {
            return Bordered(Kind::Sparse(self.correction_of(by_parameter)));
        }
        let rhs = self.reduced(by_parameter);
        let mut matrix = self.with_parameter(&rhs);
        let mut sizes = self.chain.sizes();
        sizes.push(matrix.column(matrix.ncols() - 1).amax());
        let size = matrix.nrows() - 1;
        match across {
            Some(line) => {
                let last = &line.x.nodes[line.x.nodes.len() - 1];
                let places = self.layout.states().iter().chain(self.layout.constants());
                places.enumerate().for_each(|(i, &place)| matrix[(size, i)] = last[place]);
                matrix[(size, size)] = line.t;
            }
            None => matrix[(size, size)] = 1.0,
        }
        Bordered(Kind::Chain { by_parameter: rhs, panel: Panel::new(&matrix, &sizes, nullity, VANISHING) })
    }

    /// The same where so many motions change nothing, or as many as do: what is mapped to nothing are these and the line of solutions.
    #[must_use]
    pub fn bordered_but_for(&self, by_parameter: &Residual, motions: Option<usize>) -> Bordered {
        if self.sparse.is_some() {
            return Bordered(Kind::Sparse(self.correction_of(by_parameter)));
        }
        let rhs = self.reduced(by_parameter);
        let matrix = self.with_parameter(&rhs);
        let mut sizes = self.chain.sizes();
        sizes.push(matrix.column(matrix.ncols() - 1).amax());
        let panel = Panel::new(&matrix, &sizes, motions.map(|count| count + 1), VANISHING);
        Bordered(Kind::Chain { by_parameter: rhs, panel })
    }

    /// The last panel with the column of the parameter, and a row of zeros.
    fn with_parameter(&self, by_parameter: &Rhs) -> DMatrix<f64> {
        let last = self.chain.last();
        let size = last.nrows();
        let mut matrix = last.resize(size + 1, size + 1, 0.0);
        by_parameter.nodes.last.iter().enumerate().for_each(|(i, value)| matrix[(i, size)] = -value);
        matrix
    }

    /// A solution of the equations with a parameter, for the residual last evaluated.
    #[must_use]
    pub fn particular(&self, bordered: &Bordered) -> Line {
        match &bordered.0 {
            Kind::Sparse(_) => Line { x: self.correction(), t: 0.0 },
            Kind::Chain { by_parameter, panel } => {
                let rhs = self.reduced(&self.residual);
                let mut y = rhs.nodes.last.clone();
                y.push(0.0);
                self.line(rhs, by_parameter, &panel.solve(y))
            }
        }
    }

    /// The direction of the line of solutions.
    #[must_use]
    pub fn direction(&self, bordered: &Bordered) -> Line {
        match &bordered.0 {
            Kind::Sparse(x) => Line { x: x.clone(), t: 1.0 },
            Kind::Chain { by_parameter, panel } => {
                let mut y = vec![0.0; by_parameter.nodes.last.len()];
                y.push(1.0);
                self.line(self.nothing(by_parameter), by_parameter, &panel.solve(y))
            }
        }
    }

    /// Changes that are mapped to nothing.
    #[must_use]
    pub fn mapped_to_nothing(&self, bordered: &Bordered) -> Vec<Line> {
        let Kind::Chain { by_parameter, panel } = &bordered.0 else { return Vec::new() };
        let line = |y: &Vec<f64>| self.line(self.nothing(by_parameter), by_parameter, y);
        panel.kernel().iter().map(line).collect()
    }

    /// Directions in which the equations with a parameter are nearly singular, the most singular first: at a branch point of
    /// multiplicity `m` there are `m + 1`.
    #[must_use]
    pub fn directions(&self, bordered: &Bordered, count: usize) -> Vec<Line> {
        let Kind::Chain { by_parameter, .. } = &bordered.0 else { return Vec::new() };
        let matrix = self.with_parameter(by_parameter);
        if !matrix.iter().all(|x| x.is_finite()) {
            return Vec::new();
        }
        let Some(svd) = matrix.try_svd(false, true, 5.0 * f64::EPSILON, SVD_STEPS) else { return Vec::new() };
        let mut order: Vec<usize> = (0..svd.singular_values.len()).collect();
        order.sort_by(|&i, &j| svd.singular_values[i].total_cmp(&svd.singular_values[j]));
        let Some(v) = svd.v_t else { return Vec::new() };
        let line = |&i: &usize| {
            let y: Vec<f64> = v.row(i).iter().copied().collect();
            self.line(self.nothing(by_parameter), by_parameter, &y)
        };
        order.iter().take(count).map(line).collect()
    }

    /// Determinant of the equations with a parameter, over those of the stiffnesses at all stages: it vanishes at branch points alone, and not
    /// as all sections soften, which takes a factor a stage. `None` if it is not known.
    #[must_use]
    pub fn determinant(&self, bordered: &Bordered) -> Option<Determinant> {
        let Kind::Chain { panel, .. } = &bordered.0 else { return None };
        let last = self.chain.determinant().times(panel.determinant());
        let Determinant { sign, log } =
            self.elements.iter().map(Eliminated::determinant).fold(last, Determinant::times);
        Some(Determinant { sign, log: log - self.sections.log })
    }

    /// A solution of the equations with a parameter for gaps between the elements alone.
    #[must_use]
    pub fn particular_for(&mut self, bordered: &Bordered, gaps: Vec<[f64; 9]>) -> Line {
        let strains = vec![Strain::zeros(); self.mesh.stages()];
        self.residual = Residual { strains, gaps, ..Residual::default() };
        self.particular(bordered)
    }

    /// The line of solutions for a residual, from that of the last panel.
    fn line(&self, mut rhs: Rhs, by_parameter: &Rhs, y: &[f64]) -> Line {
        let (last, t) = y.split_at(y.len() - 1);
        let t = t[0];
        rhs.strains.iter_mut().zip(&by_parameter.strains).for_each(|(a, b)| *a += t * b);
        rhs.nodes.kept.iter_mut().zip(&by_parameter.nodes.kept).for_each(|(a, b)| *a += t * b);
        Line { x: self.expanded(rhs, last), t }
    }

    fn nothing(&self, like: &Rhs) -> Rhs {
        let nodes =
            Reduced { kept: vec![0.0; like.nodes.kept.len()], last: vec![0.0; like.nodes.last.len()] };
        Rhs { strains: vec![Strain::zeros(); like.strains.len()], nodes }
    }
}
