"""Traces from states that may be moved freely, until the parameter says how: round rods, and rings.

What is the same in all directions is turned about the line of its ends for nothing. A weight, or a natural
curvature, tells where it points, however small. Independent of that is a rod that is stiff but in one plane.
"""

import numpy as np
import pytest
import ribbonrs as rb

UNIT = rb.Ribbon(1.0, 1.0, 0.1)


def law(EI1=1.0, intrinsic=(0.0, 0.0, 0.0, 0.0)):
    return rb.LinearLaw(EI1=EI1, EI2=1.0, GJ=0.7, inextensible=True, intrinsic=intrinsic)


def column(gravity=(0.0, 0.0, 0.0), **k):
    """A clamped rod whose ends are pushed together by a tenth."""
    return rb.Scene(UNIT, law=law(**k), end=rb.Clamped((0.0, 0.0, 0.9)), gravity=gravity)


@pytest.mark.parametrize("axis", [0, 1])
def test_weight_on_a_buckled_round_rod(axis):
    diagram = rb.trace(column(), f"gravity[{axis}]", (0.0, 5.0), depth=0)
    (branch,) = diagram.branches
    assert branch.ended == ("span", "span")
    assert set(branch.index) == {0.0}
    # It hangs in the plane of its weight, where the rod is that bends in that plane alone.
    heavy = rb.solve(column(gravity=(200.0, 0.0, 0.0), EI1=1e3))
    plane = rb.solve(column(gravity=(5.0, 0.0, 0.0), EI1=1e3), guess=heavy)
    last = branch.state(-1)
    np.testing.assert_allclose(last.at(0.5).position[axis], plane.at(0.5).position[0], atol=1e-9)
    assert last.energy == pytest.approx(plane.energy, abs=1e-9)
    # and without weight it is the one that started, turned.
    assert branch.parameter[0] == 0.0
    assert branch.state(0).energy == pytest.approx(rb.solve(column()).energy, rel=1e-9)


@pytest.mark.parametrize("low", [-5.0, 0.0])
def test_a_start_that_is_given_in_the_span(low):
    start = rb.solve(column())
    diagram = rb.trace(column(), "gravity[0]", (low, 5.0), start=start, depth=0)
    (branch,) = diagram.branches
    assert branch.ended == ("span", "span")
    assert (branch.parameter[0], branch.parameter[-1]) == (low, 5.0)


@pytest.mark.parametrize("place", [1, 2])
def test_natural_curvature_of_a_buckled_round_rod(place):
    diagram = rb.trace(column(), f"law.intrinsic[{place}]", (0.0, 1.0), depth=0)
    (branch,) = diagram.branches
    assert branch.ended == ("span", "span")
    natural = np.eye(4)[place]
    assert branch.energy[-1] == pytest.approx(rb.solve(column(intrinsic=tuple(natural))).energy, rel=1e-8)
    assert set(branch.index) == {0.0}


@pytest.mark.parametrize("place", [1, 2])
def test_natural_curvature_of_a_ring_that_is_naturally_straight(place):
    straight = rb.LinearLaw(EI1=1.0, EI2=1.0, GJ=1.0, inextensible=True)
    scene = rb.Scene(UNIT, law=straight, start=rb.Closed(2.0))
    diagram = rb.trace(scene, f"law.intrinsic[{place}]", (0.0, 2.0), depth=0)
    (branch,) = diagram.branches
    assert branch.ended == ("span", "span")
    # The circle, untwisted: (2 pi - k)^2/2.
    k = branch.parameter
    np.testing.assert_allclose(branch.energy, 0.5 * (2.0 * np.pi - k) ** 2, rtol=1e-9)


@pytest.mark.parametrize("found", [rb.solve, lambda scene: rb.natural_shapes(scene.ribbon, scene.growth)[0]])
def test_natural_shapes_are_starts(found):
    # Solved without collocation, as what is unloaded and uniform is.
    leaf = rb.Scene(rb.Ribbon(20.0, 1.0, 0.05), rb.growth.edge(0.005) + rb.growth.chiral(0.02))
    start = found(leaf)
    diagram = rb.trace(leaf, "gravity[0]", (-1e-7, 1e-7), start=start, depth=0, values=[0.0])
    (branch,) = diagram.branches
    (place,) = (point.place for point in diagram.special_points if point.kind == "value")
    np.testing.assert_allclose(branch.state(place).strains, start.strains, atol=1e-9)


@pytest.mark.parametrize("most", [1.0, 20.0, 1000.0])
def test_weight_on_a_ring_however_long_the_span(most):
    # The first place aside at which it is still nearly the ring.
    straight = rb.LinearLaw(EI1=1.0, EI2=1.0, GJ=0.7, inextensible=True)
    scene = rb.Scene(rb.Ribbon(10.0, 1.0, 0.1), law=straight, start=rb.Closed())
    diagram = rb.trace(scene, "gravity[0]", (0.0, most), depth=0)
    (branch,) = diagram.branches
    assert branch.ended == ("span", "span")
    assert set(branch.index) == {0.0}
    ring = 0.5 * (2.0 * np.pi / 10.0) ** 2
    assert branch.energy[0] == pytest.approx(ring, rel=1e-9)
