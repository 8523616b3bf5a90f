"""Fig. 10: how a ribbon whose edges grow bifurcates, and how a trace of chirality unfolds that."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from ..analytic import twist
from ..check import number, numbers, positive
from ..diagram import Diagram
from ..diagram_plot import STYLES, branch_lines, runs
from ..equilibrium import solve
from ..errors import InputError
from ..state import State
from . import edges
from .drawing import Drawing
from .given import ratio
from .style import INK, PHASES, WIDTH, new_figure, styled

__all__ = ["fig10"]

POINTS = 81
"""Edge growths at which branches are solved for."""
MARKS = {"branch_point": "o", "fold": "s"}
QUANTITIES = {"K3": "twist $K_3$", "K2": "curvature $K_2$"}
# K1 broad and grey: K2 = 0 lies on it where the ribbon is twisted.
CURVATURES: dict[str, dict[str, Any]] = {
    "$K_1$": {"color": "0.75", "linewidth": 3.0},
    "$K_2$": {"color": INK},
    "$K_3$": {"color": INK, "linestyle": (0, (4, 2))},
}


@styled
def fig10(
    eta: float = 0.1,
    omega: float = edges.OMEGA,
    highest: float = 8.0,
    shown: Sequence[float] = (5.0, 6.0),
) -> Drawing:
    r"""Branches over the edge growth with and without chirality, and strains along two of its ribbons.

    Parameters
    ----------
    eta : float
        Thickness over width.
    omega : float
        Chirality: shear growth g23 + g32 = 2 eta omega X1/a, which twists the ribbon by eta omega on its own.
    highest : float
        The branches are followed to an edge growth of this times eta^2.
    shown : sequence of 2 float
        Edge growths over eta^2 at which the strains along the ribbon are shown.

    Raises
    ------
    InputError
        An argument that is not that.

    Notes
    -----
    Source: Liu, Li & Liu, Fig. 10 and eqs. (64), (66)-(70).
    """
    eta, omega = ratio("eta", eta), number("omega", omega)
    highest = positive("highest", highest)
    places = numbers("shown", shown)
    if len(places) != 2:
        raise InputError("shown", shown, "two numbers")
    perfect, unfolded = (edges.diagram_of(eta, chirality, highest, POINTS) for chirality in (0.0, omega))
    # With the boundary conditions (68)-(69): that the strains are the same all along is a result.
    along = [solve(edges.grown(eta, x, omega), method="collocation") for x in places]
    closed = _eq64(eta, perfect.span[1])

    figure = new_figure(WIDTH, 5.6)
    axes = figure.subplots(3, 2)
    for row, (diagram, prime) in enumerate(((perfect, ""), (unfolded, "$'$"))):
        told = rf"$\omega$ = {omega:g}" if prime else "no chirality"
        for column, (quantity, name) in enumerate(QUANTITIES.items()):
            _draw_branches(axes[row, column], diagram, quantity, eta)
            axes[row, column].set(title=f"({'ab'[column]}{prime}) {told}", ylabel=name)
    (line,) = axes[0, 0].plot(
        *closed.values(),
        "o",
        color=INK,
        markersize=3.4,
        markerfacecolor="white",
        markeredgewidth=0.7,
        zorder=4,
    )
    for letter, x, state, where in zip("cd", places, along, axes[2], strict=True):
        _draw_along(where, state)
        where.set_title(rf"({letter}) {state.phase}, $\omega$ = {omega:g}, $\xi$ = {x * eta**2:.4g}")
    _draw_legend(figure, (perfect, unfolded), line)
    return Drawing(
        "fig10",
        figure,
        _caption(eta, omega, perfect, unfolded),
        {
            "branches": _branches(perfect),
            "branches_chiral": _branches(unfolded),
            "special_points": _special(((0.0, perfect), (omega, unfolded)), eta),
            "eq64": closed,
            "strains": _strains(along, places),
            "averages": _averages(along, places),
        },
    )


def _eq64(eta: float, highest: float) -> dict[str, list[float]]:
    """Both signs of the twist that eq. (64) gives, at some growths."""
    threshold = float(twist(eta, 0.0).threshold)
    xi = np.linspace(threshold, max(highest, threshold), 7)
    K3 = np.asarray(twist(eta, xi).twisted_curvature())
    return {"xi": np.tile(xi, 2).tolist(), "K3": np.concatenate([K3, -K3]).tolist()}


def _draw_branches(axes: Axes, diagram: Diagram, quantity: str, eta: float) -> None:
    """The branches in the colours of their phases, with where they begin or end to be stable."""
    axes.axhline(0.0, color="0.85", linewidth=0.7, zorder=0.5)
    for line in branch_lines(diagram, quantity):
        for told, points in runs(line):
            style: dict[str, Any] = {"linestyle": STYLES[told], "zorder": 2.0 if told == "stable" else 1.5}
            axes.plot(*points.T, color=PHASES[line.branch.phases[-1]], **style)
        for point in diagram.special_points:
            if point.branch == line.branch.number and point.kind in MARKS:
                height = line.curve.at(point.place, point.parameter)
                axes.plot(point.parameter, height, MARKS[point.kind], color=INK, markersize=3.8, zorder=3.0)
    axes.set(xlim=diagram.span, xlabel=r"edge growth $\xi$")
    axes.margins(y=0.45)
    marked = [point for point in diagram.special_points if point.kind in MARKS]
    # Below and above in turn: neighbours leave no room beside each other.
    for i, point in enumerate(marked):
        place, grows = ((0.03, "bottom"), (0.97, "top"))[i % 2]
        axes.axvline(point.parameter, color="0.8", linewidth=0.6, zorder=0.5)
        name = rf"{point.parameter / eta**2:.4g} $\eta^2$"
        box = {"facecolor": "white", "edgecolor": "none", "pad": 0.4}
        along = axes.get_xaxis_transform()
        style = {"rotation": 90, "ha": "center", "va": grows, "fontsize": 6.5, "bbox": box}
        axes.text(point.parameter, place, name, transform=along, zorder=0.6, **style)


def _draw_along(axes: Axes, state: State) -> None:
    for (name, style), values in zip(CURVATURES.items(), state.strains[:, 1:].T, strict=True):
        axes.plot(state.S, values, label=name, **style)
    axes.set(xlim=(0.0, state.S[-1]), xlabel="$S = X_3/a$", ylabel="curvatures $K_i$")
    axes.margins(y=0.3)
    axes.legend(ncols=3, loc="center right")


def _draw_legend(figure: Figure, diagrams: Sequence[Diagram], closed: Line2D) -> None:
    """What colours, lines and marks mean."""
    present = {branch.phases[-1] for diagram in diagrams for branch in diagram.branches}
    kinds = {point.kind for diagram in diagrams for point in diagram.special_points}
    entries = [
        *(Line2D([], [], color=colour, label=phase) for phase, colour in PHASES.items() if phase in present),
        *(Line2D([], [], color=INK, linestyle=STYLES[told], label=told) for told in ("stable", "unstable")),
        *(
            Line2D([], [], color=INK, linestyle="none", marker=mark, label=kind.replace("_", " "))
            for kind, mark in MARKS.items()
            if kind in kinds
        ),
    ]
    closed.set_label("eq. (64)")
    figure.legend(handles=[*entries, closed], loc="outside upper center", ncols=5)


def _branches(diagram: Diagram) -> dict[str, list[Any]]:
    """All points of all branches; mirror images are left out."""
    table = diagram.table()
    phases = [phase for branch in diagram.branches for phase in branch.phases]
    mirrored = [branch.mirrored for branch in diagram.branches for _ in branch.phases]
    names = ("branch", "eps", "K1", "K2", "K3", "energy", "stable")
    return {
        "xi": table["parameter"],
        "phase": phases,
        "mirrored": mirrored,
        **{name: table[name] for name in names},
    }


def _special(diagrams: Sequence[tuple[float, Diagram]], eta: float) -> dict[str, list[Any]]:
    """Where branches meet and turn back."""
    found = [
        (omega, point.kind, point.branch, point.parameter, point.parameter / eta**2)
        for omega, diagram in diagrams
        for point in diagram.special_points
        if point.kind in MARKS
    ]
    names = ("omega", "kind", "branch", "xi", "xi_over_eta2")
    return {name: [row[k] for row in found] for k, name in enumerate(names)}


def _strains(states: Sequence[State], places: Sequence[float]) -> dict[str, list[Any]]:
    """The strains at the nodes of each ribbon."""
    columns: dict[str, list[Any]] = {
        "xi_over_eta2": [x for x, state in zip(places, states, strict=True) for _ in state.S],
        "S": [S for state in states for S in state.S.tolist()],
    }
    for k, name in enumerate(("eps", "K1", "K2", "K3")):
        columns[name] = [value for state in states for value in state.strains[:, k].tolist()]
    return columns


def _averages(states: Sequence[State], places: Sequence[float]) -> dict[str, list[Any]]:
    """Eq. (70), and by how much the curvatures depart from it."""
    columns: dict[str, list[Any]] = {
        "xi_over_eta2": list(places),
        "phase": [state.phase for state in states],
        "nodes": [state.S.size for state in states],
    }
    for k, name in enumerate(("K1", "K2", "K3"), start=1):
        columns[f"mean_{name}"] = [float(np.mean(state.strains[:, k])) for state in states]
        columns[f"spread_{name}"] = [float(np.ptp(state.strains[:, k])) for state in states]
    return columns


def _caption(eta: float, omega: float, perfect: Diagram, unfolded: Diagram) -> str:
    """What is computed, and what differs from the paper."""
    flat = [point.parameter for point in perfect.special_points if point.kind in MARKS]
    coil = [point.parameter for point in unfolded.special_points if point.kind == "branch_point"]
    onsets = ", ".join(f"xi = {xi:.6g} = {xi / eta**2:.5g} eta^2" for xi in flat) or "none in the diagram"
    coils = f"at xi = {coil[0]:.6g} = {coil[0] / eta**2:.5g} eta^2" if coil else "beyond the diagram"
    low, high = map(edges.chirality_of, edges.PAPER_COILS)
    return (
        f"Fig. 10. Unloaded ribbon of thickness ratio eta = {eta:g} with the edge growth xi (2 X2/a)^2, "
        "full section law, n = m = 0; solid: stable, dashed: unstable; both mirror images. (a), (b) "
        f"Without chirality. Branches leave the flat one at {onsets}: first to bending, which the paper "
        "does not have, then to twist, where it has its first bifurcation (0.05 for eta = 0.1). The "
        "twisted branch is eq. (64) (circles), but it leaves a flat ribbon that is already unstable and "
        "is unstable to bending itself, all along; no branch leaves it, so that its printed equations "
        "have no transition from twisted to helical. (a'), (b') The same with a trace of chirality, g23 + "
        f"g32 = 2 eta omega X1/a with omega = {omega:g}: the ribbon is twisted from the start, and goes "
        f"over to a stable helix {coils}. The paper has that transition at 5.2 to 5.4 eta^2, which would "
        f"take an omega of {low:.3f} to {high:.3f}. The paper does not state a chirality: this is one "
        "possible explanation of its figure, not a reproduction. (c), (d) Strains along two of these "
        "ribbons, solved as boundary-value problems with the ends (68) and N = M = 0 at S = L (printed at "
        "S = 0 in (69)): without load they do not vary along the ribbon, and their averages (70) are "
        "their values."
    )
