"""The pages of docs/ run as written, and what they point at is there."""

import doctest
import re
from dataclasses import fields
from pathlib import Path

import pytest
import ribbonrs as rb
from ribbonrs.branch import KINDS
from ribbonrs.cli import main
from ribbonrs.growth import FIELDS

DOCS = Path(__file__).parents[2] / "docs"
PAGES = {path.stem: path.read_text() for path in sorted(DOCS.glob("*.md"))}


def blocks(page, language):
    """The fenced blocks of a page in a language."""
    return re.findall(rf"^```{language}\n(.*?)^```", PAGES[page], flags=re.DOTALL | re.MULTILINE)


@pytest.mark.parametrize("page", [page for page, text in PAGES.items() if ">>> " in text])
def test_examples_run_and_print_what_they_say(page, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    # A table or a scene whose first line names a file is that file.
    for block in blocks(page, "(?:csv|toml)"):
        if named := re.match(r"# ([\w.]+\.(?:csv|toml))\b", block):
            Path(named[1]).write_text(block)
    examples = doctest.DocTestParser().get_doctest("\n".join(blocks(page, "python")), {}, page, None, 0)
    assert examples.examples
    failed, _ = doctest.DocTestRunner().run(examples)
    assert failed == 0, capsys.readouterr().out
    for name in re.findall(r"\"(\w+\.(?:png|vtp|npz))\"", "".join(e.source for e in examples.examples)):
        assert Path(name).stat().st_size > 1000, name


@pytest.mark.parametrize("page", PAGES)
def test_figures_scenes_and_pages_exist(page):
    prose = re.sub(r"^```.*?^```", "", PAGES[page], flags=re.DOTALL | re.MULTILINE)
    for target in re.findall(r"\]\((?!https?:)([^)#]+)[^)]*\)", prose):
        assert (DOCS / target).exists(), target


def test_every_page_is_in_the_contents():
    listed = re.findall(r"^[\w-]+$", "\n".join(blocks("index", r"\{toctree\}")), flags=re.MULTILINE)
    assert sorted(listed) == sorted(set(PAGES) - {"index"})


@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_of_special_point_is_there(kind):
    assert f'| "{kind}" |' in PAGES["continuation"]


@pytest.mark.parametrize("field", FIELDS)
def test_every_field_of_growth_is_there(field):
    assert f"`{field}`" in PAGES["growth"]


@pytest.mark.parametrize("end", [rb.Clamped, rb.Free, rb.Pinned, rb.Hinged, rb.Sliding, rb.Closed])
def test_every_end_is_there_with_what_it_takes(end):
    given, *_ = re.findall(rf"^\| `{end.__name__}\((.*?)\)`", PAGES["loads-and-ends"], flags=re.MULTILINE)
    assert given.split(", ") == [field.name for field in fields(end)]


def test_every_name_is_in_the_reference():
    (listed,) = blocks("reference", r"\{eval-rst\}")
    documented = set(re.findall(r"^\.\. auto\w+:: (?:ribbonrs\.)?([\w.]+)", listed, flags=re.MULTILINE))
    assert documented >= set(rb.__all__)
    shapes = {"edge", "thickness", "chiral", "Profile", "stations", "from_csv"}
    assert documented >= {f"growth.{name}" for name in shapes}
    assert set(rb.growth.__all__) == shapes | {"FIELDS", "Growth", "Shape", "Term"}


def test_every_command_is_in_the_reference(capsys):
    with pytest.raises(SystemExit):
        main(["--help"])
    commands = re.findall(r"^    (\w+)", capsys.readouterr().out, flags=re.MULTILINE)
    assert {"run", "trace", "sweep"} <= set(commands)
    for command in commands:
        assert f"| `ribbonrs {command}" in PAGES["reference"]
