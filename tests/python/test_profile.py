"""Profiles across the width: polynomials in pieces, samples, functions, and what of them is refused."""

import contextlib
import math
import warnings

import numpy as np
import pytest
import ribbonrs as rb
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.polynomial.polynomial import polyval
from refusal import refuses
from ribbonrs.growth import FIELDS
from ribbonrs.pieces import Pieces
from ribbonrs.resolve import CHECKS, _checks
from scipy.interpolate import CubicSpline

EPS = np.finfo(float).eps
X = np.random.default_rng(7).uniform(-0.5, 0.5, 4000)


def gamma33(x=X, **given):
    """The axial growth of a profile at x."""
    return rb.growth.Profile(**given).values(x)["gamma33"]


def shape(**given):
    """The one field of a profile as it is kept."""
    return rb.growth.Profile(**given).terms[0].shape[0][1]


def line(**given):
    """The one line in which a profile is refused."""
    with pytest.raises(rb.InputError) as caught:
        rb.growth.Profile(**given)
    assert len(str(caught.value).splitlines()) == 1
    assert len(str(caught.value)) < 400
    return str(caught.value)


# polynomials


def test_one_polynomial_for_each_piece():
    polynomials = [[0.1, -0.3], [0.02], [0.0, 0.0, 0.0, 1.0]]
    expected = np.select(
        [X < -0.2, X < 0.3], [polyval(X, p) for p in polynomials[:2]], polyval(X, polynomials[2])
    )
    # Values of at most 0.3, each rounded a few times.
    assert gamma33(gamma33=polynomials, breaks=[-0.2, 0.3]) == pytest.approx(expected, abs=4 * EPS)
    rows = np.array([[0.1, -0.3], [0.02, 0.0]])
    assert shape(gamma33=rows, breaks=[0.0]) == shape(gamma33=[[0.1, -0.3], [0.02]], breaks=(0.0,))


def test_constant_pieces_are_exact():
    assert shape(gamma33=[[0.0], [0.02]], breaks=[0.1]) == Pieces((-0.5, 0.1, 0.5), ((0.0,), (0.02,)))


def test_a_polynomial_beside_breaks_is_of_the_whole_width():
    growth = rb.growth.Profile(gamma33=[[0.0], [0.02]], d33=[0.1, 0.2], breaks=[0.1])
    assert dict(growth.terms[0].shape)["d33"] == (0.1, 0.2)


@pytest.mark.parametrize(
    ("field", "given"),
    [
        ("growth.profile.gamma33", {"gamma33": [[0.1], [0.2]]}),
        ("growth.profile.gamma33", {"gamma33": np.eye(2)}),
        ("growth.profile.gamma33", {"gamma33": [[0.1], [0.2]], "breaks": [0.0, 0.1]}),
        ("growth.profile.gamma33[1]", {"gamma33": [[0.1], []], "breaks": [0.0]}),
        ("growth.profile.gamma33[1]", {"gamma33": [[0.1], 0.2], "breaks": [0.0]}),
        ("growth.profile.gamma33[0][1]", {"gamma33": [[0.1, math.nan], [0.2]], "breaks": [0.0]}),
        ("growth.profile.gamma33[0][0]", {"gamma33": [[[0.1]], [0.2]], "breaks": [0.0]}),
        ("growth.profile.gamma33[1]", {"gamma33": [[0.1], [0.1] * 34], "breaks": [0.0]}),
        ("growth.profile.breaks", {"gamma33": [0.1], "breaks": 0.1}),
        ("growth.profile.breaks", {"gamma33": [0.1], "breaks": None}),
        ("growth.profile.breaks", {"gamma33": [0.1], "breaks": np.linspace(-0.4, 0.4, 1000)}),
        ("growth.profile.breaks[0]", {"gamma33": [0.1], "breaks": ["a"]}),
        ("growth.profile.breaks[1]", {"gamma33": [0.1], "breaks": [0.1, math.inf]}),
        ("growth.profile.breaks[0]", {"gamma33": [0.1], "breaks": [0.5]}),
        ("growth.profile.breaks[0]", {"gamma33": [0.1], "breaks": [-0.6]}),
        ("growth.profile.breaks[0]", {"gamma33": [0.1], "breaks": [-0.5 + 1e-10]}),
        ("growth.profile.breaks[1]", {"gamma33": [0.1], "breaks": [0.1, 0.1]}),
        ("growth.profile.breaks[1]", {"gamma33": [0.1], "breaks": [0.1, 0.0]}),
        ("growth.profile.spline", {"gamma33": [0.1], "spline": 1}),
    ],
)
def test_pieces_are_refused(field, given):
    refuses(field, lambda: rb.growth.Profile(**given))


