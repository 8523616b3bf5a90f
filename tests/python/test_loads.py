"""Loads between the ends, weight, and the linear law: what they accept and refuse."""

import math
import pickle

import numpy as np
import pytest
import ribbonrs as rb
from refusal import NOT_FINITE, NOT_NUMBERS, refuses
from ribbonrs.pieces import Pieces, added

LEAF = rb.Ribbon(10.0, 1.0, 0.1)


@pytest.mark.parametrize("value", [*NOT_NUMBERS, *NOT_FINITE])
def test_what_is_no_number_is_refused(value):
    refuses("point_load.S", lambda: rb.PointLoad(value))
    refuses("point_load.force[0]", lambda: rb.PointLoad(1.0, force=(value, 0.0, 0.0)))
    refuses("point_load.moment[2]", lambda: rb.PointLoad(1.0, moment=(0.0, 0.0, value)))
    refuses("weight.density", lambda: rb.weight(LEAF, value, (0.0, 0.0, 1.0)))
    refuses("weight.g[1]", lambda: rb.weight(LEAF, 1.0, (0.0, value, 0.0)))
    refuses("law.intrinsic[3]", lambda: rod(intrinsic=(0.0, 0.0, 0.0, value)))


@pytest.mark.parametrize("value", [True, "1", 1j, math.nan, 2e60])
def test_line_loads_are_numbers(value):
    refuses("line_load.force[1]", lambda: rb.LineLoad(force=[0.0, value, 0.0]))


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("line_load.force", (0.0, 1.0)),
        ("line_load.force", 1.0),
        ("line_load.force", ([0.0, 10.0], [0.0, 0.0, 1.0], 3)),
        ("line_load.force.values.shape", ([0.0, 10.0], [0.0, 1.0])),
        ("line_load.force.values.shape", ([0.0, 10.0], np.zeros((2, 2)))),
        ("line_load.force.values[1, 2]", ([0.0, 10.0], [[0, 0, 0], [0, 0, math.inf]])),
        ("line_load.force", ([0.0, 5.0, 10.0], np.zeros((2, 3)))),
        ("line_load.force.S[1]", ([5.0, 0.0], np.zeros((2, 3)))),
        ("line_load.force.S[0]", ([-1.0, 10.0], np.zeros((2, 3)))),
        ("line_load.force.S", ([0.0], np.zeros((1, 3)))),
    ],
)
def test_samples_are_three_columns(field, value):
    refuses(field, lambda: rb.LineLoad(force=value))


@pytest.mark.parametrize("follower", [True, 1, None, "no"])
def test_followers_are_refused(follower):
    refuses("point_load.follower", lambda: rb.PointLoad(1.0, follower=follower))
    refuses("line_load.follower", lambda: rb.LineLoad(follower=follower))
    with pytest.raises(rb.InputError, match="follower loads have no potential and are not solved"):
        rb.PointLoad(1.0, follower=True)


@pytest.mark.parametrize(
    ("field", "function", "told"),
    [
        ("loads[0].force", lambda S: S, r"returns one \(m, 3\), not \(33,\)"),
        ("loads[0].force", lambda S: np.zeros((3, S.size)), r"not \(3, 33\)"),
        ("loads[0].force[0]", lambda S: 1 / 0, "ZeroDivisionError"),
        ("loads[0].force[1]", lambda S: np.outer(S, [0.0, math.nan, 0.0]), "finite values"),
        ("loads[0].force[2]", lambda S: np.outer(S, [0.0, 0.0, 1e60]), "at most 1e"),
        ("loads[0].force[0]", lambda S: [["a"] * 3] * S.size, "real numbers"),
    ],
)
def test_functions_are_checked_by_the_scene(field, function, told):
    make = lambda: rb.Scene(LEAF, loads=[rb.LineLoad(force=function)])  # noqa: E731
    refuses(field, make)
    with pytest.raises(rb.InputError, match=told):
        make()


