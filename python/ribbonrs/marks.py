"""What holds and loads a ribbon, drawn over its picture: marks at the ends and arrows along forces."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes

from .arrays import Array
from .ends import Clamped, Closed, Free, Hinged, Pinned, Sliding
from .loads import PROBES, PointLoad

if TYPE_CHECKING:
    from .render import Picture
    from .state import State

__all__ = ["Marks", "draw_marks", "marks_of"]

SHAPES = {Clamped: "s", Sliding: "D", Pinned: "^", Hinged: "o"}
COLOUR = "tab:green"
ARROW = 0.55
"""Inches: the longest arrow, of a force in the plane of the picture."""
ALONG, SHORTER, SHORTEST = 8, 0.6, 0.02
"""A line load is drawn as arrows at so many equal steps, the longest so much shorter; none below the last."""


@dataclass(frozen=True)
class Marks:
    """In the plane of the picture, lengths in units of the width.

    Attributes
    ----------
    ends : tuple of ((2,) array, str)
        Where held ends are, and matplotlib's name of their mark.
    forces : tuple of ((2,) array, (2,) array)
        Where forces act, and the direction of each, of a line load its share of the largest.
    gravity : (2,) array or None
        Its direction.
    """

    ends: tuple[tuple[Array, str], ...] = ()
    forces: tuple[tuple[Array, Array], ...] = ()
    gravity: Array | None = None

    @property
    def margin(self) -> float:
        """Inches that the arrows need around the picture."""
        return ARROW if self.forces else 0.0


def marks_of(state: State, picture: Picture) -> Marks:
    """Return what to draw of a scene that is loaded, nothing of another; what is cut off has no mark."""
    scene, length = state.scene, state.scene.ribbon.length_ratio
    if not scene.loaded:
        return Marks()
    ends: list[tuple[float, str]] = []
    forces: list[tuple[float, Array]] = []
    for S, end in ((0.0, scene.start), (length, scene.end)):
        if type(end) in SHAPES:
            ends.append((S, SHAPES[type(end)]))
        elif isinstance(end, Closed) and (any(scene.gravity) or scene.loads):
            ends.append((S, SHAPES[Clamped]))  # what bears the load
        if isinstance(end, Free):
            forces.append((S, _direction(end.force)))
        elif isinstance(end, Sliding):
            forces.append((S, math.copysign(float(end.force != 0.0), end.force) * np.array(end.axis)))
    for load in scene.loads:
        if isinstance(load, PointLoad):
            forces.append((load.S, _direction(load.force)))
        else:
            along = load.forces(length)[:: PROBES // ALONG]
            forces += zip(np.linspace(0.0, length, len(along)).tolist(), _shares(along), strict=True)
    drawn = picture.drawn * length
    return Marks(
        tuple((state.at(S).position @ picture.axes, shape) for S, shape in ends if drawn >= S),
        tuple(
            (state.at(S).position @ picture.axes, force @ picture.axes)
            for S, force in forces
            if drawn >= S and np.linalg.norm(force) > SHORTEST
        ),
        _direction(scene.gravity) @ picture.axes if any(scene.gravity) else None,
    )


def draw_marks(axes: Axes, marks: Marks, inch: float) -> None:
    """Draw them on axes in which an inch is so many widths."""
    for place, shape in marks.ends:
        axes.plot(*place, shape, color=COLOUR, markersize=6, markeredgecolor="white", clip_on=False)
    for place, direction in marks.forces:
        _arrow(axes, place, place + ARROW * inch * direction)
    if marks.gravity is not None:
        corner = np.array([axes.get_xlim()[1], axes.get_ylim()[0]])
        middle = corner + np.array([-0.5, 0.48]) * inch
        reach = 0.5 * ARROW * inch * marks.gravity
        _arrow(axes, middle - reach, middle + reach)
        name = middle - [0.12 * inch, 0.0]  # beside an arrow that points down in every picture
        axes.text(name[0], name[1], "gravity", color=COLOUR, fontsize=8, ha="right", va="center")


def _direction(force: tuple[float, ...]) -> Array:
    """The unit vector along a force; zero of none."""
    scaled = np.array(force) / (max(map(abs, force)) or 1.0)
    return np.asarray(scaled / (np.linalg.norm(scaled) or 1.0))


def _shares(forces: Array) -> Array:
    """Forces (n, 3) along a line over the largest of them, somewhat shorter than those at points."""
    scaled = forces / (np.max(np.abs(forces)) or 1.0)
    return np.asarray(SHORTER * scaled / (np.max(np.linalg.norm(scaled, axis=1)) or 1.0))


def _arrow(axes: Axes, tail: Array, tip: Array) -> None:
    style = {"arrowstyle": "-|>", "color": COLOUR, "lw": 1.6, "shrinkA": 0, "shrinkB": 0}
    axes.annotate("", tuple(tip), tuple(tail), annotation_clip=False, arrowprops=style)
