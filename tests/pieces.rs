//! Growth given on pieces of the width, against the same growth without pieces and against integrals.

mod growths;

use growths::every_field;
use ribbonrs::growth::{Growth, Profile};
use ribbonrs::material::PlaneStress;
use ribbonrs::piecewise::Piecewise;
use ribbonrs::section::{Amplitude, Form, RibbonLaw, RibbonSpec, Section, Strain};

/// The polynomial growth with each field given on pieces between `breaks`.
fn cut(growth: &Growth, breaks: &[f64]) -> Growth {
    let mut pieces = growth.clone();
    for (name, field) in growth.fields() {
        if !field.polynomial.is_empty() {
            let whole = whole(&field.polynomial).refined(breaks);
            *pieces.field_mut(name).unwrap() = Profile::from(whole);
        }
    }
    pieces
}

/// A polynomial in `x` of degree 4 at most as a single piece.
fn whole(c: &[f64]) -> Piecewise {
    let at = |k: usize| c.get(k).copied().unwrap_or(0.0) / 2f64.powi(k as i32);
    let legendre = vec![
        at(0) + at(2) / 3.0 + at(4) / 5.0,
        at(1) + at(3) * 0.6,
        at(2) * 2.0 / 3.0 + at(4) * 4.0 / 7.0,
        at(3) * 0.4,
        at(4) * 8.0 / 35.0,
    ];
    Piecewise::from_legendre(vec![-0.5, 0.5], vec![legendre]).unwrap()
}

/// Gradients through the thickness scale with the width and the other fields do not: the modes that the
/// sections of a tapering ribbon share hold both.
#[test]
fn modes_of_a_tapering_ribbon_hold_every_section() {
    let growth = cut(&every_field(0.1), &[-0.5, -0.2, 0.1, 0.5]);
    let stiffness = PlaneStress::incompressible();
    let taper = Piecewise::from_legendre(vec![0.0, 10.0], vec![vec![0.6, -0.4]]).unwrap();
    let law = RibbonLaw::new(RibbonSpec {
        eta: 0.1,
        stiffness,
        form: Form::Auto,
        growth: vec![(Amplitude::Constant(1.0), growth.clone())],
        width: Amplitude::Along(taper.clone()),
        thickness: Amplitude::Constant(1.0),
    })
    .unwrap();
    for s in [0.0, 4.0, 9.0] {
        let width = taper.evaluate(s);
        let mut there = Growth::default();
        there.add_scaled(1.0, width, &growth);
        let alone = Section::new(0.1 / width, &there, &stiffness, Form::Auto).unwrap();
        for k2 in [0.3, -1.0] {
            let strain = Strain::new(0.01, 0.003, k2, 0.2);
            let (a, b) = (law.station(s).unwrap().section().energy(&strain), alone.energy(&strain));
            assert!((a - b).abs() <= 1e-14 * b, "{s} {k2}: {a} {b}");
        }
    }
}

