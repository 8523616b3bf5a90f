"""Why random scenes are not solved: `python -m stress.causes scenes.csv`.

The first of these that is true. Natural shape jumps: what hangs free without load already has kinks, which no
smooth solution of the boundary-value problem has. Section unstable: the last solution on the way has unstable
sections, where equilibria may be kinked, too. Fold: that solution is unstable as a whole. Other.
"""

from __future__ import annotations

import sys
import warnings
from collections import Counter

import ribbonrs as rb

from .scenes import KINDS, random_scene
from .sweep import known
from .trial import TOL

CAUSES = ("natural shape jumps", "section unstable", "fold", "other")


def jumps(scene):
    """Whether every natural shape of the ribbon has a kink."""
    try:
        state = rb.solve(rb.Scene(scene.ribbon, scene.growth))
    except rb.ConvergenceError:
        return True
    return any(event.kind == "jump" for event in state.report.events)


def cause(seed):
    """The cause, from the scene and its error."""
    scene = random_scene(seed)[2]()
    if jumps(scene):
        return "natural shape jumps"
    try:
        rb.solve(scene, tol=TOL)
    except rb.ConvergenceError as error:
        last = error.state
    if last is None or last.stable:
        return "other"
    return "section unstable" if last.section_index > 0 else "fold"


def main(path):
    """Print how many of each kind."""
    counts = Counter()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", rb.RibbonWarning)
        for row in known(path):
            if row["result"] == "no convergence":
                counts[row["kind"], cause(int(row["seed"]))] += 1
    print(f"{'':10}", *(f"{name:>20}" for name in CAUSES))
    for kind in KINDS:
        print(f"{kind:10}", *(f"{counts[kind, name]:20d}" for name in CAUSES))


if __name__ == "__main__":
    main(sys.argv[1])
