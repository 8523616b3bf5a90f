//! One element: its stages from the wrench and orientation at its start, their linearisation and elimination.
//!
//! With `s` stages at `S_j` the stage orientations, positions relative to the start, and resultants are
//!
//! ```text
//! q_j   = q + (h/2) sum_k a_jk q_k (0, K_k)                              eq. (67)
//! rho_j = h sum_k a_jk (1 + eps_k) d3(q_k)                               eq. (66)
//! N_j   = N - h sum_k a_jk p_k
//! M_j   = M - h sum_k a_jk (rho_k x p_k + c_k) - rho_j x N_j
//! n_j   = (d3.N, d1.M, d2.M, d3.M)_j
//! ```
//!
//! and the strains `e_j` are what the law asks for, `value(e_j) + drag e_j - compliance n_j - offset_j = 0`, drag and offset zero but on the way to a solution. The orientations are linear
//! in `q` at given strains: an `s x s` system over the quaternions. So only the `4 s` strains are unknowns, and
//! since a rigid motion of all changes nothing, they depend on the start through the wrench alone (and the
//! direction of distributed loads). The Jacobian of the strains, by 4 x 4 blocks of stages,
//!
//! ```text
//!           e_1   e_2  ..  e_s  |  u_N   u_M  (u_p)
//! c_1     [  x     x        x   |   x     x     x  ]      x: full, since the stages of an element are
//! c_2     [  x     x        x   |   x     x     x  ]         coupled through q_j and rho_j
//!  :      [  :                  |                  ]
//! c_s     [  x     x        x   |   x     x     x  ]
//! ```
//!
//! is eliminated with pivoting, a singular tangent stiffness at a stage notwithstanding. What is left is the
//! flexibility of the element: the change of its end pose with the wrench.

#![expect(clippy::needless_range_loop, reason = "indices of stages, as in the equations")]

use nalgebra::{Matrix3, Matrix4, Quaternion, Vector3};

use super::eliminated::Eliminated;
use super::gauss::{Gauss, MAX_DEGREE};
use super::law::Response;
use crate::section::Strain;

type Vector = Vector3<f64>;

/// What acts on an element: orientation, force and moment at its start, in the fixed basis.
#[derive(Clone, Copy, Debug)]
pub struct Entry {
    /// Unit quaternion.
    pub rotation: Quaternion<f64>,
    /// `N`.
    pub force: Vector,
    /// `M`.
    pub moment: Vector,
}

/// What is given on an element.
#[derive(Clone, Copy)]
pub struct Span<'a> {
    /// The collocation.
    pub gauss: &'a Gauss,
    /// Length.
    pub length: f64,
    /// The law at the stages; one for all if the ribbon is uniform.
    pub responses: &'a [Response],
    /// Strains by which the law is violated on purpose, on the way to a solution; none if empty.
    pub offset: &'a [Strain],
    /// Viscosity: what the law asks for beside, per unit strain.
    pub drag: f64,
    /// Distributed force and couple at the stages; none if empty.
    pub load: &'a [(Vector, Vector)],
}

impl<'a> Span<'a> {
    /// The law at a stage.
    #[must_use]
    pub fn response(&self, stage: usize) -> &Response {
        &self.responses[if self.responses.len() == 1 { 0 } else { stage }]
    }
}

/// Where an element ends.
#[derive(Clone, Copy, Debug)]
pub struct Exit {
    /// Orientation.
    pub rotation: Quaternion<f64>,
    /// Position relative to the start.
    pub arm: Vector,
    /// What distributed force takes from `N`.
    pub force_drop: Vector,
    /// What distributed couples take from the moment.
    pub couple_drop: Vector,
    /// Moment of the distributed force about the start.
    pub lever: Vector,
}

