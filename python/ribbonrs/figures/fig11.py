"""Fig. 11: the shapes along the path from flat to helical, and the deflection of their sections."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable

from ..check import Numbers, number, numbers
from ..equilibrium import solve
from ..errors import InputError
from ..state import State
from . import edges
from .drawing import Drawing
from .given import ratios
from .shapes import deflection_scale, draw_grid, view
from .style import COLOURS, INK, PHASES, WIDTH, new_figure, styled

__all__ = ["fig11"]

COLUMNS = 1, 2, 3
GAP = 1.6, 4.2
"""Widths between shapes, where their maps are too."""
BELOW = 0.5
"""Widths between a shape and its map."""
PLACES = 0.0, 0.4, 0.5
"""X2/a in the middle, from where on the paper speaks of the edge, and at the edge."""


@styled
def fig11(
    eta: Numbers = (0.05, 0.1),
    x: Numbers = (0.0, 4.0, 5.0, 5.3, 6.0, 8.0),
    omega: float = edges.OMEGA,
) -> Drawing:
    r"""Draw shapes of growing edges with a trace of chirality, with maps and profiles of u1/a.

    Parameters
    ----------
    eta : list of float
        Thicknesses over width, a row of panels each.
    x : list of float
        Edge growths xi/eta^2.
    omega : float
        Chirality: shear growth g23 + g32 = 2 eta omega X1/a.

    Raises
    ------
    InputError
        A parameter out of range, or an empty list.

    Notes
    -----
    Source: Liu, Li & Liu, Fig. 11.
    """
    eta, x, omega = ratios("eta", eta), numbers("x", x), number("omega", omega)
    if not x:
        raise InputError("x", x, "at least one edge growth over eta^2")
    states = {h: [solve(edges.grown(h, growth, omega)) for growth in x] for h in eta}
    colour = deflection_scale([state for row in states.values() for state in row])
    across = np.linspace(-0.5, 0.5, 101)
    profiles = {h: [state.deflection(across)[0] for state in row] for h, row in states.items()}

    figure = new_figure(WIDTH, 2.6 * len(eta))
    panels = figure.subplots(len(eta), 2, squeeze=False, width_ratios=[2.7, 1.0])
    for i, (h, (space, profile)) in enumerate(zip(eta, panels, strict=True)):
        _draw_space(space, states[h], x, colour)
        space.set_title(rf"({chr(97 + i)})  $\eta$ = {h:g}")
        for k, (growth, values) in enumerate(zip(x, profiles[h], strict=True)):
            profile.plot(across, values, color=COLOURS[k % len(COLOURS)], label=f"{growth:g}")
        profile.set(xlabel="$X_2/a$", ylabel="$u_1/a$", xlim=(-0.5, 0.5), xticks=[-0.5, 0.0, 0.5])
        profile.legend(
            title=r"$\xi/\eta^2$",
            title_fontsize=7,
            loc="upper center",
            bbox_to_anchor=(0.5, -0.25),
            ncols=3,
            columnspacing=1.0,
            handlelength=1.0,
        )
    bar = figure.colorbar(colour, ax=panels[:, 0], location="bottom", shrink=0.5, aspect=35, pad=0.02)
    bar.set_label("deflection $u_1/a$")
    return Drawing(
        "fig11",
        figure,
        _caption(omega, states, x),
        {
            "states": _states(states, x),
            "deflection": {"x": across.tolist()}
            | {
                f"u1/a eta={h:g} xi={growth:g} eta^2": values.tolist()
                for h, row in profiles.items()
                for growth, values in zip(x, row, strict=True)
            },
        },
    )


def _draw_space(axes: Axes, states: list[State], x: tuple[float, ...], colour: ScalarMappable) -> None:
    """The shapes in rows, and below each its map: the width upwards and the length to the right, to scale."""
    columns = max(n for n in COLUMNS if len(states) % n == 0)
    rows = [states[i : i + columns] for i in range(0, len(states), columns)]
    boxes = draw_grid(axes, rows, colour, view(), gap=GAP)
    half = states[0].scene.ribbon.length_ratio / 2
    across = np.linspace(-0.5, 0.5, 101)
    for state, growth, box in zip(states, x, boxes.reshape(-1, 4), strict=True):
        middle, top = (box[0] + box[2]) / 2, box[1] - BELOW
        corners = middle - half, middle + half, top - 1.0, top
        painted = colour.to_rgba(state.deflection(across).T)
        axes.imshow(painted, extent=corners, origin="lower", zorder=1)
        axes.plot(
            middle + half * np.array([-1, 1, 1, -1, -1]),
            top - np.array([1, 1, 0, 0, 1]),
            color=INK,
            linewidth=0.4,
        )
        told = rf"$\xi/\eta^2$ = {growth:g}: {state.phase}"
        axes.text(middle, box[3] + 0.3, told, ha="center", va="bottom", fontsize=7, color=PHASES[state.phase])
    lowest = boxes[-1, 0, 1] - BELOW - 1.1
    left = min(0.0, boxes[0, 0, 2] / 2 - half)
    right = max(boxes[0, -1, 2], (boxes[0, -1, 0] + boxes[0, -1, 2]) / 2 + half)
    axes.set(xlim=(left - 0.2, right + 0.2), ylim=(lowest, 1.8), aspect="equal")


def _states(states: dict[float, list[State]], x: tuple[float, ...]) -> dict[str, list[Any]]:
    """Of each shape its strains, and its deflection in the middle, at X2/a = 0.4 and at the edge."""
    rows = [
        (h, growth, growth * h**2, state.phase, *state.strain.tolist(), *state.deflection(PLACES)[0].tolist())
        for h, row in states.items()
        for growth, state in zip(x, row, strict=True)
    ]
    deflections = (f"u1/a at {place:g}" for place in PLACES)
    names = ("eta", "xi_over_eta2", "xi", "phase", "eps", "K1", "K2", "K3", *deflections)
    return {name: [row[k] for row in rows] for k, name in enumerate(names)}


def _caption(omega: float, states: dict[float, list[State]], x: tuple[float, ...]) -> str:
    return (
        "Fig. 11. Shapes of an unloaded ribbon along the growth of its edges, g33 = xi (2 X2/a)^2, with "
        f"the trace of chirality g23 + g32 = 2 eta omega X1/a, omega = {omega:g}, by the full section law; "
        "coloured by their deflection u1/a. Below each its map over width (upwards) and length "
        f"({edges.LENGTH:g} widths, to the right), on the right the profiles. Without chirality there is "
        "no twisted or helical shape is stable: the path flat, twisted, helical of the paper needs it, or "
        "something else that the paper does not state. At the same xi/eta^2 thicknesses differ in scale "
        f"alone: curvatures and deflections are in proportion to eta. {_deflections(states, x)} Of two "
        "mirror images the one with K2 > 0 is shown; the other has all signs of u1 reversed."
    )


def _deflections(states: dict[float, list[State]], x: tuple[float, ...]) -> str:
    """How the deflection of the bent sections compares with what the paper says of it."""
    grown = [state for row in states.values() for state, growth in zip(row, x, strict=True) if growth > 0.0]
    bent = [state.deflection(PLACES)[0] for state in grown if state.strain[2] > 0.0]
    if not bent:
        return "None of these is bent, so that u1 = 0."
    middle, _, edge = np.array(bent).T
    return (
        "The paper has u1 small near the edge and, in the middle, going from positive to negative as xi "
        f"grows. That is not found: of those that are bent u1/a in the middle is from {np.min(middle):.3g} "
        f"to {np.max(middle):.3g}, and |u1| at the edge at least {np.min(np.abs(edge / middle)):.3g} times "
        "as large."
    )
