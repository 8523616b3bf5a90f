//! All branches that hang together with those that are known.

use super::between::at as at_length;
use super::branch::{BranchOf, Ended, Limits, Special, SpecialKind, SpecialOf};
use super::correct::{PointOf, difference, reversed};
use super::equations::{Equations, Stability, plus, scaled, unit};
use super::locate::{Found, special_points, values_between};
use super::switch::{FROM_THE_SIDE, Leaving, alike, leaving, leaving_with_section};
use super::value::at_value;
use super::walk::follow;

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

/// Follows the branches through some points, both ways where the range allows, and those that branch off, to a `depth`.
pub fn diagram<E: Equations>(
    equations: &mut E,
    starts: Vec<PointOf<E>>,
    depth: usize,
    limits: &Limits,
) -> Diagram<E> {
    let mut met: Vec<Met> = Vec::new();
    let mut branches: Vec<BranchOf<E>> = Vec::new();
    for start in starts {
        // What the branches so far reach is not followed anew.
        if passed(equations, &branches, &start) {
            continue;
        }
        let first = branches.len();
        let mut branch = both_ways(equations, start, limits, &met);
        mark_values::<E>(&mut branch, limits);
        note(equations, &branch, &mut met);
        branches.push(branch);
        let mut level = first..branches.len();
        for _ in 0..depth {
            let next = branches.len();
            for number in level {
                switch(equations, &mut branches, number, &mut met, limits);
            }
            level = next..branches.len();
        }
    }
    Diagram { branches }
}

/// The branch through a point.
fn both_ways<E: Equations>(
    equations: &mut E,
    start: PointOf<E>,
    limits: &Limits,
    met: &[Met],
) -> BranchOf<E> {
    let inside = start.t > 0.0 && start.t < 1.0;
    let ahead = walked(equations, start.clone(), limits, met);
    if !inside || ahead.ended[1] == Ended::Closed {
        return ahead;
    }
    let motions = start.stability.free_motions;
    let start = reversed(equations, start);
    let back = walked(equations, start, limits, met);
    let place = back.points.len() - 1;
    let [before, after] = [&back, &ahead].map(|half| half.points[0].stability.clone());
    let mut branch = joined(equations, back, ahead);
    // Where more motions change nothing than beside branches meet.
    let change = before.index.zip(after.index).map_or(0, |(before, after)| before.abs_diff(after));
    if motions > after.free_motions && change > 0 {
        let special = Special { kind: SpecialKind::BranchPoint, place, multiplicity: change, off: None };
        branch.special.push(special);
        branch.special.sort_by_key(|special| special.place);
    }
    branch
}

/// Follows what branches off a branch.
fn switch<E: Equations>(
    equations: &mut E,
    branches: &mut Vec<BranchOf<E>>,
    number: usize,
    met: &mut Vec<Met>,
    limits: &Limits,
) {
    let specials = branches[number].special.clone();
    for (i, special) in specials.into_iter().enumerate() {
        let at = branches[number].points[special.place].clone();
        let off = match special.kind {
            // Where two branches have met already, all there are are known.
            SpecialKind::BranchPoint if special.multiplicity > 1 || times_met(equations, met, &at) < 2 => {
                leaving(equations, &at, special.multiplicity, special.off, limits)
            }
            SpecialKind::SectionInstability => leaving_with_section(equations, &at, limits),
            _ => continue,
        };
        for Leaving { point, mirrored } in off {
            // Where a branch begins with more motions that change nothing than beside they lead to the same state, turned.
            let turned = at.stability.determinant.is_none() && (point.t - at.t).abs() < SAME_PARAMETER;
            let interrupted = limits.interrupted.is_some_and(|asks| asks());
            if turned || interrupted || passed(equations, branches, &point) {
                continue;
            }
            let (beginning, point, passed_over) = first_step(equations, &at, point, limits);
            let mut branch = walked(equations, point, limits, met);
            // It begins at the branch point itself.
            let before = passed_over.len() + 1;
            branch.special.iter_mut().for_each(|special| special.place += before);
            let special = passed_over.iter().zip(1..).map(|(found, place)| Special {
                kind: found.kind,
                place,
                multiplicity: found.multiplicity,
                off: None,
            });
            branch.special.splice(0..0, special);
            branch.points.splice(0..0, passed_over.into_iter().map(|found| found.point));
            branch.points.insert(0, beginning);
            branch.ended[0] = Ended::Switched;
            (branch.origin, branch.mirrored) = (Some((number, i)), mirrored);
            mark_values::<E>(&mut branch, limits);
            note(equations, &branch, met);
            branches.push(branch);
        }
    }
}

