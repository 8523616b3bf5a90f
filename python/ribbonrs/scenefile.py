"""Scene files: the same problem as the Python objects, written in TOML.

pydantic checks the structure: which tables and keys there are. Values are checked by the classes they are
for, so that a scene file and a Python program obey the same rules.
"""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Callable
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal

from pydantic import BeforeValidator, Discriminator, Field, Tag, ValidationError
from pydantic_core import ErrorDetails

from .boundary import degree_of, tolerance
from .ends import Clamped, Closed, Free, Hinged, Pinned, Sliding
from .errors import MISSING, InputError, shown
from .growthtable import TABLE, VALUE, Along, GrowthTable, Table, as_list, table_or_value
from .linear import LinearLaw
from .loads import LineLoad, PointLoad, weight
from .material import Isotropic, MooneyRivlin, Orthotropic
from .outputs import SWEPT, TRACED, Output, OutputTable
from .ribbon import Ribbon
from .scene import Scene
from .sweeptable import Sweeping, SweepTable
from .tracetable import TraceTable, Tracing

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

__all__ = ["Job", "read"]


@dataclass(frozen=True)
class Job:
    """What a scene file asks for."""

    scene: Scene
    options: dict[str, Any]
    """`tol` and `degree` for `solve`, if they are given."""
    outputs: tuple[Output, ...]
    """What `ribbonrs run` writes."""
    trace: Tracing | None
    traced: tuple[Output, ...]
    """What `ribbonrs trace` writes."""
    sweep: Sweeping | None
    swept: tuple[Output, ...]
    """What `ribbonrs sweep` writes."""


def read(path: str | os.PathLike[str]) -> Job:
    """Read and check a scene file.

    Files to read are relative to the directory of the scene file, files to write to the current one.

    Raises
    ------
    InputError
        One line about the first thing that is wrong; the file itself is the field "scene file".
    """
    tables = _parse(path)
    try:
        return _SceneTable.model_validate(tables).make(Path(path).parent)
    except ValidationError as error:
        details = error.errors(include_url=False)
        # A misspelt key is also a missing one: name the misspelling.
        details.sort(key=lambda detail: detail["type"] != "unknown_key")
        raise _input_error(details[0]) from None


def _parse(path: str | os.PathLike[str]) -> dict[str, Any]:
    field, name = "scene file", os.fspath(path)
    try:
        text = Path(path).read_bytes().decode("utf-8-sig")
        return tomllib.loads(text)
    except OSError as error:
        raise InputError(field, name, f"a readable file, not: {error.strerror}") from None
    except UnicodeDecodeError as error:
        raise InputError(field, name, f"UTF-8 text, unlike byte {error.start}") from None
    except RecursionError:
        raise InputError(field, name, "TOML with fewer nested brackets") from None
    except ValueError as error:  # of which TOMLDecodeError is one
        raise InputError(field, name, f"TOML, not: {error}") from None


class _RibbonTable(Table):
    length: Any
    width: Any
    thickness: Any
    width_profile: Along = None
    thickness_profile: Along = None


class _Kind(Table):
    """A table whose `kind` says which class the other keys are for."""

    makes: ClassVar[Callable[..., Any]]

    def make(self) -> Any:
        return type(self).makes(**self.given())


class _Isotropic(_Kind):
    makes = Isotropic
    kind: Literal["isotropic"]
    Y: Any = None
    nu: Any = None


class _MooneyRivlin(_Kind):
    makes = MooneyRivlin
    kind: Literal["mooney-rivlin"]
    c1: Any
    c2: Any


class _Orthotropic(_Kind):
    makes = Orthotropic
    kind: Literal["orthotropic"]
    Q33: Any
    Q22: Any
    Q23: Any
    G: Any


class _Clamped(_Kind):
    makes = Clamped
    kind: Literal["clamped"]
    position: Any = None
    rotation: Any = None
    twist_turns: Any = None


class _Free(_Kind):
    makes = Free
    kind: Literal["free"]
    force: Any = None
    moment: Any = None


class _Pinned(_Kind):
    makes = Pinned
    kind: Literal["pinned"]
    position: Any = None
    moment: Any = None


class _Hinged(_Kind):
    makes = Hinged
    kind: Literal["hinged"]
    director: Any = None
    position: Any = None
    moment: Any = None


class _Sliding(_Kind):
    makes = Sliding
    kind: Literal["sliding"]
    axis: Any = None
    rotation: Any = None
    twist_turns: Any = None
    force: Any = None


class _Closed(_Kind):
    makes = Closed
    kind: Literal["closed"]
    link: Any = None


class _PointLoad(_Kind):
    makes = PointLoad
    kind: Literal["point"]
    S: Any
    force: Any = None
    moment: Any = None


class _LineLoad(_Kind):
    makes = LineLoad
    kind: Literal["line"]
    force: Along = None
    moment: Along = None


class _WeightTable(Table):
    density: Any
    g: Any


class _LawTable(Table):
    EA: Any = None
    EI1: Any
    EI2: Any
    GJ: Any
    inextensible: Any = None
    intrinsic: Any = None


class _SolveTable(Table):
    tol: Any = None
    degree: Any = None

    def make(self) -> dict[str, Any]:
        checks: dict[str, Callable[[str, object], Any]] = {"tol": tolerance, "degree": degree_of}
        return {key: checks[key](f"solve.{key}", value) for key, value in self.given().items()}


