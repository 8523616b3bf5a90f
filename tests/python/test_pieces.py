"""Functions in pieces against numpy and scipy."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.polynomial.legendre import legval
from numpy.polynomial.polynomial import polyval
from ribbonrs.pieces import Pieces, grid, joined, linear, series
from scipy.interpolate import CubicSpline

EPS = np.finfo(float).eps
STEP = Pieces((-0.5, 0.1, 0.5), ((1.0, 2.0, 0.5), (-1.0,)))

values = st.floats(-1.0, 1.0)


def ascending(least, most):
    """Points in [-1/2, 1/2] that are not too close."""
    steps = st.lists(st.floats(0.05, 1.0), min_size=least - 1, max_size=most - 1)
    return steps.map(lambda h: np.cumsum([0.0, *h]) / sum(h) - 0.5)


def test_values_are_those_of_legendre_series():
    x = np.linspace(-0.5, 0.0999, 13)
    assert STEP.evaluate(x) == pytest.approx(legval((2 * x + 0.4) / 0.6, [1.0, 2.0, 0.5]), abs=4 * EPS)
    assert STEP.evaluate([0.2, 0.5]).tolist() == [-1.0, -1.0]


def test_a_break_belongs_to_the_right_unless_the_left_is_asked_for():
    assert STEP.evaluate(0.1) == -1.0
    assert STEP.evaluate(0.1, left=True) == 3.5
    assert (
        STEP.evaluate([-0.5, 0.5], left=True).tolist() == STEP.evaluate([-0.5, 0.5]).tolist() == [-0.5, -1.0]
    )


def test_beyond_an_end_the_end_goes_on():
    assert STEP.evaluate([-0.6, 0.6]).tolist() == [-0.5, -1.0]


@pytest.mark.parametrize("shape", [(), (0,), (3,), (2, 3)])
def test_values_have_the_shape_of_the_points(shape):
    for pieces in (STEP, Pieces((0.0, 1.0), ((1.0, 2.0),))):
        assert pieces.evaluate(np.full(shape, 0.25)).shape == shape


def test_scaling_and_size():
    assert STEP.scaled(2.0).evaluate([0.0, 0.3]).tolist() == (2.0 * STEP.evaluate([0.0, 0.3])).tolist()
    assert (STEP.degree, STEP.domain) == (2, (-0.5, 0.5))


@given(st.lists(values, min_size=1, max_size=33), st.floats(-0.5, 0.4), st.floats(0.01, 1.0))
def test_series_is_the_polynomial(coefficients, start, width):
    end = min(0.5, start + width)
    t = np.linspace(start, end, 41)
    found = Pieces((start, end), (series(coefficients, start, end),)).evaluate(t)
    # Horner's scheme in both, on |t| <= 1/2; the sum of the terms is below twice the largest coefficient.
    assert found == pytest.approx(polyval(t, coefficients), abs=8 * EPS * max(map(abs, coefficients)))


def test_short_series_are_exact():
    assert series([0.02], 0.1, 0.5) == (0.02,)
    assert series([0.0, 0.0], -0.5, 0.5) == (0.0,)
    assert series([0.0, 0.0, 3.0], -0.5, 0.5) == (0.25, 0.0, 0.5)


@given(ascending(2, 12), st.data())
def test_lines_are_those_of_numpy(points, data):
    v = np.array(data.draw(st.lists(values, min_size=points.size, max_size=points.size)))
    t = np.linspace(-0.5, 0.5, 301)
    # One rounding of a sum in [-2, 2] more than np.interp.
    assert linear(points, v).evaluate(t) == pytest.approx(np.interp(t, points, v), abs=1e-15)


def test_the_same_point_twice_is_a_jump():
    pieces = linear(np.array([0.0, 1.0, 1.0, 3.0]), np.array([0.0, 1.0, 5.0, 6.0]))
    assert pieces.breaks == (0.0, 1.0, 3.0)
    assert pieces.evaluate([0.5, 1.0, 2.0]).tolist() == [0.5, 5.0, 5.5]
    assert pieces.evaluate(1.0, left=True) == 1.0


@given(ascending(4, 12), st.data())
def test_splines_are_those_of_scipy(points, data):
    v = np.array(data.draw(st.lists(values, min_size=points.size, max_size=points.size)))
    t = np.linspace(-0.5, 0.5, 301)
    expected = CubicSpline(points, v)(t)
    found = joined(points, v, True, -0.5, 0.5).evaluate(t)
    # The powers of scipy's pieces, rounded, are summed in another order.
    terms = np.max(
        np.sum(np.abs(CubicSpline(points, v).c) * np.diff(points) ** np.arange(3, -1, -1)[:, None], 0)
    )
    assert found == pytest.approx(expected, abs=16 * EPS * terms + 1e-300)


@pytest.mark.parametrize("spline", [False, True])
def test_the_first_and_last_piece_are_extended(spline):
    points, v = np.linspace(-0.4, 0.4, 5), np.array([1.0, 0.0, 2.0, 1.0, 3.0])
    pieces = joined(points, v, spline, -0.5, 0.5)
    assert pieces.breaks == (-0.5, *points[1:-1], 0.5)
    expected = CubicSpline(points, v)([-0.5, 0.5]) if spline else [1.5, 4.0]
    assert pieces.evaluate([-0.5, 0.5]) == pytest.approx(expected, rel=16 * EPS)


def test_the_grid_has_both_ends_of_every_piece_and_resolves_polynomials():
    points, breaks = grid([STEP, Pieces((-1.0, 0.3, 1.0), ((0.0,), (1.0,)))], (-0.5, 0.5), 2, density=32)
    assert breaks.tolist() == [-0.5, 0.1, 0.3, 0.5]
    assert set(breaks[:-1]) <= set(points)
    assert points.size == 3 * 65
    lines = grid([STEP], (-0.5, 0.5), 1, density=32)[0]
    assert lines == pytest.approx([-0.5, 0.1, 0.1, 0.5], abs=EPS)
