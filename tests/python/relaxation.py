"""The relaxed section by finite differences, for any growth that is smooth between breaks.

At strains (eps, K1, K2, K3) the section takes the deflection U(x), x in [-1/2, 1/2], that minimises

    Pi = 1/2 int m^2 + (eta^2/24)/E33 int [Q33 b33^2 + 2 Q23 b33 b22 + Q22 b22^2 + 4 G b23^2],
    m = eps + K1 x - K2 U + K3^2 x^2/2 - gamma33,   b33 = K2 + d33,
    b22 = U'' - g21' + d22,   b23 = K3 + g31'/2 - d23/2,   E33 = Q33 - Q23^2/Q22,

under int U = int x U = 0. gamma33, d33, d22 and d23 may jump at the breaks. So may g21: U' jumps with it, the
section folds through that angle, and b22 stays finite. g31 must not, for its slope would be a delta and the
energy the square of it, infinite.

`discrete` minimises this on a grid, `relaxed` extrapolates to step zero: to rounding in the energy, from a
few hundred cells. Nothing is taken from the solved form of the law.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import bmat, csc_matrix, diags_array, hstack
from scipy.sparse.linalg import splu

Array = NDArray[np.float64]
Functions = Mapping[str, Sequence[Callable[[Array], Any]]]
"""For each field one function of x a piece."""
Polynomials = Mapping[str, Sequence[Sequence[float]]]
"""For each field the coefficients in x of each piece, lowest power first."""


class Relaxed(NamedTuple):
    """A relaxed section: energy, and the deflection at the nodes x."""

    energy: float
    x: Array
    U: Array


def functions(fields: Polynomials) -> dict[str, list[Callable[[Array], Any]]]:
    """Polynomials as functions."""
    return {name: [np.polynomial.Polynomial(list(c)) for c in pieces] for name, pieces in fields.items()}


def discrete(
    eta: float,
    breaks: Sequence[float],
    fields: Functions,
    strain: Sequence[float],
    stiffness: Sequence[float],
    cells: Sequence[int],
) -> Relaxed:
    """The least energy on a grid of so many equal cells in each piece.

    Nodes carry U and p = U' - g21, which are continuous; a cell, which never straddles a break, takes
    everything at its middle: U and p as means, p' and g31' as differences. U' = p + g21 holds in each cell by
    a multiplier, the shear force. The box scheme is symmetric, so that its error is a series in the square of
    the step. The unknowns solve one sparse linear system, two of whose rows, the constraints, are full.
    """
    eps, K1, K2, K3 = strain
    Q33, Q22, Q23, G = map(float, stiffness)
    bending = eta**2 / (12 * (Q33 - Q23**2 / Q22))
    edges = [-0.5, *breaks, 0.5]
    grids = [np.linspace(a, b, n + 1) for a, b, n in zip(edges[:-1], edges[1:], cells, strict=True)]
    middles = [(grid[:-1] + grid[1:]) / 2 for grid in grids]
    nodes = np.concatenate([grids[0], *(grid[1:] for grid in grids[1:])])
    x = np.concatenate(middles)
    h = np.concatenate([np.full(n, np.ptp(grid) / n) for grid, n in zip(grids, cells, strict=True)])

    def values(name: str, points: list[Array]) -> list[Array]:
        pieces = fields.get(name, [np.zeros_like] * len(points))
        return [np.broadcast_to(f(t), t.shape) for f, t in zip(pieces, points, strict=True)]

    def field(name: str) -> Array:
        return np.concatenate(values(name, middles))

    strain0 = eps + K1 * x + K3**2 * x**2 / 2 - field("gamma33")
    b33 = K2 + field("d33")
    d22 = field("d22")
    slopes = [np.diff(v) for v in values("g31", grids)]
    b23 = K3 + np.concatenate(slopes) / h / 2 - field("d23") / 2

    n = x.size
    mean = diags_array([np.full(n, 0.5), np.full(n, 0.5)], offsets=[0, 1], shape=(n, n + 1))
    difference = diags_array([-1 / h, 1 / h], offsets=[0, 1], shape=(n, n + 1))
    weight = diags_array(h)
    # The energy is 1/2 (U, p) A (U, p) - b (U, p) and what does not depend on them.
    stretch = K2**2 * mean.T @ weight @ mean
    curve = bending * Q22 * difference.T @ weight @ difference
    load_U = K2 * mean.T @ (h * strain0)
    load_p = -bending * difference.T @ (h * (Q22 * d22 + Q23 * b33))
    along = hstack([difference, -mean])
    constraints = hstack([csc_matrix(np.array([h, x * h])) @ mean, csc_matrix((2, n + 1))])
    matrix = bmat(
        [
            [bmat([[stretch, None], [None, curve]]), along.T, constraints.T],
            [along, None, None],
            [constraints, None, None],
        ],
        format="csc",
    )
    right = np.concatenate([load_U, load_p, field("g21"), np.zeros(2)])
    solver = splu(matrix)
    unknowns = solver.solve(right)
    unknowns += solver.solve(right - matrix @ unknowns)
    U, p = unknowns[: n + 1], unknowns[n + 1 : 2 * n + 2]
    m = strain0 - K2 * (mean @ U)
    b22 = difference @ p + d22
    density = m**2 + bending * (Q33 * b33**2 + 2 * Q23 * b33 * b22 + Q22 * b22**2 + 4 * G * b23**2)
    return Relaxed(float(h @ density) / 2, nodes, U)


def extrapolated(values: Sequence[Any]) -> Any:
    """The limit of values at steps 1, 1/2, 1/4, ... whose error is a series in the square of the step."""
    for k in range(1, len(values)):
        values = [b + (b - a) / (4**k - 1) for a, b in pairwise(values)]
    return values[0]


def relaxed(
    eta: float,
    breaks: Sequence[float],
    fields: Functions,
    strain: Sequence[float],
    stiffness: Sequence[float],
    cells: int = 16,
    levels: int = 6,
) -> Relaxed:
    """`discrete` extrapolated from `cells` a unit length, halved `levels` - 1 times; U at the first nodes."""
    edges = [-0.5, *breaks, 0.5]
    first = [max(2, round(cells * (b - a))) for a, b in pairwise(edges)]
    found = [
        discrete(eta, breaks, fields, strain, stiffness, [n << level for n in first])
        for level in range(levels)
    ]
    U = extrapolated([one.U[:: 1 << level] for level, one in enumerate(found)])
    return Relaxed(extrapolated([one.energy for one in found]), found[0].x, U)
