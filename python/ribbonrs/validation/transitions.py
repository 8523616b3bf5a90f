"""Where ribbons with grown edges change shape: closed forms and roots of them against the program.

k_i = K_i/eta, x = xi/eta^2, omega = d23/(2 eta), c = k3^2/2 - 4 x; unloaded, eps follows from n3 = 0. Then

    Pi/eta^4 = (k3 - omega)^2/18 + Phi(k2, c),
    Phi = [k2^2 (1 - tau/4) + 2 c (1 - tau) + 4 c^2 (1 - tau)/k2^2]/18,
    tau = (2/z)(cosh z - cos z)/(sinh z + sin z),  z = (3 k2/2)^(1/2),

which is Liu, Li & Liu, eqs. (57)-(58); to second order in k2, eq. (59), c^2/360 + A(c) k2^2 with
A = 1/24 + c/720 - c^2/20160. Nothing of the program's law enters these.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from math import factorial, sqrt

import numpy as np
from scipy.optimize import brentq, newton, root  # type: ignore[import-untyped]

from .. import growth
from ..arrays import Array
from ..continuation import trace
from ..equilibrium import SERIES_RADIUS, natural_shapes
from ..law import SectionLaw
from ..ribbon import Ribbon
from ..scene import Scene
from .row import PAPER, Row, farthest

__all__ = ["rows"]

ETA = 0.01
"""Thin, so that the growth of wide twists stays small; in scaled quantities it does not matter."""
LEAF = Ribbon(10.0, 1.0, ETA)
LOW, HIGH = 14.0 - sqrt(1036.0), 14.0 + sqrt(1036.0)
"""Roots c of A, between which a twisted ribbon does not bend."""
CLOSED = "closed form"
ROOT = "root of (57)-(58)"
SOLVED = "root by Newton's method"
EDGE = "growth.edge.amplitude"


def _shapes(xi: float, omega: float = 0.0, law: str = "full") -> list[tuple[str, Array]]:
    """Every natural shape: its phase and k2, k3, lowest energy first."""
    grown = growth.edge(xi * ETA**2) + growth.chiral(2.0 * ETA * omega)
    strains, _, _, phases, _ = SectionLaw(ETA, grown, law=law).core().natural_shapes()
    return list(zip(phases, strains[:, 2:] / ETA, strict=True))


def _branch_points(omega: float, name: str, span: tuple[float, float]) -> list[tuple[float, Array]]:
    """The branch points of a trace: parameter and strains."""
    scene = Scene(LEAF, growth.edge(0.0) + growth.chiral(2.0 * ETA * omega))
    points = trace(scene, name, span).special_points
    return [(p.parameter, p.state.strains[0]) for p in points if p.kind == "branch_point"]


def rows() -> Iterator[Row]:
    """Yield transitions, states beyond them and what the series of (59) is good for."""
    yield from _onsets()
    yield from _states()
    yield from _second_order()


def _onsets() -> Iterator[Row]:
    # xi/eta^2 runs from 0 to 8 and omega to 40; the places of branch points are told to 2e-12 of a branch.
    told = "branch points to 2e-12 of the span"
    (bend, _), (twist, _) = _branch_points(0.0, EDGE, (0.0, 8.0 * ETA**2))
    yield Row("xi/eta^2, flat to bent", CLOSED, (-7.0 + sqrt(259.0)) / 2.0, bend / ETA**2, 2e-11, told)
    yield Row("xi/eta^2, flat to twisted", CLOSED, 5.0, twist / ETA**2, 2e-11, told)

    def stiffness(c: float) -> float:
        law = SectionLaw(ETA, growth.edge(-c / 4.0 * ETA**2))
        return float(law.hessian([0.0, 0.0, 0.0, 0.0])[2, 2]) / ETA**2

    yield Row("C/eta^2 of no stiffness in K2", CLOSED, HIGH, brentq(stiffness, 0.0, 60.0, xtol=1e-13), 1e-12)
    for omega in (0.2, 0.2226):
        k3 = omega / (1.0 + LOW / 20.0)
        (onset, strain), *_ = _branch_points(omega, EDGE, (0.0, 8.0 * ETA**2))
        where = f"twisted to helical, omega = {omega}"
        yield Row(f"xi/eta^2, {where}", CLOSED, (k3**2 / 2.0 - LOW) / 4.0, onset / ETA**2, 2e-11, told)
        yield Row(f"K3/eta, {where}", CLOSED, k3, strain[3] / ETA, 2e-11, told)
    (onset, strain), *_ = _branch_points(0.0, "growth.chiral.amplitude", (0.1 * ETA, 80.0 * ETA))
    k3 = sqrt(2.0 * HIGH)
    values = k3 * (1.0 + HIGH / 20.0), onset / (2.0 * ETA)
    yield Row("omega, twisted to helical, xi = 0", CLOSED, *values, 1e-10, told)
    yield Row("K3/eta, twisted to helical, xi = 0", CLOSED, k3, strain[3] / ETA, 1e-10, told)


def _states() -> Iterator[Row]:
    """Bent and helical ribbons beyond the onsets."""
    grown = (4.7, 5.0, 6.0, 10.0, 20.0)
    found = [next(k[0] for phase, k in _shapes(x) if phase == "bent") for x in grown]
    exact = []
    for x in grown:

        def bent(k: Array, c: float = -4.0 * x) -> complex:
            return _phi(k[0], c)

        exact.append(_stationary(bent, [sqrt(8.0 * (x - 4.5))])[0])
    yield Row("K2/eta of bent ribbons", ROOT, *farthest(exact, found), 1e-10, SOLVED)
    x, omega = 6.0, 0.2

    def energy(k: Array) -> complex:
        return complex((k[1] - omega) ** 2 / 18.0 + _phi(k[0], k[1] ** 2 / 2.0 - 4.0 * x))

    k2, k3 = _stationary(energy, [2.4, 2.2])
    helix = next(k for phase, k in _shapes(x, omega) if phase == "helical" and k[0] > 0.0)
    yield Row("K2/eta of the helix, xi = 6 eta^2, omega = 0.2", ROOT, k2, helix[0], 1e-10, SOLVED)
    yield Row("K3/eta of the helix, xi = 6 eta^2, omega = 0.2", ROOT, k3, helix[1], 1e-10, SOLVED)

    law = SectionLaw(ETA, growth.edge(6.0 * ETA**2))
    twisted = next(s.strains[0] for s in natural_shapes(LEAF, law.growth) if s.phase == "twisted")
    yield Row("eps/eta^2 of twisted ribbons", CLOSED, 5.0 / 3.0, twisted[0] / ETA**2, 1e-14)
    C = twisted[3] ** 2 / (2.0 * ETA**2) - 24.0
    yield Row("C/eta^2 of twisted ribbons", CLOSED, -20.0, C, 1e-13)
    stiffness = float(law.hessian(twisted)[2, 2]) / ETA**2
    yield Row("dm2/dK2 / eta^2 of twisted ribbons", CLOSED, -1.0 / 84.0, stiffness, 1e-14)


def _second_order() -> Iterator[Row]:
    """The states and the reach of (59)."""
    x = 6.0
    k2 = sqrt((HIGH / 180.0 + 1.0 / 9.0) / (HIGH / 10080.0 - 1.0 / 720.0))
    k3 = sqrt(2.0 * HIGH + 8.0 * x)
    quadratic = next(k for phase, k in _shapes(x, law="quadratic") if phase == "helical")
    yield Row("K2/eta of (59)'s helix, xi = 6 eta^2", CLOSED, k2, abs(quadratic[0]), 1e-11)
    yield Row("K3/eta of (59)'s helix, xi = 6 eta^2", CLOSED, k3, abs(quadratic[1]), 1e-11)
    helical = sum(phase == "helical" for xi in np.arange(0.5, 40.0, 0.5) for phase, _ in _shapes(xi))
    yield Row(
        "helices for xi up to 40 eta^2, the full law",
        f"{PAPER}, (59)",
        float(sum(phase == "helical" for phase, _ in _shapes(x, law="quadratic"))),
        float(helical),
        0.0,
        "a count",
        "(59)'s helix lies beyond the radius in which its series converges; the full law has none without "
        "chirality.",
    )
    zero = newton(lambda z: np.sinh(z) + np.sin(z), 2.4 + 2.4j, fprime=lambda z: np.cosh(z) + np.cos(z))
    radius = float(abs(zero) ** 2) * 2.0 / 3.0
    source = "zero of sinh z + sin z"
    yield Row("radius K2/eta of (59)'s series", source, radius, _radius(), 1e-12)
    yield Row("radius that warnings go by", source, radius, SERIES_RADIUS, 5e-5, "digits kept")


def _radius() -> float:
    """Radius in k2 of the series of tau, from the ratio of its coefficients: its nearest pole is simple."""
    terms = 24
    top = [4.0 * j / factorial(4 * j + 2) for j in range(terms)]
    bottom = [1.0 / factorial(4 * j + 1) for j in range(terms)]
    series: list[float] = []  # of 1 - tau in z^4
    for j in range(terms):
        series.append(top[j] - sum(bottom[j - i] * series[i] for i in range(j)))
    return float(abs(series[-2] / series[-1]) ** 0.5 * 2.0 / 3.0)


def _phi(k2: complex, c: complex) -> complex:
    z = np.sqrt(1.5 * k2)
    tau = 2.0 / z * (np.cosh(z) - np.cos(z)) / (np.sinh(z) + np.sin(z))
    found: complex = (k2**2 * (1.0 - tau / 4.0) + (2.0 * c + 4.0 * c**2 / k2**2) * (1.0 - tau)) / 18.0
    return found


def _stationary(energy: Callable[[Array], complex], guess: list[float]) -> Array:
    """Root of the gradient, which complex steps give to rounding."""

    def gradient(k: Array) -> list[float]:
        steps = 1e-30j * np.eye(len(k))
        return [complex(energy(k + step)).imag / 1e-30 for step in steps]

    found: Array = root(gradient, guess, tol=1e-13).x
    return found
