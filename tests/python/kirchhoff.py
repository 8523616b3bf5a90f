"""The equations of a held and loaded ribbon, written anew on the directors, and solved by scipy.

With n and m the components of force and moment, R the directors as columns, K and eps the strains,

    r' = (1 + eps) R e3,  q' = q (0, K)/2,  n' = -K x n - R^T p,  m' = -K x m - (1 + eps) e3 x n - R^T c

where eps, K at each S have dPi/d(eps, K) = (n3, m). Units: L, EI2/L^2 of forces, EI2/L of moments.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import ribbonrs as rb
from scipy.integrate import solve_bvp, solve_ivp

E3 = np.array([0.0, 0.0, 1.0])


def rotation_matrices(q):
    """Columns d1, d2, d3 (n, 3, 3) of quaternions (n, 4), scalar first."""
    a, b, c, d = q.T
    rows = [
        [a * a + b * b - c * c - d * d, 2 * (b * c - a * d), 2 * (b * d + a * c)],
        [2 * (b * c + a * d), a * a - b * b + c * c - d * d, 2 * (c * d - a * b)],
        [2 * (b * d - a * c), 2 * (c * d + a * b), a * a - b * b - c * c + d * d],
    ]
    return np.moveaxis(np.array(rows), 2, 0) / np.einsum("ni,ni->n", q, q)[:, None, None]


def product(p, q):
    """The Hamilton product of (n, 4) by (n, 4)."""
    a, u, b, v = p[:, :1], p[:, 1:], q[:, :1], q[:, 1:]
    return np.hstack([a * b - np.sum(u * v, axis=1, keepdims=True), a * v + b * u + np.cross(u, v)])


class Kirchhoff:
    """The equations of a scene."""

    def __init__(self, scene):
        self.scene = scene
        self.length = scene.ribbon.length_ratio
        stiffness = (
            scene.law.EI2 if isinstance(scene.law, rb.LinearLaw) else scene.ribbon.thickness_ratio**2 / 12
        )
        moment = stiffness / self.length
        self.force = moment / self.length
        self.units = np.repeat([self.length, 1.0, self.force, moment], [3, 4, 3, 3])
        self.points = sorted((p for p in scene.loads if isinstance(p, rb.PointLoad)), key=lambda p: p.S)
        self.lines = [load for load in scene.loads if isinstance(load, rb.LineLoad)]
        if not isinstance(scene.law, rb.LinearLaw):
            self.law = scene.section_law

    def gradient(self, strains, S):
        """n3, m and their derivatives."""
        if self.scene.law == "linear":
            eta2 = self.scene.ribbon.thickness_ratio**2
            stiffness = np.array([1.0, 1.0 / 12.0, eta2 / 12.0, eta2 / 9.0])
            H = np.tile(np.diag(stiffness), (S.size, 1, 1))
            return self.law.gradient(np.zeros_like(strains), S) + stiffness * strains, H
        return self.law.gradient(strains, S), self.law.hessian(strains, S)

    def strains(self, resultants, S, guess):
        """The strains (n, 4) of n3, m (n, 4), by Newton's method from a guess."""
        law = self.scene.law
        if isinstance(law, rb.LinearLaw):
            return np.array(law.intrinsic) + np.array(law.compliance) * resultants
        strains = guess.copy()
        for _ in range(60):
            gradient, H = self.gradient(strains, S)
            step = np.linalg.solve(H, (resultants - gradient)[..., None])[..., 0]
            strains = strains + step
            if np.max(np.abs(step)) < 1e-15 * (1.0 + np.max(np.abs(strains))):
                break
        return strains

    def line_loads(self, S):
        """Force and couple per unit S, (n, 3) each, in the fixed basis."""
        p, c = np.tile(self.scene.gravity, (S.size, 1)), np.zeros((S.size, 3))
        for load in self.lines:
            for total, along in ((p, load.force), (c, load.moment)):
                for i, component in enumerate(along):
                    if callable(component):
                        total[:, i] += component(S)
                    else:
                        total[:, i] += component if isinstance(component, float) else component.evaluate(S)
        return p, c

    def rates(self, S, y, guess):
        """Derivatives (n, 13) of states (n, 13), in units; and the strains."""
        y = y * self.units
        q, n, m = y[:, 3:7], y[:, 7:10], y[:, 10:]
        R = rotation_matrices(q)
        e = self.strains(np.column_stack([n[:, 2], m]), S, guess)
        stretch, K = 1.0 + e[:, :1], e[:, 1:]
        p, c = (np.einsum("nji,nj->ni", R, load) for load in self.line_loads(S))
        rates = np.hstack(
            [
                stretch * R[:, :, 2],
                0.5 * product(q, np.hstack([np.zeros((S.size, 1)), K])),
                -np.cross(K, n) - p,
                -np.cross(K, m) - stretch * np.cross(E3, n) - c,
            ]
        )
        return rates / self.units, e

    def state(self, sections):
        """The state (n, 13), in units, of sections of a ribbonrs state."""
        parts = [sections.position, sections.quaternion, sections.force, sections.moment]
        return np.hstack(parts) / self.units

    def after(self, point, y):
        """What is right of a point load, of what is left of it: (13,)."""
        y = y * self.units
        R = rotation_matrices(y[None, 3:7])[0]
        y[7:10] -= R.T @ point.force
        y[10:] -= R.T @ point.moment
        return y / self.units

    def carried(self, state, places):
        """States (n, 13) at ascending places from that at S = 0, as an initial-value problem."""
        y = self.state(state.at([0.0]))[0]
        guess = state.at([0.0]).strains
        here, rows = 0.0, []
        for i, there in enumerate([*(p.S for p in self.points), self.length]):
            last = i == len(self.points)
            wanted = places[(places >= here) & ((places <= there) if last else (places < there))]

            def rate(s, y):
                rates, e = self.rates(np.array([s]), y[None], guess)
                guess[:] = e
                return rates[0]

            ends = np.union1d(wanted, [there])
            found = solve_ivp(rate, (here, there), y, "DOP853", ends, rtol=1e-12, atol=1e-13)
            assert found.success
            rows.append(found.y.T[: wanted.size])
            y = found.y[:, -1]
            if not last:
                y = self.after(self.points[i], y)
            here = there
        return np.concatenate(rows)

    def misses(self, y, end, place, outward):
        """By how much a state (13,) misses six conditions of an end, in units."""
        y = y * self.units
        R = rotation_matrices(y[None, 3:7])[0]
        r, N, M = y[:3], outward * R @ y[7:10], outward * R @ y[10:]
        length, force, moment = self.units[0], self.units[7], self.units[10]

        def away(matrix):
            """Axial vector of R relative to `matrix`."""
            D = R @ matrix.T
            return np.array([D[2, 1] - D[1, 2], D[0, 2] - D[2, 0], D[1, 0] - D[0, 1]]) / 2.0

        match end:
            case rb.Clamped():
                held = rotation_matrices(np.array([end.quaternion]))[0]
                return np.concatenate([(r - place) / length, away(held)])
            case rb.Free():
                return np.concatenate([(N - end.force) / force, (M - end.moment) / moment])
            case rb.Pinned():
                return np.concatenate([(r - place) / length, (M - end.moment) / moment])
            case rb.Hinged():
                k = end.director - 1
                others = [i for i in range(3) if i != k]
                return np.array([*(r - place) / length, *R[others, k], (M[k] - end.moment) / moment])
            case rb.Sliding():
                axis = np.array(end.axis)
                across = np.linalg.svd(axis[None])[2][1:]
                held = rotation_matrices(np.array([end.quaternion]))[0]
                off = across @ (r - place) / length
                return np.array([*off, *away(held), (N @ axis - end.force) / force])

    def end_misses(self, first, last):
        """Misses (12,) at both ends."""
        start, end = self.scene.places
        return np.concatenate(
            [self.misses(first, self.scene.start, start, -1.0), self.misses(last, self.scene.end, end, 1.0)]
        )

    def collocated(self, state, tol):
        """The solution of the boundary-value problem by scipy, from a ribbonrs state: a function of S.

        Point loads cut it into pieces, each mapped to [0, 1], which are solved side by side.
        """
        cuts = np.array([0.0, *(p.S for p in self.points), self.length])
        mesh = np.linspace(0.0, 1.0, 60)
        pieces = list(pairwise(cuts))

        def places(x, piece):
            a, b = piece
            # not beyond a jump
            return np.clip(a + (b - a) * x, a, np.nextafter(b, a) if b < self.length else b)

        y0 = np.vstack([self.state(state.at(places(mesh, piece))).T for piece in pieces])

        def rates(x, y):
            rows = []
            for i, piece in enumerate(pieces):
                S = places(x, piece)
                found, _ = self.rates(S, y[13 * i : 13 * i + 13].T, state.at(S).strains)
                rows.append((piece[1] - piece[0]) * found.T)
            return np.vstack(rows)

        def conditions(first, last):
            rows = [self.end_misses(first[:13], last[-13:]), [first[3:7] @ first[3:7] - 1.0]]
            for i, point in enumerate(self.points):
                rows.append(first[13 * i + 13 : 13 * i + 26] - self.after(point, last[13 * i : 13 * i + 13]))
            return np.concatenate(rows)

        found = solve_bvp(rates, conditions, mesh, y0, tol=tol, max_nodes=4000)
        assert found.success, found.message

        def at(S):
            rows = []
            for s in S:
                i = min(np.searchsorted(cuts, s, "right") - 1, len(pieces) - 1)
                a, b = pieces[i]
                rows.append(found.sol((s - a) / (b - a))[13 * i : 13 * i + 13])
            return np.array(rows)

        return at
