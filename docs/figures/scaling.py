"""How time and memory grow: with elements, sections, cells of a map, and cores.

    python docs/figures/scaling.py                  writes scaling.csv and scaling.png beside this file
    python docs/figures/scaling.py WORK SIZE        does one of them, and prints seconds and bytes

Each measurement is a process of its own, since the memory of a process does not go down and the number of
threads (RAYON_NUM_THREADS) is fixed when it starts. The seconds are the least of three calls, or of one
that takes longer than a second; the bytes are what the largest resident memory grows by from the first,
smallest call. Exponents are fitted to the upper half of the sizes.
"""

from __future__ import annotations

import os
import resource
import subprocess
import sys
from collections.abc import Callable
from functools import partial
from time import perf_counter
from typing import Any

import numpy as np
import ribbonrs as rb
from measure import FOLDER, exponent, write
from ribbonrs.figures.style import COLOURS, PAGE, new_figure, styled

ETA, LENGTH = 0.1, 10.0
GROWTH = rb.growth.edge(0.06) + rb.growth.chiral(0.04)


def elements(size: int) -> Callable[[], object]:
    """A ribbon that droops under a weight given by samples, an element between each two of them."""
    S = np.linspace(0.0, LENGTH, size + 1)
    weight = np.tile([-1e-5, 0.0, 0.0], (S.size, 1))
    # Samples that lie on a line would be one piece.
    weight[1::2] *= 1.001
    scene = rb.Scene(rb.Ribbon(LENGTH, 1.0, ETA), loads=[rb.LineLoad(force=(S, weight))])
    return partial(rb.solve, scene, tol=0.9, n=2)


def sections(size: int) -> Callable[[], object]:
    """Energies of one law at many strains."""
    law = rb.SectionLaw(ETA, GROWTH)
    strains = 0.1 * np.random.default_rng(0).normal(size=(size, 4))
    return partial(law.energy, strains)


def cells(size: int) -> Callable[[], object]:
    """A phase diagram over edge growth and oblique fibres."""
    scene = rb.Scene(rb.Ribbon(30.0, 1.0, 0.05), rb.growth.edge(0.03) + rb.growth.chiral(0.04))
    x, y = ("growth.chiral.amplitude", (-0.1, 0.1)), ("growth.edge.amplitude", (-0.02, 0.08))
    return partial(rb.phase_diagram, scene, x, y, n=round(size**0.5), progress=False)


WORK: dict[str, tuple[Callable[[int], Callable[[], object]], tuple[int, ...], tuple[int, ...]]] = {
    # A solve is the work of one thread.
    "elements": (elements, (10, 100, 1_000, 10_000, 100_000), (1,)),
    "sections": (sections, (1, 10, 100, 1_000, 10_000, 100_000, 1_000_000, 10_000_000), (1, 2)),
    "cells": (cells, (100, 400, 2_500, 10_000, 40_000, 160_000), (1, 2)),
}
"""How, sizes, and numbers of threads."""


def resident() -> int:
    """Largest resident memory so far, bytes."""
    return 1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss


def done(work: str, size: int) -> tuple[float, int]:
    """Seconds, and bytes above what the smallest size leaves behind."""
    make, sizes, _ = WORK[work]
    make(sizes[0])()
    before = resident()
    run = make(size)
    times: list[float] = []
    while not times or (len(times) < 3 and times[-1] < 1.0):
        start = perf_counter()
        kept = run()
        times.append(perf_counter() - start)
    assert kept is not None
    return min(times), resident() - before


def apart(work: str, size: int, threads: int) -> tuple[float, int]:
    """The same in a process of its own."""
    command = [sys.executable, __file__, work, str(size)]
    environment = os.environ | {"RAYON_NUM_THREADS": str(threads)}
    printed = subprocess.run(command, check=True, env=environment, stdout=subprocess.PIPE, text=True).stdout
    seconds, grown = printed.split()
    return float(seconds), int(grown)


@styled
def draw(found: dict[tuple[str, int], Any]) -> None:
    """Time and memory over size, and the time of one thread over that of two."""
    figure = new_figure(PAGE, 2.6)
    panels = figure.subplots(1, 3)
    names = {"elements": "elements", "sections": "sections, energy", "cells": "points of a phase diagram"}
    for (work, name), colour, mark in zip(names.items(), (COLOURS[i] for i in (1, 2, 3)), "os^", strict=True):
        sizes, times, grown = found[work, 1].T
        panels[0].loglog(sizes, times, mark + "-", color=colour, label=name)
        seen = grown > 2**20
        panels[1].loglog(sizes[seen], grown[seen] / 1e6, mark + "-", color=colour, label=name)
        if (work, 2) in found:
            panels[2].semilogx(sizes, times / found[work, 2][:, 1], mark + "-", color=colour, label=name)
    for axes, label in zip(
        panels, ("seconds, one thread", "memory added, MB", "gain of a second core"), strict=True
    ):
        axes.set(xlabel="number", ylabel=label)
        axes.grid(alpha=0.25, lw=0.4)
    panels[2].set_ylim(0.0, 2.5)
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=3)
    figure.savefig(FOLDER / "scaling.png")


def main() -> None:
    """Measure, print, write and draw; or do one piece of work."""
    if len(sys.argv) == 3:
        print(*done(sys.argv[1], int(sys.argv[2])))
        return
    rows: list[tuple[str, int, int, float, int]] = []
    for work, (_, sizes, cores) in WORK.items():
        for size in sizes:
            for threads in cores:
                rows.append((work, threads, size, *apart(work, size, threads)))
                print("{}, {} threads | {} | {:.2e} s | {} bytes".format(*rows[-1]), flush=True)
    found = {
        key: np.array([row[2:] for row in rows if row[:2] == key], float) for key in {r[:2] for r in rows}
    }
    for (work, threads), table in sorted(found.items()):
        upper = table[len(table) // 2 :]
        power = exponent(upper[:, 0], upper[:, 1])
        gain = found[work, 1][-1, 1] / table[-1, 1]
        each = upper[-1, 1] / upper[-1, 0], upper[-1, 2] / upper[-1, 0]
        line = "{}, {} threads: exponent {:.2f}, {:.2e} s and {:.0f} bytes each, gain {:.2f}"
        print(line.format(work, threads, power, *each, gain))
    write("scaling", ("work", "threads", "size", "seconds", "bytes"), rows)
    draw(found)


if __name__ == "__main__":
    main()
