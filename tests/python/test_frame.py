"""Centreline and directors from strains."""

import math

import mpmath as mp
import numpy as np
import pytest
import ribbonrs as rb
from hypothesis import given
from hypothesis import strategies as st
from numpy.polynomial import legendre
from refusal import refuses
from ribbonrs.frame import directors

EPS = np.finfo(float).eps
START = (0.3, -1.2, 0.7), (0.5, -0.5, 0.5, 0.5)

curvature = st.floats(-3.0, 3.0)
strain = st.tuples(st.floats(-0.2, 0.2), curvature, curvature, curvature)
quaternion = (
    st.tuples(*[st.floats(-1.0, 1.0)] * 4)
    .filter(lambda q: math.hypot(*q) > 0.1)
    .map(lambda q: np.array(q) / math.hypot(*q))
)
position = st.tuples(*[st.floats(-5.0, 5.0)] * 3).map(np.array)


def smooth(S):
    """Strains that vary along S, in no special plane."""
    return np.stack([0.1 * np.sin(S), np.cos(0.7 * S), 0.5 + 0.3 * np.sin(1.3 * S), np.sin(S) - 0.2 * S], -1)


def generator(e):
    """The 4x4 matrix A of T' = T A, for T = [[d1 d2 d3, r], [0, 1]]."""
    eps, K1, K2, K3 = e
    return np.array([[0, -K3, K2, 0], [K3, 0, -K1, 0], [-K2, K1, 0, 1 + eps], [0, 0, 0, 0]])


def collocated(strains, length, steps=40, stages=10):
    """Directors and position at S = length, by Gauss collocation of order 20 on the matrix equation."""
    nodes, _ = legendre.leggauss(stages)
    basis = legendre.legvander(nodes, stages - 1)
    unit = np.eye(stages)
    integrals = [legendre.legint(row, lbnd=-1) for row in unit]
    inner = np.stack([legendre.legval(nodes, c) for c in integrals], -1) @ np.linalg.inv(basis)
    whole = np.array([legendre.legval(1.0, c) for c in integrals]) @ np.linalg.inv(basis)
    h = length / steps / 2
    T = np.eye(4)
    for i in range(steps):
        A = np.array([generator(e) for e in strains((2 * i + 1 + nodes) * h)])
        # rows of T decouple: slope_k = row A_k + h sum_j inner[k, j] slope_j A_k
        system = np.eye(4 * stages)
        for k in range(stages):
            for j in range(stages):
                system[4 * j : 4 * j + 4, 4 * k : 4 * k + 4] -= h * inner[k, j] * A[k]
        right = np.concatenate([T @ A[k] for k in range(stages)], axis=1)
        slopes = np.linalg.solve(system.T, right.T).T.reshape(4, stages, 4)
        T = T + h * np.einsum("k,rkc->rc", whole, slopes)
    return T[:3, :3].T, T[:3, 3]


def exponential(e, length):
    """Directors and position at S = length for constant strain, to 40 digits."""
    with mp.workdps(40):
        eps, K1, K2, K3 = map(mp.mpf, e)
        A = mp.matrix([[0, -K3, K2, 0], [K3, 0, -K1, 0], [-K2, K1, 0, 1 + eps], [0, 0, 0, 0]])
        T = mp.expm(A * mp.mpf(length))
        return np.array([[float(T[j, i]) for j in range(3)] for i in range(3)]), np.array(
            [float(T[j, 3]) for j in range(3)]
        )


def product(p, q):
    """Hamilton product, written out."""
    a, b, c, d = p
    e, f, g, h = q
    return np.array(
        [
            a * e - b * f - c * g - d * h,
            a * f + b * e + c * h - d * g,
            a * g - b * h + c * e + d * f,
            a * h + b * g - c * f + d * e,
        ]
    )


@given(quaternion)
def test_directors_are_the_rotated_basis(q):
    conjugate = q * [1.0, -1.0, -1.0, -1.0]
    rotated = [product(product(q, [0.0, *axis]), conjugate)[1:] for axis in np.eye(3)]
    rows = directors(q)
    assert np.abs(rows - rotated).max() <= 4 * EPS
    assert np.abs(rows @ rows.T - np.eye(3)).max() <= 8 * EPS
    assert np.linalg.det(rows) == pytest.approx(1.0, abs=8 * EPS)


def test_directors_keep_leading_axes():
    q = np.zeros((2, 0, 5, 4))
    assert directors(q).shape == (2, 0, 5, 3, 3)


