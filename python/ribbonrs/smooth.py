"""A smooth curve through the few points of a branch, for drawing."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .arrays import Array

__all__ = ["Curve", "smooth"]

DENSE = 600
"""Points of a curve that look smooth."""

SHORTEST = 1e-9
"""Least length of a step, of the diagram: points may be the same."""


@dataclass(frozen=True)
class Curve:
    """Points along a branch.

    Attributes
    ----------
    points : (m, 2) array
        Parameter and quantity.
    step : int
        Every so many points there is one of the branch.
    """

    points: Array
    step: int

    @property
    def nodes(self) -> Array:
        """The points (k, 2) of the branch."""
        return self.points[:: self.step]

    def part(self, first: int, last: int) -> Array:
        """Return the curve between two points of the branch."""
        return self.points[first * self.step : last * self.step + 1]

    def at(self, i: int, parameter: float) -> float:
        """Return the quantity at this parameter, at point i or between it and the next one."""
        x, y = self.part(i, i + 1).T
        return float(np.interp(parameter, *(x, y) if x[-1] >= x[0] else (x[::-1], y[::-1])))

    def mirrored(self) -> Curve:
        """Return the curve of the opposite quantity."""
        return Curve(self.points * [1.0, -1.0], self.step)


def smooth(parameter: Array, quantity: Array, straight: bool = False) -> Curve:
    """Return a curve through points (k,) in order; lines if `straight`.

    Piecewise cubic in the length of the chords, both coordinates scaled to their range: a spline, its slopes
    limited so that the parameter goes one way between two points and the quantity does not swing (Fritsch
    & Carlson 1980).
    """
    nodes = np.stack([parameter, quantity], axis=1)
    if straight or len(nodes) < 3 or not np.all(np.isfinite(nodes)):
        return Curve(nodes, 1)
    # Loaded here, since it takes longer than the whole package; scipy has no types.
    from scipy.interpolate import CubicHermiteSpline, CubicSpline  # type: ignore[import-untyped]

    size = np.ptp(nodes, axis=0)
    chords = np.linalg.norm(np.diff(nodes, axis=0) / np.where(size > 0.0, size, 1.0), axis=1)
    steps = np.maximum(chords, SHORTEST)
    length = np.concatenate([[0.0], np.cumsum(steps)])
    slopes = CubicSpline(length, nodes)(length, 1)
    secants = np.diff(nodes, axis=0) / steps[:, None]
    before, after = np.vstack([secants[:1], secants]), np.vstack([secants, secants[-1:]])
    least = 3.0 * np.minimum(np.abs(before), np.abs(after))[:, 0]
    most = 3.0 * np.maximum(np.abs(before), np.abs(after))[:, 1]
    turns = before[:, 0] * after[:, 0] <= 0.0  # a fold, where the curve is vertical
    against = slopes[:, 0] * after[:, 0] < 0.0
    slopes[:, 0] = np.where(turns | against, 0.0, np.clip(slopes[:, 0], -least, least))
    slopes[:, 1] = np.clip(slopes[:, 1], -most, most)
    fine = max(1, DENSE // (len(nodes) - 1))
    places = (length[:-1, None] + steps[:, None] * (np.arange(fine) / fine)).ravel()
    points = CubicHermiteSpline(length, nodes, slopes)(np.append(places, length[-1]))
    points[::fine] = nodes
    return Curve(points, fine)
