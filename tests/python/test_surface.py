"""The body of the ribbon: Liu, Li & Liu, eqs. (11) and (15)."""

import math

import numpy as np
import pytest
import ribbonrs as rb
from refusal import NOT_FINITE, NOT_NUMBERS, refuses

LEAF = rb.Ribbon(length=10.0, width=1.0, thickness=0.1)
HELICAL = rb.growth.edge(0.06) + rb.growth.chiral(0.04)


def solved(growth, ribbon=LEAF, **clamp):
    return rb.solve(rb.Scene(ribbon, growth, start=rb.Clamped(**clamp)), n=21)


def test_an_ungrown_ribbon_is_a_rectangle():
    ribbon = rb.Ribbon(length=6.0, width=2.0, thickness=0.1)
    state = solved(rb.growth.edge(0.0), ribbon)
    for face in (-1.0, 0.0, 0.5, 1.0):
        points = state.surface(nx=5, face=face)
        assert points.shape == (21, 5, 3)
        expected = np.zeros((21, 5, 3))
        expected[..., 0] = face * 0.025
        expected[..., 1] = np.linspace(-0.5, 0.5, 5)
        expected[..., 2] = np.linspace(0.0, 3.0, 21)[:, None]
        assert np.abs(points - expected).max() <= 1e-15


@pytest.mark.parametrize("face", [-1.0, 0.0, 0.3, 1.0])
def test_the_formula_point_by_point(face):
    growth = HELICAL + rb.growth.Profile(g21=[0.01, 0.05, 0.02], g31=[-0.02, 0.03, 0.04], gamma23=[0.0, 0.02])
    state = solved(growth)
    points = state.surface(nx=7, face=face)
    X1 = face * 0.05
    for j, x in enumerate(np.linspace(-0.5, 0.5, 7)):
        g21 = 0.01 + 0.05 * x + 0.02 * x * x
        g31 = -0.02 + 0.03 * x + 0.04 * x * x
        slope = state.deflection(x, derivative=1)
        u = state.displacements(x)
        for i, K3 in enumerate(state.strains[:, 3]):
            d1, d2, d3 = state.directors[i]
            U2 = u[i, 1] - X1 * (slope[i] - g21)
            U3 = u[i, 2] - X1 * (-K3 * x - g31)
            expected = state.position[i] + U3 * d3 + (x + U2) * d2 + (X1 + u[i, 0]) * d1
            assert np.abs(points[i, j] - expected).max() <= 1e-14


def test_layers_are_straight_lines_through_the_thickness():
    state = solved(HELICAL)
    low, middle, high = (state.surface(face=face) for face in (-1, 0, 1))
    assert np.abs(low + high - 2 * middle).max() <= 1e-14
    # a fibre of length h, turned by the slopes of u1 and by twist: longer by their squares
    length = np.linalg.norm(high - low, axis=-1)
    assert length.min() >= 0.1 - 1e-15
    assert length.max() <= 0.1 * (1.0 + 0.5 * (0.15**2 + 0.12**2))


def test_fibres_stay_normal_to_the_mid_surface():
    """Kirchhoff's hypothesis, to the order of the theory: shear strain falls like eta^3."""
    shear = []
    for eta in (0.08, 0.04, 0.02):
        leaf = rb.Ribbon(length=3.0, width=1.0, thickness=eta)
        state = solved(rb.growth.edge(6 * eta**2) + rb.growth.chiral(0.4 * eta), leaf)
        step = 1e-3
        S = np.array([1.0 - step, 1.0, 1.0 + step])
        middle = state.surface(nx=2001, S=S)
        fibre = (state.surface(nx=2001, S=S, face=1) - middle)[1] / (eta / 2)
        along = (middle[2] - middle[0]) / (2 * step)
        across = np.gradient(middle[1], 1 / 2000, axis=0, edge_order=2)
        shear.append([np.abs((fibre * tangent).sum(-1)).max() for tangent in (along, across)])
    shear = np.array(shear)
    assert np.log2(shear[:-1] / shear[1:]).min() >= 2.8
    assert shear[0].max() <= 5 * 0.08**3


def test_the_centreline_is_the_mean_of_the_section():
    """Eq. (3): U1, U2, U3 of the mid-surface have no mean."""
    state = solved(HELICAL + rb.growth.Profile(gamma23=[0.01, 0.02], gamma22=[0.0, 0.03]))
    points = state.surface(nx=2001)
    weights = np.full(2001, 1 / 2000)
    weights[[0, -1]] /= 2
    mean = np.einsum("j,ijc->ic", weights, points)
    assert np.abs(mean - state.position).max() <= 1e-7  # trapezoidal rule


def test_a_rigid_motion_of_the_clamp_moves_the_body():
    q = np.array([0.1, 0.7, -0.5, 0.5]) / math.sqrt(1.0)
    q /= np.linalg.norm(q)
    still, moved = solved(HELICAL), solved(HELICAL, position=(1.0, -2.0, 0.5), rotation=tuple(q))
    rows = moved.directors[0]
    for face in (0, 1):
        expected = still.surface(face=face) @ rows + [1.0, -2.0, 0.5]
        assert np.abs(moved.surface(face=face) - expected).max() <= 1e-14


def test_other_stations():
    state = solved(HELICAL)
    S = np.array([0.0, 0.123, 9.0])
    assert np.abs(state.surface(nx=3, S=S)[1] - state.surface(nx=3, S=[0.123])[0]).max() == 0.0
    assert np.array_equal(state.surface(S=state.S), state.surface())


@pytest.mark.parametrize("bad", [1, 0, -3, 2.0, "41", None, True, math.nan])
def test_nx_refused(bad):
    refuses("nx", lambda: solved(HELICAL).surface(nx=bad))


@pytest.mark.parametrize("bad", [1.01, -2, *NOT_FINITE, *NOT_NUMBERS])
def test_face_refused(bad):
    refuses("face", lambda: solved(HELICAL).surface(face=bad))


@pytest.mark.parametrize(
    ("field", "bad"),
    [
        ("S", [0.0, 10.1]),
        ("S", [-0.1]),
        ("S[0]", [math.nan]),
        ("S.shape", 1.0),
        ("S.shape", [[1.0]]),
        ("S", "a"),
    ],
)
def test_stations_refused(field, bad):
    refuses(field, lambda: solved(HELICAL).surface(S=bad))