@pytest.mark.parametrize("field", ["g21", "g31"])
def test_transverse_shear_does_not_jump(field):
    refuses(f"growth.profile.{field}", lambda: rb.growth.Profile(**{field: [[0.0], [0.02]]}, breaks=[0.1]))
    kink = rb.growth.Profile(**{field: [[0.01], [0.0, 0.1]]}, breaks=[0.1])
    assert kink.values(0.2)[field] == pytest.approx(0.02, rel=4 * EPS)


# samples


def test_samples_are_joined_by_lines():
    x = np.linspace(-0.5, 0.5, 11)
    v = np.cos(7 * x)
    for samples in ((x, v), (x.tolist(), tuple(v)), (tuple(x), v)):
        assert gamma33(gamma33=samples) == pytest.approx(np.interp(X, x, v), abs=1e-15)


def test_samples_are_joined_by_a_spline():
    x = np.array([-0.5, -0.3, -0.25, 0.0, 0.2, 0.5])
    v = np.array([0.0, 0.3, -0.1, 0.2, 0.5, 0.4])
    # The spline reaches 1; its powers are rounded in another order than scipy's.
    assert gamma33(gamma33=(x, v), spline=True) == pytest.approx(CubicSpline(x, v)(X), abs=16 * EPS)


@pytest.mark.parametrize("spline", [False, True])
def test_each_piece_is_joined_on_its_own(spline):
    x = [-0.5, -0.3, -0.1, 0.1, 0.1, 0.2, 0.4, 0.5]
    v = [0.0, 0.3, 0.1, 0.2, -0.5, 0.0, 0.1, -0.2]
    found = gamma33(gamma33=(x, v), breaks=[0.1], spline=spline)
    joined = CubicSpline if spline else lambda x, v: lambda t: np.interp(t, x, v)
    expected = np.where(X < 0.1, joined(x[:4], v[:4])(X), joined(x[4:], v[4:])(X))
    assert found == pytest.approx(expected, abs=16 * EPS)
    assert gamma33(0.1, gamma33=(x, v), breaks=[0.1], spline=spline) == pytest.approx(-0.5, abs=EPS)


def test_samples_reach_to_the_edges_or_nearly():
    x = np.linspace(-0.5, 0.5, 21)[1::2]  # in the middle of ten strips
    v = x**3
    inside = np.abs(X) <= 0.45
    assert gamma33(gamma33=(x, v))[inside] == pytest.approx(np.interp(X, x, v)[inside], abs=1e-15)
    # A cubic through samples of a cubic is that cubic, up to the edges.
    assert gamma33(gamma33=(x, v), spline=True) == pytest.approx(X**3, abs=4 * EPS)
    assert gamma33([-0.5, 0.5], gamma33=(x, v)) == pytest.approx(
        [1.5 * v[0] - 0.5 * v[1], 1.5 * v[-1] - 0.5 * v[-2]], abs=EPS
    )
    gamma33(gamma33=([-0.2, 0.15], [0.0, 0.1]))  # 0.35 is as far as the samples are apart


def test_samples_rounded_off_an_edge_or_a_break_are_at_it():
    x = [-0.5 - 1e-16, 0.1 - 2e-17, 0.1 + 2e-17, 0.5 + 2e-16]
    kept = shape(gamma33=(x, [0.0, 0.0, 0.1, 0.1]), breaks=[0.1])
    assert kept == Pieces((-0.5, 0.1, 0.5), ((0.0, 0.0), (0.1, 0.0)))


@pytest.mark.parametrize(
    ("field", "x", "values", "given"),
    [
        ("x", [-0.5], [0.0], {}),
        ("x", [], [], {}),
        ("", [-0.5, 0.5], [0.0], {}),
        ("", [[-0.5, 0.5]], [[0.0, 0.1]], {}),
        ("x[1]", [-0.5, 0.6], [0.0, 0.1], {}),
        ("x[0]", [-5, 5], [0.0, 0.1], {}),
        ("x[2]", [-0.5, 0.2, 0.1, 0.5], [0.0] * 4, {}),
        ("x[1]", [-0.5, -0.5, 0.5], [0.0] * 3, {}),
        ("x[2]", [-0.5, 0.1, 0.1, 0.5], [0.0] * 4, {}),
        ("x[2]", [-0.5, 0.1, 0.1 + 1e-10, 0.5], [0.0] * 4, {}),
        ("x[1]", [-0.5, math.nan, 0.5], [0.0] * 3, {}),
        ("values[1]", [-0.5, 0.0, 0.5], [0.0, math.nan, 0.0], {}),
        ("values[2]", [-0.5, 0.0, 0.5], [0.0, 0.0, math.inf], {}),
        ("values[0]", [-0.5, 0.5], [1e61, 0.0], {}),
        ("values", [-0.5, 0.5], [0.0, "0.1"], {}),
        ("values", [-0.5, 0.5], [0.0, 1j], {}),
        ("values", [-0.5, 0.5], [0.0, None], {}),
        ("values", [-0.5, 0.5], [0.0, [0.1]], {}),
        ("values", [-0.5, 0.5], np.array([0.0, 0.1], dtype=object), {}),
        ("x", [False, True], [0.0, 0.1], {}),
        ("x[0]", [0.0, 0.1, 0.5], [0.0] * 3, {}),
        ("x[2]", [-0.5, 0.0, 0.2], [0.0] * 3, {}),
        ("x", np.linspace(-0.5, 0.5, 1001), np.zeros(1001), {}),
        ("x", [-0.5, 0.0, 0.5], [0.0] * 3, {"spline": True}),
        ("x", [-0.5, 0.1, 0.1, 0.2, 0.5], [0.0] * 5, {"spline": True, "breaks": [0.1]}),
        ("x", [-0.5, 0.0, 0.5], [0.0] * 3, {"breaks": [0.1]}),
        ("x[1]", [-0.5, 0.1, 0.5], [0.0] * 3, {"breaks": [0.1]}),
        ("x[1]", [-0.5, 0.1, 0.1, 0.1, 0.5], [0.0] * 5, {"breaks": [0.1]}),
        ("x[1]", [-0.5, -0.4, 0.1, 0.5], [0.0] * 4, {"breaks": [0.0]}),
    ],
)
def test_samples_are_refused(field, x, values, given):
    path = f"growth.profile.gamma33.{field}".rstrip(".")
    refuses(path, lambda: rb.growth.Profile(gamma33=(x, values), **given))


