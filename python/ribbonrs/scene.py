"""A problem to solve: a ribbon, its growth, its loads, and what its ends are held by."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import cast

import numpy as np

from . import conditions
from .check import Numbers, Vector, load_vector
from .ends import Clamped, Closed, End, Free, Hinged, Pinned, Start
from .errors import InputError, RibbonWarning
from .growth import FIELDS, Growth
from .law import SectionLaw
from .linear import LinearLaw
from .loads import Load
from .pieces import Pieces, grid
from .ribbon import Ribbon

__all__ = ["LAWS", "Scene"]

LAWS = ("full", "quadratic", "linear")
"""Section laws: the relaxed cross-section, its second-order expansion in K2, and constant stiffnesses."""

UNGROWN, UPRIGHT, UNLOADED = Growth(()), Clamped(), Free()
"""What a scene has if nothing is said."""

GROWTH_LIMIT = 0.5
GROWTH_WARNING = 0.1


@dataclass(frozen=True, init=False)
class Scene:
    """A ribbon that grows, loaded and held at its ends.

    Parameters
    ----------
    ribbon : Ribbon
        Dimensions and material.
    growth : Growth, optional
        Samples along the ribbon cover it. None is no growth.
    start : Clamped, Free, Pinned, Hinged, Sliding or Closed
        Where nothing else is said it is at the origin, along E3, which is also the default.
    end : Clamped, Free, Pinned, Hinged or Sliding, optional
        Where nothing else is said it is where the straight ungrown ribbon ends. None is free, or for a start
        that is Closed nothing at all.
    gravity : sequence of 3 float
        Dead force per unit S, in units of Y h a; see `weight`.
    loads : sequence of PointLoad or LineLoad
        They add.
    law : str or LinearLaw
        "full"; "quadratic" for the second-order expansion in K2 (Liu, Li & Liu, eq. (59)), which takes
        edge growth and chirality only; "linear" for the stiffnesses of the section before growth and natural
        strains that are linear in the growth; or a `LinearLaw` of a ribbon that does not grow.

    Raises
    ------
    InputError
        If an argument is not what is said above, samples do not cover the ribbon, a growth strain exceeds
        0.5, a load is not on the ribbon, the ends are farther apart than it reaches, or ends and loads leave
        it free to move or to turn.

    Warns
    -----
    RibbonWarning
        If a growth strain exceeds 0.1: the theory is for small growth.
    """

    ribbon: Ribbon
    growth: Growth
    start: Start
    end: End
    gravity: Vector
    loads: tuple[Load, ...]
    law: str | LinearLaw

    def __init__(
        self,
        ribbon: Ribbon,
        growth: Growth | None = None,
        start: Start | None = None,
        end: End | None = None,
        gravity: Numbers = UNLOADED.force,
        loads: Sequence[Load] = (),
        law: str | LinearLaw = "full",
    ) -> None:
        arguments = {
            "ribbon": ribbon,
            "growth": UNGROWN if growth is None else growth,
            "start": UPRIGHT if start is None else start,
            "end": UNLOADED if end is None else end,
            "gravity": gravity if gravity is UNLOADED.force else load_vector("gravity", gravity),
            "loads": tuple(loads) if isinstance(loads, list | tuple) else loads,
            "law": law,
        }
        for name, value in arguments.items():
            object.__setattr__(self, name, value)
        self._check_kinds()
        self._check_growth()
        conditions.check_loads(self)
        conditions.check_held(self)
        conditions.check_reach(self)
        conditions.check_closed(self)

    def _check_kinds(self) -> None:
        if not isinstance(self.ribbon, Ribbon):
            raise InputError("ribbon", self.ribbon, "a Ribbon")
        if not isinstance(self.growth, Growth):
            raise InputError("growth", self.growth, "a Growth, such as growth.edge(0.06)")
        if not isinstance(self.start, Start):
            raise InputError("start", self.start, "Clamped, Free, Pinned, Hinged, Sliding or Closed")
        if isinstance(self.end, Closed):
            raise InputError("end", self.end, "nothing: a closed ribbon has start=Closed() alone")
        if not isinstance(self.end, End):
            raise InputError("end", self.end, "Clamped, Free, Pinned, Hinged or Sliding")
        if isinstance(self.start, Closed) and self.end != UNLOADED:
            raise InputError("end", self.end, "nothing: a closed ribbon has no ends")
        if not isinstance(self.loads, tuple):
            raise InputError("loads", self.loads, "a list of PointLoad and LineLoad")
        for i, load in enumerate(self.loads):
            if not isinstance(load, Load):
                raise InputError(f"loads[{i}]", load, "a PointLoad or a LineLoad")
        if isinstance(self.law, LinearLaw):
            self._check_linear()
        elif not isinstance(self.law, str) or self.law not in LAWS:
            raise InputError("law", self.law, f"one of {', '.join(LAWS)}, or a LinearLaw")

    def _check_linear(self) -> None:
        """A linear law of its own knows neither growth nor how the section varies."""
        if self.growth.terms and self.growth_size != 0.0:
            raise InputError("growth", self.growth, "none with a LinearLaw, whose intrinsic= says the same")
        for name in ("width_profile", "thickness_profile"):
            if getattr(self.ribbon, name) is not None:
                raise InputError(f"ribbon.{name}", getattr(self.ribbon, name), "none with a LinearLaw")

    @property
    def loaded(self) -> bool:
        """Whether there is more than growth: a boundary-value problem, not natural shapes."""
        hangs_free = isinstance(self.start, Clamped) and self.end == UNLOADED
        natural = self.law in ("full", "quadratic")
        return not (hangs_free and natural) or any(self.gravity) or any(load.acts for load in self.loads)

    @property
    def places(self) -> tuple[Vector, Vector]:
        """Where the two ends are held, or lie in the straight ungrown ribbon."""
        held = (
            end.position if isinstance(end, Clamped | Pinned | Hinged) else None
            for end in (self.start, self.end)
        )
        start, end = held
        return start or (0.0, 0.0, 0.0), end or (0.0, 0.0, self.ribbon.length_ratio)

    @property
    def section_law(self) -> SectionLaw:
        """The law of each section, for "linear" the full one; an `InputError` for a `LinearLaw`."""
        if isinstance(self.law, LinearLaw):
            raise InputError("law", self.law, "a law of sections that relax: full, quadratic or linear")
        form = "full" if self.law == "linear" else self.law
        return SectionLaw.of(self.ribbon, self.growth, form)

    @cached_property
    def growth_size(self) -> float:
        """The largest growth strain in the ribbon, gradients taken at the faces of its thickest section."""
        ribbon = self.ribbon
        thickest = 1.0 if ribbon.thickness_pieces is None else _largest(ribbon.thickness_pieces)
        return self.growth.size(ribbon.thickness_ratio * thickest, ribbon.length_ratio)

    @property
    def grows_little(self) -> bool:
        """Whether coefficients alone tell that growth is no reason to warn: much cheaper than its size."""
        if self.growth.varies or self.ribbon.thickness_pieces is not None:
            return False
        bounds = dict.fromkeys(FIELDS, 0.0)
        for term in self.growth.terms:
            for key, shape in term.shape:
                if not isinstance(shape, tuple):
                    return False
                lever = self.ribbon.thickness_ratio / 2 if key.startswith("d") else 1.0
                largest = sum(abs(c) * 0.5**k for k, c in enumerate(shape))  # |x| <= 1/2
                bounds[key] += lever * largest * abs(cast(float, term.amplitude))
        return max(bounds.values()) <= GROWTH_WARNING

    def _check_growth(self) -> None:
        self.growth.check_covers(self.ribbon.length_ratio)
        if self.grows_little:
            return
        size = self.growth_size
        if not size <= GROWTH_LIMIT:  # also true of NaN, where huge terms cancel
            expected = f"at most {GROWTH_LIMIT}, since the theory is for small growth"
            raise InputError("growth.size", size, expected)
        if size > GROWTH_WARNING:
            message = f"growth.size = {size:.3g}: the theory is for growth small against 1"
            warnings.warn(message, RibbonWarning, stacklevel=3)


def _largest(factor: Pieces) -> float:
    """The largest value, on points that miss at most 2 % of it."""
    S, breaks = grid([factor], factor.domain, factor.degree, density=8)
    return float(np.max(np.concatenate([factor.evaluate(S), factor.evaluate(breaks, left=True)])))
