"""The figures of Liu, Li & Liu's paper, drawn from its equations and from what they really give.

Each function draws one figure of "Morphoelastic ribbons: Differential growth-induced curvature and torsion"
with the paper's parameters, which are free to change, and returns a `Drawing`: the figure, a caption that
says which law, which conditions and what differs from the paper, and the data.
"""

from __future__ import annotations

from collections.abc import Callable

from .drawing import Drawing
from .fig3 import fig3
from .fig4 import fig4
from .fig5 import fig5
from .fig6 import fig6
from .fig7_8 import fig7, fig8
from .fig9 import fig9
from .fig10 import fig10
from .fig11 import fig11
from .fig12 import fig12
from .phase_plane import phase_plane

__all__ = [
    "FIGURES",
    "Drawing",
    "fig3",
    "fig4",
    "fig5",
    "fig6",
    "fig7",
    "fig8",
    "fig9",
    "fig10",
    "fig11",
    "fig12",
    "phase_plane",
]

FIGURES: dict[str, Callable[..., Drawing]] = {
    "fig3": fig3,
    "fig4": fig4,
    "fig5": fig5,
    "fig6": fig6,
    "fig7": fig7,
    "fig8": fig8,
    "fig9": fig9,
    "fig10": fig10,
    "fig11": fig11,
    "fig12": fig12,
    "phase_plane": phase_plane,
}
"""Every figure by its name, in the order of the paper."""