@pytest.mark.parametrize("value", [([0.0, 0.1],), ([0.0], [0.1], [0.2]), (0.1, [0.2]), ([0.1], "ab")])
def test_samples_are_two_lists(value):
    with pytest.raises(rb.InputError, match=r"^growth\.profile\.gamma33"):
        rb.growth.Profile(gamma33=value)


def test_a_repeated_sample_is_told_of_breaks():
    told = line(gamma33=([-0.5, 0.1, 0.1, 0.5], [0.0, 0.0, 0.1, 0.1]))
    assert (
        told
        == "growth.profile.gamma33.x[2] = 0.1: expected ascending numbers, 1e-09 apart; breaks= mark jumps"
    )
    told = line(gamma33=([-0.5, 0.1, 0.5], [0.0, 0.0, 0.1]), breaks=[0.1])
    assert "two samples at the break x = 0.1: the value to its left, then that to its right" in told


# functions


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


numbers = st.one_of(
    st.floats(), st.floats(-0.6, 0.6), st.integers(), st.sampled_from([-0.5, 0.0, 0.5, 1e308])
)
entries = st.one_of(numbers, st.booleans(), st.none(), st.complex_numbers(), st.text(max_size=2))
lists = st.one_of(st.lists(numbers, max_size=6), st.lists(numbers, max_size=6).map(sorted), st.lists(entries))
anything = st.one_of(
    entries,
    lists,
    lists.map(lambda v: np.array(v, dtype=object)),
    st.lists(numbers, max_size=6).map(lambda v: np.array(v, dtype=float)),
    st.lists(lists, max_size=3),
    st.tuples(lists, lists),
    st.integers(2, 6).flatmap(
        lambda n: st.tuples(st.just(np.linspace(-0.5, 0.5, n)), st.lists(numbers, min_size=n, max_size=n))
    ),
    st.lists(entries, max_size=3).map(tuple),
    entries.map(lambda v: lambda x: v),
    numbers.map(lambda v: lambda x: v * x),
    numbers.map(lambda v: lambda x: x > v),
    st.just({}),
)


@settings(max_examples=500)
@given(anything, lists, st.booleans(), anything)
def test_anything_is_growth_or_is_refused(value, breaks, spline, along):
    makers = (
        lambda: rb.growth.Profile(gamma33=value, breaks=breaks, spline=spline, amplitude=along),
        lambda: rb.growth.Profile(gamma33=value, spline=spline, amplitude=along),
        lambda: rb.growth.edge(value) + rb.growth.thickness(along, transverse=value),
        lambda: rb.growth.stations([0.0, 1.0], [rb.growth.edge(0.1), rb.growth.Profile(g31=value)]),
    )
    for make in makers:
        with contextlib.suppress(rb.InputError):
            growth = make()
            terms = growth.core_terms(1.0)
            assert len(terms) == len(growth.terms)
            assert growth.size(0.1, 1.0) >= 0.0 or math.isnan(growth.size(0.1, 1.0))


def test_every_field_takes_everything():
    x = np.linspace(-0.5, 0.5, 9)
    for field in FIELDS:
        for value in ([0.1, 0.2], (x, 0.1 + 0.2 * x), lambda x: 0.1 + 0.2 * x, [[0.1, 0.2], [0.1, 0.2]]):
            growth = rb.growth.Profile(**{field: value}, breaks=[0.0] if isinstance(value, list) else [])
            assert growth.values(X)[field] == pytest.approx(0.1 + 0.2 * X, abs=4 * EPS)
