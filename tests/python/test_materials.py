"""What the material decides: thresholds found by bisection on natural shapes, against formulas.

docs/materials.md derives the formulas. xi is edge growth over eta^2, omega natural twist over eta, rho is
Q23/(Q33 Q22)^(1/2), Gamma is 2 G/((Q33 Q22)^(1/2) - Q23). Thresholds agree to some 1e-12 of themselves: an
eigenvalue counts as negative below -1e-13.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import mpmath
import numpy as np
import pytest
import ribbonrs as rb
from ribbonrs.material import Material

# Shapes closer than 1e-6 in K/eta are reported as one, as happens beside every threshold.
pytestmark = pytest.mark.filterwarnings("ignore::ribbonrs.RibbonWarning")

ETA = 1e-3  # so small that the growth of every case is small
NUS = [0.0, 0.1, 0.3, 0.45, 0.5]
AUXETIC = [-0.3, -0.9, -0.99]
# Q22/E33, Q23/Q22: fibres along, fibres across, strong coupling, auxetic
ORTHOTROPIC = [(0.05, 0.3), (4.0, 0.1), (1.5, 0.8), (0.7, -0.6)]


def shapes(material: Material, xi: float = 0.0, omega: float = 0.0) -> dict[str, rb.State]:
    """The natural shapes by phase; of mirror images that of K2 > 0, then K3 > 0."""
    growth = rb.growth.edge(xi * ETA**2) + rb.growth.chiral(2 * omega * ETA)
    states = rb.natural_shapes(rb.Ribbon(length=10.0, width=1.0, thickness=ETA, material=material), growth)
    return {state.phase: state for state in reversed(states)}


def crossing(true_above: Callable[[float], bool], low: float, high: float) -> float:
    """Where a statement turns true, by bisection."""
    assert not true_above(low)
    assert true_above(high)
    for _ in range(50):
        middle = (low + high) / 2
        low, high = (low, middle) if true_above(middle) else (middle, high)
    return high


def loses(material: Material, phase: str, index: int, low: float, high: float) -> float:
    """Growth at which a phase has that many unstable directions."""
    return crossing(lambda xi: shapes(material, xi)[phase].section_index >= index, low, high)


def orthotropic(transverse: float, nu: float, gamma: float) -> rb.Orthotropic:
    """A material of Young's modulus 1 along the ribbon, of given Q22, Q23/Q22 and Gamma."""
    Q33, Q23 = 1.0 + nu**2 * transverse, nu * transverse
    return rb.Orthotropic(Q33, transverse, Q23, gamma * (math.sqrt(Q33 * transverse) - Q23) / 2)


def bends(transverse: float, nu: float, sign: int = 1) -> float:
    """The root of X^2 + 126 nu beta^2 X = 472.5 beta^2, 12 beta^2 = Q22/E33, of that sign."""
    half = 63 * nu * transverse / 12
    return -half + sign * math.sqrt(half**2 + 472.5 * transverse / 12)


def critical(transverse: float, nu: float) -> float:
    """Gamma below which an edge-grown ribbon twists."""
    rho = nu * math.sqrt(transverse / (1 + nu**2 * transverse))
    return (1 + rho) / (rho + math.sqrt((10 - 3 * rho**2) / 7))


# --------------------------------------------------------------------------------------- isotropic materials


@pytest.mark.parametrize("nu", NUS)
def test_edge_growth_bends_before_it_could_twist(nu: float) -> None:
    material = rb.Isotropic(nu=nu)
    bend = (math.sqrt((504 * nu) ** 2 + 362880 * (1 - nu**2)) - 504 * nu) / (96 * (1 - nu**2))
    assert loses(material, "flat", 1, 1.0, 20.0) == pytest.approx(bend, rel=1e-11)
    assert loses(material, "flat", 2, 1.0, 20.0) == pytest.approx(7.5 / (1 + nu), rel=1e-11)
    assert crossing(lambda xi: "bent" in shapes(material, xi), 1.0, 20.0) == pytest.approx(bend, rel=1e-10)
    assert crossing(lambda xi: "twisted" in shapes(material, xi), 1.0, 20.0) == pytest.approx(
        7.5 / (1 + nu), rel=1e-10
    )
    for xi in (1.001 * bend, 9.0, 100.0, 1e4):
        assert [phase for phase, state in shapes(material, xi).items() if state.stable] == ["bent"]


@pytest.mark.parametrize("nu", AUXETIC)
def test_auxetic_materials(nu: float) -> None:
    """Stiff in shear: both thresholds move out as 1/(1 + nu), bending to 0.7 of where twist would come."""
    material, transverse = rb.Isotropic(nu=nu), 1 / (1 - nu**2)
    bend, twist = bends(transverse, nu), 7.5 / (1 + nu)
    assert loses(material, "flat", 1, 1.0, 2 * twist) == pytest.approx(bend, rel=1e-11)
    assert loses(material, "flat", 2, 1.0, 2 * twist) == pytest.approx(twist, rel=1e-11)
    assert 0.7 < bend / twist < 0.84
    if nu == -0.99:
        assert bend / twist == pytest.approx(0.7, abs=2e-3)


