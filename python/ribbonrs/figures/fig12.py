"""Fig. 12: where ribbons whose edges grow bend, twist and coil, over thickness and over chirality."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from ..arrays import Array
from ..check import Numbers, numbers, positive
from ..errors import InputError
from . import edges
from .drawing import Drawing
from .given import ratio
from .phase_map import draw_phases, phases_over, scaled_boundaries
from .style import INK, PHASES, WIDTH, new_figure, styled

__all__ = ["fig12"]

POINTS = 13
"""Thicknesses at which the ribbon is solved."""
STATED = {
    "first": ("+", ((0.05, 0.0125), (0.1, 0.05), (0.1, 0.052))),
    "second": ("x", ((0.05, 0.013), (0.1, 0.053), (0.1, 0.054))),
}
"""The bifurcations that the paper states, with what are slips by a factor of ten in its text set right."""
DASHES = ("-", (0, (5, 1.5)), (0, (1, 1)), (0, (4, 1, 1, 1)))


@styled
def fig12(eta: float = 0.12, omega: Numbers = (0.1, 0.2, 0.3), highest: float = 10.0) -> Drawing:
    r"""Draw where the shapes change, over thickness for several chiralities, and for every thickness.

    Parameters
    ----------
    eta : float
        Thickness over width, up to which.
    omega : list of float
        Chiralities, positive and ascending, that have a curve each.
    highest : float
        Edge growth in units of eta^2 up to which the phases over chirality are shown, more than 5.

    Raises
    ------
    InputError
        A parameter out of range, or an empty list.

    Notes
    -----
    Source: Liu, Li & Liu, Fig. 12.
    """
    eta, omega, highest = ratio("eta", eta), _chiralities(omega), positive("highest", highest)
    if highest <= edges.TWISTING:
        raise InputError("highest", highest, f"more than {edges.TWISTING:g}")
    thickness = np.linspace(0.0, eta, POINTS)[1:]
    loci = {
        ("flat bends", 0.0): [_onset(h, 0.0, 0) for h in thickness.tolist()],
        ("flat twists", 0.0): [_onset(h, 0.0, 1) for h in thickness.tolist()],
        **{("twisted coils", w): [_onset(h, w, 0) for h in thickness.tolist()] for w in omega},
    }
    widest = 1.25 * max(edges.chirality_of(highest), omega[-1])
    diagram = phases_over((-widest, widest), (0.0, highest))

    figure = new_figure(WIDTH, 3.4)
    left, right = figure.subplots(1, 2)
    _draw_loci(left, thickness, loci)
    left.set(xlim=(0.0, 1.02 * eta), ylim=(0.0, None), title="(a)  over thickness")
    draw_phases(right, diagram)
    _draw_scaled(right, thickness, loci, widest, highest)
    figure.legend(handles=_legend(omega), loc="outside upper center", ncols=3)
    return Drawing("fig12", figure, _caption(), _tables(thickness, loci, scaled_boundaries(diagram)))


def _chiralities(values: Numbers) -> tuple[float, ...]:
    expected = "up to four positive numbers, ascending"
    found = numbers("omega", values, expected)
    if not 0 < len(found) <= len(DASHES) or found[0] <= 0.0 or np.any(np.diff(found) <= 0.0):
        raise InputError("omega", values, expected)
    return found


def _onset(eta: float, omega: float, which: int) -> float:
    """The growth of the first or second branch point of the ribbon's first branch."""
    highest = 1.1 * max(edges.TWISTING, float(edges.coiling(np.array(omega))))
    points = edges.diagram_of(eta, omega, highest).special_points
    found = [one.parameter for one in points if one.kind == "branch_point" and one.branch == 0]
    return sorted(found)[which]


def _closed(kind: str, omega: float) -> float:
    """The growth in units of eta^2 by the closed forms."""
    return edges.TWISTING if kind == "flat twists" else float(edges.coiling(np.array(omega)))


def _style(kind: str, omega: float, chiralities: tuple[float, ...]) -> dict[str, Any]:
    if kind == "twisted coils":
        return {"color": PHASES["helical"], "linestyle": DASHES[chiralities.index(omega)]}
    return {"color": PHASES["bent" if kind == "flat bends" else "twisted"], "linestyle": "-"}


def _draw_loci(axes: Axes, eta: Array, loci: dict[tuple[str, float], list[float]]) -> None:
    chiralities = tuple(omega for kind, omega in loci if kind == "twisted coils")
    fine = np.linspace(0.0, eta[-1], 101)
    for (kind, omega), xi in loci.items():
        style = _style(kind, omega, chiralities)
        axes.plot(fine, _closed(kind, omega) * fine**2, linewidth=0.9, **style)
        axes.plot(eta, xi, "o", color=style["color"], markersize=2.6)
    for mark, places in STATED.values():
        inside = [place for place in places if place[0] <= eta[-1]]
        axes.plot(*np.reshape(inside, (-1, 2)).T, mark, color=INK, markersize=6.0, markeredgewidth=1.1)
    axes.set(xlabel=r"thickness $\eta = h/a$", ylabel=r"edge growth $\xi$")


