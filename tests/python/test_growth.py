"""Growths, their sums and what they refuse."""

import math
import time

import numpy as np
import pytest
import ribbonrs as rb
from hypothesis import given
from hypothesis import strategies as st
from refusal import NOT_FINITE, NOT_NUMBERS, refuses
from ribbonrs.growth import FIELDS

amplitudes = st.floats(-0.1, 0.1)
coefficients = st.lists(st.floats(-1.0, 1.0), min_size=1, max_size=33)


def fields(growth, x=0.25):
    """The growth fields at x, as numbers."""
    return {name: float(value) for name, value in growth.values(x).items()}


def test_the_kinds_of_growth():
    assert fields(rb.growth.edge(0.06)) == {"gamma33": 0.015}
    assert fields(rb.growth.thickness(0.3)) == {"d33": 0.3}
    assert fields(rb.growth.thickness(0.3, transverse=-0.15)) == {"d33": 0.3, "d22": -0.15}
    assert fields(rb.growth.thickness(0.0, transverse=0.2)) == {"d22": 0.2}
    assert fields(rb.growth.chiral(-0.04)) == {"d23": -0.04}


def test_the_core_takes_polynomials_as_they_are():
    growth = rb.growth.edge(0.06) + rb.growth.Profile(d33=[0.0, 1.0], g21=(0.5,), amplitude=0.1)
    assert growth.core_terms() == [
        (0.06, {"gamma33": [0.0, 0.0, 4.0]}),
        (0.1, {"d33": [0.0, 1.0], "g21": [0.5]}),
    ]
    assert growth.core_terms(10.0) == growth.core_terms()
    assert not growth.varies
    assert growth.domain is None
    growth.check_covers(1e8)


def test_the_core_takes_pieces_as_legendre_series():
    growth = rb.growth.Profile(gamma33=[[0.0], [0.02, 1.0]], breaks=[0.0], amplitude=([0.0, 8.0], [1.0, 3.0]))
    ((amplitude, shape),) = growth.core_terms()
    assert amplitude == ([0.0, 8.0], [[2.0, 1.0]])
    assert shape == {"gamma33": ([-0.5, 0.0, 0.5], [[0.0], [0.27, 0.25]])}


def test_the_amplitude_is_the_parameter():
    growth = rb.growth.edge(0.06) + rb.growth.chiral(0.04) + rb.growth.thickness(0.1, 0.3)
    growth += rb.growth.Profile(g21=[1.0, 2.0], amplitude=0.5)
    assert [(term.name, term.amplitude) for term in growth.terms] == [
        ("edge", 0.06),
        ("chiral", 0.04),
        ("thickness", 0.1),
        ("profile", 0.5),
    ]
    assert growth.values([0.0, 0.5])["g21"].tolist() == [0.5, 1.0]


def test_edge_growth_is_xi_at_the_edges():
    assert rb.growth.edge(0.06).values([-0.5, 0.0, 0.5])["gamma33"].tolist() == [0.06, 0.0, 0.06]


@given(st.lists(st.tuples(st.sampled_from(FIELDS), coefficients, amplitudes), min_size=1, max_size=4))
def test_sums_add_field_by_field(parts):
    terms = [
        rb.growth.Profile(**{field: list(c)}, amplitude=a, name=f"p{i}")
        for i, (field, c, a) in enumerate(parts)
    ]
    x = np.linspace(-0.5, 0.5, 7)
    total = sum(terms).values(x)
    assert set(total) == {field for field, _, _ in parts}
    for field, found in total.items():
        expected = sum(a * np.polynomial.polynomial.polyval(x, c) for f, c, a in parts if f == field)
        # At most 4 terms of size 0.1 * 2 each, every one rounded a few times.
        assert found == pytest.approx(expected, abs=1e-15)


@given(coefficients)
def test_size_is_the_largest_value(c):
    growth = rb.growth.Profile(gamma33=c)
    x = np.linspace(-0.5, 0.5, 4001)
    largest = np.max(np.abs(np.polynomial.polynomial.polyval(x, c)))
    # Both are maxima over points; the Chebyshev points miss at most 0.2 %, the others less than 1 %.
    assert growth.size(0.1) == pytest.approx(largest, rel=1e-2, abs=1e-300)


def test_size_of_gradients_is_taken_at_the_faces():
    assert rb.growth.thickness(0.4, transverse=-0.6).size(0.1) == pytest.approx(0.03, rel=1e-15)
    assert rb.growth.edge(-0.2).size(0.1) == pytest.approx(0.2, rel=1e-15)
    assert (rb.growth.edge(0.02) + rb.growth.chiral(1.0)).size(0.1) == pytest.approx(0.05, rel=1e-15)
    assert rb.growth.edge(0.0).size(0.1) == 0.0


def test_sums_leave_their_parts_alone():
    edge, chiral = rb.growth.edge(0.06), rb.growth.chiral(0.04)
    both = edge + chiral
    assert both == sum([edge, chiral])
    assert edge == rb.growth.edge(0.06)
    both.core_terms()[0][1]["gamma33"].append(1.0)
    both.values([0.5])["gamma33"][0] = 1.0
    assert both.core_terms()[0] == (0.06, {"gamma33": [0.0, 0.0, 4.0]})
    with pytest.raises(TypeError):
        edge + 1.0
    with pytest.raises(TypeError):
        1.0 + edge


def test_names_in_a_sum_differ():
    refuses("growth.name", lambda: rb.growth.edge(0.1) + rb.growth.edge(0.1))
    two = rb.growth.edge(0.1) + rb.growth.edge(0.1, name="margin")
    assert fields(two, 0.5) == {"gamma33": 0.2}


