"""The section law as the user sees it: shapes, broadcasting, names and refusals."""

import math

import numpy as np
import pytest
import ribbonrs as rb
from refusal import NOT_FINITE, NOT_NUMBERS, refuses

GROWTH = rb.growth.edge(0.05) + rb.growth.chiral(0.02)
STRAIN = np.array([0.01, 0.002, 0.2, 0.3])


@pytest.fixture(scope="module")
def law():
    return rb.SectionLaw(thickness_ratio=0.1, growth=GROWTH)


@pytest.mark.parametrize("shape", [(), (1,), (5,), (2, 3), (2, 1, 3), (0,), (3, 0)])
def test_leading_axes_carry_over(law, shape):
    rng = np.random.default_rng(0)
    strains = STRAIN + 0.1 * rng.standard_normal((*shape, 4))
    energy, gradient, hessian = law.energy(strains), law.gradient(strains), law.hessian(strains)
    assert energy.shape == shape
    assert gradient.shape == (*shape, 4)
    assert hessian.shape == (*shape, 4, 4)
    for index in np.ndindex(*shape):
        assert energy[index] == law.energy(strains[index])
        assert np.array_equal(gradient[index], law.gradient(strains[index]))
        assert np.array_equal(hessian[index], law.hessian(strains[index]))


def test_gradient_and_hessian_are_those_of_the_energy(law):
    step = 1e-4
    ends = np.concatenate([STRAIN + step * np.eye(4), STRAIN - step * np.eye(4)])
    energy, gradient = law.energy(ends), law.gradient(ends)
    # central differences: relative error step^2 times third derivatives over first, here below 1e-4
    assert (energy[:4] - energy[4:]) / (2 * step) == pytest.approx(law.gradient(STRAIN), rel=1e-3, abs=1e-8)
    assert (gradient[:4] - gradient[4:]) / (2 * step) == pytest.approx(
        law.hessian(STRAIN), rel=1e-3, abs=1e-6
    )


def test_any_memory_layout_and_real_type(law):
    strains = np.tile(STRAIN, (6, 1))
    expected = law.energy(strains)
    for same in (
        np.asfortranarray(strains),
        strains[::-1],
        np.repeat(strains, 2, axis=0)[::2],
        strains.tolist(),
        strains.astype(np.longdouble),
    ):
        assert np.array_equal(law.energy(same), expected)
    assert law.energy([0, 0, 0, 0]) == law.energy(np.zeros(4, dtype=np.int8))
    assert law.energy(strains.astype(np.float32)) == pytest.approx(expected, rel=1e-5)


def test_arguments_are_not_changed(law):
    strains = np.tile(STRAIN, (3, 1))
    strains.setflags(write=False)
    law.energy(strains)
    law.gradient(strains)
    law.hessian(strains)
    assert np.array_equal(strains, np.tile(STRAIN, (3, 1)))


def test_the_deflection_takes_x_of_any_shape(law):
    x = np.linspace(-0.5, 0.5, 12)
    flat = law.deflection(STRAIN, x)
    for shape in ((12,), (3, 4), (2, 1, 6)):
        assert np.array_equal(law.deflection(STRAIN, x.reshape(shape)), flat.reshape(shape))
        assert law.displacements(STRAIN, x.reshape(shape)).shape == (*shape, 3)
    assert law.deflection(STRAIN, 0.5).shape == ()
    assert law.deflection(STRAIN, []).shape == (0,)
    assert np.array_equal(law.displacements(STRAIN, x)[:, 0], flat)


def test_derivatives_of_the_deflection(law):
    x, step = np.linspace(-0.49, 0.49, 9), 1e-4
    for order in (1, 2):
        below, above = (law.deflection(STRAIN, x + d, order - 1) for d in (-step, step))
        # relative error step^2 / 6 times the third derivative over the first: below 1e-5
        expected = law.deflection(STRAIN, x, order)
        assert (above - below) / (2 * step) == pytest.approx(expected, abs=1e-5 * np.abs(expected).max())


