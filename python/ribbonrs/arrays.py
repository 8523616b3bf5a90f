"""Arrays from the user, checked before they reach the compiled core."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .errors import InputError

__all__ = ["Array", "count", "real_array", "strain_array", "vector"]

Array = NDArray[np.float64]


def real_array(field: str, value: Any, expected: str) -> Array:
    """Return `value` as a C-contiguous float64 array, or raise `InputError` naming `field`.

    Accepts integers and floats of any shape; refuses booleans, complex numbers, text, objects,
    ragged nesting, masked entries, and any entry that is not finite (the error names the first one).
    """
    try:
        raw = np.asarray(value)
    except ValueError:  # ragged nesting
        raise InputError(field, value, expected) from None
    if raw.dtype.kind not in "iuf" or np.ma.is_masked(value):
        raise InputError(field, value, expected)
    array = np.ascontiguousarray(raw, dtype=np.float64).reshape(raw.shape)
    finite = np.isfinite(array)
    if not finite.all():
        where = tuple(int(i) for i in np.argwhere(~finite)[0])
        element = f"{field}[{', '.join(map(str, where))}]" if where else field
        raise InputError(element, float(array[where]), expected)
    return array


def strain_array(field: str, value: Any) -> Array:
    """Return strains (..., 4) in the order eps, K1, K2, K3."""
    expected = "finite numbers of shape (..., 4): eps, K1, K2, K3"
    array = real_array(field, value, expected)
    if array.ndim == 0 or array.shape[-1] != 4:
        raise InputError(f"{field}.shape", array.shape, expected)
    return array


def vector(field: str, value: Any, size: int, expected: str) -> Array:
    """Return a vector (size,)."""
    array = real_array(field, value, expected)
    if array.shape != (size,):
        raise InputError(f"{field}.shape", array.shape, expected)
    return array


MOST = 10_000_000
"""Largest count: of nodes, points or segments that fit in memory."""


def count(field: str, value: Any, least: int, most: int = MOST) -> int:
    """Return a whole number from `least` to `most` (booleans are not numbers here)."""
    whole = isinstance(value, (int, np.integer)) and not isinstance(value, bool)
    if not whole or not least <= value <= most:
        raise InputError(field, value, f"a whole number from {least} to {most}")
    return int(value)
