"""All shapes of a ribbon over chirality and edge growth, each where it belongs."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from ..check import Numbers, numbers
from ..equilibrium import solve
from ..errors import InputError
from ..state import State
from . import edges
from .drawing import Drawing
from .given import ratio
from .phase_map import draw_phases, phases_over, scaled_boundaries
from .shapes import draw_shape, view
from .style import PHASES, WIDTH, new_figure, styled

__all__ = ["phase_plane"]

ACROSS, UP = 12.5, 8.0
"""Widths of the ribbon from one shape to the next where they are nearest."""
MARGIN = 0.55
"""Of such a step, around the outermost shapes."""
DETAIL = 0.06
SEEN = view(elevation=55.0, side=20.0)


@styled
def phase_plane(
    eta: float = 0.06,
    omega: Numbers = (-0.75, -0.5, -0.25, 0.0, 0.25, 0.5, 0.75),
    x: Numbers = (-16.0, -12.0, -8.0, -4.0, 0.0, 4.0, 8.0, 12.0, 16.0),
) -> Drawing:
    r"""Draw the stable shapes over chirality and edge growth, coloured by phase, on the map of phases.

    Parameters
    ----------
    eta : float
        Thickness over width of the ribbons that are drawn; the map is the same for all.
    omega : list of float
        Chiralities, ascending: a column of shapes each.
    x : list of float
        Edge growths xi/eta^2, ascending: a row each. Where they are negative the middle grows more.

    Raises
    ------
    InputError
        A parameter out of range.
    """
    eta, omega, x = ratio("eta", eta), _ascending("omega", omega), _ascending("x", x)
    unit = ACROSS / float(np.min(np.diff(omega))), UP / float(np.min(np.diff(x)))
    margin = MARGIN * ACROSS / unit[0], MARGIN * UP / unit[1]
    spans = [(values[0] - m, values[-1] + m) for values, m in zip((omega, x), margin, strict=True)]
    diagram = phases_over(*spans)
    states = [[solve(edges.grown(eta, growth, w)) for w in omega] for growth in x]

    wide, high = ((span[1] - span[0]) * size for span, size in zip(spans, unit, strict=True))
    figure = new_figure(WIDTH, 0.75 + 0.92 * WIDTH * high / wide)
    axes = figure.subplots()
    draw_phases(axes, diagram, unit)
    for growth, row in zip(x, states, strict=True):
        for w, state in zip(omega, row, strict=True):
            place = w * unit[0], growth * unit[1]
            draw_shape(axes, state, PHASES[state.phase], place, SEEN, DETAIL)
    _draw_frame(axes, spans, unit, omega, x)
    present = {state.phase for row in states for state in row}
    shown = [
        Line2D([], [], color=PHASES[name], linewidth=4.0, label=name) for name in PHASES if name in present
    ]
    figure.legend(handles=shown, loc="outside upper center", ncols=len(shown))
    boundaries = scaled_boundaries(diagram)
    return Drawing(
        "phase_plane",
        figure,
        _caption(eta),
        {
            "shapes": _shapes(omega, x, states),
            "boundaries": {
                "line": [i for i, (_, points) in enumerate(boundaries) for _ in points],
                "phases": [phases for phases, points in boundaries for _ in points],
                "omega": [value for _, points in boundaries for value in points[:, 0].tolist()],
                "xi_over_eta2": [value for _, points in boundaries for value in points[:, 1].tolist()],
            },
        },
    )


def _ascending(field: str, values: Numbers) -> tuple[float, ...]:
    expected = "two or more numbers, ascending"
    found = numbers(field, values, expected)
    if len(found) < 2 or np.any(np.diff(found) <= 0.0):
        raise InputError(field, values, expected)
    return found


def _draw_frame(
    axes: Axes,
    spans: list[tuple[float, float]],
    unit: tuple[float, float],
    omega: tuple[float, ...],
    x: tuple[float, ...],
) -> None:
    """Both axes in their own variables; lengths along them are in widths of the ribbon."""
    (left, right), (low, high) = ((span[0] * u, span[1] * u) for span, u in zip(spans, unit, strict=True))
    axes.set(xlim=(left, right), ylim=(low, high), aspect="equal")
    axes.set_xticks([w * unit[0] for w in omega], [f"${w:g}$" for w in omega])
    axes.set_yticks([growth * unit[1] for growth in x], [f"${growth:g}$" for growth in x])
    axes.set(xlabel=r"chirality $\omega$", ylabel=r"edge growth $\xi/\eta^2$")


def _shapes(
    omega: tuple[float, ...], x: tuple[float, ...], states: list[list[State]]
) -> dict[str, list[Any]]:
    """Where each shape is, its phase and its strains."""
    flat = [state for row in states for state in row]
    columns: dict[str, list[Any]] = {
        "omega": list(omega) * len(x),
        "xi_over_eta2": [growth for growth in x for _ in omega],
        "phase": [state.phase for state in flat],
    }
    for k, name in enumerate(("eps", "K1", "K2", "K3")):
        columns[name] = [float(state.strain[k]) for state in flat]
    return columns


def _caption(eta: float) -> str:
    return (
        "All shapes of an unloaded ribbon over the edge growth g33 = xi (2 X2/a)^2 and the chirality g23 "
        "+ g32 = 2 eta omega X1/a, by the full section law; the paper does not have this figure. Behind "
        "them the phases of the lowest stable state, which are the same for every thickness; lines: "
        f"shapes become unstable. The ribbons are {edges.LENGTH:g} widths long with eta = {eta:g}, in one "
        "view and on one scale, each held at its start on the left; of mirror images the one with K2 > 0. "
        "They are right-handed where omega > 0. Without chirality they are flat from xi/eta^2 = "
        f"{edges.MIDDLE_BENDING:.5g} to {edges.BENDING:.5g}; beyond, if the edges grow more, or the middle "
        "(xi < 0), they bend along their length. With it they are twisted, and helical beyond the "
        "boundaries. Contact of a ribbon with itself is left out."
    )
