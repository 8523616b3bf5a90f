//! The discrete equations: residual, Jacobian and corrections.

#![expect(clippy::neg_cmp_op_on_partial_ord, reason = "what is not a number fails every test")]

use std::sync::Arc;
use std::time::{Duration, Instant};

use nalgebra::{Matrix3, Vector3};

use super::chain::{Border, Chain};
use super::element::{Entry, Exit, Span, Stages};
use super::eliminated::Eliminated;
use super::ends::{Condition, End, Units, conditions, half_angle};
use super::iterate::{Iterate, Layout, settle};
use super::mesh::Mesh;
use super::problem::Problem;
use super::sections::Sections;
use super::sparse::{Blocks, Sparse};
use super::transfer::{Anchor, Flexibility, Rows, cayley, transfer};
use crate::InvalidInput;
use crate::section::Strain;

type Vector = Vector3<f64>;

/// What is asked of the ribbon on the way to a solution.
#[derive(Clone, Debug)]
pub struct Targets {
    /// The ends.
    pub ends: [End; 2],
    /// Factor of point and line loads.
    pub load: f64,
    /// By what the law is violated at each stage; empty at the goal.
    pub offset: Vec<Strain>,
    /// Viscosity of the sections: `drag` times the strain is asked for beside the law.
    pub drag: f64,
}

/// The equations on a mesh, with room for their factors.
pub struct System {
    /// The mesh.
    pub mesh: Mesh,
    /// Units of the unknowns.
    pub units: Units,
    pub(super) layout: Layout,
    stages: Box<Stages>,
    pub(super) elements: Vec<Eliminated>,
    pub(super) anchors: Vec<Anchor>,
    pub(super) chain: Chain,
    border: Option<Border>,
    /// In place of the chain, where the stages of an element are singular.
    pub(super) sparse: Option<Sparse>,
    /// Of the elements.
    pub(super) transfers: Vec<Rows>,
    /// The residual last evaluated.
    pub residual: Residual,
    load: Vec<(Vector, Vector)>,
    /// Whether a closed ribbon that may glide along itself is kept from it by a border; else its equations are singular.
    pub holds_gliding: bool,
    /// How often the Jacobian was factorised.
    pub factorisations: usize,
    /// How often of those by one sparse matrix.
    pub sparse_factorisations: usize,
    /// How long that took.
    pub factorising: Duration,
    /// Room for the blocks of the continuity of an element.
    continuity: [Vec<f64>; 3],
    /// Of the stages where the equations were linearised.
    pub sections: Sections,
}

/// The residual: of the law at the stages, of continuity, and minus that of the end conditions.
#[derive(Clone, Debug, Default)]
pub struct Residual {
    /// Of the law, at the stages.
    pub strains: Vec<Strain>,
    /// Of position, rotation, and moment about the origin, between elements.
    pub gaps: Vec<[f64; 9]>,
    /// Minus that of the conditions at the start.
    pub start: [f64; 6],
    /// Minus that of the conditions at the end.
    pub end: [f64; 6],
    /// The factorisation with which it was eliminated, if it was.
    pub eliminated: Option<usize>,
}

impl Residual {
    /// The difference to another, over `step`.
    pub fn subtract(&mut self, other: &Self, step: f64) {
        self.eliminated = None;
        self.strains
            .iter_mut()
            .zip(&other.strains)
            .for_each(|(mine, theirs)| *mine = (*mine - theirs) / step);
        let gaps = self.gaps.iter_mut().flatten().zip(other.gaps.iter().flatten());
        let ends = self.start.iter_mut().zip(&other.start).chain(self.end.iter_mut().zip(&other.end));
        gaps.chain(ends).for_each(|(mine, theirs)| *mine = (*mine - theirs) / step);
    }
}

/// What is done with the equations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Pass {
    /// Their residual is evaluated.
    Residual,
    /// They are linearised, and the strains and then the nodes eliminated.
    Condensed,
    /// They are linearised as they are.
    Sparse,
}

/// Relative pivots below this are singular.
const SINGULAR: f64 = 1e-15;
/// Elements whose equations are not factorised as a whole: that takes a second, and stages of short elements are singular where forces are none.
const MOST_SPARSE: usize = 5000;

/// Why the equations cannot be solved where they are.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Failure {
    /// A zero pivot.
    #[error("the equations are singular {0}")]
    Singular(String),
    /// The strains of an element cannot be eliminated.
    #[error("the stages at S = {0:.6} are singular")]
    SingularStages(f64),
    /// Not a number, or infinite.
    #[error("a number is not finite {0}")]
    NotFinite(String),
    /// A section that is refused.
    #[error(transparent)]
    Refused(#[from] InvalidInput),
}

