"""A dense search for all natural shapes, in numpy, sharing nothing with the compiled core.

Lengths in the width, curvatures in eta, strains in eta^2, so that eta is gone. With the deflection relaxed in
n Legendre functions of either parity (`test_reference` derives the form), k = K2 and q = K3 have the energy

    Pi = g (q - q0)^2 + (k + d)^2/24 + 1/2 sum_j D_j (a_j + t_j q^2)^2 + fixed,    D_j = 1/(1 + mu_j k^2),

a_j quadratic in k. At fixed k, dPi/dq = 0 is a cubic A q^3 + e q = g q0: one root of the sign of q0 exists
always, two of the other sign where the discriminant allows (with q0 = 0: q = 0, and q^2 = -e/A). The search
follows dPi/dk along these sheets, with the folds added to the grid, and brackets its changes of sign; where
it nearly touches zero the grid is refined.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cache
from typing import Any

import numpy as np
from numpy.polynomial import Polynomial
from numpy.polynomial.legendre import leggauss, legvander


@cache
def modes(n: int, odd: int) -> tuple[Any, Any]:
    """Squared singular values of the double integral on n Legendre functions, and its left vectors."""
    F = np.zeros((n, n))
    for column in range(n):
        j = 2 * column + odd
        up, down = 1 / ((2 * j + 1) * (2 * j + 3)), 1 / ((2 * j + 1) * (2 * j - 1))
        for m, c in ((j + 2, up), (j, -up - down), (j - 2, down)):
            row = (m - odd) // 2 - 1
            if 0 <= row < n:
                F[row, column] = c / 4 * np.sqrt((2 * j + 1) / (2 * m + 1))
    left, sigma, _ = np.linalg.svd(F)
    return sigma**2, left


def legendre(p: Polynomial, n: int) -> Any:
    """Components of p on sqrt(2m+1) P_m(2x), m < n."""
    nodes, weights = leggauss(n + p.degree())
    basis = legvander(nodes, n - 1) * np.sqrt(2 * np.arange(n) + 1)
    return basis.T @ (weights / 2 * p(nodes / 2))


def double_integral(p: Polynomial) -> Polynomial:
    """Double integral; its components on 1 and x are dropped later."""
    return p.integ(2)


class Ribbon:
    """The energy of one growth {field: coefficients}, scaled, and every place where it is stationary."""

    def __init__(self, fields: Mapping[str, Sequence[float]], stiffness: Sequence[float]) -> None:
        Q33, Q22, Q23, G = stiffness
        E33 = Q33 - Q23**2 / Q22
        nu, self.g = Q23 / Q22, G / (6 * E33)
        field = {
            n: Polynomial(list(fields.get(n, ())) or [0.0])
            for n in ("gamma33", "d33", "d22", "d23", "g21", "g31")
        }
        f = field["d22"] - field["g21"].deriv() + nu * field["d33"]
        twist = field["d23"] / 2 - field["g31"].deriv() / 2

        def moment(p: Polynomial) -> float:
            return float(legendre(p, 1)[0])

        self.stretch, self.bend = moment(field["gamma33"]), 12 * moment(Polynomial([0, 1]) * field["gamma33"])
        self.d, self.q0 = moment(field["d33"]), moment(twist)
        self.fixed = (moment(field["d33"] ** 2) - self.d**2) / 24 + self.g * (moment(twist**2) - self.q0**2)
        gamma = legendre(field["gamma33"], 40)[2:]
        natural = moment(field["d33"] ** 2) / 24 + Q22 / (24 * E33) * moment(f**2)
        natural += self.g * moment(twist**2)
        # For the bending strain v less growth's own: |v|^2 <= |v| |v_g| + |gamma|^2/4, |v|^2 >= k^2/24.
        self.bound = 1.02 * np.sqrt(24) * (np.sqrt(natural) + np.sqrt(natural + gamma @ gamma)) / 2 + 0.1
        n = 12 if self.bound < 40 else 24
        mu, t, s, gamma = [], [], [], []
        for odd in (0, 1):
            squares, left = modes(n, odd)

            def of(p: Polynomial, left: Any = left, odd: int = odd) -> Any:
                return left.T @ legendre(p, 2 * n + 2)[2 + odd :: 2]

            parts = of(double_integral(Polynomial([1.0]))), of(double_integral(f)), of(field["gamma33"])
            if odd and not (np.any(np.abs(parts[1]) > 1e-14) or np.any(np.abs(parts[2]) > 1e-14)):
                continue
            mu.append(12 * E33 / Q22 * squares)
            t.append(parts[0])
            s.append(parts[1])
            gamma.append(parts[2])
        self.mu, self.t, self.s, self.gamma = map(np.concatenate, (mu, t, s, gamma))
        self.nu = nu

    def coefficients(self, k: Any) -> tuple[Any, ...]:
        """A, b, c of the energy A q^4/2 + b q^2 + c at each k, then their first and second k-derivatives."""
        k = np.asarray(k, dtype=float)[..., None]
        D = 1 / (1 + self.mu * k**2)
        D1, D2 = -2 * self.mu * k * D**2, 2 * self.mu * D**2 * (4 * self.mu * k**2 * D - 1)
        t, a2 = self.t, 2 * self.nu * self.t
        a = self.nu * k**2 * t + k * self.s - self.gamma
        a1 = 2 * self.nu * k * t + self.s
        terms = (
            (D * t * t, D * a * t, D * a * a / 2),
            (D1 * t * t, (D1 * a + D * a1) * t, D1 * a * a / 2 + D * a * a1),
            (
                D2 * t * t,
                (D2 * a + 2 * D1 * a1 + D * a2) * t,
                D2 * a * a / 2 + 2 * D1 * a * a1 + D * (a1 * a1 + a * a2),
            ),
        )
        return tuple(term.sum(-1) for order in terms for term in order)

    def energy(self, k: Any, q: Any) -> Any:
        """Pi/eta^4 at eps and K1 relaxed."""
        A, b, c, *_ = self.coefficients(k)
        return self.g * (q - self.q0) ** 2 + (k + self.d) ** 2 / 24 + A * q**4 / 2 + b * q**2 + c + self.fixed

    def slope(self, k: Any, q: Any) -> Any:
        """dPi/dk."""
        _, _, _, A1, b1, c1, *_ = self.coefficients(k)
        return (k + self.d) / 12 + c1 + b1 * q**2 + A1 * q**4 / 2

    def stationarity(self, k: float, q: float) -> tuple[Any, Any]:
        """Gradient (2,) and Hessian (2, 2) in k, q."""
        A, b, _, A1, b1, c1, A2, b2, c2 = self.coefficients(k)
        gradient = [
            (k + self.d) / 12 + c1 + b1 * q**2 + A1 * q**4 / 2,
            2 * self.g * (q - self.q0) + 2 * q * (b + A * q**2),
        ]
        mixed = 2 * b1 * q + 2 * A1 * q**3
        kk, qq = 1 / 12 + c2 + b2 * q**2 + A2 * q**4 / 2, 2 * self.g + 2 * b + 6 * A * q**2
        return np.array(gradient), np.array([[kk, mixed], [mixed, qq]])

    def twists(self, k: Any) -> Any:
        """Roots q (3, ...) of dPi/dq = 0 at each k, the one of the sign of q0 first, NaN where missing."""
        A, b, *_ = self.coefficients(k)
        e, h = (b + self.g) / A, self.g * self.q0 / A
        if self.q0 == 0:
            with np.errstate(invalid="ignore"):
                return np.stack([np.zeros_like(e), np.sqrt(-e), np.full_like(e, np.nan)])
        sign, h = np.sign(self.q0), np.abs(h)
        q = np.sqrt(np.maximum(-e, 0)) + np.cbrt(h)  # Newton descends from here, the cubic being convex
        for _ in range(80):
            q = q - (q**3 + e * q - h) / (3 * q**2 + e)
        # the other two solve q'^2 + q q' + q^2 + e = 0
        with np.errstate(invalid="ignore"):
            split = np.sqrt(-3 * q**2 - 4 * e)
        return sign * np.stack([q, (-q - split) / 2, (-q + split) / 2])

    def _margin(self, k: Any) -> Any:
        """Positive where the second and third roots exist."""
        A, b, *_ = self.coefficients(k)
        e = (b + self.g) / A
        if self.q0 == 0:
            return -e
        return -4 * e**3 - 27 * (self.g * self.q0 / A) ** 2

    def _grid(self) -> Any:
        """k, even to |k| = 1 and in the logarithm beyond, never 0, every fold bracketed to rounding."""
        end = np.arcsinh(self.bound)
        k = np.sinh(np.linspace(-end, end, 2 * int(150 * end) + 2))
        margin = self._margin(k)
        changes = np.flatnonzero(np.sign(margin[1:]) != np.sign(margin[:-1]))
        if changes.size == 0:
            return k
        low, high, positive = k[changes], k[changes + 1], margin[changes] > 0
        for _ in range(60):
            middle = (low + high) / 2
            same = (self._margin(middle) > 0) == positive
            low, high = np.where(same, middle, low), np.where(same, high, middle)
        return np.unique(np.concatenate([k, low, high]))

    def _crossings(self, k: Any, depth: int = 0) -> list[tuple[float, float]]:
        """Starts (k, q) at the changes of sign of dPi/dk on each sheet, and where it comes close to one."""
        q = self.twists(k)
        starts = []
        for sheet in q:
            G = np.where(np.isnan(sheet), np.nan, self.slope(k, np.nan_to_num(sheet)))
            with np.errstate(invalid="ignore"):
                for i in np.flatnonzero(G[1:] * G[:-1] <= 0):
                    weight = G[i] / (G[i] - G[i + 1]) if G[i] != G[i + 1] else 0.5
                    starts.append(
                        (k[i] + weight * (k[i + 1] - k[i]), sheet[i] + weight * (sheet[i + 1] - sheet[i]))
                    )
                size = np.abs(G)
                # a minimum of |G| without a change of sign may hide two roots
                dips = (
                    np.flatnonzero(
                        (size[1:-1] <= size[:-2]) & (size[1:-1] <= size[2:]) & (G[:-2] * G[2:] > 0)
                    )
                    + 1
                )
            if depth < 4:
                for i in dips:
                    near = np.linspace(k[i - 1], k[i + 1], 25)
                    starts += self._crossings(near, depth + 1)
        return starts

    def shapes(self) -> list[tuple[float, float]]:
        """Every stationary (k, q), polished and told apart at 1e-7, mirror images in q included."""
        found: list[tuple[float, float]] = []
        for k, q in self._crossings(self._grid()):
            point = np.array([k, q])
            for _ in range(60):
                gradient, hessian = self.stationarity(*point)
                step, *_ = np.linalg.lstsq(hessian, gradient, rcond=1e-15)
                point = point - step * min(
                    1.0, 0.1 * max(1.0, np.abs(point).max()) / max(np.abs(step).max(), 1e-300)
                )
                if np.abs(step).max() < 1e-14 * max(1.0, np.abs(point).max()):
                    break
            images = [point] if self.q0 or abs(point[1]) < 1e-9 else [point, point * [1, -1]]
            for image in images:
                size = max(1.0, np.abs(image).max())
                if all(np.abs(image - other).max() > 1e-7 * size for other in found):
                    found.append((float(image[0]), float(image[1])))
        return found
