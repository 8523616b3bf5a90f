//! Meshes until the error is small enough.

#![expect(clippy::neg_cmp_op_on_partial_ord, reason = "what is not a number fails every test")]

use std::sync::Arc;

use super::adapt::{estimate, refined, transferred};
use super::check;
use super::iterate::Iterate;
use super::mesh::Mesh;
use super::newton::{Control, Failed, newton};
use super::path::{LARGEST_STEP_TURN, largest_turn};
use super::report::Status;
use super::solve::{Settings, Solved, goal, new_system};
use super::spent::Spent;
use super::stress::SelfStress;
use super::waves::{divided, parts_for_waves};
use crate::InvalidInput;

/// Errors above this are not those of rounding.
const LARGEST_ROUNDING: f64 = 1e-7;
/// Meshes that are too many.
const MOST_MESHES: usize = 25;
/// Factorisations that a finer mesh takes at least.
const FEWEST: usize = 4;
/// Correction at most, of Newton's method, of a ribbon that may be turned freely.
const EXACTLY: f64 = 1e-12;

/// Meshes until the estimated error is below the tolerance.
pub fn adapted(
    settings: &Settings,
    mut mesh: Mesh,
    mut x: Iterate,
    spent: &mut Spent,
) -> Result<Solved, InvalidInput> {
    let problem = Arc::clone(&mesh.problem);
    let meshes = spent.meshes;
    let (mut before, mut stalls): (Option<f64>, usize) = (None, 0);
    // A motion that changes nothing does so at an equilibrium alone: the index asks for more than the state.
    let least = if problem.law.isotropic() { EXACTLY } else { f64::INFINITY };
    let tolerance = (1e-2 * settings.tolerance).clamp(1e-15, least);
    let control = Control { tolerance, iterations: 25, least_step: 1e-2 };
    let goal = goal(&problem);
    loop {
        if settings.interrupted.is_some_and(|asks| asks()) {
            let report = spent.report(Status::Interrupted, "interrupted".to_owned(), 1.0, Vec::new());
            return Ok(Solved { nodes: mesh.nodes, x, report, index: None });
        }
        let mut system = new_system(mesh, settings)?;
        let ended = newton(&mut system, x.clone(), &goal, &control);
        spent.iterations += ended.norms.len();
        spent.factorised(&system);
        if let Some(failure) = ended.failure {
            let mesh = system.mesh;
            let reason = format!("on a mesh of {} elements {failure}", mesh.elements());
            let report = spent.report(Status::Diverged, reason, 1.0, ended.norms);
            return Ok(Solved { nodes: mesh.nodes, x, report, index: None });
        }
        if largest_turn(&x, &ended.x) > LARGEST_STEP_TURN {
            let mesh = system.mesh;
            let reason = format!("on a mesh of {} elements {}", mesh.elements(), Failed::Jumped);
            let report = spent.report(Status::Diverged, reason, 1.0, ended.norms);
            return Ok(Solved { nodes: mesh.nodes, x, report, index: None });
        }
        x = SelfStress::new(&ended.x.nodes, &system.self_stresses(), system.units).relieved(ended.x);
        let estimated = estimate(&mut system, &x, &goal, 0.0)?;
        let error = estimated.error;
        let condition = system.condition();
        mesh = system.mesh;
        let count = mesh.elements();
        stalls = if before.is_some_and(|e| error > 0.5 * e) { stalls + 1 } else { 0 };
        // Once may be a mesh that was still too coarse; orders of two and more halve the error soon.
        let stalled = stalls >= 2 && error < LARGEST_ROUNDING;
        let settled = error <= settings.tolerance || stalled;
        let hidden = if settled && settings.adaptive { parts_for_waves(&mesh, &x, true)? } else { None };
        let wanted = hidden.iter().flatten().fold(0_usize, |sum, parts| sum.saturating_add(*parts));
        let finer = wanted.max(count + 1);
        let status = if settled && hidden.is_none() {
            Some(if error <= settings.tolerance { Status::Converged } else { Status::RoundingLimited })
        } else if !settings.adaptive
            || finer > settings.most_elements
            || spent.meshes >= meshes + MOST_MESHES
            || spent.left() < FEWEST * finer
        {
            Some(Status::Unresolved)
        } else {
            None
        };
        if let Some(status) = status {
            let reason = match status {
                Status::Unresolved if settled => {
                    format!("{count} elements hide ways to buckle, for which {wanted} are needed")
                }
                Status::Unresolved => format!("{count} elements leave an error of {error:.1e}"),
                _ => String::new(),
            };
            let residual = check::residual(&mesh, &x)?;
            let mut report = spent.report(status, reason, 1.0, ended.norms);
            (report.error, report.residual, report.condition) = (error, residual, condition);
            if let Some(e) = x.strains.iter().find(|e| !(e[0] > -1.0)) {
                report.status = Status::Diverged;
                report.reason = format!("the ribbon is compressed to nothing: eps = {:.3}", e[0]);
            }
            // NaN is refused, too.
            let enough = error.max(1e-9).max(settings.tolerance).max(check::rounding(&mesh, &x)?);
            if status.is_solved() && !(residual <= 10.0 * enough) {
                report.status = Status::Diverged;
                report.reason = format!("the independent check finds a residual of {residual:.1e}");
            }
            return Ok(Solved { nodes: mesh.nodes, x, report, index: None });
        }
        before = Some(error);
        let nodes = match hidden {
            Some(parts) => divided(&mesh, &parts),
            None => refined(&mesh, &estimated, settings.tolerance),
        };
        let finer = Mesh::new(&problem, nodes, settings.degree)?;
        x = transferred(&x, &mesh, &finer)?;
        mesh = finer;
        spent.meshes += 1;
    }
}
