"""`ribbonrs.analytic` against mpmath and the closed forms' own identities."""

from __future__ import annotations

import doctest

import numpy as np
import pytest
import reference as ref
from mpmath import mp, mpf
from ribbonrs import InputError, analytic

GRID = [0.0, 1e-12, -1e-8, 1e-4, 0.01, -0.3, 1.0, 5.0, 7.46, 10.6, 10.7, -11.0, 40.0, -4e3, 1e6]
ETA = 0.1


def test_examples_in_the_docstrings() -> None:
    failed, tried = doctest.testmod(analytic)
    assert tried > 6
    assert failed == 0


@pytest.mark.parametrize("k2", GRID)
@pytest.mark.parametrize("k3", [0.0, 2.0, -30.0])
def test_twist_energy_equals_the_printed_formula(k2: float, k3: float) -> None:
    xi, chiral, strain = 0.07, -0.03, (0.02, 0.003, k2 * ETA, k3 * ETA)
    exact = ref.twist(ETA, xi, strain, chiral).energy
    assert abs(analytic.twist(ETA, xi, chiral).energy(*strain) - exact) <= 4e-15 * exact
    exact = ref.twist_second_order(ETA, xi, strain, chiral).energy
    # (59) may be negative: its terms are of either sign.
    assert abs(analytic.twist(ETA, xi, chiral).energy_second_order(*strain) - exact) <= 4e-15 * abs(exact)


@pytest.mark.parametrize("k2", GRID)
def test_saddle_energy_equals_both_formulas(k2: float) -> None:
    xi, K2 = 0.3, k2 * ETA
    exact = ref.General(ETA, {"d33": [xi]})((0.02, 0.003, K2, 0.4)).energy
    assert abs(analytic.saddle(ETA, xi).energy(K2, 0.02, 0.003, 0.4) - exact) <= 4e-15 * exact
    uniform = (
        (mpf(0.02) + mpf(0.4) ** 2 / 24) ** 2 / 2 + mpf(0.003) ** 2 / 24 + (mpf(ETA) * mpf(0.4)) ** 2 / 18
    )
    exact = ref.saddle(ETA, xi, K2, "published")[0] + uniform
    assert abs(analytic.saddle(ETA, xi, "published").energy(K2, 0.02, 0.003, 0.4) - exact) <= 4e-15 * exact


@pytest.mark.parametrize("k2", GRID)
def test_deflections_equal_the_exact_ones(k2: float) -> None:
    x = np.linspace(-0.5, 0.5, 9)
    K2, K3, xi = k2 * ETA, 0.25, 0.07
    exact = ref.General(ETA, {"gamma33": [0, 0, 4 * xi]}).deflection((0.0, 0.0, K2, K3), x)
    scale = float(max(abs(u) for u in exact))
    # G loses up to 1e-14 to cancellation where its series ends
    np.testing.assert_allclose(
        analytic.twist(ETA, xi).deflection(x, K2, K3), np.array(exact, float), rtol=0, atol=3e-14 * scale
    )
    exact = ref.General(ETA, {"d33": [xi]}).deflection((0.0, 0.0, K2, 0.0), x)
    scale = float(max(abs(u) for u in exact))
    np.testing.assert_allclose(
        analytic.saddle(ETA, xi).deflection(x, K2), np.array(exact, float), rtol=0, atol=1e-14 * scale
    )


def test_published_deflection_is_that_of_isochoric_growth() -> None:
    """Without the gradient in the edge condition, (48) relaxes the growth d22 = -d33/2, a true saddle."""
    x, xi = np.linspace(-0.5, 0.5, 9), 0.3
    exact = ref.General(ETA, {"d33": [xi], "d22": [-xi / 2]}).deflection((0.0, 0.0, -0.2, 0.0), x)
    np.testing.assert_allclose(
        analytic.saddle(ETA, xi, "published").deflection(x, -0.2), np.array(exact, float), rtol=0, atol=1e-16
    )