@pytest.mark.parametrize("nu", [-0.9, -0.3, *NUS])
def test_growth_of_the_middle_makes_a_dome(nu: float) -> None:
    """It bends at the mirror image of the edge threshold with -nu, and never twists.

    The section curves to the same side as the ribbon; where the edges grow, to the other: a saddle.
    """
    material, transverse = rb.Isotropic(nu=nu), 1 / (1 - nu**2)
    onset = -bends(transverse, nu, -1)
    assert onset == pytest.approx(bends(transverse, -nu), rel=1e-15)
    found = crossing(lambda xi: shapes(material, -xi)["flat"].section_index > 0, 1.0, 100.0)
    assert found == pytest.approx(onset, rel=1e-11)
    for xi in (-1.001 * onset, -3 * onset, -1e4):
        states = shapes(material, xi)
        assert set(states) == {"flat", "bent"}
        assert states["bent"].stable
        assert states["bent"].strain[2] * states["bent"].deflection(0.0, 2)[0] > 0.0
    saddle = shapes(material, 1.5 * bends(transverse, nu))["bent"]
    assert saddle.strain[2] * saddle.deflection(0.0, 2)[0] < 0.0


# (kappa0/t)^(1/2) w at which the helicoid coils: the numbers in print, and others from the formula alone.
@pytest.mark.parametrize(
    ("nu", "printed"),
    [(0.0, 3.607360), (0.3, 4.525635), (0.5, 5.639733), (0.1, None), (0.45, None), (-0.5, None)],
)
def test_a_chiral_ribbon_coils_when_it_is_wide(nu: float, printed: float | None) -> None:
    """Natural twist kappa0 alone: width w, thickness t, so that omega = kappa0 w^2/t."""
    found = crossing(lambda omega: "helical" in shapes(rb.Isotropic(nu=nu), omega=omega), 1.0, 100.0)
    p = 42 * nu / (1 - nu**2)
    q = math.sqrt(p + math.sqrt(p**2 + 2520 / (1 - nu**2)))  # K3/eta there
    assert found == pytest.approx(q + q**3 * (1 + nu) / 60, rel=1e-11)
    if printed is not None:
        assert math.sqrt(found) == pytest.approx(printed, abs=6e-7)
    below = shapes(rb.Isotropic(nu=nu), omega=found * (1 - 1e-9))
    assert set(below) == {"twisted"}
    assert below["twisted"].strain[3] / ETA == pytest.approx(q, rel=1e-8)
    # The helix has the handedness of the helicoid that it came from.
    assert shapes(rb.Isotropic(nu=nu), omega=1.1 * found)["helical"].strain[3] > 0.0


def test_the_natural_twist_is_that_of_a_narrow_ribbon() -> None:
    """kappa0 a = d23/2: where the growth is too weak to stretch the ribbon it takes just that twist."""
    for nu in NUS:
        state = shapes(rb.Isotropic(nu=nu), omega=1e-3)["twisted"]
        # q + q^3 (1 + nu)/60 = omega
        assert state.strain[3] == pytest.approx(1e-3 * ETA * (1 - 1e-6 * (1 + nu) / 60), rel=1e-10)


# ----------------------------------------------------------------------------------- one law, several names

STRAINS = np.random.default_rng(5).normal(size=(50, 4)) * [0.01, 0.01, 0.5, 0.5]
GROWTH = rb.growth.Profile(gamma33=[0.01, 0.02, 0.2, 0.1], d33=[0.3, 0.1], d22=[-0.2], d23=[0.1, 0.2])


def test_mooney_rivlin_is_the_incompressible_isotropic_law() -> None:
    """Y = 6 (c1 + c2); forces scale with Y, the law does not."""
    rubber, isotropic = rb.MooneyRivlin(c1=0.4, c2=-0.15), rb.Isotropic(Y=1.5, nu=0.5)
    assert rubber.Y == isotropic.Y == 1.5
    for growth in (GROWTH, rb.growth.edge(0.06) + rb.growth.chiral(0.04)):
        a, b, unit = (rb.SectionLaw(0.1, growth, m) for m in (rubber, isotropic, rb.Isotropic()))
        np.testing.assert_array_equal(a.energy(STRAINS), b.energy(STRAINS))
        np.testing.assert_array_equal(a.gradient(STRAINS), b.gradient(STRAINS))
        np.testing.assert_array_equal(a.hessian(STRAINS), b.hessian(STRAINS))
        # The ratios of the constants are rounded anew; the energy is a sum of squares.
        np.testing.assert_allclose(a.energy(STRAINS), unit.energy(STRAINS), rtol=4e-15)


