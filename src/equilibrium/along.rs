//! Natural shapes along a ribbon that varies: one branch of equilibria, followed continuously in `S`.
//!
//! Without load and with a free end every section is at a natural shape of its own. Of the stable ones at the
//! start each is followed by Newton's method at the Gauss points of elements in `S`, whose length adapts until
//! a polynomial holds the strains to [`TOLERANCE`]. Where a stable shape bends away like a square root, at a
//! bifurcation or a fold, the elements shrink towards that place; there the branch goes over to the stable
//! shape that begins there, or, if none does, jumps.

use super::Phase;
use super::branch::{Element, Event, EventKind, NaturalBranch};
use super::natural::{self, Equilibrium, Settled};
use crate::section::{RibbonLaw, Station, Strain};
use crate::{InvalidInput, legendre};

/// Part of a strain's size that its polynomial may miss on an element.
pub const TOLERANCE: f64 = 1e-12;

/// Gauss points of an element.
const POINTS: usize = 12;

/// Shortest element over the length of the ribbon: an error of the strains there moves no point by more
/// than rounding.
const SHORTEST: f64 = 1e-9;

/// Elements after which a branch is given up, not counting those that breaks ask for.
const MOST_ELEMENTS: usize = 10_000;

/// Crossings without an element between them after which a branch is given up: it stays where shapes are not
/// told apart.
const MOST_CROSSINGS: usize = 100;

/// Shapes nearer than this in `K/eta` (relative beyond 1) across a bifurcation are one branch.
const CONTINUOUS: f64 = 1e-2;

/// Rounding of the least stiffness over the greatest, and the value below which its sign is not trusted.
const STIFFNESS_NOISE: f64 = 1e-14;
const NEUTRAL: f64 = 1e-13;

/// Least stiffness over the greatest below which a change of phase is a bifurcation and not a strain that happens
/// to pass through zero.
const SOFT: f64 = 1e-6;

/// Every branch that is stable at `S = 0`, to `S = length`: fewest jumps first, then lowest energy.
///
/// # Errors
/// If the law refuses a section, none of its shapes is stable, or a branch needs too many elements.
pub fn natural_branches(law: &RibbonLaw, length: f64) -> Result<Vec<NaturalBranch>, InvalidInput> {
    if !(length > 0.0 && length.is_finite()) {
        return Err(InvalidInput::new("length", length, "a positive number"));
    }
    let station = law.station(0.0)?;
    let start = station.natural_shapes();
    let (mut branches, mut failure) =
        (Vec::new(), InvalidInput::new("S", 0.0, "a section with a stable shape"));
    for shape in candidates(&start) {
        match Follower::new(law, length).follow(shape) {
            Ok(branch) => branches.push(branch),
            Err(error) => failure = error,
        }
    }
    if branches.is_empty() {
        return Err(failure);
    }
    let jumps = |b: &NaturalBranch| b.events.iter().filter(|e| e.kind == EventKind::Jump).count();
    // Mirror images differ by rounding: they stay in order.
    let scale = branches.iter().map(|b| b.energy.abs()).fold(0.0, f64::max);
    let level = |b: &NaturalBranch| (b.energy / (1e-10 * scale).max(f64::MIN_POSITIVE)).round();
    branches.sort_by(|a, b| jumps(a).cmp(&jumps(b)).then(level(a).total_cmp(&level(b))));
    Ok(branches)
}

/// What follows one branch.
struct Follower<'a> {
    law: &'a RibbonLaw,
    length: f64,
    breaks: Vec<f64>,
    branch: NaturalBranch,
    work: f64,
}

impl<'a> Follower<'a> {
    fn new(law: &'a RibbonLaw, length: f64) -> Self {
        let inner = law.breaks().into_iter().filter(|&s| s > 0.0 && s < length);
        let breaks = inner.chain([length]).collect();
        let branch = NaturalBranch { elements: vec![], events: vec![], energy: 0.0, phases: vec![] };
        Self { law, length, breaks, branch, work: 0.0 }
    }

    fn follow(mut self, start: &Equilibrium) -> Result<NaturalBranch, InvalidInput> {
        let mut strain = start.strain;
        let (mut s, mut crossings) = (0.0, 0);
        for end in self.breaks.clone() {
            strain = self.enter(s, strain)?;
            let mut h = end - s;
            while s < end {
                let to = if s + 1.5 * h >= end { end } else { s + h };
                let shortest = SHORTEST * self.length;
                match self.element(s, to, &strain)? {
                    Some(last) => {
                        (s, strain, crossings) = (to, last, 0);
                        h *= 2.0;
                    }
                    None if to - s > 2.0 * shortest => h = 0.5 * (to - s),
                    None => {
                        (s, strain) = self.cross(s, end, &strain)?;
                        (h, crossings) = (4.0 * shortest, crossings + 1);
                    }
                }
                let most = MOST_ELEMENTS + 10 * self.breaks.len();
                if self.branch.elements.len() > most || crossings > MOST_CROSSINGS {
                    let expected = "growth that varies less, for the natural shape to be followed";
                    return Err(InvalidInput::new("S", s, expected));
                }
            }
        }
        self.branch.energy = self.work / self.length;
        Ok(self.branch)
    }

