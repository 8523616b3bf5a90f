//! Segments to polylines.

use std::collections::HashMap;

use super::cell::Segment;

/// Points in a row with one class on each side.
#[derive(Clone, Debug, PartialEq)]
pub struct Chain<C> {
    /// Numbers of points; the first is the last of a closed one.
    pub points: Vec<usize>,
    /// Class on the left; `None` is outside of what is known.
    pub left: Option<C>,
    /// Class on the right.
    pub right: Option<C>,
}

/// Joins segments with the same classes beside them wherever exactly two meet.
pub fn chains<C: Copy + PartialEq>(segments: &[Segment<C>]) -> Vec<Chain<C>> {
    let mut pairs: Vec<(Option<C>, Option<C>)> = Vec::new();
    // Of each segment the pair and its ends, turned as the first of its pair.
    let mut turned: Vec<(usize, [usize; 2])> = Vec::new();
    for segment in segments {
        let (sides, [from, to]) = ((segment.left, segment.right), segment.ends);
        if let Some(pair) = pairs.iter().position(|&known| known == sides) {
            turned.push((pair, [from, to]));
        } else if let Some(pair) = pairs.iter().position(|&known| known == (sides.1, sides.0)) {
            turned.push((pair, [to, from]));
        } else {
            pairs.push(sides);
            turned.push((pairs.len() - 1, [from, to]));
        }
    }
    let mut starting: HashMap<(usize, usize), Vec<usize>> = HashMap::new();
    let mut ending: HashMap<(usize, usize), usize> = HashMap::new();
    for (i, &(pair, [from, to])) in turned.iter().enumerate() {
        starting.entry((pair, from)).or_default().push(i);
        *ending.entry((pair, to)).or_default() += 1;
    }
    let next = |i: usize| {
        let (pair, [_, to]) = turned[i];
        match starting.get(&(pair, to)).map(Vec::as_slice) {
            Some(&[next]) if ending.get(&(pair, to)) == Some(&1) => Some(next),
            _ => None,
        }
    };
    let mut continues = vec![false; turned.len()];
    for i in 0..turned.len() {
        if let Some(next) = next(i) {
            continues[next] = true;
        }
    }
    let mut used = vec![false; turned.len()];
    let mut found = Vec::new();
    // First those with ends, then what is closed.
    let order = (0..turned.len()).filter(|&i| !continues[i]).chain(0..turned.len());
    for first in order {
        if used[first] {
            continue;
        }
        let (pair, [from, _]) = turned[first];
        let mut points = vec![from];
        let mut here = Some(first);
        while let Some(i) = here.filter(|&i| !used[i]) {
            used[i] = true;
            points.push(turned[i].1[1]);
            here = next(i);
        }
        let (left, right) = pairs[pair];
        found.push(Chain { points, left, right });
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn open_closed_and_met_lines() {
        let segment = |a: usize, b: usize, left: u8, right: u8| Segment {
            ends: [a, b],
            left: Some(left),
            right: Some(right),
        };
        // 0-1-2 of one pair, the second given backwards; a triangle of another, turned like which 3-2 comes back.
        let segments = [
            segment(0, 1, 1, 2),
            segment(2, 1, 2, 1),
            segment(5, 6, 3, 1),
            segment(6, 7, 3, 1),
            segment(7, 5, 3, 1),
            segment(2, 3, 1, 3),
        ];
        let found = chains(&segments);
        let points: Vec<_> = found.iter().map(|chain| chain.points.clone()).collect();
        assert_eq!(points, [vec![0, 1, 2], vec![3, 2], vec![5, 6, 7, 5]]);
    }
}
