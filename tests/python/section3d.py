"""The cross-section as a body in three dimensions, without any assumption of a thin layer.

Strains eps, K1, K2, K3 that are the same all along the ribbon and a displacement U(X1, X2) of the section on
the directors give the gradient F (Liu, Li & Liu, eq. (12)); with A = F G^-1 and E = (A^T A - I)/2 the energy
of an isotropic material, linear in E (Saint-Venant and Kirchhoff's), is

    Pi = 1/eta int det G [lambda/2 (tr E)^2 + mu E:E] dX1 dX2,

in units of Y h a. U minimises it, with zero mean and zero mean rotation, eqs. (3), (4): products of Legendre
polynomials, Newton's method with the exact second derivative. Faces and edges are free of stress by nature of
the minimum. Nothing is taken from ribbonrs.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.polynomial.legendre import legder, leggauss, legval
from numpy.typing import NDArray

Array = NDArray[np.float64]


def basis(t: Array, n: int) -> tuple[Array, Array]:
    """Legendre polynomials P_0 .. P_{n-1} and their derivatives at t, (t.size, n) each."""
    coefficients = np.eye(n)
    return legval(t, coefficients).T, legval(t, legder(coefficients)).T


class Section:
    """The section of an isotropic ribbon of Young's modulus 1 with `through` x `across` polynomials."""

    def __init__(
        self,
        eta: float,
        nu: float,
        growth: Callable[[Array, Array], Array] | None = None,
        through: int = 5,
        across: int = 24,
    ) -> None:
        """`growth` returns g (q, 3, 3) at X1 (q,), X2 (q,)."""
        self.eta = eta
        self.lame = nu / ((1 + nu) * (1 - 2 * nu)), 1 / (2 * (1 + nu))
        (t1, w1), (t2, w2) = leggauss(through + 3), leggauss(across + 6)
        P1, dP1 = basis(t1, through)
        P2, dP2 = basis(t2, across)
        self.X1, self.X2 = (part.ravel() for part in np.meshgrid(eta / 2 * t1, t2 / 2, indexing="ij"))
        self.weights = np.outer(w1, w2).ravel() / 4  # divided by the thickness

        def products(one: Array, other: Array) -> Array:
            return np.einsum("pi,qj->pqij", one, other).reshape(self.X1.size, through * across)

        value, by1, by2 = products(P1, P2), products(dP1, P2) * 2 / eta, products(P1, dP2) * 2
        self.size = value.shape[1]
        self.value = value
        # dF/dU but for what K multiplies: (q, 3, 3, 3 n), rows and columns of F
        self.gradient = np.zeros((self.X1.size, 3, 3, 3 * self.size))
        for i in range(3):
            columns = slice(i * self.size, (i + 1) * self.size)
            self.gradient[:, i, 0, columns] = by1
            self.gradient[:, i, 1, columns] = by2
        G = np.tile(np.eye(3), (self.X1.size, 1, 1))
        if growth is not None:
            G += growth(self.X1, self.X2)
        self.inverse, self.volume = np.linalg.inv(G), self.weights * np.linalg.det(G)
        none = np.zeros(self.size)
        mean, arm1, arm2 = (self.weights * f @ value for f in (1.0, self.X1, self.X2))
        self.constraints = np.array(
            [
                np.concatenate(row)
                for row in ((mean, none, none), (none, mean, none), (none, none, mean), (-arm2, arm1, none))
            ]
        )

    def energy(self, strain: Sequence[float], tol: float = 1e-13) -> float:
        """Pi at the minimum."""
        eps, K1, K2, K3 = strain
        n = self.size
        B = self.gradient.copy()
        U1, U2, U3 = (slice(i * n, (i + 1) * n) for i in range(3))
        for row, turned in enumerate((((K2, U3), (-K3, U2)), ((-K1, U3), (K3, U1)), ((K1, U2), (-K2, U1)))):
            for factor, columns in turned:
                B[:, row, 2, columns] += factor * self.value
        F0 = np.tile(np.eye(3), (self.X1.size, 1, 1))
        F0[:, 0, 2] -= K3 * self.X2
        F0[:, 1, 2] += K3 * self.X1
        F0[:, 2, 2] += eps + K1 * self.X2 - K2 * self.X1
        # From here on A in place of F.
        B = np.einsum("qijn,qjk->qikn", B, self.inverse)
        A0 = F0 @ self.inverse
        flat = B.reshape(-1, 3 * n)
        u = np.zeros(3 * n)
        zero = np.zeros((4, 4))
        for _ in range(30):
            A = A0 + (flat @ u).reshape(A0.shape)
            energy, stress, stiffness = self.density(A)
            slope = flat.T @ (self.volume[:, None, None] * stress).ravel()
            weighted = (self.volume[:, None, None] * stiffness) @ B.reshape(-1, 9, 3 * n)
            hessian = flat.T @ weighted.reshape(-1, 3 * n)
            system = np.block([[hessian, self.constraints.T], [self.constraints, zero]])
            step = np.linalg.solve(system, -np.concatenate([slope, np.zeros(4)]))[: 3 * n]
            u += step
            if abs(slope @ step) <= tol * abs(energy):
                return float(energy)
        raise AssertionError("Newton's method does not converge")

    def density(self, A: Array) -> tuple[Any, Array, Array]:
        """The energy, its first derivative in A (q, 3, 3) and its second (q, 9, 9)."""
        lam, mu = self.lame
        E = 0.5 * (np.swapaxes(A, 1, 2) @ A - np.eye(3))
        trace = np.trace(E, axis1=1, axis2=2)
        S = lam * trace[:, None, None] * np.eye(3) + 2 * mu * E
        energy = self.volume @ (lam / 2 * trace**2 + mu * np.einsum("qij,qij->q", E, E))
        # d(A S): dA S + A [lambda tr(A^T dA) I + mu (A^T dA + dA^T A)]
        left = A @ np.swapaxes(A, 1, 2)
        second = (
            np.einsum("ik,qjl->qijkl", np.eye(3), S)
            + lam * np.einsum("qij,qkl->qijkl", A, A)
            + mu * np.einsum("qik,jl->qijkl", left, np.eye(3))
            + mu * np.einsum("qil,qkj->qijkl", A, A)
        )
        return energy, A @ S, second.reshape(-1, 9, 9)