def test_displacements_have_no_mean(law):
    nodes, weights = np.polynomial.legendre.leggauss(40)
    moved = law.displacements(STRAIN, nodes / 2)
    assert np.abs(weights @ moved).max() <= 1e-14
    assert abs((weights * nodes) @ moved[:, 0]) <= 1e-14


def test_names(law):
    assert law.form == "closed"
    assert rb.SectionLaw(0.1, rb.growth.Profile(gamma33=[0.0, 0.0, 0.0, 0.01])).form == "general"
    assert rb.SectionLaw(0.1, GROWTH, law="quadratic").form == "second-order"
    assert (law.thickness_ratio, law.law, law.growth) == (0.1, "full", GROWTH)
    assert law.material == rb.Isotropic()


def test_the_unit_of_stress_drops_out():
    soft, hard = (rb.SectionLaw(0.1, GROWTH, rb.Isotropic(Y=Y, nu=0.3)) for Y in (1.0, 2e11))
    assert hard.energy(STRAIN) == pytest.approx(soft.energy(STRAIN), rel=1e-14)
    rubber = rb.SectionLaw(0.1, GROWTH, rb.MooneyRivlin(c1=0.2, c2=0.3))
    assert rubber.energy(STRAIN) == pytest.approx(rb.SectionLaw(0.1, GROWTH).energy(STRAIN), rel=1e-14)


@pytest.mark.parametrize("bad", [*NOT_FINITE, *NOT_NUMBERS, 0.0, -0.1, 1.0, 2.0])
def test_thickness_ratios_refused(bad):
    refuses("thickness_ratio", lambda: rb.SectionLaw(bad, GROWTH))


@pytest.mark.parametrize("bad", [None, 0.06, "edge", {"gamma33": [0.0, 0.0, 0.24]}])
def test_growths_refused(bad):
    refuses("growth", lambda: rb.SectionLaw(0.1, bad))


@pytest.mark.parametrize("bad", [1.0, "rubber", (1.0, 0.5), rb.Isotropic])
def test_materials_refused(bad):
    refuses("material", lambda: rb.SectionLaw(0.1, GROWTH, bad))


@pytest.mark.parametrize("bad", ["auto", "", "Full", None, 1, ["full"], np.array([1.0, 2.0])])
def test_laws_refused(bad):
    refuses("law", lambda: rb.SectionLaw(0.1, GROWTH, law=bad))


@pytest.mark.parametrize(
    "growth", [rb.growth.thickness(0.1), rb.growth.Profile(gamma33=[0.0, 0.0, 0.0, 0.01])]
)
def test_growth_that_the_quadratic_law_cannot_represent(growth):
    refuses("law", lambda: rb.SectionLaw(0.1, growth, law="quadratic"))


METHODS = ("energy", "gradient", "hessian")


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize(
    ("field", "bad"),
    [
        ("strains.shape", 1.0),
        ("strains.shape", [0.0, 0.0, 0.0]),
        ("strains.shape", np.zeros((4, 3))),
        ("strains.shape", []),
        ("strains[2]", [0.0, 0.0, math.nan, 0.0]),
        ("strains[1, 3]", [[0.0] * 4, [0.0, 0.0, 0.0, -math.inf]]),
        ("strains", [0.0, 0.0, 0.0, 1j]),
        ("strains", "0000"),
        ("strains", [True, False, True, False]),
        ("strains", None),
        ("strains", [[0.0] * 4, [0.0] * 3]),
        ("strains", [10**400, 0, 0, 0]),
        ("strains", object()),
    ],
)
def test_strains_refused(law, method, field, bad):
    refuses(field, lambda: getattr(law, method)(bad))