#[test]
fn pieces_of_a_polynomial_are_the_polynomial() {
    for (stiffness, eta) in
        [(PlaneStress::incompressible(), 0.1), (PlaneStress::new(3.0, 1.2, 0.5, 0.4).unwrap(), 0.03)]
    {
        let growth = every_field(eta);
        let law = Section::new(eta, &growth, &stiffness, Form::General).unwrap();
        for breaks in
            [vec![-0.5, 0.5], vec![-0.5, 0.123, 0.5], (0..=40).map(|i| f64::from(i) / 40.0 - 0.5).collect()]
        {
            let pieces = Section::new(eta, &cut(&growth, &breaks), &stiffness, Form::General).unwrap();
            for k2 in [0.0, 1e-6, 0.5, -3.0, 20.0, 100.0, -1e3, 1e4] {
                let strain = Strain::new(0.2 * eta * eta, 0.1 * eta * eta, k2 * eta, 1.5 * eta);
                let (a, b) = (law.evaluate(&strain), pieces.evaluate(&strain));
                // Rounding of the growth's series against the energy of a mismatch this large.
                assert!(
                    (a.energy - b.energy).abs() <= 1e-13 * a.energy,
                    "{} {k2}: {} {}",
                    breaks.len(),
                    a.energy,
                    b.energy
                );
                for i in 0..4 {
                    let scale = (a.energy * a.hessian[(i, i)].abs()).sqrt();
                    assert!(
                        (a.gradient[i] - b.gradient[i]).abs() <= 1e-12 * scale,
                        "{} {k2} {i}: {} {}",
                        breaks.len(),
                        a.gradient[i],
                        b.gradient[i]
                    );
                    for j in 0..4 {
                        let scale = (a.hessian[(i, i)] * a.hessian[(j, j)]).abs().sqrt();
                        assert!(
                            (a.hessian[(i, j)] - b.hessian[(i, j)]).abs() <= 1e-11 * scale,
                            "{} {k2} {i}{j}",
                            breaks.len()
                        );
                    }
                }
                let (u, v) = (law.deflection(&strain).unwrap(), pieces.deflection(&strain).unwrap());
                let (p, q) = (law.in_plane(&strain, &u), pieces.in_plane(&strain, &v));
                for x in [-0.5, -0.31, 0.0, 0.123, 0.4, 0.5] {
                    for (a, b, scale) in [
                        (u.u1(x), v.u1(x), eta),
                        (u.slope(x), v.slope(x), eta * k2.abs().sqrt().max(1.0)),
                        (u.curvature(x), v.curvature(x), eta * k2.abs().max(1.0)),
                        (p.u2(x), q.u2(x), eta * eta * k2.abs().max(1.0)),
                        (p.u3(x), q.u3(x), eta * eta * k2.abs().sqrt().max(1.0)),
                    ] {
                        // At the last level the deflection has no finer modes than the energy, whose error is its square.
                        let tolerance = if k2 < 5e3 { 1e-11 } else { 1e-9 };
                        assert!((a - b).abs() <= tolerance * scale, "{} {k2} {x}: {a} {b}", breaks.len());
                    }
                }
            }
        }
    }
}

/// Every other of many profiles varies, with amplitudes that start from zero and have breaks of their own.
#[test]
fn sums_of_many_profiles_share_modes() {
    let stiffness = PlaneStress::incompressible();
    let profile = |i: u32| {
        let breaks = (0..=5)
            .map(|j| {
                if j % 5 == 0 {
                    f64::from(j) / 5.0 - 0.5
                } else {
                    f64::from(j) / 5.0 - 0.5 + 0.003 * f64::from(i)
                }
            })
            .collect();
        let steps = (0..5).map(|j| vec![0.01 * f64::from((i * 7 + j * 3) % 5)]).collect();
        Growth { gamma33: Piecewise::from_legendre(breaks, steps).unwrap().into(), ..Growth::default() }
    };
    let cubic = |i: u32| {
        let inner = 2.0 + 0.3 * f64::from(i);
        let pieces = vec![vec![0.5, 0.5], vec![1.0, 0.1 * f64::from(i % 4), 0.2, 0.1]];
        Amplitude::Along(Piecewise::from_legendre(vec![0.0, inner, 10.0], pieces).unwrap())
    };
    let growth: Vec<(Amplitude, Growth)> =
        (0..20).map(|i| (if i % 2 == 0 { cubic(i) } else { Amplitude::Constant(0.3) }, profile(i))).collect();
    let spec = RibbonSpec {
        eta: 0.1,
        stiffness,
        form: Form::Auto,
        growth: growth.clone(),
        width: Amplitude::Constant(1.0),
        thickness: Amplitude::Constant(1.0),
    };
    let law = RibbonLaw::new(spec).unwrap();
    for s in [0.0, 1.0, 7.3, 10.0] {
        let mut there = Growth::default();
        for (amplitude, profile) in &growth {
            there.add_scaled(amplitude.at(s), 1.0, profile);
        }
        let alone = Section::new(0.1, &there, &stiffness, Form::Auto).unwrap();
        let strain = Strain::new(0.01, 0.003, 0.4, 0.2);
        let (a, b) = (law.station(s).unwrap().section().energy(&strain), alone.energy(&strain));
        assert!((a - b).abs() <= 1e-14 * b, "{s}: {a} {b}");
    }
}
