"""Fig. 6: the energy of edge growth over K2 and K3, and the configuration where it is least."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import PowerNorm
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from ..arrays import Array
from ..check import positive
from ..growth import edge
from ..ribbon import Ribbon
from .drawing import Drawing
from .extrema import CONDITIONS, MARKS, Extremum, Plane
from .given import growths, ratio
from .shapes import draw_shape, held_at
from .style import PHASES, WIDTH, new_figure, styled

__all__ = ["fig6"]

BEYOND = 1.15
"""The curvatures reach so many times as far as those of stationary points can."""
WELL = 0.7
"""The surface is drawn as far as this part of it: beyond, its walls would dwarf the wells."""
POINTS, LEVELS = 81, 13
MAP, QUADRATIC = "cividis", "#E69F00"


@styled
def fig6(eta: float = 0.1, xi: float = 0.03, length: float = 10.0) -> Drawing:
    """Draw the energy over K2 and K3 as contours and as a surface, at eps = 0 and at n3 = 0.

    Parameters
    ----------
    eta : float
        Thickness over width.
    xi : float
        Edge growth.
    length : float
        Of the ribbon that is drawn where the energy is least, in widths.

    Raises
    ------
    InputError
        A parameter out of range.

    Notes
    -----
    Source: Liu, Li & Liu, Fig. 6 and eqs. (57)-(59).
    """
    eta, (xi,), length = ratio("eta", eta), growths("xi", [xi]), positive("length", length)
    figure = new_figure(WIDTH, 4.2)
    solid: Any = {("b", "e"): {"projection": "3d"}}
    panels = figure.subplot_mosaic("abc;def", per_subplot_kw=solid)
    tables: dict[str, dict[str, list[Any]]] = {}
    phases: list[str] = []
    for row, (condition, told) in enumerate(CONDITIONS.items()):
        plane = Plane(eta, xi, condition)
        line = BEYOND * plane.reach * np.linspace(-1.0, 1.0, POINTS)
        K2, K3 = np.meshgrid(line, line)
        energy = plane.energy(K2, K3)
        extrema = plane.extrema()
        contours, surface, shape = ("abc", "def")[row]
        _draw_contours(panels[contours], plane, K2, K3, energy, extrema)
        _draw_surface(panels[surface], plane, extrema)
        phases.append(_draw_least(panels[shape], plane, extrema, length))
        panels[contours].set_title(f"({contours})  {told}")
        panels[surface].set_title(f"({surface})", y=1.0)
        panels[shape].set_title(f"({shape})", loc="left")
        tables[f"energy_{condition}"] = {
            "K2": K2.ravel().tolist(),
            "K3": K3.ravel().tolist(),
            "Pi": energy.ravel().tolist(),
            "Pi quadratic": plane.of("quadratic").energy(K2, K3).ravel().tolist(),
        }
        tables[f"extrema_{condition}"] = {
            name: [getattr(one, name) for one in extrema] for name in ("K2", "K3", "energy", "kind")
        }
    _draw_legend(figure)
    caption = (
        f"Fig. 6. Energy of edge growth g33 = xi (2 X2/a)^2 over K2 and K3, eta = {eta:g}, xi = {xi:g}, "
        "K1 = 0, with its minima, saddles and maxima: by the full law, eqs. (57) and (58) of Liu, Li & Liu, "
        "and, dashed at every third level, by its expansion to second order in K2, eq. (59). (a)-(c) With "
        f"the length held, eps = 0: least where the ribbon is {phases[0]}. (d)-(f) With the ends free of "
        f"force, n3 = 0, where eps = xi/3 - K3^2/24: least where it is {phases[1]}. (c), (f) The ribbon "
        f"there, {length:g} widths long. The paper does not say what becomes of eps. The three extrema that "
        "it describes at xi = 0.03, eta = 0.1 exist at eps = 0; with free ends, for which its eq. (64) "
        "holds, the flat ribbon is the only one until xi = 4.547 eta^2."
    )
    return Drawing("fig6", figure, caption, tables)


def _draw_contours(
    axes: Axes, plane: Plane, K2: Array, K3: Array, energy: Array, extrema: list[Extremum]
) -> None:
    least, most = float(np.min(energy)), float(np.max(energy))
    levels = least + (most - least) * np.linspace(0.0, 1.0, LEVELS) ** 2
    axes.contourf(K2, K3, energy, levels, cmap=MAP, norm=PowerNorm(0.5, least, most))
    axes.contour(K2, K3, energy, levels, colors="white", linewidths=0.4)
    quadratic = plane.of("quadratic").energy(K2, K3)
    axes.contour(K2, K3, quadratic, levels[1::3], colors=QUADRATIC, linewidths=0.8, linestyles="--")
    for one in extrema:
        axes.plot(one.K2, one.K3, **MARKS[one.kind])
    axes.set(xlabel="$K_2$", ylabel="$K_3$", aspect="equal")


def _draw_surface(axes: Any, plane: Plane, extrema: list[Extremum]) -> None:
    line = WELL * BEYOND * plane.reach * np.linspace(-1.0, 1.0, POINTS // 2)
    K2, K3 = np.meshgrid(line, line)
    energy = plane.energy(K2, K3)
    power = int(np.floor(np.log10(np.max(energy))))
    height = energy / 10.0**power
    axes.plot_surface(
        K2, K3, height, cmap=MAP, norm=PowerNorm(0.5), rcount=POINTS, ccount=POINTS, rasterized=True
    )
    for one in extrema:
        if max(abs(one.K2), abs(one.K3)) <= line[-1]:
            axes.plot([one.K2], [one.K3], [one.energy / 10.0**power], zorder=10, **MARKS[one.kind])
    axes.view_init(38, -25)
    axes.tick_params(labelsize=6, pad=-2)
    axes.set_xlabel("$K_2$", labelpad=-5)
    axes.set_ylabel("$K_3$", labelpad=-5)
    axes.set_zlabel(rf"$10^{{{-power}}}\,\Pi$", labelpad=-5)
    axes.set_box_aspect((1.0, 1.0, 0.8), zoom=0.9)


def _draw_least(axes: Axes, plane: Plane, extrema: list[Extremum], length: float) -> str:
    """The ribbon at the least energy, of mirror images the one of positive curvatures; returns its phase."""
    minima = [one for one in extrema if one.kind == "minimum" and min(one.K2, one.K3) >= 0.0]
    least = min(minima, key=lambda one: one.energy)
    strain = plane.strains(least.K2, least.K3).tolist()
    state = held_at(Ribbon(length, 1.0, plane.eta), edge(plane.xi), strain)
    draw_shape(axes, state, PHASES[state.phase])
    axes.autoscale_view()
    axes.set_aspect("equal")
    axes.axis("off")
    told = f"{state.phase}\n$K_2 = {least.K2:.4g}$, $K_3 = {least.K3:.4g}$"
    axes.text(0.5, -0.1, told, transform=axes.transAxes, ha="center", va="top")
    return state.phase


def _draw_legend(figure: Figure) -> None:
    lines = [Line2D([], [], linestyle="none", label=kind, **mark) for kind, mark in MARKS.items()]
    lines.append(Line2D([], [], linestyle="--", color=QUADRATIC, label="to second order in $K_2$, eq. (59)"))
    figure.legend(handles=lines, loc="outside lower center", ncols=len(lines))
