"""Tolerances, error estimates, degrees of the method, and how it fails."""

import math
import warnings
from functools import cache

import numpy as np
import pytest
import ribbonrs as rb
from held import largest, rod, strip
from scipy.integrate import solve_ivp

TOLERANCES = [10.0**-k for k in range(3, 13)]
ETA2 = 0.1**2
UNIT = ETA2 / 12 / 10.0**2
PLANAR = rod(end=rb.Free(force=(20.0, 0.0, 0.0)))
STRIP = rb.LinearLaw(EA=1.0, EI1=1 / 12, EI2=ETA2 / 12, GJ=ETA2 / 9, intrinsic=(0.0, 0.01, 0.1, 0.2))
END = rb.Clamped((0.5, 0.3, 9.0), (0.2, 0.5, 0.3))
GROWN = rb.growth.edge(2.0 * ETA2) + rb.growth.chiral(0.03)
SCENES = {
    "planar": PLANAR,
    "spatial rod": rod(10.0, STRIP, end=END, gravity=(2.0 * UNIT, UNIT, 0.0)),
    "cantilever": rb.Scene(
        strip(10.0), GROWN, end=rb.Free((5.0 * UNIT, 2.0 * UNIT, 0.0)), gravity=(0.0, UNIT, 0.0)
    ),
    "clamped": rb.Scene(strip(10.0), GROWN, end=END, loads=[rb.PointLoad(4.0, (3.0 * UNIT, UNIT, 0.0))]),
}


@cache
def reference(name):
    """The solution to rounding, by the highest degree."""
    return rb.solve(SCENES[name], tol=1e-13, degree=8)


def error(state, true, places):
    """The largest error: of positions over the length, angles, eps and curvatures times the length."""
    length = state.S[-1]
    one, other = state.at(places), true.at(places)
    # small angles; the distance of matrices is 2^(1/2) times theirs
    angle = np.linalg.norm(one.directors - other.directors, axis=(1, 2)) / math.sqrt(2.0)
    place = np.linalg.norm(one.position - other.position, axis=1) / length
    strain = (one.strains - other.strains) * [1.0, length, length, length]
    return max(largest(place), largest(angle), largest(strain))


def test_the_reference_itself():
    # EI theta'' = -P cos(theta), from the base to the tip
    state = reference("planar")
    K = state.strains[0, 2]
    found = solve_ivp(
        lambda s, y: [y[1], -20.0 * math.cos(y[0]), math.sin(y[0]), math.cos(y[0])],
        (0.0, 1.0),
        [0.0, K, 0.0, 0.0],
        "DOP853",
        rtol=1e-13,
        atol=1e-14,
    )
    theta, curvature, x, z = found.y[:, -1]
    # what is missed at the base grows by cosh(20^(1/2)) on the way
    assert abs(curvature) < 1e-10
    assert state.position[-1] == pytest.approx((x, 0.0, z), abs=1e-11)
    assert math.atan2(*state.directors[-1, 2, [0, 2]]) == pytest.approx(theta, abs=1e-11)


@pytest.mark.parametrize("name", SCENES)
@pytest.mark.parametrize("degree", [2, 3, 5, 8])
def test_errors_are_below_the_tolerance_and_told(name, degree):
    true = reference(name)
    for tol in TOLERANCES[:: 1 if degree == 5 else 3]:
        state = rb.solve(SCENES[name], tol=tol, degree=degree)
        found, told = error(state, true, state.course.breaks), state.report.error
        assert told <= tol
        assert found <= tol
        assert error(state, true, np.linspace(0.0, true.S[-1], 50)) <= 3.0 * tol  # between the nodes
        if found > 1e-11:  # else rounding and the reference's own error
            assert 1 / 3 < told / found < 10.0


@pytest.mark.parametrize("name", SCENES)
def test_all_degrees_agree(name):
    # degree 1 takes thousands of elements: not for the most curved
    for degree in range(2 if name == "spatial rod" else 1, 9):
        state = rb.solve(SCENES[name], tol=1e-8, degree=degree)
        assert state.report.degree == degree
        assert error(state, reference(name), np.linspace(0.0, state.S[-1], 20)) < 1e-8


