"""Columns, cantilevers and rings of classical rods: where they buckle, and their shapes beyond."""

import math

import numpy as np
import pytest
import ribbonrs as rb
from continued import along, changes, kinds, places
from held import largest, rod
from kirchhoff import Kirchhoff
from scipy.integrate import solve_ivp
from scipy.linalg import expm
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk, jv

PI2 = math.pi**2
CLOSE = 1e-10
"""Error of a branch point relative to the span: meshes are refined until it moves by less than 2e-11."""
SHAPE = 1e-9
"""Error of a shape of unit size: ten times `tol`."""


def law(EI1=100.0, EI2=1.0, GJ=1.0):
    return rb.LinearLaw(EI1=EI1, EI2=EI2, GJ=GJ, inextensible=True)


def traced(name, span, *, EI1=100.0, depth=0, guess=(0.0, 0.0, 0.0, 0.0), **scene_and_more):
    """The diagram from the straight rod."""
    more = {k: scene_and_more.pop(k) for k in ("values", "tol", "degree") if k in scene_and_more}
    scene = rod(law=scene_and_more.pop("law", law(EI1)), **scene_and_more)
    solved = {k: more[k] for k in ("tol", "degree") if k in more}
    start = rb.solve(scene, guess=np.array(guess), **solved)
    return rb.trace(scene, name, span, start=start, depth=depth, **more)


def close(found, expected, span, error=CLOSE):
    np.testing.assert_allclose(found, expected, atol=error * (span[1] - span[0]), rtol=0.0)


def bessel(order, low, high):
    """The zero of J_order between two numbers."""
    return brentq(lambda x: jv(order, x), low, high, xtol=1e-15)


TANGENT = brentq(lambda x: math.sin(x) - x * math.cos(x), 4.0, 4.7, xtol=1e-15)
"""tan x = x."""


def elastica(P):
    """Modulus, tip deflection and height of a clamped-free column of length 1 under a load P."""
    k = brentq(lambda k: ellipk(k * k) - math.sqrt(P), 1e-9, 1.0 - 1e-15, xtol=1e-16)
    return k, 2.0 * k / math.sqrt(P), 2.0 * ellipe(k * k) / math.sqrt(P) - 1.0


# --- columns of Euler


def test_clamped_free():
    span = (-30.0, 0.0)
    diagram = traced("end.force[2]", span, end=rb.Free((0.0, 0.0, -1.0)))
    assert kinds(diagram) == {"branch_point"}
    close(places(diagram, "branch_point"), [-2.25 * PI2, -0.25 * PI2], span)
    assert along(diagram) == [2.0, 1.0, 0.0]
    assert diagram.branches[0].ended == ("span", "span")
    assert diagram.branches[0].parameter[[0, -1]].tolist() == [-30.0, 0.0]


@pytest.mark.parametrize(
    ("span", "load", "index"), [((-60.0, 0.0), 4.0 * PI2, [1, 0]), ((-85.0, -60.0), 4.0 * TANGENT**2, [2, 1])]
)
def test_clamped_sliding(span, load, index):
    diagram = traced("end.force", span, end=rb.Sliding(force=span[1] - 1.0))
    close(places(diagram, "branch_point"), [-load], span)
    assert along(diagram) == index


def twisted_column(P, M, EI=(100.0, 1.0), GJ=1.0):
    """The determinant that is zero where a column under a force and a couple of fixed directions buckles.

    With e the direction of the force in the directors, to first order e' + K x e = 0 and
    m' + K x m - P d3 x e = 0, e = 0 below and m = M e above.
    """
    twist = M / GJ
    a, b = 1.0 / EI[0], 1.0 / EI[1]
    rates = [
        [0.0, twist, 0.0, -b],
        [-twist, 0.0, a, 0.0],
        [0.0, -P, 0.0, twist - M * b],
        [P, 0.0, M * a - twist, 0.0],
    ]
    end = expm(np.array(rates))
    return np.linalg.det(end[2:, 2:] - M * end[:2, 2:])


