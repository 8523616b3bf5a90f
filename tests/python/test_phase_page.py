"""The page on phase diagrams runs as written."""

import doctest
import re
from pathlib import Path

PAGE = (Path(__file__).parents[2] / "docs" / "phase-diagrams.md").read_text()


def test_examples_run_and_print_what_they_say(capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    blocks = re.findall(r"^```python\n(.*?)^```", PAGE, flags=re.DOTALL | re.MULTILINE)
    examples = doctest.DocTestParser().get_doctest("\n".join(blocks), {}, "phase-diagrams.md", None, 0)
    assert len(examples.examples) > 5
    failed, _ = doctest.DocTestRunner().run(examples)
    assert failed == 0, capsys.readouterr().out
    assert (tmp_path / "phase_diagram.png").exists()


def test_figures_and_pages_exist():
    for target in re.findall(r"\]\(([^)#]+)\)", PAGE):
        assert (Path(__file__).parents[2] / "docs" / target).exists(), target
