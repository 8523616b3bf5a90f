"""Fig. 3: a growth gradient through the thickness, and the shape it gives."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from ..arrays import Array
from ..check import positive
from .drawing import Drawing
from .given import growths, ratio
from .saddles import READINGS, shape
from .shapes import deflection_scale, draw_grid, view
from .style import COLOURS, INK, WIDTH, new_figure, styled

__all__ = ["fig3"]


@styled
def fig3(eta: float = 0.05, xi: float = 0.3, length: float = 5.0) -> Drawing:
    """Draw the growth g33 = xi X1/a and the ribbon as published, as it is, and of isochoric growth.

    Parameters
    ----------
    eta : float
        Thickness over width.
    xi : float
        Growth gradient.
    length : float
        Of the ribbon, in widths.

    Raises
    ------
    InputError
        A parameter out of range.

    Notes
    -----
    Source: Liu, Li & Liu, Fig. 3 and eqs. (44), (48)-(50).
    """
    eta, (xi,), length = ratio("eta", eta), growths("xi", [xi]), positive("length", length)
    states = [shape(reading, eta, xi, length) for reading in READINGS]
    figure = new_figure(WIDTH, 1.7)
    left, right = figure.subplots(1, 2, width_ratios=[1.0, 3.2])
    height = np.linspace(-0.5, 0.5, 11)
    growth = xi * eta * height
    _draw_gradient(left, height, growth)

    colour = deflection_scale(states)
    boxes = draw_grid(right, [states], colour, view(), gap=(1.2, 1.0))[0]
    right.set_title("(b)")
    for reading, state, box in zip(READINGS, states, boxes, strict=True):
        label = f"{reading}\n$K_2 = {state.strain[2]:.4f}$"
        right.text((box[0] + box[2]) / 2, box[1] - 0.15, label, ha="center", va="top", fontsize=7)
    figure.colorbar(colour, ax=right, shrink=0.85).set_label("deflection $u_1/a$")

    x = np.linspace(-0.5, 0.5, 101)
    caption = (
        "Fig. 3. (a) Growth along the ribbon with a gradient through the thickness, g33 = xi X1/a, "
        f"xi = {xi:g}, eta = {eta:g}. (b) The ribbon, {length:g} widths long, coloured by its deflection "
        "u1/a. Published: eqs. (48)-(50) of Liu, Li & Liu, in which the gradient is missing from the edge "
        "condition of the deflection; (48) is taken less its sign(K2), which would make the deflection even "
        "in K2, and (50) with K2 (K2 + 2 xi) for its root, which is imaginary at this curvature. "
        "Consistent: the same growth with the gradient kept. It is compatible: a cylinder without stress and "
        "deflection, K2 = -xi, and no saddle. Isochoric: with transverse growth g22 = -g33/2, which makes a "
        "saddle; the printed deflection is that of this growth, the printed energy is not."
    )
    tables = {
        "growth": {"X1/h": height.tolist(), "g33": growth.tolist()},
        "deflection": {"x": x.tolist()}
        | {
            f"u1/a {reading}": state.deflection(x)[0].tolist()
            for reading, state in zip(READINGS, states, strict=True)
        },
    }
    return Drawing("fig3", figure, caption, tables)


def _draw_gradient(axes: Axes, height: Array, growth: Array) -> None:
    for level, reach in zip(height, growth, strict=True):
        arrow = {"arrowstyle": "-|>", "color": COLOURS[1], "lw": 0.9, "shrinkA": 0, "shrinkB": 0}
        axes.annotate("", (reach, level), (0.0, level), arrowprops=arrow)
    axes.plot(growth, height, color=COLOURS[1])
    axes.axvline(0.0, color=INK, linewidth=0.7)
    axes.set_xticks([growth[0], 0.0, growth[-1]], [f"{g:g}" for g in (growth[0], 0.0, growth[-1])])
    axes.set(xlabel="growth $g_{33}$", ylabel="$X_1/h$", title="(a)", ylim=(-0.56, 0.56))
    axes.set_yticks([-0.5, 0.0, 0.5])