    /// The strains with which a stretch without breaks begins: the same shape, unless the growth jumps.
    fn enter(&mut self, s: f64, before: Strain) -> Result<Strain, InvalidInput> {
        let station = self.law.station(s)?;
        let scale = natural_scale(&station).sup(&before.abs());
        let differs = |after: &Strain| (0..4).any(|c| (after[c] - before[c]).abs() > 1e-6 * scale[c]);
        let settled = stable(&station, &before).map(|settled| settled.shape.strain);
        let after = match settled.filter(|after| distance(&station, after, &before) < 1e-6) {
            Some(same) => same,
            None => {
                nearest(&station, &station.natural_shapes(), &before).map_or(before, |shape| shape.strain)
            }
        };
        if differs(&after) {
            let kind = if self.law.jumps(s) {
                EventKind::GrowthJump
            } else if distance(&station, &after, &before) < CONTINUOUS {
                EventKind::Bifurcation
            } else {
                EventKind::Jump
            };
            self.branch.events.push(Event { s, kind, before, after });
        }
        Ok(after)
    }

    /// Solves on an element from the strains at its start; those at its end, `None` if it is too long.
    fn element(&mut self, from: f64, to: f64, start: &Strain) -> Result<Option<Strain>, InvalidInput> {
        let (nodes, weights) = legendre::rule(POINTS);
        let place = |y: f64| 0.5 * (from + to) + y * (to - from);
        let mut strains: Vec<Strain> = Vec::with_capacity(POINTS);
        let mut work = 0.0;
        let mut phases: Vec<Phase> = Vec::new();
        let (mut scale, mut noise, mut slope) = (Strain::zeros(), 0.0_f64, Strain::zeros());
        let mut softness = Vec::with_capacity(POINTS);
        for (i, (&y, weight)) in nodes.iter().zip(weights).enumerate() {
            let station = self.law.station(place(y))?;
            let (before, at) = match i {
                0 | 1 => (-0.5, *start),
                _ => (nodes[i - 2], strains[i - 2]),
            };
            let guess = match i {
                0 => *start,
                // Along the line through the last two.
                _ => {
                    let rise = (strains[i - 1] - at) / (nodes[i - 1] - before);
                    slope = slope.sup(&rise.abs());
                    strains[i - 1] + rise * (y - nodes[i - 1])
                }
            };
            let Some(Settled { shape, noise: rounding, softness: soft }) = stable(&station, &guess) else {
                return Ok(None);
            };
            if i == 0 {
                scale = natural_scale(&station);
            }
            noise = noise.max(rounding);
            softness.push(soft);
            scale = scale.sup(&shape.strain.abs());
            work += weight * shape.energy;
            if phases.last() != Some(&shape.phase) {
                phases.push(shape.phase);
            }
            strains.push(shape.strain);
        }
        let series: [Vec<f64>; 4] = std::array::from_fn(|c| {
            let values: Vec<f64> = strains.iter().map(|strain| strain[c]).collect();
            legendre::project(&values, nodes, weights, POINTS)
        });
        let element = Element { from, to, strains: series };
        let (begins, end) = (element.strain(from) - start, element.strain(to));
        let h = to - from;
        // Errors on an element far shorter than the ribbon hardly move it.
        let relief = (1e-4 * self.length / h).sqrt().max(1.0);
        // The Gauss points are rounded to this part of the element, and the strains with them.
        let misplaced = 4.0 * f64::EPSILON * from.abs().max(to.abs()) / h;
        let resolved = (0..4).all(|c| {
            let tail = &element.strains[c][POINTS - 2..];
            let tolerance = (relief * TOLERANCE * scale[c]).max(noise) + misplaced * slope[c];
            tail.iter().all(|t| t.abs() <= tolerance) && begins[c].abs() <= 1e3 * tolerance
        });
        // A gentle bifurcation hides in the rounding of the strains, but not from their names.
        let least = softness.iter().copied().fold(f64::INFINITY, f64::min);
        let bridged = phases.len() > 1 && least < SOFT;
        if !resolved || bridged || !stays_stable(&softness) {
            return Ok(None);
        }
        self.work += (to - from) * work;
        for phase in phases {
            if self.branch.phases.last() != Some(&phase) {
                self.branch.phases.push(phase);
            }
        }
        self.branch.elements.push(element);
        Ok(Some(end))
    }

