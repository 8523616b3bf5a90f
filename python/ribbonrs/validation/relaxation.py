"""The relaxed section by least squares, an independent check of the law.

At strains (eps, K1, K2, K3) an incompressible section takes the deflection U that minimises

    Pi = 1/2 int m^2 dx + (eta^2/18) int [(b22 + b33/2)^2 + (3/4) b33^2 + b23^2] dx,
    m = eps + K1 x - K2 U + K3^2 x^2/2 - gamma33,   b33 = K2 + d33,   b22 = U'' + d22,   b23 = K3 - d23/2,

x in [-1/2, 1/2], with int U = int x U = 0 (Liu, Li & Liu, eqs. (19), (24)): a sum of squares of what is
linear in U. U is a sum of Legendre polynomials from the second on, which are orthogonal to 1 and x, and the
integrals are Gauss sums. No step of the solved form of the law is used.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.polynomial import legendre
from numpy.polynomial.polynomial import polyval

from ..arrays import Array

__all__ = ["Section"]

DEGREE = 40
"""Of U: the deflection falls off over (eta/K2)^(1/2), and at K2 = 40 eta the rest is below rounding."""


@dataclass(frozen=True)
class Section:
    """A section with mid-surface growth gamma33 (coefficients in x) and gradients d33, d22, d23."""

    eta: float
    gamma33: tuple[float, ...] = (0.0,)
    d33: float = 0.0
    d22: float = 0.0
    d23: float = 0.0

    def relaxed(self, strain: Array, x: Array) -> tuple[float, Array]:
        """Return the least energy and the deflection at x."""
        rows, right = self._squares(strain)
        U, V = rows
        columns = np.concatenate([-strain[2] * U, self.eta / 3.0 * V])
        # the second derivatives of Legendre polynomials grow with the fourth power of their degree
        scale = np.linalg.norm(columns, axis=0)
        coefficients = np.linalg.lstsq(columns / scale, -right, rcond=None)[0] / scale
        series = np.concatenate([[0.0, 0.0], coefficients])
        return self._energy(strain, columns @ coefficients + right), legendre.legval(2.0 * x, series)

    def energy_of(self, strain: Array, deflection: Array) -> float:
        """Return the energy of a deflection given at `NODES`, smooth enough to be their polynomial."""
        rows, right = self._squares(strain)
        coefficients = np.linalg.lstsq(rows[0], np.sqrt(WEIGHTS) * deflection, rcond=None)[0]
        columns = np.concatenate([-strain[2] * rows[0], self.eta / 3.0 * rows[1]])
        return self._energy(strain, columns @ coefficients + right)

    def _squares(self, strain: Array) -> tuple[tuple[Array, Array], Array]:
        """Polynomials and their second derivatives, and the residuals of U = 0, times root weights."""
        eps, K1, K2, K3 = strain
        m = eps + K1 * NODES + K3**2 * NODES**2 / 2.0 - polyval(NODES, np.array(self.gamma33))
        edge = self.eta / 3.0 * (self.d22 + (K2 + self.d33) / 2.0)
        root = np.sqrt(WEIGHTS)
        return (root[:, None] * BASIS, root[:, None] * SECOND), np.concatenate([root * m, edge * root])

    def _energy(self, strain: Array, residuals: Array) -> float:
        constant = 0.75 * (strain[2] + self.d33) ** 2 + (strain[3] - self.d23 / 2.0) ** 2
        return float(residuals @ residuals / 2.0 + self.eta**2 / 18.0 * constant)


_points, _weights = legendre.leggauss(DEGREE + 4)
NODES: Array = _points / 2.0
"""Gauss points in [-1/2, 1/2]."""
WEIGHTS: Array = _weights / 2.0
_unit = np.eye(DEGREE + 1)[2:]
BASIS: Array = np.stack([legendre.legval(_points, row) for row in _unit], axis=1)
SECOND: Array = np.stack([4.0 * legendre.legval(_points, legendre.legder(row, 2)) for row in _unit], axis=1)
