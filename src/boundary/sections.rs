//! The stability of sections.

use nalgebra::Matrix4;

use super::ends::At;
use super::iterate::Iterate;
use super::law::{Law, Response};
use super::mesh::Mesh;
use super::solution::SectionState;
use super::step::pointwise;
use crate::section::Strain;

/// What the tangent stiffnesses of sections say of their stability.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sections {
    /// The largest number of negative eigenvalues.
    pub index: usize,
    /// The least determinant, of the stiffness relative to that of the ungrown section; it changes sign with the first
    /// eigenvalue.
    pub least: f64,
    /// The least of the greater eigenvalues in bending and twist, relative to the ungrown section; it changes sign with the second.
    pub second: f64,
    /// Logarithm of the size of the product of all determinants.
    pub log: f64,
}

impl Default for Sections {
    fn default() -> Self {
        Self { index: 0, least: f64::INFINITY, second: f64::INFINITY, log: 0.0 }
    }
}

impl Sections {
    /// Takes a tangent stiffness into account, its rows times a compliance.
    pub(super) fn add(&mut self, tangent: &Matrix4<f64>, compliance: &Strain) {
        // A rigid section is stable.
        if compliance.min() == 0.0 {
            return;
        }
        let scale = compliance.map(f64::sqrt);
        let mut a = tangent.map_with_location(|i, k, x| x * scale[k] / scale[i]);
        let (mut negative, mut determinant) = (0, 1.0);
        // The stiffnesses in eps and K1 come first and are positive: no pivoting is needed.
        for k in 0..4 {
            if k == 2 {
                let [mean, half] = [1.0, -1.0].map(|sign| 0.5 * (a[(2, 2)] + sign * a[(3, 3)]));
                self.second = self.second.min(mean + (half * half + a[(2, 3)] * a[(3, 2)]).sqrt());
            }
            let pivot = a[(k, k)];
            negative += usize::from(pivot < 0.0);
            determinant *= pivot;
            for i in k + 1..4 {
                let factor = a[(i, k)] / pivot;
                for j in k + 1..4 {
                    a[(i, j)] -= factor * a[(k, j)];
                }
            }
        }
        self.index = self.index.max(negative);
        self.least = if determinant < self.least { determinant } else { self.least };
        self.log += determinant.abs().ln();
    }

    /// The same with the sections at nodes taken into account: the stages alone would miss what happens first at an end, under a point
    /// load, or where growth jumps. A section there that is refused is left out.
    #[must_use]
    pub fn with_nodes(mut self, mesh: &Mesh, x: &Iterate) -> Self {
        let law = &mesh.problem.law;
        // Sections that all are the same are so at the nodes.
        let alike = || !law.varies() && x.strains.iter().all(|e| (e - x.strains[0]).amax() < SAME);
        if !matches!(**law, Law::Relaxed(_)) || alike() {
            return self;
        }
        for node in 0..mesh.nodes.len() {
            for (response, strain) in sections_at(mesh, x, node) {
                self.add(&response.value(&strain).1, &response.compliance);
            }
        }
        self
    }
}

/// The law and the strains of the sections at a node, from the resultants there: on both sides where there is a point load or the law
/// is not smooth.
pub fn sections_at(mesh: &Mesh, x: &Iterate, node: usize) -> Vec<(Response, Strain)> {
    let (problem, s) = (&mesh.problem, mesh.nodes[node]);
    let right = x.nodes[node];
    let (jump, couple) = mesh.points[node].unwrap_or_default();
    let left = At {
        force: right.force + jump,
        about_origin: right.about_origin + right.position.cross(&jump) + couple,
        ..right
    };
    let last = mesh.elements();
    let mut sides = Vec::new();
    if node < last {
        sides.push((s, right, x.strain(mesh, node, 0.0)));
    }
    if node == last || node > 0 && (mesh.points[node].is_some() || problem.law.breaks().contains(&s)) {
        let within = if node == last { s } else { s.next_down() };
        sides.push((within, left, x.strain(mesh, node - 1, 1.0)));
    }
    let section = |(s, at, guess): (f64, At, Strain)| {
        let response = problem.law.at(s).ok()?;
        Some((response.clone(), pointwise(&response, &SectionState::resultants(&at), guess)))
    };
    sides.into_iter().filter_map(section).collect()
}

/// Difference of strains that is rounding.
const SAME: f64 = 1e-14;
