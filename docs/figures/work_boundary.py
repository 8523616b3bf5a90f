"""Error against time of held and loaded ribbons, for degrees 1 to 8 on uniform and adaptive meshes.

    python docs/figures/work_boundary.py    writes work_boundary.csv and work_boundary.png beside this file

Whole calls of `rb.solve`, load steps and stability included. Adaptive meshes are asked for tolerances from
1e-2 to 1e-12. Uniform ones have a node at each of many point loads that are zero, and a tolerance that they
all meet. The error is the largest of those of position/L, angle, eps and K L at S = 0.37 L. References: the
closed form of a helix, whose curvatures are a stationary point of the printed energy
(tests/python/reference.py); elliptic integrals; and, where there is neither, shooting with DOP853 at a
relative tolerance of 1e-13 on the equations of tests/python/kirchhoff.py, from forces at the start that
Newton's method finds anew.
"""

from __future__ import annotations

import sys
import warnings
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from time import perf_counter
from typing import Any, NamedTuple

import matplotlib.pyplot as plt
import numpy as np
import ribbonrs as rb
from measure import FLOOR, FOLDER, seconds, write
from orders import elastica, largest
from ribbonrs.figures.style import PAGE, new_figure, styled
from scipy.integrate import solve_ivp
from work_frame import helix

sys.path.insert(0, str(Path(__file__).parents[2] / "tests" / "python"))
from kirchhoff import Kirchhoff
from reference import twist

Array = np.ndarray[Any, Any]
ETA, LENGTH, PLACE = 0.1, 10.0, 0.37
TOLERANCES = [10.0**-k for k in range(2, 13)]
ELEMENTS = [4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128, 192, 256, 384, 512]
SLOWEST = 0.1
"""Seconds: a degree's sweep ends with the first call that takes longer."""
PRANDTL = 4.0126
"""Critical P L^2/(EI2 GJ)^(1/2) of a cantilever on edge (Prandtl 1899, Michell 1899)."""
STRIP = rb.Ribbon(LENGTH, 1.0, ETA)


class Case(NamedTuple):
    """A scene, how it is solved, and its exact states at PLACE: position/L, quaternion, eps and K L.

    They are several where a symmetry of the scene takes a state into another of the same energy.
    """

    scene: rb.Scene
    exact: list[Array]
    method: str | None = None


def row(position: Array, quaternion: Array, strains: Array, length: float) -> Array:
    """What is compared: array (11,)."""
    return np.concatenate([position / length, quaternion, strains * [1.0, length, length, length]])


def coiled() -> Case:
    """S1: edges and oblique fibres grow; the end is free, but the whole is solved."""
    xi, chiral = 0.06, 0.04
    strain = np.array([xi / 3, 0.0, 0.24, 0.22])
    for _ in range(20):
        found = twist(ETA, xi, strain.tolist(), chiral)
        strain -= np.linalg.solve(np.array(found.hessian, float), np.array(found.gradient, float))
    scene = rb.Scene(STRIP, rb.growth.edge(xi) + rb.growth.chiral(chiral))
    pose = helix(strain.tolist(), PLACE * LENGTH)
    return Case(scene, [row(*pose, strain, LENGTH)], "collocation")


def sideways() -> Case:
    """S2: a cantilever on edge, under twice the load at which it buckles sideways."""
    law = rb.LinearLaw(EA=1.0, EI1=1 / 12, EI2=ETA**2 / 12, GJ=ETA**2 / 9)
    load = 2.0 * PRANDTL * (law.EI2 * law.GJ) ** 0.5 / LENGTH**2
    scene = rb.Scene(STRIP, law=law, end=rb.Free(force=(0.0, load, 0.0)))
    return Case(scene, [shot(scene, rb.solve(scene))])


def cantilever() -> Case:
    """S3: the elastica, P L^2 = 10 EI."""
    law = rb.LinearLaw(EI1=100.0, EI2=1.0, GJ=1.0, inextensible=True)
    scene = rb.Scene(rb.Ribbon(1.0, 1.0, ETA), law=law, end=rb.Free(force=(10.0, 0.0, 0.0)))
    return Case(scene, [elastica(10.0, PLACE)])


def clamped() -> Case:
    """S4: grown edges, between clamps half a turn apart, 10 % shorter."""
    end = rb.Clamped(position=(0.0, 0.0, 0.9 * LENGTH), twist_turns=0.5)
    scene = rb.Scene(STRIP, rb.growth.edge(2.0 * ETA**2), end=end)
    state = rb.solve(scene)
    # Run through from its end it is another, and so are both after half a turn about E3.
    back = state.at(np.linspace(LENGTH, 0.0, 201)).strains * [1.0, -1.0, 1.0, 1.0]
    states = [shot(scene, state), shot(scene, rb.solve(scene, guess=back))]
    turn = np.array([-1, -1, 1, 1, -1, -1, 1, 1, -1, -1, 1])
    return Case(scene, [*states, *(turn * known for known in states)])


