"""A rod that is the same in all directions buckles in any of them, and the index is that of one branch."""

from __future__ import annotations

import numpy as np
import pytest
import ribbonrs as rb


def test_a_column_that_may_buckle_in_any_direction() -> None:
    rod = rb.LinearLaw(EI1=1.0, EI2=1.0, GJ=1.0, inextensible=True)
    scene = rb.Scene(rb.Ribbon(1.0, 1.0, 0.1), law=rod, end=rb.Free((0.0, 0.0, -1.0)))
    start = rb.solve(scene, guess=np.zeros(4))
    diagram = rb.trace(scene, "end.force[2]", (-4.0, 0.0), start=start, depth=1)
    (point,) = [point for point in diagram.special_points if point.kind != "end"]
    assert point.kind == "branch_point"
    assert point.multiplicity == 2
    # Located to 1e-10 of the span.
    assert abs(point.parameter + np.pi**2 / 4) < 4e-10
    straight, buckled = diagram.branches
    assert set(straight.index) == {0.0, 2.0}
    assert set(buckled.index[1:]) == {0.0}


def test_a_column_buckles_under_a_load_over_the_square_of_its_length() -> None:
    rod = rb.LinearLaw(EI1=100.0, EI2=1.0, GJ=1.0, inextensible=True)
    column = rb.Scene(rb.Ribbon(1.0, 1.0, 0.1), end=rb.Free(force=(0.0, 0.0, -1.0)), law=rod)
    diagram = rb.trace(column, "end.force[2]", (-3.0, -1.0), start=rb.solve(column), depth=0)
    locus = rb.trace_locus(diagram, diagram.special_points[0], "ribbon.length", (0.9, 1.2))
    loads, lengths = locus.values.T
    assert locus.ended == ("span", "span")
    np.testing.assert_allclose(loads * lengths**2, -(np.pi**2) / 4, rtol=1e-10)


def greenhill(force: float, turns: float) -> float:
    """Determinant of `B w'''' - i M w''' - F w'' = 0`, clamped, `M = 2 pi GJ turns`; rows normalised."""
    r = np.roots([1.0, -2j * np.pi * 0.7 * turns, -force])
    rows = [[1, 0, 1, 1], [0, 1, *r], [1, 1, *np.exp(r)], [0, 1, *(r * np.exp(r))]]
    matrix = np.array(rows)
    return float(abs(np.linalg.det(matrix)) / np.prod(np.linalg.norm(matrix, axis=1)))


@pytest.mark.parametrize("turns", [0.0, 0.1, 1.5])
def test_the_locus_of_a_round_rod_that_is_twisted_and_pulled(turns: float) -> None:
    # It buckles in two ways at once: any direction of their plane may be found at the next point.
    law = rb.LinearLaw(EI1=1.0, EI2=1.0, GJ=0.7, inextensible=True)
    scene = rb.Scene(rb.Ribbon(1.0, 1.0, 0.1), law=law, end=rb.Sliding(force=60.0, twist_turns=turns))
    diagram = rb.trace(scene, "end.force", (-60.0, 60.0), start=rb.solve(scene), depth=0)
    point = [point for point in diagram.special_points if point.kind == "branch_point"][-1]
    assert point.multiplicity == 2
    locus = rb.trace_locus(diagram, point, "end.twist_turns", (-3.0, 3.0))
    assert locus.ended == ("span", "span")
    assert (locus.values[0, 1], locus.values[-1, 1]) == (-3.0, 3.0)
    # Branch points are told to 2e-11 of the span of 120.
    assert max(greenhill(*place) for place in locus.values) < 1e-9
