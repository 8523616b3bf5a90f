//! Block elimination of a chain of elements with its border.
//!
//! Unknown are `n` changes of state `x_i` at each node and `m` constants `p`, 12 together. With `S` and `F` the six conditions
//! at each end, and one row of blocks an element,
//!
//! ```text
//!        x_0   x_1   x_2   ..   x_N  |  p
//!      [  S                          |  S_p ]   6 rows
//!      [ -A_0   J_1                  | -B_0 ]   n rows
//!      [       -A_1   J_2            | -B_1 ]   n rows
//!      [                 ..          |   :  ]
//!      [                         F   |  F_p ]   n + m - 6 rows
//! ```
//!
//! The six rows above and the `n` rows of an element are the panel in which `x_i` is eliminated, with partial pivoting
//! among all of them (the alternation of conditions at both ends is what makes it stable: de Hoog & Mattheij 1987);
//! six rows are left for the next. Cost and memory are linear in the number of elements.
//!
//! Where a point load makes the constants jump, `p_left = p_right + K x_i` is substituted.

use nalgebra::DMatrix;

use super::dense::{Determinant, backward, determinant, dot, eliminate, forward, least_of, padded};
use super::panel::{Panel, VANISHING_AT_SOLUTION};

/// Singular values below this part of the next are those of gliding and rolling.
const GLIDING: f64 = 1e-2;

/// Conditions at the start of the chain, and rows that are carried along.
pub const CARRIED: usize = 6;

/// A factorised chain.
#[derive(Clone, Debug)]
pub struct Chain {
    n: usize,
    m: usize,
    panels: Vec<f64>,
    swaps: Vec<usize>,
    jumps: Vec<(usize, Vec<f64>)>,
    last: Last,
    carried: Vec<f64>,
    pivot: f64,
    /// The largest factor of each constant in an element.
    sizes: Vec<f64>,
}

/// The conditions at the end: the last panel, by rows, and its factors once they are asked for.
#[derive(Clone, Debug, Default)]
struct Last {
    size: usize,
    panel: Vec<f64>,
    factors: Option<Panel>,
}

/// Right-hand sides with all but the last panel eliminated.
#[derive(Clone, Debug)]
pub struct Reduced {
    /// `n` numbers an element.
    pub kept: Vec<f64>,
    /// Of the last panel.
    pub last: Vec<f64>,
}

/// Columns and rows that border the last panel where a closed ribbon may glide along itself or, if it is the same in
/// all directions, roll about itself: the conditions at the end that follow from the others, and the changes of the
/// last node and the constants that they leave open.
#[derive(Clone, Debug, PartialEq)]
pub struct Border {
    /// How each slack enters the conditions at the end.
    pub slack: Vec<Vec<f64>>,
    /// Changes that are not made.
    pub phase: Vec<Vec<f64>>,
}

/// The most motions that are left open.
pub const MOST_SLACK: usize = 2;
/// How much the end misses along each column of a border.
pub type Slack = [f64; MOST_SLACK];

/// Changes of the states `x_i` at the nodes, and of the constants in force to the right of each node.
#[derive(Clone, Debug, Default)]
pub struct Changes {
    /// `n` numbers a node.
    pub states: Vec<f64>,
    /// `m` numbers a node.
    pub constants: Vec<f64>,
    /// Of the slack, if there is a border.
    pub slack: Slack,
}

impl Chain {
    /// An empty chain.
    #[must_use]
    pub fn new(n: usize, m: usize) -> Self {
        let carried = Vec::new();
        let (panels, swaps, jumps) = (Vec::new(), Vec::new(), Vec::new());
        Self {
            n,
            m,
            panels,
            swaps,
            jumps,
            last: Last::default(),
            carried,
            pivot: f64::INFINITY,
            sizes: vec![0.0; m],
        }
    }

    fn stride(&self) -> usize {
        padded(2 * self.n + self.m)
    }

    fn panel_size(&self) -> usize {
        (CARRIED + self.n) * self.stride()
    }

    /// Number of elements.
    #[must_use]
    pub fn elements(&self) -> usize {
        self.swaps.len() / self.n
    }

    /// Begins with the six conditions at the start, `6 x (n + m)`.
    pub fn start(&mut self, conditions: &[f64]) {
        self.panels.clear();
        self.swaps.clear();
        self.jumps.clear();
        self.pivot = f64::INFINITY;
        self.sizes.fill(0.0);
        self.last = Last::default();
        self.carried.clear();
        self.carried.extend_from_slice(conditions);
    }

