//! The modes of a section whose growth jumps or has kinks.
//!
//! Between jumps the deflection is smooth, so its curvature is expanded on each piece of the [`Mesh`] in
//! Legendre polynomials, as many as the edge layers need. Of that large space only what the growth reaches
//! matters: with `F` the map from a curvature to its deflection (double integral, free of `1` and `x`), the
//! spaces
//!
//! ```text
//! W_0 = span{t, s, gamma},   V_j = F^T W_{j-1},   W_j = W_{j-1} + F V_j
//! ```
//!
//! hold the relaxed deflection to the order `k2^(4j)` and, since the spectrum of `F` falls like `n^-2`, to
//! rounding after few steps (block Golub-Kahan bidiagonalisation: Golub & Kahan 1965; Golub & Van Loan,
//! Matrix Computations, section 10.4). The mismatch lies in `W_0`, so none of it is lost: what no deflection
//! relieves is a mode of singular value zero.

use std::sync::OnceLock;

use faer::Mat;

use super::Reduction;
use super::basis::SIZES;
use super::general::level;
use super::mesh::{Mesh, Series};

/// The reach of some growths: a start for the modes of every law whose growth is a sum of them.
#[derive(Debug)]
pub struct Reach {
    mesh: Mesh,
    beta2: f64,
    starts: Vec<Series>,
    levels: [OnceLock<PieceModes>; LEVELS],
}

/// Modes of one level, orthonormal over the width.
#[derive(Debug)]
pub struct PieceModes {
    /// Singular values, largest first; zero for what no deflection relieves.
    pub sigma: Vec<f64>,
    /// Deflection of each mode of unit curvature over `sigma`: series on the mesh.
    pub right: Vec<Series>,
    /// Curvature of each mode; empty where `sigma` is zero.
    pub left: Vec<Series>,
}

/// Levels in use: the modes of the next would take seconds to find.
const LEVELS: usize = 4;

/// Level `i` holds up to `|K2|/(beta eta)` of this: the curvatures of the smooth basis, see `general`.
fn largest_curvature(level: usize) -> f64 {
    3.0 * 20.0 * (SIZES[level] as f64 / 8.0).powi(4)
}

impl Reach {
    /// The reach of the growths in `reductions`, which have one mesh and one material.
    #[must_use]
    pub fn new(reductions: &[Reduction]) -> Option<Self> {
        let first = reductions.first()?;
        let mesh = first.mesh.clone();
        let mut starts = vec![mesh.parabola()];
        for r in reductions {
            let nonzero = |f: &&Series| f.iter().flatten().any(|&c| c != 0.0);
            starts.extend([&r.s, &r.gamma].into_iter().filter(nonzero).cloned());
        }
        Some(Self { mesh, beta2: first.material.beta2, starts, levels: Default::default() })
    }

    /// Largest `|K2|/eta` that each level resolves to rounding.
    #[must_use]
    pub fn largest_curvatures(&self) -> Vec<f64> {
        (0..LEVELS).map(|level| self.beta2.sqrt() * largest_curvature(level)).collect()
    }

    /// The modes of a level, computed once.
    #[must_use]
    pub fn modes(&self, level: usize) -> &PieceModes {
        self.levels[level].get_or_init(|| self.decompose(largest_curvature(level)))
    }

    /// `sum_j f_j^2/(1 + mu_j k^2)`: what of the square of a mismatch remains where it is relaxed at
    /// `k = K2/eta`; not less than that, where `k` is beyond the last level.
    #[must_use]
    pub fn relaxed(&self, mismatch: &Series, k: f64) -> f64 {
        let modes = self.modes(level(k, &self.largest_curvatures()));
        let relaxed = |(right, sigma): (&Series, &f64)| {
            let component = self.mesh.dot(mismatch, right);
            component * component / (1.0 + (sigma * k).powi(2) / self.beta2)
        };
        modes.right.iter().zip(&modes.sigma).map(relaxed).sum()
    }

    /// The modes that hold up to `|K2|/(beta eta) = k`.
    fn decompose(&self, k: f64) -> PieceModes {
        let space = Space::new(&self.mesh, &self.starts, k);
        let (mut curvatures, mut deflections) = (Vec::new(), Vec::new());
        let mut images = Vec::new();
        let mut fresh = Vec::new();
        for start in &self.starts {
            fresh.extend(extend(&mut deflections, space.flat(start)));
        }
        let starts = deflections.len();
        let mut matrix = Bidiagonal::default();
        while !fresh.is_empty() {
            let mut added = Vec::new();
            for &d in &fresh {
                let moment: Vec<f64> = space.moment(&deflections[d]);
                added.extend(extend(&mut curvatures, moment));
            }
            fresh.clear();
            for &c in &added {
                let image = space.deflection(&curvatures[c]);
                fresh.extend(extend(&mut deflections, image.clone()));
                images.push(image);
            }
            matrix.extend(&deflections, &images);
            if matrix.has_converged(k, starts) {
                break;
            }
        }
        matrix.modes(&space, &deflections, &curvatures)
    }
}

