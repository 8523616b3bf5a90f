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
from .ends import Closed, Free
from .surface import placed, section

if TYPE_CHECKING:
    from .state import Sections, State

__all__ = ["Picture", "render"]

# A ribbon of more turns is drawn up to here: the rest would only be a grey band.
MAX_TURNS = 20.0
CELLS_PER_TURN = 96.0
CELLS_PER_WIDTH = 6.0
MIN_ALONG, MAX_ALONG = 240, 2400
CELLS, MIN_ACROSS, MAX_ACROSS = 20_000, 32, 100
OUTLINE = 0.012
"""Width of the dark outline along the edges, in units of the ribbon's width."""

# The shape lies on its broadest side and is seen from above and from the side by these angles; one of which
# is known what is up is seen from above by less and straight on, so that what is level is level.
ELEVATION, SIDE, STANDING = math.radians(35.0), math.radians(15.0), math.radians(26.0)

# A centreline does not choose what is up if it departs less from a straight line, relative to its length, or
# in its main direction less than so many times as much as in the other.
STRAIGHT, ROUND = 0.01, 1.3

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


def render(state: State, view: Array | None = None, detail: float = 1.0) -> Picture:
    """Return the body of `state` as cells to paint: both faces, the edges and the ends.

    `view` (3, 3) has as rows the directions right, up and towards the viewer in the fixed basis; by default
    they suit the shape. Of a small picture less `detail`, a part of the cells, is enough.
    """
    length, course = state.scene.ribbon.length_ratio, state.course
    end = length
    turns = float(course.turns(np.array([length]))[0])
    if turns > MAX_TURNS:
        places = np.linspace(0.0, length, 1001)
        end = float(np.interp(MAX_TURNS, course.turns(places), places))
    fineness = math.sqrt(detail)
    wanted = max(CELLS_PER_TURN * min(turns, MAX_TURNS), CELLS_PER_WIDTH * end)
    along = int(fineness * np.clip(wanted, MIN_ALONG, MAX_ALONG))
    across = int(np.clip(detail * CELLS / along, fineness * MIN_ACROSS, MAX_ACROSS))
    S = np.linspace(0.0, end, along + 1)
    x = np.concatenate([[-0.5], np.linspace(-0.5 + OUTLINE, 0.5 - OUTLINE, across - 1), [0.5]])
    sections = state.at(S)
    middle, fibre = section(state, S, x)
    top, bottom = placed(sections, middle + fibre), placed(sections, middle - fibre)
    u1 = _means(np.broadcast_to(middle[..., 0], (along + 1, across + 1)))

    camera = view
    if camera is None:
        camera = _camera(np.concatenate([top, bottom], axis=1), _upright(state, sections))
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


def _upright(state: State, sections: Sections) -> tuple[Array, Array] | None:
    """What is up in the picture and what goes to the right; None leaves the shape lying on its broadest side.

    Up is against gravity; of another ribbon that is held or loaded, the way it leaves the line between its
    ends or, straight or coiled, its thickness. To the right is that line; with a free end, that along which
    the other is held.
    """
    scene, centreline = state.scene, sections.position
    heavy = any(scene.gravity)
    if not heavy and (not scene.loaded or isinstance(scene.start, Closed)):
        return None
    line, middle = centreline[-1] - centreline[0], centreline[0]
    if isinstance(scene.start, Free) or isinstance(scene.end, Free):
        held = -1 if isinstance(scene.start, Free) else 0
        line, middle = scene.ribbon.length_ratio * sections.directors[held, 2], centreline.mean(axis=0)
    if heavy:
        return -_unit(np.array(scene.gravity)), line
    away = _square(centreline - middle, line)
    _, size, axes = np.linalg.svd(away, full_matrices=False)
    if size[0] <= max(STRAIGHT * scene.ribbon.length_ratio * math.sqrt(len(away)), ROUND * size[1]):
        return _unit(_square(sections.directors[0, 0], line)), line
    return _along(axes[0], np.array([1.0, 0.0, 0.0])), line


def _camera(points: Array, upright: tuple[Array, Array] | None) -> Array:
    """Rows: the directions right, up and towards the viewer, in the fixed basis.

    The shape lies on its broadest side, its longest direction to the right and its start on the left, unless
    it is told what is up and what goes to the right.
    """
    cloud = points.reshape(-1, 3) - points.mean(axis=(0, 1))
    line = points[-1].mean(axis=0) - points[0].mean(axis=0)
    elevation, side = ELEVATION, SIDE
    if upright is not None:
        up, line = upright[0], _square(upright[1], upright[0])
        cloud = _square(cloud, up)
        elevation, side = STANDING, 0.0
    _, axes = np.linalg.eigh(cloud.T @ cloud)
    right = _along(axes[:, 2], line)
    if upright is None:
        up = _along(axes[:, 0], np.array([1.0, 0.0, 0.0]))
    elif np.linalg.norm(line) > 0.5 * np.ptp(cloud @ right):
        right = _unit(line)
    front = math.cos(side) * np.cross(right, up) - math.sin(side) * right
    toward = math.cos(elevation) * front + math.sin(elevation) * up
    # roll the picture so that the long direction is level in it
    level = _unit(right - (right @ toward) * toward)
    return np.stack([level, np.cross(toward, level), toward])


def _square(vectors: Array, axis: Array) -> Array:
    """The parts of vectors (..., 3) square to an axis, all of them if it has no length."""
    size = float(axis @ axis)
    return vectors if size == 0.0 else np.asarray(vectors - (vectors @ axis)[..., None] * axis / size)


def _unit(vector: Array) -> Array:
    """The direction of a vector that is not zero."""
    scaled = vector / np.max(np.abs(vector))
    return np.asarray(scaled / np.linalg.norm(scaled))


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
