"""States of ribbons that are loaded or held: what follows from them, files, figures, the command line."""

import json
import math
import pickle
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import ribbonrs as rb
from matplotlib.text import Annotation
from refusal import refuses
from ribbonrs.cli import main
from ribbonrs.pieces import Pieces
from ribbonrs.render import render

LEAF = rb.Ribbon(20.0, 2.0, 0.2, material=rb.Isotropic(Y=2e6))
LENGTH = 10.0
FORCE = (1e-5, 2e-6, 0.0)
ROD = rb.LinearLaw(EA=1.0, EI1=1 / 12, EI2=1e-2 / 12, GJ=1e-2 / 9)
SMOOTH = 1e-8
"""What the solver's default tolerance leaves of quantities of order one."""


def ramp(S):
    return np.outer(S, [1e-7, 0.0, 0.0])


SCENES = {
    "cantilever": rb.Scene(LEAF, rb.growth.edge(0.02), end=rb.Free(force=FORCE), gravity=(0.0, 0.0, -1e-6)),
    "loaded": rb.Scene(
        LEAF,
        end=rb.Clamped(),
        loads=[rb.PointLoad(4.0, (1e-5, 0.0, 0.0)), rb.LineLoad(ramp, (0.0, 1e-6, 0.0))],
    ),
    "linear": rb.Scene(LEAF, rb.growth.edge(0.02), law="linear", end=rb.Free(force=FORCE)),
    "rod": rb.Scene(LEAF, law=ROD, start=rb.Hinged(), end=rb.Pinned(), gravity=(1e-6, 0.0, 0.0)),
    "twisted": rb.Scene(LEAF, law=ROD, end=rb.Sliding(twist_turns=0.25, force=1e-6)),
    "ring": rb.Scene(LEAF, law=rb.LinearLaw(EA=1.0, EI1=0.1, EI2=1e-3, GJ=1e-3), start=rb.Closed()),
}


@pytest.fixture(scope="module")
def states():
    return {name: rb.solve(scene, n=21) for name, scene in SCENES.items()}


@pytest.mark.parametrize("name", SCENES)
def test_shapes_and_what_is_not_known(states, name):
    state = states[name]
    assert state.S.tolist() == np.linspace(0.0, LENGTH, 21).tolist()
    for field, tail in {
        "strains": (4,),
        "position": (3,),
        "quaternion": (4,),
        "force": (3,),
        "moment": (3,),
    }.items():
        assert getattr(state, field).shape == (21, *tail)
        assert getattr(state.at(np.full((2, 3), 4.0)), field).shape == (2, 3, *tail)
        with pytest.raises(ValueError, match="read-only"):
            getattr(state, field)[...] = 1.0
    assert (state.section_index, state.resolved) == (0, True)
    assert state.stable is (None if state.index is None else state.index == 0.0)
    assert state.phases == (state.phase,)
    report = state.report
    assert (report.method, report.equilibria, report.tolerance) == ("Gauss collocation", 1, 1e-10)
    assert report.status in ("converged", "rounding_limited")
    assert report.elements >= 1
    assert report.gradient_norm == report.residual


def test_names_of_shapes(states):
    phases = {name: state.phase for name, state in states.items()}
    assert phases == {
        "cantilever": "curved",
        "loaded": "curved",
        "linear": "curved",
        "rod": "curved",
        "twisted": "twisted",
        "ring": "bent",
    }
    assert states["twisted"].helix.turns == pytest.approx(0.25, abs=SMOOTH)
    assert states["twisted"].strain[3] == pytest.approx(0.5 * math.pi / LENGTH, abs=SMOOTH)
    assert states["cantilever"].helix is None
    refuses("state.strain", lambda: states["cantilever"].strain)


def test_forces_and_reactions(states):
    state = states["cantilever"]
    inside = np.einsum("ni,nij->nj", state.force, state.directors)
    assert inside[-1] == pytest.approx(FORCE, abs=1e-12)
    assert inside[0] == pytest.approx(np.add(FORCE, (0.0, 0.0, -1e-5)), abs=1e-12)
    assert state.reactions.end.force == pytest.approx(FORCE, abs=1e-12)
    assert state.reactions.start.force == pytest.approx(-inside[0], abs=1e-12)
    free = rb.solve(rb.Scene(LEAF))
    assert not free.reactions.start.force.any()
    assert free.load_potential == 0.0


def test_units(states):
    state, unit = states["cantilever"], 2e6 * 0.2 * 2.0
    physical = state.physical
    assert physical.force == pytest.approx(unit * state.force)
    assert physical.moment == pytest.approx(2.0 * unit * state.moment)
    assert physical.reactions.start.force == pytest.approx(unit * state.reactions.start.force)
    assert physical.reactions.start.moment == pytest.approx(2.0 * unit * state.reactions.start.moment)
    assert physical.load_potential == pytest.approx(unit * state.load_potential)


