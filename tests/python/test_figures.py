"""The figures of the paper, their data and their files: `ribbonrs.figures` and `ribbonrs figures`."""

import csv
import math
from pathlib import Path

import numpy as np
import pytest
import reference as ref
import ribbonrs as rb
from refusal import refuses
from ribbonrs import figures
from ribbonrs.cli import main
from ribbonrs.figures.extrema import KINDS, Plane
from ribbonrs.figures.saddles import READINGS, shape

NAMES = ["fig3", "fig4", "fig5", "fig6", "fig7", "fig8", "fig9"]
BEND = (math.sqrt(259) - 7) / 2  # where the K2^2 term of eq. (59) vanishes at K3 = 0, in units of eta^2
TWIST = {"eps0": 20 / 9, "n30": 5.0}  # likewise the K3^2 term


@pytest.fixture(scope="module")
def drawn():
    """Every figure of the paper's own parameters."""
    return {name: figures.FIGURES[name]() for name in NAMES}


def column(drawing, table, name):
    return np.array(drawing.tables[table][name])


def marks(drawing, marker):
    """Where the lines with a marker are, one array (n, 2) for each pair of axes that has one."""
    per_axes = [
        [line.get_xydata() for line in axes.lines if line.get_marker() == marker and len(line.get_xdata())]
        for axes in drawing.figure.axes
    ]
    return [np.concatenate(found) for found in per_axes if found]


# --- growth through the thickness: 3, 4, 5


@pytest.mark.parametrize("eta", [0.05, 0.1])
@pytest.mark.parametrize("xi", [0.1, -0.3])
def test_shapes_have_the_curvature_and_the_deflection_of_their_equations(eta, xi):
    x = np.linspace(-0.5, 0.5, 11)
    states = {reading: shape(reading, eta, xi, 5.0) for reading in READINGS}
    K2 = {reading: float(state.strain[2]) for reading, state in states.items()}
    assert K2["consistent"] == pytest.approx(-xi, rel=1e-14)
    energy, slope, curving = ref.saddle(eta, xi, K2["published"], "published")
    assert abs(slope) < 1e-14 * abs(curving * K2["published"])
    assert energy > 0
    isochoric = ref.General(eta, {"d33": [xi], "d22": [-xi / 2]})((0.0, 0.0, K2["isochoric"], 0.0))
    assert abs(isochoric.gradient[2]) < 1e-14 * abs(isochoric.hessian[2][2] * K2["isochoric"])
    # The printed deflection is that of the isochoric ribbon at the same curvature.
    printed = rb.analytic.saddle(eta, xi, form="published")
    for reading, wanted in (
        ("published", printed.deflection(x, K2["published"])),
        ("consistent", np.zeros(11)),
        ("isochoric", printed.deflection(x, K2["isochoric"])),
    ):
        np.testing.assert_allclose(states[reading].deflection(x)[0], wanted, rtol=0, atol=1e-15)


def test_fig3_shows_the_growth_and_the_three_shapes(drawn):
    growth = drawn["fig3"].tables["growth"]
    np.testing.assert_allclose(growth["g33"], 0.3 * 0.05 * np.array(growth["X1/h"]), rtol=1e-15)
    x = column(drawn["fig3"], "deflection", "x")
    for reading in READINGS:
        wanted = shape(reading, 0.05, 0.3, 5.0).deflection(x)[0]
        assert column(drawn["fig3"], "deflection", f"u1/a {reading}").tolist() == wanted.tolist()


def test_fig4_energies_are_those_of_both_equations(drawn):
    K2 = column(drawn["fig4"], "energy", "K2")
    for xi in (0.1, 0.2, 0.3):
        for form in ("published", "consistent"):
            values = column(drawn["fig4"], "energy", f"Pi {form} xi={xi}")
            for i in range(0, K2.size, 24):
                exact = float(ref.saddle(0.05, xi, K2[i], form)[0])
                # What is left where the consistent energy vanishes is K2 + xi rounded, squared.
                assert values[i] == pytest.approx(exact, rel=1e-12, abs=1e-30)


