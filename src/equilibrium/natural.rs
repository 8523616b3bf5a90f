//! All natural shapes of a uniformly growing ribbon.

use super::Phase;
use super::bound::bound;
use super::reduced::{Sheets, twists};
use super::roots::roots;
use super::second_order;
use crate::section::{Form, Section, Square, Station, Strain};

/// Equilibria closer than this in `K/eta`, relative beyond 1, are not told apart.
const RESOLUTION: f64 = 1e-6;

/// Largest `|K2|/eta` that is searched: far beyond what the section law resolves in doubles.
const LARGEST_CURVATURE: f64 = 1e12;

/// Eigenvalues of the scaled Hessian above minus this count as not negative.
const INDEX_TOLERANCE: f64 = 1e-13;

/// An equilibrium of the unloaded, uniform ribbon.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Equilibrium {
    /// `eps`, `K1`, `K2`, `K3`.
    pub strain: Strain,
    /// `Pi`.
    pub energy: f64,
    /// Number of negative eigenvalues of the 4x4 Hessian of `Pi`: 0 if stable.
    pub section_index: usize,
    /// Flat, bent, twisted or helical.
    pub phase: Phase,
    /// False if this stands for several equilibria closer than 1e-6 in `K/eta` (relative beyond 1), or
    /// for a place where two such have just met or vanished.
    pub resolved: bool,
}

/// Every equilibrium of the unloaded ribbon, lowest energy first; of mirror images the one with
/// `K2 > 0`, then `K3 > 0`, first.
///
/// # Example
/// ```
/// use ribbonrs::{equilibrium::{Phase, natural_shapes}, growth::Growth, material::PlaneStress};
/// use ribbonrs::section::{Form, Section};
/// let growth = Growth::edge(0.06) + Growth::chiral(0.04);
/// let law = Section::new(0.1, &growth, &PlaneStress::incompressible(), Form::Auto)?;
/// let shapes = natural_shapes(&law);
/// assert_eq!(shapes[0].phase, Phase::Helical);
/// assert_eq!(shapes[0].section_index, 0);
/// # Ok::<(), ribbonrs::InvalidInput>(())
/// ```
#[must_use]
pub fn natural_shapes(section: &Section) -> Vec<Equilibrium> {
    let points = match section.form() {
        Form::SecondOrder => {
            let known = second_order::equilibria(section);
            known.into_iter().map(|(k, q)| Point { k, q, resolved: true }).collect()
        }
        _ => search(section),
    };
    let mut found: Vec<Point> = points.iter().flat_map(|point| mirror_images(section, point)).collect();
    merge(&mut found);
    let mut shapes: Vec<Equilibrium> = found.iter().map(|point| equilibrium(section, point)).collect();
    if section.form() != Form::SecondOrder {
        mark_incomplete(section, &mut shapes);
    }
    shapes.sort_by(|a, b| {
        // Energies just past a bifurcation agree to the last digit: then the stable shape first.
        let tie = || a.section_index.cmp(&b.section_index);
        let bending = || b.strain[2].total_cmp(&a.strain[2]);
        let twist = || b.strain[3].total_cmp(&a.strain[3]);
        a.energy.total_cmp(&b.energy).then_with(tie).then_with(bending).then_with(twist)
    });
    shapes
}

impl Station {
    /// [`natural_shapes`] of the section, in units of the ribbon's reference dimensions.
    #[must_use]
    pub fn natural_shapes(&self) -> Vec<Equilibrium> {
        let mut shapes = natural_shapes(self.section());
        for shape in &mut shapes {
            shape.strain = self.reference(&shape.strain);
            shape.energy *= self.weight();
        }
        shapes
    }
}

/// An equilibrium in the ribbon's units, not checked against others nearby.
pub(crate) struct Settled {
    pub shape: Equilibrium,
    /// Rounding error of the curvatures: that of the balance over the stiffness.
    pub noise: f64,
    /// Least eigenvalue of the scaled Hessian in `K2`, `K3`, over the greatest.
    pub softness: f64,
}

/// The equilibrium to which Newton's method leads from these strains.
pub(crate) fn settle(station: &Station, start: &Strain) -> Option<Settled> {
    let section = station.section();
    let (local, eta) = (station.local(start), section.eta());
    let point = polish(section, Point { k: local[2] / eta, q: local[3] / eta, resolved: true })?;
    let mut shape = unchecked(section, &point);
    shape.strain = station.reference(&shape.strain);
    shape.energy *= station.weight();
    let here = balance(section, point.k, point.q);
    let [low, high] = here.eigenvalues();
    let noise = 16.0 * f64::EPSILON * here.scale[0].max(here.scale[1]) / low.abs().min(high.abs());
    Some(Settled { shape, noise: noise * eta / station.width(), softness: low / high.abs().max(1.0) })
}

