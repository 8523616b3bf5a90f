"""States of ribbons whose growth, width or thickness varies along their length."""

import copy
import math
import pickle

import numpy as np
import pytest
import ribbonrs as rb
from refusal import refuses
from ribbonrs.report import Event

ETA = 0.1
LEAF = rb.Ribbon(length=10.0, width=1.0, thickness=ETA)
BEND = (math.sqrt(259.0) - 7.0) / 2.0 * ETA**2  # edge growth at which a flat ribbon bends
CORE = 1e-12  # the part of the strains that the elements of a branch may miss


def waves(S):
    return 0.07 + 0.01 * np.sin(S)


RISING = rb.growth.edge(([0.0, 10.0], [0.0, 0.08]))
HELICAL = rb.growth.edge(waves) + rb.growth.chiral(0.04)
SNAPPING = rb.growth.edge(0.08) + rb.growth.thickness(([0.0, 10.0], [-0.3, 0.6]))


def solved(growth, ribbon=LEAF, **arguments):
    return rb.solve(rb.Scene(ribbon, growth), **arguments)


def beside(states, strain):
    """The stable one of these states of a uniform ribbon that is nearest to this strain."""
    stable = [other for other in states if other.stable]
    return min(stable, key=lambda other: np.linalg.norm(other.strain - strain))


# --- against the uniform ribbon


@pytest.mark.parametrize("growth", [rb.growth.edge(0.06), rb.growth.edge(0.06) + rb.growth.chiral(0.04)])
def test_constant_growth_given_along_the_ribbon_is_the_uniform_state(growth):
    constant = rb.growth.edge(([0.0, 10.0], [0.06, 0.06])) + rb.growth.Growth(growth.terms[1:])
    one, two = solved(growth), solved(constant)
    assert (one.uniform, two.uniform) == (True, False)
    assert (two.phase, two.phases) == (one.phase, (one.phase,))
    assert two.report.events == ()
    assert two.energy == pytest.approx(one.energy, rel=1e-13)
    # strains as near as the elements, poses as near as these strains over ten widths
    for name, tolerance in {"strains": CORE, "position": 1e-11, "directors": 1e-11}.items():
        assert getattr(two, name) == pytest.approx(getattr(one, name), abs=tolerance), name
    x = np.linspace(-0.5, 0.5, 7)
    for derivative in (0, 1, 2):
        assert two.deflection(x, derivative) == pytest.approx(one.deflection(x, derivative), abs=1e-11)
    assert two.displacements(x) == pytest.approx(one.displacements(x), abs=CORE)
    for face in (-1.0, 0.0, 0.5):
        assert two.surface(face=face) == pytest.approx(one.surface(face=face), abs=1e-11)


@pytest.mark.parametrize("S", [0.0, 3.3, 7.1, 10.0])
def test_every_section_is_that_of_a_uniform_ribbon(S):
    state = solved(HELICAL)
    local = rb.natural_shapes(LEAF, rb.growth.edge(float(waves(S))) + rb.growth.chiral(0.04))
    at = state.at(S)
    assert at.strains == pytest.approx(beside(local, at.strains).strain, abs=10 * CORE)


