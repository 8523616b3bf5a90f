"""What the objects of a scene accept, what they refuse, and in which words."""

import math
import pickle
from fractions import Fraction

import numpy as np
import pytest
import ribbonrs as rb
from refusal import NOT_FINITE, NOT_NUMBERS, refuses


def test_error_says_field_value_and_expectation():
    with pytest.raises(rb.InputError) as caught:
        rb.Ribbon(10.0, 1.0, -0.1)
    assert str(caught.value) == "ribbon.thickness = -0.1: expected a positive finite number"
    assert (caught.value.field, caught.value.value) == ("ribbon.thickness", -0.1)


def test_errors_form_the_documented_tree_and_survive_pickling():
    assert issubclass(rb.InputError, (rb.RibbonError, ValueError))
    assert issubclass(rb.ConvergenceError, (rb.RibbonError, RuntimeError))
    assert issubclass(rb.RibbonError, Exception)
    error = rb.InputError("a", 1, "b")
    assert str(pickle.loads(pickle.dumps(error))) == str(error)
    failed = rb.ConvergenceError("no step reduces the residual", np.ones(2), (1.0, 0.5), "a better guess")
    again = pickle.loads(pickle.dumps(failed))
    assert str(again) == "no step reduces the residual; try a better guess"
    assert again.residuals == (1.0, 0.5)


@pytest.mark.parametrize("value", NOT_NUMBERS + NOT_FINITE + [0, -1.0, 0.0, -0.0, 1e-70, 1e70])
@pytest.mark.parametrize("name", ["length", "width", "thickness"])
def test_ribbon_refuses_dimensions(name, value):
    dimensions = {"length": 10.0, "width": 1.0, "thickness": 0.1, name: value}
    refuses(f"ribbon.{name}", lambda: rb.Ribbon(**dimensions))


@pytest.mark.parametrize("thickness", [1.0, 1.5, 9e-7])
def test_ribbon_refuses_thickness_out_of_proportion(thickness):
    refuses("ribbon.thickness", lambda: rb.Ribbon(10.0, 1.0, thickness))


def test_ribbon_refuses_what_is_no_material():
    refuses("ribbon.material", lambda: rb.Ribbon(10.0, 1.0, 0.1, material=1.0))


@pytest.mark.parametrize("number", [float, int, np.float32, np.int64, Fraction])
def test_ribbon_takes_any_real_number(number):
    ribbon = rb.Ribbon(number(8), number(2), number(1))
    assert (ribbon.length, ribbon.width, ribbon.thickness) == (8.0, 2.0, 1.0)
    assert type(ribbon.length) is float
    assert (ribbon.thickness_ratio, ribbon.length_ratio) == (0.5, 4.0)


def test_objects_are_immutable():
    objects = {
        "length": rb.Ribbon(10, 1, 0.1),
        "nu": rb.Isotropic(),
        "c1": rb.MooneyRivlin(1.0, 1.0),
        "terms": rb.growth.edge(0.1),
        "position": rb.Clamped(),
        "force": rb.Free(),
    }
    for name, thing in objects.items():
        with pytest.raises(AttributeError):
            setattr(thing, name, 1.0)


def test_incompressible_isotropic_stiffness():
    # The plane-stress constants of nu = 1/2 that the isotropic law's factors 1/18 come from.
    assert rb.Isotropic().stiffness == pytest.approx((4 / 3, 4 / 3, 2 / 3, 1 / 3), rel=2e-16)
    assert rb.Isotropic(Y=3.0).stiffness == pytest.approx((4.0, 4.0, 2.0, 1.0), rel=2e-16)


@pytest.mark.parametrize("nu", [-0.9, 0.0, 0.3, 0.5])
def test_materials_agree_on_youngs_modulus(nu):
    isotropic = rb.Isotropic(Y=7.0, nu=nu)
    # Y = Q33 - Q23^2/Q22 loses the digits of 1 - nu^2, at most one here.
    orthotropic = rb.Orthotropic(*isotropic.stiffness)
    assert pytest.approx(7.0, rel=3e-15) == orthotropic.Y
    assert isotropic.stiffness[3] == pytest.approx(
        (isotropic.stiffness[0] - isotropic.stiffness[2]) / 2, rel=3e-15
    )


