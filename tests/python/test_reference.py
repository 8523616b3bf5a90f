"""The mpmath references against each other and against two other methods."""

from __future__ import annotations

from typing import Any

import pytest
import reference as ref
from mpmath import mp, mpf

FIELDS: dict[str, list[float]] = {
    "gamma33": [0.02, -0.05, 0.3, 0.1, -0.7],
    "d33": [0.4, -0.2, 0.9],
    "d22": [-0.3, 0.5, 0.0, 1.1],
    "d23": [0.2, 0.6],
    "g21": [0.0, 0.03, -0.02, 0.05],
    "g31": [0.01, 0.0, 0.04, -0.03],
}
STIFFNESS = (2.0, 1.1, 0.45, 0.6)


def close(a: Any, b: Any, digits: int) -> bool:
    """Equal to so many digits of the larger, or of 1e-30 where both vanish."""
    with mp.workdps(200):
        return bool(abs(a - b) <= mpf(10) ** -digits * max(abs(a), abs(b), mpf(10) ** -30))


def flat(value: ref.Value) -> list[Any]:
    """All 21 numbers of a value."""
    return [value.energy, *value.gradient, *(h for row in value.hessian for h in row)]


@pytest.mark.parametrize("k2", [0.0, 1e-12, -1e-6, 0.03, -1.0, 7.4, 60.0, -1e4, 1e6])
@pytest.mark.parametrize("eta", [0.1, 1e-4])
def test_printed_twist_equals_general_law(eta: float, k2: float) -> None:
    xi, chiral = 5.5 * eta**2, 0.3 * eta
    strain = (0.3 * eta**2, -0.2 * eta**2, k2 * eta, 1.7 * eta)
    general = ref.General(eta, {"gamma33": [0, 0, 4 * xi], "d23": [chiral]})
    for a, b in zip(flat(ref.twist(eta, xi, strain, chiral)), flat(general(strain)), strict=True):
        assert close(a, b, 50)


@pytest.mark.parametrize("k2", [0.0, 1e-12, -1e-6, 0.03, -1.0, 7.4, 60.0, -1e4, 1e6])
def test_consistent_saddle_equals_general_law(k2: float) -> None:
    eta, xi = 0.1, 0.2
    general = ref.General(eta, {"d33": [xi]})((0.0, 0.0, k2 * eta, 0.0))
    a = ref.saddle(eta, xi, k2 * eta, "consistent")
    assert close(a[0], general.energy, 50)
    assert close(a[1], general.gradient[2], 50)
    assert close(a[2], general.hessian[2][2], 50)


def slope(f: list[Any], step: float) -> Any:
    """Five-point difference from the values at -2, -1, 1, 2 steps."""
    with mp.workdps(60):
        return (f[0] - 8 * f[1] + 8 * f[2] - f[3]) / (12 * step)


@pytest.mark.parametrize("k2", [0.0, 0.375, -3.0])
def test_derivatives_are_those_of_the_value(k2: float) -> None:
    eta = 0.25
    general = ref.General(eta, FIELDS, STIFFNESS)
    strain = (1 / 128, 1 / 16, k2 * eta, -5 / 16)
    value, step = general(strain), 2.0**-20  # exact in doubles; five-point differences, error step^4
    for i in range(4):
        near = []
        for s in (-2, -1, 1, 2):
            moved = list(strain)
            moved[i] += s * step
            near.append(general(moved))
        assert abs(slope([n.energy for n in near], step) - value.gradient[i]) < 1e-20
        for j in range(4):
            assert abs(slope([n.gradient[j] for n in near], step) - value.hessian[i][j]) < 1e-19


