"""What `trace` takes and refuses, and what it makes of what the core traces, which is a fake here."""

import warnings
from importlib.util import find_spec

import fake_core
import numpy as np
import pytest
import ribbonrs as rb
from fake_core import BENDS, CLAMPED, EDGE, LEAF, FakeBranch, FakeTrace, edge_trace, pressed, pressed_trace
from refusal import refuses
from ribbonrs import _core
from ribbonrs.check import number

PARAMETER, SPAN = "growth.edge.amplitude", (0.0, 0.08)
FORCE, FORCES = "end.force", (-3e-4, 0.0)


@pytest.fixture
def core(monkeypatch):
    """Stand in for the core; what it was called with is in the list returned."""
    calls = []

    def traces(make):
        return lambda *arguments: calls.append(arguments) or make()

    monkeypatch.setattr(_core, "trace_natural", traces(edge_trace), raising=False)
    monkeypatch.setattr(_core, "trace", traces(pressed_trace), raising=False)
    return calls


def nothing(calls):
    """Stand in for a core that finds no branch."""
    return lambda *arguments: calls.append(arguments) or FakeTrace([], [])


@pytest.fixture
def diagram(core):
    return rb.trace(EDGE, PARAMETER, SPAN)


@pytest.fixture
def held(core):
    return rb.trace(CLAMPED, FORCE, FORCES, values=[-2e-4])


def test_natural_shapes_are_traced_for_a_section(core):
    diagram = rb.trace(EDGE, PARAMETER, SPAN, values=[0.06, 0.03, 0.06], depth=1, max_steps=50)
    ((laws, span, values, depth, steps),) = core
    assert (span, values, depth, steps) == (SPAN, (0.03, 0.06), 1, 50)
    strain = np.array([[0.0, 0.0, 0.1, 0.0]])
    for law, xi in zip(laws, SPAN, strict=True):
        assert law.energy(strain) == rb.SectionLaw(0.1, rb.growth.edge(xi)).energy(strain)
    assert (diagram.scene, diagram.parameter, diagram.span) == (EDGE, PARAMETER, SPAN)


def test_held_ribbons_start_from_the_solution_at_the_lower_end(core):
    rb.trace(CLAMPED, FORCE, FORCES, tol=1e-9, degree=5)
    ((problems, span, start, value, values, depth, steps, tol, degree),) = core
    assert [type(problem) for problem in problems] == [_core.BoundaryProblem] * 2
    assert (span, value, values, depth, steps, tol, degree) == (FORCES, -3e-4, (), 2, 1000, 1e-9, 5)
    assert start.energy == pytest.approx(pressed(-3e-4).energy * 10.0, rel=1e-6)


def test_a_start_says_where_it_is(core, monkeypatch):
    start = pressed(-1e-4)
    rb.trace(CLAMPED, FORCE, FORCES, start=start)
    assert core[-1][2] is start.course.solution
    assert core[-1][3] == -1e-4
    flat = rb.natural_shapes(LEAF, rb.growth.edge(0.06))[-1]
    monkeypatch.setattr(_core, "trace", nothing(core))
    rb.trace(EDGE, PARAMETER, SPAN, start=flat)
    np.testing.assert_allclose(core[-1][2].at(np.zeros(1))[0][0], flat.strain, atol=1e-12)
    assert core[-1][3] == 0.06


def test_a_start_with_other_loads_says_how_much_of_them_it_has(core):
    third = rb.solve(rb.Scene(LEAF, end=rb.Free((3e-6, 0.0, 1e-6)), gravity=(0.0, 0.0, -1e-5)))
    whole = rb.Scene(LEAF, end=rb.Free((9e-6, 0.0, 3e-6)), gravity=(0.0, 0.0, -3e-5))
    rb.trace(whole, "load_factor", (0.0, 1.0), start=third)
    assert core[-1][3] == pytest.approx(1 / 3, rel=1e-12)


