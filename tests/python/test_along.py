"""What varies along the ribbon: samples over S, functions of S, and what of them is refused."""

import math
import pickle

import numpy as np
import pytest
import ribbonrs as rb
from hypothesis import example, given
from hypothesis import strategies as st
from numpy.polynomial.polynomial import polyval
from refusal import refuses
from ribbonrs.pieces import Pieces
from ribbonrs.resolve import MOST_PIECES, adapted

EPS = np.finfo(float).eps
LENGTH = 10.0
S = np.random.default_rng(5).uniform(0.0, LENGTH, 4000)

KINDS = {
    "growth.edge": rb.growth.edge,
    "growth.chiral": rb.growth.chiral,
    "growth.thickness.xi": rb.growth.thickness,
    "growth.thickness.transverse": lambda value: rb.growth.thickness(0.1, value),
    "growth.profile.amplitude": lambda value: rb.growth.Profile(gamma33=[0.1], amplitude=value),
}


def amplitude(growth, length=LENGTH):
    """The one amplitude of a growth, as the core takes it."""
    ((value, _),) = growth.core_terms(length)
    return value


# samples


def test_samples_are_joined_by_lines():
    places, values = np.array([0.0, 1.0, 4.0, 10.0]), np.array([0.01, 0.05, -0.02, 0.03])
    for samples in ((places, values), (places.tolist(), tuple(values)), (tuple(places), values)):
        growth = rb.growth.edge(samples)
        found = growth.values(0.5, S)["gamma33"]
        # The sum of two halves, each rounded, is rounded once more.
        assert found == pytest.approx(np.interp(S, places, values), abs=0.05 * 4 * EPS)
    assert growth.varies
    assert growth.domain == (0.0, 10.0)


def test_the_same_place_twice_is_a_jump():
    growth = rb.growth.chiral(([0.0, 5.0, 5.0, 10.0], [0.0, 0.0, 0.04, 0.04]))
    assert growth.values(0.0, [4.9, 5.0, 7.0])["d23"].tolist() == [0.0, 0.04, 0.04]
    assert amplitude(growth) == ([0.0, 5.0, 10.0], [[0.0, 0.0], [0.04, 0.0]])


@given(st.lists(st.floats(0.1, 1.0), min_size=1, max_size=8), st.data())
def test_samples_go_to_the_core_as_they_are(steps, data):
    places = np.cumsum([0.0, *steps])
    values = data.draw(st.lists(st.floats(-1.0, 1.0), min_size=places.size, max_size=places.size))
    breaks, coefficients = amplitude(rb.growth.edge((places, values)), places[-1])
    assert breaks == places.tolist()
    assert [c[0] - c[1] for c in coefficients] == pytest.approx(values[:-1], abs=2 * EPS)
    assert [c[0] + c[1] for c in coefficients] == pytest.approx(values[1:], abs=2 * EPS)


@pytest.mark.parametrize("path", KINDS)
@pytest.mark.parametrize(
    ("key", "samples"),
    [
        ("", ()),
        ("", ([0.0, 1.0],)),
        ("", ([0.0, 1.0], [0.0, 0.1], [0.0, 0.1])),
        ("", (1.0, 2.0)),
        ("", ([0.0, 1.0], [0.0])),
        ("", ([[0.0, 1.0]], [[0.0, 0.1]])),
        ("S", ([0.0], [0.1])),
        ("S", ([], [])),
        ("S", (["a", "b"], [0.0, 0.1])),
        ("S", ([True, False], [0.0, 0.1])),
        ("S", ([0.0, [1.0]], [0.0, 0.1])),
        ("S[0]", ([-1.0, 1.0], [0.0, 0.1])),
        ("S[1]", ([0.0, math.nan], [0.0, 0.1])),
        ("S[1]", ([0.0, math.inf], [0.0, 0.1])),
        ("S[2]", ([0.0, 2.0, 1.0], [0.0, 0.1, 0.0])),
        ("S[2]", ([0.0, 2.0, 2.0 + 1e-15, 3.0], [0.0, 0.1, 0.0, 0.0])),
        ("S[0]", ([0.0, 0.0, 1.0], [0.0, 0.1, 0.1])),
        ("S[2]", ([0.0, 1.0, 1.0], [0.0, 0.1, 0.2])),
        ("S[2]", ([0.0, 1.0, 1.0, 1.0, 2.0], [0.0] * 5)),
        ("values[1]", ([0.0, 1.0], [0.0, math.nan])),
        ("values[0]", ([0.0, 1.0], [-math.inf, 0.1])),
        ("values[1]", ([0.0, 1.0], [0.0, 1e61])),
        ("values", ([0.0, 1.0], [0.0, "0.1"])),
        ("values", ([0.0, 1.0], [0.0, 0.1j])),
        ("values", ([0.0, 1.0], np.array([0.0, 0.1], dtype=object))),
    ],
)
def test_samples_are_refused(path, key, samples):
    refuses(f"{path}.{key}".rstrip("."), lambda: KINDS[path](samples))


