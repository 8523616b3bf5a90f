"""Figs. 7 and 8: the energy of edge growth over K3 at K2 = 0, for several thicknesses and growths."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from ..arrays import Array
from ..check import Numbers
from .drawing import Drawing
from .extrema import CONDITIONS, MARKS, Plane
from .given import growths, ratio, ratios
from .style import COLOURS, INK, WIDTH, new_figure, styled

__all__ = ["fig7", "fig8"]

BEYOND = 1.2
"""The twists reach so many times as far as those of stationary points can."""

Cases = Sequence[tuple[str, float, float]]
"""Names, thicknesses over width, growths."""

CAPTION = (
    "eps = 0 with the length held, (b) with the ends free of force, n3 = 0, where eps = xi/3 - K3^2/24. The "
    "full law; its expansion to second order in K2, eq. (59) of Liu, Li & Liu, is the same at K2 = 0. Marked "
    "where it is stationary, and whether that is a minimum, a saddle or a maximum over K2 and K3. The paper "
    "does not say what becomes of eps. At eps = 0 the ribbon twists beyond xi = 20 eta^2/9, with "
    "K3^2 = 8 xi - 160 eta^2/9, and that is a minimum; with free ends beyond 5 eta^2, eq. (64), and that is "
    "a saddle: bending lowers the energy further."
)


@styled
def fig7(eta: Numbers = (0.05, 0.06, 0.07, 0.08, 0.1), xi: float = 0.03) -> Drawing:
    """Draw the energy over K3 for several thicknesses, at eps = 0 and at n3 = 0.

    Parameters
    ----------
    eta : list of float
        Thicknesses over width, a curve each.
    xi : float
        Edge growth.

    Raises
    ------
    InputError
        A parameter out of range, or an empty list.

    Notes
    -----
    Source: Liu, Li & Liu, Fig. 7 and eqs. (57)-(59).
    """
    eta, (xi,) = ratios("eta", eta), growths("xi", [xi])
    told = f"Fig. 7. Energy of edge growth over K3 for several eta, xi = {xi:g}, K1 = K2 = 0: (a) "
    return _draw("fig7", told + CAPTION, [("eta", h, xi) for h in eta])


@styled
def fig8(eta: float = 0.05, xi: Numbers = (0.01, 0.02, 0.03, 0.04)) -> Drawing:
    """Draw the energy over K3 for several edge growths, at eps = 0 and at n3 = 0.

    Parameters
    ----------
    eta : float
        Thickness over width.
    xi : list of float
        Edge growths, a curve each.

    Raises
    ------
    InputError
        A parameter out of range, or an empty list.

    Notes
    -----
    Source: Liu, Li & Liu, Fig. 8 and eqs. (57)-(59).
    """
    eta, xi = ratio("eta", eta), growths("xi", xi)
    told = f"Fig. 8. Energy of edge growth over K3 for several xi, eta = {eta:g}, K1 = K2 = 0: (a) "
    return _draw("fig8", told + CAPTION, [("xi", eta, g) for g in xi])


def _draw(name: str, caption: str, cases: Cases) -> Drawing:
    figure = new_figure(WIDTH, 2.9)
    K3 = BEYOND * max(Plane(h, g, "eps0").reach for _, h, g in cases) * np.linspace(-1.0, 1.0, 241)
    tables: dict[str, dict[str, list[Any]]] = {}
    panels = figure.subplots(1, 2)
    for letter, axes, (condition, told) in zip("ab", panels, CONDITIONS.items(), strict=True):
        energies, extrema = _draw_energies(axes, cases, condition, K3)
        tables[f"energy_{condition}"] = {"K3": K3.tolist()} | energies
        tables[f"extrema_{condition}"] = extrema
        axes.set(xlabel="$K_3$", title=f"({letter})  {told}", xlim=(K3[0], K3[-1]))
        axes.ticklabel_format(axis="y", scilimits=(0, 0), useMathText=True)
        axes.title.set_y(1.06)
    panels[0].set_ylabel(r"energy $\Pi$")
    _draw_legend(figure, panels[0])
    return Drawing(name, figure, caption, tables)


def _draw_energies(
    axes: Axes, cases: Cases, condition: str, K3: Array
) -> tuple[dict[str, list[float]], dict[str, list[Any]]]:
    energies: dict[str, list[float]] = {}
    rows: list[tuple[Any, ...]] = []
    met: dict[str, list[str]] = {}
    for i, (varied, eta, xi) in enumerate(cases):
        plane = Plane(eta, xi, condition)
        energy = plane.energy(0.0, K3)
        value = eta if varied == "eta" else xi
        axes.plot(K3, energy, color=COLOURS[(i + 1) % len(COLOURS)], label=rf"$\{varied}$ = {value:g}")
        energies[f"Pi {varied}={value:g}"] = energy.tolist()
        for one in plane.extrema(straight=True):
            if varied == "eta" and one.K3 == 0.0:  # where all curves meet
                met.setdefault(one.kind, []).append(f"{value:g}")
            else:
                axes.plot(one.K3, one.energy, zorder=3, **MARKS[one.kind])
            rows.append((eta, xi, one.K3, one.energy, one.kind))
    if met:
        told = "\n".join(rf"{kind}: $\eta$ = {', '.join(values)}" for kind, values in met.items())
        line = {"arrowstyle": "-", "color": INK, "linewidth": 0.7}
        place: dict[str, Any] = {"xytext": (0.5, 0.8), "textcoords": "axes fraction", "ha": "center"}
        axes.annotate(told, (0.0, float(plane.energy(0.0, 0.0))), fontsize=6.5, arrowprops=line, **place)
    names = ("eta", "xi", "K3", "energy", "kind")
    return energies, {name: list(column) for name, column in zip(names, zip(*rows, strict=True), strict=True)}


def _draw_legend(figure: Figure, axes: Axes) -> None:
    marks = [Line2D([], [], linestyle="none", label=kind, **mark) for kind, mark in MARKS.items()]
    lines = axes.get_legend_handles_labels()[0]
    figure.legend(
        handles=[*lines, *marks], loc="outside lower center", ncols=4, columnspacing=1.3, handlelength=1.4
    )
