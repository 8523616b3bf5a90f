r"""A ribbon whose edges grow, with a trace of chirality, in numbers that are the same for every thickness.

The growth is :math:`g_{33} = \xi (2 X_2/a)^2` (Liu, Li & Liu, eq. (51)) and
:math:`g_{23} + g_{32} = 2 \eta \omega X_1/a`. Unloaded, with :math:`k_i = K_i/\eta` and :math:`\hat\xi =
\xi/\eta^2`, :math:`\eta` drops out of its energy: only :math:`\hat\xi` and :math:`\omega` are left.
"""

from __future__ import annotations

import math

import numpy as np

from ..arrays import Array
from ..continuation import trace
from ..diagram import Diagram
from ..growth import chiral, edge
from ..ribbon import Ribbon
from ..scene import Scene

__all__ = [
    "BENDING",
    "CHIRAL",
    "EDGE",
    "LENGTH",
    "MIDDLE_BENDING",
    "OMEGA",
    "PAPER_COILS",
    "TWISTING",
    "chirality_of",
    "coiling",
    "diagram_of",
    "grown",
]

EDGE, CHIRAL = "growth.edge.amplitude", "growth.chiral.amplitude"
OMEGA = 0.2
"""Chirality if nothing is said: twisted ribbons coil within a few hundredths of the paper's threshold."""
LENGTH = 12.0
"""In widths."""

# K2^2 has the factor eta^2/24 + C/720 - C^2/(20160 eta^2) in eq. (59): zero at these C/eta^2.
SOFT, SOFT_MIDDLE = 14.0 - math.sqrt(1036.0), 14.0 + math.sqrt(1036.0)
BENDING, MIDDLE_BENDING = -SOFT / 4.0, -SOFT_MIDDLE / 4.0
"""xi/eta^2 at which a flat ribbon bends, if its edges grow and if its middle does: there C = -4 xi."""
TWISTING = 5.0
"""xi/eta^2 at which a flat ribbon that is kept from bending twists, eq. (64)."""
PAPER_COILS = 5.2, 5.4
"""xi/eta^2 between which ribbons turn from twisted to helical according to the paper."""


def coiling(omega: Array, edges: bool = True) -> Array:
    r"""Return :math:`\hat\xi` at which the twisted ribbon coils, if its edges grow or if its middle does.

    Along the twisted state :math:`C/\eta^2 = -20 (1 - \omega/k_3)`, so that with the C at which its bending
    stiffness vanishes

    .. math:: k_3 = \omega/(1 + C/(20 \eta^2)), \quad \hat\xi = k_3^2/8 - C/(4 \eta^2).
    """
    C = SOFT if edges else SOFT_MIDDLE
    return np.asarray((np.asarray(omega) / (1.0 + C / 20.0)) ** 2 / 8.0 - C / 4.0)


def chirality_of(x: float) -> float:
    """Return the omega > 0 for which `coiling` is x, if the edges grow."""
    return (1.0 + SOFT / 20.0) * math.sqrt(8.0 * (x - BENDING))


def grown(eta: float, x: float, omega: float) -> Scene:
    """Return the ribbon of thickness ratio `eta` with the edge growth x eta^2 and the chirality omega."""
    growth = edge(x * eta**2) + chiral(2.0 * eta * omega)
    return Scene(Ribbon(LENGTH, 1.0, eta), growth)


def diagram_of(eta: float, omega: float, highest: float, points: int = 2) -> Diagram:
    """Return its branches over an edge growth from 0 to `highest` eta^2, through so many equal steps."""
    span = 0.0, highest * eta**2
    values = np.linspace(*span, points).tolist()
    return trace(grown(eta, 0.0, omega), EDGE, span, values=values)