@pytest.mark.parametrize("scale", [0.0, 1e-300, 1e-12, 1e-8, 1e-5, 1e-3, 0.1, 1.0, 30.0])
@pytest.mark.parametrize("direction", [(0, 0, 1), (0, 1, 0), (1, 0, 0), (0.2, -0.7, 0.5)])
def test_constant_strain_is_exact(scale, direction):
    e = (0.05, *(scale * np.array(direction)))
    rows, r = exponential(e, 7.0)
    found, q = rb.integrate_frame([0.0, 7.0], [e])
    # the angle 7 |K| itself is rounded, and the pose turns with it
    error = EPS * (8.0 + 7.0 * np.linalg.norm(e[1:]))
    assert np.abs(directors(q[-1]) - rows).max() <= error
    assert np.abs(found[-1] - r).max() <= 7.0 * error


@given(st.lists(strain, min_size=1, max_size=6), position, quaternion)
def test_a_rigid_motion_of_the_start_moves_all(strains, p, q):
    S = np.linspace(0.0, 4.0, len(strains) + 1)
    for values in (strains, [*strains, strains[0]], smooth):
        r0, q0 = rb.integrate_frame(S, values)
        r, turned = rb.integrate_frame(S, values, p, q)
        assert np.abs(r - (p + r0 @ directors(q))).max() <= 1e-14
        assert np.abs(turned - [product(q, one) for one in q0]).max() <= 1e-14


@given(st.lists(strain, min_size=2, max_size=6))
def test_mirror_images(strains):
    S = np.linspace(0.0, 4.0, len(strains) + 1)
    r, _ = rb.integrate_frame(S, strains)
    # a mirror changes the sign of the strains that see one mirrored director
    for signs, mirror in (((1, 1, -1, -1), (-1, 1, 1)), ((1, -1, 1, -1), (1, -1, 1))):
        image, _ = rb.integrate_frame(S, np.array(strains) * signs)
        assert np.abs(image - r * mirror).max() <= 1e-14


@given(st.lists(strain, min_size=1, max_size=6), position, quaternion)
def test_there_and_back(strains, p, q):
    S = np.linspace(0.0, 4.0, len(strains) + 1)
    nodal = [*strains, strains[0]]
    for there, back in ((strains, strains[::-1]), (nodal, nodal[::-1]), (smooth, smooth)):
        r, turned = rb.integrate_frame(S, there, p, q)
        home, same = rb.integrate_frame(S[::-1], back, r[-1], turned[-1])
        assert np.abs(home - r[::-1]).max() <= 2e-14
        assert np.abs(same - turned[::-1]).max() <= 2e-14


def test_a_part_of_a_ribbon_is_a_ribbon():
    S = np.linspace(0.0, 4.0, 9)
    r, q = rb.integrate_frame(S, smooth)
    r2, q2 = rb.integrate_frame(S[3:], smooth, r[3], q[3])
    assert np.abs(r2 - r[3:]).max() <= 1e-14
    assert np.abs(q2 - q[3:]).max() <= 1e-14


def orders(strains_on, mesh):
    """Measured order of position and directors at the end, over three halvings of the mesh."""
    rows, r = collocated(smooth, 6.0)
    errors = []
    for n in (40, 80, 160, 320):
        S = mesh(n)
        found, q = rb.integrate_frame(S, strains_on(S))
        errors.append([np.abs(found[-1] - r).max(), np.abs(directors(q[-1]) - rows).max()])
    return np.log2(np.array(errors[:-1]) / errors[1:]), errors[-1]


@pytest.mark.parametrize("bend", [0.0, 0.4])
def test_measured_order_of_convergence(bend):
    def mesh(n):  # uneven where bend is not zero
        t = np.linspace(0.0, 1.0, n + 1)
        return 6.0 * (t + bend * np.sin(2 * np.pi * t) / (2 * np.pi))

    nodal, error = orders(smooth, mesh)
    assert nodal[-1].min() >= 3.9  # the coarse meshes are not there yet: 3.75, 3.87, 3.93
    assert max(error) <= 2e-8
    gauss, error = orders(lambda S: smooth, mesh)
    # the last halving comes near rounding
    assert gauss[:2].min() >= 5.95
    assert max(error) <= 1e-12
    piecewise, _ = orders(lambda S: smooth((S[1:] + S[:-1]) / 2), mesh)
    assert 1.9 <= piecewise.min() <= piecewise.max() <= 2.1  # strains at midpoints: this test can tell


def test_strains_cubic_in_S_are_followed_by_nodes_as_by_a_function():
    def cubic(S):
        return np.stack([0.01 * S, 0.1 * S**2 - 0.3, 0.2 * S**3 - S, 1.0 + 0.0 * S], -1)

    S = np.linspace(0.0, 2.0, 2001)
    nodal, _ = rb.integrate_frame(S, cubic(S))
    gauss, _ = rb.integrate_frame(S, cubic)
    assert np.abs(nodal - gauss).max() <= 1e-12


