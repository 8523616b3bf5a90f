//! All branches that hang together with those that are known.

use super::branch::{BranchOf, Ended, Limits, SpecialKind, follow};
use super::correct::PointOf;
use super::equations::{Equations, scaled};
use super::locate::at_value;
use super::switch::{alike, leaving, stepped};

/// Branches and their special points.
pub struct Diagram<E: Equations> {
    /// The branches, in the order in which they were found.
    pub branches: Vec<BranchOf<E>>,
}

/// A branch point that was met.
struct Met {
    numbers: Vec<f64>,
    branches: usize,
}

/// How near the numbers of two branch points are that are one: their places are known to less than this.
fn same(a: &[f64], b: &[f64]) -> bool {
    alike(a, b)
}

/// Follows the branches through some points, `both` ways if asked, and those that branch off, to a `depth`.
pub fn diagram<E: Equations>(
    equations: &mut E,
    starts: Vec<PointOf<E>>,
    both: bool,
    depth: usize,
    limits: &Limits,
) -> Diagram<E> {
    let mut met: Vec<Met> = Vec::new();
    let mut branches: Vec<BranchOf<E>> = Vec::new();
    let mut level: Vec<usize> = Vec::new();
    for start in starts {
        if passed(equations, &branches, &start) {
            continue;
        }
        let mut branch = walked(equations, start.clone(), limits, &met);
        if both && branch.ended[1] != Ended::Closed {
            let turned = PointOf::<E> { along: scaled(equations, &start.along, -1.0), ..start };
            let back = walked(equations, turned, limits, &met);
            branch = joined(equations, back, branch);
        }
        level.push(branches.len());
        branches.push(branch);
    }
    for generation in 0..=depth {
        for &number in &level {
            note(equations, &branches[number], number, &mut met);
        }
        if generation == depth {
            break;
        }
        let mut next = Vec::new();
        for number in level {
            let places: Vec<_> = branches[number].special.iter().cloned().enumerate().collect();
            for (i, special) in places {
                let at = branches[number].points[special.place].clone();
                let off = match special.kind {
                    SpecialKind::BranchPoint => {
                        let mut numbers = equations.invariants(&at.x, at.t);
                        numbers.push(at.t);
                        // Where two branches have met already, all there are are known.
                        if met.iter().any(|m| {
                            m.branches > 1 && special.multiplicity == 1 && same(&m.numbers, &numbers)
                        }) {
                            continue;
                        }
                        leaving(equations, &at, special.multiplicity, limits)
                    }
                    SpecialKind::SectionInstability => {
                        let Some(direction) = equations.section_direction(&at.x, at.t) else { continue };
                        let first = stepped(equations, &at, &direction, limits);
                        first
                            .map(|point| super::switch::Leaving { point, mirrored: true })
                            .into_iter()
                            .collect()
                    }
                    _ => continue,
                };
                for leaving in off {
                    if limits.interrupted.is_some_and(|asks| asks())
                        || passed(equations, &branches, &leaving.point)
                    {
                        continue;
                    }
                    let mut branch = walked(equations, leaving.point, limits, &met);
                    // The branch begins at the branch point itself.
                    branch.points.iter_mut().for_each(|point| point.s += 0.0);
                    branch.points.insert(0, at.clone());
                    branch.points[0].s = 0.0;
                    branch.special.iter_mut().for_each(|special| special.place += 1);
                    branch.ended[0] = Ended::Switched;
                    branch.origin = Some((number, i));
                    branch.mirrored = leaving.mirrored;
                    note(equations, &branch, branches.len(), &mut met);
                    next.push(branches.len());
                    branches.push(branch);
                }
            }
        }
        level = next;
    }
    Diagram { branches }
}

/// A branch, that ends where it meets a known branch point from the side and would repeat its mirror image.
fn walked<E: Equations>(equations: &mut E, start: PointOf<E>, limits: &Limits, met: &[Met]) -> BranchOf<E> {
    let first = start.s;
    follow(equations, start, limits, |equations, point, kind| {
        let turns = kind == SpecialKind::BranchPoint && point.along.t.abs() < 1e-3;
        let mut numbers = equations.invariants(&point.x, point.t);
        numbers.push(point.t);
        turns && point.s > first && met.iter().any(|m| same(&m.numbers, &numbers))
    })
}

/// Notes the branch points of a branch.
fn note<E: Equations>(equations: &mut E, branch: &BranchOf<E>, _number: usize, met: &mut Vec<Met>) {
    for special in branch.special.iter().filter(|special| special.kind == SpecialKind::BranchPoint) {
        let point = &branch.points[special.place];
        let mut numbers = equations.invariants(&point.x, point.t);
        numbers.push(point.t);
        match met.iter_mut().find(|m| same(&m.numbers, &numbers)) {
            Some(known) => known.branches += 1,
            None => met.push(Met { numbers, branches: 1 }),
        }
    }
}

/// Whether a branch passes through a point, or its mirror image.
fn passed<E: Equations>(equations: &mut E, branches: &[BranchOf<E>], point: &PointOf<E>) -> bool {
    let here = equations.invariants(&point.x, point.t);
    for pair in branches.iter().flat_map(|branch| branch.points.windows(2)) {
        let (a, b) = (&pair[0], &pair[1]);
        if (a.t - point.t) * (b.t - point.t) > 0.0 || a.t == b.t {
            continue;
        }
        let [from, to] = [a, b].map(|point| equations.invariants(&point.x, point.t));
        // Between those of the ends, or not far beyond.
        let near = here.iter().zip(from.iter().zip(&to)).all(|(x, (a, b))| {
            let (low, high) = (a.min(*b), a.max(*b));
            let beyond = high - low + 1e-6 * (1.0 + high.abs());
            (low - beyond..=high + beyond).contains(x)
        });
        if near
            && let Some(there) = at_value(equations, a, b, point.t)
            && alike(&here, &equations.invariants(&there.x, there.t))
        {
            return true;
        }
    }
    false
}

/// A branch from its two halves, which begin at the same point.
fn joined<E: Equations>(equations: &E, back: BranchOf<E>, ahead: BranchOf<E>) -> BranchOf<E> {
    let shift = back.points.len() - 1;
    let mut points: Vec<PointOf<E>> = back
        .points
        .into_iter()
        .skip(1)
        .rev()
        .map(|point| PointOf::<E> { along: scaled(equations, &point.along, -1.0), s: -point.s, ..point })
        .collect();
    points.extend(ahead.points);
    let mut special: Vec<_> = back
        .special
        .into_iter()
        .rev()
        .map(|mut special| {
            special.place = shift - special.place;
            special
        })
        .collect();
    special.extend(ahead.special.into_iter().map(|mut special| {
        special.place += shift;
        special
    }));
    let [_, before] = back.ended;
    let [_, after] = ahead.ended;
    BranchOf::<E> { points, special, ended: [before, after], origin: None, mirrored: false }
}
