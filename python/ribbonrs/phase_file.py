"""Files of a phase diagram: all of it in one .npz of numpy, or its points as comma-separated values.

What has no array is JSON text: nothing is pickled, and any program that reads .npz can use it.
"""

from __future__ import annotations

import csv
import json
import os
from collections.abc import Sequence
from importlib.metadata import version
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from .diagram_file import DAMAGED
from .errors import InputError
from .files import replacing
from .parameter import parameter_of
from .phasediagram import PHASES, Axis, Boundary, PhaseDiagram
from .record import record_of, scene_of

__all__ = ["load", "save", "write_table"]

FORMAT = "ribbonrs phase diagram"
VERSION = 1

ARRAYS = ("phase", "stable", "stable_count", "energy", "K2", "K3", "resolved", "done")
"""Fields of a diagram of shape (ny, nx) or (ny, nx, 4)."""

UNITS = (
    "x_values (nx,), y_values (ny,): of the parameters x and y, in the units of the scene (thickness and "
    "length in the user's, all else dimensionless). phase, stable_count, energy, K2, K3, resolved, done "
    "(ny, nx), stable (ny, nx, 4; flat, bent, twisted, helical): of the stable states at each point; "
    "curvatures in 1/a, energies in Y h a, with a the width; nan and '' where nothing is known. boundaries_ "
    "and rim_: lines between regions and around them, of which line i has points[start[i]:start[i + 1]], "
    "values of x and y, and the jumps of the lowest state there in (K2, K3) over the thickness ratio; sides: "
    "JSON of the phases on the left and on the right of each line and numbers of stable states of each phase "
    "there. reasons: JSON of row, column and why no state was found. tol: relative to the spans."
)


def save(diagram: PhaseDiagram, path: str | PathLike[str]) -> None:
    """Write `diagram` to `path`, which ends in .npz.

    An existing file is replaced as a whole; when writing fails it stays as it was.

    Raises
    ------
    InputError
        No file name, another suffix, or a directory that does not exist.
    OSError
        The file cannot be written.
    """
    _check_path(path, ".npz")
    contents: dict[str, Any] = {
        "format": FORMAT,
        "version": VERSION,
        "units": UNITS,
        "scene": json.dumps(record_of(diagram.scene)),
        "x": diagram.x.name,
        "y": diagram.y.name,
        "x_values": diagram.x.values,
        "y_values": diagram.y.values,
        **{name: getattr(diagram, name) for name in ARRAYS},
        **_lines("boundaries_", diagram.boundaries),
        **_lines("rim_", diagram.rim),
        "reasons": json.dumps([[*place, reason] for place, reason in diagram.reasons.items()]),
        "tol": diagram.tol,
        "interrupted": diagram.interrupted,
        "ribbonrs_version": version("ribbonrs"),
    }
    with replacing(path) as temporary, temporary.open("wb") as file:
        np.savez_compressed(file, **contents)


def load(path: str | PathLike[str]) -> PhaseDiagram:
    """Return the diagram in a file; see `ribbonrs.load_phase_diagram`."""
    if not isinstance(path, str | PathLike):
        raise InputError("path", path, "the name of a file that PhaseDiagram.save wrote")
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
        raise InputError("path", name, f"a whole file that PhaseDiagram.save wrote, not: {reason}") from None
    raise InputError("path", name, f"a {FORMAT} of version {VERSION}, which PhaseDiagram.save wrote")


def write_table(diagram: PhaseDiagram, path: str | PathLike[str]) -> None:
    """Write `PhaseDiagram.table` as comma-separated values, numbers with all their digits.

    Raises
    ------
    InputError
        No file name, another suffix than .csv, or a directory that does not exist.
    OSError
        The file cannot be written.
    """
    _check_path(path, ".csv")
    columns = diagram.table()
    with replacing(path) as temporary, temporary.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(columns)
        writer.writerows(zip(*columns.values(), strict=True))


def _check_path(path: object, suffix: str) -> None:
    expected = f"a file name ending in {suffix}"
    if not isinstance(path, str | PathLike):
        raise InputError("path", path, expected)
    if Path(path).suffix.lower() != suffix:
        raise InputError("path", str(path), expected)
    if not os.path.isdir(Path(path).parent):
        raise InputError("path", str(path), "a file in a directory that exists")


def _lines(prefix: str, lines: Sequence[Boundary]) -> dict[str, Any]:
    sizes = [len(line.points) for line in lines]
    return {
        prefix + "points": np.concatenate([np.empty((0, 2)), *(line.points for line in lines)]),
        prefix + "jump": np.concatenate([np.empty(0), *(line.jump for line in lines)]),
        prefix + "start": np.concatenate([[0], np.cumsum(sizes)]).astype(np.int64),
        prefix + "sides": json.dumps([[line.phases, line.stable] for line in lines]),
    }


def _read_lines(file: Any, prefix: str) -> tuple[Boundary, ...]:
    points, jump, start = (file[prefix + name] for name in ("points", "jump", "start"))
    sides = json.loads(str(file[prefix + "sides"]))
    if points.shape != (start[-1], 2) or jump.shape != (start[-1],) or len(sides) != len(start) - 1:
        raise ValueError("arrays of different lengths")
    return tuple(
        Boundary(
            points[first:last],
            (str(phases[0]), str(phases[1])),
            (tuple(map(int, stable[0])), tuple(map(int, stable[1]))),
            jump[first:last],
        )
        for first, last, (phases, stable) in zip(start[:-1], start[1:], sides, strict=True)
    )


def _diagram(file: Any) -> PhaseDiagram:
    scene = scene_of(json.loads(str(file["scene"])))
    x, y = (Axis(str(file[name]), file[f"{name}_values"]) for name in ("x", "y"))
    for axis in (x, y):
        parameter_of(scene, axis.name)
    shape = y.values.size, x.values.size
    arrays = {name: file[name] for name in ARRAYS}
    for name, array in arrays.items():
        if array.shape != (*shape, len(PHASES)) if name == "stable" else array.shape != shape:
            raise ValueError(f"{name} of another shape")
    reasons = {(int(j), int(i)): str(reason) for j, i, reason in json.loads(str(file["reasons"]))}
    return PhaseDiagram(
        scene=scene,
        x=x,
        y=y,
        **arrays,
        boundaries=_read_lines(file, "boundaries_"),
        rim=_read_lines(file, "rim_"),
        reasons=reasons,
        tol=float(file["tol"]),
        interrupted=bool(file["interrupted"]),
    )
