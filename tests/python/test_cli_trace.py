"""`ribbonrs trace`: what it prints, writes, and how it ends. The core is a fake."""

from pathlib import Path

import numpy as np
import pytest
import ribbonrs as rb
from fake_core import edge_trace, pressed_trace
from ribbonrs import _core
from ribbonrs.cli import main

SCENE = """
[ribbon]
length = 10.0
width = 1.0
thickness = 0.1
[growth]
edge = 0.06
"""
TRACE = '[trace]\nparameter = "growth.edge.amplitude"\nspan = [0.0, 0.08]\n'
OUTPUT = '[output]\ndiagram = ["a.png", "a.svg"]\ntable = "a.csv"\nbranches = "a.npz"\nfigure = "no.png"\n'
PRESSED = """
[ribbon]
length = 10.0
width = 1.0
thickness = 0.1
[end]
kind = "sliding"
[[loads]]
kind = "point"
S = 5.0
force = [1e-5, 0.0, 0.0]
[trace]
parameter = "end.force"
span = [-3e-4, 0.0]
"""


@pytest.fixture
def core(monkeypatch):
    monkeypatch.setattr(_core, "trace_natural", lambda *arguments: edge_trace(), raising=False)
    monkeypatch.setattr(_core, "trace", lambda *arguments: pressed_trace(), raising=False)
    return monkeypatch


def files():
    return sorted(path.name for path in Path().iterdir() if path.name != "scene.toml")


def test_prints_branches_and_special_points(core, scene, capsys):
    assert main(["trace", scene(SCENE + TRACE)]) == 0
    screen, errors = capsys.readouterr()
    assert errors == ""
    lines = [" ".join(line.split()) for line in screen.splitlines()]
    assert lines[0] == "growth.edge.amplitude from 0 to 0.08"
    for row in (
        "0 flat 7 0 0.08 0 to 0.0454674 span span",
        "1 bent, mirrored 7 0.0454674 0.08 0.0454674 to 0.08 branch point of 0 span",
        "2 twisted, mirrored 6 0.05 0.08 no branch point of 0 span",
        "branch point 0.04546738 0 1",
        "branch point 0.05 0 1",
    ):
        assert row in lines
    assert files() == []


def test_says_why_a_branch_failed(core, scene, capsys):
    assert main(["trace", scene(PRESSED)]) == 0
    screen, errors = capsys.readouterr()
    assert errors == ""
    assert "branch 0 failed at -0.0003: the Newton iteration diverged" in screen
    assert "value" in screen


def test_writes_what_is_asked_for(core, scene, capsys):
    assert main(["trace", scene(SCENE + TRACE + 'quantity = "K2"\n' + OUTPUT)]) == 0
    assert files() == ["a.csv", "a.npz", "a.png", "a.svg"]
    assert capsys.readouterr().out.splitlines()[-4:] == [
        f"wrote a.{name}" for name in ("png", "svg", "csv", "npz")
    ]
    diagram = rb.load_diagram("a.npz")
    assert diagram.parameter == "growth.edge.amplitude"
    assert len(Path("a.csv").read_text().splitlines()) == 21
    rb.Diagram.plot(diagram, "K2", "b.png")
    assert Path("a.png").read_bytes() == Path("b.png").read_bytes()


def test_run_leaves_the_files_of_trace_alone(core, scene, capsys):
    assert main(["run", scene(SCENE + TRACE + OUTPUT)]) == 0
    assert files() == ["no.png"]
    assert "`ribbonrs trace` draws the branches that [trace] asks for." in capsys.readouterr().out


def test_options_reach_the_core(core, scene):
    calls = []
    core.setattr(_core, "trace_natural", lambda *arguments: calls.append(arguments[1:]) or edge_trace())
    assert main(["trace", scene(SCENE + TRACE + "values = [0.06, 0.01]\ndepth = 0\nmax_steps = 7")]) == 0
    assert calls == [((0.0, 0.08), (0.01, 0.06), 0, 7)]
    core.setattr(_core, "trace", lambda *arguments: calls.append(arguments[-2:]) or pressed_trace())
    assert main(["trace", scene(PRESSED + "[solve]\ntol = 1e-8\ndegree = 3")]) == 0
    assert calls[1] == (1e-8, 3)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (SCENE, "trace is missing: expected a table with a parameter and its span"),
        (SCENE + TRACE.replace("edge", "edg"), "trace.parameter = 'growth.edg.amplitude': expected a name "),
        (SCENE + TRACE.replace("0.08", "0.8"), "trace.span[1] = 0.8: expected a value that growth.edge."),
        (SCENE + TRACE + "depth = -1", "trace.depth = -1: expected a whole number from 0 to 20"),
        (SCENE + TRACE + "max_steps = 0.5", "trace.max_steps = 0.5: expected a whole number from 1"),
        (
            SCENE + TRACE + "step = 1",
            "trace.step = 1: expected one of parameter, span, values, depth, max_steps,",
        ),
        (
            SCENE + TRACE + '[output]\ntable = "a.txt"',
            "output.table = 'a.txt': expected a file name ending in .csv",
        ),
    ],
)
def test_wrong_input_is_one_line(core, scene, capsys, text, told):
    assert main(["trace", scene(text)]) == 2
    screen, errors = capsys.readouterr()
    assert screen == ""
    assert errors.startswith(f"ribbonrs: {told}")
    assert errors.count("\n") == 1


def test_all_files_or_none(core, scene, capsys):
    def full(*arguments, **contents):
        raise OSError(28, "No space left on device")

    Path("a.csv").write_text("old")
    core.setattr(np, "savez_compressed", full)
    assert main(["trace", scene(SCENE + TRACE + OUTPUT)]) == 2
    assert files() == ["a.csv"]
    assert Path("a.csv").read_text() == "old"
    assert capsys.readouterr().err.startswith(
        "ribbonrs: output.branches = 'a.npz': expected a file that can be"
    )


def test_no_solution_and_interrupts(core, scene, capsys):
    def raising(error):
        def fails(*arguments):
            raise error

        return fails

    error = rb.ConvergenceError("no equilibrium", np.zeros(4), (), "another scene")
    core.setattr(_core, "trace_natural", raising(error))
    assert main(["trace", scene(SCENE + TRACE)]) == 1
    assert capsys.readouterr().err == "ribbonrs: no equilibrium; try another scene\n"
    core.setattr(_core, "trace_natural", raising(KeyboardInterrupt()))
    assert main(["trace", scene(SCENE + TRACE)]) == 130
    assert capsys.readouterr().err == "ribbonrs: interrupted\n"


def test_large_growth_is_warned_of_once(core, scene, capsys):
    assert main(["trace", scene(SCENE + TRACE.replace("0.08", "0.2"))]) == 0
    warned = "ribbonrs: warning: growth.size = 0.2 in the span: the theory is for growth small against 1\n"
    assert capsys.readouterr().err == warned


def test_a_narrow_terminal_shows_whole_numbers(core, scene, capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", "30")
    assert main(["trace", scene(SCENE + TRACE)]) == 0
    assert "0.04546738" in capsys.readouterr().out
