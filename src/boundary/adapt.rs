//! The error of a discrete solution, and the mesh that brings it below a tolerance.
//!
//! Two half steps from a node, less the whole one, are the defect of an element but for terms of higher order; what
//! the factorised equations make of all defects is the global error, with its sign, at every node.

use super::ends::{At, Units, half_angle};
use super::gauss::Gauss;
use super::iterate::{Correction, Iterate, strain_size};
use super::mesh::Mesh;
use super::problem::Problem;
use super::step::Stepper;
use super::system::{System, Targets};
use crate::InvalidInput;
use crate::section::Strain;

/// The estimated error.
#[derive(Clone, Debug)]
pub struct Estimate {
    /// Largest of the errors of position/L, angles, `eps` and `K L`.
    pub error: f64,
    /// Size of the defect of each element.
    pub defects: Vec<f64>,
    /// How fast the layers of each element decay: the root of the force times the softest compliance.
    pub rates: Vec<f64>,
}

impl Estimate {
    /// Whether all defects are those of rounding, which no finer mesh has less of.
    #[must_use]
    pub fn is_rounding(&self, x: &Iterate, units: &Units) -> bool {
        let moment = |at: &At| at.force.norm() * at.position.norm() + at.about_origin.norm();
        let largest = x.nodes.iter().map(moment).fold(0.0, f64::max) / units.moment;
        self.defects.iter().all(|defect| *defect < ROUNDING * (1.0 + largest))
    }
}

/// The defect of an element that is that of rounding, of positions/L and angles of size 1.
const ROUNDING: f64 = 2e-15;
/// The defect that stands for that of an element whose half steps cannot be solved for.
const UNKNOWN: f64 = 1e-2;

/// By how much each element misses its end.
pub struct Defects {
    /// Of position, rotation, and moment about the origin, in the units of the system.
    pub gaps: Vec<[f64; 9]>,
    sizes: Vec<f64>,
    rates: Vec<f64>,
}

impl Defects {
    /// Counts what an element misses as nothing.
    pub fn leave_out(&mut self, element: usize) {
        self.gaps[element] = [0.0; 9];
        self.sizes[element] = 0.0;
    }

    /// The estimate, from what the equations make of the gaps.
    #[must_use]
    pub fn estimate(self, correction: &Correction, problem: &Problem) -> Estimate {
        let mut error = largest(correction, problem);
        if self.sizes.contains(&UNKNOWN) {
            error = error.max(UNKNOWN);
        }
        Estimate { error, defects: self.sizes, rates: self.rates }
    }
}

