"""Branches of held ribbons: their symmetries, folds, and indices counted independently."""

import math
from functools import cache

import numpy as np
import pytest
import ribbonrs as rb
from continued import changes, places
from held import rod
from test_boundary_stability import EI, LEAF, negative_directions

STRIP = rb.Ribbon(10.0, 1.0, 0.1)
SYMMETRIC = 1e-8
"""Relative error of what a symmetry makes equal: tol is 1e-10 of the span."""


# --- an arch that snaps


@cache
def arch(side, **arguments):
    """The strip pressed together by 1/100 and pushed across its middle, from the arch to either side."""
    scene = rb.Scene(STRIP, None, end=rb.Clamped((0.0, 0.0, 9.9)), loads=[rb.PointLoad(S=5.0)])
    start = rb.solve(scene)
    start = rb.solve(scene, guess=side * np.sign(start.position[50, 0]) * start.strains)
    assert side * start.position[50, 0] > 0.6
    return rb.trace(scene, "loads[0].force[0]", (-5e-4, 5e-4), start=start, depth=0, **arguments)


def test_arches_to_either_side_are_mirror_images():
    up, down = arch(1.0), arch(-1.0)
    for kind, count in (("branch_point", 3), ("fold", 1)):
        there, here = places(up, kind), -places(down, kind)[::-1]
        assert there.size == count
        np.testing.assert_allclose(there, here, rtol=SYMMETRIC)
    for load in (-4e-4, -1e-4, 0.0, 2e-4, 4e-4):
        ours, theirs = up.states_at(load), down.states_at(-load)
        middles = [sorted(s.at([5.0]).position[0, 0] for s in states) for states in (ours, theirs)]
        np.testing.assert_allclose(middles[0], -np.array(middles[1])[::-1], atol=1e-8)
        assert sorted(s.index for s in ours) == sorted(s.index for s in theirs)
        assert max(s.report.residual for s in ours) < 1e-9


def test_the_index_of_an_arch_that_snaps():
    # asymmetric modes first; the arch falls at the first of them, long before the fold
    for side in (-1.0, 1.0):
        diagram = arch(side)
        (branch,) = diagram.branches
        assert branch.ended == ("span", "span")
        stable = branch.parameter[branch.stable]
        first = places(diagram, "branch_point")[0 if side < 0.0 else -1]
        np.testing.assert_array_less(side * first, side * stable + 1e-12)
        rises = list(changes(diagram))
        away = 1.0 if branch.stable[0] else -1.0
        assert all(change == (change[0], 1, away) for change in rises)
        assert [round(v) for v in branch.index[[0, -1]]] == [0, 4][:: int(away)]


# --- edges that grow, clamped half a turn apart


@cache
def twisted_strip(**arguments):
    scene = rb.Scene(STRIP, rb.growth.edge(0.02), end=rb.Clamped(twist_turns=0.5))
    return rb.trace(scene, "end.position[2]", (9.0, 10.0), depth=0, **arguments)


def test_a_twisted_strip_of_growing_edges():
    diagram = twisted_strip()
    (branch,) = diagram.branches
    folds = [p.parameter for p in diagram.special_points if p.kind == "fold"]
    assert len(folds) == 4
    # the branch goes through a state that is symmetric to a half turn, and back as its own image
    np.testing.assert_allclose(folds, folds[::-1], rtol=1e-11)
    assert len(places(diagram, "branch_point")) == 1
    assert branch.ended == ("start", "span")
    assert branch.parameter[[0, -1]].tolist() == [9.0, 9.0]
    assert [abs(change) for kind, _, change in changes(diagram) if kind == "fold"] == [1.0] * 4
    states = diagram.states_at(9.5)
    assert len(states) == 2
    for state in states:
        assert state.report.residual < 1e-9
        assert state.scene.end.position == (0.0, 0.0, 9.5)
        assert state.index == 0
    assert states[0].energy == pytest.approx(states[1].energy, rel=SYMMETRIC)


@pytest.mark.parametrize(("degree", "tol"), [(4, 1e-8), (5, 1e-10), (6, 1e-10), (7, 1e-8)])
def test_the_mesh_does_not_matter(degree, tol):
    fine, other = twisted_strip(), twisted_strip(degree=degree, tol=tol)
    # a fold is of second order in the error of its state
    np.testing.assert_allclose(places(other, "fold"), places(fine, "fold"), rtol=1e-10)
    np.testing.assert_allclose(places(other, "branch_point"), places(fine, "branch_point"), rtol=5e-9)
    assert [p.kind for p in other.special_points] == [p.kind for p in fine.special_points]
    for position in (9.2, 9.5, 9.62):
        both = fine.states_at(position), other.states_at(position)
        assert [s.index for s in both[0]] == [s.index for s in both[1]]


