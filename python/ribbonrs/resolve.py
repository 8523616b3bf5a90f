"""Functions of the user's, called at points and turned into Legendre series that meet them to rounding."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from functools import lru_cache, partial
from itertools import pairwise
from typing import Any, TypeAlias

import numpy as np

from .arrays import Array
from .check import LARGEST
from .errors import InputError, shown
from .pieces import Pieces

__all__ = ["Function", "adapted", "called", "fitted"]

Function: TypeAlias = Callable[[Array], Any]
"""A function of the user's: array (n,) -> array (n,)."""

EPS = float(np.finfo(np.float64).eps)

COUNTS = (9, 17, 33, 65, 129, 257)
"""Points tried on a piece of the width."""

CHECKS = 2049
"""Points at which a series must meet the function on a piece."""

LOCAL_COUNTS = (9, 17, 33)
"""Points tried on a piece along the ribbon, which can be made shorter."""

MOST_PIECES = 1000
"""Most pieces along the ribbon."""

SHARP = 1e-11
"""What is no smoother than this, relative to the length, is a kink or a jump."""

DIAGNOSIS = 1025
"""Points taken to say how many it would take."""


def called(field: str, function: Function, points: Array, variable: str) -> Array:
    """Return the values of the user's function at `points` (...), array (...).

    Raises
    ------
    InputError
        Naming `field`, if the function raises anything (kept as the cause) or returns what is not an array
        of as many finite real numbers, none of them masked.
    """
    expected = f"a function of {variable} that takes an array and returns one of the same shape"
    try:
        with np.errstate(all="ignore"):
            returned = function(points.copy())
    except Exception as error:
        reason = f"{type(error).__name__}: {shown(str(error))}"
        raise InputError(field, function, f"{expected}, not one that raises {reason}") from error
    try:
        values = np.asarray(returned)
    except ValueError:  # ragged nesting
        values = np.asarray(None)
    if np.ma.is_masked(returned):
        raise InputError(field, returned, f"numbers that are not masked from {expected}")
    if values.dtype.kind not in "iuf":
        raise InputError(field, returned, f"real numbers from {expected}")
    if values.shape != points.shape:
        raise InputError(field, function, f"{expected}, not {values.shape} for {points.shape}")
    if values.dtype.kind == "f" and values.dtype.itemsize < 8:
        raise InputError(field, function, f"{expected} of 64-bit numbers, not {values.dtype}")
    values = values.astype(np.float64)
    bad = ~(np.abs(values) <= LARGEST)
    if np.any(bad):
        value, place = float(values[bad][0]), float(points[bad][0])
        kind = f"values of at most {LARGEST:g}" if math.isfinite(value) else "finite values"
        raise InputError(field, value, f"{kind}, unlike at {variable} = {place:.6g}")
    return values


def fitted(field: str, function: Function, edges: Sequence[float]) -> Pieces:
    """Return a function of x as one series on each piece between `edges`, to rounding of its largest value.

    It is called at 9, 17, ... 257 points within each piece until the series meets it at two thousand others.

    Raises
    ------
    InputError
        If it is not smooth enough for that: how many points it would take, and where the trouble is.
    """
    call = partial(called, field, function, variable="x")
    intervals = list(pairwise(edges))
    known = [call(_between(_checks(CHECKS), a, b)) for a, b in intervals]
    size = max(float(np.max(np.abs(values))) for values in known)
    pieces = []
    for (a, b), values in zip(intervals, known, strict=True):
        coefficients = _series(call, a, b, COUNTS, values, size)
        if coefficients is None:
            raise InputError(field, function, _unresolved(call, a, b, values, size))
        pieces.append(coefficients)
    return Pieces(tuple(edges), tuple(pieces))