/// The stages of an element at given strains, and room for their linearisation.
#[derive(Clone, Debug)]
pub struct Stages {
    /// `q_j`.
    pub rotation: [Quaternion<f64>; MAX_DEGREE],
    /// `rho_j`.
    pub arm: [Vector; MAX_DEGREE],
    /// `N_j`.
    pub force: [Vector; MAX_DEGREE],
    /// `M_j`.
    pub moment: [Vector; MAX_DEGREE],
    /// `n_j`.
    pub resultants: [Strain; MAX_DEGREE],
    /// By what each stage violates the law.
    pub residual: [Strain; MAX_DEGREE],
    directors: [Matrix3<f64>; MAX_DEGREE],
    tangent: [Matrix4<f64>; MAX_DEGREE],
    inverse: [[Quaternion<f64>; MAX_DEGREE]; MAX_DEGREE],
    /// What a strain at stage `l` does to stage `j`, `[j][l]`: to the rotation on its directors and to the square
    /// of the norm of its quaternion (relative), for each curvature.
    spin: [[[(Vector, f64); 3]; MAX_DEGREE]; MAX_DEGREE],
    /// To the tangent `d3`, for each curvature.
    tilt: [[[Vector; 3]; MAX_DEGREE]; MAX_DEGREE],
    /// To the position, for each strain.
    shift: [[[Vector; 4]; MAX_DEGREE]; MAX_DEGREE],
}

const ZERO: Quaternion<f64> = Quaternion::new(0.0, 0.0, 0.0, 0.0);

impl Default for Stages {
    fn default() -> Self {
        let none = Vector3::zeros();
        Self {
            rotation: [ZERO; MAX_DEGREE],
            arm: [none; MAX_DEGREE],
            force: [none; MAX_DEGREE],
            moment: [none; MAX_DEGREE],
            resultants: [Strain::zeros(); MAX_DEGREE],
            residual: [Strain::zeros(); MAX_DEGREE],
            directors: [Matrix3::zeros(); MAX_DEGREE],
            tangent: [Matrix4::zeros(); MAX_DEGREE],
            inverse: [[ZERO; MAX_DEGREE]; MAX_DEGREE],
            spin: [[[(none, 0.0); 3]; MAX_DEGREE]; MAX_DEGREE],
            tilt: [[[none; 3]; MAX_DEGREE]; MAX_DEGREE],
            shift: [[[none; 4]; MAX_DEGREE]; MAX_DEGREE],
        }
    }
}

/// The vector part of a curvature as a quaternion.
fn pure(strain: &Strain) -> Quaternion<f64> {
    Quaternion::new(0.0, strain[1], strain[2], strain[3])
}

/// `q (0, e_c)`: a permutation.
fn times_unit(q: &Quaternion<f64>, c: usize) -> Quaternion<f64> {
    match c {
        0 => Quaternion::new(-q.i, q.w, q.k, -q.j),
        1 => Quaternion::new(-q.j, -q.k, q.w, q.i),
        _ => Quaternion::new(-q.k, q.j, -q.i, q.w),
    }
}

/// Columns `d1`, `d2`, `d3` times the square of the norm: quadratic in the quaternion.
fn directors(q: &Quaternion<f64>) -> Matrix3<f64> {
    let (w, i, j, k) = (q.w, q.i, q.j, q.k);
    Matrix3::new(
        w * w + i * i - j * j - k * k,
        2.0 * (i * j - w * k),
        2.0 * (i * k + w * j),
        2.0 * (i * j + w * k),
        w * w - i * i + j * j - k * k,
        2.0 * (j * k - w * i),
        2.0 * (i * k - w * j),
        2.0 * (j * k + w * i),
        w * w - i * i - j * j + k * k,
    )
}

impl Stages {
    /// Derivatives of the law at the stages last evaluated.
    #[must_use]
    pub fn tangents(&self) -> &[Matrix4<f64>] {
        &self.tangent
    }

