"""Tables of diagrams: as comma-separated values or a pandas DataFrame."""

from __future__ import annotations

import csv
from collections.abc import Mapping, Sequence
from importlib import import_module
from os import PathLike
from typing import Any

from .errors import RibbonError
from .files import check_path, replacing

__all__ = ["dataframe", "write"]


def write(columns: Mapping[str, Sequence[Any]], path: str | PathLike[str]) -> None:
    """Write columns as comma-separated values, numbers with all their digits.

    Raises
    ------
    InputError
        No file name, another suffix than .csv, or a directory that does not exist.
    OSError
        The file cannot be written.
    """
    check_path(path, [".csv"])
    with replacing(path) as temporary, temporary.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(columns)
        writer.writerows(zip(*columns.values(), strict=True))


def dataframe(columns: Mapping[str, Sequence[Any]]) -> Any:
    """Return columns as a pandas DataFrame.

    Raises
    ------
    RibbonError
        If pandas is not installed.
    """
    try:
        pandas = import_module("pandas")
    except ImportError:
        raise RibbonError("to_dataframe needs pandas, which is not installed; table() does not") from None
    return pandas.DataFrame(columns)
