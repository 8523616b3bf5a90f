"""The parameters of a scene: their names, their values, and scenes with other values."""

import json
import math
import warnings

import numpy as np
import pytest
import ribbonrs as rb
from refusal import refuses
from ribbonrs.parameter import parameter_of
from ribbonrs.record import record_of, same, scene_of

LEAF = rb.Ribbon(10.0, 1.0, 0.1)
WIND = ([0.0, 10.0], [[0.0, 0.0, 0.0], [1e-6, 0.0, 0.0]])
TURNED = rb.Clamped(rotation=(0.0, 0.3, 0.1), twist_turns=0.25)
ROD = rb.LinearLaw(EI1=math.inf, EI2=0.5, GJ=0.2, inextensible=True, intrinsic=(0.0, 0.0, 0.1, 0.0))


def gradient(S):
    return 1e-5 * np.stack([S, S, S], axis=1)


SCENES = {
    "natural": rb.Scene(LEAF, rb.growth.edge(0.06) + rb.growth.thickness(0.02, transverse=-0.01)),
    "loaded": rb.Scene(
        LEAF,
        rb.growth.chiral(0.02),
        start=TURNED,
        end=rb.Pinned(position=(0.0, 0.1, 9.5), moment=(1e-6, 0.0, 0.0)),
        gravity=(0.0, 0.0, -1e-4),
        loads=[
            rb.PointLoad(3.0, (1e-4, 0.0, 0.0)),
            rb.LineLoad((0.0, 0.0, 1e-5), WIND),
            rb.LineLoad(gradient),
        ],
    ),
    "varying": rb.Scene(
        rb.Ribbon(10.0, 1.0, 0.1, width_profile=([0.0, 10.0], [1.0, 0.5])),
        rb.growth.edge(lambda S: 0.01 + 0.001 * S) + rb.growth.chiral(([0.0, 10.0], [0.0, 0.02])),
    ),
    "hinged": rb.Scene(
        LEAF, start=rb.Hinged(director=1), end=rb.Free((1e-5, 0, 0)), loads=[rb.LineLoad((0, 1e-6, 0))]
    ),
    "rod": rb.Scene(LEAF, law=ROD, end=rb.Sliding((0.1, 0.0, 1.0), (0.0, 0.2, 0.0), 0.5, force=-0.1)),
    "ring": rb.Scene(LEAF, start=rb.Closed(), law="linear"),
}

NAMES = {
    "natural": [
        "growth.edge.amplitude",
        "growth.thickness.amplitude",
        "ribbon.thickness",
        "ribbon.length",
        *(f"start.position[{k}]" for k in range(3)),
        "start.twist_turns",
        *(f"end.force[{k}]" for k in range(3)),
        *(f"end.moment[{k}]" for k in range(3)),
        *(f"gravity[{k}]" for k in range(3)),
    ],
    "rod": [
        "ribbon.length",
        *(f"start.position[{k}]" for k in range(3)),
        "start.twist_turns",
        "end.twist_turns",
        "end.force",
        *(f"gravity[{k}]" for k in range(3)),
        "load_factor",
        *(f"law.intrinsic[{k}]" for k in range(4)),
    ],
    "ring": ["ribbon.thickness", "ribbon.length", *(f"gravity[{k}]" for k in range(3))],
}

EACH = [(kind, name) for kind, scene in SCENES.items() for name in rb.parameters(scene)]


@pytest.mark.parametrize("kind", NAMES)
def test_names(kind):
    assert list(rb.parameters(SCENES[kind])) == NAMES[kind]


def test_names_of_loads():
    names = rb.parameters(SCENES["loaded"])
    loads = {name.rpartition("[")[0] for name in names if name.startswith("loads")}
    assert loads == {"loads[0].force", "loads[0].moment", "loads[1].force", "loads[2].moment"}
    assert {"end.position[2]", "end.moment[1]", "load_factor"} <= set(names)
    assert "ribbon.length" not in names
    assert {"start.moment", "loads[0].force[1]", "ribbon.length"} <= set(rb.parameters(SCENES["hinged"]))


