"""Branches of natural shapes against closed forms, traced for a section and as a boundary-value problem."""

import math
from functools import cache

import numpy as np
import pytest
import ribbonrs as rb
from continued import along, kinds, places
from mpmath import mp, mpf

BENDS = (-7.0 + math.sqrt(259.0)) / 2.0
"""xi/eta^2 at which flat loses stability to bending; to twist at 5."""
C = [14.0 - math.sqrt(1036.0), 14.0 + math.sqrt(1036.0)]
"""C/eta^2 at which twisted ribbons bend: roots of 1/24 + C/720 - C^2/20160."""
CLOSE = 1e-10
"""Of a root by secants in a parameter from 0 to 1, of second differences of an energy of order one."""


def leaf(eta):
    return rb.Ribbon(10.0, 1.0, eta)


def edge(eta, span=8.0, omega=0.0, **arguments):
    """The diagram of edge growth up to `span` eta^2; chirality has d23 = 2 eta omega."""
    growth = rb.growth.edge(eta**2)
    if omega:
        growth = growth + rb.growth.chiral(2.0 * eta * omega)
    scene = rb.Scene(leaf(eta), growth)
    return rb.trace(scene, "growth.edge.amplitude", (0.0, span * eta**2), **arguments)


@cache
def exact(xi, omega=0.0, guess=(2.0, 0.0)):
    """k2 > 0 and k3 of eta = 1, by stationarity of the closed form of the energy.

    k2^2/24 + sigma (k2^2 + 4 C)^2/32 + (k3 - omega)^2/18, C = k3^2/2 - 4 xi.
    """
    with mp.workdps(30):

        def sigma(k2):
            z = mp.sqrt(3 * k2 / 2)
            tau = 2 / z * (mp.cosh(z) - mp.cos(z)) / (mp.sinh(z) + mp.sin(z))
            return (1 - tau) / z**4

        def slopes(k2, k3):
            rest = k2**2 + 4 * (k3**2 / 2 - 4 * mpf(xi))
            by2 = k2 / 12 + mp.diff(sigma, k2) * rest**2 / 32 + sigma(k2) * rest * k2 / 8
            by3 = sigma(k2) * rest * k3 / 4 + (k3 - mpf(omega)) / 9
            return by2, by3

        if omega == 0.0:
            # unstable at k2 = 0, and beyond the cylinder of the edges it rises
            bracket = (mpf("0.01"), mp.sqrt(8 * mpf(xi)) + 1)
            return float(mp.findroot(lambda k2: slopes(k2, mpf(0))[0], bracket, solver="illinois")), 0.0
        return tuple(float(x) for x in mp.findroot(slopes, guess))


@pytest.mark.parametrize("eta", [0.1, 0.05, 0.02])
def test_edge_growth(eta):
    diagram = edge(eta, values=[6.0 * eta**2])
    np.testing.assert_allclose(places(diagram, "branch_point") / eta**2, [BENDS, 5.0], atol=CLOSE, rtol=0.0)
    assert kinds(diagram) == {"branch_point", "value"}
    flat, bent, twisted = diagram.branches
    assert along(diagram) == [0.0, math.inf]
    np.testing.assert_array_equal(flat.section_index[flat.parameter > 5.001 * eta**2], 2)
    assert bent.stable[1:].all()
    assert np.isinf(twisted.index[1:]).all()
    assert not [p for p in diagram.special_points if p.branch == 2 and p.kind not in ("end", "value")]
    assert (flat.mirrored, bent.mirrored, twisted.mirrored) == (False, True, True)
    assert [diagram.special_points[b.origin].branch for b in (bent, twisted)] == [0, 0]
    assert [b.ended for b in diagram.branches] == [
        ("start", "span"),
        ("branch point", "span"),
        ("branch point", "span"),
    ]


@pytest.mark.parametrize("eta", [0.1, 0.05, 0.02])
def test_shapes_of_edge_growth(eta):
    diagram = edge(eta)
    _, bent, twisted = diagram.branches
    xi = twisted.parameter[1:] / eta**2
    # K3^2 is in proportion to xi - 5 eta^2, which is found to rounding
    np.testing.assert_allclose(np.abs(twisted.strains[1:, 3]), eta * np.sqrt(8.0 * (xi - 5.0)), rtol=1e-9)
    for xi in (4.6, 5.0, 6.0, 8.0):
        for state in diagram.states_at(xi * eta**2):
            assert state.report.gradient_norm < 1e-14
        found = next(s for s in diagram.states_at(xi * eta**2) if s.phase == "bent")
        assert abs(found.strain[2]) / eta == pytest.approx(exact(xi)[0], rel=1e-11)
    assert bent.strains[1:, 3] == pytest.approx(0.0, abs=1e-14)


