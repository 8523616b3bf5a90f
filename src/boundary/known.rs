//! Known shapes to start from: natural, straight, twisted, closed, or given.

use std::f64::consts::PI;

use nalgebra::{DMatrix, DVector, Quaternion, Vector3};

use super::ends::{At, Hold, directors};
use super::iterate::{Iterate, Layout, at_rest, settle};
use super::law::Law;
use super::mesh::Mesh;
use super::problem::Problem;
use super::step::Stepper;
use crate::InvalidInput;
use crate::equilibrium::natural_branches;
use crate::section::Strain;

type Vector = Vector3<f64>;

/// A shape to start from, at places from 0 to `L`.
#[derive(Clone, Debug)]
pub struct Guess {
    /// Places, ascending.
    pub s: Vec<f64>,
    /// Strains there.
    pub strains: Vec<Strain>,
    /// States there.
    pub states: Vec<At>,
    /// Whether their forces and moments are known; else they are those that fit the strains best.
    pub has_wrench: bool,
}

/// A known shape.
#[derive(Clone, Copy, Debug)]
pub enum Known<'a> {
    /// The natural shape, with an imperfection of this size.
    Natural(f64),
    /// Straight, or a closed circle, without the stress that this takes, with an imperfection of this size.
    Straight(f64),
    /// The same with the twist of its ends.
    Twisted(f64),
    /// One that is given.
    Given(&'a Guess),
}

/// Strains at any `S`.
type Strains<'p> = Box<dyn Fn(f64) -> Strain + 'p>;

/// The strains of a straight ribbon twisted by `turns`, or of a closed circle, at any `S`.
fn straight_strains(problem: &Problem, turns: f64) -> Strains<'_> {
    let length = problem.length;
    if problem.ends[1].hold == Hold::Closed {
        let (k, link) = (2.0 * PI / length, problem.ends[1].turns);
        return Box::new(move |s| {
            let psi = 2.0 * PI * link * s / length;
            Strain::new(0.0, k * psi.sin(), k * psi.cos(), 2.0 * PI * link / length)
        });
    }
    let twist = 2.0 * PI * turns / length;
    Box::new(move |s| {
        let straight = problem.law.at(s).map_or_else(|_| Strain::zeros(), |law| law.straight());
        straight + Strain::new(0.0, 0.0, 0.0, twist)
    })
}

/// The strains of the natural shape at any `S`.
fn natural_strains(problem: &Problem) -> Result<Strains<'_>, InvalidInput> {
    if !problem.law.varies() {
        let natural = problem.law.at(0.0)?.natural();
        return Ok(Box::new(move |_| natural));
    }
    if let Law::Relaxed(law) = &*problem.law
        && let Some(branch) = natural_branches(law, problem.length)?.into_iter().next()
    {
        return Ok(Box::new(move |s| branch.strain(s)));
    }
    Ok(Box::new(|s| problem.law.at(s).map_or_else(|_| Strain::zeros(), |law| law.natural())))
}

impl Known<'_> {
    /// The strains of the known shape at any `S`, without imperfection.
    ///
    /// # Errors
    /// Where a section is refused.
    pub fn strains<'s>(&'s self, problem: &'s Problem) -> Result<Strains<'s>, InvalidInput> {
        match self {
            Self::Straight(_) => Ok(straight_strains(problem, 0.0)),
            Self::Twisted(_) => Ok(straight_strains(problem, problem.twist().unwrap_or(0.0))),
            // Of a ribbon whose shape cannot be followed along it, the straight one will have to do.
            Self::Natural(_) => {
                Ok(natural_strains(problem).unwrap_or_else(|_| straight_strains(problem, 0.0)))
            }
            Self::Given(guess) => Ok(Box::new(|s| guess.strain(s))),
        }
    }

    /// The known shape on a mesh; not yet turned by the twist of its ends if it `winds` that up on the way.
    ///
    /// # Errors
    /// Where a section is refused.
    pub fn shape(&self, mesh: &Mesh, winds: bool) -> Result<Iterate, InvalidInput> {
        match self {
            Self::Natural(size) | Self::Straight(size) | Self::Twisted(size) => {
                shape_at_rest(mesh, &self.strains(&mesh.problem)?, *size, winds)
            }
            Self::Given(guess) => shape_of_guess(mesh, guess),
        }
    }
}