def adapted(field: str, function: Function, length: float) -> Pieces:
    """Return a function of S on [0, length] in as many pieces as it takes, to rounding of its largest value.

    Pieces meet at its kinks, and are halved until 33 points resolve them.

    Raises
    ------
    InputError
        If it jumps, is infinitely steep somewhere, or takes more than 1000 pieces.
    """
    call = partial(called, field, function, variable="S")
    size = float(np.max(np.abs(call(_between(_checks(CHECKS), 0.0, length)))))
    breaks, pieces, ends = [0.0], [], [length]
    while ends:
        start, end = breaks[-1], ends[-1]
        values = call(_between(_checks(CHECKS), start, end))
        coefficients = _series(call, start, end, LOCAL_COUNTS, values, size)
        if coefficients is not None:
            pieces.append(coefficients)
            breaks.append(ends.pop())
        elif len(breaks) + len(ends) > MOST_PIECES:
            raise InputError(field, function, f"a function of S that {MOST_PIECES} pieces resolve")
        else:
            place, steep = _division(call, start, end, length, size)
            if steep:
                reason = f"not one that jumps or is infinitely steep as near S = {place:.6g}"
                raise InputError(field, function, f"a function of S, {reason}; samples mark jumps, S twice")
            ends.append(place)
    return Pieces(tuple(breaks), tuple(pieces))


_Call: TypeAlias = Callable[[Array], Array]