def test_higher_degrees_need_fewer_elements():
    elements = [
        rb.solve(SCENES["spatial rod"], tol=1e-6, degree=degree).report.elements for degree in range(1, 9)
    ]
    assert elements == sorted(elements, reverse=True)
    # of order 2 and 16
    assert elements[0] > 30 * elements[-1]


def test_reports_count_the_work():
    report = rb.solve(SCENES["clamped"]).report
    assert report.method == "Gauss collocation"
    assert report.status == "converged"
    assert report.error <= report.tolerance == 1e-10
    assert report.residual <= 1e-10
    assert report.iterations >= report.factorisations >= report.meshes >= 1
    assert report.load_steps >= 1
    assert report.condition > 1.0
    assert report.residuals[-1] < 1e-10


# --- failures


@pytest.mark.parametrize("tol", [9e-15, 0.0, -1e-10, 1.0, math.nan, math.inf, "1e-10", None])
def test_tolerances_out_of_range_are_refused(tol):
    with pytest.raises(rb.InputError) as caught:
        rb.solve(PLANAR, tol=tol)
    assert caught.value.field == "tol"


@pytest.mark.parametrize("degree", [0, 9, -1, 2.5, "5", True])
def test_degrees_out_of_range_are_refused(degree):
    with pytest.raises(rb.InputError) as caught:
        rb.solve(PLANAR, degree=degree)
    assert caught.value.field == "degree"


def test_the_least_tolerance_is_met_or_said_not_to_be():
    # at the least tolerance it is rounding that decides whether the estimate is below it
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        state = rb.solve(SCENES["spatial rod"], tol=1e-14)
    limited = state.report.status == "rounding_limited"
    assert ["below rounding" in str(warning.message) for warning in caught] == [True] * limited
    assert limited == (state.report.error > 1e-14)
    assert error(state, reference("spatial rod"), state.S) < 1e-11


def test_pulling_an_inextensible_rod_taut_fails_on_the_way():
    # at its full length, turned ends leave no equilibrium
    scene = rod(end=rb.Clamped((0.0, 0.0, 1.0), (0.0, 1.0, 0.0)))
    with pytest.raises(rb.ConvergenceError) as caught:
        rb.solve(scene)
    failure = caught.value
    assert len(str(failure).splitlines()) == 1
    assert "; try " in str(failure)
    assert 0.0 <= failure.fraction < 1.0
    assert failure.iterate.shape == (101, 4)
    assert len(failure.residuals) > 0
    assert (failure.state is None) == (failure.fraction == 0.0)


def test_what_a_huge_force_reaches_is_a_state():
    scene = rod(end=rb.Free(force=(1e40, 0.0, 0.0)))
    with pytest.raises(rb.ConvergenceError) as caught:
        rb.solve(scene)
    failure = caught.value
    assert 0.0 <= failure.fraction <= 1.0
    if failure.state is not None:
        assert np.all(np.isfinite(failure.state.position))
        assert failure.state.scene == scene


@pytest.mark.parametrize("force", [1e-12, 1e-6, 1e3, 2e3, 5e3, 1e4, 2e4])
@pytest.mark.parametrize("tol", [1e-6, 1e-10])
def test_forces_of_any_size(force, tol):
    # across the rod: F L^3/3 EI at the tip if it is small, (2 EI F)^(1/2) at the base if it is large
    state = rb.solve(rod(end=rb.Free(force=(force, 0.0, 0.0))), tol=tol)
    assert state.report.meshes < 10
    moment = -state.reactions.start.moment[1]
    assert moment == pytest.approx(force * state.position[-1, 2], rel=1e-12, abs=1e-18)
    if force >= 1e3:
        assert moment == pytest.approx(math.sqrt(2.0 * force), rel=10.0 * tol)
    if force <= 1e-6:
        assert state.position[-1, 0] == pytest.approx(force / 3.0, rel=10.0 * tol, abs=1e-18)
