r"""What the one-dimensional theory leaves out: the exact strains of the body against those of the theory.

A state is a deformation of the whole body. Its points X1, X2, X3 go to (Liu, Li & Liu, eqs. (11), (15))

.. math::

    \chi = r + (X_1 + U_1) d_1 + (X_2 + U_2) d_2 + U_3 d_3, \quad U_1 = u_1 + \zeta, \quad
    U_2 = u_2 - X_1 s_2, \quad U_3 = u_3 - X_1 s_3,

with the slopes s2 = u1,2 - g21 and s3 = u1,3 - K3 X2 - g31 of the layers, and with the change of thickness
that the strain E11 of (14) and fibres that keep their length as they tilt give,

.. math::

    \zeta = X_1 \big[\tfrac12 (g_{21}^2 + g_{31}^2 - s_2^2 - s_3^2) - c (1 - \nu) m \big]
    + \tfrac12 X_1^2 c\, (b_{22} + b_{33}), \quad e_{11} = -c\, (e_{22} + e_{33}),

c = 1 where volume is kept, nu/(1 - nu) in an isotropic material. The gradient F (12), growth G = I + g and
A = F G^-1 give the exact strain E = (A^T A - I)/2. The theory's is, with nu = Q23/Q22,

.. math:: e_{33} = m - X_1 b_{33}, \quad e_{22} = -\nu m - X_1 b_{22}, \quad e_{23} = X_1 b_{23} .

Compared are these three. E11 follows from them, as no stress acts on the faces; E12 and E13 are zero in the
theory, and what (15) leaves of them fibres take up by tilting a little more. All are weighed by the energy

.. math:: |e|^2 = \int Q_{33} e_{33}^2 + 2 Q_{23} e_{33} e_{22} + Q_{22} e_{22}^2 + 4 G e_{23}^2 \; dV .

Of g23 + g32, of which the theory knows the sum, gamma23 is taken as g32 and d23 as equal halves: as shear of
the mid-surface along the ribbon and as twist. Lengths in units of the width a; f,2 and f,3 are derivatives in
X2 and X3 at a fixed material point, also where the width varies.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.polynomial.legendre import leggauss

from .arrays import Array
from .course import Uniform
from .growth import FIELDS, Shape
from .material import Orthotropic
from .pieces import Pieces
from .sampling import Across, Stations, across, stations, uniform_station

if TYPE_CHECKING:
    from .state import State

__all__ = ["STRETCHED", "neglected"]

STRETCHED = 0.25
"""Where a state warns: the energy may be off by half."""

LAYERS = 4
"""Gauss points through the thickness: strains are of degree 2 in X1, but for small parts."""

ROUNDING = 1e-12
"""Strains below this, relative to the largest displacement gradient, are rounding."""

CLOSEST = 1e-9
"""Breaks across the width closer than this are one."""


def neglected(state: State) -> float:
    r"""Return :math:`|E - e| / \max(|e|, |e_g|)`, see `State.neglected`.

    e_g are the strains that the growth would cause in a ribbon held flat and straight.

    Raises
    ------
    InputError
        For a `LinearLaw`, which says nothing of sections.
    """
    body = _body(state)
    exact, theory, held = body.exact(), body.theory(), body.held()
    lost, kept, grown = (body.norm(strain) for strain in (exact - theory, theory, held))
    scale = max(kept, grown)
    # Neither rounding nor the solver's error is a strain.
    none = max(ROUNDING * body.steepest, state.report.error) * body.norm(np.ones_like(theory))
    return lost / scale if scale > none else 0.0


@dataclass(frozen=True)
class _Body:
    """The body at m stations of k sections each, with n places across the width and `LAYERS` of layers.

    Arrays are (m, k, n), or (m, k, 1) if they do not vary across the width; `X1` and `volume`, the weights of
    an integral over the body, are (m, n, LAYERS), and strains (m, n, LAYERS, 3): e33, e22, e23.
    """

    stations: Stations
    across: Across
    stiffness: tuple[float, float, float, float]
    nu: float
    thinning: float
    width: Array
    strains: tuple[Array, Array, Array, Array]
    u1: tuple[Array, Array, Array]
    u2: Array
    u3: Array
    growth: dict[str, Array]
    slopes: dict[str, Array]
    X1: Array
    volume: Array

    def d2(self, f: Array) -> Array:
        """The derivative in X2."""
        return np.asarray(self.across.derivative(f) / self.width)

    def d3(self, f: Array) -> Array:
        """The derivative in X3 at a fixed X2: that at a fixed x less what x changes with the width."""
        along = self.stations.derivative
        if not self.tapers:
            return np.asarray(along @ f)
        return np.asarray(along @ f - (along @ self.width) * self.across.x * self.d2(f))

    @cached_property
    def tapers(self) -> bool:
        """Whether the width varies."""
        return bool(np.ptp(self.width) > 0.0)

    @cached_property
    def X2(self) -> Array:
        """Across the width, in units of that of reference."""
        return self.width * self.across.x

    @cached_property
    def m(self) -> Array:
        """The membrane strain e33."""
        eps, K1, K2, K3 = self.strains
        bent = K1 * self.X2 - K2 * self.u1[0] + 0.5 * (K3 * self.X2) ** 2
        return np.asarray(eps + bent - self.growth["gamma33"])

    @cached_property
    def b(self) -> tuple[Array, Array, Array]:
        """The changes of curvature b33, b22, b23."""
        _, _, K2, K3 = self.strains
        g33, g22, g23 = self.natural_curvatures
        return K2 + g33, self.u1[2] + g22, K3 + g23

    @cached_property
    def natural_curvatures(self) -> tuple[Array, Array, Array]:
        """The part of growth in b33, b22, b23."""
        g, slopes = self.growth, self.slopes
        return g["d33"], g["d22"] - slopes["g21"], 0.5 * (slopes["g31"] - g["d23"])

    @cached_property
    def rows(self) -> tuple[tuple[Array, ...], ...]:
        """F - I and g at the layers, each nine components row by row, (m, n, LAYERS) or broadcast with it."""
        eps, K1, K2, K3 = map(self.layered, self.strains)
        g, slopes, X1 = self.growth, self.slopes, self.X1
        _, slope, curvature = self.u1
        u1_3 = self.d3(self.u1[0])
        s2, s3 = slope - g["g21"], u1_3 - self.strains[3] * self.X2 - g["g31"]
        s2_2, s3_2 = curvature - slopes["g21"], self.d3(slope) - self.strains[3] - slopes["g31"]
        u2_2 = -self.nu * self.m - 0.5 * slope**2 + g["gamma22"]
        u3_2 = g["gamma23"] - self.strains[3] * (self.u1[0] - self.X2 * slope)
        # zeta = X1 thin + X1^2 wedge / 2
        tilt = 0.5 * (g["g21"] ** 2 + g["g31"] ** 2 - s2**2 - s3**2)
        thin = tilt - self.thinning * (1.0 - self.nu) * self.m
        wedge = self.thinning * (self.b[0] + self.b[1])

        def at(middle: Array, fibre: Array, square: Array | None = None) -> Array:
            value = self.layered(middle) + X1 * self.layered(fibre)
            return value if square is None else value + 0.5 * X1**2 * self.layered(square)

        U1, U2, U3 = at(self.u1[0], thin, wedge), at(self.u2, -s2), at(self.u3, -s3)
        X2 = self.layered(self.X2)
        F = (
            at(thin, wedge),
            at(slope, self.d2(thin), self.d2(wedge)),
            at(u1_3, self.d3(thin), self.d3(wedge)) + K2 * U3 - K3 * (X2 + U2),
            self.layered(-s2),
            at(u2_2, -s2_2),
            at(self.d3(self.u2), -self.d3(s2)) - K1 * U3 + K3 * (X1 + U1),
            self.layered(-s3),
            at(u3_2, -s3_2),
            eps + at(self.d3(self.u3), -self.d3(s3)) + K1 * (X2 + U2) - K2 * (X1 + U1),
        )
        none, half = np.zeros_like(s2), 0.5 * g["d23"]
        grown = (
            *(self.layered(none),) * 3,
            self.layered(g["g21"]),
            at(g["gamma22"], g["d22"]),
            at(none, half),
            self.layered(g["g31"]),
            at(g["gamma23"], half),
            at(g["gamma33"], g["d33"]),
        )
        return F, grown

    @cached_property
    def gradients(self) -> tuple[Array, Array]:
        """F - I and g, (m, n, LAYERS, 3, 3)."""
        F, g = (np.stack(np.broadcast_arrays(*rows, self.volume)[:9], axis=-1) for rows in self.rows)
        return F.reshape(*self.volume.shape, 3, 3), g.reshape(*self.volume.shape, 3, 3)

    @property
    def steepest(self) -> float:
        """The largest displacement gradient or growth."""
        return max(float(np.max(np.abs(part))) for part in self.gradients)

    def exact(self) -> Array:
        """E = (A^T A - I)/2, from H = A - I = (F - G) G^-1 so that nothing cancels."""
        F, g = self.gradients
        H = (F - g) @ np.linalg.inv(np.eye(3) + g)
        E = 0.5 * (H + np.swapaxes(H, -1, -2) + np.swapaxes(H, -1, -2) @ H)
        return np.stack([E[..., 2, 2], E[..., 1, 1], E[..., 1, 2]], axis=-1)

    def theory(self) -> Array:
        """The strains of the section law."""
        return self.of_layers(self.m, self.b)

    def held(self) -> Array:
        """The strains of the ribbon held flat and straight, its length and arc in its plane left free."""
        gamma, x, weights = self.growth["gamma33"], self.across.x, self.across.weights
        mean, arc = (gamma @ weights)[..., None], 12.0 * (gamma @ (x * weights))[..., None]
        return self.of_layers(mean + arc * x - gamma, self.natural_curvatures)

    def of_layers(self, m: Array, b: tuple[Array, Array, Array]) -> Array:
        """e33, e22, e23 of a membrane strain and changes of curvature."""
        m = self.layered(m)
        b33, b22, b23 = map(self.layered, b)
        parts = (m - self.X1 * b33, -self.nu * m - self.X1 * b22, self.X1 * b23)
        return np.stack([np.broadcast_to(part, self.volume.shape) for part in parts], axis=-1)

    def layered(self, f: Array) -> Array:
        """What is known at the sections, at the stations alone: (m, n, 1)."""
        return self.stations.here(f)[..., None]

    def norm(self, strain: Array) -> float:
        """The root of twice the energy of strains."""
        Q33, Q22, Q23, G = self.stiffness
        e33, e22, e23 = np.moveaxis(strain, -1, 0)
        density = Q33 * e33**2 + 2.0 * Q23 * e33 * e22 + Q22 * e22**2 + 4.0 * G * e23**2
        return math.sqrt(float(np.sum(density * self.volume)))


def _body(state: State) -> _Body:
    ribbon, growth = state.scene.ribbon, state.scene.growth
    law, course = state.section_law, state.course
    length, material = ribbon.length_ratio, ribbon.material
    at = uniform_station(length) if isinstance(course, Uniform) else stations(course.breaks, length)
    S = at.S
    width, thickness = (
        np.ones((*S.shape, 1)) if pieces is None else pieces.evaluate(S)[..., None]
        for pieces in (ribbon.width_pieces, ribbon.thickness_pieces)
    )
    sections = course.sections(S.ravel())
    strains = np.array([strain for strain, _ in sections]).reshape(*S.shape, 4, 1)
    eps, K1, K2, K3 = (strains[..., i, :] for i in range(4))
    # Edge layers are (eta/|K2|)^(1/2) wide; without, deflections are smooth over the width.
    sharpest = float(np.max(np.abs(K2) * width**2 / (ribbon.thickness_ratio * thickness)))
    shapes = [shape for term in growth.terms for _, shape in term.shape]
    degree = max((s.degree if isinstance(s, Pieces) else len(s) - 1 for s in shapes), default=0)
    places = across(_breaks(shapes), degree, 1.0 / (1.0 + math.sqrt(sharpest)))
    x = places.x
    shape = (*S.shape, x.size)
    slope, curvature = (
        np.reshape([law.deflection(strain, x, order, s) for strain, s in sections], shape) for order in (1, 2)
    )
    moved = np.reshape([law.displacements(strain, x, s) for strain, s in sections], (*shape, 3))
    grown, slopes = (
        {key: np.broadcast_to(values.get(key, 0.0), shape) for key in FIELDS}
        for values in (growth.values(x, S[..., None]), growth.slopes.values(x, S[..., None]))
    )
    t, w = leggauss(LAYERS)
    half = 0.5 * ribbon.thickness_ratio * at.here(thickness)[..., None]
    Q33, Q22, Q23, G = material.stiffness
    nu = Q23 / Q22
    return _Body(
        stations=at,
        across=places,
        stiffness=(Q33, Q22, Q23, G),
        nu=nu,
        # Constants in the plane say nothing of the thickness: orthotropic layers shall keep their volume.
        thinning=1.0 if isinstance(material, Orthotropic) else nu / (1.0 - nu),
        width=width,
        strains=(eps, K1, K2, K3),
        u1=(moved[..., 0], slope, curvature),
        u2=moved[..., 1],
        u3=moved[..., 2],
        growth=grown,
        slopes={key: values / width for key, values in slopes.items()},
        X1=half * t,
        volume=(at.weights[:, None] * at.here(width))[..., None] * half * places.weights[:, None] * w,
    )


def _breaks(shapes: list[Shape]) -> list[float]:
    """Where growth may jump across the width, and the edges."""
    breaks = [-0.5]
    for x in sorted({x for shape in shapes if isinstance(shape, Pieces) for x in shape.breaks}):
        if x - breaks[-1] > CLOSEST and 0.5 - x > CLOSEST:
            breaks.append(x)
    return [*breaks, 0.5]
