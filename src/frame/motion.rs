//! Rigid motions: poses, twists, and the exponential that joins them.

use nalgebra::{Quaternion, Vector3};

use crate::section::Strain;

/// Position and orientation of a cross-section.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Position of the centreline, in units of `a`.
    pub position: Vector3<f64>,
    /// Unit quaternion, body to space.
    pub rotation: Quaternion<f64>,
}

impl Pose {
    /// A pose from position and unit quaternion, scalar first.
    #[must_use]
    pub fn new(position: [f64; 3], quaternion: [f64; 4]) -> Self {
        let [w, i, j, k] = quaternion;
        Self { position: Vector3::from(position), rotation: Quaternion::new(w, i, j, k) }
    }

    /// The quaternion, scalar first.
    #[must_use]
    pub fn quaternion(&self) -> [f64; 4] {
        let q = &self.rotation;
        [q.w, q.i, q.j, q.k]
    }

    /// Components on the fixed basis of a vector given on the directors.
    #[must_use]
    pub fn rotate(&self, v: &Vector3<f64>) -> Vector3<f64> {
        // v + 2 q0 (u x v) + 2 u x (u x v), u the vector part of q.
        let u = self.rotation.imag();
        let cross = 2.0 * u.cross(v);
        v + self.rotation.w * cross + u.cross(&cross)
    }
}

/// Velocity of a pose along `S`, on the directors: an element of the Lie algebra of rigid motions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Twist {
    /// Angular part, `(K1, K2, K3)` times a length of `S`.
    pub angular: Vector3<f64>,
    /// Linear part, `(0, 0, 1 + eps)` times a length of `S`, and whatever brackets add.
    pub linear: Vector3<f64>,
}

impl Twist {
    /// The twist of a strain over a length `ds`.
    #[must_use]
    pub fn of_strain(strain: &Strain, ds: f64) -> Self {
        Self {
            angular: Vector3::new(strain[1], strain[2], strain[3]) * ds,
            linear: Vector3::new(0.0, 0.0, (1.0 + strain[0]) * ds),
        }
    }

    /// Lie bracket `[self, other]`.
    #[must_use]
    pub fn bracket(&self, other: &Self) -> Self {
        Self {
            angular: self.angular.cross(&other.angular),
            linear: self.angular.cross(&other.linear) + self.linear.cross(&other.angular),
        }
    }

    /// The exponential: rotation as a unit quaternion, and displacement on the initial directors.
    ///
    /// With `phi` the angular and `v` the linear part, `theta = |phi|`: the displacement is
    /// `v + (1 - cos theta)/theta^2 phi x v + (theta - sin theta)/theta^3 phi x (phi x v)`.
    #[must_use]
    pub fn exponential(&self) -> (Quaternion<f64>, Vector3<f64>) {
        let phi = &self.angular;
        let theta2 = phi.norm_squared();
        let theta = theta2.sqrt();
        let (sin, cos) = (0.5 * theta).sin_cos();
        let half_sinc = if theta > 0.0 { sin / theta } else { 0.5 };
        let rotation = Quaternion::from_parts(cos, half_sinc * phi);
        let first = phi.cross(&self.linear);
        let second = phi.cross(&first);
        let displacement =
            self.linear + 2.0 * half_sinc * half_sinc * first + third_order(theta, theta2) * second;
        (rotation, displacement)
    }
}

/// `(theta - sin theta)/theta^3`, by its series where the difference would cancel.
fn third_order(theta: f64, theta2: f64) -> f64 {
    if theta2 > 1.0 {
        return (theta - theta.sin()) / (theta2 * theta);
    }
    // sum_k (-theta^2)^k/(2k+3)!: the first term left out is below 1e-18 of the sum.
    (0..9).rev().fold(0.0, |sum, k| {
        let k = f64::from(k);
        // Horner: each bracket multiplies the next term's ratio.
        1.0 - theta2 * sum / ((2.0 * k + 4.0) * (2.0 * k + 5.0))
    }) / 6.0
}

impl std::ops::Add for Twist {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self { angular: self.angular + other.angular, linear: self.linear + other.linear }
    }
}

impl std::ops::Mul<f64> for Twist {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        Self { angular: self.angular * factor, linear: self.linear * factor }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn third_order_is_continuous_and_right() {
        assert_eq!(third_order(0.0, 0.0), 1.0 / 6.0);
        // 1 - sin 1, rounded.
        assert!((third_order(1.0, 1.0) - 0.158_529_015_192_103_5).abs() < 1e-16);
        let t = 1.0 + 1e-15;
        assert!((third_order(t, t * t) - third_order(1.0, 1.0)).abs() < 4e-16);
    }

    #[test]
    fn quarter_turns_follow_the_conventions() {
        let quarter = std::f64::consts::FRAC_PI_2;
        // Bending about d2 by a quarter turn takes d3 to the initial d1: r curves towards +d1.
        let strain = Strain::new(0.0, 0.0, 1.0, 0.0);
        let (rotation, displacement) = Twist::of_strain(&strain, quarter).exponential();
        let pose = Pose { position: displacement, rotation };
        assert!((pose.rotate(&Vector3::z()) - Vector3::x()).norm() < 4e-16);
        assert!((displacement - Vector3::new(1.0, 0.0, 1.0)).norm() < 4e-16);
        // Twisting about d3 takes d1 to the initial d2.
        let strain = Strain::new(0.0, 0.0, 0.0, 1.0);
        let (rotation, _) = Twist::of_strain(&strain, quarter).exponential();
        let pose = Pose { position: Vector3::zeros(), rotation };
        assert!((pose.rotate(&Vector3::x()) - Vector3::y()).norm() < 4e-16);
    }
}
