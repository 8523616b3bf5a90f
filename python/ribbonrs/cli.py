"""The command line: ``ribbonrs run SCENE.toml``.

Exit status 0, or 2 for wrong input, 1 where no solution was found; the reason is one line on stderr.
"""

from __future__ import annotations

import argparse
import io
import os
import sys
import warnings
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory

from rich.console import Console

from .equilibrium import chosen, equilibria, solve
from .errors import InputError, RibbonError, RibbonWarning
from .scenefile import Output, read
from .state import State
from .summary import summary

__all__ = ["main"]


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line and return its exit status."""
    scene = _parser().parse_args(arguments).scene
    try:
        _run(scene)
        print(end="", flush=True)
    except InputError as error:
        return _fail(str(error), 2)
    except RibbonError as error:
        return _fail(str(error), 1)
    except KeyboardInterrupt:
        return _fail("interrupted", 130)
    except OSError as error:  # a closed pipe, a full disk: reading and writing files name their field instead
        # Keep the interpreter from failing again at exit.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 1 if isinstance(error, BrokenPipeError) else _fail(f"standard output: {error.strerror}", 1)
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="ribbonrs", description="Equilibrium shapes of thin growing ribbons.", allow_abbrev=False
    )
    commands = parser.add_subparsers(required=True, metavar="COMMAND")
    run = commands.add_parser("run", help="find the shapes of a scene, show and save them")
    run.add_argument("scene", type=Path, metavar="SCENE.toml", help="the scene file")
    return parser


def _run(path: Path) -> None:
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", RibbonWarning)
        job = read(path)
        states = [] if job.scene.loaded else equilibria(job.scene)
        state = chosen(states) if states else solve(job.scene, **job.options)
        others = [other for other in states if other is not state]
        _write(state, job.outputs)
    for message in dict.fromkeys(str(warning.message) for warning in caught):
        print(f"ribbonrs: warning: {message}", file=sys.stderr)
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="backslashreplace")
    console = Console(markup=False, highlight=False, emoji=False)
    told = summary(job.scene, state, others)
    # A narrow terminal wraps; cropped numbers would be read wrongly.
    console.width = max(
        console.width, console.measure(told, options=console.options.update(width=1000)).maximum
    )
    console.print(told)
    if job.has_trace:
        console.print("[trace] is for a later version and was left out.")
    for output in job.outputs:
        console.print(f"wrote {output.path}", soft_wrap=True)


def _write(state: State, outputs: Sequence[Output]) -> None:
    """Write all files or none: each beside its place first, then all are moved there."""
    with ExitStack() as stack:
        moves = []
        for output in outputs:
            with _naming(output):
                beside = TemporaryDirectory(prefix=".ribbonrs-", dir=output.path.parent)
                written = Path(stack.enter_context(beside), output.path.name)
                if output.field.startswith("output.figure"):
                    state.plot(written)
                else:
                    state.save(written)
            moves.append((output, written))
        for output, written in moves:
            with _naming(output):
                written.replace(output.path)


@contextmanager
def _naming(output: Output) -> Iterator[None]:
    """Turn a failure to write into an error that names the key of the scene file."""
    try:
        yield
    except OSError as error:
        expected = f"a file that can be written, not: {error.strerror}"
        raise InputError(output.field, str(output.path), expected) from None


def _fail(reason: str, status: int) -> int:
    print(f"ribbonrs: {reason}", file=sys.stderr)
    return status
