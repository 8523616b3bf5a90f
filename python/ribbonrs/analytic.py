"""Closed-form section laws in numpy, an independent check of the compiled core.

Two growths of an isotropic incompressible ribbon (nu = 1/2) have closed forms (Liu, Li & Liu, "Morphoelastic
ribbons: Differential growth-induced curvature and torsion", section 3): growth towards the edges, which
bends, twists or coils the ribbon (`twist`), and growth graded through the thickness, which bends it
(`saddle`).
With z = sqrt(3 abs(K2) / (2 eta)) both rest on

    tau(z) = (2/z) (cosh z - cos z)/(sinh z + sin z),    sigma(z) = (1 - tau)/z^4,

and both are written here as sums of squares, which neither cancel nor overflow as their printed forms do.
Everything is dimensionless (lengths in the width a, energy in Y h a per length a) and broadcasts.

Examples
--------
>>> leaf = twist(eta=0.1, xi=0.06)
>>> print(f"{leaf.threshold:.3f} {leaf.twisted_curvature():.6f}")
0.050 0.282843
>>> petal = saddle(eta=0.1, xi=0.3)
>>> print(f"{petal.natural_curvature():.3f} {petal.energy(-0.3):.3f}")
-0.300 0.000
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from math import factorial

import numpy as np
from numpy.polynomial import Polynomial
from numpy.polynomial.polynomial import polyval
from numpy.typing import ArrayLike, NDArray

from .arrays import real_array
from .errors import InputError

__all__ = ["Saddle", "Twist", "saddle", "twist"]

Array = NDArray[np.float64]

_RATIO_FROM = 4.0  # z above which tau is taken from its quotient, where 1 - tau > 1/2 loses no digit
_TERMS = 10  # of the series up to there: the next is 4^44/44! = 1e-28 of the first
_PROFILE_FROM = 2.0  # z above which the deflection profile is taken from its quotient
_PROFILE_TERMS = 20  # of the profile's series up to there: its radius is z = 3.345, (2/3.345)^80 = 1e-18


def twist(eta: ArrayLike, xi: ArrayLike, chiral: ArrayLike = 0.0) -> Twist:
    """Edge growth g33 = xi (2x)^2 with a chiral growth g23 + g32 = chiral X1/a, Liu, Li & Liu, eq. (51).

    Parameters
    ----------
    eta : array_like
        Thickness over width, positive.
    xi : array_like
        Growth strain at the edges.
    chiral : array_like
        Through-thickness shear growth; the ribbon would twist by chiral/2 on its own.

    Raises
    ------
    InputError
        If an entry is not a finite number or eta is not positive.
    """
    return Twist(_positive(eta), _real("xi", xi), _real("chiral", chiral))


def saddle(eta: ArrayLike, xi: ArrayLike, form: str = "consistent") -> Saddle:
    """Growth gradient through the thickness, g33 = xi X1/a, Liu, Li & Liu, eq. (44).

    Parameters
    ----------
    eta : array_like
        Thickness over width, positive.
    xi : array_like
        Growth gradient.
    form : {"consistent", "published"}
        The published eqs. (47)-(50) leave the gradient out of the edge condition of the deflection; the
        consistent form keeps it, and then the ribbon bends into a stress-free cylinder.

    Raises
    ------
    InputError
        If an entry is not a finite number, eta is not positive, or the form is neither of the two.
    """
    if not isinstance(form, str) or form not in ("consistent", "published"):
        raise InputError("form", form, "'consistent' or 'published'")
    return Saddle(_positive(eta), _real("xi", xi), form)


@dataclass(frozen=True, eq=False)
class Twist:
    """Closed forms for edge growth and chirality; made by `twist`.

    With C = K3^2/2 - 4 xi and the relaxed deflection the energy is Liu, Li & Liu, eqs. (57)-(58), rearranged:

        Pi = (eps + K3^2/24 - xi/3)^2/2 + K1^2/24 + (eta^2/18)(K3 - chiral/2)^2
             + (eta^2/24) K2^2 + (sigma(z)/32)(K2^2 + 4 C)^2.

    Examples
    --------
    >>> leaf = twist(eta=0.1, xi=0.05)
    >>> flat, bent = leaf.energy(eps=0.05 / 3, K1=0, K2=[0, 0.17742699], K3=0) / 0.1**4
    >>> print(f"{flat:.6f} {bent:.6f}")
    1.111111 1.101999
    """

    eta: Array
    xi: Array
    chiral: Array

    def energy(self, eps: ArrayLike, K1: ArrayLike, K2: ArrayLike, K3: ArrayLike) -> Array:
        """Energy per unit length, the class's equation, in units of Y h a."""
        K2, K3 = _real("K2", K2), _real("K3", K3)
        crown = K2**2 + 2 * K3**2 - 16 * self.xi  # K2^2 + 4 C
        relaxed = self.eta**2 * K2**2 / 24 + _sigma(_z(self.eta, K2)) / 32 * crown**2
        return self._uniform(eps, K1, K3) + relaxed

    def energy_second_order(self, eps: ArrayLike, K1: ArrayLike, K2: ArrayLike, K3: ArrayLike) -> Array:
        """Taylor polynomial of `energy` to second order in K2, Liu, Li & Liu, eq. (59).

        The same uniform terms, and C^2/360 + K2^2 [eta^2/24 + C/720 - C^2/(20160 eta^2)]. The series it
        begins converges for abs(K2)/eta < 7.458.
        """
        K2, K3 = _real("K2", K2), _real("K3", K3)
        C = K3**2 / 2 - 4 * self.xi
        soft = self.eta**2 / 24 + C / 720 - C**2 / (20160 * self.eta**2)
        return self._uniform(eps, K1, K3) + C**2 / 360 + K2**2 * soft

    def deflection(self, x: ArrayLike, K2: ArrayLike, K3: ArrayLike) -> Array:
        """Relaxed deflection U = u1/a at x = X2/a, Liu, Li & Liu, eqs. (53)-(55) without their sign(K2).

            U = (K2 + 4 C/K2) H(x) + C (x^2 - 1/12)/K2,
            H = [A cos(zx) cosh(zx) - B sin(zx) sinh(zx)] / [2 z^2 (sin z + sinh z)],
            A, B = cosh(z/2) sin(z/2) -+ cos(z/2) sinh(z/2);

        the poles at K2 = 0 cancel, leaving U = K2 [H + 9 (C/eta^2) G], G = (H - (1 - 12 x^2)/48)/z^4.
        """
        K2, K3 = _real("K2", K2), _real("K3", K3)
        C = K3**2 / 2 - 4 * self.xi
        H, G = _profiles(_across(x), _z(self.eta, K2))
        return K2 * (H + 9 * C / self.eta**2 * G)

    @property
    def threshold(self) -> Array:
        """Edge growth xi = 5 eta^2 beyond which a flat unloaded ribbon twists, from Liu, Li & Liu, eq. (64).

        The K3^2 terms of the unloaded energy are eta^2/18 from torsion and -4 xi/360 from C^2/360.

        Raises
        ------
        InputError
            With chiral growth, which twists the ribbon from the start.
        """
        if np.any(self.chiral):
            raise InputError(
                "chiral", self.chiral, "0, as chiral growth twists the ribbon without a threshold"
            )
        return 360 / 4 * self.eta**2 / 18

    def twisted_curvature(self) -> Array:
        """Twist K3 of the unloaded ribbon that stays straight (K2 = 0); 0 where there is none.

        Without chirality Liu, Li & Liu, eq. (64), K3 = 2 sqrt(2) sqrt(xi - 5 eta^2), or its mirror image -K3.
        With it the root of dPi/dK3 = 0 that has the sign of the chirality,
        K3^3 + 8 (5 eta^2 - xi) K3 = 20 eta^2 chiral.
        """
        p = 8 * (5 * self.eta**2 - self.xi)
        r = 20 * self.eta**2 * np.abs(self.chiral)
        # t^3 + p t - r is convex for t > 0, has one root there and starts >= 0: Newton descends to it.
        t = np.sqrt(np.maximum(-p, 0.0)) + np.cbrt(r)
        for _ in range(60):
            slope = 3 * t**2 + p
            t = t - (t**3 + p * t - r) / np.where(slope > 0, slope, 1.0) * (slope > 0)
        return np.where(self.chiral < 0, -t, t)[()]

    def _uniform(self, eps: ArrayLike, K1: ArrayLike, K3: Array) -> Array:
        stretch = _real("eps", eps) + K3**2 / 24 - self.xi / 3
        torsion = self.eta**2 / 18 * (K3 - self.chiral / 2) ** 2
        return stretch**2 / 2 + _real("K1", K1) ** 2 / 24 + torsion


