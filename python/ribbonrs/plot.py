r"""The figure of a state: the ribbon in space, coloured by its deflection, and its cross-section."""

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
from .render import Picture, render
from .surface import section_points

if TYPE_CHECKING:
    from .state import State

__all__ = ["plot"]

# Light grey in the middle, made for shaded surfaces and for colour-blind eyes (Moreland 2009).
COLOURS = colormaps["coolwarm"]
# A deflection below this times the thickness is drawn as none.
SMALLEST = 1e-6
INK = "0.2"
# Inches: width of the figure, height of the strip below the ribbon for the fixed basis and the scale.
WIDE, KEY = 11.0, 0.9
DPI = 150.0


def plot(state: State, path: str | PathLike[str] | None = None) -> Figure:
    """Draw the ribbon of `state` in space and its cross-section beside it.

    The body is seen in parallel projection (equal scale in all directions), coloured by the deflection
    u1/h and shaded; of a ribbon of more than 20 turns, these are drawn. The profile shows u1/h across the
    width; the cross-section has the true proportions of width, thickness and deflection.

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
        A suffix that matplotlib does not know.
    """
    picture = render(state)
    x = np.linspace(-0.5, 0.5, 201, dtype=np.float64)
    deflection = state.section_law.deflection(state.strain, x) / state.scene.ribbon.thickness_ratio
    largest = float(np.max(np.abs(deflection)))
    limit = 1.06 * largest if largest > SMALLEST else 1.0
    colour = ScalarMappable(Normalize(-limit, limit), COLOURS)

    figure = Figure(dpi=DPI, facecolor="white")
    FigureCanvasAgg(figure)
    space, bar, profile, section = _layout(figure, picture.aspect)
    _draw_space(space, picture, np.interp(picture.x, x, deflection), colour, _note(state, picture))
    _draw_profile(profile, x, deflection, colour)
    figure.colorbar(colour, cax=bar, ticklocation="left").set_label("deflection $u_1/h$")
    _draw_section(section, state)
    figure.suptitle(_title(state), y=1.0 - 0.2 / figure.get_figheight(), color=INK, fontsize=12)
    if path is not None:
        _write(figure, path)
    return figure


def _layout(figure: Figure, aspect: float) -> tuple[Axes, Axes, Axes, Axes]:
    """Axes of the ribbon, the colour bar, the profile and the section, for a picture of this width/height.

    The colour bar is the vertical axis of the profile. A long picture has them below it, another beside it.
    Lengths in inches from the lower left corner.
    """
    if aspect > 2.4:
        high = 3.2 + KEY + min(max(10.6 / aspect, 0.8), 4.2)
        places = (
            (0.2, 2.7, 10.6, high - 3.2),
            (0.9, 0.6, 0.14, 1.8),
            (1.04, 0.6, 4.2, 1.8),
            (6.2, 0.5, 4.2, 1.9),
        )
    else:
        high = 5.8
        places = (0.2, 0.1, 6.6, 5.2), (7.7, 2.8, 0.14, 2.2), (7.84, 2.8, 2.9, 2.2), (7.84, 0.4, 2.9, 1.5)
    figure.set_size_inches(WIDE, high)
    space, bar, profile, section = (
        figure.add_axes((left / WIDE, low / high, w / WIDE, h / high)) for left, low, w, h in places
    )
    return space, bar, profile, section


def _draw_space(axes: Axes, picture: Picture, deflection: Array, colour: ScalarMappable, note: str) -> None:
    rgb = np.asarray(colour.to_rgba(deflection))[:, :3] * picture.shade[:, None]
    rgb = rgb + (1.0 - rgb) * picture.gloss[:, None]
    # edges in the colour of their cell close the seams between cells
    cells: Any = picture.cells  # an array is faster than the sequence that the signature asks for
    axes.add_collection(
        PolyCollection(cells, facecolors=rgb, edgecolors=rgb, linewidths=0.5, rasterized=True)
    )
    low, high = picture.extent
    box = np.array([axes.bbox.width, axes.bbox.height]) / DPI  # inches
    inch = 1.03 * float(max((high - low) / (box - [0.0, KEY])))  # in units of the ribbon's width
    left, bottom = (low + high) / 2 - box * inch / 2 - [0.0, KEY * inch / 2]
    axes.set(xlim=(left, left + box[0] * inch), ylim=(bottom, bottom + box[1] * inch), aspect="equal")
    axes.axis("off")
    _draw_key(axes, picture.axes, np.array([left, bottom]), inch, note)


def _draw_key(axes: Axes, directions: Array, corner: Array, inch: float, note: str) -> None:
    """The fixed basis, a scale bar and a note, below the ribbon."""
    origin = corner + np.array([0.5, 0.48]) * inch
    for i, direction in enumerate(directions):
        tip = origin + 0.36 * inch * direction
        arrow = {"arrowstyle": "-|>", "color": INK, "lw": 0.8, "shrinkA": 0}
        axes.annotate("", tuple(tip), tuple(origin), annotation_clip=False, arrowprops=arrow)
        name = origin + 0.36 * inch * direction + 0.11 * inch * direction / max(np.hypot(*direction), 0.1)
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


def _draw_profile(axes: Axes, x: Array, deflection: Array, colour: ScalarMappable) -> None:
    points = np.stack([x, deflection], axis=1)
    segments = np.stack([points[:-2], points[2:]], axis=1)  # overlapping, without seams
    axes.axhline(0.0, color="0.75", linewidth=0.8)
    axes.plot(x, deflection, color=INK, linewidth=4.0, solid_capstyle="round")
    line = LineCollection(
        list(segments), array=deflection[1:-1], cmap=COLOURS, norm=colour.norm, linewidths=2.6
    )
    axes.add_collection(line)
    axes.set(xlim=(-0.54, 0.54), ylim=colour.get_clim(), xlabel="$X_2/a$", yticks=[])


def _draw_section(axes: Axes, state: State) -> None:
    x = np.linspace(-0.5, 0.5, 201, dtype=np.float64)
    half = state.scene.ribbon.thickness_ratio / 2
    top, bottom = section_points(state, x, half), section_points(state, x, -half)
    outline = np.concatenate([top, bottom[::-1]])
    axes.fill(outline[:, 1], outline[:, 0], facecolor="0.82", edgecolor=INK, linewidth=1.0)
    low, high = outline[:, 1].min(), outline[:, 1].max()
    margin = 0.04 * (high - low)
    axes.set(xlim=(low - margin, high + margin), aspect="equal")
    axes.set_title("cross-section, true proportions", fontsize=9, color=INK)
    axes.axis("off")


def _title(state: State) -> str:
    eps, K1, K2, K3 = state.strain
    return (
        f"{state.phase}, {'stable' if state.stable else 'unstable'}:  "
        rf"$\varepsilon$ = {eps:.4g},  $K_1$ = {K1:.4g},  $K_2$ = {K2:.4g},  $K_3$ = {K3:.4g}"
    )


def _note(state: State, picture: Picture) -> str:
    if picture.drawn == 1.0:
        return ""
    return f"the first {picture.drawn * state.helix.turns:.0f} of {state.helix.turns:.0f} turns"


def _write(figure: Figure, path: str | PathLike[str]) -> None:
    known = figure.canvas.get_supported_filetypes()
    suffix = Path(path).suffix.lower().removeprefix(".")
    if suffix not in known:
        raise InputError("path", str(path), "a file name ending in one of ." + ", .".join(sorted(known)))
    with replacing(path) as temporary:
        figure.savefig(temporary, format=suffix)
