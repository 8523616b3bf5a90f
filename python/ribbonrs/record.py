"""A scene as what JSON can say, in files of states and of diagrams, and back."""

from __future__ import annotations

import math
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from .ends import Clamped, Closed, Free, Hinged, Pinned, Sliding
from .errors import RibbonWarning
from .linear import LinearLaw
from .loads import LineLoad, PointLoad
from .material import Isotropic, MooneyRivlin, Orthotropic
from .pieces import Pieces
from .ribbon import Ribbon
from .scene import Scene
from .terms import Growth, Term

if TYPE_CHECKING:
    from .loads import Load

__all__ = ["record_of", "same", "scene_of"]

CLOSE = 1e-9
"""Relative difference up to which two numbers of a scene are the same: what rescaling loads leaves."""

ENDS = {kind.__name__: kind for kind in (Clamped, Closed, Free, Hinged, Pinned, Sliding)}
MATERIALS = {kind.__name__: kind for kind in (Isotropic, MooneyRivlin, Orthotropic)}


def record_of(scene: Scene) -> dict[str, Any]:
    """Return all of `scene`; a function of S is kept as its pieces, a linear law by its compliances."""
    length = scene.ribbon.length_ratio
    terms = [
        {"name": term.name, "amplitude": _plain(term.along(length)), "shape": _plain(term.shape)}
        for term in scene.growth.terms
    ]
    return {
        "ribbon": _ribbon_record(scene.ribbon),
        "growth": {"terms": terms},
        "start": {"kind": type(scene.start).__name__, **asdict(scene.start)},
        "end": {"kind": type(scene.end).__name__, **asdict(scene.end)},
        "gravity": scene.gravity,
        "loads": [_load_record(load, length) for load in scene.loads],
        "law": _law_record(scene.law),
    }


def scene_of(record: Mapping[str, Any]) -> Scene:
    """Return the scene of a record, also of one that was JSON in between."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RibbonWarning)  # as it was when the scene was made
        return Scene(
            _ribbon(record["ribbon"]),
            Growth(tuple(_term(term) for term in record["growth"]["terms"])),
            _made(ENDS, record["start"]),
            _made(ENDS, record["end"]),
            record["gravity"],
            [_load(load) for load in record["loads"]],
            _law(record["law"]),
        )


def same(one: Any, other: Any) -> bool:
    """Whether two records are the same but for the rounding of their numbers."""
    if isinstance(one, float | int) and isinstance(other, float | int):
        return math.isclose(one, other, rel_tol=CLOSE)
    if isinstance(one, Mapping) and isinstance(other, Mapping):
        return one.keys() == other.keys() and all(same(one[key], other[key]) for key in one)
    if isinstance(one, list | tuple) and isinstance(other, list | tuple):
        return len(one) == len(other) and all(map(same, one, other))
    return bool(one == other)


def _load_record(load: Load, length: float) -> dict[str, Any]:
    if isinstance(load, PointLoad):
        return {"kind": "PointLoad", **asdict(load)}
    known = {name: [_plain(f) for f in components] for name, components in load.along(length).items()}
    return {"kind": "LineLoad", **known}


def _load(record: Mapping[str, Any]) -> Load:
    if record["kind"] == "PointLoad":
        return PointLoad(record["S"], record["force"], record["moment"])
    return LineLoad.of(**{name: tuple(map(_lively, record[name])) for name in ("force", "moment")})


def _law_record(law: str | LinearLaw) -> Any:
    """A linear law by its compliances, which are finite."""
    if isinstance(law, str):
        return law
    return {"kind": "LinearLaw", "compliance": law.compliance, "intrinsic": law.intrinsic}


def _law(record: Any) -> str | LinearLaw:
    if isinstance(record, str):
        return record
    stiffness = [1.0 / c if c != 0.0 else math.inf for c in record["compliance"]]
    given = dict(zip(("EA", "EI1", "EI2", "GJ"), stiffness, strict=True))
    return LinearLaw(**given, inextensible=math.isinf(given["EA"]), intrinsic=record["intrinsic"])


def _ribbon_record(ribbon: Ribbon) -> dict[str, Any]:
    record: dict[str, Any] = {name: getattr(ribbon, name) for name in ("length", "width", "thickness")}
    for name, given, pieces in (
        ("width_profile", ribbon.width_profile, ribbon.width_pieces),
        ("thickness_profile", ribbon.thickness_profile, ribbon.thickness_pieces),
    ):
        record[name] = _plain(pieces) if callable(given) else given
    record["material"] = {"kind": type(ribbon.material).__name__, **asdict(ribbon.material)}
    return record


def _ribbon(record: Mapping[str, Any]) -> Ribbon:
    given = {**record, "material": _made(MATERIALS, record["material"])}
    for name in ("width_profile", "thickness_profile"):
        profile = _lively(given[name])
        given[name] = profile.evaluate if isinstance(profile, Pieces) else profile and tuple(profile)
    return Ribbon(**given)


def _term(record: Mapping[str, Any]) -> Term:
    shape = tuple(
        (key, values if isinstance(values := _lively(field), Pieces) else tuple(values))
        for key, field in record["shape"]
    )
    return Term(record["name"], _lively(record["amplitude"]), shape)


def _made(kinds: Mapping[str, Any], record: Mapping[str, Any]) -> Any:
    """The object of a class that its record names."""
    return kinds[record["kind"]](**{key: value for key, value in record.items() if key != "kind"})


def _plain(value: object) -> Any:
    """Pieces, alone or within tuples, as dictionaries; all else as it is."""
    if isinstance(value, Pieces):
        return asdict(value)
    return [_plain(entry) for entry in value] if isinstance(value, tuple) else value


def _lively(value: Any) -> Any:
    """The pieces of a dictionary; all else as it is."""
    if not isinstance(value, Mapping):
        return value
    columns: Sequence[Any] = value["coefficients"]
    return Pieces(tuple(value["breaks"]), tuple(map(tuple, columns)))
