"""Files of a bifurcation diagram: everything at the points of its branches, in one .npz of numpy.

What has no array is JSON text: nothing is pickled, and any program that reads .npz can use it.
"""

from __future__ import annotations

import csv
import json
import os
import zipfile
import zlib
from functools import partial
from importlib.metadata import version
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from . import _core
from .branch import ARRAYS, Branch, SpecialPoint
from .diagram import Diagram
from .errors import InputError
from .files import replacing
from .parameter import Parameter, parameter_of
from .record import record_of, scene_of
from .traced import Kept, Maker

__all__ = ["load", "save", "write_table"]

FORMAT = "ribbonrs diagram"
VERSION = 1
SUFFIX = ".npz"

UNITS = (
    "branch<i>_*: one row for each point of branch i. parameter: in the units of the scene (thickness and "
    "length in the user's, all else dimensionless). strains (means over S of eps, K1, K2, K3), energy, "
    "load_potential (means over S), position (at S = L), reactions (force and moment at the start, then at "
    "the end, in the fixed basis): dimensionless, lengths in the width a, curvatures in 1/a, forces in "
    "Y h a, moments in Y h a^2, energies in Y h a. index: nan where it is not known. solutions: the numbers "
    "of each boundary-value problem, for ribbonrs alone. special: kind, parameter, multiplicity, branch, "
    "point, name, reason."
)

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

RECORD = ("ended", "reason", "origin", "mirrored")
"""What else a branch has."""


def save(diagram: Diagram, path: str | PathLike[str]) -> None:
    """Write `diagram` to `path`, which ends in .npz.

    An existing file is replaced as a whole; when writing fails it stays as it was.

    Raises
    ------
    InputError
        No file name, another suffix, or a directory that does not exist.
    OSError
        The file cannot be written.
    """
    expected = f"a file name ending in {SUFFIX}"
    if not isinstance(path, str | PathLike):
        raise InputError("path", path, expected)
    if Path(path).suffix.lower() != SUFFIX:
        raise InputError("path", str(path), expected)
    if not os.path.isdir(Path(path).parent):
        raise InputError("path", str(path), "a file in a directory that exists")
    contents: dict[str, Any] = {
        "format": FORMAT,
        "version": VERSION,
        "units": UNITS,
        "scene": json.dumps(record_of(diagram.scene)),
        "parameter": diagram.parameter,
        "span": np.array(diagram.span),
        "special": json.dumps([_special_record(point) for point in diagram.special_points]),
        "branches": len(diagram.branches),
        "ribbonrs_version": version("ribbonrs"),
    }
    for branch in diagram.branches:
        prefix = f"branch{branch.number}_"
        contents |= {prefix + name: getattr(branch, name) for name in ARRAYS}
        contents[prefix + "record"] = json.dumps(_branch_record(branch))
        contents[prefix + "solutions"] = json.dumps(_solutions(branch))
    with replacing(path) as temporary, temporary.open("wb") as file:
        np.savez_compressed(file, **contents)


def load(path: str | PathLike[str]) -> Diagram:
    """Return the diagram in a file; see `ribbonrs.load_diagram`."""
    if not isinstance(path, str | PathLike):
        raise InputError("path", path, "the name of a file that Diagram.save wrote")
    name = os.fspath(path)
    try:
        with open(path, "rb") as raw, np.load(raw, allow_pickle=False) as file:
            written = str(file.get("format")), int(file.get("version", 0))
            if written == (FORMAT, VERSION):
                return _diagram(file)
    except OSError as error:
        raise InputError("path", name, f"a readable file, not: {error.strerror or error}") from None
    except DAMAGED as error:
        reason = " ".join(str(error).split())[:80] or type(error).__name__
        raise InputError("path", name, f"a whole file that Diagram.save wrote, not: {reason}") from None
    raise InputError("path", name, f"a {FORMAT} of version {VERSION}, which Diagram.save wrote")


def write_table(diagram: Diagram, path: str | PathLike[str]) -> None:
    """Write `Diagram.table` as comma-separated values, numbers with all their digits."""
    columns = diagram.table()
    with replacing(path) as temporary, temporary.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(columns)
        writer.writerows(zip(*columns.values(), strict=True))


def _diagram(file: Any) -> Diagram:
    scene = scene_of(json.loads(str(file["scene"])))
    parameter = parameter_of(scene, str(file["parameter"]))
    low, high = file["span"].tolist()
    branches = tuple(_branch(file, i, parameter) for i in range(int(file["branches"])))
    special = tuple(_special(row, branches) for row in json.loads(str(file["special"])))
    return Diagram(scene, parameter.name, (low, high), branches, special)


def _branch_record(branch: Branch) -> dict[str, Any]:
    return {
        **{name: getattr(branch, name) for name in RECORD},
        "tol": branch.maker.tol,
        "n": branch.maker.n,
    }


def _branch(file: Any, i: int, parameter: Parameter) -> Branch:
    prefix = f"branch{i}_"
    record = json.loads(str(file[prefix + "record"]))
    arrays = {name: file[prefix + name] for name in ARRAYS}
    k = arrays["parameter"].size
    if any(array.shape[:1] != (k,) for array in arrays.values()):
        raise ValueError("arrays of different lengths")
    kept = json.loads(str(file[prefix + "solutions"]))
    first, last = record["ended"]
    return Branch(
        number=i,
        **arrays,
        ended=(first, last),
        reason=record["reason"],
        origin=record["origin"],
        mirrored=record["mirrored"],
        maker=Maker(parameter, record["tol"], record["n"]),
        source=Kept(parameter, arrays["parameter"], None if kept is None else [_parts(p) for p in kept]),
    )


def _solutions(branch: Branch) -> list[_core._Parts] | None:
    """The numbers of every solution, None of natural shapes."""
    solutions = [branch.source.solution(i) for i in range(branch.parameter.size)]
    parts = [solution.parts() for solution in solutions if solution is not None]
    return parts if len(parts) == len(solutions) else None


def _parts(value: Any) -> _core._Parts:
    """The numbers of a solution as the core takes them: JSON has no tuples."""
    degree, breaks, states, strains, statuses, *rest = value
    states = [tuple(state) for state in states]
    parts: Any = (degree, breaks, states, strains, tuple(statuses), *rest)
    return parts  # type: ignore[no-any-return]


def _special_record(point: SpecialPoint) -> list[Any]:
    place = point.branch, point.place
    return [point.kind, point.parameter, point.multiplicity, *place, point.name, point.reason]


def _special(row: list[Any], branches: tuple[Branch, ...]) -> SpecialPoint:
    """A special point; that of a zero is between points, where a file has no states."""
    kind, parameter, multiplicity, number, place, name, reason = row
    branch = branches[number]
    between = kind == "zero" and float(branch.parameter[place]) != parameter
    make = partial(branch.between, place, 0.5) if between else partial(branch.state, place)
    return SpecialPoint(kind, parameter, multiplicity, number, place, name, reason, make)
