r"""The ribbon in space: mid-surface and layers through the thickness.

A material point (X1, X2, X3) of the ribbon goes to (Liu, Li & Liu, eq. (11))

.. math:: \chi = r + (X_1 + U_1)\, d_1 + (X_2 + U_2)\, d_2 + U_3\, d_3

with, by eq. (15) for a state that does not vary along the length,

.. math:: U_1 = u_1, \quad U_2 = u_2 - X_1 (u_1' - g_{21}), \quad U_3 = u_3 + X_1 (K_3 X_2 + g_{31}),

where the change of thickness (zeta, of order eta^3 a) is neglected. All lengths in units of the width a,
X2 = x w and X1 = +-eta t/2 at the faces with the factors w, t of width and thickness at S and x in
[-1/2, 1/2], ' = d/dX2. Of a state that varies, what du1/dS adds to U3 is neglected, as in its energy.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from .arrays import Array, count, real_array
from .check import number
from .errors import InputError

if TYPE_CHECKING:
    from .state import Sections, State

__all__ = ["placed", "section", "surface"]


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
    sections = state.at(stations)
    middle, fibre = section(state, sections.S, x)
    return placed(sections, middle + level * fibre)


def placed(sections: Sections, points: Array) -> Array:
    """Points (n, nx, 3) in the fixed basis, from those of cross-sections, (n, nx, 3) or (1, nx, 3)."""
    return np.asarray(sections.position[:, None, :] + points @ sections.directors, dtype=np.float64)


def section(state: State, S: Array, x: Array) -> tuple[Array, Array]:
    """Cross-sections at S (n,): the mid-surface relative to the centreline and the fibres to X1 = +h/2.

    Arrays (n, nx, 3), or (1, nx, 3) if all are alike, components on d1, d2, d3.
    """
    law, ribbon = state.relaxed, state.scene.ribbon
    sections = state.course.sections(S)
    count, places = len(sections), S[: len(sections), None]
    middle = np.reshape([law.displacements(strain, x, at) for strain, at in sections], (count, x.size, 3))
    slope = np.reshape([law.deflection(strain, x, 1, at) for strain, at in sections], (count, x.size))
    K3 = np.reshape([strain[3] for strain, _ in sections], (count, 1))
    fields = state.scene.growth.values(x, places)
    width, thickness = (
        1.0 if pieces is None else pieces.evaluate(places)
        for pieces in (ribbon.width_pieces, ribbon.thickness_pieces)
    )
    X2 = width * x
    middle[..., 1] += X2
    fibre = np.empty_like(middle)
    half = 0.5 * ribbon.thickness_ratio * thickness
    fibre[..., 0] = half
    fibre[..., 1] = half * (fields.get("g21", 0.0) - slope)
    fibre[..., 2] = half * (K3 * X2 + fields.get("g31", 0.0))
    return middle, fibre
