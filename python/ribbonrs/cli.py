"""The command line: ``ribbonrs run``, ``trace`` and ``sweep`` of a scene file, ``figures`` and ``validate``.

Exit status 0, or 2 for wrong input, 1 where no solution was found, 130 after an interrupt; the reason is one
line on stderr. Also 1 where a row of the validation fails.
"""

from __future__ import annotations

import argparse
import io
import os
import sys
import time
import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from difflib import get_close_matches
from pathlib import Path

from rich.console import Console, RenderableType

from .equilibrium import chosen, equilibria, solve
from .errors import MISSING, InputError, RibbonError, RibbonWarning
from .files import check_path
from .outputs import Output, write_all
from .scenefile import read
from .summary import summary
from .sweep_summary import sweep_summary
from .trace_summary import trace_summary

__all__ = ["main"]

INTERRUPTED = 130
"""Exit status after an interrupt, also where what was done until then is written."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line and return its exit status."""
    given = _parser().parse_args(arguments)
    try:
        status: int = given.command(given)
        print(end="", flush=True)
    except InputError as error:
        return _fail(str(error), 2)
    except RibbonError as error:
        return _fail(str(error), 1)
    except KeyboardInterrupt:
        return _fail("interrupted", INTERRUPTED)
    except OSError as error:  # a closed pipe, a full disk: reading and writing files name their field instead
        # Keep the interpreter from failing again at exit.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 1 if isinstance(error, BrokenPipeError) else _fail(f"standard output: {error.strerror}", 1)
    return status


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="ribbonrs", description="Equilibrium shapes of thin growing ribbons.", allow_abbrev=False
    )
    commands = parser.add_subparsers(required=True, metavar="COMMAND")
    for name, command, told in (
        ("run", _run, "find the shapes of a scene, show and save them"),
        ("trace", _trace, "follow the shapes of a scene along a parameter, show and save the branches"),
        ("sweep", _sweep, "find the phases of a scene over two parameters, draw and save them"),
    ):
        added = commands.add_parser(name, help=told)
        added.add_argument("scene", type=Path, metavar="SCENE.toml", help="the scene file")
        added.set_defaults(command=command)
    added = commands.add_parser("figures", help="draw the figures of the paper that the model comes from")
    added.add_argument("names", nargs="*", metavar="NAME", help="fig3, fig4, ...; all without a name")
    added.add_argument("--directory", type=Path, default=Path("figures"), help="made if it does not exist")
    added.add_argument("--format", nargs="+", default=["pdf", "png"], help="pdf, png, svg")
    added.set_defaults(command=_figures)
    added = commands.add_parser("validate", help="compare what is published with what the program gives")
    added.add_argument("topics", nargs="*", metavar="TOPIC", help="which part of it; all if none is named")
    added.add_argument("--csv", type=Path, metavar="PATH", help="write the table as comma-separated values")
    added.set_defaults(command=_validate)
    return parser


def _run(given: argparse.Namespace) -> int:
    with _told_warnings():
        job = read(given.scene)
        states = [] if job.scene.loaded else equilibria(job.scene)
        state = chosen(states) if states else solve(job.scene, **job.options)
        others = [other for other in states if other is not state]
        told = summary(job.scene, state, others)
        write_all(job.outputs, lambda kind, path: (state.plot if kind == "figure" else state.save)(path))
    notes = [
        f"`ribbonrs {name}` draws the {what} that [{name}] asks for."
        for name, what, asked in (("trace", "branches", job.trace), ("sweep", "phases", job.sweep))
        if asked
    ]
    _print(told, notes, job.outputs)
    return 0


def _trace(given: argparse.Namespace) -> int:
    with _told_warnings():
        job = read(given.scene)
        if job.trace is None:
            raise InputError("trace", MISSING, "a table with a parameter and its span")
        diagram = job.trace.diagram(job.scene, **job.options)
        told = trace_summary(diagram)
        quantity = job.trace.quantity
        writers: dict[str, Callable[[Path], object]] = {
            "diagram": lambda path: diagram.plot(quantity, path),
            "table": diagram.to_csv,
            "branches": diagram.save,
        }
        write_all(job.traced, lambda kind, path: writers[kind](path))
    _print(told, [], job.traced)
    return 0


def _sweep(given: argparse.Namespace) -> int:
    with _told_warnings():
        job = read(given.scene)
        if job.sweep is None:
            raise InputError("sweep", MISSING, "a table with two parameters and their spans, x and y")
        begun = time.perf_counter()
        diagram = job.sweep.diagram(job.scene)
        told = sweep_summary(diagram, time.perf_counter() - begun)
        writers: dict[str, Callable[[Path], object]] = {
            "map": diagram.plot,
            "table": diagram.to_csv,
            "phases": diagram.save,
        }
        write_all(job.swept, lambda kind, path: writers[kind](path))
    _print(told, [], job.swept)
    return INTERRUPTED if diagram.interrupted else 0


def _figures(given: argparse.Namespace) -> int:
    from .figures import FIGURES
    from .figures.drawing import FORMATS

    for field, names, known in (("figure", given.names, list(FIGURES)), ("format", given.format, FORMATS)):
        for name in names:
            if name not in known:
                nearest = get_close_matches(name, known, n=1, cutoff=0.0)[0]
                raise InputError(field, name, f"one of {', '.join(known)}; the nearest is {nearest}")
    try:
        given.directory.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise _unwritable("directory", given.directory, error) from None
    for name in dict.fromkeys(given.names or FIGURES):
        drawing = FIGURES[name]()
        try:
            written = drawing.save(given.directory, given.format)
        except OSError as error:
            raise _unwritable("directory", given.directory, error) from None
        for path in written:
            print(f"wrote {path}", flush=True)
    return 0


def _validate(given: argparse.Namespace) -> int:
    from .validation import validate  # which loads half of scipy

    if given.csv is not None:
        check_path(given.csv, [".csv"])
    validation = validate(given.topics)
    notes = []
    if given.csv is not None:
        try:
            validation.to_csv(given.csv)
        except OSError as error:
            raise _unwritable("csv", given.csv, error) from None
        notes.append(f"wrote {given.csv}")
    _print(validation.summary, notes, [])
    return 0 if validation.passed else 1


def _unwritable(field: str, path: Path, error: OSError) -> InputError:
    return InputError(field, str(path), f"one that can be written, not: {error.strerror}")


@contextmanager
def _told_warnings() -> Iterator[None]:
    """Print what is warned of, each once, if all went well: an error says it otherwise."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", RibbonWarning)
        yield
    for message in dict.fromkeys(str(warning.message) for warning in caught):
        print(f"ribbonrs: warning: {message}", file=sys.stderr)


def _print(told: RenderableType, notes: Sequence[str], outputs: Sequence[Output]) -> None:
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="backslashreplace")
    console = Console(markup=False, highlight=False, emoji=False)
    # A narrow terminal wraps; cropped numbers would be read wrongly.
    console.width = max(
        console.width, console.measure(told, options=console.options.update(width=1000)).maximum
    )
    console.print(told)
    for note in notes:
        console.print(note)
    for output in outputs:
        console.print(f"wrote {output.path}", soft_wrap=True)


def _fail(reason: str, status: int) -> int:
    print(f"ribbonrs: {reason}", file=sys.stderr)
    return status
