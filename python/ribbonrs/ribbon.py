"""The undeformed ribbon: its dimensions and its material."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from .along import check_covers, function_of_s
from .check import positive
from .errors import InputError
from .material import Isotropic, Material, MooneyRivlin, Orthotropic
from .pieces import Pieces, grid
from .resolve import Function, adapted
from .samples import Samples

__all__ = ["LONGEST", "THINNEST", "Ribbon"]

THINNEST = 1e-6
"""The least thickness/width: the section law is accurate up to K2 = 1e6 thickness/width, and growth
small enough for the theory bends a ribbon to K2 of order one."""


LARGEST_FACTOR = 1e3
"""The greatest factor of a dimension along the ribbon, and the inverse of the least."""

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
    width_profile, thickness_profile : (S, values) or callable, optional
        Factors of `width` and `thickness` along the ribbon, from 1e-3 to 1e3: a tuple of samples over
        S = X3/width from 0 to length/width, joined by lines (the same S twice is a jump), or a function of S,
        called with an array. `width` and `thickness` stay the units of all results.

    Raises
    ------
    InputError
        If a dimension is not a positive finite number, the thickness anywhere is not less than the width or
        less than 1e-6 of it, or the length more than 1e8 widths.

    Examples
    --------
    >>> Ribbon(length=10.0, width=2.0, thickness=0.1).thickness_ratio
    0.05

    A leaf that tapers to a fifth of its width over its second half:

    >>> leaf = Ribbon(10.0, 1.0, 0.1, width_profile=([0.0, 5.0, 10.0], [1.0, 1.0, 0.2]))
    >>> leaf.width_pieces.evaluate([2.0, 7.5]).tolist()
    [1.0, 0.6]
    """

    length: float
    width: float
    thickness: float
    material: Material = field(default_factory=Isotropic)
    width_profile: Samples | Function | None = None
    thickness_profile: Samples | Function | None = None

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
        self._check_profiles()

    def _check_profiles(self) -> None:
        factors = {"width": self.width_pieces, "thickness": self.thickness_pieces}
        varying = {name: pieces for name, pieces in factors.items() if pieces is not None}
        if not varying:
            return
        degree = max(pieces.degree for pieces in varying.values())
        S, breaks = grid(list(varying.values()), (0.0, self.length_ratio), degree, density=32)
        places = np.concatenate([S, breaks])
        ratio = np.full(places.shape, self.thickness_ratio)
        for name, pieces in varying.items():
            values = np.concatenate([pieces.evaluate(S), pieces.evaluate(breaks, left=True)])
            bad = np.flatnonzero(~((values >= 1.0 / LARGEST_FACTOR) & (values <= LARGEST_FACTOR)))
            if bad.size:
                expected = f"factors from {1.0 / LARGEST_FACTOR:g} to {LARGEST_FACTOR:g}"
                where = f"unlike at S = {places[bad[0]]:.6g}"
                raise InputError(f"ribbon.{name}_profile", float(values[bad[0]]), f"{expected}, {where}")
            ratio = ratio * values if name == "thickness" else ratio / values
        bad = np.flatnonzero(~((ratio >= THINNEST) & (ratio < 1.0)))
        if bad.size:
            found = f"thickness/width {ratio[bad[0]]:.6g} at S = {places[bad[0]]:.6g}"
            expected = f"thickness/width from {THINNEST:g} to 1 everywhere"
            raise InputError(f"ribbon.{[*varying][-1]}_profile", found, expected)

    @cached_property
    def width_pieces(self) -> Pieces | None:
        """The factor of the width over S in [0, length_ratio], None if it is 1."""
        return self._pieces("width_profile")

    @cached_property
    def thickness_pieces(self) -> Pieces | None:
        """The factor of the thickness over S in [0, length_ratio], None if it is 1."""
        return self._pieces("thickness_profile")

    def _pieces(self, name: str) -> Pieces | None:
        value, path = getattr(self, name), f"ribbon.{name}"
        if value is None:
            return None
        profile = function_of_s(path, value)
        if isinstance(profile, Pieces):
            check_covers(path, profile, self.length_ratio)
            kept = tuple(tuple(np.asarray(column, dtype=np.float64).tolist()) for column in value)
            object.__setattr__(self, name, kept)
            return profile
        return adapted(path, profile, self.length_ratio)

    @property
    def varies(self) -> bool:
        """Whether the width or the thickness varies along the ribbon."""
        return self.width_pieces is not None or self.thickness_pieces is not None

    @property
    def thickness_ratio(self) -> float:
        """Thickness over width, eta = h/a."""
        return self.thickness / self.width

    @property
    def length_ratio(self) -> float:
        """Length over width, L = l0/a, the end of the dimensionless arc length S."""
        return self.length / self.width