@pytest.mark.parametrize("start", [0.0, -1.0, -9.0])
@pytest.mark.parametrize("M", [0.1, 1.0])
def test_a_couple_that_has_no_potential(M, start):
    # without an index, by the sign of the determinant: one point for each load, wherever the trace starts
    span = (-30.0, 0.0)
    end = rb.Free((0.0, 0.0, start), (0.0, 0.0, M))
    diagram = traced("end.force[2]", span, end=end, guess=(0.0, 0.0, 0.0, M))
    loads = np.linspace(0.0, 30.0, 61)
    found = [twisted_column(P, M) for P in loads]
    brackets = [loads[i : i + 2] for i in range(60) if found[i] * found[i + 1] < 0.0]
    exact = [-brentq(twisted_column, *pair, args=(M,), xtol=1e-14) for pair in brackets]
    assert len(exact) == 2
    assert np.isnan(diagram.branches[0].index).all()
    close(places(diagram, "branch_point"), sorted(exact), span, 0.1 * CLOSE)
    assert kinds(diagram) == {"branch_point"}


@pytest.mark.parametrize(("n", "quarters"), [("end.force[2]", 1), ("end.force", 4)])
def test_isotropic_columns(n, quarters):
    end = rb.Free((0.0, 0.0, -1.0)) if quarters == 1 else rb.Sliding(force=-1.0)
    span = (-12.0 * quarters, 0.0)
    diagram = traced(n, span, EI1=1.0, end=end)
    (point,) = [p for p in diagram.special_points if p.kind != "end"]
    if quarters == 1:
        close([point.parameter], [-PI2 / 4.0], span)
    else:
        close([point.parameter], [-4.0 * PI2], span)
    assert (point.kind, point.multiplicity) == ("branch_point", 2)
    assert list(changes(diagram)) == [("branch_point", 2, -2.0)]


def test_a_hinged_column_that_is_pressed_together():
    # the rod under P has the length 1 - P/EA, and buckles where P (1 - P/EA) = n^2 pi^2
    EA, span = 1000.0, (0.9, 1.0)
    stretch = [(1.0 + math.sqrt(1.0 - 4.0 * n * n * PI2 / EA)) / 2.0 for n in (3, 2, 1)]
    ends = {"start": rb.Hinged(2), "end": rb.Hinged(2)}
    diagram = traced(
        "end.position[2]", span, depth=1, law=rb.LinearLaw(EA=EA, EI1=100.0, EI2=1.0, GJ=1.0), **ends
    )
    close(places(diagram, "branch_point", 0), stretch, span)
    assert diagram.branches[0].index[[0, -1]].tolist() == [0.0, 3.0]
    assert [b.mirrored for b in diagram.branches[1:]] == [True] * 3
    for z, point in zip(stretch[::-1], [p for p in diagram.special_points if p.kind != "end"], strict=True):
        assert point.state.reactions.end.force[2] == pytest.approx(EA * (z - 1.0), abs=EA * 1e-10)
    assert diagram.branches[1].stable[1:].all()


def test_the_elastica_beyond():
    loads = [-9.0, -6.0, -4.0, -3.0, -2.5]
    diagram = traced("end.force[2]", (-10.0, 0.0), end=rb.Free((0.0, 0.0, -1.0)), depth=1, values=loads)
    _, bent = diagram.branches
    assert (bent.mirrored, bent.ended) == (True, ("branch point", "span"))
    assert diagram.special_points[bent.origin].kind == "branch_point"
    assert bent.stable[1:].all()
    found = {p.parameter: p.state for p in diagram.special_points if p.kind == "value" and p.branch == 1}
    assert sorted(found) == pytest.approx(loads, rel=1e-15)
    for load, state in found.items():
        k, x, z = elastica(-load)
        assert np.abs(state.position[-1]) == pytest.approx([x, 0.0, abs(z)], abs=SHAPE)
        assert math.copysign(1.0, state.position[-1, 2]) == math.copysign(1.0, z)
        assert abs(state.strains[0, 2]) == pytest.approx(2.0 * k * math.sqrt(-load), abs=SHAPE * -load)
        assert math.acos(state.directors[-1, 2, 2]) == pytest.approx(2.0 * math.asin(k), abs=10.0 * SHAPE)