def test_fig4_curvatures_are_from_1_to_1_05_xi_as_published_and_xi_itself(drawn):
    xi = column(drawn["fig4"], "curvature", "xi")
    np.testing.assert_allclose(column(drawn["fig4"], "curvature", "K2 consistent"), -xi, rtol=1e-13)
    published = -column(drawn["fig4"], "curvature", "K2 published") / xi
    assert np.all(np.diff(published) > 0)
    assert (round(published[0], 3), round(published[-1], 4)) == (1.0, 1.0494)
    places = marks(drawn["fig4"], "o")[0]
    for g in (0.1, 0.2, 0.3):
        assert any(np.allclose(place, (-g, 0.0), rtol=0, atol=1e-15) for place in places)


def test_fig5_published_curvature_depends_on_the_thickness_and_the_consistent_does_not(drawn):
    thin, thick = (drawn["fig5"].tables[f"curvature_eta{eta}"] for eta in (0.05, 0.1))
    assert thin["xi"] == [0.0, 0.1, 0.2, 0.3]
    np.testing.assert_allclose(thin["K2 consistent"], thick["K2 consistent"], rtol=1e-13, atol=0)
    assert [round(K2, 4) for K2 in (thin["K2 published"][-1], thick["K2 published"][-1])] == [
        -0.3148,
        -0.3082,
    ]
    for table, eta in ((thin, 0.05), (thick, 0.1)):
        for reading in READINGS:
            assert table[f"K2 {reading}"][2] == shape(reading, eta, 0.2, 5.0).strain[2]


# --- edge growth: 6, 7, 8, 9


@pytest.mark.parametrize("x", [-3.0, 0.0, 4.5, 4.56, 4.99, 5.01, 6.0, 30.0, 300.0])
@pytest.mark.parametrize("eta", [0.001, 0.01])
def test_extrema_of_free_ends_are_the_natural_shapes(eta, x):
    xi = x * eta**2
    found = Plane(eta, xi, "n30").extrema()
    states = rb.natural_shapes(rb.Ribbon(10.0, 1.0, eta), rb.growth.edge(xi))
    wanted = sorted((s.strain[2], s.strain[3], s.energy, KINDS[s.section_index]) for s in states)
    assert len(found) == len(wanted)
    for one, (K2, K3, energy, kind) in zip(found, wanted, strict=True):
        np.testing.assert_allclose([one.K2, one.K3], [K2, K3], rtol=1e-9, atol=1e-9 * eta)
        assert one.energy == pytest.approx(energy, rel=1e-12, abs=1e-300)
        assert one.kind == kind


@pytest.mark.parametrize("condition", ["eps0", "n30"])
@pytest.mark.parametrize("x", [-1.0, 2.0, 3.0, 4.6, 8.0, 40.0])
def test_extrema_at_both_conditions_are_those_of_the_closed_forms(condition, x):
    eta = 0.05
    twist, bend = x > TWIST[condition], x > BEND
    found = Plane(eta, x * eta**2, condition).extrema()
    straight = Plane(eta, x * eta**2, condition).extrema(straight=True)
    assert [one.K3 for one in straight] == pytest.approx(
        [one.K3 for one in found if one.K2 == 0.0], rel=1e-12
    )
    assert len(found) == 1 + 2 * twist + 2 * bend
    kinds = {(one.K2 != 0.0, one.K3 != 0.0): one.kind for one in found}
    assert kinds[False, False] == KINDS[twist + bend]
    if twist:
        K3 = eta * math.sqrt(8 * (x - TWIST[condition]))
        assert [one.K3 for one in straight] == pytest.approx([-K3, 0.0, K3], rel=1e-12)
        # On the twisted branch the K2^2 term is constant: (59) at C = -80 eta^2/9 and at -20 eta^2.
        assert kinds[False, True] == {"eps0": "minimum", "n30": "saddle"}[condition]
    if bend:
        assert kinds[True, False] == {"eps0": "saddle", "n30": "minimum"}[condition]


