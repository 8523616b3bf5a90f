"""Natural shapes of many growths at once."""

import numpy as np
import pytest
import ribbonrs as rb
from refusal import refuses
from ribbonrs import _core

LEAF = rb.Ribbon(length=10.0, width=1.0, thickness=0.1)
UNIFORM = [rb.growth.edge(xi) + rb.growth.chiral(d) for xi in (0.02, 0.048, 0.07) for d in (0.0, 0.03)]
STEP = rb.growth.Profile(gamma33=[[0.0], [0.04]], breaks=[0.1])
VARYING = rb.growth.edge(([0.0, 10.0], [0.08, 0.06]))


@pytest.fixture
def batches(monkeypatch):
    """The sizes of what is handed to all cores at once."""
    sizes = []
    original = _core.natural_shapes_of

    def counted(laws):
        sizes.append(len(laws))
        return original(laws)

    monkeypatch.setattr(_core, "natural_shapes_of", counted)
    return sizes


def same(one, two):
    """Whether two lists of states agree to the last bit."""
    assert len(one) == len(two)
    for a, b in zip(one, two, strict=True):
        for name in ("strains", "S", "position"):
            assert np.array_equal(getattr(a, name), getattr(b, name)), name
        for name in ("scene", "energy", "section_index", "phases", "resolved", "report"):
            assert getattr(a, name) == getattr(b, name), name


@pytest.mark.parametrize("kind", [list, tuple])
def test_a_list_gives_what_each_gives_alone(batches, kind):
    growths = [*UNIFORM, VARYING, STEP, VARYING + rb.growth.chiral(0.02), UNIFORM[0]]
    states = rb.natural_shapes(LEAF, kind(growths))
    assert batches == [8]  # all the uniform ones together
    assert [len(some) for some in states][:4] == [1, 1, 3, 1]
    for growth, some in zip(growths, states, strict=True):
        same(some, rb.natural_shapes(LEAF, growth))
    assert batches == [8]


def test_a_ribbon_that_varies():
    tapered = rb.Ribbon(10.0, 1.0, 0.1, width_profile=([0.0, 10.0], [1.0, 0.5]))
    for growth, some in zip(UNIFORM, rb.natural_shapes(tapered, UNIFORM), strict=True):
        same(some, rb.natural_shapes(tapered, growth))


def test_short_lists():
    assert rb.natural_shapes(LEAF, []) == []
    ((state, *_),) = rb.natural_shapes(LEAF, [UNIFORM[0]])
    assert state.phase == "flat"


def test_close_pairs_are_told_once():
    growths = [rb.growth.edge(0.05), rb.growth.edge(0.05), rb.growth.edge(0.06)]
    with pytest.warns(rb.RibbonWarning, match="2 of 11 equilibria stand for several") as caught:
        states = rb.natural_shapes(LEAF, growths)
    assert len(caught) == 1
    assert [some[0].report.unresolved for some in states] == [1, 1, 0]


@pytest.mark.parametrize(
    ("field", "ribbon", "growth"),
    [
        ("growth[1]", LEAF, [UNIFORM[0], None]),
        ("growth[0]", LEAF, [0.06]),
        ("growth[0]", LEAF, [[UNIFORM[0]]]),
        ("growth[2].size", LEAF, [*UNIFORM[:2], rb.growth.edge(0.6)]),
        ("growth[1].edge.amplitude", rb.Ribbon(11.0, 1.0, 0.1), [UNIFORM[0], VARYING]),
        ("ribbon", "leaf", UNIFORM),
        ("growth", LEAF, {0: UNIFORM[0]}),
        ("growth", LEAF, iter(UNIFORM)),
    ],
)
def test_refusals_name_the_growth(field, ribbon, growth):
    refuses(field, lambda: rb.natural_shapes(ribbon, growth))
