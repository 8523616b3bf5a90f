"""Phase diagrams: known boundaries, what is refused, interrupts, any number of threads."""

import _thread
import math
import os
import subprocess
import sys
import threading
import time

import numpy as np
import pytest
import ribbonrs as rb

ONSET = (math.sqrt(259.0) - 7.0) / 2.0
H = 0.1
LEAF = rb.Ribbon(10.0, 1.0, H)
CHIRAL = rb.Scene(LEAF, rb.growth.edge(0.06) + rb.growth.chiral(0.04))
EDGE, SHEAR, FACE = (f"growth.{name}.amplitude" for name in ("edge", "chiral", "thickness"))


def lines(diagram, *phases):
    return [line for line in diagram.boundaries if set(line.phases) == set(phases)]


def side_of(line, place):
    """The phase on the side of a line where a place is, judged at the nearest of its segments."""
    middles = 0.5 * (line.points[1:] + line.points[:-1])
    k = int(np.argmin(np.sum((middles - place) ** 2, axis=1)))
    (tx, ty), (px, py) = line.points[k + 1] - line.points[k], place - line.points[k]
    return line.phases[0] if tx * py - ty * px > 0.0 else line.phases[1]


def test_flat_bends_on_a_parabola():
    scene = rb.Scene(LEAF, rb.growth.edge(0.06))
    diagram = rb.phase_diagram(scene, ("ribbon.thickness", (0.02, 0.14)), (EDGE, (0.0, 0.08)), (31, 17))
    (line,) = diagram.boundaries
    h, xi = line.points.T
    assert len(h) > 31
    assert np.max(np.abs(xi / h**2 / ONSET - 1.0)) < 2e-8  # 1e-10 of the span of h, at the thinnest
    assert set(line.phases) == {"flat", "bent"}
    assert line.kind == "instability"
    assert side_of(line, (0.12, 0.02)) == "flat"
    assert side_of(line, (0.04, 0.07)) == "bent"
    assert diagram.phase.shape == (17, 31)
    assert diagram.done.all()
    # Where the flat ribbon, long unstable, could begin to twist.
    h, xi = np.meshgrid(diagram.x.values, diagram.y.values)
    assert np.allclose(xi[~diagram.resolved], 5.0 * h[~diagram.resolved] ** 2, rtol=1e-9)
    assert set(diagram.stable_count[diagram.phase == "bent"].tolist()) == {2}
    # The area under the parabola, up to where it leaves at the top.
    top = math.sqrt(0.08 / ONSET)
    flat = (ONSET * (top**3 - 0.02**3) / 3.0 + 0.08 * (0.14 - top)) / (0.12 * 0.08)
    assert diagram.areas["flat"] == pytest.approx(flat, abs=1e-3)
    assert sum(diagram.areas.values()) == pytest.approx(1.0, abs=1e-12)


def test_chirality_coils_where_the_energy_says():
    diagram = rb.phase_diagram(CHIRAL, (SHEAR, (0.0, 0.1)), (EDGE, (0.0, 0.1)), 41)
    (line,) = lines(diagram, "twisted", "helical")
    away = line.points[line.points[:, 0] > 2e-4]
    omega, xi = away[:, 0] / (2.0 * H), away[:, 1] / H**2
    k3 = omega / (1.0 + (14.0 - math.sqrt(1036.0)) / 20.0)
    assert np.max(np.abs(xi - (ONSET + k3**2 / 8.0))) < 1e-8
    assert line.kind == "instability"
    assert np.nanmax(line.jump) < 1e-3
    # Without chirality there is neither twist nor a helix: on one side of the diagram alone.
    assert set(diagram.phase[:, 0]) == {"flat", "bent"}
    assert {line.kind for line in lines(diagram, "flat", "twisted")} == {"name"}
    assert diagram.areas["flat"] < 1e-5


def test_chirality_alone_coils_wide_ribbons():
    scene = rb.Scene(rb.Ribbon(10.0, 1.0, 0.01), rb.growth.edge(0.0) + rb.growth.chiral(0.5))
    diagram = rb.phase_diagram(scene, (SHEAR, (0.4, 0.8)), (EDGE, (-1e-4, 0.0)), 9)
    (line,) = lines(diagram, "twisted", "helical")
    d = line.points[line.points[:, 1] == 0.0, 0]
    c = 14.0 + math.sqrt(1036.0)
    assert d == pytest.approx(0.02 * math.sqrt(2.0 * c) * (1.0 + c / 20.0), rel=1e-9)
    assert d == pytest.approx(0.02 * 31.8066, rel=1e-6)


