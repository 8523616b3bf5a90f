"""The tables of the page on validity are what the program gives."""

import warnings
from pathlib import Path

import pytest
import ribbonrs as rb
from foppl_von_karman import threshold
from ribbonrs.scenefile import read
from test_section3d import MATERIAL, part_off

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "validity.md").read_text()
SHAPES = {
    "bent": lambda eta: rb.growth.edge(8 * eta**2),
    "twisted": lambda eta: rb.growth.edge(8 * eta**2),
    "saddle": lambda eta: rb.growth.thickness(4 * eta, -2 * eta),
}


def rows(heading):
    """The cells of the table under a heading row that starts so."""
    table = PAGE[PAGE.index(heading) :].split("\n\n")[0].splitlines()[2:]
    return [[cell.strip() for cell in line.strip().strip("|").split("|")] for line in table]


def test_waves():
    table = rows("| $k a$ |")
    assert len(table) == 7
    for k, *values in table:
        assert [f"{threshold(float(k), twist):.4f}" for twist in (False, True)] == values


@pytest.mark.filterwarnings("ignore::ribbonrs.RibbonWarning")  # growth at eta = 0.2
def test_body():
    table = rows("| shape |")
    assert len(table) == 12
    shape = ""
    for name, eta, energy, neglected in table:
        shape = name.split(",")[0] or shape
        growth = SHAPES[shape](float(eta))
        states = rb.natural_shapes(rb.Ribbon(10.0, 1.0, float(eta), MATERIAL), growth)
        phase = "twisted" if shape == "twisted" else "bent"
        state = next(state for state in states if state.phase == phase)
        assert f"{100 * part_off(growth, state.strain, float(eta)):.2f} %" == energy
        assert f"{100 * state.neglected:.2f} %" == neglected


def test_scenes():
    bounds = {"below 3 %": (0.0, 0.03), "3 to 10 %": (0.03, 0.1), "above 10 %": (0.1, 0.25)}
    bounds["above 25 %, with a warning"] = (0.25, 1.0)
    told = {}
    for part, names in rows("| part |"):
        told |= {name.strip().replace(" ", "_"): bounds[part] for name in names.split(",")}
    paths = sorted((ROOT / "examples").glob("*.toml"))
    assert {path.stem for path in paths} == set(told)
    for path in paths:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            if path.stem == "kinked_strip":
                warnings.filterwarnings("ignore", "the shape jumps|neglected", rb.RibbonWarning)
            job = read(path)
            part = rb.solve(job.scene, **job.options).neglected
        least, most = told[path.stem]
        assert least <= part < most, path.stem