def test_a_line_load_is_three_components():
    S = np.linspace(0.0, 10.0, 41)
    wave = rb.LineLoad(lambda S: np.stack([np.sin(S), 0.0 * S, 1.0 + S], axis=1)).along(10.0)
    assert wave["force"][0].evaluate(S) == pytest.approx(np.sin(S), abs=1e-14)
    assert wave["force"][2].evaluate(S) == pytest.approx(1.0 + S, rel=1e-14)
    assert wave["moment"] == [0.0, 0.0, 0.0]
    ramp = rb.LineLoad(moment=([0, 5, 5, 12], [[0, 0, 1], [1, 0, 1], [0, 0, 1], [0, 7, 1]])).along(10.0)
    columns = np.stack([m.evaluate([2.5, 4.999, 5.0, 8.0]) for m in ramp["moment"]], axis=1)
    assert columns == pytest.approx(np.array([[0.5, 0, 1], [0.9998, 0, 1], [0, 0, 1], [0, 3, 1]]), abs=1e-14)


def test_loads_act_unless_zero():
    assert not rb.PointLoad(1.0).acts
    assert rb.PointLoad(1.0, moment=(0, 0, 1)).acts
    assert not rb.LineLoad().acts
    assert rb.LineLoad(force=lambda S: np.zeros((S.size, 3))).acts
    assert not rb.Scene(LEAF, loads=[rb.PointLoad(1.0), rb.LineLoad()]).loaded
    assert rb.Scene(LEAF, loads=[rb.PointLoad(1.0, (0, 0, 1))]).loaded


def test_loads_are_values():
    loads = (rb.PointLoad(1.0, (1, 2, 3)), rb.LineLoad((1, 2, 3)), rb.LineLoad(([0, 1], [[0] * 3] * 2)))
    for load in loads:
        assert pickle.loads(pickle.dumps(load)) == load


# --- functions in pieces, added

STEP = Pieces((0.0, 4.0, 12.0), ((1.0,), (2.0, 1.0)))
CURVE = Pieces((0.0, 10.0), ((0.5, 0.0, 1.0),))


def test_sums_of_numbers_stay_numbers():
    assert added([1.0, 2.0, 0.5], (0.0, 10.0)) == 3.5


def test_sums_of_pieces_cover_the_domain():
    total = added([1.0, STEP, CURVE], (0.0, 10.0))
    assert total.breaks == (0.0, 4.0, 10.0)
    S = np.linspace(0.0, 10.0, 101)
    assert total.evaluate(S) == pytest.approx(1.0 + STEP.evaluate(S) + CURVE.evaluate(S), abs=1e-14)


def test_breaks_at_the_ends_but_for_rounding_are_the_ends():
    samples = Pieces((1e-14, 5.0, 5.0 + 1e-13, 10.0 - 1e-13), ((1.0,), (2.0,), (3.0,)))
    assert added([samples], (0.0, 10.0)).breaks == (0.0, 5.0, 10.0)


# --- weight


def test_weight_in_units_of_the_stiffness():
    strip = rb.Ribbon(0.2, 0.01, 0.001, material=rb.Isotropic(Y=1e6))
    # mass per length 1000 * 0.01 * 0.001 kg/m, times g and a, over Y h a
    exact = 1000.0 * 0.01 * 0.001 * 9.81 * 0.01 / (1e6 * 0.001 * 0.01)
    assert rb.weight(strip, 1000.0, (0.0, -9.81, 0.0)) == pytest.approx((0.0, -exact, 0.0), rel=1e-15)


@pytest.mark.parametrize("density", [0.0, -1.0])
def test_density_is_positive(density):
    refuses("weight.density", lambda: rb.weight(LEAF, density, (0.0, 0.0, 1.0)))