@dataclass(frozen=True, eq=False)
class Saddle:
    """Closed forms for a growth gradient through the thickness; made by `saddle`.

    Consistent, with kappa = K2 + xi (at K3 = 0 the last two terms are (eta^2/18) kappa^2 (1 - tau/4)):

        Pi = (eps + K3^2/24)^2/2 + K1^2/24 + (eta^2/18) K3^2
             + (eta^2/24) kappa^2 + (sigma(z)/32)(K2 kappa + 2 K3^2)^2.

    Published, Liu, Li & Liu, eq. (49) with abs(K2)^(-1/2) K2 (K2 + 2 xi) for the misprinted root of (50);
    it is derived for K3 = 0, and a twist adds only torsion and mean stretch:

        Pi = (eps + K3^2/24)^2/2 + K1^2/24
             + (eta^2/18) [K3^2 + (K2 + xi)^2 - K2 (K2 + 2 xi) tau/4].

    Examples
    --------
    >>> k = saddle(eta=0.05, xi=[0.1, 0.2, 0.3], form="published").natural_curvature()
    >>> print(*(f"{K2:.5f}" for K2 in k))
    -0.10144 -0.20767 -0.31482
    """

    eta: Array
    xi: Array
    form: str

    def energy(self, K2: ArrayLike, eps: ArrayLike = 0.0, K1: ArrayLike = 0.0, K3: ArrayLike = 0.0) -> Array:
        """Energy per unit length, the class's equation, in units of Y h a."""
        K2, K3, eps = _real("K2", K2), _real("K3", K3), _real("eps", eps)
        z = _z(self.eta, K2)
        kappa = K2 + self.xi
        uniform = (eps + K3**2 / 24) ** 2 / 2 + _real("K1", K1) ** 2 / 24 + self.eta**2 / 18 * K3**2
        if self.form == "published":
            bending = kappa**2 - K2 * (K2 + 2 * self.xi) * _tau(z) / 4
            return uniform + self.eta**2 / 18 * bending
        relaxed = self.eta**2 / 24 * kappa**2 + _sigma(z) / 32 * (K2 * kappa + 2 * K3**2) ** 2
        return uniform + relaxed

    def deflection(self, x: ArrayLike, K2: ArrayLike) -> Array:
        """Relaxed deflection U = u1/a at x = X2/a for K3 = 0.

        U = (K2 + xi) H(x), which vanishes in the stress-free cylinder; published, U = K2 H(x), which is
        eq. (48) without its sign(K2). H is that of `Twist.deflection`.
        """
        K2 = _real("K2", K2)
        edge = K2 if self.form == "published" else K2 + self.xi
        return edge * _profiles(_across(x), _z(self.eta, K2))[0]

    def natural_curvature(self) -> Array:
        """Curvature K2 of least energy at K3 = 0.

        Consistent: -xi, where the energy vanishes. Published: -rho xi with rho in [1, 2) the root of

            dPi/dK2 = 0 = (1 - rho)(2 - tau/2) - (2 - rho) z tau'(z)/8,

        bisected to rounding: the left side is positive at rho = 1 and negative at rho = 2.
        """
        if self.form == "consistent":
            return -self.xi
        low = np.ones(np.broadcast(self.eta, self.xi).shape)
        high = 2 * low
        for _ in range(54):
            rho = (low + high) / 2
            z = _z(self.eta, rho * self.xi)
            rising = (1 - rho) * (2 - _tau(z) / 2) - (2 - rho) * _z_tau_slope(z) / 8 > 0
            low, high = np.where(rising, rho, low), np.where(rising, high, rho)
        return (-low * self.xi)[()]


