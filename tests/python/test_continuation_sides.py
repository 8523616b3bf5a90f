"""Branches that meet another from its side, or turn back outside the span; states next to branch points."""

from __future__ import annotations

import math

import numpy as np
import pytest
import ribbonrs as rb
from continued import kinds, places
from held import rod

SPAN = 40.0


def pressed(law: rb.LinearLaw, distance: float, **ends: object) -> rb.Scene:
    """A rod pressed together, with a load that has no size yet across its middle."""
    ends = ends or {"start": rb.Hinged(2), "end": rb.Hinged(2, position=(0.0, 0.0, distance))}
    return rod(law=law, loads=[rb.PointLoad(0.5, force=(0.0, 0.0, 0.0))], **ends)


STIFF = rb.LinearLaw(EI1=100.0, EI2=1.0, GJ=1.0, inextensible=True)
LAWS = {
    "stiff across": STIFF,
    "almost flat": rb.LinearLaw(EI1=1e4, EI2=1.0, GJ=100.0, inextensible=True),
    "extensible": rb.LinearLaw(EA=1e4, EI1=100.0, EI2=1.0, GJ=1.0),
}


@pytest.mark.parametrize("tol", [1e-6, 1e-10])
@pytest.mark.parametrize("distance", [0.9, 0.95, 0.98])
@pytest.mark.parametrize("name", LAWS)
def test_the_way_over_joins_both_arches(name: str, distance: float, tol: float) -> None:
    # An arch with a load across sways aside and becomes its mirror image: a pitchfork on each, from the side.
    scene = pressed(LAWS[name], distance)
    span = (-SPAN, SPAN)
    diagram = rb.trace(scene, "loads[0].force[0]", span, start=rb.solve(scene), tol=tol, depth=1)
    # Next to where they join the error of the mesh counts, which is tol.
    allowed = max(tol, 1e-9) * SPAN / 10.0
    for sways in diagram.branches[1:]:
        begins = abs(sways.parameter[0])
        assert sways.ended == ("branch point", "joined")
        assert sways.parameter[-1] in places(diagram, "branch_point", sways.number)
        np.testing.assert_allclose(
            np.abs(places(diagram, "branch_point", sways.number)), begins, atol=allowed
        )
        assert not places(diagram, "fold", sways.number).size
        assert np.ptp(sways.index[1:-1]) <= 1.0


def test_a_twisted_strip_sways_once_round() -> None:
    strip = rb.Ribbon(10.0, 1.0, 0.02)
    scene = rb.Scene(strip, end=rb.Clamped(position=(0.0, 0.0, 9.93)))
    diagram = rb.trace(scene, "end.twist_turns", (0.0, 0.15), depth=1)
    (begins,) = places(diagram, "branch_point", 0)
    turns, ends = places(diagram, "branch_point", 1)[::-1]
    assert diagram.branches[1].ended == ("branch point", "joined")
    assert ends == pytest.approx(begins, rel=1e-9)
    assert turns > 2.0 * begins


@pytest.mark.parametrize("span", [(-0.04, 0.04), (-0.04, 0.039), (-0.04, 0.02), (-0.03, 0.03)])
@pytest.mark.parametrize("end", [rb.Clamped, rb.Pinned])
def test_a_stable_branch_has_no_special_points(span: tuple[float, float], end: type) -> None:
    scene = rb.Scene(rb.Ribbon(10.0, 1.0, 0.1), rb.growth.edge(0.0), end=end(position=(0.0, 0.0, 9.5)))
    diagram = rb.trace(scene, "growth.edge.amplitude", span)
    assert kinds(diagram) == set()
    assert set(diagram.branches[0].index) == {0.0}


ARCH = 1.0
FOLD = 29.9228487400
PITCHFORK = 26.3514302203


def arch(span: tuple[float, float], tol: float = 1e-10) -> rb.Diagram:
    """A clamped circular arch of an angle of 1 with a load on its crown."""
    law = rb.LinearLaw(EI1=100.0, EI2=1.0, GJ=1.0, inextensible=True, intrinsic=(0.0, 0.0, ARCH, 0.0))
    ends = {
        "start": rb.Clamped(rotation=(0.0, -ARCH / 2.0, 0.0)),
        "end": rb.Clamped((0.0, 0.0, 2.0 * math.sin(ARCH / 2.0) / ARCH), rotation=(0.0, ARCH / 2.0, 0.0)),
    }
    scene = pressed(law, 0.0, **ends)
    start = rb.solve(scene, guess=(0.0, 0.0, ARCH, 0.0), tol=tol)
    return rb.trace(scene, "loads[0].force[0]", span, start=start, tol=tol, depth=0)


