"""Scenes that have no isolated equilibrium, or none at all, are refused before they are solved."""

import itertools
import math

import numpy as np
import pytest
import ribbonrs as rb
from refusal import refuses

LEAF = rb.Ribbon(10.0, 1.0, 0.1)
ROD = rb.LinearLaw(EI1=1.0, EI2=1.0, GJ=1.0, inextensible=True)
SIDEWAYS = (1e-6, 0.0, 0.0)


def scene(start, end, **arguments):
    return rb.Scene(LEAF, start=start, end=end, **arguments)


def refused(field, told, start, end, **arguments):
    """Check that the scene is refused in one line about `field` that tells this."""
    refuses(field, lambda: scene(start, end, **arguments))
    with pytest.raises(rb.InputError, match=told):
        scene(start, end, **arguments)


# --- rigid motions


KINDS = (rb.Clamped(), rb.Free(), rb.Pinned(), rb.Hinged(), rb.Sliding())
LOOSE = {
    ("Free", "Free"),
    ("Free", "Pinned"),
    ("Free", "Hinged"),
    ("Free", "Sliding"),
    ("Pinned", "Pinned"),
    ("Sliding", "Sliding"),
}


@pytest.mark.parametrize(("start", "end"), list(itertools.product(KINDS, KINDS)))
def test_ends_without_load_hold_the_ribbon_or_are_refused(start, end):
    names = tuple(sorted((type(start).__name__, type(end).__name__)))
    if names not in LOOSE:
        scene(start, end)
        return
    with pytest.raises(rb.InputError) as caught:
        scene(start, end)
    assert caught.value.field in ("start", "end", "end.axis")
    assert len(str(caught.value).splitlines()) == 1


@pytest.mark.parametrize(
    ("other", "leaves"), [(rb.Free(), "move"), (rb.Pinned(), "turn"), (rb.Sliding(), "move")]
)
def test_no_load_holds_what_is_free_to_move(other, leaves):
    load = {"gravity": (1e-6, 1e-6, 0.0), "loads": [rb.PointLoad(5.0, (0.0, 0.0, 1e-6))]}
    refused("start", f"leaves free to {leaves}", rb.Free(force=SIDEWAYS), other, **load)
    field = "start" if isinstance(other, rb.Free) else "end"
    refused(field, f"leaves free to {leaves}", other, rb.Free(force=SIDEWAYS), **load)


@pytest.mark.parametrize(
    "load",
    [
        {"gravity": SIDEWAYS},
        {"loads": [rb.PointLoad(5.0, SIDEWAYS)]},
        {"loads": [rb.LineLoad(SIDEWAYS)]},
        {"loads": [rb.LineLoad(([0, 5, 10], [[0, 0, 0], [0, 1e-6, 0], [0, 0, 0]]))]},
        {"loads": [rb.LineLoad(lambda S: np.outer(np.sin(S), SIDEWAYS))]},
    ],
)
def test_a_force_across_the_line_of_pins_holds_the_ribbon(load):
    pins = rb.Pinned(), rb.Pinned()
    refused("end", r"turning about the direction \(0, 0, 1\)", *pins)
    scene(*pins, **load)


@pytest.mark.parametrize(
    "load",
    [
        {"gravity": (0.0, 0.0, -1e-6)},
        {"loads": [rb.PointLoad(5.0, moment=(1e-6, 1e-6, 0.0)), rb.LineLoad((0.0, 0.0, 1.0))]},
        {"loads": [rb.LineLoad(moment=lambda S: np.outer(S, SIDEWAYS))]},
    ],
)
def test_forces_along_the_line_of_pins_and_moments_do_not(load):
    refused("end", "turning about the direction", rb.Pinned(), rb.Pinned(moment=(0, 1e-6, 0)), **load)


def test_the_line_of_pins_may_have_any_direction():
    ends = rb.Pinned((1.0, 0.0, 0.0)), rb.Pinned((4.0, 4.0, 0.0))
    refused("end", r"\(0\.6, 0\.8, 0\)", *ends, gravity=(3e-6, 4e-6, 0.0))
    scene(*ends, gravity=(3e-6, 4.1e-6, 0.0))


def test_pins_at_one_place_are_refused():
    refused(
        "end.position", "a place apart from the start", rb.Pinned(), rb.Pinned((0, 0, 0)), gravity=SIDEWAYS
    )


def test_a_hinge_along_the_line_to_the_other_end_does_not_hold():
    for ends in ((rb.Hinged(3), rb.Hinged(3)), (rb.Hinged(3), rb.Pinned()), (rb.Pinned(), rb.Hinged(3))):
        refused("end", "turning about", *ends)
        scene(*ends, gravity=SIDEWAYS)
    scene(rb.Hinged(3), rb.Hinged(2))
    scene(rb.Hinged(2), rb.Hinged(2))
    refused("end", "turning about", rb.Hinged(2), rb.Hinged(2, position=(0.0, 5.0, 0.0)))


def test_hinges_at_one_place_turn_about_a_common_axis():
    refused("end", r"turning about the direction \(0, 1, 0\)", rb.Hinged(2), rb.Hinged(2, position=(0, 0, 0)))
    scene(rb.Hinged(2), rb.Hinged(1, position=(0, 0, 0)))


