"""Where the body of a state is sampled, along the ribbon and across it, to be integrated and differentiated.

Along the ribbon each station lies among equally spaced sections, and derivatives are those of the polynomial
through them; across it places are Gauss points between the breaks of growth.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.polynomial.legendre import legder, leggauss, legvander
from numpy.polynomial.polynomial import polyder, polyval

from .arrays import Array

__all__ = ["Across", "Stations", "across", "stations", "uniform_station"]

SECTIONS = 5
"""Sections about each station: derivatives are of fourth order in the distance."""

STEP = 1 / 8
"""Their distance in widths: what varies within less, as at a jump, is spread over half a width."""

REACH = STEP * (SECTIONS // 2)
"""How far a station sees."""

FEWEST, MOST = 3, 12
"""Gauss points of a stretch of the ribbon: they resolve the polynomials that strains are between breaks."""


@dataclass(frozen=True)
class Stations:
    """Stations along the ribbon.

    Attributes
    ----------
    S : (m, k) array
        The sections about each of m stations.
    at : (m,) array of int
        Which of the k is the station itself.
    weights : (m,) array
        Of an integral over S.
    derivative : (k, k) array
        From values at the k sections to derivatives in S there.
    """

    S: Array
    at: Array
    weights: Array
    derivative: Array

    def here(self, values: Array) -> Array:
        """Return values (m, k, ...) at the stations themselves, (m, ...)."""
        return np.asarray(values[np.arange(self.at.size), self.at])


@dataclass(frozen=True)
class Across:
    """Places across the width.

    Attributes
    ----------
    x : (n,) array
        X2 over the width there.
    weights : (n,) array
        Of an integral over x.
    blocks : tuple of array
        For each piece in turn, from values on it to derivatives in x.
    """

    x: Array
    weights: Array
    blocks: tuple[Array, ...]

    def derivative(self, f: Array) -> Array:
        """Return the derivative in x of f (..., n), on each piece."""
        ends = np.cumsum([len(block) for block in self.blocks])
        parts = zip(np.split(f, ends[:-1], axis=-1), self.blocks, strict=True)
        return np.concatenate([part @ block.T for part, block in parts], axis=-1)


def uniform_station(length: float) -> Stations:
    """Return the one station of a ribbon that is the same everywhere."""
    zero = np.zeros((1, 1))
    return Stations(zero, np.zeros(1, dtype=np.int64), np.array([length]), zero)


def stations(breaks: Array, length: float) -> Stations:
    """Return stations between breaks from 0 to `length`, and within `REACH` of them, where strains may jump.

    Those closer than `STEP` to another count as one.
    """
    kept = [0.0]
    for S in np.unique(np.concatenate([breaks - REACH, breaks, breaks + REACH])):
        if S - kept[-1] >= STEP and length - S >= STEP:
            kept.append(float(S))
    middles, weights = map(np.concatenate, zip(*map(_stretch, kept, [*kept[1:], length]), strict=True))
    step = min(STEP, length / (SECTIONS + 1))
    last = SECTIONS - 1
    left, right = (np.floor(room / step).astype(np.int64) for room in (middles, length - middles))
    at = np.clip(last // 2, last - np.minimum(right, last), left)
    places = np.arange(SECTIONS)
    powers = np.eye(SECTIONS)
    slopes = np.stack([polyval(places, polyder(power)) for power in powers], axis=1)
    derivative = slopes @ np.linalg.inv(np.vander(places, increasing=True)) / step
    sections = np.clip(middles[:, None] + step * (places - at[:, None]), 0.0, length)
    return Stations(sections, at, weights, derivative)


def _stretch(start: float, end: float) -> tuple[Array, Array]:
    """Gauss points of a stretch, two for each width, and their weights."""
    t, w = leggauss(min(MOST, FEWEST + math.ceil(2 * (end - start))))
    half = 0.5 * (end - start)
    return start + half * (1.0 + t), half * w


def across(breaks: Sequence[float], degree: int, layer: float) -> Across:
    """Return Gauss points between breaks from -1/2 to 1/2 for polynomials and for edge layers so wide."""
    pieces = [_piece(start, end, degree, layer) for start, end in pairwise(breaks)]
    x, weights, blocks = zip(*pieces, strict=True)
    return Across(np.concatenate(x), np.concatenate(weights), blocks)


def _piece(start: float, end: float, degree: int, layer: float) -> tuple[Array, Array, Array]:
    """Gauss points, whose distance at the ends falls with the square of their number."""
    count = 2 + degree + math.ceil(6 * math.sqrt((end - start) / layer))
    t, w = leggauss(count)
    half = 0.5 * (end - start)
    values = legvander(t, count - 1)
    # The Gauss points project onto Legendre polynomials exactly.
    project = (np.arange(count) + 0.5)[:, None] * values.T * w
    slopes = values[:, :-1] @ legder(np.eye(count))
    return 0.5 * (start + end) + half * t, half * w, slopes @ project / half