@pytest.mark.parametrize("nu", [*AUXETIC, *NUS])
def test_orthotropic_with_isotropic_constants_is_isotropic(nu: float) -> None:
    isotropic = rb.Isotropic(Y=3.0, nu=nu)
    same = rb.Orthotropic(*isotropic.stiffness)
    for growth in (GROWTH, rb.growth.edge(0.06) + rb.growth.chiral(0.04)):
        a, b = rb.SectionLaw(0.1, growth, isotropic), rb.SectionLaw(0.1, growth, same)
        np.testing.assert_array_equal(a.energy(STRAINS), b.energy(STRAINS))
        np.testing.assert_array_equal(a.hessian(STRAINS), b.hessian(STRAINS))


def test_laws_of_neighbouring_materials_are_neighbours() -> None:
    """Nothing special happens at nu = 0: the law is smooth there."""
    laws = [rb.SectionLaw(0.1, GROWTH, rb.Isotropic(nu=nu)) for nu in (-1e-5, 0.0, 1e-5)]
    below, at, above = (law.energy(STRAINS) for law in laws)
    # The second difference is that of a smooth function, of the size of the energy, in steps of 1e-5.
    np.testing.assert_allclose((below + above) / 2, at, rtol=1e-9)
    assert np.all(np.abs(above - below) > 1e-9 * at)


@pytest.mark.parametrize("gamma", [0.4, 0.9, 1.3])
def test_rho_and_gamma_are_all_that_matters_to_edge_growth(gamma: float) -> None:
    """In units of beta: xi/beta, K3^2/beta and K2/beta depend on rho and Gamma alone, Pi/beta^2 too."""
    scaled = []
    for transverse in (0.02, 1.0, 6.0):
        rho = 0.3
        nu = rho / math.sqrt((1 - rho**2) * transverse)
        beta = math.sqrt(transverse / 12)
        states = shapes(orthotropic(transverse, nu, gamma), 150.0 * beta)
        scaled.append(
            {
                phase: (
                    s.section_index,
                    s.energy / beta**2 / ETA**4,
                    s.strain[2] / beta,
                    s.strain[3] ** 2 / beta,
                )
                for phase, s in states.items()
            }
        )
    for other in scaled[1:]:
        assert set(other) == set(scaled[0])
        for phase, numbers in other.items():
            np.testing.assert_allclose(numbers, scaled[0][phase], rtol=1e-11, err_msg=phase)


# ---------------------------------------------------------------------------------------------- orthotropy


@pytest.mark.parametrize(("transverse", "nu"), ORTHOTROPIC)
def test_thresholds_of_orthotropic_ribbons(transverse: float, nu: float) -> None:
    for gamma in (0.3, 1.0, 3.0):
        material = orthotropic(transverse, nu, gamma)
        first, second = sorted([bends(transverse, nu), 15 * material.G])
        assert loses(material, "flat", 1, first / 2, 2 * second) == pytest.approx(first, rel=1e-11)
        assert loses(material, "flat", 2, first / 2, 2 * second) == pytest.approx(second, rel=1e-11)


@pytest.mark.parametrize("beyond", [1.01, 3.0, 100.0])
@pytest.mark.parametrize(("transverse", "nu"), ORTHOTROPIC)
def test_twist_is_stable_where_it_comes_first_and_however_far(
    transverse: float, nu: float, beyond: float
) -> None:
    """The stability of the twisted shape against bending depends on G, not on how much has grown."""

    def unstable(gamma: float) -> bool:
        material = orthotropic(transverse, nu, gamma)
        return shapes(material, 15 * material.G * beyond)["twisted"].section_index > 0

    expected = critical(transverse, nu)
    assert crossing(unstable, 0.1, 2.0) == pytest.approx(expected, rel=1e-10)
    twists = 15 * orthotropic(transverse, nu, expected).G
    assert twists == pytest.approx(bends(transverse, nu), rel=1e-14)


@pytest.mark.parametrize(("transverse", "nu"), ORTHOTROPIC)
def test_a_ribbon_weak_in_shear_twists_and_nothing_else(transverse: float, nu: float) -> None:
    material = orthotropic(transverse, nu, 0.99 * critical(transverse, nu))
    g = material.G / 6
    for beyond in (1.001, 2.0, 1000.0):
        xi = 90 * g * beyond
        states = shapes(material, xi)
        assert [phase for phase, state in states.items() if state.stable] == ["twisted"]
        assert states["twisted"].strain[3] ** 2 / ETA**2 == pytest.approx(8 * (xi - 90 * g), rel=1e-12)
        assert states["twisted"].energy / ETA**4 == pytest.approx(8 * g * xi - 360 * g**2, rel=1e-12)


