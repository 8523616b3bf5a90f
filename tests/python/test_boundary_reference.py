"""Held and loaded ribbons against scipy's solvers of the same equations, written independently."""

from functools import cache

import numpy as np
import pytest
import ribbonrs as rb
from held import largest
from kirchhoff import Kirchhoff

LEAF = rb.Ribbon(10.0, 1.0, 0.1)
ETA2 = 0.1**2
UNIT = ETA2 / 12 / 10.0**2
"""EI2/L^2, the unit of forces that bend the ribbon."""
EDGE = rb.growth.edge(2.0 * ETA2)
CHIRAL = EDGE + rb.growth.chiral(0.03)
THICK = rb.growth.edge(3.0 * ETA2) + rb.growth.thickness(0.05, transverse=-0.02)
ALONG = rb.growth.edge(lambda S: 2.0 * ETA2 * (1.0 + 0.5 * np.sin(0.6 * S)))
ROD = rb.LinearLaw(EA=1.0, EI1=1 / 12, EI2=ETA2 / 12, GJ=ETA2 / 9, intrinsic=(0.0, 1e-3, 0.05, 0.1))
NEAR = (0.4, 0.2, 9.4)
TURNED = (0.2, 0.5, 0.3)


def wind(S):
    return UNIT * np.stack([np.cos(S), 0.3 * S / 10.0, np.sin(0.4 * S)], axis=1)


def scene(growth=EDGE, start=None, end=None, **arguments):
    return rb.Scene(LEAF, growth, start=start, end=end, **arguments)


LOADS = [
    rb.PointLoad(3.0, (2.0 * UNIT, 0.0, UNIT), (0.0, 3.0 * UNIT, -2.0 * UNIT)),
    rb.PointLoad(7.5, (0.0, -UNIT, 0.0)),
]
FORCE = (3.0 * UNIT, 0.5 * UNIT, -UNIT)
HELD = {
    "clamped": scene(end=rb.Clamped(NEAR, TURNED)),
    "clamped chiral": scene(CHIRAL, end=rb.Clamped(NEAR)),
    "clamped thick": scene(THICK, end=rb.Clamped(NEAR, TURNED)),
    "clamped heavy": scene(end=rb.Clamped(NEAR), gravity=(2.0 * UNIT, 0.0, UNIT)),
    "cantilever": scene(end=rb.Free(FORCE, (5.0 * UNIT, 2.0 * UNIT, 8.0 * UNIT))),
    "from the end": scene(
        start=rb.Free(FORCE, (0.0, 4.0 * UNIT, 0.0)), end=rb.Clamped((1.0, 2.0, 3.0), TURNED)
    ),
    "pinned": scene(start=rb.Pinned(moment=(0.0, 5.0 * UNIT, 0.0)), end=rb.Clamped(NEAR)),
    "pinned twice": scene(start=rb.Pinned(), end=rb.Pinned(NEAR), gravity=(UNIT, 0.3 * UNIT, 0.0)),
    "hinged 1": scene(start=rb.Hinged(1), end=rb.Clamped(NEAR)),
    "hinged 2": scene(
        start=rb.Hinged(2, moment=4.0 * UNIT), end=rb.Hinged(2, (0.3, 0.0, 9.5)), gravity=(0.0, UNIT, 0.0)
    ),
    "hinged 3": scene(start=rb.Clamped(), end=rb.Hinged(3, NEAR, moment=6.0 * UNIT)),
    "sliding": scene(end=rb.Sliding((0.3, -0.2, 1.0), TURNED, 0.1, force=-5.0 * UNIT)),
    "point loads": scene(end=rb.Clamped(NEAR, TURNED), loads=LOADS),
    "point loads, free": scene(CHIRAL, end=rb.Free(FORCE), loads=LOADS, gravity=(0.0, UNIT, 0.0)),
    "wind": scene(end=rb.Pinned(NEAR), loads=[rb.LineLoad(wind, (0.0, UNIT, 0.5 * UNIT))]),
    "growth along": scene(ALONG, end=rb.Clamped(NEAR, TURNED), gravity=(UNIT, 0.0, 0.0)),
    "linear": scene(CHIRAL, law="linear", end=rb.Clamped(NEAR, TURNED)),
    "quadratic": scene(CHIRAL, law="quadratic", end=rb.Clamped((0.1, 0.05, 9.95))),
    "rod": scene(None, law=ROD, end=rb.Clamped(NEAR, TURNED), loads=LOADS),
}
S = np.linspace(0.0, 10.0, 41)


@cache
def solved(name):
    return rb.solve(HELD[name], tol=1e-12)


def gap(equations, state, found):
    """The largest difference of states (n, 13), relative to the largest force and moment, at least a unit."""
    known = equations.state(state.at(S))
    size = np.ones(13)
    for part in (slice(7, 10), slice(10, 13)):
        size[part] = max(1.0, largest(known[:, part]))
    return largest((known - found) / size)


@pytest.mark.parametrize("name", HELD)
def test_the_way_from_the_start_ends_where_it_is_held(name):
    state = solved(name)
    equations = Kirchhoff(state.scene)
    carried = equations.carried(state, S)
    # 1e-12 of both methods, and what that grows to along the way
    assert gap(equations, state, carried) < 1e-11
    assert largest(equations.end_misses(carried[0], carried[-1])) < 1e-11
    at = state.at(S)
    resultants = np.column_stack([at.force[:, 2], at.moment])
    expected = equations.strains(resultants, S, at.strains)
    assert largest((at.strains - expected) * [1.0, 10.0, 10.0, 10.0]) < 1e-14  # the law, at each S


TOLERANCES = {
    "clamped": 1e-7,
    "clamped thick": 1e-6,
    "clamped heavy": 1e-6,
    "pinned twice": 1e-7,
    "hinged 1": 1e-7,
    "hinged 2": 1e-7,
    "sliding": 1e-7,
    "point loads": 1e-6,
}
"""Of scipy, which takes seconds for less."""


@pytest.mark.parametrize("name", TOLERANCES)
def test_scipy_finds_the_same(name):
    state = solved(name)
    equations = Kirchhoff(state.scene)
    found = equations.collocated(state, TOLERANCES[name])(S)
    # the tolerance is of residuals at the middle of elements, where they are far larger than the errors
    assert gap(equations, state, found) < 0.01 * TOLERANCES[name]