def test_mooney_rivlin_is_incompressible():
    material = rb.MooneyRivlin(c1=0.75, c2=-0.25)
    assert material.Y == 3.0
    assert material.stiffness == rb.Isotropic(Y=3.0, nu=0.5).stiffness


@pytest.mark.parametrize("value", NOT_NUMBERS + NOT_FINITE)
def test_materials_refuse_what_is_no_number(value):
    refuses("material.Y", lambda: rb.Isotropic(Y=value))
    refuses("material.nu", lambda: rb.Isotropic(nu=value))
    refuses("material.c1", lambda: rb.MooneyRivlin(value, 1.0))
    refuses("material.c2", lambda: rb.MooneyRivlin(1.0, value))
    for name in ("Q33", "Q22", "Q23", "G"):
        constants = {"Q33": 2.0, "Q22": 2.0, "Q23": 1.0, "G": 1.0, name: value}
        refuses(f"material.{name}", lambda constants=constants: rb.Orthotropic(**constants))


@pytest.mark.parametrize(
    ("field", "make"),
    [
        ("material.Y", lambda: rb.Isotropic(Y=0.0)),
        ("material.nu", lambda: rb.Isotropic(nu=-1.0)),
        ("material.nu", lambda: rb.Isotropic(nu=0.5000001)),
        ("material.c1 + material.c2", lambda: rb.MooneyRivlin(1.0, -1.0)),
        ("material.c1 + material.c2", lambda: rb.MooneyRivlin(1e308, 1e308)),
        ("material.Q33", lambda: rb.Orthotropic(0.0, 1.0, 0.5, 1.0)),
        ("material.Q22", lambda: rb.Orthotropic(1.0, -1.0, 0.5, 1.0)),
        ("material.G", lambda: rb.Orthotropic(1.0, 1.0, 0.5, 0.0)),
        ("material.Q23", lambda: rb.Orthotropic(0.01, 0.04, 0.02, 1.0)),
        ("material.Q23", lambda: rb.Orthotropic(1.0, 4.0, 2.0, 1.0)),
        ("material.Q23", lambda: rb.Orthotropic(1.0, 4.0, -2.5, 1.0)),
    ],
)
def test_materials_refuse_what_is_not_positive_definite(field, make):
    refuses(field, make)


def rotated(quaternion, vector):
    """Turn a vector by a unit quaternion, as a rotation matrix does."""
    scalar, axis = quaternion[0], np.array(quaternion[1:])
    return vector + 2 * np.cross(axis, np.cross(axis, vector) + scalar * np.array(vector))


def test_rotation_vector_turns_by_the_right_hand():
    end = rb.Clamped(rotation=(0.0, 0.0, math.pi / 2))
    assert rotated(end.quaternion, (1.0, 0.0, 0.0)) == pytest.approx((0.0, 1.0, 0.0), abs=3e-16)


def test_twist_follows_the_rotation_about_the_fixed_axis():
    # A quarter turn about E1 sends E3 to -E2, and the quarter turn about E3 after it sends -E2 to E1.
    end = rb.Clamped(rotation=(math.pi / 2, 0.0, 0.0), twist_turns=0.25)
    assert rotated(end.quaternion, (0.0, 0.0, 1.0)) == pytest.approx((1.0, 0.0, 0.0), abs=5e-16)
    assert math.hypot(*end.quaternion) == pytest.approx(1.0, abs=3e-16)


def test_whole_turns_change_nothing():
    # One turn flips the sign of the quaternion, as does any odd number: the same orientation.
    assert rb.Clamped(twist_turns=1e15 + 1).quaternion == pytest.approx((-1.0, 0.0, 0.0, 0.0), abs=3e-16)
    assert rb.Clamped(twist_turns=-4).quaternion == (1.0, 0.0, 0.0, 0.0)


def test_no_rotation_is_the_identity():
    assert rb.Clamped().quaternion == (1.0, 0.0, 0.0, 0.0)
    assert rb.Clamped(rotation=(0, 0, 0)).quaternion == (1.0, 0.0, 0.0, 0.0)


def test_quaternion_is_normalised_within_its_tolerance():
    end = rb.Clamped(rotation=np.array([0.6, 0.0, 0.8, 0.0]) * (1 + 9e-9), position=np.array([1, 2, 3]))
    assert end.rotation == pytest.approx((0.6, 0.0, 0.8, 0.0), abs=2e-16)
    assert end.position == (1.0, 2.0, 3.0)
    refuses("clamped.rotation", lambda: rb.Clamped(rotation=(0.6, 0.0, 0.8 + 2e-8, 0.0)))


