"""Linear stability of a flat strip whose edges grow, as a plate: Foeppl and von Karman's equations.

The strip |x| <= 1/2, infinite along S, lengths in units of its width, has grown by g33 = xi (2x)^2 and lies
flat without axial force, under the stress s33 = Y xi (1/3 - 4 x^2). Deflections w(x) cos(k S) leave it where

    (eta^2/24) int [Q33 k^4 w^2 - 2 Q23 k^2 w w'' + Q22 w''^2 + 4 G k^2 w'^2] dx + 1/2 int s33 k^2 w^2 dx

loses its definiteness (the mean over S, times 2; Y = Q33 - Q23^2/Q22). Displacements in the plane strain the
strip to first order and the deflection to second order only, so that the second variation at the flat strip
has no product of the two. The part in the plane alone is that of the membrane's own stiffness, positive.

The free edges' conditions are natural ones: the functions tried need not satisfy any. w'' is a Legendre
series, and w its double integral plus what bends the strip along S, A/k^2, or twists it, T x/k. With this
scaling k = 0 is a wave number as any other, the limit of long waves. Nothing is taken from ribbonrs.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.polynomial import Legendre
from scipy.linalg import eigh

INCOMPRESSIBLE = (4 / 3, 4 / 3, 2 / 3, 1 / 3)
"""Q33, Q22, Q23, G over Young's modulus."""


def isotropic(nu: float) -> tuple[float, float, float, float]:
    """Q33, Q22, Q23, G of Young's modulus 1."""
    return 1 / (1 - nu**2), 1 / (1 - nu**2), nu / (1 - nu**2), 1 / (2 * (1 + nu))


def shape(n: int) -> Legendre:
    """The function with second derivative P_n(2x), without its components on 1 and x."""
    double = Legendre.basis(n, domain=[-0.5, 0.5]).integ(2)
    coefficients = double.coef.copy()
    coefficients[:2] = 0.0
    return Legendre(coefficients, domain=[-0.5, 0.5])


def threshold(
    k: float,
    twist: bool,
    stiffness: tuple[float, ...] = INCOMPRESSIBLE,
    terms: int = 12,
    middle: bool = False,
) -> float:
    """xi/eta^2 at which the flat strip goes over to waves of number k.

    `twist` picks deflections odd in x, else even; `terms` of each parity are tried. It is the least positive
    one, or if the `middle` grows more than the edges the greatest negative one.
    """
    Q33, Q22, Q23, G = stiffness
    t, weights = np.polynomial.legendre.leggauss(2 * terms + 8)
    x, weights = t / 2, weights / 2
    functions = [shape(2 * i + twist) for i in range(terms)]
    v, dv, ddv = (np.array([f.deriv(m)(x) for f in functions]) for m in range(3))
    # k^2 w, k w' and k w of the rigid function, then of the series. Of A/k^2 the last lacks A/k, see below.
    one, none = np.ones(x.size), np.zeros(x.size)
    rigid = (k * x, one, x) if twist else (one, none, none)
    k2w, kdw, kw = map(np.vstack, zip(rigid, (k**2 * v, k * dv, k * v), strict=True))
    ddw = np.vstack((none, ddv))

    def product(f: Any, g: Any) -> Any:
        return (f * weights) @ g.T

    coupling = product(k2w, ddw)
    bending = Q33 * product(k2w, k2w) - Q23 * (coupling + coupling.T) + Q22 * product(ddw, ddw)
    bending += 4 * G * product(kdw, kdw)
    grown = 4 * x**2 - 1 / 3
    softening = product(grown * kw, kw)
    if not twist:  # A/k meets k v; the square of A/k has no part, as the stress has no resultant
        softening[0, 1:] = softening[1:, 0] = v @ (grown * weights)
    softening *= 12 * (Q33 - Q23**2 / Q22)
    inverse = eigh(softening, bending, eigvals_only=True)
    return float(1 / inverse[0 if middle else -1])
