"""The program as a process: the same bits, no growth of memory, interrupts, and a kill while it writes."""

from __future__ import annotations

import hashlib
import math
import os
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import ribbonrs as rb

from .row import Row

LEAF = rb.Ribbon(10.0, 1.0, 0.1)
ETA = 0.1


def digest():
    """A hash of every bit of states, a trace, a map and many strains."""
    known = hashlib.sha256()

    def add(*arrays):
        for array in arrays:
            known.update(np.ascontiguousarray(array).tobytes())

    growth = rb.growth.edge(0.06) + rb.growth.chiral(0.04)
    strains = np.random.default_rng(3).normal(size=(200_000, 4)) * [ETA**2, ETA**2, ETA, ETA]
    law = rb.SectionLaw(ETA, growth)
    add(law.energy(strains), law.gradient(strains), law.hessian(strains))
    growths = [rb.growth.edge(xi) + rb.growth.chiral(0.02) for xi in np.linspace(0.0, 0.1, 300)]
    for states in rb.natural_shapes(LEAF, growths):
        add(*(state.strain for state in states), [state.energy for state in states])
    held = rb.Scene(LEAF, rb.growth.edge(0.02), end=rb.Clamped((0.0, 0.5, 9.0), twist_turns=0.25))
    state = rb.solve(held)
    add(state.strains, state.position, state.force, state.moment, [state.energy, state.report.error])
    diagram = rb.trace(held, "end.position[2]", (8.5, 9.5), start=state, depth=1)
    for branch in diagram.branches:
        add(branch.parameter, branch.strains, branch.index)
    scene = rb.Scene(LEAF, growth)
    plane = rb.phase_diagram(
        scene, ("growth.edge.amplitude", (0.0, 0.1)), ("growth.chiral.amplitude", (0.0, 0.1)), n=60
    )
    add(plane.phase)
    add(*(line.points for line in plane.boundaries))
    return known.hexdigest()


def environment(threads="2"):
    """That of a process which finds the modules of this one."""
    path = os.pathsep.join(map(os.path.abspath, sys.path))
    return {**os.environ, "PYTHONPATH": path, "RAYON_NUM_THREADS": threads}


def python(code, threads="2"):
    """A process that runs code of this package."""
    return subprocess.Popen(
        [sys.executable, "-c", code], env=environment(threads), text=True, stdout=subprocess.PIPE
    )


def same_bits():
    """The digest of two runs with two threads, one with one, and two in the same process."""
    code = "from stress.process import digest; print(digest(), digest())"
    seen, failed = set(), 0
    for threads in ("2", "2", "1"):
        process = python(code, threads)
        seen.update(process.communicate()[0].split())
        failed += process.returncode != 0
    others = len(seen) - 1 if not failed else math.inf
    return Row("process", "other results in six runs, one thread or two", 6, others, 0)


def resident():
    """Bytes of memory of this process."""
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE")


def grown(count):
    """How much memory grows over `count` solves of various kinds, after a tenth more."""
    for i in range(count + count // 10):
        if i == count // 10:
            before = resident()
        edge = rb.growth.edge(0.02 + 1e-6 * i)
        match i % 4:
            case 0:
                rb.solve(rb.Scene(LEAF, edge, end=rb.Free(force=(1e-6, 0.0, 0.0))))
            case 1:
                rb.natural_shapes(LEAF, edge + rb.growth.chiral(0.04))
            case 2:
                rb.solve(rb.Scene(LEAF, edge, end=rb.Pinned((0.0, 2.0, 9.0)), gravity=(0.0, 0.0, -1e-7)))
            case _:
                rb.solve(rb.Scene(LEAF, rb.growth.edge(([0.0, 10.0], [0.0, 0.06]))))
    return resident() - before


def memory(count=10_000):
    """Memory of a process of its own."""
    code = f"from stress.process import grown; print(grown({count}))"
    megabytes = int(python(code).communicate()[0]) / 1e6
    # the interpreter's own arenas come and go by a few MB; 1 kB a solve lost would be 10
    return Row("process", "growth of memory", count, megabytes, 5.0, "MB")


SWEEP = """
[ribbon]
length = 10.0
width = 1.0
thickness = 0.1
[growth]
edge = 0.06
chiral = 0.04
{end}
[sweep]
x = {{ parameter = "growth.chiral.amplitude", span = [0.0, 0.1] }}
y = {{ parameter = "growth.edge.amplitude", span = [0.0, {most}] }}
n = {n}
[output]
phases = "map.npz"
"""
NATURAL = {"end": "", "most": 0.1, "n": 1200}
HELD = {"end": "[end]\nkind = 'pinned'", "most": 0.04, "n": 200}
ANSWER = 5.0
"""Seconds from an interrupt to the end, in which the map so far is written, on a busy machine."""


def interrupted(runs=8):
    """Ctrl-C in `ribbonrs sweep`: it ends soon, says 130, and a map that it wrote says so, too."""
    begun, bad = time.monotonic(), 0
    python("import ribbonrs.cli, ribbonrs.phasediagram").communicate()
    loading = time.monotonic() - begun
    for i in range(runs):
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            (folder / "scene.toml").write_text(SWEEP.format(**(HELD if i % 2 else NATURAL)))
            process = subprocess.Popen(
                [sys.executable, "-m", "ribbonrs", "sweep", "scene.toml"],
                cwd=folder,
                env=environment(),
                # shells start what runs in the background deaf to Ctrl-C, and children inherit that
                preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
                text=True,
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
            )
            time.sleep(2.0 * loading + 0.2 * i)
            process.send_signal(signal.SIGINT)
            begun = time.monotonic()
            err = process.communicate()[1]
            late = time.monotonic() - begun > ANSWER
            bad += late or process.returncode != 130 or "Traceback" in err or not says_so(folder)
    return Row("process", "Ctrl-C in a sweep that is not answered cleanly", runs, int(bad), 0)


def says_so(folder):
    """Whether there is nothing but, if anything, a map that knows it was interrupted."""
    names = {path.name for path in folder.iterdir()} - {"scene.toml"}
    return not names or (names == {"map.npz"} and rb.load_phase_diagram(folder / "map.npz").interrupted)


def write_again_and_again(folder):
    """Save two states in turn under the same names, until killed."""
    states = [rb.solve(rb.Scene(LEAF, rb.growth.edge(xi)), n=2001) for xi in (0.03, 0.06)]
    turn = 0
    while True:
        for suffix in ("npz", "vtp"):
            states[turn % 2].save(Path(folder) / f"state.{suffix}")
        if turn == 0:
            print("begun", flush=True)
        turn += 1


def killed(runs=40):
    """Kill a process that writes: what is under the name is a whole file, one or the other."""
    bad = 0
    for i in range(runs):
        with tempfile.TemporaryDirectory() as folder:
            code = f"from stress.process import write_again_and_again as w; w({folder!r})"
            process = python(code)
            process.stdout.readline()
            time.sleep(0.003 * (i % 20) + 0.02)
            process.kill()
            process.communicate()
            bad += not whole(Path(folder))
    return Row("process", "half a file after a kill", runs, bad, 0)


def whole(folder):
    """Whether both files can be read to their ends."""
    try:
        with np.load(folder / "state.npz") as data:
            for name in data.files:
                data[name]
        text = (folder / "state.vtp").read_text()
    except Exception:  # whatever a half-written file makes of the reader
        return False
    return text.startswith("<?xml") and text.rstrip().endswith("</VTKFile>")


CHECKS = (same_bits, memory, interrupted, killed)


def rows():
    """All of them."""
    for check in CHECKS:
        yield check()
