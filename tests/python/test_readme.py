"""What the README shows runs as written."""

import contextlib
import io
import re
from pathlib import Path

import pytest
from ribbonrs.cli import main
from ribbonrs.scenefile import read

README = (Path(__file__).parents[2] / "README.md").read_text()


def blocks(language):
    """The fenced blocks of the README in a language."""
    found = re.findall(rf"^```{language}\n(.*?)^```", README, flags=re.DOTALL | re.MULTILINE)
    assert found
    return found


@pytest.mark.parametrize("block", blocks("python"))
def test_python_runs(block, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with contextlib.redirect_stdout(io.StringIO()) as screen:
        exec(compile(block, "README.md", "exec"), {})
    # Whatever a comment promises beside a print, as far as the first semicolon, is printed.
    for promise in re.findall(r"print\(.*\)  # (-?[\w.]+)", block):
        assert promise in screen.getvalue()
    for name in re.findall(r"\"(\w+\.(?:png|vtp|obj|npz))\"", block):
        assert Path(name).stat().st_size > 1000


@pytest.mark.parametrize("block", blocks("toml"))
def test_scenes_are_read(block, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("scene.toml").write_text(block)
    assert read("scene.toml").outputs


def test_what_a_trace_prints(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(["trace", str(Path(__file__).parents[2] / "examples" / "coiling_leaf.toml")]) == 0

    def rows(text):
        # but for how many points there are on a branch
        lines = [re.sub(r"(\w)  +\d+  ", r"\1  ", line).strip() for line in text.splitlines()]
        return [line for line in lines if line]

    assert rows(blocks("text")[0]) == rows(capsys.readouterr().out)
