"""Phase diagrams: which states are stable over two parameters of a scene, and where that changes."""

from __future__ import annotations

import math
import warnings
from collections.abc import Sequence
from dataclasses import dataclass, field
from os import PathLike
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from . import _core
from .arrays import Array, count
from .check import number, numbers
from .errors import InputError, RibbonWarning
from .parameter import Parameter, parameter_of
from .scene import GROWTH_WARNING, Scene
from .telling import Telling

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = [
    "PHASES",
    "Axis",
    "Boundary",
    "PhaseDiagram",
    "check_parameters",
    "load_phase_diagram",
    "phase_diagram",
]

PHASES = ("flat", "bent", "twisted", "helical")
"""Phases of natural shapes, in the order of the counts of stable states."""

NONE_STABLE = "none stable"
"""Instead of a phase where no state is stable, as happens with ``law="quadratic"``."""

NATURAL_N, HELD_N = 200, 25
"""Values of each parameter if nothing is said, of natural shapes and of held or loaded ribbons."""

NATURAL_CELLS, HELD_CELLS = 4_000_000, 40_000
"""Most points: a few minutes of work."""

NATURAL_TOLERANCE, HELD_TOLERANCE = 1e-10, 1e-6
LEAST_TOLERANCE, GREATEST_TOLERANCE = 1e-14, 1e-2

CONTINUOUS = 0.03
"""A change by less than this of K2, K3 over the thickness ratio is no jump."""

MOST = 0.75
"""The part of a line on which a change is to be as small."""

SPAN = "two finite numbers, the lower one first"

Parameters: TypeAlias = tuple[str, Sequence[float]]
"""Name of a parameter and its least and greatest value."""


@dataclass(frozen=True)
class Axis:
    """A parameter of a phase diagram: its name in `parameters`, and its values, equally spaced."""

    name: str
    values: Array

    @property
    def span(self) -> tuple[float, float]:
        """The least and the greatest value."""
        return float(self.values[0]), float(self.values[-1])


@dataclass(frozen=True, eq=False)
class Boundary:
    """A line between two regions of a phase diagram.

    Attributes
    ----------
    points : (k, 2) array
        Values of the two parameters.
    phases : tuple of 2 str
        The phase on its left and on its right, walking along it with the second parameter upwards; "" is
        outside of what is known.
    stable : tuple of 2 tuples of int
        Numbers of stable states of each of `PHASES` on both sides; () where they are not known.
    jump : (k,) array
        How far the lowest state jumps in (K2, K3) over the thickness ratio; nan where lines meet, at the rim
        of the diagram, and for ribbons that are held or loaded.
    """

    points: Array
    phases: tuple[str, str]
    stable: tuple[tuple[int, ...], tuple[int, ...]]
    jump: Array

    @property
    def kind(self) -> str:
        """What happens there.

        - "instability": the lowest state becomes another one continuously, as others begin or end
        - "jump": the lowest state is another one on each side
        - "others": the lowest state stays as it is, others begin or end
        - "name": a state gets another name, none begins or ends
        - "change": not known, of ribbons that are held or loaded
        """
        if () in self.stable:
            return "change"
        renamed = sum(self.stable[0]) == sum(self.stable[1])
        if self.phases[0] == self.phases[1]:
            return "name" if renamed else "others"
        # Where a line reaches thin ribbons the state a little beyond a pitchfork is far away: of most of it.
        known = self.jump[np.isfinite(self.jump)]
        if known.size and float(np.quantile(known, MOST)) > CONTINUOUS:
            return "jump"
        return "name" if renamed else "instability"


