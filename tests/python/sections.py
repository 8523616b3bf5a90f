"""Laws, strains and scales shared by the tests of the section law."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
from ribbonrs._core import SectionLaw

INCOMPRESSIBLE = (4 / 3, 4 / 3, 2 / 3, 1 / 3)
ORTHOTROPIC = (1.7, 0.9, 0.35, 0.5)
K2_GRID = [0, 1e-12, 1e-8, 1e-4, 1e-2, 0.1, 0.5, 1, 2, 5, 7.4, 7.5, 10, 40, 400, 4e3, 1e5, 1e6]
K2_SIGNED = [s * k for k in K2_GRID for s in (1, -1) if k or s == 1]
K3_GRID = [0, 1e-3, 1, 30, 1e3]
XI_GRID = [0, 1e-3, -1e-3, 1, -1, 4.55, 5, 100, -100, 1e4, -1e4]
ETAS = [0.5, 0.1, 0.01, 1e-4]
Fields = Mapping[str, Sequence[float]]


def law(eta: float, fields: Fields, form: str, stiffness: Sequence[float] = INCOMPRESSIBLE) -> SectionLaw:
    """The compiled law."""
    terms = [(1.0, {k: list(map(float, v)) for k, v in fields.items()})]
    return SectionLaw(eta, tuple(stiffness), terms, form)


def growth_squared(eta: float, fields: Fields) -> float:
    """Sum of the squared growth terms at the edge: strains as they are, curvatures times eta."""
    total = 0.0
    for name, coefficients in fields.items():
        factor = 1.0 if name == "gamma33" else eta
        shift = 1 if name in ("g21", "g31") else 0  # these act by their slope
        total += sum(
            (factor * max(k, 1) * c / 2 ** max(k - shift, 0)) ** 2 for k, c in enumerate(coefficients)
        )
    return total


EDGE = {"gamma33": [0.0, 0.0, 0.24]}
SKEW = {"gamma33": [0.01, 0.02, 0.24, -0.3], "d33": [0.1, 0.0, 0.3], "d22": [0.05], "g21": [0.0, 0.1, 0.2]}


def samples(eta: float, seed: int, n: int = 200) -> Any:
    """Random strains of the sizes that matter to shapes."""
    rng = np.random.default_rng(seed)
    k = rng.normal(size=(n, 4)) * 10.0 ** rng.uniform(-2, 2, (n, 4))
    return k * np.array([eta**2, eta**2, eta, eta])


def numbers(tested: SectionLaw, strains: Any) -> Iterator[tuple[Any, Any]]:
    """Energy, gradient and Hessian, each with the scale its rounding is relative to."""
    e, g, H = tested.energy(strains), tested.gradient(strains), tested.hessian(strains)
    ungrown = np.array([1.0, 1 / 12, tested.eta**2 / 12, tested.eta**2 / 9])
    stiffness = np.abs(np.einsum("nii->ni", H)) + ungrown
    yield e, e
    yield g, np.abs(g) + np.sqrt(2 * e[:, None] * stiffness)
    yield H, np.abs(H) + np.sqrt(stiffness[:, :, None] * stiffness[:, None, :])
