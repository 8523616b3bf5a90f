//! A map: all nodes, then the changes along the edges between those that differ, some rows at a time.

use std::collections::HashSet;

use super::class::{Class, Sample};
use super::crossing::{Crossing, crossings};
use super::followed::place;
use super::meeting::Field;
use super::outline::{Hidden, Nodes, Outline, outline};
use super::plane::Plane;
use super::progress::Progress;
use crate::InvalidInput;

/// Rows of nodes that are done, with their edges, before the next ones are begun.
const BAND: usize = 8;

/// Where an edge is sampled for hidden changes: not in its middle, where lines of symmetry may run.
const LOOKS: [f64; 5] = [0.0, 0.23, 0.47, 0.74, 1.0];

/// Changes along edges, as [`Nodes`] has them.
pub type Edges = Vec<Option<Vec<Crossing<Class>>>>;

/// Which states are stable over the unit square.
#[derive(Clone, Debug)]
pub struct PhaseMap {
    /// At the nodes, row after row of `x`; `None` where the map was stopped before.
    pub samples: Vec<Option<Sample>>,
    /// Changes along edges in the direction of `x`.
    pub along_x: Edges,
    /// Changes along edges in the direction of `y`.
    pub along_y: Edges,
    /// Lines between the classes, and around what is done.
    pub outline: Outline<Class>,
}

/// The ribbons with a tolerance: classes between the nodes.
struct Refined<'a> {
    plane: &'a Plane,
    tolerance: f64,
}

impl Field<Class> for Refined<'_> {
    fn class(&self, at: [f64; 2]) -> Result<Class, InvalidInput> {
        Ok(Class::of(&self.plane.shapes(at)?))
    }

    fn crossings(&self, edge: [[f64; 2]; 2]) -> Result<Vec<Crossing<Class>>, InvalidInput> {
        crossings(self.plane, edge, self.tolerance)
    }
}

/// Finds the stable states at `xs[i]`, `ys[j]` in the unit square and where they change, to `tolerance` in it.
///
/// On all cores with the feature `rayon`; the result is the same, bit for bit, on any number of them.
///
/// # Errors
/// If the section law refuses a ribbon of the plane.
///
/// # Example
/// Edge growth up to `10 eta^2` with chirality up to `omega = 1/2`.
/// ```
/// use ribbonrs::{growth::Growth, maps::{Plane, Progress, phase_map}, section::{Amplitude, RibbonSpec}};
/// let corner = |xi: f64, d: f64| RibbonSpec {
///     growth: vec![(Amplitude::Constant(xi), Growth::edge(1.0)), (Amplitude::Constant(d), Growth::chiral(1.0))],
///     ..RibbonSpec::uniform(0.1, Growth::default())
/// };
/// let plane = Plane::new([corner(0.0, 0.0), corner(0.1, 0.0), corner(0.0, 0.1), corner(0.1, 0.1)])?;
/// let t: Vec<f64> = (0..=4).map(|i| f64::from(i) / 4.0).collect();
/// let map = phase_map(&plane, &t, &t, 1e-10, &Progress::default())?;
/// // Without chirality the flat ribbon bends.
/// let change = &map.along_x[1].as_ref().unwrap()[0];
/// assert!((10.0 * change.at[0] - (259f64.sqrt() - 7.0) / 2.0).abs() < 1e-9);
/// # Ok::<(), ribbonrs::InvalidInput>(())
/// ```
pub fn phase_map(
    plane: &Plane,
    xs: &[f64],
    ys: &[f64],
    tolerance: f64,
    progress: &Progress,
) -> Result<PhaseMap, InvalidInput> {
    let (nx, ny) = (xs.len(), ys.len());
    if nx < 2 || ny < 2 {
        return Err(InvalidInput::new("shape", format!("{nx} x {ny}"), "at least two nodes each way"));
    }
    let refined = Refined { plane, tolerance };
    let mut samples: Vec<Option<Sample>> = Vec::with_capacity(nx * ny);
    let mut along_x: Edges = vec![None; (nx - 1) * ny];
    let mut along_y: Edges = vec![None; nx * (ny - 1)];
    for first in (0..ny).step_by(BAND) {
        if progress.is_stopped() {
            break;
        }
        let rows = first..(first + BAND).min(ny);
        let nodes = each(rows.len() * nx, |k| {
            if progress.is_stopped() {
                return Ok(None);
            }
            let at = [xs[k % nx], ys[rows.start + k / nx]];
            let sample = Sample::of(&plane.shapes(at)?);
            progress.count(1);
            Ok(Some(sample))
        });
        for node in nodes {
            samples.push(node?);
        }
        // Edges of these rows, and those up to the first from the row before.
        let in_x = rows.clone().flat_map(|j| (0..nx - 1).map(move |i| [(i, j), (i + 1, j)]));
        let below = rows.start.saturating_sub(1)..rows.end - 1;
        let in_y = below.flat_map(|j| (0..nx).map(move |i| [(i, j), (i, j + 1)]));
        let mut changing = Vec::new();
        for edge in in_x.chain(in_y) {
            let class = |(i, j): (usize, usize)| samples[j * nx + i].map(|sample| sample.class);
            let [from, to] = edge;
            match (class(from), class(to)) {
                (Some(a), Some(b)) if a != b => changing.push(edge),
                (Some(_), Some(_)) => *slot(&mut along_x, &mut along_y, nx, edge) = Some(Vec::new()),
                _ => {}
            }
        }
        let places = each(changing.len(), |k| {
            if progress.is_stopped() {
                return Ok(None);
            }
            refined.crossings(changing[k].map(|(i, j)| [xs[i], ys[j]])).map(Some)
        });
        for (edge, found) in changing.into_iter().zip(places) {
            *slot(&mut along_x, &mut along_y, nx, edge) = found?;
        }
    }
    samples.resize(nx * ny, None);
    if !progress.is_stopped() {
        find_hidden(&refined, xs, ys, &mut along_x, &mut along_y)?;
    }
    let classes: Vec<Option<Class>> = samples.iter().map(|one| one.map(|sample| sample.class)).collect();
    let field = (!progress.is_stopped()).then_some(&refined as &dyn Field<Class>);
    for round in 0.. {
        let nodes = Nodes { xs, ys, classes: &classes, along_x: &along_x, along_y: &along_y };
        let (outline, hidden) = outline(&nodes, field)?;
        if hidden.is_empty() || round == MOST_ROUNDS || progress.is_stopped() {
            return Ok(PhaseMap { samples, along_x, along_y, outline });
        }
        for Hidden { edge, at } in hidden {
            let changes = slot(&mut along_x, &mut along_y, nx, edge);
            let known = changes.take().unwrap_or_default();
            *changes = Some(beside(&refined, edge.map(|(i, j)| [xs[i], ys[j]]), &known, at)?);
        }
        find_hidden(&refined, xs, ys, &mut along_x, &mut along_y)?;
    }
    unreachable!("the last round returns")
}

