"""One style of all figures: readable at the width of a journal's column, and by colour-blind eyes."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import Any, ParamSpec, TypeVar

from cycler import cycler
from matplotlib import style
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

__all__ = ["COLOURS", "COLUMN", "INK", "PAGE", "PHASES", "WIDTH", "new_figure", "styled"]

COLUMN, PAGE = 3.4, 7.0
"""Inches: the widths of a column and of a page."""
WIDTH = 5.0
"""Of the figures of the paper: reduced to a column their text has still five points."""
INK = "0.2"
# Okabe & Ito (2008): told apart by colour-blind eyes.
COLOURS = ("#000000", "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00")
PHASES = {"flat": "0.45", "bent": COLOURS[1], "twisted": COLOURS[2], "helical": COLOURS[3]}
"""The colour of a phase, the same in every figure."""

STYLE: dict[str, Any] = {
    "font.size": 8.0,
    "axes.labelsize": 8.0,
    "axes.titlesize": 8.0,
    "axes.linewidth": 0.7,
    "axes.edgecolor": INK,
    "axes.labelcolor": INK,
    "axes.titlelocation": "left",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.prop_cycle": cycler(color=COLOURS),
    "text.color": INK,
    "xtick.color": INK,
    "ytick.color": INK,
    "xtick.labelsize": 7.0,
    "ytick.labelsize": 7.0,
    "xtick.direction": "in",
    "ytick.direction": "in",
    "legend.fontsize": 7.0,
    "legend.frameon": False,
    "lines.linewidth": 1.3,
    "lines.markersize": 4.5,
    # Text of vector files stays text.
    "pdf.fonttype": 42,
    "svg.fonttype": "none",
}
DPI = 300.0

P = ParamSpec("P")
R = TypeVar("R")


def styled(draw: Callable[P, R]) -> Callable[P, R]:
    """Let a function draw in this style, whatever the user's is."""

    @wraps(draw)
    def in_style(*args: P.args, **kwargs: P.kwargs) -> R:
        with style.context(["default", STYLE]):
            return draw(*args, **kwargs)

    return in_style


def new_figure(width: float, height: float) -> Figure:
    """Return an empty figure of this size in inches, free of pyplot."""
    figure = Figure(figsize=(width, height), dpi=DPI, facecolor="white", layout="constrained")
    FigureCanvasAgg(figure)
    return figure
