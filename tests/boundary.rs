//! The boundary-value solver against known answers, and its orders, works and failures.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use nalgebra::{Quaternion, Vector3};
use ribbonrs::boundary::{
    At, End, Extremes, Hold, Iterate, Known, Law, Layout, LineLoad, Mesh, Path, PointLoad, Problem, Rod,
    Settings, Solution, Status, System, Targets,
};
use ribbonrs::growth::Growth;
use ribbonrs::piecewise::Piecewise;
use ribbonrs::section::{Amplitude, RibbonLaw, RibbonSpec, Strain};

type Vector = Vector3<f64>;

fn rod() -> Law {
    Law::Rod(Rod { compliance: Strain::new(0.0, 0.01, 1.0, 1.0), intrinsic: Strain::zeros() })
}

fn relaxed(growth: Growth) -> Law {
    Law::Relaxed(RibbonLaw::new(RibbonSpec::uniform(0.1, growth)).unwrap())
}

fn cantilever(load: f64) -> Arc<Problem> {
    let ends = [End::new(Hold::Clamped), End { force: Vector::new(load, 0.0, 0.0), ..End::new(Hold::Free) }];
    Arc::new(Problem::new(rod(), 1.0, ends, vec![], LineLoad::uniform([0.0; 3])).unwrap())
}

/// Grown edges, clamped a quarter of a turn apart and shortened, with weight and a load in the middle.
fn held(force: [f64; 3]) -> Arc<Problem> {
    let far = End { position: Vector::new(0.0, 0.0, 9.5), turns: 0.25, ..End::new(Hold::Clamped) };
    let point =
        PointLoad { s: 4.0, force: Vector::new(2e-5, 1e-5, 0.0), moment: Vector::new(0.0, 1e-5, 1e-5) };
    let law = relaxed(Growth::edge(0.02));
    Arc::new(
        Problem::new(law, 10.0, [End::new(Hold::Clamped), far], vec![point], LineLoad::uniform(force))
            .unwrap(),
    )
}

fn solve(problem: &Arc<Problem>, settings: &Settings) -> Solution {
    Solution::of(Arc::clone(problem), settings, None).unwrap()
}

/// Where many states are asked for they are as good as those that are asked for one by one, before and behind a point load.
#[test]
fn many_states_are_as_good_as_one() {
    for degree in 2..=8 {
        let problem = held([0.0, 3e-6, -2e-6]);
        let solution = solve(&problem, &Settings { degree, tolerance: 1e-9, ..Settings::default() });
        let error = solution.report.error;
        assert!(solution.report.status == Status::Converged && error < 1e-9);
        // Twenty in each element.
        let places: Vec<f64> = solution
            .nodes()
            .windows(2)
            .flat_map(|ends| (0..20).map(move |i| ends[0] + (ends[1] - ends[0]) * f64::from(i) / 20.0))
            .collect();
        let many = solution.many(&places).unwrap();
        let mut made = 0;
        for (there, &s) in many.iter().zip(&places) {
            let one = solution.at(s).unwrap();
            let missed = (there.at.position - one.at.position).norm() / 10.0;
            let turned = 2.0 * (there.at.rotation - one.at.rotation).norm();
            let strained = (there.strain - one.strain).amax();
            let largest = one.at.force.norm();
            let forced = (there.at.force - one.at.force).norm() / largest;
            // One place of each element was looked at, where that is largest; strains add the sensitivity of the section.
            assert!(
                missed.max(turned).max(forced) < 0.2 * error + 4e-15,
                "{degree} {s} {missed} {turned} {forced} {error}"
            );
            assert!(strained < 10.0 * error, "{strained}");
            made += usize::from(turned > 0.0);
        }
        // Most were made from others.
        assert!(made > places.len() / 2, "{degree} {made} of {}", places.len());
    }
}

/// Mattiasson (1981): tip angle, u/L, w/L of the elastica under a dead tip load.
#[test]
fn elastica() {
    for (load, angle, u, w) in [
        (1.0, 0.461_351_95, 0.056_433_236, 0.301_720_77),
        (5.0, 1.215_368_1, 0.387_628_36, 0.713_791_52),
        (10.0, 1.430_285_5, 0.554_995_60, 0.810_609_02),
    ] {
        let solution = solve(&cantilever(load), &Settings { tolerance: 1e-12, ..Settings::default() });
        assert_eq!(solution.report.status, Status::Converged);
        let tip = solution.at(1.0).unwrap().at;
        let tilt = 2.0 * tip.rotation.j.atan2(tip.rotation.w);
        // The digits that are printed.
        assert!((tilt - angle).abs() < 5e-8);
        assert!((1.0 - tip.position.z - u).abs() < 5e-9 && (tip.position.x - w).abs() < 5e-9);
    }
}

