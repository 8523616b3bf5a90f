"""A figure with what it says and the numbers it was drawn from."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from os import PathLike
from pathlib import Path
from textwrap import fill
from typing import Any

from matplotlib.figure import Figure

from .. import table
from ..errors import InputError
from ..files import replacing

__all__ = ["FORMATS", "Drawing"]

FORMATS = ("pdf", "png", "svg")
"""Vector and raster formats."""
WIDE = 100


@dataclass(frozen=True)
class Drawing:
    """A figure, its caption and its data.

    Attributes
    ----------
    name : str
        Of the figure, and what its files are called.
    figure : matplotlib.figure.Figure
        Free of pyplot.
    caption : str
        Which law, which conditions, and what differs from the paper.
    tables : mapping of str to mapping of str to sequence
        The numbers of each part of it: columns of one length, by their names with their scaling.
    """

    name: str
    figure: Figure
    caption: str
    tables: Mapping[str, Mapping[str, Sequence[Any]]] = field(default_factory=dict)

    def save(
        self, directory: str | PathLike[str] = ".", formats: Sequence[str] = ("pdf", "png")
    ) -> list[Path]:
        """Write the figure in each format, a table a part as comma-separated values, and the caption.

        Existing files are replaced, each as a whole. Returns what was written.

        Raises
        ------
        InputError
            Another format than pdf, png and svg, or a directory that does not exist.
        OSError
            A file cannot be written.
        """
        folder = Path(directory)
        for suffix in formats:
            if suffix not in FORMATS:
                raise InputError("formats", suffix, "one of " + ", ".join(FORMATS))
        if not folder.is_dir():
            raise InputError("directory", str(directory), "a directory that exists")
        written = []
        for suffix in formats:
            path = folder / f"{self.name}.{suffix}"
            with replacing(path) as temporary:
                # Without the time of drawing: the same figure gives the same file.
                dated = {"pdf": {"CreationDate": None}, "svg": {"Date": None}, "png": None}[suffix]
                self.figure.savefig(temporary, format=suffix, metadata=dated)
            written.append(path)
        for part, columns in self.tables.items():
            path = folder / f"{self.name}_{part}.csv"
            table.write(columns, path)
            written.append(path)
        path = folder / f"{self.name}.txt"
        with replacing(path) as temporary:
            temporary.write_text(fill(self.caption, WIDE) + "\n", encoding="utf-8", newline="\n")
        return [*written, path]
