"""The linear law of a classical rod: constant stiffnesses, plane cross-sections."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from .arrays import Array
from .check import LARGEST, Numbers, numbers, positive
from .errors import MISSING, InputError
from .law import across

__all__ = ["LinearLaw"]


@dataclass(frozen=True, init=False)
class LinearLaw:
    r"""A law whose forces and moments are linear in the strains.

    .. math::

        n_3 = EA\,(\varepsilon - \varepsilon^0), \quad m_1 = EI_1 (K_1 - K_1^0), \quad
        m_2 = EI_2 (K_2 - K_2^0), \quad m_3 = GJ\,(K_3 - K_3^0)

    Dimensionless: EA in units of Y h a, the others in Y h a^3. An incompressible ribbon of thickness ratio
    eta that does not grow has EA = 1, EI1 = 1/12, EI2 = eta^2/12 and GJ = eta^2/9.

    Parameters
    ----------
    EA : float, optional
        Stiffness in extension; infinite is the same as `inextensible`.
    EI1, EI2, GJ : float
        Stiffnesses in bending in the plane of the ribbon, out of it, and in twist; infinite is rigid, but not
        all three.
    inextensible : bool
        In place of `EA`.
    intrinsic : sequence of 4 float
        eps, K1, K2, K3 without load.

    Raises
    ------
    InputError
        If a stiffness is not positive, `EA` is missing or given to an inextensible rod, all of EI1, EI2 and
        GJ are infinite, or an intrinsic strain is not finite, larger than 1e60, or an eps of at most -1.

    Examples
    --------
    >>> LinearLaw(EI1=math.inf, EI2=0.5, GJ=0.25, inextensible=True).compliance
    (0.0, 0.0, 2.0, 4.0)
    """

    EA: float
    EI1: float
    EI2: float
    GJ: float
    intrinsic: tuple[float, float, float, float]

    def __init__(
        self,
        *,
        EA: float | None = None,
        EI1: float,
        EI2: float,
        GJ: float,
        inextensible: bool = False,
        intrinsic: Numbers = (0.0, 0.0, 0.0, 0.0),
    ) -> None:
        if not isinstance(inextensible, bool):
            raise InputError("law.inextensible", inextensible, "true or false")
        if EA is None:
            if not inextensible:
                raise InputError("law.EA", MISSING, "the stiffness in extension, or inextensible=True")
            EA = math.inf
        elif inextensible and not _infinite(EA):
            raise InputError("law.EA", EA, "none, since the ribbon is inextensible")
        given = {"EA": EA, "EI1": EI1, "EI2": EI2, "GJ": GJ}
        for name, value in given.items():
            object.__setattr__(self, name, _stiffness(f"law.{name}", value))
        if math.isinf(self.EI1) and math.isinf(self.EI2) and math.isinf(self.GJ):
            raise InputError("law.GJ", GJ, "a finite number, since EI1 and EI2 are infinite")
        object.__setattr__(self, "intrinsic", _strains("law.intrinsic", intrinsic))

    @property
    def inextensible(self) -> bool:
        """Whether the axial strain is the intrinsic one under any load."""
        return math.isinf(self.EA)

    @property
    def compliance(self) -> tuple[float, float, float, float]:
        """1/EA, 1/EI1, 1/EI2, 1/GJ; 0 where rigid."""
        return 1.0 / self.EA, 1.0 / self.EI1, 1.0 / self.EI2, 1.0 / self.GJ

    def gradient(self, strains: ArrayLike, S: ArrayLike | None = None) -> Array:
        """Return n3, m1, m2, m3: strains (..., 4) -> (..., 4); where rigid, a reaction, it is 0."""
        stiffness = [0.0 if math.isinf(value) else value for value in (self.EA, self.EI1, self.EI2, self.GJ)]
        return np.asarray((np.asarray(strains) - self.intrinsic) * stiffness)

    def deflection(
        self, strain: ArrayLike, x: ArrayLike, derivative: int = 0, S: float | None = None
    ) -> Array:
        """Return 0 for every x (...): sections stay plane. Arguments as those of `SectionLaw.deflection`."""
        return np.zeros(across(x, derivative).shape)

    def displacements(self, strain: ArrayLike, x: ArrayLike, S: float | None = None) -> Array:
        """Return 0, 0, 0 for every x: array (..., 3)."""
        return np.zeros((*across(x).shape, 3))


def _stiffness(field: str, value: object) -> float:
    """A positive number, or infinity."""
    return math.inf if _infinite(value) else positive(field, value)


def _infinite(value: object) -> bool:
    return isinstance(value, float) and value == math.inf


def _strains(field: str, value: Numbers) -> tuple[float, float, float, float]:
    expected = "four finite numbers: eps, K1, K2, K3"
    entries = numbers(field, value, expected)
    if len(entries) != 4:
        raise InputError(field, value, expected)
    for i, entry in enumerate(entries):
        if abs(entry) > LARGEST:
            raise InputError(f"{field}[{i}]", entry, f"a number of at most {LARGEST:g}")
    if entries[0] <= -1.0:
        raise InputError(f"{field}[0]", entries[0], "more than -1, at which the ribbon has no length")
    eps, K1, K2, K3 = entries
    return eps, K1, K2, K3
