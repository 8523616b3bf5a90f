//! The strains of an element eliminated: what is left is its flexibility.

use nalgebra::{Matrix3, Vector3};

use super::dense::{Determinant, backward, determinant, eliminate, forward};
use super::gauss::MAX_DEGREE;
use crate::section::Strain;

type Vector = Vector3<f64>;

/// The strains of an element eliminated: their factors, and what is left.
#[derive(Clone, Debug, Default)]
pub struct Eliminated {
    inputs: usize,
    outputs: usize,
    /// `4 s` rows: the factors of the Jacobian, then the response of the strains to the inputs.
    pub(super) block: Vec<f64>,
    swaps: Vec<usize>,
    /// Derivatives of the outputs in the strains, `outputs x 4 s`.
    pub(super) readout: Vec<f64>,
    /// Derivative of the lever in the direction of the load at fixed strains.
    pub lever: Matrix3<f64>,
    /// Derivatives of the outputs (arm, rotation, lever) in the inputs (`N`, `M`, direction of the load).
    pub flexibility: Vec<f64>,
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
    /// Makes room for the Jacobian of an element of so many strains.
    pub(super) fn begin(&mut self, strains: usize, loaded: bool) {
        (self.inputs, self.outputs) = if loaded { (9, 9) } else { (6, 6) };
        self.block.clear();
        self.block.resize(strains * (strains + self.inputs), 0.0);
        self.readout.clear();
        self.readout.resize(self.outputs * strains, 0.0);
        self.swaps.resize(strains, 0);
    }

    fn stages(&self) -> usize {
        self.swaps.len() / 4
    }

    /// Eliminates the strains: factorises their Jacobian, and reduces what the outputs owe them to the inputs.
    pub fn eliminate(&mut self) {
        let (size, stride) = (self.swaps.len(), self.swaps.len() + self.inputs);
        self.pivot = eliminate(&mut self.block, stride, size, &mut self.swaps);
        self.solve_inputs();
        self.flexibility.clear();
        for row in self.readout.chunks_exact(size) {
            for input in 0..self.inputs {
                let column = self.block[size + input..].iter().step_by(stride);
                self.flexibility.push(-row.iter().zip(column).map(|(x, y)| x * y).sum::<f64>());
            }
        }
        let loaded = self.loaded();
        for (i, k) in (0..3).flat_map(|i| (0..3).map(move |k| (i, k))).filter(|_| loaded) {
            self.flexibility[(6 + i) * self.inputs + 6 + k] += self.lever[(i, k)];
        }
    }

    /// Determinant of the Jacobian of the strains, once they are eliminated.
    #[must_use]
    pub fn determinant(&self) -> Determinant {
        determinant(&self.block, self.width(), &self.swaps)
    }

    /// The Jacobian of the stages and, beside it, its columns for the inputs: rows of [`Eliminated::width`] numbers,
    /// as long as the strains are not eliminated.
    #[must_use]
    pub fn jacobian(&self) -> &[f64] {
        &self.block
    }

    /// Number of strains and inputs.
    #[must_use]
    pub fn width(&self) -> usize {
        self.swaps.len() + self.inputs
    }

    /// What the strains do to an output: three rows, of its components, of a number a strain.
    #[must_use]
    pub fn readout(&self, output: usize) -> [&[f64]; 3] {
        let size = self.swaps.len();
        std::array::from_fn(|i| &self.readout[(3 * output + i) * size..(3 * output + i + 1) * size])
    }

    /// Back substitution of all inputs at once, row by row.
    fn solve_inputs(&mut self) {
        let (size, stride) = (self.swaps.len(), self.swaps.len() + self.inputs);
        for k in (0..size).rev() {
            let (head, tail) = self.block.split_at_mut((k + 1) * stride);
            let (factors, row) = head[k * stride..].split_at_mut(size);
            for (other, &factor) in tail.chunks_exact(stride).zip(&factors[k + 1..]) {
                for (x, y) in row.iter_mut().zip(&other[size..]) {
                    *x -= factor * y;
                }
            }
            let inverse = 1.0 / factors[k];
            row.iter_mut().for_each(|x| *x *= inverse);
        }
    }

    /// The strains that undo the residual at fixed inputs, and what that does to the outputs.
    pub fn solve(&self, residual: &[Strain], strains: &mut [Strain]) -> Change {
        let (size, stride) = (self.swaps.len(), self.swaps.len() + self.inputs);
        let mut rhs = [0.0; 4 * MAX_DEGREE];
        for (j, c) in residual.iter().take(self.stages()).enumerate() {
            for i in 0..4 {
                rhs[4 * j + i] = -c[i];
            }
        }
        forward(&self.block, stride, &self.swaps, &mut rhs[..size]);
        backward(&self.block, stride, &mut rhs[..size]);
        for (j, strain) in strains.iter_mut().enumerate() {
            *strain = Strain::from_fn(|i, _| rhs[4 * j + i]);
        }
        let row = |output: usize| {
            let row = &self.readout[output * size..(output + 1) * size];
            row.iter().zip(&rhs).map(|(x, y)| x * y).sum::<f64>()
        };
        let vector = |first: usize| Vector::from_fn(|i, _| row(first + i));
        let lever = if self.outputs > 6 { vector(6) } else { Vector::zeros() };
        Change { arm: vector(0), rotation: vector(3), lever }
    }

    /// Adds to the strains what a change of the inputs does to them.
    pub fn respond(&self, inputs: &[f64; 9], strains: &mut [Strain]) {
        let (size, stride) = (self.swaps.len(), self.swaps.len() + self.inputs);
        for (j, strain) in strains.iter_mut().enumerate() {
            for i in 0..4 {
                let row = &self.block[(4 * j + i) * stride + size..(4 * j + i + 1) * stride];
                strain[i] -= row.iter().zip(inputs).map(|(x, u)| x * u).sum::<f64>();
            }
        }
    }

    /// A 3 x 3 block of the flexibility; zero for a lever or a load that is not there.
    #[must_use]
    pub fn flexibility_block(&self, output: usize, input: usize) -> Matrix3<f64> {
        if 3 * output >= self.outputs || 3 * input >= self.inputs {
            return Matrix3::zeros();
        }
        Matrix3::from_fn(|i, k| self.flexibility[(3 * output + i) * self.inputs + 3 * input + k])
    }

    /// Whether there are distributed loads.
    #[must_use]
    pub fn loaded(&self) -> bool {
        self.inputs > 6
    }
}
