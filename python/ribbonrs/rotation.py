"""Orientations as the user gives them: a unit quaternion or a rotation vector, then turns about E3."""

from __future__ import annotations

import math
from typing import TypeAlias

from .check import Numbers, numbers
from .errors import InputError

__all__ = ["IDENTITY", "Quaternion", "rotation_of", "turned"]

Quaternion: TypeAlias = tuple[float, float, float, float]
"""A unit quaternion, scalar first, that turns the fixed basis into the directors."""

IDENTITY: Quaternion = (1.0, 0.0, 0.0, 0.0)
"""The orientation of the ungrown ribbon."""

_UNIT_TOLERANCE = 1e-8  # a quaternion typed with nine digits passes, a wrong one does not
_ROUNDING = 1e-15  # what is a unit to rounding stays as it is, to the last bit


def rotation_of(field: str, value: Numbers | None) -> Quaternion | None:
    """Return the unit quaternion given as such or as a rotation vector in radians; None stays None."""
    if value is None:
        return None
    expected = "a unit quaternion, scalar first, or a rotation vector of three numbers"
    entries = numbers(field, value, expected)
    norm = math.hypot(*entries)
    if len(entries) == 4 and abs(norm - 1.0) <= _UNIT_TOLERANCE:
        norm = 1.0 if abs(norm - 1.0) <= _ROUNDING else norm
        q0, q1, q2, q3 = (entry / norm for entry in entries)
        return q0, q1, q2, q3
    if len(entries) == 3 and math.isfinite(norm):
        scale = math.sin(norm / 2.0) / norm if norm > 0.0 else 0.0
        x, y, z = (scale * entry for entry in entries)
        return math.cos(norm / 2.0), x, y, z
    raise InputError(field, value, expected)


def turned(rotation: Quaternion | None, turns: float) -> Quaternion:
    """Return `rotation`, then `turns` full turns about the fixed axis E3, as a unit quaternion."""
    # Half turns are exact, so that any number of full turns returns to +-1 to rounding.
    half = math.pi * math.fmod(turns, 2.0)
    c, s = math.cos(half), math.sin(half)
    q0, q1, q2, q3 = rotation or IDENTITY
    return c * q0 - s * q3, c * q1 - s * q2, c * q2 + s * q1, c * q3 + s * q0