    /// The stages at these strains, and where the element ends.
    pub fn evaluate(&mut self, span: &Span<'_>, entry: &Entry, strains: &[Strain]) -> Exit {
        self.orient(span, entry, strains);
        let (h, s) = (span.length, span.gauss.degree);
        let a = &span.gauss.integral;
        let mut exit = Exit {
            rotation: entry.rotation,
            arm: Vector::zeros(),
            force_drop: Vector::zeros(),
            couple_drop: Vector::zeros(),
            lever: Vector::zeros(),
        };
        let mut speed = [Vector::zeros(); MAX_DEGREE];
        for j in 0..s {
            self.directors[j] = directors(&self.rotation[j]);
            speed[j] = self.directors[j].column(2) * (h * (1.0 + strains[j][0]));
            let weight = span.gauss.weights[j];
            exit.arm += weight * speed[j];
            exit.rotation += self.rotation[j] * pure(&strains[j]) * (0.5 * h * weight);
        }
        for j in 0..s {
            self.arm[j] = (0..s).map(|k| a[j][k] * speed[k]).sum();
        }
        for j in 0..s {
            let (mut force, mut moment) = (entry.force, entry.moment);
            for (k, (p, c)) in span.load.iter().enumerate() {
                force -= h * a[j][k] * p;
                moment -= h * a[j][k] * (self.arm[k].cross(p) + c);
            }
            moment -= self.arm[j].cross(&force);
            let (d, m) = (&self.directors[j], self.directors[j].tr_mul(&moment));
            (self.force[j], self.moment[j]) = (force, moment);
            self.resultants[j] = Strain::new(d.column(2).dot(&force), m.x, m.y, m.z);
        }
        for ((p, c), (arm, &weight)) in span.load.iter().zip(self.arm.iter().zip(&span.gauss.weights)) {
            exit.force_drop += h * weight * p;
            exit.couple_drop += h * weight * c;
            exit.lever += h * weight * arm.cross(p);
        }
        for j in 0..s {
            let response = span.response(j);
            let (value, tangent) = response.value(&strains[j]);
            self.tangent[j] = tangent;
            self.residual[j] = value - response.compliance.component_mul(&self.resultants[j]);
            if let Some(offset) = span.offset.get(j) {
                self.residual[j] -= offset;
            }
            if span.drag != 0.0 {
                self.residual[j] += span.drag * strains[j];
                self.tangent[j] += Matrix4::from_diagonal_element(span.drag);
            }
        }
        exit
    }

    /// The stage orientations: `sum_k q_k (delta_kj - (h/2) a_jk K_k) = q`, by the inverse over the quaternions.
    ///
    /// Row operations multiply from the left. The pivots need no search: the matrix is the identity plus what
    /// turns by less than a right angle on any element that resolves the shape.
    fn orient(&mut self, span: &Span<'_>, entry: &Entry, strains: &[Strain]) {
        let (half, s) = (0.5 * span.length, span.gauss.degree);
        let m = &mut self.inverse;
        for k in 0..s {
            let curvature = pure(&strains[k]) * -half;
            for j in 0..s {
                m[k][j] = curvature * span.gauss.integral[j][k];
            }
            m[k][k].w += 1.0;
        }
        // Gauss-Jordan in place.
        for k in 0..s {
            let pivot = m[k][k].conjugate() * (1.0 / m[k][k].norm_squared());
            m[k][k] = Quaternion::new(1.0, 0.0, 0.0, 0.0);
            for j in 0..s {
                m[k][j] = pivot * m[k][j];
            }
            let row = m[k];
            for (i, other) in m.iter_mut().enumerate().take(s) {
                if i != k {
                    let factor = other[k];
                    other[k] = ZERO;
                    for j in 0..s {
                        other[j] -= factor * row[j];
                    }
                }
            }
        }
        for j in 0..s {
            let sum = (0..s).map(|k| m[k][j]).fold(ZERO, |sum, x| sum + x);
            self.rotation[j] = entry.rotation * sum;
        }
    }

