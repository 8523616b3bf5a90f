"""What can go wrong, as exceptions: wrong input and failed convergence."""

from __future__ import annotations

import reprlib
from enum import Enum
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from .state import State

__all__ = ["MISSING", "ConvergenceError", "InputError", "RibbonError", "RibbonWarning", "shown"]


class RibbonError(Exception):
    """Base of every error this package raises on purpose."""


class RibbonWarning(UserWarning):
    """Input that is accepted but lies outside the range in which the theory is accurate."""


class _Missing(Enum):
    MISSING = "missing"


MISSING = _Missing.MISSING
"""The value of an `InputError` about something that was not given at all."""


class InputError(RibbonError, ValueError):
    """Input that means nothing to the model; the message is one line.

    Parameters
    ----------
    field : str
        Path of the offending input, as in a scene file: "ribbon.thickness".
    value : object
        What was given, `MISSING` if nothing was.
    expected : str
        What would have been right, completing "expected ...".

    Examples
    --------
    >>> str(InputError("ribbon.thickness", -0.1, "a positive finite number"))
    'ribbon.thickness = -0.1: expected a positive finite number'
    """

    def __init__(self, field: str, value: object, expected: str) -> None:
        super().__init__(field, value, expected)
        self.field = field
        self.value = value
        self.expected = expected

    def __str__(self) -> str:
        if self.value is MISSING:
            return f"{self.field} is missing: expected {self.expected}"
        return f"{self.field} = {shown(self.value)}: expected {self.expected}"


class ConvergenceError(RibbonError, RuntimeError):
    """An iteration that ended without reaching its tolerance.

    Parameters
    ----------
    reason : str
        How it ended, in one line.
    iterate : ndarray
        The last iterate.
    residuals : tuple of float
        The residual norm after each iteration.
    advice : str
        What to try next.
    state : State, optional
        The last solution on the way, for a part of the loads.
    fraction : float
        How much of the loads, and of the way of the ends to where they are held, it has.
    """

    def __init__(
        self,
        reason: str,
        iterate: NDArray[np.float64],
        residuals: tuple[float, ...],
        advice: str,
        state: State | None = None,
        fraction: float = 0.0,
    ) -> None:
        super().__init__(reason, iterate, residuals, advice, state, fraction)
        self.reason = reason
        self.iterate = iterate
        self.residuals = residuals
        self.advice = advice
        self.state = state
        self.fraction = fraction

    def __str__(self) -> str:
        return f"{self.reason}; try {self.advice}"


_SHORT = reprlib.Repr()
_SHORT.maxstring = _SHORT.maxother = 80
LONGEST = 200
"""Characters of a value that are shown."""


def shown(value: object) -> str:
    """Return the value in one line, short whatever its size and depth."""
    if isinstance(value, np.generic):
        value = value.item()
    try:
        text = " ".join(_SHORT.repr(value).split())
    except ValueError:  # an integer of more digits than Python prints
        return "a huge integer"
    return text if len(text) <= LONGEST else f"{text[: LONGEST - 3]}..."