def test_what_is_not_natural_is_a_boundary_value_problem(core, monkeypatch):
    monkeypatch.setattr(_core, "trace", nothing(core))
    varying = rb.Scene(LEAF, rb.growth.edge(([0.0, 10.0], [0.01, 0.02])))
    for scene, name, span in ((EDGE, "gravity[0]", (0.0, 1e-6)), (varying, "ribbon.thickness", (0.1, 0.2))):
        rb.trace(scene, name, span)
        assert len(core[-1]) == 9


def test_large_growth_warns_once(core):
    with pytest.warns(rb.RibbonWarning, match=r"growth.size = 0.2 in the span") as caught:
        diagram = rb.trace(EDGE, PARAMETER, (0.0, 0.2))
    assert len(caught) == 1
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        diagram.branches[0].state(-1)


BAD = [
    ("scene", lambda: rb.trace(LEAF, PARAMETER, SPAN)),
    ("trace.parameter", lambda: rb.trace(EDGE, "growth.edge", SPAN)),
    ("trace.parameter", lambda: rb.trace(EDGE, None, SPAN)),
    ("trace.span", lambda: rb.trace(EDGE, PARAMETER, (0.08, 0.0))),
    ("trace.span", lambda: rb.trace(EDGE, PARAMETER, (0.0, 0.0))),
    ("trace.span", lambda: rb.trace(EDGE, PARAMETER, 0.08)),
    ("trace.span", lambda: rb.trace(EDGE, PARAMETER, (0.0, 0.1, 0.2))),
    ("trace.span[1]", lambda: rb.trace(EDGE, PARAMETER, (0.0, float("inf")))),
    ("trace.span[1]", lambda: rb.trace(EDGE, PARAMETER, (0.0, 0.8))),
    ("trace.span[0]", lambda: rb.trace(EDGE, "ribbon.thickness", (-0.1, 0.1))),
    ("trace.span[1]", lambda: rb.trace(EDGE, "ribbon.thickness", (0.1, 1.1))),
    ("trace.values[1]", lambda: rb.trace(EDGE, PARAMETER, SPAN, values=[0.01, 0.09])),
    ("trace.values", lambda: rb.trace(EDGE, PARAMETER, SPAN, values=0.01)),
    ("trace.functions", lambda: rb.trace(EDGE, PARAMETER, SPAN, functions=[len])),
    ("trace.functions", lambda: rb.trace(EDGE, PARAMETER, SPAN, functions={"a": 1})),
    ("trace.functions['a']", lambda: rb.trace(EDGE, PARAMETER, SPAN, functions={"a": lambda state: None})),
    ("trace.depth", lambda: rb.trace(EDGE, PARAMETER, SPAN, depth=-1)),
    ("trace.max_steps", lambda: rb.trace(EDGE, PARAMETER, SPAN, max_steps=0)),
    ("tol", lambda: rb.trace(EDGE, PARAMETER, SPAN, tol=2.0)),
    ("degree", lambda: rb.trace(EDGE, PARAMETER, SPAN, degree=9)),
    ("n", lambda: rb.trace(EDGE, PARAMETER, SPAN, n=1)),
    ("start", lambda: rb.trace(EDGE, PARAMETER, SPAN, start=[0.0] * 4)),
    ("start", lambda: rb.trace(EDGE, PARAMETER, SPAN, start=pressed(0.0))),
    ("start", lambda: rb.trace(CLAMPED, FORCE, (-1e-5, 0.0), start=pressed(-1e-4))),
    ("start", lambda: rb.trace(EDGE, "ribbon.length", (5.0, 9.0), start=rb.solve(EDGE))),
]


@pytest.mark.parametrize(("field", "call"), BAD)
def test_bad_input_is_one_line(core, field, call):
    refuses(field, call)
    assert not core or field.startswith("trace.functions")


