//! A scene pays only for what it uses: the short way and the long way round give the same.
//!
//! Each pair here is a row of the table in docs/performance.md, timed by benches/pays.rs.

use ribbonrs::equilibrium::{natural_branches, natural_shapes};
use ribbonrs::frame::{Pose, helix};
use ribbonrs::growth::Growth;
use ribbonrs::material::PlaneStress;
use ribbonrs::piecewise::Piecewise;
use ribbonrs::section::{Amplitude, Form, RibbonLaw, RibbonSpec, Section, Strain};

const ETA: f64 = 0.1;
const LENGTH: f64 = 10.0;

fn section(growth: &Growth, form: Form) -> Section {
    Section::new(ETA, growth, &PlaneStress::incompressible(), form).unwrap()
}

fn strains() -> impl Iterator<Item = Strain> {
    let curvatures = [0.0, 0.3, -1.0, 2.4, 7.0, 19.0];
    curvatures.into_iter().flat_map(|k| [0.2, -1.5].map(|q| Strain::new(0.01, 0.002, k * ETA, q * ETA)))
}

/// Equal energies, gradients and Hessians, to the rounding of sums of a few terms.
fn assert_equal(a: &Section, b: &Section) {
    for strain in strains() {
        let (a, b) = (a.evaluate(&strain), b.evaluate(&strain));
        assert!((a.energy - b.energy).abs() <= 1e-14 * b.energy, "{strain}");
        assert!((a.gradient - b.gradient).amax() <= 1e-14 * b.gradient.amax(), "{strain}");
        assert!((a.hessian - b.hessian).amax() <= 1e-14 * b.hessian.amax(), "{strain}");
    }
}

#[test]
fn closed_form_and_modes() {
    let growth = Growth::edge(0.06) + Growth::chiral(0.04);
    assert_equal(&section(&growth, Form::Closed), &section(&growth, Form::General));
}

#[test]
fn even_growth_takes_half_the_modes() {
    let even = vec![0.0, 0.0, 0.3, 0.0, -0.5, 0.0, 1.0];
    let mut nearly_even = even.clone();
    nearly_even[3] = 1e-20;
    let laws = [even, nearly_even]
        .map(|gamma33| section(&Growth { gamma33: gamma33.into(), ..Growth::default() }, Form::General));
    assert!(!laws[0].reduction().has_odd_part() && laws[1].reduction().has_odd_part());
    assert_equal(&laws[0], &laws[1]);
}

#[test]
fn fields_that_are_zero() {
    let profile = || vec![0.0, 0.0, 0.3, 0.2, -0.5].into();
    let alone = Growth { gamma33: profile(), ..Growth::default() };
    let zeros = || vec![0.0; 5].into();
    let all = Growth {
        gamma33: profile(),
        d33: zeros(),
        d22: zeros(),
        d23: zeros(),
        g21: zeros(),
        g31: zeros(),
        gamma22: zeros(),
        gamma23: zeros(),
    };
    assert_equal(&section(&alone, Form::Auto), &section(&all, Form::Auto));
}

#[test]
fn growth_without_jumps_needs_no_modes_of_its_own() {
    let smooth = Growth { gamma33: vec![0.0, 0.0, 0.3, 0.2].into(), ..Growth::default() };
    let zero = Piecewise::zero(&[-0.5, 0.1, 0.5]);
    let cut = smooth.clone() + Growth { gamma33: zero.into(), ..Growth::default() };
    assert_equal(&section(&smooth, Form::Auto), &section(&cut, Form::Auto));
}

#[test]
fn value_and_gradient_alone() {
    let growth = Growth { gamma33: vec![0.0, 0.0, 0.3, 0.2, -0.5].into(), ..Growth::default() };
    for law in [section(&Growth::edge(0.06), Form::Auto), section(&growth, Form::Auto)] {
        for strain in strains() {
            let all = law.evaluate(&strain);
            assert!((law.energy(&strain) - all.energy).abs() <= 1e-15 * all.energy);
            assert!((law.gradient(&strain) - all.gradient).amax() <= 1e-15 * all.gradient.amax());
        }
    }
}

fn ribbon(growth: Vec<(Amplitude, Growth)>) -> RibbonLaw {
    let spec = RibbonSpec {
        eta: ETA,
        stiffness: PlaneStress::incompressible(),
        form: Form::Auto,
        growth,
        width: Amplitude::Constant(1.0),
        thickness: Amplitude::Constant(1.0),
    };
    RibbonLaw::new(spec).unwrap()
}

fn along(value: f64) -> Amplitude {
    Amplitude::Along(Piecewise::from_legendre(vec![0.0, LENGTH], vec![vec![value]]).unwrap())
}

#[test]
fn uniform_growth_is_one_point_and_a_helix() {
    let growth = Growth::edge(0.06) + Growth::chiral(0.04);
    let shape = natural_shapes(&section(&growth, Form::Auto))[0];
    let branch = &natural_branches(&ribbon(vec![(along(1.0), growth)]), LENGTH).unwrap()[0];
    let s: Vec<f64> = (0..=100).map(|i| LENGTH * f64::from(i) / 100.0).collect();
    let start = Pose::new([0.0; 3], [1.0, 0.0, 0.0, 0.0]);
    for (a, b) in helix(&s, &shape.strain, &start).iter().zip(branch.poses(&s, &start)) {
        assert!((a.position - b.position).norm() < 1e-12 && (a.rotation - b.rotation).norm() < 1e-13);
    }
}

#[test]
fn modes_are_shared_along_the_ribbon() {
    let steps = Piecewise::from_legendre(vec![-0.5, -0.1, 0.3, 0.5], vec![vec![0.1], vec![0.0], vec![0.2]]);
    let profile = Growth { gamma33: steps.unwrap().into(), ..Growth::default() };
    let rising = Piecewise::from_legendre(vec![0.0, LENGTH], vec![vec![0.5, 0.5]]).unwrap();
    let law = ribbon(vec![(Amplitude::Along(rising.clone()), profile.clone())]);
    for s in [0.1, 3.0, 9.9] {
        let mut there = Growth::default();
        there.add_scaled(rising.evaluate(s), 1.0, &profile);
        assert_equal(law.station(s).unwrap().section(), &section(&there, Form::Auto));
    }
}
