//! What continuation is to know of a problem.

use thiserror::Error;

use crate::InvalidInput;
use crate::boundary::Determinant;

/// A change of the state and of the parameter.
#[derive(Clone, Debug)]
pub struct Direction<C> {
    /// Of the state.
    pub x: C,
    /// Of the parameter.
    pub t: f64,
}

/// What is known of the stability of an equilibrium.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Stability {
    /// Largest number of negative eigenvalues of the tangent stiffness of a section.
    pub section_index: usize,
    /// Smooth along a branch, negative where and only where a section is unstable, and where in two directions.
    pub section: [f64; 2],
    /// Number of independent ways to lower the energy, where every section is stable and the loads have a potential.
    pub index: Option<usize>,
    /// Motions that change nothing, all along a branch.
    pub free_motions: usize,
    /// Determinant of the equations with the parameter and a plane that faces along the branch: its sign changes at branch points of
    /// odd multiplicity, and not at folds; `None` if it is not known.
    pub determinant: Option<Determinant>,
}

impl Stability {
    /// The product of the signs of both determinants; 0 if one is not known.
    #[must_use]
    pub fn signs(&self, other: &Self) -> f64 {
        self.determinant.zip(other.determinant).map_or(0.0, |(a, b)| a.sign * b.sign)
    }
}

/// Why a step cannot be made.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum Failed {
    /// The linearised equations cannot be solved, or a number is not finite.
    #[error("{0}")]
    Equations(String),
    /// Newton's method does not converge.
    #[error("Newton's method does not converge: the last correction is {0:.1e}")]
    Diverged(f64),
    /// Meshes that do not meet the tolerance.
    #[error("{0} meshes do not meet the tolerance")]
    Unresolved(usize),
    /// More elements than are allowed would be needed.
    #[error("{0} elements would be needed")]
    Fine(usize),
    /// It converges to what is not near.
    #[error("the next equilibrium is not near")]
    Jumped,
    /// A problem that is refused.
    #[error(transparent)]
    Refused(#[from] InvalidInput),
    /// Asked to stop.
    #[error("interrupted")]
    Interrupted,
}

/// Equations `F(x, t) = 0` of a state `x` and a parameter `t` from 0 to 1.
pub trait Equations {
    /// `x`.
    type State: Clone;
    /// A change of `x`: an element of a linear space.
    type Change: Clone;

    /// Says how many free motions there are on the branch that is followed, or that it is not known.
    fn expect_motions(&mut self, count: Option<usize>);

    /// `x` changed by `factor` times a change.
    fn moved(&mut self, x: &Self::State, change: &Self::Change, factor: f64) -> Self::State;

    /// The change that moves one state to another on the same mesh, but for free motions.
    fn difference(&mut self, from: &Self::State, to: &Self::State) -> Self::Change;

    /// A change that follows another as one that is added to it.
    fn added(&self, first: &Self::Change, then: &Self::Change) -> Self::Change;

    /// `x` with what is known but for the parameter, such as forces that given loads take away, as it is at `t`.
    ///
    /// # Errors
    /// Where that cannot be.
    fn settled(&mut self, x: Self::State, t: f64) -> Result<Self::State, Failed>;

    /// The sum of changes times factors.
    fn sum(&self, parts: &[(f64, &Self::Change)]) -> Self::Change;

    /// The scalar product of changes on the mesh of the state last used; its size is that of strains and angles.
    fn dot(&self, a: &Self::Change, b: &Self::Change) -> f64;

    /// The size of a change of forces, in what a ribbon resists bending with: where it is stiff against stretching they change more than
    /// its shape tells.
    fn forces(&self, change: &Self::Change) -> f64;

    /// Linearises at `(x, t)`, for solutions that lie across a direction; or at fixed `t`.
    ///
    /// # Errors
    /// Where that cannot be.
    fn linearise(
        &mut self,
        x: &Self::State,
        t: f64,
        across: Option<&Direction<Self::Change>>,
    ) -> Result<(), Failed>;