def test_consistent_saddle_is_a_stress_free_cylinder() -> None:
    xi = np.array([-0.2, 0.0, 0.1, 3.0])
    petal = analytic.saddle(ETA, xi)
    K2 = petal.natural_curvature()
    np.testing.assert_array_equal(K2, -xi)
    np.testing.assert_array_equal(petal.energy(K2), 0.0)
    np.testing.assert_array_equal(petal.deflection(0.3, K2), 0.0)


@pytest.mark.parametrize("xi", [1e-6, 0.1, -0.3, 4.0])
def test_published_natural_curvature_is_where_its_slope_changes_sign(xi: float) -> None:
    K2 = float(analytic.saddle(ETA, xi, "published").natural_curvature())
    with mp.workdps(60):
        _, slope, curvature = ref.saddle(ETA, xi, K2, "published")
        assert abs(slope / curvature) <= 4e-15 * abs(K2)  # distance to the exact root


def test_twist_threshold_and_branch() -> None:
    leaf = analytic.twist(ETA, np.array([0.0, 0.05, 0.06]))
    assert leaf.threshold == pytest.approx(0.05, rel=1e-15)
    np.testing.assert_allclose(leaf.twisted_curvature(), [0.0, 0.0, np.sqrt(0.08)], rtol=1e-14, atol=3e-9)


@pytest.mark.parametrize("chiral", [0.04, -0.3])
@pytest.mark.parametrize("xi", [-0.5, 0.0, 0.05, 0.3])
def test_twisted_curvature_with_chirality_is_stationary(xi: float, chiral: float) -> None:
    K3 = float(analytic.twist(ETA, xi, chiral).twisted_curvature())
    exact = ref.twist(ETA, xi, (xi / 3 - K3**2 / 24, 0.0, 0.0, K3), chiral)
    assert K3 * chiral > 0
    assert abs(exact.gradient[3] / exact.hessian[3][3]) <= 1e-15 * abs(K3) + 1e-30


def test_arrays_broadcast() -> None:
    leaf = analytic.twist(np.array([0.1, 0.2]), 0.03, np.array([[0.0], [0.1], [0.2]]))
    assert leaf.energy(0.0, 0.0, 0.1, 0.2).shape == (3, 2)
    assert leaf.deflection(0.1, 0.1, np.zeros((4, 1, 1))).shape == (4, 1, 2)
    assert np.shape(leaf.twisted_curvature()) == (3, 2)
    assert analytic.saddle(0.1, np.ones(5), "published").natural_curvature().shape == (5,)


def test_bad_input_is_named() -> None:
    for call, text in [
        (lambda: analytic.twist(0.0, 0.1), "eta"),
        (lambda: analytic.twist(0.1, np.nan), "xi"),
        (lambda: analytic.saddle(0.1, 0.1, "printed"), "form"),
        (lambda: analytic.twist(0.1, 0.1, 0.1).threshold, "chiral"),
        (lambda: analytic.twist(0.1, 0.1).energy(0, 0, np.inf, 0), "K2"),
    ]:
        with pytest.raises(InputError, match=text):
            call()


@pytest.mark.parametrize("bad", ["a", 1j, [1.0, [2.0]], object(), float("nan"), True])
def test_what_is_no_number_is_refused(bad):
    twist, saddle = analytic.twist(0.1, 0.06), analytic.saddle(0.1, 0.1)
    for make in (
        lambda: analytic.twist(bad, 0.06),
        lambda: analytic.twist(0.1, bad),
        lambda: twist.energy(0.0, 0.0, bad, 0.0),
        lambda: twist.deflection(bad, 0.1, 0.1),
        lambda: saddle.deflection(0.2, bad),
        lambda: analytic.saddle(0.1, 0.1, form=bad),
    ):
        with pytest.raises(InputError):
            make()
    with pytest.raises(InputError, match=r"^x = 0\.6: "):
        twist.deflection(0.6, 0.1, 0.1)
