"""How traces end, what they refuse, and that they give the same bits twice."""

import numpy as np
import pytest
import ribbonrs as rb
from continued import places
from held import rod
from refusal import refuses
from ribbonrs.branch import ARRAYS

NAME, SPAN = "end.position[2]", (9.0, 10.0)
SCENE = rb.Scene(rb.Ribbon(10.0, 1.0, 0.1), rb.growth.edge(0.02), end=rb.Clamped(twist_turns=0.5))
EDGE = rb.Scene(rb.Ribbon(10.0, 1.0, 0.1), rb.growth.edge(0.02))
HOW = {"span", "steps", "closed", "joined", "branch point", "section instability", "start", "failed"}


def both(**arguments):
    """Traces of a section and of a boundary-value problem."""
    return (
        rb.trace(EDGE, "growth.edge.amplitude", (0.0, 0.08), **arguments),
        rb.trace(SCENE, NAME, SPAN, **arguments),
    )


def test_every_branch_says_how_it_ended():
    for diagram in both():
        for branch in diagram.branches:
            assert set(branch.ended) <= HOW
            assert bool(branch.reason) == ("failed" in branch.ended)
        ends = [p for p in diagram.special_points if p.kind == "end"]
        assert [p.name for p in ends] == [how for branch in diagram.branches for how in branch.ended]
        for branch in diagram.branches[1:]:
            origin = diagram.special_points[branch.origin]
            assert origin.branch < branch.number
            assert origin.parameter == branch.parameter[0]


def test_steps_that_are_too_few():
    for diagram in both(max_steps=3, depth=0):
        branch = diagram.branches[0]
        assert branch.ended == ("start", "steps")
        assert 2 <= branch.parameter.size <= 4
        assert branch.parameter[0] == diagram.span[0]


def test_branches_are_not_switched_at_depth_0():
    for diagram in both(depth=0):
        assert all(branch.origin is None for branch in diagram.branches)
        assert any(p.kind == "branch_point" for p in diagram.special_points)


@pytest.mark.parametrize("name", ["free", "held", "from its end"])
def test_values_are_met_once_each(name):
    # ends of the span are values as others are
    scene, parameter, span = {
        "free": (EDGE, "growth.edge.amplitude", (0.0, 0.04)),
        "held": (SCENE, NAME, SPAN),
        "from its end": (SCENE, NAME, SPAN),
    }[name]
    values = np.linspace(*span, 5)
    start = rb.solve(SCENE) if name == "from its end" else None
    diagram = rb.trace(scene, parameter, span, values=values, start=start, depth=0)
    for branch in diagram.branches:
        met = places(diagram, "value", branch.number)
        passed = [v for v in values if branch.parameter.min() <= v <= branch.parameter.max()]
        np.testing.assert_array_equal(np.unique(met), passed)
        if not any(p.kind == "fold" and p.branch == branch.number for p in diagram.special_points):
            np.testing.assert_array_equal(met, passed)


def test_the_same_bits_twice():
    for one, other in zip(both(values=[]), both(values=[]), strict=True):
        assert len(one.branches) == len(other.branches)
        for a, b in zip(one.branches, other.branches, strict=True):
            for name in ARRAYS:
                np.testing.assert_array_equal(getattr(a, name), getattr(b, name), strict=True)
            assert (a.ended, a.origin, a.mirrored) == (b.ended, b.origin, b.mirrored)
        assert [repr(p) for p in one.special_points] == [repr(p) for p in other.special_points]


def test_points_are_equilibria():
    for diagram in both(depth=1):
        for branch in diagram.branches:
            special = {p.place for p in diagram.special_points if p.branch == branch.number}
            for i in range(0, branch.parameter.size, 4):
                if i not in special:
                    assert branch.state(i).report.residual < 1e-9


@pytest.mark.parametrize("span", [(10.0, 9.0), (9.0, 9.0), (9.0,), (9.0, 9.5, 10.0), (9.0, float("nan"))])
def test_spans_that_are_none(span):
    with pytest.raises(rb.InputError, match=r"^trace\.span") as caught:
        rb.trace(SCENE, NAME, span)
    assert "\n" not in str(caught.value)


def test_parameters_that_are_none():
    for name, nearest in (("end.positon[2]", "end.position[2]"), ("growth.edge", "growth.edge.amplitude")):
        with pytest.raises(rb.InputError, match=rf"the nearest is {nearest.replace('[', '.')[:12]}"):
            rb.trace(SCENE, name, SPAN)


def test_starts_that_are_no_equilibria():
    state = rb.solve(SCENE)
    other = rb.Scene(SCENE.ribbon, rb.growth.edge(0.03), end=SCENE.end)
    refuses("start", lambda: rb.trace(SCENE, NAME, SPAN, start=rb.solve(other)))
    refuses("start", lambda: rb.trace(SCENE, NAME, (9.0, 9.5), start=state))
    # a state of another ribbon, said to be of this one
    bent = rb.solve(rod(end=rb.Free((1.0, 0.0, 0.0))))
    scene = rod(end=rb.Free((2.0, 0.0, 0.0)))
    object.__setattr__(bent, "scene", scene)
    with pytest.raises(rb.InputError, match="start") as caught:
        rb.trace(scene, "end.force[0]", (0.0, 3.0), start=bent)
    assert "\n" not in str(caught.value)
