//! Orders of convergence of the boundary-value solver: states found on uniform meshes, as comma-separated values.
//!
//! `cargo bench --bench orders`. A row is a scene, the degree, the number of elements, the solver's estimate of its
//! error, then position over the length, unit quaternion, and `eps` and `K L` at `S = 0.37 L`, inside an element. A row
//! of 0 elements is the reference of its scene, of degree 8 to 1e-13. Drawn by docs/figures/orders.py.

use std::sync::Arc;

use nalgebra::Vector3;
use ribbonrs::boundary::{
    End, Guess, Hold, Law, LineLoad, PointLoad, Problem, Rod, Settings, Solution, Status,
};
use ribbonrs::growth::Growth;
use ribbonrs::section::{RibbonLaw, RibbonSpec, Strain};

type Vector = Vector3<f64>;

const PLACE: f64 = 0.37;

/// An inextensible cantilever under a dead load at its tip, `P L^2/EI = 3`.
fn elastica() -> Problem {
    let rod = Rod { compliance: Strain::new(0.0, 0.01, 1.0, 1.0), intrinsic: Strain::zeros() };
    let tip = End { force: Vector::new(3.0, 0.0, 0.0), ..End::new(Hold::Free) };
    Problem::new(Law::Rod(rod), 1.0, [End::new(Hold::Clamped), tip], vec![], LineLoad::uniform([0.0; 3]))
        .expect("a problem")
}

/// Grown edges, clamped a quarter of a turn apart and shortened, with weight and a load at `S = 4`.
fn ribbon() -> Problem {
    let far = End { position: Vector::new(0.0, 0.0, 9.5), turns: 0.25, ..End::new(Hold::Clamped) };
    let point =
        PointLoad { s: 4.0, force: Vector::new(2e-5, 1e-5, 0.0), moment: Vector::new(0.0, 1e-5, 1e-5) };
    let law = Law::Relaxed(
        RibbonLaw::new(RibbonSpec::uniform(0.1, Growth::edge(0.02))).expect("a law for this growth"),
    );
    let ends = [End::new(Hold::Clamped), far];
    Problem::new(law, 10.0, ends, vec![point], LineLoad::uniform([1e-6, -2e-6, 1e-6])).expect("a problem")
}

fn row(scene: &str, degree: usize, elements: usize, solution: &Solution) -> String {
    let length = solution.problem().length;
    let here = solution.at(PLACE * length).expect("a state");
    let (r, q, e) = (here.at.position / length, here.at.rotation, here.strain);
    let values = [r.x, r.y, r.z, q.w, q.i, q.j, q.k, e[0], e[1] * length, e[2] * length, e[3] * length];
    let values: Vec<String> = values.iter().map(|x| format!("{x:.16e}")).collect();
    format!("{scene},{degree},{elements},{:.2e},{}", solution.report.error, values.join(","))
}

/// A guess that holds the solution, so that every mesh finds the same state.
fn guess(solution: &Solution) -> Guess {
    let length = solution.problem().length;
    let s: Vec<f64> = (0..=400).map(|i| length * f64::from(i) / 400.0).collect();
    let (strains, states) =
        solution.many(&s).expect("states").iter().map(|here| (here.strain, here.at)).unzip();
    Guess { s, strains, states, has_wrench: true }
}

fn main() {
    println!("scene,degree,elements,estimate,x,y,z,q0,q1,q2,q3,eps,K1,K2,K3");
    let meshes: [(&str, Problem, Vec<usize>); 2] = [
        ("elastica", elastica(), (1..=8).map(|k| 1 << k).collect()),
        ("ribbon", ribbon(), vec![5, 10, 15, 20, 30, 40, 60, 80, 120, 160, 240, 320]),
    ];
    for (name, problem, counts) in meshes {
        let problem = Arc::new(problem);
        let settings = Settings { degree: 8, tolerance: 1e-13, ..Settings::default() };
        let reference = Solution::of(Arc::clone(&problem), &settings, None).expect("a state");
        assert!(reference.report.status.is_solved(), "{}", reference.report.reason);
        println!("{}", row(name, 8, 0, &reference));
        let guess = guess(&reference);
        for degree in 1..=8 {
            for &elements in &counts {
                let settings = Settings { degree, first_elements: elements, adaptive: false, ..settings };
                let solution = Solution::of(Arc::clone(&problem), &settings, Some(&guess)).expect("a state");
                if !matches!(solution.report.status, Status::Singular | Status::Diverged) {
                    println!("{}", row(name, degree, solution.nodes().len() - 1, &solution));
                }
            }
        }
    }
}