def test_the_elastica_of_a_hinged_column():
    # from one side through the straight rod to its mirror image: two quarter waves
    scene = rod(law=law(), start=rb.Hinged(2), end=rb.Hinged(2))
    diagram = rb.trace(scene, "end.position[2]", (0.5, 1.0), values=[0.75, 0.9])
    (branch,) = diagram.branches
    assert branch.parameter[[0, -1]].tolist() == [0.5, 0.5]
    (straight,) = [p for p in diagram.special_points if p.kind == "branch_point"]
    assert straight.parameter == pytest.approx(1.0, abs=1e-15)
    assert straight.state.reactions.end.force[2] == pytest.approx(-PI2, rel=SHAPE)
    found = [p for p in diagram.special_points if p.kind == "value"]
    assert [round(p.parameter, 12) for p in found] == [0.75, 0.9, 0.9, 0.75]
    for point in found:
        state = point.state
        _, x, z = elastica(-state.reactions.end.force[2] / 4.0)
        assert z == pytest.approx(point.parameter, abs=SHAPE)
        assert abs(state.at([0.5]).position[0, 0]) == pytest.approx(0.5 * x, abs=SHAPE)
        assert state.stable


# --- other loads


def heavy(q):
    """Tip angle of a heavy column of length 1: theta'' = -q (1 - s) sin theta, by shooting."""

    def shot(tip):
        def rate(s, y):  # from the tip, s the distance from it
            return [y[1], -q * s * math.sin(y[0])]

        return solve_ivp(rate, (0.0, 1.0), [tip, 0.0], "DOP853", rtol=1e-13, atol=1e-14).y[0, -1]

    return brentq(shot, 0.3, 3.0, xtol=1e-14)


def test_greenhill():
    span, loads = (-16.0, 0.0), [-15.0, -10.0]
    diagram = traced("gravity[2]", span, gravity=(0.0, 0.0, -1.0), depth=1, values=loads)
    close(places(diagram, "branch_point"), [-2.25 * bessel(-1.0 / 3.0, 1.0, 3.0) ** 2], span)
    assert along(diagram) == [1.0, 0.0]
    bent = diagram.branches[1]
    assert (bent.mirrored, bent.ended) == (True, ("branch point", "span"))
    assert bent.stable[1:].all()
    for point in (p for p in diagram.special_points if p.kind == "value" and p.branch == 1):
        tip = math.acos(point.state.directors[-1, 2, 2])
        assert tip == pytest.approx(heavy(-point.parameter), abs=SHAPE)


@pytest.mark.parametrize("EI1", [1e12, math.inf])
@pytest.mark.parametrize(
    ("name", "scene", "load"),
    [
        ("end.force[1]", {"end": rb.Free((0.0, 1.0, 0.0))}, 2.0 * bessel(-0.25, 1.0, 3.0)),
        ("gravity[1]", {"gravity": (0.0, 1.0, 0.0)}, 6.0 * bessel(-1.0 / 6.0, 1.0, 3.0)),
    ],
    ids=["Prandtl-Michell", "weight"],
)
def test_cantilevers_that_tip_over(EI1, name, scene, load):
    span = (0.0, 2.0 * load)
    diagram = traced(name, span, EI1=EI1, depth=1, **scene)
    close(places(diagram, "branch_point"), [load], span)
    assert along(diagram) == [0.0, 1.0]
    over = diagram.branches[1]
    assert (over.mirrored, over.ended) == (True, ("branch point", "span"))
    assert over.stable[1:].all()
    state = over.state(-1)
    assert abs(state.position[-1, 0]) > 0.2
    # the same by an initial-value problem from S = 0
    equations, S = Kirchhoff(state.scene), np.array([0.3, 1.0])
    assert largest(equations.carried(state, S) - equations.state(state.at(S))) < 1e-8


@pytest.mark.parametrize("GJ", [1.0, 1.5])
def test_ring_that_is_twisted(GJ):
    clamp = rb.Clamped((0.0, 0.0, 0.0))
    span = (0.0, 2.2 / GJ)
    ring = (0.0, 0.0, 2.0 * math.pi, 0.0)
    ends = {"start": clamp, "end": clamp, "law": law(1.0, GJ=GJ)}
    diagram = traced("end.twist_turns", span, guess=ring, **ends)
    (point,) = [p for p in diagram.special_points if p.kind != "end"]
    assert (point.kind, point.multiplicity) == ("branch_point", 2)
    # twist is no linear parameter: it is differentiated by differences of 1e-7
    assert point.parameter == pytest.approx(math.sqrt(3.0) / GJ, rel=1e-9)
    assert along(diagram) == [0.0, 2.0]


