//! The boundary-value solver against known answers.

use std::sync::Arc;

use nalgebra::{Quaternion, Vector3};
use ribbonrs::boundary::{End, Hold, Law, LineLoad, Problem, Rod, Settings, Solution, Status};
use ribbonrs::section::{Amplitude, Strain};

type Vector = Vector3<f64>;

fn end(hold: Hold) -> End {
    End {
        hold,
        position: Vector::zeros(),
        rotation: Quaternion::new(1.0, 0.0, 0.0, 0.0),
        turns: 0.0,
        force: Vector::zeros(),
        moment: Vector::zeros(),
    }
}

fn no_line() -> LineLoad {
    LineLoad { force: [0.0; 3].map(Amplitude::Constant), moment: [0.0; 3].map(Amplitude::Constant) }
}

/// Mattiasson (1981): tip angle, u/L, w/L of the elastica under a dead tip load.
#[test]
fn elastica() {
    for (load, angle, u, w) in [
        (1.0, 0.46135195, 0.056433236, 0.30172077),
        (5.0, 1.2153681, 0.38762836, 0.71379152),
        (10.0, 1.4302855, 0.55499560, 0.81060902),
    ] {
        let rod = Rod { compliance: Strain::new(0.0, 0.01, 1.0, 1.0), intrinsic: Strain::zeros() };
        let ends = [end(Hold::Clamped), End { force: Vector::new(load, 0.0, 0.0), ..end(Hold::Free) }];
        let problem = Problem::new(Law::Rod(rod), 1.0, ends, vec![], no_line()).unwrap();
        let solution = Solution::of(Arc::new(problem), &Settings::default(), None).unwrap();
        println!("{:#?} {}", solution.report, solution.nodes().len());
        assert_eq!(solution.report.status, Status::Converged);
        let tip = solution.at(1.0).unwrap().at;
        let tilt = 2.0 * tip.rotation.j.atan2(tip.rotation.w);
        println!("{} {} {}", tilt - angle, 1.0 - tip.position.z - u, tip.position.x - w);
        assert!((tilt - angle).abs() < 1e-7);
        assert!((1.0 - tip.position.z - u).abs() < 1e-8);
        assert!((tip.position.x - w).abs() < 1e-8);
    }
}