def test_the_thickness_scales_out():
    thick, thin = edge(0.1), edge(0.02)
    for one, other in zip(thick.branches, thin.branches, strict=True):
        for xi in (4.7, 5.3, 7.9):
            for a, b in zip(one.states_at(xi * 0.1**2), other.states_at(xi * 0.02**2), strict=True):
                np.testing.assert_allclose(a.strain[2:] / 0.1, b.strain[2:] / 0.02, atol=1e-11)
                assert a.energy / 0.1**4 == pytest.approx(b.energy / 0.02**4, rel=1e-12)


@pytest.mark.parametrize("omega", [0.05, 0.2, 0.2226])
def test_a_trace_of_chirality(omega):
    k3 = omega / (1.0 + C[0] / 20.0)
    xi = BENDS + k3**2 / 8.0
    diagram = edge(0.1, omega=omega)
    (point,) = [p for p in diagram.special_points if p.kind == "branch_point"]
    assert point.parameter / 0.01 == pytest.approx(xi, abs=CLOSE)
    assert point.state.strain[2:] / 0.1 == pytest.approx([0.0, k3], abs=1e-8)
    assert along(diagram) == [0.0, math.inf]
    helix = diagram.branches[1]
    assert helix.stable[1:].all()
    assert set(helix.phases[2:]) == {"helical"}
    assert np.all(helix.strains[:, 3] > 0.0)
    assert helix.mirrored
    (found,) = [s for s in diagram.states_at(0.08) if s.phase == "helical"]
    assert np.abs(found.strain[2:]) / 0.1 == pytest.approx(exact(8.0, omega, (3.0, 3.0)), rel=1e-11)


def test_the_helix_that_is_printed():
    helix = next(s for s in edge(0.1, omega=0.2).states_at(0.06) if s.phase == "helical")
    assert np.abs(helix.strain[2:]) / 0.1 == pytest.approx((2.4156, 2.2149), abs=5e-5)
    assert helix.stable


@pytest.mark.parametrize("omega", [1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-8])
def test_a_pitchfork_that_is_hardly_unfolded(omega):
    # both hands pass within omega^(1/3) of each other, and none goes over to the other's branch
    diagram = edge(0.1, omega=omega)
    own, _, other = diagram.branches
    roots = np.sort(np.roots([1.0, 0.0, 8.0 * (5.0 - 8.0), -40.0 * omega]).real)
    assert own.strains[-1, 3] / 0.1 == pytest.approx(roots[2], rel=1e-9)
    assert (own.strains[:, 3] > 0.0).all()
    np.testing.assert_allclose(np.sort(other.strains[[0, -1], 3]) / 0.1, roots[:2], rtol=1e-6, atol=1e-13)
    assert (other.strains[:, 3] < 0.0).all()
    (fold,) = places(diagram, "fold", other.number) / 0.01
    assert fold == pytest.approx(5.0 + 0.375 * (20.0 * omega) ** (2.0 / 3.0), abs=8.0 * CLOSE)
    (bend,) = places(diagram, "branch_point") / 0.01
    assert bend == pytest.approx(BENDS + (omega / (1.0 + C[0] / 20.0)) ** 2 / 8.0, abs=8.0 * CLOSE)


@pytest.mark.parametrize("omega", [0.05, 0.2])
def test_branches_of_their_own_are_found_from_the_upper_end(omega):
    # twisted against the chirality: C = -20 (1 - omega/k3), least xi at k3^3 = -20 omega
    k3 = -((20.0 * omega) ** (1.0 / 3.0))
    diagram = edge(0.1, omega=omega)
    (fold,) = [p for p in diagram.special_points if p.kind == "fold"]
    assert fold.parameter / 0.01 == pytest.approx(5.0 + 0.375 * k3**2, abs=CLOSE)
    assert fold.state.strain[3] / 0.1 == pytest.approx(k3, abs=1e-6)  # the root of the error
    branch = diagram.branches[fold.branch]
    assert branch.ended == ("start", "span")
    assert branch.parameter[[0, -1]].tolist() == [diagram.span[1]] * 2
    assert (branch.origin, branch.mirrored) == (None, False)


def test_chirality_alone():
    k3 = math.sqrt(2.0 * C[1])
    omega = k3 * (1.0 + C[1] / 20.0)
    assert (k3, omega) == pytest.approx((9.6111, 31.8066), abs=1e-4)
    scene = rb.Scene(leaf(0.05), rb.growth.chiral(0.1))
    diagram = rb.trace(scene, "growth.chiral.amplitude", (0.0, 4.0))
    (point,) = [p for p in diagram.special_points if p.kind != "end"]
    assert (point.kind, point.branch) == ("branch_point", 0)
    assert point.parameter / 0.1 == pytest.approx(omega, abs=4.0 / 0.1 * CLOSE)
    assert point.state.strain[3] / 0.05 == pytest.approx(k3, rel=1e-9)
    assert along(diagram) == [0.0, math.inf]
    assert diagram.branches[1].stable[1:].all()
    assert diagram.branches[1].phases[-1] == "helical"
    assert diagram.branches[1].strains[-1, 3] > 0.0


