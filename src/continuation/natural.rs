//! A ribbon that hangs free and is the same all along: two equations in `k = K2/eta` and `q = K3/eta`.

use std::sync::Arc;

use nalgebra::{Matrix3, Vector3};

use super::equations::{Direction, Equations, Failed, Stability};
use super::locus::Plane;
use crate::InvalidInput;
use crate::boundary::Determinant;
use crate::equilibrium::{Balance, balance};
use crate::section::{RibbonLaw, RibbonSpec, Station, corner_weights};

/// Ribbons between ribbons: those of a parameter from 0 to 1, or of two.
#[derive(Clone, Debug)]
pub struct NaturalFamily {
    corners: Vec<RibbonSpec>,
    linear: bool,
}

impl NaturalFamily {
    /// The family between two ribbons, or four, that differ in amplitudes of growth and dimensions alone.
    ///
    /// # Errors
    /// If anything else differs, or they vary along their length.
    pub fn new(corners: Vec<RibbonSpec>) -> Result<Self, InvalidInput> {
        if !matches!(corners.len(), 2 | 4) {
            return Err(InvalidInput::new("corners", corners.len(), "two ribbons, or four"));
        }
        if !corners.iter().all(|other| other.is_like(&corners[0])) {
            let expected = "ribbons that differ in amplitudes of growth and dimensions alone";
            return Err(InvalidInput::new("corners", "different kinds", expected));
        }
        for corner in &corners {
            if RibbonLaw::new(corner.clone())?.varies() {
                return Err(InvalidInput::new(
                    "corners",
                    "varying ribbons",
                    "ribbons that are the same all along",
                ));
            }
        }
        let same = |a: &RibbonSpec, b: &RibbonSpec| {
            a.eta == b.eta && a.width == b.width && a.thickness == b.thickness
        };
        let linear = corners.iter().all(|other| same(other, &corners[0]));
        Ok(Self { corners, linear })
    }

    /// The section at these parameters, of which the second counts if there are two.
    ///
    /// # Errors
    /// Where it is refused.
    pub fn station(&self, at: [f64; 2]) -> Result<Arc<Station>, InvalidInput> {
        let weights = corner_weights(self.corners.len(), at);
        let others: Vec<_> = weights.into_iter().zip(&self.corners[1..]).collect();
        RibbonLaw::new(RibbonSpec::blend(&self.corners[0], &others)?)?.station(0.0)
    }
}

/// The equations of a free section.
pub struct Natural {
    family: NaturalFamily,
    other: f64,
    exchanged: bool,
    at: Option<(f64, Arc<Station>)>,
    residual: [f64; 2],
    /// Derivatives of the residual in `k`, `q`, `t`.
    rows: [Vector3<f64>; 2],
    across: Vector3<f64>,
    balance: Option<Balance>,
}

/// Half the change of the parameter by which the equations are differentiated: where they are quadratic in it, as in growth, any is exact.
const DIFFERENCE: [f64; 2] = [1e-5, 1e-3];

impl Natural {
    /// The equations of a family.
    #[must_use]
    pub fn new(family: NaturalFamily) -> Self {
        Self {
            family,
            other: 0.0,
            exchanged: false,
            at: None,
            residual: [0.0; 2],
            rows: [Vector3::zeros(); 2],
            across: Vector3::z(),
            balance: None,
        }
    }

    /// The section at a parameter.
    ///
    /// # Errors
    /// Where it is refused.
    pub fn station(&mut self, t: f64) -> Result<Arc<Station>, InvalidInput> {
        match &self.at {
            Some((known, station)) if *known == t => Ok(Arc::clone(station)),
            _ => {
                let station = self.beside(t)?;
                self.at = Some((t, Arc::clone(&station)));
                Ok(station)
            }
        }
    }

    fn beside(&self, t: f64) -> Result<Arc<Station>, InvalidInput> {
        self.family.station(if self.exchanged { [self.other, t] } else { [t, self.other] })
    }

    fn bordered(&self) -> Matrix3<f64> {
        Matrix3::from_rows(&[self.rows[0], self.rows[1], self.across].map(|row| row.transpose()))
    }

    fn balance(&mut self, x: &[f64; 2], t: f64) -> Result<Balance, Failed> {
        Ok(balance(self.station(t)?.section(), x[0], x[1]))
    }
}

impl Plane for Natural {
    fn hold(&mut self, other: f64, exchanged: bool) {
        (self.other, self.exchanged, self.at) = (other, exchanged, None);
    }
}

impl Equations for Natural {
    type State = [f64; 2];
    type Change = [f64; 2];

    fn expect_motions(&mut self, _: Option<usize>) {}

    fn moved(&mut self, x: &[f64; 2], change: &[f64; 2], factor: f64) -> [f64; 2] {
        [x[0] + factor * change[0], x[1] + factor * change[1]]
    }

    fn difference(&mut self, from: &[f64; 2], to: &[f64; 2]) -> [f64; 2] {
        [to[0] - from[0], to[1] - from[1]]
    }

    fn added(&self, _: &[f64; 2], then: &[f64; 2]) -> [f64; 2] {
        *then
    }

