//! The energy of the relaxed cross-section: the heart of the model.
//!
//! At given strains `(eps, K1, K2, K3)` the section chooses the deflection `U = u1/a` that minimises
//!
//! ```text
//! Pi = (1/2) int m^2 dx + (eta^2/24) int b33^2 dx + (eta^2 beta^2/2) int (b22 + nu b33)^2 dx + eta^2 g int b23^2 dx,
//! m   = eps + K1 x - K2 U + K3^2 x^2/2 - gamma33,      b33 = K2 + d33,
//! b22 = U'' - g21' + d22,                              b23 = K3 + g31'/2 - d23/2,
//! ```
//!
//! over `x` in `[-1/2, 1/2]`, with `nu`, `beta` and `g` of [`crate::material::SectionConstants`] and `int U = int x U = 0`; `W/(Y h a)` of the paper's section 2.4 with the
//! thickness gradients kept in the edge conditions. What the deflection cannot change is integrated
//! once, in [`Reduction`]; what it relieves is a [`Relaxation`], of which each law has its own:
//!
//! | law | growth | source |
//! |---|---|---|
//! | [`ClosedForm`] | edge, thickness gradient, chirality | eqs. (57), (58), stable |
//! | [`GeneralLaw`] | any profiles | modes of the section |
//! | [`SecondOrder`] | edge, chirality | eq. (59) |
//! | [`PublishedSaddle`] | thickness gradient | eqs. (47)-(50) as published |

pub mod basis;
mod blend;
mod closed;
mod deflection;
mod general;
mod mesh;
mod pieces;
mod published;
mod reduction;
mod relaxation;
mod ribbon;
mod second_order;
pub mod sigma;

pub use blend::{blend, corner_weights};
pub use closed::ClosedForm;
pub use deflection::{Deflection, InPlane};
pub use general::GeneralLaw;
pub use mesh::{Mesh, Series};
pub use pieces::Reach;
pub use published::PublishedSaddle;
pub use reduction::Reduction;
pub use relaxation::{Relaxation, Relaxed, Square};
pub use ribbon::{Amplitude, RibbonLaw, RibbonSpec, Station};
pub use second_order::SecondOrder;

use std::sync::Arc;

use nalgebra::{Matrix4, Vector4};

use crate::InvalidInput;
use crate::growth::Growth;
use crate::material::PlaneStress;

/// Strains of the centreline: `eps`, `K1`, `K2`, `K3`.
pub type Strain = Vector4<f64>;

/// Which law relaxes the section.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// The closed form where it applies, else the general law: the same energy either way.
    Auto,
    /// [`ClosedForm`].
    Closed,
    /// [`GeneralLaw`].
    General,
    /// [`SecondOrder`].
    SecondOrder,
    /// [`PublishedSaddle`].
    PublishedSaddle,
}

impl Form {
    /// All forms with their names.
    pub const NAMES: [(&'static str, Self); 5] = [
        ("auto", Self::Auto),
        ("closed", Self::Closed),
        ("general", Self::General),
        ("second-order", Self::SecondOrder),
        ("published-saddle", Self::PublishedSaddle),
    ];

    /// The name of the form.
    #[must_use]
    pub fn name(self) -> &'static str {
        let named = Self::NAMES.iter().find(|(_, form)| *form == self);
        named.map_or("", |(name, _)| name)
    }
}

/// Energy with its derivatives in the four strains.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Evaluation {
    /// `Pi`.
    pub energy: f64,
    /// `(n3, m1, m2, m3) = dPi/d(eps, K1, K2, K3)`, eq. (43).
    pub gradient: Vector4<f64>,
    /// The tangent stiffness.
    pub hessian: Matrix4<f64>,
}

/// The section law of a growing ribbon.
#[derive(Debug)]
pub struct Section {
    eta: f64,
    form: Form,
    reduction: Reduction,
    reach: Option<Arc<Reach>>,
    relaxation: Box<dyn Relaxation>,
}

