"""Files of a phase diagram: all of it, its lines included."""

from __future__ import annotations

import json
from collections.abc import Sequence
from os import PathLike
from typing import Any

import numpy as np

from . import archive
from .archive import Format
from .parameter import parameter_of
from .phasediagram import PHASES, Axis, Boundary, PhaseDiagram
from .record import record_of, scene_of

__all__ = ["load", "save"]

FORMAT = Format("ribbonrs phase diagram", 1, "PhaseDiagram.save")

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
    """Write `diagram` to `path`, which ends in .npz; see `ribbonrs.archive.save`."""
    contents: dict[str, Any] = {
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
    }
    archive.save(FORMAT, path, contents)


def load(path: str | PathLike[str]) -> PhaseDiagram:
    """Return the diagram in a file; see `ribbonrs.load_phase_diagram`."""
    return archive.load(FORMAT, path, _diagram)


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
