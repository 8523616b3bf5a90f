"""Fig. 9: the twist of edge growth, from its threshold on."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ..arrays import Array
from ..check import Numbers, positive
from .drawing import Drawing
from .extrema import CONDITIONS, Plane
from .given import ratios
from .style import COLOURS, INK, WIDTH, new_figure, styled

__all__ = ["fig9"]

CLOSED = {"eps0": 20.0 / 9.0, "n30": 5.0}
"""The thresholds in units of eta^2, from the K3^2 term of eq. (59) without and with the relaxing eps."""

POINTS = 41
THRESHOLD: dict[str, Any] = {"marker": "*", "markersize": 8.0, "linestyle": "none", "zorder": 3}
BENDING: dict[str, Any] = {"marker": "v", "markersize": 5.0, "markerfacecolor": "white", "linestyle": "none"}


@styled
def fig9(eta: Numbers = (0.04, 0.06, 0.08, 0.1), xi: float = 0.1) -> Drawing:
    """Draw the twist K3 over edge growth for several thicknesses, at eps = 0 and at n3 = 0.

    Parameters
    ----------
    eta : list of float
        Thicknesses over width, a curve each.
    xi : float
        Up to this growth, positive.

    Raises
    ------
    InputError
        A parameter out of range, or an empty list.

    Notes
    -----
    Source: Liu, Li & Liu, Fig. 9 and eq. (64).
    """
    eta, xi = ratios("eta", eta), positive("xi", xi)
    figure = new_figure(WIDTH, 2.9)
    tables: dict[str, dict[str, list[Any]]] = {}
    panels = figure.subplots(1, 2, sharey=True)
    for letter, axes, (condition, told) in zip("ab", panels, CONDITIONS.items(), strict=True):
        onsets = [_onsets(h, condition) for h in eta]
        tables[f"thresholds_{condition}"] = {
            "eta": list(eta),
            "xi twist": [twist for twist, _ in onsets],
            "xi bend": [bend for _, bend in onsets],
        }
        axes.axhline(0.0, color=INK, linewidth=0.7)
        for i, (h, (twist, bend)) in enumerate(zip(eta, onsets, strict=True)):
            colour = COLOURS[(i + 1) % len(COLOURS)]
            if twist < xi:
                tables[f"twist_{condition}_eta{h:g}"] = _draw_twist(axes, h, twist, xi, condition, colour)
            if bend < min(twist, xi):
                axes.plot(bend, 0.0, color=colour, clip_on=False, zorder=3, **BENDING)
        axes.set(xlabel=r"edge growth $\xi$", title=f"({letter})  {told}", xlim=(0.0, xi))
        axes.locator_params(axis="x", nbins=3)
    panels[0].set_ylabel("twist $K_3$")
    _draw_legend(figure, panels[0], eta)
    caption = (
        "Fig. 9. Twist K3 (or -K3) over edge growth g33 = xi (2 X2/a)^2 for several eta, K1 = K2 = 0, by the "
        "full law; its expansion to second order in K2, eq. (59) of Liu, Li & Liu, is the same there. Dots: "
        "closed forms. Stars: thresholds. (a) With the length held, eps = 0: xi = 20 eta^2/9, then "
        "K3^2 = 8 xi - 160 eta^2/9. (b) With the ends free of force, n3 = 0: xi = 5 eta^2, then eq. (64), "
        "K3^2 = 8 xi - 40 eta^2. Solid: a minimum of the energy over K2 and K3, dashed: a saddle. Triangles: "
        "with free ends the flat ribbon bends already at xi = 4.547 eta^2, and the twisted one is unstable "
        "to bending from its threshold on, which the paper does not say."
    )
    return Drawing("fig9", figure, caption, tables)


def _onsets(eta: float, condition: str) -> tuple[float, float]:
    """Growths at which the flat ribbon loses its stiffness to twist and to bending.

    The stiffnesses at the flat state are polynomials in xi, of first and second order.
    """
    xi = 4.0 * eta**2 * np.arange(3.0)
    bend, twist = np.array([np.diag(Plane(eta, g, condition).stiffness(0.0, 0.0)) for g in xi.tolist()]).T
    return _first_root(xi[:2], twist[:2]), _first_root(xi, bend)


def _first_root(x: Array, values: Array) -> float:
    """The least positive root of the polynomial through these points."""
    roots = np.roots(np.polyfit(x / x[-1], values / values[0], x.size - 1)) * x[-1]
    return float(np.min(roots.real[(roots.imag == 0.0) & (roots.real > 0.0)]))


def _draw_twist(
    axes: Axes, eta: float, onset: float, most: float, condition: str, colour: str
) -> dict[str, list[Any]]:
    # Denser where the twist grows as a square root.
    xi = onset + (most - onset) * np.linspace(0.0, 1.0, POINTS)[1:] ** 2
    found = [Plane(eta, g, condition).extrema(straight=True)[-1] for g in xi.tolist()]
    K3 = np.array([one.K3 for one in found])
    kinds = [one.kind for one in found]
    closed = np.sqrt(8.0 * (xi - CLOSED[condition] * eta**2))
    dashes = "-" if set(kinds) == {"minimum"} else "--"
    axes.plot([onset, *xi], [0.0, *K3], dashes, color=colour)
    axes.plot(xi[3::5], closed[3::5], ".", color=INK, markersize=3.0)
    axes.plot(onset, 0.0, color=colour, clip_on=False, **THRESHOLD)
    return {"xi": xi.tolist(), "K3": K3.tolist(), "kind": kinds}


def _draw_legend(figure: Figure, axes: Axes, eta: tuple[float, ...]) -> None:
    for i, h in enumerate(eta):
        axes.plot([], [], color=COLOURS[(i + 1) % len(COLOURS)], label=rf"$\eta$ = {h:g}")
    axes.plot([], [], ".", color=INK, markersize=3.0, label="closed form")
    axes.plot([], [], color=INK, label="twist begins", **THRESHOLD)
    axes.plot([], [], color=INK, label="flat bends", **BENDING)
    figure.legend(handles=axes.get_legend_handles_labels()[0], loc="outside lower center", ncols=4)
