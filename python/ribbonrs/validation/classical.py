"""Classical rods by the boundary-value solver: columns, cantilevers, rings and the elastica.

Rods of length 1 and EI2 = 1; constants are roots of transcendental functions found by scipy.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
from scipy.optimize import brentq  # type: ignore[import-untyped]
from scipy.special import ellipe, ellipeinc, ellipk, ellipkinc, jv  # type: ignore[import-untyped]

from .. import growth
from ..continuation import trace
from ..ends import Clamped, Free, Sliding
from ..equilibrium import solve
from ..law import SectionLaw
from ..linear import LinearLaw
from ..ribbon import Ribbon
from ..scene import Scene
from .row import Row

__all__ = ["cantilever", "elastica", "rows"]

CLOSE = 1e-10
"""Error of a branch point relative to the span: meshes are refined until it moves by less than 2e-11."""
MESH = "the mesh, 1e-10 of the span"


def rows() -> Iterator[Row]:
    """Yield buckling loads, the elastica beyond and the stiffnesses of a ribbon that has not grown."""
    for name, source, load, parameter, scene in (
        ("P L^2/EI, clamped-free", "Euler 1744", -(math.pi**2) / 4.0, "end.force[2]", _column),
        ("P L^2/EI, clamped-clamped", "Euler 1744", -4.0 * math.pi**2, "end.force", _clamped),
        ("q L^3/EI, column by its weight", "Greenhill 1881", -_greenhill(), "gravity[2]", _heavy),
        ("P L^2/(EI2 GJ)^(1/2), lateral", "Prandtl 1899, Michell 1899", _prandtl(), "end.force[1]", _tip),
        ("q L^3/(EI2 GJ)^(1/2), lateral", "its weight, J_-1/6", _lateral_weight(), "gravity[1]", _blade),
    ):
        found = _buckling(scene(0.97 * load), parameter, load)
        yield Row(name, source, abs(load), abs(found), CLOSE * 0.1 * abs(load), MESH)
    turns = math.sqrt(3.0)
    told = "twist is differentiated by differences of 1e-7"
    yield Row("turns GJ/EI, twisted ring", "Michell 1889, Zajac 1962", turns, _ring() * 1.5, 2e-9, told)
    yield from _elastica()
    yield from _stiffnesses()


def _law(EI1: float = 100.0, GJ: float = 1.0) -> LinearLaw:
    return LinearLaw(EI1=EI1, EI2=1.0, GJ=GJ, inextensible=True)


def _rod(law: LinearLaw, **scene: Any) -> Scene:
    return Scene(Ribbon(1.0, 1.0, 0.1), law=law, **scene)


def _column(load: float) -> Scene:
    return _rod(_law(), end=Free((0.0, 0.0, load)))


def _clamped(load: float) -> Scene:
    return _rod(_law(), end=Sliding(force=load))


def _heavy(load: float) -> Scene:
    return _rod(_law(), gravity=(0.0, 0.0, load))


def _tip(load: float) -> Scene:
    """The rod does not bend in its stiff plane."""
    return _rod(_law(math.inf), end=Free((0.0, load, 0.0)))


def _blade(load: float) -> Scene:
    return _rod(_law(math.inf), gravity=(0.0, load, 0.0))


def _bessel(order: float) -> float:
    """The least zero of J_order, for orders between -1/3 and 0."""
    return float(brentq(lambda x: jv(order, x), 1.0, 3.0, xtol=1e-15))


def _greenhill() -> float:
    return 2.25 * _bessel(-1.0 / 3.0) ** 2


def _prandtl() -> float:
    return 2.0 * _bessel(-0.25)


def _lateral_weight() -> float:
    return 6.0 * _bessel(-1.0 / 6.0)


def _buckling(scene: Scene, parameter: str, load: float) -> float:
    """The only branch point along the straight rod within 5 % of a load."""
    span = (min(0.95 * load, 1.05 * load), max(0.95 * load, 1.05 * load))
    diagram = trace(scene, parameter, span, start=solve(scene, guess=np.zeros(4)), depth=0)
    (found,) = (p.parameter for p in diagram.special_points if p.kind == "branch_point")
    return float(found)


def _ring() -> float:
    """Turns at which a ring of a round rod, cut, twisted and closed, leaves its plane; GJ = 3/2 EI."""
    clamp = Clamped((0.0, 0.0, 0.0))
    scene = _rod(_law(1.0, 1.5), start=clamp, end=clamp)
    start = solve(scene, guess=np.array([0.0, 0.0, 2.0 * math.pi, 0.0]))
    diagram = trace(scene, "end.twist_turns", (0.0, 1.3), start=start, depth=0)
    (turns,) = (p.parameter for p in diagram.special_points if p.kind == "branch_point")
    return float(turns)


def elastica(P: float) -> tuple[float, float, float]:
    """Return deflection, height and angle of the tip of a cantilever under P L^2/EI across it.

    With p sin phi = ((1 + sin theta)/2)^(1/2), F(phi, p^2) grows by P^(1/2) from the base to the tip.
    """

    def base(tip: float) -> tuple[float, float]:
        m = (1.0 + math.sin(tip)) / 2.0
        return math.asin(1.0 / math.sqrt(2.0 * m)), m

    def excess(tip: float) -> float:
        phi, m = base(tip)
        return float(ellipk(m) - ellipkinc(phi, m)) - math.sqrt(P)

    tip = float(brentq(excess, 1e-9, math.pi / 2.0 - 1e-9, xtol=1e-15))
    phi, m = base(tip)
    deflection = 1.0 - 2.0 * float(ellipe(m) - ellipeinc(phi, m)) / math.sqrt(P)
    return deflection, 2.0 * math.sqrt(m / P) * math.cos(phi), tip


def cantilever(P: float, **how: Any) -> tuple[float, float, float]:
    """Return the same of the program; `how` goes to the scene, as `loads`, and to `solve`."""
    scene = _rod(_law(), end=Free((P, 0.0, 0.0)), loads=how.pop("loads", ()))
    state = solve(scene, **how)
    x, _, z = state.position[-1]
    return float(x), float(z), math.acos(state.directors[-1, 2, 2])


def _elastica() -> Iterator[Row]:
    P = 10.0
    found, exact = cantilever(P, tol=1e-12), elastica(P)
    names = [f"elastica, P L^2/EI = 10, tip {what}" for what in ("deflection/L", "height/L", "angle")]
    told = "ten times the tolerance of the solver"
    for name, integral, value in zip(names, exact, found, strict=True):
        yield Row(name, "elliptic integrals", integral, value, 1e-11, told)
    printed = (0.81060902, 1.0 - 0.55499560, 1.4302855)
    for name, digits, value, half in zip(names, printed, found, (5e-9, 5e-9, 5e-8), strict=True):
        yield Row(name, "Mattiasson 1981", digits, value, half, "digits printed")


def _stiffnesses() -> Iterator[Row]:
    """What the full law is at zero strain without growth."""
    eta = 0.1
    H = SectionLaw(eta, growth.edge(0.0)).hessian([0.0, 0.0, 0.0, 0.0])
    stiffness = {"EA": 1.0, "EI1": 1.0 / 12.0, "EI2": eta**2 / 12.0, "GJ": eta**2 / 9.0}
    for i, (name, value) in enumerate(stiffness.items()):
        yield Row(f"{name} of a flat ribbon, eta = 0.1", "beam theory", value, float(H[i, i]), 2e-16)
