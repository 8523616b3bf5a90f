"""Random ribbons that vary: sections against uniform ribbons, branches against natural shapes."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.polynomial.legendre import leggauss, legval
from piece_cases import MATERIALS
from ribbonrs._core import NaturalBranch, SectionLaw
from ribbonrs.pieces import linear

LENGTH = 10.0
SIZES = {"gamma33": 2, "d33": 1, "d22": 1, "d23": 1, "g21": 1}
"""The power of eta at which each field changes shapes."""

Amplitude = Any
"""A number, or breaks and the Legendre coefficients of the pieces between them."""


def table(S: Any, values: Any) -> Amplitude:
    """Samples joined by lines."""
    pieces = linear(np.asarray(S, dtype=float), np.asarray(values, dtype=float))
    return list(pieces.breaks), [list(c) for c in pieces.coefficients]


def random_amplitude(rng: np.random.Generator, size: float) -> Amplitude:
    """A number, lines that meet at breaks of its own, a polynomial, or polynomials that jump."""
    kind = rng.choice(["number", "table", "from zero", "polynomial", "pieces"])
    inner = np.sort(rng.uniform(0, LENGTH, rng.integers(1, 5))).tolist()
    if kind == "number":
        return size * rng.normal()
    if kind == "table":
        return table([0, *inner, LENGTH], size * rng.normal(size=len(inner) + 2))
    if kind == "from zero":
        return table([0, *inner, LENGTH], [0.0, *(size * rng.normal(size=len(inner) + 1))])
    if kind == "polynomial":
        return [0.0, LENGTH], [(size * rng.normal(size=rng.integers(2, 9))).tolist()]
    breaks = [0.0, *inner, LENGTH]
    return breaks, [(size * rng.normal(size=3)).tolist() for _ in breaks[1:]]


def at(amplitude: Amplitude, S: float) -> float:
    """The value, at a break that to its right."""
    if isinstance(amplitude, float):
        return amplitude
    breaks, pieces = amplitude
    piece = int(np.searchsorted(breaks[1:-1], S, "right"))
    a, b = breaks[piece], breaks[piece + 1]
    return float(legval((2 * S - a - b) / (b - a), pieces[piece]))


def random_steps(rng: np.random.Generator, eta: float) -> dict[str, Any]:
    """Steps across the width in some fields."""
    breaks = [-0.5, *np.sort(rng.uniform(-0.49, 0.49, rng.integers(1, 5))).tolist(), 0.5]
    names = [name for name in SIZES if rng.random() < 0.5] or ["gamma33"]
    return {
        name: (breaks, [[v] for v in eta ** SIZES[name] * rng.normal(size=len(breaks) - 1)]) for name in names
    }


def factor(rng: np.random.Generator) -> Amplitude:
    """A dimension along the ribbon."""
    return table([0, rng.uniform(1, 9), LENGTH], rng.uniform(0.4, 1.5, 3)) if rng.random() < 0.5 else 1.0


def uniform(eta: float, stiffness: Any, terms: Any, width: float, thickness: float, S: float) -> SectionLaw:
    """The law of the ribbon that is everywhere as this one is at S."""
    numbers = []
    for amplitude, fields in terms:
        for name, shape in fields.items():
            lever = width if name.startswith("d") else 1.0
            numbers.append((lever * at(amplitude, S), {name: shape}))
    return SectionLaw(eta * thickness / width, stiffness, numbers)


@pytest.mark.parametrize("seed", range(40))
def test_sections_are_those_of_uniform_ribbons(seed: int) -> None:
    """In whatever order they are asked for, of sums of few and of many profiles."""
    rng = np.random.default_rng(seed)
    eta = float(10 ** rng.uniform(-2.5, -0.8))
    stiffness = list(MATERIALS.values())[seed % 3]
    terms = [(random_amplitude(rng, 3.0), random_steps(rng, eta)) for _ in range(rng.integers(1, 9))]
    if rng.random() < 0.5:
        terms.append((random_amplitude(rng, 10 * eta**2), {"gamma33": [0.0, 0.0, 4.0]}))
    width, thickness = factor(rng), factor(rng)
    law = SectionLaw(eta, stiffness, terms, "auto", width, thickness)
    breaks = [b for amplitude, _ in terms if not isinstance(amplitude, float) for b in amplitude[0]]
    for S in [*rng.choice(breaks or [0.0], 4), *rng.uniform(0, LENGTH, 8)]:
        w, t = at(width, S), at(thickness, S)
        alone = uniform(eta, stiffness, terms, w, t, S)
        strains = rng.normal(size=(3, 4)) * [eta**2, eta**2, eta, eta] * 10 ** rng.uniform(-1, 2, (3, 1))
        local = strains * [1, w, w, w]
        places = np.full(3, S)
        energy, hessian = alone.energy(local), alone.hessian(local)
        np.testing.assert_allclose(law.energy(strains, places), w * t * energy, rtol=1e-13)
        scale = np.sqrt(2 * energy[:, None] * np.abs(np.einsum("nii->ni", hessian)))
        gradient = law.gradient(strains, places) / (w * t) / [1, w, w, w]
        assert np.all(np.abs(gradient - alone.gradient(local)) <= 1e-12 * scale), S
        one, other = law.natural_shapes(S), alone.natural_shapes()
        if one[4].all() and other[4].all():
            # To the rounding of growth near where shapes meet.
            np.testing.assert_allclose(
                one[0] * [1, w, w, w], other[0], rtol=0, atol=1e-9 * eta * np.abs(other[0] / eta).max()
            )


def random_ribbon(rng: np.random.Generator) -> SectionLaw:
    """Edge growth and chirality, gradients and steps, of the sizes at which shapes change."""
    eta = float(10 ** rng.uniform(-2.5, -0.8))
    terms: list[Any] = [
        (random_amplitude(rng, eta**2 * 10 ** rng.uniform(0.5, 1.5)), {"gamma33": [0.0, 0.0, 4.0]})
    ]
    for name in ("d23", "d33"):
        if rng.random() < 0.4:
            terms.append((random_amplitude(rng, eta * 10 ** rng.uniform(-2, 1)), {name: [1.0]}))
    terms += [(random_amplitude(rng, 3.0), random_steps(rng, eta)) for _ in range(rng.integers(0, 3))]
    stiffness = list(MATERIALS.values())[rng.integers(3)]
    return SectionLaw(eta, stiffness, terms, "auto", factor(rng), factor(rng))


def check_branch(law: SectionLaw, branch: NaturalBranch, S: Any) -> None:
    """Stable natural shapes everywhere but within 1e-6 of the length of an event."""
    places = np.array([event[0] for event in branch.events])
    assert np.all(np.diff(places) >= 0)
    away = np.array([places.size == 0 or np.abs(places - s).min() > 1e-6 * LENGTH for s in S])
    for s, strain in zip(S[away], branch.strains(S[away]), strict=True):
        shapes, _, index, _, resolved = law.natural_shapes(float(s))
        stable = shapes[(index == 0) | ~resolved]
        scale = max(law.eta, np.abs(shapes[:, 2:]).max())
        # 1e-12 of the strains, but for the amplification by softness beside a bifurcation.
        assert np.abs(stable - strain).max(axis=1).min() <= 1e-9 * scale, s
    breaks = branch.breaks
    assert (breaks[0], breaks[-1]) == (0.0, LENGTH)
    nodes, weights = leggauss(14)
    half, middle = np.diff(breaks)[:, None] / 2, (breaks[1:] + breaks[:-1])[:, None] / 2
    points = (middle + half * nodes).ravel()
    density = law.energy(branch.strains(points), points).reshape(-1, nodes.size)
    mean = float(np.sum(half * weights * density)) / LENGTH
    assert branch.energy == pytest.approx(mean, rel=1e-11, abs=1e-13 * law.eta**4)


@pytest.mark.parametrize("seed", range(60))
def test_branches_are_stable_shapes_everywhere(seed: int) -> None:
    rng = np.random.default_rng(1000 + seed)
    law = random_ribbon(rng)
    for branch in law.natural_branches(LENGTH):
        check_branch(law, branch, np.sort(rng.uniform(0, LENGTH, 30)))


BEND = (259**0.5 - 7) / 2
"""Edge growth over eta^2 at which an incompressible flat ribbon bends."""


@pytest.mark.parametrize("mean", [0.0, 1.0])
@pytest.mark.parametrize("at", [0.37, 2.9, 5.0, 5.6, 6.2, 9.71])
def test_no_window_of_instability_is_stepped_over(at: float, mean: float) -> None:
    """A flat ribbon, straight and smooth, that bends over a twentieth of its length.

    With `mean` 0 the growth has no mean, and not even eps tells that it varies.
    """
    eta, half, rise = 0.1, 0.25, 1e-3
    # BEND (1 + rise (1 - ((S - at)/half)^2)) in P_n(2 S/L - 1)
    y, steep = 2 * at / LENGTH - 1, rise * (LENGTH / 2 / half) ** 2
    series = [1 + rise - steep * (y * y + 1 / 3), 2 * steep * y, -2 / 3 * steep]
    amplitude = [0.0, LENGTH], [[BEND * eta**2 * c for c in series]]
    law = SectionLaw(eta, MATERIALS["incompressible"], [(amplitude, {"gamma33": [(mean - 1) / 3, 0.0, 4.0]})])
    (branch,) = law.natural_branches(LENGTH)
    assert branch.phases == ["flat", "bent", "flat"]
    # An eigenvalue counts as negative below -1e-13, for which the growth takes 1e-12 half/(2 rise).
    assert [S for S, *_ in branch.events] == pytest.approx([at - half, at + half], abs=2e-10)
    check_branch(law, branch, np.linspace(0.0, LENGTH, 201))


@pytest.mark.parametrize("growth", [BEND, 5.0])
@pytest.mark.parametrize("before", [0.0, 9.0, None])
@pytest.mark.parametrize("after", [0.0, 9.0, None])
def test_growth_that_rests_at_a_bifurcation(growth: float, before: float | None, after: float | None) -> None:
    eta = 0.1
    S, values = [2.0, 7.0], [growth, growth]
    for place, value, end in ((0.0, before, 0), (LENGTH, after, 2)):
        S.insert(end + (end > 0), place)
        values.insert(end + (end > 0), growth if value is None else value)
    order = np.argsort(S)
    amplitude = table(np.array(S)[order], eta**2 * np.array(values)[order])
    law = SectionLaw(eta, MATERIALS["incompressible"], [(amplitude, {"gamma33": [0.0, 0.0, 4.0]})])
    for branch in law.natural_branches(LENGTH):
        assert len(branch.breaks) < 300
        assert len(branch.events) <= 2
        S = np.linspace(0.0, LENGTH, 101)
        # Where shapes meet they are known to the root of the rounding.
        gradient = law.gradient(branch.strains(S), S) / [eta**2, eta**2, eta**3, eta**3]
        assert np.abs(gradient).max() < 1e-12
        stiffness = law.hessian(branch.strains(S), S)[:, 2:, 2:] / eta**2
        assert np.linalg.eigvalsh(stiffness).min() > -1e-12
