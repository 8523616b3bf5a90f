//! The stability index: how many independent ways there are to lower the energy under the end conditions.
//!
//! Gauss collocation of the equilibrium equations is the stationarity of a discrete energy, so that the linearised
//! elements hold its second variation. With the changes `d` of pose and `p = (dN, dM)` of the wrench at the nodes an
//! element is
//!
//! ```text
//! d_{i+1} = A d_i + B p_i,   p_{i+1} = C d_i + D p_i
//! ```
//!
//! and as a stiffness, from the wrenches `-p_i` and `p_{i+1}` that hold its ends,
//!
//! ```text
//! [ K_ss  K_se ]   [ B^-1 A           -B^-1   ]
//! [ K_es  K_ee ] = [ C - D B^-1 A     D B^-1  ].
//! ```
//!
//! (Turning the frames makes the diagonal blocks unsymmetric, by parts that cancel between neighbours in equilibrium;
//! their symmetric parts are taken.) The nodes are eliminated from the start: `W_{i+1} = K_ee - K_es (W_i + K_ss)^-1 K_se`,
//! and the negative eigenvalues of every pivot `W_i + K_ss` and of the last, restricted to what the ends leave free, are
//! counted: by Sylvester's law of inertia they are those of the whole. An element that is clamped at both ends is stable
//! by itself where its section is, if it is short; one that is not is counted as infinitely unstable.

use nalgebra::{DMatrix, Matrix6, SMatrix, Vector3};

use super::ends::{End, Hold, Units};
use super::problem::Problem;
use super::transfer::Rows;

type Vector = Vector3<f64>;

/// Eigenvalues of pivots above minus this part of the largest, a few roundings, are zero.
const ZERO: f64 = 4e-15;
/// The same where a closed ribbon may glide along itself, which the error of the mesh makes a little more or less than
/// nothing.
const GLIDING: f64 = 1e-10;
/// What replaces a compliance of zero, relative to the largest.
const RIGID: f64 = 1e-8;

impl Problem {
    /// Whether the loads have a potential: a moment that is fixed in space has none, unless it is about a hinge.
    #[must_use]
    pub fn is_conservative(&self) -> bool {
        let moment = |end: &End| match end.hold {
            Hold::Free | Hold::Pinned => end.moment,
            _ => Vector::zeros(),
        };
        self.ends.iter().all(|end| moment(end) == Vector::zeros())
            && self.points.iter().all(|point| point.moment == Vector::zeros())
            && !self.has_line_couple()
    }
}

/// Changes of position and rotation that an end leaves free, as columns.
fn freedom(hold: Hold) -> DMatrix<f64> {
    let columns: Vec<[f64; 6]> = match hold {
        Hold::Clamped | Hold::Closed => vec![],
        Hold::Free => (0..6).map(unit).collect(),
        Hold::Pinned => (3..6).map(unit).collect(),
        Hold::Hinged(director) => vec![unit(3 + director)],
        Hold::Sliding(axis) => vec![[axis.x, axis.y, axis.z, 0.0, 0.0, 0.0]],
    };
    DMatrix::from_fn(6, columns.len(), |i, k| columns[k][i])
}

fn unit(i: usize) -> [f64; 6] {
    std::array::from_fn(|k| f64::from(u8::from(i == k)))
}

/// An element as a stiffness: at its start, from start to end, and at its end.
struct Stiffness {
    start: Matrix6<f64>,
    across: Matrix6<f64>,
    end: Matrix6<f64>,
}