/// The defects of `x` as a solution for these targets, for an error that is compared with a tolerance.
///
/// # Errors
/// Where a section is refused.
pub fn defects(
    system: &System,
    x: &Iterate,
    targets: &Targets,
    tolerance: f64,
) -> Result<Defects, InvalidInput> {
    let mesh = &system.mesh;
    let mut stepper = Stepper::new(&mesh.problem, mesh.gauss)?.to(NEGLIGIBLE * tolerance);
    let degree = mesh.gauss.degree;
    let factor = 1.0 / (1.0 - 0.25_f64.powi(mesh.gauss.degree as i32));
    let mut gaps = Vec::with_capacity(mesh.elements());
    let mut sizes = Vec::with_capacity(mesh.elements());
    let mut rates = Vec::with_capacity(mesh.elements());
    for i in 0..mesh.elements() {
        let (at, s, h) = (&x.nodes[i], mesh.nodes[i], mesh.length(i));
        let strain = |c: f64| x.strain(mesh, i, c);
        let (whole, _) = stepper.step(at, s, h, strain, false)?;
        if let Some(known) = targets.offset.get(i * degree..(i + 1) * degree) {
            stepper.offset_by(halves(mesh.gauss, known, 0.0), targets.drag);
        }
        let (middle, first) = stepper.step(at, s, 0.5 * h, |c| strain(0.5 * c), true)?;
        if let Some(known) = targets.offset.get(i * degree..(i + 1) * degree) {
            stepper.offset_by(halves(mesh.gauss, known, 0.5), targets.drag);
        }
        let (end, second) = stepper.step(&middle, s + 0.5 * h, 0.5 * h, |c| strain(0.5 + 0.5 * c), true)?;
        let mut gap = [0.0; 9];
        let position = (end.position - whole.position) * (factor / system.units.length);
        let rotation = half_angle(&(end.rotation * whole.rotation.conjugate())) * (2.0 * factor);
        // About the end itself: moments about a far origin would hide it.
        let moment = (end.about_origin - whole.about_origin) * (factor / system.units.moment);
        gap[..3].copy_from_slice(position.as_slice());
        gap[3..6].copy_from_slice(rotation.as_slice());
        gap[6..].copy_from_slice(moment.as_slice());
        let size = gap.iter().map(|g| g * g).sum::<f64>().sqrt();
        sizes.push(if first && second && size.is_finite() { size } else { UNKNOWN });
        gaps.push(gap);
        let mut made = Vec::new();
        let compliance = mesh.responses(i, &mut made)?[0].compliance;
        rates.push((at.force.norm() * compliance.rows(1, 3).max()).sqrt());
    }
    Ok(Defects { gaps, sizes, rates })
}

/// Part of a tolerance that no defect is to be wrong by: what the equations make of it may be a thousand times as much.
const NEGLIGIBLE: f64 = 1e-5;

/// Estimates the error of `x`, at which `system` was linearised, as a solution for these targets, to be compared with a tolerance.
///
/// # Errors
/// Where a section is refused.
pub fn estimate(
    system: &mut System,
    x: &Iterate,
    targets: &Targets,
    tolerance: f64,
) -> Result<Estimate, InvalidInput> {
    let defects = defects(system, x, targets, tolerance)?;
    let correction = system.correction_for(defects.gaps.clone());
    Ok(defects.estimate(&correction, &system.mesh.problem))
}

/// Strains at the stages of the half of an element that begins at `from`.
fn halves(gauss: &Gauss, known: &[Strain], from: f64) -> impl Iterator<Item = Strain> {
    gauss.nodes.iter().map(move |c| {
        let basis = gauss.basis(from + 0.5 * c);
        known.iter().zip(basis).map(|(e, l)| e * l).sum()
    })
}

fn largest(correction: &Correction, problem: &Problem) -> f64 {
    let pose = |change: &[f64; 12]| {
        let size = |i: usize| change[i].hypot(change[i + 1]).hypot(change[i + 2]);
        size(0).max(size(3))
    };
    let nodes = correction.nodes.iter().map(pose);
    let strains = correction.strains.iter().map(|e| strain_size(e, problem.length));
    let nan_is_infinite = |m: f64, x: f64| {
        if x <= m {
            m
        } else if x.is_nan() {
            f64::INFINITY
        } else {
            x
        }
    };
    nodes.chain(strains).fold(0.0, nan_is_infinite)
}

/// Error that a new mesh is made for, of the tolerance.
const AIM: f64 = 0.2;
/// By how much the number of elements grows at least, for else nothing might change, and at most.
const LEAST_GROWTH: f64 = 1.25;
const GROWTH: f64 = 4.0;
/// Lengths of decay that an element spans at most: over many a step from its start amplifies what the ends damp.
const LONGEST_LAYER: f64 = 4.0;
/// Elements that layers ask for at most: a force of which they would be more is none.
const MOST_LAYERS: f64 = 20_000.0;
/// Part of an element by which the estimates from both ends of the same one differ.
const ALIKE: f64 = 0.25;
/// Distance of places, over the length, that is none.
const SAME: f64 = 1e-13;
/// Least density of elements, relative to its mean.
const LEAST_DENSITY: f64 = 0.1;

