"""Profiles across the width: polynomials in pieces, samples, and what of them is refused."""

import contextlib
import math

import numpy as np
import pytest
import ribbonrs as rb
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.polynomial.polynomial import polyval
from profiles import EPS, X, gamma33, line, shape
from refusal import refuses
from ribbonrs.growth import FIELDS
from ribbonrs.pieces import Pieces
from scipy.interpolate import CubicSpline

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


def test_twisting_shear_does_not_jump():
    refuses("growth.profile.g31", lambda: rb.growth.Profile(g31=[[0.0], [0.02]], breaks=[0.1]))
    kink = rb.growth.Profile(g31=[[0.01], [0.0, 0.1]], breaks=[0.1])
    assert kink.values(0.2)["g31"] == pytest.approx(0.02, rel=4 * EPS)


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
        ("values", [-0.5, 0.5], np.ma.masked_equal([0.0, 0.1], 0.1), {}),
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


# anything


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
