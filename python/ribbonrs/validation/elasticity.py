"""From incompressible Mooney-Rivlin elasticity to the plane stress of the shell, (8)-(10) and (20)-(24).

At strains of order eta^2 of the form (18), e22, e23, e33 random and e11 from det C = 1.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from ..arrays import Array
from ..material import MooneyRivlin
from .row import PAPER, Row

__all__ = ["rows"]

C1, C2 = 0.7, 0.4
FINE = 2.0**-4
"""Ratio eta at which orders are measured: remainders of order 6 are 1e-9, far above rounding."""
ORDER = 0.05
"""The next term is of relative size eta^2 times a few."""
MEASURED = "the next power of eta^2"


def rows() -> Iterator[Row]:
    """Yield the modulus and the orders of what is left out."""
    source = f"{PAPER}, (23)"
    yield Row("Y_e/(c1 + c2)", source, 6.0, _modulus() / (C1 + C2), 1e-9, "differences of step 1e-3, order 4")
    yield Row("Y_e of rb.MooneyRivlin", source, 6.0 * (C1 + C2), MooneyRivlin(C1, C2).Y, 1e-15)
    left_outs: tuple[tuple[str, str, float, Callable[[Array], Array | float]], ...] = (
        ("det C - 1", "(20)", 6.0, lambda e: _determinant(e) - _expanded(e)),
        ("e11", "(21)", 4.0, lambda e: float(np.trace(e))),
        ("p", "(22)", 3.0, lambda e: _pressure(e) - 2.0 * C1 - 4.0 * C2 - 4.0 * (C1 + C2) * float(e[0, 0])),
        ("stress", "(23)", 3.0, lambda e: _stress(e)[1:, 1:] - _weak_stress(e)),
        ("Psi", "(24)", 5.0, lambda e: _density(e) - _weak_density(e)),
    )
    for name, equation, claimed, left_out in left_outs:
        order = _order(left_out)
        told = f"order of what {name} leaves out"
        yield Row(told, f"{PAPER}, {equation}", claimed, order, ORDER, MEASURED, bound=">=")
    e = _strain(FINE, 0)
    latin, greek = (
        float(np.trace(4.0 * (C1 + C2) * (e[1:, 1:] + total * np.eye(2))))
        for total in (np.trace(e), np.trace(e[1:, 1:]))
    )
    wrong = "The sum e_kk of (23) is over Greek indices, e22 + e33: over 1, 2, 3 it vanishes by (21)."
    exact = float(np.trace(_stress(e)[1:, 1:]))
    name = "sigma22 + sigma33 at eta = 1/16"
    yield Row(name, f"{PAPER}, (23)", latin, exact, 100.0 * FINE**4, "terms of eta^4", wrong, greek)


def _strain(eta: float, seed: int) -> Array:
    """E of the form (18) that keeps the volume."""
    e22, e23, e33 = np.random.default_rng(seed).uniform(0.3, 1.0, 3) * eta**2
    e11 = (1.0 / ((1.0 + 2.0 * e22) * (1.0 + 2.0 * e33) - 4.0 * e23**2) - 1.0) / 2.0
    return np.array([[e11, 0.0, 0.0], [0.0, e22, e23], [0.0, e23, e33]])


def _order(left_out: Callable[[Array], Array | float]) -> float:
    """The order in eta of the largest of several remainders."""
    sizes = [
        max(float(np.max(np.abs(left_out(_strain(eta, seed))))) for seed in range(5))
        for eta in (FINE, FINE / 2.0)
    ]
    return float(np.log2(sizes[0] / sizes[1]))


def _determinant(e: Array) -> float:
    """Det C - 1, which is 0 but for e11: what e11 is does not matter to (20)."""
    return float(np.linalg.det(np.eye(3) + 2.0 * _compressed(e)) - 1.0)


def _compressed(e: Array) -> Array:
    return e - np.diag([2.0 * e[0, 0], 0.0, 0.0])


def _expanded(e: Array) -> float:
    e = _compressed(e)
    minors = e[2, 2] * e[0, 0] + e[1, 1] * e[0, 0] + e[2, 2] * e[1, 1] - e[1, 2] ** 2
    return float(2.0 * np.trace(e) + 4.0 * minors)


def _invariants(e: Array) -> tuple[Array, float, float]:
    """C and I1, I2 of (9)."""
    C = np.eye(3) + 2.0 * e
    I1 = float(np.trace(C))
    return C, I1, (I1**2 - float(np.trace(C @ C))) / 2.0


def _density(e: Array) -> float:
    """Psi of (8)."""
    _, I1, I2 = _invariants(e)
    return C1 * (I1 - 3.0) + C2 * (I2 - 3.0)


def _pressure(e: Array) -> float:
    """P of S11 = 0."""
    C, I1, _ = _invariants(e)
    return float(C[0, 0] * (2.0 * (C1 + C2 * I1) - 2.0 * C2 * C[0, 0]))


def _stress(e: Array) -> Array:
    """S of (10), the pressure being that of S11 = 0."""
    C, I1, _ = _invariants(e)
    stress: Array = 2.0 * (C1 + C2 * I1) * np.eye(3) - 2.0 * C2 * C - _pressure(e) * np.linalg.inv(C)
    return stress


def _weak_stress(e: Array) -> Array:
    """The stresses of (23), (2, 2)."""
    plane = e[1:, 1:]
    stress: Array = 4.0 * (C1 + C2) * (plane + np.trace(plane) * np.eye(2))
    return stress


def _weak_density(e: Array) -> float:
    return float(4.0 * (C1 + C2) * (e[2, 2] ** 2 + e[1, 1] ** 2 + e[1, 2] ** 2 + e[2, 2] * e[1, 1]))


def _modulus() -> float:
    """Second derivative at 1 of the energy of a bar that is stretched, by differences of order 4."""

    def energy(stretch: float) -> float:
        e = np.diag([1.0 / stretch, 1.0 / stretch, stretch**2]) / 2.0 - np.eye(3) / 2.0
        return _density(e)

    h = 1e-3
    weights = {-2: -1.0, -1: 16.0, 0: -30.0, 1: 16.0, 2: -1.0}
    return sum(weight * energy(1.0 + k * h) for k, weight in weights.items()) / (12.0 * h**2)
