"""A bifurcation diagram: the branches that a trace found, and their special points."""

from __future__ import annotations

from dataclasses import dataclass
from os import PathLike
from typing import TYPE_CHECKING, Any

from .branch import Branch, SpecialPoint
from .check import number
from .scene import Scene
from .state import State

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["Diagram", "Work", "load_diagram"]


@dataclass(frozen=True)
class Work:
    """What a trace of a boundary-value problem took.

    Attributes
    ----------
    points : int
        Of all branches, those that were special or that a finer mesh replaced not counted.
    linearisations : int
        How often the equations were assembled and factorised.
    assembly, factorisation, index : float
        Seconds for residuals and Jacobians, for eliminating strains and nodes, and for stability indices.
    rest : float
        Seconds for all else: solutions with the factors, predictions, meshes, comparisons of branches.
    """

    points: int
    linearisations: int
    assembly: float
    factorisation: float
    index: float
    rest: float

    @property
    def seconds(self) -> float:
        """All together."""
        return self.assembly + self.factorisation + self.index + self.rest

    def __str__(self) -> str:
        named = ("assembly", "factorisation", "index", "rest")
        parts = ", ".join(f"{name} {getattr(self, name) / self.seconds:.0%}" for name in named)
        each = 1e3 * self.seconds / self.points
        return f"{self.points} points in {1e3 * self.seconds:.3g} ms, {each:.2g} ms each: {parts}"


@dataclass(frozen=True, eq=False, repr=False)
class Diagram:
    """Branches of equilibria of a scene as one of its parameters varies.

    Attributes
    ----------
    scene : Scene
        What was traced, with its own value of the parameter.
    parameter : str
        Name of the parameter; see `parameters`.
    span : tuple of float
        From where to where.
    branches : tuple of Branch
        The first ones are those that the trace started from.
    special_points : tuple of SpecialPoint
        Of all branches: folds, branch points, section instabilities and values that were asked for, then
        zeros of functions, then both ends of every branch.
    work : Work or None
        What it took; None of natural shapes, and of a diagram from a file.
    """

    scene: Scene
    parameter: str
    span: tuple[float, float]
    branches: tuple[Branch, ...]
    special_points: tuple[SpecialPoint, ...]
    work: Work | None = None

    def __repr__(self) -> str:
        points = sum(branch.parameter.size for branch in self.branches)
        special = sum(point.kind != "end" for point in self.special_points)
        return (
            f"Diagram({self.parameter} in [{self.span[0]:.6g}, {self.span[1]:.6g}], "
            f"{len(self.branches)} branches, {points} points, {special} special)"
        )

    def states_at(self, value: float) -> list[State]:
        """Return every state on the branches at this value of the parameter; mirror images are left out.

        Of a diagram from a file it is that of a point of every branch that passes there.

        Raises
        ------
        InputError
            If `value` is no finite number, or there is no such point.
        """
        value = number("value", value)
        return [state for branch in self.branches for state in branch.states_at(value)]

    def table(self) -> dict[str, list[Any]]:
        """Return the columns of a table of all points, branch after branch.

        branch, point, parameter, eps, K1, K2, K3, energy, load_potential, index, section_index, stable (empty
        if it is not known), position_0 to position_2, special (kinds of special points; zeros of functions,
        which lie between points, are not among them).
        """
        columns: dict[str, list[Any]] = {}
        for branch in self.branches:
            size = branch.parameter.size
            parts: dict[str, list[Any]] = {
                "branch": [branch.number] * size,
                "point": list(range(size)),
                "parameter": branch.parameter.tolist(),
                **{name: branch.values(name).tolist() for name in ("eps", "K1", "K2", "K3")},
                **{name: branch.values(name).tolist() for name in ("energy", "load_potential", "index")},
                "section_index": branch.section_index.tolist(),
                "stable": [
                    s if k else None
                    for s, k in zip(branch.stable.tolist(), branch.known.tolist(), strict=True)
                ],
                **{f"position_{k}": branch.position[:, k].tolist() for k in range(3)},
                "special": self._special(branch),
            }
            for name, part in parts.items():
                columns.setdefault(name, []).extend(part)
        return columns

    def _special(self, branch: Branch) -> list[str]:
        """The kinds of special points at each point of a branch."""
        kinds: list[list[str]] = [[] for _ in range(branch.parameter.size)]
        for point in self.special_points:
            if point.branch == branch.number and point.kind not in ("zero", "end"):
                kinds[point.place].append(point.kind)
        return ["; ".join(names) for names in kinds]

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

    def plot(self, quantity: str = "K3", path: str | PathLike[str] | None = None) -> Figure:
        """Draw a quantity of the branches over the parameter; write the figure to `path` if given.

        See `ribbonrs.diagram_plot.plot`.
        """
        from .diagram_plot import plot

        return plot(self, quantity, path)

    def save(self, path: str | PathLike[str]) -> None:
        """Write all of it to a file (.npz) that `load_diagram` reads; see `ribbonrs.diagram_file.save`."""
        from .diagram_file import save

        save(self, path)

    @classmethod
    def load(cls, path: str | PathLike[str]) -> Diagram:
        """Read a file that `save` wrote; see `load_diagram`."""
        return load_diagram(path)


def load_diagram(path: str | PathLike[str]) -> Diagram:
    """Return the diagram in a file that `Diagram.save` wrote.

    It has everything at the points of its branches, their states included, but nothing between them: zeros
    and values that were not asked for when it was traced are not found in it.

    Raises
    ------
    InputError
        If there is no such file, or it is another one or damaged.

    Examples
    --------
    >>> load_diagram("bifurcations.npz").plot("K2", "bifurcations.png")  # doctest: +SKIP
    """
    from .diagram_file import load

    return load(path)
