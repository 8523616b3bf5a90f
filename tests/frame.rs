//! The frame integrators: exactness, order, conservation, symmetry.

use nalgebra::{Rotation3, Vector3};
use proptest::prelude::*;
use ribbonrs::frame::{Pose, gauss_points, helix, integrate_gauss, integrate_nodal, integrate_segments};
use ribbonrs::section::Strain;

const ORIGIN: fn() -> Pose = || Pose::new([0.0; 3], [1.0, 0.0, 0.0, 0.0]);

fn grid(n: usize, length: f64) -> Vec<f64> {
    (0..=n).map(|i| length * i as f64 / n as f64).collect()
}

fn distance(a: &Pose, b: &Pose) -> f64 {
    (a.position - b.position).norm() + (a.rotation - b.rotation).norm()
}

/// Strains of some length scale 1, different in every component.
fn varying(s: f64) -> Strain {
    Strain::new(0.1 * s.cos(), 0.4 * (1.3 * s).sin(), 1.0 + 0.5 * s.cos(), 0.7 - 0.3 * (0.9 * s).sin())
}

#[test]
fn constant_strain_is_a_helix_of_the_right_radius_and_pitch() {
    let (k2, k3) = (1.5, 0.8);
    let s = grid(100, 20.0);
    let poses = helix(&s, &Strain::new(0.0, 0.0, k2, k3), &ORIGIN());
    let k2sum = k2 * k2 + k3 * k3;
    let (radius, axial) = (k2 / k2sum, k3 / k2sum.sqrt());
    // The axis of the helix is omega, through the centre of curvature side of the start: r0 + d1 K2/|K|^2.
    let axis = Vector3::new(0.0, k2, k3) / k2sum.sqrt();
    let centre = Vector3::x() * radius;
    for (s, pose) in s.iter().zip(&poses) {
        let from_axis = pose.position - centre;
        let along = from_axis.dot(&axis);
        assert!((along - axial * s).abs() < 1e-14);
        assert!(((from_axis - along * axis).norm() - radius).abs() < 1e-14);
    }
}

#[test]
fn segments_of_constant_strain_compose_to_the_helix() {
    let strain = Strain::new(0.05, 0.3, -1.1, 0.6);
    let s = grid(1000, 30.0);
    let start = Pose::new([1.0, -2.0, 0.5], [0.5, 0.5, -0.5, 0.5]);
    let exact = helix(&s, &strain, &start);
    let segments = integrate_segments(&s, &vec![strain; 1000], &start);
    let nodal = integrate_nodal(&s, &vec![strain; 1001], &start);
    let gauss = integrate_gauss(&s, &vec![[strain; 3]; 1000], &start);
    for i in 0..s.len() {
        // Equal steps round alike, so errors add up in proportion to their number.
        assert!(distance(&exact[i], &segments[i]) < 1000.0 * f64::EPSILON);
        assert!(distance(&exact[i], &nodal[i]) < 1000.0 * f64::EPSILON);
        assert!(distance(&exact[i], &gauss[i]) < 1000.0 * f64::EPSILON);
    }
}

#[test]
fn straight_is_the_limit_of_small_curvature() {
    for k in [0.0, 1e-300, 1e-160, 1e-20, 1e-10] {
        let pose = helix(&[3.0], &Strain::new(0.0, k, k, k), &ORIGIN())[0];
        // Deflection k L^2/2 to first order.
        assert!((pose.position - Vector3::new(4.5 * k, -4.5 * k, 3.0)).norm() <= 1e-15 + 30.0 * k * k);
        assert!((pose.rotation.norm() - 1.0).abs() < 2e-16);
    }
}

/// Error at the end against a solution so fine that only rounding is left.
fn measured_order(solve: impl Fn(usize) -> Pose, coarse: usize, reference: &Pose) -> f64 {
    let error = |n| distance(&solve(n), reference);
    (error(coarse) / error(2 * coarse)).log2()
}

#[test]
fn orders_of_convergence() {
    let length = 6.0;
    let nodal = |n: usize| {
        let s = grid(n, length);
        let strains: Vec<Strain> = s.iter().map(|&s| varying(s)).collect();
        *integrate_nodal(&s, &strains, &ORIGIN()).last().unwrap()
    };
    let gauss = |n: usize| {
        let s = grid(n, length);
        let strains: Vec<_> = gauss_points(&s).iter().map(|p| p.map(varying)).collect();
        *integrate_gauss(&s, &strains, &ORIGIN()).last().unwrap()
    };
    let reference = gauss(2000);
    assert!(distance(&nodal(4000), &reference) < 1e-12);
    for n in [80, 160] {
        let order = measured_order(nodal, n, &reference);
        assert!((3.9..4.6).contains(&order), "nodal order {order}");
    }
    for n in [20, 40] {
        let order = measured_order(gauss, n, &reference);
        assert!((5.8..6.5).contains(&order), "Gauss order {order}");
    }
}

#[test]
fn a_million_segments_stay_on_the_unit_sphere() {
    let n = 1_000_000;
    let s = grid(n, 1000.0);
    let strains: Vec<Strain> = s.windows(2).map(|w| varying(w[0])).collect();
    let poses = integrate_segments(&s, &strains, &ORIGIN());
    let worst = poses.iter().map(|p| (p.rotation.norm() - 1.0).abs()).fold(0.0, f64::max);
    assert!(worst <= 4e-16, "{worst:e}");
}

#[test]
fn reversal_returns_to_the_start() {
    let n = 10_000;
    let s = grid(n, 50.0);
    let strains: Vec<Strain> = s.windows(2).map(|w| varying(w[0])).collect();
    let end = *integrate_segments(&s, &strains, &ORIGIN()).last().unwrap();
    let backwards: Vec<f64> = s.iter().rev().copied().collect();
    let reversed: Vec<Strain> = strains.into_iter().rev().collect();
    let back = *integrate_segments(&backwards, &reversed, &end).last().unwrap();
    assert!(distance(&back, &ORIGIN()) < 1e-12);
}

proptest! {
    #[test]
    fn moving_the_start_moves_the_ribbon(
        angles in prop::array::uniform3(-3.0..3.0f64),
        shift in prop::array::uniform3(-5.0..5.0f64),
    ) {
        let s = grid(50, 5.0);
        let strains: Vec<Strain> = s.iter().map(|&s| varying(s)).collect();
        let rotation = Rotation3::from_euler_angles(angles[0], angles[1], angles[2]);
        let unit = nalgebra::UnitQuaternion::from_rotation_matrix(&rotation);
        let start = Pose::new(shift, [unit.w, unit.i, unit.j, unit.k]);
        let moved = integrate_nodal(&s, &strains, &start);
        for (a, b) in integrate_nodal(&s, &strains, &ORIGIN()).iter().zip(&moved) {
            let expected = rotation * a.position + Vector3::from(shift);
            prop_assert!((expected - b.position).norm() < 1e-13);
        }
    }

    #[test]
    fn mirror_image(k1 in -2.0..2.0f64, k2 in -2.0..2.0f64, k3 in -2.0..2.0f64) {
        // Reflection in the plane of E1, E3 turns K1, K3 round and keeps K2.
        let s = grid(20, 8.0);
        let a = helix(&s, &Strain::new(0.0, k1, k2, k3), &ORIGIN());
        let b = helix(&s, &Strain::new(0.0, -k1, k2, -k3), &ORIGIN());
        for (a, b) in a.iter().zip(&b) {
            let reflected = Vector3::new(a.position.x, -a.position.y, a.position.z);
            prop_assert!((reflected - b.position).norm() < 1e-14 * 20.0);
        }
    }
}
