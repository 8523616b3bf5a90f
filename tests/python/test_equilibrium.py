"""Natural shapes and the state that `solve` returns."""

import math

import numpy as np
import pytest
import ribbonrs as rb
from hypothesis import given
from hypothesis import strategies as st
from refusal import NOT_FINITE, NOT_NUMBERS, refuses
from ribbonrs.equilibrium import equilibria

ETA = 0.1
LEAF = rb.Ribbon(length=10.0, width=1.0, thickness=ETA)
BEND = (
    math.sqrt(259.0) - 7.0
) / 2.0  # xi/eta^2 at which the flat ribbon bends, and twists: MODEL of edge growth
TWIST = 5.0


def edge(scaled, eta=ETA):
    return rb.growth.edge(scaled * eta**2)


def chiral(omega, eta=ETA):
    return rb.growth.chiral(2.0 * eta * omega)


def scaled(states, eta=ETA):
    return np.array([state.strain / [eta**2, eta**2, eta, eta] for state in states])


def crossing(above, low, high):
    """Where the truth of `above` changes, by bisection."""
    assert not above(low)
    assert above(high)
    for _ in range(45):
        middle = (low + high) / 2
        low, high = (low, middle) if above(middle) else (middle, high)
    return high


def the(states, phase):
    """The first state of this phase."""
    return next(state for state in states if state.phase == phase)


# --- edge growth


@pytest.mark.parametrize(("index", "threshold"), [(1, BEND), (2, TWIST)])
@pytest.mark.filterwarnings("ignore::ribbonrs.RibbonWarning")  # close pairs beside the thresholds
def test_the_flat_ribbon_loses_stability(index, threshold):
    found = crossing(
        lambda xi: the(rb.natural_shapes(LEAF, edge(xi)), "flat").section_index >= index, 4.0, 6.0
    )
    assert found == pytest.approx(threshold, rel=1e-12)


@pytest.mark.parametrize("thickness", [0.12, 0.1, 1e-3, 1e-5])
def test_shapes_of_edge_growth(thickness):
    leaf = rb.Ribbon(length=10.0, width=1.0, thickness=thickness)

    def shapes(xi):
        return rb.natural_shapes(leaf, edge(xi, thickness))

    assert [state.phase for state in shapes(4.0)] == ["flat"]
    assert [state.phase for state in shapes(4.8)] == ["bent", "bent", "flat"]
    states = shapes(6.0)
    assert [state.phase for state in states] == ["bent", "bent", "twisted", "twisted", "flat"]
    assert [state.section_index for state in states] == [0, 0, 1, 1, 2]
    energies = [state.energy for state in states]
    assert energies == sorted(energies)
    # k2 of the bent state by an independent minimisation in 40 digits
    eps, k1, k2, k3 = scaled(states, thickness).T
    assert k2 == pytest.approx([3.177341, -3.177341, 0.0, 0.0, 0.0], abs=1e-6)
    # twisted, eq. (64): K3 = +-2 sqrt(2) sqrt(xi - 5 eta^2); everywhere eps = xi/3 - K3^2/24
    assert k3 == pytest.approx([0.0, 0.0, math.sqrt(8.0), -math.sqrt(8.0), 0.0], rel=1e-12, abs=1e-12)
    assert eps == pytest.approx(2.0 - k3**2 / 24.0, rel=1e-12)
    assert k1 == pytest.approx(np.zeros(5), abs=1e-12)
    assert np.array(energies) / thickness**4 == pytest.approx(
        [1.5063322, 1.5063322, 14 / 9, 14 / 9, 1.6], abs=1e-7
    )


