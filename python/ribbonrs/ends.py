"""How the two ends of the ribbon are held or loaded.

Positions, forces and moments are components on the fixed basis E1, E2, E3: thickness, width and length of
the undeformed ribbon, whose start is at the origin. They are dimensionless: lengths in units of the width a,
forces in Y h a, moments in Y h a^2. Loads are dead: they keep their direction in space.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TypeAlias

from .arrays import count
from .check import Numbers, Vector, load, load_vector, number, vector
from .errors import InputError
from .rotation import IDENTITY, Quaternion, rotation_of, turned

__all__ = [
    "Clamped",
    "Closed",
    "End",
    "Free",
    "Hinged",
    "Pinned",
    "Quaternion",
    "Sliding",
    "Start",
    "Vector",
    "pose",
]

FARTHEST = 1e8
"""Farthest position from the origin, in widths: beyond, coordinates no longer resolve a cross-section."""


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
        Full turns about the fixed axis E3, applied after `rotation`. A held ribbon is twisted by all of them.

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
        object.__setattr__(self, "position", _held("clamped.position", position))
        object.__setattr__(self, "rotation", rotation_of("clamped.rotation", rotation))
        object.__setattr__(self, "twist_turns", number("clamped.twist_turns", twist_turns))

    @property
    def quaternion(self) -> Quaternion:
        """Orientation of the end: `rotation`, then the twist about E3, as a unit quaternion."""
        return turned(self.rotation, self.twist_turns)


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
        If a number is not finite or larger than 1e60, or a vector has the wrong length.
    """

    force: Vector
    moment: Vector

    def __init__(self, force: Numbers = (0.0, 0.0, 0.0), moment: Numbers = (0.0, 0.0, 0.0)) -> None:
        object.__setattr__(self, "force", load_vector("free.force", force))
        object.__setattr__(self, "moment", load_vector("free.moment", moment))


@dataclass(frozen=True, init=False)
class Pinned:
    """An end held in position and free to turn in every direction, under a dead moment.

    Parameters
    ----------
    position : sequence of 3 float, optional
        Where the end is held, in units of the width; None is where it lies in the straight ungrown ribbon.
    moment : sequence of 3 float
        In units of Y h a^2.

    Raises
    ------
    InputError
        If a number is not finite, a vector of the wrong length, a position farther than 1e8 widths, or a
        moment larger than 1e60.
    """

    position: Vector | None
    moment: Vector

    def __init__(self, position: Numbers | None = None, moment: Numbers = (0.0, 0.0, 0.0)) -> None:
        object.__setattr__(self, "position", _held("pinned.position", position))
        object.__setattr__(self, "moment", load_vector("pinned.moment", moment))


@dataclass(frozen=True, init=False)
class Hinged:
    """An end held in position and free to turn about one director, which stays where it is.

    Parameters
    ----------
    director : int
        k = 1, 2 or 3: the end turns about the fixed direction E_k, along which d_k stays. The default, 2, is
        a door hinge along the width.
    position : sequence of 3 float, optional
        Where the end is held, in units of the width; None is where it lies in the straight ungrown ribbon.
    moment : float
        Dead moment about E_k, in units of Y h a^2.

    Raises
    ------
    InputError
        If `director` is not 1, 2 or 3, a number is not finite, a vector of the wrong length, a position
        farther than 1e8 widths, or a moment larger than 1e60.
    """

    director: int
    position: Vector | None
    moment: float

    def __init__(self, director: int = 2, position: Numbers | None = None, moment: float = 0.0) -> None:
        object.__setattr__(self, "director", count("hinged.director", director, 1, 3))
        object.__setattr__(self, "position", _held("hinged.position", position))
        object.__setattr__(self, "moment", load("hinged.moment", moment))

    @property
    def axis(self) -> Vector:
        """The unit vector E_k about which the end turns."""
        return 1.0 * (self.director == 1), 1.0 * (self.director == 2), 1.0 * (self.director == 3)


