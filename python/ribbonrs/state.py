"""An equilibrium of the ribbon and what follows from it: pose, resultants, helix, shape, files, figure."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from os import PathLike
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from . import _core
from .arrays import Array, real_array
from .errors import InputError
from .frame import directors
from .helix import Helix, helix_of
from .law import SectionLaw
from .scene import Scene
from .surface import surface

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["Physical", "Reactions", "Report", "Sections", "State", "Wrench"]

END = 1e-12
"""How far beyond its ends, relative to its length, a ribbon may be asked for."""


@dataclass(frozen=True)
class Report:
    """How a state was found."""

    method: str
    equilibria: int
    """Number of unloaded equilibria found."""
    unresolved: int
    """How many of them stand for several closer than 1e-6 in K/eta."""
    gradient_norm: float
    """Norm of (n3, m1, m2, m3) at the state, evaluated anew: zero but for rounding."""


@dataclass(frozen=True)
class Wrench:
    """A force and a moment, (3,) each, components in the fixed basis."""

    force: Array
    moment: Array


@dataclass(frozen=True)
class Reactions:
    """What holds the ribbon at its two ends."""

    start: Wrench
    end: Wrench


@dataclass(frozen=True)
class Sections:
    """The state at chosen S of any shape (...): fields as in `State`, with (...) in place of n."""

    S: Array
    strains: Array
    position: Array
    quaternion: Array
    directors: Array
    force: Array
    moment: Array


@dataclass(frozen=True)
class Physical:
    """A state in the user's units: lengths as given, stress in the unit of Young's modulus.

    Directors, quaternions and the axial strain have no unit; `energy` is per length of the undeformed ribbon.
    """

    S: Array
    strains: Array
    position: Array
    force: Array
    moment: Array
    energy: float
    helix: Helix


@dataclass(frozen=True, eq=False, repr=False)
class State:
    r"""An equilibrium of an unloaded ribbon of uniform growth, clamped at its start.

    N = M = 0 everywhere, so the strains are one root of dPi = 0 for all S and the centreline is an exact
    helix. Lengths in units of the width a, S = X3/a in [0, L], forces in Y h a, moments in Y h a^2.

    Attributes
    ----------
    scene : Scene
        What was solved.
    strain : (4,) array
        eps, K1, K2, K3, the same at every S.
    energy : float
        Pi, mean over S, in units of Y h a.
    section_index : int
        Number of negative eigenvalues of the 4x4 Hessian of Pi.
    phase : str
        "flat", "bent", "twisted" or "helical": whether K2 and K3 exceed 1e-6 thickness/width. K1 does not
        change the name.
    resolved : bool
        False if this stands for several equilibria closer than 1e-6 in K/eta.
    report : Report
        How it was found.
    S : (n,) array
        The nodes.

    Notes
    -----
    Source: Liu, Li & Liu, eqs. (40)-(43), (65)-(67); the shape of the body, (11), (15).
    """

    scene: Scene
    strain: Array
    energy: float
    section_index: int
    phase: str
    resolved: bool
    report: Report
    S: Array

    def __repr__(self) -> str:
        named = zip(("eps", "K1", "K2", "K3"), self.strain, strict=True)
        strain = ", ".join(f"{name}={value:.6g}" for name, value in named)
        return f"State({self.phase}, stable={self.stable}, {strain})"

    @property
    def stable(self) -> bool:
        """Whether the energy is a strict local minimum: no negative eigenvalue of the section's Hessian."""
        return self.section_index == 0

    @property
    def index(self) -> float:
        """Number of unstable directions: 0, or infinite where the section itself is unstable.

        The law has no strain gradient, so an unstable section is unstable against arbitrarily short
        variations.
        """
        return 0.0 if self.stable else math.inf

    @property
    def strains(self) -> Array:
        """(n, 4): eps, K1, K2, K3 at each node."""
        return self._nodes.strains

    @property
    def position(self) -> Array:
        """(n, 3): the centreline in the fixed basis."""
        return self._nodes.position

    @property
    def quaternion(self) -> Array:
        """(n, 4): unit quaternions, scalar first."""
        return self._nodes.quaternion

    @property
    def directors(self) -> Array:
        """(n, 3, 3): rows d1, d2, d3 in the fixed basis."""
        return self._nodes.directors

    @property
    def force(self) -> Array:
        """(n, 3): internal force, components on the directors."""
        return self._nodes.force

    @property
    def moment(self) -> Array:
        """(n, 3): internal moment, components on the directors."""
        return self._nodes.moment

    @property
    def reactions(self) -> Reactions:
        """Forces and moments that the ends exert on the ribbon."""
        free = Wrench(np.zeros(3), np.zeros(3))
        return Reactions(start=free, end=free)

    @property
    def section_law(self) -> SectionLaw:
        """The full section law: it also gives the deflection where the scene's law has none."""
        return SectionLaw.of(self.scene.ribbon, self.scene.growth)

    @cached_property
    def _nodes(self) -> Sections:
        nodes = self.at(self.S)
        for array in vars(nodes).values():
            array.setflags(write=False)
        return nodes

    def at(self, S: ArrayLike) -> Sections:
        """Return the state at any S in [0, L], a number or an array: exact."""
        length = self.scene.ribbon.length_ratio
        expected = f"numbers in [0, {length:g}], the length over the width"
        points = real_array("S", S, expected)
        # The length over the width is rounded: its end as the user knows it counts as the end.
        if np.any((points < -END * length) | (points > (1.0 + END) * length)):
            raise InputError("S", S, expected)
        points = np.clip(points, 0.0, length)
        start = self.scene.start
        origin = np.zeros(3) if start.position is None else np.array(start.position)
        pose = np.array(start.quaternion)
        position, quaternion = _core.helix(points.ravel(), self.strain, origin, pose)
        shape = points.shape
        quaternion = quaternion.reshape((*shape, 4))
        return Sections(
            S=points,
            strains=np.tile(self.strain, (*shape, 1)),
            position=position.reshape((*shape, 3)),
            quaternion=quaternion,
            directors=directors(quaternion),
            force=np.zeros((*shape, 3)),
            moment=np.zeros((*shape, 3)),
        )

    def deflection(self, x: ArrayLike, derivative: int = 0) -> Array:
        """Return u1 in units of a, or an x-derivative of it: x = X2/a in [-1/2, 1/2], (...) -> (n, ...).

        For the quadratic law, an energy without a deflection, it is that of the full law at the same strains.
        """
        one = self.section_law.deflection(self.strain, x, derivative)
        return np.tile(one, (self.S.size, *(1,) * one.ndim))

    def displacements(self, x: ArrayLike) -> Array:
        """Return u1, u2, u3 of the mid-surface in units of a: x (...) -> (n, ..., 3)."""
        one = self.section_law.displacements(self.strain, x)
        return np.tile(one, (self.S.size, *(1,) * one.ndim))

    def surface(self, nx: int = 41, face: float = 0.0, S: ArrayLike | None = None) -> Array:
        """Return points of the deformed ribbon, (n, nx, 3) in the fixed basis, in units of the width.

        x = X2/a runs from -1/2 to 1/2 along the second axis. `face` is 0 for the mid-surface, +1 or -1 for
        the surfaces X1 = +h/2 and -h/2, between them for a layer inside; `S` (n,) are other stations than
        the nodes.

        Notes
        -----
        Source: Liu, Li & Liu, eqs. (11), (15).
        """
        return surface(self, nx, face, S)

    @property
    def helix(self) -> Helix:
        """The helix of the centreline, in units of the width."""
        ribbon = self.scene.ribbon
        return helix_of(self.strain, ribbon.length_ratio, ribbon.thickness_ratio)

    @property
    def physical(self) -> Physical:
        """The same in the user's units: lengths x a, curvatures / a, forces x Y h a, moments x Y h a^2."""
        ribbon = self.scene.ribbon
        a = ribbon.width
        unit_force = ribbon.material.Y * ribbon.thickness * a
        return Physical(
            S=self.S * a,
            strains=self.strains * np.array([1.0, 1.0 / a, 1.0 / a, 1.0 / a]),
            position=self.position * a,
            force=self.force * unit_force,
            moment=self.moment * (unit_force * a),
            energy=self.energy * unit_force,
            helix=self.helix.scaled(a),
        )

    def plot(self, path: str | PathLike[str] | None = None) -> Figure:
        """Draw the ribbon in space and its cross-section; write the figure to `path` if given.

        See `ribbonrs.plot.plot`.
        """
        from .plot import plot

        return plot(self, path)

    def save(self, path: str | PathLike[str]) -> None:
        """Write the surface (.vtp, .obj) or all data (.npz) by suffix; see `ribbonrs.files.save`."""
        from .files import save

        save(self, path)
