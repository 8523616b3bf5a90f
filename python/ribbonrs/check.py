"""Checks of numbers and vectors that raise `InputError` naming the field."""

from __future__ import annotations

import math
from collections.abc import Sequence
from numbers import Real
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from .errors import InputError

__all__ = ["LARGEST", "Numbers", "Vector", "load", "load_vector", "number", "numbers", "positive", "vector"]

Numbers: TypeAlias = Sequence[float] | NDArray[np.float64]
"""A list, tuple or one-dimensional array of numbers."""

Vector: TypeAlias = tuple[float, float, float]
"""Components on the fixed basis."""

LARGEST = 1e60
"""Largest dimension, stiffness or load, and the inverse of the least: Y h a^2 neither overflows nor
vanishes."""


def number(field: str, value: object, expected: str = "a finite number") -> float:
    """Return `value` as a float if it is a finite number; booleans and strings are not numbers."""
    if type(value) is float and math.isfinite(value):  # nearly all are, and to ask for `Real` takes longer
        return value
    if isinstance(value, bool) or not isinstance(value, Real):
        raise InputError(field, value, expected)
    try:
        result = float(value)
    except OverflowError:
        result = math.inf
    if not math.isfinite(result):
        raise InputError(field, value, expected)
    return result


def positive(field: str, value: object) -> float:
    """Return `value` as a float if it is positive and its products with the like stay finite."""
    expected = "a positive finite number"
    result = number(field, value, expected)
    if result <= 0.0:
        raise InputError(field, value, expected)
    if not 1.0 / LARGEST <= result <= LARGEST:
        raise InputError(field, value, f"a number between {1.0 / LARGEST:g} and {LARGEST:g}")
    return result


def numbers(field: str, value: object, expected: str = "a list of finite numbers") -> tuple[float, ...]:
    """Return `value` as a tuple of floats if it is a one-dimensional sequence of finite numbers."""
    if isinstance(value, np.ndarray):
        value = value.tolist()
    if not isinstance(value, list | tuple):
        raise InputError(field, value, expected)
    return tuple(number(f"{field}[{i}]", entry) for i, entry in enumerate(value))


def vector(field: str, value: object) -> Vector:
    """Return `value` as three floats if it is a sequence of three finite numbers."""
    expected = "three finite numbers"
    entries = numbers(field, value, expected)
    if len(entries) != 3:
        raise InputError(field, value, expected)
    return entries[0], entries[1], entries[2]


def load(field: str, value: object) -> float:
    """Return `value` as a float if it is a force or moment whose products with lengths stay finite."""
    result = number(field, value)
    if abs(result) > LARGEST:
        raise InputError(field, value, f"a number of at most {LARGEST:g}")
    return result


def load_vector(field: str, value: object) -> Vector:
    """Return `value` as three floats if it is a force or moment."""
    x, y, z = vector(field, value)
    return load(f"{field}[0]", x), load(f"{field}[1]", y), load(f"{field}[2]", z)
