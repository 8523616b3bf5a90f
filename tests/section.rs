//! The section laws: energies against quadrature of their own deflection, derivatives, symmetries.

use proptest::prelude::*;
mod growths;

use growths::every_field;
use ribbonrs::growth::Growth;
use ribbonrs::legendre;
use ribbonrs::material::PlaneStress;
use ribbonrs::section::{Form, Section, Strain};

fn horner(c: &[f64], x: f64) -> f64 {
    c.iter().rev().fold(0.0, |sum, c| sum * x + c)
}

fn orthotropic() -> PlaneStress {
    PlaneStress::new(3.0, 1.2, 0.5, 0.4).unwrap()
}

/// The unrelaxed energy by Gauss quadrature, from the returned deflection.
fn energy_by_quadrature(law: &Section, growth: &Growth, stiffness: [f64; 4], strain: &Strain) -> f64 {
    let [q33, q22, q23, g] = stiffness;
    let e33 = q33 - q23 * q23 / q22;
    let u = law.deflection(strain).unwrap();
    let derivative = |c: &[f64], x| horner(&legendre::monomial_derivative(c), x);
    let density = |x: f64| {
        let membrane = strain[0] + strain[1] * x - strain[2] * u.u1(x) + 0.5 * (strain[3] * x).powi(2)
            - horner(&growth.gamma33.polynomial, x);
        let b33 = strain[2] + horner(&growth.d33.polynomial, x);
        let b22 = u.curvature(x) - derivative(&growth.g21.polynomial, x) + horner(&growth.d22.polynomial, x);
        let b23 =
            strain[3] + 0.5 * derivative(&growth.g31.polynomial, x) - 0.5 * horner(&growth.d23.polynomial, x);
        let bending = q33 * b33 * b33 + 2.0 * q23 * b33 * b22 + q22 * b22 * b22 + 4.0 * g * b23 * b23;
        0.5 * membrane * membrane + law.eta().powi(2) / 24.0 / e33 * bending
    };
    let (nodes, weights) = legendre::gauss(80);
    nodes.iter().zip(&weights).map(|(&x, w)| w * density(x)).sum()
}

#[test]
fn energy_is_that_of_its_deflection() {
    let eta = 0.08;
    let growth = every_field(eta);
    for (stiffness, constants) in [
        (PlaneStress::incompressible(), [4.0 / 3.0, 4.0 / 3.0, 2.0 / 3.0, 1.0 / 3.0]),
        (orthotropic(), [3.0, 1.2, 0.5, 0.4]),
    ] {
        let law = Section::new(eta, &growth, &stiffness, Form::Auto).unwrap();
        assert_eq!(law.form(), Form::General);
        for k2 in [0.0, 1e-9, 0.7, -2.0, 6.0, -30.0, 300.0] {
            let strain = Strain::new(0.004, -0.002, k2 * eta, 1.3 * eta);
            let exact = energy_by_quadrature(&law, &growth, constants, &strain);
            let energy = law.energy(&strain);
            assert!((energy - exact).abs() <= 1e-13 * exact, "{k2}: {energy} {exact}");
        }
    }
}

#[test]
fn deflection_satisfies_constraints_edges_and_its_own_derivatives() {
    let eta = 0.08;
    let growth = every_field(eta);
    let law = Section::new(eta, &growth, &PlaneStress::incompressible(), Form::Auto).unwrap();
    for k2 in [0.0, 0.7, -6.0, 100.0] {
        let strain = Strain::new(0.004, -0.002, k2 * eta, 1.3 * eta);
        let u = law.deflection(&strain).unwrap();
        let v = law.in_plane(&strain, &u);
        let (nodes, weights) = legendre::gauss(60);
        let mean = |f: &dyn Fn(f64) -> f64| nodes.iter().zip(&weights).map(|(&x, w)| w * f(x)).sum::<f64>();
        for moment in [mean(&|x| u.u1(x)), mean(&|x| x * u.u1(x)), mean(&|x| v.u2(x)), mean(&|x| v.u3(x))] {
            assert!(moment.abs() < 1e-16);
        }
        // Natural edge condition b22 + b33/2 = 0.
        for x in [-0.5, 0.5] {
            let b33 = k2 * eta + horner(&growth.d33.polynomial, x);
            let growth22 = horner(&growth.d22.polynomial, x)
                - horner(&legendre::monomial_derivative(&growth.g21.polynomial), x);
            let edge = u.curvature(x) + growth22 + 0.5 * b33;
            assert!(edge.abs() < 1e-11 * eta * (1.0 + k2.abs()), "{k2} {x}: {edge:e}");
        }
        for (a, b) in [(-0.5, 0.1), (-0.2, 0.5)] {
            let (middle, half) = (0.5 * (a + b), b - a);
            let integral = |f: &dyn Fn(f64) -> f64| half * mean(&|x| f(middle + half * x));
            assert!((u.u1(b) - u.u1(a) - integral(&|x| u.slope(x))).abs() < 1e-15);
            assert!((u.slope(b) - u.slope(a) - integral(&|x| u.curvature(x))).abs() < 1e-14);
        }
    }
}

/// Fourth-order central difference of a scalar function along one strain.
fn difference(f: impl Fn(&Strain) -> f64, at: &Strain, i: usize, step: f64) -> f64 {
    let value = |m: f64| {
        let mut moved = *at;
        moved[i] += m * step;
        f(&moved)
    };
    (8.0 * (value(1.0) - value(-1.0)) - (value(2.0) - value(-2.0))) / (12.0 * step)
}