@cache
def symmetric_strip(tol, **arguments):
    """From the symmetric state, onto the branch that breaks its symmetry."""
    scene = rb.Scene(STRIP, rb.growth.edge(0.02), end=rb.Clamped(twist_turns=0.5))
    start = rb.solve(scene, tol=tol, **arguments)
    return rb.trace(scene, "end.position[2]", (9.0, 10.0), start=start, tol=tol, depth=1, **arguments)


@pytest.mark.parametrize("tol", [1e-4, 1e-6, 1e-7, 3e-8, 1e-9])
def test_no_tolerance_leads_back_to_the_symmetric_branch(tol):
    # On a mesh that is not symmetric its error turns the tangent at the branch point by its third root.
    fine, other = symmetric_strip(1e-10), symmetric_strip(tol)
    np.testing.assert_allclose(places(other, "branch_point"), places(fine, "branch_point"), rtol=tol)
    np.testing.assert_allclose(places(other, "fold"), places(fine, "fold"), rtol=tol)
    assert len(places(other, "fold")) == 2
    ends = [np.abs(diagram.branches[1].state(-1).reactions.start.force) for diagram in (fine, other)]
    # Of a force that is small beside the others no more digits are asked for.
    np.testing.assert_allclose(ends[1], ends[0], rtol=0.0, atol=tol * ends[0].max())


@pytest.mark.parametrize(("degree", "tol"), [(3, 1e-4), (3, 1e-5), (4, 1e-6)])
def test_a_state_on_a_coarse_mesh_is_a_start(degree, tol):
    # Moved to a symmetric mesh, where it begins, such a state is farther from the equilibrium than its error.
    fine, other = symmetric_strip(1e-10), symmetric_strip(tol, degree=degree)
    np.testing.assert_allclose(places(other, "branch_point"), places(fine, "branch_point"), rtol=tol)
    np.testing.assert_allclose(places(other, "fold"), places(fine, "fold"), rtol=tol)


# --- an independent count


@cache
def column(degree=None, tol=1e-10):
    """The leaf as a column, to 12 times its first load, of which values are said on either side."""
    unit = 0.25 * math.pi**2 * EI / 36.0
    scene = rb.Scene(LEAF, None, end=rb.Free((0.0, 0.0, -unit)))
    start = rb.solve(scene, guess=(0.0, 0.0, 0.0, 0.0), degree=degree, tol=tol)
    values = [-factor * unit for factor in (0.97, 1.03, 8.5, 9.5)]
    return unit, rb.trace(
        scene,
        "end.force[2]",
        (-12.0 * unit, 0.0),
        start=start,
        values=values,
        depth=1,
        degree=degree,
        tol=tol,
    )


def test_the_index_is_that_of_a_dense_count():
    _, diagram = column()
    points = [p for p in diagram.special_points if p.kind == "value"]
    assert len(points) == 4 + 1 + 3
    for point in points:
        assert point.state.index == negative_directions(point.state, 12)[0]
    assert {p.state.index for p in points} == {0.0, 1.0, 2.0}


def test_loads_of_a_column_that_shortens():
    # P (1 - P/EA) = (2n - 1)^2 pi^2/4 EI/L^2, EA = 1
    unit, diagram = column()
    found = places(diagram, "branch_point", 0) / unit
    expected = [-(1.0 - math.sqrt(1.0 - 4.0 * n * n * unit)) / (2.0 * unit) for n in (3, 1)]
    np.testing.assert_allclose(found, expected, rtol=1e-9)


@pytest.mark.parametrize(("degree", "tol"), [(3, 1e-10), (4, 1e-8), (6, 1e-10), (7, 1e-8)])
def test_indices_on_other_meshes(degree, tol):
    _, fine = column()
    _, other = column(degree, tol)
    for kind in ("branch_point", "value"):
        np.testing.assert_allclose(places(other, kind), places(fine, kind), rtol=1e-8)
    indices = [[p.state.index for p in d.special_points if p.kind == "value"] for d in (fine, other)]
    assert indices[0] == indices[1]


def test_the_rod_of_the_same_stiffnesses_buckles_alike():
    law = rb.LinearLaw(EA=1.0, EI1=1.0 / 12.0, EI2=EI, GJ=0.01 / 9.0)
    unit, diagram = column()
    scene = rod(6.0, law, end=rb.Free((0.0, 0.0, -unit)))
    start = rb.solve(scene, guess=(0.0, 0.0, 0.0, 0.0))
    other = rb.trace(scene, "end.force[2]", (-12.0 * unit, 0.0), start=start, depth=0)
    np.testing.assert_allclose(places(other, "branch_point"), places(diagram, "branch_point", 0), rtol=1e-9)


# --- a strip pressed together, from its arch