def test_a_middle_that_grows_bends_at_its_own_threshold():
    scene = rb.Scene(LEAF, rb.growth.edge(0.0))
    diagram = rb.phase_diagram(scene, ("ribbon.thickness", (0.02, 0.06)), (EDGE, (-0.04, 0.0)), 12)
    (line,) = diagram.boundaries
    h, xi = line.points.T
    # C = -4 xi of the flat ribbon where its bending stiffness 1/12 + C/360 - C^2/10080 is zero.
    assert np.max(np.abs(-4.0 * xi / h**2 - (14.0 + math.sqrt(1036.0)))) < 1e-6
    assert set(line.phases) == {"flat", "bent"}


def test_growth_through_the_thickness_bends_everywhere():
    scene = rb.Scene(LEAF, rb.growth.edge(0.0) + rb.growth.thickness(0.1))
    diagram = rb.phase_diagram(scene, (FACE, (0.05, 0.25)), (EDGE, (0.0, 0.1)), 21)
    assert set(diagram.phase.ravel()) == {"bent"}
    assert (diagram.K2 < 0.0).all()
    assert diagram.areas == pytest.approx({"bent": 1.0})
    (line,) = diagram.boundaries
    assert line.kind == "others"
    assert {sum(count) for count in line.stable} == {1, 2}


def test_values_are_those_of_natural_shapes():
    diagram = rb.phase_diagram(CHIRAL, (SHEAR, (0.01, 0.1)), (EDGE, (0.0, 0.1)), (4, 3))
    for j, i in np.ndindex(3, 4):
        growth = rb.growth.edge(diagram.y.values[j]) + rb.growth.chiral(diagram.x.values[i])
        state = rb.natural_shapes(LEAF, growth)[0]
        assert state.phase == diagram.phase[j, i]
        found = diagram.energy[j, i], diagram.K2[j, i], diagram.K3[j, i]
        assert found == pytest.approx((state.energy, *state.strain[2:]), rel=1e-12)


def test_a_saddle_rolls_up_along_or_across():
    # With transverse growth as large there are two stable shapes, in horns with their tips between points.
    growth = rb.growth.Profile(d33=[1.0], name="along") + rb.growth.Profile(d22=[1.0], name="across")
    scene = rb.Scene(rb.Ribbon(10.0, 1.0, 0.02), growth)
    x, y = ("growth.along.amplitude", (-1.0, 1.0)), ("growth.across.amplitude", (-1.0, 1.0))
    diagram = rb.phase_diagram(scene, x, y, 60)
    assert {line.kind for line in diagram.boundaries} == {"others"}
    # Turned about E1 the growth has the other sign: every point on a line has its image on one.
    points = np.concatenate([line.points for line in diagram.boundaries])
    tips = [np.min(np.abs(points[side * points.sum(axis=1) > 0.5].sum(axis=1))) for side in (1, -1)]
    assert tips[0] == pytest.approx(tips[1], abs=2e-3)


def test_an_orthotropic_ribbon_has_four_phases():
    # Softer in twist than isotropic ones: a helix between the bent and the twisted ribbon.
    material = rb.Orthotropic(Q33=4.0 / 3.0, Q22=4.0 / 3.0, Q23=2.0 / 3.0, G=0.31)
    growth = rb.growth.edge(0.0) + rb.growth.Profile(gamma33=[0.0, 0.0, 0.0, 0.0, 1.0], name="quartic")
    scene = rb.Scene(rb.Ribbon(10.0, 1.0, 0.04, material=material), growth)
    diagram = rb.phase_diagram(scene, ("growth.quartic.amplitude", (-0.5, 0.5)), (EDGE, (-0.06, 0.06)), 50)
    assert set(diagram.areas) == {"flat", "bent", "twisted", "helical"}
    assert {(frozenset(line.phases), line.kind) for line in diagram.boundaries} == {
        (frozenset(pair), "instability")
        for pair in (("flat", "bent"), ("flat", "twisted"), ("bent", "helical"), ("twisted", "helical"))
    }
    # All four meet in one point, to a small part of a cell.
    ends = np.array([line.points[k] for line in diagram.boundaries for k in (0, -1)])
    inside = ends[np.all(np.abs(ends) < [0.49, 0.059], axis=1)]
    assert len(inside) == 4
    assert np.ptp(inside, axis=0) == pytest.approx([0.0, 0.0], abs=1e-3)