/// The branch point as a point of a branch that leaves it, the first point of that, and the special points between: nearer, where they could
/// not be told apart.
fn first_step<E: Equations>(
    equations: &mut E,
    at: &PointOf<E>,
    mut first: PointOf<E>,
    limits: &Limits,
) -> (PointOf<E>, PointOf<E>, Vec<Found<E>>) {
    let from = leaving_along(equations, at, &first);
    // At the branch point itself the index is that of neither side.
    while let Some(next) = at_length(equations, &from, &first, NEXT * first.s) {
        let passed = values_between(equations, &[&from, &next], limits).and_then(|mut found| {
            found.extend(special_points(equations, &next, &first, limits)?);
            Ok(found)
        });
        if let Ok(found) = passed {
            return (from, first, found);
        }
        let Some(nearer) = at_length(equations, &from, &first, 0.5 * first.s) else { break };
        if nearer.s < NEAREST {
            break;
        }
        first = nearer;
    }
    (from, first, Vec::new())
}

/// A branch point with the free motions of a branch that leaves it, and its tangent: the chord to the first point is the mean of that and the
/// one there.
fn leaving_along<E: Equations>(equations: &mut E, at: &PointOf<E>, first: &PointOf<E>) -> PointOf<E> {
    let along = if equations.on_one_mesh(&at.x, &first.x) {
        let change = difference(equations, at, first);
        let chord = unit(equations, &change);
        let along = plus(equations, &scaled(equations, &chord, 2.0), -1.0, &first.along);
        unit(equations, &along)
    } else {
        first.along.clone()
    };
    let free_motions = first.stability.free_motions;
    PointOf::<E> {
        along,
        s: 0.0,
        stability: Stability { free_motions, ..at.stability.clone() },
        ..at.clone()
    }
}

/// Change of the parameter that is none.
const SAME_PARAMETER: f64 = 1e-9;
/// A first step that is not shortened.
const NEAREST: f64 = 1e-3;

/// How far from a branch point stability is that of a branch that leaves it, of the first step.
const NEXT: f64 = 0.1;

/// Marks what already are points of a branch at values asked for, as its ends may be; where it leaves another that is marked there.
fn mark_values<E: Equations>(branch: &mut BranchOf<E>, limits: &Limits) {
    let own = usize::from(branch.origin.is_some());
    for (place, point) in branch.points.iter().enumerate().skip(own) {
        let known = |special: &SpecialOf<E>| special.place == place && special.kind == SpecialKind::Value;
        if limits.values.contains(&point.t) && !branch.special.iter().any(known) {
            branch.special.push(Special { kind: SpecialKind::Value, place, multiplicity: 1, off: None });
        }
    }
    branch.special.sort_by_key(|special| special.place);
}

/// What tells a branch point from others.
fn numbers<E: Equations>(equations: &mut E, point: &PointOf<E>) -> Vec<f64> {
    let mut numbers = equations.invariants(&point.x, point.t);
    numbers.push(point.t);
    numbers
}

/// How many branches have met at a branch point.
fn times_met<E: Equations>(equations: &mut E, met: &[Met], point: &PointOf<E>) -> usize {
    let here = numbers(equations, point);
    met.iter().find(|met| alike(&met.numbers, &here)).map_or(0, |met| met.branches)
}

/// A branch, that ends where it meets a known branch point from the side and would repeat its mirror image.
fn walked<E: Equations>(equations: &mut E, start: PointOf<E>, limits: &Limits, met: &[Met]) -> BranchOf<E> {
    follow(equations, start, limits, |equations, point, kind| {
        let from_the_side = kind == SpecialKind::BranchPoint && point.along.t.abs() < FROM_THE_SIDE;
        from_the_side && times_met(equations, met, point) > 0
    })
}

/// Notes the branch points of a branch.
fn note<E: Equations>(equations: &mut E, branch: &BranchOf<E>, met: &mut Vec<Met>) {
    let mut places: Vec<usize> = branch
        .special
        .iter()
        .filter(|special| special.kind == SpecialKind::BranchPoint)
        .map(|special| special.place)
        .collect();
    if branch.origin.is_some() {
        places.push(0);
    }
    let mut own: Vec<Vec<f64>> = Vec::new();
    for place in places {
        let here = numbers(equations, &branch.points[place]);
        // It may pass it more than once: as its mirror image, or round and round.
        if own.iter().any(|known| alike(known, &here)) {
            continue;
        }
        match met.iter_mut().find(|met| alike(&met.numbers, &here)) {
            Some(known) => known.branches += 1,
            None => met.push(Met { numbers: here.clone(), branches: 1 }),
        }
        own.push(here);
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
        .map(|point| PointOf::<E> { s: -point.s, ..reversed(equations, point) })
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