def galerkin(eta: float, K2: float, K3: float, n: int = 42) -> Any:
    """Relaxed part of the energy from U = sum c_i (x^i - its mean and slope), minimised directly."""
    general = ref.General(eta, FIELDS, STIFFNESS)
    with mp.workdps(120):
        D, k = general._constants()[1], ref.exact(K2)
        weights = (ref.exact(K3) ** 2, k, mpf(1))
        loads = general.loads()
        P = ref.add(*(ref.scaled(w, load.P) for w, load in zip(weights, loads, strict=True)))
        f = ref.add(*(ref.scaled(w, load.f) for w, load in zip(weights, loads, strict=True)))
        U = [ref.soft([mpf(0)] * i + [mpf(1)]) for i in range(2, n)]
        V = [ref.derivative(u, 2) for u in U]
        A = mp.matrix(n - 2)
        b = mp.matrix(n - 2, 1)
        for i in range(n - 2):
            b[i] = k * ref.mean(ref.times(P, U[i])) - D * ref.mean(ref.times(f, V[i]))
            for j in range(n - 2):
                A[i, j] = k**2 * ref.mean(ref.times(U[i], U[j])) + D * ref.mean(ref.times(V[i], V[j]))
        c = mp.lu_solve(A, b)
        return (ref.mean(ref.times(P, P)) + D * ref.mean(ref.times(f, f)) - (b.T * c)[0]) / 2


def relaxed(eta: float, K2: float, K3: float) -> Any:
    """The same from the exact solution."""
    A = ref.General(eta, FIELDS, STIFFNESS).forms(K2)
    with mp.workdps(120):
        y = (ref.exact(K3) ** 2, ref.exact(K2), mpf(1))
        return sum(y[i] * A[i][j][0] * y[j] for i in range(3) for j in range(3))


@pytest.mark.parametrize("k2", [0.0, -0.7, 6.0])
def test_general_law_equals_a_galerkin_minimum(k2: float) -> None:
    assert close(galerkin(0.25, k2 * 0.25, 0.6), relaxed(0.25, k2 * 0.25, 0.6), 40)


def integration_matrix(n: int) -> Any:
    """F[m, j]: component on sqrt(2m+1) P_m(2x), m = 2..., of the double integral of sqrt(2j+1) P_j(2x)."""
    F = mp.matrix(n, n)
    for j in range(n):
        # 4 int int P_j = (P_{j+2} - P_j)/((2j+1)(2j+3)) - (P_j - P_{j-2})/((2j+1)(2j-1)), up to 1 and x
        up, down = mpf(1) / ((2 * j + 1) * (2 * j + 3)), mpf(1) / ((2 * j + 1) * (2 * j - 1))
        for m, c in ((j + 2, up), (j, -up - down), (j - 2, down)):
            if 2 <= m < n + 2:
                F[m - 2, j] = c / 4 * mp.sqrt(mpf(2 * j + 1) / (2 * m + 1))
    return F


@pytest.mark.parametrize("k2", [0.0, 0.02, -1.3, 9.0])
def test_relaxed_energy_is_a_sum_of_squares(k2: float) -> None:
    """Pi = 1/2 sum w_j^2/(1 + K2^2 sigma_j^2/D), w = K3^2 t - gamma + K2 (nu K2 t + s), sigma_j of F."""
    eta, K3, n = 0.25, 0.6, 24
    K2 = k2 * eta
    general = ref.General(eta, FIELDS, STIFFNESS)
    with mp.workdps(50):
        D, k = general._constants()[1], ref.exact(K2)
        y = (ref.exact(K3) ** 2, k, mpf(1))
        loads = general.loads()
        P = ref.add(*(ref.scaled(w, load.P) for w, load in zip(y, loads, strict=True)))
        f = ref.add(*(ref.scaled(w, load.f) for w, load in zip(y, loads, strict=True)))
        legendre = [[mpf(1)], [mpf(0), mpf(2)]]
        for m in range(1, n + 1):
            recurrence = ref.scaled(mpf(2 * m + 1) / (m + 1), [mpf(0), *ref.scaled(2, legendre[m])])
            legendre.append(ref.add(recurrence, ref.scaled(-mpf(m) / (m + 1), legendre[m - 1])))
        w = P
        w = ref.add(w, ref.scaled(k, ref.soft(ref.primitive(ref.primitive(f)))))
        left, sigma, _ = mp.svd_r(integration_matrix(n))
        components = mp.matrix(
            [mp.sqrt(2 * m + 1) * ref.mean(ref.times(w, legendre[m])) for m in range(2, n + 2)]
        )
        modes = left.T * components
        total = sum(modes[j] ** 2 / (1 + k**2 * sigma[j] ** 2 / D) for j in range(n)) / 2
    assert close(total, relaxed(eta, K2, K3), 18)
