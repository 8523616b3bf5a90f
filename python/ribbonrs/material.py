"""What the ribbon is made of: the plane-stress stiffness of a thin layer.

With strains b33 along the ribbon, b22 across it and b23 their shear (half the engineering shear),
the energy density of the layer is, up to a factor,

    Q33 b33^2 + 2 Q23 b33 b22 + Q22 b22^2 + 4 G b23^2.

Young's modulus along the ribbon, Y = Q33 - Q23^2/Q22, sets the unit of force; apart from it only the
ratios of the four constants matter.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TypeAlias

from .check import number, positive
from .errors import InputError

__all__ = ["Isotropic", "Material", "MooneyRivlin", "Orthotropic", "Stiffness"]

Stiffness: TypeAlias = tuple[float, float, float, float]
"""Q33, Q22, Q23 and G, in the user's unit of stress."""


ANISOTROPY = 1e10
"""Largest ratio of two stiffnesses of a material."""


@dataclass(frozen=True)
class Isotropic:
    """An isotropic material.

    Q33 = Q22 = Y/(1 - nu^2), Q23 = nu Y/(1 - nu^2), G = Y/(2 (1 + nu)).

    Parameters
    ----------
    Y : float
        Young's modulus.
    nu : float
        Poisson's ratio, in (-1, 0.5]; 0.5 is incompressible.
    """

    Y: float = 1.0
    nu: float = 0.5

    def __post_init__(self) -> None:
        object.__setattr__(self, "Y", positive("material.Y", self.Y))
        nu = number("material.nu", self.nu, "a number in (-1, 0.5]")
        if not -1.0 < nu <= 0.5:
            raise InputError("material.nu", self.nu, "a number in (-1, 0.5]")
        object.__setattr__(self, "nu", nu)

    @property
    def stiffness(self) -> Stiffness:
        """Q33, Q22, Q23 and G."""
        q = self.Y / (1.0 - self.nu**2)
        return q, q, self.nu * q, self.Y / (2.0 * (1.0 + self.nu))


@dataclass(frozen=True)
class MooneyRivlin:
    """An incompressible Mooney-Rivlin material at small strain: Y = 6 (c1 + c2), nu = 1/2.

    Parameters
    ----------
    c1, c2 : float
        The Mooney-Rivlin constants, c1 + c2 > 0. At small strain only their sum matters.

    Notes
    -----
    Source: Liu, Li & Liu, the material of section 2.
    """

    c1: float
    c2: float

    def __post_init__(self) -> None:
        c1, c2 = number("material.c1", self.c1), number("material.c2", self.c2)
        positive("material.c1 + material.c2", c1 + c2)
        object.__setattr__(self, "c1", c1)
        object.__setattr__(self, "c2", c2)

    @property
    def Y(self) -> float:
        """Young's modulus."""
        return 6.0 * (self.c1 + self.c2)

    @property
    def stiffness(self) -> Stiffness:
        """Q33, Q22, Q23 and G."""
        return Isotropic(self.Y, 0.5).stiffness


@dataclass(frozen=True)
class Orthotropic:
    """An orthotropic material whose axes are those of the ribbon.

    Parameters
    ----------
    Q33, Q22, Q23 : float
        Plane-stress stiffnesses along the ribbon, across it, and between the two: Q33 > 0, Q22 > 0,
        Q33 Q22 > Q23^2.
    G : float
        Shear modulus in the plane of the ribbon, positive.

    Raises
    ------
    InputError
        If a constant is not positive and finite, the stiffness not positive definite, or Q22 or G more than a
        factor 1e10 from Young's modulus along the ribbon.
    """

    Q33: float
    Q22: float
    Q23: float
    G: float

    def __post_init__(self) -> None:
        for name in ("Q33", "Q22", "G"):
            object.__setattr__(self, name, positive(f"material.{name}", getattr(self, name)))
        object.__setattr__(self, "Q23", number("material.Q23", self.Q23))
        # The roots are rounded: without the second condition a stiffness that is just singular would pass.
        if abs(self.Q23) >= math.sqrt(self.Q33) * math.sqrt(self.Q22) or not self.Y > 0.0:
            raise InputError("material.Q23", self.Q23, "Q23^2 < Q33 Q22, a positive definite stiffness")
        for name in ("Q22", "G"):
            if not 1.0 / ANISOTROPY <= getattr(self, name) / self.Y <= ANISOTROPY:
                expected = f"within a factor {ANISOTROPY:g} of Q33 - Q23^2/Q22 = {self.Y:g}"
                raise InputError(f"material.{name}", getattr(self, name), expected)

    @property
    def Y(self) -> float:
        """Young's modulus along the ribbon, Q33 - Q23^2/Q22."""
        return self.Q33 - self.Q23 * (self.Q23 / self.Q22)

    @property
    def stiffness(self) -> Stiffness:
        """Q33, Q22, Q23 and G."""
        return self.Q33, self.Q22, self.Q23, self.G


Material: TypeAlias = Isotropic | MooneyRivlin | Orthotropic
"""Any of the materials."""