def _real(name: str, value: ArrayLike) -> Array:
    return real_array(name, value, "finite numbers")


def _across(x: ArrayLike) -> Array:
    """Places x = X2/a within the width."""
    expected = "numbers in [-1/2, 1/2]"
    array = real_array("x", x, expected)
    if np.any(np.abs(array) > 0.5):
        raise InputError("x", x, expected)
    return array


def _positive(value: ArrayLike) -> Array:
    eta = _real("eta", value)
    if not np.all(eta > 0):
        raise InputError("eta", value, "positive numbers")
    return eta


def _z(eta: Array, K2: Array) -> Array:
    return np.sqrt(1.5 * np.abs(K2) / eta)


def _series(w: Array) -> tuple[Array, Array, Array, Array]:
    """P, D, w P', w D' of 1 - tau = P/D, w = z^4: P = sum 4j w^j/(4j+2)!, D = sum w^j/(4j+1)!."""
    j = np.arange(_TERMS + 1)
    p = np.array([4 * i / factorial(4 * i + 2) for i in j])
    d = np.array([1 / factorial(4 * i + 1) for i in j])
    return polyval(w, p), polyval(w, d), polyval(w, j * p), polyval(w, j * d)


def _quotient(z: Array) -> tuple[Array, Array]:
    """Tau and z tau' for large z, all exponentials scaled by exp(-z)."""
    decay = np.exp(-z)
    top = 1 + decay**2 - 2 * decay * np.cos(z)
    bottom = 1 - decay**2 + 2 * decay * np.sin(z)
    tau = 2 / z * top / bottom
    return tau, -tau + 8 * decay * np.sin(z) * (1 - decay**2) / bottom**2