impl Guess {
    /// The place before which, and how far before which, `s` is.
    fn between(&self, s: f64) -> (usize, f64) {
        let i = self.s.partition_point(|&place| place <= s).clamp(1, self.s.len() - 1);
        (i, (s - self.s[i - 1]) / (self.s[i] - self.s[i - 1]))
    }

    fn strain(&self, s: f64) -> Strain {
        let (i, x) = self.between(s);
        self.strains[i - 1].lerp(&self.strains[i], x)
    }

    fn state(&self, s: f64) -> At {
        let (i, x) = self.between(s);
        let (a, b) = (&self.states[i - 1], &self.states[i]);
        At {
            position: a.position.lerp(&b.position, x),
            rotation: slerp(&a.rotation, &b.rotation, x),
            force: a.force.lerp(&b.force, x),
            about_origin: a.about_origin.lerp(&b.about_origin, x),
        }
    }
}

/// A slight bend and twist that favours no symmetry, positive on the whole: a rotation of [`IMPERFECTION`] over the
/// ribbon, but no curvature that is large against those at which a thin section changes its shape, and none that is stiff.
fn imperfection(problem: &Problem, natural: &Strain) -> Result<impl Fn(f64) -> Strain + use<>, InvalidInput> {
    let length = problem.length;
    let compliance = problem.law.at(0.0)?.compliance;
    // EI2 = eta^2/12 where EA = 1.
    let eta = if compliance[0] > 0.0 { (12.0 * compliance[0] / compliance[2]).sqrt() } else { f64::INFINITY };
    let curved = natural.rows(2, 2).amax() > 1e-3 * eta;
    let largest = eta * if curved { SLIGHT_IF_CURVED } else { SLIGHT };
    let size = (IMPERFECTION / length).min(largest);
    let soft = soft(&compliance);
    let clamped = problem.ends.iter().all(|end| end.hold.holds_rotation());
    Ok(move |s: f64| {
        let x = s / length;
        // Like the first buckle of such ends: both ways between clamps, else one way.
        let bend = if clamped { 0.3 + 0.2 * x - (2.0 * PI * x).cos() } else { 1.0 + 0.2 * x };
        let twist = 0.25 * (1.0 - 0.3 * x + (PI * x).cos());
        Strain::new(0.0, bend, bend, twist).component_mul(&soft) * size
    })
}

/// How much of a bend, either way, and of a twist is not stiff beside the softer bend: all of that about `d2` and of the twist, if that is not
/// much stiffer. What is as easy about `d2` is not bent about `d1`.
#[must_use]
pub fn soft(compliance: &Strain) -> Strain {
    let softest = compliance[1].max(compliance[2]);
    let share = compliance.map(|compliance| (compliance / (STIFF * softest)).min(1.0));
    let across = share[1] * (1.0 - compliance[2] / compliance[1]).max(0.0);
    Strain::new(0.0, across, share[2], share[3])
}

/// Curvature of an imperfection at most, over the thickness ratio: of a flat shape, and of one that has no symmetry
/// left to break.
const SLIGHT: f64 = 0.3;
const SLIGHT_IF_CURVED: f64 = 0.02;

/// A compliance that is stiff, of the softest.
const STIFF: f64 = 0.1;
/// Rotation over the whole ribbon that an imperfection of size 1 is of.
const IMPERFECTION: f64 = 0.2;