def test_weight_of_what_varies_or_is_no_ribbon_is_refused():
    taper = rb.Ribbon(10.0, 1.0, 0.1, width_profile=([0, 10], [1, 0.5]))
    with pytest.raises(rb.InputError, match=r"^weight\.ribbon = Ribbon.*LineLoad"):
        rb.weight(taper, 1.0, (0.0, 0.0, 1.0))
    refuses("weight.ribbon", lambda: rb.weight(None, 1.0, (0.0, 0.0, 1.0)))
    refuses("weight.g", lambda: rb.weight(LEAF, 1.0, (0.0, 1.0)))
    refuses("weight[2]", lambda: rb.weight(LEAF, 1e60, (0.0, 0.0, 10.0)))


# --- the linear law


def rod(**arguments):
    return rb.LinearLaw(**{"EA": 1.0, "EI1": 1.0, "EI2": 2.0, "GJ": 4.0} | arguments)


def test_compliances():
    assert rod().compliance == (1.0, 1.0, 0.5, 0.25)
    assert rod(EA=None, inextensible=True) == rod(EA=math.inf) == rod(EA=math.inf, inextensible=True)
    stiff = rod(EA=math.inf, EI1=math.inf, GJ=math.inf)
    assert stiff.compliance == (0.0, 0.0, 0.5, 0.0)
    assert stiff.inextensible
    assert not rod().inextensible


@pytest.mark.parametrize("value", [*NOT_NUMBERS, math.nan, -math.inf, 0.0, -1.0, 1e-70, 10**400])
@pytest.mark.parametrize("name", ["EA", "EI1", "EI2", "GJ"])
def test_stiffnesses_are_positive(name, value):
    if name == "EA" and value is None:
        with pytest.raises(rb.InputError, match=r"^law\.EA is missing: expected the stiffness in extension"):
            rod(EA=None)
        return
    refuses(f"law.{name}", lambda: rod(**{name: value}))


@pytest.mark.parametrize(
    ("field", "arguments"),
    [
        ("law.EA", {"inextensible": True}),
        ("law.inextensible", {"inextensible": 1}),
        ("law.GJ", {"EI1": math.inf, "EI2": math.inf, "GJ": math.inf}),
        ("law.intrinsic", {"intrinsic": (0.0, 0.0, 1.0)}),
        ("law.intrinsic", {"intrinsic": 0.0}),
        ("law.intrinsic[0]", {"intrinsic": (-1.0, 0.0, 0.0, 0.0)}),
        ("law.intrinsic[1]", {"intrinsic": (0.0, 1e61, 0.0, 0.0)}),
    ],
)
def test_contradictory_laws_are_refused(field, arguments):
    refuses(field, lambda: rod(**arguments))


def test_the_linear_law_knows_neither_growth_nor_taper():
    refuses("growth", lambda: rb.Scene(LEAF, rb.growth.edge(0.01), law=rod()))
    with pytest.raises(rb.InputError, match="intrinsic="):
        rb.Scene(LEAF, rb.growth.edge(0.01), law=rod())
    rb.Scene(LEAF, rb.growth.edge(0.0), law=rod())
    taper = rb.Ribbon(10.0, 1.0, 0.1, thickness_profile=([0, 10], [1, 0.5]))
    refuses("ribbon.thickness_profile", lambda: rb.Scene(taper, law=rod()))


def test_plane_sections():
    law = rod(intrinsic=(0.0, 0.0, 0.5, 0.0))
    assert law.deflection([0.0] * 4, np.zeros((2, 3))).tolist() == np.zeros((2, 3)).tolist()
    assert law.displacements([0.0] * 4, 0.5).tolist() == [0.0, 0.0, 0.0]
    refuses("x", lambda: law.deflection([0.0] * 4, 0.6))
    refuses("derivative", lambda: law.deflection([0.0] * 4, 0.5, derivative=3))
    assert law.gradient([[1.0, 1.0, 1.0, 1.0]]).tolist() == [[1.0, 1.0, 1.0, 4.0]]
    assert rod(EA=math.inf).gradient([1.0] * 4).tolist() == [0.0, 1.0, 2.0, 4.0]
