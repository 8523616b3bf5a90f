"""The figure of a phase diagram: regions within their refined boundaries, and their names."""

from __future__ import annotations

from collections.abc import Iterator
from os import PathLike
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import PathPatch
from matplotlib.path import Path
from numpy.typing import NDArray
from scipy.ndimage import distance_transform_edt, label  # type: ignore[import-untyped]

from .arrays import Array
from .phasediagram import NONE_STABLE, PHASES, Boundary, PhaseDiagram
from .plot import write
from .quantity import parameter_label

__all__ = ["plot", "region"]

# Tints of Okabe & Ito (2008), of different lightness too: told apart by colour-blind eyes and in grey.
COLOURS = {
    "flat": "#F4F1E8",
    "bent": "#9CCBE8",
    "twisted": "#F3C25C",
    "helical": "#4DB092",
    "curved": "#DDA6C4",
    NONE_STABLE: "#FFFFFF",
}
OTHER = "#C9C9C9"
HATCHES = {"unstable": "////", "stability not known": "....", NONE_STABLE: "xxxx"}
STYLES: dict[str, tuple[Any, float, str]] = {
    "instability": ("-", 1.3, "0.1"),
    "jump": ((0, (5, 2)), 1.3, "0.1"),
    "others": ("-", 0.7, "0.35"),
    "name": ((0, (1, 1.5)), 1.0, "0.35"),
    "change": ("-", 1.3, "0.1"),
}
LEGEND = {
    "instability": "instability",
    "jump": "jump to another shape",
    "others": "number of other stable shapes",
    "name": "name alone",
    "change": "change of the state",
}
INK = "0.15"
# Behind a name, which may be on a hatched region.
BOX = {"boxstyle": "round,pad=0.2", "facecolor": "white", "edgecolor": "none", "alpha": 0.5}
DPI = 200.0
# Inches: the diagram, the margins to its left and below it, and a row of the legend.
WIDE, HIGH, LEFT, LOW, ROW = 3.4, 2.8, 0.95, 0.66, 0.2
# Inches that a name needs on each side of its middle to be written into its region.
ROOM = 0.16
# Rows and columns of points that are looked at for the places of names.
POINTS = 200


