//! The unknowns of the boundary-value problem, and how they change.

use nalgebra::{Quaternion, Vector3};

use super::chain::Slack;
use super::ends::{At, Units};
use super::mesh::Mesh;
use super::problem::Problem;
use crate::frame::Twist;
use crate::section::Strain;

type Vector = Vector3<f64>;

/// Which resultants are states that vary along the ribbon; the others are constants but for known jumps.
///
/// | loads | states | constants |
/// |---|---|---|
/// | at ends and points | `r`, `q` | `N`, `M + r x N` |
/// | distributed | `r`, `q`, `M + r x N` | `N` |
/// | any | `r`, `q`, `M + r x N`, `N` | none |
///
/// A quaternion changes by a rotation, three numbers, and keeps its norm: a system of 7 states has 6 unknowns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layout {
    /// 7 states.
    Constant,
    /// 10 states.
    Moment,
    /// 13 states.
    Full,
}

impl Layout {
    /// The fewest states that the loads of a problem need.
    #[must_use]
    pub fn of(problem: &Problem) -> Self {
        if problem.has_line_force() { Self::Moment } else { Self::Constant }
    }

    /// Places, among the changes of `r`, rotation, `N` and `M + r x N` (three each), of the states.
    #[must_use]
    pub fn states(self) -> &'static [usize] {
        match self {
            Self::Constant => &[0, 1, 2, 3, 4, 5],
            Self::Moment => &[0, 1, 2, 3, 4, 5, 9, 10, 11],
            Self::Full => &[0, 1, 2, 3, 4, 5, 9, 10, 11, 6, 7, 8],
        }
    }

    /// Places of the constants.
    #[must_use]
    pub fn constants(self) -> &'static [usize] {
        match self {
            Self::Constant => &[6, 7, 8, 9, 10, 11],
            Self::Moment => &[6, 7, 8],
            Self::Full => &[],
        }
    }
}

/// States at the nodes, right of point loads, and strains at the stages.
#[derive(Clone, Debug)]
pub struct Iterate {
    /// At the nodes.
    pub nodes: Vec<At>,
    /// At the stages, element by element.
    pub strains: Vec<Strain>,
    /// By how much the end may miss where a condition follows from the others: zero but for the error of the mesh.
    pub slack: Slack,
}

/// A change of an [`Iterate`], in the units of the problem.
#[derive(Clone, Debug)]
pub struct Correction {
    /// Of `r`, rotation, `N`, `M + r x N` at the nodes.
    pub nodes: Vec<[f64; 12]>,
    /// Of the strains.
    pub strains: Vec<Strain>,
    /// Of the slack.
    pub slack: Slack,
}

impl Iterate {
    /// The iterate moved by `fraction` of a correction.
    #[must_use]
    pub fn moved(&self, by: &Correction, fraction: f64, units: &Units) -> Self {
        let vector = |change: &[f64; 12], i| Vector::new(change[i], change[i + 1], change[i + 2]) * fraction;
        let node = |(at, change): (&At, &[f64; 12])| {
            let turn = Twist { angular: vector(change, 3), linear: Vector::zeros() };
            let rotation = turn.exponential().0 * at.rotation;
            At {
                position: at.position + units.length * vector(change, 0),
                rotation: rotation * (1.5 - 0.5 * rotation.norm_squared()),
                force: at.force + units.force * vector(change, 6),
                about_origin: at.about_origin + units.moment * vector(change, 9),
            }
        };
        let strains = self.strains.iter().zip(&by.strains).map(|(e, change)| e + fraction * change);
        let nodes = self.nodes.iter().zip(&by.nodes).map(node).collect();
        Self {
            nodes,
            strains: strains.collect(),
            slack: std::array::from_fn(|i| self.slack[i] + fraction * by.slack[i]),
        }
    }

    /// The correction that moves this iterate to another on the same mesh.
    #[must_use]
    pub fn difference(&self, to: &Self, units: &Units) -> Correction {
        let node = |(from, to): (&At, &At)| {
            let shift = (to.position - from.position) / units.length;
            let turn = rotation_vector(&(to.rotation * from.rotation.conjugate()));
            let force = (to.force - from.force) / units.force;
            let moment = (to.about_origin - from.about_origin) / units.moment;
            let parts = [shift, turn, force, moment];
            std::array::from_fn(|i| parts[i / 3][i % 3])
        };
        let strains = self.strains.iter().zip(&to.strains).map(|(from, to)| to - from);
        Correction {
            nodes: self.nodes.iter().zip(&to.nodes).map(node).collect(),
            strains: strains.collect(),
            slack: std::array::from_fn(|i| to.slack[i] - self.slack[i]),
        }
    }

    /// Strains at `x` in [0, 1] of an element, by the polynomial through its stages.
    #[must_use]
    pub fn strain(&self, mesh: &Mesh, element: usize, x: f64) -> Strain {
        let s = mesh.gauss.degree;
        let basis = mesh.gauss.basis(x);
        let strains = &self.strains[element * s..(element + 1) * s];
        strains.iter().zip(basis).map(|(e, l)| e * l).sum()
    }
}

/// The rotation vector of a unit quaternion, of at most half a turn.
fn rotation_vector(q: &Quaternion<f64>) -> Vector {
    let (sine, sense) = (q.imag().norm(), 1_f64.copysign(q.w));
    let half = sine.atan2(q.w.abs());
    q.imag() * (2.0 * sense * if sine > 1e-8 { half / sine } else { 1.0 })
}

