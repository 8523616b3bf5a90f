"""A problem to solve: a ribbon, its growth, and what its ends are held by."""

from __future__ import annotations

import warnings
from dataclasses import dataclass, field
from functools import cached_property
from typing import cast

import numpy as np

from .ends import Clamped, Free
from .errors import InputError, RibbonWarning
from .growth import FIELDS, Growth
from .pieces import Pieces, grid
from .ribbon import Ribbon

__all__ = ["LAWS", "Scene"]

LAWS = ("full", "quadratic")
"""Section laws: the relaxed cross-section, and its second-order expansion in K2."""

GROWTH_LIMIT = 0.5
GROWTH_WARNING = 0.1

_SOLVABLE = "this version solves an unloaded ribbon clamped at its start with a free end"


@dataclass(frozen=True)
class Scene:
    """A ribbon that grows, clamped at its start and free at its end.

    Parameters
    ----------
    ribbon : Ribbon
        Dimensions and material.
    growth : Growth
        Samples along the ribbon cover it.
    start : Clamped
        Any position and orientation; default the origin, along E3.
    end : Free
        Without load.
    law : str
        "full", or "quadratic" for the second-order expansion in K2 (Liu, Li & Liu, eq. (59)), which takes
        edge growth and chirality only.

    Raises
    ------
    InputError
        If an argument is not what is said above, samples of growth do not cover the ribbon, or a growth
        strain exceeds 0.5.

    Warns
    -----
    RibbonWarning
        If a growth strain exceeds 0.1: the theory is for small growth.
    """

    ribbon: Ribbon
    growth: Growth
    start: Clamped = field(default_factory=Clamped)
    end: Free = field(default_factory=Free)
    law: str = "full"

    def __post_init__(self) -> None:
        if not isinstance(self.ribbon, Ribbon):
            raise InputError("ribbon", self.ribbon, "a Ribbon")
        if not isinstance(self.growth, Growth):
            raise InputError("growth", self.growth, "a Growth, such as growth.edge(0.06)")
        if not isinstance(self.start, Clamped):
            raise InputError("start", self.start, f"Clamped: {_SOLVABLE}")
        if not isinstance(self.end, Free):
            raise InputError("end", self.end, f"Free: {_SOLVABLE}")
        for name in ("force", "moment"):
            if any(getattr(self.end, name)):
                raise InputError(f"end.{name}", getattr(self.end, name), f"zero: {_SOLVABLE}")
        if not isinstance(self.law, str) or self.law not in LAWS:
            raise InputError("law", self.law, f"one of {', '.join(LAWS)}")
        self._check_growth()

    @cached_property
    def growth_size(self) -> float:
        """The largest growth strain in the ribbon, gradients taken at the faces of its thickest section."""
        ribbon = self.ribbon
        thickest = 1.0 if ribbon.thickness_pieces is None else _largest(ribbon.thickness_pieces)
        return self.growth.size(ribbon.thickness_ratio * thickest, ribbon.length_ratio)

    def _check_growth(self) -> None:
        self.growth.check_covers(self.ribbon.length_ratio)
        if _surely_small(self.growth, self.ribbon):
            return
        size = self.growth_size
        if not size <= GROWTH_LIMIT:  # also true of NaN, where huge terms cancel
            expected = f"at most {GROWTH_LIMIT}, since the theory is for small growth"
            raise InputError("growth.size", size, expected)
        if size > GROWTH_WARNING:
            message = f"growth.size = {size:.3g}: the theory is for growth small against 1"
            warnings.warn(message, RibbonWarning, stacklevel=4)


def _surely_small(growth: Growth, ribbon: Ribbon) -> bool:
    """Whether the coefficients alone tell that growth is no reason to warn: much cheaper than its size."""
    if growth.varies or ribbon.thickness_pieces is not None:
        return False
    bounds = dict.fromkeys(FIELDS, 0.0)
    for term in growth.terms:
        for key, shape in term.shape:
            if not isinstance(shape, tuple):
                return False
            lever = ribbon.thickness_ratio / 2 if key.startswith("d") else 1.0
            largest = sum(abs(c) * 0.5**k for k, c in enumerate(shape))  # |x| <= 1/2
            bounds[key] += lever * largest * abs(cast(float, term.amplitude))
    return max(bounds.values()) <= GROWTH_WARNING


def _largest(factor: Pieces) -> float:
    """The largest value, on points that miss at most 2 % of it."""
    S, breaks = grid([factor], factor.domain, factor.degree, density=8)
    return float(np.max(np.concatenate([factor.evaluate(S), factor.evaluate(breaks, left=True)])))