@pytest.mark.parametrize("n", [2, 3, 4])
def test_few_nodes(n):
    S = np.linspace(0.0, 0.1, n)
    nodal, _ = rb.integrate_frame(S, smooth(S))
    exact, _ = rb.integrate_frame(S, smooth)
    # linear interpolation of curvatures: error L^4/12/... in position
    assert np.abs(nodal - exact).max() <= 1e-5
    assert nodal.shape == (n, 3)


def test_a_million_segments():
    n = 1_000_000
    S = np.linspace(0.0, 1000.0, n + 1)
    e = np.array([0.02, 0.01, 0.6, 0.4])
    r, q = rb.integrate_frame(S, np.broadcast_to(e, (n, 4)))
    assert np.abs(np.linalg.norm(q, axis=1) - 1.0).max() <= 4 * EPS  # far below n * 1e-16
    rows, end = exponential(e, 1000.0)
    assert np.abs(directors(q[-1]) - rows).max() <= n * 1e-16
    assert np.abs(r[-1] - end).max() <= 1000.0 * n * 1e-16


def test_a_callable_gets_every_point_at_once_in_order():
    calls = []

    def strains(S):
        calls.append(S)
        return np.zeros((S.size, 4))

    rb.integrate_frame([0.0, 1.0, 3.0], strains)
    assert len(calls) == 1
    assert calls[0].shape == (6,)
    assert np.all(np.diff(calls[0]) > 0.0)
    assert calls[0].sum() == pytest.approx(3 * 0.5 + 3 * 2.0)


def test_positive_twist_is_right_handed():
    S = np.linspace(0.0, 10.0, 4001)
    for sign in (1.0, -1.0):
        r, _ = rb.integrate_frame(S, lambda s, K3=sign * 0.3: np.tile([0.0, 0.0, 0.5, K3], (s.size, 1)))
        first, second, third = (np.diff(r, k, axis=0)[:3000] for k in (1, 2, 3))
        assert np.all(sign * np.einsum("ij,ij->i", np.cross(first, second), third) > 0.0)


@pytest.mark.parametrize(
    ("field", "arguments"),
    [
        ("S.shape", ([0.0], [[0.0] * 4])),
        ("S.shape", (1.0, [[0.0] * 4])),
        ("S.shape", ([[0.0, 1.0]], [[0.0] * 4])),
        ("S", ([0.0, 0.0], [[0.0] * 4])),
        ("S", ([0.0, 2.0, 1.0], [[0.0] * 4] * 2)),
        ("S", ("ab", [[0.0] * 4])),
        ("S", ([0.0, 1j], [[0.0] * 4])),
        ("S", ([[0.0], [1.0, 2.0]], [[0.0] * 4])),
        ("S", ([False, True], [[0.0] * 4])),
        ("S", (None, [[0.0] * 4])),
        ("S[1]", ([0.0, math.nan], [[0.0] * 4])),
        ("S[1]", ([0.0, math.inf], [[0.0] * 4])),
        ("strains.shape", ([0.0, 1.0], [0.0] * 4)),
        ("strains.shape", ([0.0, 1.0], [[0.0] * 3])),
        ("strains.shape", ([0.0, 1.0], [[0.0] * 4] * 3)),
        ("strains[0, 2]", ([0.0, 1.0], [[0.0, 0.0, math.nan, 0.0]])),
        ("strains", ([0.0, 1.0], [["0", "0", "0", "0"]])),
        ("strains", ([0.0, 1.0], None)),
        ("strains(S).shape", ([0.0, 1.0], lambda S: [0.0] * 4)),
        ("strains(S)", ([0.0, 1.0], lambda S: None)),
        ("strains(S)[1, 3]", ([0.0, 1.0], lambda S: [[0.0] * 4, [0.0, 0.0, 0.0, math.inf], [0.0] * 4])),
        ("position.shape", ([0.0, 1.0], [[0.0] * 4], [0.0] * 4)),
        ("position[2]", ([0.0, 1.0], [[0.0] * 4], [0.0, 0.0, math.nan])),
        ("quaternion.shape", ([0.0, 1.0], [[0.0] * 4], [0.0] * 3, [1.0, 0.0, 0.0])),
        ("|quaternion|", ([0.0, 1.0], [[0.0] * 4], [0.0] * 3, [1.0, 0.1, 0.0, 0.0])),
        ("|quaternion|", ([0.0, 1.0], [[0.0] * 4], [0.0] * 3, [0.0, 0.0, 0.0, 0.0])),
    ],
)
def test_refusals(field, arguments):
    refuses(field, lambda: rb.integrate_frame(*arguments))


@pytest.mark.parametrize("bad", [1.0, [1.0, 0.0, 0.0], [[1.0, 0.0, 0.0]]])
def test_directors_refuse_what_is_not_quaternions(bad):
    refuses("quaternion.shape", lambda: directors(bad))
