"""Fig. 4: the energy of a growth gradient through the thickness, and the curvature of least energy."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from ..analytic import saddle
from ..arrays import Array
from ..check import Numbers
from ..equilibrium import natural_shapes
from ..growth import thickness
from ..law import SectionLaw
from ..ribbon import Ribbon
from .drawing import Drawing
from .given import growths, ratio
from .style import COLOURS, INK, WIDTH, new_figure, styled

__all__ = ["fig4"]

BEYOND = 0.5
"""The energy is drawn as far beyond its least curvature, and beyond zero, as this times that curvature."""


@styled
def fig4(eta: float = 0.05, xi: Numbers = (0.1, 0.2, 0.3)) -> Drawing:
    """Draw the energy over K2 for several growth gradients, and the intrinsic curvature over the gradient.

    Parameters
    ----------
    eta : float
        Thickness over width.
    xi : list of float
        Growth gradients, a curve each; the curvature is drawn up to the largest.

    Raises
    ------
    InputError
        A parameter out of range, or an empty list.

    Notes
    -----
    Source: Liu, Li & Liu, Fig. 4 and eqs. (49), (50).
    """
    eta, xi = ratio("eta", eta), growths("xi", xi)
    most = max(map(abs, xi)) or eta
    figure = new_figure(WIDTH, 2.5)
    parts = figure.subplot_mosaic(
        [["a", "b"], ["a", "c"]], width_ratios=[1.35, 1.0], height_ratios=[1.5, 1.0]
    )
    least, greatest = min(0.0, -max(xi)), max(0.0, -min(xi))
    K2 = np.linspace(least - BEYOND * most, greatest + BEYOND * most, 241)
    energies = _draw_energies(parts["a"], eta, xi, K2)

    gradients = most * np.linspace(0.0, 1.0, 61)[1:]
    curvatures = {
        "published": saddle(eta, gradients, form="published").natural_curvature(),
        "consistent": _natural(eta, gradients),
    }
    _draw_curvatures(parts["b"], parts["c"], gradients, curvatures)
    caption = (
        f"Fig. 4. Growth gradient through the thickness, g33 = xi X1/a, eta = {eta:g}, eps = K1 = K3 = 0. "
        "(a) Energy over K2 and its minima; (b) the intrinsic curvature, where the energy is least, over xi; "
        "(c) their ratio. Published: eqs. (49) and (50) of Liu, Li & Liu with K2 (K2 + 2 xi) for the root in "
        "(50), which is imaginary between -2 xi and 0, where the minimum lies. Consistent: with the gradient "
        "also in the edge condition of the deflection. The curvature is then -xi without energy; as "
        "published it is somewhat more, not quite linear in xi and some energy remains. Both are negative: "
        "the ribbon bends away from its face that grows more."
    )
    tables = {
        "energy": {"K2": K2.tolist()} | energies,
        "curvature": {"xi": gradients.tolist()}
        | {f"K2 {form}": values.tolist() for form, values in curvatures.items()},
    }
    return Drawing("fig4", figure, caption, tables)


def _draw_energies(axes: Axes, eta: float, xi: tuple[float, ...], K2: Array) -> dict[str, list[float]]:
    strains = np.zeros((K2.size, 4))
    strains[:, 2] = K2
    columns: dict[str, list[float]] = {}
    for i, g in enumerate(xi):
        colour = COLOURS[(i + 1) % len(COLOURS)]
        printed = saddle(eta, g, form="published")
        published, lowest = printed.energy(K2), printed.natural_curvature()
        consistent = SectionLaw(eta, thickness(g)).energy(strains)
        axes.plot(K2, published, "--", color=colour, linewidth=1.0)
        axes.plot(K2, consistent, color=colour, label=rf"$\xi$ = {g:g}")
        axes.plot(lowest, printed.energy(lowest), "o", color=colour, markerfacecolor="white")
        state = natural_shapes(Ribbon(1.0, 1.0, eta), thickness(g))[0]
        axes.plot(state.strain[2], state.energy, "o", color=colour)
        columns |= {
            f"Pi published xi={g:g}": published.tolist(),
            f"Pi consistent xi={g:g}": consistent.tolist(),
        }
    axes.plot([], [], "--o", color=INK, markerfacecolor="white", linewidth=1.0, label="published")
    axes.plot([], [], "-o", color=INK, label="consistent")
    axes.ticklabel_format(axis="y", scilimits=(0, 0), useMathText=True)
    axes.set(xlabel="$K_2$", ylabel=r"energy $\Pi$", title="(a)", xlim=(K2[0], K2[-1]))
    axes.legend(loc="upper center", handlelength=1.5, labelspacing=0.3)
    return columns


def _natural(eta: float, xi: Array) -> Array:
    shapes = natural_shapes(Ribbon(1.0, 1.0, eta), [thickness(g) for g in xi.tolist()])
    return np.array([states[0].strain[2] for states in shapes])


def _draw_curvatures(axes: Axes, below: Axes, xi: Array, curvatures: dict[str, Array]) -> None:
    for (form, values), line in zip(curvatures.items(), ("--", "-"), strict=True):
        axes.plot(xi, values, line, color=INK, label=form)
        below.plot(xi, -values / xi, line, color=INK)
    axes.set(ylabel=r"$\hat K_2$", title="(b)", xlim=(0.0, xi[-1]))
    axes.legend(loc="lower left")
    axes.tick_params(labelbottom=False)
    below.set(xlabel=r"$\xi$", ylabel=r"$-\hat K_2/\xi$", title="(c)", xlim=(0.0, xi[-1]))
    below.ticklabel_format(axis="y", useOffset=False)
