"""The package's law for growth in pieces against the exact solution of the same pieces.

Bounds as in test_section_law.py: the energy to 1e-14 Pi + 1e-30 (sum of squared growth), the gradient to
1e-13 (|g_i| + sqrt(2 Pi |H_ii|)), the Hessian to 1e-13 (|H_ij| + sqrt(T_i T_j)) with T_i = |H_ii| plus the
stiffness of the ungrown section.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest
import ribbonrs as rb
from exact_pieces import Exact
from mpmath import mp, mpf
from piece_cases import CASES, MATERIALS, Fields, sized, strain
from refusal import refuses

ETAS = [0.3, 0.1, 0.01, 1e-4]
K2 = [0.0, 1e-12, -1e-6, 1e-3, -0.1, 0.7, -7.4, 24.1, 300.0, -4e3, 1e5]


def made(
    eta: float, breaks: Sequence[float], fields: Fields, stiffness: Sequence[float]
) -> tuple[rb.SectionLaw, Exact]:
    """The package's law and the exact one."""
    law = rb.SectionLaw(eta, rb.growth.Profile(**fields, breaks=breaks), rb.Orthotropic(*stiffness))
    return law, Exact(eta, breaks, fields, stiffness)


def squares(eta: float, fields: Fields) -> float:
    """Sum of the squared growth terms at the edge: strains as they are, curvatures times eta."""
    total = 0.0
    for name, pieces in fields.items():
        factor, shift = (1.0 if name == "gamma33" else eta), int(name in ("g21", "g31"))
        for piece in pieces:
            total += sum((factor * max(k, 1) * c / 2 ** max(k - shift, 0)) ** 2 for k, c in enumerate(piece))
    return total


def check(law: rb.SectionLaw, exact: Exact, strains: Sequence[Sequence[float]], size: float) -> None:
    """Compare all numbers of the two laws."""
    eta = law.thickness_ratio
    energy, gradient, hessian = law.energy(strains), law.gradient(strains), law.hessian(strains)
    for n, at in enumerate(strains):
        Pi, g, H = exact(at)
        with mp.workdps(60):
            T = [abs(H[i][i]) + t for i, t in enumerate((1.0, 1 / 12, eta**2 / 12, eta**2 / 9))]
            assert abs(mpf(energy[n]) - Pi) <= 1e-14 * Pi + 1e-30 * size, at
            for i in range(4):
                bound = 1e-13 * (abs(g[i]) + mp.sqrt(2 * abs(Pi * H[i][i])))
                assert abs(mpf(gradient[n, i]) - g[i]) <= bound, (at, i)
                for j in range(4):
                    bound = 1e-13 * (abs(H[i][j]) + mp.sqrt(T[i] * T[j]))
                    assert abs(mpf(hessian[n, i, j]) - H[i][j]) <= bound, (at, i, j)


@pytest.mark.parametrize("material", MATERIALS)
@pytest.mark.parametrize("case", list(CASES))
def test_growth_in_pieces(case: str, material: str) -> None:
    breaks, fields = CASES[case]
    # A third of the K2 for each material, another third for the next, and each K2 with another eta.
    turn = list(CASES).index(case) + list(MATERIALS).index(material)
    for n, k2 in enumerate(K2[turn % 3 :: 3], start=turn):
        eta = ETAS[n % len(ETAS)]
        grown = sized(fields, eta)
        law, exact = made(eta, breaks, grown, MATERIALS[material])
        strains = [
            strain(eta, k2),
            (0.0, 0.0, k2 * eta, 0.0),
            (0.8 * eta**2, 0.0, k2 * eta, -30 * eta),
            (1e-3 * eta**2, 1e-3 * eta**2, k2 * eta, 1e3 * eta),
        ]
        check(law, exact, strains, squares(eta, grown))


def random_pieces(rng: np.random.Generator) -> tuple[list[float], Fields]:
    """Up to six pieces, some of them narrow, of polynomials of degree four at most in each field."""
    breaks = np.sort(rng.uniform(-0.49, 0.49, rng.integers(1, 6))).tolist()
    if rng.random() < 0.3:
        breaks = sorted([*breaks, breaks[0] + 1e-3])
    fields: Fields = {}
    for name in ("gamma33", "d33", "d22", "d23"):
        if name != "gamma33" and rng.random() < 0.4:
            continue
        size = 10 ** rng.uniform(-1, 2)
        fields[name] = [
            (size * rng.normal(size=n) * 2.0 ** np.arange(n)).tolist()
            for n in rng.integers(1, 6, len(breaks) + 1)
        ]
    return breaks, fields