@pytest.mark.parametrize(
    "value", [(1.0, 0.0), (0.0,) * 5, (1, 1, 1, 1), (), "1000", 1.0, np.eye(4), (1.5e308,) * 3]
)
def test_clamp_refuses_what_is_no_rotation(value):
    with pytest.raises(rb.InputError, match=r"^clamped\.rotation"):
        rb.Clamped(rotation=value)


@pytest.mark.parametrize("value", [*NOT_NUMBERS, *NOT_FINITE])
def test_ends_refuse_what_is_no_number(value):
    refuses("clamped.twist_turns", lambda: rb.Clamped(twist_turns=value))
    refuses("clamped.position[1]", lambda: rb.Clamped(position=(0.0, value, 0.0)))
    refuses("free.force[2]", lambda: rb.Free(force=(0.0, 0.0, value)))
    refuses("free.moment[0]", lambda: rb.Free(moment=[value, 0.0, 0.0]))


@pytest.mark.parametrize("value", [(), (1.0,), (0.0,) * 4, "abc", 1.0, {1: 2}])
def test_ends_refuse_vectors_of_another_length(value):
    refuses("clamped.position", lambda: rb.Clamped(position=value))
    refuses("free.force", lambda: rb.Free(force=value))


LEAF = rb.Ribbon(10.0, 1.0, 0.1)


@pytest.mark.parametrize(
    ("field", "arguments"),
    [
        ("ribbon", {"ribbon": 3}),
        ("growth", {"growth": 0}),
        ("start", {"start": "clamped"}),
        ("end", {"end": LEAF}),
        ("end", {"end": rb.Closed()}),
        ("gravity", {"gravity": (0.0, 1.0)}),
        ("gravity[1]", {"gravity": (0.0, math.nan, 0.0)}),
        ("gravity[2]", {"gravity": (0.0, 0.0, 1e61)}),
        ("loads", {"loads": rb.PointLoad(1.0)}),
        ("loads[1]", {"loads": [rb.PointLoad(1.0), (0.0, 0.0, 1.0)]}),
        ("law", {"law": "Linear"}),
        ("law", {"law": None}),
        ("law", {"law": ["full"]}),
    ],
)
def test_scene_refuses_what_is_none_of_its_parts(field, arguments):
    refuses(field, lambda: rb.Scene(**{"ribbon": LEAF, "growth": rb.growth.edge(0.01), **arguments}))


def test_scene_refuses_and_warns_of_large_growth():
    rb.Scene(LEAF, rb.growth.edge(0.1))
    with pytest.warns(rb.RibbonWarning, match=r"growth\.size = 0\.11"):
        rb.Scene(LEAF, rb.growth.edge(0.11))
    with pytest.warns(rb.RibbonWarning, match=r"growth\.size = 0\.5"):
        rb.Scene(LEAF, rb.growth.edge(-0.5))
    refuses("growth.size", lambda: rb.Scene(LEAF, rb.growth.edge(0.5 + 1e-15)))
    # A gradient counts by what it makes at the faces, X1/a = +-0.05 here.
    rb.Scene(LEAF, rb.growth.chiral(2.0))
    refuses("growth.size", lambda: rb.Scene(LEAF, rb.growth.chiral(-10.1)))


def test_warning_points_at_the_caller():
    with pytest.warns(rb.RibbonWarning) as caught:
        rb.Scene(LEAF, rb.growth.edge(0.2))
    assert caught[0].filename == __file__


def test_ribbon_and_clamp_refuse_what_coordinates_cannot_resolve():
    refuses("ribbon.length", lambda: rb.Ribbon(1.1e8, 1.0, 0.1))
    for kind, end in {"clamped": rb.Clamped, "pinned": rb.Pinned, "hinged": rb.Hinged}.items():
        refuses(f"{kind}.position", lambda end=end: end(position=(0.0, -1.1e8, 0.0)))
    rb.Clamped(position=(1e8, 0.0, 0.0))


def test_scene_refuses_an_array_of_laws():
    leaf = rb.Ribbon(10.0, 1.0, 0.1)
    refuses("law", lambda: rb.Scene(leaf, rb.growth.edge(0.01), law=np.array(["full", "x"])))
