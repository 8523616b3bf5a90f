"""The page on growth runs as written."""

import doctest
import re
from pathlib import Path

import pytest
from ribbonrs.growth import FIELDS

PAGE = (Path(__file__).parents[2] / "docs" / "growth.md").read_text()


def blocks(language):
    return re.findall(rf"^```{language}\n(.*?)^```", PAGE, flags=re.DOTALL | re.MULTILINE)


def test_examples_run_and_print_what_they_say(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (table,) = blocks("csv")
    Path("leaf.csv").write_text(table)
    examples = doctest.DocTestParser().get_doctest("\n".join(blocks("python")), {}, "growth.md", None, 0)
    assert len(examples.examples) > 20
    failed, _ = doctest.DocTestRunner().run(examples)
    assert failed == 0, capsys.readouterr().out


@pytest.mark.parametrize("field", FIELDS)
def test_every_field_is_there(field):
    assert f"`{field}`" in PAGE
