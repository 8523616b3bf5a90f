"""One line of the validation: a published number, the same number computed, and whether they agree."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import overload

import numpy as np
from numpy.typing import ArrayLike

__all__ = ["DOES_NOT_HOLD", "FAILS", "HOLDS", "PAPER", "ROUNDING", "SLIP", "Row", "farthest"]

HOLDS = "holds"
SLIP = "slip"
DOES_NOT_HOLD = "does not hold"
FAILS = "FAILS"

PAPER = "Liu, Li & Liu"
ROUNDING = "rounding"
"""Reason of a tolerance of a few units in the last place."""


@dataclass(frozen=True)
class Row:
    """A published value beside a computed one; the verdict follows from the numbers.

    Parameters
    ----------
    name, source : str
        What is compared, and where it is published.
    published, computed : float
        Not a number where what is published is not real.
    tolerance : float
        The largest difference, absolute, that the computation or the digits printed explain.
    reason : str
        What the tolerance comes from.
    wrong : str
        Of a published value that cannot hold: why, in one sentence. Without it the row must hold.
    corrected : float, optional
        Of a slip: what should have been published.
    bound : {"=", "<=", ">="}
        How the computed value is to stand to the published one.
    topic : str
        Which part of the validation it belongs to; `validate` fills it in.
    """

    name: str
    source: str
    published: float
    computed: float
    tolerance: float
    reason: str = ROUNDING
    wrong: str = ""
    corrected: float | None = None
    bound: str = "="
    topic: str = ""

    @property
    def difference(self) -> float:
        """Computed less published."""
        return self.computed - self.published

    @property
    def verdict(self) -> str:
        """How the row ends.

        "holds": the values agree. "slip": they do not, as `wrong` says, and the corrected value does. "does
        not hold": they do not, as `wrong` says. "FAILS": anything else, so also a value that is called wrong
        and is not.
        """
        agrees = self._agrees(self.published)
        if not self.wrong:
            return HOLDS if agrees else FAILS
        if agrees or not math.isfinite(self.computed):
            return FAILS
        if self.corrected is None:
            return DOES_NOT_HOLD
        return SLIP if self._agrees(self.corrected) else FAILS

    def _agrees(self, value: float) -> bool:
        difference = self.computed - value
        if self.bound == "<=":
            return difference <= self.tolerance
        if self.bound == ">=":
            return difference >= -self.tolerance
        return abs(difference) <= self.tolerance


@overload
def farthest(published: ArrayLike, computed: ArrayLike) -> tuple[float, float]: ...
@overload
def farthest(
    published: ArrayLike, computed: ArrayLike, corrected: ArrayLike
) -> tuple[float, float, float]: ...
def farthest(
    published: ArrayLike, computed: ArrayLike, corrected: ArrayLike | None = None
) -> tuple[float, ...]:
    """Return the entries of arrays where the first two differ most.

    Where one of the two is no number counts as farther apart than anything else.
    """
    given = [published, computed] if corrected is None else [published, computed, corrected]
    arrays = [np.ravel(values) for values in np.broadcast_arrays(*given)]
    apart = np.abs(arrays[1] - arrays[0])
    i = int(np.argmax(np.where(np.isnan(apart), np.inf, apart)))
    return tuple(float(values[i]) for values in arrays)
