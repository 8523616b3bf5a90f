r"""The relaxed cross-section energy, alone: strains in; energy, resultants and stiffness out."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from . import _core
from .arrays import Array, count, real_array, strain_array
from .check import number
from .errors import InputError
from .growth import Growth
from .material import Isotropic, Material
from .ribbon import THINNEST

__all__ = ["SectionLaw"]

FORMS = {"full": "auto", "quadratic": "second-order"}
"""The core's form of each `law`."""


class SectionLaw:
    r"""The energy per unit length of a ribbon whose cross-sections have relaxed.

    .. math::

        \Pi(\varepsilon, K_1, K_2, K_3) = \min_U \tfrac12 \int m^2 dx
        + \tfrac{\eta^2}{18} \int (b_{33}^2 + b_{22}^2 + b_{33} b_{22} + b_{23}^2)\, dx

    over x = X2/a in [-1/2, 1/2], with m = eps + K1 x - K2 U + K3^2 x^2/2 - gamma33, b33 = K2 + d33,
    b22 = U'' - g21' + d22, b23 = K3 + g31'/2 - d23/2 and U = u1/a free of its components on 1 and x
    (another material changes the weights of the second integral).

    Energy in units of Y h a, forces Y h a, moments Y h a^2, curvatures 1/a, lengths a, where h is the
    thickness, a the width and Y Young's modulus along the ribbon. Strains are eps, K1, K2, K3 in the last
    axis of an array (..., 4); the leading axes carry over to the results.

    Parameters
    ----------
    thickness_ratio : float
        eta = h/a, from 1e-6 to 1.
    growth : Growth
        See `ribbonrs.growth`.
    material : Isotropic, MooneyRivlin or Orthotropic
        Only the ratios of its stiffnesses matter here.
    law : str
        "full", or "quadratic": the Taylor polynomial of second order in K2, for edge growth and
        chirality only; its series converges for |K2| < 7.46 eta.

    Raises
    ------
    InputError
        A value out of range, or a growth that the quadratic law cannot represent.

    Notes
    -----
    Source: Liu, Li & Liu, eqs. (19), (24), (30)-(39); "quadratic" is eq. (59).

    Examples
    --------
    >>> import ribbonrs as rb
    >>> law = rb.SectionLaw(thickness_ratio=0.1, growth=rb.growth.edge(0.06))
    >>> flat, bent = law.energy([[0.02, 0.0, 0.0, 0.0], [0.02, 0.0, 0.3, 0.0]])
    >>> bool(bent < flat)
    True
    >>> law.hessian([0.02, 0.0, 0.3, 0.0]).shape
    (4, 4)
    """

    def __init__(
        self, thickness_ratio: float, growth: Growth, material: Material | None = None, law: str = "full"
    ) -> None:
        expected = f"a number from {THINNEST:g} to 1"
        eta = number("thickness_ratio", thickness_ratio, expected)
        if not THINNEST <= eta < 1.0:
            raise InputError("thickness_ratio", thickness_ratio, expected)
        if not isinstance(growth, Growth):
            raise InputError("growth", growth, "a growth made with ribbonrs.growth")
        material = Isotropic() if material is None else material
        if not isinstance(material, Material):
            raise InputError("material", material, "Isotropic, MooneyRivlin or Orthotropic")
        if not isinstance(law, str) or law not in FORMS:
            raise InputError("law", law, "one of " + ", ".join(FORMS))
        try:
            self.core = _core.SectionLaw(eta, material.stiffness, growth.fields(), FORMS[law])
        except ValueError as error:
            raise InputError("law", law, f"a law that can represent the growth: {error}") from error
        self.thickness_ratio = eta
        self.growth = growth
        self.material = material
        self.law = law

    @property
    def form(self) -> str:
        """How the energy is evaluated: "closed", "general" or "second-order"."""
        return self.core.form

    def energy(self, strains: ArrayLike, S: None = None) -> Array:
        """Return Pi: strains (..., 4) -> (...,), in units of Y h a.

        `S` is where along the ribbon; growth does not vary with S in this version, so None.
        """
        flat, shape = _rows(strains, S)
        return self.core.energy(flat).reshape(shape)

    def gradient(self, strains: ArrayLike, S: None = None) -> Array:
        """Return n3 = dPi/d eps and m_i = dPi/dK_i, eq. (43): strains (..., 4) -> (..., 4)."""
        flat, shape = _rows(strains, S)
        return self.core.gradient(flat).reshape((*shape, 4))

    def hessian(self, strains: ArrayLike, S: None = None) -> Array:
        """Return the tangent stiffness, the Hessian of Pi: strains (..., 4) -> (..., 4, 4), symmetric."""
        flat, shape = _rows(strains, S)
        return self.core.hessian(flat).reshape((*shape, 4, 4))

    def deflection(self, strain: ArrayLike, x: ArrayLike, derivative: int = 0) -> Array:
        """Return u1/a of the relaxed cross-section, or its first or second x-derivative: x (...,) -> (...,).

        `strain` is one (4,), x = X2/a in [-1/2, 1/2]. The deflection has no component on 1 and x, eqs. (16),
        (17). Not defined for the quadratic law, which is an energy only.
        """
        one, points = self._section(strain, x)
        if count("derivative", derivative, 0) > 2:
            raise InputError("derivative", derivative, "0, 1 or 2")
        return self.core.deflection(one, points.ravel(), derivative).reshape(points.shape)

    def displacements(self, strain: ArrayLike, x: ArrayLike) -> Array:
        """Return u1, u2, u3 in units of a, relative to the plane section: x (...,) -> (..., 3).

        Arguments as for `deflection`; u2 and u3 are those of the mid-surface, of zero mean, eq. (15).
        """
        one, points = self._section(strain, x)
        return self.core.displacements(one, points.ravel()).reshape((*points.shape, 3))

    def _section(self, strain: ArrayLike, x: ArrayLike) -> tuple[Array, Array]:
        if self.law == "quadratic":
            raise InputError("law", self.law, '"full": the quadratic law has no deflection')
        one = strain_array("strain", strain)
        if one.shape != (4,):
            raise InputError("strain.shape", one.shape, "(4,): eps, K1, K2, K3")
        points = real_array("x", x, "numbers in [-1/2, 1/2]")
        outside = points[np.abs(points) > 0.5]
        if outside.size:
            raise InputError("x", float(outside[0]), "numbers in [-1/2, 1/2]")
        return one, points


def _rows(strains: ArrayLike, S: None) -> tuple[Array, tuple[int, ...]]:
    """Strains as rows (m, 4), and the leading shape."""
    if S is not None:
        raise InputError("S", S, "None: growth does not vary along the ribbon in this version")
    array = strain_array("strains", strains)
    return array.reshape(-1, 4), array.shape[:-1]
