"""Diagrams kept whole in one .npz of numpy, with the name and version of their format.

What has no array is JSON text: nothing is pickled, and any program that reads .npz can use it.
"""

from __future__ import annotations

import os
import zipfile
import zlib
from collections.abc import Callable
from os import PathLike
from typing import Any, NamedTuple, TypeVar

import numpy as np

from .errors import InputError
from .files import check_path, replacing

__all__ = ["Format", "load", "save"]

T = TypeVar("T")

DAMAGED = (
    ValueError,  # of which InputError is one
    LookupError,
    TypeError,
    AttributeError,
    EOFError,
    ArithmeticError,
    RuntimeError,
    zipfile.BadZipFile,
    zlib.error,
)
"""What reading something else, or a part of a file, ends with."""


class Format(NamedTuple):
    """What a file is and what wrote it."""

    name: str
    version: int
    writer: str


def save(kind: Format, path: str | PathLike[str], contents: dict[str, Any]) -> None:
    """Write `contents` to `path`, which ends in .npz.

    An existing file is replaced as a whole; when writing fails it stays as it was.

    Raises
    ------
    InputError
        No file name, another suffix, or a directory that does not exist.
    OSError
        The file cannot be written.
    """
    check_path(path, [".npz"])
    about: dict[str, Any] = {"format": kind.name, "version": kind.version}
    from importlib.metadata import version  # slow to load

    about["ribbonrs_version"] = version("ribbonrs")
    with replacing(path) as temporary, temporary.open("wb") as file:
        np.savez_compressed(file, **about, **contents)


def load(kind: Format, path: str | PathLike[str], make: Callable[[Any], T]) -> T:
    """Return what `make` makes of the arrays in a file.

    Raises
    ------
    InputError
        If there is no such file, or it is another one or damaged.
    """
    if not isinstance(path, str | PathLike):
        raise InputError("path", path, f"the name of a file that {kind.writer} wrote")
    name = os.fspath(path)
    try:
        with open(path, "rb") as raw, np.load(raw, allow_pickle=False) as file:
            written = str(file.get("format")), int(file.get("version", 0))
            if written == (kind.name, kind.version):
                return make(file)
    except OSError as error:
        raise InputError("path", name, f"a readable file, not: {error.strerror or error}") from None
    except DAMAGED as error:
        reason = " ".join(str(error).split())[:80] or type(error).__name__
        raise InputError("path", name, f"a whole file that {kind.writer} wrote, not: {reason}") from None
    raise InputError("path", name, f"a {kind.name} of version {kind.version}, which {kind.writer} wrote")
