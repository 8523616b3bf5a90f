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
//! direction of distributed loads). The Jacobian of the strains, by `s x s` blocks of components,
//!
//! ```text
//!           eps   K1    K2   K3  |  u_N   u_M  (u_p)
//! c_1     [  D     x     x    x  |   x     0     x  ]     D: diagonal; x: full, since the stages of an element are
//! c_2     [  x     x     x    x  |   x     x     x  ]        coupled through q_j and rho_j
//! c_3     [  x     x     x    x  |   x     x     x  ]
//! c_4     [  x     x     x    x  |   x     x     x  ]
//! ```
//!
//! is eliminated with pivoting, a singular tangent stiffness at a stage notwithstanding. What is left is the
//! flexibility of the element: the change of its end pose with the wrench.

#![expect(clippy::needless_range_loop, reason = "indices of stages, as in the equations")]

use std::array::from_fn;

use nalgebra::{Matrix3, Matrix4, Quaternion, Vector3};
use pulp::NullaryFnOnce;

use super::dense::wide;
use super::eliminated::Eliminated;
use super::gauss::{Gauss, MAX_DEGREE};
use super::lanes::{Lane, Quaternions, add, all, at, lanes, set, times, times_unit, weighted};
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

/// The stages of an element at given strains.
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
    /// By what each stage violates the law.
    pub residual: [Strain; MAX_DEGREE],
    directors: [Matrix3<f64>; MAX_DEGREE],
    tangent: [Matrix4<f64>; MAX_DEGREE],
    /// Of the system for the orientations.
    inverse: [[Quaternion<f64>; MAX_DEGREE]; MAX_DEGREE],
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
            residual: [Strain::zeros(); MAX_DEGREE],
            directors: [Matrix3::zeros(); MAX_DEGREE],
            tangent: [Matrix4::zeros(); MAX_DEGREE],
            inverse: [[ZERO; MAX_DEGREE]; MAX_DEGREE],
        }
    }
}

/// The number of stages, and the same made even, known to the compiler: loops over stages are of fixed length.
macro_rules! of_degree {
    ($degree:expr, $work:ident { $($argument:ident),* }) => {
        match $degree {
            1 => wide($work::<1, 2> { $($argument),* }),
            2 => wide($work::<2, 2> { $($argument),* }),
            3 => wide($work::<3, 4> { $($argument),* }),
            4 => wide($work::<4, 4> { $($argument),* }),
            5 => wide($work::<5, 6> { $($argument),* }),
            6 => wide($work::<6, 6> { $($argument),* }),
            7 => wide($work::<7, 8> { $($argument),* }),
            _ => wide($work::<MAX_DEGREE, MAX_DEGREE> { $($argument),* }),
        }
    };
}

struct Evaluation<'a, const S: usize, const L: usize> {
    stages: &'a mut Stages,
    span: &'a Span<'a>,
    entry: &'a Entry,
    strains: &'a [Strain],
}

impl<const S: usize, const L: usize> NullaryFnOnce for Evaluation<'_, S, L> {
    type Output = Exit;

    #[inline(always)]
    fn call(self) -> Exit {
        self.stages.evaluated::<S, L>(self.span, self.entry, self.strains)
    }
}

struct Linearisation<'a, const S: usize, const L: usize> {
    stages: &'a Stages,
    span: &'a Span<'a>,
    exit: &'a Exit,
    strains: &'a [Strain],
    into: &'a mut Eliminated,
}

impl<const S: usize, const L: usize> NullaryFnOnce for Linearisation<'_, S, L> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        self.stages.linearised::<S, L>(self.span, self.exit, self.strains, self.into);
    }
}