def test_samples_cover_the_ribbon():
    growth = rb.growth.edge(([0.0, 10.0], [0.0, 0.06])) + rb.growth.chiral(0.1)
    growth.check_covers(10.0)
    growth.check_covers(3.0)
    growth.check_covers(10.0 * (1 + 1e-13))
    with pytest.raises(rb.InputError) as caught:
        growth.check_covers(12.5)
    assert str(caught.value) == "growth.edge.amplitude = (0.0, 10.0): expected samples from S = 0 to S = 12.5"
    refuses("growth.edge.amplitude", lambda: rb.growth.edge(([0.1, 10.0], [0.0, 0.1])).check_covers(10.0))
    both = growth + rb.growth.edge(([1.0, 20.0], [0.0, 0.1]), name="margin")
    assert both.domain == (1.0, 10.0)
    assert (rb.growth.edge(0.1) + rb.growth.chiral(np.sin)).domain is None


def test_values_are_refused_where_there_are_no_samples():
    growth = rb.growth.edge(([1.0, 4.0], [0.0, 0.06]))
    growth.values(0.0, [1.0, 4.0 * (1 + 1e-13)])
    for outside in (0.9, 4.1):
        refuses("S", lambda outside=outside: growth.values(0.0, outside))


# functions


FUNCTIONS = {
    "constant": lambda S: np.full_like(S, 0.06),
    "ramp": lambda S: 0.06 * S / LENGTH,
    "sigmoid": lambda S: 1 / (1 + np.exp(-3 * (S - 5))),
    "wave": lambda S: np.sin(3 * S + 1),
    "steep": lambda S: np.tanh(1e6 * (S - 3.0)),
    "zero": np.zeros_like,
    "kink": lambda S: np.abs(S - 3.3),
    "kink in the middle": lambda S: np.abs(S - 5.0),
    "kink near the end": lambda S: np.minimum(S, 9.99),
    "kinks": lambda S: np.abs(np.sin(np.pi * S)),
    "kink of the slope": lambda S: np.abs(S - 3.0) * (S - 3.0),
    "trapezoid": lambda S: np.interp(S, [0.0, 2.0, 7.0, 10.0], [0.0, 1.0, 1.0, 0.0]),
}


@pytest.mark.parametrize("name", FUNCTIONS)
def test_functions_are_met_to_rounding(name):
    exact = FUNCTIONS[name](S)
    found = adapted("growth.edge", FUNCTIONS[name], LENGTH).evaluate(S)
    assert found == pytest.approx(exact, abs=1e-14 * np.max(np.abs(exact)))


@pytest.mark.parametrize(
    ("name", "breaks"),
    [
        ("constant", []),
        ("ramp", []),
        ("kink", [3.3]),
        ("kink in the middle", [5.0]),
        ("kinks", range(1, 10)),
        ("trapezoid", [2.0, 7.0]),
    ],
)
def test_pieces_meet_at_kinks(name, breaks):
    pieces = adapted("growth.edge", FUNCTIONS[name], LENGTH)
    # To where the kink is less than rounding; |sin| is rounded to 1e-15 about its zeros.
    assert pieces.breaks == pytest.approx((0.0, *breaks, LENGTH), abs=1e-13)


def test_fast_functions_are_met_to_the_rounding_of_s():
    # 100 S = 1000 is rounded to 1e-13.
    found = adapted("growth.edge", lambda S: np.sin(100 * S), LENGTH)
    assert found.evaluate(S) == pytest.approx(np.sin(100 * S), abs=2e-13)
    assert len(found.coefficients) < 100


