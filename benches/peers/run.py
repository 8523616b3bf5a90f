"""Run time against error of ribbonrs, AUTO-07p and scipy's solve_bvp: `make bench-peers`.

    python benches/peers/run.py            measures, writes docs/figures/peers.csv and draws a picture a scene
    python benches/peers/run.py --draw     only draws

Every round runs each solver at each of its levels once, one after the other; medians of seven rounds.
"""

from __future__ import annotations

import csv
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from statistics import median
from typing import Any

import auto
import bvp
import matplotlib.pyplot as plt
import numpy as np
import ribbon
from scenes import TITLES, error

ROUNDS = 7
HERE = Path(__file__).parent
FIGURES = HERE.parents[1] / "docs" / "figures"
LOOK = {
    "ribbonrs": ("#0072B2", "o"),
    "AUTO-07p": ("#D55E00", "s"),
    "solve_bvp": ("#009E73", "^"),
}
TOLERANCES = {"ribbonrs": (1e-4, 1e-7, 1e-10), "solve_bvp": (1e-3, 1e-5, 1e-7)}
"""What the solvers are asked for."""

Sample = tuple[float, float, float]
"""Error, and seconds in the solver and of the whole process."""


def in_python(module: Any, scene: str, tol: float, cache: Path) -> Callable[[], Sample]:
    """Return what measures a Python solver: here, warm, and as a script, with bytecode in `cache`."""
    function = getattr(module, scene)
    function(tol)
    # As where packages are installed; some machines are told to write none.
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    environment["PYTHONPYCACHEPREFIX"] = str(cache)

    def measure() -> Sample:
        before = time.perf_counter()
        outputs = function(tol)
        inside = time.perf_counter() - before
        before = time.perf_counter()
        command = [sys.executable, module.__file__, scene, repr(tol)]
        subprocess.run(command, env=environment, check=True, stdout=subprocess.DEVNULL)
        return error(scene, outputs), inside, time.perf_counter() - before

    return measure


def in_fortran(scene: str, program: Path, level: auto.Level) -> Callable[[], Sample]:
    """Return what measures AUTO, whose programs are compiled already."""

    def measure() -> Sample:
        outputs, found = auto.solve(scene, program, level)
        return error(scene, outputs), found.solver, found.process

    return measure


def rows_of(scene: str, folder: Path) -> list[list[Any]]:
    """Return solver, level, error and both times for each solver and level."""
    program = auto.compiled(scene, folder)
    kinds: list[tuple[str, str, Callable[[], Sample]]] = []
    for name, module in (("ribbonrs", ribbon), ("solve_bvp", bvp)):
        kinds += [(name, f"{tol:g}", in_python(module, scene, tol, folder)) for tol in TOLERANCES[name]]
    for level in auto.LEVELS[scene]:
        kinds.append(("AUTO-07p", f"{level[0]} x {level[1]}", in_fortran(scene, program, level)))
    samples: list[list[Sample]] = [[] for _ in kinds]
    for _ in range(ROUNDS):
        for own, (_, _, measure) in zip(samples, kinds, strict=True):
            own.append(measure())
    rows = []
    for own, (name, level, _) in zip(samples, kinds, strict=True):
        errors, inside, whole = (median(values) for values in zip(*own, strict=True))
        rows.append([scene, name, level, f"{errors:.2e}", f"{1e3 * inside:.2f}", f"{1e3 * whole:.1f}"])
        print(*rows[-1], flush=True)
    return rows


def draw(scene: str, rows: Sequence[dict[str, str]]) -> None:
    """Draw times against errors: in the solver, and of the whole process (dashed)."""
    figure, axes = plt.subplots(figsize=(3.4, 2.9), layout="constrained")
    for name, (colour, marker) in LOOK.items():
        own = [row for row in rows if row["solver"] == name]
        errors = np.array([float(row["error"]) for row in own])
        order = np.argsort(errors)
        for column, style, label in (("solver_ms", "-", name), ("process_ms", ":", None)):
            times = np.array([float(row[column]) for row in own])
            axes.loglog(
                errors[order], times[order], style, marker=marker, ms=4, lw=1.2, color=colour, label=label,
                mfc=colour if label else "white",
            )  # fmt: skip
    axes.set_title(TITLES[scene], fontsize=9)
    axes.set_xlabel("largest relative error of the outputs", fontsize=8)
    axes.set_ylabel("time, ms (dotted: whole process)", fontsize=8)
    axes.tick_params(labelsize=7)
    axes.xaxis.minorticks_off()
    axes.grid(alpha=0.3)
    axes.legend(fontsize=7)
    figure.savefig(FIGURES / f"peers_{scene}.png", dpi=200)
    plt.close(figure)


def main() -> None:
    """Measure, unless told only to draw, and draw."""
    table = FIGURES / "peers.csv"
    if "--draw" not in sys.argv[1:]:
        rows: list[list[Any]] = []
        for scene in TITLES:
            with tempfile.TemporaryDirectory() as folder:
                rows += rows_of(scene, Path(folder))
        with table.open("w", newline="") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerows([["scene", "solver", "level", "error", "solver_ms", "process_ms"], *rows])
    with table.open() as file:
        measured = list(csv.DictReader(file))
    for scene in TITLES:
        draw(scene, [row for row in measured if row["scene"] == scene])


if __name__ == "__main__":
    main()
