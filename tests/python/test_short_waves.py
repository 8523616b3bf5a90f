"""The index of uniform states far beyond buckling, which are exact on meshes too coarse for that."""

import math

import numpy as np
import pytest
import ribbonrs as rb
from scipy.optimize import brentq

UNIT = rb.Ribbon(1.0, 1.0, 0.1)


def branch_points(diagram):
    points = [p for p in diagram.special_points if p.kind == "branch_point"]
    points.sort(key=lambda point: point.parameter)
    return [p.parameter for p in points], [p.multiplicity for p in points]


# --- a clamped column whose end slides: P = (2 pi n)^2, and (2 x)^2 with tan x = x


def column(force):
    law = rb.LinearLaw(EI1=100.0, EI2=1.0, GJ=100.0, inextensible=True)
    return rb.Scene(UNIT, law=law, end=rb.Sliding(force=-force))


def column_loads(count):
    """The first loads at which it buckles, in pairs."""

    def touching(n):
        return brentq(lambda x: math.sin(x) - x * math.cos(x), math.pi * n, math.pi * (n + 0.5), xtol=1e-14)

    return sorted(
        [(2 * math.pi * n) ** 2 for n in range(1, count)] + [(2 * touching(n)) ** 2 for n in range(1, count)]
    )


@pytest.mark.parametrize("degree", [1, 2, 5, 8])
@pytest.mark.parametrize("force", [30.0, 200.0, 890.0, 3000.0])
def test_column_far_beyond_buckling(force, degree):
    state = rb.solve(column(force), guess=rb.solve(column(0.0)), degree=degree, tol=1e-6)
    assert np.max(np.abs(state.strains[:, 1:])) < 1e-9  # it is the straight one
    assert state.index == sum(load < force for load in column_loads(20))
    assert state.stable == (force < column_loads(2)[0])


@pytest.mark.parametrize(("lower", "upper"), [(700.0, 900.0), (2900.0, 3300.0)])
def test_trace_of_a_column_that_begins_far_beyond_buckling(lower, upper):
    start = rb.solve(column(upper), guess=rb.solve(column(0.0)))
    diagram = rb.trace(column(upper), "end.force", (-upper, -lower), start=start, depth=0)
    loads = [-load for load in column_loads(20)[::-1] if lower < load < upper]
    # The special points of a trace at its tolerance of 1e-8.
    assert branch_points(diagram) == (pytest.approx(loads, rel=1e-10), [1] * len(loads))
    index = diagram.branches[0].index
    below, above = (sum(load < force for load in column_loads(20)) for force in (lower, upper))
    assert (min(index), max(index)) == (below, above)


def test_trace_of_a_column_from_no_load_to_far_beyond_buckling():
    start = rb.solve(column(0.0))
    diagram = rb.trace(column(0.0), "end.force", (-3000.0, 0.0), start=start, depth=0)
    loads = [-load for load in column_loads(20)[::-1] if load < 3000.0]
    assert branch_points(diagram) == (pytest.approx(loads, rel=1e-10), [1] * len(loads))


# --- Greenhill: an isotropic rod that is twisted and pulled, clamped, its end slides

PULL, GJ = 16000.0, 10.0
CRITICAL = 2.0 * math.sqrt(PULL) / GJ


def twisted(natural):
    law = rb.LinearLaw(EI1=1.0, EI2=1.0, GJ=GJ, inextensible=True, intrinsic=(0.0, 0.0, 0.0, natural))
    return rb.Scene(UNIT, law=law, end=rb.Sliding(force=PULL))


def greenhill(natural):
    """The number of ways in which the straight rod buckles, between two values.

    With `u1' + i u2' = a(S) exp(i M S/2 EI)` the second variation is `int EI |a'|^2 - (M^2/4 EI - T) |a|^2`,
    `a` zero at the ends: two for every `n` with `(n pi)^2 < M^2/4 - T`; that the ends stay on the axis
    takes two at most.
    """
    over = (GJ * natural) ** 2 / 4.0 - PULL
    count = int(math.sqrt(over) / math.pi) if over > 0.0 else 0
    return max(2 * count - 2, 0), 2 * count


@pytest.mark.parametrize("factor", [0.9, 1.02, 1.05, 1.2])
def test_rod_that_is_pulled_hard_and_twisted_past_greenhill(factor):
    state = rb.solve(twisted(factor * CRITICAL), guess=np.zeros(4))
    assert np.max(np.abs(state.strains)) < 1e-9
    low, high = greenhill(factor * CRITICAL)
    assert low <= state.index <= high
    assert state.stable == (high == 0)


def test_many_branch_points_in_one_step():
    """Their number is that of the change of the index, whichever the steps were."""
    diagram = rb.trace(twisted(0.0), "law.intrinsic[3]", (0.0, 1.06 * CRITICAL), depth=0)
    places, multiplicities = branch_points(diagram)
    low, high = greenhill(1.06 * CRITICAL)
    assert multiplicities == [2] * len(places)
    assert low <= 2 * len(places) <= high
    assert diagram.branches[0].index[-1] == 2 * len(places)
    # The n-th is between those of n and n + 1 half waves.
    for i, place in enumerate(places):
        loads = [(n * math.pi) ** 2 for n in (i + 1, i + 2)]
        assert loads[0] < (GJ * place) ** 2 / 4.0 - PULL < loads[1]