_MaterialTable = Annotated[_Isotropic | _MooneyRivlin | _Orthotropic, Discriminator("kind")]
_EndTable = Annotated[_Clamped | _Free | _Pinned | _Hinged | _Sliding, Discriminator("kind")]
_StartTable = Annotated[_Clamped | _Free | _Pinned | _Hinged | _Sliding | _Closed, Discriminator("kind")]
_LoadTable = Annotated[_PointLoad | _LineLoad, Discriminator("kind")]
_Law = Annotated[Annotated[_LawTable, Tag(TABLE)] | Annotated[Any, Tag(VALUE)], Discriminator(table_or_value)]
_ENDS = ("clamped", "free", "pinned", "hinged", "sliding")
_KINDS = {
    "material": ("isotropic", "mooney-rivlin", "orthotropic"),
    "start": (*_ENDS, "closed"),
    "end": _ENDS,
    "loads": ("point", "line"),
}


class _SceneTable(Table):
    ribbon: _RibbonTable
    material: _MaterialTable | None = None
    growth: GrowthTable | None = None
    start: _StartTable | None = None
    end: _EndTable | None = None
    gravity: Any = None
    weight: _WeightTable | None = None
    loads: Annotated[list[_LoadTable], BeforeValidator(as_list)] = Field(default_factory=list)
    law: _Law = None
    solve: _SolveTable = _SolveTable()
    trace: TraceTable | None = None
    sweep: SweepTable | None = None
    output: OutputTable = OutputTable()

    def make(self, directory: Path) -> Job:
        given = self.given()
        ribbon = self.ribbon.given()
        if self.material is not None:
            ribbon["material"] = self.material.make()
        arguments: dict[str, Any] = {"ribbon": Ribbon(**ribbon)}
        if self.growth is not None:
            arguments["growth"] = self.growth.make(directory)
        for end in ("start", "end"):
            if end in given:
                arguments[end] = _named(end, given[end])
        if isinstance(arguments.get("start"), Closed) and "end" in given:
            raise InputError("end.kind", given["end"].kind, "no table [end]: a closed ribbon has no ends")
        if "gravity" in given:
            arguments["gravity"] = self.gravity
        if self.weight is not None:
            if "gravity" in given:
                raise InputError("gravity", self.gravity, "none beside the table [weight]")
            arguments["gravity"] = weight(arguments["ribbon"], **self.weight.given())
        arguments["loads"] = [_named(f"loads[{i}]", load) for i, load in enumerate(self.loads)]
        if "law" in given:
            arguments["law"] = LinearLaw(**self.law.given()) if isinstance(self.law, _LawTable) else self.law
        tracing = None if self.trace is None else self.trace.make()
        sweeping = None if self.sweep is None else self.sweep.make()
        read = () if self.growth is None else self.growth.reads(directory)
        options, outputs = self.solve.make(), self.output.make(read)
        scene = Scene(**arguments)
        for asked in (tracing, sweeping):
            if asked is not None:
                asked.check(scene)
        solved = tuple(output for output in outputs if output.kind not in (*TRACED, *SWEPT))
        traced, swept = _shared(outputs, tracing is not None, sweeping is not None)
        return Job(scene, options, solved, tracing, traced, sweeping, swept)


def _shared(
    outputs: tuple[Output, ...], traces: bool, sweeps: bool
) -> tuple[tuple[Output, ...], tuple[Output, ...]]:
    """The files of `ribbonrs trace` and those of `ribbonrs sweep`; a table is of the one that is run."""
    traced = tuple(o for o in outputs if o.kind in TRACED and (o.kind not in SWEPT or traces or not sweeps))
    swept = tuple(o for o in outputs if o.kind in SWEPT and (o.kind not in TRACED or sweeps))
    for name, files, is_there in (("trace", traced, traces), ("sweep", swept, sweeps)):
        if files and not is_there:
            raise InputError(name, MISSING, f"a table, of which {files[0].field} asks for a file")
    return traced, swept


def _named(field: str, table: _Kind) -> Any:
    """Make an end or a load; its class does not know which of several it is, so name the field here."""
    try:
        return table.make()
    except InputError as error:
        key = error.field.partition(".")[2]
        raise InputError(f"{field}.{key}", error.value, error.expected) from None


def _input_error(detail: ErrorDetails) -> InputError:
    """Say in one line what pydantic found wrong with the structure."""
    kind, value = detail["type"], detail["input"]
    loc = detail["loc"] or ("",)
    table, rest = loc[0], list(loc[1:])
    number: list[str | int] = [step for step in rest[:1] if isinstance(step, int)]
    if table in _KINDS:
        rest = number + rest[len(number) + 1 :]  # pydantic adds the kind chosen
    loc = tuple(step for step in (table, *rest) if step != TABLE) if table else ()
    if kind == "unknown_key":
        key, known = detail["ctx"]["key"], detail["ctx"]["known"]
        nearest = get_close_matches(key, known, n=1, cutoff=0.0)[0]
        expected = f"one of {', '.join(known)}; the nearest is {nearest}"
        return InputError(_path(*loc, key), value[key], expected)
    if kind in ("union_tag_invalid", "union_tag_not_found"):
        expected = f"one of {', '.join(_KINDS[str(table)])}"
        return InputError(_path(table, *number, "kind"), value.get("kind", MISSING), expected)
    if kind == "missing":
        return InputError(_path(*loc), MISSING, "a value" if rest else "a table")
    return InputError(_path(*loc), value, "a table")


def _path(*steps: str | int) -> str:
    """The place in the file, as ribbon.length or growth.profile[1].name."""
    path = ""
    for step in steps:
        if isinstance(step, int):
            path += f"[{step}]"
        else:
            key = step if re.fullmatch("[A-Za-z0-9_-]+", step) else shown(step)
            path += f".{key}" if path else key
    return path
