//! The trait behind which each section law keeps its relaxed energy.

/// Relaxed energy over `eta^4` and its derivatives in `k2 = K2/eta` and `p = (K3/eta)^2`.
///
/// Every law of this crate is a quadratic in `p` at fixed `k2`, so these are all there are up to
/// second order, with the one third derivative that the search for natural shapes needs.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Relaxed {
    /// The energy.
    pub energy: f64,
    /// `d/dk2`.
    pub d2: f64,
    /// `d/dp`.
    pub dp: f64,
    /// `d^2/dk2^2`.
    pub d22: f64,
    /// `d^2/(dk2 dp)`.
    pub d2p: f64,
    /// `d^2/dp^2`, a function of `k2` alone.
    pub dpp: f64,
    /// `d^3/(dk2 dp^2)`.
    pub d2pp: f64,
}

/// A square that remembers what rounding took from it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Square {
    value: f64,
    error: f64,
}

impl Square {
    /// `x^2`, exactly.
    #[must_use]
    pub fn of(x: f64) -> Self {
        let value = x * x;
        Self { value, error: x.mul_add(x, -value) }
    }

    /// A square given as such; may be negative, as the search for natural shapes needs.
    #[must_use]
    pub fn from_value(value: f64) -> Self {
        Self { value, error: 0.0 }
    }

    /// `x^2 - y + z`, to rounding of the result where `x^2`, `y` and `z` cancel.
    ///
    /// Knuth's two-sum keeps what the difference loses, to be added last.
    #[must_use]
    pub fn minus_plus(self, y: f64, z: f64) -> f64 {
        let difference = self.value - y;
        let back = difference - self.value;
        let lost = (self.value - (difference - back)) - (y + back);
        (difference + z) + (lost + self.error)
    }
}

/// The part of the section energy that the deflection `u1` can relieve, at given `K2` and `K3^2`.
///
/// It is all that distinguishes the laws; stretching, in-plane bending, and the bending and twisting
/// of the unrelaxed section are the same for each and live in [`super::Section`].
/// `k2` and `k3` are in units of `1/a`, not divided by `eta`: the differences against the growth
/// are taken before scaling, so that they are exact where they cancel.
pub trait Relaxation: std::fmt::Debug + Send + Sync {
    /// Relaxed energy over `eta^4`.
    fn energy(&self, k2: f64, k3_squared: Square) -> f64;

    /// Relaxed energy over `eta^4` with derivatives in `K2/eta` and `(K3/eta)^2`.
    fn derivatives(&self, k2: f64, k3_squared: Square) -> Relaxed;
}

/// The parabolic mismatch `w = [K3^2 + K2 (nu K2 + delta) - offset]/eta^2` and its `k2`-derivatives.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mismatch {
    nu: f64,
    delta: f64,
    offset: f64,
    eta: f64,
}

impl Mismatch {
    pub fn new(reduction: &super::Reduction, eta: f64) -> Self {
        Self { nu: reduction.material.nu, delta: reduction.delta, offset: reduction.offset, eta }
    }

    pub fn value(&self, k2: f64, k3_squared: Square) -> f64 {
        k3_squared.minus_plus(self.offset, k2 * (self.nu * k2 + self.delta)) / (self.eta * self.eta)
    }

    /// First derivative in `K2/eta`; the second is `2 nu`, that in `(K3/eta)^2` is 1.
    pub fn slope(&self, k2: f64) -> f64 {
        (2.0 * self.nu * k2 + self.delta) / self.eta
    }

    pub fn curvature(&self) -> f64 {
        2.0 * self.nu
    }
}