/// Nodes of a mesh on which all elements have the same defect, small enough for the error to meet the tolerance.
#[must_use]
pub fn refined(mesh: &Mesh, estimate: &Estimate, tolerance: f64) -> Vec<f64> {
    let order = 2.0 * mesh.gauss.degree as f64;
    let count = mesh.elements() as f64;
    let shares: Vec<f64> = estimate.defects.iter().map(|d| d.max(1e-300).powf(1.0 / (order + 1.0))).collect();
    let total: f64 = estimate.defects.iter().sum();
    let integral: f64 = shares.iter().sum();
    let amplified = estimate.error / total.max(1e-300);
    let wanted = (amplified * integral.powf(order + 1.0) / (AIM * tolerance)).powf(1.0 / order);
    let wanted = wanted.clamp(LEAST_GROWTH * count, GROWTH * count).max(1.0);
    let length = mesh.problem.length;
    // Elements per length, no element much longer than the mean.
    let density: Vec<f64> = shares
        .iter()
        .enumerate()
        .map(|(i, share)| {
            let layers = (estimate.rates[i] / LONGEST_LAYER).min(MOST_LAYERS / length);
            let least = (LEAST_DENSITY * wanted / length).max(layers);
            (wanted * share / integral / mesh.length(i)).max(least)
        })
        .collect();
    let mut nodes = vec![0.0];
    for pair in mesh.problem.breaks().windows(2) {
        // Density between these breaks, summed up, and divided into equal parts.
        let first = mesh.nodes.partition_point(|&s| s < pair[0]);
        let last = mesh.nodes.partition_point(|&s| s < pair[1]);
        let mut sums = vec![0.0];
        for (i, density) in (first..last).zip(&density[first..last]) {
            sums.push(sums[sums.len() - 1] + density * mesh.length(i));
        }
        let parts = sums[sums.len() - 1].ceil().max(1.0) as usize;
        for part in 1..parts {
            let place = sums[sums.len() - 1] * part as f64 / parts as f64;
            let i = sums.partition_point(|&sum| sum <= place).clamp(1, sums.len() - 1);
            let within = (place - sums[i - 1]) / (sums[i] - sums[i - 1]);
            nodes.push(mesh.nodes[first + i - 1] + within * mesh.length(first + i - 1));
        }
        nodes.push(pair[1]);
    }
    nodes
}

/// Nodes that are nearly the same from either end, the same, if the places that are given are so. Collocation then has what symmetry
/// the equations have, and branches that break it meet the others exactly: an error that is not symmetric is an imperfection, by the third
/// root of which they miss one another.
#[must_use]
pub fn symmetrised(nodes: Vec<f64>, problem: &Problem) -> Vec<f64> {
    let (breaks, length) = (problem.breaks(), problem.length);
    let mirrored = |(a, b): (&f64, &f64)| (a + b - length).abs() < SAME * length;
    if !breaks.iter().zip(breaks.iter().rev()).all(mirrored) {
        return nodes;
    }
    // Between places that are given as many elements as between their images.
    let place = |s: f64| nodes.partition_point(|&node| node < s);
    let part = |pair: &[f64]| &nodes[place(pair[0])..=place(pair[1])];
    let parts: Vec<&[f64]> = breaks.windows(2).map(part).collect();
    let mut same = vec![0.0];
    for (own, image) in parts.iter().zip(parts.iter().rev()) {
        let count = own.len().max(image.len()) - 1;
        for i in 1..=count {
            let [x, y] = [i, count - i].map(|i| i as f64 / count as f64);
            let (s, other) = (within(own, x), length - within(image, y));
            // To where the other image is, of those that differ by little.
            if (s - other).abs() > ALIKE * (own[own.len() - 1] - own[0]) / count as f64 {
                return nodes;
            }
            same.push(if i < count { 0.5 * (s + other) } else { own[own.len() - 1] });
        }
    }
    same
}

