"""What varies along the ribbon: a number, samples over S, or a function of S.

S = X3/a is the arc length of the ungrown ribbon over its width a.
"""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np

from .arrays import Array
from .check import number
from .errors import InputError
from .pieces import Pieces, linear
from .resolve import Function, called
from .samples import Samples, checked

__all__ = ["AlongInput", "Amplitude", "amplitude", "check_covers", "evaluated", "function_of_s"]

Amplitude: TypeAlias = float | Pieces | Function
"""A number, samples joined linearly, or the user's function."""

AlongInput: TypeAlias = float | Samples | Function
"""What a user gives for it: a number, samples (S, values), or a function of S."""

CLOSEST = 1e-12
"""Least distance of two samples, relative to the last S: closer ones must be at the same S, a jump."""


END = 1e-12
"""How far from the ends of the ribbon, relative to its length, samples may start and end."""


def amplitude(field: str, value: Any) -> Amplitude:
    """Return what the user gave, checked: a number, samples (S, values) as pieces, or a function as it is."""
    if isinstance(value, tuple) or callable(value):
        return function_of_s(field, value)
    return number(field, value, "a finite number, samples (S, values) or a function of S")


def function_of_s(field: str, value: Any) -> Pieces | Function:
    """Return samples (S, values) joined linearly as pieces, or a function of S as it is.

    Two samples at the same S are the values before and after a jump.
    """
    if callable(value):
        function: Function = value
        return function
    if not isinstance(value, tuple):
        raise InputError(field, value, "samples (S, values) or a function of S")
    S, values = checked(field, value, "S")
    if S[0] < 0.0:
        raise InputError(f"{field}.S[0]", float(S[0]), "S = X3/a from 0, the start of the ribbon")
    steps = np.diff(S)
    crowded = np.flatnonzero((steps > 0.0) & (steps < CLOSEST * S[-1]))
    if crowded.size:
        i = int(crowded[0]) + 1
        raise InputError(
            f"{field}.S[{i}]", float(S[i]), f"{S[i - 1]!s} again, for a jump, or farther from it"
        )
    same = np.concatenate([[True], steps == 0.0, [True]])
    repeated = np.flatnonzero(same[:-1] & same[1:])
    if repeated.size:
        i = int(repeated[0])
        raise InputError(f"{field}.S[{i}]", float(S[i]), "ascending numbers; a jump inside, the same S twice")
    return linear(S, values)


def check_covers(field: str, pieces: Pieces, length: float) -> None:
    """Refuse samples that do not reach from S = 0 to `length`, in units of the width."""
    start, end = pieces.domain
    if start > END * length or end < (1.0 - END) * length:
        raise InputError(field, (start, end), f"samples from S = 0 to S = {length}")


def evaluated(field: str, value: Amplitude, S: Array) -> Array:
    """Return the values at S (...); where it jumps those to the right."""
    if isinstance(value, Pieces):
        start, end = value.domain
        outside = S[np.abs(S - 0.5 * (start + end)) > 0.5 * (end - start) + CLOSEST * end]
        if outside.size:
            raise InputError(
                "S", float(outside[0]), f"numbers in [{start:g}, {end:g}], as sampled in {field}"
            )
        return value.evaluate(S)
    if callable(value):
        return called(field, value, S, "S")
    return np.asarray(value, dtype=np.float64)
