"""What a state says of the strains that the theory neglects."""

import warnings
from types import SimpleNamespace

import numpy as np
import pytest
import ribbonrs as rb
from body import ALONG, Body
from ribbonrs.neglected import STRETCHED

LEAF = rb.Ribbon(10.0, 1.0, 0.1)
ETAS = (0.1, 0.05, 0.025, 0.0125)


def unloaded(growth, ribbon=LEAF):
    return rb.solve(rb.Scene(ribbon, growth))


def closed(link=0.0, thickness=0.05):
    return rb.solve(rb.Scene(rb.Ribbon(20.0, 1.0, thickness), start=rb.Closed(link=link)))


# ------------------------------------------------------------------------------------- against differences

EVERY = rb.growth.Profile(
    gamma33=[0.01, 0.02, 0.2],
    d33=[0.05, 0.1],
    d22=[0.03],
    d23=[0.08, 0.1],
    g21=[0.02, 0.03, 0.1],
    g31=[0.01, -0.02, 0.05],
    gamma22=[0.01, 0.02],
    gamma23=[0.02, -0.03],
)


@pytest.mark.parametrize(
    ("growth", "material"),
    [
        (rb.growth.edge(0.06), rb.Isotropic()),
        (rb.growth.edge(0.06) + rb.growth.chiral(0.04), rb.MooneyRivlin(1.0, 0.5)),
        (rb.growth.thickness(0.3, -0.15), rb.Isotropic(nu=0.2)),
        (EVERY, rb.Isotropic(nu=-0.3)),
    ],
    ids=["bent", "helical", "saddle", "every field"],
)
def test_uniform_states_against_differences_of_positions(growth, material):
    state = unloaded(growth, rb.Ribbon(10.0, 1.0, 0.1, material))
    lost, kept = Body(state, 5.0).energies(24)
    part = np.sqrt(lost / kept)
    held = np.sqrt(held_flat(growth, material.stiffness, 0.1) / kept)
    # Differences in steps of 2e-4 are good to 1e-10, the strains that are lost 1e-5 or more.
    assert state.neglected == pytest.approx(part / max(1.0, held), rel=1e-5)


def held_flat(growth, stiffness, eta, width=1.0):
    """Twice the energy per length of what grows and is held flat, its length and arc free."""
    Q33, Q22, Q23, G = stiffness
    t, w = np.polynomial.legendre.leggauss(24)
    x, w = t / 2, w / 2
    zero = np.zeros(x.size)
    g = {**dict.fromkeys(rb.growth.FIELDS, zero), **growth.values(x)}
    ahead, behind = growth.values(x + 1e-4), growth.values(x - 1e-4)
    slope = {name: (ahead[name] - behind[name]) / 2e-4 / width for name in ahead}
    m = np.polynomial.polynomial.polyval(
        x, np.polynomial.polynomial.polyfit(x, g["gamma33"], 1, w=np.sqrt(w))
    )
    m = m - g["gamma33"]
    b33, b22 = g["d33"], g["d22"] - slope.get("g21", zero)
    b23 = (slope.get("g31", zero) - g["d23"]) / 2
    bending = Q33 * b33**2 + 2 * Q23 * b33 * b22 + Q22 * b22**2 + 4 * G * b23**2
    return float((eta * (Q33 - Q23**2 / Q22) * m**2 + eta**3 / 12 * bending) @ w * width)


VARYING = {
    "growth along": lambda: rb.Scene(
        LEAF, rb.growth.thickness(lambda S: 0.3 * np.cos(S / 2), -0.1) + rb.growth.chiral(0.05)
    ),
    "gravity": lambda: rb.Scene(LEAF, rb.growth.thickness(0.2, -0.1), gravity=(-3e-6, 1e-6, 0.0)),
    "tapered": lambda: rb.Scene(
        rb.Ribbon(
            8.0,
            1.0,
            0.1,
            width_profile=lambda S: 1 - 0.3 * np.sin(S / 3),
            thickness_profile=lambda S: 1 - S / 40,
        ),
        rb.growth.thickness(0.2, -0.1) + rb.growth.chiral(0.05),
        gravity=(2e-6, 0.0, 0.0),
    ),
    "twist between clamps": lambda: rb.Scene(
        rb.Ribbon(6.0, 1.0, 0.1), end=rb.Clamped(position=(0, 0, 5.4), twist_turns=0.4)
    ),
}