def test_a_scene_that_cannot_be_at_an_end_of_the_span_says_why(core):
    hinged = rb.Scene(LEAF, start=rb.Hinged(), end=rb.Free((1e-5, 0.0, 0.0)))
    with pytest.raises(rb.InputError, match=r"trace.span\[0\] = 0.0: expected a value .* not: end = Free"):
        rb.trace(hinged, "load_factor", (0.0, 1.0))


def test_a_start_that_is_no_equilibrium(core, monkeypatch):
    def refused(*arguments):
        raise ValueError("the residual is 0.1")

    monkeypatch.setattr(_core, "trace", refused)
    with pytest.raises(
        rb.InputError, match=r"expected an equilibrium of the scene, not: the residual is 0.1"
    ) as e:
        rb.trace(CLAMPED, FORCE, FORCES, start=pressed(0.0))
    assert e.value.field == "start"
    refuses("scene", lambda: rb.trace(CLAMPED, FORCE, FORCES))


def test_branches(diagram):
    flat, bent, twisted = diagram.branches
    assert (flat.phases[0], bent.phases[-1], twisted.phases[-1]) == ("flat", "bent", "twisted")
    assert flat.stable.tolist() == [True] * 3 + [False] * 4
    assert bent.stable[1:].all()
    assert bent.known.all()
    assert diagram.special_points[bent.origin].kind == "branch_point"
    states = rb.natural_shapes(LEAF, rb.growth.edge(0.08))
    for branch, phase in ((flat, "flat"), (bent, "bent"), (twisted, "twisted")):
        state, found = next(s for s in states if s.phase == phase), branch.state(-1)
        np.testing.assert_allclose(found.strain, state.strain, atol=1e-15)
        np.testing.assert_allclose(branch.values("position[0]")[-1], state.position[-1, 0], atol=1e-12)
        assert found.energy == pytest.approx(state.energy)
        assert (found.section_index, found.stable, found.phase) == (state.section_index, state.stable, phase)
        assert found.scene.growth == rb.growth.edge(0.08)
        assert branch.energy[-1] == pytest.approx(state.energy)
        assert branch.values("K3")[-1] == pytest.approx(state.strain[3], rel=1e-12)
    with pytest.raises(ValueError, match="read-only"):
        flat.strains[0] = 0.0


def test_held_branches(held):
    (branch,) = held.branches
    state = pressed(-2e-4)
    found = branch.state(2)
    np.testing.assert_allclose(found.position, state.position, atol=1e-9)
    assert (found.stable, found.phase, branch.phases[2]) == (True, "curved", "curved")
    assert branch.energy[2] == pytest.approx(found.energy, rel=1e-12)
    total = branch.energy + branch.load_potential
    np.testing.assert_array_equal(branch.values("total_energy"), total)
    reactions = found.reactions
    assert branch.values("start.moment[1]")[2] == pytest.approx(reactions.start.moment[1])
    assert branch.values("end.force[2]")[2] == pytest.approx(-2e-4)
    kinds = [(point.kind, point.name, point.reason) for point in held.special_points]
    failed = ("end", "failed", "the Newton iteration diverged")
    assert kinds == [("value", "", ""), ("end", "span", ""), failed]
    assert held.special_points[0].state.scene.end.force == -2e-4


def test_unknown_stability_is_told_apart(core, monkeypatch):
    trace = pressed_trace()
    trace.branches[0].index[:] = np.nan
    monkeypatch.setattr(_core, "trace", lambda *arguments: trace)
    diagram = rb.trace(CLAMPED, FORCE, FORCES)
    assert not diagram.branches[0].known.any()
    assert diagram.table()["stable"] == [None] * 5


def test_quantities_have_names(diagram):
    refuses("quantity", lambda: diagram.branches[0].values("k3"))
    with pytest.raises(rb.InputError, match=r"position\[0..2\], .*; the nearest is end.force\[2\]"):
        diagram.branches[0].values("end.force")


