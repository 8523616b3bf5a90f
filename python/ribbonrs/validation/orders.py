"""Orders of convergence, measured on problems with exact solutions."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TypeAlias

import numpy as np

from ..arrays import Array
from ..frame import integrate_frame
from ..loads import LineLoad
from .classical import cantilever, elastica
from .row import Row

__all__ = ["rows"]

LOAD = 10.0
"""P L^2/EI of the elastica."""
ELEMENTS = {1: 64, 2: 32, 3: 16, 4: 12}
"""By degree, the coarser mesh: fine enough for the order, errors far above rounding."""
MEASURED = "the next power of the step"
Method: TypeAlias = Callable[[Array], Array | Callable[[Array], Array]]
"""From the places S to what `integrate_frame` takes."""


def rows() -> Iterator[Row]:
    """Yield the orders of the collocation, by degree, and of the frame integrator."""
    for degree, n in ELEMENTS.items():
        coarse, fine = (_tip_error(degree, elements) for elements in (n, 2 * n))
        name = f"order of collocation of degree {degree} at nodes"
        order = float(np.log2(coarse / fine))
        within = 0.1 if degree == 4 else 0.02
        yield Row(name, "2 x degree, Gauss points", 2.0 * degree, order, within, MEASURED)
    methods: tuple[tuple[str, float, int, Method], ...] = (
        ("strains at nodes", 4.0, 320, _strains),
        ("a function of S", 6.0, 40, lambda S: _strains),
    )
    for name, claimed, n, method in methods:
        coarse, fine = (_frame_error(method, segments) for segments in (n, 2 * n))
        told = f"order of the frame, {name}"
        yield Row(told, "integrate_frame", claimed, float(np.log2(coarse / fine)), 0.05, MEASURED)


def _tip_error(degree: int, elements: int) -> float:
    """Error of the tip of the elastica on a uniform mesh.

    A load given by samples, though they are zero, puts a node of the mesh at each; the tolerance accepts the
    first mesh.
    """
    samples = np.linspace(0.0, 1.0, elements + 1)
    nothing = LineLoad(force=(samples, np.zeros((elements + 1, 3))))
    guess = np.array([0.0, 0.0, 1.0, 0.0])
    found = cantilever(LOAD, loads=[nothing], degree=degree, tol=0.5, guess=guess)
    return float(np.hypot(*np.subtract(found, elastica(LOAD))[:2]))


KAPPA, TAU = 0.9, 0.5


def _strains(S: Array) -> Array:
    """Of a helix about which the directors turn by phi = sin S against the normal."""
    zero = np.zeros_like(S)
    phi, rate = np.sin(S), np.cos(S)
    return np.stack([zero, -KAPPA * np.sin(phi), KAPPA * np.cos(phi), TAU - rate], axis=-1)


def _frame_error(method: Method, n: int) -> float:
    """Error of the centreline at S = 6, which is that of the helix of constant curvature and torsion."""
    S = np.linspace(0.0, 6.0, n + 1)
    position, _ = integrate_frame(S, method(S))
    exact, _ = integrate_frame([0.0, 6.0], [[0.0, 0.0, KAPPA, TAU]])
    return float(np.linalg.norm(position[-1] - exact[-1]))