def test_a_pendulum():
    hinge, free = rb.Hinged(2), rb.Free()
    refused("end", r"turning about the direction \(0, 1, 0\)", hinge, free)
    refused("end", "turning about", hinge, free, gravity=(0.0, -1e-6, 0.0))
    scene(hinge, free, gravity=(0.0, 0.0, -1e-6))
    scene(hinge, rb.Free(force=SIDEWAYS))
    scene(rb.Free(), hinge, gravity=SIDEWAYS)


def test_slides_hold_each_other_unless_parallel():
    refused("end.axis", "another direction than start.axis", rb.Sliding(), rb.Sliding((0, 0, -2)))
    scene(rb.Sliding(), rb.Sliding((1, 0, 1e-6)))


# --- reach


def test_an_end_out_of_reach():
    told = "at most 11 from the start, which is as far as the ribbon reaches, not 11.0001"
    refused("end.position", told, rb.Clamped(), rb.Clamped((0.0, 0.0, 11.0001)))
    scene(rb.Clamped(), rb.Clamped((0.0, 0.0, 10.9999)))
    refused("start.position", "from the end", rb.Clamped((0.0, 0.0, -1.1)), rb.Pinned())
    scene(rb.Clamped((0.0, 0.0, 21.0)), rb.Clamped())
    refused("end.position", "not 20", rb.Pinned((-10, 0, 0)), rb.Hinged(position=(10, 0, 0)))


def test_growth_lengthens_the_reach():
    place = rb.Clamped((0.0, 0.0, 11.3))
    # the mean of xi (2 x)^2 over the width is xi/3
    rb.Scene(LEAF, rb.growth.edge(0.1), end=place)
    refuses("end.position", lambda: rb.Scene(LEAF, rb.growth.edge(0.08), end=place))
    step = rb.growth.Profile(gamma33=[[0.0], [0.04]], breaks=[0.0], amplitude=([0.0, 10.0], [0.0, 2.0]))
    rb.Scene(LEAF, step, end=place)
    refuses("end.position", lambda: rb.Scene(LEAF, rb.growth.edge(-0.1), end=place))


def test_an_inextensible_ribbon_reaches_its_length():
    scene(rb.Clamped(), rb.Pinned((6.0, 0.0, 8.0)), law=ROD)
    refused("end.position", "at most 10 from", rb.Clamped(), rb.Pinned((6.0, 0.0, 8.0 + 1e-9)), law=ROD)
    longer = rb.LinearLaw(EI1=1, EI2=1, GJ=1, inextensible=True, intrinsic=(0.05, 0, 0, 0))
    scene(rb.Clamped(), rb.Pinned((0.0, 0.0, 10.5)), law=longer)
    stretched = rb.LinearLaw(EA=1, EI1=1, EI2=1, GJ=1, intrinsic=(0.05, 0, 0, 0))
    scene(rb.Clamped(), rb.Pinned((0.0, 0.0, 11.49)), law=stretched)
    refused("end.position", "at most 11.5", rb.Clamped(), rb.Pinned((0.0, 0.0, 11.51)), law=stretched)


def test_the_axis_of_a_slide_passes_within_reach():
    scene(rb.Clamped((10.9, 0.0, -1e3)), rb.Sliding())
    refused("start.position", "not 11.1", rb.Clamped((11.1, 0.0, -1e3)), rb.Sliding())
    # lines along E1 and E3 that pass each other at the distance 0
    scene(rb.Sliding((1, 0, 0)), rb.Sliding())


# --- loads on the ribbon


@pytest.mark.parametrize("S", [0.0, 10.0, -1.0, 10.1, 1e300])
def test_point_loads_are_inside_the_ribbon(S):
    with pytest.raises(rb.InputError, match=r"^loads\[1\]\.S = .*inside \(0, 10\).*Free\(force=, moment=\)"):
        scene(rb.Clamped(), rb.Free(), loads=[rb.PointLoad(1.0), rb.PointLoad(S, SIDEWAYS)])


def test_samples_cover_the_ribbon():
    short = rb.LineLoad(moment=([0.0, 9.0], np.zeros((2, 3))))
    refuses("loads[0].moment", lambda: scene(rb.Clamped(), rb.Free(), loads=[short]))


def test_loads_at_one_place_are_let_pass():
    loads = (rb.PointLoad(5.0, SIDEWAYS), rb.PointLoad(5.0, SIDEWAYS))
    assert scene(rb.Clamped(), rb.Free(), loads=list(loads)).loads == loads


# --- closed ribbons


def test_a_closed_ribbon_has_no_ends():
    for end in (rb.Clamped(), rb.Pinned(), rb.Free(force=SIDEWAYS)):
        refused("end", "a closed ribbon has no ends", rb.Closed(), end)
    assert scene(rb.Closed(), rb.Free()) == rb.Scene(LEAF, start=rb.Closed())