/// Largest difference of positions/L, rotations, and curvatures times L at these places.
fn difference(a: &Solution, b: &Solution, places: &[f64], length: f64) -> f64 {
    let (a, b) = (a.many(places).unwrap(), b.many(places).unwrap());
    let pairs = a.iter().zip(&b).map(|(a, b)| {
        let turn = (a.at.rotation - b.at.rotation).norm().min((a.at.rotation + b.at.rotation).norm());
        let strain = (a.strain - b.strain).component_mul(&Strain::new(1.0, length, length, length)).norm();
        ((a.at.position - b.at.position).norm() / length).max(2.0 * turn).max(strain)
    });
    pairs.fold(0.0, f64::max)
}

fn uniform(degree: usize, elements: usize) -> Settings {
    Settings { degree, first_elements: elements, adaptive: false, tolerance: 1e-13, ..Settings::default() }
}

/// Gauss collocation of degree s is of order 2 s at the nodes, and by steps from them anywhere.
#[test]
fn superconvergence() {
    for (problem, length, first) in [(cantilever(3.0), 1.0, 4), (held([1e-6, -2e-6, 1e-6]), 10.0, 20)] {
        let exact = solve(&problem, &Settings { degree: 8, tolerance: 1e-13, ..Settings::default() });
        let places: Vec<f64> = (0..=7).map(|i| length * f64::from(i) / 7.0).collect();
        for degree in 1..=5 {
            let first = if degree == 1 { 8 * first } else { first };
            let errors = [first, 2 * first].map(|elements| {
                difference(&solve(&problem, &uniform(degree, elements)), &exact, &places, length)
            });
            let order = (errors[0] / errors[1]).log2();
            assert!(errors[0] > 1e-11, "rounding tells no order: {degree} {errors:?}");
            // Before the limit is reached the order is a little more or less.
            assert!(order > 2.0 * degree as f64 - 0.9, "{degree}: {order} {errors:?}");
        }
    }
}

/// What the estimate says of the error at the nodes is right within a factor of three.
#[test]
fn estimated_errors_are_true() {
    for (problem, length) in [(cantilever(3.0), 1.0), (held([1e-6, -2e-6, 1e-6]), 10.0)] {
        let exact = solve(&problem, &Settings { degree: 8, tolerance: 1e-13, ..Settings::default() });
        for degree in 2..=5 {
            for elements in [8, 16, 32] {
                let solution = solve(&problem, &uniform(degree, elements));
                let error = difference(&solution, &exact, solution.nodes(), length);
                let told = solution.report.error;
                let fair = error < 3.0 * told && told < 3.0 * error;
                // Close to rounding, and where the mesh is too coarse for orders to show, there is no telling.
                assert!(fair || !(1e-12..=1e-2).contains(&error), "{degree} {elements}: {told} {error}");
            }
        }
    }
}

/// More states than the loads need change nothing.
#[test]
fn layouts_agree() {
    for force in [[0.0; 3], [1e-6, -2e-6, 1e-6]] {
        let problem = held(force);
        let few = solve(&problem, &Settings { tolerance: 1e-11, ..Settings::default() });
        let places: Vec<f64> = (0..=10).map(f64::from).collect();
        for layout in [Layout::Moment, Layout::Full] {
            let settings = Settings { tolerance: 1e-11, layout: Some(layout), ..Settings::default() };
            let more = solve(&problem, &settings);
            assert_eq!(more.report.status, Status::Converged, "{layout:?} {force:?}");
            assert!(difference(&few, &more, &places, 10.0) < 2e-11, "{layout:?} {force:?}");
        }
    }
}

/// How many factorisations and elements known scenes take: a change tells of a change of the method.
#[test]
fn work() {
    let counts = |problem: &Arc<Problem>, tolerance| {
        let solution = solve(problem, &Settings { tolerance, ..Settings::default() });
        assert_eq!(solution.report.status, Status::Converged);
        (solution.report.factorisations, solution.nodes().len() - 1)
    };
    let (factorisations, elements) = counts(&cantilever(10.0), 1e-11);
    assert!(factorisations <= 12 && elements <= 12, "{factorisations} {elements}");
    let (factorisations, elements) = counts(&held([0.0; 3]), 1e-10);
    assert!(factorisations <= 110 && elements <= 40, "{factorisations} {elements}");
}

