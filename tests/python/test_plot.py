"""The figure of a state."""

import math
import os
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest
import ribbonrs as rb
from matplotlib.collections import PolyCollection
from matplotlib.image import imread
from refusal import refuses
from ribbonrs.course import Uniform
from ribbonrs.render import MAX_TURNS, render

EDGE = rb.growth.edge(0.06)
HELICAL = EDGE + rb.growth.chiral(0.04)


def solved(growth, length=10.0, thickness=0.1, **arguments):
    leaf = rb.Ribbon(length=length, width=1.0, thickness=thickness)
    return rb.solve(rb.Scene(leaf, growth), **arguments)


def with_strain(state, *strain):
    """The same ribbon in another shape, for pictures that no growth here makes."""
    return replace(state, course=Uniform(np.array(strain)))


SHAPES = {
    "flat": lambda: solved(rb.growth.edge(0.01)),
    "bent": lambda: solved(EDGE),
    "twisted": lambda: solved(rb.growth.chiral(0.04), length=40.0),
    "helical": lambda: solved(HELICAL, length=40.0),
    "unstable": lambda: solved(EDGE, guess=[0.0] * 4),
    "ring": lambda: with_strain(solved(EDGE), 0.02, 0.0, 0.2 * math.pi, 0.0),
    "thick": lambda: solved(rb.growth.thickness(0.02), thickness=0.9),
    "thin": lambda: solved(rb.growth.edge(6e-12), thickness=1e-6),
    "long": lambda: solved(HELICAL, length=1e4),
    "longer": lambda: solved(rb.growth.edge(0.0), length=1e6),
    "short": lambda: solved(HELICAL, length=0.01),
}


VARYING = {
    "rising": lambda: solved(rb.growth.edge(([0.0, 10.0], [0.0, 0.08]))),
    "stepped": lambda: solved(rb.growth.chiral(([0.0, 4.0, 4.0, 10.0], [0.0, 0.0, 0.1, 0.1]))),
    "coiled": lambda: solved(HELICAL + rb.growth.edge(lambda S: 0.01 * np.sin(S), name="wave"), length=40.0),
    "in its plane": lambda: solved(
        rb.growth.Profile(gamma33=[0.0, 0.1], amplitude=([0.0, 10.0], [0.0, 1.0]))
    ),
    "tapered": lambda: rb.solve(
        rb.Scene(rb.Ribbon(10.0, 1.0, 0.1, width_profile=([0.0, 5.0, 10.0], [0.3, 1.0, 0.2])), EDGE)
    ),
    "very long": lambda: solved(rb.growth.chiral(([0.0, 1e3, 1e4], [0.04, 0.08, 0.08])), length=1e4),
}
ALL = SHAPES | VARYING


@pytest.mark.parametrize("name", SHAPES)
def test_every_shape_fills_its_picture(name):
    state = SHAPES[name]()
    figure = state.plot()
    space, profile, section, bar = (figure.axes[i] for i in (0, 2, 3, 1))
    assert space.get_aspect() == 1.0
    assert section.get_aspect() == 1.0
    (cells,) = (c for c in space.collections if isinstance(c, PolyCollection))
    corners = np.concatenate([path.vertices for path in cells.get_paths()])
    assert np.isfinite(corners).all()
    limits = np.array([space.get_xlim(), space.get_ylim()])
    inside = (corners - limits[:, 0]) / (limits[:, 1] - limits[:, 0])
    assert inside.min() >= 0.0
    assert inside.max() <= 1.0
    assert np.ptp(inside, axis=0).max() >= 0.8
    # one unit is as long up as to the right
    box = space.get_window_extent()
    scale = [box.width, box.height] / np.diff(limits).ravel()
    assert scale[0] == pytest.approx(scale[1], rel=1e-6)
    # colours symmetric about no deflection, and the bar is the axis of the profile
    low, high = profile.get_ylim()
    assert low == -high
    assert bar.get_ylim() == (low, high)
    deflection = state.deflection(np.linspace(-0.5, 0.5, 201))[0] / state.scene.ribbon.thickness_ratio
    assert np.abs(deflection).max() <= high
    assert "u_1/h" in bar.get_ylabel()
    title = figure.get_suptitle()
    assert title.startswith(f"{state.phase}, {'stable' if state.stable else 'unstable'}")
    for value in state.strain:
        assert f"{value:.4g}" in title


