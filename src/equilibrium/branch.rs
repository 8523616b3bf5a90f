//! A natural shape along a ribbon: strains as piecewise polynomials of `S`, and the poses that follow.

use super::Phase;
use crate::frame::{Pose, gauss_points, integrate_gauss};
use crate::section::Strain;
use crate::{InvalidInput, legendre};

/// Why the strains are not smooth at a place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EventKind {
    /// The branch continues, with a corner: another stable shape begins where it ends.
    Bifurcation,
    /// The stable shape ends and no other begins there: the ribbon has a kink.
    Jump,
    /// The growth or a dimension jumps.
    GrowthJump,
}

impl EventKind {
    /// All kinds.
    pub const ALL: [Self; 3] = [Self::Bifurcation, Self::Jump, Self::GrowthJump];

    /// The name of the kind.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Bifurcation => "bifurcation",
            Self::Jump => "jump",
            Self::GrowthJump => "growth jump",
        }
    }
}

/// A place where the strains are not smooth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Event {
    /// Where.
    pub s: f64,
    /// Why.
    pub kind: EventKind,
    /// Strains before.
    pub before: Strain,
    /// Strains after.
    pub after: Strain,
}

/// Strains on an element, as series in the Legendre polynomials of [`legendre`].
#[derive(Clone, Debug)]
pub(super) struct Element {
    pub from: f64,
    pub to: f64,
    pub strains: [Vec<f64>; 4],
}

impl Element {
    pub fn strain(&self, s: f64) -> Strain {
        let y = (s - 0.5 * (self.from + self.to)) / (self.to - self.from);
        Strain::from_fn(|i, _| legendre::evaluate(&self.strains[i], y))
    }
}

/// A stable natural shape all along the ribbon.
#[derive(Clone, Debug)]
pub struct NaturalBranch {
    pub(super) elements: Vec<Element>,
    /// Where it is not smooth, in order.
    pub events: Vec<Event>,
    /// Mean energy over the length.
    pub energy: f64,
    /// The phases met, in order, each run once.
    pub phases: Vec<Phase>,
}

impl NaturalBranch {
    /// A branch from its parts, as [`NaturalBranch::breaks`], [`NaturalBranch::series`] and the fields give them.
    ///
    /// # Errors
    /// If there are no elements, or the numbers of breaks and series do not match.
    pub fn from_parts(
        breaks: &[f64],
        series: Vec<[Vec<f64>; 4]>,
        events: Vec<Event>,
        energy: f64,
        phases: Vec<Phase>,
    ) -> Result<Self, InvalidInput> {
        if series.is_empty() || breaks.len() != series.len() + 1 {
            let found = format!("{} breaks and {} elements", breaks.len(), series.len());
            return Err(InvalidInput::new("breaks", found, "one break more than elements"));
        }
        let element = |(ends, strains): (&[f64], _)| Element { from: ends[0], to: ends[1], strains };
        let elements = breaks.windows(2).zip(series).map(element).collect();
        Ok(Self { elements, events, energy, phases })
    }

    /// The strains on each element: Legendre series of [`legendre`].
    #[must_use]
    pub fn series(&self) -> Vec<[Vec<f64>; 4]> {
        self.elements.iter().map(|element| element.strains.clone()).collect()
    }

    /// Ends of the elements.
    #[must_use]
    pub fn breaks(&self) -> Vec<f64> {
        let first = self.elements.first().map(|e| e.from);
        first.into_iter().chain(self.elements.iter().map(|e| e.to)).collect()
    }

    /// The strains at `s`.
    #[must_use]
    pub fn strain(&self, s: f64) -> Strain {
        self.elements[self.element(s)].strain(s)
    }

    fn element(&self, s: f64) -> usize {
        self.elements.partition_point(|e| e.to <= s).min(self.elements.len() - 1)
    }

    /// The poses at ascending `s`, from that at `S = 0`.
    #[must_use]
    pub fn poses(&self, s: &[f64], start: &Pose) -> Vec<Pose> {
        let mut poses = Vec::with_capacity(s.len());
        let mut rest = s;
        let mut pose = *start;
        for (i, element) in self.elements.iter().enumerate() {
            let steps = element.steps();
            let last = i + 1 == self.elements.len();
            let inside = rest.partition_point(|&s| last || s < element.to);
            let (here, after) = rest.split_at(inside);
            let mut nodes: Vec<f64> = (0..=steps).map(|j| element.node(j, steps)).collect();
            nodes.extend(here);
            nodes.sort_by(f64::total_cmp);
            let all = element.poses(&nodes, &pose);
            // Each place asked for is a node; the nodes and the places are both in order.
            let mut node = 0;
            for &place in here {
                while nodes[node] < place {
                    node += 1;
                }
                poses.push(all[node]);
            }
            pose = all[element_end(&nodes, element.to)];
            rest = after;
        }
        poses
    }
}

/// The last node not beyond the element.
fn element_end(nodes: &[f64], to: f64) -> usize {
    nodes.partition_point(|&s| s <= to).max(1) - 1
}

impl Element {
    fn node(&self, j: usize, steps: usize) -> f64 {
        if j == steps { self.to } else { self.from + (self.to - self.from) * (j as f64 / steps as f64) }
    }

    fn poses(&self, nodes: &[f64], start: &Pose) -> Vec<Pose> {
        let strains: Vec<[Strain; 3]> =
            gauss_points(nodes).iter().map(|points| points.map(|s| self.strain(s))).collect();
        integrate_gauss(nodes, &strains, start)
    }

    /// Steps of order six over the element whose halves agree to rounding.
    fn steps(&self) -> usize {
        let end = |steps: usize| {
            let nodes: Vec<f64> = (0..=steps).map(|j| self.node(j, steps)).collect();
            self.poses(&nodes, &Pose::new([0.0; 3], [1.0, 0.0, 0.0, 0.0]))[steps]
        };
        let mut steps = 1;
        let mut coarse = end(steps);
        while steps < MOST_STEPS {
            let fine = end(2 * steps);
            let length = (self.to - self.from).max(f64::MIN_POSITIVE);
            let moved = (fine.position - coarse.position).norm() / length;
            let turned = (fine.rotation - coarse.rotation).norm();
            if moved.max(turned) <= STEP_ERROR {
                break;
            }
            steps *= 2;
            coarse = fine;
        }
        steps
    }
}

/// Difference of the poses with steps twice as long: 64 times the error of the shorter.
const STEP_ERROR: f64 = 1e-13;
const MOST_STEPS: usize = 4096;