@given(st.lists(st.floats(-1.0, 1.0), min_size=1, max_size=8), st.floats(0.1, 1e6))
@example([0.0, 0.75, 0.0, 0.0, 1.0], 1.01953125)
def test_polynomials_are_one_short_piece(c, length):
    pieces = adapted("growth.edge", lambda S: polyval(S / length, c) + 0.0 * S, length)
    assert pieces.domain == (0.0, length)
    assert len(pieces.coefficients) == 1
    assert pieces.degree < len(c)


@pytest.mark.parametrize(
    ("function", "at"),
    [
        (lambda S: np.sign(S - 3.2), 3.2),
        (lambda S: np.where(S < 5.0, 0.0, 0.06), 5.0),
        (lambda S: 1.0 + 1e-6 * (S > 1.25), 1.25),
        (np.sqrt, 0.0),
        (lambda S: np.sqrt(LENGTH - S), 10.0),
        (lambda S: np.cbrt(S - 4.0), 4.0),
        (lambda S: np.tanh(1e13 * (S - 3.0)), 3.0),
    ],
)
def test_jumps_and_infinite_slopes_are_found(function, at):
    growth = rb.growth.edge(function)
    with pytest.raises(rb.InputError) as caught:
        growth.core_terms(LENGTH)
    told = str(caught.value)
    assert told.startswith("growth.edge.amplitude = <")
    assert float(told.split("near S = ")[1].split(";")[0]) == pytest.approx(at, abs=1e-9)
    refuses("growth.edge.amplitude", lambda: growth.core_terms(LENGTH))


@pytest.mark.parametrize("at", [0.05, 3.3, 7.777])
def test_short_details_are_met(at):
    def bump(S):
        return np.exp(-(((S - at) / 0.01) ** 2))

    near = at + np.linspace(-0.02, 0.02, 41)
    # The slope is up to 86, and S is known to 2e-16 of itself.
    pieces = adapted("growth.edge", bump, LENGTH)
    assert pieces.evaluate(near) == pytest.approx(bump(near), abs=1e-14 + 86 * at * 2 * EPS)


def test_too_many_pieces_are_refused():
    assert f"{MOST_PIECES} pieces" in refusal(lambda S: np.sin(1e4 * S))


def refusal(function):
    with pytest.raises(rb.InputError) as caught:
        rb.growth.edge(function).core_terms(LENGTH)
    return str(caught.value)


def test_what_a_function_raises_is_kept():
    def function(S):
        raise KeyError("no such station")

    growth = rb.growth.chiral(function)
    with pytest.raises(rb.InputError, match=r"^growth\.chiral\.amplitude.*KeyError") as caught:
        growth.core_terms(LENGTH)
    assert isinstance(caught.value.__cause__, KeyError)
    with pytest.raises(rb.InputError, match=r"^growth\.chiral\.amplitude"):
        growth.values(0.0, 1.0)


@pytest.mark.parametrize(
    "function",
    [
        lambda S: 0.06,
        lambda S: S[:-1],
        lambda S: S + 0j,
        lambda S: S.astype(object),
        lambda S: np.ma.masked_greater(S, 5.0),
        lambda S: S.astype(np.float32),
        lambda S: None,
        lambda S: np.where(S < 5, np.nan, S),
        lambda S: 1 / (S - S),
        lambda S: 1e61 + S,
        lambda: 1.0,
    ],
)
def test_functions_return_real_arrays(function):
    refuses("growth.edge.amplitude", lambda: rb.growth.edge(function).core_terms(LENGTH))


def test_a_value_that_is_not_finite_is_told_with_its_place():
    told = refusal(lambda S: np.where(S < 2.5, S, np.nan))
    assert told.startswith("growth.edge.amplitude = nan: expected finite values, unlike at S = ")
    assert float(told.split("S = ")[1]) >= 2.5


def test_functions_are_resolved_once_for_each_length():
    calls = []

    def function(S):
        calls.append(S.size)
        return np.cos(S)

    growth = rb.growth.edge(function) + rb.growth.chiral(0.1)
    first = growth.core_terms(LENGTH)
    once = len(calls)
    assert growth.core_terms(LENGTH) == first
    assert growth.size(0.1, LENGTH) == pytest.approx(1.0, rel=0.02)
    assert len(calls) == once
    assert growth.core_terms(5.0)[0][0][0][-1] == 5.0
    assert len(calls) > once


