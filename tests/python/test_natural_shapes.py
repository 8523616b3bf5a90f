"""All natural shapes: against an independent dense search, and the known transitions, found by bisection.

In the tests xi is edge growth over eta^2, omega = d23/(2 eta), k2 and k3 curvatures over eta.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
import pytest
from search import Ribbon
from sections import INCOMPRESSIBLE, ORTHOTROPIC, law

ETA = 0.1


class Shapes(NamedTuple):
    """Equilibria in scaled quantities, lowest energy first."""

    k: Any  # (m, 2): K2, K3 over eta
    energy: Any  # over eta^4
    index: Any
    phase: list[str]
    resolved: Any


def scaled(fields: dict[str, list[float]], eta: float) -> dict[str, list[float]]:
    """Growth from strains over eta^2 and curvatures over eta."""
    return {n: [c * (eta**2 if n == "gamma33" else eta) for c in v] for n, v in fields.items()}


def natural(
    fields: dict[str, list[float]], eta: float = ETA, stiffness: tuple[float, ...] = INCOMPRESSIBLE
) -> Shapes:
    """What the compiled core finds."""
    strains, energy, index, phase, resolved = law(
        eta, scaled(fields, eta), "auto", stiffness
    ).natural_shapes()
    return Shapes(strains[:, 2:] / eta, energy / eta**4, index, list(phase), resolved)


def edge(xi: float, omega: float = 0.0) -> dict[str, list[float]]:
    """Edge growth and chirality."""
    return {"gamma33": [0.0, 0.0, 4 * xi], "d23": [2 * omega]}


def random_growth(kind: str, rng: np.random.Generator) -> tuple[dict[str, list[float]], tuple[float, ...]]:
    """A growth of the sizes at which shapes change, and a stiffness."""
    xi = float(rng.uniform(-5, 15) if rng.random() < 0.7 else rng.normal() * 10 ** rng.uniform(0, 3))
    omega = float(rng.choice([0.0, 1.0]) * rng.normal() * 10 ** rng.uniform(-2, 1.5))
    d33, d22 = (float(rng.normal() * 10 ** rng.uniform(-2, 1.5)) for _ in range(2))
    if kind == "edge":
        return edge(xi, omega), INCOMPRESSIBLE
    if kind == "thickness":
        return {"d33": [d33], "d22": [d22 * float(rng.choice([0, 1]))], "d23": [2 * omega]}, INCOMPRESSIBLE
    if kind == "mixture":
        return {
            **edge(xi, omega),
            "d33": [d33],
            "d22": [d22],
        }, ORTHOTROPIC if rng.random() < 0.5 else INCOMPRESSIBLE
    fields: dict[str, list[float]] = {}
    for name in ("gamma33", "d33", "d22", "d23", "g21", "g31"):
        if rng.random() < 0.6:
            size = 10 ** rng.uniform(-1, 1.7 if name == "gamma33" else 1)
            powers = 2.0 ** np.arange(rng.integers(1, 8))
            fields[name] = (size * rng.normal(size=powers.size) * powers).tolist()
    if rng.random() < 0.5:  # even across the width and achiral: more symmetry, more shapes
        fields = {n: [c * (i % 2 == 0) for i, c in enumerate(v)] for n, v in fields.items() if n == "gamma33"}
    return fields, ORTHOTROPIC if rng.random() < 0.3 else INCOMPRESSIBLE


def disagreement(fields: dict[str, list[float]], stiffness: tuple[float, ...], eta: float) -> str:
    """What the core and the dense search see differently; empty if nothing."""
    found = natural(fields, eta, stiffness)
    ribbon = Ribbon(fields, stiffness)
    expected = np.array(ribbon.shapes()).reshape(-1, 2)

    def distances(point: Any, points: Any) -> Any:
        return np.abs(points - point).max(axis=1) / max(1.0, np.abs(point).max())

    for point in expected:
        # An equilibrium that is nearly one of a pair is known only to the root of the rounding.
        if distances(point, found.k).min() > 1e-6:
            return f"missed {point.tolist()}"
    for point, energy, index, resolved in zip(
        found.k, found.energy, found.index, found.resolved, strict=True
    ):
        near = expected[distances(point, expected) < 1e-6]
        if not resolved:
            continue
        if len(near) != 1:
            return f"{len(near)} equilibria at {point.tolist()}"
        hessian = ribbon.stationarity(*near[0])[1]
        if abs(energy - ribbon.energy(*near[0])) > 1e-12 * (1 + abs(energy)):
            return f"energy {energy} at {point.tolist()}"
        eigenvalues = np.linalg.eigvalsh(hessian)
        if np.abs(eigenvalues).min() > 1e-6 and index != np.sum(eigenvalues < 0):
            return f"index {index} at {point.tolist()}"
    return ""


@pytest.mark.parametrize(
    ("kind", "count", "seed"),
    [
        ("edge", 350, 10),
        ("thickness", 300, 20),
        ("mixture", 250, 30),
        ("profile", 400, 40),
    ],
)
def test_all_shapes_are_found(kind: str, count: int, seed: int) -> None:
    rng = np.random.default_rng(seed)
    differences = []
    for case in range(count):
        fields, stiffness = random_growth(kind, rng)
        difference = disagreement(fields, stiffness, float(10 ** rng.uniform(-4, -0.31)))
        if difference:
            differences.append((case, difference, fields, stiffness))
    assert not differences


def threshold(holds: Callable[[float], bool], low: float, high: float) -> float:
    """Where `holds` turns from false to true."""
    assert not holds(low)
    assert holds(high)
    while high - low > 1e-14 * high:
        middle = (low + high) / 2
        if middle in (low, high):
            break
        low, high = (low, middle) if holds(middle) else (middle, high)
    return (low + high) / 2


def straight(shapes: Shapes, phase: str) -> int:
    """Position of the flat state, or of the twisted state of lowest energy."""
    return shapes.phase.index(phase)


@pytest.mark.parametrize("eta", [0.3, 0.1, 1e-3])
def test_flat_ribbons_bend_then_twist(eta: float) -> None:
    """The flat state loses stability to bending at (-7 + sqrt(259))/2 and again, to twist, at 5."""

    def negative(xi: float) -> int:
        shapes = natural(edge(xi), eta)
        return int(shapes.index[straight(shapes, "flat")])

    assert threshold(lambda xi: negative(xi) >= 1, 0.0, 20.0) == pytest.approx((-7 + 259**0.5) / 2, rel=1e-12)
    assert threshold(lambda xi: negative(xi) >= 2, 0.0, 20.0) == pytest.approx(5.0, rel=1e-12)
    assert threshold(lambda xi: "bent" in natural(edge(xi), eta).phase, 0.0, 20.0) == pytest.approx(
        (-7 + 259**0.5) / 2, abs=1e-9
    )
    assert threshold(lambda xi: "twisted" in natural(edge(xi), eta).phase, 0.0, 20.0) == pytest.approx(
        5.0, abs=1e-9
    )


# xi, k2, energy less (1/2)(eps - eps_relaxed)^2: bent, flat, twisted; computed separately with 50 digits
BENT = [
    (4.55, 0.150499, 0.9201106, 0.9201111, None),
    (4.7, 1.031686, 0.9807360, 0.9817778, None),
    (5.0, 1.774270, 1.1019995, 1.1111111, None),
    (5.3, 2.287347, 1.2232797, 1.2484444, 1.2444444),
    (6.0, 3.177341, 1.5063322, 1.6000000, 1.5555556),
    (8.0, 4.898911, 2.3155497, 2.8444444, 2.4444444),
    (10.0, 6.157513, 3.1254882, 4.4444444, 3.3333333),
    (20.0, 10.376224, 7.1854055, 17.777778, 7.7777778),
]


@pytest.mark.parametrize(("xi", "k2", "bent", "flat", "twisted"), BENT)
def test_bent_states_are_the_stable_ones(
    xi: float, k2: float, bent: float, flat: float, twisted: Any
) -> None:
    shapes = natural(edge(xi))
    assert shapes.phase[:2] == ["bent", "bent"]
    np.testing.assert_allclose(shapes.k[:2], [[k2, 0], [-k2, 0]], rtol=0, atol=6e-7)
    np.testing.assert_allclose(shapes.energy[:2], bent, rtol=0, atol=6e-8)
    assert shapes.index.tolist() == sorted(shapes.index.tolist())
    assert shapes.index[:2].tolist() == [0, 0]
    assert shapes.energy[straight(shapes, "flat")] == pytest.approx(flat, abs=6e-7)
    if twisted is not None:
        assert shapes.phase == ["bent", "bent", "twisted", "twisted", "flat"]
        np.testing.assert_allclose(shapes.energy[2:4], twisted, rtol=0, atol=6e-8)


@pytest.mark.parametrize("xi", [5.001, 5.5, 7.0, 30.0, 1e3])
def test_twisted_branch_keeps_its_membrane_strain(xi: float) -> None:
    """C/eta^2 = k3^2/2 - 4 xi = -20, eq. (64); unstable to bending, and no helix branches off."""
    shapes = natural(edge(xi))
    first = straight(shapes, "twisted")
    assert shapes.k[first, 1] ** 2 / 2 - 4 * xi == pytest.approx(-20.0, abs=1e-13 * xi)
    assert shapes.index[first] == 1
    assert "helical" not in shapes.phase


@pytest.mark.parametrize(("omega", "rounded"), [(0.2, 5.155), (0.2226, 5.300)])
def test_trace_of_chirality_turns_twist_into_a_helix(omega: float, rounded: float) -> None:
    """The twisted state loses stability at C/eta^2 = 14 - sqrt(1036); a helix of the same hand takes over."""
    onset = threshold(lambda xi: "helical" in natural(edge(xi, omega)).phase, 3.0, 8.0)
    c = 14 - 1036**0.5
    k3 = omega / (1 + c / 20)
    assert onset == pytest.approx((k3**2 / 2 - c) / 4, abs=1e-9)
    assert onset == pytest.approx(rounded, abs=6e-4)

    def unstable(xi: float) -> bool:
        shapes = natural(edge(xi, omega))
        return bool(shapes.index[straight(shapes, "twisted")] > 0)

    # An eigenvalue counts as negative below -1e-13, which is 1.4e-11 in xi.
    assert threshold(unstable, 3.0, 8.0) == pytest.approx((k3**2 / 2 - c) / 4, abs=3e-11)
    just_below = natural(edge(onset - 1e-6, omega))
    assert just_below.k[0, 1] == pytest.approx(k3, rel=1e-6)


def test_helix_beyond_the_transition() -> None:
    shapes = natural(edge(6.0, 0.2))
    assert shapes.phase[:2] == ["helical", "helical"]
    assert shapes.index[:2].tolist() == [0, 0]
    np.testing.assert_allclose(shapes.k[:2], [[2.4156, 2.2149], [-2.4156, 2.2149]], rtol=0, atol=6e-5)
    mirrored = natural(edge(6.0, -0.2))
    np.testing.assert_allclose(mirrored.k[0], [2.4156, -2.2149], rtol=0, atol=6e-5)


def test_chirality_alone() -> None:
    """Narrow to wide: a helicoid coils where C/eta^2 = 14 + sqrt(1036), at omega = 31.8066, k3 = 9.6111."""

    def coiled(omega: float) -> bool:
        return "helical" in natural(edge(0.0, omega)).phase

    onset = threshold(coiled, 1.0, 100.0)
    assert onset == pytest.approx(31.8066, abs=6e-5)
    assert natural(edge(0.0, onset - 1e-5)).k[0, 1] == pytest.approx(9.6111, abs=6e-5)


def test_thickness_gradient_makes_a_stress_free_cylinder() -> None:
    shapes = natural({"d33": [1.7]})
    np.testing.assert_allclose(shapes.k[0], [-1.7, 0.0], rtol=1e-14, atol=0)
    assert shapes.energy[0] < 1e-28
    assert shapes.phase[0] == "bent"


def test_no_growth_no_shape() -> None:
    shapes = natural({})
    np.testing.assert_array_equal(shapes.k, [[0.0, 0.0]])
    assert shapes.phase == ["flat"]
    assert shapes.index.tolist() == [0]
    assert shapes.resolved.tolist() == [True]


def test_mirror_images_are_ordered_and_of_equal_energy() -> None:
    shapes = natural(edge(9.0))
    assert np.all(np.diff(shapes.energy) >= 0)
    for a, b in ((0, 1), (2, 3)):
        assert shapes.energy[a] == shapes.energy[b]
        np.testing.assert_array_equal(shapes.k[a], -shapes.k[b])
        assert shapes.k[a].max() > 0


def test_close_pairs_are_reported() -> None:
    """Just past a fold two states are too close to tell apart and come back as one, unresolved."""

    def count(xi: float) -> int:
        return len(natural(edge(xi, 0.2)).phase)

    # The two twisted states against the chirality are born at a double root of
    # k3^3 + 8 (5 - xi) k3 = 40 omega.
    fold = threshold(lambda xi: count(xi) > 3, 5.5, 6.5)
    assert fold == pytest.approx(5 + (27 * 64 / 4) ** (1 / 3) / 8, rel=1e-12)
    near = natural(edge(fold * (1 + 1e-14), 0.2))
    assert len(near.phase) == 4
    assert np.sum(~near.resolved) == 1
    far = natural(edge(fold * (1 + 1e-6), 0.2))
    assert len(far.phase) == 5
    assert far.resolved.all()