@pytest.mark.parametrize("name", ALL)
def test_the_picture_is_a_parallel_projection_of_the_body(name):
    state = ALL[name]()
    picture = render(state)
    assert picture.axes.T @ picture.axes == pytest.approx(np.eye(2), abs=1e-14)
    # a body of these proportions has this silhouette at most, and the corners of the ends are in it
    S = [0.0, picture.drawn * state.scene.ribbon.length_ratio]
    corners = np.concatenate([state.surface(nx=2, S=S, face=face).reshape(-1, 3) for face in (-1, 1)])
    flat = corners @ picture.axes
    centre = sum(picture.extent) / 2
    size = picture.extent[1] - picture.extent[0]
    assert (np.ptp(flat, axis=0) <= size * (1 + 1e-9)).all()
    assert np.abs(picture.cells - centre).max() <= size.max()
    assert np.all((picture.shade > 0.0) & (picture.shade <= 1.0))
    assert np.all((picture.gloss >= 0.0) & (picture.gloss < 0.5))


@pytest.mark.parametrize("name", ALL)
def test_only_what_faces_the_viewer_is_drawn(name):
    cells = render(ALL[name]()).cells
    ahead, side = cells[:, 2] - cells[:, 0], cells[:, 3] - cells[:, 1]
    # corners run clockwise as seen from outside
    assert np.all(side[:, 0] * ahead[:, 1] - side[:, 1] * ahead[:, 0] > 0.0)