/// Marks the softest shape as unresolved if the count of all cannot be right.
///
/// The energy grows in every direction, so the sum of `(-1)^index` over its nondegenerate critical points
/// is 1, the Euler characteristic of the plane of `K2`, `K3`. Where it is not, a pair has been lost in
/// rounding beside a nearly degenerate shape. The second-order form is unbounded below and obeys no such rule.
fn mark_incomplete(section: &Section, shapes: &mut [Equilibrium]) {
    let even = shapes.iter().filter(|s| s.section_index % 2 == 0).count();
    if shapes.iter().any(|s| !s.resolved) || 2 * even == shapes.len() + 1 {
        return;
    }
    let eta = section.eta();
    let softness = |s: &Equilibrium| balance(section, s.strain[2] / eta, s.strain[3] / eta).softness();
    let softest = shapes.iter_mut().min_by(|a, b| softness(a).total_cmp(&softness(b)));
    if let Some(shape) = softest {
        shape.resolved = false;
    }
}

/// An equilibrium in scaled curvatures `k = K2/eta`, `q = K3/eta`.
#[derive(Clone, Copy, Debug)]
struct Point {
    k: f64,
    q: f64,
    resolved: bool,
}

/// Equilibria up to mirror images, on every sheet of the torsion equation.
fn search(section: &Section) -> Vec<Point> {
    let symmetric = section.reduction().is_symmetric_in_bending();
    let untwisted = section.reduction().k3 == 0.0;
    let at = |k: f64| Sheets::at(section, k, symmetric);
    let bound = bound(section);
    let mut found = Vec::new();
    // Strains this small leave the stiffness that of the ungrown section: one equilibrium, near zero.
    if symmetric || bound < RESOLUTION {
        for q in twists(section, 0.0) {
            found.extend(polish(section, Point { k: 0.0, q, resolved: true }));
        }
    }
    if bound < RESOLUTION {
        return found;
    }
    for (from, to) in intervals(section, bound, symmetric) {
        if !untwisted {
            for root in roots(|k| at(k).resultant(), from, to) {
                let starts = twists(section, root.x);
                found.extend(nearest(section, root.x, &starts, root.simple));
            }
            continue;
        }
        for root in roots(|k| at(k).untwisted, from, to) {
            found.extend(nearest(section, root.x, &[0.0], root.simple));
        }
        // The published saddle law does not relax in K3 and has no other sheet.
        if section.form() == Form::PublishedSaddle {
            continue;
        }
        for root in roots(|k| at(k).twisted, from, to) {
            let squared = at(root.x).twist_squared;
            if squared > -RESOLUTION * RESOLUTION {
                found.extend(nearest(section, root.x, &[squared.max(0.0).sqrt()], root.simple));
            }
        }
    }
    found
}

/// Intervals of `k` that cover the bound, none longer than its distance from the poles at `+-7.46 i`
/// and from the imaginary axis beyond.
fn intervals(section: &Section, bound: f64, symmetric: bool) -> Vec<(f64, f64)> {
    // The bound is attained by compatible growth; leave room for its rounding.
    let bound = (bound * (1.0 + 1e-9)).min(LARGEST_CURVATURE);
    let first = 4.0 * 3.0 * section.reduction().material.beta2.sqrt();
    let mut intervals = Vec::new();
    let (mut from, mut to) = (0.0, first);
    while from < bound {
        let end = to.min(bound);
        intervals.push((from, end));
        if !symmetric {
            intervals.push((-end, -from));
        }
        (from, to) = (to, 2.0 * to);
    }
    intervals
}