impl System {
    /// The equations with the states that their loads need.
    ///
    /// # Errors
    /// Where a section is refused.
    pub fn new(mesh: Mesh) -> Result<Self, InvalidInput> {
        let layout = Layout::of(&mesh.problem);
        Self::with_layout(mesh, layout)
    }

    /// The equations with these states, at least those that the loads need.
    ///
    /// # Errors
    /// Where a section is refused.
    pub fn with_layout(mesh: Mesh, layout: Layout) -> Result<Self, InvalidInput> {
        let chain = Chain::new(layout.states().len(), layout.constants().len());
        Ok(Self {
            units: mesh.problem.units()?,
            layout,
            stages: Box::default(),
            elements: vec![Eliminated::default(); mesh.elements()],
            anchors: Vec::with_capacity(mesh.elements()),
            mesh,
            chain,
            border: None,
            sparse: None,
            transfers: Vec::new(),
            residual: Residual::default(),
            load: Vec::new(),
            holds_gliding: true,
            factorisations: 0,
            sparse_factorisations: 0,
            factorising: Duration::ZERO,
            continuity: Default::default(),
            sections: Sections::default(),
        })
    }

    /// Turns to another problem of the same kind, on the same mesh in proportion to its length, and keeps the factors.
    ///
    /// # Errors
    /// Where a section is refused.
    pub fn turn_to(&mut self, problem: &Arc<Problem>) -> Result<(), InvalidInput> {
        self.mesh.turn_to(problem)
    }

    /// Evaluates the residual at `x`.
    ///
    /// # Errors
    /// A residual that is not finite, a section that is refused.
    pub fn evaluate(&mut self, x: &Iterate, targets: &Targets) -> Result<(), Failure> {
        self.pass(x, targets, Pass::Residual)
    }

    /// Sets the residual to the difference of those for two targets, over `step`: what the way does to it.
    ///
    /// # Errors
    /// As [`System::evaluate`].
    pub fn difference(&mut self, x: &Iterate, targets: &[Targets; 2], step: f64) -> Result<(), Failure> {
        let mut settled = x.clone();
        self.settle(&mut settled, targets[0].load);
        self.evaluate(&settled, &targets[0])?;
        let before = std::mem::take(&mut self.residual);
        self.settle(&mut settled, targets[1].load);
        self.evaluate(&settled, &targets[1])?;
        self.residual.subtract(&before, step);
        Ok(())
    }

    /// What a change of the ends alone, over `step`, does to the residual.
    #[must_use]
    pub fn by_ends(&self, x: &Iterate, [from, to]: [&[End; 2]; 2], step: f64) -> Residual {
        let (from, to) = (self.conditions(x, from), self.conditions(x, to));
        let [start, end] = [0, 1].map(|end| {
            std::array::from_fn(|i| {
                let ((_, from), (_, to)) = (&from[end][i], &to[end][i]);
                (to - from) / step
            })
        });
        let (strains, gaps) =
            (vec![Strain::zeros(); self.mesh.stages()], vec![[0.0; 9]; self.mesh.elements()]);
        Residual { strains, gaps, start, end, eliminated: None }
    }

    /// The conditions at both ends: their rows, and minus their residuals.
    fn conditions(&self, x: &Iterate, ends: &[End; 2]) -> [[Condition; 6]; 2] {
        [0, 1].map(|i| {
            let outward = if i == 0 { -1.0 } else { 1.0 };
            conditions(&ends[i], &x.nodes[i * self.mesh.elements()], outward, &self.units)
        })
    }

    /// Evaluates the residual and factorises the Jacobian at `x`.
    ///
    /// # Errors
    /// A singular Jacobian, a residual that is not finite, a section that is refused.
    pub fn linearise(&mut self, x: &Iterate, targets: &Targets) -> Result<(), Failure> {
        self.linearise_open(x, targets)?;
        if self.sparse.is_none() {
            self.chain.close();
            if !(self.chain.pivot() > SINGULAR) {
                return Err(Failure::Singular("in the conditions that join the elements".to_owned()));
            }
        }
        Ok(())
    }

    /// The same where the Jacobian may be singular, as long as that shows in the last panel alone: at a bifurcation.
    ///
    /// # Errors
    /// As [`System::linearise`].
    pub fn linearise_open(&mut self, x: &Iterate, targets: &Targets) -> Result<(), Failure> {
        self.factorisations += 1;
        self.sparse = None;
        match self.pass(x, targets, Pass::Condensed) {
            Err(Failure::SingularStages(_)) if self.mesh.elements() <= MOST_SPARSE => {
                self.linearise_sparsely(x, targets)
            }
            done => done,
        }
    }

