"""How the two ends of the ribbon are held or loaded.

Positions, forces and moments are components on the fixed basis E1, E2, E3: thickness, width and length of
the undeformed ribbon, whose start is at the origin. They are dimensionless: lengths in units of the width.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TypeAlias

from .check import Numbers, number, numbers, vector
from .errors import InputError

__all__ = ["Clamped", "Free", "Quaternion", "Vector"]

Vector: TypeAlias = tuple[float, float, float]
"""Components on the fixed basis."""

Quaternion: TypeAlias = tuple[float, float, float, float]
"""A unit quaternion, scalar first, that turns the fixed basis into the directors."""

FARTHEST = 1e8
"""Farthest position from the origin, in widths: beyond, coordinates no longer resolve a cross-section."""

_UNIT_TOLERANCE = 1e-8  # a quaternion typed with nine digits passes, a wrong one does not


@dataclass(frozen=True, init=False)
class Clamped:
    """An end held in position and orientation.

    Parameters
    ----------
    position : sequence of 3 float, optional
        Where the end is held, in units of the width; None is where it lies in the straight ungrown ribbon.
    rotation : sequence of 4 or 3 float, optional
        Orientation of the end: a unit quaternion, scalar first, or a rotation vector in radians; None is
        that of the ungrown ribbon. Kept as a unit quaternion.
    twist_turns : float
        Full turns about the fixed axis E3, applied after `rotation`.

    Raises
    ------
    InputError
        If a number is not finite, a vector of the wrong length, a position farther than 1e8 widths, or a
        quaternion not of unit norm to 1e-8.
    """

    position: Vector | None
    rotation: Quaternion | None
    twist_turns: float

    def __init__(
        self, position: Numbers | None = None, rotation: Numbers | None = None, twist_turns: float = 0.0
    ) -> None:
        held = None if position is None else vector("clamped.position", position)
        if held is not None and max(map(abs, held)) > FARTHEST:
            raise InputError("clamped.position", position, f"components of at most {FARTHEST:g} widths")
        turned = None if rotation is None else _unit_quaternion("clamped.rotation", rotation)
        object.__setattr__(self, "position", held)
        object.__setattr__(self, "rotation", turned)
        object.__setattr__(self, "twist_turns", number("clamped.twist_turns", twist_turns))

    @property
    def quaternion(self) -> Quaternion:
        """Orientation of the end: `rotation`, then the twist about E3, as a unit quaternion."""
        # Half turns are exact, so that any number of full turns returns to +-1 to rounding.
        half = math.pi * math.fmod(self.twist_turns, 2.0)
        c, s = math.cos(half), math.sin(half)
        q0, q1, q2, q3 = self.rotation or (1.0, 0.0, 0.0, 0.0)
        return c * q0 - s * q3, c * q1 - s * q2, c * q2 + s * q1, c * q3 + s * q0


@dataclass(frozen=True, init=False)
class Free:
    """An end free to move and turn, under a dead force and moment.

    Parameters
    ----------
    force, moment : sequence of 3 float
        In units of Y h a and Y h a^2.

    Raises
    ------
    InputError
        If a number is not finite or a vector has the wrong length.
    """

    force: Vector
    moment: Vector

    def __init__(self, force: Numbers = (0.0, 0.0, 0.0), moment: Numbers = (0.0, 0.0, 0.0)) -> None:
        object.__setattr__(self, "force", vector("free.force", force))
        object.__setattr__(self, "moment", vector("free.moment", moment))


def _unit_quaternion(field: str, value: Numbers) -> Quaternion:
    """The unit quaternion given as such or as a rotation vector."""
    expected = "a unit quaternion, scalar first, or a rotation vector of three numbers"
    entries = numbers(field, value, expected)
    norm = math.hypot(*entries)
    if len(entries) == 4 and abs(norm - 1.0) <= _UNIT_TOLERANCE:
        q0, q1, q2, q3 = (entry / norm for entry in entries)
        return q0, q1, q2, q3
    if len(entries) == 3 and math.isfinite(norm):
        scale = math.sin(norm / 2.0) / norm if norm > 0.0 else 0.0
        x, y, z = (scale * entry for entry in entries)
        return math.cos(norm / 2.0), x, y, z
    raise InputError(field, value, expected)
