"""The files that a scene file asks for: which there are, and writing all of them or none."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from .errors import InputError
from .files import check_encoding
from .growthtable import Table

__all__ = ["SUFFIXES", "SWEPT", "TRACED", "Output", "OutputTable", "write_all"]

SUFFIXES = {
    "figure": (".png", ".pdf", ".svg"),
    "surface": (".vtp", ".obj"),
    "data": (".npz",),
    "diagram": (".png", ".pdf", ".svg"),
    "table": (".csv",),
    "branches": (".npz",),
    "map": (".png", ".pdf", ".svg"),
    "phases": (".npz",),
}
"""The kinds of output and what their files are called."""

TRACED = ("diagram", "table", "branches")
"""The kinds that `ribbonrs trace` writes."""

SWEPT = ("map", "table", "phases")
"""The kinds that `ribbonrs sweep` writes; `ribbonrs run` writes what is in neither."""


@dataclass(frozen=True)
class Output:
    """A file to write; `field` is the key of the scene file that asks for it, `kind` its name."""

    field: str
    path: Path
    kind: str


class OutputTable(Table):
    """The table [output]."""

    figure: Any = None
    surface: Any = None
    data: Any = None
    diagram: Any = None
    table: Any = None
    branches: Any = None
    map: Any = None
    phases: Any = None

    def make(self, read: Sequence[Path] = ()) -> tuple[Output, ...]:
        """Return every file, each another one and none of those that are read."""
        outputs: dict[str, Output] = {}
        kept = {os.path.realpath(path) for path in read}
        for key, value in self.given().items():
            for i, name in enumerate(value) if isinstance(value, list) else ((None, value),):
                field = f"output.{key}" if i is None else f"output.{key}[{i}]"
                output = Output(field, _path(field, name, SUFFIXES[key]), key)
                place = os.path.realpath(output.path)
                if place in kept:
                    raise InputError(field, name, "a file that the scene does not read")
                if outputs.setdefault(place, output) is not output:
                    raise InputError(field, name, "a different file for each output")
        return tuple(outputs.values())


def write_all(outputs: Sequence[Output], write: Callable[[str, Path], object]) -> None:
    """Write all files or none: each beside its place by `write(kind, path)`, then all are moved there.

    A failure is an `InputError` that names the key of the scene file.
    """
    with ExitStack() as stack:
        moves = []
        for output in outputs:
            with _naming(output):
                beside = TemporaryDirectory(prefix=".ribbonrs-", dir=output.path.parent)
                written = Path(stack.enter_context(beside), output.path.name)
                write(output.kind, written)
            moves.append((output, written))
        for output, written in moves:
            with _naming(output):
                written.replace(output.path)


@contextmanager
def _naming(output: Output) -> Iterator[None]:
    """Turn a failure to write into an error that names the key of the scene file."""
    try:
        yield
    except OSError as error:
        expected = f"a file that can be written, not: {error.strerror}"
        raise InputError(output.field, str(output.path), expected) from None


def _path(field: str, name: object, suffixes: tuple[str, ...]) -> Path:
    if not isinstance(name, str) or not name.isprintable():
        raise InputError(field, name, "a file name")
    path = Path(name)
    if path.suffix.lower() not in suffixes:
        raise InputError(field, name, f"a file name ending in {' or '.join(suffixes)}")
    check_encoding(field, name)
    # os.path, since Path.is_dir fails on a name that is too long.
    if not os.path.isdir(path.parent):
        raise InputError(field, name, "a file in a directory that exists")
    if os.path.isdir(path):
        raise InputError(field, name, "a file, not a directory")
    return path
