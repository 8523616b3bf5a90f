//! What the section law is to the boundary-value problem: resultants from strains, or the other way round.

use std::sync::Arc;

use nalgebra::Matrix4;

use crate::InvalidInput;
use crate::section::{RibbonLaw, RibbonSpec, Station, Strain};

/// The law of every section.
#[derive(Debug)]
pub enum Law {
    /// The relaxed cross-section, or its second-order form.
    Relaxed(RibbonLaw),
    /// The stiffnesses of the ungrown section at zero strain, with the strains that growth alone makes natural.
    Linearised(RibbonLaw),
    /// A classical rod.
    Rod(Rod),
}

/// A linear law of a rod that does not vary: `e = intrinsic + compliance n`.
///
/// Written in compliances, so that an inextensible or rigid rod is one with zeros.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rod {
    /// `1/EA`, `1/EI1`, `1/EI2`, `1/GJ`.
    pub compliance: Strain,
    /// Strains without load.
    pub intrinsic: Strain,
}

/// The law of one section.
///
/// It is kept as `value(e) - compliance n = 0`, a strain. For the relaxed section `compliance` holds the inverse
/// stiffnesses of the ungrown one, which bring the four resultants to the size of strains, and
/// `value = compliance dPi/de`; for a rod `value = e - intrinsic`.
#[derive(Clone, Debug)]
pub struct Response {
    /// Factors of `n = (n3, m1, m2, m3)`.
    pub compliance: Strain,
    kind: Kind,
}

#[derive(Clone, Debug)]
enum Kind {
    Relaxed(Arc<Station>),
    Linear(Strain),
}

impl Law {
    /// Whether the section differs along the ribbon.
    #[must_use]
    pub fn varies(&self) -> bool {
        match self {
            Self::Relaxed(law) | Self::Linearised(law) => law.varies(),
            Self::Rod(_) => false,
        }
    }

    /// Whether it is that of a rod that bends in all directions alike.
    #[must_use]
    pub fn isotropic(&self) -> bool {
        matches!(self, Self::Rod(rod) if rod.compliance[1] == rod.compliance[2])
    }

    /// What a ribbon is made of and how it grows; `None` for a rod.
    #[must_use]
    pub fn spec(&self) -> Option<&RibbonSpec> {
        match self {
            Self::Relaxed(law) | Self::Linearised(law) => Some(law.spec()),
            Self::Rod(_) => None,
        }
    }

    /// Where along the ribbon the law is not smooth.
    #[must_use]
    pub fn breaks(&self) -> Vec<f64> {
        match self {
            Self::Relaxed(law) | Self::Linearised(law) => law.breaks(),
            Self::Rod(_) => Vec::new(),
        }
    }

    /// The law of the section at `s`.
    ///
    /// # Errors
    /// Where dimensions or growth of this section are refused.
    pub fn at(&self, s: f64) -> Result<Response, InvalidInput> {
        match self {
            Self::Rod(rod) => Ok(Response { compliance: rod.compliance, kind: Kind::Linear(rod.intrinsic) }),
            Self::Relaxed(law) => {
                let station = law.station(s)?;
                Ok(Response { compliance: compliance(&station), kind: Kind::Relaxed(station) })
            }
            Self::Linearised(law) => {
                let station = law.station(s)?;
                let r = station.section().reduction();
                let natural = station.reference(&Strain::new(r.eps, r.k1, -r.d33, r.k3));
                Ok(Response { compliance: compliance(&station), kind: Kind::Linear(natural) })
            }
        }
    }
}

/// Inverse stiffnesses of the ungrown section at zero strain: `EA = 1`, `EI1 = 1/12`, `EI2 = eta^2/12`,
/// `GJ = 2 g eta^2`, in units of the section's own width and thickness.
fn compliance(station: &crate::section::Station) -> Strain {
    let section = station.section();
    let (eta, twist) = (section.eta(), section.reduction().material.twist);
    let eta2 = eta * eta;
    let stiffness = Strain::new(1.0, 1.0 / 12.0, eta2 / 12.0, 2.0 * twist * eta2);
    let scaled = station.weight() * station.local(&station.local(&stiffness));
    scaled.map(|b| 1.0 / b)
}