@dataclass(frozen=True, eq=False)
class PhaseDiagram:
    """The stable states over two parameters of a scene.

    Rows are values of `y`, columns of `x`: shape (ny, nx) throughout.

    Attributes
    ----------
    scene : Scene
        The scene; its own values of the two parameters do not matter.
    x, y : Axis
        The parameters and their values.
    phase : (ny, nx) array of str
        Of a ribbon that hangs free that of the stable state of lowest energy: "flat", "bent", "twisted",
        "helical", or "none stable". Of one that is held or loaded that of the state that was followed, with
        ", unstable" or ", stability not known" where it is so. "" where nothing is known.
    stable : (ny, nx, 4) array of int
        How many stable states of each of `PHASES` there are, mirror images included; of a ribbon that is held
        or loaded all are 0.
    stable_count : (ny, nx) array of int
        How many stable states are known; of a ribbon that is held or loaded 1, or 0.
    energy, K2, K3 : (ny, nx) array
        Of the state whose phase is given, dimensionless, means over S; nan where nothing is known.
    resolved : (ny, nx) array of bool
        False where states closer than 1e-6 in K over the thickness ratio are not told apart.
    done : (ny, nx) array of bool
        False where the work was interrupted before, or no state was found.
    boundaries : tuple of Boundary
        Where the phase, or the numbers of stable states, change.
    rim : tuple of Boundary
        Around what is known; outside is on the right.
    reasons : dict from (int, int) to str
        Why no state was found at [j, i].
    tol : float
        How well the places of the boundaries are known along the lines of the grid, relative to the spans.
    interrupted : bool
        Whether the work was ended by an interrupt.
    """

    scene: Scene
    x: Axis
    y: Axis
    phase: NDArray[np.str_]
    stable: NDArray[np.int64]
    stable_count: NDArray[np.int64]
    energy: Array
    K2: Array
    K3: Array
    resolved: NDArray[np.bool_]
    done: NDArray[np.bool_]
    boundaries: tuple[Boundary, ...]
    rim: tuple[Boundary, ...]
    reasons: dict[tuple[int, int], str] = field(default_factory=dict)
    tol: float = NATURAL_TOLERANCE
    interrupted: bool = False

    def __repr__(self) -> str:
        ny, nx = self.phase.shape
        axes = ", ".join(
            f"{axis.name} in [{axis.span[0]:.6g}, {axis.span[1]:.6g}]" for axis in (self.x, self.y)
        )
        left = "" if self.done.all() else f", {np.count_nonzero(~self.done)} not done"
        return f"PhaseDiagram({axes}, {nx} x {ny}, {len(self.boundaries)} boundaries{left})"

    @property
    def areas(self) -> dict[str, float]:
        """The part of the diagram that each phase takes, largest first, from the refined boundaries."""
        areas: dict[str, float] = {}
        origin, end = np.array([self.x.span, self.y.span]).T
        for line in (*self.boundaries, *self.rim):
            # In parts of the spans, whose product may be too small, or too large, for a number.
            x, y = ((line.points - origin) / (end - origin)).T
            area = 0.5 * float(np.sum(x[:-1] * y[1:] - x[1:] * y[:-1]))
            for phase, sign in zip(line.phases, (1.0, -1.0), strict=True):
                if phase:
                    areas[phase] = areas.get(phase, 0.0) + sign * area
        return dict(sorted(areas.items(), key=lambda item: -item[1]))

    def table(self) -> dict[str, list[Any]]:
        """Return the columns of a table of all points, row after row: parameters, phase, states, reasons."""
        x, y = (grid.ravel().tolist() for grid in np.meshgrid(self.x.values, self.y.values))
        reasons = [self.reasons.get(place, "") for place in np.ndindex(self.phase.shape)]
        counts = {f"stable_{phase}": self.stable[..., k].ravel().tolist() for k, phase in enumerate(PHASES)}
        names = ("phase", "stable_count", "energy", "K2", "K3", "resolved", "done")
        columns = {name: getattr(self, name).ravel().tolist() for name in names}
        return {self.x.name: x, self.y.name: y, **columns, **counts, "reason": reasons}

    def to_dataframe(self) -> Any:
        """Return `table` as a pandas DataFrame.

        Raises
        ------
        RibbonError
            If pandas is not installed.
        """
        from .table import dataframe

        return dataframe(self.table())

    def to_csv(self, path: str | PathLike[str]) -> None:
        """Write `table` as comma-separated values, numbers with all their digits."""
        from .table import write

        write(self.table(), path)

    def plot(self, path: str | PathLike[str] | None = None) -> Figure:
        """Draw the regions and their boundaries; write the figure to `path` if given.

        See `ribbonrs.phase_plot.plot`.
        """
        from .phase_plot import plot

        return plot(self, path)

    def save(self, path: str | PathLike[str]) -> None:
        """Write all of it to a file (.npz) for `load_phase_diagram`; see `ribbonrs.phase_file.save`."""
        from .phase_file import save

        save(self, path)

    @classmethod
    def load(cls, path: str | PathLike[str]) -> PhaseDiagram:
        """Read a file that `save` wrote; see `load_phase_diagram`."""
        return load_phase_diagram(path)


def load_phase_diagram(path: str | PathLike[str]) -> PhaseDiagram:
    """Return the phase diagram in a file that `PhaseDiagram.save` wrote.

    Raises
    ------
    InputError
        If there is no such file, or it is another one or damaged.

    Examples
    --------
    >>> load_phase_diagram("phases.npz").plot("phases.png")  # doctest: +SKIP
    """
    from .phase_file import load

    return load(path)