    /// Adds an element, `J x_{i+1} = A x_i + B p + ...`: `A` and `J` are `n x n`, `B` is `n x m`.
    pub fn push(&mut self, a: &[f64], j: &[f64], b: &[f64]) {
        let (n, m, stride) = (self.n, self.m, self.stride());
        for row in b.chunks_exact(m.max(1)) {
            self.sizes.iter_mut().zip(row).for_each(|(size, b)| *size = size.max(b.abs()));
        }
        let first = self.panels.len();
        self.panels.resize(first + self.panel_size(), 0.0);
        let panel = &mut self.panels[first..];
        for (row, carried) in panel.chunks_exact_mut(stride).zip(self.carried.chunks_exact(n + m)) {
            row[..n].copy_from_slice(&carried[..n]);
            row[2 * n..2 * n + m].copy_from_slice(&carried[n..]);
        }
        for (i, row) in panel[CARRIED * stride..].chunks_exact_mut(stride).enumerate() {
            for k in 0..n {
                row[k] = -a[i * n + k];
            }
            row[n..2 * n].copy_from_slice(&j[i * n..(i + 1) * n]);
            for k in 0..m {
                row[2 * n + k] = -b[i * m + k];
            }
        }
        let swap = self.swaps.len();
        self.swaps.resize(swap + n, 0);
        let pivot = eliminate(panel, stride, n, &mut self.swaps[swap..]);
        self.pivot = least_of(self.pivot, pivot);
        for (row, carried) in
            panel[n * stride..].chunks_exact(stride).zip(self.carried.chunks_exact_mut(n + m))
        {
            carried.copy_from_slice(&row[n..2 * n + m]);
        }
    }

    /// At the node just reached, `p_left = p_right + K x`, with `K` of `m x n`.
    pub fn jump(&mut self, k: Vec<f64>) {
        let (n, m) = (self.n, self.m);
        for row in self.carried.chunks_exact_mut(n + m) {
            let (x, p) = row.split_at_mut(n);
            for (factor, k) in p.iter().zip(k.chunks_exact(n)) {
                x.iter_mut().zip(k).for_each(|(x, k)| *x += factor * k);
            }
        }
        self.jumps.push((self.elements(), k));
    }

    /// Ends with the conditions at the end, `(n + m - 6) x (n + m)`.
    pub fn finish(&mut self, conditions: &[f64], border: Option<&Border>) {
        let inner = self.n + self.m;
        let size = inner + border.map_or(0, |border| border.slack.len());
        let mut panel = Vec::with_capacity(size * size);
        let rows = self.carried.chunks_exact(inner).chain(conditions.chunks_exact(inner));
        for (i, row) in rows.enumerate() {
            panel.extend_from_slice(row);
            if let Some(border) = border {
                panel.extend(border.slack.iter().map(|w| if i < CARRIED { 0.0 } else { w[i - CARRIED] }));
            }
        }
        if let Some(border) = border {
            for phase in &border.phase {
                panel.extend_from_slice(phase);
                panel.extend(border.phase.iter().map(|_| 0.0));
            }
        }
        self.last = Last { size, panel, factors: None };
    }

    /// Factorises the last panel, for [`Chain::solve_last`].
    pub fn close(&mut self) {
        self.last.factors = Some(Panel::new(&self.last(), &self.sizes(), None, VANISHING_AT_SOLUTION));
    }

    /// Changes of the last panel that change nothing, or that a border keeps from being made; none before it is factorised.
    #[must_use]
    pub fn kernel(&self) -> Vec<Vec<f64>> {
        let Some(factors) = &self.last.factors else { return Vec::new() };
        let unit = |row: usize| (0..self.last.size).map(|i| f64::from(u8::from(i == row))).collect();
        let held = (self.n + self.m..self.last.size).map(|row| factors.solve(unit(row)));
        factors.kernel().iter().cloned().chain(held).collect()
    }

    /// The border that small singular values of the last panel ask for; `None` if none is far below the others.
    #[must_use]
    pub fn border(&self, conditions: &[f64]) -> Option<Border> {
        let size = self.n + self.m;
        let block: Vec<f64> = self.carried.iter().chain(conditions).copied().collect();
        if !block.iter().all(|x| x.is_finite()) {
            return None;
        }
        let svd = DMatrix::from_row_slice(size, size, &block).svd(true, true);
        let mut order: Vec<usize> = (0..size).collect();
        order.sort_by(|&i, &j| svd.singular_values[i].total_cmp(&svd.singular_values[j]));
        let value = |rank: usize| svd.singular_values[order[rank]];
        let count = (1..=MOST_SLACK).rev().find(|&k| value(k - 1) < GLIDING * value(k))?;
        let (u, v) = (svd.u?, svd.v_t?);
        let slack = |&i: &usize| {
            let w: Vec<f64> = u.column(i).iter().skip(CARRIED).copied().collect();
            let norm = w.iter().map(|x| x * x).sum::<f64>().sqrt();
            w.iter().map(|x| x / norm).collect()
        };
        let phase = |&i: &usize| v.row(i).iter().copied().collect();
        let open = &order[..count];
        Some(Border { slack: open.iter().map(slack).collect(), phase: open.iter().map(phase).collect() })
    }

