"""The figure of a bifurcation diagram: branches, what is stable on them, special points and some shapes."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from os import PathLike
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from .arrays import Array
from .branch import Branch, SpecialPoint
from .diagram import Diagram
from .diagram_shapes import Shape, draw_shapes
from .parameter import parameter_of
from .plot import write
from .quantity import check_quantity, label, parameter_label
from .smooth import Curve, smooth
from .stability import neutral, stability
from .symmetry import image, symmetries

__all__ = ["STYLES", "WIDTHS", "Line", "branch_lines", "plot", "runs"]

# Okabe & Ito (2008): told apart by colour-blind eyes.
COLOURS = ("#000000", "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00")
STYLES: dict[str, Any] = {"stable": "-", "unstable": (0, (4, 2)), "stability not known": (0, (1, 1.5))}
WIDTHS = {"stable": 1.8, "unstable": 1.2, "stability not known": 1.2}
MIRROR = "mirror image"
FAINT = 0.35
MARKS: dict[str, dict[str, Any]] = {
    "fold": {"marker": "s", "markersize": 5},
    "branch point": {"marker": "o", "markersize": 5},
    "section instability": {"marker": "D", "markersize": 5},
    "zero": {"marker": "o", "markersize": 5.5, "markerfacecolor": "white"},
    "value": {"marker": "o", "markersize": 4, "markerfacecolor": "white"},
    "failed": {"marker": "x", "markersize": 6, "markeredgewidth": 1.5},
}
# Curvatures up to this times the thickness ratio, and places up to this times the length, are drawn as 0.
SMALLEST = 1e-6
INK = "0.2"
DPI = 200.0
# Inches, for a column of a journal: the diagram, the margins to its left and below it, and the shapes.
WIDE, HIGH, LEFT, LOW, SHAPES, ROW = 3.0, 2.4, 0.76, 0.66, 1.5, 0.18
MOST_SHAPES = 3


@dataclass(frozen=True)
class Line:
    """A branch, or an image of one, as it is drawn."""

    branch: Branch
    curve: Curve
    colour: str
    alpha: float
    neutral: frozenset[int]


def plot(diagram: Diagram, quantity: str = "K3", path: str | PathLike[str] | None = None) -> Figure:
    """Draw a quantity of the branches of `diagram` over its parameter.

    Stable equilibria are drawn solid, unstable ones dashed, those of which it is not known dotted; a square
    is a fold, a full circle a branch point, a diamond a section instability, an open circle a zero of a
    function or a value asked for, a cross where a branch failed. Branches run smoothly through their points.
    Mirror images that were not traced are faint. Beside it are shapes of stable states near the right ends of
    up to three branches, all on the same scale; letters say which.

    Parameters
    ----------
    diagram : Diagram
        What to draw.
    quantity : str
        Of those that `Branch.values` knows.
    path : path, optional
        Where to write the figure, in any format matplotlib knows by its suffix; replaced as a whole.

    Returns
    -------
    matplotlib.figure.Figure
        Free of pyplot: it needs no display and matplotlib does not keep it alive.

    Raises
    ------
    InputError
        An unknown quantity, a suffix that matplotlib does not know, or a directory that does not exist.
    """
    quantity = check_quantity("quantity", quantity)
    lines = list(branch_lines(diagram, quantity))
    shown = list(_shown(diagram))
    figure = Figure(dpi=DPI, facecolor="white")
    FigureCanvasAgg(figure)
    handles = [*_styles_of(lines), *_marks_of(diagram)]
    columns = 3 if shown else 2
    above = 0.28 + ROW * -(-len(handles) // columns)
    size = np.array([LEFT + WIDE + 0.1 + (SHAPES if shown else 0.0), LOW + HIGH + above])
    figure.set_size_inches(*size)
    axes = figure.add_axes((LEFT / size[0], LOW / size[1], WIDE / size[0], HIGH / size[1]))
    axes.axhline(0.0, color="0.85", linewidth=0.7, zorder=0)
    for line in lines:
        _draw(axes, line)
    for point in diagram.special_points:
        _mark(axes, point, [line for line in lines if line.branch.number == point.branch])
    _set_limits(axes, diagram, lines)
    axes.set_xlabel(parameter_label(diagram.parameter), fontsize=10, color=INK)
    varies = any(branch.held for branch in diagram.branches)
    axes.set_ylabel(label(quantity, varies), fontsize=10, color=INK)
    axes.tick_params(labelsize=9, color=INK, labelcolor=INK)
    axes.locator_params(nbins=6)
    axes.ticklabel_format(scilimits=(-3, 4), useMathText=True)
    for axis in (axes.xaxis, axes.yaxis):
        axis.get_offset_text().set(fontsize=9, color=INK)
    axes.spines[["top", "right"]].set_visible(False)
    axes.legend(
        handles=handles,
        loc="lower left",
        bbox_to_anchor=(0.0, 1.0 + 0.16 / HIGH),
        ncols=columns,
        fontsize=8.5,
        frameon=False,
        borderaxespad=0.2,
        columnspacing=1.0,
        handletextpad=0.5,
        labelspacing=0.25,
    )
    letters = _letters(axes, shown, lines)
    draw_shapes(figure, (LEFT + WIDE + 0.15, LOW + HIGH), (SHAPES - 0.1, HIGH / MOST_SHAPES), letters)
    if path is not None:
        write(figure, path)
    return figure


def branch_lines(diagram: Diagram, quantity: str) -> Iterator[Line]:
    """Yield every branch and its images that differ in the quantity, mirror images first: they lie below."""
    parameter = parameter_of(diagram.scene, diagram.parameter)
    kept = [{tuple(s.tolist()) for s in symmetries(parameter.scene(value))} for value in diagram.span]
    factors = {image(np.array(signs), quantity) for signs in sorted(kept[0] & kept[1])}
    own = []
    for branch in diagram.branches:
        finite = _seen(branch, quantity)
        curve = smooth(branch.parameter, finite, straight=quantity == "index")
        points = neutral(diagram, branch)
        colour = COLOURS[branch.number % len(COLOURS)]
        if branch.mirrored and -1.0 in factors and np.any(finite != 0.0):
            yield Line(branch, curve.mirrored(), colour, FAINT, points)
        own.append(Line(branch, curve, colour, 1.0, points))
    yield from own


def _seen(branch: Branch, quantity: str) -> Array:
    """A quantity without what is infinite, or only rounding."""
    values, ribbon = branch.values(quantity), branch.maker.parameter.base.ribbon
    noise = SMALLEST * (ribbon.thickness_ratio if quantity.startswith("K") else ribbon.length_ratio)
    if quantity.startswith(("K", "position")):
        values = np.where(np.abs(values) <= noise, 0.0, values)
    return np.where(np.isfinite(values), values, np.nan)


def _own(lines: list[Line], branch: Branch) -> Line:
    """The line of a branch itself."""
    return next(line for line in lines if line.branch is branch and line.alpha == 1.0)


def runs(line: Line) -> Iterator[tuple[str, Array]]:
    """Yield the parts of a line of one stability each, as points (m, 2)."""
    told = stability(line.branch, line.neutral)
    first = 0
    for i in range(1, len(told) + 1):
        if i == len(told) or told[i] != told[first]:
            yield told[first], line.curve.part(first, i)
            first = i


def _draw(axes: Axes, line: Line) -> None:
    for told, points in runs(line):
        axes.plot(
            *points.T,
            linestyle=STYLES[told],
            linewidth=WIDTHS[told],
            color=line.colour,
            alpha=line.alpha,
            zorder=2.0 if told == "stable" else 1.5,
            dash_capstyle="butt",
        )


def _kind(point: SpecialPoint) -> str | None:
    """What a point is marked as; ends are marked where they failed."""
    if point.kind == "end":
        return "failed" if point.name == "failed" else None
    return point.kind.replace("_", " ")


def _mark(axes: Axes, point: SpecialPoint, lines: list[Line]) -> None:
    kind = _kind(point)
    if kind is None:
        return
    for line in lines:
        height = line.curve.at(point.place, point.parameter)
        axes.plot(
            [point.parameter],
            [height],
            linestyle="none",
            color=line.colour,
            alpha=line.alpha,
            zorder=3.0,
            clip_on=False,
            **MARKS[kind],
        )


def _styles_of(lines: list[Line]) -> Iterator[Line2D]:
    """What the legend says of lines."""
    present = {told for line in lines for told, _ in runs(line)}
    for told, style in STYLES.items():
        if told in present:
            yield Line2D([], [], color=INK, linestyle=style, linewidth=WIDTHS[told], label=told)
    if any(line.alpha < 1.0 for line in lines):
        yield Line2D([], [], color=INK, alpha=FAINT, linewidth=1.8, label=MIRROR)


def _marks_of(diagram: Diagram) -> Iterator[Line2D]:
    """What the legend says of marks; functions by their names."""
    named = {
        kind: sorted({point.name for point in diagram.special_points if _kind(point) == kind})
        for kind in MARKS
    }
    for kind, style in MARKS.items():
        if named[kind]:
            told = f"zero of {', '.join(named[kind])}" if kind == "zero" else kind
            yield Line2D([], [], color=INK, linestyle="none", label=told, **style)


def _set_limits(axes: Axes, diagram: Diagram, lines: list[Line]) -> None:
    low, high = diagram.span
    axes.set_xlim(low, high + 0.02 * (high - low))
    heights = np.concatenate([line.curve.points[:, 1] for line in lines] or [np.zeros(1)])
    known = heights[np.isfinite(heights)]
    least, greatest = float(np.min(known, initial=np.inf)), float(np.max(known, initial=-np.inf))
    if not known.size:
        least = greatest = 0.0
    margin = 0.06 * (greatest - least) or 1.0
    axes.set_ylim(least - margin, greatest + margin)


def _shown(diagram: Diagram) -> Iterator[tuple[Branch, int]]:
    """Stable points of up to three branches, the ones farthest to the right."""
    found = []
    for branch in diagram.branches:
        places = neutral(diagram, branch)
        stable = [i for i in np.flatnonzero(branch.stable).tolist() if i not in places]
        if stable:
            found.append((branch, max(stable, key=lambda i: branch.parameter[i])))
    found.sort(key=lambda place: -float(place[0].parameter[place[1]]))
    yield from found[:MOST_SHAPES]


def _letters(axes: Axes, shown: list[tuple[Branch, int]], lines: list[Line]) -> list[Shape]:
    """Mark points by letters, from top to bottom, and return the states there."""
    nodes = [(branch, i, _own(lines, branch)) for branch, i in shown]
    nodes.sort(key=lambda node: -node[2].curve.nodes[node[1], 1])
    shapes = []
    for letter, (branch, i, line) in zip("abc", nodes, strict=False):
        place = line.curve.nodes[i]
        style: dict[str, Any] = {"color": line.colour, "fontsize": 9, "ha": "right"}
        axes.plot(*place, marker=".", color=line.colour, markersize=6, zorder=4.0, clip_on=False)
        axes.annotate(letter, place, (-3.0, 4.0), textcoords="offset points", **style)
        shapes.append(Shape(letter, branch.state(i), line.colour))
    return shapes