    /// Evaluates `F(x, t)`, near where it was linearised.
    ///
    /// # Errors
    /// Where that cannot be.
    fn evaluate(&mut self, x: &Self::State, t: f64) -> Result<(), Failed>;

    /// A solution of the linearised equations for the residual last evaluated.
    fn particular(&mut self) -> Direction<Self::Change>;

    /// The line of such solutions, toward where the direction that they lie across points.
    fn line(&mut self) -> Direction<Self::Change>;

    /// Directions in which the linearised equations are nearly singular, the most first.
    fn kernel(&mut self, count: usize) -> Vec<Direction<Self::Change>>;

    /// Stability at `(x, t)`, where the equations were linearised.
    fn stability(&mut self, x: &Self::State, t: f64) -> Stability;

    /// Numbers that tell mirror images apart, too.
    fn coordinates(&mut self, x: &Self::State, t: f64) -> Vec<f64>;

    /// Numbers that are the same for mirror images, to tell equilibria apart.
    fn invariants(&mut self, x: &Self::State, t: f64) -> Vec<f64>;

    /// The state of a branch with this tangent on a finer mesh, if the error on the one it has is above the tolerance, or
    /// above `most`.
    ///
    /// # Errors
    /// Where that cannot be.
    fn refined(
        &mut self,
        x: &Self::State,
        t: f64,
        along: &Direction<Self::Change>,
        most: f64,
    ) -> Result<Option<Self::State>, Failed>;

    /// The error of the parameter at a branch point on the mesh of a state beside it, in a direction in which a branch leaves it, and
    /// that state on a finer mesh, if the error is above `tolerance`.
    ///
    /// # Errors
    /// Where that cannot be.
    fn resolved(
        &mut self,
        x: &Self::State,
        t: f64,
        across: &Direction<Self::Change>,
        tolerance: f64,
    ) -> Result<(f64, Option<Self::State>), Failed>;

    /// The state on a mesh twice as fine, if it has one.
    ///
    /// # Errors
    /// Where that cannot be.
    fn doubled(&mut self, x: &Self::State, t: f64) -> Result<Option<Self::State>, Failed>;

    /// Whether two states are on one mesh.
    fn on_one_mesh(&self, a: &Self::State, b: &Self::State) -> bool;

    /// The state, and a change of it, on the mesh of another.
    ///
    /// # Errors
    /// Where that cannot be.
    fn remeshed(
        &mut self,
        x: &Self::State,
        change: &Self::Change,
        like: &Self::State,
        t: f64,
    ) -> Result<(Self::State, Self::Change), Failed>;

    /// The direction in which a section that becomes unstable at `(x, t)` gives way, the same all along, if the ribbon may.
    fn section_direction(&mut self, x: &Self::State, t: f64) -> Option<Direction<Self::Change>>;
}

/// The scalar product of directions.
pub fn dot<E: Equations + ?Sized>(equations: &E, a: &Direction<E::Change>, b: &Direction<E::Change>) -> f64 {
    equations.dot(&a.x, &b.x) + a.t * b.t
}

/// The direction times a factor.
pub fn scaled<E: Equations + ?Sized>(
    equations: &E,
    a: &Direction<E::Change>,
    factor: f64,
) -> Direction<E::Change> {
    Direction { x: equations.sum(&[(factor, &a.x)]), t: factor * a.t }
}

/// The direction of unit length.
pub fn unit<E: Equations + ?Sized>(equations: &E, a: &Direction<E::Change>) -> Direction<E::Change> {
    scaled(equations, a, 1.0 / dot(equations, a, a).sqrt())
}

/// `a + factor b`.
pub fn plus<E: Equations + ?Sized>(
    equations: &E,
    a: &Direction<E::Change>,
    factor: f64,
    b: &Direction<E::Change>,
) -> Direction<E::Change> {
    Direction { x: equations.sum(&[(1.0, &a.x), (factor, &b.x)]), t: a.t + factor * b.t }
}