impl Response {
    /// `value(e)` and its derivatives, rows by columns.
    #[must_use]
    pub fn value(&self, strain: &Strain) -> (Strain, Matrix4<f64>) {
        match &self.kind {
            Kind::Linear(natural) => (strain - natural, Matrix4::identity()),
            Kind::Relaxed(station) => {
                let law = station.evaluate(strain);
                let mut hessian = law.hessian;
                for (mut row, &factor) in hessian.row_iter_mut().zip(self.compliance.iter()) {
                    row *= factor;
                }
                (self.compliance.component_mul(&law.gradient), hessian)
            }
        }
    }

    /// `value(e)` by the law's gradient alone.
    #[must_use]
    pub fn value_alone(&self, strain: &Strain) -> Strain {
        match &self.kind {
            Kind::Linear(natural) => strain - natural,
            Kind::Relaxed(station) => self.compliance.component_mul(&station.gradient(strain)),
        }
    }

    /// Elastic energy per unit `S` at strains with these resultants.
    #[must_use]
    pub fn energy(&self, strain: &Strain, resultants: &Strain) -> f64 {
        match &self.kind {
            Kind::Linear(natural) => 0.5 * (strain - natural).dot(resultants),
            Kind::Relaxed(station) => station.energy(strain),
        }
    }

    /// Number of negative eigenvalues of the tangent stiffness.
    #[must_use]
    pub fn index(&self, strain: &Strain) -> usize {
        match &self.kind {
            Kind::Linear(_) => 0,
            Kind::Relaxed(station) => {
                // Scaled to a unit diagonal in the ungrown state; congruence keeps the signs.
                let scale = self.compliance.map(f64::sqrt);
                let scaled = station.evaluate(strain).hessian.component_mul(&(scale * scale.transpose()));
                // Most sections are stable, which costs less to tell than all eigenvalues.
                if (scaled + Matrix4::from_diagonal_element(INDEX_TOLERANCE)).cholesky().is_some() {
                    return 0;
                }
                scaled.symmetric_eigenvalues().iter().filter(|&&value| value < -INDEX_TOLERANCE).count()
            }
        }
    }

    /// The direction whose tangent stiffness, relative to that of the ungrown section, is nearest to none; `None` for a linear law.
    #[must_use]
    pub fn neutral(&self, strain: &Strain) -> Option<Strain> {
        let Kind::Relaxed(station) = &self.kind else { return None };
        let scale = self.compliance.map(f64::sqrt);
        let scaled = station.evaluate(strain).hessian.component_mul(&(scale * scale.transpose()));
        let eigen = scaled.symmetric_eigen();
        let nearest = eigen.eigenvalues.iamin();
        Some(eigen.eigenvectors.column(nearest).component_mul(&scale))
    }

    /// Strains of the straight and untwisted section that no axial force stretches.
    #[must_use]
    pub fn straight(&self) -> Strain {
        let eps = match &self.kind {
            Kind::Linear(natural) => natural[0],
            Kind::Relaxed(station) => station.section().reduction().eps,
        };
        Strain::new(eps, 0.0, 0.0, 0.0)
    }

    /// Strains without load that are stable and of lowest energy.
    #[must_use]
    pub fn natural(&self) -> Strain {
        match &self.kind {
            Kind::Linear(natural) => *natural,
            Kind::Relaxed(station) => {
                let shapes = station.natural_shapes();
                let stable = shapes.iter().find(|shape| shape.section_index == 0);
                stable.or(shapes.first()).map_or_else(Strain::zeros, |shape| shape.strain)
            }
        }
    }
}

/// Eigenvalues of the scaled stiffness above minus this are rounding.
const INDEX_TOLERANCE: f64 = 1e-12;
