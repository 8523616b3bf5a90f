"""Rods that are the same in all directions: what turns them about the line of their loads does not count."""

from __future__ import annotations

import math

import numpy as np
import pytest
import ribbonrs as rb
from continued import places
from held import rod
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk

TURN = 2.0 * math.pi
THRUST = 5.0


def law(EI1: float, natural: float = 0.0) -> rb.LinearLaw:
    return rb.LinearLaw(EI1=EI1, EI2=1.0, GJ=1.0, inextensible=True, intrinsic=(0.0, 0.0, natural, 0.0))


def column(EI1: float) -> rb.Scene:
    return rod(law=law(EI1), end=rb.Free(force=(0.0, 0.0, -THRUST)))


def tip() -> tuple[float, float]:
    """Distance of the end from the axis, and along it, of the elastica: K(m) = sqrt(P) L."""
    m = brentq(lambda m: ellipk(m) - math.sqrt(THRUST), 1e-6, 1.0 - 1e-12, xtol=1e-16, rtol=1e-15)
    return 2.0 * math.sqrt(m / THRUST), 2.0 * ellipe(m) / math.sqrt(THRUST) - 1.0


# As the rod becomes round a bifurcation of its plane, and of its index, would become one of rounding.
NEARLY = [0.0, 1e-14, 1e-12, 1e-10, 1e-9, 1e-8, 1e-7, 1e-5, 1e-3]


@pytest.mark.parametrize("unlike", NEARLY)
@pytest.mark.parametrize("tol", [1e-6, 1e-10])
def test_a_column_buckles_into_the_elastica(unlike: float, tol: float) -> None:
    state = rb.solve(column(1.0 + unlike), tol=tol)
    assert state.index == 0.0
    across, height = tip()
    x, y, z = state.position[-1]
    # The stiffness of a plane that is not the softest differs by so much.
    assert abs(math.hypot(x, y) - across) < 10.0 * tol + unlike
    assert abs(z - height) < 10.0 * tol + unlike


@pytest.mark.parametrize("degree", [3, 5, 8])
@pytest.mark.parametrize("tol", [1e-4, 1e-8, 1e-12])
def test_the_index_does_not_hang_on_the_mesh(tol: float, degree: int) -> None:
    plane = rb.solve(column(100.0))
    state = rb.solve(column(1.0), guess=plane, tol=tol, degree=degree)
    assert (state.index, state.stable) == (0.0, True)


@pytest.mark.parametrize("unlike", NEARLY)
def test_between_clamps_as_in_a_plane(unlike: float) -> None:
    end = rb.Clamped(position=(0.0, 0.0, 0.9))
    plane = rb.solve(rod(law=law(100.0), end=end))
    state = rb.solve(rod(law=law(1.0 + unlike), end=end))
    assert state.index == 0.0
    assert state.energy == pytest.approx(plane.energy, rel=1e-10 + unlike)


def test_under_its_weight_and_between_a_clamp_and_a_slide() -> None:
    for ends in ({"gravity": (0.0, 0.0, -12.0)}, {"end": rb.Sliding(force=-45.0)}):
        assert rb.solve(rod(law=law(1.0), **ends)).index == 0.0


def ring(natural: float) -> rb.Scene:
    """A closed ring of curvature TURN whose rod is naturally this times as curved."""
    return rod(law=law(1.0, natural * TURN), start=rb.Closed())


def unstable(natural: float) -> int:
    """Directions of negative second variation: n waves of bending out of the plane and twist, and rolling."""
    moment = 1.0 - natural
    count = int(natural < 0.0)
    for n in range(1, 9):
        both = n * (2.0 - moment)
        matrix = np.array([[n * n + 1.0 - moment, both], [both, 1.0 + n * n - moment]])
        count += 2 * int((np.linalg.eigvalsh(matrix) < -1e-9).sum())
    return count


@pytest.mark.parametrize(
    "natural", [-1.5, -1.004, -0.99, -0.5, -0.01, 0.001, 0.3, 0.5, 0.7, 1.9, 2.002, 3.01]
)
def test_the_index_of_a_ring(natural: float) -> None:
    # at +-0.5 a part of the ring that is held at one end is about to buckle by itself
    state = rb.solve(ring(natural), guess=(0.0, 0.0, TURN, 0.0))
    assert state.index == unstable(natural)


@pytest.mark.parametrize("start", [-0.7, 0.0, 0.5, 1.0])
def test_a_ring_is_followed_from_any_of_its_states(start: float) -> None:
    # straight rods may also roll as they are closed: a bifurcation, of one direction; the others are of two
    state = rb.solve(ring(start), guess=(0.0, 0.0, TURN, 0.0))
    diagram = rb.trace(ring(0.0), "law.intrinsic[2]", (-3.5 * TURN, 3.5 * TURN), start=state, depth=0)
    assert diagram.branches[0].ended == ("span", "span")
    np.testing.assert_allclose(places(diagram, "branch_point") / TURN, [-3, -2, -1, 0, 2, 3], atol=1e-8)
    points = [point for point in diagram.special_points if point.kind != "end"]
    assert sorted((round(p.parameter / TURN), p.multiplicity) for p in points) == [
        *((n, 2) for n in (-3, -2, -1)),
        (0, 1),
        *((n, 2) for n in (2, 3)),
    ]
    special = {point.place for point in points}
    (branch,) = diagram.branches
    for i, natural in enumerate(branch.parameter / TURN):
        assert i in special or branch.index[i] == unstable(natural)


def test_a_force_across_a_buckled_column_is_followed_both_ways() -> None:
    start = rb.solve(rod(law=law(1.0), end=rb.Free(force=(0.0, 0.0, -THRUST))))
    scene = rod(law=law(1.0), end=rb.Free(force=(1.0, 0.0, -THRUST)))
    plane = rb.solve(rod(law=law(100.0), end=rb.Free(force=(1.0, 0.0, -THRUST))))
    # In the plane of the force, to which the column may turn for nothing.
    x, y, _ = start.position[-1]
    turned = rb.solve(start.scene, guess=start.strains * [1.0, 0.0, math.hypot(x, y) / x, 0.0])
    diagram = rb.trace(scene, "end.force[0]", (-1.0, 1.0), start=turned)
    (branch,) = diagram.branches
    assert branch.ended == ("span", "span")
    # Of the span, what branch points are found to.
    np.testing.assert_allclose(places(diagram, "branch_point"), [0.0], atol=2.0 * 2e-11)
    last = branch.state(-1)
    np.testing.assert_allclose(last.position[-1], plane.position[-1], atol=1e-8)
    assert (branch.index[0], branch.index[-1]) in ((1.0, 0.0), (0.0, 1.0))


@pytest.mark.parametrize("distance", [0.9, 0.7, 0.6, 0.5, 0.4])
@pytest.mark.parametrize("tol", [1e-4, 1e-10])
def test_clamps_are_drawn_apart(distance: float, tol: float) -> None:
    # A motion that changes nothing stays one, whatever the error of the points that tell.
    scene = rod(law=law(1.0), end=rb.Clamped(position=(0.0, 0.0, distance)))
    diagram = rb.trace(scene, "end.position[2]", (distance, 0.99), tol=tol, depth=0)
    (branch,) = diagram.branches
    assert branch.ended == ("start", "span")
    assert set(branch.index) == {0.0}
    plane = rb.solve(rod(law=law(100.0), end=rb.Clamped(position=(0.0, 0.0, 0.99))))
    assert branch.energy[-1] == pytest.approx(plane.energy, rel=10.0 * tol)
