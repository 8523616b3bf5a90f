//! Phase diagrams: known boundaries, whole maps the same on any number of cores.

use ribbonrs::equilibrium::Phase;
use ribbonrs::growth::Growth;
use ribbonrs::maps::{Class, PhaseMap, Plane, Polyline, Progress, phase_map};
use ribbonrs::section::{Amplitude, RibbonLaw, RibbonSpec};

const ETA: f64 = 0.1;
const TOLERANCE: f64 = 1e-10;

fn onset() -> f64 {
    (259f64.sqrt() - 7.0) / 2.0
}

/// A ribbon with edge growth `xi eta^2`, chirality `omega` and thickness gradient `d eta`.
fn spec(eta: f64, xi: f64, omega: f64, d: f64) -> RibbonSpec {
    let terms = [
        (xi * ETA * ETA, Growth::edge(1.0)),
        (2.0 * ETA * omega, Growth::chiral(1.0)),
        (d * ETA, Growth::thickness(1.0, 0.0)),
    ];
    let growth = terms.into_iter().map(|(amplitude, growth)| (Amplitude::Constant(amplitude), growth));
    RibbonSpec { growth: growth.collect(), ..RibbonSpec::uniform(eta, Growth::default()) }
}

fn grid(n: usize) -> Vec<f64> {
    (0..n).map(|i| i as f64 / (n - 1) as f64).collect()
}

fn map(corner: impl Fn(f64, f64) -> RibbonSpec, n: usize) -> PhaseMap {
    let plane =
        Plane::new([(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)].map(|(x, y)| corner(x, y))).unwrap();
    phase_map(&plane, &grid(n), &grid(n), TOLERANCE, &Progress::default()).unwrap()
}

/// Lines between two phases.
fn between(map: &PhaseMap, phases: [Phase; 2]) -> Vec<&Polyline<Class>> {
    let sides = |line: &&Polyline<Class>| {
        let of = |side: Option<Class>| side.and_then(|class| class.lowest);
        let [a, b] = [of(line.left), of(line.right)];
        (a, b) == (Some(phases[0]), Some(phases[1])) || (b, a) == (Some(phases[0]), Some(phases[1]))
    };
    map.outline.iter().filter(sides).collect()
}

#[test]
fn flat_and_bent_meet_on_a_parabola() {
    // eta from 0.02 to 0.14, xi up to 0.08.
    let map = map(|x, y| spec(0.02 + 0.12 * x, 8.0 * y, 0.0, 0.0), 24);
    let lines = between(&map, [Phase::Flat, Phase::Bent]);
    assert_eq!(lines.len(), 1);
    for at in &lines[0].points {
        let (eta, xi) = (0.02 + 0.12 * at[0], 0.08 * at[1]);
        assert!((xi / (eta * eta) / onset() - 1.0).abs() < 1e-9, "{at:?}");
    }
    assert!(lines[0].points.len() > 24);
    assert!(lines[0].jumps.iter().all(|jump| *jump < 0.01));
}

#[test]
fn twisted_and_helical_meet_where_the_energy_says() {
    let map = map(|x, y| spec(ETA, 10.0 * y, 0.5 * x, 0.0), 31);
    let lines = between(&map, [Phase::Twisted, Phase::Helical]);
    assert_eq!(lines.len(), 1);
    let c = 14.0 - 1036f64.sqrt();
    let mut checked = 0;
    for at in lines[0].points.iter().filter(|at| at[0] > 1e-3) {
        let (omega, xi) = (0.5 * at[0], 10.0 * at[1]);
        let k3 = omega / (1.0 + c / 20.0);
        let exact = onset() + k3 * k3 / 8.0;
        // Along x the tolerance is multiplied by the slope of the line.
        assert!((xi - exact).abs() < 1e-8, "{omega} {xi} {exact}");
        checked += 1;
    }
    assert!(checked > 31);
    // The line begins where flat, bent, twisted and helical meet.
    let ends = [lines[0].points[0], *lines[0].points.last().unwrap()];
    let start = ends.iter().find(|at| at[0] < 1e-3).unwrap();
    assert!((10.0 * start[1] - onset()).abs() < 1e-2, "{start:?}");
}

