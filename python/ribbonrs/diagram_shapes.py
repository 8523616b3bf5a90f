"""Small pictures of states beside a bifurcation diagram."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure

from .arrays import Array
from .render import Picture, render
from .state import State

__all__ = ["Shape", "draw_shapes"]

TINT = 0.55
"""A shape is painted in the colour of its branch, so much of it."""

LETTER = 0.18
"""Inches that the letter takes above a shape."""


@dataclass(frozen=True)
class Shape:
    """A state to draw, the letter that names it, and a colour."""

    letter: str
    state: State
    colour: str


def draw_shapes(
    figure: Figure, corner: tuple[float, float], box: tuple[float, float], shapes: Sequence[Shape]
) -> None:
    """Draw shapes on one scale, one below the other, in boxes (width, height) below the upper left corner.

    All in inches from the lower left corner of the figure.
    """
    pictures = [render(shape.state) for shape in shapes]
    if not pictures:
        return
    size = np.array(box)
    largest = np.max([np.subtract(*picture.extent[::-1]) for picture in pictures], axis=0)
    inch = 1.1 * float(max(largest / (size - [0.0, LETTER])))  # in widths of the ribbon
    whole = np.tile(figure.get_size_inches(), 2)
    for row, (shape, picture) in enumerate(zip(shapes, pictures, strict=True)):
        place = np.array([corner[0], corner[1] - (row + 1) * box[1], *box]) / whole
        left, bottom, width, height = place.tolist()
        axes = figure.add_axes((left, bottom, width, height), frameon=False)
        _paint(axes, picture, shape.colour, size * inch)
        style: dict[str, Any] = {"fontsize": 9, "color": shape.colour, "va": "top"}
        axes.text(0.0, 0.97, shape.letter, transform=axes.transAxes, **style)


def _paint(axes: Axes, picture: Picture, colour: str, size: Array) -> None:
    """The shape in the middle of axes of this size in widths of the ribbon."""
    tint = 1.0 - TINT * (1.0 - np.array(to_rgb(colour)))
    rgb = tint * picture.shade[:, None]
    rgb = rgb + (1.0 - rgb) * picture.gloss[:, None]
    cells: Any = picture.cells  # an array is faster than the sequence that the signature asks for
    axes.add_collection(
        PolyCollection(cells, facecolors=rgb, edgecolors=rgb, linewidths=0.3, rasterized=True)
    )
    low, high = picture.extent
    left, bottom = (low + high) / 2 - size / 2
    axes.set(xlim=(left, left + size[0]), ylim=(bottom, bottom + size[1]), aspect="equal")
    axes.axis("off")