/// The shape at rest of these strains with an imperfection of this size.
fn shape_at_rest(mesh: &Mesh, strain: &Strains<'_>, size: f64, winds: bool) -> Result<Iterate, InvalidInput> {
    let problem = &mesh.problem;
    let flaw = imperfection(problem, &strain(0.5 * problem.length))?;
    let flawed = |s: f64| strain(s) + flaw(s) * size;
    let start = if winds { problem.ends[0] } else { problem.goal(&problem.ends[0]) };
    let mut nodes = vec![at_rest(start.position, start.rotation)];
    let mut stepper = Stepper::new(problem, mesh.gauss)?;
    for i in 0..mesh.elements() {
        let (s, h) = (mesh.nodes[i], mesh.length(i));
        let (at, _) = stepper.step(&nodes[i], s, h, |c| flawed(s + c * h), false)?;
        let unit = at.rotation * (1.0 / at.rotation.norm());
        nodes.push(at_rest(at.position, unit));
    }
    if start.hold == Hold::Free {
        // The end is where it belongs instead.
        let end = if winds { problem.ends[1] } else { problem.goal(&problem.ends[1]) };
        let last = nodes[mesh.elements()];
        let turn = end.rotation * last.rotation.conjugate();
        for node in &mut nodes {
            let away = Quaternion::from_imag(node.position - last.position);
            let position = end.position + (turn * away * turn.conjugate()).imag();
            *node = at_rest(position, turn * node.rotation);
        }
    }
    hang(mesh, &mut nodes);
    let places = (0..mesh.elements()).flat_map(|i| mesh.places(i));
    let strains = places.map(flawed).collect();
    Ok(Iterate { nodes, strains, slack: Default::default() })
}

/// The shape of a guess.
fn shape_of_guess(mesh: &Mesh, guess: &Guess) -> Result<Iterate, InvalidInput> {
    let nodes = mesh.nodes.iter().map(|&s| guess.state(s)).collect();
    let strains = (0..mesh.elements()).flat_map(|i| mesh.places(i)).map(|s| guess.strain(s)).collect();
    let mut x = Iterate { nodes, strains, slack: Default::default() };
    if !guess.has_wrench {
        fit_wrench(mesh, guess, &mut x)?;
    }
    Ok(x)
}

/// Gives a shape the force and moment at its start that, with the loads, fit its strains best by the law.
fn fit_wrench(mesh: &Mesh, guess: &Guess, x: &mut Iterate) -> Result<(), InvalidInput> {
    let units = mesh.problem.units()?;
    let layout = Layout::of(&mesh.problem);
    for node in &mut x.nodes {
        *node = at_rest(node.position, node.rotation);
    }
    settle(mesh, layout, x, 1.0);
    let count = x.nodes.len();
    let (mut rows, mut rhs) = (DMatrix::zeros(4 * count, 6), DVector::zeros(4 * count));
    for (i, (at, &s)) in x.nodes.iter().zip(&mesh.nodes).enumerate() {
        let response = mesh.problem.law.at(s)?;
        let resultants = |force: Vector, about_origin: Vector| {
            let at = At { force, about_origin, ..*at };
            let frame = directors(&at.rotation);
            let m = frame.tr_mul(&at.moment());
            let n = Strain::new(frame.column(2).dot(&force), m.x, m.y, m.z);
            // Strains over the whole ribbon, as the solver measures them.
            let strain = response.compliance.component_mul(&n);
            strain.component_mul(&Strain::new(1.0, units.length, units.length, units.length))
        };
        let strain = guess.strain(s);
        let scale = Strain::new(1.0, units.length, units.length, units.length);
        let wanted =
            response.value_alone(&strain).component_mul(&scale) - resultants(at.force, at.about_origin);
        rhs.rows_mut(4 * i, 4).copy_from(&wanted);
        for k in 0..3 {
            let unit = Vector::ith(k, 1.0);
            rows.view_mut((4 * i, k), (4, 1)).copy_from(&resultants(units.force * unit, Vector::zeros()));
            rows.view_mut((4 * i, 3 + k), (4, 1))
                .copy_from(&resultants(Vector::zeros(), units.moment * unit));
        }
    }
    // What the strains do not tell is left zero.
    let svd = rows.svd(true, true);
    let least = 1e-8 * svd.singular_values.max();
    if let Ok(fit) = svd.solve(&rhs, least) {
        let first = &mut x.nodes[0];
        first.force += units.force * Vector::new(fit[0], fit[1], fit[2]);
        first.about_origin += units.moment * Vector::new(fit[3], fit[4], fit[5]);
        if layout != Layout::Constant {
            let (force, about) = (first.force, first.about_origin);
            for node in &mut x.nodes[1..] {
                node.force += force;
                node.about_origin += about;
            }
        }
    }
    Ok(())
}