@pytest.mark.parametrize("method", METHODS)
def test_a_section_along_the_ribbon_is_that_of_its_growth_there(method):
    """To the rounding of the amplitude: nothing is interpolated between sections."""
    varying = rb.SectionLaw(0.1, rb.growth.edge(([0.0, 4.0], [0.0, 0.08])) + rb.growth.chiral(0.02))
    strains, S = np.tile(STRAIN, (3, 2, 1)), np.array([[0.5, 2.0], [2.5, 3.0], [0.0, 4.0]])
    along = getattr(varying, method)(strains, S=S)
    for place in np.ndindex(S.shape):
        there = rb.SectionLaw(0.1, rb.growth.edge(0.02 * S[place]) + rb.growth.chiral(0.02))
        np.testing.assert_allclose(along[place], getattr(there, method)(STRAIN), rtol=4e-15, atol=1e-18)


@pytest.mark.parametrize("method", METHODS)
def test_where_along_the_ribbon_may_be_said_for_uniform_growth_too(law, method):
    np.testing.assert_array_equal(getattr(law, method)(STRAIN, S=3.0), getattr(law, method)(STRAIN))


def test_one_strain_at_many_places():
    varying = rb.SectionLaw(0.1, rb.growth.edge(lambda S: 0.01 * S))
    assert varying.energy(STRAIN, S=np.linspace(0.0, 30.0, 7)).shape == (7,)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize(
    ("field", "S"), [("S", None), ("S", 4.5), ("S", -0.1), ("S", np.nan), ("S.shape", [0.0, 1.0]), ("S", "0")]
)
def test_places_along_the_ribbon_refused(method, field, S):
    varying = rb.SectionLaw(0.1, rb.growth.edge(([0.0, 4.0], [0.0, 0.08])))
    refuses(field, lambda: getattr(varying, method)(np.tile(STRAIN, (3, 1)), S=S))


@pytest.mark.parametrize(
    ("field", "arguments"),
    [
        ("strain.shape", ([[0.0] * 4], [0.0])),
        ("strain.shape", ([0.0] * 3, [0.0])),
        ("strain[0]", ([math.nan, 0.0, 0.0, 0.0], [0.0])),
        ("x", ([0.0] * 4, [0.0, 0.51])),
        ("x", ([0.0] * 4, -0.6)),
        ("x[0]", ([0.0] * 4, [math.nan])),
        ("x", ([0.0] * 4, "0")),
        ("derivative", ([0.0] * 4, [0.0], 3)),
        ("derivative", ([0.0] * 4, [0.0], -1)),
        ("derivative", ([0.0] * 4, [0.0], 1.0)),
        ("derivative", ([0.0] * 4, [0.0], True)),
    ],
)
def test_deflections_refused(law, field, arguments):
    refuses(field, lambda: law.deflection(*arguments))


def test_the_quadratic_law_has_no_deflection():
    quadratic = rb.SectionLaw(0.1, GROWTH, law="quadratic")
    refuses("law", lambda: quadratic.deflection(STRAIN, 0.0))
    refuses("law", lambda: quadratic.displacements(STRAIN, 0.0))


def test_masked_strains_are_refused(law):
    masked = np.ma.masked_array(STRAIN, mask=[False, True, False, False])
    refuses("strains", lambda: law.energy(masked))


def test_a_function_is_not_asked_beyond_the_places_asked_for():
    """A function of S known up to 0.7 only."""
    growth = rb.growth.edge(lambda S: np.where(S <= 0.7, 0.06 + 0.01 * S, np.nan))
    varying = rb.SectionLaw(0.1, growth)
    for S in (0.3, 0.6, 0.7):
        there = rb.SectionLaw(0.1, rb.growth.edge(0.06 + 0.01 * S))
        assert varying.energy(STRAIN, S=S) == pytest.approx(there.energy(STRAIN), rel=1e-13)


@pytest.mark.parametrize("method", ["deflection", "displacements"])
def test_a_section_is_at_one_place(law, method):
    varying = rb.SectionLaw(0.1, rb.growth.edge(([0.0, 4.0], [0.0, 0.08])))
    for one in (law, varying):
        refuses("S", lambda one=one: getattr(one, method)(STRAIN, [0.1], S=[1.0, 2.0]))
