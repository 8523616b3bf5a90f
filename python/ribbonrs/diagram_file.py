"""Files of a bifurcation diagram: everything at the points of its branches."""

from __future__ import annotations

import json
from functools import partial
from os import PathLike
from typing import Any

import numpy as np

from . import _core, archive
from .archive import Format
from .branch import ARRAYS, Branch, SpecialPoint
from .diagram import Diagram
from .parameter import Parameter, parameter_of
from .record import record_of, scene_of
from .traced import Kept, Maker

__all__ = ["load", "save"]

FORMAT = Format("ribbonrs diagram", 1, "Diagram.save")

UNITS = (
    "branch<i>_*: one row for each point of branch i. parameter: in the units of the scene (thickness and "
    "length in the user's, all else dimensionless). strains (means over S of eps, K1, K2, K3), energy, "
    "load_potential (means over S), position (at S = L), reactions (force and moment at the start, then at "
    "the end, in the fixed basis): dimensionless, lengths in the width a, curvatures in 1/a, forces in "
    "Y h a, moments in Y h a^2, energies in Y h a. index: nan where it is not known. solutions: the numbers "
    "of each boundary-value problem, for ribbonrs alone. special: kind, parameter, multiplicity, branch, "
    "point, name, reason."
)

RECORD = ("ended", "reason", "origin", "mirrored")
"""What else a branch has."""


def save(diagram: Diagram, path: str | PathLike[str]) -> None:
    """Write `diagram` to `path`, which ends in .npz; see `ribbonrs.archive.save`."""
    contents: dict[str, Any] = {
        "units": UNITS,
        "scene": json.dumps(record_of(diagram.scene)),
        "parameter": diagram.parameter,
        "span": np.array(diagram.span),
        "special": json.dumps([_special_record(point) for point in diagram.special_points]),
        "branches": len(diagram.branches),
    }
    for branch in diagram.branches:
        prefix = f"branch{branch.number}_"
        contents |= {prefix + name: getattr(branch, name) for name in ARRAYS}
        contents[prefix + "record"] = json.dumps(_branch_record(branch))
        contents[prefix + "solutions"] = json.dumps(_solutions(branch))
    archive.save(FORMAT, path, contents)


def load(path: str | PathLike[str]) -> Diagram:
    """Return the diagram in a file; see `ribbonrs.load_diagram`."""
    return archive.load(FORMAT, path, _diagram)


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
