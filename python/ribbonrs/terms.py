"""Sums of growths: each a shape across the width times an amplitude, which may vary along the ribbon."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from .along import Amplitude, check_covers, evaluated
from .arrays import Array, real_array
from .errors import InputError
from .pieces import Pieces, grid
from .resolve import adapted

__all__ = ["FIELDS", "SAME", "CorePieces", "CoreTerm", "Growth", "Shape", "Term", "core_pieces"]

FIELDS = ("gamma33", "d33", "d22", "d23", "g21", "g31", "gamma22", "gamma23")
"""The parts of the growth tensor that act."""

SAME = 1e-12
"""How far x may be from an edge or a break, by rounding, to be at it."""

Shape: TypeAlias = tuple[float, ...] | Pieces
"""A field across the width: coefficients in x, lowest power first, or pieces from -1/2 to 1/2."""

CorePieces: TypeAlias = tuple[list[float], list[list[float]]]

CoreTerm: TypeAlias = tuple[float | CorePieces, dict[str, list[float] | CorePieces]]
"""A term as the core takes it: pieces are their breaks and the Legendre coefficients of each."""


@dataclass(frozen=True)
class Term:
    """One growth of a sum.

    Attributes
    ----------
    name : str
        Its name within the sum.
    amplitude : float, Pieces or callable
        A number, samples over S = X3/a, or the user's function of S.
    shape : tuple of (str, tuple of float or Pieces)
        Each field present and what it is at amplitude 1.
    """

    name: str
    amplitude: Amplitude
    shape: tuple[tuple[str, Shape], ...]

    @property
    def path(self) -> str:
        """The name of the amplitude, in errors and as a parameter."""
        return f"growth.{self.name}.amplitude"

    @cached_property
    def bounds(self) -> dict[str, float]:
        """Numbers that the fields do not exceed."""
        size = _bound(self.amplitude)
        return {key: size * _bound(shape) for key, shape in self.shape}

    @cached_property
    def _resolved(self) -> dict[float, Pieces]:
        """A function of S as pieces, for each length so far."""
        return {}

    def along(self, length: float | None) -> float | Pieces:
        """Return the amplitude as a number or pieces; a function of S is resolved on [0, length], once."""
        if not callable(self.amplitude):
            return self.amplitude
        if length is None:
            raise InputError("length", length, f"the length over the width: {self.path} is a function of S")
        if length not in self._resolved:
            self._resolved[length] = adapted(self.path, self.amplitude, length)
        return self._resolved[length]


@dataclass(frozen=True)
class Growth:
    """A sum of growths of different names; made by the functions of `ribbonrs.growth`.

    Raises
    ------
    InputError
        If two terms have the same name, or the sum is too large for a floating-point number.

    Examples
    --------
    >>> import ribbonrs as rb
    >>> (rb.growth.edge(0.06) + rb.growth.chiral(0.04)).values(x=0.5)
    {'gamma33': array(0.06), 'd23': array(0.04)}
    """

    terms: tuple[Term, ...]

    def __post_init__(self) -> None:
        names: set[str] = set()
        bounds: dict[str, float] = {}
        for term in self.terms:
            if term.name in names:
                raise InputError("growth.name", term.name, "a different name for each growth of a sum")
            names.add(term.name)
            for key, bound in term.bounds.items():
                bounds[key] = bounds.get(key, 0.0) + bound
        for key, bound in bounds.items():
            if not math.isfinite(bound):
                raise InputError(f"growth.{key}", math.inf, "a sum of finite numbers")

    def __add__(self, other: Growth) -> Growth:
        if not isinstance(other, Growth):
            return NotImplemented
        return Growth(self.terms + other.terms)

    def __radd__(self, other: int) -> Growth:
        """Let `sum` start from its 0."""
        return self if other == 0 else NotImplemented

    @property
    def varies(self) -> bool:
        """Whether it varies along the ribbon."""
        return not all(isinstance(term.amplitude, float) for term in self.terms)

    @property
    def domain(self) -> tuple[float, float] | None:
        """The S that all samples along the ribbon cover, None if there are no samples."""
        ranges = [term.amplitude.domain for term in self.terms if isinstance(term.amplitude, Pieces)]
        if not ranges:
            return None
        starts, ends = zip(*ranges, strict=True)
        return max(starts), min(ends)

    def check_covers(self, length: float) -> None:
        """Refuse samples along the ribbon that do not reach from S = 0 to `length`, in units of the width."""
        for term in self.terms:
            if isinstance(term.amplitude, Pieces):
                check_covers(term.path, term.amplitude, length)

    def core_terms(self, length: float | None = None) -> list[CoreTerm]:
        """Return the terms as the core takes them: (amplitude, {field: shape}).

        Numbers, and lists of polynomial coefficients in x, stay what they are; all else becomes breaks and
        Legendre coefficients. `length` is that of the ribbon in units of its width: functions of S need it.
        """
        terms: list[CoreTerm] = []
        for term in self.terms:
            amplitude = term.along(length)
            shapes = {key: core_pieces(s) if isinstance(s, Pieces) else list(s) for key, s in term.shape}
            terms.append((core_pieces(amplitude) if isinstance(amplitude, Pieces) else amplitude, shapes))
        return terms

    def values(self, x: ArrayLike, S: ArrayLike = 0.0) -> dict[str, Array]:
        """Return the growth fields present, at x = X2/a in [-1/2, 1/2] and S = X3/a, broadcast.

        Where a field jumps it is the value to the right.

        Raises
        ------
        InputError
            If x is outside the width, S outside of samples along the ribbon, or shapes do not broadcast.
        """
        expected = "finite numbers in [-1/2, 1/2]"
        points = real_array("x", x, expected)
        outside = points[np.abs(points) > 0.5 + SAME]
        if outside.size:
            raise InputError("x", float(outside[0]), expected)
        stations = real_array("S", S, "finite numbers")
        try:
            shape = np.broadcast_shapes(points.shape, stations.shape)
        except ValueError:
            expected = f"one that broadcasts with {points.shape}, that of x"
            raise InputError("S.shape", stations.shape, expected) from None
        sums: dict[str, Array] = {}
        for term in self.terms:
            amplitude = evaluated(term.path, term.amplitude, stations)
            for key, profile in term.shape:
                sums[key] = sums.get(key, np.zeros(shape)) + amplitude * _profile(profile, points)
        return {key: np.asarray(sums[key]) for key in FIELDS if key in sums}

    @property
    def slopes(self) -> Growth:
        """The growth whose fields are the derivatives of these in x."""
        return Growth(
            tuple(
                Term(term.name, term.amplitude, tuple((key, _slope(shape)) for key, shape in term.shape))
                for term in self.terms
            )
        )

    def size(self, thickness_ratio: float, length: float | None = None) -> float:
        """Return the largest growth strain over the cross-section, and along the ribbon where it varies.

        The maximum over x in [-1/2, 1/2], over S in [0, length] and over the fields of the absolute value of
        gamma33, gamma22, gamma23, g21, g31, and of d33, d22, d23 times half the thickness ratio: growth at
        the faces. Found on points that miss at most 2 % of it.
        """
        sizes = [0.0]
        for key in FIELDS:
            parts = self._of(key)
            if parts:
                lever = thickness_ratio / 2 if key.startswith("d") else 1.0
                with np.errstate(over="ignore", invalid="ignore"):
                    amplitudes = _amplitudes([term.along(length) for term, _ in parts], length)
                    profiles = _profiles([shape for _, shape in parts])
                    sizes.append(lever * _largest_sum(amplitudes, profiles))
        return float(np.max(sizes))  # NaN, where huge terms cancel, is the largest

    def axial(self, length: float) -> float:
        """Return the largest mean of gamma33 over the width, along a ribbon of `length` over its width.

        A ribbon without load is not strained more along its centreline. Accurate to 2 %, as `size`.
        """
        parts = self._of("gamma33")
        if not parts:
            return 0.0
        amplitudes = _amplitudes([term.along(length) for term, _ in parts], length)
        means = np.array([_mean(shape) for _, shape in parts])
        return float(np.max(means @ amplitudes))

    def _of(self, key: str) -> list[tuple[Term, Shape]]:
        """The terms with this field, and its shape in each."""
        return [(term, shape) for term in self.terms for name, shape in term.shape if name == key]


def core_pieces(pieces: Pieces) -> CorePieces:
    """Return pieces as the core takes them."""
    return list(pieces.breaks), [list(coefficients) for coefficients in pieces.coefficients]


def _profile(shape: Shape, x: Array, left: bool = False) -> Array:
    """A field at x; where it jumps the value to the right or to the left."""
    if isinstance(shape, Pieces):
        return shape.evaluate(x, left)
    return np.asarray(np.polynomial.polynomial.polyval(x, np.array(shape)), dtype=np.float64)


def _slope(shape: Shape) -> Shape:
    """The derivative of a field, on each piece."""
    if isinstance(shape, Pieces):
        return shape.derivative
    return tuple(float(k * c) for k, c in enumerate(shape))[1:] or (0.0,)


def _mean(shape: Shape) -> float:
    """The mean of a field over the width."""
    if isinstance(shape, Pieces):
        widths = np.diff(shape.breaks)
        return float(sum(width * c[0] for width, c in zip(widths, shape.coefficients, strict=True)))
    return sum(c * 0.5**k / (k + 1) for k, c in enumerate(shape) if k % 2 == 0)


def _bound(function: Shape | Amplitude) -> float:
    """A number that the function does not exceed; 1 for one of the user's, whose values are limited."""
    if isinstance(function, Pieces):
        return max(sum(map(abs, piece)) for piece in function.coefficients)
    if isinstance(function, tuple):
        return sum(map(abs, function))
    return 1.0 if callable(function) else abs(function)


