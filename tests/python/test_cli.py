"""The command line: what it prints, writes, and how it ends."""

import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import ribbonrs as rb
from ribbonrs.cli import main

EXAMPLES = Path(__file__).parents[2] / "examples"

SCENE = """
[ribbon]
length = 30.0
width = 2.0
thickness = 0.2
[growth]
edge = 0.06
chiral = 0.04
"""


def run_process(*arguments, **options):
    """Run the command line as a process of its own."""
    command = [sys.executable, "-m", "ribbonrs", *arguments]
    return subprocess.run(command, capture_output=True, text=True, check=False, **options)


def files():
    """Every file and directory in the current directory but the scene."""
    return sorted(path.name for path in Path().iterdir() if path.name != "scene.toml")


@pytest.mark.parametrize("path", sorted(EXAMPLES.glob("*.toml")), ids=lambda path: path.stem)
def test_examples_run_and_write_what_they_say(path, tmp_path):
    done = run_process("run", str(path), cwd=tmp_path)
    assert done.returncode == 0
    told = [line.removeprefix("ribbonrs: warning: ").split()[0] for line in done.stderr.splitlines()]
    # That the shape jumps, and what is neglected.
    assert told == (["the", "neglected"] if path.stem == "kinked_strip" else [])
    written = sorted(file.name for file in tmp_path.iterdir())
    assert written == sorted(
        line.removeprefix("wrote ") for line in done.stdout.splitlines() if "wrote" in line
    )
    assert {Path(name).suffix for name in written} >= {".png", ".vtp", ".npz"}
    assert all((tmp_path / name).stat().st_size > 1000 for name in written)


TRACED = [path for path in sorted(EXAMPLES.glob("*.toml")) if "[trace]" in path.read_text()]
SWEPT = [path for path in sorted(EXAMPLES.glob("*.toml")) if "[sweep]" in path.read_text()]
DRAWN = [("trace", path) for path in TRACED] + [("sweep", path) for path in SWEPT]


