"""The page on loads and ends runs as written."""

import doctest
import re
from dataclasses import fields
from pathlib import Path

import pytest
import ribbonrs as rb

PAGE = (Path(__file__).parents[2] / "docs" / "loads-and-ends.md").read_text()


def test_examples_run_and_print_what_they_say(capsys):
    blocks = re.findall(r"^```python\n(.*?)^```", PAGE, flags=re.DOTALL | re.MULTILINE)
    examples = doctest.DocTestParser().get_doctest("\n".join(blocks), {}, "loads-and-ends.md", None, 0)
    assert len(examples.examples) > 20
    failed, _ = doctest.DocTestRunner().run(examples)
    assert failed == 0, capsys.readouterr().out


@pytest.mark.parametrize("end", [rb.Clamped, rb.Free, rb.Pinned, rb.Hinged, rb.Sliding, rb.Closed])
def test_every_end_is_there_with_what_it_takes(end):
    given, *_ = re.findall(rf"^\| `{end.__name__}\((.*?)\)`", PAGE, flags=re.MULTILINE)
    assert given.split(", ") == [field.name for field in fields(end)]


def test_figures_and_scenes_exist():
    for target in re.findall(r"\]\(([^)#]+)\)", PAGE):
        assert (Path(__file__).parents[2] / "docs" / target).exists(), target
