//! Natural shapes: known thresholds and states, all found by the search.

use proptest::prelude::*;
use ribbonrs::equilibrium::{Equilibrium, Phase, natural_shapes};
use ribbonrs::growth::{Growth, Profile};
use ribbonrs::material::PlaneStress;
use ribbonrs::section::{Form, Section};

const ETA: f64 = 0.1;

/// Shapes for edge growth `xi = x eta^2` and chirality `omega`.
fn shapes(x: f64, omega: f64, form: Form) -> Vec<Equilibrium> {
    let growth = Growth::edge(x * ETA * ETA) + Growth::chiral(2.0 * ETA * omega);
    let law = Section::new(ETA, &growth, &PlaneStress::incompressible(), form).unwrap();
    natural_shapes(&law)
}

fn count(shapes: &[Equilibrium], phase: Phase) -> usize {
    shapes.iter().filter(|s| s.phase == phase).count()
}

/// Value at which a property of the shapes changes.
fn threshold(mut low: f64, mut high: f64, holds: impl Fn(f64) -> bool) -> f64 {
    assert!(!holds(low) && holds(high));
    while high - low > 1e-13 * high {
        let middle = 0.5 * (low + high);
        if holds(middle) { high = middle } else { low = middle }
    }
    high
}

#[test]
fn edge_growth_bends_then_twists() {
    for form in [Form::Closed, Form::General] {
        let flat_stable =
            |x| shapes(x, 0.0, form).iter().any(|s| s.phase == Phase::Flat && s.section_index > 0);
        let bending = threshold(3.0, 6.0, flat_stable);
        assert!((bending - (259f64.sqrt() - 7.0) / 2.0).abs() < 1e-11, "{bending}");
        let twisting = threshold(4.8, 6.0, |x| {
            shapes(x, 0.0, form).iter().any(|s| s.phase == Phase::Flat && s.section_index > 1)
        });
        assert!((twisting - 5.0).abs() < 1e-11, "{twisting}");
        for x in [4.0, 4.7, 5.5, 10.0, 200.0] {
            let all = shapes(x, 0.0, form);
            let bent = if x > bending { 2 } else { 0 };
            let twisted = if x > twisting { 2 } else { 0 };
            assert_eq!(all.len(), 1 + bent + twisted, "{x}");
            assert_eq!((count(&all, Phase::Bent), count(&all, Phase::Twisted)), (bent, twisted));
            assert!(all.iter().all(|s| s.resolved));
            for s in &all {
                let k3 = s.strain[3] / ETA;
                let exact = 8.0 * (x - 5.0);
                match s.phase {
                    // eq. (64), and C = -20 eta^2 on the whole branch; unstable from its onset.
                    Phase::Twisted => {
                        assert!((k3 * k3 / exact - 1.0).abs() < 1e-12);
                        assert_eq!(s.section_index, 1);
                    }
                    Phase::Bent => assert_eq!(s.section_index, 0),
                    _ => {}
                }
            }
        }
    }
}

#[test]
fn chirality_turns_twist_into_a_stable_helix() {
    // Not by the lowest energy, which differs by the square of the distance to the transition.
    let stable_helix =
        |all: &[Equilibrium]| all.iter().any(|s| s.phase == Phase::Helical && s.section_index == 0);
    // Bending sets in where C/eta^2 = 14 - sqrt(1036), at k3 = omega/(1 + C/20).
    for omega in [0.1f64, 0.2, 0.2226] {
        let helical = threshold(4.6, 7.0, |x| stable_helix(&shapes(x, omega, Form::Closed)));
        let c = 14.0 - 1036f64.sqrt();
        let k3 = omega / (1.0 + c / 20.0);
        // k2 grows like a root of the distance: the phase tolerance 1e-6 in k2 is 1e-12 in x.
        let exact = k3 * k3 / 8.0 - c / 4.0;
        assert!((helical - exact).abs() < 1e-10, "{helical} {exact}");
    }
    let helix = shapes(6.0, 0.2, Form::Closed)[0];
    assert!((helix.strain[2] / ETA - 2.4156).abs() < 5e-5 && (helix.strain[3] / ETA - 2.2149).abs() < 5e-5);
    assert!(helix.section_index == 0 && helix.strain[2] > 0.0);
    // Chirality alone: the narrow-to-wide transition of chiral seed pods.
    let omega = threshold(20.0, 40.0, |omega| stable_helix(&shapes(0.0, omega, Form::General)));
    let c = 14.0 + 1036f64.sqrt();
    let k3 = (2.0 * c).sqrt();
    assert!((omega - k3 * (1.0 + c / 20.0)).abs() < 1e-9, "{omega}");
}

#[test]
fn thickness_gradient_rolls_up_without_energy() {
    for xi in [1e-6, 0.05, -0.3] {
        let law = Section::new(0.05, &Growth::thickness(xi, 0.0), &PlaneStress::incompressible(), Form::Auto);
        let all = natural_shapes(&law.unwrap());
        let rolled = all[0];
        assert!((rolled.strain[2] / xi + 1.0).abs() < 1e-15);
        assert!(rolled.energy <= 1e-32 * xi * xi && rolled.section_index == 0);
    }
}

#[test]
fn no_growth_is_flat_and_second_order_has_its_spurious_helix() {
    let flat = shapes(0.0, 0.0, Form::General);
    assert_eq!(flat.len(), 1);
    assert_eq!((flat[0].phase, flat[0].section_index), (Phase::Flat, 0));
    let all = shapes(6.0, 0.0, Form::SecondOrder);
    assert_eq!(count(&all, Phase::Bent), 0);
    let spurious = all.iter().find(|s| s.phase == Phase::Helical).unwrap();
    let (k2, k3) = (spurious.strain[2] / ETA, spurious.strain[3] / ETA);
    assert!((k2 - 10.731).abs() < 5e-4 && (k3 * k3 - 48.0 - 92.374).abs() < 5e-4);
}

