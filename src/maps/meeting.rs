//! Lines inside a cell: it is quartered where they are not straight, and where they meet until that is known to a small
//! part of it.

use std::ops::Range;

use super::cell::{Cell, Mark, Segment, certain, joined};
use super::crossing::Crossing;
use crate::InvalidInput;

/// How often a cell is halved each way.
const DEEPEST: usize = 7;

/// How far a line may be from a straight one, in parts of a cell of the grid.
const STRAIGHT: f64 = 0.01;

/// Most quarterings within one cell of the grid.
const MOST: usize = 96;

/// What is asked for classes between the nodes of a grid.
pub trait Field<C>: Sync {
    /// The class at a point.
    ///
    /// # Errors
    /// If there is none.
    fn class(&self, at: [f64; 2]) -> Result<C, InvalidInput>;

    /// Its changes along an edge.
    ///
    /// # Errors
    /// If there is no class somewhere.
    fn crossings(&self, edge: [[f64; 2]; 2]) -> Result<Vec<Crossing<C>>, InvalidInput>;
}

/// Points on lines, and how far the lowest state jumps there.
#[derive(Clone, Debug, Default)]
pub struct Points {
    /// Where, in the unit square.
    pub at: Vec<[f64; 2]>,
    /// Not-a-number where lines meet and at nodes.
    pub jump: Vec<f64>,
}

impl Points {
    /// Adds a point and returns its number.
    pub fn add(&mut self, at: [f64; 2], jump: f64) -> usize {
        self.at.push(at);
        self.jump.push(jump);
        self.at.len() - 1
    }

    /// Drops all but the first.
    fn truncate(&mut self, count: usize) {
        self.at.truncate(count);
        self.jump.truncate(count);
    }
}

/// The lines through one cell, whose new points are numbered from those known on.
pub struct Meeting<'a, C> {
    field: Option<&'a dyn Field<C>>,
    known: &'a Points,
    /// Of the cell.
    corners: [[f64; 2]; 2],
    /// Points inside the cell.
    pub points: Points,
    /// Lines.
    pub segments: Vec<Segment<C>>,
    /// Places on the border of the cell where a class is that the changes there hide.
    pub hidden: Vec<[f64; 2]>,
    quarterings: usize,
}

impl<'a, C: Copy + PartialEq> Meeting<'a, C> {
    /// Joins the changes around a cell.
    pub fn of(
        cell: &Cell<C>,
        field: Option<&'a dyn Field<C>>,
        known: &'a Points,
    ) -> Result<Self, InvalidInput> {
        let (points, segments, corners) = (Points::default(), Vec::new(), cell.corners);
        let mut meeting =
            Self { field, known, corners, points, segments, hidden: Vec::new(), quarterings: 0 };
        meeting.resolve(cell, 0)?;
        Ok(meeting)
    }

    /// Joins the changes around a cell, or tells where on its border, inside the one of the grid, a class is that they hide: between two
    /// that undo each other.
    fn resolve(&mut self, cell: &Cell<C>, depth: usize) -> Result<Option<[f64; 2]>, InvalidInput> {
        let ring = cell.ring();
        if ring.is_empty() {
            return Ok(None);
        }
        let lines = certain(&ring);
        // Places where lines cross those by which it is cut in pairs.
        let mut hidden: Vec<[f64; 2]> = Vec::new();
        while let Some(field) = self.field
            && depth < DEEPEST
            && self.quarterings < MOST
        {
            let (points, segments) = (self.points.at.len(), self.segments.len());
            let centre = cell.centre();
            let quarters = match self.quarters(cell, field, &hidden)? {
                Ok(quarters) => quarters,
                Err(place) if self.is_on_grid(&place) => {
                    self.hidden.push(place);
                    break;
                }
                Err(place) => return Ok(Some(place)),
            };
            self.quarterings += 1;
            let first = self.known.at.len();
            let inside = first + points..first + self.points.at.len();
            let scale = f64::from(1u32 << depth);
            if lines.as_ref().is_some_and(|lines| self.are_straight(lines, cell, inside, scale)) {
                break;
            }
            let mut missed = None;
            for quarter in &quarters {
                missed = self.resolve(quarter, depth + 1)?;
                if missed.is_some() {
                    break;
                }
            }
            match missed {
                Some(place) if place[0] == centre[0] || place[1] == centre[1] => {
                    hidden.push(place);
                    self.points.truncate(points);
                    self.segments.truncate(segments);
                }
                missed => return Ok(missed),
            }
        }
        if let Some(lines) = lines {
            self.segments.extend(lines);
            return Ok(None);
        }
        let places: Vec<[f64; 2]> = ring.iter().map(|mark| self.place(mark.point)).collect();
        let mean = |i: usize| places.iter().map(|at| at[i]).sum::<f64>() / places.len() as f64;
        let meeting = self.add([mean(0), mean(1)], f64::NAN);
        self.segments.extend(joined(ring, Some(meeting)));
        Ok(None)
    }

