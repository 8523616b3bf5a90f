"""The two references for growth in pieces: each against what is known, and against each other."""

from __future__ import annotations

from typing import Any

import exact_pieces
import numpy as np
import pytest
import reference as ref
import relaxation
from mpmath import mp, mpf
from piece_cases import CASES, MATERIALS, sized, strain
from relaxation import functions
from sections import INCOMPRESSIBLE, law

K2 = [0.0, 1e-6, -0.7, 7.4, -30.0, 100.0]
ETA = [0.02, 0.1, 0.3]


def difference(found: Any, exact: Any, scale: Any) -> float:
    """|found - exact|/scale, before the difference is rounded."""
    with mp.workdps(60):
        return float(abs(mpf(found) - exact) / scale)


# ------------------------------------------------------------------------------------- the exact solution

FULL: dict[str, list[float]] = {
    "gamma33": [0.02, -0.05, 0.3, 0.1, -0.7, 0.0, 0.0, 0.0, 3.0],
    "d33": [0.4, -0.2, 0.9],
    "d22": [-0.3, 0.5, 0.0, 1.1],
    "d23": [0.2, 0.6],
    "g21": [0.0, 0.03, -0.02, 0.05],
    "g31": [0.01, 0.0, 0.04, -0.03],
}


@pytest.mark.parametrize("k2", [0.0, 1e-12, -1e-3, 1.0, -30.0, 1e4])
def test_pieces_of_one_polynomial_are_the_polynomial(k2: float) -> None:
    """Cut at will, the growth and so its law stay as they were: 50 digits, and U with two derivatives."""
    eta, stiffness = 0.1, (2.0, 1.1, 0.45, 0.6)
    breaks = [-0.3, 0.25, 0.26]
    whole = ref.General(eta, FULL, stiffness)
    pieces = exact_pieces.Exact(eta, breaks, {name: [c] * 4 for name, c in FULL.items()}, stiffness)
    at, x = (0.01, -0.02, k2 * eta, 0.3), [-0.5, -0.3, 0.0, 0.255, 0.5]
    a, b = pieces(at), whole(at)
    with mp.workdps(200):
        pairs = [(a.energy, b.energy), *zip(a.gradient, b.gradient, strict=True)]
        pairs += [
            (p, q) for r, s in zip(a.hessian, b.hessian, strict=True) for p, q in zip(r, s, strict=True)
        ]
        for order in (0, 1, 2):
            pairs += zip(pieces.deflection(at, x, order), whole.deflection(at, x, order), strict=True)
        for found, expected in pairs:
            assert abs(found - expected) <= mpf(10) ** -50 * max(abs(expected), mpf(10) ** -8)


@pytest.mark.parametrize("k2", [1e-12, 0.3])
def test_the_exact_energy_has_its_digits(k2: float) -> None:
    """Half as many again, and a piece a thousandth of the width, change nothing in the first 60."""
    fields = {
        "gamma33": [[0.1, 0.0, 0.3], [-0.2], [0.0, 1.0, 0.0, 2.0]],
        "d22": [[1.0], [0.0, 0.0, 3.0], [0.0]],
    }
    tested, more = (exact_pieces.Exact(0.1, [0.2, 0.201], fields) for _ in range(2))
    digits = more.digits(k2 * 0.1)
    more.digits = lambda K2: digits * 3 // 2  # type: ignore[method-assign]
    at = strain(0.1, k2)
    with mp.workdps(200):
        assert abs(tested.energy(at) / more.energy(at) - 1) <= mpf(10) ** -60
        for a, b in zip(
            tested.deflection(at, [-0.5, 0.2005]), more.deflection(at, [-0.5, 0.2005]), strict=True
        ):
            assert abs(a / b - 1) <= mpf(10) ** -60


def test_a_jump_of_g31_has_no_finite_energy() -> None:
    with pytest.raises(ValueError, match=r"g31 jumps at 0\.1"):
        exact_pieces.Exact(0.1, [0.1], {"g31": [[0.0], [0.01]]})
    steep = [
        relaxation.relaxed(
            0.1,
            [0.1 - width, 0.1],
            functions({"g31": [[0.0], [-0.01 * (0.1 - width) / width, 0.01 / width], [0.01]]}),
            (0.0,) * 4,
            INCOMPRESSIBLE,
        ).energy
        for width in (1e-2, 1e-3)
    ]
    # (eta^2/18) (0.01/(2 w))^2 w
    assert steep == pytest.approx([0.1**2 / 18 * 0.005**2 / width for width in (1e-2, 1e-3)], rel=1e-10)


