//! The stability index: how many independent ways there are to lower the energy under the end conditions.
//!
//! Gauss collocation of the equilibrium equations is the stationarity of a discrete energy, so that the linearised
//! elements hold its second variation. With the changes `d` of pose and `p = (dN, dM + M x phi/2)` of the wrench at the
//! nodes (the term in `M` is half of what a moment that turns with the section changes by: it makes all blocks below
//! symmetric) an element is
//!
//! ```text
//! d_{i+1} = A d_i + B p_i,   p_{i+1} = C d_i + D p_i.
//! ```
//!
//! Its energy less the work of the wrench `p' = p_{i+1}` at its end is a function of `d_i` and `p'`, whose second
//! derivatives ask for no inverse of the flexibility `B`, which is singular where a ribbon is rigid:
//!
//! ```text
//! dd: D^-1 C,   dp': -D^-1,   p'p': -B D^-1.
//! ```
//!
//! With the terms `p'.d_{i+1}` that join the elements, the whole is a symmetric matrix in `p'` and `d`, of as many
//! negative eigenvalues as there are components of `p'`, and the index. The pairs `(p'_{i-1}, d_i)` are eliminated from
//! the start, which is safe since they are joined by an identity; what is carried to the next is minus the flexibility
//! `F` of all that is behind, and by Sylvester's law of inertia the negative eigenvalues of the pivots are counted,
//!
//! ```text
//! [ -F_i   1      ]                  [ -F_N   Z  -Y_N ]
//! [  1     D^-1 C ],       the last  [  Z^T   0   0   ]  with what the end leaves free, and the start.
//!                                    [ -Y_N^T 0   E_N ]
//! ```
//!
//! With `F = G S G^T`, `S` of signs, and `K = D^-1 C` such a pivot has as many as `T = S + G^T K G` more than `S`, beside
//! six: if `F` is regular, since `K + F^-1 = G^-T T G^-1`, else by continuity. `F` may be singular, and is where a ribbon is
//! rigid. The next one is `B D^-1 + X^T T^-1 X` with `X = G^T D^-1`.
//!
//! A change of pose `y` that the start leaves free, held by very soft springs, goes along to the end: it moves the end of
//! what is behind by `Y y`, `Y_0 = Z_0`, and has the energy `y.E y/2`, with `V = G^T K Y`
//!
//! ```text
//! Y' = D^-T (Y - G T^-1 V),   E' = E + Y^T K Y - V^T T^-1 V.
//! ```

use nalgebra::{DMatrix, Matrix6, SMatrix, Vector3};

use super::ends::{At, End, Hold, Units};
use super::iterate::{Correction, Iterate};
use super::problem::Problem;
use super::symmetric::Symmetric;
use super::system::{System, Targets};
use super::transfer::Rows;

type Vector = Vector3<f64>;

/// Eigenvalues of the flexibility `B D^-1` of an element below minus this part of the largest of `B`, but for rounding, are those of buckling,
/// which come from infinity.
const BUCKLED: f64 = 1e-6;
/// Flexibility of all that is behind that is nearly infinite, of what it is without stress, and stiffness of springs at the end of an element, of
/// the inverse of its own, of which one keeps it from being so.
const SINGULAR: f64 = 1e4;
const SPRINGS: [f64; 4] = [0.0, 0.2, 0.5, 1.2];
/// Stiffness of the springs at the start, in units of the soft stiffness of the whole ribbon.
const SPRING: f64 = 1e-7;
/// Part of the flexibility of all elements that stands for none at all, a few roundings, where the ends hold what is rigid.
const ROUNDING: f64 = 1e-13;

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

impl System {
    /// The stability index of a solution under the end conditions, where its sections are stable and its loads have a
    /// potential; `None` where it cannot be told.
    pub fn index(&mut self, x: &Iterate, targets: &Targets) -> Option<usize> {
        self.linearise_open(x, targets).ok()?;
        if self.sparse.is_none() {
            self.chain.close();
        }
        self.index_here(x, targets.load)
    }

    /// The same, where the equations were just linearised.
    #[must_use]
    pub fn index_here(&self, x: &Iterate, load: f64) -> Option<usize> {
        self.index_without(x, load, &self.motions())
    }

