"""Growth across the width as the user says: polynomials, samples, functions, with or without jumps."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import Any, TypeAlias

import numpy as np

from .along import AlongInput, amplitude
from .arrays import Array
from .check import Numbers, numbers
from .errors import InputError
from .pieces import Pieces, joined, series
from .resolve import Function, fitted
from .samples import Samples, checked, is_samples
from .terms import FIELDS, SAME, Growth, Shape, Term

__all__ = ["FieldInput", "Profile", "path_of"]

FieldInput: TypeAlias = Numbers | Sequence[Numbers] | Samples | Function
"""A field across the width: a polynomial, one for each piece, samples (x, values), or a function of x."""

MAX_COEFFICIENTS = 33
"""Longest polynomial: degree 32."""

MOST_PIECES = 1000
"""Most pieces across the width."""

CLOSEST = 1e-9
"""Least distance of two samples or two breaks."""


def path_of(name: object) -> str:
    """Return the path of a growth of this name, which is part of the names of traced parameters."""
    if not isinstance(name, str) or not name.isidentifier():
        raise InputError("growth.name", name, "an identifier, such as 'edge'")
    return f"growth.{name}"


def Profile(
    gamma33: FieldInput | None = None,
    d33: FieldInput | None = None,
    d22: FieldInput | None = None,
    d23: FieldInput | None = None,
    g21: FieldInput | None = None,
    g31: FieldInput | None = None,
    gamma22: FieldInput | None = None,
    gamma23: FieldInput | None = None,
    *,
    breaks: Numbers = (),
    spline: bool = False,
    amplitude: AlongInput = 1.0,
    name: str = "profile",
) -> Growth:
    """Return growth given field by field across the width, x = X2/a in [-1/2, 1/2].

    Each field is one of

    - coefficients in x, lowest power first, at most 33;
    - with `breaks`: a list of such lists, in the same x, one for each piece;
    - samples: a tuple (x, values) of two sequences, joined by lines or, with `spline`, by a not-a-knot cubic
      spline. They reach to the edges, or are extended there by no more than their spacing. With
      `breaks`, each piece is joined on its own, and a sample at a break is given twice, with the value to its
      left and the value to its right;
    - a function of x, called with an array (n,) and returning one. It is resolved to rounding on each piece,
      or refused with the number of points it would take.

    Parameters
    ----------
    gamma33, d33, d22, d23, g21, g31, gamma22, gamma23 : see above
        A field left out is zero. g31 must not jump: the energy would be infinite.
    breaks : sequence of float
        Ascending x inside the width at which fields may jump or have kinks.
    spline : bool
        Join samples smoothly: at least 4 on each piece.
    amplitude : float, (S, values), or callable
        Factor of the whole; along the ribbon as in `edge`.
    name : str
        Name of this growth within a sum.

    Raises
    ------
    InputError
        Anything else, and samples or functions that do not define the field on the whole width.

    Examples
    --------
    The middle third grows more:

    >>> rib = Profile(gamma33=[[0.0], [0.02], [0.0]], breaks=[-1 / 6, 1 / 6])
    >>> rib.values(x=[-0.4, 0.0, 0.4])["gamma33"].tolist()
    [0.0, 0.02, 0.0]

    A function:

    >>> import numpy as np
    >>> wave = Profile(gamma33=lambda x: 0.01 * np.cos(2 * np.pi * x))
    >>> round(float(wave.values(x=0.25)["gamma33"]), 12)
    0.0
    """
    path = path_of(name)
    given: Mapping[str, FieldInput | None] = {
        "gamma33": gamma33,
        "d33": d33,
        "d22": d22,
        "d23": d23,
        "g21": g21,
        "g31": g31,
        "gamma22": gamma22,
        "gamma23": gamma23,
    }
    edges = (-0.5, *_breaks(f"{path}.breaks", breaks), 0.5)
    if not isinstance(spline, bool):
        raise InputError(f"{path}.spline", spline, "true or false")
    shape = tuple(
        (key, _shape(f"{path}.{key}", value, edges, spline))
        for key, value in given.items()
        if value is not None
    )
    if not shape:
        raise InputError(path, {}, f"at least one of {', '.join(FIELDS)}")
    for key, field in shape:
        if key == "g31" and isinstance(field, Pieces):
            _check_continuous(f"{path}.{key}", field)
    return Growth((Term(name, _amplitude(f"{path}.amplitude", amplitude), shape),))


_amplitude = amplitude  # in `Profile` the name is an argument


def _breaks(field: str, value: Any) -> tuple[float, ...]:
    breaks = numbers(field, value)
    if len(breaks) >= MOST_PIECES:
        raise InputError(field, value, f"at most {MOST_PIECES - 1} numbers")
    for i, (before, x) in enumerate(zip((-0.5, *breaks), breaks, strict=False)):
        if not -0.5 < x < 0.5:
            raise InputError(f"{field}[{i}]", x, "a number inside (-1/2, 1/2)")
        if x - before < CLOSEST or 0.5 - x < CLOSEST:
            raise InputError(f"{field}[{i}]", x, f"ascending numbers, {CLOSEST:g} apart and inside the edges")
    return breaks


def _shape(field: str, value: Any, edges: tuple[float, ...], spline: bool) -> Shape:
    """A field of any kind, checked."""
    if callable(value):
        return fitted(field, value, edges)
    if is_samples(value):
        return _sampled(field, value, edges, spline)
    if isinstance(value, np.ndarray):
        value = value.tolist()
    if isinstance(value, list) and value and isinstance(value[0], list | tuple | np.ndarray):
        return _polynomials(field, value, edges)
    return _polynomial(field, value)


def _polynomial(field: str, value: Any) -> tuple[float, ...]:
    expected = f"polynomial coefficients, lowest power first, 1 to {MAX_COEFFICIENTS} finite numbers"
    coefficients = numbers(field, value, f"{expected}, samples (x, values) or a function of x")
    if not 1 <= len(coefficients) <= MAX_COEFFICIENTS:
        raise InputError(field, value, expected)
    return coefficients


def _polynomials(field: str, value: list[Any], edges: tuple[float, ...]) -> Pieces:
    intervals = list(pairwise(edges))
    if len(value) != len(intervals) or len(intervals) == 1:
        expected = f"one polynomial for each of the pieces that breaks= make, here {len(intervals)}"
        raise InputError(field, value, expected)
    pieces = (_polynomial(f"{field}[{i}]", entry) for i, entry in enumerate(value))
    return Pieces(edges, tuple(series(p, a, b) for p, (a, b) in zip(pieces, intervals, strict=True)))


def _sampled(field: str, value: Any, edges: tuple[float, ...], spline: bool) -> Pieces:
    """Samples joined on each piece between the edges."""
    x, values = checked(field, value, "x")
    if x.size > MOST_PIECES:
        raise InputError(f"{field}.x", value[0], f"at most {MOST_PIECES} samples")
    for edge in edges:
        x[np.abs(x - edge) <= SAME] = edge
    outside = np.flatnonzero(np.abs(x) > 0.5)
    if outside.size:
        i = int(outside[0])
        raise InputError(f"{field}.x[{i}]", float(x[i]), "numbers in [-1/2, 1/2]: x = X2/a")
    places = np.searchsorted(x, edges[1:-1], "left"), np.searchsorted(x, edges[1:-1], "right")
    for edge, first, last in zip(edges[1:-1], *places, strict=True):
        if last - first not in (0, 2):
            expected = f"two samples at the break x = {edge:g}: the value to its left, then that to its right"
            raise InputError(f"{field}.x[{first}]", edge, expected)
    starts = [0, *((first + last) // 2 for first, last in zip(*places, strict=True)), x.size]
    breaks: list[float] = [-0.5]
    pieces: list[tuple[float, ...]] = []
    for first, last, a, b in zip(starts[:-1], starts[1:], edges[:-1], edges[1:], strict=True):
        _check_piece(field, x, first, last, (a, b), 4 if spline else 2)
        part = joined(x[first:last], values[first:last], spline, a, b)
        breaks.extend(part.breaks[1:])
        pieces.extend(part.coefficients)
    return Pieces(tuple(breaks), tuple(pieces))


def _check_piece(field: str, x: Array, first: int, last: int, ends: tuple[float, float], least: int) -> None:
    """Check that the samples from `first` to before `last` define the field from one end to the other."""
    a, b = (f"{end:g}" for end in ends)
    if last - first < least:
        found = f"{last - first} samples"
        raise InputError(f"{field}.x", found, f"at least {least} samples between x = {a} and x = {b}")
    steps = np.diff(x[first:last])
    if np.min(steps) < CLOSEST:
        i = first + 1 + int(np.argmin(steps))
        raise InputError(
            f"{field}.x[{i}]", float(x[i]), f"ascending numbers, {CLOSEST:g} apart; breaks= mark jumps"
        )
    gaps = (x[first] - ends[0], ends[1] - x[last - 1])
    if gaps[0] > steps[0] * (1.0 + CLOSEST) or gaps[1] > steps[-1] * (1.0 + CLOSEST):
        i = first if gaps[0] > steps[0] else last - 1
        expected = f"samples from x = {a} to x = {b}, or no farther from either than from the next sample"
        raise InputError(f"{field}.x[{i}]", float(x[i]), expected)


def _check_continuous(field: str, pieces: Pieces) -> None:
    x = np.array(pieces.breaks[1:-1])
    jumps = np.abs(pieces.evaluate(x) - pieces.evaluate(x, left=True))
    size = max(sum(map(abs, piece)) for piece in pieces.coefficients)
    jumping = np.flatnonzero(jumps > SAME * size)
    if jumping.size:
        i = int(jumping[0])
        expected = f"a continuous field, not a jump at x = {x[i]:g}, whose energy is infinite"
        raise InputError(field, float(jumps[i]), expected)
