"""Ribbons in space within a figure: parallel projection, one scale, shaded, coloured by u1/a or plainly."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import PolyCollection
from matplotlib.colors import Normalize, to_rgb

from ..arrays import Array
from ..course import Uniform, phase_of
from ..equilibrium import NODES
from ..growth import Growth
from ..law import SectionLaw
from ..render import Picture, render
from ..report import Report
from ..ribbon import Ribbon
from ..scene import Scene
from ..state import State

__all__ = ["deflection_scale", "draw_grid", "draw_shape", "held_at", "view"]

Colour = str | ScalarMappable

# Of the cells that a picture as wide as a page has.
DETAIL = 0.3
TINT = 0.55
"""A plain shape has so much of its colour."""
# Light grey in the middle, for colour-blind eyes (Moreland 2009).
COLOURS = colormaps["coolwarm"]


def view(elevation: float = 30.0, side: float = 25.0) -> Array:
    """Return how a ribbon is seen that starts along E3 to the right with its thickness E1 up.

    From above and from its start by these angles in degrees: rows (3, 3) right, up, towards the viewer in
    the fixed basis. In one view shapes along a path compare.
    """
    up, along = math.radians(elevation), math.radians(side)
    front = np.array([0.0, math.cos(along), -math.sin(along)])
    right = np.array([0.0, math.sin(along), math.cos(along)])
    toward = math.cos(up) * front + math.sin(up) * np.array([1.0, 0.0, 0.0])
    return np.stack([right, np.cross(toward, right), toward])


def held_at(ribbon: Ribbon, growth: Growth, strain: Sequence[float]) -> State:
    """Return the ribbon at the strains eps, K1, K2, K3 all along, its sections relaxed, whatever holds it."""
    law = SectionLaw.of(ribbon, growth)
    given = np.array(strain, dtype=np.float64)
    return State(
        scene=Scene(ribbon, growth),
        course=Uniform(given),
        energy=float(law.energy(given)),
        section_index=int(np.sum(np.linalg.eigvalsh(law.hessian(given)) < 0.0)),
        phases=(phase_of(given, ribbon.thickness_ratio),),
        resolved=True,
        report=Report("held at given strains", 1, 0, float(np.linalg.norm(law.gradient(given)))),
        S=np.linspace(0.0, ribbon.length_ratio, NODES),
    )


def deflection_scale(states: Sequence[State]) -> ScalarMappable:
    """Return the colours of u1/a on one scale, symmetric about zero, for all these states."""
    x = np.linspace(-0.5, 0.5, 201)
    largest = max((float(np.max(np.abs(state.deflection(x)))) for state in states), default=0.0)
    limit = largest or 1.0
    return ScalarMappable(Normalize(-limit, limit), COLOURS)


def draw_shape(
    axes: Axes,
    state: State,
    colour: Colour,
    at: tuple[float, float] = (0.0, 0.0),
    seen: Array | None = None,
    detail: float = DETAIL,
) -> Picture:
    """Draw a state with the middle of its picture at a place, lengths in units of the ribbon's width.

    Parameters
    ----------
    axes : Axes
        Of equal scale.
    state : State
        What to draw.
    colour : str or ScalarMappable
        One for all of it, or the colours of u1/a, `deflection_scale`.
    at : (float, float)
        Where.
    seen : (3, 3) array, optional
        From where, as `view` returns; by default as suits the shape.
    detail : float
        Of the cells that a picture as wide as a page has.
    """
    picture = render(state, seen, detail)
    _paint(axes, picture, colour, np.array(at))
    return picture


def draw_grid(
    axes: Axes,
    rows: Sequence[Sequence[State]],
    colour: Colour,
    seen: Array | None = None,
    gap: tuple[float, float] = (1.0, 1.0),
    detail: float = DETAIL,
) -> Array:
    """Draw rows of as many states each on one scale, so many widths apart, and hide the axes.

    Arguments as in `draw_shape`. Returns the boxes (rows, columns, 4) left, bottom, right, top of each: of a
    row as high, of a column as wide as its largest.
    """
    pictures = [[render(state, seen, detail) for state in row] for row in rows]
    size = np.array([[np.subtract(*picture.extent[::-1]) for picture in row] for row in pictures])
    wide, high = size[..., 0].max(axis=0), size[..., 1].max(axis=1)
    left = np.concatenate([[0.0], np.cumsum(wide + gap[0])[:-1]])
    top = -np.concatenate([[0.0], np.cumsum(high + gap[1])[:-1]])
    boxes = np.empty((*size.shape[:2], 4))
    for i, row in enumerate(pictures):
        for j, picture in enumerate(row):
            boxes[i, j] = left[j], top[i] - high[i], left[j] + wide[j], top[i]
            _paint(axes, picture, colour, (boxes[i, j, :2] + boxes[i, j, 2:]) / 2)
    axes.set(xlim=(0.0, boxes[0, -1, 2]), ylim=(boxes[-1, 0, 1], 0.0), aspect="equal")
    axes.axis("off")
    return boxes


def _paint(axes: Axes, picture: Picture, colour: Colour, middle: Array) -> None:
    if isinstance(colour, ScalarMappable):
        paint = np.asarray(colour.to_rgba(picture.u1))[:, :3]
    else:
        paint = 1.0 - TINT * (1.0 - np.array(to_rgb(colour)))
    rgb = paint * picture.shade[:, None]
    rgb = rgb + (1.0 - rgb) * picture.gloss[:, None]
    low, high = picture.extent
    cells: Any = picture.cells + (middle - (low + high) / 2)
    # edges in the colour of their cell close the seams between cells
    axes.add_collection(
        PolyCollection(cells, facecolors=rgb, edgecolors=rgb, linewidths=0.3, rasterized=True)
    )
