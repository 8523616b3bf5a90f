"""How the ribbon grows: small growth strains over its cross-section.

The growth tensor is G = I + g. Of g these parts act, as functions of x = X2/a across the width:

- gamma33: axial growth of the mid-surface; gamma22 and gamma23: its transverse and shear growth g22 and
  g23 + g32, which only move points within the cross-section;
- d33, d22, d23: gradients through the thickness, g33 = gamma33 + (X1/a) d33 and alike for g22 and
  g23 + g32;
- g21, g31: transverse shear growth.

Growths add: ``edge(0.06) + chiral(0.04)``.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import zip_longest
from typing import TypeAlias

import numpy as np

from .check import Numbers, number, numbers
from .errors import InputError

__all__ = ["FIELDS", "Growth", "Profile", "Term", "chiral", "edge", "thickness"]

FIELDS = ("gamma33", "d33", "d22", "d23", "g21", "g31", "gamma22", "gamma23")
"""The parts of the growth tensor that act."""

MAX_COEFFICIENTS = 33
"""Longest polynomial: degree 32."""

Polynomials: TypeAlias = tuple[tuple[str, tuple[float, ...]], ...]
"""Pairs of a field and its coefficients, lowest power of x first."""


@dataclass(frozen=True)
class Term:
    """One growth of a sum: a fixed shape across the width, times an amplitude."""

    name: str
    amplitude: float
    shape: Polynomials


@dataclass(frozen=True)
class Growth:
    """A sum of growths of different names; made by `edge`, `thickness`, `chiral` and `Profile`.

    Raises
    ------
    InputError
        If two terms have the same name, or the sum is too large for a floating-point number.

    Examples
    --------
    >>> (edge(0.06) + chiral(0.04)).fields()
    {'gamma33': [0.0, 0.0, 0.24], 'd23': [0.04]}
    """

    terms: tuple[Term, ...]

    def __post_init__(self) -> None:
        names = [term.name for term in self.terms]
        for name in names:
            if names.count(name) > 1:
                raise InputError("growth.name", name, "a different name for each growth of a sum")
        for field, coefficients in self.fields().items():
            if not all(map(math.isfinite, coefficients)):
                raise InputError(f"growth.{field}", coefficients, "a sum of finite numbers")

    def __add__(self, other: Growth) -> Growth:
        if not isinstance(other, Growth):
            return NotImplemented
        return Growth(self.terms + other.terms)

    def __radd__(self, other: int) -> Growth:
        """Let `sum` start from its 0."""
        return self if other == 0 else NotImplemented

    def fields(self) -> dict[str, list[float]]:
        """Return the polynomial coefficients of each field present, lowest power of x = X2/a first."""
        sums: dict[str, list[float]] = {}
        for term in self.terms:
            for field, shape in term.shape:
                added = [term.amplitude * c for c in shape]
                sums[field] = [a + b for a, b in zip_longest(sums.get(field, []), added, fillvalue=0.0)]
        return {field: sums[field] for field in FIELDS if field in sums}

    def size(self, thickness_ratio: float) -> float:
        """Return the largest growth strain over the cross-section.

        The maximum over x in [-1/2, 1/2] and over the fields of the absolute value of gamma33, gamma22,
        gamma23, g21, g31, and of d33, d22, d23 times half the thickness ratio: growth at the faces.
        """
        sizes = [0.0]
        for field, coefficients in self.fields().items():
            lever = thickness_ratio / 2 if field.startswith("d") else 1.0
            # Polynomials this low cannot rise by more than 0.2 % between so many Chebyshev points.
            values = np.polynomial.polynomial.polyval(_CHEBYSHEV, coefficients)
            sizes.append(lever * float(np.max(np.abs(values))))
        return max(sizes)


_CHEBYSHEV = np.cos(np.linspace(0.0, np.pi, 1025)) / 2


def edge(xi: float, name: str = "edge") -> Growth:
    """Return growth along the ribbon that is largest at its edges, g33 = xi (2 X2/a)^2.

    Parameters
    ----------
    xi : float
        Growth strain at the edges; the amplitude.
    name : str
        Name of this growth within a sum.

    Notes
    -----
    Source: Liu, Li & Liu, eq. (51).
    """
    return _single(name, number(_path(name), xi), (("gamma33", (0.0, 0.0, 4.0)),))


def thickness(xi: float, transverse: float = 0.0, name: str = "thickness") -> Growth:
    """Return growth that varies through the thickness, g33 = xi X1/a and g22 = transverse X1/a.

    Parameters
    ----------
    xi : float
        Gradient of the growth along the ribbon; the amplitude (where it is zero, `transverse` is).
    transverse : float
        Gradient of the growth across it; ``-xi / 2`` makes a saddle.
    name : str
        Name of this growth within a sum.

    Notes
    -----
    Source: Liu, Li & Liu, eq. (44), without the transverse part.
    """
    along = number(f"{_path(name)}.xi", xi)
    across = number(f"{_path(name)}.transverse", transverse)
    if across == 0.0:
        return _single(name, along, (("d33", (1.0,)),))
    if along == 0.0:
        return _single(name, across, (("d22", (1.0,)),))
    return _single(name, along, (("d33", (1.0,)), ("d22", (across / along,))))


def chiral(d: float, name: str = "chiral") -> Growth:
    """Return shear growth that varies through the thickness, g23 + g32 = d X1/a.

    It gives the ribbon a natural twist, of the sign of `d`: oblique fibres, say.

    Parameters
    ----------
    d : float
        Gradient of the shear growth; the amplitude.
    name : str
        Name of this growth within a sum.
    """
    return _single(name, number(_path(name), d), (("d23", (1.0,)),))


def Profile(
    gamma33: Numbers | None = None,
    d33: Numbers | None = None,
    d22: Numbers | None = None,
    d23: Numbers | None = None,
    g21: Numbers | None = None,
    g31: Numbers | None = None,
    gamma22: Numbers | None = None,
    gamma23: Numbers | None = None,
    *,
    amplitude: float = 1.0,
    name: str = "profile",
) -> Growth:
    """Return growth given by a polynomial across the width for each field.

    Parameters
    ----------
    gamma33, d33, d22, d23, g21, g31, gamma22, gamma23 : sequence of float
        Coefficients in x = X2/a, lowest power first, at most 33; a field left out is zero.
    amplitude : float
        Factor of the whole.
    name : str
        Name of this growth within a sum.

    Examples
    --------
    >>> Profile(gamma33=[0.0, 0.0, 0.24]).fields() == edge(0.06).fields()
    True
    """
    path = _path(name)
    given: Mapping[str, object] = {
        "gamma33": gamma33,
        "d33": d33,
        "d22": d22,
        "d23": d23,
        "g21": g21,
        "g31": g31,
        "gamma22": gamma22,
        "gamma23": gamma23,
    }
    expected = f"polynomial coefficients, lowest power first, 1 to {MAX_COEFFICIENTS} finite numbers"
    shape = []
    for field, value in given.items():
        if value is not None:
            coefficients = numbers(f"{path}.{field}", value, expected)
            if not 1 <= len(coefficients) <= MAX_COEFFICIENTS:
                raise InputError(f"{path}.{field}", value, expected)
            shape.append((field, coefficients))
    if not shape:
        raise InputError(path, {}, f"at least one of {', '.join(FIELDS)}")
    return _single(name, number(f"{path}.amplitude", amplitude), tuple(shape))


def _path(name: object) -> str:
    """The path of a growth of this name, which is part of the names of traced parameters."""
    if not isinstance(name, str) or not name.isidentifier():
        raise InputError("growth.name", name, "an identifier, such as 'edge'")
    return f"growth.{name}"


def _single(name: str, amplitude: float, shape: Polynomials) -> Growth:
    return Growth((Term(name, amplitude, shape),))
