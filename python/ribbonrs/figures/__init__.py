"""The figures of Liu, Li & Liu's paper, drawn from its equations and from what they really give.

Each function draws one figure of "Morphoelastic ribbons: Differential growth-induced curvature and torsion"
with the paper's parameters, which are free to change, and returns a `Drawing`: the figure, a caption that
says which law, which conditions and what differs from the paper, and the data.
"""

from __future__ import annotations

from collections.abc import Callable

from .drawing import Drawing

__all__ = ["FIGURES", "Drawing"]

FIGURES: dict[str, Callable[..., Drawing]] = {}
"""Every figure by its name, in the order of the paper."""
