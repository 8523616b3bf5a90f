"""Where a branch is stable, as the summary of a trace says it."""

import math

import pytest
import ribbonrs as rb
from ribbonrs.stability import stable_spans

EULER = math.pi**2 / 4


@pytest.fixture(scope="module")
def diagram():
    """Euler's column, from the buckled state: through straight, and to its mirror image."""
    rod = rb.LinearLaw(EI1=math.inf, EI2=1.0, GJ=1.0, inextensible=True)
    scene = rb.Scene(rb.Ribbon(1.0, 1.0, 0.1), law=rod, end=rb.Free(force=(0.0, 0.0, -1.0)))
    return rb.trace(scene, "end.force[2]", (-4.0, 0.0))


def test_spans_end_where_the_parameter_turns_back(diagram):
    first, second = stable_spans(diagram, diagram.branches[0])
    assert first == pytest.approx((-4.0, -EULER))
    assert second == pytest.approx((-EULER, -4.0))


def test_a_branch_point_says_nothing_of_what_is_beside_it(diagram):
    spans = [span for branch in diagram.branches[1:] for span in stable_spans(diagram, branch)]
    assert spans == [pytest.approx((-EULER, 0.0))]