    /// The same by one sparse matrix, which pivots across elements.
    ///
    /// # Errors
    /// As [`System::linearise`].
    pub fn linearise_sparsely(&mut self, x: &Iterate, targets: &Targets) -> Result<(), Failure> {
        let (n, m) = (self.layout.states().len(), self.layout.constants().len());
        let strains = 4 * self.mesh.gauss.degree;
        self.sparse_factorisations += 1;
        self.border = None;
        self.sparse = Some(Sparse::new(n, m, strains, self.mesh.elements()));
        self.pass(x, targets, Pass::Sparse)?;
        let begun = Instant::now();
        let regular = self.sparse.as_mut().is_some_and(Sparse::factorise);
        self.factorising += begun.elapsed();
        if regular {
            return Ok(());
        }
        Err(Failure::Singular("as a whole".to_owned()))
    }

    fn pass(&mut self, x: &Iterate, targets: &Targets, pass: Pass) -> Result<(), Failure> {
        let count = self.mesh.elements();
        self.residual.eliminated = (pass == Pass::Condensed).then_some(self.factorisations);
        self.residual.gaps.clear();
        self.residual.strains.clear();
        let [start, end] = self.conditions(x, &targets.ends);
        self.residual.start = start.map(|(_, rhs)| rhs);
        self.residual.end = end.map(|(_, rhs)| rhs);
        if pass != Pass::Residual {
            self.anchors.clear();
            self.transfers.clear();
            self.sections = Sections::default();
            let start = self.placed(&start);
            match &mut self.sparse {
                Some(sparse) => sparse.conditions(0, &start),
                None => self.chain.start(&start),
            }
        }
        for i in 0..count {
            let exit = self.enter(x, targets, i, pass)?;
            self.join(x, targets, i, &exit, pass);
        }
        if let Some(border) = &self.border {
            for (slack, column) in x.slack.iter().zip(&border.slack) {
                self.residual.end.iter_mut().zip(column).for_each(|(rhs, w)| *rhs -= slack * w);
            }
        }
        let finite = self.residual.gaps.iter().flatten().all(|g| g.is_finite())
            && self.residual.strains.iter().all(|e| e.iter().all(|x| x.is_finite()));
        if !finite {
            return Err(Failure::NotFinite("in the residual".to_owned()));
        }
        if pass == Pass::Residual {
            return Ok(());
        }
        let end = self.placed(&end);
        if let Some(sparse) = &mut self.sparse {
            sparse.conditions(count, &end);
        } else {
            // On the way what the law is violated by tells the places along the ribbon apart.
            let held = self.holds_gliding && targets.offset.is_empty();
            if !(held && self.mesh.problem.glides()) {
                self.border = None;
            } else if self.border.is_none() {
                self.border = self.chain.border(&end);
            }
            let begun = Instant::now();
            self.chain.finish(&end, self.border.as_ref());
            self.factorising += begun.elapsed();
            if !(self.chain.inner_pivot() > SINGULAR) {
                return Err(Failure::Singular("in the conditions that join the elements".to_owned()));
            }
        }
        Ok(())
    }

    /// The stages of an element: their residual and, if asked, the elimination of its strains.
    fn enter(&mut self, x: &Iterate, targets: &Targets, i: usize, pass: Pass) -> Result<Exit, Failure> {
        let (mesh, s) = (&self.mesh, self.mesh.gauss.degree);
        let at = &x.nodes[i];
        let mut made = Vec::new();
        let responses = mesh.responses(i, &mut made)?;
        let stages = i * s..(i + 1) * s;
        let mut load = mesh.load(i);
        if targets.load != 1.0 {
            let factor = targets.load;
            self.load.clear();
            self.load.extend(load.iter().map(|(p, c)| (factor * p, factor * c)));
            load = &self.load;
        }
        let span = Span {
            gauss: mesh.gauss,
            length: mesh.length(i),
            responses,
            offset: targets.offset.get(stages.clone()).unwrap_or(&[]),
            drag: targets.drag,
            load,
        };
        let entry = Entry { rotation: at.rotation, force: at.force, moment: at.moment() };
        let strains = &x.strains[stages];
        let exit = self.stages.evaluate(&span, &entry, strains);
        self.residual.strains.extend_from_slice(&self.stages.residual[..s]);
        if pass != Pass::Residual {
            for (j, tangent) in self.stages.tangents().iter().enumerate().take(s) {
                self.sections.add(tangent, &span.response(j).compliance);
            }
            let element = &mut self.elements[i];
            self.stages.linearise(&span, &exit, strains, element);
            if pass == Pass::Condensed {
                element.put_residual(&self.stages.residual);
                let begun = Instant::now();
                element.eliminate();
                self.factorising += begun.elapsed();
                if !(element.pivot > SINGULAR) {
                    return Err(Failure::SingularStages(mesh.nodes[i]));
                }
            }
        }
        Ok(exit)
    }

