"""`ribbonrs validate`: the whole table passes, and it can fail."""

import csv
import math

import numpy as np
import pytest
import ribbonrs as rb
from refusal import refuses
from ribbonrs.cli import main
from ribbonrs.validation import (
    TOPICS,
    Row,
    Validation,
    classical,
    elasticity,
    frame,
    kinematics,
    numbers,
    orders,
    printed,
    shell,
    transitions,
)
from ribbonrs.validation.row import farthest


@pytest.fixture(scope="module")
def whole():
    return rb.validate()


def test_no_row_fails(whole):
    assert [row for row in whole.rows if row.verdict == "FAILS"] == []
    assert whole.passed
    assert whole.counts["holds"] > 100
    assert sum(whole.counts.values()) == len(whole.rows)
    assert list(dict.fromkeys(row.topic for row in whole.rows)) == list(TOPICS)
    # a second on an idle machine
    assert whole.seconds < 15.0


def test_what_does_not_hold_says_why_in_one_sentence(whole):
    for row in whole.rows:
        assert (row.verdict == "holds") == (not row.wrong)
        assert not row.wrong or (row.wrong.endswith(".") and "\n" not in row.wrong)
        assert (row.verdict == "slip") == (row.corrected is not None)
        assert row.reason
    slips = [row for row in whole.rows if row.verdict == "slip"]
    assert {0.53, 0.125, 0.052} <= {row.published for row in slips}


def row(published=1.0, computed=1.0, tolerance=1e-3, **more):
    return Row("name", "source", published, computed, tolerance, **more)


@pytest.mark.parametrize(
    ("made", "verdict"),
    [
        (row(), "holds"),
        (row(computed=1.0009), "holds"),
        (row(computed=1.0011), "FAILS"),
        (row(computed=0.9989), "FAILS"),
        (row(computed=math.nan), "FAILS"),
        (row(published=math.nan), "FAILS"),
        (row(computed=1.1, wrong="Why."), "does not hold"),
        (row(wrong="Why."), "FAILS"),
        (row(computed=math.nan, wrong="Why."), "FAILS"),
        (row(published=math.nan, wrong="Why."), "does not hold"),
        (row(computed=2.0, wrong="Why.", corrected=2.0), "slip"),
        (row(computed=2.0, wrong="Why.", corrected=2.1), "FAILS"),
        (row(corrected=1.0, wrong="Why."), "FAILS"),
        (row(computed=5.0, bound=">="), "holds"),
        (row(computed=0.998, bound=">="), "FAILS"),
        (row(computed=math.nan, bound=">="), "FAILS"),
        (row(computed=-5.0, bound="<="), "holds"),
        (row(computed=1.002, bound="<="), "FAILS"),
        (row(computed=1.002, bound="<=", wrong="Why."), "does not hold"),
    ],
)
def test_verdicts(made, verdict):
    assert made.verdict == verdict


def test_the_entries_that_differ_most():
    assert farthest([1.0, 2.0, 3.0], [1.0, 2.5, 3.1]) == (2.0, 2.5)
    assert farthest(0.0, [[1.0, -3.0]]) == (0.0, -3.0)
    assert farthest([1.0, 2.0], [9.0, 2.5], [5.0, 6.0]) == (1.0, 9.0, 5.0)
    published, computed = farthest([1.0, math.nan], [9.0, 2.0])
    assert math.isnan(published)
    assert computed == 2.0


def scaled(module, name, factor):
    """A function whose result is off by a factor."""
    right = getattr(module, name)
    return lambda *arguments, **named: np.multiply(right(*arguments, **named), factor)


@pytest.mark.parametrize(
    ("topic", "module", "name", "factor"),
    [
        ("closed_forms", printed, "twist_of", 1.0 + 1e-12),
        ("closed_forms", printed, "second_order", 1.0 + 1e-12),
        ("closed_forms", printed, "edge_deflection", 1.0 + 1e-12),
        ("kinematics", kinematics, "weak", 1.0 + 1e-3),
        ("shell", shell, "weak", 1.0 + 1e-13),
        ("elasticity", elasticity, "_weak_density", 1.0 + 1e-2),
        ("frame", frame, "directors", 1.0 + 1e-13),
        ("transitions", transitions, "_phi", 1.0 + 1e-8),
        ("transitions", transitions, "_radius", 1.0 + 1e-11),
        ("classical", classical, "elastica", 1.0 + 1e-9),
        ("classical", classical, "_greenhill", 1.0 + 1e-9),
        ("orders", orders, "elastica", 1.0 + 1e-9),
    ],
)
def test_a_changed_formula_fails(monkeypatch, topic, module, name, factor):
    assert rb.validate([topic]).passed
    monkeypatch.setattr(module, name, scaled(module, name, factor))
    assert not rb.validate([topic]).passed