@pytest.mark.parametrize("S", [0.5, 4.0, 9.0])
def test_every_section_of_a_taper_is_that_of_a_ribbon_of_that_size(S):
    """A ribbon of the local width and thickness, in its own units, brought to those of the taper."""
    tapered = rb.Ribbon(
        10.0,
        1.0,
        ETA,
        width_profile=([0.0, 10.0], [1.2, 0.7]),
        thickness_profile=lambda S: 1.0 - 0.03 * S,
    )
    growth = rb.growth.edge(0.07) + rb.growth.chiral(0.05) + rb.growth.thickness(-0.2)
    across = rb.growth.Profile(g21=[0.0, 0.02], g31=[0.01, 0.0, 0.03], gamma22=[0.01], gamma23=[0.02, 0.01])
    state = solved(growth + across, tapered)
    w, t = 1.2 - 0.05 * S, 1.0 - 0.03 * S
    # gradients through the thickness are per width
    same = rb.growth.edge(0.07) + rb.growth.chiral(0.05 * w) + rb.growth.thickness(-0.2 * w) + across
    small = rb.Ribbon(10.0, w, ETA * t)
    K = np.array([1.0, w, w, w])
    local = beside(rb.natural_shapes(small, same), state.at(S).strains * K)
    assert state.at(S).strains * K == pytest.approx(local.strain, abs=10 * CORE)
    x = np.linspace(-0.5, 0.5, 9)
    law = state.section_law
    strain = state.at(S).strains
    assert law.displacements(strain, x, S) == pytest.approx(w * local.displacements(x)[0], abs=10 * CORE)
    # the body around the same cross-section
    for face in (-1.0, 0.0, 0.7):
        body = state.surface(nx=9, face=face, S=[S])[0] - state.at(S).position
        alone = w * local.surface(nx=9, face=face, S=[0.0])[0]
        assert body @ state.at(S).directors.T == pytest.approx(alone, abs=10 * CORE)


def test_the_energy_is_the_mean():
    state = solved(HELICAL)
    y, weights = np.polynomial.legendre.leggauss(20)
    S = 5.0 * (1.0 + y)
    energy = state.section_law.energy(state.at(S).strains, S)
    # a Gauss rule for a function as smooth as the growth
    assert state.energy == pytest.approx(float(weights @ energy) / 2.0, rel=1e-13)


def test_the_pose_is_the_integral_of_the_strains():
    state = solved(HELICAL)
    S = np.linspace(0.0, 10.0, 401)
    position, quaternion = rb.integrate_frame(S, lambda S: state.at(S).strains)
    # of order six in steps of 1/40
    assert state.at(S).position == pytest.approx(position, abs=1e-12)
    assert state.at(S).quaternion == pytest.approx(quaternion, abs=1e-12)


def test_forces_vanish_at_every_node():
    for growth in (RISING, HELICAL, SNAPPING):
        states = rb.natural_shapes(LEAF, growth)
        for state in states:
            gradient = state.section_law.gradient(state.strains, state.S)
            assert state.report.gradient_norm == np.max(np.linalg.norm(gradient, axis=1))
            # the stiffest direction has modulus 1, the strains are of order 0.1 to 1
            assert state.report.gradient_norm <= CORE
            assert not state.force.any()
            assert not state.moment.any()


# --- events


def test_growth_that_rises_bends_where_it_passes_the_threshold():
    state = solved(RISING)
    assert (state.phase, state.phases) == ("curved", ("flat", "bent"))
    (event,) = state.report.events
    assert event.kind == "bifurcation"
    assert abs(event.S - BEND / 0.008) <= 1e-11  # ends of elements are 1e-12 apart
    # flat to there: eps is the mean growth, xi/3
    flat = state.S < event.S
    assert state.strains[flat, 0] == pytest.approx(0.008 * state.S[flat] / 3.0, abs=CORE)
    assert not state.strains[flat, 2:].any()
    assert np.all(state.strains[~flat, 2] > 0.0)
    # and a square root beyond
    near = state.at(event.S + np.array([1e-4, 4e-4])).strains[:, 2]
    assert near[1] / near[0] == pytest.approx(2.0, abs=1e-3)
    assert state.report.tolerance == 1e-12
    assert state.report.elements > 10  # they shrink towards the root


def test_growth_that_jumps():
    growth = rb.growth.edge(([0.0, 4.0, 4.0, 10.0], [0.05, 0.05, 0.08, 0.08])) + rb.growth.chiral(0.04)
    state = solved(growth)
    (event,) = state.report.events
    assert (event.S, event.kind) == (4.0, "growth jump")
    parts = [solved(rb.growth.edge(xi) + rb.growth.chiral(0.04)).strain for xi in (0.05, 0.08)]
    assert event.before == pytest.approx(tuple(parts[0]), abs=10 * CORE)
    assert event.after == pytest.approx(tuple(parts[1]), abs=10 * CORE)
    # where the strains jump, those to the right
    assert state.at([3.999, 4.0]).strains == pytest.approx(np.array(parts), abs=10 * CORE)
    position, _ = rb.integrate_frame([0.0, 4.0, 10.0], parts)
    assert state.at([0.0, 4.0, 10.0]).position == pytest.approx(position, abs=1e-11)