/// A shape that is free to turn about an axis, turned to where its load is lowest; `None` if it is not, or hardly turns.
#[must_use]
pub fn hung(mesh: &Mesh, x: &Iterate) -> Option<Guess> {
    let mut states = x.nodes.clone();
    let turn = hang(mesh, &mut states);
    let last = mesh.elements();
    let mut strains: Vec<Strain> = (0..last).map(|i| x.strain(mesh, i, 0.0)).collect();
    strains.push(x.strain(mesh, last - 1, 1.0));
    (turn > LEAST_TURN).then(|| Guess { s: mesh.nodes.clone(), strains, states, has_wrench: false })
}

/// Angle by which a shape hardly turns.
const LEAST_TURN: f64 = 1.0;

/// Turns a shape that is free to turn about an axis to where its load is lowest, and tells by what angle.
fn hang(mesh: &Mesh, nodes: &mut [At]) -> f64 {
    let problem = &mesh.problem;
    let [start, end] = [0, 1].map(|i| problem.ends[i].hold);
    let (first, last) = (nodes[0].position, nodes[mesh.elements()].position);
    let along = (last - first).try_normalize(0.0);
    let spins = |hold: Hold, axis: &Vector| match hold {
        Hold::Pinned => true,
        Hold::Hinged(director) => axis[director].abs() > 1.0 - 1e-12,
        _ => false,
    };
    let (axis, through) = match (start, end, along) {
        (Hold::Hinged(director), Hold::Free, _) => (Vector::ith(director, 1.0), first),
        (Hold::Free, Hold::Hinged(director), _) => (Vector::ith(director, 1.0), last),
        (_, _, Some(along)) if spins(start, &along) && spins(end, &along) => (along, first),
        _ => return 0.0,
    };
    // The work of all forces when the shape turns by phi is a cos phi + b sin phi.
    let (mut a, mut b) = (0.0, 0.0);
    let mut take = |position: &Vector, force: &Vector| {
        let arm = position - through;
        a += force.dot(&(arm - axis * axis.dot(&arm)));
        b += force.dot(&axis.cross(&arm));
    };
    for i in 0..mesh.elements() {
        let middle = 0.5 * (nodes[i].position + nodes[i + 1].position);
        let (p, _) = problem.line_load(0.5 * (mesh.nodes[i] + mesh.nodes[i + 1]));
        take(&middle, &(p * mesh.length(i)));
        if let Some((force, _)) = mesh.points[i + 1] {
            take(&nodes[i + 1].position, &force);
        }
    }
    for (hold, end, node) in [(start, &problem.ends[0], 0), (end, &problem.ends[1], mesh.elements())] {
        if hold == Hold::Free {
            take(&nodes[node].position, &end.force);
        }
    }
    let half = 0.5 * b.atan2(a);
    let turn = Quaternion::from_parts(half.cos(), axis * half.sin());
    for node in nodes.iter_mut() {
        let arm = Quaternion::from_imag(node.position - through);
        *node = at_rest(through + (turn * arm * turn.conjugate()).imag(), turn * node.rotation);
    }
    // A force at the free end is carried from the first: it is what holds the shape there.
    for (hold, end, node, outward) in
        [(start, &problem.ends[0], 0, -1.0), (end, &problem.ends[1], mesh.elements(), 1.0)]
    {
        if hold == Hold::Free {
            let (force, at) = (outward * end.force, nodes[node].position);
            for node in nodes.iter_mut() {
                (node.force, node.about_origin) = (force, at.cross(&force));
            }
        }
    }
    2.0 * half.abs()
}

/// The rotation between two, by the shorter way.
#[must_use]
pub fn slerp(a: &Quaternion<f64>, b: &Quaternion<f64>, x: f64) -> Quaternion<f64> {
    let w = b * a.conjugate();
    let w = if w.w < 0.0 { -w } else { w };
    let angle = w.imag().norm().atan2(w.w);
    let part = w.imag().try_normalize(0.0).map_or_else(
        || Quaternion::new(1.0, 0.0, 0.0, 0.0),
        |axis| Quaternion::from_parts((x * angle).cos(), axis * (x * angle).sin()),
    );
    part * a
}
