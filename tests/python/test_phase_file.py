"""Files and figures of phase diagrams, and `ribbonrs sweep`."""

import _thread
import csv
import threading
from pathlib import Path

import numpy as np
import pytest
import ribbonrs as rb
from ribbonrs.cli import main
from ribbonrs.phasediagram import PHASES

EDGE, SHEAR = "growth.edge.amplitude", "growth.chiral.amplitude"
SCENE = """
[ribbon]
length = 10.0
width = 1.0
thickness = 0.1
[growth]
edge = 0.06
chiral = 0.04
"""
SWEEP = f"""
[sweep]
x = {{parameter = "{SHEAR}", span = [0.01, 0.1]}}
y = {{parameter = "{EDGE}", span = [0.0, 0.1]}}
n = [12, 10]
"""
OUTPUT = '[output]\nmap = ["a.png", "a.svg"]\ntable = "a.csv"\nphases = "a.npz"\nfigure = "no.png"\n'


@pytest.fixture(scope="module")
def diagram():
    scene = rb.Scene(rb.Ribbon(10.0, 1.0, 0.1), rb.growth.edge(0.06) + rb.growth.chiral(0.04))
    return rb.phase_diagram(scene, (SHEAR, (0.0, 0.1)), (EDGE, (0.0, 0.09)), (13, 11))


def test_a_file_has_all_of_it(diagram, tmp_path):
    path = tmp_path / "phases.npz"
    diagram.save(path)
    again = rb.load_phase_diagram(path)
    assert repr(again) == repr(diagram)
    assert again.scene == diagram.scene
    assert again.areas == diagram.areas
    for name in ("phase", "stable", "stable_count", "energy", "K2", "K3", "resolved", "done"):
        assert np.array_equal(getattr(again, name), getattr(diagram, name)), name
    for line, other in zip(again.boundaries + again.rim, diagram.boundaries + diagram.rim, strict=True):
        assert np.array_equal(line.points, other.points)
        assert line.kind == other.kind
        assert line.phases == other.phases
        assert line.stable == other.stable
    with np.load(path) as file:  # no pickle
        assert str(file["format"]) == "ribbonrs phase diagram"
        assert "dimensionless" in str(file["units"])
    assert list(tmp_path.iterdir()) == [path]