@pytest.mark.parametrize("condition", ["eps0", "n30"])
def test_fig6_energies_are_the_closed_forms(drawn, condition):
    K2, K3 = (column(drawn["fig6"], f"energy_{condition}", name) for name in ("K2", "K3"))
    eps = 0.0 if condition == "eps0" else 0.01 - K3**2 / 24
    leaf = rb.analytic.twist(0.1, 0.03)
    full, quadratic = (column(drawn["fig6"], f"energy_{condition}", n) for n in ("Pi", "Pi quadratic"))
    np.testing.assert_allclose(full, leaf.energy(eps, 0, K2, K3), rtol=1e-12)
    np.testing.assert_allclose(quadratic, leaf.energy_second_order(eps, 0, K2, K3), rtol=1e-12)


def test_fig6_has_the_three_extrema_of_the_paper_with_the_length_held_only(drawn):
    held, free = (drawn["fig6"].tables[f"extrema_{condition}"] for condition in ("eps0", "n30"))
    K3 = math.sqrt(8 * 0.03 - 160 * 0.1**2 / 9)
    assert held["K2"] == [0.0, 0.0, 0.0]
    assert held["K3"] == pytest.approx([-K3, 0.0, K3], rel=1e-12)
    assert held["kind"] == ["minimum", "saddle", "minimum"]
    assert (free["K2"], free["K3"], free["kind"]) == ([0.0], [0.0], ["minimum"])
    panels = marks(drawn["fig6"], "o")
    np.testing.assert_allclose(panels[0], [(0.0, -K3), (0.0, K3)], rtol=1e-12)
    assert [len(panel) for panel in panels] == [2, 2, 1, 1]  # contours and surface, at both conditions


@pytest.mark.parametrize(
    ("name", "cases"),
    [
        ("fig7", [(eta, 0.03) for eta in (0.05, 0.06, 0.07, 0.08, 0.1)]),
        ("fig8", [(0.05, xi) for xi in (0.01, 0.02, 0.03, 0.04)]),
    ],
)
@pytest.mark.parametrize("condition", ["eps0", "n30"])
def test_energies_over_twist_and_their_extrema_are_the_closed_forms(drawn, name, cases, condition):
    energies = drawn[name].tables[f"energy_{condition}"]
    K3 = np.array(energies["K3"])
    table = drawn[name].tables[f"extrema_{condition}"]
    rows = list(zip(*table.values(), strict=True))
    expected = []
    for (eta, xi), values in zip(cases, list(energies.values())[1:], strict=True):
        eps = 0.0 if condition == "eps0" else xi / 3 - K3**2 / 24
        np.testing.assert_allclose(values, rb.analytic.twist(eta, xi).energy(eps, 0, 0, K3), rtol=1e-12)
        beyond = 8 * (xi - TWIST[condition] * eta**2)
        expected += [
            (eta, xi, k) for k in ((-math.sqrt(beyond), 0, math.sqrt(beyond)) if beyond > 0 else (0,))
        ]
    np.testing.assert_allclose([row[:3] for row in rows], expected, rtol=1e-12)
    for eta, xi, twist, _, kind in rows:
        if twist:
            assert kind == ("minimum" if condition == "eps0" else "saddle")
        else:
            assert kind == KINDS[(xi > TWIST[condition] * eta**2) + (xi > BEND * eta**2)]


def test_fig8_marks_every_extremum_by_its_kind(drawn):
    for kind, marker in (("minimum", "o"), ("saddle", "D"), ("maximum", "^")):
        found = np.concatenate(marks(drawn["fig8"], marker))
        tables = (drawn["fig8"].tables[f"extrema_{condition}"] for condition in ("eps0", "n30"))
        wanted = [
            (K3, energy)
            for table in tables
            for K3, energy, of in zip(table["K3"], table["energy"], table["kind"], strict=True)
            if of == kind
        ]
        assert found.tolist() == [list(place) for place in wanted]