def test_a_right_handed_helix_looks_right_handed():
    """Its front strands rise to the right of an upright axis, so fall along a level one."""
    state = with_strain(solved(HELICAL, length=60.0), 0.0, 0.0, 0.5, 0.4)
    for sign in (1.0, -1.0):
        picture = render(with_strain(state, 0.0, 0.0, 0.5, 0.4 * sign))
        # painted last is nearest
        near = picture.cells[-len(picture.cells) // 8 :]
        along = near[:, 1] - near[:, 0]
        long = np.linalg.norm(along, axis=1) > 0.5 * np.linalg.norm(along, axis=1).max()
        slope = along[long, 1] / along[long, 0]
        assert np.sign(np.median(slope)) == -sign


def test_a_ribbon_of_many_turns_is_cut_and_says_so():
    state = SHAPES["long"]()
    assert state.helix.turns > 100
    assert render(state).drawn == pytest.approx(MAX_TURNS / state.helix.turns)
    texts = [text.get_text() for text in state.plot().axes[0].texts]
    assert f"the first 20 of {state.helix.turns:.0f} turns" in texts
    texts = [text.get_text() for text in SHAPES["bent"]().plot().axes[0].texts]
    assert not any("turns" in text for text in texts)


def colourful(pixels):
    """Share of reddish and bluish pixels."""
    red, _, blue = pixels[..., 0], pixels[..., 1], pixels[..., 2]
    return (red - blue > 0.2).mean(), (blue - red > 0.2).mean()


def test_the_colours_in_the_file(tmp_path):
    """The middle of a bent ribbon rises, its edges fall; a flat one has no colour but in the bar."""
    SHAPES["bent"]().plot(tmp_path / "bent.png")
    SHAPES["flat"]().plot(tmp_path / "flat.png")
    assert min(colourful(imread(tmp_path / "bent.png"))) >= 0.02
    assert max(colourful(imread(tmp_path / "flat.png"))) <= 0.005


@pytest.mark.parametrize("suffix", ["png", "pdf", "svg", "PNG"])
def test_formats(tmp_path, suffix):
    path = tmp_path / f"leaf.{suffix}"
    path.write_text("old")
    solved(HELICAL).plot(path)
    start = path.read_bytes()[:5]
    assert start == {"png": b"\x89PNG\r", "pdf": b"%PDF-", "svg": b"<?xml"}[suffix.lower()]
    assert path.stat().st_size <= 2_000_000  # the cells are a bitmap in every format
    assert [entry.name for entry in tmp_path.iterdir()] == [path.name]


@pytest.mark.parametrize("name", ["leaf", "leaf.vtp", "leaf.gif2", ""])
def test_unknown_formats_are_refused(tmp_path, name):
    refuses("path", lambda: solved(HELICAL).plot(tmp_path / name if name else ""))
    assert list(tmp_path.iterdir()) == []


def test_no_display_and_no_global_state():
    program = """
import sys, ribbonrs as rb
state = rb.solve(rb.Scene(rb.Ribbon(10, 1, 0.1), rb.growth.edge(0.06)))
figure = state.plot()
assert type(figure).__name__ == "Figure"
print("matplotlib.pyplot" in sys.modules)
"""
    environment = {**os.environ, "MPLBACKEND": "TkAgg"}
    result = subprocess.run(
        [sys.executable, "-c", program], env=environment, capture_output=True, text=True, check=True
    )
    assert result.stdout.split() == ["False"]


def test_a_section_wider_than_the_ribbon_fits_its_axes():
    growth = rb.growth.edge(0.06) + rb.growth.Profile(gamma22=[0.2])
    with pytest.warns(rb.RibbonWarning):
        state = rb.solve(rb.Scene(rb.Ribbon(10.0, 1.0, 0.1), growth))
    section = next(axes for axes in state.plot().axes if "cross-section" in axes.get_title())
    low, high = section.get_xlim()
    assert low < -0.59 < 0.59 < high


@pytest.mark.parametrize("name", VARYING)
def test_a_ribbon_that_varies_shows_its_curvatures(name):
    state = VARYING[name]()
    figure = state.plot()
    space, bar, profile, beside = figure.axes
    (cells,) = (c for c in space.collections if isinstance(c, PolyCollection))
    corners = np.concatenate([path.vertices for path in cells.get_paths()])
    limits = np.array([space.get_xlim(), space.get_ylim()])
    inside = (corners - limits[:, 0]) / (limits[:, 1] - limits[:, 0])
    assert inside.min() >= 0.0
    assert inside.max() <= 1.0
    # profiles at both ends and halfway, within the colours of the bar
    length = state.scene.ribbon.length_ratio
    x = np.linspace(-0.5, 0.5, 201)
    profiles = [line.get_ydata() for line in profile.lines if len(line.get_xdata()) == 201]
    for S, shown in zip((0.0, 0.5 * length, length), profiles, strict=True):
        strain = state.at(S).strains
        exact = state.section_law.deflection(strain, x, S=S) / state.scene.ribbon.thickness_ratio
        assert shown == pytest.approx(exact, abs=1e-14)
    low, high = bar.get_ylim()
    assert low == -high
    everywhere = np.abs(state.deflection(x)).max() / state.scene.ribbon.thickness_ratio
    if render(state).drawn == 1.0:
        assert everywhere <= high
    named = ", ".join(text.get_text().removeprefix("$S$ = ") for text in profile.texts).split(", ")
    assert sorted(map(float, named)) == pytest.approx([0.0, 0.5 * length, length], rel=1e-3)
    # K2, K3, K1 along S, each if there is any, and the events
    curves = {line.get_label(): line for line in beside.lines if line.get_label().startswith("$")}
    for i in (1, 2, 3):
        if np.abs(state.strains[:, i]).max() <= 1e-7:
            assert f"$K_{i}$" not in curves
        else:
            S, K = curves[f"$K_{i}$"].get_data()
            assert np.array_equal(K, state.at(S).strains[:, i])
    marks = [line.get_xdata()[0] for line in beside.lines if len(set(line.get_xdata())) == 1]
    assert marks == [event.S for event in state.report.events]
    title = figure.get_suptitle()
    assert title.startswith(state.phase)
    assert all(phase in title for phase in state.phases)


def test_a_coil_that_varies_is_cut_where_it_has_turned_enough():
    state = VARYING["very long"]()
    S = render(state).drawn * 1e4
    turned = np.trapezoid(state.at(np.linspace(0.0, S, 20001)).strains[:, 3], dx=S / 20000) / (2.0 * math.pi)
    assert turned == pytest.approx(MAX_TURNS, rel=1e-3)
    assert any("the first 20 of" in text.get_text() for text in state.plot().axes[0].texts)


def test_the_colours_are_the_deflection():
    """In the middle of cells, which are short of the edges by half their size."""
    for name in ("tapered", "rising", "stepped"):
        state = VARYING[name]()
        picture = render(state)
        deflection = state.deflection(np.linspace(-0.5, 0.5, 201))
        assert picture.u1.max() == pytest.approx(deflection.max(), rel=0.06)
        assert picture.u1.min() == pytest.approx(deflection.min(), rel=0.06)
