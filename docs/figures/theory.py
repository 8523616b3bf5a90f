"""The directors on a ribbon, and deflections of bent sections: the figure of docs/theory.md."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import ribbonrs as rb
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from numpy.typing import NDArray
from ribbonrs.figures.style import COLOURS, INK, PAGE, new_figure, styled

Array = NDArray[np.float64]
# Parallel projection: where the eye's right and up are, in the fixed basis.
RIGHT = np.array([0.0, -0.5, 0.87])
UP = np.array([0.8, -0.5, -0.25])
ETA = 0.1


def flat(points: Array) -> Array:
    """Points (..., 3) in the plane of the picture (..., 2)."""
    right = RIGHT / np.linalg.norm(RIGHT)
    up = UP - (UP @ right) * right
    return np.stack([points @ right, points @ up / np.linalg.norm(up)], axis=-1)


def draw_frame(axes: Axes) -> None:
    """A helical leaf with its centreline and its directors at three stations."""
    growth = rb.growth.edge(0.06) + rb.growth.chiral(0.04)
    leaf = rb.solve(rb.Scene(rb.Ribbon(6.0, 1.0, ETA), growth))
    S = np.linspace(0.0, 6.0, 121)
    surface = leaf.surface(nx=21, S=S)
    outline = np.concatenate([surface[:, 0], surface[-1], surface[::-1, -1], surface[0, ::-1]])
    axes.add_collection(PolyCollection([flat(outline)], facecolor="0.9", edgecolor="0.45", linewidth=0.8))
    for station in np.linspace(0.0, 6.0, 7):
        axes.plot(*flat(leaf.surface(nx=21, S=[station])[0]).T, color="0.75", linewidth=0.6)
    centre = leaf.at(S).position
    axes.plot(*flat(centre).T, color=INK, linewidth=1.0)
    for station in (0.0, 2.5, 5.0):
        there = leaf.at(station)
        start = flat(there.position)
        for i, (d, colour) in enumerate(zip(there.directors, COLOURS[1:4], strict=True)):
            tip = flat(there.position + 0.7 * d)
            arrow = {"arrowstyle": "->", "color": colour, "linewidth": 1.3, "shrinkA": 0.0, "shrinkB": 0.0}
            axes.annotate("", tip, start, arrowprops=arrow, annotation_clip=False)
            if station == 0.0:
                name = tip + 0.16 * (tip - start) / np.linalg.norm(tip - start)
                axes.text(*name, f"$d_{i + 1}$", color=colour, ha="center", va="center")
    axes.set_aspect("equal")
    axes.set_axis_off()
    axes.autoscale_view()


def draw_deflections(axes: Axes) -> None:
    """U/K2 of an ungrown ribbon over the width, for curvatures from small to large."""
    law = rb.SectionLaw(ETA, rb.growth.edge(0.0))
    x = np.linspace(-0.5, 0.5, 401)
    for k2, style, colour in ((0.1, "-", 0), (5.0, "--", 1), (20.0, "-.", 2), (100.0, ":", 3)):
        K2 = k2 * ETA
        label = rf"$K_2 = {k2:g}\,\eta$"
        axes.plot(x, law.deflection([0.0, 0.0, K2, 0.0], x) / K2, style, color=COLOURS[colour], label=label)
    axes.axhline(0.0, color="0.8", linewidth=0.6, zorder=0)
    axes.set(xlabel="across the width, $x$", ylabel="$U/K_2$", xlim=(-0.5, 0.5))
    axes.legend(loc="lower center")


@styled
def main() -> None:
    """Draw the figure beside this file."""
    figure = new_figure(PAGE, 2.6)
    left, right = figure.subplots(1, 2, width_ratios=(1.2, 1.0))
    draw_frame(left)
    draw_deflections(right)
    figure.savefig(Path(__file__).with_suffix(".png"), dpi=200)


if __name__ == "__main__":
    main()