impl Section {
    /// The law for thickness ratio `eta = h/a`, a growth and a stiffness.
    ///
    /// # Errors
    /// If `eta` is not in `(0, 1)`, a growth coefficient is refused, or the form cannot represent the growth.
    ///
    /// # Example
    /// ```
    /// use ribbonrs::{growth::Growth, material::PlaneStress, section::{Form, Section, Strain}};
    /// let law = Section::new(0.1, &Growth::edge(0.06), &PlaneStress::incompressible(), Form::Auto)?;
    /// let twisted = Strain::new(0.02 - 0.08 / 24.0, 0.0, 0.0, 0.08f64.sqrt()); // eq. (64)
    /// assert!(law.gradient(&twisted).amax() < 1e-17); // the rounding of `eps`
    /// # Ok::<(), ribbonrs::InvalidInput>(())
    /// ```
    pub fn new(eta: f64, growth: &Growth, stiffness: &PlaneStress, form: Form) -> Result<Self, InvalidInput> {
        Self::with_reach(eta, growth.clone(), stiffness, form, None)
    }

    /// The same with the modes of a sum of growths that this one is part of, so that they are found once.
    ///
    /// # Errors
    /// As [`Section::new`].
    pub fn with_reach(
        eta: f64,
        growth: Growth,
        stiffness: &PlaneStress,
        form: Form,
        reach: Option<Arc<Reach>>,
    ) -> Result<Self, InvalidInput> {
        if !(eta > 0.0 && eta < 1.0) {
            return Err(InvalidInput::new("eta", eta, "a thickness ratio in (0, 1)"));
        }
        growth.validate()?;
        let published = PublishedSaddle::new(&growth, eta);
        let reduction = Reduction::new(growth, stiffness);
        let closed = ClosedForm::new(&reduction, eta);
        let reach = match reach {
            None if !reduction.mesh.is_single() => Reach::new(std::slice::from_ref(&reduction)).map(Arc::new),
            given => given,
        };
        let (form, relaxation): (Form, Option<Box<dyn Relaxation>>) = match (form, closed) {
            (Form::Auto | Form::Closed, Some(law)) => (Form::Closed, Some(Box::new(law))),
            (Form::Closed, None) => (Form::Closed, None),
            (Form::Auto | Form::General, _) => {
                (Form::General, Some(Box::new(GeneralLaw::new(&reduction, reach.clone(), eta))))
            }
            (Form::SecondOrder, _) => {
                let law = SecondOrder::new(&reduction, eta);
                (form, law.map(|law| Box::new(law) as _))
            }
            (Form::PublishedSaddle, _) => {
                let incompressible = *stiffness == PlaneStress::incompressible();
                (form, published.filter(|_| incompressible).map(|law| Box::new(law) as _))
            }
        };
        let relaxation = relaxation.ok_or_else(|| {
            let expected = match form {
                Form::SecondOrder => "edge growth and chirality alone",
                Form::PublishedSaddle => {
                    "a constant thickness gradient d33 alone, in an incompressible material"
                }
                _ => "gamma33 of degree <= 2 and constant d33, d22 and g21'",
            };
            InvalidInput::new("growth", format!("not of the form {:?}", form.name()), expected)
        })?;
        Ok(Self { eta, form, reduction, reach, relaxation })
    }

    /// Thickness ratio `h/a`.
    #[must_use]
    pub fn eta(&self) -> f64 {
        self.eta
    }

    /// The form in use; never [`Form::Auto`].
    #[must_use]
    pub fn form(&self) -> Form {
        self.form
    }

    /// The growth as the section sees it.
    #[must_use]
    pub fn reduction(&self) -> &Reduction {
        &self.reduction
    }

    /// The modes that growth with jumps reaches; `None` where there are no jumps.
    #[must_use]
    pub fn reach(&self) -> Option<&Reach> {
        self.reach.as_deref()
    }

    /// `|K2|` up to which the energy is resolved to rounding: unlimited, unless growth jumps.
    #[must_use]
    pub fn resolved_curvature(&self) -> f64 {
        let last = self.reach().and_then(|reach| reach.largest_curvatures().last().copied());
        last.map_or(f64::INFINITY, |k| k * self.eta)
    }

    /// The relaxed part of the energy.
    #[must_use]
    pub fn relaxation(&self) -> &dyn Relaxation {
        self.relaxation.as_ref()
    }

    /// `Pi` at the strains.
    #[must_use]
    pub fn energy(&self, strain: &Strain) -> f64 {
        let u = self.unrelaxed(strain);
        self.unrelaxed_energy(&u)
            + self.eta.powi(4) * self.relaxation.energy(strain[2], Square::of(strain[3]))
    }