/// The section that is just at its bifurcation has no twisting stiffness: the stages of an element alone are singular,
/// but not the whole, where a clamp at each end tells the twist.
#[test]
fn a_stage_without_stiffness_is_solved_for() {
    let eta2 = 0.1 * 0.1;
    let steps =
        Piecewise::from_legendre(vec![0.0, 1.0, 2.0], vec![vec![5.0 * eta2], vec![4.0 * eta2]]).unwrap();
    let growth = vec![(Amplitude::Along(steps), Growth::edge(1.0))];
    let law = Law::Relaxed(
        RibbonLaw::new(RibbonSpec { growth, ..RibbonSpec::uniform(0.1, Growth::default()) }).unwrap(),
    );
    let position = Vector::new(0.0, 0.0, 2.0 + 9.0 * eta2 / 3.0);
    let ends = [End::new(Hold::Clamped), End { position, ..End::new(Hold::Clamped) }];
    let problem = Arc::new(Problem::new(law, 2.0, ends, vec![], LineLoad::uniform([0.0; 3])).unwrap());
    let mesh = Mesh::new(&problem, vec![0.0, 1.0, 2.0], 1).unwrap();
    let mut system = System::new(mesh.clone()).unwrap();
    let targets = Targets { ends, load: 1.0, offset: Vec::new(), drag: 0.0 };
    let x = Path::new(&mesh, &Known::Straight(0.0)).unwrap().x;
    // The straight ribbon is the solution.
    system.linearise(&x, &targets).unwrap();
    assert!(system.correction().norm(&mesh) < 1e-12);
    // A clamp that is turned twists the element without stiffness, at no moment, and not the other.
    let half = 0.05_f64;
    let rotation = Quaternion::new(half.cos(), 0.0, 0.0, half.sin());
    let turned = Targets { ends: [ends[0], End { rotation, ..ends[1] }], ..targets };
    system.linearise(&x, &turned).unwrap();
    let strains = system.correction().strains;
    assert!((strains[0][3] - 2.0 * half.tan()).abs() < 1e-10 && strains[1][3].abs() < 1e-10, "{strains:?}");
}

/// A rod that may spin about its pins is found but for that, which changes nothing and does not count.
#[test]
fn what_changes_nothing_is_left_open() {
    let far = End { position: Vector::new(0.0, 0.0, 0.9), ..End::new(Hold::Pinned) };
    let problem =
        Problem::new(rod(), 1.0, [End::new(Hold::Pinned), far], vec![], LineLoad::uniform([0.0; 3])).unwrap();
    let problem = Arc::new(problem);
    let settings = Settings::default();
    let solution = solve(&problem, &settings);
    assert!(solution.report.status.is_solved(), "{:?}", solution.report);
    let mut system =
        System::new(Mesh::new(&problem, solution.nodes().to_vec(), settings.degree).unwrap()).unwrap();
    let ends = [0, 1].map(|i| problem.goal(&problem.ends[i]));
    let targets = Targets { ends, load: 1.0, offset: Vec::new(), drag: 0.0 };
    assert_eq!(system.index(solution.iterate(), &targets), Some(0));
    let motions = system.motions();
    assert_eq!(motions.len(), 1);
    // A rotation about the axis, the same everywhere.
    let turn = motions[0].nodes[0][5];
    for (node, at) in motions[0].nodes.iter().zip(&solution.iterate().nodes) {
        let moved = Vector::z().cross(&at.position) * turn;
        let rigid = [moved.x, moved.y, moved.z, 0.0, 0.0, turn];
        assert!(node.iter().zip(rigid).all(|(x, exact)| (x - exact).abs() < 1e-9 * turn.abs()), "{node:?}");
    }
}

/// A mesh that may not have the elements it needs says so, and leaves its state.
#[test]
fn too_few_elements_are_told() {
    let settings = Settings { tolerance: 1e-12, degree: 2, most_elements: 20, ..Settings::default() };
    let solution = solve(&cantilever(10.0), &settings);
    assert_eq!(solution.report.status, Status::Unresolved);
    assert!(solution.report.reason.contains("elements") && solution.report.error > 1e-12);
}

