"""Growth as it was measured: profiles at stations along the ribbon, and tables of them."""

from __future__ import annotations

import io
import math
import os
import re
from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from .arrays import real_array
from .check import Numbers, numbers, positive
from .errors import MISSING, InputError
from .pieces import Pieces, joined
from .profile import Profile, path_of
from .terms import FIELDS, SAME, Growth, Term

__all__ = ["from_csv", "stations"]

MOST_STATIONS = 1000

MOST_ROWS = 250_000
"""Most rows of numbers in a table: a quarter of what all stations could have."""

ALIASES = {"g33": "gamma33"}
"""Other names of columns: the paper's g33 is that of the mid-surface here."""


def stations(S: ArrayLike, growths: Sequence[Growth], spline: bool = False, name: str = "station") -> Growth:
    """Return growth whose profile across the width changes along the ribbon.

    Parameters
    ----------
    S : array_like (n,)
        Where along the ribbon the growths are, S = X3/a ascending from the start to the end of the ribbon.
    growths : sequence of Growth
        One at each station, of amplitudes that are numbers.
    spline : bool
        Whether the growths pass over into each other by not-a-knot cubic splines in S, of at least 4
        stations, rather than linearly.
    name : str
        Growth ``edge`` at the first station is named ``station0_edge`` in the sum, and so on.

    Examples
    --------
    >>> import ribbonrs as rb
    >>> opening = rb.growth.stations([0.0, 10.0], [rb.growth.edge(0.02), rb.growth.edge(0.06)])
    >>> opening.values(x=0.5, S=5.0)
    {'gamma33': array(0.04)}
    """
    path = path_of(name)
    if not isinstance(spline, bool):
        raise InputError(f"{path}.spline", spline, "true or false")
    least = 4 if spline else 2
    expected = f"{least} to {MOST_STATIONS} ascending numbers, not negative"
    places = real_array(f"{path}.S", S, expected)
    if places.ndim != 1 or not least <= places.size <= MOST_STATIONS:
        raise InputError(f"{path}.S", S, expected)
    falling = np.flatnonzero(np.diff(places, prepend=-math.inf) <= 1e-12 * places[-1])
    if places[0] < 0.0 or falling.size:
        i = 0 if places[0] < 0.0 else int(falling[0])
        raise InputError(f"{path}.S[{i}]", float(places[i]), expected)
    if not isinstance(growths, list | tuple) or len(growths) != places.size:
        raise InputError(f"{path}.growths", growths, f"a list of {places.size} growths, one for each S")
    terms = []
    for i, (weight, growth) in enumerate(zip(np.eye(places.size), growths, strict=True)):
        expected = "a growth that does not vary along the ribbon"
        if not isinstance(growth, Growth):
            raise InputError(f"{path}.growths[{i}]", growth, expected)
        share = joined(places, weight, spline, float(places[0]), float(places[-1]))
        for term in growth.terms:
            if not isinstance(term.amplitude, float):
                raise InputError(f"{path}.growths[{i}].{term.name}", term.amplitude, expected)
            amplitude = _without_zeros(share.scaled(term.amplitude))
            terms.append(Term(f"{name}{i}_{term.name}", amplitude, term.shape))
    return Growth(tuple(terms))


def _without_zeros(pieces: Pieces) -> Pieces:
    """The same with one coefficient where it is zero: the core leaves such pieces out."""
    coefficients = tuple(piece if any(piece) else (0.0,) for piece in pieces.coefficients)
    return Pieces(pieces.breaks, coefficients)


def from_csv(
    path: str | os.PathLike[str],
    *,
    width: float | None = None,
    breaks: Numbers = (),
    spline: bool = False,
    name: str = "measured",
) -> Growth:
    """Return the growth in a table of comma-separated values, such as was measured on a leaf.

    The first row names the columns: ``x`` = X2/a in [-1/2, 1/2], and any of the fields ``gamma33`` (or
    ``g33``), ``d33``, ``d22``, ``d23``, ``g21``, ``g31``, ``gamma22``, ``gamma23``. With a column ``S``,
    S = X3/a, rows of equal S are a station with x of its own, and stations are joined as in `stations`.
    Rows come in any order. Blank lines and those that start with # are left out.

    Parameters
    ----------
    path : str or path
        A text file in UTF-8, of at most 250,000 rows of numbers.
    width : float, optional
        If given, x, S and `breaks` are lengths in the unit of this width.
    breaks, spline, name
        As for samples in `Profile`; `spline` joins stations as well. Of two rows at a break the first is the
        value to its left.

    Raises
    ------
    InputError
        One line that names the line of the file, and the column, of the first thing that is wrong.

    Examples
    --------
    ::

        # growth of a leaf, measured at three stations
        S, x,    g33
        0, -0.5, 0.01
        0,  0.5, 0.01
    """
    path_of(name)
    unit = 1.0 if width is None else positive("growth.csv width", width)
    columns, rows = _read(path)
    at = tuple(b / unit for b in numbers("growth.csv breaks", breaks))
    groups: dict[float, list[_Row]] = {}
    for row in rows:
        scaled = {key: v / unit if key in ("x", "S") else v for key, v in row.values.items()}
        scaled["x"] = _rounded(scaled["x"], at)
        groups.setdefault(scaled.get("S", 0.0), []).append(_Row(row.line, scaled))
    least = 4 if spline else 2
    if "S" in columns and len(groups) < least:
        found = f"{len(groups)} stations"
        raise InputError("growth.csv column S", found, f"at least {least} stations, or no column S")
    S = sorted(groups)
    profiles = []
    for station in S:
        group = sorted(groups[station], key=lambda row: row.values["x"])
        where = f"growth.csv at S = {station:g}" if "S" in columns else "growth.csv"
        profiles.append(_profile(where, columns, group, at, spline, name))
    return stations(S, profiles, spline) if "S" in columns else profiles[0]


