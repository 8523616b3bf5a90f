//! One unit of work, so many times: what `benches/guard.py` counts the instructions of.
//!
//! `guard UNIT REPETITIONS`; without arguments, the units and how many units a repetition does.

use std::hint::black_box;
use std::sync::Arc;

use nalgebra::Vector3;
use ribbonrs::boundary::{End, Hold, Known, Law, Layout, LineLoad, Mesh, Path, Problem, System, Targets};
use ribbonrs::frame::{Pose, integrate_gauss, integrate_nodal, integrate_segments};
use ribbonrs::growth::Growth;
use ribbonrs::material::PlaneStress;
use ribbonrs::section::{Form, RibbonLaw, RibbonSpec, Section, Strain};

mod diagrams;

const ETA: f64 = 0.1;
const SEGMENTS: u32 = 100;
const ELEMENTS: usize = 100;

/// A unit is named by what it does and its size; a repetition does it `1`, `SEGMENTS` or `ELEMENTS` times.
const UNITS: [(&str, usize); 20] = [
    ("section closed 2.4", 1),
    ("section closed 40", 1),
    ("section general 2.4", 1),
    ("section general 40", 1),
    ("section general 400", 1),
    ("section second-order 2.4", 1),
    ("frame segments", SEGMENTS as usize),
    ("frame nodal", SEGMENTS as usize),
    ("frame gauss", SEGMENTS as usize),
    ("iteration 2 7", ELEMENTS),
    ("iteration 3 7", ELEMENTS),
    ("iteration 4 7", ELEMENTS),
    ("iteration 5 7", ELEMENTS),
    ("iteration 6 7", ELEMENTS),
    ("iteration 7 7", ELEMENTS),
    ("iteration 8 7", ELEMENTS),
    ("iteration 5 13", ELEMENTS),
    ("index", ELEMENTS),
    ("diagram 2", 1),
    ("diagram 3", 1),
];

/// Energy, gradient and Hessian at `|K2| = k2 eta`; 8, 16 or 32 modes of an even profile of degree 6.
fn section(form: &str, k2: f64, repetitions: usize) {
    let form = Form::NAMES.iter().find(|(name, _)| *name == form).expect("a form").1;
    let growth = match form {
        Form::General => {
            Growth { gamma33: vec![0.0, 0.0, 0.3, 0.0, -0.5, 0.0, 1.0].into(), ..Growth::default() }
        }
        _ => Growth::edge(0.06) + Growth::chiral(0.04),
    };
    let law = Section::new(ETA, &growth, &PlaneStress::incompressible(), form).expect("a law");
    let strain = Strain::new(0.01, 0.002, k2 * ETA, 0.8 * ETA);
    for _ in 0..repetitions {
        black_box(law.evaluate(black_box(&strain)));
    }
}

/// Poses along a ribbon of varying strain.
fn frame(method: &str, repetitions: usize) {
    let s: Vec<f64> = (0..=SEGMENTS).map(|i| 10.0 * f64::from(i) / f64::from(SEGMENTS)).collect();
    let strains: Vec<Strain> = s.iter().map(|s| Strain::new(0.0, 0.1, s.cos(), 0.3)).collect();
    let at_points: Vec<[Strain; 3]> = strains[1..].iter().map(|&strain| [strain; 3]).collect();
    let start = Pose::new([0.0; 3], [1.0, 0.0, 0.0, 0.0]);
    for _ in 0..repetitions {
        black_box(match method {
            "segments" => integrate_segments(black_box(&s), &strains[1..], &start),
            "nodal" => integrate_nodal(black_box(&s), &strains, &start),
            _ => integrate_gauss(black_box(&s), &at_points, &start),
        });
    }
}

/// Grown edges between clamps half a turn apart, shortened, and a state near it.
fn clamped(degree: usize, layout: Layout) -> (System, Path, Targets) {
    let law = RibbonLaw::new(RibbonSpec::uniform(ETA, Growth::edge(0.02))).expect("a law for this growth");
    let far = End { position: Vector3::new(0.0, 0.0, 9.0), turns: 0.5, ..End::new(Hold::Clamped) };
    let (ends, line) = ([End::new(Hold::Clamped), far], LineLoad::uniform([0.0; 3]));
    let problem = Arc::new(Problem::new(Law::Relaxed(law), 10.0, ends, vec![], line).expect("a problem"));
    let nodes = (0..=ELEMENTS).map(|i| 10.0 * i as f64 / ELEMENTS as f64).collect();
    let mesh = Mesh::new(&problem, nodes, degree).expect("a mesh");
    let path = Path::new(&mesh, &Known::Straight(1.0)).expect("a shape");
    let targets = path.targets(&problem, 0.5);
    (System::with_layout(mesh, layout).expect("a system"), path, targets)
}

/// Linearisation, factorisation and correction.
fn iteration(degree: usize, states: usize, repetitions: usize) {
    let (mut system, path, targets) =
        clamped(degree, if states == 7 { Layout::Constant } else { Layout::Full });
    for _ in 0..repetitions {
        system.linearise(&path.x, &targets).expect("a regular matrix");
        black_box(system.correction());
    }
}

/// The stability index of what is linearised.
fn index(repetitions: usize) {
    let (mut system, path, targets) = clamped(5, Layout::Constant);
    system.linearise(&path.x, &targets).expect("a regular matrix");
    for _ in 0..repetitions {
        black_box(system.index_without(&path.x, targets.load, &[]).expect("a potential"));
    }
}

/// A whole diagram.
fn diagram(number: usize, repetitions: usize) {
    let scene = &diagrams::SCENES[number - 1];
    let state = scene.state();
    for _ in 0..repetitions {
        scene.follow(&state);
    }
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [unit, repetitions] = arguments.as_slice() else {
        for (unit, size) in UNITS {
            println!("{unit},{size}");
        }
        return;
    };
    let repetitions = repetitions.parse().expect("a number of repetitions");
    let number = |text: &str| text.parse().expect("a whole number");
    match unit.split(' ').collect::<Vec<_>>().as_slice() {
        ["section", form, k2] => section(form, k2.parse().expect("a number"), repetitions),
        ["frame", method] => frame(method, repetitions),
        ["iteration", degree, states] => iteration(number(degree), number(states), repetitions),
        ["index"] => index(repetitions),
        ["diagram", scene] => diagram(number(scene), repetitions),
        _ => panic!("{unit} is not one of the units"),
    }
}
