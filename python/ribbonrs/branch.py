"""A branch of equilibria along a parameter, and the points on it that are special."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _core
from .arrays import Array
from .course import phase_of
from .ends import pose
from .parameter import Parameter
from .quantity import check_quantity, values_of
from .state import State
from .traced import Live, Maker, Source

__all__ = ["ARRAYS", "KINDS", "Branch", "SpecialPoint"]

KINDS = ("fold", "branch_point", "section_instability", "zero", "value", "end")
"""What a point of a branch can be besides an equilibrium."""

ARRAYS = (
    "parameter",
    "strains",
    "energy",
    "load_potential",
    "index",
    "section_index",
    "position",
    "reactions",
)
"""The arrays of a branch."""


@dataclass(frozen=True, eq=False, repr=False)
class Branch:
    """Equilibria that follow from one another as the parameter varies: k points in the order of the branch.

    Attributes
    ----------
    number : int
        Its place in the branches of the diagram.
    parameter : (k,) array
        Between two points it increases or decreases: a fold is a point.
    strains : (k, 4) array
        eps, K1, K2, K3, means over S.
    energy, load_potential : (k,) array
        As of `State`: means over S, in units of Y h a.
    index : (k,) array
        As of `State`; nan where it is not known, inf where a section is unstable.
    section_index : (k,) array of int
        As of `State`.
    position : (k, 3) array
        Of the end S = L, in units of the width.
    reactions : (k, 12) array
        Force and moment at the start, then at the end, that act on the ribbon; in the fixed basis.
    ended : tuple of str
        How its beginning and its end came about: at a limit of the "span", after the allowed "steps", where
        it is "closed" or "joined" another branch, at a "branch point" or a "section instability" from which
        it came or beyond which it was not followed, at the "start" of the trace, or "failed".
    reason : str
        Why it failed, empty if it did not.
    origin : int or None
        The special point of the diagram at which it branches off.
    mirrored : bool
        Whether its mirror images are branches too, which are left out.
    maker, source
        How its states are made.
    """

    number: int
    parameter: Array
    strains: Array
    energy: Array
    load_potential: Array
    index: Array
    section_index: NDArray[np.int64]
    position: Array
    reactions: Array
    ended: tuple[str, str]
    reason: str
    origin: int | None
    mirrored: bool
    maker: Maker
    source: Source

    def __post_init__(self) -> None:
        for name in ARRAYS:
            getattr(self, name).setflags(write=False)

    @classmethod
    def of(cls, number: int, traced: _core.TracedBranch, maker: Maker, natural: bool) -> Branch:
        """Return what the core traced; natural shapes it traces for a section, without the ribbon."""
        parameter = np.array(traced.parameter)
        lengths = 1.0 if natural else _lengths(maker.parameter, parameter)
        return cls(
            number,
            parameter,
            strains=traced.strains + 0.0,  # no negative zeros
            energy=traced.energy / lengths,
            load_potential=traced.load_potential / lengths,
            index=np.array(traced.index),
            section_index=np.array(traced.section_index),
            position=_tips(maker.parameter, parameter, traced.strains) if natural else +traced.position,
            reactions=np.array(traced.reactions),
            ended=traced.ended,
            reason=traced.reason,
            origin=traced.origin,
            mirrored=traced.mirrored,
            maker=maker,
            source=Live(traced),
        )

    def __repr__(self) -> str:
        first, last = self.parameter[[0, -1]]
        ends = " and ".join(self.ended)
        size = self.parameter.size
        return f"Branch({self.number}, {size} points from {first:.6g} to {last:.6g}, ended {ends})"

    @cached_property
    def held(self) -> bool:
        """Whether its states are solutions of boundary-value problems, not natural shapes."""
        return self.source.solution(0) is not None

    @property
    def known(self) -> NDArray[np.bool_]:
        """(k,): whether it is known how many unstable directions there are."""
        return ~np.isnan(self.index)

    @property
    def stable(self) -> NDArray[np.bool_]:
        """(k,): whether the energy is known to be a strict local minimum."""
        stable: NDArray[np.bool_] = self.index == 0.0
        return stable

    @cached_property
    def phases(self) -> tuple[str, ...]:
        """The phase of the state at each point, "curved" if its strains vary along S."""
        if self.held:
            return tuple(self.state(i).phase for i in range(self.parameter.size))
        scenes = (self.maker.parameter.scene(value) for value in self.parameter.tolist())
        return tuple(
            phase_of(strain, scene.ribbon.thickness_ratio)
            for strain, scene in zip(self.strains, scenes, strict=True)
        )

    def values(self, quantity: str) -> Array:
        """Return a quantity at every point, (k,).

        "eps", "K1", "K2", "K3" (means over S), "energy", "load_potential", "total_energy", "position[k]" (at
        S = L), "start.force[k]", "start.moment[k]", "end.force[k]", "end.moment[k]" or "index".

        Raises
        ------
        InputError
            For another name.
        """
        return values_of(self, check_quantity("quantity", quantity))

    def state(self, i: int) -> State:
        """Return the state at point i."""
        i = range(self.parameter.size)[i]
        return self.maker.state(float(self.parameter[i]), self.strains[i], self.source.solution(i))

    def between(self, i: int, fraction: float) -> State:
        """Return a state between points i and i + 1, near this fraction of the way."""
        return self.maker.state(*self.source.between(i, fraction))

    def states_at(self, value: float) -> Iterator[State]:
        """Yield the states at this value of the parameter, in the order of the branch."""
        for i, here in enumerate(self.parameter.tolist()):
            if here == value:
                if not self._repeated(i):
                    yield self.state(i)
            elif i + 1 < self.parameter.size and (here - value) * (self.parameter[i + 1] - value) < 0.0:
                yield self.maker.state(value, *self.source.at_value(i, value)[1:])

    def _repeated(self, i: int) -> bool:
        """Whether the same state is also a point of another branch, or the other end of this one."""
        began, ended = self.ended
        if i == 0:
            return self.origin is not None or began in ("closed", "joined")
        return i == self.parameter.size - 1 and ended == "joined"


@dataclass(frozen=True, eq=False)
class SpecialPoint:
    """A point of a branch at which something happens.

    Attributes
    ----------
    kind : str
        "fold", "branch_point", "section_instability", "zero" (of a function of the state), "value" (one of
        those asked for) or "end".
    parameter : float
        Where.
    multiplicity : int
        How many directions become neutral at once, 1 of a point where none does.
    branch : int
        Number of the branch.
    place : int
        Its point; a zero is between that and the next one.
    name : str
        Of the function; of an "end" how it came about, as in `Branch`.
    reason : str
        Of an end that failed, why.
    """

    kind: str
    parameter: float
    multiplicity: int
    branch: int
    place: int
    name: str = ""
    reason: str = ""
    make: Callable[[], State] | None = field(default=None, repr=False)

    @cached_property
    def state(self) -> State:
        """The state there."""
        assert self.make is not None
        return self.make()


def root(function: Callable[[float], float], ends: tuple[float, float]) -> float:
    """Return where in [0, 1] a function is zero that has values of different signs at 0 and 1."""
    from scipy.optimize import brentq  # type: ignore[import-untyped]  # scipy takes longer than this package

    known = dict(zip((0.0, 1.0), ends, strict=True))

    def value(fraction: float) -> float:
        # Newton's method need not converge at an end: equations are singular at a special point
        return known[fraction] if fraction in known else function(fraction)

    found: Any = brentq(value, 0.0, 1.0, xtol=1e-14, rtol=1e-14)
    return float(found)


def _lengths(parameter: Parameter, values: Array) -> Array:
    """Length over width of the ribbon at each value of the parameter, of which only one changes it."""
    if parameter.name != "ribbon.length":
        return np.full(values.size, parameter.base.ribbon.length_ratio)
    return np.array([parameter.scene(value).ribbon.length_ratio for value in values.tolist()])


def _tips(parameter: Parameter, values: Array, strains: Array) -> Array:
    """Where natural shapes end, (k, 3)."""
    scenes = map(parameter.scene, values.tolist())
    return np.array(
        [
            _core.helix(np.array([scene.ribbon.length_ratio]), strain, *map(np.array, pose(scene.start)))[0][
                0
            ]
            for scene, strain in zip(scenes, strains, strict=True)
        ]
    ).reshape(-1, 3)
