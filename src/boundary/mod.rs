//! Ribbons that are held and loaded: the boundary-value problem and its solver.
//!
//! ```text
//! N' + p = 0,   M' + r' x N + c = 0,   r' = (1 + eps) d3,   q' = q (0, K)/2,   n = dPi/d(eps, K)
//! ```
//!
//! (Liu, Li & Liu, eqs. (40), (43), (60), (66), (67)), with force `N` and moment `M` in the fixed basis, dead loads `p`, `c`,
//! and six conditions at each end. Gauss collocation; the strains are algebraic unknowns at the stages.
//!
//! | file | role |
//! |---|---|
//! | `problem`, `ends`, `law`, `family` | what is given, and how it depends on parameters |
//! | `gauss`, `element`, `lanes`, `eliminated` | one element: stages, linearisation, elimination of its strains |
//! | `transfer`, `chain`, `dense`, `symmetric` | elimination of the nodes |
//! | `sparse` | the same without elimination, by faer |
//! | `mesh`, `iterate`, `system` | all elements: unknowns, residual, Jacobian |
//! | `correct`, `panel` | corrections, also with a parameter unknown |
//! | `newton`, `known`, `path`, `arclength` | the nonlinear equations, from a known shape |
//! | `creep`, `kinks` | the same where no equilibria lead on: viscous, to a stable one, with sections in several phases |
//! | `step`, `adapt`, `waves`, `meshes` | dense output, errors and meshes |
//! | `check` | an independent residual |
//! | `stress` | wrenches that nothing tells, of what is rigid |
//! | `stability`, `fallen` | the index under the end conditions, and what unstable states fall into |
//! | `deflation` | several equilibria |
//! | `solve`, `spent`, `report`, `solution` | the whole, and what it gives |

mod adapt;
mod arclength;
mod chain;
mod check;
mod correct;
mod creep;
mod deflation;
mod dense;
mod element;
mod eliminated;
mod ends;
mod extremes;
mod fallen;
mod family;
mod gauss;
mod inside;
mod iterate;
mod kinks;
mod known;
mod lanes;
mod law;
mod mesh;
mod meshes;
mod newton;
mod panel;
mod path;
mod problem;
mod report;
mod sections;
mod solution;
mod solve;
mod sparse;
mod spent;
mod stability;
mod step;
mod stress;
mod symmetric;
mod system;
mod transfer;
mod waves;

pub use adapt::{Defects, Estimate, defects, refined, symmetrised, transferred};
pub use correct::{Bordered, Line};
pub use deflation::find;
pub use dense::Determinant;
pub use ends::{At, End, Hold, Units};
pub use extremes::Extremes;
pub use family::Family;
pub use gauss::MAX_DEGREE;
pub use iterate::{Correction, Iterate, Layout};
pub use known::{Guess, Known};
pub use law::{Law, Rod};
pub use mesh::Mesh;
pub use path::Path;
pub use problem::{LineLoad, PointLoad, Problem};
pub use report::{Report, Status};
pub use sections::Sections;
pub use solution::{Energies, SectionState, Solution, Wrench, energies};
pub use solve::{DEGREE, Settings, Solved, goal};
pub use step::Stepper;
pub use stress::SelfStress;
pub use system::{Failure, Residual, System, Targets};
pub use waves::{divided, parts_for_waves};