@dataclass(frozen=True, init=False)
class Sliding:
    """An end held in orientation and free to move along a fixed axis, under a dead force along it.

    The axis passes through the place of the end in the straight ungrown ribbon.

    Parameters
    ----------
    axis : sequence of 3 float
        Direction of the axis, of any length but zero. Kept as a unit vector.
    rotation : sequence of 4 or 3 float, optional
        Orientation of the end: a unit quaternion, scalar first, or a rotation vector in radians; None is
        that of the ungrown ribbon. Kept as a unit quaternion.
    twist_turns : float
        Full turns about the fixed axis E3, applied after `rotation`. A held ribbon is twisted by all of them.
    force : float
        Along `axis`, in units of Y h a.

    Raises
    ------
    InputError
        If a number is not finite, a vector of the wrong length, the axis zero, a quaternion not of unit norm
        to 1e-8, or a force larger than 1e60.
    """

    axis: Vector
    rotation: Quaternion | None
    twist_turns: float
    force: float

    def __init__(
        self,
        axis: Numbers = (0.0, 0.0, 1.0),
        rotation: Numbers | None = None,
        twist_turns: float = 0.0,
        force: float = 0.0,
    ) -> None:
        object.__setattr__(self, "axis", _direction("sliding.axis", axis))
        object.__setattr__(self, "rotation", rotation_of("sliding.rotation", rotation))
        object.__setattr__(self, "twist_turns", number("sliding.twist_turns", twist_turns))
        object.__setattr__(self, "force", load("sliding.force", force))

    @property
    def quaternion(self) -> Quaternion:
        """Orientation of the end: `rotation`, then the twist about E3, as a unit quaternion."""
        return turned(self.rotation, self.twist_turns)


@dataclass(frozen=True, init=False)
class Closed:
    """A ribbon closed to a loop; given as its start, for both ends.

    The start is clamped at the origin, along E3, and the end is glued to it after `link` full turns of the
    frame about the tangent.

    Parameters
    ----------
    link : float
        A multiple of 1/2. Odd halves make a Moebius strip, for which growth must be the same after a half
        turn of the cross-section.

    Raises
    ------
    InputError
        If `link` is not a multiple of 1/2.
    """

    link: float

    def __init__(self, link: float = 0.0) -> None:
        expected = "a multiple of 1/2: full turns of the frame along the loop"
        turns = number("closed.link", link, expected)
        if not (2.0 * turns).is_integer():
            raise InputError("closed.link", link, expected)
        object.__setattr__(self, "link", turns)

    @property
    def one_sided(self) -> bool:
        """Whether an odd number of half turns makes a Moebius strip."""
        return math.fmod(2.0 * self.link, 2.0) != 0.0


End: TypeAlias = Clamped | Free | Pinned | Hinged | Sliding
"""An end of a ribbon that is not closed."""

Start: TypeAlias = End | Closed
"""What a ribbon may start with."""


def pose(start: Start) -> tuple[Vector, Quaternion]:
    """Return where the start is and how it is turned; what is not held is as in the ungrown ribbon."""
    position = start.position if isinstance(start, Clamped | Pinned | Hinged) else None
    quaternion = start.quaternion if isinstance(start, Clamped | Sliding) else IDENTITY
    return position or (0.0, 0.0, 0.0), quaternion


def _held(field: str, value: Numbers | None) -> Vector | None:
    """A position that coordinates resolve."""
    if value is None:
        return None
    held = vector(field, value)
    if max(map(abs, held)) > FARTHEST:
        raise InputError(field, value, f"components of at most {FARTHEST:g} widths")
    return held


def _direction(field: str, value: Numbers) -> Vector:
    """A unit vector; scaled before its norm, which may overflow or vanish."""
    x, y, z = vector(field, value)
    largest = max(abs(x), abs(y), abs(z))
    if largest == 0.0:
        raise InputError(field, value, "a direction: three numbers, not all zero")
    x, y, z = x / largest, y / largest, z / largest
    norm = math.hypot(x, y, z)
    return x / norm, y / norm, z / norm