def test_a_jump_is_told():
    """Edges that grow keep the ribbon bent against a gradient through the thickness, up to a fold."""
    with pytest.warns(rb.RibbonWarning) as caught:
        state = solved(SNAPPING)
    (event,) = [event for event in state.report.events if event.kind == "jump"]
    (message,) = [str(warning.message) for warning in caught]
    assert message.startswith(f"the shape jumps along the ribbon: S = {event.S:.6g} from K2 = 0.")
    assert message.count("\n") == 0
    assert event.before[2] > 0.0 > event.after[2]
    # a fold: the stiffness against K2 vanishes, like a root of the distance from it
    # a fold: the stiffness against K2, elsewhere 2e-4, vanishes like the root of the distance, here 1e-12
    soft = np.linalg.eigvalsh(state.section_law.hessian(event.before, event.S))[0]
    assert abs(soft) <= 1e-9

    def stable(S):
        growth = rb.growth.edge(0.08) + rb.growth.thickness(-0.3 + 0.09 * S)
        return [other for other in rb.natural_shapes(LEAF, growth) if other.stable]

    # and two stable shapes before it, one after it
    assert len(stable(event.S - 1e-6)) == 2
    (after,) = stable(event.S + 1e-6)
    assert event.after == pytest.approx(tuple(after.strain), abs=1e-6)


def test_a_guess_picks_the_branch_nearest_at_the_start():
    states = rb.natural_shapes(LEAF, rb.growth.edge(([0.0, 10.0], [0.08, 0.06])))
    assert [np.sign(state.strains[0, 2]) for state in states] == [1.0, -1.0]
    for state in states:
        near = state.strains[0] + [100.0, -0.5, 0.1, 0.1]  # eps and K1 do not count
        for guess in (state, near, list(near)):
            found = rb.solve(state.scene, guess=guess)
            assert np.array_equal(found.strains, state.strains)
    uniform = solved(rb.growth.edge(0.06), guess=[0.0, 0.0, -0.3, 0.0])
    assert np.array_equal(rb.solve(states[0].scene, guess=uniform).strains, states[1].strains)
    assert np.array_equal(solved(rb.growth.edge(0.06), guess=states[1]).strain, uniform.strain)


def test_the_order_is_jumps_then_energy():
    growth = rb.growth.edge(0.08) + rb.growth.thickness(([0.0, 10.0], [-0.05, 0.6]))
    states = rb.natural_shapes(LEAF, growth)

    def rank(state):
        return sum(event.kind == "jump" for event in state.report.events), state.energy

    assert len(states) == 2
    assert [rank(state) for state in states] == sorted(map(rank, states))
    assert rank(states[0])[0] == 0 < rank(states[1])[0]
    for state in states:
        assert (state.stable, state.section_index, state.index, state.resolved) == (True, 0, 0.0, True)
        assert state.report.equilibria == 2
        eigenvalues = np.linalg.eigvalsh(state.section_law.hessian(state.strains, state.S))
        assert eigenvalues.min() > 0.0


def test_events_are_plain_values():
    (event,) = solved(RISING).report.events
    assert event == Event(event.S, event.kind, event.before, event.after)
    assert hash(event)
    with pytest.raises(AttributeError):
        event.S = 0.0


# --- the state


def test_at_takes_any_shape_and_order():
    state = solved(HELICAL)
    S = np.random.default_rng(3).permutation(np.concatenate([np.linspace(0.0, 10.0, 23), [4.0, 4.0]]))
    shuffled, ordered = state.at(S.reshape(5, 5)), state.at(np.sort(S))
    order = np.argsort(S)
    for name in ("strains", "position", "quaternion", "directors"):
        rows = getattr(shuffled, name)
        assert rows.shape == (5, 5, *getattr(state, name).shape[1:])
        assert np.array_equal(rows.reshape(25, *rows.shape[2:])[order], getattr(ordered, name)), name
    # where else it is asked for changes the steps of the integration, and so its rounding
    assert state.at(7.3).position == pytest.approx(state.at([9.0, 7.3]).position[1], abs=1e-13)
    for shape in ((), (0,), (2, 0)):
        assert state.at(np.full(shape, 7.3)).directors.shape == (*shape, 3, 3)
    refuses("S", lambda: state.at(10.001))
    refuses("S", lambda: state.at(-1e-9))