def _tau(z: Array) -> Array:
    P, D, _, _ = _series(np.minimum(z, _RATIO_FROM) ** 4)
    return np.where(z < _RATIO_FROM, 1 - P / D, _quotient(np.maximum(z, _RATIO_FROM))[0])


def _z_tau_slope(z: Array) -> Array:
    P, D, wP, wD = _series(np.minimum(z, _RATIO_FROM) ** 4)
    return np.where(z < _RATIO_FROM, -4 * (wP * D - P * wD) / D**2, _quotient(np.maximum(z, _RATIO_FROM))[1])


def _sigma(z: Array) -> Array:
    w = np.minimum(z, _RATIO_FROM) ** 4
    j = range(_TERMS)
    p = np.array([4 * (i + 1) / factorial(4 * i + 6) for i in j])  # P/w
    d = np.array([1 / factorial(4 * i + 1) for i in j])
    large = np.maximum(z, _RATIO_FROM)
    sigma: Array = np.where(
        z < _RATIO_FROM, polyval(w, p) / polyval(w, d), (1 - _quotient(large)[0]) / large**4
    )
    return sigma


@cache
def _profile_series() -> tuple[Polynomial, ...]:
    """Coefficients of w^n in G, of zero mean.

    G_n'''' = -4 G_{n-1}, G_n'' = G_n''' = 0 at the edges, and G_{-1} = H at z = 0.
    """
    G = Polynomial([1 / 48, 0, -1 / 4])
    terms = []
    for _ in range(_PROFILE_TERMS):
        G = (-4 * G).integ(2, lbnd=-0.5).integ(2)
        mean = G.integ()
        G = G - (mean(0.5) - mean(-0.5))
        G = Polynomial(np.where(np.arange(G.coef.size) % 2, 0.0, G.coef))  # H is even
        terms.append(G)
    return tuple(terms)


def _profiles(x: Array, z: Array) -> tuple[Array, Array]:
    """H(x), the deflection per curvature, and G(x) = (H(x) - (1 - 12 x^2)/48) / z^4."""
    crown = (1 - 12 * x**2) / 48
    w = np.minimum(z, _PROFILE_FROM) ** 4
    series: Array = np.zeros(np.broadcast(x, z).shape)
    for term in reversed(_profile_series()):
        series = series * w + term(x)
    large = np.maximum(z, _PROFILE_FROM)
    half, near, far = large / 2, np.exp(large * (np.abs(x) - 0.5)), np.exp(-large * (np.abs(x) + 0.5))
    cosh_x, sinh_x = (near + far) / 2, np.sign(x) * (near - far) / 2  # scaled by exp(-z/2), like those of z/2
    cosh_h, sinh_h = (1 + np.exp(-large)) / 2, (1 - np.exp(-large)) / 2
    A = cosh_h * np.sin(half) - np.cos(half) * sinh_h
    B = cosh_h * np.sin(half) + np.cos(half) * sinh_h
    bottom = np.exp(-large) * np.sin(large) + (1 - np.exp(-2 * large)) / 2
    H = (A * np.cos(large * x) * cosh_x - B * np.sin(large * x) * sinh_x) / (2 * large**2 * bottom)
    quotient = z >= _PROFILE_FROM
    G = np.where(quotient, (H - crown) / large**4, series)
    return np.where(quotient, H, crown + w * series), G