    /// The least relative pivot met: of the order of rounding, zero or NaN where the chain is singular before its last panel.
    #[must_use]
    pub fn inner_pivot(&self) -> f64 {
        self.pivot
    }

    /// The same with the last panel, once it is factorised.
    #[must_use]
    pub fn pivot(&self) -> f64 {
        least_of(self.pivot, self.last.factors.as_ref().map_or(0.0, Panel::pivot))
    }

    /// Determinant of all but the last panel.
    #[must_use]
    pub fn determinant(&self) -> Determinant {
        let panels = self.panels.chunks_exact(self.panel_size()).zip(self.swaps.chunks_exact(self.n));
        let one = |(panel, swaps): (&[f64], &[usize])| determinant(panel, self.stride(), swaps);
        panels.map(one).fold(Determinant { sign: 1.0, log: 0.0 }, Determinant::times)
    }

    /// Sizes of the columns of the last panel if nothing cancels in it.
    #[must_use]
    pub fn sizes(&self) -> Vec<f64> {
        let mut sizes = vec![1.0; self.n];
        sizes.extend(&self.sizes);
        sizes.resize(self.last.size, 1.0);
        sizes
    }

    /// The last panel before its elimination, by rows: of the last node, the constants, and the slack of a border.
    #[must_use]
    pub fn last(&self) -> DMatrix<f64> {
        DMatrix::from_row_slice(self.last.size, self.last.size, &self.last.panel)
    }

    /// Condition number, in the 1-norm, of what is left for the last node and the constants.
    #[must_use]
    pub fn condition(&self) -> f64 {
        let Last { size, panel, .. } = &self.last;
        let size = *size;
        let (mut inverse, mut norm) = (0.0_f64, 0.0_f64);
        for column in 0..size {
            let mut rhs = vec![0.0; size];
            rhs[column] = 1.0;
            inverse = inverse.max(self.solve_last(&rhs).iter().map(|x| x.abs()).sum());
            norm = norm.max(panel.iter().skip(column).step_by(size).map(|x| x.abs()).sum());
        }
        norm * inverse
    }

    /// Solves the last panel, once it is factorised: by what is not a number before.
    #[must_use]
    pub fn solve_last(&self, rhs: &[f64]) -> Vec<f64> {
        match &self.last.factors {
            Some(factors) => factors.solve(rhs.to_vec()),
            None => vec![f64::NAN; rhs.len()],
        }
    }

    /// Eliminates right-hand sides at the start (6), of the elements (`n` each) and at the end, but for the last panel.
    #[must_use]
    pub fn reduce(&self, start: &[f64], elements: &[f64], end: &[f64]) -> Reduced {
        let (n, stride) = (self.n, self.stride());
        let mut carried = start.to_vec();
        let mut kept = vec![0.0; elements.len()];
        let mut rhs = vec![0.0; CARRIED + n];
        for (i, own) in elements.chunks_exact(n).enumerate() {
            rhs[..CARRIED].copy_from_slice(&carried);
            rhs[CARRIED..].copy_from_slice(own);
            let panel = &self.panels[i * self.panel_size()..(i + 1) * self.panel_size()];
            forward(panel, stride, &self.swaps[i * n..(i + 1) * n], &mut rhs);
            kept[i * n..(i + 1) * n].copy_from_slice(&rhs[..n]);
            carried.copy_from_slice(&rhs[n..]);
        }
        carried.extend_from_slice(end);
        carried.resize(self.last.size, 0.0);
        Reduced { kept, last: carried }
    }