def _draw_scaled(
    axes: Axes, eta: Array, loci: dict[tuple[str, float], list[float]], widest: float, highest: float
) -> None:
    """The closed form on the phases, the points of the other panel, and names."""
    fine = np.linspace(-widest, widest, 201)
    axes.plot(fine, edges.coiling(fine), ":", color="white", linewidth=0.9, zorder=0.9)
    for (kind, omega), xi in loci.items():
        colour = _style(kind, omega, (omega,))["color"]
        axes.plot(np.full(eta.size, omega), np.array(xi) / eta**2, "o", color=colour, markersize=3.6)
    for name, across, up in (
        ("flat", 0.03, edges.BENDING / 2.0),
        ("bent", 0.03, 0.72 * highest),
        ("twisted", 0.5, edges.BENDING / 2.0),
        ("twisted", -0.8, edges.BENDING / 2.0),
        ("helical", 0.25, 0.9 * highest),
        ("helical", -0.55, 0.9 * highest),
    ):
        style: dict[str, Any] = {"color": PHASES[name], "fontsize": 7.5, "fontweight": "bold", "va": "center"}
        axes.text(across * widest, up, name, **style)
    axes.set(
        xlim=(-widest, widest),
        ylim=(0.0, highest),
        xlabel=r"chirality $\omega$",
        ylabel=r"edge growth $\xi/\eta^2$",
        title="(b)  for every thickness",
    )


def _legend(omega: tuple[float, ...]) -> list[Line2D]:
    kinds = [("flat bends", 0.0), ("flat twists", 0.0), *(("twisted coils", w) for w in omega)]
    return [
        *(
            Line2D(
                [], [], marker="o", markersize=2.6, linewidth=0.9, label=_told(*kind), **_style(*kind, omega)
            )
            for kind in kinds
        ),
        *(
            Line2D([], [], color=INK, marker=mark, linestyle="none", markersize=6.0, label=f"paper, {which}")
            for which, (mark, _) in STATED.items()
        ),
    ]


def _told(kind: str, omega: float) -> str:
    return rf"{kind}, $\omega$ = {omega:g}"


def _tables(
    eta: Array, loci: dict[tuple[str, float], list[float]], boundaries: list[tuple[str, Array]]
) -> dict[str, dict[str, list[Any]]]:
    rows = [
        (kind, omega, h, xi, xi / h**2, _closed(kind, omega))
        for (kind, omega), values in loci.items()
        for h, xi in zip(eta.tolist(), values, strict=True)
    ]
    names = ("change", "omega", "eta", "xi", "xi_over_eta2", "closed_form")
    return {
        "loci": {name: [row[k] for row in rows] for k, name in enumerate(names)},
        "boundaries": {
            "line": [i for i, (_, points) in enumerate(boundaries) for _ in points],
            "phases": [phases for phases, points in boundaries for _ in points],
            "omega": [value for _, points in boundaries for value in points[:, 0].tolist()],
            "xi_over_eta2": [value for _, points in boundaries for value in points[:, 1].tolist()],
        },
    }


def _caption() -> str:
    rise = float(edges.coiling(np.array(1.0))) - edges.BENDING
    low, high = map(edges.chirality_of, edges.PAPER_COILS)
    return (
        "Fig. 12. Where the shapes of an unloaded ribbon change whose edges grow, g33 = xi (2 X2/a)^2, by "
        "the full section law at n = m = 0. (a) Over the thickness, without chirality and with the "
        "chirality g23 + g32 = 2 eta omega X1/a: each dot from the branches of a ribbon of its own, lines "
        f"by the closed forms xi = {edges.BENDING:.5g} eta^2, 5 eta^2 and ({edges.BENDING:.5g} + "
        f"{rise:.4g} omega^2) eta^2. All are parabolas through the origin, since thickness scales out of "
        "the problem; the paper's two curves, which it calls nonlinear, must be as well. Flat ribbons "
        "bend, which the paper does not have, before they would twist (unstable). The paper's first "
        "bifurcations (+, 5 to 5.2 eta^2) are those of twist; its second ones (x, 5.2 to 5.4 eta^2; it "
        "gives two numbers for each, and misprints of a factor of ten are set right) do not follow from "
        f"its equations. They are where twisted ribbons turn helical if omega is {low:.2f} to {high:.2f}; "
        "the paper does not state a chirality: one possible explanation, not a reproduction. (b) The same "
        "for every thickness: phase of the lowest stable state over chirality and growth, with the "
        "computed boundary (solid) on its closed form (dotted); the dots of (a) fall on one another. "
        "Without chirality, at omega = 0, ribbons are flat and then bent."
    )