def test_functions_need_a_length():
    growth = rb.growth.edge(np.sin)
    refuses("length", lambda: growth.core_terms())
    refuses("length", lambda: growth.size(0.1))


def test_values_call_the_function_itself():
    growth = rb.growth.edge(np.sin) + rb.growth.Profile(gamma33=[1.0], amplitude=0.5)
    places = np.linspace(0.0, 3.0, 7)
    assert growth.values(0.5, places)["gamma33"].tolist() == (np.sin(places) + 0.5).tolist()


# sums and other ways


def test_thickness_gradients_that_vary_are_two_growths():
    table = ([0.0, 10.0], [0.0, 0.2])
    both = rb.growth.thickness(table, transverse=-0.1)
    assert [term.name for term in both.terms] == ["thickness", "thickness_transverse"]
    assert both == rb.growth.Profile(d33=[1.0], amplitude=table, name="thickness") + rb.growth.Profile(
        d22=[1.0], amplitude=-0.1, name="thickness_transverse"
    )
    assert [t.name for t in rb.growth.thickness(table, name="dorsal").terms] == ["dorsal"]
    only = rb.growth.thickness(0.0, transverse=table)
    assert [(t.name, [f for f, _ in t.shape]) for t in only.terms] == [("thickness", ["d22"])]
    across = rb.growth.thickness(0.1, transverse=table, name="dorsal")
    assert [t.name for t in across.terms] == ["dorsal", "dorsal_transverse"]


def test_sums_of_different_tables():
    growth = rb.growth.edge(([0.0, 4.0, 10.0], [0.0, 0.1, 0.0]))
    growth += rb.growth.Profile(gamma33=[0.02], amplitude=([0.0, 7.0, 10.0], [1.0, 2.0, 1.0]))
    expected = np.interp(S, [0, 4, 10], [0, 0.1, 0]) + 0.02 * np.interp(S, [0, 7, 10], [1, 2, 1])
    assert growth.values(0.5, S)["gamma33"] == pytest.approx(expected, abs=0.15 * 4 * EPS)


def test_values_broadcast():
    growth = rb.growth.edge(([0.0, 10.0], [0.0, 0.1])) + rb.growth.chiral(0.2)
    values = growth.values(np.linspace(-0.5, 0.5, 5), np.linspace(0, 10, 3)[:, None])
    assert values["gamma33"].shape == (3, 5)
    assert values["gamma33"][:, 0] == pytest.approx([0.0, 0.05, 0.1], abs=EPS)
    assert growth.values(0.5, 5.0)["gamma33"].shape == ()


def test_size_is_the_largest_along_the_ribbon():
    growth = rb.growth.edge(([0.0, 3.0, 3.0, 10.0], [0.0, 0.3, -0.1, 0.05]))
    assert growth.size(0.1) == pytest.approx(0.3, rel=4 * EPS)  # the left limit at the jump
    assert growth.size(0.1, 10.0) == pytest.approx(0.3, rel=4 * EPS)
    assert growth.size(0.1, 1.5) == pytest.approx(0.15, rel=4 * EPS)
    both = growth + rb.growth.Profile(gamma33=[[0.0], [0.2]], breaks=[0.25])
    assert both.size(0.1) == pytest.approx(0.5, rel=4 * EPS)
    # Where both are largest at the same S and x: 0.1 * 0.1 / 2 less.
    wave = rb.growth.thickness(lambda S: 2 * np.sin(S)) + rb.growth.edge(0.0)
    assert wave.size(0.1, 10.0) == pytest.approx(0.1, rel=0.02)


def test_growth_that_varies_is_kept_in_order():
    growth = rb.growth.edge(([0, 10], [0.0, 0.1])) + rb.growth.Profile(
        gamma33=([-0.5, 0.5], [0.0, 1.0]), amplitude=0.1
    )
    assert pickle.loads(pickle.dumps(growth)) == growth
    assert hash(growth) == hash(pickle.loads(pickle.dumps(growth)))
    assert growth.terms[0].amplitude == Pieces((0.0, 10.0), ((0.05, 0.05),))
    assert not rb.growth.edge(0.1).varies
    assert rb.growth.edge(np.sin) == rb.growth.edge(np.sin)
    assert rb.growth.edge(np.sin).terms[0].amplitude is np.sin