def plot(diagram: PhaseDiagram, path: str | PathLike[str] | None = None) -> Figure:
    """Draw the regions of `diagram`, coloured by phase, and the lines between them.

    A region is named by the phase of its lowest stable state, and by those of the other stable states where
    they differ; a small one by its colour alone. How a boundary is drawn tells its `Boundary.kind`. What was
    not done stays white.

    Parameters
    ----------
    diagram : PhaseDiagram
        What to draw.
    path : path, optional
        Where to write the figure, in any format matplotlib knows by its suffix; replaced as a whole.

    Returns
    -------
    matplotlib.figure.Figure
        Free of pyplot: it needs no display and matplotlib does not keep it alive.

    Raises
    ------
    InputError
        A suffix that matplotlib does not know, or a directory that does not exist.
    """
    kinds = [kind for kind in LEGEND if any(line.kind == kind for line in _drawn(diagram))]
    rows = -(-len(kinds) // 2) if len(kinds) > 1 else 0
    size = np.array([LEFT + WIDE + 0.2, LOW + HIGH + 0.12 + ROW * rows])
    figure = Figure(figsize=(size[0], size[1]), dpi=DPI, facecolor="white")
    FigureCanvasAgg(figure)
    axes = figure.add_axes((LEFT / size[0], LOW / size[1], WIDE / size[0], HIGH / size[1]))
    for phase in dict.fromkeys(phase for line in diagram.rim + diagram.boundaries for phase in line.phases):
        if phase:
            _fill(axes, diagram, phase)
    for line in _drawn(diagram):
        style, width, colour = STYLES[line.kind]
        axes.plot(*line.points.T, linestyle=style, linewidth=width, color=colour, solid_joinstyle="round")
    for x, y, name in _names(diagram):
        axes.text(x, y, name, ha="center", va="center", fontsize=9, color=INK, bbox=BOX)
    axes.set_xlim(*diagram.x.span)
    axes.set_ylim(*diagram.y.span)
    axes.set_xlabel(parameter_label(diagram.x.name), fontsize=9, color=INK)
    axes.set_ylabel(parameter_label(diagram.y.name), fontsize=9, color=INK)
    axes.locator_params(nbins=5)
    axes.tick_params(labelsize=8, color=INK, labelcolor=INK)
    if rows:
        handles = [
            Line2D([], [], linestyle=STYLES[kind][0], linewidth=STYLES[kind][1], color=STYLES[kind][2])
            for kind in kinds
        ]
        figure.legend(
            handles,
            [LEGEND[kind] for kind in kinds],
            loc="upper left",
            bbox_to_anchor=(LEFT / size[0], 1.0),
            ncols=2,
            fontsize=7.5,
            frameon=False,
            borderaxespad=0.2,
            handlelength=2.4,
        )
    if path is not None:
        write(figure, path)
    return figure


def _drawn(diagram: PhaseDiagram) -> list[Boundary]:
    """Boundaries that are seen: not those along the rim, closer than a line is wide."""
    return [line for line in diagram.boundaries if np.any(_inside(diagram, line.points))]


def _inside(diagram: PhaseDiagram, points: Array) -> NDArray[np.bool_]:
    spans = (diagram.x.span, diagram.y.span)
    unit = np.stack([(points[:, k] - low) / (high - low) for k, (low, high) in enumerate(spans)])
    inside: NDArray[np.bool_] = np.all((unit > 1e-3) & (unit < 1.0 - 1e-3), axis=0)
    return inside


def _fill(axes: Axes, diagram: PhaseDiagram, phase: str) -> None:
    """One colour within the region of a phase."""
    path = region(diagram, phase)
    if path is None:
        return
    kind, _, how = phase.partition(", ")
    colour = COLOURS.get(kind, OTHER)
    hatch = HATCHES.get(how or kind)
    edge = "0.45" if hatch else colour
    axes.add_patch(PathPatch(path, facecolor=colour, edgecolor=edge, linewidth=0.3, hatch=hatch, zorder=0.5))


def region(diagram: PhaseDiagram, phase: str) -> Path | None:
    """Return what is within all lines that have the phase on one side; None where nothing is."""
    pieces = []
    for line in (*diagram.boundaries, *diagram.rim):
        if line.phases[0] != line.phases[1] and phase in line.phases:
            # With the region on the left the winding number is 1 inside and 0 outside.
            pieces.append(line.points if line.phases[0] == phase else line.points[::-1])
    loops = list(_loops(pieces))
    if not loops:
        return None
    return Path.make_compound_path(*(Path(loop, closed=True) for loop in loops))


def _loops(pieces: list[Array]) -> Iterator[Array]:
    """Closed lines from pieces that begin where others end."""
    beginning: dict[tuple[float, float], list[int]] = {}
    for k, piece in enumerate(pieces):
        beginning.setdefault(_key(piece[0]), []).append(k)
    left = dict.fromkeys(range(len(pieces)))
    while left:
        k = next(iter(left))
        start = _key(pieces[k][0])
        points: list[Array] = []
        while True:
            del left[k]
            points.append(pieces[k] if not points else pieces[k][1:])
            end = _key(pieces[k][-1])
            following = [other for other in beginning.get(end, []) if other in left]
            if end == start or not following:
                break
            k = following[0]
        loop = np.concatenate(points)
        yield loop if _key(loop[-1]) == start else np.concatenate([loop, loop[:1]])


def _key(point: Array) -> tuple[float, float]:
    return float(point[0]), float(point[1])


def _names(diagram: PhaseDiagram) -> Iterator[tuple[float, float, str]]:
    """Where names go: to the middle of every region that is large enough."""
    # Some points will do.
    rows, columns = (slice(None, None, -(-n // POINTS)) for n in diagram.phase.shape)
    phases, stable = diagram.phase[rows, columns], diagram.stable[rows, columns]
    x, y = diagram.x.values[columns], diagram.y.values[rows]
    size = HIGH / (y.size - 1), WIDE / (x.size - 1)
    counts = map(tuple, stable.reshape(-1, len(PHASES)).tolist())
    kinds = sorted(set(zip(phases.ravel().tolist(), counts, strict=True)) - {("", (0, 0, 0, 0))})
    for phase, count in kinds:
        nodes = (phases == phase) & np.all(stable == count, axis=-1)
        # Whole cells: what is a line has none.
        regions, number = label(nodes[:-1, :-1] & nodes[1:, :-1] & nodes[:-1, 1:] & nodes[1:, 1:])
        for k in range(1, number + 1):
            # The rim of the diagram is a border as well.
            distance = distance_transform_edt(np.pad(regions == k, 1), sampling=size)[1:-1, 1:-1]
            j, i = np.unravel_index(np.argmax(distance), distance.shape)
            if distance[j, i] - 0.5 * min(size) >= ROOM:
                # Of mirror images there are two; how many is said where that differs.
                differ = sum(other == phase for other, _ in kinds) > 1
                yield 0.5 * float(x[i] + x[i + 1]), 0.5 * float(y[j] + y[j + 1]), _name(phase, count, differ)


def _name(phase: str, count: tuple[int, ...], differ: bool) -> str:
    """The phase, and what else is stable."""
    also = [other for other, states in zip(PHASES, count, strict=True) if states and other != phase]
    name = phase.replace(", ", "\n") + "".join(f"\nor {other}" for other in also)
    if differ and not also:
        name += "\n1 shape" if sum(count) == 1 else f"\n{sum(count)} shapes"
    return name