@pytest.mark.parametrize("condition", ["eps0", "n30"])
def test_fig9_thresholds_and_twists_are_the_closed_forms(drawn, condition):
    eta = column(drawn["fig9"], f"thresholds_{condition}", "eta")
    twist, bend = (column(drawn["fig9"], f"thresholds_{condition}", f"xi {n}") for n in ("twist", "bend"))
    np.testing.assert_allclose(twist, TWIST[condition] * eta**2, rtol=1e-12)
    np.testing.assert_allclose(bend, BEND * eta**2, rtol=1e-12)
    for h in eta:
        table = drawn["fig9"].tables[f"twist_{condition}_eta{h:g}"]
        # Near the threshold the rounding of xi - threshold, 1e-17, is what the square root enlarges.
        beyond = 8 * (np.array(table["xi"]) - TWIST[condition] * h**2)
        np.testing.assert_allclose(np.array(table["K3"]) ** 2, beyond, rtol=1e-12, atol=1e-15)
        assert set(table["kind"]) == {"minimum" if condition == "eps0" else "saddle"}
        assert table["xi"][-1] == pytest.approx(0.1, rel=1e-15)


def test_fig9_marks_the_thresholds(drawn):
    eta = np.array([0.04, 0.06, 0.08, 0.1])
    held, free = marks(drawn["fig9"], "*")
    np.testing.assert_allclose(held[:, 0], TWIST["eps0"] * eta**2, rtol=1e-12)
    np.testing.assert_allclose(free[:, 0], TWIST["n30"] * eta**2, rtol=1e-12)
    (bends,) = marks(drawn["fig9"], "v")
    np.testing.assert_allclose(bends[:, 0], BEND * eta**2, rtol=1e-12)


def test_fig9_draws_no_twist_that_begins_beyond_the_range():
    drawing = figures.fig9(eta=[0.1, 0.3], xi=0.06)
    assert [name for name in drawing.tables if name.startswith("twist")] == [
        "twist_eps0_eta0.1",
        "twist_n30_eta0.1",
    ]


# --- files, input, command line


def test_captions_name_law_and_conditions_and_figures_are_in_the_order_of_the_paper(drawn):
    assert [name for name in figures.FIGURES if name in NAMES] == NAMES
    for name, drawing in drawn.items():
        assert drawing.name == name
        assert drawing.caption.startswith(f"Fig. {name[3:]}. ")
        assert getattr(figures, name) is figures.FIGURES[name]
        assert name in figures.__all__
        condition = "eps = 0" if name in NAMES[3:] else "onsistent"
        assert condition in drawing.caption


@pytest.mark.parametrize("name", ["fig3", "fig8"])
def test_files_are_figures_tables_and_the_caption(drawn, name, tmp_path):
    written = drawn[name].save(tmp_path, ("pdf", "png", "svg"))
    assert sorted(written) == sorted(tmp_path.iterdir())
    assert (tmp_path / f"{name}.pdf").read_bytes().startswith(b"%PDF")
    assert (tmp_path / f"{name}.png").read_bytes().startswith(b"\x89PNG")
    assert "<svg" in (tmp_path / f"{name}.svg").read_text()[:1000]
    assert " ".join((tmp_path / f"{name}.txt").read_text().split()) == drawn[name].caption
    for part, columns in drawn[name].tables.items():
        with (tmp_path / f"{name}_{part}.csv").open() as file:
            rows = list(csv.reader(file))
        assert rows[0] == list(columns)
        for i, values in enumerate(columns.values()):
            # All digits: what is read is what was drawn.
            assert [type(v)(row[i]) for row, v in zip(rows[1:], values, strict=True)] == list(values)


def test_the_same_figure_gives_the_same_file(drawn, tmp_path):
    for folder in (tmp_path / "a", tmp_path / "b"):
        folder.mkdir()
        figures.fig8().save(folder, ["pdf", "png"])
    for name in ("fig8.pdf", "fig8.png"):
        assert (tmp_path / "a" / name).read_bytes() == (tmp_path / "b" / name).read_bytes()