@lru_cache(maxsize=16)
def _rule(count: int) -> tuple[Array, Array]:
    """Chebyshev points (n,) in (-1, 1), symmetric to the last bit, n odd; P_k at those >= 0."""
    xi: Array = np.sin(np.pi * np.arange(1 - count, count, 2, dtype=np.float64) / (2 * count))
    return xi, np.asarray(np.polynomial.legendre.legvander(xi[count // 2 :], count - 1), dtype=np.float64)


@lru_cache(maxsize=16)
def _checks(count: int) -> Array:
    """Points (n,) in (-1, 1), denser towards the ends, that share no symmetry and no period.

    The angles of their cosines are multiples of the golden ratio.
    """
    angles = np.pi * np.mod(np.arange(1, count + 1) * (0.5 * 5.0**0.5 - 0.5), 1.0)
    return np.asarray(np.cos(angles), dtype=np.float64)


def _between(xi: Array, a: float, b: float) -> Array:
    """The points of [a, b] at xi in [-1, 1]; never an end, which may be a jump."""
    return np.asarray(0.5 * (a + b) + 0.5 * (b - a) * xi)


def _interpolated(values: Array) -> Array:
    """The Legendre coefficients (n,) of the polynomial through values (n,) at the Chebyshev points.

    Even and odd parts are kept apart, so that a symmetric function has a symmetric series.
    """
    middle = values.size // 2
    vandermonde = _rule(values.size)[1]
    right, left = values[middle:], values[middle::-1]
    coefficients = np.empty(values.size)
    coefficients[::2] = np.linalg.solve(vandermonde[:, ::2], 0.5 * (right + left))
    coefficients[1::2] = np.linalg.solve(vandermonde[1:, 1::2], 0.5 * (right - left)[1:])
    return coefficients


def _series(
    call: _Call, a: float, b: float, counts: Iterable[int], checks: Array, size: float
) -> tuple[float, ...] | None:
    """The series from the fewest points that meets the function on [a, b], None if none does.

    `checks` are the function's values at as many check points.
    """
    for count in counts:
        full = _interpolated(call(_between(_rule(count)[0], a, b)))
        short = _met(full, a, b, checks, size)
        if short is not None:
            return short
    return None


def _met(series: Array, a: float, b: float, checks: Array, size: float) -> tuple[float, ...] | None:
    """The series, without coefficients that are rounding, if it meets the function on [a, b], else None."""
    xi = _checks(checks.size)
    error = float(np.max(np.abs(np.polynomial.legendre.legval(xi, series) - checks)))
    slope = (
        2.0
        / (b - a)
        * float(np.max(np.abs(np.polynomial.legendre.legval(xi, np.polynomial.legendre.legder(series)))))
    )
    # Rounding of the values, and of the points at which they are taken.
    if error > 16.0 * EPS * size + 2.0 * EPS * max(abs(a), abs(b)) * slope:
        return None
    # What is no larger than the last coefficients is rounding, if the series is as good without it.
    last = float(np.max(np.abs(series[-(series.size // 8) :])))
    for noise in (max(4.0 * EPS * size, last), 2.0 * EPS * size, 0.5 * EPS * size):
        kept = np.flatnonzero(np.abs(series) > noise)
        short = series[: kept[-1] + 1] if kept.size else np.zeros(1)
        if float(np.max(np.abs(np.polynomial.legendre.legval(xi, short) - checks))) <= 2.0 * max(
            EPS * size, error
        ):
            return tuple(short.tolist())
    return tuple(series.tolist())


@lru_cache(maxsize=1)
def _low_degree() -> tuple[Array, Array]:
    """Points (n,) in (-1, 1), and the matrix that takes values there to what a polynomial of degree 8 misses.

    The polynomial goes through the first nine values and misses the other n - 9.
    """
    nodes, others = _rule(9)[0], _checks(33)
    through = np.polynomial.legendre.legvander(others, 8) @ np.linalg.inv(
        np.polynomial.legendre.legvander(nodes, 8)
    )
    return np.concatenate([nodes, others]), np.hstack([-through, np.eye(others.size)])


def _pinned(call: _Call, a: float, b: float, size: float) -> tuple[float, float]:
    """The small interval about the worst of what keeps the function from being a low polynomial.

    Of its left, right and middle half that one is taken which a polynomial of degree 8 fits worst, and so on
    until all fit to rounding. What lies where two halves meet is inside the third.
    """
    xi, misses = _low_degree()
    least = EPS * (b - a)
    while b - a > max(64.0 * EPS * max(abs(a), abs(b)), least):
        w = b - a
        halves = ((a, a + 0.5 * w), (a + 0.25 * w, a + 0.75 * w), (a + 0.5 * w, b))
        points = np.stack([_between(xi, *half) for half in halves])
        values = call(points.ravel()).reshape(points.shape)
        errors = np.max(np.abs(values @ misses.T), axis=1)
        with np.errstate(over="ignore"):  # infinite where the interval is a few floating-point numbers
            slope = float(np.max(np.abs(np.diff(values[:, :9])) / np.diff(points[:, :9])))
        if np.max(errors) <= 4.0 * EPS * size + 2.0 * EPS * max(abs(a), abs(b)) * slope:
            break
        a, b = halves[int(np.argmax(errors))]
    return a, b


def _division(call: _Call, a: float, b: float, length: float, size: float) -> tuple[float, bool]:
    """Where to divide [a, b], at a kink if there is one, else in the middle; whether it is steep there."""
    lo, hi = _pinned(call, a, b, size)
    if hi - lo > SHARP * length:  # smooth when seen from near enough
        return 0.5 * (a + b), False
    place = 0.5 * (lo + hi)
    before, across, after = np.abs(
        np.diff(call(np.array([max(a, 2 * lo - hi), lo, hi, min(b, 2 * hi - lo)])))
    )
    jump = across > 1e-10 * size + 10.0 * (before + after)
    return place, bool(jump or min(place - a, b - place) < SHARP * length)


def _unresolved(call: _Call, a: float, b: float, checks: Array, size: float) -> str:
    """What a function on [a, b] should have been that 257 points do not resolve."""
    enough = f"a function that {COUNTS[-1]} points on a piece resolve"
    coefficients = _interpolated(call(_between(_rule(DIAGNOSIS)[0], a, b)))
    if _met(coefficients, a, b, checks, size) is not None:
        rounding = max(16.0 * EPS * size, 2.0 * float(np.max(np.abs(coefficients[-DIAGNOSIS // 8 :]))))
        points = int(np.flatnonzero(np.abs(coefficients) > rounding)[-1])
        return f"{enough}, not about {points}: divide it with breaks="
    xi = _checks(checks.size)
    worst = float(
        _between(xi, a, b)[np.argmax(np.abs(np.polynomial.legendre.legval(xi, coefficients) - checks))]
    )
    margin = (b - a) / 64
    lo, hi = _pinned(call, max(a, worst - margin), min(b, worst + margin), size)
    place = f"near x = {round(0.5 * (lo + hi), 9) + 0.0:.6g}"
    low, high = (max(EPS * size, *np.abs(coefficients[i : 2 * i]).tolist()) for i in (64, 256))
    # Coefficients fall as k^(-1/2) for a jump, whose series does not converge, and as k^(-3/2) for a kink.
    decay = math.log(low / high) / math.log(4.0)
    if hi - lo > 1e-9 * (b - a) and decay < 1.0:
        return f"{enough}, not more than {DIAGNOSIS} as {place}"
    if decay < 0.75:
        return (
            f"a function without the jump {place}, which no number of points resolves: mark it with breaks="
        )
    points = 256.0 * (high / (EPS * size)) ** (1.0 / decay)
    return f"{enough}, not about {points:.0e} for the kink {place}: mark it with breaks="