SAME_AFTER_HALF_TURN = [
    rb.growth.edge(0.01) + rb.growth.chiral(0.1),
    rb.growth.Profile(d33=[0.0, 0.1], d22=[0.0, 0.1, 0.0, 0.2], g31=[0.0, 0.1], gamma23=[0.0, 0.1]),
    rb.growth.Profile(gamma22=[0.1], g21=[0.0, 0.0, 0.1], d23=[1.0]),
    rb.growth.Profile(gamma33=lambda x: 0.01 * np.cos(9 * x)),
    rb.growth.Profile(gamma33=[[0.01], [0.0], [0.01]], breaks=[-0.2, 0.2]),
    rb.growth.Profile(d33=([-0.5, 0.0, 0.5], [0.1, 0.0, -0.1]), amplitude=([0.0, 10.0], [0.0, 1.0])),
    # two that are not, but their sum is
    rb.growth.thickness(0.1) + rb.growth.Profile(d33=[-0.1, 0.1]),
]
DIFFERENT = [
    rb.growth.thickness(0.1),
    rb.growth.Profile(d22=[0.0, 0.0, 0.1]),
    rb.growth.Profile(gamma33=[0.0, 0.01]),
    rb.growth.Profile(gamma22=[0.0, 0.01]),
    rb.growth.Profile(d23=[0.0, 0.01]),
    rb.growth.Profile(g21=[0.0, 0.01]),
    rb.growth.Profile(g31=[0.0, 0.0, 0.01]),
    rb.growth.Profile(gamma23=[0.1]),
    rb.growth.Profile(gamma33=[[0.01], [0.0], [0.01]], breaks=[-0.2, 0.25]),
    rb.growth.thickness(([0.0, 10.0], [0.0, 0.1])),
    rb.growth.Profile(gamma33=[0.0, 1e-10, 0.02]),
]


@pytest.mark.parametrize("growth", SAME_AFTER_HALF_TURN)
def test_growth_of_a_moebius_strip(growth):
    rb.Scene(LEAF, growth, start=rb.Closed(-0.5))


@pytest.mark.parametrize("growth", DIFFERENT)
def test_other_growth_needs_whole_turns(growth):
    rb.Scene(LEAF, growth, start=rb.Closed(2.0))
    with pytest.raises(rb.InputError, match=r"^start\.link = 1\.5: expected a whole number of turns"):
        rb.Scene(LEAF, growth, start=rb.Closed(1.5))


def test_a_moebius_rod_is_not_bent():
    twisted = rb.LinearLaw(EA=1, EI1=1, EI2=1, GJ=1, intrinsic=(0.1, 0, 0, 0.1))
    bent = rb.LinearLaw(EA=1, EI1=1, EI2=1, GJ=1, intrinsic=(0, 0, 0.1, 0))
    rb.Scene(LEAF, start=rb.Closed(0.5), law=twisted)
    rb.Scene(LEAF, start=rb.Closed(1), law=bent)
    refuses("start.link", lambda: rb.Scene(LEAF, start=rb.Closed(0.5), law=bent))


# --- what is solved how


def test_what_needs_the_boundary_value_solver():
    assert not rb.Scene(LEAF, rb.growth.edge(0.06), start=rb.Clamped((1, 2, 3))).loaded
    assert not rb.Scene(LEAF, law="quadratic").loaded
    for arguments in (
        {"end": rb.Clamped()},
        {"end": rb.Free(force=SIDEWAYS)},
        {"end": rb.Free(moment=SIDEWAYS)},
        {"start": rb.Pinned(), "end": rb.Clamped()},
        {"start": rb.Free(), "end": rb.Clamped()},
        {"start": rb.Closed()},
        {"gravity": SIDEWAYS},
        {"loads": [rb.LineLoad(SIDEWAYS)]},
        {"law": "linear"},
        {"law": ROD},
    ):
        assert rb.Scene(LEAF, **arguments).loaded


@pytest.mark.parametrize(
    "method", ["", "Pointwise", 1, ["pointwise"], np.array(["pointwise", "x"]), math.nan]
)
def test_methods_refused(method):
    refuses("method", lambda: rb.solve(rb.Scene(LEAF), method=method))


def test_loaded_scenes_are_not_solved_pointwise():
    refuses("method", lambda: rb.solve(rb.Scene(LEAF, end=rb.Clamped()), method="pointwise"))
    assert rb.solve(rb.Scene(LEAF), method="pointwise").phase == "flat"


@pytest.mark.parametrize(
    ("field", "arguments"),
    [
        ("degree", {"degree": 9}),
        ("degree", {"degree": 0}),
        ("tol", {"tol": 9e-15}),
        ("n", {"n": 1}),
        ("guess.shape", {"guess": [0.0, 0.0]}),
        ("guess.shape", {"guess": np.zeros((1, 4))}),
        ("guess.shape", {"guess": np.zeros((4, 3))}),
        ("guess[0, 1]", {"guess": [[0.0, math.nan, 0.0, 0.0]] * 2}),
        ("guess", {"guess": "bent"}),
    ],
)
def test_settings_of_a_loaded_scene_refused(field, arguments):
    refuses(field, lambda: rb.solve(rb.Scene(LEAF, end=rb.Clamped()), **arguments))
