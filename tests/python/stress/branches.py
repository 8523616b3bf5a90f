"""Branches at and around singular points, and branches of ten thousand steps."""

from __future__ import annotations

import math
import warnings

import numpy as np
import ribbonrs as rb

from .equations import misses
from .row import Row
from .trial import ALLOWED

ETA = 0.1
BEND, TWIST = (math.sqrt(259.0) - 7.0) / 2.0, 5.0
"""Edge growth over eta^2 at which a flat ribbon bends and twists."""

LEAF = rb.Ribbon(10.0, 1.0, ETA)
TOL = 1e-10


def at_singular_points():
    """Natural shapes at and within a few roundings of both bifurcations: roots of dPi = 0, all of them."""
    worst, runs = 0.0, 0
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", rb.RibbonWarning)  # shapes that meet stand for several
        for value in (BEND, TWIST):
            for away in (0.0, *(s * 10.0**e for e in range(-16, -1) for s in (-1.0, 1.0))):
                xi = value * (1.0 + away) * ETA**2
                states = rb.natural_shapes(LEAF, rb.growth.edge(xi))
                runs += 1
                units = np.array([ETA**2, ETA**2, ETA**3, ETA**3])
                law = rb.SectionLaw(ETA, rb.growth.edge(xi))
                slope = max(np.abs(law.gradient(state.strain) / units).max() for state in states)
                # the flat state and the one of lowest energy are always there
                flat = any(state.phase == "flat" for state in states)
                worst = max(worst, slope if flat else math.inf)
    return Row("branches", "natural shapes at bifurcations, within 1e-16 to 1e-2", runs, worst, 1e-12, "dPi")


def at_buckling_loads():
    """Columns at their buckling load and within a few roundings: an equilibrium, whichever."""
    worst, runs = 0.0, 0
    rod = rb.LinearLaw(EI1=math.inf, EI2=1.0, GJ=1.0, inextensible=True)
    ribbon = rb.Ribbon(1.0, 1.0, 0.1)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", rb.RibbonWarning)  # the straight one is unstable beyond
        for away in (0.0, *(s * 10.0**e for e in range(-15, -1) for s in (-1.0, 1.0))):
            load = math.pi**2 / 4.0 * (1.0 + away)
            runs += 1
            try:
                state = rb.solve(rb.Scene(ribbon, law=rod, end=rb.Free(force=(0.0, 0.0, -load))), tol=TOL)
            except rb.ConvergenceError:
                worst = math.inf
                continue
            missed = misses(state)
            worst = max(worst, max(missed.values()) / TOL)
    return Row("branches", "columns at buckling, within 1e-15 to 1e-2", runs, worst, ALLOWED, "tolerances")


def right_chirality(omega, most=8.0):
    """Whether edge growth traced with a trace of chirality gives the branches that the law has.

    With C = K3^2/2 - 4 xi and eta = 1, twisted states obey C = -20 (1 - omega/k3), so that
    xi = k3^2/8 + 5 (1 - omega/k3): one branch from xi = 0 with k3 > 0, and one with k3 < 0 and a fold where
    k3^3 = -20 omega. The first bends where C = 14 - 1036^(1/2). There are no other bifurcations.
    """
    growth = rb.growth.edge(0.0) + rb.growth.chiral(2.0 * ETA * omega)
    diagram = rb.trace(rb.Scene(LEAF, growth), "growth.edge.amplitude", (0.0, most * ETA**2))
    k3 = -((20.0 * omega) ** (1.0 / 3.0))
    C = 14.0 - math.sqrt(1036.0)
    bent = omega / (1.0 + C / 20.0)
    expected = {
        "fold": [k3**2 / 8.0 + 5.0 * (1.0 - omega / k3)],
        "branch_point": [(bent**2 / 2.0 - C) / 4.0],
    }
    for kind, places in expected.items():
        found = sorted(p.parameter / ETA**2 for p in diagram.special_points if p.kind == kind)
        within = [place for place in places if place < most]
        if len(found) != len(within) or not np.allclose(found, within, rtol=1e-9, atol=0.0):
            return False
    cubic = np.roots([1.0 / 8.0, 0.0, 5.0 - most, -5.0 * omega])
    twist = max(root.real for root in cubic if abs(root.imag) < 1e-9)
    end = diagram.branches[0].strains[-1, 2:] / ETA
    return bool(np.allclose(end, [0.0, twist], rtol=0.0, atol=1e-9 * twist))


def chirality():
    """Nearly coincident bifurcations: from a chirality of 1e-8 on."""
    sizes = 10.0 ** np.linspace(-8.0, -1.0, 36)
    wrong = sum(not right_chirality(omega) for omega in sizes.tolist())
    return Row("branches", "wrong diagrams of edge growth, omega 1e-8 to 0.1", sizes.size, wrong, 0)


def column(sideways):
    """A clamped column of unit stiffness under a load along it and a small one across."""
    rod = rb.LinearLaw(EI1=math.inf, EI2=1.0, GJ=1.0, inextensible=True)
    return rb.Scene(rb.Ribbon(1.0, 1.0, 0.1), law=rod, end=rb.Free(force=(sideways, 0.0, -1.0)))


def stays(sideways, values=(), max_steps=1000):
    """The branch of a column from 12 times its load to none, None if that is not one smooth branch."""
    span = (-30.0, 0.0)
    diagram = rb.trace(column(sideways), "end.force[2]", span, values=values, depth=0, max_steps=max_steps)
    branch = diagram.branches[0]
    inside = branch.parameter.min() == span[0] and branch.parameter.max() == span[1]
    one_way = bool(np.all(np.diff(branch.parameter) > 0.0) or np.all(np.diff(branch.parameter) < 0.0))
    # bent to one side all along
    same_side = bool(np.all(branch.strains[:, 2] > 0.0))
    return branch if inside and one_way and same_side and len(diagram.branches) == 1 else None


def imperfect_columns():
    """A force across unfolds the bifurcation: the arch goes over into the straight column without one."""
    sizes = 10.0 ** np.linspace(-8.0, -1.0, 15)
    wrong = sum(stays(sideways) is None for sideways in sizes.tolist())
    return Row("branches", "wrong branches of columns, 1e-8 to 0.1 of a load across", sizes.size, wrong, 0)


def many_steps(count=10_000):
    """The same, of ten thousand steps, for so many loads are asked for; some states are judged."""
    values = np.linspace(-30.0, 0.0, count + 2)[1:-1]
    branch = stays(0.1, values.tolist(), 2 * count)
    if branch is None or not np.all(np.isin(values, branch.parameter)):
        return Row("branches", "a branch of 10,000 steps", count, math.inf, ALLOWED, "tolerances")
    seen = np.linspace(0, branch.parameter.size - 1, 50).astype(int)
    worst = max(max(misses(branch.state(int(i))).values()) for i in seen) / TOL
    return Row("branches", "a branch of 10,000 steps", branch.parameter.size, worst, ALLOWED, "tolerances")


CHECKS = (at_singular_points, at_buckling_loads, chirality, imperfect_columns, many_steps)


def rows():
    """All of them."""
    for check in CHECKS:
        yield check()