def test_values_and_zeros():
    values = [0.01, 0.046, 0.06]
    tip = {"tip": lambda state: state.strain[2] + 0.2, "none": lambda state: 1.0 + state.energy}
    diagram = edge(0.1, values=values, functions=tip)
    found = {(p.branch, p.parameter) for p in diagram.special_points if p.kind == "value"}
    expected = [(0, 0.01), (0, 0.046), (0, 0.06), (1, 0.046), (1, 0.06), (2, 0.06)]
    np.testing.assert_allclose(sorted(found), expected, rtol=1e-15)  # rounding of the place in the span
    (zero,) = [p for p in diagram.special_points if p.kind == "zero"]
    assert zero.name == "tip"
    assert abs(zero.state.strain[2] + 0.2) < 1e-13
    assert zero.parameter == zero.state.scene.growth.values(0.5)["gamma33"]
    assert exact(zero.parameter / 0.01)[0] == pytest.approx(2.0, abs=1e-11)


@pytest.mark.parametrize("eta", [0.02, 0.05, 0.08, 0.1])
@pytest.mark.parametrize(("number", "xi"), [(0, BENDS), (1, 5.0)])
def test_neighbouring_loci_are_parabolas(eta, number, xi):
    scene = rb.Scene(leaf(eta), rb.growth.edge(0.0))
    diagram = rb.trace(scene, "growth.edge.amplitude", (0.0, 0.08), depth=0)
    point = [p for p in diagram.special_points if p.kind == "branch_point"][number]
    locus = rb.trace_locus(diagram, point, "ribbon.thickness", (0.02, 0.1))
    assert locus.ended == ("span", "span")
    growth, thickness = locus.values.T
    np.testing.assert_allclose(growth, xi * thickness**2, atol=CLOSE * 0.08, rtol=0.0)


# --- the same as a boundary-value problem


@pytest.mark.parametrize("eta", [0.1, 0.02])
def test_section_instabilities_of_a_free_ribbon(eta):
    scene = rb.Scene(leaf(eta), rb.growth.edge(0.01 * eta**2))
    start = rb.solve(scene, method="collocation")
    span = (0.0, 8.0 * eta**2)
    values = [xi * eta**2 for xi in (4.7, 5.5, 7.5)]
    diagram = rb.trace(scene, "growth.edge.amplitude", span, start=start, depth=1, values=values)
    found = places(diagram, "section_instability", 0) / eta**2
    np.testing.assert_allclose(found, [BENDS, 5.0], atol=1e-9, rtol=0.0)
    flat, bent, twisted = diagram.branches
    assert along(diagram) == [0.0, math.inf]
    assert (bent.mirrored, bent.ended) == (True, ("branch point", "span"))
    assert (twisted.mirrored, twisted.ended) == (True, ("branch point", "span"))
    np.testing.assert_array_equal(twisted.section_index[twisted.parameter > 5.001 * eta**2], 1)
    grown = twisted.parameter / eta**2 - 5.0
    np.testing.assert_allclose(twisted.strains[:, 3] ** 2, 8.0 * eta**2 * grown, atol=1e-9 * eta**2)
    assert bent.stable[bent.parameter > 4.6 * eta**2].all()
    np.testing.assert_array_equal(flat.section_index[flat.parameter > 5.1 * eta**2], 2)
    points = [p for p in diagram.special_points if p.kind == "value" and p.branch == 1]
    for point, value in zip(points, values, strict=True):
        state, xi = point.state, value / eta**2
        natural = rb.natural_shapes(scene.ribbon, rb.growth.edge(value))[0]
        assert abs(state.strain[2]) == pytest.approx(natural.strain[2], rel=1e-9)
        assert abs(state.strain[2]) / eta == pytest.approx(exact(xi)[0], rel=1e-9)
        assert state.energy == pytest.approx(natural.energy, rel=1e-9)


def test_section_instability_with_chirality():
    eta, omega = 0.1, 0.2
    growth = rb.growth.edge(1e-4) + rb.growth.chiral(2.0 * eta * omega)
    scene = rb.Scene(leaf(eta), growth)
    start = rb.solve(scene, method="collocation")
    diagram = rb.trace(scene, "growth.edge.amplitude", (0.0, 0.06), start=start, depth=1)
    k3 = omega / (1.0 + C[0] / 20.0)
    found = places(diagram, "section_instability", 0) / eta**2
    np.testing.assert_allclose(found, [BENDS + k3**2 / 8.0], atol=1e-9)
    helix = diagram.branches[1].state(-1)
    assert np.abs(helix.strain[2:]) / eta == pytest.approx(exact(6.0, omega, (2.4, 2.2)), rel=1e-9)
    assert helix.stable
