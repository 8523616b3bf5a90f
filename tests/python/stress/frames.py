"""Frames of very many segments and turns, against exact curves.

Rounding moves a frame by a few units of 2^-53 a segment, which add up like the root of their number as long
as they have no preferred direction. An eighth of 2^-53 times the number is allowed.
"""

from __future__ import annotations

import numpy as np
import ribbonrs as rb
from ribbonrs.frame import directors

from .row import Row

ROUNDING = 2.0**-53
DRIFT = ROUNDING / 8
"""Allowed for each segment."""


def helix(S, strain):
    """Positions (n, 3) and directors (n, 3, 3) of constant strains, in 64-bit mantissas."""
    S = np.asarray(S, dtype=np.longdouble)
    K = np.array(strain[1:], dtype=np.longdouble)
    k = np.sqrt(K @ K)
    axis = K / k
    angle = np.remainder(k * S, 2 * np.arccos(np.longdouble(-1)))
    c, s = np.cos(angle), np.sin(angle)
    outer = np.outer(axis, axis)
    cross = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    R = outer + np.multiply.outer(c, np.eye(3) - outer) + np.multiply.outer(s, cross)
    e3 = np.array([0, 0, 1], dtype=np.longdouble)
    along = outer @ e3
    rate = (
        S[:, None] * along
        + np.outer(s / k, e3 - along)
        + np.outer(2 * np.sin(angle / 2) ** 2 / k, cross @ e3)
    )
    return (1 + strain[0]) * rate, np.swapaxes(R, 1, 2)


def away(found, position, axes, length):
    """The largest error of positions over the length and of directors."""
    r, q = found
    return float(max(np.abs(r - position).max() / length, np.abs(directors(q) - axes).max()))


def segments(n):
    """A helix of `n` segments of unequal lengths, seen at a thousand of them and at the end."""
    S = np.concatenate([[0.0], np.cumsum(np.random.default_rng(1).uniform(0.5, 1.5, n))])
    S *= 100.0 / S[-1]
    strain = np.array([0.01, 0.3, -1.1, 0.7])
    r, q = rb.integrate_frame(S, np.broadcast_to(strain, (n, 4)))
    seen = np.union1d(np.linspace(0, n, 1001).astype(int), [n])
    error = away((r[seen], q[seen]), *helix(S[seen], strain), 100.0)
    yield Row("frames", f"helix of {n:.0e} segments", n, error, DRIFT * n)
    norm = float(np.abs(np.linalg.norm(q, axis=1) - 1.0).max())
    yield Row("frames", f"norm of the quaternions of {n:.0e} segments", n, norm, 4 * ROUNDING)
    back_r, back_q = rb.integrate_frame(S[::-1], np.broadcast_to(strain, (n, 4)), r[-1], q[-1])
    error = away((back_r[-1:], back_q[-1:]), np.zeros((1, 3)), np.eye(3)[None], 100.0)
    yield Row("frames", f"back to the start over {n:.0e} segments", n, error, DRIFT * n)


def jumps(n):
    """Arcs of alternating curvature: every pair moves straight on and leaves the directors as they were."""
    K2, step = 3.0, 0.25
    strains = np.zeros((n, 4))
    strains[::2, 2], strains[1::2, 2] = K2, -K2
    r, q = rb.integrate_frame(step * np.arange(n + 1.0), strains)
    # the first arc moves by (x, 0, z) and turns by a, the second mirrors it in the turned directors
    a = np.longdouble(K2 * step)
    c, s = np.cos(a), np.sin(a)
    x, z = (1 - c) / K2, s / K2
    pair = np.array([x - c * x + s * z, np.longdouble(0), z + s * x + c * z])
    pairs = np.arange(n // 2 + 1, dtype=np.longdouble)
    error = away((r[::2], q[::2]), np.multiply.outer(pairs, pair), np.eye(3), step * n)
    yield Row("frames", f"{n:.0e} jumps of curvature", n, error, DRIFT * n)


def turns(number):
    """A circle passed over and over, by segments, by nodes, and by a function of S."""
    n = 100 * number
    S, strain = np.linspace(0.0, 2.0 * np.pi * number, n + 1), np.array([0.0, 0.0, 1.0, 0.0])
    exact = helix(S[:: 10 * number], strain)
    forms = {
        "segments": np.broadcast_to(strain, (n, 4)),
        "nodes": np.broadcast_to(strain, (n + 1, 4)),
        "a function": lambda s: np.broadcast_to(strain, (s.size, 4)),
    }
    for name, strains in forms.items():
        r, q = rb.integrate_frame(S, strains)
        error = away((r[:: 10 * number], q[:: 10 * number]), *exact, 1.0)
        yield Row("frames", f"{number:.0e} turns by {name}", n, error, DRIFT * n)


def straight(n):
    """No curvature, and curvatures from the least number on, without a switch seen."""
    S = np.linspace(0.0, 10.0, n + 1)
    r, q = rb.integrate_frame(S, np.zeros((n, 4)))
    error = away((r, q), np.outer(S, [0, 0, 1]), np.eye(3), 10.0)
    yield Row("frames", "no curvature", n, error, DRIFT * n)
    largest = 0.0
    sizes = 10.0 ** np.linspace(-320.0, 1.0, 4000)
    for size in sizes:
        strain = np.array([0.0, 0.36, 0.48, 0.8]) * size
        found = rb.integrate_frame([0.0, 1.0], strain[None])
        exact = helix(np.array([0.0, 1.0]), strain) if size > 1e-9 else line(strain)
        largest = max(largest, away(found, *exact, 1.0))
    yield Row("frames", "curvatures from 1e-320 to 10", sizes.size, largest, 8 * ROUNDING)


def line(strain):
    """To first order in curvatures below 1e-9: positions and directors at S = 0 and 1."""
    K1, K2, K3 = strain[1:]
    turned = np.eye(3) + np.array([[0, K3, -K2], [-K3, 0, K1], [K2, -K1, 0]])
    return np.array([[0, 0, 0], [K2 / 2, -K1 / 2, 1.0]]), np.stack([np.eye(3), turned])


def rows(n=10_000_000, number=100_000):
    """All of them."""
    yield from segments(n)
    yield from jumps(n)
    yield from turns(number)
    yield from straight(n // 10)