@pytest.mark.parametrize(
    ("name", "given", "field"),
    [
        ("fig3", {"eta": 0.0}, "eta"),
        ("fig3", {"eta": 1.5}, "eta"),
        ("fig3", {"xi": math.nan}, "xi[0]"),
        ("fig3", {"length": -1.0}, "length"),
        ("fig4", {"eta": math.nan}, "eta"),
        ("fig4", {"xi": []}, "xi"),
        ("fig4", {"xi": 0.1}, "xi"),
        ("fig5", {"eta": [0.05, -0.1]}, "eta[1]"),
        ("fig5", {"xi": [0.0, math.inf]}, "xi[1]"),
        ("fig6", {"eta": "thin"}, "eta"),
        ("fig6", {"length": 0.0}, "length"),
        ("fig7", {"eta": []}, "eta"),
        ("fig7", {"xi": None}, "xi[0]"),
        ("fig8", {"xi": [True]}, "xi[0]"),
        ("fig9", {"eta": [0.1, 0.0]}, "eta[1]"),
        ("fig9", {"xi": 0.0}, "xi"),
    ],
)
def test_what_cannot_be_drawn_is_refused(name, given, field):
    refuses(field, lambda: figures.FIGURES[name](**given))


def test_other_parameters_are_drawn():
    for drawing in (
        figures.fig3(eta=0.2, xi=-0.1, length=2.0),
        figures.fig4(eta=0.1, xi=[0.0, -0.2]),
        figures.fig6(eta=0.05, xi=0.03),
        figures.fig7(eta=np.array([0.05]), xi=-0.01),
        figures.fig8(eta=0.05, xi=(0.0,)),
    ):
        drawing.figure.canvas.draw()
        assert all(len(set(map(len, table.values()))) == 1 for table in drawing.tables.values())
    kinds = figures.fig6(eta=0.05, xi=0.03).tables["extrema_n30"]["kind"]
    assert sorted(kinds) == ["maximum", "minimum", "minimum", "saddle", "saddle"]


def test_command_draws_what_it_is_told_and_says_what_it_wrote(tmp_path, capsys):
    folder = tmp_path / "new" / "figures"
    assert main(["figures", "fig8", "fig4", "--directory", str(folder), "--format", "png", "svg"]) == 0
    screen, errors = capsys.readouterr()
    told = [Path(line.removeprefix("wrote ")) for line in screen.splitlines()]
    assert errors == ""
    assert sorted(told) == sorted(folder.iterdir())
    assert {path.suffix for path in told} == {".png", ".svg", ".csv", ".txt"}
    assert told[0].name == "fig8.png"


def test_command_draws_every_figure_in_vector_and_raster_if_nothing_is_said(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    some = {name: figures.FIGURES[name] for name in ("fig7", "fig9")}
    monkeypatch.setattr(figures, "FIGURES", some)
    assert main(["figures"]) == 0
    found = {path.name for path in Path("figures").iterdir()}
    assert found >= {"fig7.pdf", "fig7.png", "fig9.pdf", "fig9.png", "fig9.txt"}
    assert {f"wrote figures/{name}" for name in found} == set(capsys.readouterr().out.splitlines())


@pytest.mark.parametrize(
    ("arguments", "field", "told"),
    [
        (["fig41"], "figure = 'fig41'", "the nearest is fig4"),
        (["fig4", "figure7"], "figure = 'figure7'", "the nearest is fig7"),
        (["fig4", "--format", "pgn"], "format = 'pgn'", "the nearest is png"),
    ],
)
def test_command_refuses_unknown_names_with_the_nearest(arguments, field, told, tmp_path, capsys):
    assert main(["figures", *arguments, "--directory", str(tmp_path / "figures")]) == 2
    screen, errors = capsys.readouterr()
    assert screen == ""
    assert errors.startswith(f"ribbonrs: {field}: expected one of ")
    assert errors.endswith(f"{told}\n")
    assert not (tmp_path / "figures").exists()


def test_command_refuses_a_directory_that_is_a_file(tmp_path, capsys):
    (tmp_path / "taken").touch()
    assert main(["figures", "fig4", "--directory", str(tmp_path / "taken")]) == 2
    assert capsys.readouterr().err.startswith("ribbonrs: directory = ")
