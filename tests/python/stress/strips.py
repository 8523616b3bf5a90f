"""Branches of random strips, the same whatever the tolerance.

python -m stress.strips 60      prints those that differ
"""

from __future__ import annotations

import sys
import warnings

import numpy as np
import ribbonrs as rb

from .row import Row

TOLERANCES = (1e-6, 1e-9)
APART = 1e-6
"""Distance of special points that is none, over the larger end of the span: the coarser tolerance."""


def strip(seed):
    """A strip whose edges grow, chiral or not, loaded at its free end or pressed together; what is traced."""
    rng = np.random.default_rng(seed)
    eta, length = float(10.0 ** rng.uniform(-2.0, -0.8)), float(rng.uniform(5.0, 20.0))
    xi = float(rng.uniform(-10.0, 10.0) * rng.choice([0.0, 0.3, 1.0])) * eta**2
    omega = float(rng.uniform(-1.0, 1.0) * 10.0 ** rng.uniform(-6.0, 0.0) * rng.choice([0.0, 1.0]))
    growth = rb.growth.edge(xi) + rb.growth.chiral(2.0 * eta * omega)
    kind = rng.choice(["free", "clamped", "pinned"])
    if kind == "free":
        end = rb.Free(force=(3.0 * eta**3 / length**2 * rng.normal(size=3)).tolist())
        traced = "load_factor", (0.0, float(rng.uniform(1.0, 5.0)))
    else:
        turns = float(rng.choice([0.0, 0.25, 0.5, rng.uniform(0.0, 0.6)]))
        end = rb.Clamped(twist_turns=turns) if kind == "clamped" else rb.Pinned()
        traced = "end.position[2]", (0.98 * length, length)
    return rb.Scene(rb.Ribbon(length, 1.0, eta), growth, end=end), *traced


FIRST = 10
"""Special points that are compared: of more, those next to a section instability may be passed over."""

AT_END = 1e-3
"""Distance from where a branch ends that is not at an end of its span, over that: a section softens there."""


def branch(seed, tol):
    """Whether the branch of the state at the start of its span ends at that, and its first special points."""
    scene, parameter, span = strip(seed)
    start = rb.solve(scene, tol=tol)
    if parameter == "load_factor":
        start = None
    diagram = rb.trace(scene, parameter, span, start=start, tol=tol, depth=0)
    through = diagram.branches[0].ended[1] == "span"
    first, last = diagram.branches[0].parameter[[0, -1]].tolist()
    near = 0.0 if through else AT_END * (span[1] - span[0])
    points = [(p.parameter, p.kind) for p in diagram.special_points if p.kind != "end"]
    points = sorted((p for p in points if abs(p[0] - last) >= near), key=lambda p: abs(p[0] - first))
    return through, points[:FIRST], span[1]


def differs(seed):
    """Whether the branches to both tolerances differ."""
    (through, points, size), (other, others, _) = (branch(seed, tol) for tol in TOLERANCES)
    same = [kind for _, kind in points] == [kind for _, kind in others] and through == other
    places, other_places = ([place for place, _ in found] for found in (points, others))
    return not (same and np.allclose(places, other_places, rtol=0.0, atol=APART * size))


def tried(count):
    """Yield a seed and whether its branches differ, for all but those whose load no state is found for."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", rb.RibbonWarning)
        for seed in range(count):
            try:
                yield seed, differs(seed)
            except rb.ConvergenceError:
                continue


def rows(count=60):
    """Yield the row."""
    found = [wrong for _, wrong in tried(count)]
    yield Row("branches", "of strips, other with tol 1e-6 than with 1e-9", len(found), sum(found), 0)


if __name__ == "__main__":
    for seed, wrong in tried(int(sys.argv[1])):
        if wrong:
            print(seed, *(branch(seed, tol) for tol in TOLERANCES))
