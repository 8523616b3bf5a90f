//! The lines between the classes of a grid, and around what is known of it.

use std::collections::HashMap;

use super::cell::{Cell, Mark, Segment};
use super::chain::chains;
use super::crossing::Crossing;
use super::grid::each;
use super::meeting::{Field, Meeting, Points};
use crate::InvalidInput;

/// Classes at the nodes of a grid and their changes along its edges, `None` where they are not known.
///
/// Node `(i, j)` at `xs[i]`, `ys[j]` is number `j nx + i`; so is the edge from it along `x` among `(nx - 1) ny`
/// with `j (nx - 1) + i`, and that along `y` among `nx (ny - 1)` with `j nx + i`.
#[derive(Clone, Debug)]
pub struct Nodes<'a, C> {
    /// Coordinates, ascending.
    pub xs: &'a [f64],
    /// Coordinates, ascending.
    pub ys: &'a [f64],
    /// Classes.
    pub classes: &'a [Option<C>],
    /// Changes along edges in the direction of `x`.
    pub along_x: &'a [Option<Vec<Crossing<C>>>],
    /// Changes along edges in the direction of `y`.
    pub along_y: &'a [Option<Vec<Crossing<C>>>],
}

/// Points in the unit square with one class on each side.
#[derive(Clone, Debug)]
pub struct Polyline<C> {
    /// Points.
    pub points: Vec<[f64; 2]>,
    /// How far the lowest state jumps at each; not-a-number where lines meet and on the border.
    pub jumps: Vec<f64>,
    /// Class on the left, walking along it; `None` is outside of what is known.
    pub left: Option<C>,
    /// Class on the right.
    pub right: Option<C>,
}

/// All lines of a map.
pub type Outline<C> = Vec<Polyline<C>>;

/// A place on an edge of the grid where a class is that the changes along it hide: between two that undo each other.
#[derive(Clone, Copy, Debug)]
pub struct Hidden {
    /// Both nodes of the edge, `(i, j)`.
    pub edge: [(usize, usize); 2],
    /// Where, in the unit square.
    pub at: [f64; 2],
}

/// The lines between the classes, and around the cells of which all nodes and edges are known, and what was seen to be hidden.
///
/// Where several lines meet in a cell it is quartered, if a field is given that knows the classes inside.
///
/// # Errors
/// As those of the field.
pub fn outline<C: Copy + PartialEq + Send + Sync>(
    nodes: &Nodes<'_, C>,
    field: Option<&dyn Field<C>>,
) -> Result<(Outline<C>, Vec<Hidden>), InvalidInput> {
    let mut points = Points::default();
    let mut number = |edges: &[Option<Vec<Crossing<C>>>]| -> Vec<usize> {
        let mut first = Vec::with_capacity(edges.len());
        for edge in edges {
            first.push(points.at.len());
            for crossing in edge.iter().flatten() {
                points.add(crossing.at, crossing.jump);
            }
        }
        first
    };
    let (first_x, first_y) = (number(nodes.along_x), number(nodes.along_y));
    let (nx, ny) = (nodes.xs.len(), nodes.ys.len());
    let cell = |i: usize, j: usize| nodes.cell(i, j, &first_x, &first_y);
    let mut segments = border(nodes, cell, &mut points);
    let places = (0..ny - 1).flat_map(|j| (0..nx - 1).map(move |i| (i, j)));
    let mixed: Vec<((usize, usize), Cell<C>)> = places
        .filter(|&(i, j)| !nodes.is_plain(i, j))
        .filter_map(|(i, j)| Some(((i, j), cell(i, j)?)))
        .collect();
    let known = &points;
    let met = each(mixed.len(), |i| {
        let (place, cell) = &mixed[i];
        let meeting = Meeting::of(cell, field, known)?;
        let hidden = meeting.hidden.into_iter().map(|at| nodes.hidden(*place, at)).collect::<Vec<_>>();
        Ok::<_, InvalidInput>((meeting.points, meeting.segments, hidden))
    });
    let (mut inside, mut hidden) = (Points::default(), Vec::new());
    let known = points.at.len();
    for one in met {
        let (new, lines, unseen) = one?;
        hidden.extend(unseen);
        let shift = inside.at.len();
        inside.at.extend(new.at);
        inside.jump.extend(new.jump);
        segments.extend(lines.into_iter().map(|line| Segment {
            ends: line.ends.map(|point| if point < known { point } else { point + shift }),
            ..line
        }));
    }
    points.at.extend(inside.at);
    points.jump.extend(inside.jump);
    let polylines = chains(&segments).into_iter().map(|chain| Polyline {
        points: chain.points.iter().map(|&i| points.at[i]).collect(),
        jumps: chain.points.iter().map(|&i| points.jump[i]).collect(),
        left: chain.left,
        right: chain.right,
    });
    Ok((polylines.collect(), hidden))
}