/// Polishes the starts `(k, q)` and keeps what stays near `k`.
///
/// A cluster is tried from both its sides as well, to separate a close pair. If nothing stays, the start
/// nearest to equilibrium is kept as unresolved: after a change of sign always, at a cluster where its
/// imbalance is lost in rounding.
fn nearest(section: &Section, k: f64, twists: &[f64], simple: bool) -> Vec<Point> {
    let size = k.abs().max(1.0);
    let offsets: &[f64] = if simple { &[0.0] } else { &[0.0, -1e-4, 1e-4] };
    let starts = twists
        .iter()
        .flat_map(|&q| offsets.iter().map(move |offset| Point { k: k + offset * size, q, resolved: true }));
    let polished: Vec<Point> = starts.filter_map(|start| polish(section, start)).collect();
    // A change of sign known only to the noise over a small slope may lie further off than most.
    let reaches: &[f64] = if simple { &[1e-5, 1e-3] } else { &[1e-3] };
    for reach in reaches {
        let near = polished.iter().copied().filter(|p| (p.k - k).abs() < reach * size);
        let kept: Vec<Point> = near.collect();
        if !kept.is_empty() {
            return kept;
        }
    }
    let imbalance = |q: f64| balance(section, k, q).relative_size();
    let best = twists.iter().copied().min_by(|p, q| imbalance(*p).total_cmp(&imbalance(*q)));
    best.filter(|&q| simple || imbalance(q) < 1e-11)
        .map(|q| Point { k, q, resolved: false })
        .into_iter()
        .collect()
}

/// Gradient and Hessian of `Pi/eta^4` in `k`, `q` with `eps` and `K1` eliminated.
pub struct Balance {
    /// Derivatives in `k` and `q`.
    pub gradient: [f64; 2],
    /// Sizes of the terms that cancel in the gradient.
    scale: [f64; 2],
    /// `kk, kq, qq`
    pub hessian: [f64; 3],
}

impl Balance {
    fn relative_size(&self) -> f64 {
        let relative = |i: usize| self.gradient[i].abs() / self.scale[i].max(f64::MIN_POSITIVE);
        relative(0).max(relative(1))
    }

    /// Number of negative eigenvalues.
    #[must_use]
    pub fn index(&self) -> usize {
        let [low, high] = self.eigenvalues();
        let tolerance = self.index_tolerance();
        usize::from(low < -tolerance) + usize::from(high < -tolerance)
    }

    fn index_tolerance(&self) -> f64 {
        let [low, high] = self.eigenvalues();
        INDEX_TOLERANCE * low.abs().max(high.abs()).max(1.0)
    }

    /// The softest direction's stiffness, relative to the stiffest.
    fn softness(&self) -> f64 {
        let [low, high] = self.eigenvalues();
        low.abs().min(high.abs()) / low.abs().max(high.abs()).max(f64::MIN_POSITIVE)
    }

    /// The lesser first.
    #[must_use]
    pub fn eigenvalues(&self) -> [f64; 2] {
        let [kk, kq, qq] = self.hessian;
        let (mean, radius) = (0.5 * (kk + qq), (0.5 * (kk - qq)).hypot(kq));
        [mean - radius, mean + radius]
    }

    /// Curvature of the energy along a unit direction.
    fn along(&self, [k, q]: [f64; 2]) -> f64 {
        let [kk, kq, qq] = self.hessian;
        kk * k * k + 2.0 * kq * k * q + qq * q * q
    }
}

/// Whether no other equilibrium can be closer than [`RESOLUTION`].
///
/// Along the softest direction the energy is `lambda s^2/2 + T s^3/6 + Q s^4/24 + ...`; another
/// stationary point at `s` needs `|lambda| <= |T| s/2 + |Q| s^2/6`.
fn is_isolated(section: &Section, point: &Point) -> bool {
    let here = balance(section, point.k, point.q);
    let [low, high] = here.eigenvalues();
    let soft = if low.abs() < high.abs() { low } else { high };
    let [kk, kq, qq] = here.hessian;
    // Of the two rows of H - soft, the larger one gives the direction.
    let (a, b) = if (kk - soft).abs() > (qq - soft).abs() { (-kq, kk - soft) } else { (qq - soft, -kq) };
    let norm = a.hypot(b);
    let direction = if norm > 0.0 { [a / norm, b / norm] } else { [1.0, 0.0] };
    let size = point.k.abs().max(point.q.abs()).max(1.0);
    let step = 1e-4 * size;
    let beside = |sign: f64| {
        let (k, q) = (point.k + sign * step * direction[0], point.q + sign * step * direction[1]);
        balance(section, k, q).along(direction)
    };
    let (before, after) = (beside(-1.0), beside(1.0));
    let third = (after - before) / (2.0 * step);
    let fourth = (after - 2.0 * here.along(direction) + before) / (step * step);
    let s = RESOLUTION * size;
    // An eigenvalue whose sign the index does not trust belongs to no isolated equilibrium.
    soft.abs() > here.index_tolerance().max(0.5 * third.abs() * s + fourth.abs() * s * s / 6.0)
}

