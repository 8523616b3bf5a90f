//! Changes of class along an edge of the grid.

use super::class::{Class, stable};
use super::followed::{Stretch, place};
use super::plane::{Plane, scaled};
use crate::InvalidInput;
use crate::equilibrium::Equilibrium;

/// Most changes on an edge that are told apart; the rest of it then counts as the last.
const MOST: usize = 8;

/// How often places are proposed before bisection goes on alone.
const PROPOSED: usize = 6;

/// Steps of rounding along an edge: no place is known better.
const NARROWEST: f64 = 4.0 * f64::EPSILON;

/// A change of class.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing<C> {
    /// Where, in the unit square.
    pub at: [f64; 2],
    /// Class on the way there.
    pub before: C,
    /// Class from there on.
    pub after: C,
    /// How far the lowest state jumps, in `(K2, K3)` over the thickness ratio; near zero where it changes continuously.
    pub jump: f64,
}

/// All equilibria at a place of an edge.
#[derive(Clone)]
struct Known {
    t: f64,
    shapes: Vec<Equilibrium>,
    class: Class,
}

impl Known {
    fn is_blurred(&self) -> bool {
        stable(&self.shapes).any(|shape| !shape.resolved)
    }
}

/// The changes of class from one end of an edge to the other, to `tolerance` in the unit square, in their order.
///
/// Of two changes that undo each other none may be found.
pub fn crossings(
    plane: &Plane,
    edge: [[f64; 2]; 2],
    tolerance: f64,
) -> Result<Vec<Crossing<Class>>, InvalidInput> {
    let known = |t: f64| {
        let shapes = plane.shapes(place(edge, t))?;
        Ok::<_, InvalidInput>(Known { t, class: Class::of(&shapes), shapes })
    };
    let length = (edge[1][0] - edge[0][0]).hypot(edge[1][1] - edge[0][1]);
    let width = (tolerance / length).max(NARROWEST);
    let (mut here, end) = (known(0.0)?, known(1.0)?);
    let (start, mut found) = (here.class, Vec::new());
    for _ in 0..MOST {
        if here.class == end.class {
            break;
        }
        let (t, low, high) = change(plane, edge, [here, end.clone()], width, &known)?;
        let high = beyond_blur(high, &end, width, &known)?;
        let at = place(edge, t);
        if high.class != low.class {
            let jump = jump(plane, at, [&low, &high])?;
            found.push(Crossing { at, before: low.class, after: high.class, jump });
        }
        here = high;
    }
    // Whatever was lost on the way, the changes lead from one end to the other.
    match found.last_mut() {
        Some(last) => last.after = end.class,
        None if start != end.class => {
            found.push(Crossing { at: edge[1], before: start, after: end.class, jump: f64::NAN });
        }
        None => {}
    }
    Ok(found)
}

/// The first place from here on where the stable states are told apart from others: before, counts mean nothing.
fn beyond_blur(
    mut here: Known,
    end: &Known,
    width: f64,
    known: &impl Fn(f64) -> Result<Known, InvalidInput>,
) -> Result<Known, InvalidInput> {
    let mut step = width;
    while here.is_blurred() {
        if here.t + step >= end.t {
            return Ok(end.clone());
        }
        here = known(here.t + step)?;
        step *= 4.0;
    }
    Ok(here)
}

/// Where between two places of different class the class of the first ends, with what is on both sides.
fn change(
    plane: &Plane,
    edge: [[f64; 2]; 2],
    [mut low, mut high]: [Known; 2],
    width: f64,
    known: &impl Fn(f64) -> Result<Known, InvalidInput>,
) -> Result<(f64, Known, Known), InvalidInput> {
    let class = low.class;
    let narrow = |probe: Known, low: &mut Known, high: &mut Known| {
        let end = if probe.class == class { low } else { high };
        *end = probe;
    };
    for round in 0.. {
        if high.t - low.t <= width {
            break;
        }
        if round < PROPOSED {
            let ends = [low.t, high.t];
            let shapes = [low.shapes.clone(), high.shapes.clone()];
            let stretch = Stretch { plane, edge, ends, shapes: [&shapes[0], &shapes[1]] };
            for t in stretch.proposals(width) {
                if !(t > low.t && t < high.t) {
                    continue;
                }
                for side in [t - 0.49 * width, t + 0.49 * width] {
                    if side > low.t && side < high.t {
                        narrow(known(side)?, &mut low, &mut high);
                    }
                }
                if high.t - low.t <= width {
                    return Ok((t, low, high));
                }
            }
        }
        let middle = 0.5 * (low.t + high.t);
        if middle <= low.t || middle >= high.t {
            break;
        }
        narrow(known(middle)?, &mut low, &mut high);
    }
    Ok((0.5 * (low.t + high.t), low, high))
}

/// How far the lowest state is from the nearest of the lowest phase on the other side.
fn jump(plane: &Plane, at: [f64; 2], [low, high]: [&Known; 2]) -> Result<f64, InvalidInput> {
    let station = plane.station(at)?;
    let Some(first) = stable(&low.shapes).next() else { return Ok(f64::NAN) };
    let from = scaled(&station, &first.strain);
    let others = stable(&high.shapes).filter(|shape| Some(shape.phase) == high.class.lowest);
    let distances = others.map(|shape| {
        let to = scaled(&station, &shape.strain);
        (to[0] - from[0]).hypot(to[1] - from[1])
    });
    Ok(distances.fold(f64::NAN, f64::min))
}
