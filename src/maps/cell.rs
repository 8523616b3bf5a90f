//! Lines through a cell of the grid, from the changes of class around it.
//!
//! ```text
//!  3 --- edge 2 --- 2       Nodes and edges counterclockwise; around the cell every change separates
//!  |                |       two arcs of its border, each of one class. A line from change i to change j
//!  edge 3      edge 1       has the arcs between i and j, counterclockwise, on its right.
//!  |                |
//!  0 --- edge 0 --- 1
//! ```

/// A line between two points, with the classes beside it; `None` is outside of what is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment<C> {
    /// Numbers of points.
    pub ends: [usize; 2],
    /// On the left, seen from the first point to the second.
    pub left: Option<C>,
    /// On the right.
    pub right: Option<C>,
}

/// A change on the border of a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mark<C> {
    /// Number of its point.
    pub point: usize,
    /// The class that begins there, counterclockwise.
    pub after: C,
}

/// A rectangle, the classes at its corners and the changes along its edges.
#[derive(Clone, Debug)]
pub struct Cell<C> {
    /// Least and greatest coordinates, `[x, y]` each.
    pub corners: [[f64; 2]; 2],
    /// Classes of the nodes.
    pub nodes: [C; 4],
    /// Changes along the edges.
    pub edges: [Vec<Mark<C>>; 4],
}

/// The place of the centre: off the middle, where lines of symmetry may run.
const MIDDLE: f64 = 0.47;

impl<C: Copy + PartialEq> Cell<C> {
    /// All changes around the cell.
    pub fn ring(&self) -> Vec<Mark<C>> {
        self.edges.concat()
    }

    /// Where it is cut.
    pub fn centre(&self) -> [f64; 2] {
        let [low, high] = self.corners;
        std::array::from_fn(|axis| low[axis] + MIDDLE * (high[axis] - low[axis]))
    }

    /// Where a node is.
    pub fn place(&self, node: usize) -> [f64; 2] {
        let [low, high] = self.corners;
        [if matches!(node, 1 | 2) { high[0] } else { low[0] }, if node < 2 { low[1] } else { high[1] }]
    }
}

/// The lines through a cell, if its changes leave no choice: none, one, or two that do not meet.
pub fn certain<C: Copy + PartialEq>(ring: &[Mark<C>]) -> Option<Vec<Segment<C>>> {
    match ring {
        [] => Some(Vec::new()),
        [_, _] => Some(joined(ring.to_vec(), None)),
        // A band of one class between two others.
        [a, b, c, d] if (a.after == c.after) != (b.after == d.after) => Some(joined(ring.to_vec(), None)),
        _ => None,
    }
}

/// Lines that join all changes around a cell: those that can be joined in pairs, the rest at the point `meeting`.
pub fn joined<C: Copy + PartialEq>(mut ring: Vec<Mark<C>>, meeting: Option<usize>) -> Vec<Segment<C>> {
    let mut segments = Vec::new();
    while ring.len() > 2 {
        let n = ring.len();
        // An arc whose neighbours are of one class is cut off.
        let Some(i) = (0..n).find(|&i| ring[(i + n - 1) % n].after == ring[(i + 1) % n].after) else { break };
        let next = (i + 1) % n;
        segments.push(line(ring[i].point, ring[next].point, ring[next].after, ring[i].after));
        let mut cut = [i, next];
        cut.sort_unstable();
        ring.remove(cut[1]);
        ring.remove(cut[0]);
    }
    match (&ring[..], meeting) {
        ([a, b], _) => segments.push(line(a.point, b.point, b.after, a.after)),
        (rest, Some(meeting)) => {
            for (i, mark) in rest.iter().enumerate() {
                let before = rest[(i + rest.len() - 1) % rest.len()];
                segments.push(line(mark.point, meeting, before.after, mark.after));
            }
        }
        (_, None) => {}
    }
    segments
}

fn line<C>(from: usize, to: usize, left: C, right: C) -> Segment<C> {
    Segment { ends: [from, to], left: Some(left), right: Some(right) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ring(classes: &[u8]) -> Vec<Mark<u8>> {
        classes.iter().enumerate().map(|(point, &after)| Mark { point, after }).collect()
    }

    #[test]
    fn one_line_has_its_sides_right() {
        let lines = certain(&ring(&[1, 2])).unwrap();
        assert_eq!(lines, [Segment { ends: [0, 1], left: Some(2), right: Some(1) }]);
    }

    #[test]
    fn a_band_is_not_cut() {
        let lines = certain(&ring(&[5, 1, 5, 2])).unwrap();
        let inner: Vec<_> = lines.iter().map(|l| (l.ends, l.left, l.right)).collect();
        assert_eq!(inner, [([1, 2], Some(5), Some(1)), ([0, 3], Some(2), Some(5))]);
    }

    #[test]
    fn three_lines_meet_and_a_saddle_is_not_certain() {
        assert_eq!(certain(&ring(&[1, 2, 3])), None);
        assert_eq!(joined(ring(&[1, 2, 3]), Some(9)).len(), 3);
        assert_eq!(certain(&ring(&[1, 2, 1, 2])), None);
        assert_eq!(joined(ring(&[1, 2, 1, 2]), Some(9)).len(), 2);
    }
}
