"""Functions of x: met to rounding, or refused with the place of the trouble and the points it would take."""

import math
import warnings

import numpy as np
import pytest
import ribbonrs as rb
from hypothesis import given
from hypothesis import strategies as st
from numpy.polynomial.polynomial import polyval
from profiles import EPS, X, gamma33, line, shape
from refusal import refuses
from ribbonrs.resolve import CHECKS, _checks

FUNCTIONS = {
    "constant": lambda x: np.full_like(x, 0.02),
    "exp": np.exp,
    "parabola": lambda x: 0.24 * x**2,
    "wave": lambda x: np.cos(20 * x + 1),
    "high power": lambda x: (2 * x) ** 30,
    "Runge": lambda x: 1 / (1 + 25 * x**2),
    "bump": lambda x: np.exp(-((x / 0.05) ** 2)),
    "layer": lambda x: np.tanh(15 * x),
    "aliased": lambda x: np.sin(9 * np.arcsin(2 * x)),  # zero at the nine points tried first
    "zero": np.zeros_like,
    "integers": lambda x: np.ones(x.shape, dtype=int),
}


@pytest.mark.parametrize("name", FUNCTIONS)
def test_functions_are_met_to_rounding(name):
    exact = FUNCTIONS[name](X)
    assert gamma33(gamma33=FUNCTIONS[name]) == pytest.approx(exact, abs=1e-14 * np.max(np.abs(exact)))


def test_fast_functions_are_met_to_the_rounding_of_x():
    # |f'| = 150: a last digit of x is worth 75 of f; twice that is allowed on the check points.
    assert gamma33(gamma33=lambda x: np.sin(150 * x)) == pytest.approx(np.sin(150 * X), abs=2 * 75 * EPS)


@given(st.lists(st.floats(-1.0, 1.0), min_size=1, max_size=9))
def test_polynomials_become_short_series(c):
    kept = shape(gamma33=lambda x: polyval(x, c) + 0.0 * x)
    assert len(kept.coefficients) == 1
    assert len(kept.coefficients[0]) <= len(c)


def test_symmetric_functions_stay_symmetric():
    (even,), (odd,) = (
        shape(gamma33=f).coefficients for f in (lambda x: np.cos(9 * x), lambda x: np.sin(9 * x))
    )
    assert not any(even[1::2])
    assert not any(odd[::2])


def test_functions_with_jumps_and_kinks_at_breaks():
    def f(x):
        return np.where(x < 0.1, np.exp(x), np.abs(x - 0.3))

    assert gamma33(gamma33=f, breaks=[0.1, 0.3]) == pytest.approx(f(X), abs=1e-14)
    assert gamma33(0.1, gamma33=f, breaks=[0.1, 0.3]) == pytest.approx(0.2, rel=1e-14)
    assert len(shape(gamma33=f, breaks=[0.1, 0.3]).coefficients[2]) == 2


def test_a_function_cannot_change_where_it_is_called():
    def f(x):
        x += 1.0
        return x

    assert gamma33(gamma33=f) == pytest.approx(X + 1.0, abs=1e-14)


def test_no_warning_of_a_function_gets_out():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert gamma33(0.0, gamma33=lambda x: np.where(x == 0, 1.0, np.sin(x) / x)) == pytest.approx(
            1.0, abs=1e-14
        )


def test_functions_return_numbers_that_are_not_masked():
    masked = np.ma.masked_greater
    refuses("growth.profile.d33", lambda: rb.growth.Profile(d33=lambda x: masked(x, 0.1)))
    assert gamma33(gamma33=lambda x: masked(x, 0.6)) == pytest.approx(X, abs=1e-16)


def test_what_a_function_raises_is_kept():
    def f(x):
        raise KeyError("no such leaf\nat all")

    with pytest.raises(rb.InputError) as caught:
        rb.growth.Profile(d33=f)
    assert isinstance(caught.value.__cause__, KeyError)
    assert "not one that raises KeyError: " in str(caught.value)
    refuses("growth.profile.d33", lambda: rb.growth.Profile(d33=f))
    refuses("growth.profile.d33", lambda: rb.growth.Profile(d33=math.sin))
    refuses("growth.profile.d33", lambda: rb.growth.Profile(d33=lambda: 1.0))


