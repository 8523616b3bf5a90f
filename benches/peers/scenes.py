"""The scenes: their outputs, and the laws in the peers' units (as in `auto`): lengths over L, S in [0, 1]."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from edge_law import inverse

Array = np.ndarray[Any, Any]

TITLES = {
    "s1": "S1, edges grow, free end",
    "s2": "S2, lateral buckling of a strip",
    "s3": "S3, elastica",
    "s4": "S4, grown edges between clamps",
}

GROUPS = {
    "s1": {"threshold of bending": 1, "threshold of twist": 1, "curvature": 1, "end": 2},
    "s2": {"critical load": 1, "end": 3, "moment at the clamp": 2},
    "s3": {"critical load": 1, "end": 2},
    "s4": {"bifurcation": 1, "force": 3, "moment": 3, "middle": 3},
}
"""Outputs in their order, with their numbers of components."""


def reference(scene: str) -> Array:
    """Return the outputs of a scene as `reference.py` has found them."""
    rows = Path(__file__).with_name("reference.csv").read_text().split()
    return np.array(next(row.split(",")[1:] for row in rows if row.startswith(scene)), dtype=float)


def error(scene: str, outputs: Array) -> float:
    """Return the largest relative error of a scene's outputs, vectors by their norm."""
    exact, place, largest = reference(scene), 0, 0.0
    for size in GROUPS[scene].values():
        own = slice(place, place + size)
        off = np.linalg.norm(outputs[own] - exact[own]) / np.linalg.norm(exact[own])
        largest, place = max(largest, float(off)), place + size
    return largest


ETA, LENGTH = 0.1, 10.0
EA, EI1, EI2, GJ = 1.0, 1 / 12, ETA**2 / 12, ETA**2 / 9

S2_UNIT = np.sqrt(EI2 * GJ) / LENGTH**2
"""Unit of forces of S2, in Y h a; moments in this times L."""

S2_SOFT = np.array([S2_UNIT / EA, *(S2_UNIT * LENGTH**2 / np.array([EI1, EI2, GJ]))])

S4_GROWTH = 2.0
S4_FORCE, S4_MOMENT = ETA**3 / LENGTH, ETA**3
S4_LOAD = np.array([ETA / LENGTH, ETA, 1.0, 1.0])
S4_STRAIN = np.array([ETA**2, ETA**2 * LENGTH, ETA * LENGTH, ETA * LENGTH])


def canonical(n: Array, c: Array, middle: Array) -> Array:
    """Return N, C and the middle of a state of S4 in one way for all its mirror images.

    Of the two ends that where the first component of the moment is larger, and no signs.
    """
    other = c + np.array([0.9 * n[1], -0.9 * n[0], 0.0])  # the moment at the far end
    if abs(other[0]) > abs(c[0]):
        c, middle = other, np.array([0.0, 0.0, 0.9]) - middle
    return np.abs(np.concatenate([n, c, middle]))


def strip(wrench: Array) -> tuple[Array, Array]:
    """Linear section of S2: strains (4, n) and compliances (4, 4, n)."""
    compliance = np.broadcast_to(np.diag(S2_SOFT)[:, :, None], (4, 4, wrench.shape[1]))
    return S2_SOFT[:, None] * wrench, compliance


def grown(k: Array, wrench: Array) -> tuple[Array, Array]:
    """Section of S4, from a guess (2, n) of (K2, K3)/eta that becomes what they are."""
    strain, compliance = inverse(S4_LOAD[:, None] * wrench, S4_GROWTH, k)
    k[:] = strain[2:].real
    return S4_STRAIN[:, None] * strain, S4_STRAIN[:, None, None] * compliance * S4_LOAD[None, :, None]