/// Nodes at a part of the way from the first to the last, joined by lines.
fn within(nodes: &[f64], part: f64) -> f64 {
    let place = part * (nodes.len() - 1) as f64;
    let i = (place as usize).min(nodes.len() - 2);
    nodes[i] + (place - i as f64) * (nodes[i + 1] - nodes[i])
}

/// The iterate on another mesh.
///
/// # Errors
/// Where a section is refused.
pub fn transferred(x: &Iterate, from: &Mesh, to: &Mesh) -> Result<Iterate, InvalidInput> {
    Ok(Iterate {
        strains: transferred_strains(&x.strains, from, to),
        nodes: placed_states(x, from, to)?,
        slack: Default::default(),
    })
}

/// The states at the nodes of another mesh.
///
/// # Errors
/// Where a section is refused.
pub fn placed_states(x: &Iterate, from: &Mesh, to: &Mesh) -> Result<Vec<At>, InvalidInput> {
    let mut stepper = Stepper::new(&from.problem, from.gauss)?;
    let mut nodes = Vec::with_capacity(to.nodes.len());
    for &s in &to.nodes {
        let i = element(from, s);
        let (start, h) = (from.nodes[i], from.length(i));
        let part = s - start;
        let known = if part == 0.0 { Some(i) } else { (s == from.nodes[i + 1]).then_some(i + 1) };
        nodes.push(match known {
            Some(node) => x.nodes[node],
            None => stepper.step(&x.nodes[i], start, part, |c| x.strain(from, i, c * part / h), false)?.0,
        });
    }
    Ok(nodes)
}

/// Strains at the stages of another mesh, by the polynomials through those of the first.
#[must_use]
pub fn transferred_strains(strains: &[Strain], from: &Mesh, to: &Mesh) -> Vec<Strain> {
    let degree = from.gauss.degree;
    let places = (0..to.elements()).flat_map(|i| to.places(i));
    let at = |s: f64| {
        let i = element(from, s);
        let basis = from.gauss.basis((s - from.nodes[i]) / from.length(i));
        strains[i * degree..(i + 1) * degree].iter().zip(basis).map(|(e, l)| e * l).sum()
    };
    places.map(at).collect()
}

/// The element in which `s` is, the one to the right of a node.
fn element(mesh: &Mesh, s: f64) -> usize {
    mesh.nodes.partition_point(|&node| node <= s).clamp(1, mesh.elements()) - 1
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use nalgebra::Vector3;

    use super::*;
    use crate::boundary::{End, Hold, Law, LineLoad, PointLoad, Rod};

    #[test]
    fn meshes_that_are_nearly_symmetric_are_made_so() {
        let rod = Rod { compliance: Strain::repeat(1.0), intrinsic: Strain::zeros() };
        let ends = [End::new(Hold::Clamped), End::new(Hold::Free)];
        let with = |points| {
            Arc::new(Problem::new(Law::Rod(rod), 4.0, ends, points, LineLoad::uniform([0.0; 3])).unwrap())
        };
        let free = with(Vec::new());
        let nodes = vec![0.0, 0.95, 2.05, 3.1, 4.0];
        let found = symmetrised(nodes.clone(), &free);
        assert_eq!((found[0], found[4]), (0.0, 4.0));
        assert!((1..4).all(|i| (found[i] + found[4 - i] - 4.0).abs() < 1e-15));
        assert!((1..4).all(|i| (found[i] - nodes[i]).abs() < 0.06));
        // What is finer at one end on purpose stays, and so does the place of a load.
        let graded = vec![0.0, 0.2, 0.8, 2.0, 4.0];
        assert_eq!(symmetrised(graded.clone(), &free), graded);
        let point = PointLoad { s: 2.05, force: Vector3::x(), moment: Vector3::zeros() };
        assert_eq!(symmetrised(nodes.clone(), &with(vec![point])), nodes);
    }
}
