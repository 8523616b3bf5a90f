"""What ends hold, what they accept and what they refuse."""

import math
import pickle

import numpy as np
import pytest
import ribbonrs as rb
from refusal import NOT_FINITE, NOT_NUMBERS, refuses
from ribbonrs.ends import pose

VECTORS = {
    "free.force": lambda v: rb.Free(force=v),
    "free.moment": lambda v: rb.Free(moment=v),
    "pinned.position": lambda v: rb.Pinned(position=v),
    "pinned.moment": lambda v: rb.Pinned(moment=v),
    "hinged.position": lambda v: rb.Hinged(position=v),
    "sliding.axis": lambda v: rb.Sliding(axis=v),
}
NUMBERS = {
    "hinged.moment": lambda v: rb.Hinged(moment=v),
    "sliding.force": lambda v: rb.Sliding(force=v),
    "sliding.twist_turns": lambda v: rb.Sliding(twist_turns=v),
    "closed.link": lambda v: rb.Closed(link=v),
}


@pytest.mark.parametrize("value", [*NOT_NUMBERS, *NOT_FINITE])
def test_what_is_no_number_is_refused(value):
    for field, end in NUMBERS.items():
        refuses(field, lambda end=end: end(value))
    for field, end in VECTORS.items():
        refuses(f"{field}[1]", lambda end=end: end((0.0, value, 1.0)))


@pytest.mark.parametrize("value", [(), (1.0,), (0.0,) * 4, "abc", 1.0, {1: 2}])
def test_vectors_have_three_components(value):
    for field, end in VECTORS.items():
        refuses(field, lambda end=end: end(value))


@pytest.mark.parametrize("size", [1.1e60, -1e200])
def test_huge_loads_are_refused(size):
    for name in ("free.force", "free.moment", "pinned.moment"):
        refuses(f"{name}[2]", lambda name=name: VECTORS[name]((0.0, 0.0, size)))
    for name in ("hinged.moment", "sliding.force"):
        refuses(name, lambda name=name: NUMBERS[name](size))


@pytest.mark.parametrize("director", [0, 4, -1, 2.0, "2", True, None, math.nan, [1]])
def test_hinges_have_one_of_three_directors(director):
    refuses("hinged.director", lambda: rb.Hinged(director))


def test_a_hinge_turns_about_its_director():
    assert [rb.Hinged(k).axis for k in (1, 2, 3)] == [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)]
    assert rb.Hinged(np.int64(3)).director == 3


@pytest.mark.parametrize("size", [1e-300, 1e-5, 1.0, 1e300])
def test_the_axis_of_any_length_is_normalised(size):
    axis = rb.Sliding(axis=(0.6 * size, 0.0, -0.8 * size)).axis
    assert axis == pytest.approx((0.6, 0.0, -0.8), abs=2e-16)


def test_a_zero_axis_is_refused():
    refuses("sliding.axis", lambda: rb.Sliding(axis=(0.0, 0.0, 0.0)))


@pytest.mark.parametrize("rotation", [(1.0, 0.0), (1, 1, 1, 1), (), "1000", 1.0])
def test_a_slide_refuses_what_is_no_rotation(rotation):
    with pytest.raises(rb.InputError, match=r"^sliding\.rotation"):
        rb.Sliding(rotation=rotation)


def test_a_slide_is_turned_as_a_clamp():
    turn = {"rotation": (0.3, -0.4, 1.1), "twist_turns": 0.25}
    assert rb.Sliding(**turn).quaternion == rb.Clamped(**turn).quaternion


@pytest.mark.parametrize("link", [0.25, 1 / 3, 0.5000001, -0.1])
def test_links_are_half_turns(link):
    refuses("closed.link", lambda: rb.Closed(link))


def test_odd_half_turns_make_one_side():
    assert [rb.Closed(k / 2).one_sided for k in range(-3, 4)] == [True, False, True, False, True, False, True]


def test_where_a_start_is():
    identity = (1.0, 0.0, 0.0, 0.0)
    clamp = rb.Clamped((1, 2, 3), (0.3, 0.0, 0.0))
    assert pose(clamp) == ((1.0, 2.0, 3.0), clamp.quaternion)
    assert pose(rb.Pinned((1, 2, 3))) == pose(rb.Hinged(position=(1, 2, 3))) == ((1.0, 2.0, 3.0), identity)
    assert pose(rb.Sliding()) == pose(rb.Free()) == pose(rb.Closed(1.5)) == ((0.0, 0.0, 0.0), identity)


def test_ends_are_values():
    for end in (rb.Pinned((1, 2, 3)), rb.Hinged(1), rb.Sliding((1, 0, 0)), rb.Closed(0.5), rb.Free()):
        assert pickle.loads(pickle.dumps(end)) == end
        assert hash(end) == hash(pickle.loads(pickle.dumps(end)))
        with pytest.raises(AttributeError):
            end.moment = 1.0