def test_other_files_are_refused_in_one_line(diagram, tmp_path):
    path = tmp_path / "phases.npz"
    diagram.save(path)
    whole = path.read_bytes()
    for name, contents in (("cut", whole[: len(whole) // 2]), ("text", b"x,y\n"), ("empty", b"")):
        other = tmp_path / f"{name}.npz"
        other.write_bytes(contents)
        with pytest.raises(rb.InputError) as caught:
            rb.load_phase_diagram(other)
        assert "PhaseDiagram.save" in str(caught.value)
        assert "\n" not in str(caught.value)
    np.savez(tmp_path / "foreign.npz", a=np.zeros(3))
    with pytest.raises(rb.InputError, match="a ribbonrs phase diagram of version 1"):
        rb.PhaseDiagram.load(tmp_path / "foreign.npz")
    with pytest.raises(rb.InputError, match="a readable file"):
        rb.load_phase_diagram(tmp_path / "none.npz")
    for bad in ("a.txt", 3, tmp_path / "no" / "a.npz"):
        with pytest.raises(rb.InputError, match="path"):
            diagram.save(bad)


def test_a_failure_to_write_leaves_the_old_file(diagram, tmp_path, monkeypatch):
    path = tmp_path / "phases.npz"
    path.write_bytes(b"old")

    def full(file, **contents):
        file.write(b"half")
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(np, "savez_compressed", full)
    with pytest.raises(OSError, match="No space"):
        diagram.save(path)
    assert path.read_bytes() == b"old"
    assert list(tmp_path.iterdir()) == [path]


def test_the_table_has_every_point(diagram, tmp_path):
    diagram.to_csv(tmp_path / "a.csv")
    with (tmp_path / "a.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 13 * 11
    row = rows[3 * 13 + 5]
    assert float(row[SHEAR]) == diagram.x.values[5]
    assert float(row[EDGE]) == diagram.y.values[3]
    assert row["phase"] == diagram.phase[3, 5]
    assert float(row["energy"]) == diagram.energy[3, 5]
    assert [int(row[f"stable_{phase}"]) for phase in PHASES] == diagram.stable[3, 5].tolist()


def test_a_dataframe_needs_pandas(diagram, monkeypatch):
    def missing(name):
        raise ImportError(name)

    monkeypatch.setattr("ribbonrs.table.import_module", missing)
    with pytest.raises(rb.RibbonError, match="needs pandas"):
        diagram.to_dataframe()


def test_the_figure_has_regions_lines_and_names(diagram, tmp_path):
    figure = diagram.plot(tmp_path / "a.png")
    axes = figure.axes[0]
    names = {text.get_text() for text in axes.texts}
    assert names == {"twisted", "helical"}
    # A point is inside the region of its phase, and of no other of them.
    fills = {tuple(patch.get_facecolor()): patch.get_path() for patch in axes.patches}
    assert len(fills) == 4
    for j, i in ((1, 6), (3, 9), (9, 4), (8, 2)):
        place = float(diagram.x.values[i]), float(diagram.y.values[j])
        inside = [colour for colour, path in fills.items() if path.contains_point(place)]
        assert len(inside) == 1
    with pytest.raises(rb.InputError, match="path"):
        diagram.plot(tmp_path / "a.what")


def files():
    return sorted(path.name for path in Path().iterdir() if path.name != "scene.toml")


def test_sweep_prints_and_writes(scene, capsys):
    assert main(["sweep", scene(SCENE + SWEEP + OUTPUT)]) == 0
    out = capsys.readouterr().out
    for told in ("12 x 10 points", "helical and twisted", "instability", "twisted", "%", "wrote a.npz"):
        assert told in out
    assert files() == ["a.csv", "a.npz", "a.png", "a.svg"]
    assert rb.load_phase_diagram("a.npz").phase.shape == (10, 12)


def test_run_says_what_sweep_is_for(scene, capsys):
    assert main(["run", scene(SCENE + SWEEP)]) == 0
    assert "ribbonrs sweep" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (SCENE, "sweep is missing"),
        (SCENE + SWEEP.replace(EDGE, "growth.egde.amplitude"), "sweep.y.parameter = 'growth.egde.amplitude'"),
        (SCENE + SWEEP.replace("[0.0, 0.1]", "[0.1, 0.0]"), "sweep.y.span"),
        (SCENE + SWEEP.replace("n = [12, 10]", "n = 0"), "sweep.n = 0"),
        (SCENE + SWEEP.replace("span = [0.0,", "spam = [0.0,"), "sweep.y.spam"),
        (SCENE + SWEEP.replace("x = {", "z = {"), "sweep.z"),
        (SCENE + '[output]\nmap = "a.png"\n', "output.map asks for a file"),
        (SCENE + '[output]\ntable = "a.csv"\n', "output.table asks for a file"),
    ],
)
def test_what_sweep_refuses(scene, capsys, text, message):
    assert main(["sweep", scene(text)]) == 2
    err = capsys.readouterr().err
    assert message in err
    assert err.count("\n") == 1
    assert files() == []


def test_an_interrupt_writes_what_is_done(scene, capsys):
    name = scene(SCENE + SWEEP.replace("n = [12, 10]", "n = 2000") + '[output]\nphases = "a.npz"\n')
    threading.Timer(0.3, _thread.interrupt_main).start()
    assert main(["sweep", name]) == 130
    assert "interrupted" in capsys.readouterr().err
    assert rb.load_phase_diagram("a.npz").interrupted