@pytest.mark.parametrize("end", [29.0, 29.5, 29.7, 29.85, 29.9, 29.92])
def test_a_branch_ends_where_it_leaves_the_span(end: float) -> None:
    # it turns back at a fold beyond
    (branch,) = arch((-30.0, end)).branches
    assert branch.ended == ("span", "span")
    assert (branch.parameter.max(), branch.parameter[0]) in ((end, end), (end, -30.0))
    assert branch.state(int(np.argmax(branch.parameter))).report.residual < 1e-9


@pytest.mark.parametrize("span", [(-200.0, 200.0), (-60.0, 120.0), (-10.0, 60.0)])
@pytest.mark.parametrize("tol", [1e-3, 1e-5, 1e-6, 3e-7, 1e-7, 1e-8])
def test_places_are_as_good_as_the_tolerance(tol: float, span: tuple[float, float]) -> None:
    # the same for every tol below 1e-9, and where the determinant of a shooting by Runge-Kutta vanishes
    diagram = arch(span, tol)
    allowed = max(tol / 100.0, 1e-10) * (span[1] - span[0])
    assert np.min(np.abs(places(diagram, "branch_point") - PITCHFORK)) < allowed
    assert np.min(np.abs(places(diagram, "fold") - FOLD)) < allowed


@pytest.mark.parametrize("other", [(0.08, 0.2), (0.05, 0.12)])
@pytest.mark.parametrize("last", [0.05, 0.06])
def test_a_locus_ends_at_the_ends_of_its_spans(last: float, other: tuple[float, float]) -> None:
    scene = rb.Scene(rb.Ribbon(10.0, 1.0, 0.1), rb.growth.edge(0.0))
    diagram = rb.trace(scene, "growth.edge.amplitude", (0.0, last))
    point = next(p for p in diagram.special_points if p.kind == "branch_point")
    locus = rb.trace_locus(diagram, point, "ribbon.thickness", other)
    assert locus.ended == ("span", "span")
    assert locus.values[0, 1] == other[0]
    assert locus.values[-1, 0] == last or locus.values[-1, 1] == other[1]
    assert np.all((locus.values >= [0.0, other[0]]) & (locus.values <= [last, other[1]]))
    edge, thickness = locus.values.T
    np.testing.assert_allclose(edge / thickness**2, point.parameter / 0.1**2, rtol=1e-9)


def test_states_next_to_a_branch_point() -> None:
    # a column that is pressed by a fixed force buckles as it becomes thinner
    length = 20.0
    force = -0.4 * 0.1**2 / 12.0 * math.pi**2 / length**2
    scene = rb.Scene(rb.Ribbon(length, 1.0, 0.1), end=rb.Free(force=(0.0, 0.0, force)))
    diagram = rb.trace(scene, "ribbon.thickness", (0.06, 0.2), depth=1)
    (buckles,) = places(diagram, "branch_point", 0)
    grows = []
    for thickness in buckles - np.geomspace(1e-6, 0.03, 30):
        bent, image, straight = diagram.states_at(thickness)
        assert (bent.index, image.index, straight.index) == (0.0, 0.0, 1.0)
        assert max(state.report.residual for state in (bent, image, straight)) < 1e-9
        assert bent.scene.ribbon.thickness == pytest.approx(thickness, rel=1e-12)
        largest = [np.max(np.abs(state.strains[:, 2])) for state in (bent, image, straight)]
        assert largest[0] == pytest.approx(largest[1], rel=1e-6)
        assert largest[2] < 1e-9
        grows.append(largest[0] ** 2 / (buckles - thickness))
    # Its curvature is as the root of the distance from the branch point, but for a part as large as that.
    np.testing.assert_allclose(grows[:10], grows[0], rtol=1e-3)


def test_natural_states_next_to_a_branch_point() -> None:
    leaf = rb.Ribbon(10.0, 1.0, 0.1)
    diagram = rb.trace(rb.Scene(leaf, rb.growth.edge(0.0)), "growth.edge.amplitude", (-0.08, 0.08))
    for amplitude in np.linspace(-0.079, 0.079, 80):
        found = diagram.states_at(amplitude)
        exact = rb.natural_shapes(leaf, rb.growth.edge(amplitude))
        energies = sorted({round(state.energy, 12) for state in exact})
        assert sorted({round(state.energy, 12) for state in found}) == energies