    /// The continuity of an element with the next node.
    fn join(&mut self, x: &Iterate, targets: &Targets, i: usize, exit: &Exit, pass: Pass) {
        let (at, next) = (&x.nodes[i], &x.nodes[i + 1]);
        let Units { length, moment: unit_moment, .. } = self.units;
        let point = self.mesh.points[i + 1].map(|(f, m)| (targets.load * f, targets.load * m));
        let (jump, couple) = point.unwrap_or((Vector::zeros(), Vector::zeros()));
        let left_over = exit.rotation * next.rotation.conjugate();
        let half = half_angle(&left_over);
        let position = (at.position + exit.arm - next.position) / length;
        let about_origin =
            at.about_origin - at.position.cross(&exit.force_drop) - exit.lever - exit.couple_drop;
        let about_origin =
            (about_origin - next.position.cross(&jump) - couple - next.about_origin) / unit_moment;
        let mut gap = [0.0; 9];
        gap[..3].copy_from_slice(position.as_slice());
        gap[3..6].copy_from_slice((2.0 * half).as_slice());
        gap[6..].copy_from_slice(about_origin.as_slice());
        self.residual.gaps.push(gap);
        if pass == Pass::Residual {
            return;
        }
        let anchor =
            Anchor { position: at.position, force: at.force, moment: at.moment(), turn: cayley(&left_over) };
        self.anchors.push(anchor);
        let element = &self.elements[i];
        let none = || Matrix3::zeros();
        let flexibility: Flexibility = match pass {
            Pass::Condensed => {
                std::array::from_fn(|o| std::array::from_fn(|k| element.flexibility_block(o, k)))
            }
            _ => [[none(); 3], [none(); 3], [none(), none(), element.lever]],
        };
        let rows = transfer(&flexibility, &anchor, exit, &self.units);
        self.transfers.push(rows);
        let (states, constants) = (self.layout.states(), self.layout.constants());
        let n = states.len();
        let [mut a, mut b, mut j] = std::mem::take(&mut self.continuity);
        a.clear();
        b.clear();
        j.clear();
        j.resize(n * n, 0.0);
        for (row, &state) in states.iter().enumerate() {
            let entry = |column: usize| match state {
                0..6 => rows[(state, column)],
                6..9 => f64::from(u8::from(column == state)),
                _ => rows[(state - 3, column)],
            };
            a.extend(states.iter().map(|&column| entry(column)));
            b.extend(constants.iter().map(|&column| entry(column)));
            j[row * n + row] = 1.0;
        }
        // M + r x N jumps by what a point force turns with: -r x F.
        let turning = -jump.cross_matrix() * (length / unit_moment);
        if point.is_some() && self.layout != Layout::Constant {
            for (row, column) in (0..3).flat_map(|row| (0..3).map(move |column| (row, column))) {
                j[(6 + row) * n + column] = turning[(row, column)];
            }
        }
        let own = self.sparse.is_some().then(|| self.uneliminated(i, &anchor));
        match (&mut self.sparse, own) {
            (Some(sparse), Some([jacobian, inputs, readout])) => {
                sparse.element(i, &Blocks { jacobian, inputs, readout, continuity: [&a, &j, &b] });
            }
            _ => {
                let begun = Instant::now();
                self.chain.push(&a, &j, &b);
                self.factorising += begun.elapsed();
            }
        }
        self.continuity = [a, b, j];
        if point.is_some() && self.layout == Layout::Constant {
            let mut k = vec![0.0; 6 * n];
            for (row, column) in (0..3).flat_map(|row| (0..3).map(move |column| (row, column))) {
                k[(3 + row) * n + column] = turning[(row, column)];
            }
            match &mut self.sparse {
                Some(sparse) => sparse.jump(i + 1, k),
                None => self.chain.jump(k),
            }
        }
    }

    /// The columns of conditions, states first.
    fn placed(&self, conditions: &[Condition; 6]) -> Vec<f64> {
        let columns = || self.layout.states().iter().chain(self.layout.constants());
        conditions.iter().flat_map(|(row, _)| columns().map(|&column| row[column])).collect()
    }

    /// Condition number of what is left when all nodes but the last are eliminated.
    #[must_use]
    pub fn condition(&self) -> f64 {
        // Of the sparse matrix it is not known.
        if self.sparse.is_some() { f64::INFINITY } else { self.chain.condition() }
    }

    /// By what the law is violated at each stage, as last evaluated.
    #[must_use]
    pub fn law_residual(&self) -> &[Strain] {
        &self.residual.strains
    }

    /// Makes the constants of an iterate follow their values at the start.
    pub fn settle(&self, x: &mut Iterate, load: f64) {
        settle(&self.mesh, self.layout, x, load);
    }
}

#[cfg(test)]
mod tests;