@pytest.mark.parametrize("made", VARYING.values(), ids=VARYING.keys())
def test_varying_states_against_differences_of_positions(made):
    scene = made()
    state = rb.solve(scene, tol=1e-12)
    length = scene.ribbon.length_ratio
    t, w = np.polynomial.legendre.leggauss(10)
    S = (np.arange(3)[:, None] + (1 + t) / 2).ravel() * length / 3
    assert S[0] > 4 * ALONG  # room for differences
    lost, kept = np.array([Body(state, s).energies() for s in S]).T @ np.tile(w, 3)
    held = held_flat_along(scene, S, np.tile(w, 3)) if scene.growth.terms else 0.0
    # The package differentiates sections an eighth of the width apart, with an error of fourth order, and
    # takes three stations an element.
    assert state.neglected == pytest.approx(np.sqrt(lost / max(kept, held)), rel=5e-3)


def held_flat_along(scene, S, w):
    """The same of growth that varies, summed with weights over stations."""
    ribbon = scene.ribbon
    dimensions = [
        np.ones(S.size) if pieces is None else pieces.evaluate(S)
        for pieces in (ribbon.width_pieces, ribbon.thickness_pieces)
    ]
    energies = [
        held_flat(
            SimpleNamespace(values=lambda x, s=s: scene.growth.values(x, s)),
            ribbon.material.stiffness,
            ribbon.thickness_ratio * thickness,
            width,
        )
        for s, width, thickness in zip(S, *dimensions, strict=True)
    ]
    return energies @ w


# ---------------------------------------------------------------------------------------------- known cases


@pytest.mark.parametrize(
    "growth",
    [
        rb.growth.edge(0.0),
        rb.growth.Profile(gamma33=[0.05], gamma22=[0.03], gamma23=[0.02], g21=[0.04], g31=[-0.03]),
        rb.growth.Profile(gamma33=[0.02, 0.03, -0.1])
        + rb.growth.Profile(gamma33=[-0.02, -0.03, 0.1], name="less"),
        rb.growth.thickness(0.3),
    ],
    ids=["none", "the same everywhere", "cancelling", "a cylinder"],
)
def test_zero_where_growth_fits(growth):
    """Uniform growth only lengthens and shears; growth along it and through it rolls it up exactly."""
    assert unloaded(growth).neglected == pytest.approx(0.0, abs=1e-12)


def test_none_of_a_straight_ribbon_that_the_solver_knows_to_an_error():
    """What is left of the strains of the guess is no strain, so that no part of it is neglected."""
    state = rb.solve(rb.Scene(LEAF, end=rb.Clamped()), guess=[0.0, 0.0, 0.02, 0.01], tol=1e-4)
    assert state.neglected < 1e-6


def test_a_stretched_ribbon_by_hand():
    """Drawn out by eps: E33 = eps + eps^2/2, E22 = -nu eps + (nu eps)^2/2 against eps and -nu eps."""
    force = 0.02
    scene = rb.Scene(LEAF, end=rb.Free(force=(0.0, 0.0, force)))
    Q33, Q22, Q23, _ = LEAF.material.stiffness

    def norm(e33, e22):
        return np.sqrt(Q33 * e33**2 + 2 * Q23 * e33 * e22 + Q22 * e22**2)

    lost, kept = norm(force**2 / 2, (force / 2) ** 2 / 2), norm(force, -force / 2)
    assert rb.solve(scene).neglected == pytest.approx(lost / kept, rel=1e-8)


# ------------------------------------------------------------------------------------------------ how it goes


@pytest.mark.parametrize("omega", [0.0, 0.2], ids=["bent", "helical"])
def test_of_second_order_in_the_thickness(omega):
    """With growth in proportion to eta^2 strains are, and what is neglected is eta^4."""
    parts = [
        unloaded(
            rb.growth.edge(6 * eta**2) + rb.growth.chiral(2 * omega * eta**2), rb.Ribbon(10.0, 1.0, eta)
        ).neglected
        for eta in ETAS
    ]
    orders = np.log2(np.array(parts[:-1]) / parts[1:])
    # The next order is eta^4: what is missing to 2 falls to a quarter each time.
    missing = 2.0 - orders
    assert missing[0] < 0.07
    assert missing[1:] / missing[:-1] == pytest.approx(0.25, rel=0.05)


def test_in_proportion_to_strong_growth():
    """On a thin leaf the angles by which sections tilt count: Gauss's curvature is 8 xi, and tilts square."""
    thin = rb.Ribbon(10.0, 1.0, 0.001)
    parts = [unloaded(rb.growth.edge(xi), thin).neglected for xi in (0.01, 0.02, 0.04)]
    assert np.array(parts[1:]) / parts[:-1] == pytest.approx(2.0, rel=0.05)


def test_in_inverse_proportion_to_the_length_of_waves():
    """Growth across the ribbon, to and fro along it: sections curl up and down."""

    def curled(length):
        waves = rb.growth.thickness(0.0, lambda S: 0.01 * np.cos(2 * np.pi * S / length))
        return unloaded(waves, rb.Ribbon(40.0, 1.0, 0.01)).neglected

    parts = [curled(length) for length in (40.0, 20.0, 10.0)]
    assert np.array(parts[1:]) / parts[:-1] == pytest.approx(2.0, rel=0.02)


