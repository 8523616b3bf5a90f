"""Mirror images of equilibria: reflections and the half turn that leave a scene as it is.

A reflection or half turn with the signs s of E1, E2, E3 takes a vector v to s v and, as they follow the right
hand, moments and curvatures to det(s) s times themselves.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from .arrays import Array
from .ends import Clamped, Closed, Free, Hinged, Pinned, Sliding, Start
from .linear import LinearLaw
from .loads import LineLoad
from .pieces import Pieces
from .quantity import vector_of
from .scene import Scene

__all__ = ["image", "symmetries"]

SIGNS = ((-1.0, 1.0, 1.0), (1.0, -1.0, 1.0), (-1.0, -1.0, 1.0))
"""Reflections through the thickness and across the width, and the half turn about the length."""

CLOSE = 1e-12
"""What rounding leaves of energies that are the same, relative to them."""

STATIONS = 9
"""Stations along the ribbon at which a law that varies is compared."""


def symmetries(scene: Scene) -> list[Array]:
    """Return the signs (3,) of E1, E2, E3 of what leaves the scene as it is."""
    signs = map(np.array, SIGNS)
    return [s for s in signs if _law_kept(scene, s) and _loads_kept(scene, s) and _ends_kept(scene, s)]


def image(signs: Array, quantity: str) -> float:
    """Return the factor of a quantity (see `ribbonrs.quantity`) in the image of a state."""
    axial = np.prod(signs) * signs
    if quantity in ("K1", "K2", "K3"):
        return float(axial[int(quantity[1]) - 1])
    vector = vector_of(quantity)
    if vector is None:
        return 1.0
    name, k = vector
    return float((axial if name.endswith("moment") else signs)[k])


def _law_kept(scene: Scene, signs: Array) -> bool:
    """Whether the image of every strain has the same energy."""
    factors = np.array([1.0, *(np.prod(signs) * signs)])
    if isinstance(scene.law, LinearLaw):
        intrinsic = np.array(scene.law.intrinsic)
        return bool(np.all(factors * intrinsic == intrinsic))
    law = scene.section_law
    stations = np.linspace(0.0, scene.ribbon.length_ratio, STATIONS) if law.varies else np.zeros(1)
    # strains of the size that thickness makes soft; no two of the same absolute value
    eta = scene.ribbon.thickness_ratio
    strains = np.tile(np.array([0.3 * eta**2, 0.7 * eta**2, 1.3 * eta, 2.1 * eta]), (stations.size, 1))
    energies, images = law.energy(strains, stations), law.energy(factors * strains, stations)
    return bool(np.all(np.abs(energies - images) <= CLOSE * np.abs(energies)))


def _loads_kept(scene: Scene, signs: Array) -> bool:
    """Whether all dead loads between the ends are their own images."""
    forces: list[Sequence[float]] = [scene.gravity]
    moments: list[Sequence[float]] = []
    for load in scene.loads:
        known = load.along(scene.ribbon.length_ratio) if isinstance(load, LineLoad) else vars(load)
        forces.append([_size(f) for f in known["force"]])
        moments.append([_size(m) for m in known["moment"]])
    return _kept(signs, forces) and _kept(np.prod(signs) * signs, moments)


def _size(component: float | Pieces) -> float:
    """Zero if the component is zero everywhere."""
    if isinstance(component, Pieces):
        return max(abs(c) for piece in component.coefficients for c in piece)
    return component


def _kept(factors: Array, vectors: Sequence[ArrayLike]) -> bool:
    return all(np.all(factors * np.array(v) == np.array(v)) for v in vectors)


def _ends_kept(scene: Scene, signs: Array) -> bool:
    return all(
        _end_kept(end, place, signs)
        for end, place in zip((scene.start, scene.end), scene.places, strict=True)
    )


def _end_kept(end: Start, place: tuple[float, ...], signs: Array) -> bool:
    """Whether an end is held and loaded as its image is."""
    axial = np.prod(signs) * signs
    held = isinstance(end, Free) or _kept(signs, [place])
    match end:
        case Clamped():
            return held and _turn_kept(end, axial)
        case Closed():
            return held and (end.link == 0.0 or axial[2] > 0.0)
        case Free():
            return _kept(signs, [end.force]) and _kept(axial, [end.moment])
        case Pinned():
            return held and _kept(axial, [end.moment])
        case Hinged():
            return held and _kept(axial, [end.moment * np.array(end.axis)])
        case Sliding():
            axis = np.array(end.axis)
            line = _kept(signs, [axis]) or _kept(-signs, [axis])
            return held and line and _kept(signs, [end.force * axis]) and _turn_kept(end, axial)


def _turn_kept(end: Clamped | Sliding, axial: Array) -> bool:
    """Whether an orientation is that of the image: its rotation vector is, and so are its turns."""
    turns = end.twist_turns == 0.0 or axial[2] > 0.0
    return turns and (end.rotation is None or _kept(axial, [end.rotation[1:]]))
