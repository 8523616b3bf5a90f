"""scipy.integrate.solve_bvp on the scenes, with derivatives and continuation in a loop.

    python benches/peers/bvp.py SCENE TOLERANCE      prints seconds in the solver, then the outputs

At a bifurcation solve_bvp has no answer: three states beside it are extrapolated to amplitude zero.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from typing import Any

import numpy as np
from edge_law import section
from rod import B, T, field
from scenes import S4_LOAD, S4_STRAIN, canonical, grown, reference, strip
from scipy.integrate import solve_bvp

Array = np.ndarray[Any, Any]

ROUGH = 1e-3
"""Tolerance on the way."""

MESH = np.linspace(0.0, 1.0, 9)


class Problem:
    """A boundary-value problem, its latest solution, and how it is solved for again with more conditions."""

    def __init__(
        self, equations: Callable[..., Any], conditions: Callable[..., Any], y: Array, p: Array
    ) -> None:
        self.equations, self.conditions = equations, conditions
        self.x, self.y, self.p = MESH, y, p

    def solve(self, pin: tuple[int, float], tol: float) -> Any:
        """Solve with the parameter `pin[0]`, or the end state -1 - `pin[0]`, given."""
        place, value = pin

        def conditions(ya: Array, yb: Array, p: Array) -> Array:
            pinned = p[place] if place >= 0 else yb[-1 - place]
            return np.append(self.conditions(ya, yb, p)[0], pinned - value)

        def conditions_jac(ya: Array, yb: Array, p: Array) -> tuple[Array, Array, Array]:
            by_a, by_b, by_p = self.conditions(ya, yb, p)[1:]
            row = np.zeros(ya.size + p.size)
            row[ya.size + place if place >= 0 else -1 - place] = 1.0
            rows = np.zeros(ya.size), row[: ya.size], row[ya.size :]
            return tuple(np.vstack([a, b]) for a, b in zip((by_a, by_b, by_p), rows, strict=True))  # type: ignore[return-value]

        solution = solve_bvp(
            lambda _, y, p: self.equations(y, p)[0],
            conditions,
            self.x,
            self.y,
            p=self.p,
            fun_jac=lambda _, y, p: self.equations(y, p)[1:],
            bc_jac=conditions_jac,
            tol=tol,
            max_nodes=20000,
        )
        if not solution.success:
            raise ArithmeticError(solution.message)
        self.x, self.y, self.p = solution.x, solution.y, solution.p
        return solution

    def bifurcation(self, place: int, amplitude: float, tol: float) -> float:
        """Return the first parameter where the pinned value vanishes, on which it depends by its square."""
        squares, loads = [], []
        for factor in (1.0, 2.0, 4.0):
            self.solve((place, factor * amplitude), tol)
            squares.append((factor * amplitude) ** 2)
            loads.append(float(self.p[0]))
        return float(np.polyval(np.polyfit(squares, loads, 2), 0.0))

    def follow(self, place: int, values: Any) -> None:
        """Go through values of what is pinned, roughly."""
        for value in values:
            self.solve((place, value), ROUGH)


def s3(tol: float) -> Array:
    """Elastica: states theta, m, x, z, parameter p."""

    def equations(y: Array, p: Array) -> tuple[Array, Array, Array]:
        s, c, zero = np.sin(y[0]), np.cos(y[0]), 0 * y[0]
        by_y = np.zeros((4, 4, y.shape[1]))
        by_y[0, 1], by_y[1, 0], by_y[2, 0], by_y[3, 0] = 1.0, -p[0] * c, c, -s
        return np.stack([y[1], -p[0] * s, s, c]), by_y, np.stack([zero, -s, zero, zero])[:, None]

    def conditions(ya: Array, yb: Array, p: Array) -> tuple[Array, ...]:
        by_a, by_b = np.zeros((4, 4)), np.zeros((4, 4))
        by_a[0, 0] = by_a[1, 2] = by_a[2, 3] = by_b[3, 1] = 1.0
        return np.array([ya[0], ya[2], ya[3], yb[1]]), by_a, by_b, np.zeros((4, 1))

    mode = np.sin(np.pi * MESH / 2)
    y = np.stack([0.05 * mode, 0.05 * np.gradient(mode, MESH), 0 * mode, MESH])
    problem = Problem(equations, conditions, y, np.array([2.5]))
    critical = problem.bifurcation(-1, 0.02, tol)
    problem.follow(0, (3.0, 4.5, 6.5, 8.5))
    end = problem.solve((0, 10.0), tol).y[:, -1]
    return np.array([critical, end[2], end[3]])


def clamp(ya: Array) -> Array:
    """Return what (r, q) at a clamp misses."""
    return ya - np.array([0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0])


def s2(tol: float) -> Array:
    """Strip: states (r, q), parameters p, C1, C3."""

    def equations(y: Array, p: Array) -> tuple[Array, Array, Array]:
        f, by_y, by_w = field(y, np.array([0.0, -p[0], 0.0]), np.array([p[1], 0.0, p[2]]), strip)
        return f, by_y, np.stack([-by_w[:, 1], by_w[:, 3], by_w[:, 5]], axis=1)

    def conditions(ya: Array, yb: Array, p: Array) -> tuple[Array, ...]:
        by_a, by_b, by_p = np.eye(9, 7), np.zeros((9, 7)), np.zeros((9, 3))
        by_b[7, 2], by_p[7] = -p[0], [-yb[2], 1.0, 0.0]
        by_b[8, 0], by_p[8] = p[0], [yb[0], 0.0, 1.0]
        return np.append(clamp(ya), [p[1] - p[0] * yb[2], p[2] + p[0] * yb[0]]), by_a, by_b, by_p

    y = np.zeros((7, MESH.size))
    y[0], y[2], y[3] = 0.05 * MESH**2, MESH, 1.0
    y[5], y[6] = 0.05 * MESH, 0.1 * MESH
    problem = Problem(equations, conditions, y, np.array([4.07, 4.07, -0.2]))
    critical = problem.bifurcation(-1, 0.02, tol)
    target = 2 * float(reference("s2")[0])
    problem.follow(0, np.linspace(1.1, 1.8, 5) * target / 2)
    end = problem.solve((0, target), tol).y[:3, -1]
    _, c1, c3 = problem.p
    return np.array([critical, abs(end[0]), end[1], end[2], c1, abs(c3)])


S1_STRAIN = S4_STRAIN
"""Strains in units of 1 and 1/L from those of `edge_law`; forces and moments in eta^3/L and eta^3 from it."""
S1_LOAD = 1 / S4_LOAD


def growing(y: Array, p: Array) -> tuple[Array, Array, Array]:
    """Right side and derivatives as in `auto/s1.f90`: states strains, n1, n2, r, q, parameter x."""
    points = y.shape[1]
    w, h, hx = section(y[:4], p[0])
    (n3, *m), strains = S1_LOAD[:, None] * w, S1_STRAIN[:, None] * y[:4]
    k, stretch, zero = strains[1:], 1 + strains[0], np.zeros(points)
    n1, n2 = y[4:6]
    h = S1_LOAD[:, None, None] * h
    hx = S1_LOAD[:, None] * hx
    factor = np.linalg.inv(np.moveaxis(h, -1, 0))
    g = np.stack(
        [
            k[1] * n1 - k[0] * n2,
            k[2] * m[1] - k[1] * m[2] + stretch * n2,
            k[0] * m[2] - k[2] * m[0] - stretch * n1,
            k[1] * m[0] - k[0] * m[1],
        ]
    )
    by_strain = np.array(
        [
            [zero, -n2, n1, zero],
            [n2, zero, -m[2], m[1]],
            [-n1, m[2], zero, -m[0]],
            [zero, -m[1], m[0], zero],
        ]
    )
    by_wrench = np.zeros((4, 4, points))
    by_wrench[1, 2:], by_wrench[2, 1], by_wrench[2, 3] = (k[2], -k[1]), -k[2], k[0]
    by_wrench[3, 1:3] = k[1], -k[0]
    by = np.concatenate(
        [
            by_strain * S1_STRAIN[:, None] + np.einsum("ijp,jkp->ikp", by_wrench, h),
            np.array([[k[1], -k[0]], [zero, stretch], [-stretch, zero], [zero, zero]]),
            np.einsum("ijp,jp->ip", by_wrench, hx)[:, None],
        ],
        axis=1,
    )
    f = np.zeros((13, points))
    by_y, by_p = np.zeros((13, 13, points)), np.zeros((13, 1, points))
    f[:4] = np.einsum("pij,jp->ip", factor, g)
    # The derivatives of the stiffness are left out: they multiply the strains' derivatives, which vanish.
    solved = np.einsum("pij,jkp->ikp", factor, by)
    by_y[:4, :6], by_p[:4, 0] = solved[:, :6], solved[:, 6]
    f[4], f[5] = k[2] * n2 - k[1] * n3, k[0] * n3 - k[2] * n1
    by_y[4, :4], by_y[5, :4] = -k[1] * h[0], k[0] * h[0]
    by_p[4:6, 0] = -k[1] * hx[0], k[0] * hx[0]
    by_y[4, 2] -= n3 * S1_STRAIN[2]
    by_y[4, 3] += n2 * S1_STRAIN[3]
    by_y[5, 1] += n3 * S1_STRAIN[1]
    by_y[5, 3] -= n1 * S1_STRAIN[3]
    by_y[4, 5], by_y[5, 4] = k[2], -k[2]
    q = y[9:]
    by_q = 2 * np.einsum("jab,bp->jap", B[2], q)
    d3 = np.einsum("jap,ap->jp", by_q, q) / 2
    turn = np.einsum("iab,bp->aip", T, q)
    f[6:9], f[9:] = stretch * d3, np.einsum("aip,ip->ap", turn, k)
    by_y[6:9, 0], by_y[6:9, 9:] = S1_STRAIN[0] * d3, stretch * by_q
    by_y[9:, 1:4], by_y[9:, 9:] = turn * S1_STRAIN[1:, None], np.einsum("iab,ip->abp", T, k)
    return f, by_y, by_p


def s1(tol: float) -> Array:
    """Growing edges, clamped and free."""

    def conditions(ya: Array, yb: Array, p: Array) -> tuple[Array, ...]:
        w, h, hx = section(yb[:4, None], p[0])
        by_a, by_b, by_p = np.eye(13, k=6), np.zeros((13, 13)), np.zeros((13, 1))
        by_a[7:] = 0.0
        by_b[7, 4] = by_b[8, 5] = 1.0
        by_b[9:, :4], by_p[9:] = h[:, :, 0], hx
        return np.concatenate([clamp(ya[6:]), yb[4:6], w[:, 0]]), by_a, by_b, by_p

    def beside(x: float, state: int) -> Problem:
        """Start beside the flat state at a threshold."""
        y = np.zeros((13, MESH.size))
        y[0], y[state], y[8], y[9] = x / 3, 0.1, MESH, 1.0
        return Problem(growing, conditions, y, np.array([x]))

    twist = beside(5.0, 3).bifurcation(-4, 0.1, tol)
    problem = beside(4.55, 2)
    bend = problem.bifurcation(-3, 0.1, tol)
    problem.follow(0, (5.0, 6.0, 7.0))
    end = problem.solve((0, 8.0), tol).y[:, -1]
    return np.array([bend, twist, abs(end[2]), abs(end[6]), end[8]])


def s4(tol: float) -> Array:
    """Strip between clamps: states (r, q), parameters z, N, C."""

    def law(wrench: Array) -> tuple[Array, Array]:
        return grown(np.zeros((2, wrench.shape[1])), wrench)

    def equations(y: Array, p: Array) -> tuple[Array, Array, Array]:
        f, by_y, by_w = field(y, p[1:4], p[4:7], law)
        return f, by_y, np.concatenate([np.zeros((7, 1, y.shape[1])), by_w], axis=1)

    def conditions(ya: Array, yb: Array, p: Array) -> tuple[Array, ...]:
        by_a, by_b, by_p = np.eye(13, 7), np.eye(13, 7, -7), np.zeros((13, 7))
        by_p[9, 0] = -1.0
        missed = yb[:6] - np.array([0.0, 0.0, p[0], 0.0, 0.0, 0.0])
        return np.append(clamp(ya), missed), by_a, by_b, by_p

    # The first buckle of the straight and twisted strip, grown until it is near the bifurcation.
    angle = np.pi * MESH / 2
    y = np.zeros((7, MESH.size))
    y[0], y[2], y[3], y[6] = -0.03 * (1 - np.cos(2 * np.pi * MESH)), MESH, np.cos(angle), np.sin(angle)
    problem = Problem(equations, conditions, y, np.array([1.0, 0.3, 0.0, -9.0, 0.15, 0.15, 0.28]))
    problem.follow(1, (0.3, 0.5, 0.75))
    # The other branch breaks the symmetry between the ends: N2 is not zero, and the moments differ.
    problem.p[[2, 4]] += [-0.1, 0.048]
    problem.follow(2, (-0.1, -0.02))
    critical = problem.bifurcation(2, -0.02, tol)
    problem.follow(2, (-0.3, -0.5, -0.75))
    problem.follow(0, (0.9,))
    solution = problem.solve((0, 0.9), tol)
    middle = solution.sol(0.5)[:3]
    return np.append(critical, canonical(problem.p[1:4], problem.p[4:7], middle))


def main() -> None:
    """Run one scene."""
    scene, tol = globals()[sys.argv[1]], float(sys.argv[2])
    before = time.perf_counter()
    outputs = scene(tol)
    print(time.perf_counter() - before, *outputs.tolist())


if __name__ == "__main__":
    main()
