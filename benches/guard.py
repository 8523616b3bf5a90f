"""Instructions of units of work, by callgrind, against stored numbers.

    python benches/guard.py            compares with benches/guard.csv, and fails where one is off by 2 %
    python benches/guard.py --write    writes benches/guard.csv

A unit is an energy, gradient and Hessian of a section, a segment of a frame, an element of a Newton
iteration, or a whole diagram: see benches/guard.rs. Two runs with different repetitions differ by the work
alone, not by start and set-up. Counts do not depend on what else the machine does. They do depend on the
compiler, on the C library, so the file says with which they were counted; after a change of those it is
written anew. They are those of any processor: of wider ones, which the program uses where there are some,
valgrind knows not all.
"""

from __future__ import annotations

import csv
import json
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[1]
STORED = Path(__file__).with_suffix(".csv")
TOLERANCE = 0.02
"""Far above what is not the same in every run, less than a change that could be noticed in run time."""
LEAST = 10_000
"""Units between the two runs."""


def output(*command: str) -> str:
    """What a command prints to both streams."""
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.STDOUT}
    return str(subprocess.run(command, cwd=ROOT, check=True, text=True, **pipes).stdout)


def built() -> str:
    """The program that does the work, built."""
    options = ["--features=baseline", "--example=guard", "--message-format=json"]
    command = ["cargo", "build", "--quiet", "--release", *options]
    lines = subprocess.run(
        command, cwd=ROOT, check=True, text=True, stdout=subprocess.PIPE
    ).stdout.splitlines()
    found = [message["executable"] for message in map(json.loads, lines) if message.get("executable")]
    return str(found[-1])


def instructions(program: str, unit: str, repetitions: int) -> int:
    """Instructions of a whole run."""
    tool = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null"]
    found = re.search(r"Collected : (\d+)", output(*tool, program, unit, str(repetitions)))
    assert found
    return int(found[1])


def counted() -> dict[str, float]:
    """Instructions of each unit."""
    program = built()
    counts = {}
    for line in output(program).splitlines():
        unit, size = line.split(",")
        repetitions = max(1, LEAST // int(size)) if not unit.startswith(("iteration", "diagram")) else 5
        few, many = (instructions(program, unit, n * repetitions) for n in (1, 2))
        counts[unit] = (many - few) / (repetitions * int(size))
        print(f"{unit:28} {counts[unit]:10.0f}", flush=True)
    return counts


def conditions() -> str:
    """With what the counts were made."""
    libc = output("ldd", "--version").splitlines()[0]
    return (
        "; ".join(output(tool, "--version").splitlines()[0] for tool in ("rustc", "valgrind")) + f"; {libc}"
    )


def main() -> int:
    """Write or compare; the exit status."""
    counts = counted()
    if "--write" in sys.argv[1:]:
        with STORED.open("w", newline="") as file:
            file.write(f"# {conditions()}\n")
            rows = csv.writer(file, lineterminator="\n")
            rows.writerows([("unit", "instructions"), *((unit, round(n)) for unit, n in counts.items())])
        return 0
    header, *lines = STORED.read_text().splitlines()
    stored = {row["unit"]: float(row["instructions"]) for row in csv.DictReader(lines)}
    if header[2:] != conditions():
        print(f"stored with {header[2:]}\ncounted with {conditions()}")
    failed = sorted(stored.keys() ^ counts.keys())
    for unit in stored.keys() & counts.keys():
        if abs(counts[unit] / stored[unit] - 1.0) > TOLERANCE:
            failed.append(f"{unit}: {counts[unit]:.0f} instructions, stored {stored[unit]:.0f}")
    print("\n".join(["differs:", *failed]) if failed else f"all within {TOLERANCE:.0%} of {STORED.name}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
