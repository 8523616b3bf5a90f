"""Natural shapes of growth in pieces: against an independent dense search, and by the count of their indices.

Growth is given on each piece by Legendre coefficients in its own coordinate, gamma33 in units of eta^2 and
all else in units of eta; k = K2/eta and q = K3/eta.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from numpy.polynomial.legendre import legder
from piece_cases import MATERIALS
from ribbonrs._core import SectionLaw
from search import Ribbon

Series = Sequence[Sequence[float]]
Growth = tuple[list[float], dict[str, Series]]
"""The breaks from edge to edge, and for each field the coefficients of each piece."""


def core(growth: Growth, eta: float, stiffness: Sequence[float]) -> SectionLaw:
    """The compiled law."""
    breaks, fields = growth
    pieces = {
        name: (breaks, [[float(c) * (eta**2 if name == "gamma33" else eta) for c in p] for p in series])
        for name, series in fields.items()
    }
    return SectionLaw(eta, tuple(stiffness), [(1.0, pieces)])


class Pieces(Ribbon):
    """The energy of growth in pieces, from every mode of a space of functions smooth between the breaks.

    A function is a vector of its components on the orthonormal Legendre functions of each piece.
    """

    def __init__(self, growth: Growth, stiffness: Sequence[float]) -> None:
        Q33, Q22, Q23, G = stiffness
        E33 = Q33 - Q23**2 / Q22
        self.nu, self.g = Q23 / Q22, G / (6 * E33)
        breaks, fields = growth
        h, middle = np.diff(breaks), (np.array(breaks[1:]) + breaks[:-1]) / 2
        zero = [[0.0]] * h.size
        raw = {n: fields.get(n, zero) for n in ("gamma33", "d33", "d22", "d23", "g21", "g31")}
        slope = {
            n: [2 / w * legder(c) if len(c) > 1 else [0.0] for c, w in zip(raw[n], h, strict=True)]
            for n in ("g21", "g31")
        }
        degree = max(len(c) for series in raw.values() for c in series)
        # A deflection of layers exp(a x), a^4 = -k^2/4 beta^2, to 1e-10 for k < 100 on the whole width.
        sizes = [degree + 6 + int(np.ceil(32 * w**0.5)) for w in h]

        def vector(series: Series, extra: int = 2) -> Any:
            parts = []
            for c, w, size in zip(series, h, sizes, strict=True):
                part = np.zeros(size + extra)
                part[: len(c)] = np.sqrt(w / (2 * np.arange(len(c)) + 1)) * np.asarray(c)
                parts.append(part)
            return np.concatenate(parts)

        one = vector([[1.0]] * h.size)
        x = vector([[m, w / 2] for m, w in zip(middle, h, strict=True)])

        def soft(v: Any) -> Any:
            for _ in range(2):
                for direction in (one, x - one @ x * one):
                    v = v - np.multiply.outer(direction / (direction @ direction), direction @ v)
            return v

        field = {n: vector(series) for n, series in raw.items()}
        twist = field["d23"] / 2 - vector(slope["g31"]) / 2
        natural = vector(raw["d22"], 0) + self.nu * vector(raw["d33"], 0) - vector(slope["g21"], 0)
        self.d, self.q0 = field["d33"] @ one, twist @ one
        self.fixed = (field["d33"] @ field["d33"] - self.d**2) / 24 + self.g * (twist @ twist - self.q0**2)
        gamma = soft(field["gamma33"])
        own = field["d33"] @ field["d33"] / 24 + Q22 / (24 * E33) * natural @ natural + self.g * twist @ twist
        # As for smooth growth: |v|^2 <= |v| |v_g| + |gamma|^2/4 of the bending strain v less growth's own.
        self.bound = 1.02 * np.sqrt(24) * (np.sqrt(own) + np.sqrt(own + gamma @ gamma)) / 2 + 0.1
        F = soft(primitive(h, [n + 1 for n in sizes]) @ primitive(h, sizes))
        left, sigma, _ = np.linalg.svd(F)
        self.mu = 12 * E33 / Q22 * np.append(sigma, np.zeros(len(left) - len(sigma))) ** 2
        parts = F @ vector([[1.0]] * h.size, 0), F @ natural, gamma
        self.t, self.s, self.gamma = (left.T @ part for part in parts)


def primitive(h: Any, sizes: Sequence[int]) -> Any:
    """The integral from the left edge, of one degree more on each piece, between orthonormal components."""
    rows, columns = np.cumsum([0, *(n + 1 for n in sizes)]), np.cumsum([0, *sizes])
    matrix = np.zeros((rows[-1], columns[-1]))
    for piece, (w, size) in enumerate(zip(h, sizes, strict=True)):
        row, column = rows[piece], columns[piece]
        # What the mean of this piece adds to those after it.
        matrix[rows[piece + 1 : -1], column] = np.sqrt(w * h[piece + 1 :])
        matrix[row, column] = w / 2
        # int P_n = (P_(n+1) - P_(n-1))/(2n+1) from -1, and P_1 + P_0 for n = 0
        for n in range(size):
            step = w / 2 / np.sqrt(2 * n + 1)
            matrix[row + n + 1, column + n] = step / np.sqrt(2 * n + 3)
            if n:
                matrix[row + n - 1, column + n] = -step / np.sqrt(2 * n - 1)
    return matrix


def cut(rng: np.random.Generator, most: int = 20) -> list[float]:
    """Up to so many pieces, some of them narrow."""
    inner = rng.uniform(-0.49, 0.49, rng.integers(1, most)).tolist()
    if rng.random() < 0.2:
        inner.append(inner[0] + 10 ** rng.uniform(-9, -3))
    return [-0.5, *sorted(inner), 0.5]


def steps(rng: np.random.Generator, breaks: Sequence[float], size: float) -> Series:
    """A constant on each piece, or a value on one of them alone."""
    values = size * rng.normal(size=len(breaks) - 1)
    if rng.random() < 0.3:
        values[np.arange(values.size) != rng.integers(values.size)] = 0.0
    return [[v] for v in values]


def lines(rng: np.random.Generator, breaks: Sequence[float], size: float) -> Series:
    """Lines that meet at the breaks."""
    values = size * rng.normal(size=len(breaks))
    return [[(a + b) / 2, (b - a) / 2] for a, b in pairwise(values)]


def polynomials(rng: np.random.Generator, breaks: Sequence[float], size: float) -> Series:
    """Up to quartics that do not meet."""
    return [(size * rng.normal(size=rng.integers(1, 6))).tolist() for _ in breaks[1:]]


KINDS: dict[str, Callable[..., Series]] = {"steps": steps, "lines": lines, "polynomials": polynomials}


def random_growth(rng: np.random.Generator, kind: str) -> Growth:
    """Several fields at the sizes at which shapes change."""
    breaks = cut(rng)
    fields = {
        name: KINDS[kind](rng, breaks, 10 ** rng.uniform(-1, 1.5 if name == "gamma33" else 1))
        for name in ("gamma33", "d33", "d22", "d23")
        if rng.random() < (0.9 if name == "gamma33" else 0.4)
    }
    return breaks, fields or {"gamma33": steps(rng, breaks, 10.0)}


def symmetric(rng: np.random.Generator) -> Growth:
    """Steps even across the width, with or without twist: more symmetry, more shapes."""
    half = np.sort(rng.uniform(0.01, 0.49, rng.integers(1, 8)))
    values = 10 ** rng.uniform(0.5, 1.7) * rng.normal(size=half.size + 1)
    breaks = [-0.5, *(-half[::-1]).tolist(), *half.tolist(), 0.5]
    fields: dict[str, Series] = {"gamma33": [[v] for v in [*values, *values[-2::-1]]]}
    if rng.random() < 0.5:
        fields["d23"] = [[10 ** rng.uniform(-2, 1)]] * (len(breaks) - 1)
    return breaks, fields


def disagreement(growth: Growth, eta: float, stiffness: Sequence[float]) -> str:
    """What the core and the dense search see differently; empty if nothing."""
    strains, energies, indices, _, resolved = core(growth, eta, stiffness).natural_shapes()
    found = strains[:, 2:] / eta
    ribbon = Pieces(growth, stiffness)
    expected = np.array(ribbon.shapes()).reshape(-1, 2)

    def distances(point: Any, points: Any) -> Any:
        return np.abs(points - point).max(axis=1) / max(1.0, np.abs(point).max())

    for point in expected:
        if distances(point, found).min() > 1e-6:
            return f"missed {point.tolist()}"
    for point, energy, index in zip(found[resolved], energies[resolved], indices[resolved], strict=True):
        near = expected[distances(point, expected) < 1e-6]
        if len(near) != 1:
            return f"{len(near)} equilibria at {point.tolist()}"
        # Rounding of the 300 squares in either sum.
        if abs(energy / eta**4 - ribbon.energy(*near[0])) > 1e-12 * (1 + energy / eta**4):
            return f"energy {energy / eta**4} at {point.tolist()}"
        eigenvalues = np.linalg.eigvalsh(ribbon.stationarity(*near[0])[1])
        if np.abs(eigenvalues).min() > 1e-6 and index != np.sum(eigenvalues < 0):
            return f"index {index} at {point.tolist()}"
    return ""


@pytest.mark.parametrize(("kind", "seed"), [("steps", 1), ("lines", 2), ("polynomials", 3), ("symmetric", 4)])
def test_all_shapes_are_found(kind: str, seed: int) -> None:
    rng = np.random.default_rng(seed)
    for case in range(15):
        growth = symmetric(rng) if kind == "symmetric" else random_growth(rng, kind)
        stiffness = list(MATERIALS.values())[case % 3]
        eta = float(10 ** rng.uniform(-3, -0.52))
        assert not disagreement(growth, eta, stiffness), (case, growth)


def large(rng: np.random.Generator) -> Growth:
    """Any size, from next to nothing to bending to hundreds of eta."""
    breaks = cut(rng)
    names = ("gamma33", "d33", "d22", "d23", "g21")
    fields = {n: steps(rng, breaks, 10 ** rng.uniform(-3, 4)) for n in names if rng.random() < 0.6}
    return breaks, fields


def without_mean_twist(rng: np.random.Generator) -> Growth:
    """Steps of d23 whose mean is rounding, and edges that grow."""
    breaks = cut(rng)
    twist = 10 ** rng.uniform(-1, 2) * rng.normal(size=len(breaks) - 1)
    twist -= twist @ np.diff(breaks)
    return breaks, {"d23": [[v] for v in twist], "gamma33": parabola(breaks, 10 ** rng.uniform(0.3, 2))}


def nearly_smooth(rng: np.random.Generator) -> Growth:
    """Edges that grow, and steps down to the rounding of it."""
    breaks = cut(rng)
    xi = rng.choice([-1, 1]) * 10 ** rng.uniform(0.3, 3)
    jumps = steps(rng, breaks, xi * 10 ** rng.uniform(-16, -2))
    together = zip(parabola(breaks, xi), jumps, strict=True)
    return breaks, {"gamma33": [[mean + jump, *rest] for (mean, *rest), (jump,) in together]}


def nearly_stress_free(rng: np.random.Generator) -> Growth:
    """A cylinder that fits, but for small steps."""
    breaks = cut(rng)
    d = 10 ** rng.uniform(-1, 3)
    fields: dict[str, Series] = {}
    for name in ("d33", "d22"):
        errors = steps(rng, breaks, d * 10 ** rng.uniform(-16, -1))
        fields[name] = [[(d if name == "d33" else rng.choice([0, -d, d])) + e] for (e,) in errors]
    return breaks, fields


def parabola(breaks: Sequence[float], xi: float) -> Series:
    """4 xi x^2."""
    return [
        [4 * xi * (m * m + w * w / 12), 4 * xi * m * w, 4 * xi * w * w / 6]
        for m, w in (((a + b) / 2, b - a) for a, b in pairwise(breaks))
    ]


FAMILIES = {f.__name__: f for f in (large, without_mean_twist, nearly_smooth, nearly_stress_free, symmetric)}


@pytest.mark.parametrize("name", FAMILIES)
def test_indices_add_up(name: str) -> None:
    """The energy grows in every direction, so over all shapes the sum of (-1)^index is 1; one is stable."""
    rng = np.random.default_rng(7)
    for case in range(300):
        growth = FAMILIES[name](rng)
        eta = float(10 ** rng.uniform(-3, -0.52))
        law = core(growth, eta, list(MATERIALS.values())[case % 3])
        strains, energies, indices, _, resolved = law.natural_shapes()
        assert resolved.all(), (case, growth)
        assert np.sum((-1.0) ** indices) == 1, (case, growth)
        assert indices[0] == 0, (case, growth)
        gradient, stiffness = law.gradient(strains), np.abs(np.einsum("nii->ni", law.hessian(strains)))
        # Rounding of what cancels in the gradient, and of the strains; where both are zero, of the growth.
        size = np.sqrt(2 * energies[:, None] * stiffness) + stiffness * np.abs(strains)
        largest = max((abs(c) for series in growth[1].values() for piece in series for c in piece), default=0)
        floor = 1e-30 * eta**2 * (1 + largest**2)
        assert np.all(np.abs(gradient) <= 1e-13 * size + floor), (case, growth)
