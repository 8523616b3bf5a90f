"""The quaternion of the directors, (5) and (65)-(67), and the program's directors and poses."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ..arrays import Array
from ..frame import directors, integrate_frame
from .row import PAPER, Row, farthest

__all__ = ["rows"]


def rows() -> Iterator[Row]:
    """Yield the identities at random quaternions, strains and rates."""
    rng = np.random.default_rng(65)
    q = rng.normal(size=(50, 4))
    q /= np.linalg.norm(q, axis=1, keepdims=True)
    K, eps = rng.uniform(-1.0, 1.0, (50, 3)), rng.uniform(-0.1, 0.1, 50)
    Q = _matrix(q)
    source = f"{PAPER}, (65)"
    products = Q @ np.swapaxes(Q, 1, 2)
    yield Row("Q Q^T = I", source, *farthest(np.eye(3), products), 5e-15)
    yield Row("det Q", source, *farthest(1.0, np.linalg.det(Q)), 5e-15)
    yield Row("the program's directors", source, *farthest(Q, directors(q)), 5e-15)
    tangents = _tangent(q, eps)
    own = (1.0 + eps)[:, None] * directors(q)[:, 2]
    yield Row("r' = (1 + eps) d3", f"{PAPER}, (66)", *farthest(tangents, own), 5e-15)

    rates = _rates(q, K)
    source = f"{PAPER}, (67)"
    yield Row("q . q' = 0", source, *farthest(0.0, np.sum(q * rates, axis=1)), 2e-16)
    # Q is quadratic in q: Q' is the polarised form, exactly
    turned = (_matrix(q + rates) - _matrix(q - rates)) / 2.0
    omega = np.einsum("ni,nij->nj", K, Q)
    crossed = np.cross(omega[:, None, :], Q)
    yield Row("d_i' = omega x d_i", f"{PAPER}, (5), (67)", *farthest(crossed, turned), 5e-15)
    product = _hamilton(q, np.hstack([np.zeros((50, 1)), K])) / 2.0
    yield Row("q' = q (0, K)/2", source, *farthest(product, rates), 5e-16)

    S = np.linspace(0.0, 10.0, 11)
    strain = np.array([0.05, 0.2, 0.7, 0.4])
    position, _ = integrate_frame(S, np.tile(strain, (10, 1)))
    told = "rounding of sums over 10 segments"
    yield Row("the program's helix", "closed form", *farthest(_helix(S, strain), position), 2e-14, told)


def _matrix(q: Array) -> Array:
    """Q (n, 3, 3) of (65)."""
    q0, q1, q2, q3 = q.T
    half = 0.5 * np.ones(len(q))
    rows = [
        [q0**2 + q1**2 - half, q1 * q2 + q0 * q3, q1 * q3 - q0 * q2],
        [q1 * q2 - q0 * q3, q0**2 + q2**2 - half, q2 * q3 + q0 * q1],
        [q1 * q3 + q0 * q2, q2 * q3 - q0 * q1, q0**2 + q3**2 - half],
    ]
    return 2.0 * np.moveaxis(np.array(rows), 2, 0)


def _tangent(q: Array, eps: Array) -> Array:
    """Derivatives r' (n, 3) of (66)."""
    q0, q1, q2, q3 = q.T
    rows = [q1 * q3 + q0 * q2, q2 * q3 - q0 * q1, q0**2 + q3**2 - 0.5]
    return np.stack([2.0 * (1.0 + eps) * row for row in rows], axis=1)


def _rates(q: Array, K: Array) -> Array:
    """Derivatives q' (n, 4) of (67)."""
    (q0, q1, q2, q3), (k1, k2, k3) = q.T, K.T
    rows = [
        -q1 * k1 - q2 * k2 - q3 * k3,
        q0 * k1 - q3 * k2 + q2 * k3,
        q3 * k1 + q0 * k2 - q1 * k3,
        -q2 * k1 + q1 * k2 + q0 * k3,
    ]
    return np.stack(rows, axis=1) / 2.0


def _hamilton(p: Array, q: Array) -> Array:
    """Products (n, 4) of quaternions, scalar first."""
    a, u, b, v = p[:, :1], p[:, 1:], q[:, :1], q[:, 1:]
    return np.hstack([a * b - np.sum(u * v, axis=1, keepdims=True), a * v + b * u + np.cross(u, v)])


def _helix(S: Array, strain: Array) -> Array:
    """Points (n, 3) of a centreline of constant strain, whose tangent turns about omega, from the origin."""
    rate = float(np.linalg.norm(strain[1:]))
    axis = strain[1:] / rate
    tangent = np.array([0.0, 0.0, 1.0 + strain[0]])
    along = (tangent @ axis) * axis
    across, side = tangent - along, np.cross(axis, tangent)
    angle = rate * S
    circle = np.outer(np.sin(angle), across) + np.outer(1.0 - np.cos(angle), side)
    points: Array = np.outer(S, along) + circle / rate
    return points
