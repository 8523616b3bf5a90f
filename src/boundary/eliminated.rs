//! The strains of an element eliminated: what is left is its flexibility.

use nalgebra::{Matrix3, Vector3};
use pulp::NullaryFnOnce;

use super::dense::{Determinant, backward, determinant, dot, eliminate, forward, padded, wide};
use super::gauss::MAX_DEGREE;
use crate::section::Strain;

type Vector = Vector3<f64>;

/// The most inputs, padded.
const MOST_INPUTS: usize = 12;

/// The strains of an element eliminated: their factors, and what is left.
///
/// Rows and strains are ordered by components, and within those by stages.
#[derive(Clone, Debug, Default)]
pub struct Eliminated {
    stages: usize,
    inputs: usize,
    outputs: usize,
    /// `4 s` rows: the factors of the Jacobian, then the response of the strains to the inputs, padded.
    block: Vec<f64>,
    swaps: Vec<usize>,
    /// Derivatives of the outputs in the strains, `outputs x 4 s`.
    readout: Vec<f64>,
    /// Derivative of the lever in the direction of the load at fixed strains.
    pub lever: Matrix3<f64>,
    /// Derivatives of the outputs (arm, rotation, lever) in the inputs (`N`, `M`, direction of the load).
    flexibility: [[f64; MOST_INPUTS]; 9],
    /// The least relative pivot.
    pub pivot: f64,
}

/// Change of the outputs of an element.
#[derive(Clone, Copy, Debug, Default)]
pub struct Change {
    /// Of the position of its end.
    pub arm: Vector,
    /// Of the rotation there, in the fixed basis.
    pub rotation: Vector,
    /// Of the moment of the distributed force.
    pub lever: Vector,
}

impl Eliminated {
    /// Makes room for the Jacobian of an element of so many stages.
    pub(super) fn begin(&mut self, stages: usize, loaded: bool) {
        self.stages = stages;
        (self.inputs, self.outputs) = if loaded { (9, 9) } else { (6, 6) };
        let strains = 4 * stages;
        // All of it is put but what pads the inputs.
        let width = self.width();
        self.block.resize(strains * width, 0.0);
        self.block.chunks_exact_mut(width).for_each(|row| row[strains..].fill(0.0));
        self.readout.clear();
        self.readout.resize(self.outputs * strains, 0.0);
        self.swaps.resize(strains, 0);
    }

    /// Derivatives of component `row` of the law at a stage in a component of the strains, one a stage.
    pub(super) fn block_mut(&mut self, row: usize, stage: usize, component: usize) -> &mut [f64] {
        let first = (row * self.stages + stage) * self.width() + component * self.stages;
        &mut self.block[first..first + self.stages]
    }

    /// Puts what an input does to the law at a stage.
    pub(super) fn put_input(&mut self, stage: usize, input: usize, change: [f64; 4]) {
        let (strains, width) = (4 * self.stages, self.width());
        for (row, change) in change.into_iter().enumerate() {
            self.block[(row * self.stages + stage) * width + strains + input] = change;
        }
    }

    /// Puts the residual of the law at the stages, which is eliminated with the inputs, as the first column that pads them: six are padded to
    /// eight, nine to twelve.
    pub(super) fn put_residual(&mut self, residual: &[Strain]) {
        let (strains, width) = (4 * self.stages, self.width());
        for (row, value) in by_component(&residual[..self.stages], 1.0).enumerate() {
            self.block[row * width + strains + self.inputs] = value;
        }
    }

    /// Derivatives of an output in a component of the strains, one a stage.
    pub(super) fn readout_mut(&mut self, output: usize, component: usize) -> &mut [f64] {
        let first = (4 * output + component) * self.stages;
        &mut self.readout[first..first + self.stages]
    }

    /// Eliminates the strains: factorises their Jacobian, and reduces what the outputs owe them to the inputs.
    pub fn eliminate(&mut self) {
        self.factorise();
        if self.loaded() { wide(Reduction::<MOST_INPUTS>(self)) } else { wide(Reduction::<8>(self)) }
    }

    /// Factorises the Jacobian of the strains alone.
    pub fn factorise(&mut self) {
        let (size, width) = (self.swaps.len(), self.width());
        self.pivot = eliminate(&mut self.block, width, size, &mut self.swaps);
    }

    /// Determinant of the Jacobian of the strains, once they are eliminated.
    #[must_use]
    pub fn determinant(&self) -> Determinant {
        determinant(&self.block, self.width(), &self.swaps)
    }

    /// The Jacobian of the stages and, beside it, its columns for the inputs, as long as the strains are not eliminated: by rows.
    pub fn jacobian(&self) -> impl Iterator<Item = (&[f64], &[f64])> {
        let size = self.swaps.len();
        self.block.chunks_exact(self.width()).map(move |row| (&row[..size], &row[size..size + self.inputs]))
    }

    /// Length of a row: strains and padded inputs.
    fn width(&self) -> usize {
        4 * self.stages + padded(self.inputs)
    }

    /// What the strains do to an output: three rows, of its components, of a number a strain.
    #[must_use]
    pub fn readout(&self, output: usize) -> [&[f64]; 3] {
        let size = self.swaps.len();
        std::array::from_fn(|i| &self.readout[(3 * output + i) * size..(3 * output + i + 1) * size])
    }

