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


def chiral(omega, most):
    """Edge growth traced with a trace of chirality, and its special points of either kind, over eta^2."""
    growth = rb.growth.edge(0.0) + rb.growth.chiral(2.0 * ETA * omega)
    diagram = rb.trace(rb.Scene(LEAF, growth), "growth.edge.amplitude", (0.0, most * ETA**2))
    kinds = ("fold", "branch_point")
    found = {k: sorted(p.parameter / ETA**2 for p in diagram.special_points if p.kind == k) for k in kinds}
    return diagram, found


def right_chirality(omega, most=8.0):
    """Whether edge growth traced with a trace of chirality gives the branches that the law has.

    With C = K3^2/2 - 4 xi and eta = 1, twisted states obey C = -20 (1 - omega/k3), so that
    xi = k3^2/8 + 5 (1 - omega/k3): one branch from xi = 0 with k3 > 0, and one with k3 < 0 and a fold where
    k3^3 = -20 omega. The first bends where C = 14 - 1036^(1/2). There are no other bifurcations. A negative
    omega makes mirror images.
    """
    diagram, found = chiral(omega, most)
    hand, omega = math.copysign(1.0, omega), abs(omega)
    k3 = -((20.0 * omega) ** (1.0 / 3.0))
    C = 14.0 - math.sqrt(1036.0)
    bent = omega / (1.0 + C / 20.0)
    expected = {
        "fold": [k3**2 / 8.0 + 5.0 * (1.0 - omega / k3)],
        "branch_point": [(bent**2 / 2.0 - C) / 4.0],
    }
    for kind, places in expected.items():
        within = [place for place in places if place < most]
        if len(found[kind]) != len(within) or not np.allclose(found[kind], within, rtol=1e-9, atol=0.0):
            return False
    cubic = np.roots([1.0 / 8.0, 0.0, 5.0 - most, -5.0 * omega])
    twist = max(root.real for root in cubic if abs(root.imag) < 1e-9)
    end = diagram.branches[0].strains[-1, 2:] / ETA
    return bool(np.allclose(end, [0.0, hand * twist], rtol=0.0, atol=1e-9 * twist))


def right_pitchfork(omega, most=8.0):
    """Whether chirality below the error of points leaves the diagram of none: flat bends, and twists at 5."""
    diagram, found = chiral(omega, most)
    places = np.allclose(found["branch_point"], [BEND, TWIST], rtol=1e-9, atol=0.0)
    flat, *others = diagram.branches
    straight = flat.ended == ("start", "span") and np.abs(flat.strains[-1, 2:]).max() < 1e-9
    twists = [abs(branch.strains[-1, 3]) / ETA for branch in others if branch.phases[-1] == "twisted"]
    both = len(twists) == 2 or [branch.mirrored for branch in others] == [True, True]
    least = math.sqrt(8.0 * (most - TWIST))
    return bool(not found["fold"] and places and straight and both and np.allclose(twists, least, rtol=1e-9))


def chirality():
    """Nearly coincident bifurcations: either hand, from a chirality of 1e-10 on."""
    sizes = 10.0 ** np.linspace(-10.0, -1.0, 46)
    wrong = sum(not right_chirality(omega) for omega in (*sizes.tolist(), *(-sizes).tolist()))
    return Row("branches", "wrong diagrams of edge growth, omega 1e-10 to 0.1", 2 * sizes.size, wrong, 0)


def hardly_chiral():
    """Not told from a pitchfork: (5/8) omega, which keeps branches apart, is below the error of points."""
    sizes = 10.0 ** np.linspace(-16.0, -11.0, 26)
    wrong = sum(not right_pitchfork(omega) for omega in (*sizes.tolist(), *(-sizes).tolist()))
    return Row("branches", "wrong pitchforks of edge growth, omega 1e-16 to 1e-11", 2 * sizes.size, wrong, 0)


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
    sizes = 10.0 ** np.linspace(-9.0, -1.0, 17)
    wrong = sum(stays(sideways) is None for sideways in sizes.tolist())
    return Row("branches", "wrong branches of columns, 1e-9 to 0.1 of a load across", sizes.size, wrong, 0)


def many_steps(count=10_000):
    """The same, of ten thousand steps, for so many loads are asked for; some states are judged."""
    values = np.linspace(-30.0, 0.0, count + 2)[1:-1]
    branch = stays(0.1, values.tolist(), 2 * count)
    if branch is None or not np.all(np.isin(values, branch.parameter)):
        return Row("branches", "a branch of 10,000 steps", count, math.inf, ALLOWED, "tolerances")
    seen = np.linspace(0, branch.parameter.size - 1, 50).astype(int)
    worst = max(max(misses(branch.state(int(i))).values()) for i in seen) / TOL
    return Row("branches", "a branch of 10,000 steps", branch.parameter.size, worst, ALLOWED, "tolerances")


CHECKS = (at_singular_points, at_buckling_loads, chirality, hardly_chiral, imperfect_columns, many_steps)


def rows():
    """All of them."""
    for check in CHECKS:
        yield check()
