//! Elements, and what is given on them.

use std::sync::Arc;

use nalgebra::Vector3;

use super::gauss::Gauss;
use super::law::Response;
use super::problem::Problem;
use crate::InvalidInput;

type Vector = Vector3<f64>;

/// Sections that are kept; beyond, those of a ribbon that varies are made when needed.
const KEPT_STAGES: usize = 20_000;

/// Distance of a node from a break, over the length, that is none.
const ROUNDING: f64 = 1e-14;

/// The elements of a problem, with its law and loads at their stages.
#[derive(Clone)]
pub struct Mesh {
    /// The problem.
    pub problem: Arc<Problem>,
    /// The collocation.
    pub gauss: &'static Gauss,
    /// Ends of the elements, `0` to `L`.
    pub nodes: Vec<f64>,
    /// At each node the point load there: its force and moment.
    pub points: Vec<Option<(Vector, Vector)>>,
    /// One for a uniform ribbon, one a stage for one that varies, none if there are too many.
    responses: Vec<Response>,
    /// Distributed force and couple at the stages; none if nothing is distributed.
    load: Vec<(Vector, Vector)>,
}

impl Mesh {
    /// The mesh with these nodes, among them all breaks of the problem.
    ///
    /// # Errors
    /// Where a section is refused.
    pub fn new(problem: &Arc<Problem>, nodes: Vec<f64>, degree: usize) -> Result<Self, InvalidInput> {
        let (points, responses, load) = (Vec::new(), Vec::new(), Vec::new());
        let mut mesh =
            Self { problem: Arc::clone(problem), gauss: Gauss::of(degree), nodes, points, responses, load };
        mesh.meet_breaks();
        mesh.take_law()?;
        mesh.take_loads();
        Ok(mesh)
    }

    /// Moves nodes that differ from breaks by rounding, as those do that were scaled, to where these are.
    fn meet_breaks(&mut self) {
        let breaks = self.problem.breaks();
        for &place in &breaks[1..breaks.len() - 1] {
            let next = self.nodes.partition_point(|&s| s < place).min(self.nodes.len() - 1);
            let apart = |node: usize| (self.nodes[node] - place).abs();
            let nearest = if next > 0 && apart(next - 1) < apart(next) { next - 1 } else { next };
            if apart(nearest) < ROUNDING * self.problem.length {
                self.nodes[nearest] = place;
            }
        }
    }

    fn take_law(&mut self) -> Result<(), InvalidInput> {
        self.responses.clear();
        if !self.problem.law.varies() {
            self.responses.push(self.problem.law.at(0.0)?);
        } else if self.stages() <= KEPT_STAGES {
            self.responses = (0..self.elements())
                .flat_map(|i| self.places(i))
                .map(|s| self.problem.law.at(s))
                .collect::<Result<_, _>>()?;
        }
        Ok(())
    }

    fn take_loads(&mut self) {
        self.points.clear();
        self.points.resize(self.nodes.len(), None);
        for point in &self.problem.points {
            let node = self.nodes.partition_point(|&s| s < point.s);
            let (force, moment) = self.points[node].unwrap_or((Vector::zeros(), Vector::zeros()));
            self.points[node] = Some((force + point.force, moment + point.moment));
        }
        self.load.clear();
        if self.problem.has_line_load() {
            let places = (0..self.elements()).flat_map(|i| self.places(i));
            self.load = places.map(|s| self.problem.line_load(s)).collect();
        }
    }

    /// The same elements, in proportion to its length, of another problem of the same kind.
    ///
    /// # Errors
    /// Where a section is refused.
    pub fn turn_to(&mut self, problem: &Arc<Problem>) -> Result<(), InvalidInput> {
        if Arc::ptr_eq(&self.problem, problem) {
            return Ok(());
        }
        let before = std::mem::replace(&mut self.problem, Arc::clone(problem));
        if problem.length != before.length {
            let factor = problem.length / before.length;
            self.nodes.iter_mut().for_each(|s| *s = (*s * factor).min(problem.length));
            self.nodes.last_mut().into_iter().for_each(|s| *s = problem.length);
            self.meet_breaks();
        }
        if problem.length != before.length || !Arc::ptr_eq(&before.law, &problem.law) {
            self.take_law()?;
        }
        self.take_loads();
        Ok(())
    }

    /// Number of elements.
    #[must_use]
    pub fn elements(&self) -> usize {
        self.nodes.len() - 1
    }

    /// Number of stages of all elements.
    #[must_use]
    pub fn stages(&self) -> usize {
        self.elements() * self.gauss.degree
    }

    /// Length of an element.
    #[must_use]
    pub fn length(&self, element: usize) -> f64 {
        self.nodes[element + 1] - self.nodes[element]
    }

    /// Where the stages of an element are.
    #[must_use]
    pub fn places(&self, element: usize) -> Vec<f64> {
        let (from, length) = (self.nodes[element], self.length(element));
        self.gauss.nodes.iter().map(|c| from + c * length).collect()
    }

    /// The law at the stages of an element, made here if it is not kept.
    ///
    /// # Errors
    /// Where a section is refused.
    pub fn responses<'b>(
        &'b self,
        element: usize,
        made: &'b mut Vec<Response>,
    ) -> Result<&'b [Response], InvalidInput> {
        let degree = self.gauss.degree;
        if self.responses.len() == 1 && !self.problem.law.varies() {
            return Ok(&self.responses);
        }
        if !self.responses.is_empty() {
            return Ok(&self.responses[element * degree..(element + 1) * degree]);
        }
        let places = self.places(element).into_iter();
        *made = places.map(|s| self.problem.law.at(s)).collect::<Result<_, _>>()?;
        Ok(made)
    }

    /// Distributed load at the stages of an element.
    #[must_use]
    pub fn load(&self, element: usize) -> &[(Vector, Vector)] {
        let degree = self.gauss.degree;
        if self.load.is_empty() { &[] } else { &self.load[element * degree..(element + 1) * degree] }
    }
}
