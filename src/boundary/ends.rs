//! How an end is held, as six conditions.

use nalgebra::{Matrix3, Quaternion, Vector3};

type Vector = Vector3<f64>;

/// How an end is held.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Hold {
    /// Position and orientation.
    Clamped,
    /// Neither: force and moment are given.
    Free,
    /// Position; the moment is given.
    Pinned,
    /// Position, and a director (0, 1, 2) along the basis vector of its number; the moment about it is given.
    Hinged(usize),
    /// Orientation, and the position but for a translation along a unit vector; the force along it is given.
    Sliding(Vector),
    /// Position and orientation, glued to the start.
    Closed,
}

/// An end: how it is held, where, and under what load. Which fields matter depends on the hold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct End {
    /// How.
    pub hold: Hold,
    /// Position.
    pub position: Vector,
    /// Orientation before the twist, a unit quaternion.
    pub rotation: Quaternion<f64>,
    /// Full turns about E3 after `rotation`; of a closed ribbon those of the frame about its tangent.
    pub turns: f64,
    /// Dead force.
    pub force: Vector,
    /// Dead moment.
    pub moment: Vector,
}

impl End {
    /// An end at the origin, in the orientation of the fixed basis, without twist and without load.
    #[must_use]
    pub fn new(hold: Hold) -> Self {
        Self {
            hold,
            position: Vector::zeros(),
            rotation: Quaternion::new(1.0, 0.0, 0.0, 0.0),
            turns: 0.0,
            force: Vector::zeros(),
            moment: Vector::zeros(),
        }
    }
}

impl Hold {
    /// Whether the position is held, but for sliding.
    #[must_use]
    pub fn holds_position(self) -> bool {
        !matches!(self, Self::Free)
    }

    /// Whether the orientation is held.
    #[must_use]
    pub fn holds_rotation(self) -> bool {
        matches!(self, Self::Clamped | Self::Sliding(_) | Self::Closed)
    }
}

/// State at an end: position, orientation, internal force, moment about the origin.
#[derive(Clone, Copy, Debug)]
pub struct At {
    /// Position.
    pub position: Vector,
    /// Unit quaternion.
    pub rotation: Quaternion<f64>,
    /// Internal force `N`.
    pub force: Vector,
    /// `M + r x N`.
    pub about_origin: Vector,
}

impl At {
    /// Internal moment `M`.
    #[must_use]
    pub fn moment(&self) -> Vector {
        self.about_origin - self.position.cross(&self.force)
    }
}

/// Units of the unknowns: changes are of `length` in position, radians, `force`, and `moment`.
#[derive(Clone, Copy, Debug)]
pub struct Units {
    /// Of positions.
    pub length: f64,
    /// Of forces.
    pub force: f64,
    /// Of moments.
    pub moment: f64,
}

/// A condition: its derivatives in the changes of position, rotation, force, and moment about the origin (three
/// each, in [`Units`]), and minus its residual.
pub type Condition = ([f64; 12], f64);

/// The six conditions at an end. `outward` is 1 at the end, -1 at the start, where the ribbon's section faces back.
#[must_use]
pub fn conditions(end: &End, at: &At, outward: f64, units: &Units) -> [Condition; 6] {
    let mut rows = Vec::with_capacity(6);
    let basis = |i| Vector::ith(i, 1.0);
    match end.hold {
        Hold::Clamped | Hold::Closed => {
            rows.extend((0..3).map(|i| position(end, at, units, &basis(i))));
            rows.extend(rotation(end, at));
        }
        Hold::Free => {
            rows.extend((0..3).map(|i| force(end, at, outward, units, &basis(i))));
            rows.extend((0..3).map(|i| moment(end, at, outward, units, &basis(i))));
        }
        Hold::Pinned => {
            rows.extend((0..3).map(|i| position(end, at, units, &basis(i))));
            rows.extend((0..3).map(|i| moment(end, at, outward, units, &basis(i))));
        }
        Hold::Hinged(director) => {
            // On the way to it the axis is not yet where it belongs.
            let axes = directors(&end.rotation);
            let axis = |k: usize| axes.column(k % 3).into_owned();
            rows.extend((0..3).map(|i| position(end, at, units, &basis(i))));
            rows.extend([1, 2].map(|step| alignment(at, director, &axis(director + step))));
            rows.push(moment(end, at, outward, units, &axis(director)));
        }
        Hold::Sliding(axis) => {
            let least = axis.iamin();
            let across = axis.cross(&basis(least)).normalize();
            let other = axis.cross(&across);
            rows.extend([across, other].map(|direction| position(end, at, units, &direction)));
            rows.extend(rotation(end, at));
            rows.push(force(end, at, outward, units, &axis));
        }
    }
    std::array::from_fn(|i| rows[i])
}