    /// Goes over the end of a stable shape just beyond `s` to one after it.
    ///
    /// Close to a bifurcation its shapes are not told apart: the first place beyond where they are is taken.
    fn cross(&mut self, s: f64, end: f64, before: &Strain) -> Result<(f64, Strain), InvalidInput> {
        let phase = stable(&*self.law.station(s)?, before).map(|here| here.shape.phase);
        let mut gap = 4.0 * SHORTEST * self.length;
        loop {
            let to = if s + 2.0 * gap >= end { end } else { s + gap };
            // The growth may jump at the end.
            let station = self.law.station(to.next_down())?;
            let shapes = station.natural_shapes();
            let wide = gap >= WIDEST * self.length || to == end;
            let Some(near) = nearest(&station, &shapes, before).filter(|shape| shape.resolved || wide) else {
                if wide {
                    return Err(InvalidInput::new("S", s, "a section with a stable shape"));
                }
                gap *= 4.0;
                continue;
            };
            let continuous = distance(&station, &near.strain, before) < CONTINUOUS;
            let after = if continuous { *near } else { lowest(&station, &shapes, before).unwrap_or(*near) };
            if !continuous || Some(after.phase) != phase {
                let kind = if continuous { EventKind::Bifurcation } else { EventKind::Jump };
                let place = self.last_place(s, to, before, phase)?;
                self.branch.events.push(Event { s: place, kind, before: *before, after: after.strain });
            }
            // Over so short a gap a line will do; a jump is at its start.
            let left = if continuous { *before } else { after.strain };
            let line = |c: usize| {
                let (a, b) = (left[c], after.strain[c]);
                vec![0.5 * (a + b), (b - a) / 12f64.sqrt()]
            };
            self.branch.elements.push(Element { from: s, to, strains: std::array::from_fn(line) });
            self.work += (to - s) * after.energy;
            if self.branch.phases.last() != Some(&after.phase) {
                self.branch.phases.push(after.phase);
            }
            return Ok((to, after.strain));
        }
    }

    /// The last place to which the stable shape of this phase goes on, by bisection.
    fn last_place(
        &self,
        s: f64,
        to: f64,
        before: &Strain,
        phase: Option<Phase>,
    ) -> Result<f64, InvalidInput> {
        let (mut low, mut high, mut strain) = (s, to, *before);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            let station = self.law.station(middle)?;
            match stable(&station, &strain).map(|settled| settled.shape) {
                Some(shape)
                    if Some(shape.phase) == phase
                        && distance(&station, &shape.strain, before) < CONTINUOUS =>
                {
                    (low, strain) = (middle, shape.strain);
                }
                _ => high = middle,
            }
        }
        Ok(low)
    }
}

/// Whether the stiffness, given at the Gauss points of an element, stays positive in between: it is smooth, and
/// its polynomial has no zero.
fn stays_stable(softness: &[f64]) -> bool {
    let (nodes, weights) = legendre::rule(POINTS);
    let series = legendre::project(softness, nodes, weights, POINTS);
    let least = softness.iter().copied().fold(f64::INFINITY, f64::min);
    let smooth = series[POINTS - 2..].iter().all(|t| t.abs() <= (1e-3 * least).max(STIFFNESS_NOISE));
    let grid = (0..=4 * POINTS).map(|i| i as f64 / (4 * POINTS) as f64 - 0.5);
    smooth && grid.into_iter().all(|y| legendre::evaluate(&series, y) > -NEUTRAL)
}

/// Widest gap at a bifurcation over the length of the ribbon.
const WIDEST: f64 = 1e-6;

/// The stable shape to which Newton's method leads from these strains.
fn stable(station: &Station, strain: &Strain) -> Option<Settled> {
    natural::settle(station, strain).filter(|settled| settled.shape.section_index == 0)
}

/// The stable shapes; if there are none, those that stand for several.
fn candidates(shapes: &[Equilibrium]) -> impl Iterator<Item = &Equilibrium> {
    let any = shapes.iter().any(|shape| shape.section_index == 0);
    shapes.iter().filter(move |shape| if any { shape.section_index == 0 } else { !shape.resolved })
}

/// The candidate nearest in `K2` and `K3`; of equally near ones the first.
fn nearest<'a>(station: &Station, shapes: &'a [Equilibrium], strain: &Strain) -> Option<&'a Equilibrium> {
    let to = |shape: &Equilibrium| distance(station, &shape.strain, strain);
    let least = candidates(shapes).map(to).fold(f64::INFINITY, f64::min);
    candidates(shapes).find(|shape| to(shape) <= least * (1.0 + 1e-6))
}

/// The stable shape of lowest energy; of mirror images the nearest.
fn lowest(station: &Station, shapes: &[Equilibrium], strain: &Strain) -> Option<Equilibrium> {
    let lowest = candidates(shapes).map(|shape| shape.energy).fold(f64::INFINITY, f64::min);
    let level = lowest + 1e-9 * lowest.abs();
    let images: Vec<Equilibrium> =
        candidates(shapes).filter(|shape| shape.energy <= level).copied().collect();
    nearest(station, &images, strain).copied()
}

/// Distance in `K2` and `K3` over the local thickness ratio, relative beyond 1.
fn distance(station: &Station, a: &Strain, b: &Strain) -> f64 {
    let unit = station.section().eta() / station.width();
    let size = (a[2].abs().max(a[3].abs()) / unit).max(1.0);
    (a[2] - b[2]).abs().max((a[3] - b[3]).abs()) / (unit * size)
}

/// Sizes of the strains below which they do not matter: those at which the section's stiffness changes.
fn natural_scale(station: &Station) -> Strain {
    let eta = station.section().eta();
    station.reference(&Strain::new(eta * eta, eta * eta, eta, eta))
}