#[test]
fn chirality_alone_coils_a_ribbon() {
    let map = map(|x, y| spec(ETA, -y, 40.0 * x, 0.0), 9);
    let lines = between(&map, [Phase::Twisted, Phase::Helical]);
    let c = 14.0 + 1036f64.sqrt();
    let at = lines.iter().flat_map(|line| &line.points).find(|at| at[1] == 0.0).unwrap();
    let k3 = 40.0 * at[0] / (1.0 + c / 20.0);
    // C = k3^2/2 without edge growth.
    assert!((k3 * k3 / 2.0 - c).abs() < 1e-7, "{k3}");
    assert!((40.0 * at[0] - 31.8066).abs() < 1e-4);
}

#[test]
fn growth_through_the_thickness_bends_everywhere_and_ends_the_second_state() {
    let map = map(|x, y| spec(ETA, 12.0 * y, 0.0, 0.5 + 2.0 * x), 21);
    let phases = map.samples.iter().map(|one| one.unwrap().class.lowest);
    assert!(phases.into_iter().all(|phase| phase == Some(Phase::Bent)));
    // The state bent the other way ends at a fold: lines between two stable bent states and one.
    let lines = between(&map, [Phase::Bent, Phase::Bent]);
    assert_eq!(lines.len(), 1);
    assert!(lines[0].points.len() > 10);
    assert!(lines[0].jumps.iter().all(|jump| *jump < 1e-6));
    for at in &lines[0].points {
        // At a fold two states meet: one more just above than just below.
        let shapes = |y: f64| {
            let law = RibbonLaw::new(spec(ETA, 12.0 * y, 0.0, 0.5 + 2.0 * at[0])).unwrap();
            law.station(0.0).unwrap().natural_shapes().len()
        };
        assert!(at[1] == 1.0 || shapes(at[1] + 1e-8) == shapes(at[1] - 1e-8) + 2, "{at:?}");
    }
}

#[test]
fn tips_between_the_nodes_are_found() {
    // The helical region ends in a tip on the axis of symmetry, where an even number of nodes has none.
    let tip = |n: usize| {
        let map = map(|x, y| spec(ETA, 10.0 * x, 2.0 * (y - 0.5), 0.0), n);
        let lines = between(&map, [Phase::Twisted, Phase::Helical]);
        lines.iter().flat_map(|line| &line.points).map(|at| 10.0 * at[0]).fold(f64::INFINITY, f64::min)
    };
    for n in [8, 20, 38] {
        assert!((tip(n) - onset()).abs() < 0.1 / n as f64, "{n} {}", tip(n));
    }
}

#[test]
fn a_stopped_map_is_empty_and_a_whole_one_has_a_border() {
    let corner = |x: f64, y: f64| spec(ETA, 10.0 * y, 0.5 * x, 0.0);
    let plane = Plane::new([corner(0.0, 0.0), corner(1.0, 0.0), corner(0.0, 1.0), corner(1.0, 1.0)]).unwrap();
    let progress = Progress::default();
    progress.stop();
    let stopped = phase_map(&plane, &grid(5), &grid(5), TOLERANCE, &progress).unwrap();
    assert!(stopped.samples.iter().all(Option::is_none) && stopped.outline.is_empty());
    let whole = map(corner, 5);
    // Shoelace over the border: the whole square, counterclockwise.
    let area: f64 = whole
        .outline
        .iter()
        .filter(|line| line.left.is_none() || line.right.is_none())
        .map(|line| {
            let turn = if line.right.is_none() { 0.5 } else { -0.5 };
            let cross = |w: &[[f64; 2]]| w[0][0] * w[1][1] - w[0][1] * w[1][0];
            turn * line.points.windows(2).map(cross).sum::<f64>()
        })
        .sum();
    assert!((area - 1.0).abs() < 1e-12, "{area}");
}

#[test]
fn corners_of_different_kinds_are_refused() {
    let other = RibbonSpec::uniform(ETA, Growth::edge(0.1));
    let one = spec(ETA, 1.0, 0.0, 0.0);
    assert!(Plane::new([one.clone(), one.clone(), one, other]).is_err());
}