def test_energies_are_means(states):
    state = states["linear"]
    places = np.linspace(0.0, LENGTH, 2001)
    strains = state.at(places).strains
    ungrown = rb.SectionLaw(0.1, rb.growth.edge(0.0)).hessian(np.zeros(4))
    elastic = strains - [0.02 / 3.0, 0.0, 0.0, 0.0]
    density = 0.5 * np.einsum("ni,ij,nj->n", elastic, ungrown, elastic)
    assert state.energy == pytest.approx(np.trapezoid(density, places) / LENGTH, rel=1e-6)
    assert state.load_potential == pytest.approx(-state.position[-1] @ FORCE / LENGTH, rel=1e-6)


def test_point_loads_are_events(states):
    (event,) = states["loaded"].report.events
    assert (event.S, event.kind) == (4.0, "point load")
    # a force leaves the bending as it is
    assert event.before == pytest.approx(event.after, abs=1e-4)
    jump = np.diff(
        np.einsum(
            "ni,nij->nj",
            *(
                getattr(states["loaded"].at([np.nextafter(4.0, 0.0), 4.0]), name)
                for name in ("force", "directors")
            ),
        ),
        axis=0,
    )
    assert jump[0] == pytest.approx((-1e-5, 0.0, 0.0), abs=1e-12)


def test_sections_of_a_linear_law_stay_plane(states):
    state = states["rod"]
    x = np.linspace(-0.5, 0.5, 5)
    refuses("law", lambda: state.section_law)
    assert not state.deflection(x).any()
    assert state.displacements(x).shape == (21, 5, 3)
    plane = state.position[:, None, :] + x[:, None] * state.directors[:, None, 1]
    assert state.surface(nx=5) == pytest.approx(plane, abs=1e-15)
    assert states["linear"].deflection(x).any()


@pytest.mark.parametrize("name", SCENES)
def test_guesses(states, name):
    state = states[name]
    for guess in (state, state.strains):
        again = rb.solve(state.scene, guess=guess, n=21)
        assert again.position[10] == pytest.approx(state.position[10], abs=1e-6)


def test_the_same_strains_everywhere_are_a_guess(states):
    state = states["linear"]
    again = rb.solve(state.scene, guess=state.strains[0])
    assert again.position[-1] == pytest.approx(state.position[-1], abs=1e-6)


def test_a_guess_of_another_length(states):
    longer = rb.Scene(rb.Ribbon(22.0, 2.0, 0.2), law="linear", end=rb.Free(force=FORCE))
    state = rb.solve(longer, guess=states["linear"])
    assert state.position[-1] == pytest.approx(rb.solve(longer).position[-1], abs=1e-6)


@pytest.mark.parametrize("reach", np.linspace(0.4, 1.5, 12))
def test_guesses_of_many_lengths(reach):
    # Places that scaling brings together are the same place.
    rod = rb.LinearLaw(EI1=100.0, EI2=1.0, GJ=1.0, inextensible=True)

    def column(length):
        ribbon = rb.Ribbon(length, 1.0, 0.1)
        return rb.Scene(ribbon, law=rod, end=rb.Free(force=(0.1, 0.0, -1.0)))

    known = rb.solve(column(reach))
    for length in np.linspace(0.4, 1.5, 12):
        state = rb.solve(column(length), guess=known)
        assert state.energy == pytest.approx(rb.solve(column(length)).energy, abs=1e-10)


def test_unloaded_ribbons_by_collocation():
    scene = rb.Scene(LEAF, rb.growth.edge(0.03) + rb.growth.chiral(0.02))
    pointwise, collocated = rb.solve(scene), rb.solve(scene, method="collocation")
    assert collocated.phase == pointwise.phase
    assert collocated.strain == pytest.approx(pointwise.strain, abs=SMOOTH)
    assert collocated.position[-1] == pytest.approx(pointwise.position[-1], abs=1e-6)


def test_states_are_pickled(states):
    state = states["cantilever"]
    again = pickle.loads(pickle.dumps(state))
    assert np.array_equal(again.position, state.position)
    assert again.scene == state.scene
    assert np.array_equal(again.reactions.start.moment, state.reactions.start.moment)