impl<C: Copy + PartialEq> Nodes<'_, C> {
    /// What is hidden on the border of a cell.
    fn hidden(&self, (i, j): (usize, usize), at: [f64; 2]) -> Hidden {
        let edge = if at[1] == self.ys[j] {
            [(i, j), (i + 1, j)]
        } else if at[1] == self.ys[j + 1] {
            [(i, j + 1), (i + 1, j + 1)]
        } else if at[0] == self.xs[i] {
            [(i, j), (i, j + 1)]
        } else {
            [(i + 1, j), (i + 1, j + 1)]
        };
        Hidden { edge, at }
    }

    /// Numbers of the edges of a cell, those along `x` and those along `y`.
    fn edges(&self, i: usize, j: usize) -> ([usize; 2], [usize; 2]) {
        let nx = self.xs.len();
        ([j * (nx - 1) + i, (j + 1) * (nx - 1) + i], [j * nx + i, j * nx + i + 1])
    }

    fn around(&self, i: usize, j: usize) -> impl Iterator<Item = &Option<Vec<Crossing<C>>>> {
        let (x, y) = self.edges(i, j);
        x.map(|k| &self.along_x[k]).into_iter().chain(y.map(|k| &self.along_y[k]))
    }

    /// Whether nothing changes along the edges of a cell, as far as it is known.
    fn is_plain(&self, i: usize, j: usize) -> bool {
        self.around(i, j).all(|edge| edge.as_ref().is_none_or(Vec::is_empty))
    }

    /// Whether all of a cell is known; an edge is known only if both its nodes are.
    fn is_known(&self, i: usize, j: usize) -> bool {
        self.around(i, j).all(Option::is_some)
    }

    /// A cell, if all of it is known.
    fn cell(&self, i: usize, j: usize, first_x: &[usize], first_y: &[usize]) -> Option<Cell<C>> {
        let nx = self.xs.len();
        let node = |i: usize, j: usize| self.classes[j * nx + i];
        let forward = |edges: &[Option<Vec<Crossing<C>>>], first: &[usize], k: usize| {
            let marks = edges[k].as_ref()?.iter().enumerate();
            Some(marks.map(|(i, change)| Mark { point: first[k] + i, after: change.after }).collect())
        };
        let backward = |edges: &[Option<Vec<Crossing<C>>>], first: &[usize], k: usize| {
            let marks = edges[k].as_ref()?.iter().enumerate().rev();
            Some(marks.map(|(i, change)| Mark { point: first[k] + i, after: change.before }).collect())
        };
        let ([below, above], [left, right]) = self.edges(i, j);
        Some(Cell {
            corners: [[self.xs[i], self.ys[j]], [self.xs[i + 1], self.ys[j + 1]]],
            nodes: [node(i, j)?, node(i + 1, j)?, node(i + 1, j + 1)?, node(i, j + 1)?],
            edges: [
                forward(self.along_x, first_x, below)?,
                forward(self.along_y, first_y, right)?,
                backward(self.along_x, first_x, above)?,
                backward(self.along_y, first_y, left)?,
            ],
        })
    }
}

/// The edges between a cell that is known and none.
fn border<C: Copy + PartialEq>(
    nodes: &Nodes<'_, C>,
    cell: impl Fn(usize, usize) -> Option<Cell<C>>,
    points: &mut Points,
) -> Vec<Segment<C>> {
    let (mx, my) = (nodes.xs.len() - 1, nodes.ys.len() - 1);
    let mut corners: HashMap<(usize, usize), usize> = HashMap::new();
    let mut segments = Vec::new();
    // Below the first row and left of the first column the numbers wrap, and are not known.
    let known = |i: usize, j: usize| i < mx && j < my && nodes.is_known(i, j);
    for (i, j) in (0..my).flat_map(|j| (0..mx).map(move |i| (i, j))) {
        let neighbours = [(i, j.wrapping_sub(1)), (i + 1, j), (i, j + 1), (i.wrapping_sub(1), j)];
        if !known(i, j) || neighbours.iter().all(|&(i, j)| known(i, j)) {
            continue;
        }
        let Some(cell) = cell(i, j) else { continue };
        let grid = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)];
        for (side, (ni, nj)) in neighbours.into_iter().enumerate() {
            if known(ni, nj) {
                continue;
            }
            let mut corner = |node: usize| {
                let place = cell.place(node);
                *corners.entry(grid[node]).or_insert_with(|| points.add(place, f64::NAN))
            };
            let (mut from, to) = (corner(side), corner((side + 1) % 4));
            let mut class = cell.nodes[side];
            for mark in &cell.edges[side] {
                segments.push(Segment { ends: [from, mark.point], left: Some(class), right: None });
                (from, class) = (mark.point, mark.after);
            }
            segments.push(Segment { ends: [from, to], left: Some(class), right: None });
        }
    }
    segments
}