def test_grows_as_loads_get_closer():
    def pushed(waves):
        def force(S):
            return np.stack([1e-7 * np.sin(2 * np.pi * waves * S / 24), 0 * S, 0 * S], axis=-1)

        loads = [rb.LineLoad(force=force)]
        return rb.solve(rb.Scene(rb.Ribbon(24.0, 1.0, 0.05), end=rb.Clamped(), loads=loads)).neglected

    parts = [pushed(waves) for waves in (1, 2, 4)]
    assert (np.diff(parts) > 0).all()


def test_a_jump_counts_wherever_it_is():
    """It is spread over half a width, which stations do not miss; a longer ribbon shares it among more."""

    def jump(S, length=10.0):
        half = rb.growth.edge(([0, S, S, length], [0, 0, 0.06, 0.06]))
        with pytest.warns(rb.RibbonWarning, match="^neglected = "):
            return unloaded(half, rb.Ribbon(length, 1.0, 0.1)).neglected

    parts = np.array([jump(S) for S in (4.0, 4.03, 5.0, 5.11)])
    # of the square, as large on all, by the length that has grown
    assert parts**2 * (10 - np.array([4.0, 4.03, 5.0, 5.11])) == pytest.approx(parts[0] ** 2 * 6, rel=0.15)
    assert jump(10.0, 20.0) == pytest.approx(parts[2] / np.sqrt(2), rel=0.05)


def test_does_not_tell_mirror_images_apart():
    growth = rb.growth.edge(0.06)
    one, other = (state.neglected for state in rb.natural_shapes(LEAF, growth) if state.phase == "bent")
    assert one == pytest.approx(other, rel=1e-12)
    right, left = (unloaded(growth + rb.growth.chiral(d)).neglected for d in (0.04, -0.04))
    assert right == pytest.approx(left, rel=1e-10)


def test_does_not_depend_on_units_nor_on_the_dimensions_of_reference():
    growth = rb.growth.edge(0.06) + rb.growth.thickness(0.1)
    part = unloaded(growth).neglected
    assert unloaded(growth, rb.Ribbon(30.0, 3.0, 0.3, rb.Isotropic(Y=7.0))).neglected == pytest.approx(part)
    # Half the width, twice the thickness, all along: the gradient through it is in units of the width.
    halved = rb.Ribbon(
        20.0, 2.0, 0.05, width_profile=([0, 10], [0.5, 0.5]), thickness_profile=([0, 10], [2, 2])
    )
    growth = rb.growth.edge(0.06) + rb.growth.thickness(0.2)
    assert unloaded(growth, halved).neglected == pytest.approx(part, rel=1e-6)


def test_a_closed_band():
    ring, band = closed(), closed(link=0.5)
    assert 0.0 < ring.neglected < 0.02
    assert ring.neglected < band.neglected < STRETCHED


# --------------------------------------------------------------------------------------- warnings and errors


def test_warns_where_the_theory_is_stretched():
    with pytest.warns(rb.RibbonWarning, match=r"growth.size = 0.5"):
        state = unloaded(rb.growth.edge(0.5))
    with pytest.warns(rb.RibbonWarning, match=r"^neglected = 0\.[0-9]+: strains that the theory") as caught:
        part = state.neglected
    assert part > STRETCHED
    assert caught[0].filename == __file__
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert state.neglected == part  # once is enough


def test_a_law_of_its_own_has_no_sections():
    scene = rb.Scene(
        LEAF, end=rb.Free(force=(1e-6, 0, 0)), law=rb.LinearLaw(EA=1, EI1=1 / 12, EI2=1e-3, GJ=1e-3)
    )
    with pytest.raises(rb.InputError, match=r"^law = "):
        rb.solve(scene).neglected  # noqa: B018


@pytest.mark.parametrize("law", ["quadratic", "linear"])
def test_other_laws_have_the_sections_of_the_full_one(law):
    growth = rb.growth.edge(0.02)
    part = rb.solve(rb.Scene(LEAF, growth, law=law)).neglected
    assert part == pytest.approx(unloaded(growth).neglected, rel=1e-9)


def test_of_thin_ribbons_and_of_growth_in_pieces():
    thin = rb.Ribbon(10.0, 1.0, 1e-6)
    assert 0.0 < unloaded(rb.growth.edge(0.06), thin).neglected < STRETCHED
    step = rb.growth.Profile(gamma33=[[0.0], [0.02]], breaks=[0.1])
    x = np.linspace(-0.5, 0.5, 101)
    smooth = rb.growth.Profile(gamma33=(x, 0.02 / (1 + np.exp(-(x - 0.1) / 0.005))))
    assert unloaded(step).neglected == pytest.approx(unloaded(smooth).neglected, rel=0.02)
