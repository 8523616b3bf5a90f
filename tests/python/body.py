"""The strains of the body that a state describes, by differences of the positions of its points.

A point goes to chi = r + (X1 + u1 + zeta) d1 + (X2 + u2 - X1 s2) d2 + (u3 - X1 s3) d3 (Liu, Li & Liu, eqs.
(11), (15)); zeta is integrated from eq. (14), E11 = -c (e22 + e33). Differences of chi along X1, X2, X3 on
the fixed basis are the gradient F. Nothing is taken from `ribbonrs.neglected`. Places across the ribbon are
given as X2, in widths of reference.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.polynomial.legendre import leggauss
from numpy.typing import NDArray

Array = NDArray[np.float64]

STENCIL = ((-2, 1 / 12), (-1, -2 / 3), (1, 2 / 3), (2, -1 / 12))
"""Of a first derivative: the error is of fourth order in the step."""

ALONG, ACROSS = 4e-3, 2e-4
"""Steps."""


class Body:
    """The strains at one station S of a state."""

    def __init__(self, state: Any, S: float) -> None:
        self.state, self.S = state, S
        self.law, self.growth = state.section_law, state.scene.growth
        material = state.scene.ribbon.material
        Q33, Q22, Q23, G = material.stiffness
        self.stiffness = Q33, Q22, Q23, G
        self.nu = Q23 / Q22
        self.thinning = self.nu / (1 - self.nu)

    def width(self, S: float) -> float:
        """Over that of reference."""
        pieces = self.state.scene.ribbon.width_pieces
        return 1.0 if pieces is None else float(pieces.evaluate(S))

    def thickness(self, S: float) -> float:
        """Over that of reference."""
        pieces = self.state.scene.ribbon.thickness_pieces
        return 1.0 if pieces is None else float(pieces.evaluate(S))

    def field(self, name: str, X2: Array, S: float) -> Array:
        """A part of the growth."""
        return self.growth.values(X2 / self.width(S), S).get(name, np.zeros(X2.shape))

    def slope_of(self, name: str, X2: Array, S: float) -> Array:
        """Its derivative across the width."""
        return sum(c * self.field(name, X2 + n * ACROSS, S) for n, c in STENCIL) / ACROSS

    def along(self, f: Any, S: float) -> Array:
        """The derivative of a function of S."""
        return sum(c * f(S + n * ALONG) for n, c in STENCIL) / ALONG

    def u(self, X2: Array, S: float, order: int = 0) -> Array:
        """u1 and its derivatives in X2."""
        return self.law.deflection(self.strain(S), X2 / self.width(S), order, S)

    def strain(self, S: float) -> Array:
        """eps, K1, K2, K3."""
        return self.state.at(S).strains

    def parts(self, X2: Array, S: float) -> tuple[Array, ...]:
        """The membrane strain m, and the changes of curvature b33, b22, b23."""
        eps, K1, K2, K3 = self.strain(S)
        m = eps + K1 * X2 - K2 * self.u(X2, S) + 0.5 * (K3 * X2) ** 2 - self.field("gamma33", X2, S)
        b33 = K2 + self.field("d33", X2, S)
        b22 = self.u(X2, S, 2) - self.slope_of("g21", X2, S) + self.field("d22", X2, S)
        b23 = K3 + 0.5 * self.slope_of("g31", X2, S) - 0.5 * self.field("d23", X2, S)
        return m, b33, b22, b23

    def theory(self, X1: float, X2: Array) -> tuple[Array, Array, Array]:
        """e33, e22, e23."""
        m, b33, b22, b23 = self.parts(X2, self.S)
        return m - X1 * b33, -self.nu * m - X1 * b22, X1 * b23

    def position(self, X1: float, X2: Array, S: float) -> Array:
        """chi (n, 3) on the fixed basis."""
        at, moved = self.state.at(S), self.law.displacements(self.strain(S), X2 / self.width(S), S)
        K3 = at.strains[3]
        m, b33, b22, _ = self.parts(X2, S)
        g21, g31 = self.field("g21", X2, S), self.field("g31", X2, S)
        u1_2, u1_3 = self.u(X2, S, 1), self.along(lambda s: self.u(X2, s), S)
        U2_1, U3_1 = -(u1_2 - g21), -(u1_3 - K3 * X2 - g31)
        zeta = 0.0
        for t, w in zip(*leggauss(3), strict=True):
            Z = X1 * (1 + t) / 2
            E11 = -self.thinning * ((1 - self.nu) * m - Z * (b33 + b22))
            squares = 0.5 * (U3_1**2 + U2_1**2 + g31**2 + g21**2)
            zeta = zeta + X1 * w / 2 * (E11 - squares - g31 * (K3 * X2 - u1_3 - U3_1) + g21 * (u1_2 + U2_1))
        U = np.stack([X1 + moved[:, 0] + zeta, X2 + moved[:, 1] + X1 * U2_1, moved[:, 2] + X1 * U3_1], axis=1)
        return at.position + U @ at.directors

    def exact(self, X1: float, X2: Array) -> tuple[Array, Array, Array]:
        """E33, E22, E23 of A = F G^-1."""

        def derivative(f: Any, step: float) -> Array:
            return sum(c * f(n * step) for n, c in STENCIL) / step

        columns = (
            derivative(lambda d: self.position(X1 + d, X2, self.S), ACROSS),
            derivative(lambda d: self.position(X1, X2 + d, self.S), ACROSS),
            derivative(lambda d: self.position(X1, X2, self.S + d), ALONG),
        )
        F = np.stack(columns, axis=-1)
        G = np.tile(np.eye(3), (X2.size, 1, 1))
        g = {
            name: self.field(name, X2, self.S)
            for name in ("gamma33", "gamma22", "gamma23", "d33", "d22", "d23")
        }
        G[:, 2, 2] += g["gamma33"] + X1 * g["d33"]
        G[:, 1, 1] += g["gamma22"] + X1 * g["d22"]
        G[:, 2, 1] += g["gamma23"] + X1 * g["d23"] / 2
        G[:, 1, 2] += X1 * g["d23"] / 2
        G[:, 1, 0] += self.field("g21", X2, self.S)
        G[:, 2, 0] += self.field("g31", X2, self.S)
        A = F @ np.linalg.inv(G)
        E = 0.5 * (np.swapaxes(A, 1, 2) @ A - np.eye(3))
        return E[:, 2, 2], E[:, 1, 1], E[:, 1, 2]

    def energies(self, n: int = 12) -> tuple[float, float]:
        """Twice the energies, per length, of what the strains differ by and of the theory's."""
        Q33, Q22, Q23, G = self.stiffness
        half = self.state.scene.ribbon.thickness_ratio * self.thickness(self.S) / 2
        wide = self.width(self.S) / 2
        t, w = leggauss(n)
        lost = kept = 0.0
        for z, weight in zip(*leggauss(4), strict=True):
            X1 = half * z
            theory = np.array(self.theory(X1, wide * t))
            for strains, share in ((theory, 0), (np.array(self.exact(X1, wide * t)) - theory, 1)):
                e33, e22, e23 = strains
                density = Q33 * e33**2 + 2 * Q23 * e33 * e22 + Q22 * e22**2 + 4 * G * e23**2
                total = float(density @ w) * wide * weight * half
                lost, kept = (lost + total, kept) if share else (lost, kept + total)
        return lost, kept