def _profiles(shapes: Sequence[Shape]) -> Array:
    """Fields (k, n) at common points across the width, which do not miss their extremes."""
    degree = max(s.degree if isinstance(s, Pieces) else len(s) - 1 for s in shapes)
    x, breaks = grid([s for s in shapes if isinstance(s, Pieces)], (-0.5, 0.5), degree, density=32)
    return np.stack([np.concatenate([_profile(s, x), _profile(s, breaks, left=True)]) for s in shapes])


def _amplitudes(amplitudes: Sequence[float | Pieces], length: float | None) -> Array:
    """Amplitudes (k, n) at common points along the ribbon; n = 1 if none of them varies."""
    varying = [a for a in amplitudes if isinstance(a, Pieces)]
    if not varying:
        return np.array(amplitudes, dtype=np.float64)[:, None]
    starts, ends = zip(*(a.domain for a in varying), strict=True)
    domain = (max(starts), min(ends)) if length is None else (0.0, length)
    S, breaks = grid(varying, domain, max(a.degree for a in varying), density=8)
    rows = []
    for amplitude in amplitudes:
        known = amplitude if isinstance(amplitude, Pieces) else Pieces((0.0, 1.0), ((amplitude,),))
        rows.append(np.concatenate([known.evaluate(S), known.evaluate(breaks, left=True)]))
    return np.stack(rows)


def _largest_sum(amplitudes: Array, profiles: Array) -> float:
    """The largest absolute value of sum_k a_k(S) f_k(x), amplitudes (k, n) and profiles (k, m)."""
    rows = max(1, 1_000_000 // profiles.shape[1])  # of the table (n, m) at a time
    largest = 0.0
    for i in range(0, amplitudes.shape[1], rows):
        some = amplitudes[:, i : i + rows]
        present = np.any(some != 0.0, axis=1)  # of many stations two
        values = np.abs(some[present].T @ profiles[present])
        largest = float(np.maximum(largest, np.max(values)))
    return largest