def test_values_are_in_the_order_of_the_branch() -> None:
    # many between two points of it
    column = rod(law=STIFF, end=rb.Free(force=(0.1, 0.0, -1.0)))
    values = np.linspace(-29.0, -1.0, 1000)
    diagram = rb.trace(column, "end.force[2]", (-30.0, 0.0), values=values.tolist(), depth=0)
    (branch,) = diagram.branches
    assert np.all(np.isin(values, branch.parameter))
    assert np.all(np.diff(branch.parameter) > 0.0)


def test_a_branch_from_its_fold() -> None:
    # where the equations at a fixed load are singular
    diagram = arch((-60.0, 120.0))
    for fold in (point for point in diagram.special_points if point.kind == "fold"):
        start = diagram.branches[0].state(fold.place)
        again = rb.trace(start.scene, "loads[0].force[0]", (-60.0, 120.0), start=start, tol=1e-10, depth=0)
        assert again.branches[0].ended == ("span", "span")
        for kind in ("fold", "branch_point"):
            np.testing.assert_allclose(places(again, kind), places(diagram, kind), atol=1e-8)


def test_what_is_between_points_does_not_hang_on_what_was_asked_before() -> None:
    scene = rb.Scene(
        rb.Ribbon(10.0, 1.0, 0.1), rb.growth.thickness(0.05), end=rb.Clamped(position=(0.0, 0.0, 9.5))
    )
    zeros = {"length": lambda state: state.scene.ribbon.length - 10.3}
    diagram = rb.trace(scene, "ribbon.length", (9.7, 11.0), functions=zeros)
    (zero,) = (point for point in diagram.special_points if point.kind == "zero")
    assert zero.parameter == pytest.approx(10.3, abs=1e-11)
    assert zero.state.scene.ribbon.length == pytest.approx(10.3, abs=1e-11)
    (branch,) = diagram.branches
    length = branch.between(2, 0.3).scene.ribbon.length
    branch.state(0), branch.between(0, 0.5)
    assert branch.between(2, 0.3).scene.ribbon.length == pytest.approx(length, rel=1e-12)


GROWTHS = {
    "thickness": (rb.growth.thickness(0.02), "growth.thickness.amplitude", 0.02),
    "edges": (rb.growth.edge(0.002), "growth.edge.amplitude", 0.004),
    "chiral": (rb.growth.chiral(0.005), "growth.chiral.amplitude", 0.01),
}


@pytest.mark.parametrize("law", ["full", "linear"])
@pytest.mark.parametrize("link", [0, 1])
@pytest.mark.parametrize("name", GROWTHS)
def test_closed_ribbons_do_not_glide_as_they_grow(name: str, link: int, law: str) -> None:
    # A twisted ring bends more in some places than in others, and is clamped to itself at any of them.
    growth, parameter, most = GROWTHS[name]
    scene = rb.Scene(rb.Ribbon(15.0, 1.0, 0.1), growth, start=rb.Closed(link=link), law=law)
    diagram = rb.trace(scene, parameter, (-most, most), depth=0)
    (branch,) = diagram.branches
    assert branch.ended == ("start", "span")
    assert np.all(np.diff(branch.parameter) > 0.0)
    first, last = (state.strains for state in (branch.state(0), branch.state(-1)))
    # what glides goes round the whole range of its curvatures
    assert np.abs(last[0, 1:] - first[0, 1:]).max() < 0.5 * np.ptp(first[:, 1:], axis=0).max() + 0.05


def test_closed_branch_passes_through_the_ring_turned_inside_out() -> None:
    # The branch lies among its own images that glide: what leads to the ring must not pass beside it.
    rod = rb.LinearLaw(EI1=100.0, EI2=1.0, GJ=1.0, inextensible=True, intrinsic=(0.0, 0.0, 0.0, 2.6))
    scene = rb.Scene(rb.Ribbon(1.0, 1.0, 0.1), law=rod, start=rb.Closed(link=1.0))
    diagram = rb.trace(scene, "law.intrinsic[2]", (-15.0, 15.0), depth=1)
    ring, branch = diagram.branches
    assert branch.ended == ("branch point", "joined")
    (leaves,) = (p.parameter for p in diagram.special_points if p.kind == "branch_point" and p.branch == 0)
    met = [p.parameter for p in diagram.special_points if p.kind == "branch_point" and p.branch == 1]
    # turned inside out, natural curvature counts the other way; next to the ring the parameter changes with
    # the square of what is located
    assert met == pytest.approx([-leaves, leaves], abs=1e-6)
    assert ring.ended == ("start", "span")
