"""A little of `make stress`, and that its judges see what is wrong."""

import os
import time
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
import ribbonrs as rb
from ribbonrs.frame import directors
from scipy.integrate import solve_ivp
from stress import boundary, branches, frames, process, section
from stress.equations import Frame, misses
from stress.sweep import sweep, trials
from stress.trial import DEFECTS, Trial, trial

LEAF = rb.Ribbon(10.0, 1.0, 0.1)
HELD = rb.Scene(
    LEAF,
    rb.growth.edge(0.02) + rb.growth.chiral(([0.0, 4.0, 10.0], [0.0, 0.2, 0.1])),
    end=rb.Clamped((1.0, 0.5, 8.5), rotation=(0.3, 0.0, 1.0)),
    gravity=(1e-6, 0.0, -1e-6),
)


@pytest.fixture(scope="module")
def state():
    return rb.solve(HELD)


@pytest.mark.parametrize("seed", range(16))
def test_random_scenes(seed):
    found = trial(seed)
    assert found.result not in DEFECTS, found


def test_the_frame_is_that_of_another_integrator(state):
    def rates(S, y):
        eps, K1, K2, K3 = state.at(S).strains
        a, b, c, d = y[3:]
        turn = [-b * K1 - c * K2 - d * K3, a * K1 + c * K3 - d * K2, a * K2 + d * K1 - b * K3]
        turn.append(a * K3 + b * K2 - c * K1)
        return np.array([*(1.0 + eps) * directors(y[3:])[2], *(0.5 * np.array(turn))])

    y, breaks = np.concatenate([state.position[0], state.quaternion[0]]), state.course.breaks
    for a, b in pairwise(breaks):
        y = solve_ivp(rates, (a, b), y, "DOP853", rtol=1e-11, atol=1e-12).y[:, -1]
    r, R = Frame(state).end
    np.testing.assert_allclose(r, y[:3], rtol=0, atol=1e-9)
    np.testing.assert_allclose(R.T, directors(y[3:]), rtol=0, atol=1e-10)


def test_a_state_is_judged_by_its_tolerance(state):
    assert max(misses(state).values()) < 1e-10


class Bent:
    """A course of which some numbers are a little off."""

    def __init__(self, course, name, off):
        self.course, self.name, self.off = course, name, off
        self.breaks = course.breaks

    def points(self, *arguments):
        found = self.course.points(*arguments)
        return found._replace(**{self.name: getattr(found, self.name) + self.off})


@pytest.mark.parametrize(
    ("name", "off", "seen"),
    [
        ("strains", [0.0, 0.0, 1e-8, 0.0], {"strains", "frame", "end"}),
        ("position", [1e-7, 0.0, 0.0], {"end"}),
        ("force", [1e-9, 0.0, 0.0], {"balance"}),
        ("moment", [0.0, 1e-9, 0.0], {"strains", "balance"}),
    ],
)
def test_what_is_off_is_seen(state, name, off, seen):
    missed = misses(replace(state, course=Bent(state.course, name, off)))
    assert {key for key, miss in missed.items() if miss > 1e-9} >= seen


@pytest.mark.parametrize(
    ("scene", "name"),
    [
        (rb.Scene(LEAF, HELD.growth, end=HELD.end, gravity=(1.1e-6, 0.0, -1e-6)), "balance"),
        (rb.Scene(LEAF, rb.growth.edge(0.021), end=HELD.end, gravity=HELD.gravity), "strains"),
        (rb.Scene(LEAF, HELD.growth, end=rb.Pinned((1.0, 0.5, 8.5)), gravity=HELD.gravity), "end"),
    ],
)
def test_a_state_of_another_scene_is_seen(state, scene, name):
    assert misses(replace(state, scene=scene))[name] > 1e-6


def task(seed):
    """Dies, hangs, or answers."""
    if seed == 1:
        os._exit(3)
    if seed == 2:
        time.sleep(600.0)
    return Trial(seed, "free", False, "converged")


def test_processes_that_die_or_hang_are_told():
    found = {one.seed: one.result for one in trials(range(4), task=task, patience=8.0)}
    assert found == {0: "converged", 1: "crash", 2: "hang", 3: "converged"}


def test_a_table_is_completed(tmp_path):
    path = tmp_path / "scenes.csv"
    sweep(2, path)
    before = path.read_text()
    rows = sweep(4, path)
    assert path.read_text().startswith(before)
    assert sorted(int(row["seed"]) for row in rows) == [0, 1, 2, 3]


ROWS = [
    lambda: section.rows(laws=30, n=300),
    lambda: frames.rows(n=100_000, number=1000),
    lambda: [boundary.slender(), boundary.overloaded(), boundary.coarsest()],
    lambda: [branches.at_singular_points(), branches.at_buckling_loads()],
    lambda: [process.same_bits()],
]


@pytest.mark.parametrize("rows", ROWS, ids=["section", "frames", "boundary", "branches", "process"])
def test_rows(rows):
    assert [row for row in rows() if not row.passed] == []


def test_a_column_with_a_force_across_has_one_branch():
    assert branches.stays(0.01) is not None


# at 1.6e-11 what keeps them apart is the error of points, 1e-11
@pytest.mark.parametrize("omega", [1e-2, -1e-4, 3.9810717055349695e-8, 1.6244e-8, 1e-9, -1e-10, 1.601e-11])
def test_a_trace_of_chirality_keeps_the_branches_apart(omega):
    assert branches.right_chirality(omega)


@pytest.mark.parametrize("omega", [1.599e-11, -1e-11, 1e-14])
def test_less_chirality_than_the_error_of_points_leaves_a_pitchfork(omega):
    assert branches.right_pitchfork(omega)
