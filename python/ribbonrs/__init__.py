"""Equilibrium shapes of thin growing ribbons.

Examples
--------
>>> import ribbonrs as rb
>>> leaf = rb.Ribbon(length=10.0, width=1.0, thickness=0.1)
>>> scene = rb.Scene(leaf, rb.growth.edge(0.06) + rb.growth.chiral(0.04))
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from . import growth
from .ends import Clamped, Closed, Free, Hinged, Pinned, Sliding
from .equilibrium import natural_shapes, solve
from .errors import ConvergenceError, InputError, RibbonError, RibbonWarning
from .frame import integrate_frame
from .growth import Growth
from .helix import Helix
from .law import SectionLaw
from .linear import LinearLaw
from .loads import LineLoad, PointLoad, weight
from .material import Isotropic, MooneyRivlin, Orthotropic
from .ribbon import Ribbon
from .scene import Scene
from .state import State

if TYPE_CHECKING:
    from . import analytic, figures
    from .continuation import trace
    from .deflation import find_states
    from .diagram import Diagram, load_diagram
    from .locus import Locus, trace_locus
    from .parameter import parameters
    from .phasediagram import PhaseDiagram, load_phase_diagram, phase_diagram
    from .validation import validate

__all__ = [
    "Clamped",
    "Closed",
    "ConvergenceError",
    "Diagram",
    "Free",
    "Growth",
    "Helix",
    "Hinged",
    "InputError",
    "Isotropic",
    "LineLoad",
    "LinearLaw",
    "Locus",
    "MooneyRivlin",
    "Orthotropic",
    "PhaseDiagram",
    "Pinned",
    "PointLoad",
    "Ribbon",
    "RibbonError",
    "RibbonWarning",
    "Scene",
    "SectionLaw",
    "Sliding",
    "State",
    "analytic",
    "figures",
    "find_states",
    "growth",
    "integrate_frame",
    "load_diagram",
    "load_phase_diagram",
    "natural_shapes",
    "parameters",
    "phase_diagram",
    "solve",
    "trace",
    "trace_locus",
    "validate",
    "weight",
]


LATER = {
    "Diagram": ".diagram",
    "PhaseDiagram": ".phasediagram",
    "load_diagram": ".diagram",
    "find_states": ".deflation",
    "Locus": ".locus",
    "load_phase_diagram": ".phasediagram",
    "parameters": ".parameter",
    "phase_diagram": ".phasediagram",
    "trace": ".continuation",
    "trace_locus": ".locus",
    "validate": ".validation",
}
"""Names that are loaded when they are first used, from these modules."""


def __getattr__(name: str) -> Any:
    """Load what not every program uses: half of what this package costs to import."""
    if name in ("analytic", "figures"):
        return import_module(f".{name}", __name__)
    if name in LATER:
        return getattr(import_module(LATER[name], __name__), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