    /// The strains that undo the residual at fixed inputs, and what that does to the outputs.
    pub fn solve(&self, residual: &[Strain], strains: &mut [Strain]) -> Change {
        let (size, width) = (self.swaps.len(), self.width());
        let mut rhs = [0.0; 4 * MAX_DEGREE];
        let rhs = &mut rhs[..size];
        rhs.iter_mut().zip(by_component(&residual[..self.stages], -1.0)).for_each(|(x, y)| *x = y);
        forward(&self.block, width, &self.swaps, rhs);
        backward(&self.block, width, rhs);
        strains.iter_mut().zip(by_stage(rhs)).for_each(|(x, y)| *x = y);
        let vector = |output: usize| Vector::from(self.readout(output).map(|row| dot(row, rhs)));
        let lever = if self.outputs > 6 { vector(2) } else { Vector::zeros() };
        Change { arm: vector(0), rotation: vector(1), lever }
    }

    /// What [`Eliminated::solve`] gives for the residual that was eliminated.
    pub fn solved(&self, strains: &mut [Strain]) -> Change {
        let (size, width) = (self.swaps.len(), self.width());
        let own = |row: usize| -self.block[row * width + size + self.inputs];
        for (j, strain) in strains.iter_mut().enumerate() {
            *strain = Strain::from_fn(|i, _| own(i * self.stages + j));
        }
        let vector = |output: usize| Vector::from_fn(|i, _| self.flexibility[3 * output + i][self.inputs]);
        let lever = if self.outputs > 6 { vector(2) } else { Vector::zeros() };
        Change { arm: vector(0), rotation: vector(1), lever }
    }

    /// Adds to the strains what a change of the inputs does to them.
    pub fn respond(&self, inputs: &[f64; 9], strains: &mut [Strain]) {
        let (size, width) = (self.swaps.len(), self.width());
        let mut padded = [0.0; MOST_INPUTS];
        padded[..self.inputs].copy_from_slice(&inputs[..self.inputs]);
        for (j, strain) in strains.iter_mut().enumerate() {
            for i in 0..4 {
                let row = (i * self.stages + j) * width;
                strain[i] -= dot(&self.block[row + size..row + width], &padded);
            }
        }
    }

    /// A 3 x 3 block of the flexibility; zero for a lever or a load that is not there.
    #[must_use]
    pub fn flexibility_block(&self, output: usize, input: usize) -> Matrix3<f64> {
        if 3 * output >= self.outputs || 3 * input >= self.inputs {
            return Matrix3::zeros();
        }
        Matrix3::from_fn(|i, k| self.flexibility[3 * output + i][3 * input + k])
    }

    /// Whether there are distributed loads.
    #[must_use]
    pub fn loaded(&self) -> bool {
        self.inputs > 6
    }
}

/// Back substitution of all inputs at once, row by row, and what they do to the outputs.
struct Reduction<'a, const INPUTS: usize>(&'a mut Eliminated);

impl<const INPUTS: usize> NullaryFnOnce for Reduction<'_, INPUTS> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let element = self.0;
        let (size, width) = (element.swaps.len(), element.width());
        let mut responses = [[0.0; INPUTS]; 4 * MAX_DEGREE];
        for k in (0..size).rev() {
            let (factors, row) = element.block[k * width..(k + 1) * width].split_at_mut(size);
            let mut sum = [0.0; INPUTS];
            for (response, &factor) in responses[k + 1..size].iter().zip(&factors[k + 1..]) {
                add(&mut sum, factor, response);
            }
            let inverse = 1.0 / factors[k];
            for i in 0..INPUTS {
                responses[k][i] = (row[i] - sum[i]) * inverse;
            }
            row.copy_from_slice(&responses[k]);
        }
        for (row, flexibility) in element.readout.chunks_exact(size).zip(&mut element.flexibility) {
            let mut sum = [0.0; INPUTS];
            for (response, &factor) in responses.iter().zip(row) {
                add(&mut sum, -factor, response);
            }
            flexibility[..INPUTS].copy_from_slice(&sum);
        }
        if element.loaded() {
            for (i, k) in (0..3).flat_map(|i| (0..3).map(move |k| (i, k))) {
                element.flexibility[6 + i][6 + k] += element.lever[(i, k)];
            }
        }
    }
}

/// Numbers of an element, four a stage, times a factor, ordered as its strains are.
pub fn by_component(stages: &[Strain], factor: f64) -> impl Iterator<Item = f64> {
    (0..4).flat_map(move |i| stages.iter().map(move |stage| factor * stage[i]))
}

/// The other way round.
pub fn by_stage(strains: &[f64]) -> impl Iterator<Item = Strain> {
    let stages = strains.len() / 4;
    (0..stages).map(move |j| Strain::from_fn(|i, _| strains[i * stages + j]))
}

/// `x += factor y`.
#[inline(always)]
fn add<const N: usize>(x: &mut [f64; N], factor: f64, y: &[f64; N]) {
    for i in 0..N {
        x[i] += factor * y[i];
    }
}