def test_nearly_degenerate_instabilities_are_whole_lines():
    # Close to isotropy a slight change of the growth turns the whole state: rounding blurs its stability.
    material = rb.Orthotropic(Q33=4.0 / 3.0, Q22=4.0 / 3.0, Q23=2.0 / 3.0, G=0.32)
    growth = rb.growth.edge(0.0) + rb.growth.Profile(gamma33=[0.0, 0.0, 0.0, 0.0, 0.1], name="quartic")
    scene = rb.Scene(rb.Ribbon(10.0, 1.0, 0.05, material=material), growth + rb.growth.chiral(0.0))
    diagram = rb.phase_diagram(scene, (SHEAR, (0.001, 0.021)), (EDGE, (-0.05, 0.08)), 50)
    assert [(set(line.phases), line.kind) for line in diagram.boundaries] == [
        ({"twisted", "helical"}, "instability")
    ] * 2


@pytest.mark.parametrize(
    ("x", "y", "options", "message"),
    [
        (("growth.edg.amplitude", (0, 1)), (SHEAR, (0, 1)), {}, "sweep.x.parameter = 'growth.edg.amplitude'"),
        ((EDGE, (0, 0.1)), ("thicknes", (0, 1)), {}, "nearest is ribbon.thickness"),
        ((EDGE, (0, 0.1)), (EDGE, (0, 0.1)), {}, "sweep.y.parameter"),
        ((EDGE, (0.1, 0.0)), (SHEAR, (0, 0.1)), {}, "sweep.x.span"),
        ((EDGE, (0.1, 0.1)), (SHEAR, (0, 0.1)), {}, "sweep.x.span"),
        ((EDGE, (0.0, math.nan)), (SHEAR, (0, 0.1)), {}, "sweep.x.span[1] = nan"),
        ((EDGE, (0.0, 0.1, 0.2)), (SHEAR, (0, 0.1)), {}, "sweep.x.span"),
        (EDGE, (SHEAR, (0, 0.1)), {}, "sweep.x = "),
        ((EDGE, (0, 0.1)), (SHEAR, (0, 0.1)), {"n": 1}, "sweep.n = 1"),
        ((EDGE, (0, 0.1)), (SHEAR, (0, 0.1)), {"n": (5, 1)}, "sweep.n = 1"),
        ((EDGE, (0, 0.1)), (SHEAR, (0, 0.1)), {"n": 2.5}, "sweep.n = 2.5"),
        ((EDGE, (0, 0.1)), (SHEAR, (0, 0.1)), {"n": (2, 2, 2)}, "sweep.n"),
        ((EDGE, (0, 0.1)), (SHEAR, (0, 0.1)), {"n": 100_000}, "at most 4000000 points"),
        ((EDGE, (0, 0.1)), (SHEAR, (0, 0.1)), {"tol": 0.0}, "sweep.tol = 0.0"),
        ((EDGE, (0, 0.9)), (SHEAR, (0, 0.1)), {}, "growth.size"),
        (("ribbon.thickness", (-0.1, 0.1)), (SHEAR, (0, 0.1)), {}, "ribbon.thickness"),
    ],
)
def test_what_is_refused(x, y, options, message):
    with pytest.raises(rb.InputError) as caught:
        rb.phase_diagram(CHIRAL, x, y, **options)
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)


def test_growth_that_varies_is_refused():
    scene = rb.Scene(LEAF, rb.growth.edge(lambda S: 0.001 * S) + rb.growth.chiral(0.0))
    with pytest.raises(rb.InputError, match="the same all along"):
        rb.phase_diagram(scene, (SHEAR, (0.0, 0.1)), ("ribbon.thickness", (0.05, 0.1)))
    with pytest.raises(rb.InputError, match="scene = 3"):
        rb.phase_diagram(3, (SHEAR, (0.0, 0.1)), (EDGE, (0.0, 0.1)))


def test_large_growth_is_warned_of():
    with pytest.warns(rb.RibbonWarning, match="in the diagram"):
        rb.phase_diagram(CHIRAL, (SHEAR, (0.0, 0.1)), (EDGE, (0.0, 0.3)), 3)


def test_the_quadratic_law_may_have_no_stable_state():
    growth = rb.growth.edge(0.06) + rb.growth.chiral(0.01) + rb.growth.thickness(0.0)
    scene = rb.Scene(LEAF, growth, law="quadratic")
    diagram = rb.phase_diagram(scene, (SHEAR, (0.0, 0.05)), (EDGE, (0.0, 0.09)), 12)
    assert "none stable" in diagram.phase
    assert np.isnan(diagram.energy[diagram.phase == "none stable"]).all()


def interrupt_soon(seconds):
    threading.Timer(seconds, _thread.interrupt_main).start()