    /// `dPi/d(eps, K1, K2, K3)` at the strains.
    #[must_use]
    pub fn gradient(&self, strain: &Strain) -> Vector4<f64> {
        let relaxed = self.relaxation.derivatives(strain[2], Square::of(strain[3]));
        self.gradient_of(strain, &self.unrelaxed(strain), &relaxed)
    }

    /// Energy, gradient and Hessian at the strains.
    #[must_use]
    pub fn evaluate(&self, strain: &Strain) -> Evaluation {
        let eta2 = self.eta * self.eta;
        let k3 = strain[3];
        let u = self.unrelaxed(strain);
        let r = self.relaxation.derivatives(strain[2], Square::of(k3));
        let stretch_k3 = k3 / 12.0;
        let mut hessian = Matrix4::zeros();
        hessian[(0, 0)] = 1.0;
        hessian[(0, 3)] = stretch_k3;
        hessian[(3, 0)] = stretch_k3;
        hessian[(1, 1)] = 1.0 / 12.0;
        hessian[(2, 2)] = eta2 * (1.0 / 12.0 + r.d22);
        hessian[(2, 3)] = eta2 * 2.0 * (k3 / self.eta) * r.d2p;
        hessian[(3, 2)] = hessian[(2, 3)];
        hessian[(3, 3)] = u.stretch / 12.0
            + stretch_k3 * stretch_k3
            + eta2 * (2.0 * self.reduction.material.twist + 2.0 * r.dp)
            + 4.0 * k3 * k3 * r.dpp;
        Evaluation {
            energy: self.unrelaxed_energy(&u) + eta2 * eta2 * r.energy,
            gradient: self.gradient_of(strain, &u, &r),
            hessian,
        }
    }

    /// The deflection of the section at the strains.
    ///
    /// # Errors
    /// For [`Form::SecondOrder`] and [`Form::PublishedSaddle`], which are energies without a deflection.
    pub fn deflection(&self, strain: &Strain) -> Result<Deflection, InvalidInput> {
        match self.form {
            Form::SecondOrder | Form::PublishedSaddle => Err(InvalidInput::new(
                "form",
                self.form.name(),
                "\"closed\" or \"general\", which have a deflection",
            )),
            _ => Ok(Deflection::new(&self.reduction, self.reach.as_deref(), self.eta, strain)),
        }
    }

    /// The in-plane displacements of the section that has this deflection at the strains.
    #[must_use]
    pub fn in_plane(&self, strain: &Strain, deflection: &Deflection) -> InPlane {
        InPlane::new(&self.reduction, strain, deflection)
    }

    /// The strains less their natural values, before the section relaxes.
    fn unrelaxed(&self, strain: &Strain) -> Unrelaxed {
        let r = &self.reduction;
        Unrelaxed {
            stretch: Square::of(strain[3]).minus_plus(r.eps_spread, 24.0 * (strain[0] - r.eps_constant))
                / 24.0,
            in_plane: strain[1] - r.k1,
            bend: strain[2] + r.d33,
            twist: strain[3] - r.k3,
        }
    }

    fn unrelaxed_energy(&self, u: &Unrelaxed) -> f64 {
        let r = &self.reduction;
        let eta2 = self.eta * self.eta;
        0.5 * u.stretch * u.stretch
            + u.in_plane * u.in_plane / 24.0
            + eta2 * ((u.bend * u.bend + r.d33_variance) / 24.0)
            + eta2 * (r.material.twist * (u.twist * u.twist + r.k3_variance))
    }

    fn gradient_of(&self, strain: &Strain, u: &Unrelaxed, r: &Relaxed) -> Vector4<f64> {
        let eta2 = self.eta * self.eta;
        Vector4::new(
            u.stretch,
            u.in_plane / 12.0,
            eta2 * (u.bend / 12.0 + self.eta * r.d2),
            u.stretch * (strain[3] / 12.0)
                + eta2 * 2.0 * (self.reduction.material.twist * u.twist + strain[3] * r.dp),
        )
    }
}

/// Strains of the section that does not deflect, less what growth makes natural.
struct Unrelaxed {
    stretch: f64,
    in_plane: f64,
    bend: f64,
    twist: f64,
}