    /// Linearises about the stages just evaluated.
    pub fn linearise(&mut self, span: &Span<'_>, exit: &Exit, strains: &[Strain], into: &mut Eliminated) {
        let (h, s) = (span.length, span.gauss.degree);
        let (a, b) = (&span.gauss.integral, &span.gauss.weights);
        let loaded = !span.load.is_empty();
        let inputs = if loaded { 9 } else { 6 };
        let (size, stride) = (4 * s, 4 * s + inputs);
        into.begin(size, loaded);

        // dq_j = sum_l q_l dK_l z_lj with z_lj = (h/2) sum_k a_kl x_kj, x the inverse.
        for l in 0..s {
            let mut z_end = Quaternion::new(b[l], 0.0, 0.0, 0.0);
            for j in 0..s {
                let z = (0..s).map(|k| self.inverse[k][j] * a[k][l]).fold(ZERO, |sum, x| sum + x) * (0.5 * h);
                z_end += z * pure(&strains[j]) * b[j];
                let q = &self.rotation[j];
                let relative = q.conjugate() * self.rotation[l] * (2.0 / q.norm_squared());
                let d = &self.directors[j];
                for c in 0..3 {
                    let twice = times_unit(&relative, c) * z;
                    let (spin, growth) = (twice.imag(), twice.w);
                    self.spin[j][l][c] = (spin, growth);
                    self.tilt[j][l][c] = d.column(0) * spin.y - d.column(1) * spin.x + d.column(2) * growth;
                }
            }
            let z_end = z_end * (0.5 * h);
            for c in 0..3 {
                let turn = times_unit(&self.rotation[l], c) * z_end * exit.rotation.conjugate();
                let turn = 2.0 * turn.imag();
                for i in 0..3 {
                    into.readout[(3 + i) * size + 4 * l + 1 + c] = turn[i];
                }
            }
        }
        // Weighted tilts, then what they move.
        for l in 0..s {
            let mut moved = [Vector::zeros(); 4];
            for k in 0..s {
                let stretch = h * (1.0 + strains[k][0]);
                for c in 0..3 {
                    self.tilt[k][l][c] *= stretch;
                    moved[1 + c] += b[k] * self.tilt[k][l][c];
                }
            }
            moved[0] = self.directors[l].column(2) * (h * b[l]);
            for (c, column) in moved.iter().enumerate() {
                for i in 0..3 {
                    into.readout[i * size + 4 * l + c] = column[i];
                }
            }
            for j in 0..s {
                let mut shift = [
                    self.directors[l].column(2) * (h * a[j][l]),
                    Vector::zeros(),
                    Vector::zeros(),
                    Vector::zeros(),
                ];
                for k in 0..s {
                    for c in 0..3 {
                        shift[1 + c] += a[j][k] * self.tilt[k][l][c];
                    }
                }
                self.shift[j][l] = shift;
            }
        }
        if loaded {
            for l in 0..s {
                for c in 0..4 {
                    let lever: Vector =
                        (0..s).map(|k| self.shift[k][l][c].cross(&span.load[k].0) * (h * b[k])).sum();
                    for i in 0..3 {
                        into.readout[(6 + i) * size + 4 * l + c] = lever[i];
                    }
                }
            }
        }
        for j in 0..s {
            let d = &self.directors[j];
            let compliance = span.response(j).compliance;
            let (nu, mu) = (d.tr_mul(&self.force[j]), d.tr_mul(&self.moment[j]));
            for l in 0..s {
                for c in 0..4 {
                    let mut moment = -self.shift[j][l][c].cross(&self.force[j]);
                    for (k, (p, _)) in span.load.iter().enumerate() {
                        moment -= self.shift[k][l][c].cross(p) * (h * a[j][k]);
                    }
                    let mut change = d.tr_mul(&moment);
                    let mut axial = 0.0;
                    if c > 0 {
                        let (spin, growth) = &self.spin[j][l][c - 1];
                        change += mu.cross(spin) + mu * *growth;
                        axial = nu.x * spin.y - nu.y * spin.x + nu.z * growth;
                    }
                    let change = [axial, change.x, change.y, change.z];
                    for i in 0..4 {
                        let own = if j == l { self.tangent[j][(i, c)] } else { 0.0 };
                        into.block[(4 * j + i) * stride + 4 * l + c] = own - compliance[i] * change[i];
                    }
                }
            }
            for input in 0..inputs {
                let unit = Vector::ith(input % 3, 1.0);
                let (mut force, mut moment) = (Vector::zeros(), Vector::zeros());
                match input / 3 {
                    0 => force = unit,
                    1 => moment = unit,
                    _ => {
                        // The load turns by -unit.
                        for (k, (p, c)) in span.load.iter().enumerate() {
                            force += unit.cross(p) * (h * a[j][k]);
                            moment += (self.arm[k].cross(&unit.cross(p)) + unit.cross(c)) * (h * a[j][k]);
                        }
                    }
                }
                let change = d.tr_mul(&(moment - self.arm[j].cross(&force)));
                let change = [d.column(2).dot(&force), change.x, change.y, change.z];
                for i in 0..4 {
                    into.block[(4 * j + i) * stride + size + input] = -compliance[i] * change[i];
                }
            }
        }
        // The lever turns with the load itself, too.
        into.lever = Matrix3::zeros();
        for (arm, ((p, _), weight)) in self.arm.iter().zip(span.load.iter().zip(b)) {
            into.lever += arm.cross_matrix() * p.cross_matrix() * (h * weight);
        }
    }
}
