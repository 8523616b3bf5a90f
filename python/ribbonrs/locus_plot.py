"""The figure of a curve of special points."""

from __future__ import annotations

from os import PathLike
from typing import TYPE_CHECKING

from .plot import INK, write
from .quantity import parameter_label

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from .locus import Locus

__all__ = ["plot"]


def plot(locus: Locus, path: str | PathLike[str] | None = None) -> Figure:
    """Draw the curve in the plane of its parameters; write the figure to `path` if given."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(4.5, 3.6), layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.add_subplot()
    axes.plot(locus.values[:, 1], locus.values[:, 0], color=INK, linewidth=1.6)
    axes.set_title(locus.kind.replace("_", " "), fontsize=9, color=INK)
    first, second = (parameter_label(name) for name in locus.parameters)
    axes.set(xlabel=second.replace("\n", " "), ylabel=first)
    axes.spines[["top", "right"]].set_visible(False)
    if path is not None:
        write(figure, path)
    return figure