@pytest.mark.parametrize(("command", "path"), DRAWN, ids=lambda part: getattr(part, "stem", part))
def test_examples_are_traced_and_swept(command, path, tmp_path):
    done = run_process(command, str(path), cwd=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    assert "failed" not in done.stdout
    for file in tmp_path.iterdir():
        assert f"wrote {file.name}" in done.stdout
        assert file.stat().st_size > 1000
        assert (EXAMPLES.parent / "docs" / "figures" / file.name).exists()


def test_summary_shows_the_state_in_both_units(scene, capsys):
    assert main(["run", scene(SCENE)]) == 0
    screen, errors = capsys.readouterr()
    assert errors == ""
    leaf = rb.Ribbon(30.0, 2.0, 0.2)
    growth = rb.growth.edge(0.06) + rb.growth.chiral(0.04)
    state = rb.solve(rb.Scene(leaf, growth))
    rows = {
        line.split("  ")[1].strip(): line.split()[-2:]
        for line in screen.splitlines()
        if line.startswith("  ")
    }
    for row, value, unit in (
        ("axial strain", state.strain[0], 1.0),
        ("curvature out of the plane", state.strain[2], 1 / 2.0),
        ("twist", state.strain[3], 1 / 2.0),
        ("radius of the helix", state.helix.radius, 2.0),
        ("pitch of the helix", state.helix.pitch, 2.0),
        ("energy per length", state.energy, 0.2 * 2.0),
    ):
        assert [float(number) for number in rows[row]] == pytest.approx([value, value * unit], rel=1e-5)
    assert "helical, right-handed" in screen
    assert "stable (section_index 0)" in screen
    assert re.search(rf"^neglected +{100 * state.neglected:.2g} % of the strains", screen, re.MULTILINE)
    others = [other for other in rb.natural_shapes(leaf, growth) if (other.strain != state.strain).any()]
    table = screen[screen.index("other equilibria") :].splitlines()[4:]
    shapes = [line.split(",")[0].strip() for line in table[: len(others)]]
    assert shapes == [other.phase for other in others]
    assert table[len(others)].strip() == ""


def test_files_are_in_the_users_units(scene):
    assert main(["run", scene(SCENE + '[output]\ndata = "a.npz"\nsurface = "a.obj"\nfigure = "a.svg"')]) == 0
    assert files() == ["a.npz", "a.obj", "a.svg"]
    state = rb.solve(rb.Scene(rb.Ribbon(30.0, 2.0, 0.2), rb.growth.edge(0.06) + rb.growth.chiral(0.04)))
    vertices = [line.split()[1:] for line in Path("a.obj").read_text().splitlines() if line.startswith("v ")]
    far = np.max(np.abs(np.array(vertices, dtype=float)))
    assert far == pytest.approx(2.0 * np.max(np.abs(state.surface(face=1.0))), rel=0.05)


def test_files_are_readable_by_others_as_the_umask_says(scene):
    old = os.umask(0o027)
    try:
        assert main(["run", scene(SCENE + '[output]\ndata = "a.npz"\nfigure = "a.png"')]) == 0
    finally:
        os.umask(old)
    assert [Path(name).stat().st_mode & 0o777 for name in files()] == [0o640, 0o640]


def test_outputs_replace_older_files(scene):
    Path("a.npz").write_text("old")
    assert main(["run", scene(SCENE + '[output]\ndata = "a.npz"')]) == 0
    assert Path("a.npz").read_bytes()[:2] == b"PK"


def test_run_says_which_command_traces(scene, capsys):
    trace = '[trace]\nparameter = "growth.edge.amplitude"\nspan = [0, 0.1]'
    assert main(["run", scene(SCENE + trace)]) == 0
    assert "`ribbonrs trace` draws the branches that [trace] asks for." in capsys.readouterr().out


def test_large_growth_warns_in_one_line(scene, capsys):
    assert main(["run", scene(SCENE.replace("0.06", "0.2"))]) == 0
    assert capsys.readouterr().err == (
        "ribbonrs: warning: growth.size = 0.2: the theory is for growth small against 1\n"
    )


def test_wrong_input_is_one_line_and_status_2(scene):
    name = scene(SCENE.replace("0.2", "-0.2") + '[output]\ndata = "a.npz"')
    done = run_process("run", name)
    expected = "ribbonrs: ribbon.thickness = -0.2: expected a positive finite number\n"
    assert (done.returncode, done.stdout, done.stderr) == (2, "", expected)
    assert files() == []


def test_missing_scene_is_one_line_and_status_2(tmp_path):
    done = run_process("run", "none.toml", cwd=tmp_path)
    expected = (
        "ribbonrs: scene file = 'none.toml': expected a readable file, not: No such file or directory\n"
    )
    assert (done.returncode, done.stdout, done.stderr) == (2, "", expected)


@pytest.mark.parametrize("arguments", [[], ["walk"], ["run"], ["run", "a", "b"], ["run", "--fast", "a"]])
def test_wrong_usage_is_status_2(arguments, capsys):
    with pytest.raises(SystemExit) as caught:
        main(arguments)
    assert caught.value.code == 2
    assert "usage: ribbonrs" in capsys.readouterr().err


def test_no_stable_state_is_status_1(scene, capsys):
    # The second-order expansion is unbounded below past the onset of bending: no equilibrium is stable.
    text = SCENE.replace("chiral = 0.04", "") + '[output]\ndata = "a.npz"'
    assert main(["run", scene('law = "quadratic"' + text)]) == 1
    screen, errors = capsys.readouterr()
    assert screen == ""
    assert errors.startswith("ribbonrs: none of the ")
    assert errors.count("\n") == 1
    assert files() == []


def test_all_files_or_none(scene, capsys):
    # The name of the last file is too long to be written, which shows only when it is tried.
    name = "a" * 300 + ".npz"
    output = f'[output]\nfigure = "a.png"\nsurface = "a.vtp"\ndata = "{name}"'
    assert main(["run", scene(SCENE + output)]) == 2
    assert "output.data" in capsys.readouterr().err
    assert files() == []


def test_interruption_leaves_nothing(scene, capsys, monkeypatch):
    def interrupt(self, path):
        Path(path).write_text("half")
        raise KeyboardInterrupt

    monkeypatch.setattr(rb.State, "save", interrupt)
    assert main(["run", scene(SCENE + '[output]\nfigure = "a.png"\ndata = "a.npz"')]) == 130
    assert capsys.readouterr().err == "ribbonrs: interrupted\n"
    assert files() == []


def test_a_reader_that_leaves_early_is_no_traceback(scene):
    command = f"{sys.executable} -m ribbonrs run {scene(SCENE)} | true"
    done = subprocess.run(command, shell=True, capture_output=True, text=True, check=False)
    assert done.stderr == ""


def test_a_screen_that_cannot_be_written_is_one_line(scene):
    command = f"{sys.executable} -m ribbonrs run {scene(SCENE)} 1< /dev/null"
    done = subprocess.run(command, shell=True, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (1, "ribbonrs: standard output: Bad file descriptor\n")


def test_any_terminal_can_show_any_file_name(scene):
    environment = {**os.environ, "PYTHONIOENCODING": "ascii"}
    done = run_process("run", scene(SCENE + '[output]\ndata = "fl\\u00f6te.npz"'), env=environment)
    assert done.returncode == 0
    assert "wrote fl\\xf6te.npz" in done.stdout
    assert files() == ["flöte.npz"]


def test_a_name_that_the_locale_cannot_encode_is_one_line(scene):
    environment = {**os.environ, "LC_ALL": "C", "PYTHONCOERCECLOCALE": "0", "PYTHONUTF8": "0"}
    done = run_process("run", scene(SCENE + '[output]\ndata = "fl\\u00f6te.npz"'), env=environment)
    assert (done.returncode, done.stderr) == (
        2,
        "ribbonrs: output.data = 'fl\\xf6te.npz': expected a file name in the encoding ascii\n",
    )
    assert files() == []


def test_no_number_is_cropped(scene, capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", "40")
    thin = SCENE.replace("thickness = 0.2", "thickness = 2e-5")
    assert main(["run", scene(thin)]) == 0
    assert "…" not in capsys.readouterr().out


def test_growth_is_told_by_its_fields(scene, capsys):
    text = SCENE.replace("edge = 0.06", "edge = 0.06\nthickness = {xi = 0.02, transverse = -0.01}")
    assert main(["run", scene(text)]) == 0
    shown = " ".join(capsys.readouterr().out.split())
    assert "edge 0.06 (gamma33 = 0.24 x^2)" in shown
    assert "thickness 0.02 (d33 = 0.02, d22 = -0.01)" in shown


# --- ribbons that vary along their length

BENDS = SCENE.replace("edge = 0.06\nchiral = 0.04", "edge = { S = [0, 15], values = [0, 0.08] }")
SNAPS = SCENE.replace(
    "edge = 0.06\nchiral = 0.04", "edge = 0.08\nthickness = { S = [0, 15], values = [-0.05, 0.6] }"
)


def rows_of(screen):
    """The cells of each line of the screen, by the first."""
    lines = [re.split(r"  +", line.strip()) for line in screen.splitlines()]
    return {cells[0]: cells[1:] for cells in lines}


def test_summary_of_a_ribbon_that_varies(scene, capsys):
    taper = "width_profile = { S = [0, 15], values = [1, 0.8] }\n[growth]"
    assert main(["run", scene(BENDS.replace("[growth]", taper))]) == 0
    screen, errors = capsys.readouterr()
    assert errors == ""
    growth = rb.growth.edge(([0.0, 15.0], [0.0, 0.08]))
    state = rb.solve(rb.Scene(rb.Ribbon(30.0, 2.0, 0.2, width_profile=([0.0, 15.0], [1.0, 0.8])), growth))
    rows = rows_of(screen)
    assert rows["width"] == ["from 0.8 to 1 of the above, varying along S"]
    assert rows["growth"] == ["edge varying along S (gamma33 = 4 x^2); largest growth strain 0.08"]
    assert rows["shape"] == ["curved: flat, then bent"]
    K2 = state.strains[-1, 2]
    assert rows["curvature out of the plane"] == ["K2", f"0 to {K2:.6g}", f"0 to {K2 / 2.0:.6g}"]
    assert rows["twist"] == ["K3", "0", "0"]
    (event,) = state.report.events
    assert rows[f"{event.S:.6g}"][0] == "bifurcation"
    assert "helix" not in screen
    assert "no other shape is stable at the start" in screen


def test_jumps_warn_in_one_line(scene, capsys):
    flipped = SNAPS.replace("-0.05, 0.6", "0.05, -0.6")
    for text in (SNAPS, flipped):
        assert main(["run", scene(text)]) == 0
        screen, errors = capsys.readouterr()
        # the branch without a jump is shown, the other one listed
        assert errors == ""
        assert "other stable shapes, strains at S = 0" in screen
    assert main(["run", scene(SNAPS.replace("-0.05", "-0.3"))]) == 0
    screen, errors = capsys.readouterr()
    jump, stretched = errors.splitlines()
    assert jump.startswith("ribbonrs: warning: the shape jumps along the ribbon: S = ")
    assert stretched.startswith("ribbonrs: warning: neglected = 0.")  # no body can follow it
    (row,) = [cells for cells in rows_of(screen).values() if cells[:1] == ["jump"]]
    before, _, after, _ = map(float, row[1:])
    assert before > 0.0 > after


def test_no_stable_shape_along_the_ribbon_is_status_1(scene, capsys):
    assert main(["run", scene('law = "quadratic"' + BENDS)]) == 1
    screen, errors = capsys.readouterr()
    assert screen == ""
    assert errors.startswith("ribbonrs: no natural shape all along the ribbon, S = ")
    assert errors.count("\n") == 1


def test_stations_are_told_together(scene, capsys):
    Path("leaf.csv").write_text("S, x, g33\n0, -0.5, 0.01\n0, 0.5, 0.01\n15, -0.5, 0.02\n15, 0.5, 0.02\n")
    assert main(["run", scene(SCENE.replace("edge = 0.06", 'csv = "leaf.csv"'))]) == 0
    (told,) = rows_of(capsys.readouterr().out)["growth"]
    stations = "station0_measured ... station1_measured varying along S (gamma33 = a function of degree 1)"
    assert told == f"chiral 0.04 (d23 = 0.04) + {stations}; largest growth strain 0.02"
