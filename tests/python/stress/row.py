"""A line of the table of `make stress`."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Row:
    """The worst of many runs against what is allowed; what is not a number is not allowed."""

    part: str
    what: str
    runs: int
    worst: float
    allowed: float
    unit: str = ""

    @property
    def passed(self):
        """Whether the worst is allowed."""
        return bool(self.worst <= self.allowed)