def test_a_jump_of_g21_folds_the_section_for_nothing() -> None:
    """U' jumps with g21; without curvature to oppose it the fold costs no energy."""
    fields = {"g21": [[0.0], [0.01]]}
    exact = exact_pieces.Exact(0.1, [0.1], fields)
    assert exact.energy((0.0,) * 4) == 0
    left, right = exact.deflection((0.0,) * 4, [0.1 - 1e-9, 0.1], 1)
    assert float(right - left) == 0.01
    U = relaxation.relaxed(0.1, [0.1], functions(fields), (0.0,) * 4, INCOMPRESSIBLE)
    assert U.energy == pytest.approx(0.0, abs=1e-30)
    expected = [float(u) for u in exact.deflection((0.0,) * 4, U.x.tolist())]
    np.testing.assert_allclose(U.U, expected, rtol=0, atol=1e-14 * max(expected))


# -------------------------------------------------------------------------------------- finite differences


@pytest.mark.parametrize("k2", [0.0, 7.4, 100.0])
def test_order_of_the_finite_differences(k2: float) -> None:
    """Errors fall as the square of the step, and once extrapolated as its fourth power."""
    eta = 0.1
    breaks, fields = CASES["mixture"]
    fields, at = sized(fields, eta), strain(eta, k2)
    exact = exact_pieces.Exact(eta, breaks, fields).energy(at)
    energies = [
        relaxation.discrete(eta, breaks, functions(fields), at, INCOMPRESSIBLE, [n, 2 * n, 2 * n]).energy
        for n in (16, 32, 64)
    ]
    once = [relaxation.extrapolated(energies[i : i + 2]) for i in (0, 1)]
    for values, order in ((energies[1:], 2), (once, 4)):
        coarse, fine = (float(mpf(value) - exact) for value in values)
        # The next term of the series is (q h)^2, below 2 % at these steps, edge layers of width 1/q = 1/12.
        assert np.log2(coarse / fine) == pytest.approx(order, abs=0.05)


@pytest.mark.parametrize("k2", K2)
def test_finite_differences_against_the_closed_form(k2: float) -> None:
    """Edge growth and chirality, the law of the package: two methods with nothing in common."""
    eta, xi, d = 0.1, 0.06, 0.04
    fields = {"gamma33": [0.0, 0.0, 4 * xi], "d23": [d]}
    compiled, at = law(eta, fields, "closed"), strain(eta, k2)
    found = relaxation.relaxed(
        eta, [], functions({name: [c] for name, c in fields.items()}), at, INCOMPRESSIBLE
    )
    assert found.energy == pytest.approx(compiled.energy(np.array([at]))[0], rel=5e-15)
    U = compiled.deflection(np.array(at), found.x, 0)
    np.testing.assert_allclose(found.U, U, rtol=0, atol=2e-12 * max(np.abs(U).max(), 1e-3 * eta))


def test_finite_differences_take_any_function() -> None:
    """A cosine against its Taylor polynomial of degree 24, right to 1e-20, with a needless break."""
    eta, at = 0.1, (0.01, 0.0, 0.7, 0.2)
    taylor = [0.0 if n % 2 else (-1) ** (n // 2) * 3.0**n / float(mp.factorial(n)) for n in range(25)]
    exact = exact_pieces.Exact(eta, [], {"gamma33": [[0.1 * c for c in taylor]]})
    found = relaxation.relaxed(
        eta, [0.1], {"gamma33": [lambda x: 0.1 * np.cos(3 * x)] * 2}, at, INCOMPRESSIBLE
    )
    assert found.energy == pytest.approx(float(exact.energy(at)), rel=1e-14)


@pytest.mark.parametrize("material", MATERIALS)
@pytest.mark.parametrize("case", CASES)
def test_the_two_references_agree(case: str, material: str) -> None:
    """Energy to rounding; the deflection to what rounding leaves of it in the linear systems."""
    breaks, fields = CASES[case]
    for n, k2 in enumerate(K2, start=list(MATERIALS).index(material)):
        eta = ETA[n % 3]
        growth, at, stiffness = sized(fields, eta), strain(eta, k2), MATERIALS[material]
        exact = exact_pieces.Exact(eta, breaks, growth, stiffness)
        found = relaxation.relaxed(eta, breaks, functions(growth), at, stiffness)
        energy = exact.energy(at)
        assert difference(found.energy, energy, energy) <= 5e-15, (eta, k2)
        U = np.array(exact.deflection(at, found.x.tolist()), dtype=float)
        error = np.abs(found.U - U).max() / max(np.abs(U).max(), 1e-3 * eta)
        assert error <= 2e-12, (eta, k2)
