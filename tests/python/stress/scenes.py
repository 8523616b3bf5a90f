"""Random scenes: growth far past every threshold, loads up to ten times buckling, ends anywhere in reach."""

from __future__ import annotations

import math

import numpy as np
import ribbonrs as rb

KINDS = ("free", "clamped", "pinned", "sliding")
"""How the far end is held; the start is clamped."""


def course(rng, length, value):
    """An amplitude along the ribbon of about the size of `value`: lines, a jump, or a wave."""
    match rng.integers(3):
        case 0:
            S = np.sort([0.0, *rng.uniform(0.0, length, rng.integers(1, 4)), length])
            return S, value * rng.uniform(0.0, 1.0, S.size)
        case 1:
            at, other = rng.uniform(0.1, 0.9) * length, value * rng.uniform(0.0, 1.0)
            return [0.0, at, at, length], [value, value, other, other]
        case _:
            waves, phase = rng.uniform(0.5, 2.0), rng.uniform(0.0, 2.0 * math.pi)
            return lambda S: value * (0.5 + 0.5 * np.cos(2.0 * math.pi * waves * S / length + phase))


def direction(rng):
    """A unit vector, uniform on the sphere."""
    vector = rng.normal(size=3)
    return vector / np.linalg.norm(vector)


def reachable_axis(rng):
    """The direction of an axis through the straight ribbon's end that comes within 0.95 L of its start."""
    while True:
        axis = direction(rng)
        if math.hypot(axis[0], axis[1]) <= 0.95:
            return axis


def rotation(rng):
    """A unit quaternion, uniform on all rotations."""
    quaternion = rng.normal(size=4)
    return quaternion / np.linalg.norm(quaternion)


def random_growth(rng, eta, length):
    """Edge growth, chirality, and gradients through the thickness along and across the ribbon."""
    varies = rng.random() < 0.5

    def amplitude(value):
        return course(rng, length, value) if varies else value

    xi, omega = rng.uniform(-20.0, 20.0), rng.uniform(-40.0, 40.0)
    along, across = rng.uniform(-5.0, 5.0, 2)
    growth = (
        rb.growth.edge(amplitude(xi * eta**2))
        + rb.growth.chiral(amplitude(2.0 * eta * omega))
        + rb.growth.thickness(amplitude(along * eta), amplitude(across * eta))
    )
    return growth, varies


def random_end(rng, kind, length, euler):
    """The far end; a force of up to ten times Euler's load where the end may move."""
    place = rng.uniform(0.0, 0.95) * length * direction(rng)
    load = rng.uniform(0.0, 10.0) * euler
    match kind:
        case "free":
            return rb.Free(force=load * direction(rng))
        case "clamped":
            return rb.Clamped(place, rotation(rng))
        case "pinned":
            return rb.Pinned(place)
        case _:
            return rb.Sliding(reachable_axis(rng), rotation(rng), force=load)


def random_scene(seed):
    """Return the kind of far end, whether the growth varies, and the scene; growth too large is refused."""
    rng = np.random.default_rng(seed)
    length, eta = rng.uniform(5.0, 200.0), float(np.exp(rng.uniform(math.log(0.005), math.log(0.2))))
    stiffness = eta**2 / 12.0
    growth, varies = random_growth(rng, eta, length)
    kind = KINDS[seed % len(KINDS)]
    end = random_end(rng, kind, length, math.pi**2 / 4.0 * stiffness / length**2)
    gravity = rng.uniform(0.0, 20.0) * stiffness / length**3 * direction(rng)
    return kind, varies, lambda: rb.Scene(rb.Ribbon(length, 1.0, eta), growth, end=end, gravity=gravity)