/// Quaternions keep their norm along ten thousand elements and a hundred turns.
#[test]
fn quaternions_do_not_drift() {
    let turns = 100.0;
    let rod = Rod {
        compliance: Strain::new(0.1, 1.0, 1.0, 1.0),
        intrinsic: Strain::new(0.0, 0.0, 2.0 * std::f64::consts::PI * turns, 0.0),
    };
    let ends = [End::new(Hold::Clamped), End::new(Hold::Free)];
    let problem = Problem::new(Law::Rod(rod), 1.0, ends, vec![], LineLoad::uniform([0.0; 3])).unwrap();
    let settings = Settings {
        first_elements: 10_000,
        adaptive: false,
        degree: 4,
        tolerance: 1e-9,
        ..Settings::default()
    };
    let solution = solve(&Arc::new(problem), &settings);
    let Iterate { nodes, .. } = solution.iterate();
    assert!(nodes.iter().all(|at: &At| (at.rotation.norm() - 1.0).abs() < 4e-16));
    // Elements of 0.06 radians: their error is below the rounding of ten thousand.
    let tip = solution.at(1.0).unwrap().at;
    assert!(tip.position.norm() < 1e-12, "{}", tip.position);
}

/// Who asks to stop asks once, and whatever the solver is at then, it stops: on the way, between meshes, and where it
/// disturbs what it found unstable.
#[test]
fn an_interrupt_is_not_lost() {
    static ASKED: AtomicUsize = AtomicUsize::new(0);
    static AT: AtomicUsize = AtomicUsize::new(0);
    fn interrupted() -> bool {
        ASKED.fetch_add(1, Ordering::Relaxed) == AT.load(Ordering::Relaxed)
    }
    let far = End { position: Vector::new(0.0, 0.0, 9.0), turns: 0.5, ..End::new(Hold::Clamped) };
    let ends = [End::new(Hold::Clamped), far];
    let law = relaxed(Growth::edge(0.02));
    let problem = Arc::new(Problem::new(law, 10.0, ends, vec![], LineLoad::uniform([0.0; 3])).unwrap());
    let settings = Settings { interrupted: Some(interrupted), ..Settings::default() };
    let status = |at| {
        ASKED.store(0, Ordering::Relaxed);
        AT.store(at, Ordering::Relaxed);
        solve(&problem, &settings).report.status
    };
    assert_eq!(status(usize::MAX), Status::Converged);
    let questions = ASKED.load(Ordering::Relaxed);
    // The way, the meshes of the unstable state, a disturbance and its meshes.
    assert!(questions > 8, "{questions}");
    for at in 0..questions {
        assert_eq!(status(at), Status::Interrupted, "{at} of {questions}");
    }
}

/// Strains that are the same all along but for the error of a polynomial, and strains that are so at the nodes alone.
#[test]
fn uniform_states_are_told() {
    let law = || Law::Rod(Rod { compliance: Strain::new(0.01, 0.01, 1.0, 1.0), intrinsic: Strain::zeros() });
    let most = Strain::repeat(1e-9);
    let clamped = |turns: f64, load: f64| {
        let far = End { position: Vector::new(0.0, 0.0, 1.0), turns, ..End::new(Hold::Clamped) };
        let ends = [End::new(Hold::Clamped), far];
        Arc::new(Problem::new(law(), 1.0, ends, vec![], LineLoad::uniform([load, 0.0, 0.0])).unwrap())
    };
    // Straight and twisted by a turn.
    let twisted = solve(&clamped(1.0, 0.0), &Settings::default());
    let twist = 2.0 * std::f64::consts::PI;
    assert!(!twisted.extremes().alike(&most));
    assert!(twisted.is_uniform(&most).unwrap());
    assert!((twisted.at(0.3).unwrap().strain[3] - twist).abs() < 1e-10);
    assert!((twisted.extremes().least[3] - twist).abs() < 1e-6);
    // The ends of a beam that sags between clamps are bent by p L^2/12, its middle by half of that the other way.
    let sagging = solve(&clamped(0.0, 1e-3), &uniform(5, 1));
    let [start, middle, end] = [0.0, 0.5, 1.0].map(|s| sagging.at(s).unwrap().strain[2]);
    assert!((start - end).abs() < 1e-12 && (middle + 0.5 * start).abs() < 1e-9);
    assert!((start.abs() - 1e-3 / 12.0).abs() < 1e-9);
    assert!(!sagging.is_uniform(&most).unwrap());
    assert!(sagging.is_uniform(&Strain::repeat(1e-3)).unwrap());
    let Extremes { least, greatest } = sagging.extremes();
    assert!((least[2].abs().max(greatest[2].abs()) - 1e-3 / 12.0).abs() < 1e-9);
}
