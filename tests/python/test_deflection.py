"""The relaxed cross-section itself: u1 with two derivatives, u2, u3, and the energy that they add up to."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import reference as ref
from ribbonrs._core import SectionLaw
from sections import INCOMPRESSIBLE, ORTHOTROPIC, SKEW, Fields, law

FULL = {
    **SKEW,
    "d23": [0.02, 0.1],
    "g31": [0.0, 0.03, 0.01],
    "gamma22": [0.01, 0.02, 0.03],
    "gamma23": [0.02, -0.03, 0.0, 0.1],
}
EDGE = {"gamma33": [0.0, 0.0, 0.24], "d33": [0.1], "d23": [0.04]}
CASES = [(EDGE, "closed", INCOMPRESSIBLE), (EDGE, "general", INCOMPRESSIBLE), (FULL, "general", ORTHOTROPIC)]
K2 = [0.0, 1e-9, -0.03, 0.7, -7.4, 24.1, 300.0, -4e3, 1e5, 1e6]
ETA = 0.1
X = np.linspace(-0.5, 0.5, 13)

each_case = pytest.mark.parametrize(
    ("fields", "form", "stiffness"), CASES, ids=["edge", "edge-general", "full"]
)
each_curvature = pytest.mark.parametrize("k2", K2)


def gauss(a: float, b: float, k2: float) -> tuple[Any, Any]:
    """Nodes and weights that resolve the edge layers, of width (eta/|K2|)^(1/2), at both ends."""
    layer = 1 / np.sqrt(1 + abs(k2))
    cuts = [side * (0.5 - n * layer) for side in (-1, 1) for n in (2, 6, 16, 40)]
    edges = np.array(sorted({a, b, *(c for c in cuts if a < c < b)}))
    t, w = np.polynomial.legendre.leggauss(40)
    half = np.diff(edges)[:, None] / 2
    return ((edges[:-1] + edges[1:])[:, None] / 2 + half * t).ravel(), (half * w).ravel()


def polynomial(fields: Fields, name: str, order: int = 0) -> np.polynomial.Polynomial:
    """One growth field or a derivative of it."""
    return np.polynomial.Polynomial(list(fields.get(name, ())) or [0.0]).deriv(order)


@each_case
@each_curvature
def test_deflection_and_its_derivatives(fields: Fields, form: str, stiffness: Any, k2: float) -> None:
    strain = np.array([0.01, -0.02, k2 * ETA, 0.3])
    tested, exact = law(ETA, fields, form, stiffness), ref.General(ETA, fields, stiffness)
    for order in (0, 1, 2):
        u = np.array(exact.deflection(strain.tolist(), X.tolist(), order), dtype=float)
        # Rounding of Legendre series. Their coefficients are as large as U'' in the edge layers, of width
        # (eta/|K2|)^(1/2), and the layers weigh less in what is integrated.
        tolerance = 2e-15 * (1 + abs(k2)) ** (1 / 3, 1 / 2, 1 / 4)[order]
        np.testing.assert_allclose(
            tested.deflection(strain, X, order), u, rtol=0, atol=tolerance * np.abs(u).max()
        )


@each_case
@each_curvature
def test_in_plane_displacements(fields: Fields, form: str, stiffness: Any, k2: float) -> None:
    """u2' = -nu m - U'^2/2 + gamma22 and u3' = gamma23 - K3 (U - x U'), of zero mean, U the exact one."""
    eps, K1, K2, K3 = strain = (0.01, -0.02, k2 * ETA, 0.3)
    exact = ref.General(ETA, fields, stiffness)
    nu = stiffness[2] / stiffness[1]
    displacements = law(ETA, fields, form, stiffness).displacements(np.array(strain), X)
    scale = np.abs(displacements).max()
    tolerance = 1e-14 * (1 + abs(k2)) ** (1 / 2)  # that of U'
    for n in (0, 3, 7, 12):
        total = np.zeros(2)
        # u(x) = int (s + 1/2) u'(s) ds below x, - int (1/2 - s) u'(s) ds above
        for a, b, offset in ((-0.5, X[n], 0.5), (X[n], 0.5, -0.5)):
            if a == b:
                continue
            s, w = gauss(a, b, k2)
            U, dU = (np.array(exact.deflection(strain, s.tolist(), i), dtype=float) for i in (0, 1))
            m = eps + K1 * s - K2 * U + K3**2 * s**2 / 2 - polynomial(fields, "gamma33")(s)
            u2 = -nu * m - dU**2 / 2 + polynomial(fields, "gamma22")(s)
            u3 = polynomial(fields, "gamma23")(s) - K3 * (U - s * dU)
            total += np.array([u2, u3]) @ (w * (s + offset))
        U = float(exact.deflection(strain, [X[n]])[0])
        np.testing.assert_allclose(displacements[n], [U, *total], rtol=0, atol=tolerance * scale)


@each_case
@each_curvature
def test_energy_is_that_of_the_returned_deflection(
    fields: Fields, form: str, stiffness: Any, k2: float
) -> None:
    """Pi = 1/2 int m^2 + (eta^2/24)/E33 int [Q33 b33^2 + 2 Q23 b33 b22 + Q22 b22^2 + 4 G b23^2]."""
    eps, K1, K2, K3 = 0.01, -0.02, k2 * ETA, 0.3
    tested: SectionLaw = law(ETA, fields, form, stiffness)
    Q33, Q22, Q23, G = stiffness
    x, w = gauss(-0.5, 0.5, k2)
    strain = np.array([eps, K1, K2, K3])
    U, curvature = tested.deflection(strain, x, 0), tested.deflection(strain, x, 2)
    assert abs(U @ w) <= 1e-14 * np.abs(U).max()
    assert abs((x * U) @ w) <= 1e-14 * np.abs(U).max()
    m = eps + K1 * x - K2 * U + K3**2 * x**2 / 2 - polynomial(fields, "gamma33")(x)
    b33 = K2 + polynomial(fields, "d33")(x)
    b22 = curvature - polynomial(fields, "g21", 1)(x) + polynomial(fields, "d22")(x)
    b23 = K3 + polynomial(fields, "g31", 1)(x) / 2 - polynomial(fields, "d23")(x) / 2
    bending = Q33 * b33**2 + 2 * Q23 * b33 * b22 + Q22 * b22**2 + 4 * G * b23**2
    density = m**2 / 2 + ETA**2 / 24 / (Q33 - Q23**2 / Q22) * bending
    assert density @ w == pytest.approx(tested.energy(strain[None])[0], rel=4e-14)


def test_forms_without_a_deflection_say_so() -> None:
    for form, fields in (("second-order", {"gamma33": [0, 0, 0.24]}), ("published-saddle", {"d33": [0.1]})):
        with pytest.raises(ValueError, match="deflection"):
            law(ETA, fields, form).deflection(np.zeros(4), X)
