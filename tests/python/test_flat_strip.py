"""When a flat strip with growing edges buckles: the section law against the equations of a plate."""

import math
from itertools import pairwise

import numpy as np
import pytest
import ribbonrs as rb
from foppl_von_karman import INCOMPRESSIBLE, isotropic, threshold
from scipy.optimize import brentq, minimize_scalar

WAVES = np.array([0.0, 0.02, 0.1, 0.3, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0])
ORTHOTROPIC = [(1.5, 0.8, 0.3, 0.25), (0.6, 1.4, -0.2, 0.5), (9.0, 0.5, 0.4, 0.1)]
MATERIALS = {
    **{f"nu={nu}": (rb.Isotropic(nu=nu), isotropic(nu)) for nu in (-0.5, 0.0, 0.3, 0.5)},
    **{f"Q={Q}": (rb.Orthotropic(*Q), Q) for Q in ORTHOTROPIC},
}

each_material = pytest.mark.parametrize(("material", "stiffness"), MATERIALS.values(), ids=MATERIALS.keys())


def of_section_law(material, strain, low, high, eta=1e-2):
    """The xi/eta^2 in (low, high) at which the stiffness of the flat section against a strain vanishes."""

    def stiffness(xi):
        law = rb.SectionLaw(eta, rb.growth.edge(xi * eta**2), material)
        return law.hessian([xi * eta**2 / 3, 0.0, 0.0, 0.0])[strain, strain] / eta**2

    return brentq(stiffness, low, high, xtol=1e-13, rtol=1e-14)


def test_thresholds_of_the_incompressible_strip():
    assert threshold(0.0, False) == pytest.approx((math.sqrt(259) - 7) / 2, rel=1e-13)
    assert threshold(0.0, True) == pytest.approx(5.0, rel=1e-13)
    # to the figures given
    for k, bend, twist in ((0.02, 4.5469, 5.0001), (1.0, 4.9674, 5.3378)):
        assert threshold(k, False) == pytest.approx(bend, abs=5e-5)
        assert threshold(k, True) == pytest.approx(twist, abs=5e-5)


@each_material
def test_long_waves_have_the_thresholds_of_the_section_law(material, stiffness):
    """Bending, twist, and bending under growth of the middle; both sides are good to rounding."""
    for strain, twist, middle in ((2, False, False), (3, True, False), (2, False, True)):
        exact = threshold(0.0, twist, stiffness, middle=middle)
        bracket = sorted((0.9 * exact, 1.1 * exact))
        assert of_section_law(material, strain, *bracket) == pytest.approx(exact, rel=1e-11)


@each_material
def test_shorter_waves_come_later_by_a_part_of_order_k_squared(material, stiffness):
    for twist in (False, True):
        limit, *later = (threshold(k, twist, stiffness) for k in (0.0, 0.01, 0.02))
        rise = np.array(later) / limit - 1
        # The next order is k^4, a part of 1e-3 of this or less; 1e-4 is what rounding leaves of `rise`.
        assert rise[1] / rise[0] == pytest.approx(4.0, rel=2e-3)


@each_material
def test_the_first_wave_of_growing_edges_is_the_longest(material, stiffness):
    """What a one-dimensional model presumes."""
    first = [min(threshold(k, twist, stiffness, 16) for twist in (False, True)) for k in WAVES]
    assert (np.diff(first) > 0).all()


@pytest.mark.parametrize("nu", [-0.5, 0.0, 0.3, 0.5])
def test_in_isotropic_strips_each_kind_of_wave_comes_first_where_it_is_longest(nu):
    for twist, middle in ((False, False), (True, False), (False, True)):
        growth = [abs(threshold(k, twist, isotropic(nu), 16, middle)) for k in WAVES]
        assert (np.diff(growth) > 0).all()


def test_soft_in_shear_waves_of_bending_come_earlier_if_short_but_after_twist():
    soft = (1.0, 1.0, 0.0, 0.015)
    short, long = threshold(2.0, False, soft), threshold(0.0, False, soft)
    assert threshold(0.0, True, soft) < 0.1 * short < 0.1 * long


@pytest.mark.parametrize("twist", [False, True])
@pytest.mark.parametrize("k", [0.02, 1.0, 5.0])
def test_twelve_functions_are_enough(k, twist):
    exact = threshold(k, twist, terms=24)
    errors = [abs(threshold(k, twist, terms=terms) / exact - 1) for terms in (2, 4, 6, 8, 12)]
    assert errors[-1] < 1e-10
    # spectral: faster than any power, until rounding
    assert all(later < max(earlier / 30, 1e-12) for earlier, later in pairwise(errors))


@pytest.mark.parametrize("k", [0.02, 0.7, 3.0])
def test_one_function_is_the_best_parabola(k):
    """The quotient of the energies of w = 1 + b x^2, integrated as polynomials, at the best b."""
    Q33, Q22, Q23, G = INCOMPRESSIBLE
    x = np.polynomial.Polynomial([0.0, 1.0])

    def integral(p):
        return p.integ()(0.5) - p.integ()(-0.5)

    def softening_over_bending(b):
        w = 1 + b * k**2 * x**2
        density = Q33 * k**4 * w**2 - 2 * Q23 * k**2 * w * w.deriv(2) + Q22 * w.deriv(2) ** 2
        bending = integral(density + 4 * G * k**2 * w.deriv() ** 2) / 24
        return k**2 * integral((4 * x**2 - 1 / 3) * w**2) / 2 / bending

    best = minimize_scalar(lambda b: -softening_over_bending(b), bounds=(0, 10), options={"xatol": 1e-8})
    # at an extremum the error of b enters squared; 1e-9 is what cancels in int (4 x^2 - 1/3) w^2 at k = 0.02
    assert threshold(k, False, terms=1) == pytest.approx(1 / softening_over_bending(best.x), rel=1e-9)