def phase_diagram(
    scene: Scene,
    x: Parameters,
    y: Parameters,
    n: int | tuple[int, int] | None = None,
    *,
    tol: float | None = None,
    progress: bool | None = None,
) -> PhaseDiagram:
    """Find the stable states of `scene` over two of its parameters, and the lines where they change.

    Of a uniform ribbon that hangs free every natural shape is found anew at every point of a grid. On the
    lines of the grid between points that differ in the phase of the lowest stable state, or in how many
    stable states of each phase there are, the places of change are found to `tol`. A region that lies between
    points, or a boundary that crosses a line of the grid twice between them, is not seen.

    Of a ribbon that is held or loaded one state is followed: along `y` at the least `x`, from there along
    `x`. Its phase and stability make the diagram; other states there may be are not known.

    Parameters
    ----------
    scene : Scene
        What to solve.
    x, y : tuple of str and sequence of 2 float
        Name of a parameter, one of `parameters`, and its least and greatest value.
    n : int or tuple of 2 int, optional
        How many values of both parameters, or of `x` and `y`. None is 200, of ribbons that are held or loaded
        25.
    tol : float, optional
        How well places on boundaries are found, relative to the spans. None is 1e-10, of ribbons that are
        held or loaded 1e-6.
    progress : bool, optional
        Whether progress is shown on standard error; None shows it after a second if that is a terminal.

    Raises
    ------
    InputError
        An argument that is not what is said above, no scene at a corner, or growth, width or thickness that
        vary along a ribbon that hangs free: its phase would be that of each section.

    Warns
    -----
    RibbonWarning
        If a growth strain exceeds 0.1, or the work was interrupted (Ctrl-C): then the diagram is what was
        done until then, with ``done`` False for the rest.

    Examples
    --------
    >>> import ribbonrs as rb
    >>> leaf = rb.Ribbon(length=10.0, width=1.0, thickness=0.1)
    >>> scene = rb.Scene(leaf, rb.growth.edge(0.06) + rb.growth.chiral(0.04))
    >>> x, y = ("growth.chiral.amplitude", (0.01, 0.1)), ("growth.edge.amplitude", (0.0, 0.1))
    >>> diagram = rb.phase_diagram(scene, x, y, n=10)
    >>> [(line.phases, line.kind) for line in diagram.boundaries]
    [(('twisted', 'helical'), 'instability')]
    """
    if not isinstance(scene, Scene):
        raise InputError("scene", scene, "a Scene")
    plane = check_parameters(scene, x, y)
    corners = [plane.corner(a, b) for b in plane.spans[1] for a in plane.spans[0]]
    held = any(corner.loaded for corner in corners)
    if not held and any(corner.section_law.varies for corner in corners):
        raise InputError("scene", scene, "growth, width and thickness that are the same all along the ribbon")
    shape = _shape(n, HELD_N if held else NATURAL_N, HELD_CELLS if held else NATURAL_CELLS)
    tol = _tolerance(tol, HELD_TOLERANCE if held else NATURAL_TOLERANCE)
    _warn_growth(corners)
    with Telling("phase diagram", shape[0] * shape[1], progress) as telling:
        if held:
            from .phase_held import held_diagram

            diagram = held_diagram(scene, plane, shape, tol, telling)
        else:
            diagram = _natural(scene, plane, corners, shape, tol, telling)
    if diagram.interrupted:
        done = np.count_nonzero(diagram.done) / diagram.done.size
        warnings.warn(f"interrupted: {done:.0%} of the diagram is done", RibbonWarning, stacklevel=2)
    return diagram


def check_parameters(scene: Scene, x: object, y: object) -> Plane:
    """Return the scenes over two parameters; an `InputError` if the scene does not have them."""
    (first, span_x), (second, span_y) = _checked("sweep.x", x), _checked("sweep.y", y)
    of_x, of_y = _parameter(scene, "x", first), _parameter(scene, "y", second)
    if of_x.name == of_y.name:
        raise InputError("sweep.y.parameter", second, "another parameter than that of x")
    return Plane(of_x, of_y.name, (span_x, span_y))


class Plane:
    """The scenes over a rectangle of two parameters."""

    def __init__(self, first: Parameter, second: str, spans: Sequence[tuple[float, float]]) -> None:
        self.first, self.second, self.spans = first, second, spans

    def scene(self, x: float, y: float) -> Scene:
        """Return the scene at these values."""
        return parameter_of(self.first.scene(x), self.second).scene(y)

    def corner(self, x: float, y: float) -> Scene:
        """Return the scene at a corner of the rectangle, an `InputError` that says where if there is none."""
        try:
            return self.scene(x, y)
        except InputError as error:
            place = f"{self.first.name} = {x:g}, {self.second} = {y:g}"
            raise InputError("sweep", place, f"values that the scene can have, not: {error}") from None

    def axes(self, shape: tuple[int, int]) -> tuple[Axis, Axis]:
        """Return both parameters with so many values."""
        names = self.first.name, self.second
        x, y = (
            Axis(name, self.values(k, fractions(n)))
            for k, (name, n) in enumerate(zip(names, shape, strict=True))
        )
        return x, y

    def values(self, k: int, t: Array) -> Array:
        """Return the values of the parameter k at these parts of its span; the ends are exact."""
        low, high = self.spans[k]
        return np.where(t == 1.0, high, low + t * (high - low))

    def points(self, unit: Array) -> Array:
        """Return points (k, 2) of the unit square as values of the parameters."""
        return np.stack([self.values(0, unit[:, 0]), self.values(1, unit[:, 1])], axis=1)


