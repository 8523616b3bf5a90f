"""Files of a state, read back without the libraries they are for."""

import base64
import json
import re
import stat
from xml.etree import ElementTree

import numpy as np
import pytest
import ribbonrs as rb
from refusal import refuses
from ribbonrs.files import replacing
from ribbonrs.pieces import Pieces

LEAF = rb.Ribbon(
    length=30.0, width=1.5, thickness=0.15, material=rb.Orthotropic(Q33=3e6, Q22=1e6, Q23=3e5, G=4e5)
)
GROWTH = rb.growth.edge(0.06) + rb.growth.chiral(0.04)
N, NX = 31, 41


@pytest.fixture(scope="module")
def state():
    return rb.solve(rb.Scene(LEAF, GROWTH, start=rb.Clamped((1.0, 2.0, 3.0), (0.1, 0.2, 0.3))), n=N)


def expected_quads():
    """Corners of every quadrilateral, in the order that faces +d1."""
    return [
        [i * NX + j, i * NX + j + 1, (i + 1) * NX + j + 1, (i + 1) * NX + j]
        for i in range(N - 1)
        for j in range(NX - 1)
    ]


def read_vtp(path):
    """The pieces of a PolyData file: attributes, and arrays by section and name."""
    root = ElementTree.parse(path).getroot()
    assert root.tag == "VTKFile"
    assert root.attrib["type"] == "PolyData"
    assert (root.attrib["byte_order"], root.attrib["header_type"]) == ("LittleEndian", "UInt64")
    (piece,) = root.findall("PolyData/Piece")
    arrays = {}
    for section in piece:
        for array in section:
            raw = base64.b64decode(array.text, validate=True)
            size = int.from_bytes(raw[:8], "little")
            assert size == len(raw) - 8
            kind = {"Float64": "<f8", "Int64": "<i8"}[array.attrib["type"]]
            values = np.frombuffer(raw[8:], dtype=kind)
            components = int(array.attrib["NumberOfComponents"])
            shape = (-1,) if components == 1 else (-1, components)
            arrays[section.tag, array.attrib["Name"]] = values.reshape(shape)
    return piece.attrib, arrays


def test_vtp(state, tmp_path):
    path = tmp_path / "leaf.vtp"
    state.save(path)
    counts, arrays = read_vtp(path)
    assert counts == {
        "NumberOfPoints": str(N * NX),
        "NumberOfPolys": str((N - 1) * (NX - 1)),
        "NumberOfVerts": "0",
        "NumberOfLines": "0",
        "NumberOfStrips": "0",
    }
    surface = state.surface(nx=NX)
    assert np.array_equal(arrays["Points", "Points"], 1.5 * surface.reshape(-1, 3))
    connectivity, offsets = arrays["Polys", "connectivity"], arrays["Polys", "offsets"]
    assert connectivity.reshape(-1, 4).tolist() == expected_quads()
    assert np.array_equal(offsets, 4 * np.arange(1, (N - 1) * (NX - 1) + 1))
    x = np.linspace(-0.5, 0.5, NX)
    assert np.array_equal(arrays["PointData", "u1"].reshape(N, NX), 1.5 * state.deflection(x))
    assert np.array_equal(arrays["PointData", "S"].reshape(N, NX), np.tile(state.S[:, None], NX))
    assert np.array_equal(arrays["PointData", "x"].reshape(N, NX), np.tile(x, (N, 1)))
    assert np.array_equal(arrays["PointData", "strains"], np.tile(state.strain, (N * NX, 1)))
    assert {name for section, name in arrays if section == "PointData"} == {"u1", "S", "x", "strains"}


def test_quadrilaterals_face_d1(state, tmp_path):
    state.save(tmp_path / "leaf.vtp")
    _, arrays = read_vtp(tmp_path / "leaf.vtp")
    corners = arrays["Points", "Points"][arrays["Polys", "connectivity"].reshape(-1, 4)]
    normal = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]).reshape(N - 1, NX - 1, 3)
    assert np.all(np.einsum("ijc,ic->ij", normal, state.directors[:-1, 0]) > 0.0)


def test_obj(state, tmp_path):
    path = tmp_path / "leaf.OBJ"  # suffixes in any case
    state.save(path)
    lines = path.read_text(encoding="ascii").splitlines()
    points = [[float(word) for word in line.split()[1:]] for line in lines if line.startswith("v ")]
    faces = [[int(word) - 1 for word in line.split()[1:]] for line in lines if line.startswith("f ")]
    assert len(points) + len(faces) + sum(line.startswith("#") for line in lines) == len(lines)
    assert np.array_equal(points, 1.5 * state.surface(nx=NX).reshape(-1, 3))
    assert faces == expected_quads()