    /// Whether a place is on the border of the cell of the grid.
    fn is_on_grid(&self, place: &[f64; 2]) -> bool {
        self.corners.iter().any(|corner| (0..2).any(|axis| corner[axis] == place[axis]))
    }

    /// Whether points inside a cell, of which `scale` make the width of one of the grid, are near its lines.
    fn are_straight(&self, lines: &[Segment<C>], cell: &Cell<C>, inside: Range<usize>, scale: f64) -> bool {
        let [low, high] = cell.corners;
        let size = [scale * (high[0] - low[0]), scale * (high[1] - low[1])];
        let scaled = |point: usize| -> [f64; 2] {
            let at = self.place(point);
            std::array::from_fn(|i| (at[i] - low[i]) / size[i])
        };
        // Both ends on one edge: what the line goes around is inside.
        let folded = |line: &Segment<C>| {
            let on = |edge: &Vec<Mark<C>>| edge.iter().filter(|mark| line.ends.contains(&mark.point)).count();
            cell.edges.iter().any(|edge| on(edge) == 2)
        };
        let near = |point: usize| {
            let distance = |line: &Segment<C>| {
                let ([a, b], p) = (line.ends.map(scaled), scaled(point));
                let (along, to) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
                (along[0] * to[1] - along[1] * to[0]).abs() / along[0].hypot(along[1]).max(f64::MIN_POSITIVE)
            };
            lines.iter().any(|line| distance(line) <= STRAIGHT)
        };
        !lines.iter().any(folded) && inside.into_iter().all(near)
    }

    /// The quarters of a cell, with lines through some places on what cuts it, or where on its border the field does not agree with the changes
    /// there.
    fn quarters(
        &mut self,
        cell: &Cell<C>,
        field: &dyn Field<C>,
        hidden: &[[f64; 2]],
    ) -> Result<Result<[Cell<C>; 4], [f64; 2]>, InvalidInput> {
        let ([low, high], centre) = (cell.corners, cell.centre());
        let middles = [[centre[0], low[1]], [high[0], centre[1]], [centre[0], high[1]], [low[0], centre[1]]];
        let mut halves: Vec<[Vec<Mark<C>>; 2]> = Vec::new();
        let mut at_middles = Vec::new();
        for (edge, middle) in middles.iter().enumerate() {
            let axis = edge % 2;
            let forward = edge < 2;
            let first = cell.edges[edge]
                .iter()
                .take_while(|mark| (self.place(mark.point)[axis] < middle[axis]) == forward)
                .count();
            let (a, b) = cell.edges[edge].split_at(first);
            let class = a.last().map_or(cell.nodes[edge], |mark| mark.after);
            if field.class(*middle)? != class {
                return Ok(Err(*middle));
            }
            halves.push([a.to_vec(), b.to_vec()]);
            at_middles.push(class);
        }
        let inside = field.class(centre)?;
        // From the middle of each edge to the centre, and back.
        let mut spokes = Vec::new();
        for (edge, middle) in middles.iter().enumerate() {
            let (mut there, mut back) = (Vec::new(), Vec::new());
            let (along, across) = (1 - edge % 2, edge % 2);
            let within = |place: &&[f64; 2]| {
                place[across] == centre[across]
                    && (place[along] - middle[along]) * (place[along] - centre[along]) < 0.0
            };
            let mut stops: Vec<[f64; 2]> = hidden.iter().filter(within).copied().collect();
            let away = |place: &[f64; 2]| (place[along] - middle[along]).abs();
            stops.sort_by(|a, b| away(a).total_cmp(&away(b)));
            let stops = [vec![*middle], stops, vec![centre]].concat();
            for part in stops.windows(2) {
                for crossing in field.crossings([part[0], part[1]])? {
                    let point = self.add(crossing.at, crossing.jump);
                    there.push(Mark { point, after: crossing.after });
                    back.insert(0, Mark { point, after: crossing.before });
                }
            }
            if there.last().map_or(at_middles[edge], |mark| mark.after) != inside {
                return Ok(Err(*middle));
            }
            spokes.push([there, back]);
        }
        // Quarter i has node i: its border runs from there along edge i, in, out, and along edge i - 1.
        Ok(Ok(std::array::from_fn(|i| {
            let before = (i + 3) % 4;
            let mut nodes = [cell.nodes[i], at_middles[i], inside, at_middles[before]];
            let mut edges = [
                halves[i][0].clone(),
                spokes[i][0].clone(),
                spokes[before][1].clone(),
                halves[before][1].clone(),
            ];
            nodes.rotate_right(i);
            edges.rotate_right(i);
            let node = cell.place(i);
            let corners = [
                [node[0].min(centre[0]), node[1].min(centre[1])],
                [node[0].max(centre[0]), node[1].max(centre[1])],
            ];
            Cell { corners, nodes, edges }
        })))
    }

    fn add(&mut self, at: [f64; 2], jump: f64) -> usize {
        self.known.at.len() + self.points.add(at, jump)
    }

    fn place(&self, point: usize) -> [f64; 2] {
        let known = self.known.at.len();
        if point < known { self.known.at[point] } else { self.points.at[point - known] }
    }
}
