"""Figures 10 to 12 of the paper and the plane of phases: their data against closed forms, and their files."""

import math

import numpy as np
import pytest
import ribbonrs as rb
from refusal import refuses
from ribbonrs import figures

NAMES = ["fig10", "fig11", "fig12", "phase_plane"]
# Where the K2^2 term of eq. (59) vanishes, C/eta^2: if the edges grow, and if the middle does.
SOFT, SOFT_MIDDLE = 14 - math.sqrt(1036), 14 + math.sqrt(1036)
BEND, TWIST = -SOFT / 4, 5.0


def coil(omega, C=SOFT):
    """Growth over eta^2 at which the twisted ribbon coils: C = k3^2/2 - 4 xi = -20 (1 - omega/k3)."""
    return (omega / (1 + C / 20)) ** 2 / 8 - C / 4


@pytest.fixture(scope="module")
def drawn():
    """Every figure of its own parameters."""
    return {name: figures.FIGURES[name]() for name in NAMES}


def table(drawing, part):
    return {name: np.array(values) for name, values in drawing.tables[part].items()}


# --- 10: branches


def test_fig10_branches_meet_where_the_closed_forms_say(drawn):
    points = table(drawn["fig10"], "special_points")
    found = {
        (omega, kind): points["xi_over_eta2"][(points["omega"] == omega) & (points["kind"] == kind)]
        for omega in (0.0, 0.2)
        for kind in ("branch_point", "fold")
    }
    np.testing.assert_allclose(found[0.0, "branch_point"], [4.546738469715593, TWIST], rtol=1e-9)
    np.testing.assert_allclose(found[0.2, "branch_point"], [coil(0.2)], rtol=1e-9)
    assert found[0.0, "fold"].size == 0
    # The other hand begins where xi = k3^2/8 + 5 (1 - omega/k3) is least: k3^3 = -20 omega.
    k3 = -math.cbrt(20 * 0.2)
    np.testing.assert_allclose(found[0.2, "fold"], [k3**2 / 8 + 5 * (1 - 0.2 / k3)], rtol=1e-9)
    np.testing.assert_allclose(points["xi"], 0.01 * points["xi_over_eta2"], rtol=1e-14)


def test_fig10_twisted_branch_is_eq64_and_nothing_on_it_is_stable(drawn):
    branches = table(drawn["fig10"], "branches")
    twisted = branches["phase"] == "twisted"
    # At the branch point itself rounding of xi, 1e-17, is what K3^2 loses.
    xi, K3 = branches["xi"][twisted], branches["K3"][twisted]
    np.testing.assert_allclose(K3**2, 8 * (xi - TWIST * 0.01), rtol=1e-9, atol=1e-15)
    assert twisted.sum() > 20
    assert set(branches["stable"][twisted]) == {False}
    closed = table(drawn["fig10"], "eq64")
    np.testing.assert_allclose(closed["K3"] ** 2, 8 * (closed["xi"] - 0.05), rtol=1e-12, atol=1e-16)


def test_fig10_flat_and_bent_are_stable_below_and_beyond_the_threshold(drawn):
    branches = table(drawn["fig10"], "branches")
    flat, bent = (branches["phase"] == phase for phase in ("flat", "bent"))
    away = np.abs(branches["xi"] / 0.01 - BEND) > 1e-6
    stable = branches["stable"].astype(bool)
    np.testing.assert_array_equal(stable[flat & away], branches["xi"][flat & away] < 0.01 * BEND)
    assert stable[bent & away].all()
    assert set(branches["phase"]) == {"flat", "bent", "twisted"}


def test_fig10_with_chirality_the_twisted_ribbon_is_stable_until_it_coils(drawn):
    branches = table(drawn["fig10"], "branches_chiral")
    x, k3 = branches["xi"] / 0.01, branches["K3"] / 0.1
    twisted, helical = (branches["phase"] == phase for phase in ("twisted", "helical"))
    # At xi = 0 two terms of size 5 cancel.
    closed = k3[twisted] ** 2 / 8 + 5 * (1 - 0.2 / k3[twisted])
    np.testing.assert_allclose(closed, x[twisted], rtol=1e-9, atol=1e-14)
    away = np.abs(x - coil(0.2)) > 1e-6
    stable = branches["stable"].astype(bool)
    right = k3 > 0
    np.testing.assert_array_equal(stable[twisted & right & away], x[twisted & right & away] < coil(0.2))
    assert not stable[twisted & ~right].any()
    assert (~right).any()
    assert stable[helical & away].all()
    assert right[helical].all()


def test_fig10_strains_do_not_vary_along_the_ribbon_and_are_the_helix(drawn):
    averages = table(drawn["fig10"], "averages")
    assert averages["phase"].tolist() == ["twisted", "helical"]
    # At xi = 5 eta^2: k3^3 = 40 omega.
    np.testing.assert_allclose(averages["mean_K3"] / 0.1, [math.cbrt(40 * 0.2), 2.2149], atol=5e-5)
    np.testing.assert_allclose(averages["mean_K2"] / 0.1, [0.0, 2.4156], atol=5e-5)
    for name in ("K1", "K2", "K3"):
        # Of a tolerance of 1e-10.
        assert np.max(averages[f"spread_{name}"]) < 1e-10
    strains = table(drawn["fig10"], "strains")
    for i, x in enumerate((5.0, 6.0)):
        here = strains["xi_over_eta2"] == x
        assert strains["S"][here][[0, -1]].tolist() == [0.0, 12.0]
        assert strains["K2"][here].mean() == pytest.approx(averages["mean_K2"][i], abs=1e-15)


