"""A state and what follows from it."""

import math
from dataclasses import replace

import numpy as np
import pytest
import ribbonrs as rb
from hypothesis import given
from hypothesis import strategies as st
from refusal import refuses
from ribbonrs.helix import helix_of

LEAF = rb.Ribbon(length=30.0, width=1.5, thickness=0.15, material=rb.Isotropic(Y=2e6))
GROWTH = rb.growth.edge(0.06) + rb.growth.chiral(0.04)


@pytest.fixture(scope="module")
def state():
    return rb.solve(rb.Scene(LEAF, GROWTH), n=31)


def test_shapes_and_ends(state):
    assert state.S.shape == (31,)
    assert (state.S[0], state.S[-1]) == (0.0, 20.0)
    for name, tail in {
        "strains": (4,),
        "position": (3,),
        "quaternion": (4,),
        "directors": (3, 3),
        "force": (3,),
        "moment": (3,),
    }.items():
        assert getattr(state, name).shape == (31, *tail), name
    assert np.array_equal(state.strains, np.tile(state.strain, (31, 1)))
    assert np.array_equal(state.position[0], [0.0, 0.0, 0.0])
    assert np.array_equal(state.directors[0], np.eye(3))


def test_nothing_pulls_on_a_free_ribbon(state):
    assert not state.force.any()
    assert not state.moment.any()
    for end in (state.reactions.start, state.reactions.end):
        assert end.force.tolist() == end.moment.tolist() == [0.0, 0.0, 0.0]


def test_stability(state):
    assert (state.stable, state.index, state.section_index) == (True, 0.0, 0)
    for other in rb.natural_shapes(LEAF, GROWTH):
        assert other.stable == (other.section_index == 0)
        assert other.index == (0.0 if other.stable else math.inf)
        eigenvalues = np.linalg.eigvalsh(other.section_law.hessian(other.strain))
        assert np.count_nonzero(eigenvalues < 0.0) == other.section_index


def test_at_is_the_state_between_the_nodes(state):
    nodes = state.at(state.S)
    for name in ("strains", "position", "quaternion", "directors", "force", "moment"):
        assert np.array_equal(getattr(nodes, name), getattr(state, name)), name
        for shape in ((), (0,), (2,), (2, 3)):
            part = getattr(state.at(np.full(shape, 7.3)), name)
            assert part.shape == (*shape, *getattr(state, name).shape[1:])
    assert state.at(7.3).S.shape == ()
    assert np.array_equal(state.at(7.3).position, state.at([1.0, 7.3]).position[1])


def test_the_pose_is_the_integral_of_the_strains(state):
    position, quaternion = rb.integrate_frame(state.S, state.strains)
    assert np.abs(position - state.position).max() <= 1e-13
    assert np.abs(quaternion - state.quaternion).max() <= 1e-14
    step = 1e-4
    before, after = state.at(state.S[1:-1] - step), state.at(state.S[1:-1] + step)
    eps, K1, K2, K3 = state.strain
    d1, d2, d3 = np.moveaxis(state.directors[1:-1], 1, 0)
    # central differences of order step^2 = 1e-8
    tangent = (after.position - before.position) / (2 * step)
    assert np.abs(tangent - (1 + eps) * d3).max() <= 1e-8
    omega = K1 * d1 + K2 * d2 + K3 * d3
    for i, d in enumerate((d1, d2, d3)):
        change = (after.directors[:, i] - before.directors[:, i]) / (2 * step)
        assert np.abs(change - np.cross(omega, d)).max() <= 1e-8


@pytest.mark.parametrize(
    ("field", "bad"),
    [
        ("S", -1e-9),
        ("S", 20.001),
        ("S", [0.0, 21.0]),
        ("S", "0"),
        ("S", None),
        ("S", 1j),
        ("S", math.nan),
        ("S[1]", [0.0, math.inf]),
    ],
)
def test_at_refuses(state, field, bad):
    refuses(field, lambda: state.at(bad))


