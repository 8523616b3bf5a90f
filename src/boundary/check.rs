//! An independent check of a discrete solution.
//!
//! The equations are written anew: in differential form, by differentiating the polynomials of position, orientation,
//! force and moment through the stages; the law by its gradient; what the ends hold in plain words. Nothing that the
//! solver eliminates, scales or linearises enters.

use nalgebra::{Quaternion, Vector3};

use super::element::{Entry, Span, Stages};
use super::ends::{At, End, Hold, directors};
use super::iterate::{Iterate, strain_size};
use super::mesh::Mesh;
use crate::InvalidInput;
use crate::section::Strain;

type Vector = Vector3<f64>;

/// The largest residual: of positions over the length, of angles, of strains (`eps`, `K L`), and of forces and moments as
/// the strains they would cause.
///
/// # Errors
/// Where a section is refused.
pub fn residual(mesh: &Mesh, x: &Iterate) -> Result<f64, InvalidInput> {
    let problem = &mesh.problem;
    let length = problem.length;
    let units = problem.units()?;
    let mut stages = Box::<Stages>::default();
    let mut worst = Worst(0.0);
    for i in 0..mesh.elements() {
        let (at, h, s) = (&x.nodes[i], mesh.length(i), mesh.gauss.degree);
        let mut made = Vec::new();
        let responses = mesh.responses(i, &mut made)?;
        let span =
            Span { gauss: mesh.gauss, length: h, responses, offset: &[], drag: 0.0, load: mesh.load(i) };
        let entry = Entry { rotation: at.rotation, force: at.force, moment: at.moment() };
        let strains = &x.strains[i * s..(i + 1) * s];
        stages.evaluate(&span, &entry, strains);
        let places = mesh.places(i);
        let rotations: Vec<_> =
            std::iter::once(at.rotation).chain(stages.rotation[..s].iter().copied()).collect();
        let positions: Vec<Vector> =
            std::iter::once(at.position).chain(stages.arm[..s].iter().map(|arm| at.position + arm)).collect();
        let forces: Vec<Vector> =
            std::iter::once(at.force).chain(stages.force[..s].iter().copied()).collect();
        let abouts: Vec<Vector> = std::iter::once(at.about_origin)
            .chain((0..s).map(|j| stages.moment[j] + positions[1 + j].cross(&stages.force[j])))
            .collect();
        let (mut end_force, mut end_about) = (at.force, at.about_origin);
        for j in 0..s {
            let row = &mesh.gauss.derivative[j];
            let slope = |values: &[Vector]| row.iter().zip(values).map(|(d, v)| v * *d).sum::<Vector>();
            let e = &strains[j];
            let (q, r) = (rotations[1 + j], positions[1 + j]);
            let turning = row
                .iter()
                .zip(&rotations)
                .map(|(d, q)| *q * *d)
                .fold(Quaternion::new(0.0, 0.0, 0.0, 0.0), |sum, q| sum + q);
            let expected = q * Quaternion::new(0.0, e[1], e[2], e[3]) * (0.5 * h);
            worst.take((turning - expected).norm());
            let tangent = (q * Quaternion::new(0.0, 0.0, 0.0, 1.0) * q.conjugate()).imag();
            worst.take((slope(&positions) - tangent * (h * (1.0 + e[0]))).norm() / length);
            let (p, c) = problem.line_load(places[j]);
            worst.take((slope(&forces) + h * p).norm() / units.force);
            worst.take((slope(&abouts) + h * (r.cross(&p) + c)).norm() / units.moment);
            end_force -= h * mesh.gauss.weights[j] * p;
            end_about -= h * mesh.gauss.weights[j] * (r.cross(&p) + c);
            // Components on the directors, of the norm that the polynomial has at a stage.
            let body = |v: &Vector| (q.conjugate() * Quaternion::from_imag(*v) * q).imag();
            let (n, m) = (body(&forces[1 + j]), body(&(abouts[1 + j] - r.cross(&forces[1 + j]))));
            let response = &responses[if responses.len() == 1 { 0 } else { j }];
            let resultants = Strain::new(n.z, m.x, m.y, m.z);
            let law = response.value_alone(e) - response.compliance.component_mul(&resultants);
            worst.take(strain_size(&law, length));
        }
        let next = &x.nodes[i + 1];
        let (mut r, mut q) = (at.position, at.rotation);
        for ((e, stage), weight) in strains.iter().zip(&rotations[1..]).zip(&mesh.gauss.weights) {
            let tangent = (stage * Quaternion::new(0.0, 0.0, 0.0, 1.0) * stage.conjugate()).imag();
            r += tangent * (h * weight * (1.0 + e[0]));
            q += stage * Quaternion::new(0.0, e[1], e[2], e[3]) * (0.5 * h * weight);
        }
        worst.take((r - next.position).norm() / length);
        worst.take((q - next.rotation).norm().min((q + next.rotation).norm()));
        let (force, moment) = mesh.points[i + 1].unwrap_or((Vector::zeros(), Vector::zeros()));
        worst.take((end_force - force - next.force).norm() / units.force);
        let turning = next.position.cross(&force);
        worst.take((end_about - turning - moment - next.about_origin).norm() / units.moment);
        worst.take((next.rotation.norm() - 1.0).abs());
    }
    for (end, at, outward) in
        [(&problem.ends[0], &x.nodes[0], -1.0), (&problem.ends[1], &x.nodes[mesh.elements()], 1.0)]
    {
        held(&problem.goal(end), at, outward, units.force, units.moment, length, &mut worst);
    }
    Ok(worst.0)
}

