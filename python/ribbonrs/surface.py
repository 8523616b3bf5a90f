r"""The ribbon in space: mid-surface and layers through the thickness.

A material point (X1, X2, X3) of the ribbon goes to (Liu, Li & Liu, eq. (11))

.. math:: \chi = r + (X_1 + U_1)\, d_1 + (X_2 + U_2)\, d_2 + U_3\, d_3

with, by eq. (15) for a state that does not vary along the length,

.. math:: U_1 = u_1, \quad U_2 = u_2 - X_1 (u_1' - g_{21}), \quad U_3 = u_3 + X_1 (K_3 x + g_{31}),

where the change of thickness (zeta, of order eta^3 a) is neglected. All lengths in units of the width a,
x = X2/a in [-1/2, 1/2], ' = d/dx.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from .arrays import Array, count, real_array
from .check import number
from .errors import InputError

if TYPE_CHECKING:
    from .state import State

__all__ = ["layer", "section_points", "surface"]


STATIONS = "finite numbers of shape (n,)"


def surface(state: State, nx: int = 41, face: float = 0.0, S: ArrayLike | None = None) -> Array:
    """Points of the deformed ribbon, array (n, nx, 3) in the fixed basis, in units of the width.

    Index 0 runs along `S` (default ``state.S``), index 1 across the width from x = -1/2 to 1/2.
    `face` picks the layer: 0 the mid-surface, +1 and -1 the faces X1 = +h/2 and -h/2, anything between a
    layer inside. See `State.surface`.
    """
    x = np.linspace(-0.5, 0.5, count("nx", nx, 2), dtype=np.float64)
    level = number("face", face, "a number from -1 to 1")
    if abs(level) > 1.0:
        raise InputError("face", face, "a number from -1 to 1")
    stations = state.S if S is None else real_array("S", S, STATIONS)
    if stations.ndim != 1:
        raise InputError("S.shape", stations.shape, STATIONS)
    return layer(state, stations, x, 0.5 * state.scene.ribbon.thickness_ratio * level)


def layer(state: State, S: ArrayLike, x: Array, X1: float) -> Array:
    """Points (n, nx, 3) of the layer `X1` at the stations `S` (n,) and `x` (nx,), in units of the width."""
    sections = state.at(S)
    points = sections.position[:, None, :] + section_points(state, x, X1) @ sections.directors
    return np.asarray(points, dtype=np.float64)


def section_points(state: State, x: Array, X1: float) -> Array:
    """Points of one cross-section relative to the centreline: array (nx, 3), components on d1, d2, d3."""
    fields = state.scene.growth.values(x)
    g21, g31 = (fields.get(name, np.zeros_like(x)) for name in ("g21", "g31"))
    law = state.section_law
    u1, u2, u3 = law.displacements(state.strain, x).T
    slope = law.deflection(state.strain, x, derivative=1)
    K3 = state.strain[3]
    return np.stack([X1 + u1, x + u2 - X1 * (slope - g21), u3 + X1 * (K3 * x + g31)], axis=-1)
