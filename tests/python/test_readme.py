"""What the README shows runs as written."""

import contextlib
import io
import re
from pathlib import Path

import pytest
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
