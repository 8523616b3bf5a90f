"""The exact relaxed section for growth that is polynomial in pieces, in mpmath.

The functional is that of relaxation.py. With Y the primitive of g21 without its components on 1 and x, and
U = V + Y, V has no kinks where g21 jumps, and g21' is gone. Let D = eta^2 Q22/(12 E33), P the membrane strain
at V = 0 without its components on 1 and x, f = d22 + (Q23/Q22) b33 and B = V'' + f. Then

    D B'' = K2 (P - K2 V),   so   V'''' + lambda V = (K2/D) P - f'',   lambda = K2^2/D.

V, V', the moment D B and the shear force D B' are continuous at the breaks, and B = B' = 0 at the edges. A
piece has a polynomial solution and the four exponentials exp(+-(1 +- i) q x), 4 q^4 = lambda.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import Any, NamedTuple

import reference as ref
from mpmath import mp, mpf

Pieces = list[ref.Poly]
"""One polynomial in x a piece."""


def integral(edges: Sequence[Any], p: Pieces, q: Pieces | None = None) -> Any:
    """Integral of p, or p q, over the width."""
    total = mpf(0)
    for j, (a, b) in enumerate(pairwise(edges)):
        whole = ref.primitive(p[j] if q is None else ref.times(p[j], q[j]))
        total += ref.at(whole, b) - ref.at(whole, a)
    return total


def slope(edges: Sequence[Any], p: Pieces) -> Any:
    """Component of p on x."""
    return 12 * integral(edges, p, [[mpf(0), mpf(1)]] * len(p))


def soft(edges: Sequence[Any], p: Pieces) -> Pieces:
    """p less its components on 1 and x."""
    line = [-integral(edges, p), -slope(edges, p)]
    return [ref.add(piece, line) for piece in p]


def joined(edges: Sequence[Any], p: Pieces) -> Pieces:
    """A continuous primitive."""
    whole: Pieces = []
    for piece, (a, _) in zip(p, pairwise(edges), strict=True):
        part = ref.primitive(piece)
        whole.append(ref.add(part, [ref.at(whole[-1], a) - ref.at(part, a) if whole else mpf(0)]))
    return whole


class Load(NamedTuple):
    """A membrane strain P, orthogonal to 1 and x, and a transverse curvature f."""

    P: Pieces
    f: Pieces


class Wave(NamedTuple):
    """The real part of c exp(rate (x - origin))."""

    c: Any
    rate: Any
    origin: Any

    def at(self, x: Any, order: int = 0) -> Any:
        """Value or derivative."""
        return (self.c * self.rate**order * mp.exp(self.rate * (x - self.origin))).real

    def work(self, p: ref.Poly, order: int, a: Any, b: Any) -> Any:
        """Integral of p times the derivative of that order from a to b, by parts."""
        total, factor = mpf(0), self.c * self.rate**order
        low, high = (mp.exp(self.rate * (x - self.origin)) for x in (a, b))
        while any(p):
            factor /= self.rate
            total += (factor * (ref.at(p, b) * high - ref.at(p, a) * low)).real
            p = ref.scaled(-1, ref.derivative(p))
        return total


class Deflection:
    """V of one load: on each piece a polynomial and waves."""

    def __init__(self, edges: Sequence[Any], polys: Pieces, waves: Sequence[Sequence[Wave]]) -> None:
        self.edges, self.polys, self.waves = edges, polys, waves

    def __call__(self, x: Any, order: int = 0) -> Any:
        """V or a derivative of it, at a break from the right."""
        j = max(i for i, a in enumerate(self.edges[:-1]) if a <= x)
        smooth = ref.at(ref.derivative(self.polys[j], order), x)
        return smooth + sum(wave.at(x, order) for wave in self.waves[j])

    def work(self, p: Pieces, order: int) -> Any:
        """Integral of p times V (order 0) or V'' (order 2) over the width."""
        total = mpf(0)
        for j, (a, b) in enumerate(pairwise(self.edges)):
            whole = ref.primitive(ref.times(p[j], ref.derivative(self.polys[j], order)))
            total += ref.at(whole, b) - ref.at(whole, a)
            total += sum(wave.work(p[j], order, a, b) for wave in self.waves[j])
        return total


def particular(P: ref.Poly, f: ref.Poly, K2: Any, D: Any) -> ref.Poly:
    """The polynomial solution of V'''' + lambda V = (K2/D) P - f''."""
    lam = K2**2 / D
    term, poly = ref.add(ref.scaled(K2 / D, P), ref.scaled(-1, ref.derivative(f, 2))), [mpf(0)]
    while any(term):
        poly = ref.add(poly, ref.scaled(1 / lam, term))
        term = ref.scaled(-1 / lam, ref.derivative(term, 4))
    return poly


def without_curvature(load: Load, edges: Sequence[Any]) -> Deflection:
    """V at K2 = 0, where V'' = -f."""
    polys = joined(edges, joined(edges, [ref.scaled(-1, f) for f in load.f]))
    return Deflection(edges, soft(edges, polys), [[]] * len(polys))


def deflections(loads: Sequence[Load], K2: Any, D: Any, edges: Sequence[Any]) -> list[Deflection]:
    """The deflections of several loads at one K2 other than 0."""
    q = mp.sqrt(mp.sqrt(K2**2 / D / 4))
    r = mp.mpc(q, q)
    n = len(edges) - 1
    # What is unknown, four a piece: two waves that decay from its left end, two from its right.
    shapes = [[Wave(c, s, o) for s, o in ((-r, a), (r, b)) for c in (1, 1j)] for a, b in pairwise(edges)]
    # What holds: no moment and no shear force at the edges, and at a break no jump, from piece to piece.
    conditions = [(edges[0], order, ((0, 1),)) for order in (2, 3)]
    for j in range(1, n):
        conditions += [(edges[j], order, ((j - 1, -1), (j, 1))) for order in range(4)]
    conditions += [(edges[n], order, ((n - 1, 1),)) for order in (2, 3)]

    matrix = mp.matrix(4 * n)
    for i, (x, order, sides) in enumerate(conditions):
        for j, sign in sides:
            for k, shape in enumerate(shapes[j]):
                matrix[i, 4 * j + k] = sign * shape.at(x, order) / q**order
    factors, swaps = mp.LU_decomp(matrix)

    found = []
    for load in loads:
        polys = [particular(P, f, K2, D) for P, f in zip(load.P, load.f, strict=True)]
        right = mp.matrix(4 * n, 1)
        for i, (x, order, sides) in enumerate(conditions):
            for j, sign in sides:
                known = ref.derivative(polys[j], order)
                if order >= 2:
                    known = ref.add(known, ref.derivative(load.f[j], order - 2))
                right[i] -= sign * ref.at(known, x) / q**order
        c = mp.U_solve(factors, mp.L_solve(factors, right, swaps))
        waves = [
            [Wave(c[4 * j + k] * shape.c, shape.rate, shape.origin) for k, shape in enumerate(shapes[j])]
            for j in range(n)
        ]
        found.append(Deflection(edges, polys, waves))
    return found


class Exact:
    """The relaxed law, with at least 50 digits; doubles are taken as they are.

    Fields are lists of polynomial coefficients in x, lowest power first, one list a piece. Raises ValueError
    where g31 jumps.
    """

    def __init__(
        self,
        eta: float,
        breaks: Sequence[float],
        fields: Mapping[str, Sequence[Sequence[float]]],
        stiffness: Sequence[Any] = ref.ISOTROPIC,
    ) -> None:
        self.eta, self.stiffness = eta, tuple(stiffness)
        self.edges = [mpf(-1) / 2, *map(mpf, breaks), mpf(1) / 2]
        self.count = len(self.edges) - 1
        self.fields = {
            name: [[ref.exact(c) for c in piece] or [mpf(0)] for piece in fields.get(name, [()] * self.count)]
            for name in ref.FIELDS
        }
        for (left, right), b in zip(pairwise(self.fields["g31"]), self.edges[1:-1], strict=True):
            # The coefficients are doubles, and meet to their rounding only.
            if abs(ref.at(left, b) - ref.at(right, b)) > 1e-15 * sum(map(abs, [*left, *right])):
                raise ValueError(f"g31 jumps at {b}: infinite energy")
        self._sections: dict[Any, tuple[list[Deflection], list[list[Any]]]] = {}

    def digits(self, K2: float) -> int:
        """Digits to work with, to leave 60 in second differences of steps 1e-30.

        For small K2 the polynomials grow as K2^-6 (growth of degree eight or less) and the four exponentials
        become alike, the more so the shorter the piece, and all this cancels.
        """
        small = min(mp.log10(abs(mpf(K2)) / self.eta), 0) if K2 else mpf(-30)
        shortest = min(b - a for a, b in pairwise(self.edges))
        return 240 + int(-16 * small - 12 * mp.log10(shortest))

    def constants(self) -> tuple[Any, Any, Any, Any]:
        """Q23/Q22, D, and the factors of b33^2 and b23^2."""
        Q33, Q22, Q23, G = map(ref.exact, self.stiffness)
        E33 = Q33 - Q23**2 / Q22
        h2 = ref.exact(self.eta) ** 2
        return Q23 / Q22, h2 * Q22 / (12 * E33), h2 / 24, h2 * G / (6 * E33)

    def fold(self) -> Pieces:
        """Y, with Y' = g21 but for its mean."""
        return soft(self.edges, joined(self.edges, self.fields["g21"]))

    def loads(self) -> list[Load]:
        """Loads of weight K3^2, K2 and 1."""
        nu, n = self.constants()[0], self.count
        f = [
            ref.add(d22, ref.scaled(nu, d33))
            for d22, d33 in zip(self.fields["d22"], self.fields["d33"], strict=True)
        ]
        square: Pieces = [[mpf(0), mpf(0), mpf(1) / 2]] * n
        folded = [ref.scaled(-1, piece) for piece in self.fold()]
        gamma = [ref.scaled(-1, piece) for piece in self.fields["gamma33"]]
        return [
            Load(soft(self.edges, square), [[mpf(0)]] * n),
            Load(folded, [[nu]] * n),
            Load(soft(self.edges, gamma), f),
        ]

    def section(self, K2: Any) -> tuple[list[Deflection], list[list[Any]]]:
        """The deflections of the three loads, and A: with the weights y the relaxed energy is y A y.

        The minimum of a quadratic J(V) is J(0) + J'(0)[V]/2.
        """
        if K2 not in self._sections:
            D, loads = self.constants()[1], self.loads()
            if K2:
                V = deflections(loads, K2, D, self.edges)
            else:
                V = [without_curvature(load, self.edges) for load in loads]

            A = [[mpf(0)] * 3 for _ in loads]
            for i, a in enumerate(loads):
                for j, (b, v) in enumerate(zip(loads[: i + 1], V, strict=False)):
                    fixed = integral(self.edges, a.P, b.P) + D * integral(self.edges, a.f, b.f)
                    A[i][j] = A[j][i] = (fixed - K2 * v.work(a.P, 0) + D * v.work(a.f, 2)) / 2
            self._sections[K2] = V, A
        return self._sections[K2]

    def _energy(self, strain: Sequence[Any]) -> Any:
        eps, K1, K2, K3 = strain
        gamma = self.fields["gamma33"]
        b33 = [ref.add([K2], d33) for d33 in self.fields["d33"]]
        b23 = [
            ref.add([K3], ref.scaled(mpf(1) / 2, ref.add(ref.derivative(g31), ref.scaled(-1, d23))))
            for g31, d23 in zip(self.fields["g31"], self.fields["d23"], strict=True)
        ]
        _, _, along, shear = self.constants()
        stretch = eps + K3**2 / 24 - integral(self.edges, gamma)
        bend = K1 - slope(self.edges, gamma)
        A, y = self.section(K2)[1], (K3**2, K2, mpf(1))
        relaxed = sum(y[i] * A[i][j] * y[j] for i in range(3) for j in range(3))
        rigid = along * integral(self.edges, b33, b33) + shear * integral(self.edges, b23, b23)
        return stretch**2 / 2 + bend**2 / 24 + relaxed + rigid

    def energy(self, strain: Sequence[float]) -> Any:
        """The energy alone."""
        with mp.workdps(self.digits(strain[2])):
            return self._energy([ref.exact(s) for s in strain])

    def __call__(self, strain: Sequence[float]) -> ref.Value:
        """Energy, gradient and Hessian, the derivatives by central differences."""
        with mp.workdps(self.digits(strain[2])):
            eta, here = ref.exact(self.eta), [ref.exact(s) for s in strain]
            steps = [mpf(10) ** -30 * size for size in (eta**2, eta**2, eta, eta)]

            def moved(*moves: tuple[int, int]) -> Any:
                there = list(here)
                for i, sign in moves:
                    there[i] += sign * steps[i]
                return self._energy(there)

            gradient, hessian = [mpf(0)] * 4, [[mpf(0)] * 4 for _ in range(4)]
            for i, h in enumerate(steps):
                low, mid, high = moved((i, -1)), moved(), moved((i, 1))
                gradient[i], hessian[i][i] = (high - low) / (2 * h), (high - 2 * mid + low) / h**2
                for j in range(i):
                    mixed = sum(a * b * moved((i, a), (j, b)) for a in (-1, 1) for b in (-1, 1))
                    hessian[i][j] = hessian[j][i] = mixed / (4 * h * steps[j])
            return ref.Value(self._energy(here), gradient, hessian)

    def deflection(self, strain: Sequence[float], x: Sequence[float], order: int = 0) -> list[Any]:
        """U or a derivative of it at the points x, at a break from the right."""
        with mp.workdps(self.digits(strain[2])):
            K2, K3 = ref.exact(strain[2]), ref.exact(strain[3])
            fold = Deflection(self.edges, self.fold(), [[]] * self.count)
            parts = [*zip((K3**2, K2, 1), self.section(K2)[0], strict=True), (1, fold)]
            return [sum(w * part(ref.exact(t), order) for w, part in parts) for t in x]
