"""Fig. 5: how the ribbon of Fig. 3 bends as it grows."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable

from ..arrays import Array
from ..check import Numbers, positive
from ..state import State
from .drawing import Drawing
from .given import growths, ratios
from .saddles import READINGS, shape
from .shapes import deflection_scale, draw_grid, view
from .style import COLOURS, INK, WIDTH, new_figure, styled

__all__ = ["fig5"]

DASHES = ("--", "-", ":")


@styled
def fig5(eta: Numbers = (0.05, 0.1), xi: Numbers = (0.0, 0.1, 0.2, 0.3), length: float = 5.0) -> Drawing:
    """Draw the shapes of a growth gradient through the thickness, as published, as it is, and isochoric.

    Parameters
    ----------
    eta : list of float
        Thickness over width, a panel each.
    xi : list of float
        Growth gradients, a column each.
    length : float
        Of the ribbon, in widths.

    Raises
    ------
    InputError
        A parameter out of range, or an empty list.

    Notes
    -----
    Source: Liu, Li & Liu, Fig. 5 and eqs. (44), (48)-(50).
    """
    eta, xi, length = ratios("eta", eta), growths("xi", xi), positive("length", length)
    states = {h: [[shape(reading, h, g, length) for g in xi] for reading in READINGS] for h in eta}
    colour = deflection_scale([state for rows in states.values() for row in rows for state in row])
    figure = new_figure(WIDTH, 2.4 * len(eta))
    panels = figure.subplots(len(eta), 2, squeeze=False, width_ratios=[2.7, 1.0])
    x = np.linspace(-0.5, 0.5, 101)
    tables: dict[str, dict[str, list[float]]] = {}
    for i, (h, (space, across)) in enumerate(zip(eta, panels, strict=True)):
        _draw_space(space, states[h], xi, colour)
        space.set_title(rf"({chr(97 + i)})  $\eta$ = {h:g}", pad=11)
        profiles = {
            reading: [state.deflection(x)[0] for state in row]
            for reading, row in zip(READINGS, states[h], strict=True)
        }
        _draw_profiles(across, x, profiles, xi)
        tables[f"curvature_eta{h:g}"] = {"xi": list(xi)} | {
            f"K2 {reading}": [float(state.strain[2]) for state in row]
            for reading, row in zip(READINGS, states[h], strict=True)
        }
        tables[f"deflection_eta{h:g}"] = {"x": x.tolist()} | {
            f"u1/a {reading} xi={g:g}": profile.tolist()
            for reading, row in profiles.items()
            for g, profile in zip(xi, row, strict=True)
        }
    _draw_legend(panels[0, 1], xi)
    bar = figure.colorbar(colour, ax=panels[:, 0], location="bottom", shrink=0.5, aspect=35, pad=0.02)
    bar.set_label("deflection $u_1/a$")
    caption = (
        f"Fig. 5. Ribbons of {length:g} widths bent by a growth gradient through the thickness, "
        "g33 = xi X1/a, coloured by their deflection u1/a, and its profiles across the width. Published: "
        "eqs. (48)-(50) of Liu, Li & Liu, repaired as in Fig. 3; the curvature depends somewhat on eta, "
        "which the paper denies. Consistent: the gradient kept in the edge condition of the deflection; "
        "cylinders without stress and deflection, K2 = -xi for every eta, no saddles. Isochoric: with "
        "transverse growth g22 = -g33/2, saddles, whose anticlastic bending withdraws to the edges as "
        "xi/eta grows."
    )
    return Drawing("fig5", figure, caption, tables)


def _draw_space(axes: Axes, rows: list[list[State]], xi: tuple[float, ...], colour: ScalarMappable) -> None:
    boxes = draw_grid(axes, rows, colour, view(), gap=(0.9, 0.55))
    axes.set(xlim=(-0.5, boxes[0, -1, 2]), ylim=(boxes[-1, 0, 1], 0.9))
    for reading, box in zip(READINGS, boxes[:, 0], strict=True):
        axes.text(box[0] - 0.5, box[3], reading, ha="left", va="top", fontsize=7)
    for g, box in zip(xi, boxes[0], strict=True):
        axes.text((box[0] + box[2]) / 2, box[3] + 0.7, rf"$\xi$ = {g:g}", ha="center", fontsize=7)


def _draw_profiles(axes: Axes, x: Array, profiles: dict[str, list[Array]], xi: tuple[float, ...]) -> None:
    for row, dashes in zip(profiles.values(), DASHES, strict=True):
        for i in range(len(xi)):
            axes.plot(x, row[i], dashes, color=COLOURS[i % len(COLOURS)], linewidth=1.0)
    axes.set(xlabel="$X_2/a$", ylabel="$u_1/a$", xlim=(-0.5, 0.5), xticks=[-0.5, 0.0, 0.5])


def _draw_legend(axes: Axes, xi: tuple[float, ...]) -> None:
    for reading, dashes in zip(READINGS, DASHES, strict=True):
        axes.plot([], [], dashes, color=INK, linewidth=1.0, label=reading)
    for i, g in enumerate(xi):
        axes.plot([], [], color=COLOURS[i % len(COLOURS)], label=rf"$\xi$ = {g:g}")
    axes.legend(fontsize=6, loc="upper center", handlelength=1.8)