def test_a_load_that_is_too_large_is_an_error_that_says_what_to_try():
    with pytest.raises(rb.ConvergenceError, match="; try a smaller load, or guess=") as caught:
        rb.solve(rb.Scene(LEAF, end=rb.Free(force=(1e10, 0.0, 0.0))), n=5)
    error = caught.value
    assert error.iterate.shape == (5, 4)
    assert isinstance(error.residuals, tuple)
    assert 0.0 <= error.fraction < 1.0
    assert (error.state is None) == (error.fraction == 0.0)
    again = pickle.loads(pickle.dumps(error))
    assert (str(again), again.fraction) == (str(error), error.fraction)


# --- files


def test_npz(states, tmp_path):
    state = states["loaded"]
    state.save(tmp_path / "leaf.npz")
    with np.load(tmp_path / "leaf.npz", allow_pickle=False) as data:
        assert "index" not in data
        assert "stable" not in data
        for name in ("force", "moment", "load_potential", "energy"):
            assert np.array_equal(data[name], getattr(state, name))
        reactions = state.reactions
        assert np.array_equal(data["reaction_force"], [reactions.start.force, reactions.end.force])
        assert np.array_equal(data["reaction_moment"], [reactions.start.moment, reactions.end.moment])
        named = set(re.findall(r"\w+", data["units"].item()))
        for name, values in data.items():
            if values.dtype.kind == "f" and values.ndim:
                assert name in named or name.startswith("physical_")
        scene, report = json.loads(data["scene"].item()), json.loads(data["report"].item())
    assert scene["end"] == {"kind": "Clamped", "position": None, "rotation": None, "twist_turns": 0.0}
    point, line = scene["loads"]
    assert point == {"kind": "PointLoad", "S": 4.0, "force": [1e-5, 0.0, 0.0], "moment": [0.0] * 3}
    force = line["force"][0]
    pieces = Pieces(tuple(force["breaks"]), tuple(map(tuple, force["coefficients"])))
    assert pieces.evaluate(5.0) == pytest.approx(5e-7)
    assert line["moment"] == [0.0, 1e-6, 0.0]
    assert report["elements"] == state.report.elements
    assert report["events"][0]["kind"] == "point load"


@pytest.mark.parametrize("name", SCENES)
def test_every_scene_is_recorded(states, name, tmp_path):
    states[name].save(tmp_path / "leaf.npz")
    with np.load(tmp_path / "leaf.npz", allow_pickle=False) as data:
        scene = json.loads(data["scene"].item(), parse_constant=lambda word: pytest.fail(word))
        json.loads(data["report"].item(), parse_constant=lambda word: pytest.fail(word))
    start, law = SCENES[name].start, SCENES[name].law
    assert scene["start"]["kind"] == type(start).__name__
    if isinstance(law, rb.LinearLaw):
        assert scene["law"]["compliance"] == list(law.compliance)
    else:
        assert scene["law"] == law
    assert scene["gravity"] == list(SCENES[name].gravity)


@pytest.mark.parametrize("link", [0.0, 0.5])
def test_the_mesh_of_a_closed_ribbon_closes(states, link, tmp_path):
    scene = rb.Scene(LEAF, law=SCENES["ring"].law, start=rb.Closed(link))
    # the shape does not matter here: a ring and, cut open, a twisted ribbon
    ring = states["ring"] if link == 0.0 else replace(states["ring"], scene=scene)
    ring.save(tmp_path / "ring.obj")
    lines = (tmp_path / "ring.obj").read_text().splitlines()
    faces = [tuple(int(word) for word in line.split()[1:]) for line in lines if line.startswith("f ")]
    edges = [frozenset((f[i], f[(i + 1) % 4])) for f in faces for i in range(4)]
    # every edge is shared by two faces but for the rim, one closed line or two
    rim = [edge for edge in edges if edges.count(edge) == 1]
    assert len(rim) == 2 * 20
    seen, following = set(), {}
    for a, b in map(tuple, rim):
        following.setdefault(a, []).append(b)
        following.setdefault(b, []).append(a)
    assert all(len(both) == 2 for both in following.values())
    pieces = 0
    for corner in following:
        if corner not in seen:
            pieces += 1
            stack = [corner]
            while stack:
                at = stack.pop()
                if at not in seen:
                    seen.add(at)
                    stack.extend(following[at])
    assert pieces == (2 if link == 0.0 else 1)


# --- figures


def drawn(state):
    """Marks of ends, and arrows, in the picture of a state."""
    axes = state.plot().axes[0]
    marks = [line.get_marker() for line in axes.lines if line.get_marker() not in ("", "None", None)]
    arrows = [a for a in axes.texts if isinstance(a, Annotation) and a.arrowprops["color"] == "tab:green"]
    return marks, len(arrows), [text.get_text() for text in axes.texts]