@given(st.floats(0.0, 40.0), st.floats(0.0, 30.0), st.sampled_from([0.3, 0.01, 1e-4]))
def test_everything_scales_with_the_thickness(xi, omega, eta):
    if abs(xi - BEND) < 0.01 or abs(xi - TWIST) < 0.01:
        return  # roots of multiplicity > 1 nearby: ill-conditioned
    leaf = rb.Ribbon(length=10.0, width=1.0, thickness=eta)
    unit = rb.Ribbon(length=10.0, width=1.0, thickness=0.01)
    shrink = min(1.0, 0.4 / (40.0 * eta**2))
    growths = [edge(shrink * xi, e) + chiral(shrink * omega, e) for e in (eta, 0.01)]
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("warnings.warn", lambda *_, **__: None)  # large growth and close pairs
        one, two = rb.natural_shapes(leaf, growths[0]), rb.natural_shapes(unit, growths[1])
    if not all(state.resolved for state in [*one, *two]):
        return
    assert [state.phase for state in one] == [state.phase for state in two]
    assert scaled(one, eta) == pytest.approx(scaled(two, 0.01), rel=1e-7, abs=1e-7)


# --- chirality


@pytest.mark.parametrize("omega", [0.05, 0.2, 0.2226])
@pytest.mark.filterwarnings("ignore::ribbonrs.RibbonWarning")
def test_a_trace_of_chirality_makes_a_helix(omega):
    # twisted until C/eta^2 = 14 - sqrt(1036), where k3 = omega/(1 + C/20) and xi = (k3^2/2 - C)/4
    C = 14.0 - math.sqrt(1036.0)
    k3 = omega / (1.0 + C / 20.0)

    def twisted(xi):
        return min(
            (s for s in rb.natural_shapes(LEAF, edge(xi) + chiral(omega)) if s.phase == "twisted"),
            key=lambda state: -state.strain[3],
        )

    found = crossing(lambda xi: not twisted(xi).stable, 4.0, 7.0)
    # the index counts eigenvalues below -1e-13, which change by 0.01 per unit of xi/eta^2
    assert found == pytest.approx((k3**2 / 2.0 - C) / 4.0, rel=1e-11)
    assert twisted(found).strain[3] / ETA == pytest.approx(k3, rel=1e-10)
    helix = rb.solve(rb.Scene(LEAF, edge(found + 0.05) + chiral(omega)))
    assert (helix.phase, helix.helix.handedness) == ("helical", "right")


def test_the_helix_of_the_example():
    state = rb.solve(rb.Scene(LEAF, edge(6.0) + chiral(0.2)))
    assert state.phase == "helical"
    assert state.strain[2:] / ETA == pytest.approx([2.4156, 2.2149], abs=1e-4)
    other = rb.solve(rb.Scene(LEAF, edge(6.0) + chiral(-0.2)))
    assert other.strain == pytest.approx(state.strain * [1, 1, 1, -1], rel=1e-12, abs=1e-15)


@pytest.mark.filterwarnings("ignore::ribbonrs.RibbonWarning")
def test_chirality_alone_from_narrow_to_wide():
    leaf = rb.Ribbon(length=10.0, width=1.0, thickness=0.01)
    C = 14.0 + math.sqrt(1036.0)
    k3 = math.sqrt(2.0 * C)

    def helical(omega):
        return rb.solve(rb.Scene(leaf, chiral(omega, 0.01))).phase == "helical"

    found = crossing(helical, 20.0, 40.0)
    assert found == pytest.approx(k3 * (1.0 + C / 20.0), rel=1e-11)
    assert found == pytest.approx(31.8066, abs=1e-4)


# --- other growths


@pytest.mark.parametrize("xi", [-0.3, 0.05, 0.3])
def test_a_thickness_gradient_bends_without_stress(xi):
    state = rb.solve(rb.Scene(LEAF, rb.growth.thickness(xi)))
    assert state.phase == "bent"
    assert state.strain == pytest.approx([0.0, 0.0, -xi, 0.0], abs=1e-15)
    assert state.energy <= 1e-30
    assert np.abs(state.deflection(np.linspace(-0.5, 0.5, 9))).max() <= 1e-15


def test_a_gradient_across_the_width_curves_in_its_plane():
    # gamma33 = 0.02 x is the strain of in-plane bending: K1 = 12 <x gamma33> = 0.02, no stress
    state = rb.solve(rb.Scene(LEAF, rb.growth.Profile(gamma33=[0.01, 0.02])))
    assert state.phase == "flat"
    assert state.strain == pytest.approx([0.01, 0.02, 0.0, 0.0], abs=1e-15)
    assert state.energy <= 1e-30


