"""The strains (12)-(14), (72)-(77) against exact kinematics at points of the ribbon.

Displacements, their derivatives and the growth take random values of the sizes that the paper assumes,
powers of eta = h/a: u1 ~ eta, U2, U3, eps, K1, g22 ... ~ eta^2, and so on, in units of a. Derivatives by X1
gain a power, for X1 ~ eta. The order of a remainder is the base-2 logarithm of what halving eta divides it
by.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import Array
from .row import PAPER, Row, farthest

__all__ = ["COMPONENTS", "Point", "exact", "order_row", "orders", "rows", "weak"]

FINE = 2.0**-8
"""Ratio eta at which orders are measured: remainders of order 4 are 1e-10, far above rounding."""
ORDER = 0.02
"""By how much a measured order differs from the limit: the next term is a few times eta."""
MEASURED = "the next power of eta"

SIZES: dict[str, ArrayLike] = {
    "X": [1, 0],
    "U": [1, 2, 2],
    "U_1": [2, 1, 1],
    "U_2": [1, 2, 2],
    "U_3": [1, 2, 2],
    "zeta": [3, 3, 3],
    "eps": [2],
    "K": [2, 1, 1],
    "g": [[2, 3, 3], [1, 2, 2], [1, 2, 2]],
}
"""Powers of eta: X1 and X2; U and its derivatives by X1, X2, X3; the part zeta of U1 and its derivatives by
X2 and X3; strains; growth, rows g1j, g2j, g3j."""


class Point(NamedTuple):
    """What the deformation gradient depends on at a point."""

    X: Array
    U: Array
    U_1: Array
    U_2: Array
    U_3: Array
    zeta: Array
    eps: Array
    K: Array
    g: Array


def _point(seed: int, eta: float) -> Point:
    """The same random numbers for every eta, times their powers of it."""
    rng = np.random.default_rng(seed)
    powers = (np.array(n, dtype=float) for n in SIZES.values())
    return Point(*(rng.uniform(0.3, 1.0, n.shape) * eta**n for n in powers))


def _gradient(p: Point) -> Array:
    """F of (12) on the directors."""
    (X1, X2), (U1, U2, U3), (k1, k2, k3) = p.X, p.U, p.K
    last = [U3 * k2 - (X2 + U2) * k3, -U3 * k1 + (X1 + U1) * k3, (X2 + U2) * k1 - (X1 + U1) * k2]
    stretch = np.array([0.0, 0.0, p.eps[0]])
    F: Array = np.eye(3) + np.stack([p.U_1, p.U_2, p.U_3 + last + stretch], axis=1)
    return F


def _green(A: Array) -> Array:
    """The strain (A^T A - I)/2."""
    strain: Array = (A.T @ A - np.eye(3)) / 2.0
    return strain


def exact(p: Point) -> Array:
    """The strain of F G^-1."""
    return _green(_gradient(p) @ np.linalg.inv(np.eye(3) + p.g))


def _short(p: Point) -> Array:
    """The strain of F (I - g)."""
    return _green(_gradient(p) @ (np.eye(3) - p.g))


def weak(p: Point) -> Array:
    """The strains (14)."""
    (X1, X2), (k1, k2, k3), g = p.X, p.K, p.g
    zeta1, U21, U31 = p.U_1
    _, U22, U32 = p.U_2
    _, U23, U33 = p.U_3
    u1, u12, u13 = np.array([p.U[0], p.U_2[0], p.U_3[0]]) - p.zeta
    g21, g31 = g[1, 0], g[2, 0]
    E11 = (U31**2 + U21**2 + g31**2 + g21**2) / 2.0 + zeta1
    E11 += g31 * (k3 * X2 - u13 - U31) - g21 * (u12 + U21) - g[0, 0]
    E12 = (U21 + u12 - g21) / 2.0
    E13 = (U31 + u13 - k3 * X2 - g31) / 2.0
    E22 = U22 + u12**2 / 2.0 - g[1, 1]
    E23 = (U23 + U32 + u12 * u13 + k3 * (X1 + u1 - X2 * u12) - g[1, 2] - g[2, 1]) / 2.0
    E33 = p.eps[0] + k1 * X2 - k2 * (X1 + u1) + (u13 - k3 * X2) ** 2 / 2.0 + U33 - g[2, 2]
    return np.array([[E11, E12, E13], [E12, E22, E23], [E13, E23, E33]])


def _printed_full(p: Point) -> Array:
    """The strains (72)-(77)."""
    (X1, X2), (U1, U2, U3), (k1, k2, k3), g = p.X, p.U, p.K, p.g
    zeta1, U21, U31 = p.U_1
    u12, U22, U32 = p.U_2
    # the brackets that recur in each of them
    t1 = p.U_3[0] + k2 * U3 - k3 * (U2 + X2)
    t2 = k3 * (U1 + X1) + p.U_3[1] - k1 * U3
    t3 = -k2 * (U1 + X1) + p.U_3[2] + k1 * (U2 + X2) + p.eps[0] + 1.0
    (g11, g12, g13), (g21, g22, g23), (g31, g32, g33) = g
    E11 = (g31 * t1 + g21 * u12 + (g11 - 1.0) * (zeta1 + 1.0)) ** 2
    E11 += (g31 * t2 + g21 * (U22 + 1.0) + (g11 - 1.0) * U21) ** 2
    E11 += (g31 * t3 + g21 * U32 + (g11 - 1.0) * U31) ** 2 - 1.0
    E12 = (-g31 * t2 - g21 * (U22 + 1.0) - (g11 - 1.0) * U21) * (
        -g32 * t2 + (1.0 - g22) * (1.0 + U22) - g12 * U21
    )
    E12 += (-g31 * t3 - g21 * U32 + (1.0 - g11) * U31) * (-g32 * t3 + (1.0 - g22) * U32 - g12 * U31)
    E12 += (-g31 * t1 - g21 * u12 + (1.0 - g11) * (1.0 + zeta1)) * (
        -g32 * t1 + (1.0 - g22) * u12 - g12 * (1.0 + zeta1)
    )
    E22 = (g32 * t1 + (g22 - 1.0) * u12 + g12 * (zeta1 + 1.0)) ** 2
    E22 += (g32 * t2 + (g22 - 1.0) * (U22 + 1.0) + g12 * U21) ** 2
    E22 += (g32 * t3 + (g22 - 1.0) * U32 + g12 * U31) ** 2 - 1.0
    E13 = (-g31 * t2 - g21 * (1.0 + U22) + (1.0 - g11) * U21) * (
        (1.0 - g33) * t2 - g23 * (1.0 + U22) - g13 * U21
    )
    E13 += (-g31 * t3 - g21 * U32 + (1.0 - g11) * U31) * ((1.0 - g33) * t3 - g23 * U32 - g13 * U31)
    E13 += (-g31 * t1 - g21 * u12 + (1.0 - g11) * (1.0 + zeta1)) * (
        (1.0 - g33) * t1 - g23 * u12 - g13 * (1.0 + zeta1)
    )
    E23 = (-g32 * t2 + (1.0 - g22) * (1.0 + U22) - g12 * U21) * (
        (1.0 - g33) * t2 - g23 * (1.0 + U22) - g13 * U21
    )
    E23 += (-g32 * t3 + (1.0 - g22) * U32 - g12 * U31) * ((1.0 - g33) * t3 - g23 * U32 - g13 * U31)
    E23 += (-g32 * t1 + (1.0 - g22) * u12 - g12 * (1.0 + zeta1)) * (
        (1.0 - g33) * t1 - g23 * u12 - g13 * (1.0 + zeta1)
    )
    E33 = ((g33 - 1.0) * t1 + g23 * u12 + g13 * (zeta1 + 1.0)) ** 2
    E33 += ((g33 - 1.0) * t2 + g23 * (U22 + 1.0) + g13 * U21) ** 2
    E33 += ((g33 - 1.0) * t3 + g23 * U32 + g13 * U31) ** 2 - 1.0
    return np.array([[E11, E12, E13], [E12, E22, E23], [E13, E23, E33]]) / 2.0


COMPONENTS = {"11": (0, 0), "12": (0, 1), "13": (0, 2), "22": (1, 1), "23": (1, 2), "33": (2, 2)}
FULL = {"11": 72, "12": 73, "22": 74, "13": 75, "23": 76, "33": 77}
"""Equation numbers of the strains of the appendix."""


def rows() -> Iterator[Row]:
    """Yield the identities and the orders of what is left out."""
    points = [_point(seed, 1.0) for seed in range(20)]
    moved = farthest([_by_cross_products(p) for p in points], [_gradient(p) for p in points])
    yield Row("F from the moving frame", f"{PAPER}, (11)-(12)", *moved, 2e-15)
    full = np.array([_printed_full(p) for p in points])
    short = np.array([_short(p) for p in points])
    for name, (i, j) in COMPONENTS.items():
        source = f"{PAPER}, ({FULL[name]})"
        yield Row(f"E{name} of F (I - g)", source, *farthest(full[:, i, j], short[:, i, j]), 1e-14)

    measured = orders(lambda eta, seed: _inverse_left_out(_point(seed, eta)))
    yield order_row("order of G^-1 - (I - g)", "(13)", 3.0, float(np.min(measured)))
    measured = orders(lambda eta, seed: exact(_point(seed, eta)) - _short(_point(seed, eta)))
    yield order_row("order in E of G^-1 - (I - g)", "(13)", 3.0, float(np.min(measured)))
    measured = orders(lambda eta, seed: exact(_point(seed, eta)) - weak(_point(seed, eta)))
    for name, (i, j) in COMPONENTS.items():
        yield order_row(f"order of what E{name} leaves out", "(14)", 3.0, float(measured[i, j]))


def _inverse_left_out(p: Point) -> Array:
    left_out: Array = np.linalg.inv(np.eye(3) + p.g) - (np.eye(3) - p.g)
    return left_out


def order_row(name: str, equation: str, claimed: float, measured: float) -> Row:
    """Return a row that holds an order to be at least what is claimed."""
    return Row(name, f"{PAPER}, {equation}", claimed, measured, ORDER, MEASURED, bound=">=")


def orders(left_out: Callable[[float, int], Array]) -> Array:
    """Return the orders, by components, of the largest of several points of a remainder of (eta, seed)."""
    largest = [np.max([np.abs(left_out(eta, seed)) for seed in range(5)], axis=0) for eta in (FINE, FINE / 2)]
    measured: Array = np.log2(largest[0] / largest[1])
    return measured


def _by_cross_products(p: Point) -> Array:
    """F of (11): d chi/dX_i, with d_i' = omega x d_i (5) and r' = (1 + eps) d3."""
    place = np.array([*p.X, 0.0]) + p.U
    along = np.array([0.0, 0.0, 1.0 + p.eps[0]]) + p.U_3 + np.cross(p.K, place)
    return np.stack([np.eye(3)[0] + p.U_1, np.eye(3)[1] + p.U_2, along], axis=1)
