"""An equilibrium of the ribbon and what follows from it: pose, resultants, helix, shape, files, figure."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from os import PathLike
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from .arrays import Array, real_array
from .course import Course, Held, Points
from .ends import pose
from .errors import InputError, RibbonWarning
from .frame import directors
from .helix import Helix
from .law import SectionLaw
from .linear import LinearLaw
from .report import Report
from .scene import Scene
from .surface import surface

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["Physical", "Reactions", "Sections", "State", "Wrench", "shown_strains"]

SMALL = 1e-6
"""Errors below this hide strains that are smaller still."""

END = 1e-12
"""How far beyond its ends, relative to its length, a ribbon may be asked for."""


@dataclass(frozen=True)
class Wrench:
    """A force and a moment, (3,) each, components in the fixed basis."""

    force: Array
    moment: Array


@dataclass(frozen=True)
class Reactions:
    """What the two ends exert on the ribbon, moments about the ends themselves.

    At a free end that is its dead load; the end of a closed ribbon is its start, from the other side.
    """

    start: Wrench
    end: Wrench

    def scaled(self, force: float, moment: float) -> Reactions:
        """Return the same with forces and moments multiplied by these units."""
        start, end = (Wrench(force * w.force, moment * w.moment) for w in (self.start, self.end))
        return Reactions(start, end)


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

    Directors, quaternions and the axial strain have no unit; `energy` and `load_potential` are per length of
    the undeformed ribbon.
    """

    S: Array
    strains: Array
    position: Array
    force: Array
    moment: Array
    reactions: Reactions
    energy: float
    load_potential: float
    helix: Helix | None


