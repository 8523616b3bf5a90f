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

    par: np.ndarray[Any, Any]
    middle: np.ndarray[Any, Any]
    end: np.ndarray[Any, Any]


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
        # fort.7 tells the kind, with eleven digits of the parameter; of points that agree in them the last is meant.
        value = float(row[4])
        near = np.abs(every[:, 0] - value)
        place = int(np.flatnonzero(near <= near.min() + 1e-9 * abs(value))[-1])
        par, states = np.split(every[place], [parameters])
        special.append((KINDS[int(row[2]) % 10 if int(row[2]) > 0 else int(row[2])], Point(par, *np.split(states, 2))))
    return special
