//! A scene pays only for what it uses: the short way and the long way round give the same.
//!
//! Each pair here is a row of the table in docs/performance.md, timed by benches/pays.rs.

use std::sync::Arc;

use nalgebra::Vector3;
use ribbonrs::boundary::{
    End, Hold, Known, Law, Layout, LineLoad, Mesh, Path, Problem, Settings, Solution, System,
};
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
    let spec = RibbonSpec { growth, ..RibbonSpec::uniform(ETA, Growth::default()) };
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

/// A ribbon without loads, clamped at its start, and free or clamped after some turns at its end.
fn problem(law: RibbonLaw, hold: Hold, z: f64, turns: f64) -> Arc<Problem> {
    let end = End { position: Vector3::new(0.0, 0.0, z), turns, ..End::new(hold) };
    let (ends, line) = ([End::new(Hold::Clamped), end], LineLoad::uniform([0.0; 3]));
    Arc::new(Problem::new(Law::Relaxed(law), LENGTH, ends, vec![], line).unwrap())
}

/// Without loads and with a free end the boundary-value problem has the natural shape for its solution.
#[test]
fn natural_shape_and_boundary_value_problem() {
    let s: Vec<f64> = (0..=100).map(|i| LENGTH * f64::from(i) / 100.0).collect();
    let start = Pose::new([0.0; 3], [1.0, 0.0, 0.0, 0.0]);
    let growth = || Growth::edge(0.06) + Growth::chiral(0.04);
    let settings = Settings { tolerance: 1e-12, ..Settings::default() };
    let solved = |law| {
        let solution = Solution::of(problem(law, Hold::Free, 0.0, 0.0), &settings, None).unwrap();
        assert!(solution.report.status.is_solved(), "{:?}", solution.report);
        solution.many(&s).unwrap()
    };
    let compare = |law: RibbonLaw, strains: &dyn Fn(f64) -> Strain, poses: Vec<Pose>| {
        for ((&s, pose), found) in s.iter().zip(poses).zip(solved(law)) {
            let turn = (pose.rotation - found.at.rotation).norm();
            assert!((pose.position - found.at.position).norm() < 1e-11 * LENGTH && turn < 1e-11, "{s}");
            assert!((strains(s) - found.strain).norm() < 1e-11, "{s}");
        }
    };
    let strain = natural_shapes(&section(&growth(), Form::Auto))[0].strain;
    compare(ribbon(vec![(Amplitude::Constant(1.0), growth())]), &|_| strain, helix(&s, &strain, &start));
    let rising = Piecewise::from_legendre(vec![0.0, LENGTH], vec![vec![1.0, 0.1]]).unwrap();
    let varies = || ribbon(vec![(Amplitude::Along(rising.clone()), growth())]);
    let branch = &natural_branches(&varies(), LENGTH).unwrap()[0];
    compare(varies(), &|s| branch.strain(s), branch.poses(&s, &start));
}

#[test]
fn seven_states_and_thirteen() {
    let s: Vec<f64> = (0..=20).map(|i| LENGTH * f64::from(i) / 20.0).collect();
    let growth = || ribbon(vec![(Amplitude::Constant(1.0), Growth::edge(0.02))]);
    let [few, many] = [Layout::Constant, Layout::Full].map(|layout| {
        let settings = Settings { tolerance: 1e-12, layout: Some(layout), ..Settings::default() };
        let problem = problem(growth(), Hold::Clamped, 9.0, 0.5);
        let solution = Solution::of(problem, &settings, None).unwrap();
        assert!(solution.report.status.is_solved(), "{:?}", solution.report);
        solution.many(&s).unwrap()
    });
    for (a, b) in few.iter().zip(&many) {
        assert!((a.at.position - b.at.position).norm() < 1e-11 * LENGTH);
        assert!((a.at.rotation - b.at.rotation).norm() < 1e-11 && (a.strain - b.strain).norm() < 1e-11);
    }
}

/// Elements and nodes eliminated in turn, and everything as one sparse matrix.
#[test]
fn chain_and_sparse_matrix() {
    let law = ribbon(vec![(Amplitude::Constant(1.0), Growth::edge(0.02))]);
    let problem = problem(law, Hold::Clamped, 9.0, 0.5);
    let nodes = (0..=100).map(|i| LENGTH * f64::from(i) / 100.0).collect();
    let mesh = Mesh::new(&problem, nodes, Settings::default().degree).unwrap();
    let path = Path::new(&mesh, &Known::Straight(1.0)).unwrap();
    let targets = path.targets(&problem, 0.5);
    let mut system = System::new(mesh.clone()).unwrap();
    system.linearise(&path.x, &targets).unwrap();
    let chain = system.correction();
    system.linearise_sparsely(&path.x, &targets).unwrap();
    let sparse = system.correction();
    let size = chain.norm(&mesh);
    for (a, b) in chain.strains.iter().zip(&sparse.strains) {
        assert!((a - b).norm() < 1e-11 * size);
    }
    for (a, b) in chain.nodes.iter().flatten().zip(sparse.nodes.iter().flatten()) {
        assert!((a - b).abs() < 1e-11 * size);
    }
}