def test_the_clamp_is_the_starting_pose():
    scene = rb.Scene(LEAF, GROWTH, start=rb.Clamped((1.0, 2.0, 3.0), (0.3, -0.4, 1.1), twist_turns=0.25))
    state = rb.solve(scene)
    assert np.array_equal(state.position[0], [1.0, 2.0, 3.0])
    # the rotation vector, then a quarter turn about E3: what pointed along E1 points along E2
    angle = math.hypot(0.3, -0.4, 1.1)
    x, y, z = np.array([0.3, -0.4, 1.1]) / angle
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    rotation = np.eye(3) + math.sin(angle) * cross + (1 - math.cos(angle)) * cross @ cross
    quarter = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    assert np.abs(state.directors[0] - (quarter @ rotation).T).max() <= 1e-15


def test_mirror_images_are_mirrored():
    growth = rb.growth.edge(0.06)
    left, right = (rb.solve(rb.Scene(LEAF, growth), guess=[0.02, 0.0, K2, 0.0]) for K2 in (-0.3, 0.3))
    assert (left.phase, right.phase) == ("bent", "bent")
    assert np.abs(left.position * [-1, 1, 1] - right.position).max() <= 1e-13
    assert np.abs(left.surface() * [-1, 1, 1] - right.surface()).max() <= 1e-13
    twin = rb.solve(rb.Scene(LEAF, rb.growth.edge(0.06) + rb.growth.chiral(-0.04)))
    state = rb.solve(rb.Scene(LEAF, GROWTH))
    assert twin.helix.handedness == "left"
    # the mirror normal to E2 keeps K2 and changes the sign of K3
    assert np.abs(twin.surface()[:, ::-1] * [1, -1, 1] - state.surface()).max() <= 1e-12


def test_physical_units(state):
    physical, a = state.physical, 1.5
    assert np.array_equal(physical.S, state.S * a)
    assert physical.S[-1] == 30.0
    assert np.array_equal(physical.position, state.position * a)
    eps, *kappa = physical.strains[0]
    assert [eps, *kappa] == pytest.approx(
        [state.strain[0], *(K / a for K in state.strain[1:])], rel=1e-15, abs=0.0
    )
    # W = Pi Y h a
    assert physical.energy == pytest.approx(state.energy * 2e6 * 0.15 * 1.5, rel=1e-15)
    assert physical.force.shape == physical.moment.shape == (31, 3)
    assert physical.helix.radius == state.helix.radius * a
    assert physical.helix.pitch == state.helix.pitch * a
    assert physical.helix.turns == state.helix.turns


def test_the_units_of_force_and_moment(state):
    """This version's states are free of both, so they are put in."""
    loaded = replace(state)
    ones = np.ones((31, 3))
    loaded.__dict__["_nodes"] = replace(state.at(state.S), force=ones, moment=ones)
    unit = 2e6 * 0.15 * 1.5  # Y h a
    assert loaded.physical.force == pytest.approx(unit * ones, rel=1e-15)
    assert loaded.physical.moment == pytest.approx(1.5 * unit * ones, rel=1e-15)


def test_a_larger_ribbon_is_the_same_state():
    small, large = (rb.Ribbon(length=20.0 * a, width=a, thickness=0.1 * a) for a in (1.0, 1000.0))
    one, two = (rb.solve(rb.Scene(ribbon, GROWTH)) for ribbon in (small, large))
    assert np.abs(one.strain - two.strain).max() <= 1e-14
    assert np.abs(one.position - two.position).max() <= 1e-12


def test_deflection_and_displacements(state):
    x = np.linspace(-0.5, 0.5, 6)
    assert state.deflection(0.0).shape == (31,)
    assert state.deflection(x).shape == (31, 6)
    assert state.deflection(x.reshape(2, 3), derivative=2).shape == (31, 2, 3)
    assert state.displacements(0.0).shape == (31, 3)
    assert state.displacements(x).shape == (31, 6, 3)
    assert np.array_equal(state.displacements(x)[..., 0], state.deflection(x))
    assert np.array_equal(state.deflection(x)[4], state.section_law.deflection(state.strain, x))


def test_the_quadratic_law_borrows_its_deflection():
    growth = rb.growth.edge(0.046) + rb.growth.chiral(0.04)
    state = rb.solve(rb.Scene(LEAF, growth, law="quadratic"), guess=[0.0, 0.0, 0.274, 0.065])
    assert state.phase == "helical"
    full = rb.SectionLaw(LEAF.thickness_ratio, growth)
    assert np.array_equal(state.deflection(0.2)[0], full.deflection(state.strain, 0.2))
    assert state.surface().shape == (101, 41, 3)


