"""A rod that is the same in all directions buckles in any of them, and the index is that of one branch."""

from __future__ import annotations

import numpy as np
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