impl Stiffness {
    /// From the change of the end pose and moment about the origin by those at the start, all in units of the problem.
    fn new(rows: &Rows, ends: [&Place; 2], units: &Units, rigid: bool) -> Option<Self> {
        let (from, to) = (&ends[0].position, &ends[1].position);
        let force = [&ends[0].force[1], &ends[1].force[0]];
        // p holds the moment about the node itself: dC = dM + dr x N + r x dN.
        let arm = |position: &Vector| position.cross_matrix() * (units.force / units.moment);
        let lever = |force: &Vector| -force.cross_matrix() * (units.length / units.moment);
        let block = |i: usize, k: usize| rows.fixed_view::<3, 3>(3 * i, 3 * k).into_owned();
        let (mut a, mut b) = (Matrix6::zeros(), Matrix6::zeros());
        let (mut c, mut d) = (Matrix6::zeros(), Matrix6::zeros());
        for i in 0..3 {
            let by_position = block(i, 0) + block(i, 3) * lever(force[0]);
            let by_force = block(i, 2) + block(i, 3) * arm(from);
            let (by_rotation, by_moment) = (block(i, 1), block(i, 3));
            if i < 2 {
                a.fixed_view_mut::<3, 3>(3 * i, 0).copy_from(&by_position);
                a.fixed_view_mut::<3, 3>(3 * i, 3).copy_from(&by_rotation);
                b.fixed_view_mut::<3, 3>(3 * i, 0).copy_from(&by_force);
                b.fixed_view_mut::<3, 3>(3 * i, 3).copy_from(&by_moment);
            } else {
                c.fixed_view_mut::<3, 3>(3, 0).copy_from(&by_position);
                c.fixed_view_mut::<3, 3>(3, 3).copy_from(&by_rotation);
                d.fixed_view_mut::<3, 3>(3, 0).copy_from(&by_force);
                d.fixed_view_mut::<3, 3>(3, 3).copy_from(&by_moment);
            }
        }
        d.fixed_view_mut::<3, 3>(0, 0).fill_with_identity();
        // M = C - r x N at the end, whose pose has changed by a and b.
        for (target, pose, by_force) in [(&mut c, &a, 0.0), (&mut d, &b, 1.0)] {
            let moved = lever(force[1]) * pose.fixed_view::<3, 6>(0, 0);
            let mut moment = target.fixed_view_mut::<3, 6>(3, 0);
            moment -= moved;
            let mut own = target.fixed_view_mut::<3, 3>(3, 0);
            own -= arm(to) * by_force;
        }
        if rigid {
            // What nothing deforms would have no inverse.
            let largest = b.amax();
            (0..6).for_each(|i| b[(i, i)] += RIGID * largest);
        }
        let inverse = b.try_inverse()?;
        // Conjugate to length and angle are units.force * length and units.moment, which are equal.
        Some(Self { start: symmetric(&(inverse * a)), across: -inverse, end: symmetric(&(d * inverse)) })
    }
}

fn symmetric(k: &Matrix6<f64>) -> Matrix6<f64> {
    0.5 * (k + k.transpose())
}

/// What is known of a node.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    /// Position.
    pub position: Vector,
    /// Internal force to its left and right.
    pub force: [Vector; 2],
}

/// The index under the end conditions; `None` where it cannot be told.
#[must_use]
pub fn index(problem: &Problem, rows: &[Rows], places: &[Place], units: &Units) -> Option<usize> {
    let rigid = problem.law.at(0.0).ok()?.compliance.min() == 0.0;
    let zero = if problem.glides() { GLIDING } else { ZERO };
    let mut negative = 0;
    // The stiffness of what is behind, at the node ahead; at first what the start leaves free.
    let mut behind: Option<Matrix6<f64>> = None;
    for (rows, ends) in rows.iter().zip(places.windows(2)) {
        let element = Stiffness::new(rows, [&ends[0], &ends[1]], units, rigid)?;
        let (pivot, across) = match behind {
            Some(w) => {
                let pivot = DMatrix::from_iterator(6, 6, (w + element.start).iter().copied());
                (pivot, DMatrix::from_iterator(6, 6, element.across.iter().copied()))
            }
            None => {
                let free = freedom(problem.ends[0].hold);
                let start = DMatrix::from_iterator(6, 6, element.start.iter().copied());
                let across = DMatrix::from_iterator(6, 6, element.across.iter().copied());
                (free.transpose() * start * &free, free.transpose() * across)
            }
        };
        let mut end = element.end;
        if pivot.nrows() > 0 {
            let (count, solved) = eliminated(&pivot, &across, zero)?;
            negative += count;
            let softened: SMatrix<f64, 6, 6> =
                SMatrix::from_iterator((across.transpose() * solved).iter().copied());
            end -= symmetric(&softened);
        }
        behind = Some(end);
    }
    let free = freedom(problem.ends[1].hold);
    if free.ncols() > 0 {
        let last = DMatrix::from_iterator(6, 6, behind?.iter().copied());
        negative += count_negative(&(free.transpose() * last * &free), zero)?;
    }
    Some(negative)
}

/// Number of negative eigenvalues of a pivot, and its solution.
fn eliminated(pivot: &DMatrix<f64>, across: &DMatrix<f64>, zero: f64) -> Option<(usize, DMatrix<f64>)> {
    if let Some(factor) = pivot.clone().cholesky() {
        return Some((0, factor.solve(across)));
    }
    Some((count_negative(pivot, zero)?, pivot.clone().lu().solve(across)?))
}

fn count_negative(pivot: &DMatrix<f64>, zero: f64) -> Option<usize> {
    if !pivot.iter().all(|x| x.is_finite()) {
        return None;
    }
    let values = pivot.symmetric_eigenvalues();
    let least = -zero * values.amax();
    Some(values.iter().filter(|&&value| value < least).count())
}