def shot(scene: rb.Scene, state: rb.State) -> Array:
    """The state at PLACE by shooting from the start."""
    equations = Kirchhoff(scene)
    start, strains = equations.state(state.at([0.0]))[0], state.at([0.0]).strains

    def carried(wrench: Array) -> tuple[Array, Array]:
        """The state at PLACE, and by how much the far end is missed."""
        guess = strains.copy()

        def rate(s: float, y: Array) -> Array:
            rates, guess[:] = equations.rates(np.array([s]), y[None], guess)
            return np.asarray(rates[0])

        y0, places = np.concatenate([start[:7], wrench]), [PLACE * LENGTH, LENGTH]
        found = solve_ivp(rate, (0.0, LENGTH), y0, "DOP853", places, rtol=1e-13, atol=1e-14).y
        return found[:, 0], equations.end_misses(y0, found[:, 1])[6:]

    wrench = start[7:].copy()
    steps = 1e-5 * np.eye(6)
    jacobian = np.stack([(carried(wrench + h)[1] - carried(wrench - h)[1]) / 2e-5 for h in steps], axis=1)
    for _ in range(4):
        here, misses = carried(wrench)
        wrench = wrench - np.linalg.solve(jacobian, misses)
    print(f"shooting misses the end by {np.max(np.abs(misses)):.1e}")
    y = here * equations.units
    guess = state.at([PLACE * LENGTH]).strains
    return row(y[:3], y[3:7], equations.rates(np.array([PLACE * LENGTH]), here[None], guess)[1][0], LENGTH)


CASES = {
    "S1: grown helix": coiled,
    "S2: sideways buckling": sideways,
    "S3: elastica": cantilever,
    "S4: grown, clamped": clamped,
}


def error(case: Case, state: rb.State) -> float:
    """The largest error at PLACE."""
    length = case.scene.ribbon.length_ratio
    here = state.at([PLACE * length])
    found = row(here.position[0], here.quaternion[0], here.strains[0], length)
    return min(largest(found, exact) for exact in case.exact)


def solved(case: Case, degree: int, tolerance: float) -> rb.State:
    """The state; two sections of it, for more are not looked at."""
    return rb.solve(case.scene, degree=degree, tol=tolerance, n=2, method=case.method)


def uniform(case: Case, elements: int) -> Case:
    """The same on a mesh of its own."""
    nodes = np.linspace(0.0, case.scene.ribbon.length_ratio, elements + 1)[1:-1]
    return case._replace(scene=replace(case.scene, loads=[rb.PointLoad(s) for s in nodes.tolist()]))


Sweep = tuple[str, int, float, int]
"""Mesh, degree, tolerance or number of elements asked for, and elements."""


def measured(case: Case) -> list[tuple[str, int, float, int, float, float]]:
    """Mesh, degree, what was asked for, elements, seconds, error; an error of NaN where none was found."""
    found: dict[Sweep, tuple[Callable[[], Any], float]] = {}
    for degree in range(1, 9):
        ways: dict[str, list[tuple[float, Callable[[], rb.State]]]] = {
            "adaptive": [(tol, partial(solved, case, degree, tol)) for tol in TOLERANCES],
            "uniform": [(n, partial(solved, uniform(case, n), degree, 0.9)) for n in ELEMENTS],
        }
        for mesh, runs in ways.items():
            for asked, run in runs:
                began = perf_counter()
                try:
                    run()
                    state = run()
                except rb.ConvergenceError as failed:
                    print(f"{mesh}, degree {degree}, {asked:g}: {failed}")
                    continue
                found[mesh, degree, asked, state.report.elements] = run, error(case, state)
                if (perf_counter() - began) / 2 > SLOWEST:
                    break
    times = seconds({name: run for name, (run, _) in found.items()}, 3)
    return [(*name, times[name], wrong) for name, (_, wrong) in found.items()]


@styled
def draw(found: dict[str, list[tuple[str, int, float, int, float, float]]]) -> None:
    """A column for each scene, uniform meshes above."""
    figure = new_figure(PAGE, 4.6)
    panels = figure.subplots(2, len(found), sharex="col", sharey=True)
    colours = plt.get_cmap("viridis")(np.linspace(0.0, 0.93, 8))
    for column, (name, rows) in enumerate(found.items()):
        for line, mesh in enumerate(("uniform", "adaptive")):
            axes = panels[line, column]
            for degree in range(1, 9):
                points = [(1e3 * t, max(e, FLOOR)) for m, d, _, _, t, e in rows if (m, d) == (mesh, degree)]
                axes.loglog(
                    *zip(*points, strict=True), "o-", color=colours[degree - 1], ms=2, lw=0.9, label=degree
                )
            axes.grid(alpha=0.25, lw=0.4)
        panels[0, column].set_title(name)
        panels[1, column].set_xlabel("ms")
    for line, mesh in enumerate(("uniform", "adaptive")):
        panels[line, 0].set_ylabel(f"error, {mesh} meshes")
    panels[0, 0].set_ylim(1e-16, 1.0)
    handles, names = panels[0, 0].get_legend_handles_labels()
    figure.legend(handles, names, title="degree", loc="outside right center")
    figure.savefig(FOLDER / "work_boundary.png")


def main() -> None:
    """Measure, print, write and draw."""
    # Of a tolerance below rounding, or a coarse mesh that gives an unstable state, the errors tell.
    warnings.simplefilter("ignore", rb.RibbonWarning)
    found = {name: measured(case()) for name, case in CASES.items()}
    rows = [(name, *row) for name, panel in found.items() for row in panel]
    for row in rows:
        print("{} | {}, degree {} | {:g}: {} elements | {:.2e} s | {:.1e}".format(*row))
    write("work_boundary", ("scene", "mesh", "degree", "asked", "elements", "seconds", "error"), rows)
    draw(found)


if __name__ == "__main__":
    main()
