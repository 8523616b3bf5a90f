r"""How the strains of a state run along the ribbon: the same everywhere, or along a branch."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np

from . import _core
from .arrays import Array
from .errors import InputError
from .helix import Helix, helix_of

__all__ = ["Along", "Course", "Uniform"]


class Course(Protocol):
    """eps, K1, K2, K3 and the poses that follow from them, at S (m,) in any order."""

    @property
    def uniform(self) -> bool:
        """Whether the strains are the same at every S because the ribbon is."""

    @property
    def strain(self) -> Array:
        """(4,): the strains of a uniform state."""

    def strains(self, S: Array) -> Array:
        """(m, 4)."""

    def poses(self, S: Array, position: Array, quaternion: Array) -> tuple[Array, Array]:
        """Positions (m, 3) and quaternions (m, 4), from the pose at S = 0."""

    def sections(self, S: Array) -> list[tuple[Array, float | None]]:
        """The strains (4,) and S of each cross-section at S (m,); one, whose S is None, if all are alike."""

    def turns(self, S: Array) -> Array:
        r"""(m,): turns of the directors from 0 to S, the integral of \|K\|/(2 pi)."""

    def helix(self, length: float, thickness_ratio: float) -> Helix | None:
        """The helix of the centreline, None if it is none."""


@dataclass(frozen=True, eq=False)
class Uniform:
    """The same strains (4,) everywhere: an exact helix."""

    strain: Array
    uniform = True

    def strains(self, S: Array) -> Array:
        """(m, 4)."""
        return np.tile(self.strain, (S.size, 1))

    def poses(self, S: Array, position: Array, quaternion: Array) -> tuple[Array, Array]:
        """Positions (m, 3) and quaternions (m, 4)."""
        return _core.helix(S, self.strain, position, quaternion)

    def sections(self, S: Array) -> list[tuple[Array, float | None]]:
        """One for all."""
        return [(self.strain, None)]

    def turns(self, S: Array) -> Array:
        """(m,)."""
        return np.asarray(S * (math.hypot(*self.strain[1:]) / (2.0 * math.pi)))

    def helix(self, length: float, thickness_ratio: float) -> Helix:
        """The helix."""
        return helix_of(self.strain, length, thickness_ratio)


@dataclass(frozen=True, eq=False)
class Along:
    """Strains that vary with S in [0, `length`], along a branch of natural shapes."""

    branch: _core.NaturalBranch
    length: float
    uniform = False

    @property
    def strain(self) -> Array:
        """There is none: an error that says what to use instead."""
        expected = "a ribbon that is uniform; of one that varies see strains and at(S)"
        raise InputError("state.strain", "different along the ribbon", expected)

    def strains(self, S: Array) -> Array:
        """(m, 4): where the strains jump those to the right."""
        return self.branch.strains(S) + 0.0  # no negative zeros

    def poses(self, S: Array, position: Array, quaternion: Array) -> tuple[Array, Array]:
        """Positions (m, 3) and quaternions (m, 4)."""
        order = np.argsort(S)
        back = np.empty_like(order)
        back[order] = np.arange(order.size)
        positions, quaternions = self.branch.poses(S[order], position, quaternion)
        return positions[back], quaternions[back]

    def sections(self, S: Array) -> list[tuple[Array, float | None]]:
        """Every one."""
        return list(zip(self.strains(S), S.tolist(), strict=True))

    def turns(self, S: Array) -> Array:
        """(m,), as drawings need them: by the trapezoidal rule."""
        places, turns = self._turns
        return np.interp(S, places, turns)

    @cached_property
    def _turns(self) -> tuple[Array, Array]:
        places = np.union1d(self.branch.breaks, np.linspace(0.0, self.length, 1001))
        rate = np.linalg.norm(self.strains(places)[:, 1:], axis=1) / (2.0 * math.pi)
        steps = np.diff(places) * (rate[1:] + rate[:-1]) / 2.0
        return places, np.concatenate([[0.0], np.cumsum(steps)])

    def helix(self, length: float, thickness_ratio: float) -> None:
        """None: the centreline is no helix."""
