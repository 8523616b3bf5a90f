"""How the run times of the figures are measured, written and labelled."""

from __future__ import annotations

import csv
import os
import platform
import sys
from collections.abc import Callable, Hashable, Mapping, Sequence
from datetime import datetime, timezone
from pathlib import Path
from time import perf_counter
from typing import Any, TypeVar

import numpy as np

FOLDER = Path(__file__).parent
SHORTEST = 2e-3
"""Seconds that one measurement takes at least, by repetition: the clock and a call are small against it."""
FLOOR = 1e-17
"""Where an exact result is drawn."""

Name = TypeVar("Name", bound=Hashable)


def seconds(runs: Mapping[Name, Callable[[], object]], rounds: int = 7) -> dict[Name, float]:
    """The least seconds of a call to each, of rounds in which all take their turn.

    What else the machine does can only add to a time, and not to all rounds of one.
    """
    counts = {}
    for name, run in runs.items():
        run()
        start = perf_counter()
        run()
        counts[name] = max(1, round(SHORTEST / (perf_counter() - start)))
    found: dict[Name, list[float]] = {name: [] for name in runs}
    for _ in range(rounds):
        for name, run in runs.items():
            start = perf_counter()
            for _ in range(counts[name]):
                run()
            found[name].append((perf_counter() - start) / counts[name])
    return {name: min(times) for name, times in found.items()}


def machine() -> str:
    """Processor, cores and versions, in a line."""
    model = platform.processor() or platform.machine()
    known = Path("/proc/cpuinfo")
    if known.exists():
        lines = known.read_text().splitlines()
        model = next((line.split(":")[1].strip() for line in lines if line.startswith("model name")), model)
    versions = f"Python {platform.python_version()}, numpy {np.__version__}"
    return f"{os.cpu_count()} cores of {model}, {platform.system()}, {versions}"


def write(name: str, columns: Sequence[str], rows: Sequence[Sequence[Any]]) -> None:
    """Write a table beside this file, its first line saying when, where and by what it was measured."""
    now = datetime.now(timezone.utc).strftime("%Y-%m-%d")
    with (FOLDER / f"{name}.csv").open("w", newline="") as file:
        file.write(f"# {now}; {machine()}; python docs/figures/{Path(sys.argv[0]).name}\n")
        table = csv.writer(file, lineterminator="\n")
        table.writerow(columns)
        for row in rows:
            table.writerow([f"{value:.3e}" if isinstance(value, float) else value for value in row])


def exponent(sizes: Sequence[float], times: Sequence[float]) -> float:
    """The power of the size with which the time grows, by least squares in the logarithms."""
    return float(np.polyfit(np.log(sizes), np.log(times), 1)[0])
