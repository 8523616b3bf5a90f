//! How the end of an element follows from its start.
//!
//! With the strains eliminated ([`super::element`]) an element says how its end follows from its start: with `L`, `f`
//! and `g` the units of length, force and moment, `u_N = f nu - phi x N`, `u_M = dM - phi x M`, `u_p = phi` and the
//! flexibility `E`,
//!
//! ```text
//!                 rho_i                phi_i                      nu                      gamma
//! rho_{i+1} = [ I + E_rM L [N x]/L   (-[arm x] + Q_r)/L   f (E_rN - E_rM [r x])/L   g E_rM/L ]
//! phi_{i+1} = [ T E_fM L [N x]       T (I + Q_f)          f T (E_fN - E_fM [r x])   g T E_fM ]
//! gamma_{i+1} = [ (L/g)([D x] - E_lM [N x])   ([lever x] - Q_l)/g   -(f/g)(E_lN - E_lM [r x])   I - E_lM ]
//! ```
//!
//! with `Q_. = E_.N [N x] + E_.M [M x] + E_.p`, `D` the force distributed over the element, and `T` the rotation that is
//! left between the end of the element and the next node. These are the blocks of [`super::chain::Chain`].

use nalgebra::{Matrix3, Quaternion, SMatrix, Vector3};

use super::element::Exit;
use super::eliminated::Change;
use super::ends::{Units, half_angle};

type Vector = Vector3<f64>;

/// Changes of position, rotation and moment about the origin at the end of an element, by those of position, rotation,
/// force and moment about the origin at its start.
pub type Rows = SMatrix<f64, 9, 12>;

/// `E`: of arm, rotation and lever, by force, moment, and direction of the load.
pub type Flexibility = [[Matrix3<f64>; 3]; 3];

/// Where an element was linearised.
#[derive(Clone, Copy, Debug)]
pub struct Anchor {
    /// Its start.
    pub position: Vector,
    /// `N` there.
    pub force: Vector,
    /// `M` there.
    pub moment: Vector,
    /// `T`.
    pub turn: Matrix3<f64>,
}

impl Anchor {
    /// The inputs of an element from the change at its start.
    #[must_use]
    pub fn inputs(&self, change: &[f64; 12], units: &Units) -> [f64; 9] {
        let vector = |i| Vector::new(change[i], change[i + 1], change[i + 2]);
        let (shift, turn) = (units.length * vector(0), vector(3));
        let (force, about_origin) = (units.force * vector(6), units.moment * vector(9));
        let moment = about_origin - shift.cross(&self.force) - self.position.cross(&force);
        let (force, moment) = (force - turn.cross(&self.force), moment - turn.cross(&self.moment));
        let parts = [force, moment, turn];
        std::array::from_fn(|i| parts[i / 3][i % 3])
    }
}

/// The matrix of the module's header.
#[must_use]
pub fn transfer(flexibility: &Flexibility, anchor: &Anchor, exit: &Exit, units: &Units) -> Rows {
    let Units { length, force, moment } = *units;
    let (n, m) = (anchor.force.cross_matrix(), anchor.moment.cross_matrix());
    let r = anchor.position.cross_matrix();
    let mut rows = Rows::zeros();
    for (output, [by_force, by_moment, by_load]) in flexibility.iter().enumerate() {
        let by_turn = by_force * n + by_moment * m + by_load;
        let mut blocks =
            [by_moment * n * length, by_turn, (by_force - by_moment * r) * force, by_moment * moment];
        for block in &mut blocks {
            match output {
                0 => *block /= length,
                1 => *block = anchor.turn * *block,
                _ => *block /= -moment,
            }
        }
        for (i, block) in blocks.iter().enumerate() {
            rows.fixed_view_mut::<3, 3>(3 * output, 3 * i).copy_from(block);
        }
    }
    let mut add = |output: usize, input: usize, block: Matrix3<f64>| {
        let mut view = rows.fixed_view_mut::<3, 3>(3 * output, 3 * input);
        view += block;
    };
    add(0, 0, Matrix3::identity());
    add(0, 1, -exit.arm.cross_matrix() / length);
    add(1, 1, anchor.turn);
    add(2, 0, exit.force_drop.cross_matrix() * (length / moment));
    add(2, 1, exit.lever.cross_matrix() / moment);
    add(2, 3, Matrix3::identity());
    rows
}

/// A gap and what eliminating the strains adds to it.
#[must_use]
pub fn joined(gap: &[f64; 9], change: &Change, turn: &Matrix3<f64>, units: &Units) -> [f64; 9] {
    let (arm, rotation) = (change.arm / units.length, turn * change.rotation);
    let lever = change.lever / units.moment;
    std::array::from_fn(|i| match i {
        0..3 => gap[i] + arm[i],
        3..6 => gap[i] + rotation[i - 3],
        _ => gap[i] - lever[i - 6],
    })
}

/// `(I + t x)^-1 (I - t x)` with `t` the half angle: the rotation back by `w`.
#[must_use]
pub fn cayley(w: &Quaternion<f64>) -> Matrix3<f64> {
    let t = half_angle(w);
    let x = t.cross_matrix();
    let scale = 2.0 / (1.0 + t.norm_squared());
    Matrix3::identity() + (x * x - x) * scale
}
