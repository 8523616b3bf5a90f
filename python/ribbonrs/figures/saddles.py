"""The shapes of a ribbon whose growth changes through its thickness: three readings of the paper's saddle.

"published": the curvature of least energy of eqs. (49), (50) with the deflection of eq. (48), both of Liu,
Li & Liu. That deflection, without its sign(K2), is the relaxed one of isochoric growth at that curvature, so
that the shape is that ribbon's, held there. "consistent": the least energy of the growth of eq. (44), a
stress-free cylinder. "isochoric": the natural shape of growth that keeps the volume, d22 = -d33/2, a saddle.
"""

from __future__ import annotations

from ..analytic import saddle
from ..equilibrium import natural_shapes
from ..growth import thickness
from ..ribbon import Ribbon
from ..state import State
from .shapes import held_at

__all__ = ["READINGS", "shape"]

READINGS = ("published", "consistent", "isochoric")


def shape(reading: str, eta: float, xi: float, length: float) -> State:
    """Return the shape of one of `READINGS`, of a ribbon so many widths long."""
    ribbon = Ribbon(length, 1.0, eta)
    growth = thickness(xi, 0.0 if reading == "consistent" else -xi / 2.0)
    if reading == "published":
        curvature = float(saddle(eta, xi, form="published").natural_curvature())
        return held_at(ribbon, growth, (0.0, 0.0, curvature, 0.0))
    return natural_shapes(ribbon, growth)[0]
