"""The numbers that Liu, Li & Liu state, in the text and on figures."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from .. import analytic, growth
from ..arrays import Array
from ..continuation import trace
from ..equilibrium import natural_shapes
from ..law import SectionLaw
from ..ribbon import Ribbon
from ..scene import Scene
from .row import PAPER, Row

__all__ = ["rows"]

DIGITS = "digits printed"
COUNT = "a count"
BRANCH = "branch points to 1e-13 of the span"
FIRST = "The flat ribbon bends first, at xi = 4.5467 eta^2."
NO_SECOND = (
    "On the twisted branch the stiffness in K2 is the same for every xi and negative, so that nothing "
    "branches off from it; with a trace of chirality it is positive first, and helices do branch off."
)


def rows() -> Iterator[Row]:
    """Yield thresholds, counts and trends."""
    yield from _saddle()
    yield from _energies()
    yield from _first_threshold()
    yield from _second_threshold()
    yield from _problem()


def _saddle() -> Iterator[Row]:
    """Section 3.1: the curvature over the growth gradient."""
    wrong = "It is so with the growth gradient in the edge condition (35), not by (49)-(50)."
    for form, why in (("published", wrong), ("consistent", "")):
        thin, thick = (analytic.saddle(eta, [0.1, 0.3], form=form).natural_curvature() for eta in (0.05, 0.1))
        by = "(49)-(50)" if form == "published" else "edge condition mended"
        told = f"{PAPER}, Fig. 4(b)"
        yield Row(f"K2(xi = 0.3)/K2(0.1), linear in xi, {by}", told, 3.0, thin[1] / thin[0], 1e-14, wrong=why)
        told = f"{PAPER}, text of Fig. 5"
        name = f"K2(eta = 0.1)/K2(0.05), xi = 0.3, {by}"
        yield Row(name, told, 1.0, thick[1] / thin[1], 1e-14, wrong=why)


def _energies() -> Iterator[Row]:
    """Figs. 6-8: extrema of the energy over K3 at K2 = 0."""
    source = f"{PAPER}, Fig. 6"
    free = "With n3 = 0 a ribbon of eta = 0.1 twists beyond xi = 0.05; the figure is drawn with eps = 0."
    for held, why in (("eps = 0", ""), ("n3 = 0", free)):
        found = _extrema(0.1, 0.03, held == "n3 = 0")
        name = f"extrema at eta = 0.1, xi = 0.03, {held}"
        yield Row(name, source, 3.0, float(found.size), 0.0, COUNT, why)
    for figure, pairs in (
        ("Fig. 6", [(0.1, 0.03)]),
        ("Fig. 7", [(eta, 0.03) for eta in (0.05, 0.06, 0.07, 0.08)]),
        ("Fig. 8", [(0.05, xi) for xi in (0.01, 0.02, 0.03, 0.04)]),
    ):
        for eta, xi in pairs:
            held = (8.0 * xi - 160.0 * eta**2 / 9.0) ** 0.5
            largest = float(np.max(_extrema(eta, xi, False)))
            told = f"{PAPER}, (59), {figure}"
            yield Row(f"K3 at eta = {eta}, xi = {xi}, eps = 0", told, held, largest, 5e-15)


def _extrema(eta: float, xi: float, free: bool) -> Array:
    """K3 of the extrema of the energy at K2 = 0, for eps = 0 or n3 = 0; m3 is odd and cubic in K3."""
    K3 = np.array([0.1, 0.2])
    eps = xi / 3.0 - K3**2 / 24.0 if free else 0.0 * K3
    zero = 0.0 * K3
    strains = np.stack([eps, zero, zero, K3], axis=-1)
    m3 = SectionLaw(eta, growth.edge(xi)).gradient(strains)[:, 3]
    cubic, linear = np.linalg.solve(np.stack([K3**3, K3], axis=-1), m3)
    if linear >= 0.0:
        return np.zeros(1)
    twist = float(np.sqrt(-linear / cubic))
    return np.array([-twist, 0.0, twist])


def _branch_points(eta: float, span: tuple[float, float]) -> tuple[list[float], int]:
    """Edge growth at which the flat ribbon bends and twists, and how often the twisted one branches."""
    scene = Scene(Ribbon(10.0, 1.0, eta), growth.edge(0.0))
    diagram = trace(scene, "growth.edge.amplitude", span)
    points = [p for p in diagram.special_points if p.kind == "branch_point"]
    twisted = {b.number for b in diagram.branches if set(b.phases[1:]) == {"twisted"}}
    flat = [p.parameter for p in points if p.branch == 0]
    return flat, sum(p.branch in twisted for p in points)


def _first_threshold() -> Iterator[Row]:
    """Text below (64), Figs. 9-12: where the flat ribbon becomes unstable, and where it twists."""
    (bend, twist), _ = _branch_points(0.1, (0.0, 0.08))
    source = f"{PAPER}, text of (64)"
    yield Row("xi/eta^2, flat to twisted", source, 5.0, twist / 0.01, 1e-12, BRANCH)
    yield Row("xi/eta^2, flat loses stability", source, 5.0, bend / 0.01, 1e-12, BRANCH, FIRST)
    source = f"{PAPER}, text of Fig. 10"
    yield Row("xi, flat to twisted, eta = 0.1", source, 0.05, twist, 5e-3, DIGITS)
    wrong = "Its own (64) and the text of Fig. 10 say 0.050."
    source = f"{PAPER}, text of Fig. 11"
    yield Row("xi, flat to twisted, eta = 0.1", source, 0.052, twist, 5e-4, DIGITS, wrong, 0.050)
    (_, thin), _ = _branch_points(0.05, (0.0, 0.02))
    wrong = "A digit is lost: 0.0125, which is 5 eta^2."
    yield Row("xi, flat to twisted, eta = 0.05", source, 0.125, thin, 5e-5, DIGITS, wrong, 0.0125)


def _second_threshold() -> Iterator[Row]:
    """Figs. 10-12: where a twisted ribbon is said to become a helix."""
    scaled = 0.013 * (0.1 / 0.05) ** 2
    printed = 4.0 * 5e-4 + 5e-4
    wrong = "A digit is lost: 0.053. Thresholds are multiples of eta^2, and 0.013 at eta = 0.05 makes 0.052."
    name = "0.013 of eta = 0.05, scaled by eta^2 to eta = 0.1"
    yield Row(name, f"{PAPER}, text of Fig. 10", 0.53, scaled, printed, DIGITS, wrong, 0.053)
    yield Row(name, f"{PAPER}, text of Fig. 11", 0.054, scaled, printed, DIGITS)
    for eta, xi, figure in ((0.05, 0.013, "Fig. 11"), (0.1, 0.053, "Fig. 10"), (0.1, 0.054, "Fig. 11")):
        states = natural_shapes(Ribbon(10.0, 1.0, eta), growth.edge(xi))
        twisted = next(state for state in states if state.phase == "twisted")
        stiffness = SectionLaw(eta, growth.edge(xi)).hessian(twisted.strains[0])[2, 2] / eta**2
        name = f"dm2/dK2 / eta^2, twisted, eta = {eta}, xi = {xi}"
        yield Row(name, f"{PAPER}, text of {figure}", 0.0, float(stiffness), 1e-13, wrong=NO_SECOND)
    _, count = _branch_points(0.1, (0.0, 0.1))
    name = "branch points of twisted ribbons, eta = 0.1"
    yield Row(name, f"{PAPER}, Fig. 10", 1.0, float(count), 0.0, COUNT, NO_SECOND)

    eta, xi = 0.05, 5.4 * 0.05**2
    state = natural_shapes(Ribbon(10.0, 1.0, eta), growth.edge(xi))[0]
    edge, centre = (
        float(np.mean(np.abs(state.deflection(x)[0]))) for x in (np.linspace(0.4, 0.5, 21), [0.0])
    )
    wrong = "The deflection is about (1 - 12 x^2) times a constant: larger at the edges, twice so at first."
    name = "|u1| in 0.4 < X2/a < 0.5 over that of the centre"
    yield Row(name, f"{PAPER}, text of Fig. 11", 1.0, edge / centre, 1e-14, wrong=wrong, bound="<=")


def _problem() -> Iterator[Row]:
    """Text below (67): how many unknowns."""
    state = natural_shapes(Ribbon(10.0, 1.0, 0.1), growth.edge(0.06))[0]
    listed = (state.strains, state.position, state.quaternion)
    wrong = "eps, kappa_i, r_i and q are 11; the reactions N1 and N2 are the other two, and do not vanish."
    values = 13.0, float(sum(numbers.shape[1] for numbers in listed))
    yield Row("unknowns eps, kappa_i, r_i, q", f"{PAPER}, text of (67)", *values, 0.0, COUNT, wrong)
