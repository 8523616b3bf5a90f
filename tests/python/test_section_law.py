"""The compiled section laws against 50-digit references.

Bounds. Energy: 1e-13 Pi + 1e-29 (sum of squared growth terms), the second part being the square of the
growth's own rounding. Gradient: 1e-12 (|g_i| + sqrt(2 Pi |H_ii|)); for Pi = 1/2 sum r^2 the root bounds
|r| |r_i|, so this is relative accuracy of each residual r. Hessian: 1e-12 (|H_ij| + sqrt(T_i T_j)), T_i =
|H_ii| plus the stiffness of the ungrown section, for H_ii passes through 0 where the section loses stability
and its terms do not. The tests ask for a tenth of all this.

Where growth and strain cancel (a section nearly free of stress) the differences are exact for edge growth,
thickness gradients and chirality, and the bounds hold without allowance.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest
import reference as ref
from mpmath import mp, mpf
from ribbonrs._core import SectionLaw
from sections import (
    ETAS,
    INCOMPRESSIBLE,
    K2_SIGNED,
    K3_GRID,
    ORTHOTROPIC,
    XI_GRID,
    growth_squared,
    law,
    samples,
)


class Worst:
    """The largest ratio of an error to its bound, and where."""

    def __init__(self) -> None:
        self.ratio: dict[str, float] = {}
        self.case: dict[str, Any] = {}

    def add(self, kind: str, error: Any, bound: Any, case: Any) -> None:
        ratio = 0.0 if error == 0 else float(abs(error) / bound) if bound else float("inf")
        if not ratio <= self.ratio.get(kind, -1.0):
            self.ratio[kind], self.case[kind] = ratio, case

    def check(self, limit: float = 0.1) -> None:
        bad = {k: (r, self.case[k]) for k, r in self.ratio.items() if not r <= limit}
        assert not bad, bad

    def compare(
        self,
        tested: SectionLaw,
        strains: Any,
        exact: Sequence[ref.Value],
        squares: float,
        tag: Any,
    ) -> None:
        """All numbers of a law at strains (m, 4) against the references."""
        strains = np.ascontiguousarray(strains, dtype=float)
        energy, gradient, hessian = tested.energy(strains), tested.gradient(strains), tested.hessian(strains)
        eta = tested.eta
        ungrown = (1.0, 1 / 12, eta**2 / 12, eta**2 / 9)
        for n, value in enumerate(exact):
            case = (tag, eta, strains[n].tolist())
            Pi, g, H = value
            bound = 1e-13 * Pi + 1e-29 * mpf(squares)
            self.add("energy", mpf(energy[n]) - Pi, bound, case)
            T = [abs(H[i][i]) + ungrown[i] for i in range(4)]
            for i in range(4):
                bound = 1e-12 * (abs(g[i]) + mp.sqrt(2 * abs(Pi * H[i][i])))
                self.add(f"gradient[{i}]", mpf(gradient[n, i]) - g[i], bound, case)
                for j in range(i, 4):
                    bound = 1e-12 * (abs(H[i][j]) + mp.sqrt(T[i] * T[j]))
                    self.add(f"hessian[{i}{j}]", mpf(hessian[n, i, j]) - H[i][j], bound, case)
                    self.add("symmetry", hessian[n, i, j] - hessian[n, j, i], 1e-300, case)


def strain_grid(eta: float, natural: tuple[float, float], scale: float, rng: np.random.Generator) -> Any:
    """Grid of K2 and K3 with eps and K1 once random, once within 1e-6 of relaxed or less."""
    rows = []
    for k2, k3 in itertools.product(K2_SIGNED, K3_GRID):
        K2, K3 = k2 * eta, k3 * eta * rng.choice([-1, 1])
        rows.append((scale * rng.normal(), scale * rng.normal(), K2, K3))
        near = 10.0 ** rng.uniform(-17, -6, 2) * rng.choice([-1, 1], 2)
        rows.append((natural[0] - K3**2 / 24 + near[0] * scale, natural[1] + near[1] * scale, K2, K3))
    return np.array(rows)


@pytest.mark.parametrize("eta", ETAS)
def test_edge_growth_with_chirality_on_the_grid(eta: float) -> None:
    rng = np.random.default_rng(1)
    worst = Worst()
    for xi_hat, omega in zip(XI_GRID, [0, 0.2, 0, -31.8, 0, 0.2, 0, 500.0, 0, 0.2, 0], strict=True):
        xi, d = xi_hat * eta**2, 2 * eta * omega
        fields = {"gamma33": [0, 0, 4 * xi], "d23": [d]}
        strains = strain_grid(eta, (xi / 3, 0.0), max(abs(xi), eta**2), rng)
        exact = [ref.twist(eta, xi, s, d) for s in strains.tolist()]
        for form in ("closed", "general"):
            worst.compare(
                law(eta, fields, form), strains, exact, growth_squared(eta, fields), (form, xi_hat, omega)
            )
    worst.check()


@pytest.mark.parametrize("eta", ETAS)
def test_thickness_gradients_on_the_grid(eta: float) -> None:
    rng = np.random.default_rng(2)
    worst = Worst()
    # d33 is a curvature, of the size eta where it matters; the second is the isochoric saddle.
    for size, transverse in [(0.0, 0.0), (1e-3, 0.0), (-1.0, 0.5), (4.55, 0.0), (100.0, 0.0), (1e4, 0.0)]:
        d33, d22 = size * eta, transverse * eta
        fields = {"d33": [d33], "d22": [d22]}
        strains = strain_grid(eta, (0.0, 0.0), max(abs(size), 1.0) * eta**2, rng)
        reference = ref.General(eta, fields)
        exact = [reference(s) for s in strains.tolist()]
        for form in ("closed", "general"):
            worst.compare(law(eta, fields, form), strains, exact, growth_squared(eta, fields), (form, size))
    worst.check()


def random_growth(rng: np.random.Generator, eta: float) -> dict[str, list[float]]:
    """Polynomials of degree <= 8 in every field, some left out, of sizes that matter to shapes."""
    fields: dict[str, list[float]] = {}
    for name in ("gamma33", "d33", "d22", "d23", "g21", "g31"):
        if name != "gamma33" and rng.random() < 0.3:
            continue
        size = 10 ** rng.uniform(-2, 2) * (eta**2 if name == "gamma33" else eta)
        degree = int(rng.integers(0, 9))
        fields[name] = [float(size * rng.normal() * 2.0**k) for k in range(degree + 1)]
    return fields


@pytest.mark.parametrize("stiffness", [INCOMPRESSIBLE, ORTHOTROPIC], ids=["isotropic", "orthotropic"])
def test_polynomial_growth_in_every_field(stiffness: tuple[float, ...]) -> None:
    rng = np.random.default_rng(3)
    worst = Worst()
    for case in range(90):
        eta = float(rng.choice(ETAS))
        fields = random_growth(rng, eta)
        reference = ref.General(eta, fields, stiffness)
        K2 = float(rng.choice(K2_SIGNED)) * eta
        gamma = np.polynomial.Polynomial(fields["gamma33"])
        moments = [
            float(p.integ()(0.5) - p.integ()(-0.5)) for p in (gamma, np.polynomial.Polynomial([0, 1]) * gamma)
        ]
        rows = []
        for k3 in (*K3_GRID, rng.normal() * 3):
            K3, scale = k3 * eta * rng.choice([-1, 1]), np.sqrt(growth_squared(eta, fields))
            rows.append((scale * rng.normal(), scale * rng.normal(), K2, K3))
            near = 10.0 ** rng.uniform(-17, -6, 2) * scale
            rows.append((moments[0] - K3**2 / 24 + near[0], 12 * moments[1] + near[1], K2, K3))
        exact = [reference(s) for s in rows]
        tested = law(eta, fields, "general", stiffness)
        worst.compare(tested, rows, exact, growth_squared(eta, fields), (case, fields))
    worst.check()


@pytest.mark.parametrize("form", ["closed", "general"])
def test_nearly_stress_free_sections(form: str) -> None:
    """Edge growth and chirality that leave the twist K3 = d/2, 8 xi = K3^2, free of stress; and nearby."""
    rng = np.random.default_rng(8)
    worst = Worst()
    for case in range(300):
        eta = float(rng.choice(ETAS))
        K3 = eta * 10 ** rng.uniform(-2, 2)
        xi, d = K3**2 / 8, 2 * K3
        fields = {"gamma33": [0, 0, 4 * xi], "d23": [d]}
        p = 10 ** rng.uniform(-16, -1) * rng.choice([-1, 1], 4)
        strain = [xi / 3 - K3**2 / 24 + p[0] * xi, p[1] * xi, p[2] * K3 * (case % 2), K3 * (1 + p[3])]
        exact = [ref.twist(eta, xi, strain, d)]
        worst.compare(law(eta, fields, form), [strain], exact, growth_squared(eta, fields), p.tolist())
    worst.check(1.0)


def test_second_order_form_is_the_published_polynomial() -> None:
    eta, xi, d = 0.1, 0.07, -0.03
    strains = samples(eta, 7)
    worst = Worst()
    tested = law(eta, {"gamma33": [0, 0, 4 * xi], "d23": [d]}, "second-order")
    energy, gradient, hessian = tested.energy(strains), tested.gradient(strains), tested.hessian(strains)
    for n, s in enumerate(strains.tolist()):
        exact = ref.twist_second_order(eta, xi, s, d)
        # A difference of terms, unbounded below: relative to the largest of them.
        size = 2 * xi**2 + s[0] ** 2 + s[3] ** 4 / 72
        size += s[2] ** 2 * (eta**2 + s[3] ** 2 / 720 + (s[3] ** 2 + 8 * xi) ** 2 / (80640 * eta**2))
        worst.add("energy", mpf(energy[n]) - exact.energy, 1e-14 * (abs(exact.energy) + size), s)
        for i in range(4):
            scale = max(abs(h) * abs(k) for h, k in zip(exact.hessian[i], s, strict=True)) + abs(
                exact.gradient[i]
            )
            worst.add("gradient", mpf(gradient[n, i]) - exact.gradient[i], 1e-12 * (scale + eta * xi), s)
            for j in range(4):
                bound = 1e-12 * (abs(exact.hessian[i][j]) + eta**2 + xi)
                worst.add("hessian", mpf(hessian[n, i, j]) - exact.hessian[i][j], bound, s)
    worst.check()


@pytest.mark.parametrize("xi", [0.0, 0.3, -0.02])
def test_published_saddle_is_the_published_formula(xi: float) -> None:
    eta, worst = 0.05, Worst()
    tested = law(eta, {"d33": [xi]}, "published-saddle")
    strains = np.array([(0.01, 0.002, k2 * eta, K3) for k2 in K2_SIGNED for K3 in (0.0, 0.2)])
    exact = []
    for e, K1, K2, K3 in (tuple(map(mpf, s)) for s in strains.tolist()):
        with mp.workdps(60):
            soft, slope, curvature = ref.saddle(eta, xi, float(K2), "published")
            h, s = mpf(eta), e + K3**2 / 24
            energy = s**2 / 2 + K1**2 / 24 + h**2 * K3**2 / 18 + soft
            gradient = [s, K1 / 12, slope, s * K3 / 12 + h**2 * K3 / 9]
            twisting = s / 12 + K3**2 / 144 + h**2 / 9
            exact.append(ref.Value(energy, gradient, ref._hessian(K3 / 12, curvature, mpf(0), twisting)))
    worst.compare(tested, strains, exact, (eta * xi) ** 2, xi)
    worst.check()
