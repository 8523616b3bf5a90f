"""A scene as the boundary-value problem of the core."""

from __future__ import annotations

from . import _core
from .check import Vector
from .ends import Clamped, Closed, Free, Hinged, Pinned, Sliding, Start
from .linear import LinearLaw
from .loads import LineLoad, PointLoad
from .pieces import Pieces, added
from .rotation import IDENTITY
from .scene import Scene
from .terms import CorePieces, core_pieces

__all__ = ["problem_of"]

_ZERO: Vector = (0.0, 0.0, 0.0)


def problem_of(scene: Scene) -> _core.BoundaryProblem:
    """Return what the core solves; an unloaded scene has a boundary-value problem too."""
    length = scene.ribbon.length_ratio
    law = (
        _core.LinearLaw(scene.law.compliance, scene.law.intrinsic)
        if isinstance(scene.law, LinearLaw)
        else scene.section_law.core()
    )
    here, there = scene.places
    start = _core_end(scene.start, here)
    end = _core_end(scene.end, there)
    if isinstance(scene.start, Closed):
        end = ("closed", here, IDENTITY, scene.start.link, _ZERO, _ZERO, _ZERO)
    points = [(load.S, load.force, load.moment) for load in scene.loads if isinstance(load, PointLoad)]
    lines = [load.along(length) for load in scene.loads if isinstance(load, LineLoad)]
    force, moment = (
        [
            _core_along(added([p, *(line[name][i] for line in lines)], (0.0, length)))
            for i, p in enumerate(dead)
        ]
        for name, dead in (("force", scene.gravity), ("moment", _ZERO))
    )
    return _core.BoundaryProblem(law, scene.law == "linear", length, start, end, points, force, moment)


def _core_end(end: Start, place: Vector) -> _core._End:
    """Kind, position, orientation before its twist, turns of twist, axis, force and moment."""
    match end:
        case Clamped():
            return "clamped", place, end.rotation or IDENTITY, end.twist_turns, _ZERO, _ZERO, _ZERO
        case Closed():
            return "clamped", place, IDENTITY, 0.0, _ZERO, _ZERO, _ZERO
        case Free():
            return "free", place, IDENTITY, 0.0, _ZERO, end.force, end.moment
        case Pinned():
            return "pinned", place, IDENTITY, 0.0, _ZERO, _ZERO, end.moment
        case Hinged():
            return "hinged", place, IDENTITY, 0.0, end.axis, _ZERO, _along(end.axis, end.moment)
        case Sliding():
            force = _along(end.axis, end.force)
            return "sliding", place, end.rotation or IDENTITY, end.twist_turns, end.axis, force, _ZERO


def _along(axis: Vector, size: float) -> Vector:
    x, y, z = axis
    return x * size, y * size, z * size


def _core_along(component: float | Pieces) -> float | CorePieces:
    return core_pieces(component) if isinstance(component, Pieces) else component
