"""The phases of a ribbon over chirality and edge growth, the same map for every thickness."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import PathPatch
from matplotlib.transforms import Affine2D

from ..arrays import Array
from ..phase_plot import region
from ..phasediagram import PhaseDiagram, phase_diagram
from .edges import CHIRAL, EDGE, grown
from .style import INK, PHASES

__all__ = ["draw_phases", "phases_over", "scaled_boundaries"]

ETA = 0.01
"""Of the ribbon that is solved: its growth is small all over the map, and its thickness scales out."""
SCALE = np.array([2.0 * ETA, ETA**2])
POINTS = 81
TINT = 0.25


def phases_over(omega: tuple[float, float], x: tuple[float, float]) -> PhaseDiagram:
    """Return the phases over these spans of omega and xi/eta^2, whose amplitudes are `SCALE` times that."""
    across, up = (np.array(span) * scale for span, scale in zip((omega, x), SCALE, strict=True))
    return phase_diagram(grown(ETA, 0.0, 0.0), (CHIRAL, across), (EDGE, up), n=POINTS, progress=False)


def scaled_boundaries(diagram: PhaseDiagram) -> list[tuple[str, Array]]:
    """Return the boundaries at which a shape becomes unstable: both phases, and points omega, xi/eta^2."""
    return [
        ("/".join(sorted(line.phases)), line.points / SCALE)
        for line in diagram.boundaries
        if line.kind == "instability"
    ]


def draw_phases(axes: Axes, diagram: PhaseDiagram, unit: tuple[float, float] = (1.0, 1.0)) -> None:
    """Draw the regions of phases and the boundaries between them, omega and xi/eta^2 in these units.

    Flat and bent ribbons have no chirality: they are seen as a line at omega = 0.
    """
    scale = np.array(unit) / SCALE
    for phase, colour in PHASES.items():
        path = region(diagram, phase)
        if path is None:
            continue
        shape = path.transformed(Affine2D().scale(*scale))
        if phase in ("flat", "bent"):
            line: dict[str, Any] = {"linewidth": 2.2, "joinstyle": "round", "zorder": 0.7}
            axes.add_patch(PathPatch(shape, facecolor=colour, edgecolor=colour, **line))
        else:
            axes.add_patch(PathPatch(shape, facecolor=colour, alpha=TINT, edgecolor="none", zorder=0.5))
    for _, points in scaled_boundaries(diagram):
        axes.plot(*(points * np.array(unit)).T, color=INK, linewidth=1.0, zorder=0.8)
