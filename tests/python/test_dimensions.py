"""Ribbons whose width or thickness varies along them."""

import dataclasses
import math
import pickle

import numpy as np
import pytest
import ribbonrs as rb
from refusal import refuses
from ribbonrs.pieces import Pieces

EPS = np.finfo(float).eps
PROFILES = ("width_profile", "thickness_profile")


def ribbon(**profiles):
    return rb.Ribbon(20.0, 2.0, 0.2, **profiles)


def test_plain_ribbons_do_not_vary():
    plain = ribbon()
    assert not plain.varies
    assert plain.width_pieces is plain.thickness_pieces is None
    assert plain == rb.Ribbon(20, 2, 0.2)
    assert hash(plain) == hash(rb.Ribbon(20, 2, 0.2))


@pytest.mark.parametrize("name", PROFILES)
def test_samples(name):
    tapered = ribbon(**{name: ([0, 5, 10], [1, 1, 0.2])})
    pieces = getattr(tapered, name.replace("profile", "pieces"))
    S = np.linspace(0, 10, 101)
    assert pieces.evaluate(S) == pytest.approx(np.interp(S, [0, 5, 10], [1, 1, 0.2]), abs=2 * EPS)
    assert tapered.varies
    assert (tapered.thickness_ratio, tapered.length_ratio) == (0.1, 10.0)
    other = ribbon(**{name: (np.array([0.0, 5.0, 10.0]), (1.0, 1.0, 0.2))})
    assert tapered == other
    assert hash(tapered) == hash(other)
    assert tapered != ribbon()
    assert pickle.loads(pickle.dumps(tapered)) == tapered


@pytest.mark.parametrize("name", PROFILES)
def test_functions_are_resolved_on_the_length(name):
    tapered = ribbon(**{name: lambda S: 1 - S**2 / 200})
    pieces = getattr(tapered, name.replace("profile", "pieces"))
    S = np.linspace(0, 10, 101)
    assert pieces.domain == (0.0, 10.0)
    assert pieces.evaluate(S) == pytest.approx(1 - S**2 / 200, abs=4 * EPS)
    shorter = dataclasses.replace(tapered, length=10.0)
    assert getattr(shorter, name.replace("profile", "pieces")).domain == (0.0, 5.0)
    assert hash(tapered) == hash(dataclasses.replace(tapered))


def test_a_step_of_the_width():
    stepped = ribbon(width_profile=([0, 4, 4, 10], [1, 1, 0.5, 0.5]))
    assert stepped.width_pieces == Pieces((0.0, 4.0, 10.0), ((1.0, 0.0), (0.5, 0.0)))


@pytest.mark.parametrize("name", PROFILES)
@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("", 1.0),
        ("", "1"),
        ("", [[0, 10], [1, 1]]),
        ("", ([0, 10],)),
        ("", ([0, 10], [1])),
        ("", ([0, 9.9], [1, 1])),
        ("", ([0.1, 10], [1, 1])),
        ("S[1]", ([0, math.nan], [1, 1])),
        ("S[0]", ([-1, 10], [1, 1])),
        ("S[2]", ([0, 10, 5], [1, 1, 1])),
        ("values[1]", ([0, 10], [1, math.inf])),
        ("", ([0, 10], [1, 0])),
        ("", ([0, 10], [1, -1])),
        ("", ([0, 10], [1, 0.9e-3])),
        ("", ([0, 10], [1, 1.1e3])),
        ("", ([0, 5, 5, 10], [1, 0, 1, 1])),  # the left limit at a jump
        ("", lambda S: 1 - S / 10),
        ("", lambda S: 1 - 2 * np.exp(-((S - 5) ** 2))),
        ("", lambda S: np.where(S < 5, 1.0, 0.5)),
        ("", lambda S: 1.0),
        ("", lambda S: S / 0),
        ("", lambda S: 1 + 0j * S),
        ("", lambda: 1.0),
    ],
)
def test_profiles_are_refused(name, key, value):
    refuses(f"ribbon.{name}.{key}".rstrip("."), lambda: ribbon(**{name: value}))


def test_what_a_function_raises_is_kept():
    def function(S):
        raise ZeroDivisionError

    with pytest.raises(rb.InputError, match="ZeroDivisionError") as caught:
        ribbon(width_profile=function)
    assert isinstance(caught.value.__cause__, ZeroDivisionError)


def test_the_thickness_stays_below_the_width_everywhere():
    refuses("ribbon.width_profile", lambda: ribbon(width_profile=([0, 10], [1, 0.09])))
    refuses("ribbon.thickness_profile", lambda: ribbon(thickness_profile=([0, 10], [1, 11])))
    both = {"width_profile": ([0, 10], [1, 0.2]), "thickness_profile": ([0, 5, 10], [1, 6.1, 0.2])}
    # 0.1 * 6.1 / 0.6 at S = 5
    with pytest.raises(rb.InputError) as caught:
        ribbon(**both)
    assert str(caught.value) == (
        "ribbon.thickness_profile = 'thickness/width 1.01667 at S = 5': "
        "expected thickness/width from 1e-06 to 1 everywhere"
    )
    both["thickness_profile"] = ([0, 5, 10], [1, 5.9, 0.2])
    assert ribbon(**both).varies
    thin = {"length": 10.0, "width": 1.0, "thickness": 2e-6}
    refuses("ribbon.width_profile", lambda: rb.Ribbon(**thin, width_profile=([0, 10], [1, 2.1])))
    assert rb.Ribbon(**thin, width_profile=([0, 10], [1, 1.9])).varies
