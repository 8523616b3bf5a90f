"""One random scene, solved and judged."""

from __future__ import annotations

import time
import warnings
from dataclasses import dataclass, fields

import numpy as np
import ribbonrs as rb

from .equations import misses
from .scenes import random_scene

TOL = 1e-10
ALLOWED = 3.0
"""What a state may miss of the equations, in units of its tolerance, or of the error it admits if rounding is
larger: 1 for its own poses, and 3^(1/2) for a frame of three curvatures that are each off by 1."""

LIMIT = 10.0
"""Seconds of the processor a solve may take: those of the clock say how busy the machine is."""

DEFECTS = ("wrong", "not finite", "slow", "hang", "crash", "exception", "no reason")
"""Results that must not be; besides there are "converged", "refused" and "no convergence"."""


@dataclass
class Trial:
    """What became of a scene."""

    seed: int
    kind: str
    varies: bool
    result: str
    seconds: float = 0.0
    length: float = 0.0
    eta: float = 0.0
    elements: int = 0
    section_index: int = 0
    index: float = float("nan")
    fraction: float = 1.0
    worst: str = ""
    miss: float = 0.0
    reason: str = ""

    @classmethod
    def columns(cls):
        """The names of the columns of the table."""
        return [field.name for field in fields(cls)]


def trial(seed):
    """Solve the scene of a seed and judge what came out."""
    kind, varies, make = random_scene(seed)
    found = Trial(seed, kind, varies, "")
    start = time.process_time()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", rb.RibbonWarning)
        try:
            scene = make()
            found.length, found.eta = scene.ribbon.length_ratio, scene.ribbon.thickness_ratio
            start = time.process_time()
            state = rb.solve(scene, tol=TOL)
        except rb.InputError as error:
            found.result, found.reason = "refused", str(error)
        except rb.ConvergenceError as error:
            found.result, found.reason, found.fraction = "no convergence", str(error), error.fraction
            if error.state is not None:
                found.section_index = error.state.section_index
        except Exception as error:
            found.result, found.reason = "exception", repr(error)
        found.seconds = time.process_time() - start
        if not found.result:
            judge(found, state)
    if found.result in ("refused", "no convergence") and len(found.reason) < 20:
        found.result = "no reason"
    if found.seconds > LIMIT:
        found.result, found.reason = "slow", f"{found.result}: {found.reason}"
    return found


def judge(found, state):
    """Put a state that is said to be converged into the equations."""
    found.elements, found.section_index = state.report.elements, state.section_index
    found.index = float("nan") if state.index is None else state.index
    missed = misses(state)
    found.worst = max(missed, key=lambda name: missed[name] if np.isfinite(missed[name]) else np.inf)
    found.miss = float(missed[found.worst])
    tolerance = max(TOL, state.report.error) if state.report.status == "rounding_limited" else TOL
    if not all(np.isfinite(miss) for miss in missed.values()):
        found.result = "not finite"
    else:
        found.result = "converged" if found.miss <= ALLOWED * tolerance else "wrong"