@pytest.mark.parametrize(("kind", "name"), EACH)
def test_every_parameter_takes_its_value_and_nothing_else_changes(kind, name):
    scene = SCENES[kind]
    parameter = parameter_of(scene, name)
    value = parameter.value
    assert parameter.scene(value) is scene
    changed = value * (1 - 1e-4) if value else 1e-7
    other = parameter.scene(changed)
    assert parameter.read(other) == pytest.approx(changed, rel=1e-12)
    # A place that was left to the ribbon is said; put back, everything is as it was.
    there, back = (
        record_of(other),
        record_of(parameter.write(other, value / changed if factor(scene, name) else value)),
    )
    before = record_of(scene)
    assert not same(there, before)
    for side in ("start", "end"):
        if before[side].get("position", 0) is None and back[side]["position"] is not None:
            before[side]["position"] = scene.places[side == "end"]
    assert same(back, before)


def factor(scene, name):
    """Whether a parameter multiplies what there is."""
    if name == "load_factor":
        return True
    varying = [term.path for term in scene.growth.terms if not isinstance(term.amplitude, float)]
    return name in varying


@pytest.mark.parametrize(("kind", "name"), EACH)
def test_a_record_is_the_scene_also_after_json(kind, name):
    parameter = parameter_of(SCENES[kind], name)
    other = parameter.scene(parameter.value * 0.999 or 1e-7)
    record = json.loads(json.dumps(record_of(other)))
    assert same(record_of(scene_of(record)), record_of(other))


def test_growth_as_a_whole():
    parameter = parameter_of(SCENES["varying"], "growth.edge.amplitude")
    assert parameter.value == 1.0
    half = parameter.scene(0.5)
    assert half.growth.values(0.5, [0.0, 10.0])["gamma33"] == pytest.approx([0.005, 0.01])
    both = parameter_of(SCENES["natural"], "growth.thickness.amplitude").scene(0.04)
    assert both.growth.values(0.0)["d22"] == pytest.approx(-0.02)


def test_load_factor_multiplies_every_load():
    half = parameter_of(SCENES["loaded"], "load_factor").scene(0.5)
    assert half.gravity == (0.0, 0.0, -5e-5)
    assert half.end.moment == (5e-7, 0.0, 0.0)
    assert half.end.position == (0.0, 0.1, 9.5)
    assert half.loads[0].force == (5e-5, 0.0, 0.0)
    assert half.loads[1].force == (0.0, 0.0, 5e-6)
    assert half.loads[1].along(10.0)["moment"][0].evaluate(10.0) == pytest.approx(5e-7)
    assert half.loads[2].along(10.0)["force"][1].evaluate(2.0) == pytest.approx(1e-5)
    assert not parameter_of(SCENES["rod"], "load_factor").scene(0.0).end.force


def test_the_default_place_of_the_end_moves_with_the_length():
    scene = rb.Scene(LEAF, end=rb.Clamped())
    assert parameter_of(scene, "ribbon.length").scene(11.0).places[1] == (0.0, 0.0, 11.0)
    assert parameter_of(scene, "end.position[2]").value == 10.0
    assert parameter_of(scene, "end.position[0]").scene(0.5).places[1] == (0.5, 0.0, 10.0)


def test_thickness_leaves_dimensionless_loads():
    thin = parameter_of(SCENES["loaded"], "ribbon.thickness").scene(0.05)
    assert (thin.gravity, thin.ribbon.thickness_ratio) == ((0.0, 0.0, -1e-4), 0.05)


def test_large_growth_is_not_warned_of():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert parameter_of(SCENES["natural"], "growth.edge.amplitude").scene(0.2).growth_size == 0.2


def test_names_that_there_are_not():
    refuses("trace.parameter", lambda: parameter_of(SCENES["natural"], "growth.edg.amplitude"))
    with pytest.raises(rb.InputError, match=r"the nearest is growth\.edge\.amplitude$"):
        parameter_of(SCENES["natural"], "growth.edg.amplitude")
    with pytest.raises(
        rb.InputError, match=r"expected one of ribbon\.thickness, .*; the nearest is gravity\[2\]"
    ):
        parameter_of(SCENES["ring"], "gravity[4]")
    refuses("trace.parameter", lambda: parameter_of(SCENES["natural"], 3))
    refuses("scene", lambda: rb.parameters(3))


def test_values_that_cannot_be():
    refuses("ribbon.thickness", lambda: parameter_of(SCENES["natural"], "ribbon.thickness").scene(-0.1))
    refuses("growth.size", lambda: parameter_of(SCENES["natural"], "growth.edge.amplitude").scene(0.9))
    refuses("gravity[0]", lambda: parameter_of(SCENES["natural"], "gravity[0]").scene(math.nan))