def test_held_ends_and_forces_are_drawn(states):
    marks, arrows, texts = drawn(states["cantilever"])
    assert (marks, arrows) == (["s"], 2)
    assert "gravity" in texts
    marks, arrows, texts = drawn(states["loaded"])
    # one at the point; along the line eight, since the ramp starts from zero
    assert (marks, arrows) == (["s", "s"], 1 + 8)
    assert "gravity" not in texts
    assert drawn(states["rod"])[:2] == (["o", "^"], 1)
    assert drawn(states["twisted"])[:2] == (["s", "D"], 1)
    assert drawn(states["ring"])[:2] == ([], 0)
    assert drawn(rb.solve(rb.Scene(LEAF)))[:2] == ([], 0)


@pytest.mark.parametrize("name", SCENES)
def test_what_is_up_and_what_is_level_in_the_picture(states, name):
    state = states[name]
    axes = render(state).axes
    assert axes.T @ axes == pytest.approx(np.eye(2), abs=1e-14)
    right, up = state.scene.gravity @ axes
    if any(state.scene.gravity):
        assert right == pytest.approx(0.0, abs=1e-20)
        assert up < 0.0
    elif name != "ring":
        along, risen = (state.position[-1] - state.position[0]) @ axes
        assert along > 0.0
        if name != "linear":  # which has a free end
            assert risen == pytest.approx(0.0, abs=1e-9 * along)


def test_a_loaded_ring_is_held_where_it_was_glued(states):
    scene = SCENES["ring"]
    heavy = rb.solve(rb.Scene(LEAF, law=scene.law, start=scene.start, gravity=(1e-6, 0.0, 0.0)))
    assert drawn(heavy)[:2] == (["s"], 1)


def test_the_figure_says_the_shape_and_its_stability(states):
    assert states["cantilever"].plot().get_suptitle().startswith("curved, stable:  ")


# --- the command line

SCENE = """
gravity = [0, 0, -1e-6]
[ribbon]
length = 20.0
width = 2.0
thickness = 0.2
[growth]
edge = 0.02
[end]
kind = "free"
force = [1e-5, 2e-6, 0]
[[loads]]
kind = "point"
S = 4.0
force = [1e-6, 0, 0]
[output]
data = "leaf.npz"
"""


def test_run_shows_loads_reactions_and_errors(scene, capsys):
    assert main(["run", scene(SCENE)]) == 0
    screen, errors = capsys.readouterr()
    assert errors == ""
    rows = {
        re.split(r"  +", line.strip())[0]: re.split(r"  +", line.strip())[1:] for line in screen.splitlines()
    }
    assert rows["start"] == ["clamped"]
    assert rows["end"] == ["free, force (1e-05, 2e-06, 0)"]
    assert rows["gravity"] == ["(0, 0, -1e-06) per unit S"]
    assert rows["load"] == ["force (1e-06, 0, 0) at S = 4"]
    assert [float(word) for word in rows["force of the end"][:3]] == pytest.approx(
        [1e-5, 2e-6, 0.0], abs=1e-10
    )
    assert float(rows["force of the start"][0]) == pytest.approx(-1.1e-5, rel=1e-3)
    assert rows["4"][0] == "point load"
    assert rows["stability"] == ["stable (section_index 0)"]
    assert "equilibri" not in screen
    assert re.search(r"on \d+ elements of degree \d, \d+ Newton steps; error about", screen)
    assert Path("leaf.npz").exists()


def test_settings_reach_the_solver(scene, capsys):
    assert main(["run", scene(SCENE + "[solve]\ndegree = 2\ntol = 1e-6")]) == 0
    assert "of degree 2," in capsys.readouterr().out


def test_no_solution_is_one_line_and_status_1(scene, capsys):
    assert main(["run", scene(SCENE.replace("[1e-5, 2e-6, 0]", "[1e10, 0, 0]"))]) == 1
    screen, errors = capsys.readouterr()
    assert screen == ""
    assert errors.startswith("ribbonrs: ")
    assert errors.count("\n") == 1
    assert not Path("leaf.npz").exists()


def test_linear_laws_are_told(scene, capsys):
    text = SCENE.replace(
        "[growth]\nedge = 0.02", "[law]\nEI1 = inf\nEI2 = 1e-3\nGJ = 1e-3\ninextensible = true"
    )
    assert main(["run", scene(text)]) == 0
    screen = " ".join(capsys.readouterr().out.split())
    assert "law EA = inf, EI1 = inf, EI2 = 0.001, GJ = 0.001" in screen
    assert "growth none" in screen


def test_a_figure_needs_a_directory(states, tmp_path):
    with pytest.raises(rb.InputError, match="expected a file in a directory that exists"):
        states["cantilever"].plot(tmp_path / "nowhere" / "figure.png")
