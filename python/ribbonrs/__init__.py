"""Equilibrium shapes of thin growing ribbons.

Examples
--------
>>> import ribbonrs as rb
>>> leaf = rb.Ribbon(length=10.0, width=1.0, thickness=0.1)
>>> scene = rb.Scene(leaf, rb.growth.edge(0.06) + rb.growth.chiral(0.04))
"""

from __future__ import annotations

from . import growth
from .ends import Clamped, Free
from .errors import ConvergenceError, InputError, RibbonError, RibbonWarning
from .growth import Growth
from .material import Isotropic, MooneyRivlin, Orthotropic
from .ribbon import Ribbon
from .scene import Scene

__all__ = [
    "Clamped",
    "ConvergenceError",
    "Free",
    "Growth",
    "InputError",
    "Isotropic",
    "MooneyRivlin",
    "Orthotropic",
    "Ribbon",
    "RibbonError",
    "RibbonWarning",
    "Scene",
    "growth",
]
