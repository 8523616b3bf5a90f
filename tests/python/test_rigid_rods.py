"""Rods that are rigid in one way and held at both ends: the limit of stiff ones tells what they bear.

Thresholds are those of a column that bends in one plane, which do not depend on what is rigid.
"""

import math

import numpy as np
import pytest
import ribbonrs as rb

STRIP = rb.Ribbon(10.0, 1.0, 0.1)
ENDS = {"clamped": rb.Clamped(), "sliding": rb.Sliding(axis=(1.0, 0.0, 0.0)), "hinged": rb.Hinged()}
LAWS = {
    "EI1": rb.LinearLaw(EI1=math.inf, EI2=1.0, GJ=1.0, EA=9e3),
    "EI1, EA": rb.LinearLaw(EI1=math.inf, EI2=1.0, GJ=1.0, inextensible=True),
    "GJ, EA": rb.LinearLaw(EI1=100.0, EI2=1.0, GJ=math.inf, inextensible=True),
}


@pytest.mark.parametrize("start", ENDS.values(), ids=ENDS)
@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
def test_without_load_there_is_no_reaction(start, law):
    state = rb.solve(rb.Scene(STRIP, law=law, start=start, end=rb.Sliding()))
    assert state.index == 0.0
    for values in (state.force, state.moment):
        np.testing.assert_allclose(values, 0.0, atol=1e-12)


@pytest.mark.parametrize("start", ["clamped", "sliding"])
@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
def test_a_trace_in_tension_meets_nothing(start, law):
    scene = rb.Scene(STRIP, law=law, start=ENDS[start], end=rb.Sliding())
    (branch,) = (diagram := rb.trace(scene, "end.force", (0.0, 0.3), depth=0)).branches
    assert branch.ended == ("start", "span")
    assert set(branch.index) == {0.0}
    assert [point.kind for point in diagram.special_points] == ["end", "end"]
    np.testing.assert_allclose(branch.state(-1).moment, 0.0, atol=1e-12)


@pytest.mark.parametrize("degree", [1, 3, 5])
def test_a_column_far_beyond_buckling(degree):
    # P L^2/EI2 = 187.9: thresholds 39.5, 80.8 and 157.9 are below, 238.7 is above
    law = rb.LinearLaw(EI1=math.inf, EI2=1.0, GJ=1.0, EA=0.14851473815561914)
    scene = rb.Scene(rb.Ribbon(100.0, 1.0, 0.1), law=law, end=rb.Sliding(force=-0.0187853972442334))
    assert rb.solve(scene, guess=np.zeros(4), degree=degree).index == 3.0


def test_a_hinged_column_far_beyond_buckling():
    # between the thresholds of 8 and 9 ways, as for GJ = 1e6
    law = rb.LinearLaw(EI1=100.0, EI2=1.0, GJ=math.inf, inextensible=True)
    scene = rb.Scene(
        rb.Ribbon(1.0, 1.0, 0.1), law=law, start=rb.Hinged(), end=rb.Sliding(force=-822.4644157851517)
    )
    state = rb.solve(scene, guess=np.zeros(4))
    assert state.index == 8.0
    assert state.report.elements < 50


@pytest.mark.parametrize("force", [0.09, 0.102, 0.12, 0.14, 0.38, 0.41])
@pytest.mark.parametrize(
    "law",
    [
        *(rb.LinearLaw(EI1=math.inf, EI2=1.0, GJ=1.0, EA=EA) for EA in (9e3, 100.0)),
        rb.LinearLaw(EI1=math.inf, EI2=1.0, GJ=1.0, inextensible=True, intrinsic=(0.0, 0.0, 0.0, -7.0)),
        rb.LinearLaw(EI1=1e4, EI2=1.0, GJ=1.0, EA=9e3),
    ],
)
def test_a_guided_column(force, law):
    # its start slides aside: P = (n pi/L)^2 EI2
    scene = rb.Scene(STRIP, law=law, start=ENDS["sliding"], end=rb.Sliding(force=-force))
    state = rb.solve(scene, guess=np.zeros(4))
    thresholds = [(n * math.pi / 10.0) ** 2 for n in (1, 2)]
    assert state.index == sum(threshold < force for threshold in thresholds)