/// The vector part of a curvature as a quaternion.
fn pure(strain: &Strain) -> Quaternion<f64> {
    Quaternion::new(0.0, strain[1], strain[2], strain[3])
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
        let stages = self;
        of_degree!(span.gauss.degree, Evaluation { stages, span, entry, strains })
    }

    /// Linearises about the stages just evaluated.
    pub fn linearise(&self, span: &Span<'_>, exit: &Exit, strains: &[Strain], into: &mut Eliminated) {
        into.begin(span.gauss.degree, !span.load.is_empty());
        let stages = self;
        of_degree!(span.gauss.degree, Linearisation { stages, span, exit, strains, into });
    }

    #[inline(always)]
    fn evaluated<const S: usize, const L: usize>(
        &mut self,
        span: &Span<'_>,
        entry: &Entry,
        strains: &[Strain],
    ) -> Exit {
        self.orient::<S, L>(span, entry, strains);
        let h = span.length;
        let a = &span.gauss.integral;
        let mut exit = Exit {
            rotation: entry.rotation,
            arm: Vector::zeros(),
            force_drop: Vector::zeros(),
            couple_drop: Vector::zeros(),
            lever: Vector::zeros(),
        };
        let mut speed = [Vector::zeros(); MAX_DEGREE];
        for j in 0..S {
            let q = self.rotation[j];
            self.directors[j] = directors(&q);
            speed[j] = self.directors[j].column(2) * (h * (1.0 + strains[j][0]));
            let weight = span.gauss.weights[j];
            exit.arm += weight * speed[j];
            exit.rotation += q * pure(&strains[j]) * (0.5 * h * weight);
        }
        for j in 0..S {
            let mut arm = Vector::zeros();
            for k in 0..S {
                arm += a[j][k] * speed[k];
            }
            self.arm[j] = arm;
        }
        for j in 0..S {
            let (mut force, mut moment) = (entry.force, entry.moment);
            for (k, (p, c)) in span.load.iter().enumerate() {
                force -= h * a[j][k] * p;
                moment -= h * a[j][k] * (self.arm[k].cross(p) + c);
            }
            moment -= self.arm[j].cross(&force);
            (self.force[j], self.moment[j]) = (force, moment);
            let (d, m) = (&self.directors[j], self.directors[j].tr_mul(&moment));
            let resultants = Strain::new(d.column(2).dot(&force), m.x, m.y, m.z);
            let response = span.response(j);
            let (value, tangent) = response.value(&strains[j]);
            self.tangent[j] = tangent;
            self.residual[j] = value - response.compliance.component_mul(&resultants);
            if let Some(offset) = span.offset.get(j) {
                self.residual[j] -= offset;
            }
            if span.drag != 0.0 {
                self.residual[j] += span.drag * strains[j];
                self.tangent[j] += Matrix4::from_diagonal_element(span.drag);
            }
        }
        for ((p, c), (arm, &weight)) in span.load.iter().zip(self.arm.iter().zip(&span.gauss.weights)) {
            exit.force_drop += h * weight * p;
            exit.couple_drop += h * weight * c;
            exit.lever += h * weight * arm.cross(p);
        }
        exit
    }

    /// The stage orientations: `sum_k q_k (delta_kj - (h/2) a_jk K_k) = q`, by the inverse over the quaternions.
    ///
    /// Row operations multiply from the left. The pivots need no search: the matrix is the identity plus what
    /// turns by less than a right angle on any element that resolves the shape.
    #[inline(always)]
    fn orient<const S: usize, const L: usize>(&mut self, span: &Span<'_>, entry: &Entry, strains: &[Strain]) {
        let half = 0.5 * span.length;
        let mut m = [[[0.0; L]; 4]; S];
        for k in 0..S {
            for j in 0..S {
                let weight = -half * span.gauss.integral[j][k];
                for c in 1..4 {
                    m[k][c][j] = weight * strains[k][c];
                }
            }
            m[k][0][k] = 1.0;
        }
        // Gauss-Jordan in place.
        for k in 0..S {
            let pivot = at(&m[k], k);
            let pivot = pivot.conjugate() * (1.0 / pivot.norm_squared());
            set(&mut m[k], k, &Quaternion::new(1.0, 0.0, 0.0, 0.0));
            let row = times(&all(&pivot), &m[k]);
            m[k] = row;
            for i in 0..S {
                if i != k {
                    let factor = -at(&m[i], k);
                    set(&mut m[i], k, &ZERO);
                    let change = times(&all(&factor), &row);
                    for c in 0..4 {
                        add(&mut m[i][c], 1.0, &change[c]);
                    }
                }
            }
        }
        let mut sum = [[0.0; L]; 4];
        for row in &m {
            for c in 0..4 {
                add(&mut sum[c], 1.0, &row[c]);
            }
        }
        for j in 0..S {
            self.rotation[j] = entry.rotation * at(&sum, j);
            for k in 0..S {
                self.inverse[j][k] = at(&m[k], j);
            }
        }
    }

    #[inline(always)]
    fn linearised<const S: usize, const L: usize>(
        &self,
        span: &Span<'_>,
        exit: &Exit,
        strains: &[Strain],
        into: &mut Eliminated,
    ) {
        let h = span.length;
        let a: [Lane<L>; S] = from_fn(|j| from_fn(|k| span.gauss.integral[j][k]));
        let b: Lane<L> = from_fn(|l| if l < S { span.gauss.weights[l] } else { 0.0 });
        let rotation: Quaternions<L> = lanes(&self.rotation);
        // What curvature c at stage l does to stage j, [j][c][..][l]: to the rotation on its directors, to the square of the norm of its
        // quaternion, relative, and to h (1 + eps) d3.
        let mut spin = [[[[0.0; L]; 3]; 3]; S];
        let mut growth = [[[0.0; L]; 3]; S];
        let mut tilt = [[[[0.0; L]; 3]; 3]; S];
        // dq_j = sum_l q_l dK_l z_lj with z_lj = (h/2) sum_k a_kl x_kj, x the inverse.
        let mut z_end = [b, [0.0; L], [0.0; L], [0.0; L]];
        for j in 0..S {
            let mut z = [[0.0; L]; 4];
            for k in 0..S {
                let x = self.inverse[j][k] * (0.5 * h);
                for (z, x) in z.iter_mut().zip([x.w, x.i, x.j, x.k]) {
                    add(z, x, &a[k]);
                }
            }
            let turned = times(&z, &all(&(pure(&strains[j]) * b[j])));
            for c in 0..4 {
                add(&mut z_end[c], 1.0, &turned[c]);
            }
            let q = self.rotation[j];
            let relative = times(&all(&(q.conjugate() * (2.0 / q.norm_squared()))), &rotation);
            let stretched = self.directors[j] * (h * (1.0 + strains[j][0]));
            for c in 0..3 {
                [growth[j][c], spin[j][c][0], spin[j][c][1], spin[j][c][2]] =
                    times(&times_unit(&relative, c), &z);
                let (growth, spin) = (&growth[j][c], &spin[j][c]);
                for i in 0..3 {
                    let (d1, d2, d3) = (stretched[(i, 0)], stretched[(i, 1)], stretched[(i, 2)]);
                    for l in 0..L {
                        tilt[j][c][i][l] = d1 * spin[1][l] - d2 * spin[0][l] + d3 * growth[l];
                    }
                }
            }
        }
        let z_end = times(&z_end, &all(&(exit.rotation.conjugate() * h)));
        for c in 0..3 {
            let [_, turn @ ..] = times(&times_unit(&rotation, c), &z_end);
            for i in 0..3 {
                into.readout_mut(3 + i, 1 + c).copy_from_slice(&turn[i][..S]);
            }
        }
        // To the positions of the stages, by each strain, and of the end.
        let mut shift = [[[[0.0; L]; 3]; 4]; S];
        for i in 0..3 {
            let d3: Lane<L> = from_fn(|l| h * self.directors[l.min(S - 1)][(i, 2)]);
            for l in 0..S {
                into.readout_mut(i, 0)[l] = b[l] * d3[l];
            }
            for j in 0..S {
                for l in 0..L {
                    shift[j][0][i][l] = a[j][l] * d3[l];
                }
            }
            for c in 0..3 {
                let tilt: [Lane<L>; S] = from_fn(|k| tilt[k][c][i]);
                into.readout_mut(i, 1 + c).copy_from_slice(&weighted(&b, &tilt)[..S]);
                for j in 0..S {
                    shift[j][1 + c][i] = weighted(&a[j], &tilt);
                }
            }
        }
        let levers = (!span.load.is_empty()).then(|| levers(span, &shift, into));
        // rho x (p x ..) at the stages.
        let turned: [Matrix3<f64>; S] = from_fn(|k| {
            span.load
                .get(k)
                .map_or_else(Matrix3::zeros, |(p, _)| self.arm[k].cross_matrix() * p.cross_matrix())
        });
        for j in 0..S {
            let d = &self.directors[j];
            let compliance = span.response(j).compliance;
            let soft = Matrix3::from_diagonal(&compliance.fixed_rows::<3>(1).into_owned());
            let to_directors = soft * d.transpose();
            let by_shift = -to_directors * self.force[j].cross_matrix();
            let (nu, mu) = (-compliance[0] * d.tr_mul(&self.force[j]), -d.tr_mul(&self.moment[j]));
            let (by_spin, by_growth) = (soft * mu.cross_matrix(), soft * mu);
            for c in 0..4 {
                let mut rows = [[0.0; L]; 4];
                let [x, y, z] = &shift[j][c];
                for i in 0..3 {
                    let (gx, gy, gz) = (by_shift[(i, 0)], by_shift[(i, 1)], by_shift[(i, 2)]);
                    for l in 0..L {
                        rows[1 + i][l] = gx * x[l] + gy * y[l] + gz * z[l];
                    }
                }
                if let Some(levers) = &levers {
                    let moment: [Lane<L>; 3] = from_fn(|m| weighted(&a[j], &levers[c][m]));
                    for i in 0..3 {
                        for m in 0..3 {
                            add(&mut rows[1 + i], -h * to_directors[(i, m)], &moment[m]);
                        }
                    }
                }
                if c > 0 {
                    let (growth, [x, y, z]) = (&growth[j][c - 1], &spin[j][c - 1]);
                    for i in 0..3 {
                        let (gx, gy, gz, g) =
                            (by_spin[(i, 0)], by_spin[(i, 1)], by_spin[(i, 2)], by_growth[i]);
                        for l in 0..L {
                            rows[1 + i][l] += gx * x[l] + gy * y[l] + gz * z[l] + g * growth[l];
                        }
                    }
                    for l in 0..L {
                        rows[0][l] = nu.x * y[l] - nu.y * x[l] + nu.z * growth[l];
                    }
                }
                for i in 0..4 {
                    rows[i][j] += self.tangent[j][(i, c)];
                    into.block_mut(i, j, c).copy_from_slice(&rows[i][..S]);
                }
            }
            let by_force = to_directors * self.arm[j].cross_matrix();
            let axial = -compliance[0] * d.column(2);
            for input in 0..3 {
                let column = [axial[input], by_force[(0, input)], by_force[(1, input)], by_force[(2, input)]];
                into.put_input(j, input, column);
                let column = [0, 1, 2].map(|i| -to_directors[(i, input)]);
                into.put_input(j, 3 + input, [0.0, column[0], column[1], column[2]]);
            }
            if span.load.is_empty() {
                continue;
            }
            // The load turns by -u: force -p x u, moment -(rho x (p x u) + c x u).
            let (mut force, mut moment) = (Vector::zeros(), Matrix3::zeros());
            for (k, (p, c)) in span.load.iter().enumerate() {
                force += p * (h * a[j][k]);
                moment -= (turned[k] + c.cross_matrix()) * (h * a[j][k]);
            }
            let force = force.cross_matrix();
            let change = -to_directors * (moment + self.arm[j].cross_matrix() * force);
            let axial = -force.tr_mul(&axial);
            for input in 0..3 {
                let column = change.column(input);
                into.put_input(j, 6 + input, [axial[input], column[0], column[1], column[2]]);
            }
        }
        // The lever turns with the load itself, too.
        into.lever =
            turned.iter().zip(&span.gauss.weights).map(|(turned, weight)| turned * (h * weight)).sum();
    }
}

/// `p x shift` at the stages, by strain and component; of all, the moment about the start is put where it is read out.
#[inline(always)]
fn levers<const S: usize, const L: usize>(
    span: &Span<'_>,
    shift: &[[[Lane<L>; 3]; 4]; S],
    into: &mut Eliminated,
) -> [[[Lane<L>; S]; 3]; 4] {
    let mut levers = [[[[0.0; L]; S]; 3]; 4];
    let weights: Lane<L> = from_fn(|l| if l < S { -span.length * span.gauss.weights[l] } else { 0.0 });
    for c in 0..4 {
        for (k, (p, _)) in span.load.iter().enumerate().take(S) {
            let [x, y, z] = &shift[k][c];
            for l in 0..L {
                levers[c][0][k][l] = p.y * z[l] - p.z * y[l];
                levers[c][1][k][l] = p.z * x[l] - p.x * z[l];
                levers[c][2][k][l] = p.x * y[l] - p.y * x[l];
            }
        }
        for i in 0..3 {
            into.readout_mut(6 + i, c).copy_from_slice(&weighted(&weights, &levers[c][i])[..S]);
        }
    }
    levers
}
