"""The figure of a bifurcation diagram: what is drawn, how, and under which symmetries."""

import numpy as np
import pytest
import ribbonrs as rb
from fake_core import CLAMPED, EDGE, LEAF, edge_trace, pressed_trace
from refusal import refuses
from ribbonrs import _core
from ribbonrs.quantity import QUANTITIES, label, parameter_label
from ribbonrs.smooth import smooth
from ribbonrs.symmetry import SIGNS, image, symmetries


@pytest.fixture
def natural(monkeypatch):
    monkeypatch.setattr(_core, "trace_natural", lambda *arguments: edge_trace(), raising=False)
    return rb.trace(EDGE, "growth.edge.amplitude", (0.0, 0.08))


@pytest.fixture
def held(monkeypatch):
    monkeypatch.setattr(_core, "trace", lambda *arguments: pressed_trace(), raising=False)
    return rb.trace(CLAMPED, "end.force", (-3e-4, 0.0))


def legend(figure):
    return [text.get_text() for text in figure.axes[0].get_legend().get_texts()]


def curves(axes, style):
    """Lines of this style that are no marks, without the axis."""
    return [line for line in axes.lines if line.get_linestyle() == style and len(line.get_xdata()) > 2]


def test_stability_marks_and_images(natural):
    figure = natural.plot("K2")
    assert legend(figure) == ["stable", "unstable", "mirror image", "branch point"]
    axes = figure.axes[0]
    solid = curves(axes, "-")
    assert [line.get_alpha() for line in solid] == [0.35, 1.0, 1.0]
    mirrored, flat, bent = (np.asarray(line.get_ydata()) for line in solid)
    np.testing.assert_array_equal(mirrored, -bent)
    assert not flat.any()
    assert max(solid[1].get_xdata()) == pytest.approx(0.04546738)
    assert axes.get_xlabel() == r"edge growth $\xi$" "\n(growth.edge.amplitude)"
    assert axes.get_ylabel() == "curvature $K_2$"
    # the flat and the bent ribbon beside it; the twisted one is unstable
    assert [beside.texts[0].get_text() for beside in figure.axes[1:]] == ["a", "b"]
    assert all(beside.collections for beside in figure.axes[1:])


def test_energies_have_no_image(natural):
    assert "mirror image" not in legend(natural.plot("energy"))


@pytest.mark.parametrize("quantity", QUANTITIES)
def test_every_quantity_is_drawn(natural, held, quantity, tmp_path):
    natural.plot(quantity, tmp_path / "a.png")
    held.plot(quantity, tmp_path / "b.svg")
    assert all((tmp_path / name).stat().st_size > 1000 for name in ("a.png", "b.svg"))


def test_what_failed_and_what_is_not_known(monkeypatch):
    trace = pressed_trace()
    trace.branches[0].index[:] = np.nan
    monkeypatch.setattr(_core, "trace", lambda *arguments: trace, raising=False)
    figure = rb.trace(CLAMPED, "end.force", (-3e-4, 0.0)).plot("position[2]")
    assert legend(figure) == ["stability not known", "value", "failed"]
    assert len(figure.axes) == 1


def test_a_diagram_from_a_file_is_drawn_alike(held, tmp_path):
    held.save(tmp_path / "a.npz")
    held.plot("eps", tmp_path / "a.png")
    rb.load_diagram(tmp_path / "a.npz").plot("eps", tmp_path / "b.png")
    assert (tmp_path / "a.png").read_bytes() == (tmp_path / "b.png").read_bytes()


def test_what_cannot_be_drawn(natural, tmp_path):
    refuses("quantity", lambda: natural.plot("k2"))
    refuses("path", lambda: natural.plot("K2", tmp_path / "a.xyz"))
    refuses("path", lambda: natural.plot("K2", tmp_path / "no" / "a.png"))


def test_every_name_has_a_label():
    assert all(label(quantity, True) for quantity in QUANTITIES)
    assert label("end.moment[1]", False) == "moment $M_2$ on the end"
    assert label("position[2]", False) == "place of the end along $E_3$"
    assert parameter_label("loads[0].force[2]") == "force of load 0 along $E_3$\n(loads[0].force[2])"
    assert parameter_label("law.intrinsic[2]") == "intrinsic $K_2^0$\n(law.intrinsic[2])"
    assert parameter_label("end.force[2]") == "force $F_3$ on the end\n(end.force[2])"
    assert parameter_label("growth.vein1.amplitude").startswith("amplitude of the growth vein1")
    assert parameter_label("growth.a$_{x}.amplitude").startswith("amplitude of the growth a\\$_{x}\n")
    assert parameter_label("growth.1.amplitude").startswith("amplitude of the growth 1\n")


