"""Whether the ends of a scene can hold its ribbon: refusals before any solve."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from .arrays import Array
from .ends import Clamped, Closed, Free, Hinged, Pinned, Sliding
from .errors import InputError
from .linear import LinearLaw
from .loads import PointLoad

if TYPE_CHECKING:
    from .scene import Scene

__all__ = ["check_closed", "check_held", "check_loads", "check_reach"]

PARALLEL = 1e-12
"""Sine of an angle between parallel directions."""

STRETCH = 0.1
"""Axial strain by loads up to which an end may be from the start: the theory is for small strains."""

EXACT = 1e-12
"""What rounding adds to a distance, relative to the length."""

SYMMETRIC = 1e-12
"""What a growth may miss of a symmetry, relative to its largest value."""

ODD_AFTER_HALF_TURN = {"d33", "d22", "g31", "gamma23"}
"""Fields that are odd in x if growth is the same after a half turn about the tangent; the others are even."""


def check_held(scene: Scene) -> None:
    """Refuse ends that leave the ribbon free to move as a rigid body, unless loads keep it in place."""
    start, end = scene.start, scene.end
    if isinstance(start, Clamped | Closed) or isinstance(end, Clamped):
        return
    for name, free, other in (("start", start, end), ("end", end, start)):
        if isinstance(free, Free) and not isinstance(other, Hinged):
            kind, leaves = type(other).__name__, "turn" if isinstance(other, Pinned) else "move"
            expected = f"an end that holds the ribbon, which {kind} at the other leaves free to {leaves}"
            raise InputError(name, free, expected)
    if isinstance(start, Sliding) and isinstance(end, Sliding) and _parallel(start.axis, end.axis):
        raise InputError(
            "end.axis", end.axis, "another direction than start.axis, to keep the ribbon in place"
        )
    if isinstance(start, Sliding) or isinstance(end, Sliding):
        return
    axis = _axis(scene)
    if axis is not None and not any(np.any(force) and not _parallel(force, axis) for force in _forces(scene)):
        x, y, z = (f"{entry + 0.0:.6g}" for entry in axis)
        expected = f"ends or forces that keep the ribbon from turning about the direction ({x}, {y}, {z})"
        raise InputError("end", end, expected)


def _axis(scene: Scene) -> Array | None:
    """The direction about which ends that are pinned, hinged or free let the ribbon turn, None if none."""
    here, there = scene.places
    axes = [np.array(end.axis) for end in (scene.start, scene.end) if isinstance(end, Hinged)]
    if not isinstance(scene.start, Free) and not isinstance(scene.end, Free):
        line = np.subtract(there, here)
        distance = float(np.linalg.norm(line))
        if distance > EXACT * scene.ribbon.length_ratio:
            axes.append(line / distance)
        elif not axes:
            expected = "a place apart from the start, to keep the ribbon from turning about it"
            raise InputError("end.position", there, expected)
    return None if any(not _parallel(axes[0], axis) for axis in axes[1:]) else axes[0]


def _forces(scene: Scene) -> Array:
    """Every force that acts between the ends or on a free one, array (n, 3)."""
    length = scene.ribbon.length_ratio
    ends = [end.force for end in (scene.start, scene.end) if isinstance(end, Free)]
    return np.concatenate([[scene.gravity, *ends], *(load.forces(length) for load in scene.loads)])


def check_reach(scene: Scene) -> None:
    """Refuse ends farther apart than the ribbon reaches."""
    start, end = scene.start, scene.end
    if isinstance(start, Free | Closed) or isinstance(end, Free):
        return
    here, there = scene.places
    span = np.subtract(there, here)
    axes = [end.axis for end in (start, end) if isinstance(end, Sliding)]
    if axes:  # sliding ends come as near as their axes let them
        columns = np.array(axes).T
        span = span - columns @ np.linalg.lstsq(columns, span, rcond=None)[0]
    distance, most = float(np.linalg.norm(span)), _reach(scene)
    if distance > most * (1.0 + EXACT):
        field = "start" if isinstance(end, Sliding) or end.position is None else "end"
        other = "end" if field == "start" else "start"
        place = here if field == "start" else there
        expected = f"at most {most:.6g} from the {other}, which is as far as the ribbon reaches"
        raise InputError(f"{field}.position", place, f"{expected}, not {distance:.6g}")


def _reach(scene: Scene) -> float:
    """The greatest distance of the ends."""
    length, law = scene.ribbon.length_ratio, scene.law
    if isinstance(law, LinearLaw):
        natural = law.intrinsic[0]
        if law.inextensible:
            return length * (1.0 + natural)
    else:
        natural = scene.growth.axial(length)
    return length * (1.0 + max(0.0, natural) + STRETCH)


def check_loads(scene: Scene) -> None:
    """Refuse loads that are not on the ribbon."""
    length = scene.ribbon.length_ratio
    for i, load in enumerate(scene.loads):
        if isinstance(load, PointLoad):
            if not 0.0 < load.S < length:
                expected = f"a number inside (0, {length:g}); the ends take Free(force=, moment=)"
                raise InputError(f"loads[{i}].S", load.S, expected)
        else:
            try:
                load.along(length)
            except InputError as error:
                field = error.field.replace("line_load", f"loads[{i}]", 1)
                raise InputError(field, error.value, error.expected) from error.__cause__


def check_closed(scene: Scene) -> None:
    """Refuse a Moebius strip of growth that is not the same after a half turn about the tangent."""
    start = scene.start
    if not isinstance(start, Closed) or not start.one_sided:
        return
    if isinstance(scene.law, LinearLaw):
        if any(scene.law.intrinsic[1:3]):
            expected = "a whole number of turns, or intrinsic K1 and K2 of zero"
            raise InputError("start.link", start.link, expected)
        return
    # Points that miss breaks, at which fields would differ by the side from which they are taken.
    x = 0.5 * np.sin(0.5 * np.pi * np.mod(np.arange(1, 258) * (0.5 * 5.0**0.5 - 0.5), 1.0))
    S = scene.ribbon.length_ratio * np.mod(np.arange(1, 66) * (0.5 * 5.0**0.5 - 0.5), 1.0)
    places = S[:, None] if scene.growth.varies else 0.0
    right, left = scene.growth.values(x, places), scene.growth.values(-x, places)
    for key, values in right.items():
        image = -left[key] if key in ODD_AFTER_HALF_TURN else left[key]
        if np.max(np.abs(values - image)) > SYMMETRIC * np.max(np.abs(values)):
            kind = "odd" if key in ODD_AFTER_HALF_TURN else "even"
            expected = f"a whole number of turns, or growth of a Moebius strip: {key} {kind} in x"
            raise InputError("start.link", start.link, expected)


def _parallel(one: ArrayLike, two: ArrayLike) -> bool:
    """Whether two vectors that are not zero have the same or the opposite direction."""
    a, b = (np.asarray(v, dtype=np.float64) / np.max(np.abs(v)) for v in (one, two))
    sine = np.linalg.norm(np.cross(a, b)) / (np.linalg.norm(a) * np.linalg.norm(b))
    return bool(sine <= PARALLEL)
