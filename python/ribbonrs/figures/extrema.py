"""Where the energy of edge growth is stationary in (K2, K3), under either reading of the axial strain.

The paper's figures of the energy do not say what becomes of eps. Its numbers follow with the length held,
eps = 0; its eq. (64) with the ends free of force, n3 = 0, where eps = xi/3 - K3^2/24 relaxes.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..arrays import Array
from ..growth import edge
from ..law import SectionLaw
from .style import INK

__all__ = ["CONDITIONS", "KINDS", "MARKS", "Extremum", "Plane"]

CONDITIONS = {"eps0": r"$\varepsilon = 0$", "n30": "$n_3 = 0$"}
"""The two readings, and how figures name them."""

KINDS = ("minimum", "saddle", "maximum")
"""By the number of negative eigenvalues of the Hessian in (K2, K3)."""

MARKS: dict[str, dict[str, Any]] = {
    "minimum": {"marker": "o", "markersize": 5.5, "color": INK, "markeredgecolor": "white"},
    "saddle": {"marker": "D", "markersize": 4.0, "color": "white", "markeredgecolor": INK},
    "maximum": {"marker": "^", "markersize": 5.0, "color": "white", "markeredgecolor": INK},
}
"""What marks each kind in figures."""

STARTS = 9
"""Newton starts in either direction."""

STEPS = 60

# Of the size of the curvatures: roots that are closer are one.
SAME = 1e-7


@dataclass(frozen=True)
class Extremum:
    """A stationary point: curvatures, energy and which of `KINDS` it is."""

    K2: float
    K3: float
    energy: float
    kind: str


class Plane:
    """The energy over (K2, K3) at K1 = 0, for edge growth.

    Parameters
    ----------
    eta, xi : float
        Thickness over width, edge growth.
    condition : str
        One of `CONDITIONS`.
    law : str
        "full", or "quadratic", eq. (59).
    """

    def __init__(self, eta: float, xi: float, condition: str, law: str = "full") -> None:
        self.law = SectionLaw(eta, edge(xi), law=law)
        self.eta, self.xi, self.condition = eta, xi, condition

    def of(self, law: str) -> Plane:
        """Return the same of another law."""
        return Plane(self.eta, self.xi, self.condition, law)

    @property
    def reach(self) -> float:
        """Within which curvatures of stationary points stay: that of the isometric surface, sqrt(8 |xi|)."""
        return math.sqrt(8.0 * abs(self.xi)) or self.eta

    def strains(self, K2: Array | float, K3: Array | float) -> Array:
        """Return eps, K1, K2, K3, array (..., 4)."""
        K2, K3 = np.broadcast_arrays(K2, K3)
        eps = self.xi / 3.0 - K3**2 / 24.0 if self.condition == "n30" else np.zeros(K3.shape)
        return np.stack([eps, np.zeros(K3.shape), K2, K3], axis=-1)

    def energy(self, K2: Array | float, K3: Array | float) -> Array:
        """Return Pi, array (...)."""
        return self.law.energy(self.strains(K2, K3))

    def slope(self, K2: Array | float, K3: Array | float) -> Array:
        """Return its derivatives by K2 and K3, array (..., 2); n3 = 0 leaves none through eps."""
        return self.law.gradient(self.strains(K2, K3))[..., 2:]

    def stiffness(self, K2: Array | float, K3: Array | float) -> Array:
        """Return its Hessian, array (..., 2, 2), less what the relaxing eps takes away."""
        whole = self.law.hessian(self.strains(K2, K3))
        stiff, coupled = whole[..., 2:, 2:], whole[..., 0, 2:]
        if self.condition == "n30":
            stiff = stiff - coupled[..., :, None] * coupled[..., None, :] / whole[..., :1, :1]
        return stiff

    def extrema(self, *, straight: bool = False) -> list[Extremum]:
        """Return the stationary points by K2, then K3; only those with K2 = 0 if `straight`.

        Newton's method from a grid, which stays on the line K2 = 0 by symmetry. That it misses none is
        tested at n3 = 0 against the natural shapes, which are complete, and at eps = 0 against closed forms.
        """
        reach = self.reach
        line = np.linspace(-reach, reach, STARTS)
        K2, K3 = (grid.ravel() for grid in np.meshgrid(0.0 if straight else line, line))
        with np.errstate(all="ignore"):  # starts that diverge are dropped
            for _ in range(STEPS):
                step = _solved(self.stiffness(K2, K3), self.slope(K2, K3))
                inside = np.all(np.isfinite(step), axis=-1) & (np.hypot(*step.T) <= 4.0 * reach)
                K2, K3, step = K2[inside] - step[inside, 0], K3[inside] - step[inside, 1], step[inside]
        small = np.hypot(*step.T) <= 1e-3 * SAME * reach
        found: list[Extremum] = []
        for k2, k3 in sorted(zip(K2[small].tolist(), K3[small].tolist(), strict=True)):
            k2, k3 = (0.0 if abs(k) <= SAME * reach else k for k in (k2, k3))
            if all(np.hypot(k2 - other.K2, k3 - other.K3) > SAME * reach for other in found):
                index = int(np.sum(np.linalg.eigvalsh(self.stiffness(k2, k3)) < 0.0))
                found.append(Extremum(k2, k3, float(self.energy(k2, k3)), KINDS[index]))
        return sorted(found, key=lambda one: (one.K2, one.K3))


def _solved(matrices: Array, vectors: Array) -> Array:
    """Solutions of 2 x 2 systems, infinite or NaN where singular."""
    (a, b), (c, d) = np.moveaxis(matrices, 0, -1)
    x, y = vectors.T
    return np.asarray(np.stack([d * x - b * y, a * y - c * x], axis=-1) / (a * d - b * c)[:, None])
