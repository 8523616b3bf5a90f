"""Files of a state: its surface (.vtp, .obj) in the user's length unit, and all its data (.npz)."""

from __future__ import annotations

import base64
import json
import math
import os
import tempfile
from collections.abc import Collection, Iterator
from contextlib import contextmanager
from dataclasses import asdict
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from .arrays import Array
from .ends import Closed
from .errors import InputError
from .record import record_of

if TYPE_CHECKING:
    from .state import State

__all__ = ["WRITERS", "check_encoding", "check_path", "replacing", "save"]

NX = 41
"""Points across the width in every file."""

UNITS = (
    "S, x, strains, position, quaternion, directors, force, moment, reaction_force, reaction_moment, energy, "
    "load_potential, u: dimensionless (lengths in the width a, S = X3/a, x = X2 over the width at S, "
    "curvatures in 1/a, force, energy and load_potential in Y h a, moment in Y h a^2). "
    "physical_* and surface: the user's units, of which length_unit (a), force_unit (Y h a) and "
    "moment_unit (Y h a^2) are the factors. Strains are eps, K1, K2, K3; quaternions scalar first; "
    "directors are rows d1, d2, d3 in the fixed basis; force and moment are components on the directors, "
    "reactions on the fixed basis, rows for the start and the end; "
    "u is u1, u2, u3 at S, x. A function of S is kept in scene as its pieces: breaks in S and the Legendre "
    "coefficients of each. Where strains vary along S there is no helix: handedness, turns, "
    "physical_radius and physical_pitch are left out, and where stability is not known index and stable."
)


def save(state: State, path: str | PathLike[str]) -> None:
    """Write `state` to `path`, whose suffix decides the format.

    ``.vtp`` (VTK XML PolyData): the mid-surface as quadrilaterals in the user's length unit, with the
    deflection u1 in the same unit and the dimensionless S, x and strains at each point. ``.obj``
    (Wavefront): the same quadrilaterals alone. ``.npz`` (numpy): every array, number and the scene, with a
    note on units in ``units``.

    An existing file is replaced as a whole; when writing fails it stays as it was.

    Raises
    ------
    InputError
        No file name, another suffix, or a directory that does not exist.
    OSError
        The file cannot be written.
    """
    suffix = check_path(path, WRITERS)
    with replacing(path) as temporary:
        WRITERS[suffix](state, temporary)


def check_path(path: object, suffixes: Collection[str]) -> str:
    """Return the suffix of a file name that can be written."""
    expected = "a file name ending in " + " or ".join(suffixes)
    if not isinstance(path, str | PathLike):
        raise InputError("path", path, expected)
    suffix = Path(path).suffix.lower()
    if suffix not in suffixes:
        raise InputError("path", str(path), expected)
    check_encoding("path", path)
    if not os.path.isdir(Path(path).parent):
        raise InputError("path", str(path), "a file in a directory that exists")
    return suffix


def check_encoding(field: str, path: str | PathLike[str]) -> None:
    """Refuse a name that the file system of this locale has no bytes for."""
    try:
        os.fsencode(path)
    except UnicodeEncodeError as error:
        raise InputError(field, str(path), f"a file name in the encoding {error.encoding}") from None


@contextmanager
def replacing(path: str | PathLike[str]) -> Iterator[Path]:
    """Yield a temporary file name beside `path`, to which it is renamed on success, else removed.

    A reader sees the old file or the whole new one, never half of it.
    """
    target = Path(path)
    handle, name = tempfile.mkstemp(prefix=f".{target.name}.", suffix=".tmp", dir=target.parent)
    os.close(handle)
    temporary = Path(name)
    try:
        yield temporary
        temporary.chmod(0o666 & ~_umask())
        temporary.replace(target)
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise


def _umask() -> int:
    """The permissions that new files do not get; it can only be read by setting it."""
    mask = os.umask(0)
    os.umask(mask)
    return mask


def _write_vtp(state: State, path: Path) -> None:
    a = state.scene.ribbon.width
    points, quads = _mesh(state)
    n = state.S.size
    x = np.linspace(-0.5, 0.5, NX)
    data = {
        "u1": a * state.deflection(x).ravel(),
        "S": np.repeat(state.S, NX),
        "x": np.tile(x, n),
        "strains": np.repeat(state.strains, NX, axis=0),
    }
    offsets = 4 * np.arange(1, len(quads) + 1)
    lines = [
        '<?xml version="1.0"?>',
        '<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian" header_type="UInt64">',
        "<!-- points, u1: in the user's length unit; S = X3/a, x = X2 over the width at S, strains: "
        "dimensionless -->",
        "<PolyData>",
        f'<Piece NumberOfPoints="{len(points)}" NumberOfVerts="0" NumberOfLines="0" NumberOfStrips="0" '
        f'NumberOfPolys="{len(quads)}">',
        '<PointData Scalars="u1">',
        *(_data_array(name, values) for name, values in data.items()),
        "</PointData>",
        "<Points>",
        _data_array("Points", points),
        "</Points>",
        "<Polys>",
        _data_array("connectivity", quads.ravel()),
        _data_array("offsets", offsets),
        "</Polys>",
        "</Piece>",
        "</PolyData>",
        "</VTKFile>",
    ]
    path.write_text("\n".join(lines) + "\n", encoding="ascii", newline="\n")


