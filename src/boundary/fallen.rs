//! From an unstable state to a stable one.

use std::f64::consts::PI;
use std::sync::Arc;

use super::creep::crept_from;
use super::iterate::Iterate;
use super::known::{Guess, Known, hung, soft};
use super::mesh::Mesh;
use super::meshes::adapted;
use super::newton::Failed;
use super::path::Stride;
use super::problem::Problem;
use super::report::Status;
use super::solve::{Settings, Solved, first_turn, followed, goal, unfinished};
use super::spent::Spent;
use super::step::Stepper;
use super::system::System;
use crate::InvalidInput;
use crate::section::Strain;

/// The stable state that an unstable one falls into when it is disturbed, if one of some disturbances leads to one, or that a viscous
/// ribbon creeps to; else the unstable one. All is to cost little.
pub fn fallen(
    problem: &Arc<Problem>,
    settings: &Settings,
    unstable: Solved,
    spent: &mut Spent,
) -> Result<Solved, InvalidInput> {
    // Between clamps also from the straight, twisted ribbon, bent anew.
    let straight = BOWS.into_iter().filter(|_| problem.twist().is_some());
    let fine = Mesh::new(problem, unstable.nodes.clone(), settings.degree)?;
    let bent = straight.chain(DISTURBANCES).map(|how| disturbed(&fine, &unstable.x, &how));
    // And as it is, turned about the line of its ends.
    for guess in hung(&fine, &unstable.x).map(Ok).into_iter().chain(bent) {
        spent.allowed = spent.work + LITTLE_WORK;
        let guess = guess?;
        // As from any guess: on a coarse mesh first, which is quick and takes large steps.
        let known = Known::Given(&guess);
        let nodes = problem.first_nodes(settings.first_elements as f64, first_turn(problem, &known)?);
        let mesh = Mesh::new(problem, nodes, settings.degree)?;
        let stride = Stride { step: 1.0, most: 1.0, careful: false, again: false };
        let (mesh, reached) = followed(settings, mesh, &known, stride, spent)?;
        // Who asks to stop asks once.
        if reached.failure == Some(Failed::Interrupted) {
            return Ok(unfinished(mesh, reached, spent));
        }
        if reached.failure.is_none() {
            let mut solved = adapted(settings, mesh, reached.x, spent)?;
            if solved.report.status == Status::Interrupted {
                return Ok(solved);
            }
            if solved.report.status.is_solved() && !is_unstable(problem, settings, &mut solved)? {
                return Ok(solved);
            }
        }
    }
    spent.allowed = spent.work + SOME_WORK;
    let mesh = Mesh::new(problem, unstable.nodes.clone(), settings.degree)?;
    let (mesh, reached) = crept_from(settings, mesh, unstable.x.clone(), spent)?;
    if reached.failure == Some(Failed::Interrupted) {
        return Ok(unfinished(mesh, reached, spent));
    }
    if reached.failure.is_none() {
        let mut solved = adapted(settings, mesh, reached.x, spent)?;
        let found = solved.report.status.is_solved() && !is_unstable(problem, settings, &mut solved)?;
        if found || solved.report.status == Status::Interrupted {
            return Ok(solved);
        }
    }
    Ok(unstable)
}

/// A disturbance: half waves, and signs, in bending and in twist, and its size in radians over the ribbon.
#[derive(Clone, Copy)]
pub struct Disturbance {
    /// Whether it is one of the straight, twisted ribbon, in place of the state.
    of_straight: bool,
    bend: f64,
    twist: f64,
    size: f64,
}

const fn wave(bend: f64, twist: f64) -> Disturbance {
    Disturbance { of_straight: false, bend, twist, size: 2.0 }
}

const fn bow(bend: f64, twist: f64, size: f64) -> Disturbance {
    Disturbance { of_straight: true, bend, twist, size }
}

/// Of the straight ribbon.
pub const BOWS: [Disturbance; 3] = [bow(2.0, 0.0, 6.0), bow(0.5, 0.0, 4.0), bow(1.0, 1.0, 4.0)];

/// Of a state.
pub const DISTURBANCES: [Disturbance; 8] = [
    wave(0.5, 0.0),
    wave(1.0, 1.0),
    wave(1.0, -2.0),
    wave(2.0, 1.0),
    wave(-1.0, 2.0),
    wave(3.0, -1.0),
    wave(2.0, 3.0),
    wave(0.5, 0.5),
];

/// The shape of the disturbed strains, from the start.
pub fn disturbed(mesh: &Mesh, x: &Iterate, disturbance: &Disturbance) -> Result<Guess, InvalidInput> {
    let length = mesh.problem.length;
    let size = |waves: f64| waves.signum() * disturbance.size / length * f64::from(u8::from(waves != 0.0));
    let wave = |s: f64, waves: f64| size(waves) * (waves * PI * s / length).cos();
    let twisted = Known::Twisted(0.0);
    let straight = twisted.strains(&mesh.problem)?;
    let soft = soft(&mesh.problem.law.at(0.0)?.compliance);
    let strain = |i: usize, y: f64| {
        let s = mesh.nodes[i] + y * mesh.length(i);
        let base = if disturbance.of_straight { straight(s) } else { x.strain(mesh, i, y) };
        let [bend, twist] = [disturbance.bend, disturbance.twist].map(|waves| wave(s, waves));
        base + Strain::new(0.0, bend, bend, twist).component_mul(&soft)
    };
    let mut stepper = Stepper::new(&mesh.problem, mesh.gauss)?;
    let (mut s, mut strains, mut states) = (vec![0.0], vec![strain(0, 0.0)], vec![x.nodes[0]]);
    for i in 0..mesh.elements() {
        // Between the nodes, too, for the strains of a guess are joined by lines.
        for part in 0..PARTS {
            let [from, to] = [part, part + 1].map(|k| k as f64 / PARTS as f64);
            let between = |c: f64| strain(i, from + c * (to - from));
            let step = (to - from) * mesh.length(i);
            let (mut at, _) =
                stepper.step(&states[states.len() - 1], s[s.len() - 1], step, between, false)?;
            at.rotation *= 1.0 / at.rotation.norm();
            s.push(mesh.nodes[i] + to * mesh.length(i));
            strains.push(strain(i, to));
            states.push(at);
        }
    }
    Ok(Guess { s, strains, states, has_wrench: false })
}

/// Parts of an element at which a guess is given.
const PARTS: usize = 4;

/// Whether a solution is known to be unstable, by a section or under the end conditions. It keeps its index.
pub fn is_unstable(
    problem: &Arc<Problem>,
    settings: &Settings,
    solved: &mut Solved,
) -> Result<bool, InvalidInput> {
    let mesh = Mesh::new(problem, solved.nodes.clone(), settings.degree)?;
    for i in 0..mesh.elements() {
        let mut made = Vec::new();
        let responses = mesh.responses(i, &mut made)?;
        let strains = &solved.x.strains[i * settings.degree..(i + 1) * settings.degree];
        // A uniform ribbon has one law for all stages.
        if responses.iter().cycle().zip(strains).any(|(response, strain)| response.index(strain) > 0) {
            return Ok(true);
        }
    }
    let index = System::new(mesh)?.index(&solved.x, &goal(problem));
    solved.index = Some(index);
    Ok(index.is_some_and(|index| index > 0))
}

/// Factorised elements of creeping that are too many.
const SOME_WORK: usize = 100_000;
/// Factorised elements of a disturbance that are too many.
const LITTLE_WORK: usize = 4_000;