    fn settled(&mut self, x: [f64; 2], _: f64) -> Result<[f64; 2], Failed> {
        Ok(x)
    }

    fn sum(&self, parts: &[(f64, &[f64; 2])]) -> [f64; 2] {
        let add = |sum: [f64; 2], (factor, part): &(f64, &[f64; 2])| {
            [sum[0] + factor * part[0], sum[1] + factor * part[1]]
        };
        parts.iter().fold([0.0; 2], add)
    }

    fn dot(&self, a: &[f64; 2], b: &[f64; 2]) -> f64 {
        a[0] * b[0] + a[1] * b[1]
    }

    fn forces(&self, _: &[f64; 2]) -> f64 {
        0.0
    }

    fn linearise(
        &mut self,
        x: &[f64; 2],
        t: f64,
        across: Option<&Direction<[f64; 2]>>,
    ) -> Result<(), Failed> {
        let step = DIFFERENCE[usize::from(self.family.linear)];
        let beside = |t: f64| Ok::<_, Failed>(balance(self.beside(t)?.section(), x[0], x[1]).gradient);
        let (before, after) = (beside(t - step)?, beside(t + step)?);
        let here = self.balance(x, t)?;
        let [kk, kq, qq] = here.hessian;
        let slope = |i: usize| (after[i] - before[i]) / (2.0 * step);
        self.rows = [Vector3::new(kk, kq, slope(0)), Vector3::new(kq, qq, slope(1))];
        self.residual = here.gradient;
        self.balance = Some(here);
        self.across = across.map_or(Vector3::z(), |across| Vector3::new(across.x[0], across.x[1], across.t));
        Ok(())
    }

    fn evaluate(&mut self, x: &[f64; 2], t: f64) -> Result<(), Failed> {
        self.residual = self.balance(x, t)?.gradient;
        Ok(())
    }

    fn particular(&mut self) -> Direction<[f64; 2]> {
        let rhs = Vector3::new(-self.residual[0], -self.residual[1], 0.0);
        let solution = self.bordered().lu().solve(&rhs).unwrap_or(Vector3::repeat(f64::NAN));
        Direction { x: [solution.x, solution.y], t: solution.z }
    }

    fn line(&mut self) -> Direction<[f64; 2]> {
        let [a, b] = self.rows.map(|row| row / row.norm().max(f64::MIN_POSITIVE));
        let line = a.cross(&b);
        let line = line * 1.0_f64.copysign(line.dot(&self.across));
        Direction { x: [line.x, line.y], t: line.z }
    }

    fn kernel(&mut self, count: usize) -> Vec<Direction<[f64; 2]>> {
        let matrix = Matrix3::from_rows(&[
            self.rows[0].transpose(),
            self.rows[1].transpose(),
            Vector3::zeros().transpose(),
        ]);
        let svd = matrix.svd(false, true);
        let Some(v) = svd.v_t else { return Vec::new() };
        let mut order = [0, 1, 2];
        order.sort_by(|&i, &k| svd.singular_values[i].total_cmp(&svd.singular_values[k]));
        let direction = |&i: &usize| Direction { x: [v[(i, 0)], v[(i, 1)]], t: v[(i, 2)] };
        order.iter().take(count).map(direction).collect()
    }

    fn stability(&mut self, _: &[f64; 2], _: f64) -> Stability {
        let Some(balance) = &self.balance else { return Stability::default() };
        // The ends are free: what the section does decides.
        let determinant = Some(Determinant::of(self.bordered().determinant()));
        Stability {
            section_index: 0,
            section: [1.0; 2],
            index: Some(balance.index()),
            free_motions: 0,
            determinant,
        }
    }

    fn coordinates(&mut self, x: &[f64; 2], _: f64) -> Vec<f64> {
        x.to_vec()
    }

    fn invariants(&mut self, x: &[f64; 2], _: f64) -> Vec<f64> {
        vec![x[0] * x[0], x[1] * x[1]]
    }

    fn refined(
        &mut self,
        _: &[f64; 2],
        _: f64,
        _: &Direction<[f64; 2]>,
        _: f64,
    ) -> Result<Option<[f64; 2]>, Failed> {
        Ok(None)
    }

    fn resolved(
        &mut self,
        _: &[f64; 2],
        _: f64,
        _: &Direction<[f64; 2]>,
        _: f64,
    ) -> Result<(f64, Option<[f64; 2]>), Failed> {
        Ok((0.0, None))
    }

    fn doubled(&mut self, _: &[f64; 2], _: f64) -> Result<Option<[f64; 2]>, Failed> {
        Ok(None)
    }

    fn on_one_mesh(&self, _: &[f64; 2], _: &[f64; 2]) -> bool {
        true
    }

    fn remeshed(
        &mut self,
        x: &[f64; 2],
        change: &[f64; 2],
        _: &[f64; 2],
        _: f64,
    ) -> Result<([f64; 2], [f64; 2]), Failed> {
        Ok((*x, *change))
    }

    fn section_direction(&mut self, _: &[f64; 2], _: f64) -> Option<Direction<[f64; 2]>> {
        None
    }
}
