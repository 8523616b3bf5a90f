"""The ribbon as shaded quadrilaterals in the plane of the picture, for any drawing library.

A parallel projection, so that lengths compare in all parts of the picture. Only cells that face the viewer
are kept, sorted from back to front: painting them in order hides what lies behind.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from .arrays import Array
from .surface import placed, section

if TYPE_CHECKING:
    from .state import State

__all__ = ["Picture", "render"]

# A ribbon of more turns is drawn up to here: the rest would only be a grey band.
MAX_TURNS = 20.0
CELLS_PER_TURN = 96.0
CELLS_PER_WIDTH = 6.0
MIN_ALONG, MAX_ALONG = 240, 2400
CELLS, MIN_ACROSS, MAX_ACROSS = 20_000, 32, 100
OUTLINE = 0.012
"""Width of the dark outline along the edges, in units of the ribbon's width."""

# The shape lies on its broadest side and is seen from above and from the side by these angles.
ELEVATION, SIDE = math.radians(35.0), math.radians(15.0)

# Cosine of an angle that counts as a right one, so that rounding does not turn the picture over.
SQUARE = 1e-6

# Light from the upper left and front, in the frame of the picture: right, up, towards the viewer.
LIGHT = np.array([-0.40, 0.62, 0.67])
DARKEST, GLOSS, SHARPNESS = 0.5, 0.16, 24
OUTLINE_SHADE, WALL_SHADE = 0.35, 0.62


@dataclass(frozen=True)
class Picture:
    """m cells in the plane of the picture, from back to front; lengths in units of the width.

    Attributes
    ----------
    cells : (m, 4, 2) array
        Corners: right, up.
    u1 : (m,) array
        Deflection in the middle of each cell.
    shade : (m,) array
        Light that the cell sends back, 0 (dark) to 1.
    gloss : (m,) array
        Part of white light on top of it.
    axes : (3, 2) array
        E1, E2, E3 in the plane of the picture.
    drawn : float
        How much of the length is in the picture, 0 to 1.
    """

    cells: Array
    u1: Array
    shade: Array
    gloss: Array
    axes: Array
    drawn: float

    @property
    def extent(self) -> tuple[Array, Array]:
        """Lower left and upper right corner."""
        return self.cells.min(axis=(0, 1)), self.cells.max(axis=(0, 1))

    @property
    def aspect(self) -> float:
        """Width over height."""
        low, high = self.extent
        return float(np.divide(*(high - low)))


def render(state: State) -> Picture:
    """Return the body of `state` as cells to paint: both faces, the edges and the ends."""
    length, course = state.scene.ribbon.length_ratio, state.course
    end = length
    turns = float(course.turns(np.array([length]))[0])
    if turns > MAX_TURNS:
        places = np.linspace(0.0, length, 1001)
        end = float(np.interp(MAX_TURNS, course.turns(places), places))
    wanted = max(CELLS_PER_TURN * min(turns, MAX_TURNS), CELLS_PER_WIDTH * end)
    along = int(np.clip(wanted, MIN_ALONG, MAX_ALONG))
    across = int(np.clip(CELLS / along, MIN_ACROSS, MAX_ACROSS))
    S = np.linspace(0.0, end, along + 1)
    x = np.concatenate([[-0.5], np.linspace(-0.5 + OUTLINE, 0.5 - OUTLINE, across - 1), [0.5]])
    sections = state.at(S)
    middle, fibre = section(state, S, x)
    top, bottom = placed(sections, middle + fibre), placed(sections, middle - fibre)
    u1 = _means(np.broadcast_to(middle[..., 0], (along + 1, across + 1)))

    camera = _camera(np.concatenate([top, bottom], axis=1))
    x_mid = (x[:-1] + x[1:]) / 2
    face = np.where(np.abs(x_mid) > 0.5 - OUTLINE, OUTLINE_SHADE, 1.0)
    parts = []
    # each part: two rows of lines of points, such that the cells between them turn outwards
    for lines, at, paint in (
        (top, u1, face),
        (bottom[:, ::-1], u1[:, ::-1], face),
        (np.stack([bottom[:, 0], top[:, 0]], axis=1), u1[:, :1], np.array([WALL_SHADE])),
        (np.stack([top[:, -1], bottom[:, -1]], axis=1), u1[:, -1:], np.array([WALL_SHADE])),
        (np.stack([bottom[0], top[0]]), u1[:1], np.full(across, WALL_SHADE)),
        (np.stack([top[-1], bottom[-1]]), u1[-1:], np.full(across, WALL_SHADE)),
    ):
        corners = np.stack([lines[:-1, :-1], lines[1:, :-1], lines[1:, 1:], lines[:-1, 1:]], axis=2)
        parts.append((corners.reshape(-1, 4, 3) @ camera.T, at.ravel(), np.tile(paint, corners.shape[0])))
    corners, colour, paint = (np.concatenate(items) for items in zip(*parts, strict=True))

    normal = np.cross(corners[:, 3] - corners[:, 1], corners[:, 2] - corners[:, 0])
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), np.finfo(float).tiny)
    order = np.argsort(corners[:, :, 2].sum(axis=1))
    order = order[normal[order, 2] > 0.0]
    shade, gloss = _light(normal[order])
    return Picture(
        corners[order, :, :2], colour[order], shade * paint[order], gloss, camera[:2].T, end / length
    )


def _means(values: Array) -> Array:
    """Means over the cells between points (n, m): array (n - 1, m - 1)."""
    rows = values[1:] + values[:-1]
    return np.asarray(0.25 * (rows[:, 1:] + rows[:, :-1]))


def _camera(points: Array) -> Array:
    """Rows: the directions right, up and towards the viewer, in the fixed basis.

    The shape lies on its broadest side, its longest direction to the right and its start on the left.
    """
    cloud = points.reshape(-1, 3) - points.mean(axis=(0, 1))
    _, axes = np.linalg.eigh(cloud.T @ cloud)
    up = _along(axes[:, 0], np.array([1.0, 0.0, 0.0]))
    right = _along(axes[:, 2], points[-1].mean(axis=0) - points[0].mean(axis=0))
    front = math.cos(SIDE) * np.cross(right, up) - math.sin(SIDE) * right
    toward = math.cos(ELEVATION) * front + math.sin(ELEVATION) * up
    # roll the picture so that the long direction is level in it
    level = right - (right @ toward) * toward
    level /= np.linalg.norm(level)
    return np.stack([level, np.cross(toward, level), toward])


def _along(axis: Array, hint: Array) -> Array:
    """`axis` or its opposite, whichever points along `hint` or, square to it, in a positive direction."""
    lean = axis @ hint
    if abs(lean) <= SQUARE * np.linalg.norm(hint):
        lean = axis[np.argmax(np.abs(axis))]
    return axis if lean >= 0.0 else -axis


def _light(normal: Array) -> tuple[Array, Array]:
    """Diffuse and glossy light of cells with these outward normals."""
    light = LIGHT / np.linalg.norm(LIGHT)
    halfway = light + np.array([0.0, 0.0, 1.0])
    halfway /= np.linalg.norm(halfway)
    # light that wraps around the body: no part of it is black
    shade = DARKEST + (1.0 - DARKEST) * (0.5 + 0.5 * (normal @ light)) ** 1.2
    return shade, GLOSS * np.clip(normal @ halfway, 0.0, 1.0) ** SHARPNESS
