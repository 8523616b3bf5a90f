"""Settings for every test, and a scene in a file."""

import os
import signal
from pathlib import Path

import pytest
from hypothesis import settings
from ribbonrs.scenefile import read

# The same examples on every machine, however slow it is.
settings.register_profile("fixed", deadline=None, derandomize=True, database=None)
settings.load_profile("fixed")

# Programs that are started import what is compiled already, as those of a user do.
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)

# Also where the shell started this in the background, without interrupts.
signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture
def scene(tmp_path, monkeypatch):
    """Write a scene into an empty current directory and return its name."""
    monkeypatch.chdir(tmp_path)

    def write(text):
        Path("scene.toml").write_text(text)
        return "scene.toml"

    return write


@pytest.fixture
def job(tmp_path, monkeypatch):
    """Read a scene given as text, in an empty current directory."""
    monkeypatch.chdir(tmp_path)

    def read_text(text):
        content = text if isinstance(text, bytes) else text.encode()
        Path("scene.toml").write_bytes(content)
        return read("scene.toml")

    return read_text