@pytest.mark.parametrize(
    "function",
    [
        lambda x: 0.02,
        lambda x: np.array(0.02),
        lambda x: x[:-1],
        lambda x: x[None, :],
        lambda x: x + 0j,
        lambda x: x > 0,
        lambda x: x.astype(object),
        lambda x: x.astype(str),
        lambda x: x.astype(np.float32),
        lambda x: [x, [1.0]],
        lambda x: None,
        lambda x: 1e61 + x,
        dict,
    ],
)
def test_functions_return_real_arrays(function):
    for breaks in ([], [0.0]):
        refuses("growth.profile.gamma33", lambda b=breaks: rb.growth.Profile(gamma33=function, breaks=b))


def test_a_value_that_is_not_finite_is_told_with_its_place():
    told = line(gamma33=lambda x: np.where(np.abs(x - 0.25) < 1e-3, np.nan, x))
    assert told.startswith("growth.profile.gamma33 = nan: expected finite values, unlike at x = 0.2")
    told = line(gamma33=lambda x: 1 / x)
    assert told == "growth.profile.gamma33 = inf: expected finite values, unlike at x = 0"


def place(told):
    """The x that a refusal names."""
    return float(told.split("near x = ")[1].split(",")[0].split(":")[0])


@pytest.mark.parametrize("at", [-0.4999, -0.3, 0.0, 0.123456789, 0.49])
def test_kinks_are_found(at):
    told = line(gamma33=lambda x: np.abs(x - at))
    assert place(told) == pytest.approx(at, abs=1e-6)
    assert "breaks=" in told


@pytest.mark.parametrize("at", [-0.3, 0.0, 0.2])
def test_kinks_are_told_the_number_of_points(at):
    told = line(gamma33=lambda x: np.abs(x - at) / 2)
    # The Legendre coefficients of |xi - t| fall as (8/pi)^(1/2) (1 - t^2)^(3/4) k^(-3/2), here over 4, to
    # 2e-16 of the largest value. Extrapolated over eight decades: an exponent wrong by 0.05 is a factor of 2.
    size = (0.5 + abs(at)) / 2
    exact = (0.25 * np.sqrt(8 / np.pi) * (1 - 4 * at**2) ** 0.75 / (EPS * size)) ** (2 / 3)
    points = float(told.split("not about ")[1].split(" ")[0])
    assert exact / 3 < points < exact * 3


@pytest.mark.parametrize("at", [-0.45, 0.0, 0.2, 1 / 3])
@pytest.mark.parametrize("height", [1.0, 1e-3])
def test_jumps_are_found_and_no_number_of_points_is_enough(at, height):
    told = line(gamma33=lambda x: 1.0 + height * np.sign(x - at))
    assert place(told) == pytest.approx(at, abs=1e-6)
    assert "no number of points" in told
    assert "breaks=" in told


def test_of_several_pieces_the_bad_one_is_told():
    told = line(gamma33=lambda x: np.where(x < 0, np.abs(x + 0.2), np.exp(x)), breaks=[0.0])
    assert place(told) == pytest.approx(-0.2, abs=1e-6)


@pytest.mark.parametrize(
    ("function", "least", "most"),
    [
        # Bernstein ellipse through i/20 of a half-width 1/2: a digit for every 23 coefficients, 16 digits.
        (lambda x: 1 / (1 + 400 * x**2), 300, 400),
        # 500 half-waves to resolve, and a few more.
        (lambda x: np.sin(1000 * x), 500, 700),
    ],
)
def test_slow_functions_are_told_the_number_of_points(function, least, most):
    told = line(gamma33=function)
    assert least < float(told.split("not about ")[1].split(":")[0]) < most


@pytest.mark.parametrize("at", [-0.31, 0.2])
def test_details_too_fine_are_found(at):
    told = line(gamma33=lambda x: np.exp(-(((x - at) / 2e-4) ** 2)))
    assert "not more than 1025" in told
    assert place(told) == pytest.approx(at, abs=1e-3)


def test_a_spike_between_the_points_is_found():
    # At one of the points where the series is checked, and nowhere else that it is called.
    spike = 0.5 * _checks(CHECKS)[100]
    told = line(gamma33=lambda x: np.where(np.abs(x - spike) < 1e-9, 1.0, 0.0))
    assert place(told) == pytest.approx(spike, abs=1e-6)


def test_a_pole_is_found():
    assert place(line(gamma33=lambda x: 1 / (x - 0.1 + 1e-18))) == pytest.approx(0.1, abs=1e-6)