@dataclass(frozen=True, eq=False, repr=False)
class State:
    r"""An equilibrium of a ribbon.

    Without loads on a ribbon with a free end N = M = 0 everywhere, so that the strains at each S are a root
    of dPi = 0 there. Of a uniform ribbon they are the same for all S and the centreline is an exact helix; of
    one that varies along its length they follow a branch of stable roots. Any other state is the solution of
    a boundary-value problem. Lengths in units of the width a, S = X3/a in [0, L], forces in Y h a, moments in
    Y h a^2; a and h are those of the `Ribbon`, also where its width and thickness vary.

    Attributes
    ----------
    scene : Scene
        What was solved.
    course : Uniform, Along or Held
        How the strains run along the ribbon.
    energy : float
        Pi, mean over S, in units of Y h a.
    section_index : int
        Number of negative eigenvalues of the 4x4 Hessian of Pi; the largest over S.
    phases : tuple of str
        "flat", "bent", "twisted" or "helical": whether K2 and K3 exceed 1e-6 thickness/width, of a ribbon
        that varies those at S. K1 does not change the name. In the order in which they are met along S.
        A ribbon that is loaded or held has one: that name if its curvatures differ by no more than
        1e-6 thickness/width along S and eps by no more than 1e-9, else "curved".
    resolved : bool
        False if this stands for several equilibria closer than 1e-6 in K/eta. Where those of a ribbon that
        varies meet is an event of the `report` instead.
    report : Report
        How it was found.
    S : (n,) array
        The nodes.
    load_potential : float
        Minus the work of the dead loads on the displacement from the origin, a mean over S as the energy: the
        sum of both is stationary.

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
    load_potential: float = 0.0

    def __repr__(self) -> str:
        columns = zip(("eps", "K1", "K2", "K3"), shown_strains(self).T, strict=True)
        strain = ", ".join(f"{name}={_range(values)}" for name, values in columns)
        return f"State({self.phase}, stable={self.stable}, {strain})"

    @property
    def uniform(self) -> bool:
        """Whether the strains are the same all along; `phases` says within which tolerances."""
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
    def stable(self) -> bool | None:
        """Whether the energy is a strict local minimum; None where that is not known, see `index`."""
        return None if self.index is None else self.index == 0.0

    @property
    def index(self) -> float | None:
        """Number of independent ways to lower the energy as the ends are held; infinite where a section is.

        The law has no strain gradient, so an unstable section is unstable against arbitrarily short
        variations. None where loads have no potential: moments that are fixed in space, unless about a hinge.
        Gliding and rolling of a closed ribbon along and about itself change nothing and do not count.
        """
        if self.section_index > 0:
            return math.inf
        if not isinstance(self.course, Held):
            return 0.0
        index = self.course.solution.index
        return None if index is None else float(index)

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
        return self._directors

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
        """Forces and moments that the ends exert on the ribbon, in the fixed basis."""
        if not isinstance(self.course, Held):
            return Reactions(*(Wrench(np.zeros(3), np.zeros(3)) for _ in range(2)))
        force0, moment0, force1, moment1 = self.course.solution.reactions()
        return Reactions(Wrench(force0, moment0), Wrench(force1, moment1))

    @property
    def section_law(self) -> SectionLaw:
        """The full section law: it also gives the deflection where the scene's law has none.

        An `InputError` for a `LinearLaw`, which says nothing of sections.
        """
        law = self.scene.section_law
        return law if law.law == "full" else SectionLaw.of(self.scene.ribbon, self.scene.growth)

    @property
    def relaxed(self) -> SectionLaw | LinearLaw:
        """What gives the deflection of the sections: none for a `LinearLaw`, whose sections stay plane."""
        return self.scene.law if isinstance(self.scene.law, LinearLaw) else self.section_law

    @cached_property
    def _nodes(self) -> Points:
        nodes = self._points(self.S)
        for array in nodes:
            array.setflags(write=False)
        return nodes

    @cached_property
    def _directors(self) -> Array:
        rows = directors(self._nodes.quaternion)
        rows.setflags(write=False)
        return rows

    def _points(self, S: Array) -> Points:
        """What is known at S (m,), from where the start is."""
        return self.course.points(S, *map(np.array, pose(self.scene.start)))

    def at(self, S: ArrayLike) -> Sections:
        """Return the state at any S in [0, L], a number or an array of any shape and order.

        Of a uniform ribbon without load it is exact; else all is as accurate as at the nodes. At a point load
        forces and strains are those to its right.
        """
        length = self.scene.ribbon.length_ratio
        expected = f"numbers in [0, {length:g}], the length over the width"
        points = real_array("S", S, expected)
        # The length over the width is rounded: its end as the user knows it counts as the end.
        if np.any((points < -END * length) | (points > (1.0 + END) * length)):
            raise InputError("S", S, expected)
        points = np.clip(points, 0.0, length)
        found = self._points(points.ravel())
        fields = {
            name: values.reshape((*points.shape, values.shape[1])) for name, values in found._asdict().items()
        }
        return Sections(S=points, directors=directors(fields["quaternion"]), **fields)

    def deflection(self, x: ArrayLike, derivative: int = 0) -> Array:
        """Return u1 in units of a, or an X2/a-derivative of it: x in [-1/2, 1/2], (...) -> (n, ...).

        x is X2 over the width at S. For the quadratic and the linear law, which are energies without a
        deflection, it is that of the full law at the same strains; for a `LinearLaw` it is zero.
        """
        law = self.relaxed
        return self._across(lambda strain, S: law.deflection(strain, x, derivative, S))

    def displacements(self, x: ArrayLike) -> Array:
        """Return u1, u2, u3 of the mid-surface in units of a: x (...) -> (n, ..., 3)."""
        law = self.relaxed
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
        """The helix of the centreline, in units of the width; None if the strains vary."""
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
            reactions=self.reactions.scaled(unit_force, unit_force * a),
            energy=self.energy * unit_force,
            load_potential=self.load_potential * unit_force,
            helix=None if helix is None else helix.scaled(a),
        )

    @cached_property
    def neglected(self) -> float:
        r"""How large the strains are that the theory neglects, relative to those that it balances.

        :math:`|E - e| / \max(|e|, |e_g|)`, root mean squares over the body, weighed by their energy: E the
        exact strains of the body that the state describes, e those of the section law, and e_g those that
        the growth would cause in a ribbon held flat and straight, since where growth fits the shape hardly
        any stress is left. Of order (thickness/width)^2 where all sections are alike, and of order width over
        length where they vary within that length. The energy is off by about as much; that of twist by
        another 0.63 thickness/width, from the free edges, of which this knows nothing, nor of what ends and
        jumps do to the ribbon within about a width. It is 0 of strains within the error of the solution.
        Computed when first asked for: see `docs/validity.md`.

        Raises
        ------
        InputError
            For a `LinearLaw`, which says nothing of sections.

        Warns
        -----
        RibbonWarning
            Above 0.25.
        """
        from .neglected import STRETCHED, neglected

        part = neglected(self)
        if part > STRETCHED:
            message = (
                f"neglected = {part:.2g}: strains that the theory neglects are not small against its own"
            )
            warnings.warn(message, RibbonWarning, stacklevel=3)
        return part

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


def shown_strains(state: State) -> Array:
    """Return the strains at the nodes (n, 4) for people to read: what is less than a small error is 0."""
    error = state.report.error if state.report.error < SMALL else 0.0
    small = np.array([error, *(error / state.scene.ribbon.length_ratio,) * 3])
    return np.where(np.abs(state.strains) <= small, 0.0, state.strains)


def _range(values: Array) -> str:
    """The value, or the least and the greatest if six figures tell them apart."""
    least, greatest = f"{np.min(values):.6g}", f"{np.max(values):.6g}"
    return least if least == greatest else f"[{least}, {greatest}]"
