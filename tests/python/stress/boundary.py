"""Boundary-value problems at the ends of every range: slender, overloaded, stiff, kinked, from anywhere."""

from __future__ import annotations

import math
import warnings
from dataclasses import replace

import numpy as np
import ribbonrs as rb

from .equations import misses
from .row import Row
from .trial import ALLOWED

EDGES = rb.growth.edge
UNSTABLE = rb.RibbonWarning
"""What is warned of here is not judged: that a state is unstable, stretched, or limited by rounding."""


class Judge:
    """The worst of what states miss, in units of their tolerance or of the error that they admit."""

    def __init__(self):
        self.runs = self.refused = 0
        self.worst = 0.0
        self.solved = {}

    def solve(self, name, scene, tol=1e-10, must=True, **arguments):
        """Solve and judge; what must be solved and is not counts as infinitely wrong."""
        self.runs += 1
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UNSTABLE)
            try:
                state = rb.solve(scene, tol=tol, **arguments)
            except rb.ConvergenceError as error:
                self.refused += 1
                if must:
                    self.worst = math.inf
                    self.solved[name] = str(error)
                return None
        missed = max(misses(state).values())
        admitted = state.report.error if state.report.status == "rounding_limited" else 0.0
        self.worst = max(self.worst, missed / max(tol, admitted))
        self.solved[name] = missed
        return state

    def row(self, what):
        """The line of the table."""
        return Row("boundary values", what, self.runs, self.worst, ALLOWED, "tolerances")


def bending(scene_length, eta):
    """EI2/L^2."""
    return eta**2 / 12.0 / scene_length**2


def slender():
    """Cantilevers under ten times EI/L^2 across and a tenth of it sideways, to a million widths long."""
    judge = Judge()
    for length in 10.0 ** np.arange(1.0, 7.0):
        for eta in (0.1, 1e-3):
            P = bending(length, eta)
            for xi in (0.0, 3.0):
                growth = EDGES(xi * eta**2)
                scene = rb.Scene(
                    rb.Ribbon(length, 1.0, eta), growth, end=rb.Free(force=(10 * P, 0.1 * P, 0.0))
                )
                judge.solve((length, eta, xi), scene)
    return judge.row("length/width 10 to 1e6")


def overloaded():
    """Columns pressed, pushed and pulled by up to 1e4 times the load that buckles them."""
    judge, eta, length = Judge(), 0.01, 50.0
    euler = math.pi**2 / 4 * bending(length, eta)
    for factor in (1.0, 10.0, 100.0, 1e3, 1e4):
        for name, direction in {
            "pressed": (1e-3, 0, -1),
            "pushed": (1, 0, 0),
            "pulled": (0.3, 0.1, 1),
        }.items():
            force = factor * euler * np.array(direction)
            scene = rb.Scene(rb.Ribbon(length, 1.0, eta), EDGES(2 * eta**2), end=rb.Free(force=force))
            judge.solve((name, factor), scene)
    return judge.row("forces to 1e4 times buckling")


def layers():
    """Clamped ends of a rod that is pulled taut, and stiffnesses that differ by 1e8."""
    judge = Judge()
    ribbon = rb.Ribbon(1.0, 1.0, 0.1)
    for exponent in range(0, 9):
        soft = 10.0**-exponent
        taut = rb.LinearLaw(EA=1e4, EI1=soft, EI2=soft, GJ=soft)
        turned = rb.Sliding(axis=(0, 0, 1), rotation=(0.5, 0.3, 0.0), force=1.0)
        judge.solve(("taut", exponent), rb.Scene(ribbon, law=taut, end=turned))
        flat = rb.LinearLaw(inextensible=True, EI1=1.0, EI2=soft, GJ=soft)
        tip = rb.Free(force=(soft, 0.5 * soft, 0.0))
        judge.solve(("flat", exponent), rb.Scene(ribbon, law=flat, end=tip))
    return judge.row("stiffness ratios to 1e8")


def kinked():
    """Growth with corners and jumps where no mesh expects them."""
    judge, eta, length = Judge(), 0.05, 30.0
    for seed in range(40):
        rng = np.random.default_rng(seed)
        places = np.sort(rng.uniform(0.0, length, rng.integers(1, 12)))
        S = np.sort([0.0, *places, *places[::2], length])
        edge = EDGES((S, rng.uniform(-10.0, 4.0, S.size) * eta**2))
        twist = rb.growth.chiral((S, rng.uniform(-1.0, 1.0, S.size) * eta))
        scene = rb.Scene(
            rb.Ribbon(length, 1.0, eta), edge + twist, gravity=(bending(length, eta) / length, 0, 0)
        )
        judge.solve(seed, scene)
    return judge.row("growth with up to 17 kinks and jumps")


def tolerances():
    """Every degree at tolerances from 1e-3 to 1e-13."""
    judge, eta = Judge(), 0.1
    end = rb.Clamped((1.0, 0.5, 8.5), rotation=(0.3, 0.0, 1.0))
    scene = rb.Scene(rb.Ribbon(10.0, 1.0, eta), EDGES(2 * eta**2), end=end, gravity=(0.0, 1e-6, -1e-6))
    for degree in range(1, 9):
        for exponent in (3, 5, 7, 9, 11, 13):
            # of degree 1 errors go like the square of the element: beyond 1e-9 there would be 1e5 of them
            if degree > 1 or exponent <= 7:
                judge.solve((degree, exponent), scene, tol=10.0**-exponent, degree=degree)
    return judge.row("degrees 1 to 8, tolerances 1e-3 to 1e-13")


def coarsest():
    """Shapes so even that the coarsest mesh is enough, four elements; fewer cannot be asked for."""
    judge, most = Judge(), 0
    for degree in (6, 7, 8):
        for force in (0.0, 1e-9, 1e-7):
            scene = rb.Scene(rb.Ribbon(5.0, 1.0, 0.1), EDGES(0.02), end=rb.Free(force=(force, 0, 0)))
            state = judge.solve((degree, force), scene, tol=1e-3, degree=degree, method="collocation")
            most = max(most, state.report.elements)
    row = judge.row("the coarsest mesh, four elements")
    return row if most == 4 else replace(row, worst=math.inf)


def guesses(count=200):
    """From random strains, each an equilibrium or an error that says why."""
    judge, eta, length = Judge(), 0.05, 20.0
    end = rb.Clamped((2.0, 1.0, 15.0), twist_turns=0.4)
    scene = rb.Scene(rb.Ribbon(length, 1.0, eta), EDGES(2 * eta**2), end=end)
    for seed in range(count):
        rng = np.random.default_rng(seed)
        waves = np.cos(math.pi * np.outer(np.linspace(0.0, 1.0, 101), np.arange(5)))
        strains = waves @ rng.normal(size=(5, 4)) * [eta**2, eta**2, eta, eta] * 10.0 ** rng.uniform(-1, 1)
        judge.solve(seed, scene, must=False, guess=strains)
    return judge.row(f"random guesses ({judge.runs - judge.refused} lead to a state)")


CHECKS = (slender, overloaded, layers, kinked, tolerances, coarsest, guesses)


def rows():
    """All of them."""
    for check in CHECKS:
        yield check()