fn row(first: usize, direction: &Vector) -> [f64; 12] {
    let mut row = [0.0; 12];
    row[first..first + 3].copy_from_slice(direction.as_slice());
    row
}

fn position(end: &End, at: &At, units: &Units, direction: &Vector) -> Condition {
    (row(0, direction), direction.dot(&(end.position - at.position)) / units.length)
}

/// `q` equals the given quaternion or its opposite: with `w = q q_end*`, the change of rotation is `-2 w_v/w_0`.
fn rotation(end: &End, at: &At) -> [Condition; 3] {
    let w = at.rotation * end.rotation.conjugate();
    let change = -2.0 * half_angle(&w);
    std::array::from_fn(|i| (row(3, &Vector::ith(i, 1.0)), change[i]))
}

/// `w_v/w_0`, the tangent of half the angle of a rotation times its axis, kept finite at a half turn.
#[must_use]
pub fn half_angle(w: &Quaternion<f64>) -> Vector {
    let least = 0.1 * w.norm();
    let scalar = if w.w.abs() < least { least.copysign(w.w) } else { w.w };
    w.imag() / scalar
}

fn force(end: &End, at: &At, outward: f64, units: &Units, direction: &Vector) -> Condition {
    (row(6, direction), direction.dot(&(outward * end.force - at.force)) / units.force)
}

fn moment(end: &End, at: &At, outward: f64, units: &Units, direction: &Vector) -> Condition {
    // M = (M + r x N) - r x N, so dM = moment dC - length dr x N - r x force dN.
    let mut change = row(9, direction);
    let by_position = -at.force.cross(direction) * (units.length / units.moment);
    let by_force = -direction.cross(&at.position) * (units.force / units.moment);
    change[..3].copy_from_slice(by_position.as_slice());
    change[6..9].copy_from_slice(by_force.as_slice());
    (change, direction.dot(&(outward * end.moment - at.moment())) / units.moment)
}

/// The component of `E_k x d_k` that vanishes with `d_k . E_other`.
fn alignment(at: &At, director: usize, other: &Vector) -> Condition {
    let d = directors(&at.rotation).column(director).into_owned();
    // d(d_k . e) = (phi x d_k) . e = phi . (d_k x e)
    (row(3, &d.cross(other)), -d.dot(other))
}

/// Whether the director of a hinge points along its axis, not against it, which meets the same conditions.
#[must_use]
pub fn is_upright(end: &End, at: &At) -> bool {
    let Hold::Hinged(director) = end.hold else { return true };
    directors(&at.rotation).column(director).dot(&directors(&end.rotation).column(director)) > 0.0
}

/// Columns `d1`, `d2`, `d3` of a unit quaternion.
#[must_use]
pub fn directors(q: &Quaternion<f64>) -> Matrix3<f64> {
    let pose = crate::frame::Pose { position: Vector::zeros(), rotation: *q };
    Matrix3::from_columns(&[0, 1, 2].map(|i| pose.rotate(&Vector::ith(i, 1.0))))
}