    /// The changes of all from those of the last panel, for right-hand sides that were reduced.
    #[must_use]
    pub fn expand(&self, kept: &[f64], last: &[f64]) -> Changes {
        let (n, m, stride) = (self.n, self.m, self.stride());
        let slack = std::array::from_fn(|i| last.get(n + m + i).copied().unwrap_or(0.0));
        let count = self.elements() + 1;
        let mut states = vec![0.0; n * count];
        let mut constants = vec![0.0; m * count];
        states[n * (count - 1)..].copy_from_slice(&last[..n]);
        constants[m * (count - 1)..].copy_from_slice(&last[n..n + m]);
        let mut jumps = self.jumps.iter().rev().peekable();
        let mut known = vec![0.0; n + m];
        for i in (0..count - 1).rev() {
            let (head, next) = states.split_at_mut((i + 1) * n);
            let next = &next[..n];
            let (before, after) = constants.split_at_mut((i + 1) * m);
            let p = &mut before[i * m..];
            p.copy_from_slice(&after[..m]);
            while let Some((_, k)) = jumps.next_if(|(node, _)| *node == i + 1) {
                for (value, k) in p.iter_mut().zip(k.chunks_exact(n)) {
                    *value += k.iter().zip(next).map(|(k, x)| k * x).sum::<f64>();
                }
            }
            let panel = &self.panels[i * self.panel_size()..(i + 1) * self.panel_size()];
            known[..n].copy_from_slice(next);
            known[n..].copy_from_slice(p);
            let x = &mut head[i * n..];
            for (row, value) in x.iter_mut().enumerate() {
                let first = row * stride + n;
                *value = kept[i * n + row] - dot(&panel[first..first + n + m], &known);
            }
            backward(panel, stride, x);
        }
        Changes { states, constants, slack }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::DVector;

    /// Reproducible numbers in [-1, 1].
    fn numbers(count: usize, seed: u64) -> Vec<f64> {
        let mut state = seed;
        let next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        };
        std::iter::repeat_with(next).take(count).collect()
    }

    /// The whole matrix, dense, with a jump of the constants at the second node.
    #[test]
    fn solves_as_a_dense_matrix_does() {
        for (n, m) in [(6, 6), (9, 3), (12, 0)] {
            let count = 4;
            let size = (count + 1) * n + m;
            let random = |rows, cols, seed| DMatrix::from_row_slice(rows, cols, &numbers(rows * cols, seed));
            let (start, end) = (random(6, n + m, 1), random(n + m - 6, n + m, 2));
            let k = 0.5 * random(m, n, 3);
            let mut matrix = DMatrix::zeros(size, size);
            let mut chain = Chain::new(n, m);
            let slice = |matrix: &DMatrix<f64>| matrix.transpose().as_slice().to_vec();
            chain.start(&slice(&start));
            matrix.view_mut((0, 0), (6, n)).copy_from(&start.columns(0, n));
            matrix.view_mut((0, size - m), (6, m)).copy_from(&start.columns(n, m));
            for i in 0..count {
                let (a, b) = (random(n, n, 10 + i as u64), random(n, m, 20 + i as u64));
                let j = DMatrix::identity(n, n) + 0.1 * random(n, n, 30 + i as u64);
                chain.push(&slice(&a), &slice(&j), &slice(&b));
                let row = 6 + i * n;
                matrix.view_mut((row, i * n), (n, n)).copy_from(&-a);
                matrix.view_mut((row, (i + 1) * n), (n, n)).copy_from(&j);
                matrix.view_mut((row, size - m), (n, m)).copy_from(&-b);
                if i == 1 {
                    chain.jump(slice(&k));
                }
            }
            // Rows above the jump see the constants to its left.
            let left = matrix.view((0, size - m), (6 + 2 * n, m)) * &k;
            let mut block = matrix.view_mut((0, 2 * n), (6 + 2 * n, n));
            block += left;
            matrix.view_mut((size + 6 - n - m, count * n), (n + m - 6, n)).copy_from(&end.columns(0, n));
            matrix.view_mut((size + 6 - n - m, size - m), (n + m - 6, m)).copy_from(&end.columns(n, m));
            chain.finish(&slice(&end), None);
            chain.close();
            let rhs = numbers(size, 99);
            let split = 6 + count * n;
            let Reduced { kept, last } = chain.reduce(&rhs[..6], &rhs[6..split], &rhs[split..]);
            let found = chain.expand(&kept, &chain.solve_last(&last));
            let exact = matrix.lu().solve(&DVector::from_vec(rhs)).unwrap();
            for (x, y) in found.states.iter().zip(exact.iter()) {
                assert!((x - y).abs() < 1e-11 * exact.amax(), "{n} {m}: {x} {y}");
            }
            for (x, y) in found.constants[m * count..].iter().zip(exact.iter().skip(size - m)) {
                assert!((x - y).abs() < 1e-11 * exact.amax());
            }
        }
    }
}