@pytest.mark.parametrize("name", ["", "a b", "a.b", "a\nb", 3, None, b"x", "1st"])
def test_names_are_identifiers(name):
    for make in (rb.growth.edge, rb.growth.thickness, rb.growth.chiral):
        refuses("growth.name", lambda make=make: make(0.1, name=name))
    refuses("growth.name", lambda: rb.growth.Profile(d33=[0.1], name=name))


@pytest.mark.parametrize("value", NOT_NUMBERS + NOT_FINITE)
def test_growth_refuses_what_is_no_number(value):
    refuses("growth.edge", lambda: rb.growth.edge(value))
    refuses("growth.margin", lambda: rb.growth.edge(value, name="margin"))
    refuses("growth.chiral", lambda: rb.growth.chiral(value))
    refuses("growth.thickness.xi", lambda: rb.growth.thickness(value))
    refuses("growth.thickness.transverse", lambda: rb.growth.thickness(0.1, value))
    refuses("growth.profile.amplitude", lambda: rb.growth.Profile(d33=[0.1], amplitude=value))
    refuses("growth.profile.d33[1]", lambda: rb.growth.Profile(d33=[0.1, value]))


@pytest.mark.parametrize(
    "value",
    [
        [],
        np.zeros(34),
        0.1,
        "0.1",
        np.array(0.1),
        math.sin,
        {0: 1.0},
    ],
)
def test_profiles_are_short_lists_of_coefficients(value):
    for field in FIELDS:
        refuses(f"growth.profile.{field}", lambda field=field: rb.growth.Profile(**{field: value}))


def test_profile_needs_a_field():
    refuses("growth.profile", lambda: rb.growth.Profile())


@pytest.mark.parametrize("value", ["0.1", None, [0.1, math.nan], 1j, [[0.1], [0.1, 0.2]], True])
def test_values_are_asked_for_at_numbers(value):
    with pytest.raises(rb.InputError, match=r"^x"):
        rb.growth.edge(0.1).values(value)
    with pytest.raises(rb.InputError, match=r"^S"):
        rb.growth.edge(0.1).values(0.1, value)


def test_size_of_pieces_is_that_of_both_sides_of_a_jump():
    growth = rb.growth.Profile(gamma33=[[0.0, 3.0], [0.02]], breaks=[0.1])
    assert growth.size(0.1) == pytest.approx(1.5, rel=1e-15)
    growth = rb.growth.Profile(gamma33=[[0.02], [0.0, 3.0], [0.02]], breaks=[-0.05, 0.1])
    assert growth.size(0.1) == pytest.approx(0.3, rel=1e-15)
    beside = growth + rb.growth.Profile(gamma33=[[0.1], [0.0]], breaks=[0.1], name="half")
    assert beside.size(0.1) == pytest.approx(0.4, rel=1e-15)


def test_overflowing_sums_are_refused():
    refuses(
        "growth.gamma33", lambda: rb.growth.Profile(gamma33=[[1e308], [-1.5e308]], breaks=[0.0], amplitude=9)
    )
    refuses("growth.gamma33", lambda: rb.growth.edge(1e308))
    refuses("growth.d33", lambda: rb.growth.Profile(d33=[1e300], amplitude=1e300))


def test_slopes_are_the_derivatives_of_every_field_on_each_piece():
    growth = rb.growth.Profile(
        gamma33=[[0.1, 0.2, 0.3], [0.02]], g21=[0.0, 0.05, 0.0, 0.4], d33=[0.3], breaks=[0.1], amplitude=0.5
    ) + rb.growth.edge(0.06)
    at = np.array([-0.3, 0.05, 0.1, 0.4])
    slopes = growth.slopes.values(at)
    assert slopes["gamma33"] == pytest.approx(np.where(at < 0.1, 0.1 + 0.3 * at, 0.0) + 0.48 * at, abs=1e-15)
    assert slopes["g21"] == pytest.approx(0.025 + 0.6 * at**2, abs=1e-15)
    assert slopes["d33"] == pytest.approx(0.0, abs=0.0)


def test_values_broadcast():
    growth = rb.growth.edge(0.06) + rb.growth.chiral(([0.0, 10.0], [0.0, 0.1]))
    values = growth.values(np.array([0.0, 0.5]), [[0.0], [5.0], [10.0]])
    assert values["gamma33"].tolist() == [[0.0, 0.06]] * 3
    assert values["d23"].tolist() == [[0.0, 0.0], [0.05, 0.05], [0.1, 0.1]]
    refuses("S.shape", lambda: growth.values([0.0, 0.1], [1.0, 2.0, 3.0]))


@pytest.mark.parametrize("x", [3.0, -0.5001, [0.0, 0.5 + 1e-11]])
def test_values_are_inside_the_width(x):
    refuses("x", lambda: rb.growth.edge(0.1).values(x))
    assert rb.growth.edge(0.1).values(0.5 + 1e-13)["gamma33"] == pytest.approx(0.1, rel=1e-12)


@pytest.mark.parametrize("xi", [4e-5, ([0.0, 10.0], [0.0, 4e-5])])
def test_sums_of_many_growths(xi):
    start = time.perf_counter()
    growth = sum(rb.growth.edge(xi, name=f"edge{i}") for i in range(1000))
    # Takes 0.2 s; comparing every two names of every sum took 6 s.
    assert time.perf_counter() - start < 2.0
    # A thousand roundings of numbers up to 0.04.
    assert growth.values(0.5, 10.0)["gamma33"] == pytest.approx(0.04, rel=1000 * 2.3e-16)


def test_sums_that_overflow_are_refused():
    half = 1e308 / 4
    refuses("growth.gamma33", lambda: rb.growth.edge(half, "a") + rb.growth.edge(half, "b"))