def test_an_interrupt_returns_what_is_done(tmp_path):
    # On a busy machine nothing may be done as soon as that.
    for seconds in (0.15, 0.5, 2.0):
        interrupt_soon(seconds)
        start = time.perf_counter()
        with pytest.warns(rb.RibbonWarning, match="interrupted"):
            diagram = rb.phase_diagram(CHIRAL, (SHEAR, (0.0, 0.1)), (EDGE, (0.0, 0.1)), 1500)
        assert time.perf_counter() - start < seconds + 5.0
        if diagram.done.any():
            break
    assert diagram.interrupted
    assert 0 < np.count_nonzero(diagram.done) < diagram.done.size
    assert set(diagram.phase[~diagram.done]) == {""}
    assert np.isnan(diagram.energy[~diagram.done]).all()
    assert 0.0 < sum(diagram.areas.values()) < 1.0
    diagram.plot(tmp_path / "part.png")


def test_an_error_while_progress_is_told_is_not_lost(monkeypatch):
    def fail(self, done):
        raise ValueError("no terminal")

    monkeypatch.setattr("ribbonrs.telling.Telling.__call__", fail)
    with pytest.raises(ValueError, match="no terminal"):
        rb.phase_diagram(CHIRAL, (SHEAR, (0.0, 0.1)), (EDGE, (0.0, 0.1)), 800)


def test_progress_is_told_on_standard_error(capsys):
    rb.phase_diagram(CHIRAL, (SHEAR, (0.0, 0.1)), (EDGE, (0.0, 0.1)), 300, progress=True)
    captured = capsys.readouterr()
    assert captured.out == ""
    assert "phase diagram" in captured.err


DIGEST = """
import hashlib, ribbonrs as rb
growth = rb.growth.edge(0.06) + rb.growth.chiral(0.04) + rb.growth.thickness(0.01)
scene = rb.Scene(rb.Ribbon(10.0, 1.0, 0.1), growth)
x, y = ("growth.chiral.amplitude", (-0.1, 0.1)), ("growth.edge.amplitude", (-0.1, 0.1))
diagram = rb.phase_diagram(scene, x, y, 60)
arrays = [diagram.phase, diagram.stable, diagram.energy, diagram.K2, diagram.K3]
arrays += [array for line in diagram.boundaries for array in (line.points, line.jump)]
print(hashlib.sha256(b"".join(array.tobytes() for array in arrays)).hexdigest())
"""