def test_the_nodes_and_the_clamp():
    start = rb.Clamped((1.0, 2.0, 3.0), (0.3, -0.4, 1.1))
    state = rb.solve(rb.Scene(LEAF, HELICAL, start=start), n=7)
    still = solved(HELICAL, n=7)
    assert np.array_equal(state.S, np.linspace(0.0, 10.0, 7))
    moved = still.position @ state.directors[0] + [1.0, 2.0, 3.0]
    assert state.position == pytest.approx(moved, abs=1e-13)
    for name in ("S", "strains", "position", "quaternion", "directors", "force", "moment"):
        with pytest.raises(ValueError, match="read-only"):
            getattr(state, name)[...] = 7.0


def test_what_a_state_that_varies_does_not_have():
    state = solved(RISING)
    refuses("state.strain", lambda: state.strain)
    assert state.helix is None
    assert state.physical.helix is None
    assert repr(state).startswith("State(curved, stable=True, eps=[")
    assert ", K1=0, K2=[0, 0.4" in repr(state)


def test_a_copy_is_the_same_state():
    state = solved(rb.growth.edge(([0.0, 10.0], [0.0, 0.08])) + rb.growth.chiral(0.04))
    for copied in (pickle.loads(pickle.dumps(state)), copy.deepcopy(state)):
        assert copied.report == state.report
        S = np.linspace(0.0, 10.0, 333)
        assert np.array_equal(copied.at(S).strains, state.at(S).strains)
        assert np.array_equal(copied.at(S).position, state.at(S).position)


def test_physical_units():
    ribbon = rb.Ribbon(30.0, 3.0, 0.3, material=rb.Isotropic(Y=2e6))
    state = solved(HELICAL, ribbon)
    assert state.strains == pytest.approx(solved(HELICAL).strains, abs=1e-14)
    physical = state.physical
    assert physical.strains == pytest.approx(state.strains / [1.0, 3.0, 3.0, 3.0], rel=1e-15)
    assert physical.position == pytest.approx(3.0 * state.position, rel=1e-15)
    assert physical.energy == pytest.approx(state.energy * 2e6 * 0.3 * 3.0, rel=1e-15)


def test_the_surface_follows_the_growth_along_the_ribbon():
    growth = (
        HELICAL
        + rb.growth.Profile(g21=[0.0, 0.05], amplitude=([0.0, 10.0], [1.0, 0.0]), name="one")
        + rb.growth.Profile(g31=[0.02, 0.0, 0.04], amplitude=np.cos, name="two")
    )
    state = solved(growth, n=11)
    u = state.displacements(0.3)
    slope = state.deflection(0.3, derivative=1)
    for face in (-1.0, 0.4):
        points = state.surface(nx=11, face=face)[:, 8]
        X1 = face * ETA / 2
        for i, S in enumerate(state.S):
            g21, g31 = 0.05 * 0.3 * (1.0 - S / 10.0), (0.02 + 0.04 * 0.09) * math.cos(S)
            K3 = state.strains[i, 3]
            section = [
                X1 + u[i, 0],
                0.3 + u[i, 1] - X1 * (slope[i] - g21),
                u[i, 2] + X1 * (K3 * 0.3 + g31),
            ]
            expected = state.position[i] + section @ state.directors[i]
            assert points[i] == pytest.approx(expected, abs=1e-14)
    assert state.surface(S=[]).shape == (0, 41, 3)
    assert np.array_equal(state.surface(S=[3.0, 1.0])[0], state.surface(S=[1.0, 3.0])[1])