def test_fig10_draws_both_mirror_images(drawn):
    for axes, odd in zip(drawn["fig10"].figure.axes[:4], (True, True, False, True), strict=True):
        heights = np.concatenate([line.get_ydata() for line in axes.lines if len(line.get_ydata()) > 2])
        assert (np.max(heights) == pytest.approx(-np.min(heights), rel=1e-12)) == odd


# --- 11: shapes


def test_fig11_goes_from_twisted_to_helical_where_the_closed_form_says(drawn):
    states = table(drawn["fig11"], "states")
    coiled = states["xi_over_eta2"] > coil(0.2)
    np.testing.assert_array_equal(states["phase"] == "helical", coiled)
    assert set(states["phase"]) == {"twisted", "helical"}
    assert np.all(states["K2"][~coiled] == 0.0)
    assert np.all(states["u1/a at 0"][~coiled] == 0.0)


def test_fig11_deflections_are_in_proportion_to_the_thickness(drawn):
    states = table(drawn["fig11"], "states")
    thin, thick = (states["eta"] == eta for eta in (0.05, 0.1))
    for name in ("K2", "K3", "u1/a at 0", "u1/a at 0.4", "u1/a at 0.5"):
        np.testing.assert_allclose(states[name][thick], 2 * states[name][thin], rtol=1e-9, atol=1e-15)


def test_fig11_deflection_is_larger_at_the_edge_and_keeps_its_sign(drawn):
    """What the paper says of it is not found: small at the edge, positive and then negative in the middle."""
    growths = [5.2, 5.3, 5.4, 5.6, 6.0, 7.0, 10.0, 20.0, 50.0, 100.0]
    wide = figures.fig11(eta=[0.02], x=growths)
    for drawing in (drawn["fig11"], wide):
        states = table(drawing, "states")
        bent = states["K2"] > 0
        middle, edge = states["u1/a at 0"][bent], states["u1/a at 0.5"][bent]
        assert np.all(middle > 0)
        assert np.all(edge < -1.7 * middle)
        assert np.all(states["u1/a at 0.4"][bent] < 0)
    assert np.all(np.diff(middle) > 0)
    assert np.all(np.diff(edge) < 0)


def test_fig11_profiles_have_neither_mean_nor_slope(drawn):
    deflection = table(drawn["fig11"], "deflection")
    x = deflection.pop("x")
    assert len(deflection) == 12
    for profile in deflection.values():
        np.testing.assert_allclose(profile, profile[::-1], rtol=0, atol=1e-15)
        # By Simpson's rule, whose error is 1e-8 of the profile's fourth derivative of order 10 u1.
        weights = np.array([1, *([4, 2] * 50)[:-1], 1]) / 300
        assert abs(weights @ profile) < 1e-6 * max(np.max(np.abs(profile)), 1e-300)
    assert x.size == 101


# --- 12: thresholds


def test_fig12_loci_are_parabolas(drawn):
    loci = table(drawn["fig12"], "loci")
    kinds = {("flat bends", 0.0): BEND, ("flat twists", 0.0): TWIST}
    kinds |= {("twisted coils", omega): coil(omega) for omega in (0.1, 0.2, 0.3)}
    assert set(zip(loci["change"].tolist(), loci["omega"].tolist(), strict=True)) == set(kinds)
    for (change, omega), factor in kinds.items():
        here = (loci["change"] == change) & (loci["omega"] == omega)
        eta, xi = loci["eta"][here], loci["xi"][here]
        assert eta.size == 12
        np.testing.assert_allclose(xi, factor * eta**2, rtol=1e-8)
        np.testing.assert_allclose(loci["closed_form"][here], factor, rtol=1e-14)


@pytest.mark.parametrize("name", ["fig12", "phase_plane"])
def test_boundaries_of_phases_are_the_closed_forms(drawn, name):
    boundaries = table(drawn[name], "boundaries")
    line = boundaries["line"]
    # Where lines meet, near omega = 0, a point is known to the size of the smallest cells only.
    inner = (line == np.roll(line, 1)) & (line == np.roll(line, -1))
    coiling = (boundaries["phases"] == "helical/twisted") & inner
    omega, x = boundaries["omega"][coiling], boundaries["xi_over_eta2"][coiling]
    edges = x > 0
    assert edges.sum() > 50
    # Where it crosses a line of the grid a boundary is known to 1e-10 of the spans, of 2 and some 35.
    np.testing.assert_allclose(x[edges], coil(omega[edges]), rtol=1e-8)
    np.testing.assert_allclose(x[~edges], coil(omega[~edges], SOFT_MIDDLE), rtol=1e-8)
    assert (~edges).any() == (name == "phase_plane")