def test_random_growth_in_pieces() -> None:
    rng = np.random.default_rng(11)
    for n in range(24):
        breaks, fields = random_pieces(rng)
        eta = ETAS[n % len(ETAS)]
        grown, stiffness = sized(fields, eta), list(MATERIALS.values())[n % 3]
        law, exact = made(eta, breaks, grown, stiffness)
        K2 = float(rng.choice([-1, 1]) * 10 ** rng.uniform(-3, 5) * eta)
        strains = [
            (rng.normal() * eta**2, rng.normal() * eta**2, K2, rng.normal() * eta * 10 ** rng.uniform(-1, 2))
            for _ in range(2)
        ]
        check(law, exact, strains, squares(eta, grown))


# The law takes as many modes as the energy needs, whose error is of the square of that of U. What they leave
# of U'' at an edge, the worst place, sets the tolerance from 24 eta on.
@pytest.mark.parametrize("case", list(CASES))
@pytest.mark.parametrize(
    ("k2", "tolerance"),
    [(0.0, 1e-14), (1e-9, 1e-14), (-0.7, 1e-14), (7.4, 2e-14), (24.1, 2e-13), (1e3, 3e-10), (-4e3, 4e-9)],
)
def test_deflection(case: str, k2: float, tolerance: float) -> None:
    """U, U' and U'' between the breaks and in the layers beside them, of width (eta/|K2|)^(1/2)."""
    eta = 0.1
    breaks, fields = CASES[case]
    law, exact = made(eta, breaks, sized(fields, eta), MATERIALS["orthotropic"])
    at = strain(eta, k2)
    layer = 0.5 / np.sqrt(1 + abs(k2)) * np.array([0.1, 0.5, 2.0])
    x = [*np.linspace(-0.5, 0.5, 33) * (1 - 1e-9), *(0.5 - layer), *(layer - 0.5)]
    x = np.array(
        [t for t in [*x, *(b + s * d for b in breaks for s in (-1, 1) for d in layer)] if abs(t) < 0.5]
    )
    for order in (0, 1, 2):
        U = np.array(exact.deflection(at, x.tolist(), order), dtype=float)
        found = law.deflection(at, x, order)
        np.testing.assert_allclose(found, U, rtol=0, atol=tolerance * np.abs(U).max())


def test_pieces_of_one_polynomial_are_the_polynomial() -> None:
    """The same growth, whole and cut: two routes through the law, each exact to rounding."""
    eta, whole = 0.1, {"gamma33": [0.01, -0.05, 0.2, 0.4], "d33": [0.1, 0.3], "d22": [0.2, 0.0, -0.5]}
    breaks = [-0.2, 0.3]
    a = rb.SectionLaw(eta, rb.growth.Profile(**whole))
    b = rb.SectionLaw(eta, rb.growth.Profile(**{k: [c] * 3 for k, c in whole.items()}, breaks=breaks))
    strains = np.array([strain(eta, k2) for k2 in K2])
    np.testing.assert_allclose(a.energy(strains), b.energy(strains), rtol=1e-14)
    x = np.linspace(-0.5, 0.5, 23)
    np.testing.assert_allclose(a.deflection(strains[6], x), b.deflection(strains[6], x), rtol=0, atol=1e-15)


def test_jumps_of_g31_are_refused() -> None:
    refuses("growth.profile.g31", lambda: rb.growth.Profile(g31=[[0.0], [0.01]], breaks=[0.1]))


def test_bending_beyond_the_modes_is_told() -> None:
    growth = rb.growth.Profile(gamma33=[[0.0], [0.05]], breaks=[0.1])
    with pytest.warns(rb.RibbonWarning, match="beyond"):
        rb.solve(rb.Scene(rb.Ribbon(10.0, 1.0, 2e-6), growth))
    rb.solve(rb.Scene(rb.Ribbon(10.0, 1.0, 1e-2), growth))  # without a warning, which would be an error
