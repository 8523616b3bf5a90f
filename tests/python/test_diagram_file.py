"""A diagram is the same after it was saved and read; what is no diagram is refused in one line."""

import csv
from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest
import ribbonrs as rb
from fake_core import CLAMPED, EDGE, FakeTrace, edge_trace, pressed_trace
from refusal import refuses
from ribbonrs import _core
from ribbonrs.branch import ARRAYS


@pytest.fixture
def natural(monkeypatch):
    monkeypatch.setattr(_core, "trace_natural", lambda *arguments: edge_trace(), raising=False)
    functions = {"K2 = 0.4": lambda state: state.strain[2] - 0.4}
    return rb.trace(EDGE, "growth.edge.amplitude", (0.0, 0.08), functions=functions)


@pytest.fixture
def held(monkeypatch):
    monkeypatch.setattr(_core, "trace", lambda *arguments: pressed_trace(), raising=False)
    return rb.trace(CLAMPED, "end.force", (-3e-4, 0.0), n=51)


@pytest.fixture(params=["natural", "held"])
def diagram(request):
    return request.getfixturevalue(request.param)


def told(diagram):
    """What is told of a diagram besides its branches."""
    points = [
        (p.kind, p.parameter, p.multiplicity, p.branch, p.place, p.name, p.reason)
        for p in diagram.special_points
    ]
    return diagram.scene, diagram.parameter, diagram.span, points


def test_round_trip(diagram, tmp_path):
    diagram.save(tmp_path / "a.npz")
    read = rb.load_diagram(tmp_path / "a.npz")
    assert told(read) == told(diagram)
    for one, other in zip(read.branches, diagram.branches, strict=True):
        for name in ARRAYS:
            np.testing.assert_array_equal(getattr(one, name), getattr(other, name))
        for name in ("number", "ended", "reason", "origin", "mirrored", "phases", "held"):
            assert getattr(one, name) == getattr(other, name)
        for i in (0, -1):
            first, second = one.state(i), other.state(i)
            np.testing.assert_array_equal(first.position, second.position)
            assert (first.index, first.energy, first.phase) == (second.index, second.energy, second.phase)
    assert read.table() == diagram.table()
    assert repr(read) == repr(diagram)


def test_again_round_trip(held, tmp_path):
    held.save(tmp_path / "a.npz")
    rb.Diagram.load(tmp_path / "a.npz").save(tmp_path / "b.npz")
    np.testing.assert_array_equal(
        rb.Diagram.load(str(tmp_path / "b.npz")).branches[0].state(2).strains,
        held.branches[0].state(2).strains,
    )


def test_nothing_lies_between_points_of_a_file(natural, tmp_path):
    natural.save(tmp_path / "a.npz")
    read = rb.load_diagram(tmp_path / "a.npz")
    assert [state.phase for state in read.states_at(0.08)] == ["flat", "bent", "twisted"]
    refuses("state", lambda: read.states_at(0.06))
    (zero,) = [point for point in read.special_points if point.kind == "zero"]
    refuses("state", lambda: zero.state)


def test_the_file_explains_itself(natural, tmp_path):
    natural.save(tmp_path / "a.npz")
    with np.load(tmp_path / "a.npz") as file:
        assert str(file["format"]) == "ribbonrs diagram"
        assert "dimensionless" in str(file["units"])
        assert file["branch1_parameter"].shape == (7,)


def test_growth_given_by_functions(monkeypatch, tmp_path):
    monkeypatch.setattr(_core, "trace", lambda *arguments: FakeTrace([], []), raising=False)
    scene = rb.Scene(EDGE.ribbon, rb.growth.edge(lambda S: 0.01 + 0.001 * S))
    rb.trace(scene, "growth.edge.amplitude", (0.0, 2.0)).save(tmp_path / "a.npz")
    read = rb.load_diagram(tmp_path / "a.npz").scene
    np.testing.assert_allclose(read.growth.values(0.5, [0.0, 5.0])["gamma33"], [0.01, 0.015])


def test_names_that_cannot_be(natural, tmp_path):
    for path in (tmp_path / "a.png", tmp_path / "no" / "a.npz", 3, None):
        refuses("path", lambda path=path: natural.save(path))
    for path in (tmp_path / "none.npz", tmp_path, 3):
        refuses("path", lambda path=path: rb.load_diagram(path))


def test_files_that_are_no_diagrams(natural, held, tmp_path):
    path = tmp_path / "a.npz"
    foreign = [b"", b"PK", b"text\n" * 100, b"\x93NUMPY"]
    rb.solve(EDGE).save(path)
    foreign.append(path.read_bytes())
    np.savez(path, format="ribbonrs diagram", version=2)
    foreign.append(path.read_bytes())
    np.savez(path, format="ribbonrs diagram", version=1, scene="{}")
    foreign.append(path.read_bytes())
    np.savez(path, format=np.array([None], dtype=object))
    foreign.append(path.read_bytes())
    for content in foreign:
        path.write_bytes(content)
        refuses("path", lambda: rb.load_diagram(path))
        assert path.read_bytes() == content


def test_every_part_of_a_file(held, tmp_path):
    held.save(tmp_path / "a.npz")
    whole = (tmp_path / "a.npz").read_bytes()
    for size in range(0, len(whole) - 1, len(whole) // 60):
        (tmp_path / "b.npz").write_bytes(whole[:size])
        refuses("path", lambda: rb.load_diagram(tmp_path / "b.npz"))


def test_damaged_files_are_refused_or_read(natural, tmp_path):
    natural.save(tmp_path / "a.npz")
    whole = bytearray((tmp_path / "a.npz").read_bytes())
    for at in range(0, len(whole), len(whole) // 80):
        damaged = bytearray(whole)
        damaged[at] ^= 0xFF
        (tmp_path / "b.npz").write_bytes(damaged)
        with suppress(rb.InputError):
            assert told(rb.load_diagram(tmp_path / "b.npz")) == told(natural)


def test_a_failed_save_leaves_the_old_file(natural, tmp_path, monkeypatch):
    path = tmp_path / "a.npz"
    path.write_text("old")

    def full(*arguments, **contents):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(np, "savez_compressed", full)
    with pytest.raises(OSError, match="No space"):
        natural.save(path)
    assert [file.name for file in tmp_path.iterdir()] == ["a.npz"]
    assert path.read_text() == "old"


def test_table_as_csv(natural, tmp_path):
    natural.to_csv(tmp_path / "a.csv")
    with Path(tmp_path / "a.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    table = natural.table()
    assert list(rows[0]) == list(table)
    assert [float(row["K2"]) for row in rows] == table["K2"]
    assert rows[2]["special"] == "branch_point"