def _data_array(name: str, values: NDArray[Any]) -> str:
    """A VTK DataArray: the number of bytes, then the values, both little-endian in base 64."""
    kind, stored = ("Float64", "<f8") if values.dtype.kind == "f" else ("Int64", "<i8")
    components = values.shape[1] if values.ndim == 2 else 1
    raw = np.ascontiguousarray(values, dtype=stored).tobytes()
    text = base64.b64encode(len(raw).to_bytes(8, "little") + raw).decode("ascii")
    head = f'<DataArray type="{kind}" Name="{name}" NumberOfComponents="{components}" format="binary">'
    return f"{head}{text}</DataArray>"


def _write_obj(state: State, path: Path) -> None:
    points, quads = _mesh(state)
    with path.open("w", encoding="ascii", newline="\n") as file:
        file.write("# mid-surface of a ribbon, lengths in the user's unit\n")
        file.writelines(f"v {p[0]!r} {p[1]!r} {p[2]!r}\n" for p in points.tolist())
        file.writelines("f {} {} {} {}\n".format(*quad) for quad in (quads + 1).tolist())


def _write_npz(state: State, path: Path) -> None:
    from importlib.metadata import version  # slow to load

    ribbon, physical, reactions = state.scene.ribbon, state.physical, state.reactions
    x = np.linspace(-0.5, 0.5, NX)
    force_unit = ribbon.material.Y * ribbon.thickness * ribbon.width
    contents: dict[str, Any] = {
        "S": state.S,
        "x": x,
        "strains": state.strains,
        "position": state.position,
        "quaternion": state.quaternion,
        "directors": state.directors,
        "force": state.force,
        "moment": state.moment,
        "reaction_force": np.stack([wrench.force for wrench in (reactions.start, reactions.end)]),
        "reaction_moment": np.stack([wrench.moment for wrench in (reactions.start, reactions.end)]),
        "u": state.displacements(x),
        "energy": state.energy,
        "load_potential": state.load_potential,
        "section_index": state.section_index,
        "resolved": state.resolved,
        "phase": state.phase,
        "phases": state.phases,
        "physical_S": physical.S,
        "physical_strains": physical.strains,
        "physical_position": physical.position,
        "physical_force": physical.force,
        "physical_moment": physical.moment,
        "physical_energy": physical.energy,
        "physical_load_potential": physical.load_potential,
        "surface": ribbon.width * state.surface(NX),
        "length_unit": ribbon.width,
        "force_unit": force_unit,
        "moment_unit": force_unit * ribbon.width,
        "units": UNITS,
        "scene": json.dumps(record_of(state.scene)),
        "report": json.dumps(_finite(asdict(state.report))),
        "ribbonrs_version": version("ribbonrs"),
    }
    if state.index is not None:
        contents |= {"index": state.index, "stable": state.stable}
    if physical.helix is not None:
        contents |= {
            "handedness": physical.helix.handedness,
            "turns": physical.helix.turns,
            "physical_radius": physical.helix.radius,
            "physical_pitch": physical.helix.pitch,
        }
    with path.open("wb") as file:
        np.savez_compressed(file, **contents)


def _finite(value: Any) -> Any:
    """None for a number that JSON cannot say, within dictionaries, lists and tuples."""
    if isinstance(value, dict):
        return {key: _finite(entry) for key, entry in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(entry) for entry in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _mesh(state: State) -> tuple[Array, NDArray[np.int64]]:
    """Mid-surface points (n NX, 3) in the user's length unit and quadrilaterals (m, 4) facing +d1.

    The last row of points of a closed ribbon is its first, from the other side after odd half turns; the last
    quadrilaterals meet the first.
    """
    points = state.scene.ribbon.width * state.surface(NX)
    number = np.arange(points.shape[0] * NX, dtype=np.int64).reshape(-1, NX)
    start = state.scene.start
    if isinstance(start, Closed):
        number[-1] = number[0, ::-1] if start.one_sided else number[0]
    corners = (number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1])
    return points.reshape(-1, 3), np.stack(corners, axis=-1).reshape(-1, 4)


WRITERS = {".vtp": _write_vtp, ".obj": _write_obj, ".npz": _write_npz}
"""How to write each kind of file."""
