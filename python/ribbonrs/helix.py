r"""The helix that a centreline of constant strains makes."""

from __future__ import annotations

import math
from dataclasses import dataclass

from .arrays import Array

__all__ = ["Helix", "helix_of"]

# Twist below this times the thickness ratio is not called right- or left-handed.
HANDED = 1e-9


@dataclass(frozen=True)
class Helix:
    """The centreline as a helix, lengths in units of the width unless said otherwise.

    A circle is the helix of pitch 0; a straight centreline has radius 0 and the pitch of its twist, infinite
    where there is none.

    Attributes
    ----------
    radius : float
        Of the cylinder on which the centreline lies.
    pitch : float
        Advance along the axis in one turn, >= 0.
    turns : float
        Over the whole length.
    handedness : str
        "right", "left" or, without twist, "none".
    """

    radius: float
    pitch: float
    turns: float
    handedness: str

    def scaled(self, unit: float) -> Helix:
        """Return the same helix with lengths multiplied by `unit`."""
        return Helix(self.radius * unit, self.pitch * unit, self.turns, self.handedness)


def helix_of(strain: Array, length: float, thickness_ratio: float) -> Helix:
    r"""Return the helix of constant `strain` (4,): eps, K1, K2, K3 over 0 <= S <= `length`.

    The directors turn about the fixed vector K_i d_i at the rate W = sqrt(K1^2 + K2^2 + K3^2), so that

        radius = (1 + eps) sqrt(K1^2 + K2^2)/W^2,  pitch = 2 pi (1 + eps) |K3|/W^2,  turns = L W/(2 pi).

    The torsion of the centreline is K3/(1 + eps): K3 > 0 is right-handed. A twist of
    |K3| <= 1e-9 `thickness_ratio` counts as none.
    """
    eps, K1, K2, K3 = (float(value) for value in strain)
    rate = math.hypot(K1, K2, K3)
    handedness = "none"
    if abs(K3) > HANDED * thickness_ratio:
        handedness = "right" if K3 > 0.0 else "left"
    if rate == 0.0:
        return Helix(0.0, math.inf, 0.0, handedness)
    # twice divided by the rate, whose square may underflow
    radius = (1.0 + eps) * math.hypot(K1, K2) / rate / rate
    pitch = 2.0 * math.pi * (1.0 + eps) * abs(K3) / rate / rate
    return Helix(radius, pitch, length * rate / (2.0 * math.pi), handedness)