#[test]
fn a_close_pair_is_reported() {
    let below = shapes(5.0 + 1e-14, 0.0, Form::Closed);
    let flat = below.iter().find(|s| s.phase == Phase::Flat).unwrap();
    assert!(!flat.resolved);
    assert_eq!(count(&below, Phase::Bent), 2);
}

/// Sum of `(-1)^index` over all critical points of a function that grows in every direction: 1.
///
/// By Morse theory it is the Euler characteristic of the plane of `K2`, `K3`; a search that missed a
/// single nondegenerate equilibrium would break it.
fn euler_characteristic(shapes: &[Equilibrium]) -> i32 {
    shapes.iter().map(|s| if s.section_index % 2 == 0 { 1 } else { -1 }).sum()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(3000))]

    #[test]
    fn no_equilibrium_is_missed(
        eta in 1e-3..0.4f64,
        size in -3.0..3.5f64,
        gamma33 in prop::collection::vec(-1.0..1.0f64, 3..8),
        d33 in prop::collection::vec(-1.0..1.0f64, 0..4),
        d22 in prop::collection::vec(-1.0..1.0f64, 0..4),
        d23 in prop::collection::vec(-1.0..1.0f64, 0..3),
        g21 in prop::collection::vec(-1.0..1.0f64, 0..5),
        g31 in prop::collection::vec(-1.0..1.0f64, 0..3),
        share in -3.0..0.0f64,
        orthotropic in any::<bool>(),
    ) {
        let membrane = 30.0 * 10f64.powf(size) * eta * eta;
        let bending = 10f64.powf(0.5 * size + share) * eta;
        let times = |field: Vec<f64>, factor: f64| -> Profile { field.iter().map(|c| c * factor).collect::<Vec<_>>().into() };
        let growth = Growth {
            gamma33: times(gamma33, membrane),
            d33: times(d33, bending),
            d22: times(d22, bending),
            d23: times(d23, bending),
            g21: times(g21, bending),
            g31: times(g31, bending),
            ..Growth::default()
        };
        let stiffness = if orthotropic {
            PlaneStress::new(1.0, 1.7, -0.4, 0.25).unwrap()
        } else {
            PlaneStress::incompressible()
        };
        let law = Section::new(eta, &growth, &stiffness, Form::Auto).unwrap();
        let all = natural_shapes(&law);
        prop_assert!(!all.is_empty());
        for s in &all {
            // Residual of the forces and moments, against the stiffness times the size of the strains.
            let value = law.evaluate(&s.strain);
            for i in 0..4 {
                let scale = (2.0 * value.energy * value.hessian[(i, i)].abs()).sqrt();
                prop_assert!(value.gradient[i].abs() <= 1e-11 * scale + 1e-15 * membrane);
            }
        }
        if all.iter().all(|s| s.resolved) {
            prop_assert_eq!(euler_characteristic(&all), 1);
            prop_assert_eq!(all[0].section_index, 0);
        }
    }
}

/// Growth so small that its squares vanish in doubles still has its one natural shape.
#[test]
fn vanishing_growth_has_one_shape() {
    for size in [1e-300, 1e-243, 1e-160, 1e-100, 1e-20, 1e-9] {
        let growth = Growth {
            gamma33: vec![0.0, size, size, size].into(),
            d33: vec![size].into(),
            d23: vec![-size].into(),
            g21: vec![size, size].into(),
            ..Growth::default()
        };
        for growth in
            [growth.clone(), Growth { d23: vec![].into(), ..growth.clone() }, Growth::thickness(size, 0.0)]
        {
            let law = Section::new(ETA, &growth, &PlaneStress::incompressible(), Form::Auto).unwrap();
            let all = natural_shapes(&law);
            assert_eq!((all.len(), all[0].section_index), (1, 0), "{size}");
            assert!(all[0].resolved && all[0].strain[2].abs() <= 2.0 * size);
        }
    }
}

/// Near a bifurcation with tiny imperfections the roots are ill-conditioned, the shapes are not.
#[test]
fn ill_conditioned_roots_are_polished_or_dropped() {
    let growth = Growth {
        gamma33: vec![0.0, 0.0, 0.18187, 1e-9].into(),
        d22: vec![2e-12].into(),
        d23: vec![1e-10].into(),
        ..Growth::default()
    };
    let law = Section::new(0.1, &growth, &PlaneStress::incompressible(), Form::Auto).unwrap();
    for shape in natural_shapes(&law) {
        // Moments of a state displaced by 1e-5 in K/eta are 1e-12 here; rounding is 1e-19.
        assert!(law.gradient(&shape.strain).amax() < 1e-17, "{shape:?}");
    }
}

/// Within rounding of a pitchfork no list of resolved shapes contradicts itself.
#[test]
fn indices_add_up_wherever_shapes_are_resolved() {
    for critical in [(259f64.sqrt() - 7.0) / 2.0, 5.0] {
        for i in 0..400 {
            let all = shapes(critical * (1.0 + 1e-14 * f64::from(i - 10)), 0.0, Form::Closed);
            if all.iter().all(|s| s.resolved) {
                assert_eq!(euler_characteristic(&all), 1, "{critical} {i}");
            }
        }
    }
}