def test_the_same_bits_on_any_number_of_threads():
    digests = {
        subprocess.run(
            [sys.executable, "-c", DIGEST],
            env={**os.environ, "RAYON_NUM_THREADS": threads},
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        for threads in ("1", "2", "3")
    }
    assert len(digests) == 1


def test_a_pressed_strip_buckles_at_the_load_of_its_stiffness():
    scene = rb.Scene(LEAF, rb.growth.edge(0.02), end=rb.Sliding(force=-1e-4))
    diagram = rb.phase_diagram(scene, ("end.force", (-3.2e-4, -1e-4)), (EDGE, (0.0, 0.03)), (5, 4), tol=1e-4)
    (line,) = diagram.boundaries
    assert set(line.phases) == {"flat", "flat, unstable"}
    assert line.kind == "change"
    force, xi = line.points.T
    C = -4.0 * xi
    stiffness = H**2 / 12.0 + C / 360.0 - C**2 / (10080.0 * H**2)
    # The load also shortens the strip, by some 1e-4 of what bends it.
    assert np.max(np.abs(-force / (4.0 * math.pi**2 / 100.0 * stiffness) - 1.0)) < 2e-2
    assert set(diagram.stable_count.ravel().tolist()) == {0, 1}
    assert not diagram.reasons


def test_a_point_that_fails_says_why(monkeypatch):
    solve = rb.solve

    def failing(scene, guess=None, n=101):
        if scene.end.force < -2.5e-4:
            raise rb.ConvergenceError("it does not", np.zeros(4), (), "something else")
        return solve(scene, guess=guess, n=n)

    monkeypatch.setattr("ribbonrs.phase_held.solve", failing)
    scene = rb.Scene(LEAF, rb.growth.edge(0.0), end=rb.Sliding(force=-1e-4))
    diagram = rb.phase_diagram(scene, ("end.force", (-3e-4, -1e-4)), (EDGE, (0.0, 0.005)), 3, tol=1e-3)
    assert diagram.reasons == {(j, 0): "it does not; try something else" for j in range(3)}
    assert diagram.done.tolist() == [[False, True, True]] * 3
    assert diagram.areas == pytest.approx({"flat": 0.5})


def test_an_interrupt_of_a_held_diagram_returns_what_is_done():
    scene = rb.Scene(LEAF, rb.growth.edge(0.02), end=rb.Sliding(force=-1e-4))
    interrupt_soon(1.0)
    with pytest.warns(rb.RibbonWarning, match="interrupted"):
        diagram = rb.phase_diagram(scene, ("end.force", (-3e-4, -1e-4)), (EDGE, (0.0, 0.03)), 100)
    assert 0 < np.count_nonzero(diagram.done) < diagram.done.size


@pytest.mark.parametrize("nodes", [21, 27, 36])
def test_tips_inside_cells_are_followed(nodes):
    # Edge growth and a thickness gradient, without which two bent shapes are stable from 4.5467 eta^2 on: a
    # cusp, whose tip is cut off where it is narrower than a hundredth of a cell.
    scene = rb.Scene(LEAF, rb.growth.edge(0.06) + rb.growth.thickness(0.001))
    x, y = ("growth.thickness.amplitude", (-0.2, 0.21)), (EDGE, (0.0, 0.1))
    diagram = rb.phase_diagram(scene, x, y, nodes)
    tip = min(boundary.points[:, 1].min() for boundary in diagram.boundaries)
    exact = (math.sqrt(259.0) - 7.0) / 2.0 * 0.1**2
    assert 0.0 < tip - exact < 0.2 * 0.1 / (nodes - 1)


def test_a_narrow_band_between_grid_points_is_followed_from_row_to_row():
    eta = 0.0656989
    growth = rb.growth.Profile(d22=[-0.02051044], name="profile") + rb.growth.chiral(-0.03)
    scene = rb.Scene(rb.Ribbon(10.0, 1.0, eta, material=rb.Isotropic(nu=-0.28186)), growth)
    x = ("growth.chiral.amplitude", (-0.0455281197, 0.0182818721))
    y = ("ribbon.thickness", (0.0267758838, 0.1065926456))
    diagram = rb.phase_diagram(scene, x, y, 14)
    # the band reaches through the whole diagram
    finer = rb.phase_diagram(scene, x, y, 57)
    assert diagram.areas["twisted"] == pytest.approx(finer.areas["twisted"], rel=1e-3)


@pytest.mark.parametrize("low", [1e-3, 1e-6])
def test_a_pitchfork_of_thin_ribbons_is_no_jump(low: float) -> None:
    # flat bends at xi = 4.546738 eta^2: beyond it K2/eta grows as the root of the distance over eta^2
    scene = rb.Scene(rb.Ribbon(10.0, 1.0, 0.1), rb.growth.edge(0.06))
    y = ("growth.edge.amplitude", (0.0, 0.1))
    diagram = rb.phase_diagram(scene, ("ribbon.thickness", (low, 0.1)), y, 30)
    (line,) = diagram.boundaries
    assert line.kind == "instability"
    flat = 4.546738 * (0.1**3 - low**3) / 3.0 / (0.1 * (0.1 - low))
    # Chords of a parabola over 29 cells lie above it, by h^2/2 of its area at most.
    assert 0.0 <= diagram.areas["flat"] / flat - 1.0 <= 0.5 / 29**2


def test_shapes_that_change_names_alone_do_not_begin_or_end() -> None:
    growth = rb.growth.edge(-0.016) + rb.growth.chiral(0.01) + rb.growth.thickness(0.02)
    scene = rb.Scene(rb.Ribbon(10.0, 1.0, 0.04), growth)
    x, y = ("growth.chiral.amplitude", (0.0, 0.01)), ("growth.edge.amplitude", (0.0, 0.04))
    kinds = set()
    for line in rb.phase_diagram(scene, x, y, 20).boundaries:
        before, after = (sum(stable) for stable in line.stable)
        assert (line.kind == "others") <= (before != after)
        kinds.add(line.kind)
    assert kinds == {"others", "name"}


@pytest.mark.parametrize("span", [1e-200, 1e-2])
def test_areas_of_spans_whose_product_is_no_number(span: float) -> None:
    scene = rb.Scene(rb.Ribbon(10.0, 1.0, 0.1), rb.growth.edge(0.0) + rb.growth.chiral(0.0))
    x, y = (f"growth.{name}.amplitude" for name in ("chiral", "edge"))
    areas = rb.phase_diagram(scene, (x, (0.0, 1e-200)), (y, (0.0, span)), 5).areas
    assert areas == {"flat": pytest.approx(1.0, abs=1e-12)}