# --- solve


def test_of_mirror_images_the_positive_one():
    assert rb.solve(rb.Scene(LEAF, edge(6.0))).strain[2] > 0.0
    signs = [tuple(np.sign(s.strain[2:])) for s in rb.natural_shapes(LEAF, edge(6.0))]
    assert signs == [(1, 0), (-1, 0), (0, 1), (0, -1), (0, 0)]


def test_the_start_moves_the_state_only():
    start = rb.Clamped(position=(1.0, 2.0, 3.0))
    one, two = (rb.solve(rb.Scene(LEAF, edge(6.0), start=s)) for s in (rb.Clamped(), start))
    assert np.array_equal(one.strain, two.strain)
    assert np.abs(two.position - one.position - [1.0, 2.0, 3.0]).max() <= 1e-14


@pytest.mark.parametrize("i", range(5))
def test_a_guess_picks_the_nearest_equilibrium(i):
    scene = rb.Scene(LEAF, edge(6.0))
    states = rb.natural_shapes(LEAF, edge(6.0))
    near = states[i].strain + np.array([100.0, -0.5, 0.03, -0.03])  # eps and K1 do not count
    far = states[i].strain + np.array([-100.0, 0.5, -0.03, 0.03])
    for guess in (states[i], near, list(near), far):
        found = rb.solve(scene, guess=guess)
        assert np.array_equal(found.strain, states[i].strain)
        assert found.section_index == states[i].section_index


def test_the_nodes():
    for n in (2, 7, 101):
        state = rb.solve(rb.Scene(LEAF, edge(6.0)), n=n)
        assert np.array_equal(state.S, np.linspace(0.0, 10.0, n))
    assert rb.solve(rb.Scene(LEAF, edge(6.0))).S.size == 101


def test_the_report():
    for state in rb.natural_shapes(LEAF, edge(6.0) + chiral(0.2)):
        report = state.report
        assert (report.method, report.equilibria, report.unresolved) == ("pointwise natural shape", 5, 0)
        # forces of the order of xi = 0.06 cancel to rounding
        assert report.gradient_norm <= 1e-16
        assert np.linalg.norm(state.section_law.gradient(state.strain)) == report.gradient_norm


def test_close_pairs_are_reported():
    growth = edge(BEND * (1.0 + 1e-14))
    with pytest.warns(rb.RibbonWarning, match="several closer than 1e-6 in K/eta"):
        states = rb.natural_shapes(LEAF, growth)
    assert not any(state.resolved for state in states)
    assert states[0].report.unresolved == len(states)


@pytest.mark.parametrize("bad", [0.0, 1e-15, 1.0, -1e-10, *NOT_FINITE, *NOT_NUMBERS])
def test_tolerances_refused(bad):
    refuses("tol", lambda: rb.solve(rb.Scene(LEAF, edge(1.0)), tol=bad))


@pytest.mark.parametrize("bad", [0, -1, 2.0, "3", True, math.nan])
def test_degrees_refused(bad):
    refuses("degree", lambda: rb.solve(rb.Scene(LEAF, edge(1.0)), degree=bad))


def test_tolerance_and_degree_accepted():
    rb.solve(rb.Scene(LEAF, edge(1.0)), tol=1e-14, degree=3)


@pytest.mark.parametrize("bad", [1, 0, -5, 101.0, "101", None, True, math.nan])
def test_node_counts_refused(bad):
    refuses("n", lambda: rb.solve(rb.Scene(LEAF, edge(1.0)), n=bad))


@pytest.mark.parametrize("bad", [None, LEAF, "scene", 1])
def test_scenes_refused(bad):
    refuses("scene", lambda: rb.solve(bad))


@pytest.mark.parametrize(
    ("field", "bad"),
    [
        ("guess", "bent"),
        ("guess.shape", [0.0, 0.0]),
        ("guess.shape", 0.0),
        ("guess[2]", [0.0, 0.0, math.nan, 0.0]),
        ("guess", LEAF),
    ],
)
def test_guesses_refused(field, bad):
    refuses(field, lambda: rb.solve(rb.Scene(LEAF, edge(1.0)), guess=bad))


