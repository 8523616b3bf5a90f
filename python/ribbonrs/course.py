"""How the strains of a state run along the ribbon: the same everywhere, along a branch, or as loads ask."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from functools import cached_property
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from . import _core
from .arrays import Array
from .errors import InputError
from .helix import Helix, helix_of
from .problem import problem_of
from .scene import Scene

__all__ = ["Along", "Course", "Held", "Points", "Uniform", "phase_of"]

SMALL_CURVATURE, SMALL_STRAIN = 1e-6, 1e-9
"""Curvatures up to this times the thickness ratio, and axial strains up to this, do not differ."""


class Points(NamedTuple):
    """What is known at m places; `force` and `moment` on the directors."""

    strains: Array
    position: Array
    quaternion: Array
    force: Array
    moment: Array


class Uniform:
    """The same strains (4,) everywhere, because the ribbon is the same: an exact helix."""

    uniform = True

    def __init__(self, strain: Array) -> None:
        self.strain = strain

    def strains(self, S: Array) -> Array:
        """Return the strains at S (m,), in any order: array (m, 4)."""
        return np.tile(self.strain, (S.size, 1))

    def points(self, S: Array, position: Array, quaternion: Array) -> Points:
        """Return all there is at S (m,), in any order, from the pose at S = 0 if the start is clamped."""
        poses = _core.helix(S, self.strain, position, quaternion)
        return Points(self.strains(S), *poses, np.zeros((S.size, 3)), np.zeros((S.size, 3)))

    def sections(self, S: Array) -> list[tuple[Array, float | None]]:
        """Return strains (4,) and S of each cross-section at S (m,); here one, without S: all are alike."""
        return [(self.strain, None)]

    def turns(self, S: Array) -> Array:
        r"""Return the turns of the directors from 0 to S (m,), the integral of \|K\|/(2 pi)."""
        return np.asarray(S * (math.hypot(*self.strain[1:]) / (2.0 * math.pi)))

    def helix(self, length: float, thickness_ratio: float) -> Helix | None:
        """Return the helix of the centreline."""
        return helix_of(self.strain, length, thickness_ratio)


class _Varying(ABC):
    """Strains that vary with S in [0, `length`]; methods as `Uniform`."""

    length: float

    @property
    @abstractmethod
    def breaks(self) -> Array:
        """Where the elements meet."""

    @abstractmethod
    def strains(self, S: Array) -> Array:
        """Return the strains, where they jump those to the right."""

    def sections(self, S: Array) -> list[tuple[Array, float | None]]:
        """Return the strains and S of every one."""
        return list(zip(self.strains(S), S.tolist(), strict=True))

    def turns(self, S: Array) -> Array:
        """Return the turns, as drawings need them: by the trapezoidal rule."""
        places, turns = self._turns
        return np.interp(S, places, turns)

    @cached_property
    def _turns(self) -> tuple[Array, Array]:
        places = np.union1d(self.breaks, np.linspace(0.0, self.length, 1001))
        rate = np.linalg.norm(self.strains(places)[:, 1:], axis=1) / (2.0 * math.pi)
        steps = np.diff(places) * (rate[1:] + rate[:-1]) / 2.0
        return places, np.concatenate([[0.0], np.cumsum(steps)])


class Along(_Varying):
    """Strains along a branch of natural shapes."""

    uniform = False

    def __init__(self, branch: _core.NaturalBranch, length: float) -> None:
        self.branch = branch
        self.length = length

    @property
    def breaks(self) -> Array:
        """Where the elements meet."""
        return self.branch.breaks

    @property
    def strain(self) -> Array:
        """There is none: an error that says what to use instead."""
        raise _no_strain()

    def strains(self, S: Array) -> Array:
        """Return the strains, where they jump those to the right."""
        return self.branch.strains(S) + 0.0  # no negative zeros

    def points(self, S: Array, position: Array, quaternion: Array) -> Points:
        """Return all there is at S (m,)."""
        order = np.argsort(S)
        back = np.empty_like(order)
        back[order] = np.arange(order.size)
        positions, quaternions = self.branch.poses(S[order], position, quaternion)
        poses = positions[back], quaternions[back]
        return Points(self.strains(S), *poses, np.zeros((S.size, 3)), np.zeros((S.size, 3)))

    def helix(self, length: float, thickness_ratio: float) -> Helix | None:
        """Return None: the centreline is no helix."""
        return None


class Held(_Varying):
    """Strains that loads and ends ask for: the solution of a boundary-value problem."""

    def __init__(self, solution: _core.BoundarySolution, scene: Scene) -> None:
        self.solution = solution
        self.scene = scene
        self.length = scene.ribbon.length_ratio

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle the numbers of the solution: the core's problem follows from the scene."""
        return _restored, (self.scene, self.solution.parts())

    @property
    def breaks(self) -> Array:
        """Where the elements meet."""
        return self.solution.breaks

    @cached_property
    def uniform(self) -> bool:
        """Whether the strains are the same all along, to the tolerances by which phases are named."""
        curvature = SMALL_CURVATURE * self.scene.ribbon.thickness_ratio
        return self.solution.is_uniform((SMALL_STRAIN, curvature, curvature, curvature))

    @cached_property
    def phase(self) -> str:
        """The name of the shape by K2 and K3, as of natural shapes; "curved" if it is not uniform."""
        if not self.uniform:
            return "curved"
        return phase_of(self.strain, self.scene.ribbon.thickness_ratio)

    @cached_property
    def strain(self) -> Array:
        """The strains (4,) where they are the same all along, else an error."""
        if not self.uniform:
            raise _no_strain()
        strain: Array = self.strains(np.zeros(1))[0]
        strain.setflags(write=False)
        return strain

    def strains(self, S: Array) -> Array:
        """Return the strains, at a point load those to the right."""
        return self.solution.at(S)[0] + 0.0  # no negative zeros

    def points(self, S: Array, position: Array, quaternion: Array) -> Points:
        """Return all there is at S (m,); the pose at S = 0 is part of the solution."""
        strains, *rest = self.solution.at(S)
        return Points(strains + 0.0, *rest)

    def helix(self, length: float, thickness_ratio: float) -> Helix | None:
        """Return the helix of the centreline if the strains are the same all along."""
        return helix_of(self.strain, length, thickness_ratio) if self.uniform else None


Course: TypeAlias = Uniform | Along | Held
"""How the strains of a state run along the ribbon."""


def phase_of(strain: Array, thickness_ratio: float) -> str:
    """Return the name of a shape of the same strains (4,) everywhere, by K2 and K3."""
    bent, twisted = np.abs(strain[2:]) > SMALL_CURVATURE * thickness_ratio
    return ("helical" if twisted else "bent") if bent else ("twisted" if twisted else "flat")


def _restored(scene: Scene, parts: _core._Parts) -> Held:
    return Held(problem_of(scene).restored(parts), scene)


def _no_strain() -> InputError:
    expected = "a state that is uniform; of one that varies see strains and at(S)"
    return InputError("state.strain", "different along the ribbon", expected)
