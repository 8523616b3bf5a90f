"""Special points as a second parameter varies: the curve along which a fold or a branch point lies."""

from __future__ import annotations

from dataclasses import dataclass
from os import PathLike
from typing import TYPE_CHECKING

from . import _core
from .arrays import Array, count
from .boundary import tolerance
from .branch import SpecialPoint
from .check import Numbers
from .continuation import check_span
from .diagram import Diagram
from .errors import InputError
from .parameter import Parameter, parameter_of
from .problem import problem_of
from .scene import Scene
from .traced import Live

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["Locus", "trace_locus"]

KINDS = ("fold", "branch_point", "section_instability")
"""Special points that are followed."""


@dataclass(frozen=True, eq=False)
class Locus:
    """A curve of special points in the plane of two parameters.

    Attributes
    ----------
    scene : Scene
        What was traced, with its own values of the parameters.
    parameters : tuple of str
        Names of the two.
    kind : str
        Of the special points.
    values : (k, 2) array
        Values of both parameters along the curve; the second ascends where the curve does not turn back.
    ended : tuple of str
        How it ended at its beginning and its end: "span", "steps" or "failed", as at a cusp.
    """

    scene: Scene
    parameters: tuple[str, str]
    kind: str
    values: Array
    ended: tuple[str, str]

    def plot(self, path: str | PathLike[str] | None = None) -> Figure:
        """Draw the curve; write the figure to `path` if given."""
        from .locus_plot import plot

        return plot(self, path)


def trace_locus(
    diagram: Diagram,
    point: SpecialPoint,
    parameter: str,
    span: Numbers,
    *,
    max_steps: int = 500,
    tol: float = 1e-10,
) -> Locus:
    """Follow a special point of a diagram as another parameter varies.

    Parameters
    ----------
    diagram : Diagram
        As `trace` returned it; one from a file does not have what it takes.
    point : SpecialPoint
        One of its folds, branch points or section instabilities.
    parameter : str
        The other of the scene's `parameters`, whose value in the scene is in the span.
    span : sequence of 2 float
        Its least and its greatest value.
    max_steps : int
        Most points each way.
    tol : float
        As of `trace`.

    Raises
    ------
    InputError
        An argument that is not that.

    Examples
    --------
    A column buckles under a load in proportion to 1/L^2:

    >>> import ribbonrs as rb
    >>> rod = rb.LinearLaw(EI1=100.0, EI2=1.0, GJ=1.0, inextensible=True)
    >>> column = rb.Scene(rb.Ribbon(1.0, 1.0, 0.1), end=rb.Free(force=(0.0, 0.0, -1.0)), law=rod)
    >>> diagram = rb.trace(column, "end.force[2]", (-3.0, -1.0), start=rb.solve(column), depth=0)
    >>> locus = rb.trace_locus(diagram, diagram.special_points[0], "ribbon.length", (0.8, 1.2))
    >>> loads, lengths = locus.values.T
    >>> sorted({round(float(constant), 8) for constant in loads * lengths**2})
    [-2.4674011]
    """
    if not isinstance(diagram, Diagram):
        raise InputError("diagram", diagram, "a Diagram")
    if not isinstance(point, SpecialPoint) or point not in diagram.special_points:
        raise InputError("point", point, "a special point of the diagram")
    if point.kind not in KINDS:
        raise InputError("point.kind", point.kind, f"one of {', '.join(KINDS)}")
    other = parameter_of(diagram.scene, parameter)
    if other.name == diagram.parameter:
        raise InputError("parameter", parameter, "another than that of the diagram")
    low, high = check_span(span)
    if not low <= other.value <= high:
        expected = f"a span with the scene's own value in it, {other.value:g}"
        raise InputError("span", span, expected)
    max_steps, tol = count("trace_locus.max_steps", max_steps, 1), tolerance("tol", tol)
    source = diagram.branches[point.branch].source
    if not isinstance(source, Live):
        raise InputError("diagram", diagram, "one that was traced, not one from a file")
    try:
        corners = _corners(diagram, other, (low, high), source.solution(point.place) is None)
        values, ended = source.branch.locus(
            point.place, point.kind.replace("_", " "), corners, (low, high), other.value, max_steps, tol
        )
    except ValueError as error:
        raise InputError("span", span, f"values that the scene can have, not: {error}") from None
    values.setflags(write=False)
    return Locus(diagram.scene, (diagram.parameter, other.name), point.kind, values, ended)


def _corners(
    diagram: Diagram, other: Parameter, span: tuple[float, float], natural: bool
) -> list[_core.SectionLaw] | list[_core.BoundaryProblem]:
    """What the core interpolates between: the ends of the diagram's span, at each end of the other."""
    scenes = [
        parameter_of(other.scene(value), diagram.parameter).scene(end)
        for value in span
        for end in diagram.span
    ]
    if natural:
        return [scene.section_law.core() for scene in scenes]
    return [problem_of(scene) for scene in scenes]