# --- a ring with natural curvature about its stiff axis

STIFF = np.diag([3.0, 1.0, 0.5])


def ring(natural):
    law = rb.LinearLaw(EA=500.0, EI1=3.0, EI2=1.0, GJ=0.5, intrinsic=(0.0, natural, 0.0, 0.0))
    return rb.Scene(UNIT, law=law, start=rb.Closed())


def least(natural, n):
    """The least eigenvalue of the second variation for changes of angles `theta exp(2 pi i n S)`."""
    curvature = np.array([2.0 * math.pi, 0.0, 0.0])
    moment = STIFF @ (curvature - [natural, 0.0, 0.0])

    def skew(v):
        return np.array([[0.0, -v[2], v[1]], [v[2], 0.0, -v[0]], [-v[1], v[0], 0.0]])

    rate = 2j * math.pi * n * np.eye(3) + skew(curvature)
    turning = -0.5 * rate.conj().T @ skew(moment)
    return np.linalg.eigvalsh(rate.conj().T @ STIFF @ rate + turning + turning.conj().T)[0]


THRESHOLDS = [brentq(least, 4.0, 100.0, args=(n,), xtol=1e-14) for n in range(2, 30)]


@pytest.mark.parametrize("natural", [8.0, 16.0, 24.0, 40.0])
def test_ring_of_large_natural_curvature(natural):
    state = rb.solve(ring(natural), guess=np.array([0.0, 2.0 * math.pi, 0.0, 0.0]))
    assert state.index == 2 * sum(threshold < natural for threshold in THRESHOLDS)


@pytest.mark.parametrize(("lower", "upper"), [(13.0, 19.0), (15.5, 16.5), (37.0, 43.0)])
def test_trace_of_a_ring_that_begins_far_beyond_buckling(lower, upper):
    start = rb.solve(ring(0.5 * (lower + upper)), guess=np.array([0.0, 2.0 * math.pi, 0.0, 0.0]))
    diagram = rb.trace(ring(lower), "law.intrinsic[1]", (lower, upper), start=start, depth=0)
    inside = [threshold for threshold in THRESHOLDS if lower < threshold < upper]
    assert branch_points(diagram) == (pytest.approx(inside, rel=1e-9), [2] * len(inside))


# --- a clamped strip that stretches, pressed by moving its clamp: its shape hardly tells its force


@pytest.mark.parametrize("thickness", [3e-4, 1e-4])
def test_thin_strip_pressed_by_moving_its_clamp(thickness):
    critical = 4 * math.pi**2 * thickness**2 / 12 / 100.0
    scene = rb.Scene(rb.Ribbon(10.0, 1.0, thickness), law="linear", end=rb.Clamped())
    diagram = rb.trace(scene, "end.position[2]", (10.0 * (1 - 5 * critical), 10.0))
    found, multiplicities = branch_points(diagram)
    shortening = [(1 - position / 10.0) / critical for position in found]
    # A shortening of 5e-10 is known to 1e-16 of the length, twice: 4e-7 of it.
    second = brentq(lambda x: math.tan(x) - x, math.pi, 1.499 * math.pi) ** 2 / math.pi**2
    assert shortening == pytest.approx([4.0, second, 1.0], rel=2e-6)
    assert multiplicities == [1, 1, 1]
    index = diagram.branches[0].index
    assert set(index[diagram.branches[0].parameter > 10.0 * (1 - 0.99 * critical)]) == {0}


# --- a strip whose edges grow, pressed a little: it buckles as its sections soften, before these give way


@pytest.mark.parametrize("force", [1e-6, 1e-5, 5e-5])
def test_strip_that_softens_under_a_small_force(force):
    # Euler's load of the ungrown strip is 3.3e-4.
    def excess(xi, waves):
        law = rb.SectionLaw(0.1, rb.growth.edge(xi))
        eps = brentq(lambda eps: law.gradient([eps, 0, 0, 0])[0] + force, -0.1, 0.1, xtol=1e-16)
        return law.hessian([eps, 0, 0, 0])[2, 2] * (waves / 10.0) ** 2 - force * (1 + eps)

    second = 2 * brentq(lambda x: math.tan(x) - x, math.pi, 1.499 * math.pi)
    expected = [
        brentq(excess, 0.02, 0.0454673, args=(waves,), xtol=1e-16)
        for waves in (2 * math.pi, second, 4 * math.pi)
    ]
    scene = rb.Scene(rb.Ribbon(10.0, 1.0, 0.1), rb.growth.edge(0.0), end=rb.Sliding(force=-force))
    diagram = rb.trace(scene, "growth.edge.amplitude", (0.0, 0.08), depth=0)
    found, multiplicities = branch_points(diagram)
    # Points of a trace at its tolerance of 1e-10, in a span of twice these.
    assert found[:3] == pytest.approx(expected, rel=1e-11)
    assert multiplicities[:3] == [1, 1, 1]
    assert diagram.branches[0].ended[1] == "span"
