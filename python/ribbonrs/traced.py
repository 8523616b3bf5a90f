"""The states along a branch: made by the core that traced it, or from what a file kept of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from . import _core
from .arrays import Array
from .boundary import state_of
from .course import phase_of
from .equilibrium import uniform_states
from .errors import InputError
from .parameter import Parameter
from .problem import problem_of
from .state import State

__all__ = ["Kept", "Live", "Maker", "Source"]


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
            [phase_of(strains, scene.ribbon.thickness_ratio)],
            np.ones(1, dtype=np.bool_),
        )
        nodes = np.linspace(0.0, scene.ribbon.length_ratio, self.n)
        nodes.setflags(write=False)
        return uniform_states(scene, core, nodes, found)[0]


Between: TypeAlias = tuple[float, Array, _core.BoundarySolution | None]
"""Parameter, strains (4,) and solution of an equilibrium; None is the solution of natural shapes."""


@dataclass(frozen=True)
class Live:
    """A branch that the core has just traced."""

    branch: _core.TracedBranch

    def solution(self, i: int) -> _core.BoundarySolution | None:
        """Return the solution at point i; None of a natural shape."""
        return self.branch.solution(i)

    def between(self, i: int, fraction: float) -> Between:
        """Return what is between points i and i + 1."""
        return self.branch.between(i, fraction)

    def at_value(self, i: int, value: float) -> Between:
        """Return what is between points i and i + 1 at a value of the parameter."""
        return self.branch.at_value(i, value)


@dataclass(frozen=True)
class Kept:
    """A branch from a file: the parts of the solution at each point, None of a branch of natural shapes."""

    parameter: Parameter
    values: Array
    parts: Sequence[_core._Parts] | None

    def solution(self, i: int) -> _core.BoundarySolution | None:
        """Return the solution at point i; None of a natural shape."""
        if self.parts is None:
            return None
        return problem_of(self.parameter.scene(float(self.values[i]))).restored(self.parts[i])

    def between(self, i: int, fraction: float) -> Between:
        """There is nothing between the points: an error that says so."""
        expected = "a point of a branch, since a diagram from a file has nothing between them"
        raise InputError("state", f"between points {i} and {i + 1}", expected)

    def at_value(self, i: int, value: float) -> Between:
        """There is nothing between the points: an error that says so."""
        return self.between(i, value)


Source: TypeAlias = Live | Kept
"""Where the states of a branch come from."""
