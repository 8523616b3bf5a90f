"""Unloaded ribbons with a free end: the boundary-value problem against the natural shape of each section."""

import numpy as np
import pytest
import ribbonrs as rb
from held import largest

LENGTH = 10.0
LEAF = rb.Ribbon(LENGTH, 1.0, 0.1)
ETA2 = 0.1**2
CLOSE = 1e-11
"""Ten times the tolerance asked of collocation, 1e-12: of positions over L, angles, eps, and K L."""
WEIGHTS = np.array([1.0, LENGTH, LENGTH, LENGTH])
TAPERED = rb.Ribbon(LENGTH, 1.0, 0.1, width_profile=lambda S: 1.0 - 0.04 * S)

UNIFORM = {
    "none": None,
    "flat": rb.growth.edge(3.0 * ETA2),
    "bent": rb.growth.edge(6.0 * ETA2),
    "twisted": rb.growth.chiral(0.04),
    "helical": rb.growth.edge(6.0 * ETA2) + rb.growth.chiral(0.04),
    "cylinder": rb.growth.thickness(0.3),
    "saddle": rb.growth.thickness(0.2, transverse=-0.1),
    "lopsided": rb.growth.Profile(gamma33=(0.0, 0.01, 0.03), d33=(0.1, 0.05), g31=(0.0, 0.0, 0.005)),
}
ALONG = {
    "edge": (LEAF, rb.growth.edge(lambda S: ETA2 * (6.0 + np.sin(0.7 * S)))),
    "chirality": (LEAF, rb.growth.edge(3.0 * ETA2) + rb.growth.chiral(lambda S: 0.03 * np.cos(0.5 * S))),
    "thickness": (LEAF, rb.growth.thickness(lambda S: 0.1 + 0.02 * S)),
    "jump": (LEAF, rb.growth.thickness(([0.0, 4.0, 4.0, 10.0], [0.1, 0.2, 0.3, 0.05]))),
    "width": (TAPERED, rb.growth.edge(3.0 * ETA2) + rb.growth.thickness(0.1)),
}
S = np.linspace(0.0, LENGTH, 37)


def compare(natural, held):
    one, other = natural.at(S), held.at(S)
    assert largest((one.strains - other.strains) * WEIGHTS) < CLOSE
    assert largest(one.position - other.position) < CLOSE * LENGTH
    assert largest(one.directors - other.directors) < CLOSE
    # the rounding of stresses that balance within a section: growth of 0.1
    assert largest(other.force) < 1e-15
    assert largest(other.moment) < 1e-15
    assert held.energy == pytest.approx(natural.energy, rel=CLOSE, abs=CLOSE * ETA2**2)
    assert held.report.method == "Gauss collocation"
    assert held.report.method != natural.report.method


@pytest.mark.parametrize("name", UNIFORM)
def test_uniform_growth(name):
    scene = rb.Scene(LEAF, UNIFORM[name])
    natural, held = rb.solve(scene), rb.solve(scene, method="collocation", tol=1e-12)
    compare(natural, held)
    assert held.phase == natural.phase


@pytest.mark.parametrize("name", ALONG)
def test_growth_that_varies_along_the_ribbon(name):
    ribbon, growth = ALONG[name]
    scene = rb.Scene(ribbon, growth)
    # the branch is followed to 1e-12 of the strains, which this doubles at most
    compare(rb.solve(scene), rb.solve(scene, method="collocation", tol=1e-12))


@pytest.mark.parametrize("name", ["bent", "helical", "cylinder", "saddle"])
@pytest.mark.parametrize("seed", range(3))
def test_a_shape_nearby_leads_to_the_natural_one(name, seed):
    scene = rb.Scene(LEAF, UNIFORM[name])
    natural = rb.solve(scene)
    rng = np.random.default_rng(seed)
    waves = np.sin(np.outer(np.linspace(0.0, LENGTH, 41), rng.uniform(0.2, 1.0, 4)) + rng.uniform(0, 6, 4))
    # the helix is soft: a tenth off, some of its sections are unstable, and Newton's method leaves them
    size = 0.02 if name == "helical" else 0.1
    guess = natural.strain * (1.0 + size * waves) + 0.1 * size * waves * [0.1, 0.1, 1.0, 1.0]
    compare(natural, rb.solve(scene, method="collocation", guess=guess, tol=1e-12))


def test_each_of_two_mirror_images_from_itself():
    scene = rb.Scene(LEAF, UNIFORM["bent"])
    for sign in (1.0, -1.0):
        natural = rb.solve(scene, guess=(0.0, 0.0, sign * 0.5, 0.0))
        assert np.sign(natural.strain[2]) == sign
        compare(natural, rb.solve(scene, method="collocation", guess=natural, tol=1e-12))


@pytest.mark.parametrize("name", ["edge", "chirality", "width"])
def test_a_branch_leads_to_itself(name):
    ribbon, growth = ALONG[name]
    scene = rb.Scene(ribbon, growth)
    natural = rb.solve(scene)
    compare(natural, rb.solve(scene, method="collocation", guess=natural, tol=1e-12))


@pytest.mark.parametrize("name", UNIFORM)
def test_a_ribbon_held_as_it_lies_bears_no_load(name):
    natural = rb.solve(rb.Scene(LEAF, UNIFORM[name]))
    end = rb.Clamped(natural.position[-1], natural.quaternion[-1])
    # bent shapes are nearly degenerate: the tension-free state is one of several, so it is the guess
    held = rb.solve(rb.Scene(LEAF, UNIFORM[name], end=end), guess=natural, tol=1e-12)
    compare(natural, held)
    for wrench in (held.reactions.start, held.reactions.end):
        assert largest([wrench.force, wrench.moment]) < 1e-15
