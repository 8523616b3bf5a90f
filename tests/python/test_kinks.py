"""Held ribbons whose sections are in different phases: the way there, and the kinks between."""

import warnings
from pathlib import Path

import numpy as np
import pytest
import ribbonrs as rb
from ribbonrs.boundary import state_of
from ribbonrs.problem import problem_of
from ribbonrs.scenefile import read
from stress.equations import misses
from stress.scenes import random_scene
from stress.trial import ALLOWED

EXAMPLES = Path(__file__).parents[2] / "examples"

pytestmark = pytest.mark.filterwarnings("ignore:growth.size")

STRIP = rb.Ribbon(20.0, 1.0, 0.1)
MIDDLE = rb.growth.edge(-0.15)
SLIDING = rb.Sliding((0.0, 0.0, 1.0))


@pytest.fixture(scope="module")
def zigzag():
    """A strip that wants to be bent, either way, between ends that are held parallel."""
    with pytest.warns(rb.RibbonWarning) as told:
        state = rb.solve(rb.Scene(STRIP, MIDDLE, end=SLIDING))
    assert any("the shape jumps along the ribbon, at S = " in str(one.message) for one in told)
    return state


def test_a_strip_that_cannot_bend_one_way_bends_both_ways(zigzag):
    bent = rb.natural_shapes(STRIP, MIDDLE)[0]
    K2 = abs(bent.strain[2])
    # Each section has nearly the curvature that its phase has without load.
    assert np.all(np.abs(np.abs(zigzag.strains[:, 2]) - K2) < 0.1 * K2)
    assert {event.kind for event in zigzag.report.events} == {"jump"}
    # The straight strip between these ends, which smooth states are near, has far more energy.
    flat = next(shape for shape in rb.natural_shapes(STRIP, MIDDLE) if shape.phase == "flat")
    assert zigzag.energy - bent.energy < 0.01 * (flat.energy - bent.energy)
    assert zigzag.stable
    assert zigzag.section_index == 0


def test_resultants_are_the_same_on_both_sides_of_a_kink(zigzag):
    law = rb.SectionLaw.of(STRIP, MIDDLE)
    for event in zigzag.report.events:
        before, after = (law.gradient(np.array(side)) for side in (event.before, event.after))
        assert event.before[2] * event.after[2] < 0.0
        # Strains are known to the tolerance over the length; softest stiffness eta^2/12.
        np.testing.assert_allclose(before, after, rtol=0.0, atol=1e-12)
        for side in (event.before, event.after):
            assert np.linalg.eigvalsh(law.hessian(np.array(side)))[0] > 0.0


def test_a_kinked_state_is_an_equilibrium(zigzag):
    misses_of = misses(zigzag)
    assert max(misses_of.values()) <= ALLOWED * 1e-10


@pytest.mark.parametrize("seed", [3, 18, 25, 34, 64, 79])
def test_scenes_that_no_smooth_way_leads_to(seed):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", rb.RibbonWarning)
        scene = random_scene(seed)[2]()
        state = rb.solve(scene)
    assert "jump" in {event.kind for event in state.report.events}
    assert state.stable
    assert state.index == 0
    assert max(misses(state).values()) <= ALLOWED * 1e-10


def test_a_guess_keeps_its_kinks(zigzag):
    scene = rb.Scene(STRIP, rb.growth.edge(-0.14), end=SLIDING)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", rb.RibbonWarning)
        state = rb.solve(scene, guess=zigzag)
    places = [[event.S for event in one.report.events] for one in (state, zigzag)]
    assert places[0] == places[1]
    assert max(misses(state).values()) <= ALLOWED * 1e-10


def test_a_guess_that_is_far_creeps_on():
    strip = rb.Ribbon(10.0, 1.0, 0.1)
    near, far = (rb.Scene(strip, rb.growth.edge(0.05), end=rb.Clamped((0.0, 0.0, z))) for z in (9.8, 9.7))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", rb.RibbonWarning)
        state = rb.solve(far, guess=rb.solve(near))
    assert state.stable
    assert max(misses(state).values()) <= ALLOWED * 1e-10


def test_a_smooth_state_has_no_kinks():
    state = rb.solve(rb.Scene(STRIP, rb.growth.edge(0.02), end=rb.Clamped((1.0, 0.5, 18.0))))
    assert state.report.events == ()


@pytest.mark.parametrize("stages", [1, 2, 3, 4])
def test_sections_of_an_element_with_a_kink_inside_are_of_one_phase_or_the_other(stages):
    scene = read(EXAMPLES / "kinked_strip.toml").scene
    with pytest.warns(rb.RibbonWarning, match="jumps"):
        solution = rb.solve(scene).course.solution
    degree, nodes, states, strains, *rest = solution.parts()
    strains = np.reshape(strains, (-1, degree, 4))
    # So many stages as if the kink were between them: there their polynomial is of no phase.
    after = int(np.argmax(np.abs(np.diff(strains[:, 0, 2])))) + 1
    strains[after, :stages] = strains[after - 1, -1]
    parts = (degree, nodes, states, [tuple(stage) for stage in strains.reshape(-1, 4).tolist()], *rest)
    state = state_of(scene, problem_of(scene).restored(parts), 1e-10, 101)
    S = np.linspace(nodes[after], nodes[after + 1], 1002)[1:-1]
    sections = state.at(S)
    resultants = np.column_stack([sections.force[:, 2], sections.moment])
    # Of 1e-3, solved for to rounding; a section of no phase misses 1e-5.
    assert np.abs(scene.section_law.gradient(sections.strains, S) - resultants).max() < 1e-15
