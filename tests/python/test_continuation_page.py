"""The page on how shapes change runs as written."""

import doctest
import re
from pathlib import Path

import pytest
from ribbonrs.branch import KINDS

DOCS = Path(__file__).parents[2] / "docs"
PAGE = (DOCS / "continuation.md").read_text()


def test_examples_run_and_print_what_they_say(capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    blocks = re.findall(r"^```python\n(.*?)^```", PAGE, flags=re.DOTALL | re.MULTILINE)
    examples = doctest.DocTestParser().get_doctest("\n".join(blocks), {}, "continuation.md", None, 0)
    assert len(examples.examples) > 20
    failed, _ = doctest.DocTestRunner().run(examples)
    assert failed == 0, capsys.readouterr().out
    assert (tmp_path / "coiling_leaf_diagram.png").exists()


@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_of_special_point_is_there(kind):
    assert f'| "{kind}" |' in PAGE


def test_figures_scenes_and_pages_exist():
    for target in re.findall(r"\]\(([^)#]+)\)", PAGE):
        assert (DOCS / target).exists(), target