/// Orthonormalises `vector` against `basis` and appends it; its place, unless it depends on the basis.
fn extend(basis: &mut Vec<Vec<f64>>, mut vector: Vec<f64>) -> Option<usize> {
    let size = norm(&vector);
    // Twice is enough (Parlett, after Kahan).
    for _ in 0..2 {
        for b in basis.iter() {
            let component = dot(b, &vector);
            vector.iter_mut().zip(b).for_each(|(v, b)| *v -= component * b);
        }
    }
    let rest = norm(&vector);
    // Also what overflowed is left out: the matrix of what remains is finite.
    if !(rest > DEPENDENT * size && rest.is_finite()) {
        return None;
    }
    vector.iter_mut().for_each(|v| *v /= rest);
    basis.push(vector);
    Some(basis.len() - 1)
}

/// A vector is in a space if no more than this part of it is outside: a few roundings.
const DEPENDENT: f64 = 1e-15;

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn norm(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}

/// `F` between the growing spaces: rows the deflections, columns the curvatures.
#[derive(Default)]
struct Bidiagonal {
    columns: Vec<Vec<f64>>,
    rows: usize,
    tried: usize,
    energies: Vec<f64>,
}

impl Bidiagonal {
    fn extend(&mut self, deflections: &[Vec<f64>], images: &[Vec<f64>]) {
        self.rows = deflections.len();
        // Earlier images lie in the earlier deflections, but for what was dropped as dependent.
        for (c, image) in images.iter().enumerate() {
            let known = self.columns.get(c).map_or(0, Vec::len);
            let more = deflections[known..].iter().map(|d| dot(d, image));
            match self.columns.get_mut(c) {
                Some(column) => column.extend(more),
                None => self.columns.push(more.collect()),
            }
        }
    }

    fn matrix(&self) -> Mat<f64> {
        Mat::from_fn(self.rows, self.columns.len(), |row, column| self.columns[column][row])
    }

    /// Whether the last growth of the space did not lower the energy `1/(1 + k^2 F F^T)` of any start.
    ///
    /// Tried whenever the space has grown by a fifth; what is left then is far below what the step brought.
    fn has_converged(&mut self, k: f64, starts: usize) -> bool {
        if self.columns.len() * 5 < self.tried * 6 {
            return false;
        }
        self.tried = self.columns.len();
        let (sigma, left, _) = self.decomposition();
        let weight = |j: usize| 1.0 / (1.0 + (k * sigma[j]).powi(2));
        let energy = |i: usize| (0..self.rows).map(|j| weight(j) * left[(i, j)] * left[(i, j)]).sum();
        let energies: Vec<f64> = (0..starts).map(energy).collect();
        let settled = |(new, old): (&f64, &f64)| (old - new).abs() <= SETTLED * new;
        let converged = self.energies.len() == starts && energies.iter().zip(&self.energies).all(settled);
        self.energies = energies;
        converged
    }

    /// Singular values, zero for what has no curvature, and singular vectors.
    fn decomposition(&self) -> (Vec<f64>, Mat<f64>, Mat<f64>) {
        // Its entries are products of unit vectors, hence finite; the QR iteration does not fail on them.
        let svd = self.matrix().svd().expect("singular values of a finite matrix");
        let values = svd.S().column_vector();
        let sigma = (0..self.rows).map(|j| if j < values.nrows() { values[j] } else { 0.0 });
        (sigma.collect(), svd.U().to_owned(), svd.V().to_owned())
    }

    fn modes(&self, space: &Space, deflections: &[Vec<f64>], curvatures: &[Vec<f64>]) -> PieceModes {
        let (sigma, left, right) = self.decomposition();
        let count = self.columns.len().min(self.rows);
        let combine = |basis: &[Vec<f64>], weight: &dyn Fn(usize) -> f64| {
            let mut sum = vec![0.0; basis.first().map_or(0, Vec::len)];
            for (i, vector) in basis.iter().enumerate() {
                let w = weight(i);
                sum.iter_mut().zip(vector).for_each(|(s, v)| *s += w * v);
            }
            sum
        };
        let shape = |j: usize| space.series(&combine(deflections, &|i| left[(i, j)]), DEFLECTION);
        let bent = |j: usize| space.series(&combine(curvatures, &|i| right[(i, j)]), CURVATURE);
        PieceModes { sigma, right: (0..self.rows).map(shape).collect(), left: (0..count).map(bent).collect() }
    }
}

/// Relative change of an energy by the last step, far above that by the next.
const SETTLED: f64 = 1e-14;

/// Extra degrees of a deflection over its curvature.
const DEFLECTION: usize = 2;
const CURVATURE: usize = 0;

/// Curvatures with `sizes` coefficients on the pieces, and their deflections with two more, as flat vectors
/// of orthonormal components.
struct Space<'a> {
    mesh: &'a Mesh,
    sizes: Vec<usize>,
}