def test_arrays_of_a_state_cannot_be_written(state):
    for array in (state.S, state.strain):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1.0
    with pytest.raises(AttributeError):
        state.phase = "flat"


def test_the_representation_is_one_short_line(state):
    assert repr(state).startswith("State(helical, stable=True, eps=0.0179")
    assert len(repr(state)) < 100


# --- the helix of the centreline

curvature = st.one_of(st.just(0.0), st.floats(0.01, 2.0), st.floats(-2.0, -0.01))


@given(st.floats(-0.1, 0.1), curvature, curvature, curvature, st.floats(1.0, 20.0))
def test_the_centreline_lies_on_the_helix(eps, K1, K2, K3, length):
    helix = helix_of(np.array([eps, K1, K2, K3]), length, 0.1)
    S = np.linspace(0.0, length, 40)
    r, _ = rb.integrate_frame(S, np.tile([eps, K1, K2, K3], (39, 1)))
    rate = math.hypot(K1, K2, K3)
    if rate == 0.0:
        assert helix == (type(helix))(0.0, math.inf, 0.0, "none")
        return
    assert helix.turns * 2 * math.pi == pytest.approx(rate * length, rel=1e-14)
    # its axis has the fixed direction of omega and passes one radius from the start, towards r''
    axis = np.array([K1, K2, K3]) / rate
    advance = (r - r[0]) @ axis
    assert np.abs(advance).max() == pytest.approx(helix.pitch * helix.turns, abs=1e-12 * length)
    normal = np.array([K2, -K1, 0.0])
    bend = np.linalg.norm(normal)
    centre = helix.radius * normal / bend if bend > 0.0 else np.zeros(3)
    radial = r - centre - np.outer(advance, axis)
    assert np.linalg.norm(radial, axis=1) == pytest.approx(np.full(40, helix.radius), abs=1e-11)
    assert helix.handedness == ("none" if K3 == 0.0 else "right" if K3 > 0.0 else "left")
    if K3 != 0.0 and bend > 0.0:
        # right-handed: turning about the axis as a right-handed screw while advancing along it
        turn = np.cross(radial[0], radial[1]) @ axis
        angle = rate * S[1]
        assert np.sign(turn * advance[1]) == np.sign(math.sin(angle)) * np.sign(K3)


def test_helices_that_degenerate():
    assert helix_of(np.array([0.1, 0.0, 0.0, 0.0]), 10.0, 0.1).pitch == math.inf
    circle = helix_of(np.array([0.1, 0.0, -0.5, 0.0]), 10.0, 0.1)
    assert (circle.radius, circle.pitch, circle.handedness) == (pytest.approx(2.2), 0.0, "none")
    twist = helix_of(np.array([0.1, 0.0, 0.0, -0.5]), 10.0, 0.1)
    assert (twist.radius, twist.pitch, twist.handedness) == (0.0, pytest.approx(4.4 * math.pi), "left")
    # where the square of the curvature would underflow
    tiny = helix_of(np.array([0.0, 0.0, 1e-200, 0.0]), 10.0, 0.1)
    assert tiny.radius == pytest.approx(1e200)
    # rounding left in K3 is no twist
    assert helix_of(np.array([0.0, 0.0, 0.3, 1e-17]), 10.0, 0.1).handedness == "none"


def test_the_rounded_end_of_the_ribbon_is_its_end():
    # 0.3/0.1 is a little less than 3.
    state = rb.solve(rb.Scene(rb.Ribbon(0.3, 0.1, 0.01), GROWTH))
    np.testing.assert_array_equal(state.at(3.0).position, state.position[-1])
    assert state.surface(5, S=[0.0, 3.0]).shape == (2, 5, 3)
    refuses("S", lambda: state.at(3.0001))


def test_arrays_cannot_be_changed(state):
    for name in ("S", "strain", "strains", "position", "quaternion", "directors", "force", "moment"):
        with pytest.raises(ValueError, match="read-only"):
            getattr(state, name)[...] = 7.0


def test_too_many_nodes_are_refused():
    refuses("n", lambda: rb.solve(rb.Scene(LEAF, GROWTH), n=10**12))