def test_a_smooth_curve_is_a_circle_and_turns_at_folds():
    angle = np.linspace(0.0, 2.0 * np.pi, 9)
    curve = smooth(np.cos(angle), np.sin(angle))
    np.testing.assert_array_equal(curve.nodes, np.stack([np.cos(angle), np.sin(angle)], axis=1))
    radius = np.linalg.norm(curve.points, axis=1)
    assert np.abs(radius - 1.0).max() < 0.01
    assert np.abs(curve.points).max() <= 1.005


def test_a_smooth_curve_does_not_swing():
    x = np.array([0.0, 0.5, 0.9, 0.99, 1.0, 1.0, 1.0, 1.01, 1.05])
    y = np.array([0.0, 0.0, 0.0, 0.0, 1e-3, 0.1, 0.5, 0.9, 1.0])
    points = smooth(x, y).points
    assert points.min() > -0.01
    assert points[:, 1].max() < 1.01
    assert np.diff(points[:, 0]).min() >= -1e-15


def test_a_pitchfork_starts_upright():
    y = np.linspace(0.0, 1.0, 6)
    points = smooth(y**2, y).points
    np.testing.assert_allclose(points[:, 0], points[:, 1] ** 2, atol=0.01)


REFLECTED, ACROSS, HALF_TURN = SIGNS
SYMMETRIES = [
    (EDGE, {REFLECTED, ACROSS, HALF_TURN}),
    (rb.Scene(LEAF, rb.growth.edge(0.06) + rb.growth.chiral(0.04)), {HALF_TURN}),
    (rb.Scene(LEAF, rb.growth.thickness(0.06)), {ACROSS}),
    (rb.Scene(LEAF, rb.growth.Profile(gamma33=[0.0, 0.01])), {REFLECTED}),
    (rb.Scene(LEAF, rb.growth.edge(0.06), gravity=(0.0, 0.0, -1e-5)), {REFLECTED, ACROSS, HALF_TURN}),
    (rb.Scene(LEAF, rb.growth.edge(0.06), gravity=(1e-5, 0.0, 0.0)), {ACROSS}),
    (rb.Scene(LEAF, rb.growth.edge(0.06), end=rb.Clamped(twist_turns=0.5)), {HALF_TURN}),
    (rb.Scene(LEAF, rb.growth.edge(0.06), end=rb.Clamped((0.2, 0.0, 9.0))), {ACROSS}),
    (rb.Scene(LEAF, end=rb.Sliding(rotation=(0.0, 0.3, 0.0), force=1e-5)), {ACROSS}),
    (rb.Scene(LEAF, end=rb.Free(moment=(0.0, 1e-6, 0.0))), {ACROSS}),
    (rb.Scene(LEAF, start=rb.Hinged(), end=rb.Clamped()), {REFLECTED, ACROSS, HALF_TURN}),
    (rb.Scene(LEAF, end=rb.Pinned((0.0, 0.1, 9.0))), {REFLECTED}),
    (rb.Scene(LEAF, rb.growth.edge(0.01), start=rb.Closed(1.0)), {HALF_TURN}),
    (rb.Scene(LEAF, loads=[rb.LineLoad(([0.0, 10.0], [[0, 0, 0], [1e-6, 0, 0]]))]), {ACROSS}),
    (rb.Scene(LEAF, loads=[rb.PointLoad(5.0, moment=(1e-6, 0.0, 0.0))]), {REFLECTED}),
    (
        rb.Scene(LEAF, law=rb.LinearLaw(EA=1.0, EI1=1.0, EI2=1.0, GJ=1.0, intrinsic=(0, 0, 0, 0.1))),
        {HALF_TURN},
    ),
]


@pytest.mark.parametrize(("scene", "expected"), SYMMETRIES)
def test_symmetries(scene, expected):
    assert {tuple(signs.tolist()) for signs in symmetries(scene)} == expected


@pytest.mark.parametrize("signs", SIGNS)
def test_images_of_a_loaded_state_solve_the_image_of_the_scene(signs):
    force, moment = np.array([3e-5, 2e-5, -1e-5]), np.array([1e-5, -2e-5, 1e-5])
    axial = np.prod(signs) * np.array(signs)
    state = rb.solve(rb.Scene(LEAF, end=rb.Free(force, moment)))
    other = rb.solve(rb.Scene(LEAF, end=rb.Free(signs * force, axial * moment)))
    tip = [image(np.array(signs), f"position[{k}]") for k in range(3)]
    strains = [image(np.array(signs), name) for name in ("eps", "K1", "K2", "K3")]
    reaction = [image(np.array(signs), f"start.moment[{k}]") for k in range(3)]
    np.testing.assert_allclose(other.position[-1], tip * state.position[-1], atol=1e-9)
    np.testing.assert_allclose(other.strains, strains * state.strains, atol=1e-9)
    np.testing.assert_allclose(
        other.reactions.start.moment, reaction * state.reactions.start.moment, atol=1e-12
    )