def inverse_sigma(s: mpmath.mpf) -> mpmath.mpf:
    """1/sigma as a function of z^4."""
    z = mpmath.root(s, 4)
    tau = 2 / z * (mpmath.cosh(z) - mpmath.cos(z)) / (mpmath.sinh(z) + mpmath.sin(z))
    return s / (1 - tau)


def test_the_helix_is_one_shape_at_most() -> None:
    """Its condition is that d(1/sigma)/d(z^4), which falls from 10/7 to 1, has a certain value."""
    with mpmath.workdps(40):
        slopes = [float(mpmath.diff(inverse_sigma, mpmath.mpf(10) ** (n / 4))) for n in range(-12, 60)]
    assert np.all(np.diff(slopes) < 0.0)
    assert slopes[0] == pytest.approx(10 / 7, rel=1e-6)
    assert 1.0 < slopes[-1] < 1.001


@pytest.mark.parametrize(("transverse", "nu"), ORTHOTROPIC)
@pytest.mark.parametrize("part", [0.1, 0.4])
def test_between_the_two_moduli_the_bent_ribbon_coils(transverse: float, nu: float, part: float) -> None:
    """For Gamma between its critical value and 1 bending is followed by a helix, of one and the same K2."""
    limit = critical(transverse, nu)
    material = orthotropic(transverse, nu, limit + part * (1 - limit))
    beta2, g = transverse / 12, material.G / 6
    with mpmath.workdps(30):
        level = beta2 * (1 - 24 * g * nu) / (12 * g**2)
        s = mpmath.findroot(lambda s: mpmath.diff(inverse_sigma, s) - level, (1.0, 1e4), solver="anderson")
        k = float(2 * mpmath.sqrt(beta2 * s))
        onset = float(nu * k**2 + 4 * g * inverse_sigma(s)) / 8
    assert onset > bends(transverse, nu)
    low = 1.01 * bends(transverse, nu)
    assert crossing(lambda xi: "helical" in shapes(material, xi), low, 2 * onset) == pytest.approx(
        onset, rel=1e-11
    )
    # The bent shape softens slowly: an eigenvalue of -1e-13 is 2e-10 in growth.
    assert loses(material, "bent", 1, low, 2 * onset) == pytest.approx(onset, rel=1e-9)
    for beyond in (1.1, 3.0, 30.0):
        states = shapes(material, onset * beyond)
        assert [phase for phase, state in states.items() if state.stable] == ["helical"]
        assert states["helical"].strain[2] / ETA == pytest.approx(k, rel=1e-12)
    before = shapes(material, onset * 0.9)
    assert [phase for phase, state in before.items() if state.stable] == ["bent"]


@pytest.mark.parametrize(("transverse", "nu"), ORTHOTROPIC)
@pytest.mark.parametrize("gamma", [1.0, 1.001, 2.0])
def test_from_hubers_modulus_on_the_ribbon_bends_and_nothing_else(
    transverse: float, nu: float, gamma: float
) -> None:
    material = orthotropic(transverse, nu, gamma)
    for xi in (1.01 * bends(transverse, nu), 100.0, 1e4):
        assert [phase for phase, state in shapes(material, xi).items() if state.stable] == ["bent"]


@pytest.mark.parametrize(("transverse", "nu"), ORTHOTROPIC)
def test_wide_ribbons_prefer_twist_below_hubers_modulus(transverse: float, nu: float) -> None:
    """Energy per growth as xi -> infinity: 8 g twisted, (2/3) ((Q33 Q22)^(1/2) - Q23)/E33 bent."""
    material = orthotropic(transverse, nu, 1.0)
    xi = np.array([1e3, 5e3, 2.5e4, 1e5])
    energy = [shapes(material, x)["bent"].energy / ETA**4 for x in xi.tolist()]
    # Edge layers, of width K2^(-1/2), add a series in xi^(-1/4): fitted to three terms, and to 1e-4 by that.
    slope = np.linalg.solve(xi[:, None] ** [1.0, 0.75, 0.5, 0.25], energy)[0]
    expected = 2 / 3 * (math.sqrt(material.Q33 * material.Q22) - material.Q23)
    assert slope == pytest.approx(expected, rel=1e-4)
    twisted = 8 * material.G / 6
    assert twisted == pytest.approx(expected, rel=1e-15)


def test_middle_growth_never_twists_whatever_the_shear_modulus() -> None:
    for transverse, nu in ORTHOTROPIC:
        for gamma in (0.01, 0.9, 3.0):
            material, onset = orthotropic(transverse, nu, gamma), bends(transverse, nu, -1)
            assert set(shapes(material, 0.999 * onset)) == {"flat"}
            for beyond in (1.001, 3.0, 100.0):
                states = shapes(material, beyond * onset)
                assert set(states) == {"flat", "bent"}
                assert states["bent"].stable
