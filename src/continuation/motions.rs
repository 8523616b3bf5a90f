//! What tells the tangent of a branch from motions that change nothing.

use super::equations::{Direction, Equations, dot, plus, scaled, unit};

/// Change of the parameter along a branch, of its arclength, above which it tells the branch from motions that change nothing.
const STEEP: f64 = 1e-4;

/// Motions that change nothing where the equations were linearised, and the tangent beside them.
pub struct Motions<C> {
    /// The motions, orthonormal.
    pub all: Vec<Direction<C>>,
    /// The unit tangent, if there are any.
    pub tangent: Option<Direction<C>>,
    /// What is mapped to nothing and is no motion either: wrenches.
    pub idle: Vec<C>,
}

impl<C> Default for Motions<C> {
    fn default() -> Self {
        Self { all: Vec::new(), tangent: None, idle: Vec::new() }
    }
}

impl<C: Clone> Motions<C> {
    /// Of all that is mapped to nothing, the motions that do not change the parameter, and the tangent of the branch at right angles to them,
    /// toward where a direction points. Where the parameter hardly changes along the branch that is nearest to the direction.
    pub fn apart<E: Equations<Change = C>>(
        equations: &E,
        lines: Vec<Direction<C>>,
        across: Option<&Direction<C>>,
        is_idle: impl Fn(&C, f64) -> bool,
    ) -> Self {
        let (mut basis, mut idle): (Vec<Direction<C>>, Vec<C>) = (Vec::new(), Vec::new());
        for mut line in lines {
            for other in basis.iter().chain(&basis) {
                line = plus(equations, &line, -dot(equations, other, &line), other);
            }
            if is_idle(&line.x, dot(equations, &line, &line)) {
                idle.push(line.x);
            } else {
                basis.push(unit(equations, &line));
            }
        }
        if basis.is_empty() {
            return Self { idle, ..Self::default() };
        }
        let ahead = |line: &Direction<C>| across.map_or(line.t, |across| dot(equations, across, line));
        let steep = basis.iter().map(|line| line.t * line.t).sum::<f64>().sqrt();
        let parts: Vec<f64> = if basis.len() == 1 {
            vec![1.0]
        } else if steep > STEEP {
            basis.iter().map(|line| line.t).collect()
        } else {
            basis.iter().map(ahead).collect()
        };
        let mut sum = scaled(equations, &basis[0], parts[0]);
        for (part, line) in parts.iter().zip(&basis).skip(1) {
            sum = plus(equations, &sum, *part, line);
        }
        let tangent = unit(equations, &sum);
        let tangent = scaled(equations, &tangent, ahead(&tangent).signum());
        let mut apart = vec![tangent.clone()];
        while apart.len() < basis.len() {
            // What is farthest from those known.
            let left = basis.iter().map(|line| beside(equations, line.clone(), &apart));
            let Some((_, farthest)) = left.max_by(|a, b| a.0.total_cmp(&b.0)) else { break };
            apart.push(farthest);
        }
        Self { all: apart.split_off(1), tangent: Some(tangent), idle }
    }

    /// The part of a direction at right angles to the motions.
    pub fn without<E: Equations<Change = C>>(
        &self,
        equations: &E,
        mut direction: Direction<C>,
    ) -> Direction<C> {
        for motion in &self.all {
            direction = plus(equations, &direction, -dot(equations, motion, &direction), motion);
        }
        direction
    }
}

/// The part of a line at right angles to others: its size, and the unit direction.
fn beside<E: Equations>(
    equations: &E,
    mut line: Direction<E::Change>,
    others: &[Direction<E::Change>],
) -> (f64, Direction<E::Change>) {
    line = unit(equations, &line);
    for other in others.iter().chain(others) {
        line = plus(equations, &line, -dot(equations, other, &line), other);
    }
    (dot(equations, &line, &line), unit(equations, &line))
}