def test_the_edges_of_a_taper_are_its_width_apart():
    petal = rb.Ribbon(10.0, 2.0, 0.02, width_profile=([0.0, 2.0, 5.0], [0.3, 1.0, 0.1]))
    surface = solved(rb.growth.edge(0.0), petal).surface(nx=3)
    width = np.linalg.norm(surface[:, 2] - surface[:, 0], axis=1)
    S = np.linspace(0.0, 5.0, 101)
    assert width == pytest.approx(np.interp(S, [0.0, 2.0, 5.0], [0.3, 1.0, 0.1]), abs=1e-15)


# --- what cannot be solved


def test_the_quadratic_law_ends_where_it_would_bend():
    """Its stable shapes are all unbent; no shape at all is stable beyond the threshold."""
    scene = rb.Scene(LEAF, RISING, law="quadratic")
    with pytest.raises(rb.ConvergenceError, match=r'stable shape; try law="full"') as caught:
        rb.solve(scene)
    assert str(caught.value).startswith("no natural shape all along the ribbon, S = 5.68")
    assert "\n" not in str(caught.value)
    twisted = rb.growth.edge(([0.0, 10.0], [0.0, 0.04])) + rb.growth.chiral(0.04)
    full, quadratic = (rb.solve(rb.Scene(LEAF, twisted, law=law)) for law in ("full", "quadratic"))
    assert full.phases == quadratic.phases == ("twisted",)
    assert quadratic.strains == pytest.approx(full.strains, abs=10 * CORE)
    refuses("law", lambda: rb.solve(rb.Scene(LEAF, SNAPPING, law="quadratic")))


# --- scenes


def test_samples_cover_the_ribbon():
    refuses("growth.edge.amplitude", lambda: rb.Scene(rb.Ribbon(10.1, 1.0, 0.1), RISING))
    refuses("growth.edge.amplitude", lambda: rb.natural_shapes(rb.Ribbon(10.1, 1.0, 0.1), RISING))


def test_the_size_of_growth_is_taken_along_the_ribbon():
    refuses("growth.size", lambda: rb.Scene(LEAF, rb.growth.edge(([0.0, 10.0], [0.0, 0.6]))))
    with pytest.warns(rb.RibbonWarning, match=r"growth\.size = 0\.2"):
        rb.Scene(LEAF, rb.growth.edge(lambda S: 0.2 * np.sin(S) ** 2))
    # at the faces, which are farther from the middle where the ribbon is thick
    assert rb.Scene(LEAF, rb.growth.chiral(0.4)).growth_size == pytest.approx(0.02, rel=1e-15)
    thick = rb.Ribbon(10.0, 1.0, ETA, thickness_profile=([0.0, 5.0, 10.0], [1.0, 3.0, 2.0]))
    assert rb.Scene(thick, rb.growth.chiral(0.4)).growth_size == pytest.approx(0.06, rel=1e-15)
    refuses("growth.size", lambda: rb.Scene(thick, rb.growth.chiral(4.0)))
    assert rb.Scene(thick, rb.growth.edge(0.05)).growth_size == pytest.approx(0.05, rel=1e-15)


@pytest.mark.parametrize("field", ["gamma33", "d33", "d22", "d23", "g21", "g31", "gamma22", "gamma23"])
@pytest.mark.parametrize("piecewise", [False, True])
def test_the_warning_starts_at_a_tenth_in_every_field(field, piecewise):
    lever = ETA / 2 if field.startswith("d") else 1.0

    def growth(size):
        # at x = 1/2; fields with the sign of their parts mixed are less than the sum of these
        coefficients = [0.0, 0.0, 8.0 * size / lever, -8.0 * size / lever]
        if piecewise:
            return rb.growth.Profile(**{field: [coefficients, coefficients]}, breaks=[0.0])
        return rb.growth.Profile(**{field: coefficients})

    rb.Scene(LEAF, growth(0.033))  # |8 x^2 - 8 x^3| is 3 at x = -1/2
    with pytest.warns(rb.RibbonWarning, match=r"growth\.size = 0\.1"):
        rb.Scene(LEAF, growth(0.034))