class _Row(NamedTuple):
    line: int
    values: dict[str, float]


def _rounded(x: float, breaks: tuple[float, ...]) -> float:
    """The break that x is at but for rounding, so that rows there keep their order, else x."""
    return next((b for b in breaks if abs(x - b) <= SAME), x)


def _profile(
    where: str, columns: list[str], rows: list[_Row], breaks: tuple[float, ...], spline: bool, name: str
) -> Growth:
    """The growth at one station, of rows with ascending x."""
    x = [row.values["x"] for row in rows]
    for before, place, row in zip([math.nan, *x], x, rows, strict=False):
        if abs(place) > 0.5 + SAME:
            raise InputError(_cell(row.line, "x"), place, "a number in [-1/2, 1/2]: x = X2/a")
        if place == before and place not in breaks:
            raise InputError(_cell(row.line, "x"), place, "each x once at a station; breaks= mark jumps")
    fields: Any = {key: (x, [row.values[key] for row in rows]) for key in columns if key in FIELDS}
    try:
        return Profile(**fields, breaks=breaks, spline=spline, name=name)
    except InputError as error:
        key = error.field.split(".", 2)[2]
        raise InputError(f"{where}, {key}", error.value, error.expected) from None


def _read(path: str | os.PathLike[str]) -> tuple[list[str], list[_Row]]:
    """The names of the columns, and the rows as numbers."""
    lines = _lines(path)
    line, header = next(lines, (1, []))
    if not header:
        raise InputError(
            "growth.csv", os.fspath(path), "a header, such as x,gamma33, and rows of numbers below it"
        )
    columns = [ALIASES.get(column, column) for column in header]
    known = ["x", "S", *FIELDS, *ALIASES]
    for column in header:
        if column not in known:
            raise InputError(f"growth.csv line {line}", column, _column(column, known))
        if columns.count(ALIASES.get(column, column)) > 1:
            raise InputError(f"growth.csv line {line}", column, "each column once")
    if "x" not in columns:
        raise InputError("growth.csv column x", MISSING, f"x = X2/a besides {', '.join(columns)}")
    if not set(columns) & set(FIELDS):
        raise InputError("growth.csv column", MISSING, f"at least one of {', '.join(FIELDS)}")
    rows: list[_Row] = []
    for line, cells in lines:
        if len(rows) == MOST_ROWS:
            raise InputError(
                f"growth.csv line {line}", "one row more", f"at most {MOST_ROWS} rows of numbers"
            )
        if len(cells) != len(columns):
            expected = f"{len(columns)}, as in the header"
            raise InputError(f"growth.csv line {line}", f"{len(cells)} cells", expected)
        values = [_number(line, name, cell) for name, cell in zip(header, cells, strict=True)]
        rows.append(_Row(line, dict(zip(columns, values, strict=True))))
    if not rows:
        raise InputError("growth.csv", os.fspath(path), "rows of numbers below the header")
    return columns, rows


def _column(found: str, known: list[str]) -> str:
    """What was expected in place of a column of this name."""
    from difflib import get_close_matches

    words = re.findall(r"\w+", found)
    if len(words) > 1 and (";" in found or "\t" in found or set(words) <= set(known)):
        return "columns separated by commas"
    if words and words[0] in known:
        return f"plain {words[0]}" + ("; width= is for lengths" if words[0] in ("x", "S") else "")
    nearest = get_close_matches(found, known, n=1, cutoff=0.0)[0]
    return f"one of {', '.join(known)}; the nearest is {nearest}"


def _lines(path: str | os.PathLike[str]) -> Iterator[tuple[int, list[str]]]:
    """Each line that is not blank or a comment: its number and its cells."""
    import csv

    if not isinstance(path, str | os.PathLike):
        raise InputError("growth.csv", path, "the name of a file")
    name = os.fspath(path)
    try:
        with open(path, "rb") as file:
            text = file.read().decode("utf-8-sig")
    except (OSError, ValueError) as error:
        if isinstance(error, UnicodeDecodeError):
            raise InputError("growth.csv", name, f"UTF-8 text, unlike byte {error.start}") from None
        reason = error.strerror if isinstance(error, OSError) else str(error)
        raise InputError("growth.csv", name, f"a readable file, not: {reason}") from None
    for i, line in enumerate(io.StringIO(text, newline=None), 1):
        if line.strip() and not line.lstrip().startswith("#"):
            try:
                yield i, [cell.strip() for cell in next(csv.reader([line], skipinitialspace=True))]
            except csv.Error as error:
                expected = f"comma-separated values, not: {error}"
                raise InputError(f"growth.csv line {i}", line, expected) from None


def _number(line: int, column: str, cell: str) -> float:
    try:
        value = float(cell) if "_" not in cell else math.nan
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise InputError(_cell(line, column), cell, "a finite number")
    return value


def _cell(line: int, column: str) -> str:
    return f"growth.csv line {line}, column {column}"
