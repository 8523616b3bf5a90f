r"""The relaxed cross-section energy, alone: strains in; energy, resultants and stiffness out."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from . import _core
from .along import END
from .arrays import Array, count, real_array, strain_array
from .check import number
from .errors import InputError
from .growth import Growth
from .material import Isotropic, Material
from .pieces import Pieces
from .ribbon import THINNEST, Ribbon
from .terms import core_pieces

__all__ = ["SectionLaw", "across"]

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
        See `ribbonrs.growth`. Where its amplitudes vary along the ribbon, the methods take S.
    material : Isotropic, MooneyRivlin or Orthotropic
        Only the ratios of its stiffnesses matter here.
    law : str
        "full", or "quadratic": the Taylor polynomial of second order in K2, for edge growth and
        chirality only; its series converges for abs(K2) < 7.46 eta.

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
        self.thickness_ratio = eta
        self.growth = growth
        self.material = material
        self.law = law
        self._width: Pieces | None = None
        self._thickness: Pieces | None = None
        self._reach = 0.0
        self._core: _core.SectionLaw | None = None
        if not growth.varies:
            self._core = self._made(None)

    @classmethod
    def of(cls, ribbon: Ribbon, growth: Growth, law: str = "full") -> SectionLaw:
        """Return the law of each section of `ribbon`, whose width and thickness may vary along it too.

        Strains, energy and resultants in units of the ribbon's `width` and `thickness`; S in [0, L].
        """
        made = cls.__new__(cls)
        made.thickness_ratio, made.material, made.law = ribbon.thickness_ratio, ribbon.material, law
        made.growth = growth
        made._width, made._thickness = ribbon.width_pieces, ribbon.thickness_pieces
        made._reach = ribbon.length_ratio
        growth.check_covers(ribbon.length_ratio)
        made._core = made._made(ribbon.length_ratio)
        return made

    def _made(self, length: float | None) -> _core.SectionLaw:
        width, thickness = (None if f is None else core_pieces(f) for f in (self._width, self._thickness))
        terms = self.growth.core_terms(length)
        try:
            stiffness = self.material.stiffness
            return _core.SectionLaw(self.thickness_ratio, stiffness, terms, FORMS[self.law], width, thickness)
        except ValueError as error:
            raise InputError("law", self.law, f"a law that can represent the growth: {error}") from error

    @property
    def varies(self) -> bool:
        """Whether the section differs along the ribbon."""
        return self.growth.varies or self._width is not None or self._thickness is not None

    def core(self, furthest: float = 0.0) -> _core.SectionLaw:
        """The law in the core, with functions of S resolved up to `furthest` at least."""
        if self._core is None or furthest > self._reach:
            # Further than asked, not to resolve anew at each step, unless functions end before.
            for reach in (max(furthest, 2.0 * self._reach), furthest):
                try:
                    self._core, self._reach = self._made(reach or SHORTEST), reach
                    break
                except InputError:
                    if reach == furthest:
                        raise
        assert self._core is not None
        return self._core

    @property
    def form(self) -> str:
        """How the energy is evaluated: "closed", "general" or "second-order"; at the start, if it varies."""
        return self.core().form

    def energy(self, strains: ArrayLike, S: ArrayLike | None = None) -> Array:
        """Return Pi: strains (..., 4) -> (...,), in units of Y h a.

        `S`, of the leading shape of the strains or broadcast with it, is where along the ribbon, in units of
        the width; needed only where the section varies. Many strains are shared by all cores.
        """
        flat, places, shape = self._rows(strains, S)
        return self.core(_furthest(places)).energy(flat, places).reshape(shape)

    def gradient(self, strains: ArrayLike, S: ArrayLike | None = None) -> Array:
        """Return n3 = dPi/d eps and m_i = dPi/dK_i, eq. (43): strains (..., 4) -> (..., 4)."""
        flat, places, shape = self._rows(strains, S)
        return self.core(_furthest(places)).gradient(flat, places).reshape((*shape, 4))

    def hessian(self, strains: ArrayLike, S: ArrayLike | None = None) -> Array:
        """Return the tangent stiffness, the Hessian of Pi: strains (..., 4) -> (..., 4, 4), symmetric."""
        flat, places, shape = self._rows(strains, S)
        return self.core(_furthest(places)).hessian(flat, places).reshape((*shape, 4, 4))

    def deflection(
        self, strain: ArrayLike, x: ArrayLike, derivative: int = 0, S: float | None = None
    ) -> Array:
        """Return u1/a of the relaxed cross-section, or its first or second derivative: x (...,) -> (...,).

        `strain` is one (4,), x = X2 over the width there, in [-1/2, 1/2]; derivatives are in X2/a. The
        deflection has no component on 1 and x, eqs. (16), (17). Not defined for the quadratic law, which is
        an energy only.
        """
        one, points, place = self._section(strain, x, S, derivative)
        return self.core(place).deflection(one, points.ravel(), derivative, place).reshape(points.shape)

    def displacements(self, strain: ArrayLike, x: ArrayLike, S: float | None = None) -> Array:
        """Return u1, u2, u3 in units of a, relative to the plane section: x (...,) -> (..., 3).

        Arguments as for `deflection`; u2 and u3 are those of the mid-surface, of zero mean, eq. (15).
        """
        one, points, place = self._section(strain, x, S)
        return self.core(place).displacements(one, points.ravel(), place).reshape((*points.shape, 3))

    def _section(
        self, strain: ArrayLike, x: ArrayLike, S: float | None, derivative: int = 0
    ) -> tuple[Array, Array, float]:
        if self.law == "quadratic":
            raise InputError("law", self.law, '"full": the quadratic law has no deflection')
        one = strain_array("strain", strain)
        if one.shape != (4,):
            raise InputError("strain.shape", one.shape, "(4,): eps, K1, K2, K3")
        points = across(x, derivative)
        if S is not None and real_array("S", S, "a number").ndim:
            raise InputError("S", S, "a number: where along the ribbon this one section is")
        place = self._places(S, ())
        return one, points, 0.0 if place is None else float(place[0])

    def _rows(self, strains: ArrayLike, S: ArrayLike | None) -> tuple[Array, Array | None, tuple[int, ...]]:
        """Strains as rows (m, 4), where they are (m,), and the leading shape."""
        array = strain_array("strains", strains)
        shape = array.shape[:-1]
        if S is not None:
            shape = _broadcast(shape, real_array("S", S, PLACES).shape)
            array = np.broadcast_to(array, (*shape, 4))
        return np.ascontiguousarray(array.reshape(-1, 4)), self._places(S, shape), shape

    def _places(self, S: ArrayLike | None, shape: tuple[int, ...]) -> Array | None:
        """S for each row (m,), None where it does not matter."""
        if S is None:
            if self.varies:
                raise InputError("S", None, "where along the ribbon: the section varies with S")
            return None
        places = real_array("S", S, PLACES)
        domain = self._domain()
        outside = places[(places < domain[0]) | (places > domain[1])]
        if outside.size:
            raise InputError("S", float(outside[0]), f"numbers in [{domain[0]:g}, {domain[1]:g}]")
        if not self.varies:
            return None
        return np.ascontiguousarray(np.broadcast_to(places, shape).ravel())

    def _domain(self) -> tuple[float, float]:
        """Where the section is known; the ends of samples count with what rounding adds."""
        start, end = self.growth.domain or (0.0, np.inf)
        for pieces in (self._width, self._thickness):
            if pieces is not None:
                start, end = max(start, pieces.domain[0]), min(end, pieces.domain[1])
        return start, end * (1.0 + END)


def across(x: ArrayLike, derivative: int = 0) -> Array:
    """Return the places x (...) across the width at which a deflection, or a derivative of it, is wanted."""
    points = real_array("x", x, "numbers in [-1/2, 1/2]")
    outside = points[np.abs(points) > 0.5]
    if outside.size:
        raise InputError("x", float(outside[0]), "numbers in [-1/2, 1/2]")
    count("derivative", derivative, 0, 2)
    return points


SHORTEST = 1.0
"""Up to which S functions of S are resolved for the section at S = 0."""

PLACES = "finite numbers S = X3/a >= 0, of the leading shape of the strains"
"""What S may be."""


def _broadcast(shape: tuple[int, ...], places: tuple[int, ...]) -> tuple[int, ...]:
    try:
        return np.broadcast_shapes(shape, places)
    except ValueError:
        raise InputError("S.shape", places, f"{shape}, the leading shape of the strains") from None


def _furthest(places: Array | None) -> float:
    return 0.0 if places is None or places.size == 0 else float(places.max())
