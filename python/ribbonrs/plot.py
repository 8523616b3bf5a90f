r"""The figure of a state: the ribbon in space, coloured by its deflection, and its cross-sections."""

from __future__ import annotations

from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from .arrays import Array
from .errors import InputError
from .files import replacing
from .marks import draw_marks, marks_of
from .render import Picture, render
from .state import shown_strains
from .surface import section

if TYPE_CHECKING:
    from .state import State

__all__ = ["plot", "write"]

# Light grey in the middle, made for shaded surfaces and for colour-blind eyes (Moreland 2009).
COLOURS = colormaps["coolwarm"]
# A deflection below this times the thickness is drawn as none.
SMALLEST = 1e-6
INK = "0.2"
DASHES = ("-", "--", ":")
# Of an axis in the picture: its name goes beside it, since another axis may point the same way.
FORESHORTENED = 0.6
# Inches: width of the figure, height of the strip below the ribbon for the fixed basis and the scale.
WIDE, KEY = 11.0, 0.9
DPI = 150.0


def plot(state: State, path: str | PathLike[str] | None = None) -> Figure:
    """Draw the ribbon of `state` in space and its cross-section beside it.

    The body is seen in parallel projection (equal scale in all directions), coloured by the deflection
    u1/h and shaded; of a ribbon of more than 20 turns, these are drawn. The profile shows u1/h across the
    width; the cross-section has the true proportions of width, thickness and deflection. Of a ribbon that
    varies there are profiles at both ends and halfway and, in place of the cross-section, the curvatures
    along S, with its events as vertical lines. Ends that are held have a mark, a square where they are
    clamped, a diamond where they slide, a triangle where they are pinned and a circle where they are hinged;
    arrows show the directions of forces at ends, at points and along lines, and of gravity.

    Parameters
    ----------
    state : State
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
    picture = render(state)
    marks = marks_of(state, picture)
    h = state.scene.ribbon.thickness_ratio
    x = np.linspace(-0.5, 0.5, 201, dtype=np.float64)
    places = np.array([0.0, 0.5, 1.0]) * state.scene.ribbon.length_ratio
    profiles = section(state, places, x)[0][..., 0] / h
    largest = float(max(np.max(np.abs(profiles)), np.max(np.abs(picture.u1)) / h))
    limit = 1.06 * largest if largest > SMALLEST else 1.0
    colour = ScalarMappable(Normalize(-limit, limit), COLOURS)

    figure = Figure(dpi=DPI, facecolor="white")
    FigureCanvasAgg(figure)
    space, bar, profile, beside = _layout(figure, picture.aspect, marks.margin)
    inch = _draw_space(space, picture, picture.u1 / h, colour, _note(state, picture), marks.margin)
    draw_marks(space, marks, inch)
    _draw_profiles(profile, x, profiles, colour)
    figure.colorbar(colour, cax=bar, ticklocation="left").set_label("deflection $u_1/h$")
    if state.uniform:
        _draw_section(beside, state)
    else:
        _name_profiles(profile, x, profiles, places)
        _draw_curvatures(beside, state)
    figure.suptitle(_title(state), y=1.0 - 0.2 / figure.get_figheight(), color=INK, fontsize=12)
    if path is not None:
        write(figure, path)
    return figure


def _layout(figure: Figure, aspect: float, margin: float) -> tuple[Axes, Axes, Axes, Axes]:
    """Axes of the ribbon, the colour bar, the profile and the section.

    The picture has this width/height and a margin around it. The colour bar is the vertical axis of the
    profile. A long picture has them below it, another beside it. Inches from the lower left corner.
    """
    if aspect > 2.4:
        high = 3.2 + KEY + min(max(10.6 / aspect, 0.8), 4.2) + 2.0 * margin
        places = (
            (0.2, 2.7, 10.6, high - 3.2),
            (0.9, 0.6, 0.14, 1.8),
            (1.04, 0.6, 4.2, 1.8),
            (6.2, 0.5, 4.2, 1.9),
        )
    else:
        high = 5.8
        places = (0.2, 0.1, 6.6, 5.2), (7.7, 2.8, 0.14, 2.2), (7.84, 2.8, 2.9, 2.2), (7.84, 0.5, 2.9, 1.5)
    figure.set_size_inches(WIDE, high)
    space, bar, profile, section = (
        figure.add_axes((left / WIDE, low / high, w / WIDE, h / high)) for left, low, w, h in places
    )
    return space, bar, profile, section


def _draw_space(
    axes: Axes, picture: Picture, deflection: Array, colour: ScalarMappable, note: str, margin: float
) -> float:
    """The body, with a margin in inches around it; returns the length of an inch in widths."""
    rgb = np.asarray(colour.to_rgba(deflection))[:, :3] * picture.shade[:, None]
    rgb = rgb + (1.0 - rgb) * picture.gloss[:, None]
    # edges in the colour of their cell close the seams between cells
    cells: Any = picture.cells  # an array is faster than the sequence that the signature asks for
    axes.add_collection(
        PolyCollection(cells, facecolors=rgb, edgecolors=rgb, linewidths=0.5, rasterized=True)
    )
    low, high = picture.extent
    box = np.array([axes.bbox.width, axes.bbox.height]) / DPI  # inches
    room = box - [0.0, KEY] - 2.0 * margin
    inch = 1.03 * float(max((high - low) / room))  # in units of the ribbon's width
    left, bottom = (low + high) / 2 - box * inch / 2 - [0.0, KEY * inch / 2]
    axes.set(xlim=(left, left + box[0] * inch), ylim=(bottom, bottom + box[1] * inch), aspect="equal")
    axes.axis("off")
    _draw_key(axes, picture.axes, np.array([left, bottom]), inch, note)
    return inch


def _draw_key(axes: Axes, directions: Array, corner: Array, inch: float, note: str) -> None:
    """The fixed basis, a scale bar and a note, below the ribbon."""
    origin = corner + np.array([0.5, 0.48]) * inch
    for i, direction in enumerate(directions):
        tip = origin + 0.36 * inch * direction
        arrow = {"arrowstyle": "-|>", "color": INK, "lw": 0.8, "shrinkA": 0}
        axes.annotate("", tuple(tip), tuple(origin), annotation_clip=False, arrowprops=arrow)
        size = np.hypot(*direction)
        name = origin + 0.36 * inch * direction + 0.11 * inch * direction / max(size, 0.1)
        if size < FORESHORTENED:
            name[0] -= 0.15 * inch
        axes.text(name[0], name[1], f"$E_{i + 1}$", color=INK, fontsize=8, ha="center", va="center")
    length = _round_number(inch)
    start = corner + np.array([1.4, 0.4]) * inch
    axes.plot([start[0], start[0] + length], [start[1]] * 2, color=INK, linewidth=2.0, solid_capstyle="butt")
    axes.text(
        start[0] + length / 2, start[1] + 0.06 * inch, f"{length:g} $a$", color=INK, fontsize=9, ha="center"
    )
    axes.text(start[0] + length + 0.4 * inch, start[1], note, color=INK, fontsize=9, va="center")


def _round_number(value: float) -> float:
    """The largest of 1, 2, 5 times a power of ten that is at most `value`."""
    power = 10.0 ** np.floor(np.log10(value))
    return float(power * max(digit for digit in (1.0, 2.0, 5.0) if digit * power <= value))


def _draw_profiles(axes: Axes, x: Array, deflections: Array, colour: ScalarMappable) -> None:
    axes.axhline(0.0, color="0.75", linewidth=0.8)
    for deflection in deflections:
        points = np.stack([x, deflection], axis=1)
        segments = np.stack([points[:-2], points[2:]], axis=1)  # overlapping, without seams
        axes.plot(x, deflection, color=INK, linewidth=4.0, solid_capstyle="round")
        line = LineCollection(
            list(segments), array=deflection[1:-1], cmap=COLOURS, norm=colour.norm, linewidths=2.6
        )
        axes.add_collection(line)
    axes.set(xlim=(-0.54, 0.54), ylim=colour.get_clim(), xlabel="$X_2/a$", yticks=[])


def _name_profiles(axes: Axes, x: Array, deflections: Array, places: Array) -> None:
    """Say at which S each profile is, beside its right end; equal ones share a name."""
    wide = axes.bbox.width / DPI  # an inch of it for the names
    axes.set(
        xlim=(-0.54, (0.56 * wide + 0.54) / (wide - 1.0)),
        xlabel="$X_2$ over the width at $S$",
        xticks=[-0.5, 0.0, 0.5],
    )
    low, high = axes.get_ylim()
    named: dict[int, list[str]] = {}
    for deflection, S in zip(deflections, places, strict=True):
        named.setdefault(round(20 * (deflection[-1] - low) / (high - low)), []).append(f"{S:.4g}")
    for row, names in named.items():
        height = low + row / 20 * (high - low)
        name = "$S$ = " + ", ".join(names)
        box = {"facecolor": "white", "edgecolor": "none", "pad": 1.0}
        axes.text(0.56, height, name, color=INK, fontsize=8, va="center", bbox=box)


def _draw_section(axes: Axes, state: State) -> None:
    x = np.linspace(-0.5, 0.5, 201, dtype=np.float64)
    (middle,), (fibre,) = section(state, np.zeros(1), x)
    outline = np.concatenate([middle + fibre, (middle - fibre)[::-1]])
    axes.fill(outline[:, 1], outline[:, 0], facecolor="0.82", edgecolor=INK, linewidth=1.0)
    low, high = outline[:, 1].min(), outline[:, 1].max()
    margin = 0.04 * (high - low)
    axes.set(xlim=(low - margin, high + margin), aspect="equal")
    axes.set_title("cross-section, true proportions", fontsize=9, color=INK)
    axes.axis("off")


def _draw_curvatures(axes: Axes, state: State) -> None:
    """K1, K2 and K3 along S, without those that are zero."""
    S = np.linspace(0.0, state.scene.ribbon.length_ratio, 1001)
    strains = state.course.strains(S)
    for i, style in zip((2, 3, 1), DASHES, strict=True):
        if np.max(np.abs(strains[:, i])) > SMALLEST * state.scene.ribbon.thickness_ratio:
            axes.plot(S, strains[:, i], style, color=INK, linewidth=1.4, label=f"$K_{i}$")
    axes.axhline(0.0, color="0.75", linewidth=0.8, zorder=0)
    for event in state.report.events:
        axes.axvline(event.S, color="0.75", linewidth=0.8, zorder=0)
    axes.set(xlim=(0.0, S[-1]), xlabel="$S = X_3/a$")
    axes.spines[["top", "right"]].set_visible(False)
    if axes.get_legend_handles_labels()[0]:
        axes.legend(frameon=False, fontsize=9, ncols=3, loc="lower right", bbox_to_anchor=(1.0, 0.98))


def _title(state: State) -> str:
    strains = shown_strains(state)
    names = (r"\varepsilon", "K_1", "K_2", "K_3")
    values = ",  ".join(f"${name}$ {_range(column)}" for name, column in zip(names, strains.T, strict=True))
    phase = f"{state.phase} ({', '.join(state.phases)})" if state.phases[1:] else state.phase
    if state.stable is None:
        return f"{phase}:  {values}"
    return f"{phase}, {'stable' if state.stable else 'unstable'}:  {values}"


def _range(values: Array) -> str:
    """As `= 0.02` or, if three figures tell the least from the greatest, `from 0.01 to 0.02`."""
    least, greatest = np.min(values), np.max(values)
    ends = f"{least:.3g}", f"{greatest:.3g}"
    return f"= {least:.4g}" if ends[0] == ends[1] else f"from {ends[0]} to {ends[1]}"


def _note(state: State, picture: Picture) -> str:
    if picture.drawn == 1.0:
        return ""
    drawn, turns = state.course.turns(np.array([picture.drawn, 1.0]) * state.scene.ribbon.length_ratio)
    return f"the first {drawn:.0f} of {turns:.0f} turns"


def write(figure: Figure, path: str | PathLike[str]) -> None:
    """Write a figure in the format that the suffix names; an existing file is replaced as a whole."""
    known = figure.canvas.get_supported_filetypes()
    suffix = Path(path).suffix.lower().removeprefix(".")
    if suffix not in known:
        raise InputError("path", str(path), "a file name ending in one of ." + ", .".join(sorted(known)))
    if not Path(path).parent.is_dir():
        raise InputError("path", str(path), "a file in a directory that exists")
    with replacing(path) as temporary:
        figure.savefig(temporary, format=suffix)
