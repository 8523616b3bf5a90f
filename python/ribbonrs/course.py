"""How the strains of a state run along the ribbon: the same everywhere, or along a branch."""

from __future__ import annotations

import math
from functools import cached_property
from typing import TypeAlias

import numpy as np

from . import _core
from .arrays import Array
from .errors import InputError
from .helix import Helix, helix_of

__all__ = ["Along", "Course", "Uniform"]


class Uniform:
    """The same strains (4,) everywhere, because the ribbon is the same: an exact helix."""

    uniform = True

    def __init__(self, strain: Array) -> None:
        self.strain = strain

    def strains(self, S: Array) -> Array:
        """Return the strains at S (m,), in any order: array (m, 4)."""
        return np.tile(self.strain, (S.size, 1))

    def poses(self, S: Array, position: Array, quaternion: Array) -> tuple[Array, Array]:
        """Return positions (m, 3) and quaternions (m, 4) at S (m,), in any order, from the pose at S = 0."""
        return _core.helix(S, self.strain, position, quaternion)

    def sections(self, S: Array) -> list[tuple[Array, float | None]]:
        """Return strains (4,) and S of each cross-section at S (m,); here one, without S: all are alike."""
        return [(self.strain, None)]

    def turns(self, S: Array) -> Array:
        r"""Return the turns of the directors from 0 to S (m,), the integral of \|K\|/(2 pi)."""
        return np.asarray(S * (math.hypot(*self.strain[1:]) / (2.0 * math.pi)))

    def helix(self, length: float, thickness_ratio: float) -> Helix | None:
        """Return the helix of the centreline."""
        return helix_of(self.strain, length, thickness_ratio)


class Along:
    """Strains that vary with S in [0, `length`], along a branch of natural shapes; methods as `Uniform`."""

    uniform = False

    def __init__(self, branch: _core.NaturalBranch, length: float) -> None:
        self.branch = branch
        self.length = length

    @property
    def strain(self) -> Array:
        """There is none: an error that says what to use instead."""
        expected = "a ribbon that is uniform; of one that varies see strains and at(S)"
        raise InputError("state.strain", "different along the ribbon", expected)

    def strains(self, S: Array) -> Array:
        """Return the strains, where they jump those to the right."""
        return self.branch.strains(S) + 0.0  # no negative zeros

    def poses(self, S: Array, position: Array, quaternion: Array) -> tuple[Array, Array]:
        """Return positions and quaternions."""
        order = np.argsort(S)
        back = np.empty_like(order)
        back[order] = np.arange(order.size)
        positions, quaternions = self.branch.poses(S[order], position, quaternion)
        return positions[back], quaternions[back]

    def sections(self, S: Array) -> list[tuple[Array, float | None]]:
        """Return the strains and S of every one."""
        return list(zip(self.strains(S), S.tolist(), strict=True))

    def turns(self, S: Array) -> Array:
        """Return the turns, as drawings need them: by the trapezoidal rule."""
        places, turns = self._turns
        return np.interp(S, places, turns)

    @cached_property
    def _turns(self) -> tuple[Array, Array]:
        places = np.union1d(self.branch.breaks, np.linspace(0.0, self.length, 1001))
        rate = np.linalg.norm(self.strains(places)[:, 1:], axis=1) / (2.0 * math.pi)
        steps = np.diff(places) * (rate[1:] + rate[:-1]) / 2.0
        return places, np.concatenate([[0.0], np.cumsum(steps)])

    def helix(self, length: float, thickness_ratio: float) -> Helix | None:
        """Return None: the centreline is no helix."""
        return None


Course: TypeAlias = Uniform | Along
"""How the strains of a state run along the ribbon."""