def test_the_straight_strip_is_followed_from_its_arch():
    # the arch meets it from the side; it changes the ribbon a thousand times less, and others are near
    ends = [rb.Clamped((0.0, 0.0, z)) for z in (9.98, 10.0)]
    arch, straight = (rb.Scene(STRIP, None, end=end) for end in ends)
    span = (9.97, 10.0)
    known = rb.trace(straight, "end.position[2]", span, start=rb.solve(straight), depth=0)
    found = rb.trace(arch, "end.position[2]", span, depth=1)
    above, below = found.branches[1:]
    np.testing.assert_allclose(
        np.sort([*places(found, "branch_point", 0), *places(found, "branch_point", below.number)]),
        places(known, "branch_point"),
        atol=1e-10 * (span[1] - span[0]),
        rtol=0.0,
    )
    assert places(known, "branch_point").size == 5
    assert [above.parameter[-1], below.parameter[-1]] == [span[1], span[0]]
    assert (above.index[-1], below.index[-1]) == (0.0, 5.0)


# --- sections that are unstable where growth is greatest


def bends(growth):
    """The factor of a growth at which its section becomes unstable."""
    scene = rb.Scene(STRIP, growth)
    diagram = rb.trace(scene, "growth.edge.amplitude", (0.0, 2.0))
    return places(diagram, "section_instability")[0]


@pytest.mark.parametrize(
    "xi", [lambda s: 0.003 * s, lambda s: 0.03 - 0.003 * s, lambda s: 0.03 - 0.006 * abs(s - 5.0)]
)
def test_sections_at_nodes_count(xi):
    # greatest at an end or at a kink, where no stage is: flat bends at (-7 + sqrt(259))/2 eta^2
    S = np.array([0.0, 5.0, 10.0])
    exact = (-7.0 + math.sqrt(259.0)) / 2.0 * 0.01 / 0.03
    assert bends(rb.growth.edge((S, np.array([xi(s) for s in S])))) == pytest.approx(exact, rel=1e-9)


def test_crowded_branch_points_are_found_one_by_one():
    """A straight strip between clamps a quarter of a turn apart, 1/1900 shorter, has eight ways to buckle."""
    scene = rb.Scene(rb.Ribbon(19.0, 1.0, 0.03), end=rb.Clamped(twist_turns=0.25))

    def found(tol):
        start = rb.solve(scene, tol=tol)
        diagram = rb.trace(scene, "end.position[2]", (18.99, 19.0), start=start, tol=tol, depth=0)
        (branch,) = diagram.branches
        assert branch.ended == ("start", "span")
        places = [point.parameter for point in diagram.special_points if point.kind == "branch_point"]
        # Every one that is passed counts.
        assert branch.index[0] == 0
        assert branch.index[-1] == len(places) == 8
        return np.array(places)

    exact = found(1e-9)
    # A straight ribbon is exact on every mesh: that of the shapes into which it buckles counts by its square.
    for tol in (1e-3, 1e-4, 1e-6):
        assert np.abs(found(tol) - exact).max() < 1e-4 * tol


def test_two_branch_points_that_nearly_coincide_are_told_apart():
    # half a turn, and a growth at which two ways to buckle differ by 1.5e-6 of the length
    L = 13.619743618610823
    strip = rb.Ribbon(L, 1.0, 0.0601058429426066)
    scene = rb.Scene(strip, rb.growth.edge(-0.0011537572062640322), end=rb.Clamped(twist_turns=0.5))

    def found(tol):
        start = rb.solve(scene, tol=tol)
        return places(
            rb.trace(scene, "end.position[2]", (0.99 * L, L), start=start, tol=tol, depth=0), "branch_point"
        )

    exact = found(1e-8)
    assert 0.0 < np.abs(np.diff(exact)).min() < 2e-6 * L
    for tol in (1e-4, 1e-6):
        rough = found(tol)
        assert rough.size == exact.size
        # meshes are made for a hundredth of tol
        assert np.abs(rough - exact).max() < 1e-2 * tol


@pytest.mark.parametrize("eta", [0.04, 0.07])
@pytest.mark.parametrize("along", [([0.0, 15.0], [0.005, 0.01]), 0.01], ids=["along", "uniform"])
def test_sections_that_are_unstable_in_two_directions(eta, along):
    # pulled, and free to shorten: the stiffness in twist is n3/12 + eta^2/9 - xi/45, least at the end
    force = 1.8277e-5
    scene = rb.Scene(rb.Ribbon(15.0, 1.0, eta), rb.growth.edge(along), end=rb.Sliding(force=force))
    # the parameter is the amplitude itself, or a factor where that varies
    unit = 1.0 if along == 0.01 else 0.01
    diagram = rb.trace(scene, "growth.edge.amplitude", (0.0, 0.03 / unit), depth=0)
    points = places(diagram, "section_instability") * unit
    assert len(points) == 2
    assert points[1] == pytest.approx(5.0 * eta**2 + 45.0 / 12.0 * force, rel=1e-10)