/// The balance of a section at `k = K2/eta`, `q = K3/eta`.
#[must_use]
pub fn balance(section: &Section, k: f64, q: f64) -> Balance {
    let r = section.reduction();
    let (eta, g) = (section.eta(), r.material.twist);
    let relaxed = section.relaxation().derivatives(k * eta, Square::of(q * eta));
    let bend = (k * eta + r.d33) / eta / 12.0;
    let twist = 2.0 * g * (q - r.k3 / eta);
    let relief = 2.0 * q * relaxed.dp;
    Balance {
        gradient: [bend + relaxed.d2, twist + relief],
        scale: [bend.abs() + relaxed.d2.abs(), twist.abs() + relief.abs()],
        hessian: [
            1.0 / 12.0 + relaxed.d22,
            2.0 * q * relaxed.d2p,
            2.0 * g + 2.0 * relaxed.dp + 4.0 * q * q * relaxed.dpp,
        ],
    }
}

/// Newton's method in `(k, q)`; `None` if it does not settle.
fn polish(section: &Section, start: Point) -> Option<Point> {
    let Point { mut k, mut q, resolved } = start;
    let mut previous = f64::INFINITY;
    for _ in 0..40 {
        let Balance { gradient: [g0, g1], hessian: [kk, kq, qq], .. } = balance(section, k, q);
        // The symmetric states k = 0 and q = 0 are kept exactly.
        let (dk, dq) = if k == 0.0 && g0 == 0.0 {
            (0.0, -g1 / qq)
        } else if q == 0.0 && g1 == 0.0 {
            (-g0 / kk, 0.0)
        } else {
            let determinant = kk * qq - kq * kq;
            ((kq * g1 - qq * g0) / determinant, (kq * g0 - kk * g1) / determinant)
        };
        let size = k.abs().max(q.abs()).max(1.0);
        let step = dk.abs().max(dq.abs()) / size;
        if !step.is_finite() && g0 == 0.0 && g1 == 0.0 {
            return Some(Point { k, q, resolved: false });
        }
        if !step.is_finite() || step > 10.0 {
            return None;
        }
        // Steps that no longer shrink are rounding.
        if step <= 4.0 * f64::EPSILON || (step < 1e-9 && step >= 0.5 * previous) {
            return Some(Point { k: k + dk, q: q + dq, resolved });
        }
        (k, q, previous) = (k + dk, q + dq, step);
    }
    None
}

/// The point with its images under the symmetries of the growth.
fn mirror_images(section: &Section, point: &Point) -> Vec<Point> {
    let r = section.reduction();
    let mut images = vec![*point];
    if r.is_symmetric_in_bending() && point.k != 0.0 {
        images.push(Point { k: -point.k, ..*point });
    }
    if r.k3 == 0.0 && point.q != 0.0 {
        images.extend(images.clone().iter().map(|p| Point { q: -p.q, ..*p }));
    }
    images
}

/// Merges what is closer than [`RESOLUTION`]: repeats of one equilibrium silently, different ones
/// into a single unresolved point.
fn merge(points: &mut Vec<Point>) {
    // Of several, keep the one with the most symmetry, then the resolved one.
    let rank = |p: &Point| (p.k != 0.0, p.q != 0.0, !p.resolved);
    points.sort_by_key(rank);
    let mut kept: Vec<Point> = Vec::new();
    for point in points.iter() {
        let distance = |p: &Point| (p.k - point.k).abs().max((p.q - point.q).abs());
        let size = point.k.abs().max(point.q.abs()).max(1.0);
        match kept.iter_mut().find(|p| distance(p) < RESOLUTION * size) {
            Some(p) => p.resolved &= point.resolved && distance(p) < 1e-9 * size,
            None => kept.push(*point),
        }
    }
    *points = kept;
}

fn equilibrium(section: &Section, point: &Point) -> Equilibrium {
    Equilibrium { resolved: point.resolved && is_isolated(section, point), ..unchecked(section, point) }
}

fn unchecked(section: &Section, point: &Point) -> Equilibrium {
    let r = section.reduction();
    let eta = section.eta();
    let (k2, k3) = (point.k * eta, point.q * eta);
    let strain = Strain::new(r.eps - k3 * k3 / 24.0, r.k1, k2, k3);
    Equilibrium {
        strain,
        energy: section.energy(&strain),
        section_index: balance(section, point.k, point.q).index(),
        phase: Phase::of(&strain, eta),
        resolved: point.resolved,
    }
}