/// What rounding of forces and moments makes of strains, which are soft in bending and twist.
///
/// # Errors
/// Where a section is refused.
pub fn rounding(mesh: &Mesh, x: &Iterate) -> Result<f64, InvalidInput> {
    let compliance = mesh.problem.law.at(0.0)?.compliance;
    let softest = compliance.rows(1, 3).max() * mesh.problem.length;
    let size = |at: &At| at.about_origin.norm() + at.position.norm() * at.force.norm();
    Ok(100.0 * f64::EPSILON * softest * x.nodes.iter().map(size).fold(0.0, f64::max))
}

struct Worst(f64);

impl Worst {
    fn take(&mut self, value: f64) {
        // Once not a number, it stays so: no later value may hide it.
        if !(self.0.is_nan() || value <= self.0) {
            self.0 = value;
        }
    }
}

fn held(end: &End, at: &At, outward: f64, force: f64, moment: f64, length: f64, worst: &mut Worst) {
    let away = at.position - end.position;
    let (n, m) = (outward * at.force - end.force, outward * at.moment() - end.moment);
    let frame = directors(&at.rotation);
    let turned = (frame - directors(&end.rotation)).norm();
    match end.hold {
        Hold::Clamped | Hold::Closed => {
            worst.take(away.norm() / length);
            worst.take(turned);
        }
        Hold::Free => {
            worst.take(n.norm() / force);
            worst.take(m.norm() / moment);
        }
        Hold::Pinned => {
            worst.take(away.norm() / length);
            worst.take(m.norm() / moment);
        }
        Hold::Hinged(director) => {
            worst.take(away.norm() / length);
            worst.take(1.0 - frame[(director, director)]);
            worst.take(m[director].abs() / moment);
        }
        Hold::Sliding(axis) => {
            worst.take((away - axis * axis.dot(&away)).norm() / length);
            worst.take(turned);
            worst.take(axis.dot(&n).abs() / force);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_a_number_stays() {
        let mut worst = Worst(0.0);
        [1.0, f64::NAN, 2.0, 0.5].into_iter().for_each(|value| worst.take(value));
        assert!(worst.0.is_nan());
        let mut worst = Worst(0.0);
        [1.0, 2.0, 0.5].into_iter().for_each(|value| worst.take(value));
        assert_eq!(worst.0, 2.0);
    }
}
