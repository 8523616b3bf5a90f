"""The states along a branch: made by the core that traced it, or from what a file kept of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from . import _core
from .arrays import Array
from .boundary import state_of
from .equilibrium import uniform_states
from .errors import InputError
from .parameter import Parameter
from .problem import problem_of
from .state import State

__all__ = ["Kept", "Live", "Maker", "States", "natural_phase"]

SMALL_CURVATURE = 1e-6
"""Curvatures up to this times the thickness ratio have no name."""


@dataclass(frozen=True)
class Maker:
    """How to make states of a scene with some value of its parameter: n nodes, solved to `tol`."""

    parameter: Parameter
    tol: float
    n: int

    def state(self, value: float, strains: Array, solution: _core.BoundarySolution | None) -> State:
        """Return the state of this solution; without one it is a natural shape, which strains (4,) say."""
        scene = self.parameter.scene(value)
        if solution is not None:
            return state_of(scene, solution, self.tol, self.n)
        core = scene.section_law.core()
        strain = strains[None].copy()
        negative = np.linalg.eigvalsh(core.hessian(strain)) < 0.0
        found = (
            strain,
            core.energy(strain),
            np.count_nonzero(negative, axis=1),
            [natural_phase(strains, scene.ribbon.thickness_ratio)],
            np.ones(1, dtype=np.bool_),
        )
        nodes = np.linspace(0.0, scene.ribbon.length_ratio, self.n)
        nodes.setflags(write=False)
        return uniform_states(scene, core, nodes, found)[0]


@dataclass(frozen=True)
class Live:
    """A branch that the core has just traced."""

    maker: Maker
    branch: _core.TracedBranch

    @property
    def held(self) -> bool:
        """Whether its states are solutions of boundary-value problems."""
        return self.branch.solution(0) is not None

    def solution(self, i: int) -> _core.BoundarySolution | None:
        """Return the solution at point i; None of a natural shape."""
        return self.branch.solution(i)

    def value_between(self, i: int, fraction: float) -> float:
        """Return the parameter between points i and i + 1 of the branch."""
        return self.branch.between(i, fraction)[0]

    def between(self, i: int, fraction: float) -> State:
        """Return the state between points i and i + 1 of the branch."""
        return self.maker.state(*self.branch.between(i, fraction))


@dataclass(frozen=True)
class Kept:
    """A branch from a file: the solutions at its points in parts, None of natural shapes."""

    maker: Maker
    values: Array
    parts: Sequence[_core._Parts] | None

    @property
    def held(self) -> bool:
        """Whether its states are solutions of boundary-value problems."""
        return self.parts is not None

    def solution(self, i: int) -> _core.BoundarySolution | None:
        """Return the solution at point i; None of a natural shape."""
        if self.parts is None:
            return None
        return problem_of(self.maker.parameter.scene(float(self.values[i]))).restored(self.parts[i])

    def value_between(self, i: int, fraction: float) -> float:
        """There is none: an error that says so."""
        expected = "the parameter at a point of a branch: a diagram from a file has nothing between points"
        raise InputError("value", float((1.0 - fraction) * self.values[i] + fraction * self.values[i + 1]), expected)

    def between(self, i: int, fraction: float) -> State:
        """There is none: an error that says so."""
        self.value_between(i, fraction)
        raise AssertionError


States: TypeAlias = Live | Kept
"""Where the states of a branch come from."""


def natural_phase(strain: Array, thickness_ratio: float) -> str:
    """Return the name of a shape of these strains (4,), by K2 and K3 as in `State`."""
    bent, twisted = np.abs(strain[2:]) > SMALL_CURVATURE * thickness_ratio
    return ("helical" if twisted else "bent") if bent else ("twisted" if twisted else "flat")
