"""Samples of a function of one variable, (places, values), as the user gives them."""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from .arrays import Array, real_array
from .check import LARGEST
from .errors import InputError

__all__ = ["Samples", "checked", "is_samples"]

Samples: TypeAlias = tuple[ArrayLike, ArrayLike]
"""Places and values, two equally long sequences of numbers."""


def is_samples(value: object) -> bool:
    """Whether `value` is a tuple of sequences: a tuple of numbers is something else."""
    return isinstance(value, tuple) and any(isinstance(v, list | tuple | np.ndarray) for v in value)


def checked(field: str, value: Any, name: str) -> tuple[Array, Array]:
    """Return the places, called `name`, and the values as finite arrays (n,), n at least 2, places ascending.

    Two equal places are let pass.
    """
    expected = f"samples ({name}, values), two equally long lists of finite numbers"
    if not isinstance(value, tuple) or len(value) != 2:
        raise InputError(field, value, expected)
    places = real_array(f"{field}.{name}", value[0], "a list of finite numbers")
    values = real_array(f"{field}.values", value[1], "a list of finite numbers")
    if places.ndim != 1 or places.shape != values.shape:
        shapes = f"{expected}, not of the shapes {places.shape} and {values.shape}"
        raise InputError(field, value, shapes)
    if places.size < 2:
        raise InputError(f"{field}.{name}", value[0], "at least 2 samples")
    for array, column in ((places, name), (values, "values")):
        large = np.flatnonzero(np.abs(array) > LARGEST)
        if large.size:
            i = int(large[0])
            raise InputError(f"{field}.{column}[{i}]", float(array[i]), f"a number of at most {LARGEST:g}")
    falling = np.flatnonzero(np.diff(places) < 0.0)
    if falling.size:
        i = int(falling[0]) + 1
        raise InputError(
            f"{field}.{name}[{i}]", float(places[i]), f"ascending numbers, after {places[i - 1]!s}"
        )
    return places, values
