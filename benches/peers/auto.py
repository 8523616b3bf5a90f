"""AUTO-07p on the scenes: compiles its equations, runs it, and reads what it found."""

from __future__ import annotations

import os
import subprocess
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from scenes import canonical, reference

Array = np.ndarray[Any, Any]
Constants = Mapping[str, Any]

SOURCES = Path(__file__).parent / "auto"
OBJECTS = Path("/usr/lib/auto-07p/lib")
"""Where the Debian package auto-07p has the objects that every equation is linked with."""

FLAGS = ("-O3", "-march=native", "-fopenmp", "-ffree-line-length-none")
"""-fopenmp since the objects of the package ask for its library; one thread is used."""

COMMON = {"IPS": 4, "ILP": 0, "JAC": 1, "IID": 0, "MXBF": 0, "NPR": 0, "IADS": 1, "NMX": 500, "NINT": 0}
"""Boundary values, with derivatives; no folds are located; little is written."""


@dataclass(frozen=True)
class Point:
    """What AUTO has at one point: parameters, and states at the middle and the end."""

    par: Array
    middle: Array
    end: Array


@dataclass(frozen=True)
class Found:
    """Special points by kind, in order, of all runs, and how long it took."""

    points: Mapping[str, Sequence[Point]]
    solver: float
    process: float


KINDS = {1: "BP", 6: "BP", 5: "LP", -4: "UZ", 9: "EP", -9: "MX"}


def compiled(scene: str, folder: Path) -> Path:
    """Return the program of a scene, compiled into `folder`."""
    for name in ("record", "edge_law", "rod", scene):
        subprocess.run(["gfortran", *FLAGS, "-c", SOURCES / f"{name}.f90"], cwd=folder, check=True)
    units = [f"{scene}.o", "record.o", "edge_law.o", "rod.o"]
    program = folder / f"{scene}.exe"
    objects = sorted(OBJECTS.glob("*.o"))
    linker = ["gfortran", "-fopenmp", "-Wl,-z,noexecstack", *units, *objects, "-o", program]
    subprocess.run(linker, cwd=folder, check=True)
    return program


def run(program: Path, runs: Sequence[Constants], parameters: int) -> Found:
    """Run AUTO once for each set of constants, each from the last labelled point of the one before."""
    folder = program.parent
    environment = {**os.environ, "OMP_NUM_THREADS": "1"}
    found: dict[str, list[Point]] = {}
    solver = process = 0.0
    for i, constants in enumerate(runs):
        text = "\n".join(f"{name} = {value}" for name, value in {**COMMON, **constants}.items())
        (folder / "fort.2").write_text(text + "\n")
        if i:
            (folder / "fort.8").replace(folder / "fort.3")
        before = time.perf_counter()
        done = subprocess.run(
            [program], cwd=folder, env=environment, capture_output=True, text=True, check=True
        )
        process += time.perf_counter() - before
        solver += float(done.stdout.rsplit("Total Time", 1)[1].split()[0])
        for kind, point in _special(folder, parameters):
            found.setdefault(kind, []).append(point)
    return Found(found, solver, process)


def _special(folder: Path, parameters: int) -> list[tuple[str, Point]]:
    """Labelled points of a run, with all digits."""
    rows = [line.split() for line in (folder / "fort.7").read_text().splitlines()]
    labelled = [row for row in rows if row[0] != "0" and int(row[3])]
    every = np.loadtxt(folder / "points.txt", ndmin=2)
    special = []
    for row in labelled:
        # fort.7 tells the kind, with eleven digits of the parameter; of points that agree the last is meant.
        value = float(row[4])
        near = np.abs(every[:, 0] - value)
        place = int(np.flatnonzero(near <= near.min() + 1e-9 * abs(value))[-1])
        par, states = np.split(every[place], [parameters])
        kind = int(row[2])
        special.append((KINDS[kind % 10 if kind > 0 else kind], Point(par, *np.split(states, 2))))
    return special


Level = tuple[int, int]
"""Mesh intervals and collocation points in each: what the error depends on."""

LEVELS: Mapping[str, Sequence[Level]] = {
    "s1": ((3, 3), (4, 3), (4, 4), (5, 5)),
    "s2": ((3, 3), (4, 4), (6, 4), (8, 5)),
    "s3": ((3, 3), (4, 4), (6, 5), (8, 6)),
    "s4": ((12, 4), (16, 4), (24, 4), (32, 4), (24, 6), (48, 5)),
}
"""Meshes are even and do not move, so that the middle of S4 is a node."""

PARAMETERS = {"s1": 1, "s2": 3, "s3": 1, "s4": 7}


def _runs(scene: str, level: Level) -> list[Constants]:
    """Constants of the runs of a scene; steps are about the longest with which AUTO finds what it should."""
    states = {"s1": 13, "s2": 7, "s3": 4, "s4": 7}[scene]
    target = {"s1": 8.0, "s2": 2 * float(reference("s2")[0]), "s3": 10.0, "s4": 0.9}[scene]
    common = {
        "NDIM": states,
        "NBC": states + PARAMETERS[scene] - 1,
        "ICP": list(range(1, PARAMETERS[scene] + 1)),
        "NTST": level[0],
        "NCOL": level[1],
        "IAD": 0,
        "ITNW": 7,
        "NWTN": 3,
        "ITMX": 20,
        "DSMIN": 1e-5,
        "UZSTOP": {1: target},
    }

    def run_of(
        step: float, longest: float, epsilon: float, stop: str = "", switch: bool = False
    ) -> Constants:
        own = {"DS": step, "DSMAX": longest, "EPSL": epsilon, "EPSU": epsilon, "EPSS": epsilon}
        own |= {"ISP": 2, "STOP": f"['{stop}']"} if stop else {"ISP": 0}
        own |= {"ISW": -1, "IRS": "'BP1'"} if switch else {"ISW": 1}
        return {**common, **own}

    if scene == "s1":
        return [run_of(0.4, 0.4, 1e-9, "BP2"), run_of(0.4, 0.4, 1e-9, switch=True)]
    if scene == "s2":
        return [run_of(1.0, 3.0, 1e-9, "BP1"), run_of(1.0, 3.0, 1e-9, switch=True)]
    if scene == "s3":
        return [run_of(1.0, 3.0, 1e-9, "BP1"), run_of(1.0, 5.0, 1e-9, switch=True)]
    return [
        run_of(-2.0, 2.0, 1e-7, "BP1"),
        run_of(0.2, 0.2, 1e-7, "BP1", switch=True),
        run_of(0.2, 0.5, 1e-9, switch=True),
    ]


def solve(scene: str, program: Path, level: Level) -> tuple[Array, Found]:
    """Return the outputs of a scene, and how they were found."""
    found = run(program, _runs(scene, level), PARAMETERS[scene])
    bifurcations = [point.par[0] for point in found.points["BP"]]
    last = found.points["UZ"][-1]
    end, middle, par = last.end, last.middle, last.par
    if scene == "s1":
        outputs = [*bifurcations[:2], abs(end[2]), abs(end[6]), end[8]]
    elif scene == "s2":
        outputs = [bifurcations[0], abs(end[0]), end[1], end[2], par[1], abs(par[2])]
    elif scene == "s3":
        outputs = [bifurcations[0], abs(end[2]), end[3]]
    else:
        outputs = [bifurcations[1], *canonical(par[1:4], par[4:7], middle[:3])]
    return np.array(outputs), found
