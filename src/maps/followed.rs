//! Where along an edge a change may be, from single states that are followed: proposals, not proofs.
//!
//! | change | function of the place | |
//! |---|---|---|
//! | a symmetric state loses stability | least stiffness, which changes its sign | pitchfork |
//! | a state gets another name | `abs(K2)` or `abs(K3)` less the least that has a name | no bifurcation |
//! | a state ends | square of its least stiffness, which falls to zero like a line | fold |
//!
//! Where two states exchange the lowest energy, or nothing here helps, bisection does.

use super::class::stable;
use super::plane::{Plane, scaled};
use super::root::{bracketed, ending};
use crate::equilibrium::{Equilibrium, PHASE_TOLERANCE, settle};
use crate::section::Strain;

/// A state that moves farther than this in `K/eta`, relative beyond 1, over an edge is taken for another one.
const FARTHEST: f64 = 0.5;

/// A stretch of an edge of the grid, with all equilibria at its ends.
pub struct Stretch<'a> {
    /// The ribbons.
    pub plane: &'a Plane,
    /// The edge.
    pub edge: [[f64; 2]; 2],
    /// The ends of the stretch, from 0 to 1 along the edge.
    pub ends: [f64; 2],
    /// All equilibria there.
    pub shapes: [&'a [Equilibrium]; 2],
}

/// A state somewhere on a stretch.
#[derive(Clone, Copy)]
struct Followed {
    strain: Strain,
    energy: f64,
    /// Least eigenvalue of the scaled Hessian over the greatest.
    softness: f64,
    stable: bool,
    /// `K2` and `K3` over the thickness ratio.
    curvatures: [f64; 2],
}

/// The point at `t` along an edge.
pub fn place([from, to]: [[f64; 2]; 2], t: f64) -> [f64; 2] {
    std::array::from_fn(|i| if t == 1.0 { to[i] } else { from[i] + t * (to[i] - from[i]) })
}

impl Stretch<'_> {
    /// Places, to `width`, where the class may change.
    pub fn proposals(&self, width: f64) -> impl Iterator<Item = f64> {
        let states: [Vec<Followed>; 2] = [0, 1].map(|end| self.stable(end));
        // Each kind only if those before did not do; a state of the far end is followed back.
        (0..3).flat_map(move |kind| {
            let each = |find: &dyn Fn(usize, &Followed) -> Option<f64>| -> Vec<f64> {
                let ends = states.iter().enumerate();
                ends.flat_map(|(end, states)| states.iter().filter_map(move |one| find(end, one))).collect()
            };
            match kind {
                0 => each(&|end, state| self.loses_stability(end, state, width)),
                1 => self.renamed(&states, width),
                _ => each(&|end, state| self.ends(end, state, width)),
            }
        })
    }

    /// The stable states at an end, lowest energy first, one of mirror images.
    fn stable(&self, end: usize) -> Vec<Followed> {
        let mut states: Vec<Followed> = Vec::new();
        for shape in stable(self.shapes[end]) {
            let Some(state) = self.settled(self.ends[end], &shape.strain) else { continue };
            let same = |other: &Followed| {
                let pairs = [(other.energy, state.energy), (other.softness, state.softness)];
                pairs.iter().all(|(a, b)| (a - b).abs() <= 1e-9 * a.abs().max(b.abs()))
            };
            if !states.iter().any(same) {
                states.push(state);
            }
        }
        states
    }

    fn settled(&self, t: f64, start: &Strain) -> Option<Followed> {
        let station = self.plane.station(place(self.edge, t)).ok()?;
        let settled = settle(&station, start)?;
        Some(Followed {
            strain: settled.shape.strain,
            energy: settled.shape.energy,
            softness: settled.softness,
            stable: settled.shape.section_index == 0,
            curvatures: scaled(&station, &settled.shape.strain),
        })
    }

    /// The state at `t` to which one leads that is not far.
    fn near(&self, t: f64, from: &Followed) -> Option<Followed> {
        let state = self.settled(t, &from.strain)?;
        let moved = |i: usize| (state.curvatures[i] - from.curvatures[i]).abs();
        let size = from.curvatures.iter().fold(1.0, |size: f64, k| size.max(k.abs()));
        (moved(0).max(moved(1)) <= FARTHEST * size).then_some(state)
    }

    /// A state at one end that is still there, unstable, at the other.
    fn loses_stability(&self, end: usize, state: &Followed, width: f64) -> Option<f64> {
        let other = self.near(self.ends[1 - end], state)?;
        // What keeps its symmetry through the change is not bent, or not twisted, at both ends.
        let kept = (0..2).any(|i| state.curvatures[i] == 0.0 && other.curvatures[i] == 0.0);
        if other.stable || !kept {
            return None;
        }
        self.bracketed(width, |t| Some(self.between(t, [state, &other], end)?.softness))
    }

    /// Where the bending or the twist of the lowest state begins to count.
    fn renamed(&self, states: &[Vec<Followed>; 2], width: f64) -> Vec<f64> {
        let Some(state) = states[0].first() else { return Vec::new() };
        let Some(other) = self.near(self.ends[1], state) else { return Vec::new() };
        let named = |i: usize| {
            self.bracketed(width, |t| {
                let state = self.between(t, [state, &other], 0)?;
                Some(state.curvatures[i].abs() - PHASE_TOLERANCE)
            })
        };
        (0..2).filter_map(named).collect()
    }

    /// Where a state that is not there, or not stable, at the other end ends.
    fn ends(&self, end: usize, state: &Followed, width: f64) -> Option<f64> {
        let far = self.ends[1 - end];
        if self.near(far, state).is_some_and(|other| other.stable) {
            return None;
        }
        let mut last = *state;
        let softness_squared = |t: f64| {
            let found = self.near(t, &last).filter(|found| found.stable)?;
            last = found;
            Some(found.softness * found.softness)
        };
        ending(softness_squared, self.ends[end], far, width)
    }

    /// The state at `t` between what it is at the ends, of which the first may be either.
    fn between(&self, t: f64, mut states: [&Followed; 2], first: usize) -> Option<Followed> {
        if first == 1 {
            states.swap(0, 1);
        }
        let u = (t - self.ends[0]) / (self.ends[1] - self.ends[0]);
        self.settled(t, &(states[0].strain * (1.0 - u) + states[1].strain * u))
    }

    fn bracketed(&self, width: f64, f: impl FnMut(f64) -> Option<f64>) -> Option<f64> {
        bracketed(f, self.ends[0], self.ends[1], width)
    }
}
