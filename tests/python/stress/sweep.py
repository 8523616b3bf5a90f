"""Many scenes in processes of their own, which may hang or die: a table that a second run completes.

python -m stress.sweep 10000 scenes.csv
"""

from __future__ import annotations

import csv
import os
import sys
import time
from dataclasses import astuple
from multiprocessing import get_context
from multiprocessing.connection import wait
from pathlib import Path

from .scenes import random_scene
from .trial import Trial, trial

PATIENCE = 600.0
"""Seconds after which a process counts as hanging: long, for a busy machine may leave it little of them."""


def work(pipe, task):
    """Try what seeds come, until there are none."""
    while (seed := pipe.recv()) is not None:
        pipe.send(task(seed))


class Worker:
    """A process that tries one scene at a time."""

    def __init__(self, context, task, patience):
        self.context, self.task, self.patience = context, task, patience
        self.started()

    def started(self):
        """Start the process, anew if it was there before."""
        self.pipe, theirs = self.context.Pipe()
        self.process = self.context.Process(target=work, args=(theirs, self.task), daemon=True)
        self.process.start()
        theirs.close()

    def give(self, seeds):
        """Hand over the next scene, if there is one; else the process ends."""
        self.seed = next(seeds, None)
        self.pipe.send(self.seed)
        self.since = time.monotonic()
        return self.seed is not None

    def answer(self):
        """What came of the scene, None as long as the process may still say."""
        if self.pipe.poll():
            try:
                return self.pipe.recv()
            except (EOFError, ConnectionError):
                self.process.join()
                return self.lost("crash", f"exit code {self.process.exitcode}")
        if time.monotonic() - self.since > self.patience:
            return self.lost("hang", f"no answer in {self.patience:g} s")
        return None

    def lost(self, result, reason):
        """End the process and say what became of its scene."""
        self.process.kill()
        self.process.join()
        seed = self.seed
        self.started()
        kind, varies, _ = random_scene(seed)
        return Trial(seed, kind, varies, result, reason=reason)


def trials(seeds, processes=2, task=trial, patience=PATIENCE):
    """Yield what `task` says of every seed, as it comes."""
    # One thread each; the setting is read by the processes that are started.
    os.environ["RAYON_NUM_THREADS"] = "1"
    context = get_context("spawn")
    left = iter(seeds)
    busy = [
        worker for worker in (Worker(context, task, patience) for _ in range(processes)) if worker.give(left)
    ]
    while busy:
        wait([worker.pipe for worker in busy], timeout=1.0)
        for worker in list(busy):
            found = worker.answer()
            if found is not None:
                yield found
                if not worker.give(left):
                    busy.remove(worker)


def known(path):
    """Return the rows that a table has: lists of text."""
    if not Path(path).exists():
        return []
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def sweep(count, path):
    """Try the seeds 0 to `count` that the table at `path` does not have yet, and return all its rows."""
    done = {int(row["seed"]) for row in known(path)}
    new = not done
    with open(path, "a", newline="") as file:
        table = csv.writer(file)
        if new:
            table.writerow(Trial.columns())
        for found in trials(seed for seed in range(count) if seed not in done):
            table.writerow(astuple(found))
            file.flush()
    return [row for row in known(path) if int(row["seed"]) < count]


if __name__ == "__main__":
    sweep(int(sys.argv[1]), sys.argv[2])