/// How often lines are drawn anew since one was seen to cross an edge twice.
const MOST_ROUNDS: usize = 3;

/// The changes along an edge that are known, and those beside a place that was not.
fn beside(
    refined: &Refined<'_>,
    edge: [[f64; 2]; 2],
    known: &[Crossing<Class>],
    at: [f64; 2],
) -> Result<Vec<Crossing<Class>>, InvalidInput> {
    let axis = usize::from(edge[0][0] == edge[1][0]);
    // Between all that are known, and there.
    let between = |pair: &[Crossing<Class>]| std::array::from_fn(|i| 0.5 * (pair[0].at[i] + pair[1].at[i]));
    let mut stops: Vec<[f64; 2]> = known.windows(2).map(between).collect();
    stops.extend([edge[0], at, edge[1]]);
    stops.sort_by(|a, b| a[axis].total_cmp(&b[axis]));
    stops.dedup();
    let mut changes = Vec::new();
    for part in stops.windows(2) {
        changes.extend(refined.crossings([part[0], part[1]])?);
    }
    Ok(changes)
}

/// Looks beside the lines found for places where they cross an edge twice between its nodes.
///
/// Edges without a change that are on cells with one are sampled between their nodes, as long as that finds more.
fn find_hidden(
    refined: &Refined<'_>,
    xs: &[f64],
    ys: &[f64],
    along_x: &mut Edges,
    along_y: &mut Edges,
) -> Result<(), InvalidInput> {
    let (nx, ny) = (xs.len(), ys.len());
    let mut looked = HashSet::new();
    loop {
        let mut beside = Vec::new();
        for (i, j) in (0..ny - 1).flat_map(|j| (0..nx - 1).map(move |i| (i, j))) {
            let nodes = [(i, j), (i + 1, j), (i, j + 1), (i + 1, j + 1)];
            let edges = [[0, 1], [2, 3], [0, 2], [1, 3]].map(|edge| edge.map(|node| nodes[node]));
            let plain = edges.map(|edge| slot(along_x, along_y, nx, edge).as_ref().is_none_or(Vec::is_empty));
            if plain.contains(&false) {
                let new = edges.into_iter().zip(plain).filter(|&(edge, plain)| plain && looked.insert(edge));
                beside.extend(new.map(|(edge, _)| edge));
            }
        }
        let found = each(beside.len(), |k| {
            let edge = beside[k].map(|(i, j)| [xs[i], ys[j]]);
            let mut changes = Vec::new();
            for part in LOOKS.windows(2) {
                changes.extend(refined.crossings([part[0], part[1]].map(|t| place(edge, t)))?);
            }
            Ok::<_, InvalidInput>(changes)
        });
        let mut any = false;
        for (edge, changes) in beside.into_iter().zip(found) {
            let changes = changes?;
            any |= !changes.is_empty();
            *slot(along_x, along_y, nx, edge) = Some(changes);
        }
        if !any {
            return Ok(());
        }
    }
}

/// Where the changes along an edge from one node to the next are kept.
fn slot<'a>(
    along_x: &'a mut Edges,
    along_y: &'a mut Edges,
    nx: usize,
    [(i, j), (_, next)]: [(usize, usize); 2],
) -> &'a mut Option<Vec<Crossing<Class>>> {
    if next == j { &mut along_x[j * (nx - 1) + i] } else { &mut along_y[j * nx + i] }
}

/// The values of a function at 0, 1, ... in their order, on all cores with the feature `rayon`.
pub(super) fn each<T: Send>(count: usize, f: impl Fn(usize) -> T + Sync + Send) -> Vec<T> {
    #[cfg(feature = "rayon")]
    {
        use rayon::prelude::*;
        (0..count).into_par_iter().map(f).collect()
    }
    #[cfg(not(feature = "rayon"))]
    (0..count).map(f).collect()
}
