"""Functions of one variable in pieces: a Legendre series on each, free to jump between them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from .arrays import Array

__all__ = ["Pieces", "added", "grid", "joined", "linear", "series"]


@dataclass(frozen=True)
class Pieces:
    """A function of t between ascending breaks.

    On piece p, from b_p to b_(p+1), it is sum_n c_n P_n(xi) with the Legendre polynomials P_n and
    xi = (2 t - b_p - b_(p+1)) / (b_(p+1) - b_p).

    Parameters
    ----------
    breaks : tuple of float
        m + 1 ascending numbers.
    coefficients : tuple of tuple of float
        The Legendre coefficients of each of the m pieces, lowest degree first.

    Examples
    --------
    >>> step = Pieces(breaks=(-0.5, 0.1, 0.5), coefficients=((0.0,), (0.02,)))
    >>> step.evaluate([0.0, 0.1, 0.2]).tolist()
    [0.0, 0.02, 0.02]
    """

    breaks: tuple[float, ...]
    coefficients: tuple[tuple[float, ...], ...]

    @property
    def domain(self) -> tuple[float, float]:
        """Where the first piece starts and the last one ends."""
        return self.breaks[0], self.breaks[-1]

    @property
    def degree(self) -> int:
        """The highest degree of a piece."""
        return max(map(len, self.coefficients)) - 1

    def evaluate(self, t: ArrayLike, left: bool = False) -> Array:
        """Return the values at t (...), array (...); beyond an end that of the end.

        At an inner break it is the value of the piece to the right, or with `left` of that to the left.
        """
        points = np.clip(np.asarray(t, dtype=np.float64), *self.domain)
        starts, ends = np.array(self.breaks[:-1]), np.array(self.breaks[1:])
        piece = np.searchsorted(ends[:-1], points, "left" if left else "right")
        start, end = starts[piece], ends[piece]
        xi = ((points - start) + (points - end)) / (end - start)
        # A single piece needs no column of coefficients for every point.
        columns = self._columns[:, 0] if len(self.coefficients) == 1 else self._columns[:, piece]
        return np.asarray(np.polynomial.legendre.legval(xi, columns, tensor=False), dtype=np.float64)

    @cached_property
    def _columns(self) -> Array:
        """Coefficients by degree and piece, filled up with zeros."""
        columns = np.zeros((self.degree + 1, len(self.coefficients)))
        for piece, coefficients in enumerate(self.coefficients):
            columns[: len(coefficients), piece] = coefficients
        return columns

    @property
    def derivative(self) -> Pieces:
        """The derivative on each piece."""
        return Pieces(
            self.breaks,
            tuple(
                tuple((np.polynomial.legendre.legder(piece) * 2.0 / (end - start)).tolist())
                for piece, start, end in zip(
                    self.coefficients, self.breaks[:-1], self.breaks[1:], strict=True
                )
            ),
        )

    def scaled(self, factor: float) -> Pieces:
        """Return `factor` times the function."""
        return Pieces(self.breaks, tuple(tuple(factor * c for c in piece) for piece in self.coefficients))


def added(functions: Sequence[float | Pieces], domain: tuple[float, float]) -> float | Pieces:
    """Return the sum of numbers and functions, which cover `domain` but for rounding, over all of it."""
    varying = [f for f in functions if isinstance(f, Pieces)]
    constant = sum(f for f in functions if not isinstance(f, Pieces))
    if not varying:
        return constant
    start, end = domain
    close = 1e-12 * (end - start)
    breaks = [start]
    for t in sorted({t for f in varying for t in f.breaks}):
        if t - breaks[-1] > close and end - t > close:
            breaks.append(t)
    breaks.append(end)
    # Gauss points project a polynomial of degree n - 1 onto the first n Legendre polynomials exactly.
    degree = max(f.degree for f in varying)
    xi, weights = np.polynomial.legendre.leggauss(degree + 1)
    project = (
        (np.arange(degree + 1) + 0.5)[:, None] * np.polynomial.legendre.legvander(xi, degree).T * weights
    )
    starts, ends = np.array(breaks[:-1]), np.array(breaks[1:])
    points = 0.5 * (starts + ends)[:, None] + 0.5 * (ends - starts)[:, None] * xi
    values = constant + sum(f.evaluate(points) for f in varying)
    return Pieces(tuple(breaks), tuple(map(tuple, (values @ project.T).tolist())))


def grid(
    functions: Sequence[Pieces], domain: tuple[float, float], degree: int, density: int
) -> tuple[Array, Array]:
    """Return points that do not miss extremes of functions of this degree, and the breaks among them.

    Chebyshev points between neighbouring breaks, `density` for each degree: a polynomial does not rise by
    more than a factor 1 / cos(pi / (2 density)) between them. At the breaks there are also left limits.
    """
    start, end = domain
    inner = {t for f in functions for t in f.breaks if start < t < end}
    breaks = np.array([start, *sorted(inner), end])
    count = density * degree if degree > 1 else 1
    nodes = 0.5 - 0.5 * np.cos(np.linspace(0.0, np.pi, count + 1))
    return (breaks[:-1, None] + np.diff(breaks)[:, None] * nodes).ravel(), breaks


def series(polynomial: Sequence[float], start: float, end: float) -> tuple[float, ...]:
    """Return the Legendre coefficients on [start, end] of a polynomial in t, given lowest power first."""
    middle, half = 0.5 * start + 0.5 * end, 0.5 * end - 0.5 * start
    total = [0.0]
    for coefficient in reversed(polynomial):  # Horner's scheme, with polynomials in place of numbers
        t = middle * np.array(total), half * np.polynomial.legendre.legmulx(total)
        total = np.polynomial.legendre.legadd(np.polynomial.legendre.legadd(*t), [coefficient]).tolist()
    return tuple(total)


def linear(points: Array, values: Array) -> Pieces:
    """Return the lines between samples at ascending points; two samples at the same point are a jump."""
    steps = np.diff(points) > 0.0
    before, after = values[:-1][steps], values[1:][steps]
    means, halves = 0.5 * before + 0.5 * after, 0.5 * after - 0.5 * before
    breaks = (*points[:-1][steps].tolist(), float(points[-1]))
    return Pieces(breaks, tuple(zip(means.tolist(), halves.tolist(), strict=True)))


def joined(points: Array, values: Array, spline: bool, start: float, end: float) -> Pieces:
    """Return the lines, or the not-a-knot cubic spline, through samples at ascending points.

    The first and the last piece are extended to `start` and `end`.
    """
    breaks = np.concatenate([[start], points[1:-1], [end]])
    if not spline:
        ends = values.copy()
        ends[0] = _beyond(points[1], values[1], points[0], values[0], start)
        ends[-1] = _beyond(points[-2], values[-2], points[-1], values[-1], end)
        return linear(breaks, ends)
    # Loaded here, since it takes longer than the whole package; scipy has no types.
    from scipy.interpolate import CubicSpline  # type: ignore[import-untyped]

    curve = CubicSpline(points, values, bc_type="not-a-knot")
    middle, half = 0.5 * (breaks[:-1] + breaks[1:]), 0.5 * np.diff(breaks)
    # The Taylor series about the middle, in Legendre polynomials.
    p, dp, d2p, d3p = (curve(middle, k) * half**k for k in range(4))
    columns = (p + d2p / 6.0, dp + d3p / 10.0, d2p / 3.0, d3p / 15.0)
    return Pieces(tuple(breaks.tolist()), tuple(zip(*(column.tolist() for column in columns), strict=True)))


def _beyond(t0: float, v0: float, t1: float, v1: float, t: float) -> float:
    """The value at t of the line through two samples; that of the second at the second."""
    return float(v1 + (v1 - v0) * ((t - t1) / (t1 - t0)))