def test_states_at_a_value(diagram, held):
    found = diagram.states_at(0.06)
    assert [state.phase for state in found] == ["flat", "bent", "twisted"]
    exact = rb.natural_shapes(LEAF, rb.growth.edge(0.06))
    for state in found:
        strain = next(s.strain for s in exact if s.phase == state.phase)
        np.testing.assert_allclose(state.strain, strain, atol=1e-12)
        assert state.scene.growth == rb.growth.edge(0.06)
    # a branch point belongs to the branch that it is on, not to that which begins there
    assert len(diagram.states_at(BENDS)) == 1
    assert diagram.states_at(0.09) == []
    (state,) = held.states_at(-1.5e-4)
    assert state.reactions.end.force[2] == pytest.approx(-1.5e-4)
    refuses("value", lambda: diagram.states_at("0.06"))


@pytest.mark.parametrize(("ended", "count"), [(("span", "span"), 2), (("closed", "closed"), 1)])
def test_the_ends_of_a_closed_branch_are_one_state(core, monkeypatch, ended, count):
    branch = FakeBranch([0.0, -1e-4, 0.0], pressed, ended)
    monkeypatch.setattr(_core, "trace", lambda *arguments: FakeTrace([branch], []))
    assert len(rb.trace(CLAMPED, FORCE, FORCES).states_at(0.0)) == count


def test_zeros_of_functions(core):
    functions = {"tip": lambda state: state.strain[2] - 0.4, "energy": lambda state: state.energy - 1e-4}
    diagram = rb.trace(EDGE, PARAMETER, SPAN, functions=functions)
    zeros = [point for point in diagram.special_points if point.kind == "zero"]
    assert {(point.name, point.branch) for point in zeros} == {("energy", 0), ("energy", 1), ("tip", 1)}
    for point in zeros:
        assert abs(functions[point.name](point.state)) < 1e-12
        assert point.state.scene.growth.values(0.5)["gamma33"] == pytest.approx(point.parameter)


def test_a_function_that_jumps_has_no_zero_there(core):
    functions = {"sign": lambda state: 1.0 if state.strain[2] > 0.3 else -1.0}
    diagram = rb.trace(EDGE, PARAMETER, SPAN, functions=functions)
    assert all(point.kind != "zero" or point.branch != 1 for point in diagram.special_points)


def test_table(diagram):
    table = diagram.table()
    assert list(table) == [
        *("branch", "point", "parameter", "eps", "K1", "K2", "K3", "energy", "load_potential", "index"),
        *("section_index", "stable", "position_0", "position_1", "position_2", "special"),
    ]
    assert {len(column) for column in table.values()} == {20}
    assert table["special"][2] == "branch_point"
    assert table["stable"][1:5] == [True, True, False, False]


def test_dataframe_or_one_line(diagram):
    if find_spec("pandas") is None:
        with pytest.raises(rb.RibbonError, match="needs pandas"):
            diagram.to_dataframe()
    else:
        assert list(diagram.to_dataframe().columns) == list(diagram.table())


def test_repr(diagram):
    assert repr(diagram) == ("Diagram(growth.edge.amplitude in [0, 0.08], 3 branches, 20 points, 2 special)")
    assert "ended branch point and span" in repr(diagram.branches[1])


def test_a_trace_without_branches(monkeypatch):
    monkeypatch.setattr(_core, "trace_natural", lambda *arguments: FakeTrace([], []), raising=False)
    diagram = rb.trace(EDGE, PARAMETER, SPAN)
    assert diagram.table() == {}
    assert diagram.states_at(0.05) == []
    assert number("width", diagram.plot().get_figwidth()) > 0.0


def test_fakes_are_equilibria():
    for branch in fake_core.edge_trace().branches:
        for value, strain in zip(branch.parameter, branch.strains, strict=True):
            assert np.abs(rb.SectionLaw(0.1, rb.growth.edge(value)).gradient(strain)).max() < 1e-12