impl Correction {
    /// The correction times a factor.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        Self {
            nodes: self.nodes.iter().map(|change| change.map(|x| factor * x)).collect(),
            strains: self.strains.iter().map(|e| factor * e).collect(),
            slack: self.slack.map(|x| factor * x),
        }
    }

    /// The sum with `factor` times another.
    #[must_use]
    pub fn plus(&self, factor: f64, other: &Self) -> Self {
        let node = |(a, b): (&[f64; 12], &[f64; 12])| std::array::from_fn(|i| a[i] + factor * b[i]);
        let strains = self.strains.iter().zip(&other.strains).map(|(a, b)| a + factor * b);
        Self {
            nodes: self.nodes.iter().zip(&other.nodes).map(node).collect(),
            strains: strains.collect(),
            slack: std::array::from_fn(|i| self.slack[i] + factor * other.slack[i]),
        }
    }

    /// What a change after this one changes this one by: with `x` moved by it, `x` is moved by their sum. Of rotation vectors
    /// `w`, `v` that is `v - w x v/2 + w x (w x v)/12` but for terms of the fourth order in `w`.
    #[must_use]
    pub fn before(&self, change: &Self) -> Self {
        let node = |(by, change): (&[f64; 12], &[f64; 12])| {
            let [w, v] = [by, change].map(|c| Vector::new(c[3], c[4], c[5]));
            let across = w.cross(&v);
            let turn = v - 0.5 * across + w.cross(&across) / 12.0;
            std::array::from_fn(|i| if (3..6).contains(&i) { turn[i - 3] } else { change[i] })
        };
        let nodes = self.nodes.iter().zip(&change.nodes).map(node).collect();
        Self { nodes, strains: change.strains.clone(), slack: change.slack }
    }

    /// The change on another mesh, joined by lines between nodes.
    #[must_use]
    pub fn on(&self, from: &Mesh, to: &Mesh) -> Self {
        let node = |&s: &f64| {
            let i = from.nodes.partition_point(|&node| node <= s).clamp(1, from.elements()) - 1;
            let part = (s - from.nodes[i]) / from.length(i);
            let (a, b) = (&self.nodes[i], &self.nodes[i + 1]);
            std::array::from_fn(|k| a[k] + part * (b[k] - a[k]))
        };
        let strains = super::adapt::transferred_strains(&self.strains, from, to);
        Self { nodes: to.nodes.iter().map(node).collect(), strains, slack: self.slack }
    }

    /// Size: root mean square, over the length, of changes of position/L, angles, `eps` and `K L`.
    #[must_use]
    pub fn norm(&self, mesh: &Mesh) -> f64 {
        self.dot(self, mesh).sqrt()
    }

    /// The scalar product that belongs to the norm.
    #[must_use]
    pub fn dot(&self, other: &Self, mesh: &Mesh) -> f64 {
        self.dot_over(other, mesh, mesh.problem.length)
    }

    /// The same with curvatures over this length, on meshes of ribbons of any.
    #[must_use]
    pub fn dot_over(&self, other: &Self, mesh: &Mesh, length: f64) -> f64 {
        let s = mesh.gauss.degree;
        let mut sum = 0.0;
        for i in 0..mesh.elements() {
            let pose = |node: usize| {
                let pairs = self.nodes[node][..6].iter().zip(&other.nodes[node]);
                pairs.map(|(x, y)| x * y).sum::<f64>()
            };
            let mut local = 0.5 * (pose(i) + pose(i + 1));
            let own = i * s..(i + 1) * s;
            let pairs = self.strains[own.clone()].iter().zip(&other.strains[own]);
            for ((a, b), weight) in pairs.zip(&mesh.gauss.weights) {
                local += weight * (a[0] * b[0] + length * length * a.rows(1, 3).dot(&b.rows(1, 3)));
            }
            sum += local * mesh.length(i) / mesh.problem.length;
        }
        sum
    }
}

impl Correction {
    /// Whether it is a change of force and moment alone, but for rounding, if its pose and strains have this square.
    #[must_use]
    pub fn is_idle(&self, square: f64) -> bool {
        let wrench = |change: &[f64; 12]| change[6..].iter().map(|x| x * x).sum::<f64>();
        let most = self.nodes.iter().map(wrench).fold(0.0, f64::max);
        square.is_nan() || square <= IDLE * IDLE * most
    }
}

/// Change of pose, of that of force and moment, that is rounding.
const IDLE: f64 = 1e-8;

/// Makes what is known but for its value at the start follow from that: the force everywhere, whatever the layout, for
/// dead loads are given; and the moment about the origin, if no force is distributed. `load` is the factor of the loads.
pub fn settle(mesh: &Mesh, layout: Layout, x: &mut Iterate, load: f64) {
    for i in 0..mesh.elements() {
        let (mut force, mut about_origin) = (x.nodes[i].force, x.nodes[i].about_origin);
        let h = mesh.length(i) * load;
        for ((p, c), weight) in mesh.load(i).iter().zip(&mesh.gauss.weights) {
            force -= h * weight * p;
            about_origin -= h * weight * c;
        }
        let next = &mut x.nodes[i + 1];
        if let Some((f, m)) = mesh.points[i + 1] {
            force -= load * f;
            about_origin -= load * (next.position.cross(&f) + m);
        }
        next.force = force;
        if layout == Layout::Constant {
            next.about_origin = about_origin;
        }
    }
}

/// Size of a strain: that of `eps` and `K L`.
#[must_use]
pub fn strain_size(e: &Strain, length: f64) -> f64 {
    let k = Vector::new(e[1], e[2], e[3]).norm() * length;
    e[0].hypot(k)
}

/// A pose and wrench at rest.
#[must_use]
pub fn at_rest(position: Vector, rotation: Quaternion<f64>) -> At {
    At { position, rotation, force: Vector::zeros(), about_origin: Vector::zeros() }
}