def test_npz(state, tmp_path):
    path = tmp_path / "leaf.npz"
    state.save(path)
    with np.load(path, allow_pickle=False) as data:
        for name in ("S", "strains", "position", "quaternion", "directors", "force", "moment"):
            assert np.array_equal(data[name], getattr(state, name)), name
        for name in ("energy", "section_index", "index", "stable", "resolved", "phase"):
            assert data[name].item() == getattr(state, name), name
        physical = state.physical
        for name in ("S", "strains", "position", "force", "moment", "energy"):
            assert np.array_equal(data[f"physical_{name}"], getattr(physical, name)), name
        helix = physical.helix
        assert data["physical_radius"] == helix.radius
        assert data["physical_pitch"] == helix.pitch
        assert (data["turns"], data["handedness"].item()) == (helix.turns, "right")
        assert np.array_equal(data["surface"], 1.5 * state.surface(nx=NX))
        assert np.array_equal(data["u"], state.displacements(data["x"]))
        Y = LEAF.material.Y
        units = [data[f"{name}_unit"].item() for name in ("length", "force", "moment")]
        assert units == pytest.approx([1.5, Y * 0.15 * 1.5, Y * 0.15 * 1.5**2], rel=1e-15)
        assert data["ribbonrs_version"].item().startswith("0.")
        note = data["units"].item()
        named = set(re.findall(r"\w+", note))
        for name, values in data.items():
            if values.dtype.kind == "f" and values.ndim:
                assert name in named or name.startswith("physical_"), f"{name} has no word on its unit"
        scene, report = json.loads(data["scene"].item()), json.loads(data["report"].item())
    assert scene["ribbon"] == {
        "length": 30.0,
        "width": 1.5,
        "thickness": 0.15,
        "width_profile": None,
        "thickness_profile": None,
        "material": {"kind": "Orthotropic", "Q33": 3e6, "Q22": 1e6, "Q23": 3e5, "G": 4e5},
    }
    assert [(term["name"], term["amplitude"]) for term in scene["growth"]["terms"]] == [
        ("edge", 0.06),
        ("chiral", 0.04),
    ]
    assert scene["start"]["kind"] == "Clamped"
    assert scene["start"]["position"] == [1.0, 2.0, 3.0]
    assert scene["end"] == {"kind": "Free", "force": [0.0, 0.0, 0.0], "moment": [0.0, 0.0, 0.0]}
    assert scene["law"] == "full"
    assert report["equilibria"] == state.report.equilibria


def test_json_has_no_infinities(tmp_path):
    """A flat ribbon has an infinite pitch, which JSON cannot say."""
    state = rb.solve(rb.Scene(LEAF, rb.growth.edge(0.0)))
    state.save(tmp_path / "flat.npz")
    with np.load(tmp_path / "flat.npz", allow_pickle=False) as data:
        assert data["physical_pitch"] == np.inf
        for name in ("scene", "report"):
            json.loads(data[name].item(), parse_constant=lambda word: pytest.fail(word))


def test_the_data_do_not_depend_on_when_they_are_written(state, tmp_path):
    for suffix in ("vtp", "obj"):
        first, second = tmp_path / f"a.{suffix}", tmp_path / f"b.{suffix}"
        state.save(first)
        state.save(second)
        assert first.read_bytes() == second.read_bytes()


@pytest.mark.parametrize("name", ["leaf", "leaf.txt", "leaf.vtk", "leaf.vtp.gz", ".vtp", ""])
def test_other_suffixes_are_refused(state, tmp_path, name):
    refuses("path", lambda: state.save(tmp_path / name if name else ""))
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("suffix", ["vtp", "obj", "npz"])
def test_a_missing_folder_is_refused(state, tmp_path, suffix):
    refuses("path", lambda: state.save(tmp_path / "nowhere" / f"leaf.{suffix}"))
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("suffix", ["vtp", "obj", "npz"])
def test_an_existing_file_is_replaced(state, tmp_path, suffix):
    path = tmp_path / f"leaf.{suffix}"
    path.write_text("old")
    state.save(str(path))
    assert path.stat().st_size > 1000
    assert [entry.name for entry in tmp_path.iterdir()] == [path.name]


def half_write(path):
    with replacing(path) as temporary:
        temporary.write_text("half")
        assert path.read_text() == "old"
        raise RuntimeError("disk full")


def test_when_writing_fails_the_old_file_stays(tmp_path):
    path = tmp_path / "leaf.obj"
    path.write_text("old")
    with pytest.raises(RuntimeError, match="disk full"):
        half_write(path)
    assert path.read_text() == "old"
    assert [entry.name for entry in tmp_path.iterdir()] == ["leaf.obj"]