# --- the plane of phases


def test_phase_plane_shows_the_phases_of_the_closed_forms(drawn):
    shapes = table(drawn["phase_plane"], "shapes")
    omega, x = shapes["omega"], shapes["xi_over_eta2"]
    assert omega.size == 63
    curved = (x > coil(omega)) | (x < coil(omega, SOFT_MIDDLE))
    expected = np.where(omega == 0, np.where(curved, "bent", "flat"), np.where(curved, "helical", "twisted"))
    assert shapes["phase"].tolist() == expected.tolist()
    np.testing.assert_array_equal(np.sign(shapes["K3"]), np.sign(omega))
    np.testing.assert_array_equal(shapes["K2"] > 0, curved)
    assert np.all(shapes["K1"] == 0)


def test_phase_plane_bends_where_the_middle_grows():
    x = (14 + math.sqrt(1036)) / 4
    drawing = figures.phase_plane(omega=[0.0, 0.1], x=[-x - 1e-5, -x + 1e-5])
    assert drawing.tables["shapes"]["phase"][::2] == ["bent", "flat"]


# --- files, input


def test_captions_say_what_is_computed_and_what_is_not_in_the_paper(drawn):
    for name in NAMES:
        drawing = drawn[name]
        assert drawing.name == name
        assert "section law" in drawing.caption
        assert getattr(figures, name) is figures.FIGURES[name]
        assert name in figures.__all__
        assert all(len(set(map(len, part.values()))) == 1 for part in drawing.tables.values())
        if name != "phase_plane":
            assert drawing.caption.startswith(f"Fig. {name[3:]}. ")
            assert "does not state" in drawing.caption
    assert list(figures.FIGURES)[-4:] == NAMES
    for numbers in ("4.5467 eta^2", "5.1552 eta^2", "0.207 to 0.237"):
        assert numbers in drawn["fig10"].caption


@pytest.mark.parametrize("name", NAMES)
def test_files_are_written(drawn, name, tmp_path):
    written = drawn[name].save(tmp_path, ["pdf", "png"])
    assert sorted(written) == sorted(tmp_path.iterdir())
    assert (tmp_path / f"{name}.pdf").read_bytes().startswith(b"%PDF")
    assert {path.suffix for path in written} == {".pdf", ".png", ".csv", ".txt"}


@pytest.mark.parametrize(
    ("name", "given", "field"),
    [
        ("fig10", {"eta": 0.0}, "eta"),
        ("fig10", {"omega": math.nan}, "omega"),
        ("fig10", {"highest": -1.0}, "highest"),
        ("fig10", {"shown": [5.0]}, "shown"),
        ("fig11", {"eta": []}, "eta"),
        ("fig11", {"x": []}, "x"),
        ("fig11", {"x": [1.0, "much"]}, "x[1]"),
        ("fig11", {"omega": None}, "omega"),
        ("fig12", {"eta": 1.0}, "eta"),
        ("fig12", {"omega": []}, "omega"),
        ("fig12", {"omega": [0.2, 0.1]}, "omega"),
        ("fig12", {"omega": [-0.1]}, "omega"),
        ("fig12", {"omega": [0.1, 0.2, 0.3, 0.4, 0.5]}, "omega"),
        ("fig12", {"highest": 5.0}, "highest"),
        ("phase_plane", {"eta": -0.1}, "eta"),
        ("phase_plane", {"omega": [0.0]}, "omega"),
        ("phase_plane", {"x": [1.0, 1.0]}, "x"),
        ("phase_plane", {"x": [0.0, math.inf]}, "x[1]"),
    ],
)
def test_what_cannot_be_drawn_is_refused(name, given, field):
    refuses(field, lambda: figures.FIGURES[name](**given))


@pytest.mark.parametrize(
    ("name", "given"),
    [
        ("fig10", {"eta": 0.05, "omega": -0.3, "highest": 10.0, "shown": (1.0, 9.0)}),
        ("fig10", {"omega": 0.0, "highest": 2.0, "shown": (0.0, 1.0)}),
        ("fig11", {"eta": [0.02], "x": [-13.0, 2.0], "omega": -0.1}),
        ("fig11", {"x": [0.0], "omega": 0.0}),
        ("fig12", {"eta": 0.04, "omega": [0.8], "highest": 5.5}),
        ("phase_plane", {"eta": 0.02, "omega": [0.1, 0.3], "x": [1.0, 2.0, 4.0]}),
        ("phase_plane", {"eta": 0.02, "omega": [0.0, 0.3], "x": [0.0, 8.0]}),
    ],
)
def test_other_parameters_are_drawn(name, given):
    drawing = figures.FIGURES[name](**given)
    drawing.figure.canvas.draw()
    assert all(len(set(map(len, part.values()))) == 1 for part in drawing.tables.values())


def test_growth_beyond_the_theory_is_said():
    with pytest.warns(rb.RibbonWarning, match=r"growth\.size"):
        figures.phase_plane(eta=0.1, omega=[0.0, 0.5], x=[0.0, 16.0])