def fractions(n: int) -> Array:
    """Return n numbers from 0 to 1."""
    return np.arange(n, dtype=np.float64) / (n - 1)


def _natural(
    scene: Scene,
    plane: Plane,
    corners: Sequence[Scene],
    shape: tuple[int, int],
    tol: float,
    telling: Telling,
) -> PhaseDiagram:
    """The diagram of natural shapes, found by the core."""
    laws = [corner.section_law.core() for corner in corners]
    xs, ys = (fractions(n).tolist() for n in shape)
    codes, stable, of_lowest, resolved, lines, interrupted = _core.phase_map(laws, xs, ys, tol, telling)
    named = np.array([*PHASES, NONE_STABLE, ""])
    found = [
        Boundary(
            plane.points(points),
            (_name(left), _name(right)),
            (() if left is None else tuple(left[1]), () if right is None else tuple(right[1])),
            jump,
        )
        for points, jump, left, right in lines
    ]
    x, y = plane.axes(shape)
    energy, K2, K3 = (np.ascontiguousarray(of_lowest[..., k]) + 0.0 for k in range(3))
    return PhaseDiagram(
        scene=scene,
        x=x,
        y=y,
        phase=named[codes],
        stable=stable.astype(np.int64),
        stable_count=stable.sum(axis=-1, dtype=np.int64),
        energy=energy,
        K2=K2,
        K3=K3,
        resolved=resolved,
        done=codes >= 0,
        boundaries=tuple(line for line in found if "" not in line.phases),
        rim=tuple(_outward(line) for line in found if "" in line.phases),
        tol=tol,
        interrupted=interrupted,
    )


def _name(side: _core._Side) -> str:
    """The phase on a side of a line."""
    return "" if side is None else (*PHASES, NONE_STABLE)[side[0]]


def _outward(line: Boundary) -> Boundary:
    """A line of the rim with what is known on its left."""
    if line.phases[0]:
        return line
    (left, right), stable = line.phases, line.stable
    return Boundary(line.points[::-1].copy(), (right, left), (stable[1], stable[0]), line.jump[::-1].copy())


def _checked(field: str, given: object) -> tuple[object, tuple[float, float]]:
    """Name and span of a parameter."""
    if not isinstance(given, tuple | list) or len(given) != 2:
        raise InputError(field, given, "a name and its span, such as ('growth.edge.amplitude', (0.0, 0.1))")
    name, span = given
    entries = numbers(f"{field}.span", span, SPAN)
    if len(entries) != 2 or not entries[0] < entries[1] or not math.isfinite(entries[1] - entries[0]):
        raise InputError(f"{field}.span", span, SPAN)
    return name, (entries[0], entries[1])


def _parameter(scene: Scene, side: str, name: object) -> Parameter:
    try:
        return parameter_of(scene, name)
    except InputError as error:
        raise InputError(f"sweep.{side}.parameter", error.value, error.expected) from None


def _shape(n: object, default: int, most: int) -> tuple[int, int]:
    """How many values of x and of y."""
    if n is None:
        return default, default
    pair = tuple(n) if isinstance(n, list | tuple) else (n, n)
    if len(pair) != 2:
        raise InputError("sweep.n", n, "a number of values, or two")
    nx, ny = (count("sweep.n", entry, 2, most // 2) for entry in pair)
    if nx * ny > most:
        raise InputError("sweep.n", n, f"at most {most} points in all")
    return nx, ny


def _tolerance(tol: object, default: float) -> float:
    expected = f"a number from {LEAST_TOLERANCE:g} to {GREATEST_TOLERANCE:g}"
    value = default if tol is None else number("sweep.tol", tol, expected)
    if not LEAST_TOLERANCE <= value <= GREATEST_TOLERANCE:
        raise InputError("sweep.tol", tol, expected)
    return value


def _warn_growth(corners: Sequence[Scene]) -> None:
    size = max(corner.growth_size for corner in corners)
    if size > GROWTH_WARNING:
        message = f"growth.size = {size:.3g} in the diagram: the theory is for growth small against 1"
        warnings.warn(message, RibbonWarning, stacklevel=3)