impl<'a> Space<'a> {
    fn new(mesh: &'a Mesh, starts: &[Series], k: f64) -> Self {
        let needed = |(piece, (_, h)): (usize, (f64, f64))| {
            let degree = starts.iter().map(|s| s[piece].len()).fold(0, usize::max);
            // A polynomial mismatch needs its own degree and what its layers add.
            degree + layer_functions(k * h * h)
        };
        Self { mesh, sizes: mesh.pieces().enumerate().map(needed).collect() }
    }

    fn flat(&self, series: &Series) -> Vec<f64> {
        let mut flat = Vec::new();
        for ((series, &size), (_, h)) in series.iter().zip(&self.sizes).zip(self.mesh.pieces()) {
            let root = h.sqrt();
            let padded = series.iter().copied().chain(std::iter::repeat(0.0));
            flat.extend(padded.take(size + DEFLECTION).map(|c| c * root));
        }
        flat
    }

    fn series(&self, flat: &[f64], extra: usize) -> Series {
        let mut rest = flat;
        let mut piece = |(&size, (_, h)): (&usize, (f64, f64))| {
            let (here, after) = rest.split_at(size + extra);
            rest = after;
            here.iter().map(|c| c / h.sqrt()).collect()
        };
        self.sizes.iter().zip(self.mesh.pieces()).map(&mut piece).collect()
    }

    /// `F c`.
    fn deflection(&self, curvature: &[f64]) -> Vec<f64> {
        self.flat(&self.double_integral(&self.series(curvature, CURVATURE)))
    }

    /// `F^T w`: the bending moment that the mismatch `w` makes, the double integral that vanishes at both
    /// edges with its slope.
    fn moment(&self, mismatch: &[f64]) -> Vec<f64> {
        let series = self.series(mismatch, DEFLECTION);
        let double = self.mesh.integral(&self.mesh.integral(&series));
        let mut flat = Vec::new();
        for ((series, &size), (_, h)) in double.iter().zip(&self.sizes).zip(self.mesh.pieces()) {
            flat.extend(series.iter().take(size).map(|c| c * h.sqrt()));
        }
        flat
    }

    fn double_integral(&self, curvature: &Series) -> Series {
        let mut double = self.mesh.integral(&self.mesh.integral(curvature));
        self.mesh.remove_linear(&mut double);
        double
    }
}

/// Polynomials on a piece of length `h` that hold `exp(lambda x)`, `lambda^4 = -(K2/(beta eta))^2`, to a part
/// 1e-10 (of which the energy takes the square), for `kh2 = h^2 |K2|/(beta eta)`.
///
/// Its coefficients fall like `a^n/n!` with `a = |lambda| h/4`; where the layers are thin against the piece,
/// `n` grows with the root of their number, as the zeros of Legendre polynomials crowd at the ends.
fn layer_functions(kh2: f64) -> usize {
    let a = 0.25 * kh2.sqrt();
    let thin = (16.0 * (kh2 / 60.0).powf(0.25)).ceil().max(16.0) as usize;
    let mut term = 1.0;
    let needed = (1..thin).find(|&n| {
        term *= a / n as f64;
        term < 1e-10
    });
    needed.unwrap_or(thin) + 1
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::growth::Growth;
    use crate::material::PlaneStress;
    use crate::piecewise::Piecewise;

    /// At the largest curvature of each level the modes of the next change nothing, and they stay few
    /// however many pieces there are.
    #[test]
    fn modes_are_few_and_enough() {
        for count in [2, 5, 20] {
            let breaks = (0..=count).map(|i| (f64::from(i) / f64::from(count)).powf(1.1) - 0.5).collect();
            let pieces =
                (0..count).map(|i| vec![f64::from((i * 7919) % 13), f64::from(i % 3), 1.0]).collect();
            let steps = Piecewise::from_legendre(breaks, pieces).unwrap();
            let growth = Growth { gamma33: steps.clone().into(), d22: steps.into(), ..Growth::default() };
            let r = Reduction::new(growth.clone(), &PlaneStress::incompressible());
            let reach = Reach::new(&[r]).unwrap();
            for (level, most) in [(0, 20), (1, 40), (2, 100)] {
                assert!(reach.modes(level).sigma.len() <= most, "{count} {level}");
                let k = reach.largest_curvatures()[level];
                let relaxed = |series: &Series, level: usize| -> f64 {
                    let modes = reach.modes(level);
                    let term = |(right, sigma): (&Series, &f64)| {
                        reach.mesh.dot(series, right).powi(2) / (1.0 + (sigma * k).powi(2) / reach.beta2)
                    };
                    modes.right.iter().zip(&modes.sigma).map(term).sum()
                };
                for series in &reach.starts {
                    let (a, b) = (relaxed(series, level), relaxed(series, level + 1));
                    // Rounding of the singular values against the largest of them.
                    assert!((a - b).abs() <= 2e-14 * b, "{count} {level}: {a} {b}");
                }
            }
        }
    }
}
