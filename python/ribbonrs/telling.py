"""Progress of long work, on standard error."""

from __future__ import annotations

import sys
import time
from types import TracebackType

from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

__all__ = ["Telling"]

QUIET = 1.0
"""Seconds before progress is worth telling."""


class Telling:
    """Tells how much of some work is done: call it with that.

    Parameters
    ----------
    what : str
        What is done.
    total : int
        How much there is.
    shown : bool, optional
        Whether it is told at all; None if it takes longer than a second and standard error is a terminal.
    """

    def __init__(self, what: str, total: int, shown: bool | None = None) -> None:
        self.what, self.total = what, total
        self.shown = sys.stderr.isatty() if shown is None else shown
        self.after = time.monotonic() + (QUIET if shown is None else 0.0)
        self.progress: Progress | None = None

    def __enter__(self) -> Telling:
        return self

    def __call__(self, done: int) -> None:
        """Tell that so much is done."""
        if not self.shown or time.monotonic() < self.after:
            return
        if self.progress is None:
            columns = (TextColumn("{task.description}"), BarColumn(), TextColumn("{task.percentage:.0f} %"))
            console = Console(stderr=True)
            self.progress = Progress(
                *columns, TimeRemainingColumn(), console=console, transient=console.is_terminal
            )
            self.progress.add_task(self.what, total=self.total)
            self.progress.start()
        self.progress.update(self.progress.task_ids[0], completed=done)

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self.progress is not None:
            self.progress.stop()
