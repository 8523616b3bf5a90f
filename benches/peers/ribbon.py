"""ribbonrs on the scenes, as a user would write them.

python benches/peers/ribbon.py SCENE TOLERANCE      prints seconds in the solver, then the outputs
"""

from __future__ import annotations

import math
import sys
import time
from typing import Any

import numpy as np
import ribbonrs as rb
from scenes import ETA, LENGTH, S2_UNIT, S4_FORCE, S4_MOMENT, canonical, reference

Array = np.ndarray[Any, Any]

STRIP = rb.Ribbon(length=LENGTH, width=1.0, thickness=ETA)


def bifurcation(diagram: rb.Diagram) -> float:
    """Return the parameter of the first branch point of the first branch."""
    points = [p.parameter for p in diagram.special_points if p.kind == "branch_point" and p.branch == 0]
    return points[0]


def at_end(diagram: rb.Diagram, place: int) -> rb.State:
    """Return the state at the end of the branch that leaves the first one: its first or its last point."""
    return diagram.branches[1].state(place)


def s1(tol: float) -> Array:
    """Edge growth of a ribbon with a free end, as a boundary-value problem."""
    scene = rb.Scene(STRIP, rb.growth.edge(0.0))
    start = rb.solve(scene, method="collocation", tol=tol)
    diagram = rb.trace(scene, "growth.edge.amplitude", (0.0, 8 * ETA**2), start=start, tol=tol)
    thresholds = [p.parameter / ETA**2 for p in diagram.special_points if p.kind == "section_instability"]
    state = at_end(diagram, -1)
    x, _, z = state.position[-1] / LENGTH
    return np.array([*thresholds, abs(state.strains[-1, 2]) / ETA, abs(x), z])


def s2(tol: float) -> Array:
    """Lateral buckling of a cantilever strip, to twice its critical load."""
    scene = rb.Scene(STRIP, law="linear", end=rb.Free(force=(0.0, -S2_UNIT, 0.0)))
    twice = 2 * float(reference("s2")[0])
    diagram = rb.trace(scene, "load_factor", (0.0, twice), tol=tol)
    state = at_end(diagram, -1)
    x, y, z = state.position[-1] / LENGTH
    moment = state.reactions.start.moment / (S2_UNIT * LENGTH)
    return np.array([bifurcation(diagram), abs(x), y, z, abs(moment[0]), abs(moment[2])])


def s3(tol: float) -> Array:
    """Elastica, to P L^2 = 10 EI."""
    rod = rb.LinearLaw(EI1=math.inf, EI2=1.0, GJ=1.0, inextensible=True)
    scene = rb.Scene(rb.Ribbon(1.0, 1.0, 0.1), law=rod, end=rb.Free(force=(0.0, 0.0, -1.0)))
    diagram = rb.trace(scene, "load_factor", (0.0, 10.0), tol=tol)
    x, _, z = at_end(diagram, -1).position[-1]
    return np.array([bifurcation(diagram), abs(x), z])


def s4(tol: float) -> Array:
    """Grown edges between clamps half a turn apart, shortened by 10 %."""
    scene = rb.Scene(STRIP, rb.growth.edge(2 * ETA**2), end=rb.Clamped(twist_turns=0.5))
    start = rb.solve(scene, tol=tol)
    distances = 0.9 * LENGTH, LENGTH
    diagram = rb.trace(scene, "end.position[2]", distances, start=start, tol=tol, depth=1)
    state = at_end(diagram, -1)
    reaction = state.reactions.start
    middle = state.position[state.S.size // 2] / LENGTH
    outputs = canonical(-reaction.force / S4_FORCE, -reaction.moment / S4_MOMENT, middle)
    return np.append(bifurcation(diagram) / LENGTH, outputs)


def main() -> None:
    """Run one scene."""
    scene, tol = globals()[sys.argv[1]], float(sys.argv[2])
    before = time.perf_counter()
    outputs = scene(tol)
    print(time.perf_counter() - before, *outputs.tolist())


if __name__ == "__main__":
    main()