@pytest.mark.parametrize("method", ["energy", "gradient", "hessian"])
def test_a_changed_law_fails(monkeypatch, method):
    monkeypatch.setattr(rb.SectionLaw, method, scaled(rb.SectionLaw, method, 1.0 + 1e-11))
    assert not rb.validate(["closed_forms"]).passed


def test_a_published_value_that_is_called_wrong_and_is_not_fails(monkeypatch):
    monkeypatch.setattr(numbers, "_branch_points", lambda eta, span: ([5 * eta**2, 5 * eta**2], 0))
    failing = [row for row in rb.validate(["numbers"]).rows if row.verdict == "FAILS"]
    assert [(row.name, row.wrong != "") for row in failing] == [("xi/eta^2, flat loses stability", True)]


def test_topics():
    assert {row.topic for row in rb.validate(["shell", "frame", "shell"]).rows} == {"shell", "frame"}
    refuses("topic", lambda: rb.validate(["frames"]))
    refuses("topic", lambda: rb.validate("frame"))


def test_csv(whole, tmp_path):
    whole.to_csv(tmp_path / "a.csv")
    with (tmp_path / "a.csv").open(newline="") as file:
        lines = list(csv.DictReader(file))
    assert len(lines) == len(whole.rows)
    for line, row in zip(lines, whole.rows, strict=True):
        for name in ("topic", "name", "source", "bound", "verdict", "reason", "wrong"):
            assert line[name] == getattr(row, name)
        for name in ("published", "computed", "difference", "tolerance"):
            np.testing.assert_equal(float(line[name]), getattr(row, name))
        assert line["corrected"] == ("" if row.corrected is None else str(row.corrected))
    refuses("path", lambda: whole.to_csv(tmp_path / "a.txt"))


def test_command_line(capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert main(["validate", "shell", "numbers", "--csv", "a.csv"]) == 0
    shown, errors = capsys.readouterr()
    assert errors == ""
    assert shown.index("shell") < shown.index("numbers")
    assert "slip (1)" in shown
    assert "(1) The last term of e33^(1) is X1 g31,3, not X3 g31,3.\nMore in docs/corrections.md." in shown
    assert " 0 fail\nwrote a.csv\n" in shown
    assert (tmp_path / "a.csv").read_text().startswith("topic,name,")


def test_the_exit_status_tells_of_a_row_that_fails(capsys, monkeypatch):
    monkeypatch.setattr(printed, "twist_of", scaled(printed, "twist_of", 1.0 + 1e-12))
    assert main(["validate", "closed_forms"]) == 1
    shown, _ = capsys.readouterr()
    assert "FAILS" in shown.split("K3 of twisted ribbons")[1].splitlines()[0]
    assert shown.endswith(" 1 fail\n")


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["frames"], "topic = 'frames': expected one of numbers, closed_forms, kinematics, shell, "),
        (["frame", "--csv", "a.txt"], "path = 'a.txt': expected a file name ending in .csv"),
        (["frame", "--csv", "no/a.csv"], "path = 'no/a.csv': expected a file in a directory that exists"),
    ],
)
def test_wrong_input_is_one_line(capsys, arguments, told, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert main(["validate", *arguments]) == 2
    shown, errors = capsys.readouterr()
    assert shown == ""
    assert errors.startswith(f"ribbonrs: {told}")
    assert errors.count("\n") == 1


def test_a_table_that_cannot_be_written_is_one_line(capsys, tmp_path, monkeypatch):
    def full(*arguments, **named):
        raise OSError(28, "No space left on device")

    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(Validation, "to_csv", full)
    assert main(["validate", "frame", "--csv", "a.csv"]) == 2
    told = "csv = 'a.csv': expected one that can be written, not: No space left on device"
    assert capsys.readouterr().err == f"ribbonrs: {told}\n"