def test_files_have_the_permissions_of_any_new_file(state, tmp_path):
    plain = tmp_path / "plain"
    plain.write_text("")
    state.save(tmp_path / "leaf.obj")
    assert stat.S_IMODE((tmp_path / "leaf.obj").stat().st_mode) == stat.S_IMODE(plain.stat().st_mode)


# --- ribbons that vary along their length


def thinner(S):
    return np.exp2(-0.2 * S)


@pytest.fixture(scope="module")
def petal():
    ribbon = rb.Ribbon(10.0, 2.0, 0.2, width_profile=([0.0, 5.0], [1.0, 0.5]), thickness_profile=thinner)
    growth = rb.growth.edge(lambda S: 0.06 + 0.01 * S) + rb.growth.chiral(([0.0, 5.0], [0.02, 0.04]))
    step = rb.growth.Profile(gamma22=[[0.01], [0.02]], breaks=[0.1])
    with pytest.warns(rb.RibbonWarning, match=r"growth\.size"):
        return rb.solve(rb.Scene(ribbon, growth + step), n=N)


def evaluated(record, places):
    """A function as it is in a file."""
    return Pieces(tuple(record["breaks"]), tuple(map(tuple, record["coefficients"]))).evaluate(places)


def test_npz_of_a_ribbon_that_varies(petal, tmp_path):
    petal.save(tmp_path / "petal.npz")
    S = petal.S
    with np.load(tmp_path / "petal.npz", allow_pickle=False) as data:
        for name in ("S", "strains", "position", "quaternion", "directors", "force", "moment"):
            assert np.array_equal(data[name], getattr(petal, name)), name
        assert np.ptp(data["strains"][:, 2]) > 0.01
        assert np.array_equal(data["surface"], 2.0 * petal.surface(nx=NX))
        assert np.array_equal(data["u"], petal.displacements(data["x"]))
        assert tuple(data["phases"]) == petal.phases
        # there is no helix, and the note says so
        for name in ("handedness", "turns", "physical_radius", "physical_pitch"):
            assert name not in data
            assert name in data["units"].item()
        scene, report = json.loads(data["scene"].item()), json.loads(data["report"].item())
    # functions as their pieces, samples as they were given
    edge, chiral, step = scene["growth"]["terms"]
    assert evaluated(edge["amplitude"], S) == pytest.approx(0.06 + 0.01 * S, rel=1e-14)
    assert evaluated(chiral["amplitude"], S) == pytest.approx(0.02 + 0.004 * S, rel=1e-14)
    assert (edge["shape"], chiral["shape"]) == ([["gamma33", [0.0, 0.0, 4.0]]], [["d23", [1.0]]])
    ((key, field),) = step["shape"]
    assert key == "gamma22"
    assert evaluated(field, [0.0, 0.2]).tolist() == [0.01, 0.02]
    assert scene["ribbon"]["width_profile"] == [[0.0, 5.0], [1.0, 0.5]]
    assert evaluated(scene["ribbon"]["thickness_profile"], S) == pytest.approx(thinner(S), abs=1e-14)
    assert report["elements"] == petal.report.elements
    assert report["events"] == []


def test_events_are_in_the_report(tmp_path):
    rising = rb.Scene(LEAF, rb.growth.edge(([0.0, 20.0], [0.0, 0.08])))
    state = rb.solve(rising)
    state.save(tmp_path / "leaf.npz")
    with np.load(tmp_path / "leaf.npz", allow_pickle=False) as data:
        (event,) = json.loads(data["report"].item())["events"]
    assert event == {
        key: list(v) if isinstance(v, tuple) else v for key, v in vars(state.report.events[0]).items()
    }


def test_vtp_of_a_ribbon_that_varies(petal, tmp_path):
    petal.save(tmp_path / "petal.vtp")
    _, arrays = read_vtp(tmp_path / "petal.vtp")
    points = arrays["Points", "Points"].reshape(N, NX, 3)
    assert np.array_equal(points, 2.0 * petal.surface(nx=NX))
    x = np.linspace(-0.5, 0.5, NX)
    assert np.array_equal(arrays["PointData", "u1"].reshape(N, NX), 2.0 * petal.deflection(x))
    assert np.array_equal(arrays["PointData", "strains"], np.repeat(petal.strains, NX, axis=0))
    width = np.sum(np.linalg.norm(np.diff(points, axis=1), axis=-1), axis=1)
    # the sections are curved, and their g22 is 1 to 2 %
    assert width == pytest.approx(2.0 * np.interp(petal.S, [0.0, 5.0], [1.0, 0.5]), rel=0.05)


@pytest.mark.parametrize("path", [None, 3, b"leaf.vtp", "nowhere/leaf.vtp"])
def test_what_is_no_file_name_is_refused(path):
    refuses("path", lambda: rb.solve(rb.Scene(LEAF, rb.growth.edge(0.06))).save(path))
