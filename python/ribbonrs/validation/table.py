"""The rows of a validation as tables to print, and as columns to write."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import groupby
from math import isnan

from rich.box import SIMPLE_HEAD
from rich.console import RenderableType
from rich.table import Table
from rich.text import Text

from .row import FAILS, Row

__all__ = ["columns", "tables"]

NUMBERS = ("published", "computed", "difference", "within")
"""Headings of the columns of numbers."""

CORRECTIONS = "docs/corrections.md"
"""Where it is explained at length what does not hold."""


def tables(rows: Sequence[Row]) -> Iterator[RenderableType]:
    """Yield a table a topic, and below it a numbered sentence for each row that cannot hold."""
    for topic, members in groupby(rows, lambda row: row.topic):
        table = Table(title=topic, title_justify="left", box=SIMPLE_HEAD, pad_edge=False)
        table.add_column("", no_wrap=True)
        for heading in NUMBERS:
            table.add_column(heading, justify="right", no_wrap=True)
        for heading in ("verdict", "source"):
            table.add_column(heading, no_wrap=True)
        sentences: dict[str, int] = {}
        for row in members:
            number = sentences.setdefault(row.wrong, len(sentences) + 1) if row.wrong else 0
            table.add_row(
                row.name,
                ("" if row.bound == "=" else f"{row.bound} ") + _number(row.published),
                f"{row.computed:.10g}",
                "" if isnan(row.difference) else f"{row.difference:.1e}",
                f"{row.tolerance:.1e}",
                Text(f"{row.verdict} ({number})" if number else row.verdict, _style(row)),
                row.source,
            )
        yield table
        for sentence, number in sentences.items():
            yield Text(f"({number}) {sentence}")
        if sentences:
            yield Text(f"More in {CORRECTIONS}.\n")


def _style(row: Row) -> str:
    return "bold" if row.verdict == FAILS else ""


def _number(value: float) -> str:
    return "not real" if isnan(value) else f"{value:.10g}"


def columns(rows: Sequence[Row]) -> dict[str, list[str | float]]:
    """Return what `tables` prints, and the reasons of the tolerances, with all digits."""
    names = ("topic", "name", "source", "published", "bound", "computed", "difference", "tolerance")
    told = ("verdict", "corrected", "reason", "wrong")
    found: dict[str, list[str | float]] = {
        name: [getattr(row, name) for row in rows] for name in (*names, *told)
    }
    found["corrected"] = ["" if row.corrected is None else row.corrected for row in rows]
    return found