    /// The same, where it is known which motions change nothing, at right angles to one another.
    #[must_use]
    pub fn index_without(&self, x: &Iterate, load: f64, motions: &[Correction]) -> Option<usize> {
        if self.sparse.is_some() || !self.mesh.problem.is_conservative() {
            return None;
        }
        let springs: Vec<Spring> =
            motions.iter().filter_map(|motion| Spring::against(&motion.nodes)).collect();
        let place = |(i, at): (usize, &At)| {
            let jump = self.mesh.points[i].map_or(Vector::zeros(), |(force, _)| load * force);
            Place { position: at.position, force: [at.force + jump, at.force], moment: at.moment() }
        };
        let places: Vec<Place> = x.nodes.iter().enumerate().map(place).collect();
        index(&self.mesh.problem, &self.transfers, &places, &self.units, &springs)
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

/// What is known of a node.
struct Place {
    /// Position.
    position: Vector,
    /// Internal force to its left and right.
    force: [Vector; 2],
    /// Internal moment.
    moment: Vector,
}

/// An element: `A`, `B`, `C`, `D`.
struct Transfer {
    a: Matrix6<f64>,
    b: Matrix6<f64>,
    c: Matrix6<f64>,
    d: Matrix6<f64>,
}

/// An element, by the second derivatives above.
struct Blocks {
    /// `D^-1 C`, to the wrench at its start from the pose there.
    stiffness: Matrix6<f64>,
    /// `B D^-1`, of the end while the start is held.
    flexibility: Matrix6<f64>,
    /// `D^-1`.
    carried: Matrix6<f64>,
    /// Number of negative eigenvalues of the flexibility.
    buckled: usize,
}

impl Transfer {
    /// From the change of the end pose and moment about the origin by those at the start, all in units of the problem.
    fn new(rows: &Rows, ends: [&Place; 2], units: &Units) -> Self {
        // p holds the moment about the node itself: dC = dM + dr x N + r x dN.
        let arm = |place: &Place| place.position.cross_matrix() * (units.force / units.moment);
        let lever = |force: &Vector| -force.cross_matrix() * (units.length / units.moment);
        let half = |place: &Place| {
            let mut half = Matrix6::zeros();
            let turning = place.moment.cross_matrix() * (0.5 / units.moment);
            half.fixed_view_mut::<3, 3>(3, 3).copy_from(&turning);
            half
        };
        let block = |i: usize, k: usize| rows.fixed_view::<3, 3>(3 * i, 3 * k).into_owned();
        // Rows of pose and moment by pose, then by wrench.
        let (mut by_pose, mut by_wrench) = (SMatrix::<f64, 9, 6>::zeros(), SMatrix::<f64, 9, 6>::zeros());
        for i in 0..3 {
            let by_position = block(i, 0) + block(i, 3) * lever(&ends[0].force[1]);
            by_pose.fixed_view_mut::<3, 3>(3 * i, 0).copy_from(&by_position);
            by_pose.fixed_view_mut::<3, 3>(3 * i, 3).copy_from(&block(i, 1));
            let by_force = block(i, 2) + block(i, 3) * arm(ends[0]);
            by_wrench.fixed_view_mut::<3, 3>(3 * i, 0).copy_from(&by_force);
            by_wrench.fixed_view_mut::<3, 3>(3 * i, 3).copy_from(&block(i, 3));
        }
        let (mut c, mut d) = (Matrix6::zeros(), Matrix6::identity());
        // M = C - r x N at the end, whose pose has changed, too.
        let leaving = lever(&ends[1].force[0]);
        let moment = by_pose.fixed_view::<3, 6>(6, 0) - leaving * by_pose.fixed_view::<3, 6>(0, 0);
        c.fixed_view_mut::<3, 6>(3, 0).copy_from(&moment);
        let moment = by_wrench.fixed_view::<3, 6>(6, 0) - leaving * by_wrench.fixed_view::<3, 6>(0, 0);
        d.fixed_view_mut::<3, 6>(3, 0).copy_from(&moment);
        let mut own = d.fixed_view_mut::<3, 3>(3, 0);
        own -= arm(ends[1]);
        let (a, b) =
            (by_pose.fixed_view::<6, 6>(0, 0).into_owned(), by_wrench.fixed_view::<6, 6>(0, 0).into_owned());
        let [start, end] = ends.map(half);
        let d = d + end * b;
        let c = c + end * a - d * start;
        let a = a - b * start;
        Self { a, b, c, d }
    }

    /// The element with springs at its end.
    fn with_springs(&self, springs: f64) -> Option<Blocks> {
        let inverse = (self.d + springs * self.b).try_inverse()?;
        let flexibility = symmetric(&(self.b * inverse));
        let rigid = BUCKLED * self.b.amax() + ROUNDING * flexibility.amax();
        Some(Blocks {
            stiffness: symmetric(&(inverse * (self.c + springs * self.a))),
            buckled: Symmetric::new(&flexibility)?.negative(rigid),
            flexibility,
            carried: inverse,
        })
    }
}

fn symmetric(k: &Matrix6<f64>) -> Matrix6<f64> {
    0.5 * (k + k.transpose())
}

/// A spring of unit stiffness at a node, along a change of its pose.
struct Spring {
    /// The node.
    node: usize,
    /// Position and rotation.
    along: nalgebra::Vector6<f64>,
}

impl Spring {
    /// What holds a motion of all nodes: in the middle, where it is carried by both halves, or else where it moves most.
    fn against(motion: &[[f64; 12]]) -> Option<Self> {
        let pose = |node: usize| nalgebra::Vector6::from_column_slice(&motion[node][..6]);
        let size = |node: usize| pose(node).norm();
        let most = (0..motion.len()).max_by(|&a, &b| size(a).total_cmp(&size(b)))?;
        let middle = motion.len() / 2;
        let node = if size(middle) > 0.05 * size(most) { middle } else { most };
        (size(node) > 0.0).then(|| Self { node, along: pose(node) / size(node) })
    }
}

/// All that is behind a node.
struct Behind {
    /// `F`.
    flexibility: Matrix6<f64>,
    /// `Y` and `E`, what is not free padded by ones; none of a start that leaves nothing free.
    open: Option<(Matrix6<f64>, Matrix6<f64>)>,
    /// The stiffness of springs at the node, which the next element is to take back.
    taken: f64,
    /// What is rounding of `F`.
    rounding: f64,
}

impl Behind {
    /// Nothing but what the start leaves free.
    fn start(free: &DMatrix<f64>) -> Self {
        let open = (free.ncols() > 0).then(|| {
            let (mut moved, mut energy) = (Matrix6::zeros(), Matrix6::identity());
            moved.columns_mut(0, free.ncols()).copy_from(free);
            (0..free.ncols()).for_each(|i| energy[(i, i)] = SPRING);
            (moved, energy)
        });
        Self { flexibility: Matrix6::zeros(), open, taken: 0.0, rounding: 0.0 }
    }

    /// The same with the next element, and what that adds to the index. Springs at its end keep this from being about to buckle by
    /// itself, where `D` or `T` is singular; the element after is held by as much less.
    fn and(&self, element: &Transfer, springs: f64, held: &Matrix6<f64>) -> Option<(Self, isize)> {
        let Blocks { stiffness, flexibility, carried, buckled } = element.with_springs(springs)?;
        let stiffness = stiffness + held - Matrix6::from_diagonal_element(self.taken);
        let (root, signs) = Symmetric::new(&self.flexibility)?.root();
        let pivot = root.tr_mul(&(stiffness * root)) + Matrix6::from_diagonal(&signs);
        let pivot = Symmetric::new(&pivot)?;
        let before = signs.iter().filter(|sign| **sign < 0.0).count();
        // An element so long that it buckles by itself, held at its start alone: its strains were eliminated at that.
        let index = buckled as isize + pivot.negative(0.0) as isize - before as isize;
        let across = root.tr_mul(&carried);
        let open = self.open.map(|(moved, energy)| {
            let turned = root.tr_mul(&(stiffness * moved));
            let yielding = pivot.solve(&turned);
            let own = moved.tr_mul(&(stiffness * moved)) - turned.tr_mul(&yielding);
            (carried.tr_mul(&(moved - root * yielding)), energy + symmetric(&own))
        });
        let next = Self {
            flexibility: symmetric(&(flexibility + across.tr_mul(&pivot.solve(&across)))),
            open,
            taken: springs,
            rounding: self.rounding + ROUNDING * flexibility.amax(),
        };
        Some((next, index))
    }
}

/// The index under the end conditions; `None` where it cannot be told. Springs hold free
/// motions, which change nothing and do not count: they change the sign of nothing else.
fn index(
    problem: &Problem,
    rows: &[Rows],
    places: &[Place],
    units: &Units,
    holding: &[Spring],
) -> Option<usize> {
    let rigid = problem.law.at(0.0).ok()?.compliance.min() == 0.0;
    let held = |node: usize| {
        let here = holding.iter().filter(|spring| spring.node == node);
        here.fold(Matrix6::zeros(), |sum, spring| sum + spring.along * spring.along.transpose())
    };
    let start = freedom(problem.ends[0].hold);
    let mut behind = Behind::start(&start);
    let (mut index, mut soft) = (0, 0.0);
    for (i, (row, ends)) in rows.iter().zip(places.windows(2)).enumerate() {
        let element = Transfer::new(row, [&ends[0], &ends[1]], units);
        soft += element.b.amax();
        let with = |springs: &f64| behind.and(&element, springs / element.b.amax(), &held(i));
        let next =
            SPRINGS.iter().filter_map(with).find(|(next, _)| next.flexibility.amax() < SINGULAR * soft);
        let (next, unstable) = next?;
        index += unstable;
        behind = next;
    }
    let Behind { flexibility, open, taken, rounding } = behind;
    let free = freedom(problem.ends[1].hold);
    let mut last = SMatrix::<f64, 18, 18>::identity();
    last.fixed_view_mut::<6, 6>(0, 0).copy_from(&-flexibility);
    last.view_mut((0, 6), (6, free.ncols())).copy_from(&free);
    last.view_mut((6, 0), (free.ncols(), 6)).copy_from(&free.transpose());
    let spring = free.transpose() * (held(rows.len()) - Matrix6::from_diagonal_element(taken)) * &free;
    last.view_mut((6, 6), (free.ncols(), free.ncols())).copy_from(&spring);
    if let Some((moved, energy)) = open {
        last.fixed_view_mut::<6, 6>(0, 12).copy_from(&-moved);
        last.fixed_view_mut::<6, 6>(12, 0).copy_from(&-moved.transpose());
        last.fixed_view_mut::<6, 6>(12, 12).copy_from(&energy);
    }
    // No flexibility at all is a little of it.
    if rigid {
        (0..6).for_each(|i| last[(i, i)] -= rounding);
    }
    index += Symmetric::new(&last)?.negative(0.0) as isize - 6;
    usize::try_from(index).ok()
}