@pytest.mark.parametrize("along", [1.0, ([0.0, 1e7], [1.0, 1.0])])
def test_growth_that_jumps_is_told_where_it_loses_digits(along):
    thin = rb.Ribbon(length=10.0, width=1.0, thickness=1e-6)

    def step(size):
        return rb.growth.Profile(d33=[[size], [0.8 * size]], breaks=[0.1], amplitude=along)

    rb.natural_shapes(thin, step(0.08))
    rb.natural_shapes(thin, rb.growth.thickness(0.5))  # without a jump there is no limit
    for found in (
        lambda: rb.natural_shapes(thin, [step(0.5), step(0.4)]),
        lambda: rb.natural_shapes(thin, step(0.5)),
        lambda: rb.solve(rb.Scene(thin, step(0.5))),
    ):
        with pytest.warns(rb.RibbonWarning, match=r"\|K2\| = 0\.[0-9]+ is beyond 0\.0819, where") as caught:
            found()
        assert [warning.filename for warning in caught] == [__file__]  # once, where it was called


# --- the quadratic law, eq. (59)


def test_the_quadratic_law_agrees_where_K2_is_small():
    growths = edge(4.0), edge(4.0) + chiral(0.2)
    for growth in growths:
        full, quadratic = (rb.solve(rb.Scene(LEAF, growth, law=law)) for law in ("full", "quadratic"))
        assert full.strain == pytest.approx(quadratic.strain, rel=1e-12, abs=1e-15)
        assert full.energy == pytest.approx(quadratic.energy, rel=1e-12)


def test_the_quadratic_law_refuses_other_growth():
    refuses("law", lambda: rb.solve(rb.Scene(LEAF, rb.growth.thickness(0.1), law="quadratic")))


def test_the_quadratic_law_has_a_spurious_state_and_says_so():
    # eq. (59) alone has equilibria at k2 = 10.731, k3^2 = 8 xi/eta^2 + 92.374, beyond its convergence
    scene = rb.Scene(LEAF, edge(6.0), law="quadratic")
    with pytest.warns(rb.RibbonWarning, match="series diverges"):
        state = rb.solve(scene, guess=[0.0, 0.0, 1.07, 1.18])
    assert state.strain[2:] / ETA == pytest.approx([10.731, math.sqrt(8 * 6.0 + 92.374)], abs=1e-3)
    assert not state.stable


def test_no_stable_state_is_an_error_that_says_what_to_try():
    # past its threshold the energy of eq. (59) is unbounded below in K2
    with pytest.raises(
        rb.ConvergenceError, match=r"none of the \d+ equilibria is stable; try law=\"full\""
    ) as caught:
        rb.solve(rb.Scene(LEAF, edge(6.0), law="quadratic"))
    assert caught.value.iterate.shape == (4,)
    assert caught.value.residuals[0] <= 1e-16
    assert all(not state.stable for state in equilibria(rb.Scene(LEAF, edge(6.0), law="quadratic")))


# --- natural_shapes


@pytest.mark.filterwarnings("ignore::ribbonrs.RibbonWarning")
@pytest.mark.parametrize("bad", [None, "leaf", 1.0])
def test_arguments_refused(bad):
    refuses("ribbon", lambda: rb.natural_shapes(bad, edge(1.0)))
    refuses("growth", lambda: rb.natural_shapes(LEAF, bad))


def test_growth_too_large():
    with pytest.raises(rb.InputError, match="small growth"):
        rb.natural_shapes(LEAF, rb.growth.edge(0.6))


@pytest.mark.parametrize("growth", [edge(6.0), rb.growth.thickness(0.3), chiral(0.2)])
def test_no_negative_zeros(growth):
    for state in rb.natural_shapes(LEAF, growth):
        zeros = state.strain[state.strain == 0.0]
        assert not np.signbit(zeros).any()
