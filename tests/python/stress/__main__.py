"""Run every check, print the table, and fail if one does: `python -m stress [scenes [table.csv]]`."""

from __future__ import annotations

import sys
import tempfile
from collections import Counter
from pathlib import Path

from . import boundary, branches, frames, process, section, strips
from .row import Row
from .scenes import KINDS
from .sweep import sweep
from .trial import DEFECTS

PARTS = (section, frames, boundary, branches, strips, process)
SCENES = 10_000


def told(row):
    """A line of the table."""
    verdict = "ok" if row.passed else "FAILED"
    numbers = f"{row.runs:>9,d}  {row.worst:9.2g}  {row.allowed:9.2g} {row.unit:<10}"
    return f"{row.part:<15} {row.what:<58} {numbers} {verdict}"


def scene_rows(table):
    """Random scenes: none may end in a defect; rates of success are told, by kind."""
    for kind in KINDS:
        for varies in ("False", "True"):
            rows = [row for row in table if (row["kind"], row["varies"]) == (kind, varies)]
            if not rows:
                continue
            results = Counter(row["result"] for row in rows)
            defects = sum(results[name] for name in DEFECTS)
            solvable = len(rows) - results["refused"]
            rate = 100.0 * results["converged"] / max(solvable, 1)
            what = f"{kind}, {'varying' if varies == 'True' else 'uniform'}: {rate:.1f} % converged"
            yield Row("random scenes", what, solvable, defects, 0, "defects")


def run(scenes, path):
    """Yield all rows as they come."""
    for part in PARTS:
        yield from part.rows()
    yield from scene_rows(sweep(scenes, path))


def main(arguments):
    """Print the table; 1 if a row failed."""
    scenes = int(arguments[0]) if arguments else SCENES
    with tempfile.TemporaryDirectory() as folder:
        path = arguments[1] if arguments[1:] else Path(folder) / "scenes.csv"
        failed = 0
        for row in run(scenes, path):
            print(told(row), flush=True)
            failed += not row.passed
    print(f"{failed} failed" if failed else "all passed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