#[test]
fn derivatives_are_those_of_the_energy() {
    let eta = 0.1;
    let edge = Growth::edge(0.06) + Growth::chiral(0.04);
    let thick = Growth::thickness(0.2, 0.0);
    for (growth, form) in [
        (edge.clone() + thick.clone(), Form::Closed),
        (every_field(eta), Form::General),
        (edge, Form::SecondOrder),
        (thick, Form::PublishedSaddle),
    ] {
        let law = Section::new(eta, &growth, &PlaneStress::incompressible(), form).unwrap();
        for k2 in [-40.0, -3.0, 0.0, 0.01, 2.4, 23.0, 25.0] {
            let at = Strain::new(0.01, 0.003, k2 * eta, 0.9 * eta);
            let value = law.evaluate(&at);
            assert!((value.energy - law.energy(&at)).abs() <= 1e-15 * value.energy.abs());
            assert_eq!(value.gradient, law.gradient(&at));
            for i in 0..4 {
                let step = 1e-2 * eta * if i < 2 { eta } else { 1.0 };
                let slope = difference(|s| law.energy(s), &at, i, step);
                // h^4 truncation of the difference at h = 1e-2 of the scale, and rounding over h.
                let scale =
                    value.gradient[i].abs() + (2.0 * value.energy * value.hessian[(i, i)]).abs().sqrt();
                assert!((slope - value.gradient[i]).abs() < 1e-9 * scale, "{form:?} {k2} {i}");
                for j in 0..4 {
                    let second = difference(|s| law.gradient(s)[j], &at, i, step);
                    let scale = (value.hessian[(i, i)] * value.hessian[(j, j)]).abs().sqrt();
                    let error = (second - value.hessian[(j, i)]).abs();
                    assert!(error < 1e-7 * scale, "{form:?} {k2} {i}{j}: {error:e} {scale:e}");
                }
            }
        }
    }
}

#[test]
fn second_order_form_is_the_limit_of_the_closed_form() {
    let eta = 0.1;
    let growth = Growth::edge(0.04) + Growth::chiral(0.02);
    let law = |form| Section::new(eta, &growth, &PlaneStress::incompressible(), form).unwrap();
    let (closed, second) = (law(Form::Closed), law(Form::SecondOrder));
    let gap = |k: f64| {
        let at = Strain::new(0.01, 0.0, k * eta, 0.5 * eta);
        closed.energy(&at) - second.energy(&at)
    };
    let order = (gap(0.4) / gap(0.2)).log2();
    assert!((order - 4.0).abs() < 0.02, "{order}");
}

#[test]
fn forms_refuse_growth_they_cannot_represent() {
    let material = PlaneStress::incompressible();
    let cubic = Growth { gamma33: vec![0.0, 0.0, 0.0, 0.1].into(), ..Growth::default() };
    for (growth, form) in [
        (cubic.clone(), Form::Closed),
        (cubic, Form::SecondOrder),
        (Growth::edge(0.1), Form::PublishedSaddle),
        (Growth::thickness(0.1, 0.0), Form::SecondOrder),
    ] {
        let error = Section::new(0.1, &growth, &material, form).unwrap_err();
        assert!(error.to_string().contains(form.name()), "{error}");
    }
    for eta in [0.0, -0.1, 1.0, f64::NAN] {
        assert!(Section::new(eta, &Growth::edge(0.1), &material, Form::Auto).is_err());
    }
}

proptest! {
    /// Mirror images of even, achiral growth, exactly.
    #[test]
    fn even_achiral_growth_does_not_know_left_from_right(
        k2 in -100.0..100.0f64, k3 in -20.0..20.0f64, x in -50.0..50.0f64, quartic in -50.0..50.0f64,
    ) {
        let eta = 0.1;
        let growth = Growth { gamma33: vec![0.0, 0.0, x * eta * eta, 0.0, quartic * eta * eta].into(), ..Growth::default() };
        let law = Section::new(eta, &growth, &PlaneStress::incompressible(), Form::Auto).unwrap();
        let at = |k2: f64, k3: f64| law.energy(&Strain::new(0.01, 0.002, k2 * eta, k3 * eta));
        prop_assert_eq!(at(k2, k3), at(-k2, k3));
        prop_assert_eq!(at(k2, k3), at(k2, -k3));
    }

    /// `Pi/eta^4` depends on `K/eta`, `eps/eta^2`, `gamma/eta^2`, `d/eta` alone.
    #[test]
    fn everything_scales_with_the_thickness(k2 in -100.0..100.0f64, k3 in -20.0..20.0f64, e in -10.0..10.0f64) {
        let energy = |eta: f64| {
            let law = Section::new(eta, &every_field(eta), &orthotropic(), Form::Auto).unwrap();
            law.energy(&Strain::new(e * eta * eta, eta * eta, k2 * eta, k3 * eta)) / eta.powi(4)
        };
        let (a, b) = (energy(0.1), energy(1e-4));
        // Rounding of the scaled inputs, against the terms that cancel in the mismatch.
        let terms = (k3 * k3 + 0.5 * k2 * k2 + 60.0) / 27.0;
        prop_assert!((a - b).abs() <= 1e-14 * (a + a.sqrt() * terms));
    }
}
