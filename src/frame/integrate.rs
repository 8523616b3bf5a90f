//! Integrators of the frame equations on the group of rigid motions.

use super::{Pose, Twist};
use crate::section::Strain;
use nalgebra::Vector3;

/// Exact poses of a ribbon of constant strain at each `S`, from the pose at `S = 0`: a helix.
#[must_use]
pub fn helix(s: &[f64], strain: &Strain, start: &Pose) -> Vec<Pose> {
    let pose = |&s: &f64| {
        let (rotation, displacement) = Twist::of_strain(strain, s).exponential();
        let rotation = start.rotation * rotation;
        Pose {
            position: start.position + start.rotate(&displacement),
            rotation: rotation * (1.0 / rotation.norm()),
        }
    };
    s.iter().map(pose).collect()
}

/// Poses at the nodes `s`, for strains that are constant on each of the `s.len() - 1` segments: exact.
///
/// # Panics
/// If there are fewer strains than segments.
#[must_use]
pub fn integrate_segments(s: &[f64], strains: &[Strain], start: &Pose) -> Vec<Pose> {
    march(s, start, |i, ds| Twist::of_strain(&strains[i], ds))
}

/// Poses at the nodes `s`, for strains given at the nodes: global error of order 4.
///
/// The strains are interpolated by the cubic through the four nearest nodes (fewer if there are fewer)
/// and each segment advanced by the fourth-order Magnus exponential at its two Gauss points,
/// `Omega = (h/2)(x1 + x2) + (sqrt 3/12) h^2 [x1, x2]` (Iserles & Norsett 1999, with the sign of
/// `g' = g xi`).
///
/// # Panics
/// If there are fewer strains than nodes.
#[must_use]
pub fn integrate_nodal(s: &[f64], strains: &[Strain], start: &Pose) -> Vec<Pose> {
    let offset = 0.5 / 3f64.sqrt();
    march(s, start, |i, ds| {
        let middle = 0.5 * (s[i] + s[i + 1]);
        let twist = |x| Twist::of_strain(&cubic(s, strains, i, x), ds);
        let (first, second) = (twist(middle - offset * ds), twist(middle + offset * ds));
        (first + second) * 0.5 + first.bracket(&second) * (3f64.sqrt() / 12.0)
    })
}

/// Where [`integrate_gauss`] needs the strains: three Gauss points of each segment.
#[must_use]
pub fn gauss_points(s: &[f64]) -> Vec<[f64; 3]> {
    let offset = 15f64.sqrt() / 10.0;
    let points = |w: &[f64]| {
        let (middle, ds) = (0.5 * (w[0] + w[1]), w[1] - w[0]);
        [middle - offset * ds, middle, middle + offset * ds]
    };
    s.windows(2).map(points).collect()
}

/// Poses at the nodes `s`, for strains at the [`gauss_points`] of each segment: global error of order 6.
///
/// The sixth-order Magnus exponential of Blanes, Casas & Ros (2000), with the sign of `g' = g xi`.
///
/// # Panics
/// If there are fewer strains than segments.
#[must_use]
pub fn integrate_gauss(s: &[f64], strains: &[[Strain; 3]], start: &Pose) -> Vec<Pose> {
    march(s, start, |i, ds| {
        let [x1, x2, x3] = strains[i].map(|strain| Twist::of_strain(&strain, ds));
        let a1 = x2;
        let a2 = (x3 + x1 * -1.0) * (15f64.sqrt() / 3.0);
        let a3 = (x3 + x2 * -2.0 + x1) * (10.0 / 3.0);
        // Commutators of g' = g xi have the opposite sign of those of g' = xi g.
        let c1 = a2.bracket(&a1);
        let c2 = (a3 * 2.0 + c1).bracket(&a1) * (-1.0 / 60.0);
        let outer = (a2 + c2).bracket(&(a1 * -20.0 + a3 * -1.0 + c1));
        a1 + a3 * (1.0 / 12.0) + outer * (1.0 / 240.0)
    })
}

/// Composes the exponentials of the segments' twists from the start.
///
/// The quaternion is brought back to unit length at each step (its error there is of the order of
/// rounding, so one Newton step does), and positions are summed with compensation: over `n` segments
/// rounding grows no faster than the orientation's.
fn march(s: &[f64], start: &Pose, twist: impl Fn(usize, f64) -> Twist) -> Vec<Pose> {
    let mut poses = Vec::with_capacity(s.len());
    if s.is_empty() {
        return poses;
    }
    let mut pose = *start;
    let mut lost = Vector3::zeros();
    poses.push(pose);
    for i in 0..s.len().saturating_sub(1) {
        let (rotation, displacement) = twist(i, s[i + 1] - s[i]).exponential();
        let step = pose.rotate(&displacement) - lost;
        let position = pose.position + step;
        lost = (position - pose.position) - step;
        let product = pose.rotation * rotation;
        let unit = product * (1.5 - 0.5 * product.norm_squared());
        pose = Pose { position, rotation: unit };
        poses.push(pose);
    }
    poses
}

/// Strain at `x` in segment `i` from the polynomial through the nearest nodes, four if there are.
///
/// Written as differences from the strain at node `i`, so that constant strain stays exactly so.
fn cubic(s: &[f64], strains: &[Strain], i: usize, x: f64) -> Strain {
    match s.len() {
        0 | 1 => strains[i],
        2 => through::<2>(s, strains, i, x),
        3 => through::<3>(s, strains, i, x),
        _ => through::<4>(s, strains, i, x),
    }
}

/// The same of so many nodes.
fn through<const N: usize>(s: &[f64], strains: &[Strain], i: usize, x: f64) -> Strain {
    let first = i.saturating_sub(1).min(s.len() - N);
    let nodes: [f64; N] = std::array::from_fn(|j| s[first + j]);
    let mut change = Strain::zeros();
    for j in 0..N {
        let mut weight = 1.0;
        for k in (0..N).filter(|&k| k != j) {
            weight *= (x - nodes[k]) / (nodes[j] - nodes[k]);
        }
        change += (strains[first + j] - strains[i]) * weight;
    }
    strains[i] + change
}
