"""The undeformed ribbon: its dimensions and its material."""

from __future__ import annotations

from dataclasses import dataclass, field

from .check import positive
from .errors import InputError
from .material import Isotropic, Material, MooneyRivlin, Orthotropic

__all__ = ["LONGEST", "THINNEST", "Ribbon"]

THINNEST = 1e-6
"""The least thickness/width: the section law is accurate up to K2 = 1e6 thickness/width, and growth
small enough for the theory bends a ribbon to K2 of order one."""


LONGEST = 1e8
"""The greatest length/width: beyond, coordinates along the ribbon no longer resolve a cross-section."""


@dataclass(frozen=True)
class Ribbon:
    """A straight, flat ribbon before growth.

    Parameters
    ----------
    length, width, thickness : float
        In one length unit of the user's choice. The theory is for thickness << width << length.
    material : Isotropic, MooneyRivlin or Orthotropic
        Default: incompressible isotropic with Young's modulus 1.

    Raises
    ------
    InputError
        If a dimension is not a positive finite number, the thickness is not less than the width or less
        than 1e-6 of it, or the length more than 1e8 widths.

    Examples
    --------
    >>> Ribbon(length=10.0, width=2.0, thickness=0.1).thickness_ratio
    0.05
    """

    length: float
    width: float
    thickness: float
    material: Material = field(default_factory=Isotropic)

    def __post_init__(self) -> None:
        for name in ("length", "width", "thickness"):
            object.__setattr__(self, name, positive(f"ribbon.{name}", getattr(self, name)))
        if self.thickness >= self.width:
            expected = f"less than ribbon.width = {self.width}"
            raise InputError("ribbon.thickness", self.thickness, expected)
        if self.thickness_ratio < THINNEST:
            expected = f"at least {THINNEST:g} times ribbon.width = {self.width}"
            raise InputError("ribbon.thickness", self.thickness, expected)
        if self.length_ratio > LONGEST:
            expected = f"at most {LONGEST:g} times ribbon.width = {self.width}"
            raise InputError("ribbon.length", self.length, expected)
        if not isinstance(self.material, Isotropic | MooneyRivlin | Orthotropic):
            raise InputError("ribbon.material", self.material, "Isotropic, MooneyRivlin or Orthotropic")

    @property
    def thickness_ratio(self) -> float:
        """Thickness over width, eta = h/a."""
        return self.thickness / self.width

    @property
    def length_ratio(self) -> float:
        """Length over width, L = l0/a, the end of the dimensionless arc length S."""
        return self.length / self.width
