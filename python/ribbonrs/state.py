"""An equilibrium of the ribbon and what follows from it: pose, resultants, helix, shape, files, figure."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from os import PathLike
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from .arrays import Array, real_array
from .course import Course
from .errors import InputError
from .frame import directors
from .helix import Helix
from .law import SectionLaw
from .report import Report
from .scene import Scene
from .surface import surface

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["Physical", "Reactions", "Sections", "State", "Wrench"]

END = 1e-12
"""How far beyond its ends, relative to its length, a ribbon may be asked for."""


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
    helix: Helix | None


@dataclass(frozen=True, eq=False, repr=False)
class State:
    r"""An equilibrium of an unloaded ribbon, clamped at its start.

    N = M = 0 everywhere, so that the strains at each S are a root of dPi = 0 there. Of a uniform ribbon they
    are the same for all S and the centreline is an exact helix; of one that varies along its length they
    follow a branch of stable roots. Lengths in units of the width a, S = X3/a in [0, L], forces in Y h a,
    moments in Y h a^2; a and h are those of the `Ribbon`, also where its width and thickness vary.

    Attributes
    ----------
    scene : Scene
        What was solved.
    course : Uniform or Along
        How the strains run along the ribbon.
    energy : float
        Pi, mean over S, in units of Y h a.
    section_index : int
        Number of negative eigenvalues of the 4x4 Hessian of Pi; the largest over S.
    phases : tuple of str
        "flat", "bent", "twisted" or "helical": whether K2 and K3 exceed 1e-6 thickness/width, of a ribbon
        that varies those at S. K1 does not change the name. In the order in which they are met along S.
    resolved : bool
        False if this stands for several equilibria closer than 1e-6 in K/eta. Where those of a ribbon that
        varies meet is an event of the `report` instead.
    report : Report
        How it was found.
    S : (n,) array
        The nodes.

    Notes
    -----
    Source: Liu, Li & Liu, eqs. (40)-(43), (65)-(67); the shape of the body, (11), (15).
    """

    scene: Scene
    course: Course
    energy: float
    section_index: int
    phases: tuple[str, ...]
    resolved: bool
    report: Report
    S: Array

    def __repr__(self) -> str:
        columns = zip(("eps", "K1", "K2", "K3"), self.course.strains(self.S).T, strict=True)
        strain = ", ".join(f"{name}={_range(values)}" for name, values in columns)
        return f"State({self.phase}, stable={self.stable}, {strain})"

    @property
    def uniform(self) -> bool:
        """Whether the ribbon and its growth, and so the state, are the same all along."""
        return self.course.uniform

    @property
    def strain(self) -> Array:
        """(4,): eps, K1, K2, K3 of a uniform state, the same at every S; an `InputError` if it varies."""
        return self.course.strain

    @property
    def phase(self) -> str:
        """The phase, if it is one all along, else "curved"."""
        return self.phases[0] if len(self.phases) == 1 else "curved"

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
        """Return the state at any S in [0, L], a number or an array of any shape and order.

        Of a uniform ribbon it is exact; of one that varies strains and poses are as accurate as at the nodes.
        """
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
        places, shape = points.ravel(), points.shape
        position, quaternion = self.course.poses(places, origin, pose)
        quaternion = quaternion.reshape((*shape, 4))
        return Sections(
            S=points,
            strains=self.course.strains(places).reshape((*shape, 4)),
            position=position.reshape((*shape, 3)),
            quaternion=quaternion,
            directors=directors(quaternion),
            force=np.zeros((*shape, 3)),
            moment=np.zeros((*shape, 3)),
        )

    def deflection(self, x: ArrayLike, derivative: int = 0) -> Array:
        """Return u1 in units of a, or an X2/a-derivative of it: x in [-1/2, 1/2], (...) -> (n, ...).

        x is X2 over the width at S. For the quadratic law, an energy without a deflection, it is that of the
        full law at the same strains.
        """
        law = self.section_law
        return self._across(lambda strain, S: law.deflection(strain, x, derivative, S))

    def displacements(self, x: ArrayLike) -> Array:
        """Return u1, u2, u3 of the mid-surface in units of a: x (...) -> (n, ..., 3)."""
        law = self.section_law
        return self._across(lambda strain, S: law.displacements(strain, x, S))

    def _across(self, of: Callable[[Array, float | None], Array]) -> Array:
        """What is `of` a section at all nodes: (n, ...)."""
        rows = np.array([of(strain, S) for strain, S in self.course.sections(self.S)])
        return np.tile(rows, (self.S.size // len(rows), *(1,) * (rows.ndim - 1)))

    def surface(self, nx: int = 41, face: float = 0.0, S: ArrayLike | None = None) -> Array:
        """Return points of the deformed ribbon, (n, nx, 3) in the fixed basis, in units of the width.

        x, X2 over the width at S, runs from -1/2 to 1/2 along the second axis. `face` is 0 for the
        mid-surface, +1 or -1 for the surfaces X1 = +h/2 and -h/2, between them for a layer inside; `S` (n,)
        are other stations than the nodes.

        Notes
        -----
        Source: Liu, Li & Liu, eqs. (11), (15).
        """
        return surface(self, nx, face, S)

    @property
    def helix(self) -> Helix | None:
        """The helix of the centreline, in units of the width; None if the ribbon varies."""
        ribbon = self.scene.ribbon
        return self.course.helix(ribbon.length_ratio, ribbon.thickness_ratio)

    @property
    def physical(self) -> Physical:
        """The same in the user's units: lengths x a, curvatures / a, forces x Y h a, moments x Y h a^2."""
        ribbon, helix = self.scene.ribbon, self.helix
        a = ribbon.width
        unit_force = ribbon.material.Y * ribbon.thickness * a
        return Physical(
            S=self.S * a,
            strains=self.strains * np.array([1.0, 1.0 / a, 1.0 / a, 1.0 / a]),
            position=self.position * a,
            force=self.force * unit_force,
            moment=self.moment * (unit_force * a),
            energy=self.energy * unit_force,
            helix=None if helix is None else helix.scaled(a),
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


def _range(values: Array) -> str:
    """The value, or the least and the greatest if six figures tell them apart."""
    least, greatest = f"{np.min(values):.6g}", f"{np.max(values):.6g}"
    return least if least == greatest else f"[{least}, {greatest}]"