# --- imperfect columns


@pytest.mark.parametrize("sideways", [1e-9, 1e-7, 1e-5, 1e-3])
def test_an_arch_against_a_small_load_across_folds(sideways):
    # theta = A sin(pi S/2) has energy (pi^2/4 - P) A^2/4 + pi^2 A^4/256 + 2 f A/pi:
    # a fold at P - pi^2/4 = 3/2 f^(2/3), and terms of its square
    span = (-20.0, 0.0)
    end = rb.Free((-sideways, 0.0, span[0]))
    diagram = traced("end.force[2]", span, EI1=math.inf, end=end, guess=(0.0, 0.0, 2.0, 0.0))
    (branch,) = diagram.branches
    assert (kinds(diagram), branch.ended) == ({"fold"}, ("start", "span"))
    assert branch.parameter[[0, -1]].tolist() == [span[0]] * 2
    assert (branch.strains[:, 2] > 0.0).all()
    square = sideways ** (2.0 / 3.0)
    close(places(diagram, "fold"), -PI2 / 4.0 - 1.5 * square, span, CLOSE + 0.3 * square**2 / 20.0)


# meshes are made for a hundredth of tol of the span of 1.6, by an estimate; at the last, rounding of 16
@pytest.mark.parametrize(("tol", "error"), [(1e-4, 1.6e-6), (1e-6, 1.6e-8), (1e-9, 2e-12)])
def test_a_strip_buckles_before_its_sections_soften(tol, error):
    # Euler's modes of a strip between clamps, with what compression makes of stiffness and length; where its
    # stiffness against twist vanishes a section is unstable, and a long step leads beyond that past them all
    L, eta, modes = 16.0, 0.03, 10
    section = rb.SectionLaw(eta, rb.growth.edge(0.0))

    def at(eps):
        strains = np.array([eps, 0.0, 0.0, 0.0])
        return section.gradient(strains)[0], np.diag(section.hessian(strains))

    def unbalanced(eps, q):
        n3, stiffness = at(eps)
        return -n3 * (1.0 + eps) - stiffness[2] * q**2

    softened = brentq(lambda eps: at(eps)[1][3], -0.01, 0.0, xtol=1e-16)
    symmetric = [2.0 * math.pi * n for n in range(1, 20)]
    others = [
        2.0 * brentq(lambda x: math.sin(x) - x * math.cos(x), n * math.pi, (n + 0.5) * math.pi, xtol=1e-15)
        for n in range(1, 20)
    ]
    waves = [q for q in np.array(sorted(symmetric + others)) / L if unbalanced(softened, q) > 0.0]
    exact = [brentq(unbalanced, softened, -1e-9, args=(q,), xtol=1e-16) for q in waves]
    softened, *exact = (L * (1.0 + eps) for eps in (softened, *exact))

    scene = rb.Scene(rb.Ribbon(L, 1.0, eta), end=rb.Clamped())
    start = rb.solve(scene, tol=tol)
    diagram = rb.trace(scene, "end.position[2]", (0.9 * L, L), start=start, tol=tol, depth=0)
    buckled, soft = (
        np.array([point.parameter for point in diagram.special_points if point.kind == kind])
        for kind in ("branch_point", "section_instability")
    )
    assert diagram.branches[0].ended == ("start", "span")
    assert (buckled > soft[0]).all()
    np.testing.assert_allclose(buckled[:modes], exact[:modes], rtol=0.0, atol=error)
    # not all of the others are found, but what is found is one of them, less well where they crowd
    assert modes <= buckled.size <= len(exact)
    nearest = np.array(exact)[np.abs(np.array(exact)[:, None] - buckled).argmin(axis=0)]
    np.testing.assert_allclose(buckled, nearest, rtol=0.0, atol=10.0 * error)
    np.testing.assert_allclose(soft, [softened], rtol=0.0, atol=1e-9)
