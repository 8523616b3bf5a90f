"""Several equilibria by deflation."""

from __future__ import annotations

import math
import time

import numpy as np
import pytest
import ribbonrs as rb
from scipy.optimize import brentq
from scipy.special import ellipk

ROD = rb.LinearLaw(EI1=100.0, EI2=1.0, GJ=1.0, inextensible=True)
STRIP = rb.Ribbon(10.0, 1.0, 0.1)


def test_a_column_has_the_shapes_of_the_elastica() -> None:
    # Beyond the second buckling load, 9 pi^2/4: straight, and in its plane one shape of each of two modes.
    load = 30.0
    column = rb.Scene(rb.Ribbon(1.0, 1.0, 0.1), end=rb.Free(force=(0.0, 0.0, -load)), law=ROD)
    states = rb.find_states(column, most=30)
    planar = [s for s in states if np.max(np.abs(s.strains[:, [1, 3]])) < 1e-9]
    found = sorted(abs(s.strains[0, 2]) for s in planar)
    # Of mode j: (2 j + 1) K(m) = sqrt(P) L, and at the clamp K2 = 2 sqrt(m P).
    moduli = [brentq(lambda m, j=j: (2 * j + 1) * ellipk(m) - np.sqrt(load), 0.0, 1 - 1e-12) for j in (0, 1)]
    exact = sorted([0.0, *(2.0 * np.sqrt(m * load) for m in moduli)])
    assert np.allclose(
        found, exact, rtol=0.0, atol=1e-8
    )  # curvatures are within tol of what they are over L = 1


def test_energies_ascend_and_all_are_equilibria() -> None:
    strip = rb.Scene(STRIP, end=rb.Clamped(position=(0.0, 0.0, 9.5)))
    states = rb.find_states(strip, most=6)
    energies = [s.energy + s.load_potential for s in states]
    assert energies == sorted(energies)
    assert states[0].index == 0.0
    assert states[0].energy == pytest.approx(rb.solve(strip).energy, rel=1e-10)
    assert all(s.report.residual < 1e-9 for s in states)
    assert len({round(e, 12) for e in energies}) == len(states) == 6


def winding(state: rb.State) -> float:
    """1 or -1: the quaternion that a rotation without turns becomes along the ribbon, over that."""
    q = state.quaternion
    return float(np.sign(np.prod(np.sign(np.einsum("ni,ni->n", q[:-1], q[1:]))) * (q[0] @ q[-1])))


@pytest.mark.parametrize(("turns", "sign"), [(0.0, 1.0), (1.0, -1.0), (-1.0, -1.0), (2.0, 1.0)])
def test_clamped_states_have_the_turns_asked_for(turns: float, sign: float) -> None:
    # A turn more or less is another quaternion of the end; two are not told apart, for ribbons may cross.
    rod = rb.LinearLaw(EI1=5.0, EI2=1.0, GJ=1.0, inextensible=True)
    end = rb.Clamped(position=(0.0, 0.0, 0.8), twist_turns=turns)
    states = rb.find_states(rb.Scene(rb.Ribbon(1.0, 1.0, 0.1), law=rod, end=end), most=6)
    assert len(states) > 2
    assert {winding(state) for state in states} == {sign}


@pytest.mark.parametrize("link", [0, 1])
def test_closed_states_have_the_link_asked_for(link: int) -> None:
    rod = rb.LinearLaw(EI1=5.0, EI2=1.0, GJ=1.0, inextensible=True)
    states = rb.find_states(rb.Scene(rb.Ribbon(1.0, 1.0, 0.1), law=rod, start=rb.Closed(link=link)), most=4)
    assert len(states) > 1
    # A ring without turns turns by one about its normal.
    assert {winding(state) for state in states} == {1.0 if link else -1.0}


def test_unloaded_ribbons_have_their_natural_shapes() -> None:
    growth = rb.growth.edge(0.06)
    found = rb.find_states(rb.Scene(STRIP, growth))
    assert [s.energy for s in found] == [s.energy for s in rb.natural_shapes(STRIP, growth)]


def test_the_same_twice() -> None:
    strip = rb.Scene(STRIP, rb.growth.edge(0.02), end=rb.Clamped(position=(0.0, 0.0, 9.0), twist_turns=0.5))
    first, again = (rb.find_states(strip, most=4) for _ in range(2))
    assert [s.energy for s in first] == [s.energy for s in again]


@pytest.mark.parametrize("most", [0, -1, 2.5, True, 10**6])
def test_how_many_is_checked(most: object) -> None:
    with pytest.raises(
        rb.InputError, match=r"^find_states\.most = .*: expected a whole number from 1 to 1000$"
    ):
        rb.find_states(rb.Scene(STRIP), most=most)  # type: ignore[arg-type]


def test_a_search_that_finds_little_ends() -> None:
    """A few seconds a state: without a bound on all of its work this one takes minutes."""
    law = rb.LinearLaw(
        inextensible=True,
        EI1=0.10469979537448289,
        EI2=math.inf,
        GJ=6.301816613682313,
        intrinsic=(0.0, 0.0, -0.5428858606555135, 0.0032820002845776242),
    )
    end = rb.Clamped((0.0, 0.0, 23.581437066262872), twist_turns=-1.3)
    scene = rb.Scene(rb.Ribbon(30.0, 1.0, 0.1), law=law, start=rb.Pinned(), end=end)
    begun = time.process_time()
    states = rb.find_states(scene, most=2)
    assert 1 <= len(states) <= 2
    assert time.process_time() - begun < 60.0


def test_round_rods_are_counted_once() -> None:
    """They may be turned for nothing: what is found once is not found again, turned."""
    rod = rb.LinearLaw(EI1=1.0, EI2=1.0, GJ=1.0, inextensible=True)
    for start, end in ((rb.Closed(), rb.Free()), (rb.Clamped(), rb.Clamped((0.0, 0.0, 0.9)))):
        scene = rb.Scene(rb.Ribbon(1.0, 1.0, 0.1), law=rod, start=start, end=end)
        states = rb.find_states(scene, most=6)
        numbers = [
            (
                state.energy,
                np.mean(np.sum(state.strains[:, 1:3] ** 2, axis=1)),
                np.mean(state.strains[:, 3] ** 2),
            )
            for state in states
        ]
        assert len(states) >= 3
        for i, one in enumerate(numbers):
            for other in numbers[:i]:
                assert not np.allclose(one, other, rtol=1e-5, atol=1e-5)
