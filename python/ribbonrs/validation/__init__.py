"""What is published beside what the program gives: numbers, formulas, classical constants, orders.

Every row of the table has a published value, the computed one, the difference that can be explained, and a
verdict that follows from these. A row that cannot hold, because what is published is wrong, says why, and is
held to it: it fails if the values agree after all.

Examples
--------
>>> import ribbonrs as rb
>>> checked = rb.validate(["frame"])
>>> checked.passed
True
"""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from os import PathLike

from rich.console import Group
from rich.text import Text

from .. import table as csv_table
from ..errors import InputError
from . import classical, closed_forms, elasticity, frame, kinematics, numbers, orders, shell, transitions
from .row import DOES_NOT_HOLD, FAILS, HOLDS, SLIP, Row
from .table import columns, tables

__all__ = ["TOPICS", "Row", "Validation", "validate"]

TOPICS: dict[str, Callable[[], Iterable[Row]]] = {
    "numbers": numbers.rows,
    "closed_forms": closed_forms.rows,
    "kinematics": kinematics.rows,
    "shell": shell.rows,
    "elasticity": elasticity.rows,
    "frame": frame.rows,
    "transitions": transitions.rows,
    "classical": classical.rows,
    "orders": orders.rows,
}
"""What makes the rows of each topic, in the order in which they are shown."""

PLURALS = {HOLDS: "hold", SLIP: "slips", DOES_NOT_HOLD: "do not hold", FAILS: "fail"}
"""The verdicts, as they are counted."""


@dataclass(frozen=True)
class Validation:
    """The rows of a validation, which took so many `seconds`."""

    rows: tuple[Row, ...]
    seconds: float

    @property
    def passed(self) -> bool:
        """Whether no row fails."""
        return all(row.verdict != FAILS for row in self.rows)

    @property
    def counts(self) -> dict[str, int]:
        """How many rows have each verdict."""
        found = Counter(row.verdict for row in self.rows)
        return {verdict: found[verdict] for verdict in PLURALS}

    @property
    def summary(self) -> Group:
        """The tables and a line of counts, to be printed by rich."""
        told = ", ".join(f"{self.counts[verdict]} {plural}" for verdict, plural in PLURALS.items())
        line = Text(f"{len(self.rows)} rows in {self.seconds:.2g} s: {told}", style="bold")
        return Group(*tables(self.rows), line)

    def to_csv(self, path: str | PathLike[str]) -> None:
        """Write the rows as comma-separated values, with all digits and the reasons of the tolerances.

        Raises
        ------
        InputError
            No file name, another suffix than .csv, or a directory that does not exist.
        OSError
            The file cannot be written.
        """
        csv_table.write(columns(self.rows), path)


def validate(topics: Sequence[str] | None = None) -> Validation:
    """Compare what is published with what the program gives.

    Parameters
    ----------
    topics : sequence of str, optional
        Some of `TOPICS`; all if none is given.

    Raises
    ------
    InputError
        If a topic is none of these.
    """
    begun = time.perf_counter()
    wanted = list(dict.fromkeys(topics or TOPICS))
    for topic in wanted:
        if topic not in TOPICS:
            raise InputError("topic", topic, "one of " + ", ".join(TOPICS))
    rows = [replace(row, topic=topic) for topic in wanted for row in TOPICS[topic]()]
    return Validation(tuple(rows), time.perf_counter() - begun)
