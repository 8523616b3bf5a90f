"""What `ribbonrs trace` prints: the branches and their special points."""

from __future__ import annotations

from collections.abc import Iterator

from rich.box import SIMPLE_HEAD
from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from .branch import Branch
from .diagram import Diagram
from .stability import stable_spans

__all__ = ["trace_summary"]


def trace_summary(diagram: Diagram) -> Group:
    """Return the tables of a diagram, to be printed by rich."""
    low, high = diagram.span
    told = f"{diagram.parameter} from {low:g} to {high:g}"
    tables = _branches_table(diagram), *_special_table(diagram), *_failures(diagram)
    work = [Text(str(diagram.work))] if diagram.work else []
    return Group(Text(told, style="bold"), *tables, *work)


def _table(title: str, headings: tuple[str, ...], numbers: set[str]) -> Table:
    table = Table(title=title, title_justify="left", box=SIMPLE_HEAD, pad_edge=False)
    for heading in headings:
        table.add_column(heading, justify="right" if heading in numbers else "left", no_wrap=True)
    return table


def _branches_table(diagram: Diagram) -> Table:
    headings = ("branch", "shape", "points", "from", "to", "stable", "began", "ended")
    table = _table("branches", headings, {"branch", "points", "from", "to"})
    for branch in diagram.branches:
        first, last = (f"{value:.6g}" for value in branch.parameter[[0, -1]].tolist())
        first_own = 0 if branch.origin is None else 1  # at its origin it is a point of another branch
        shapes = ", ".join(dict.fromkeys(branch.phases[first_own:]))
        began, ended = branch.ended
        table.add_row(
            str(branch.number),
            shapes + (", mirrored" if branch.mirrored else ""),
            str(branch.parameter.size),
            first,
            last,
            ", ".join(_stable(diagram, branch)) or ("no" if branch.known.all() else "not known"),
            began if branch.origin is None else _place(diagram, branch.origin),
            ended,
        )
    return table


def _place(diagram: Diagram, i: int) -> str:
    """The special point at which a branch begins."""
    point = diagram.special_points[i]
    return f"{point.kind.replace('_', ' ')} of {point.branch}"


def _stable(diagram: Diagram, branch: Branch) -> Iterator[str]:
    """Ranges of the parameter in which a branch is stable, in its order."""
    for first, last in stable_spans(diagram, branch):
        yield f"{first:.6g} to {last:.6g}"


def _special_table(diagram: Diagram) -> Iterator[RenderableType]:
    points = [point for point in diagram.special_points if point.kind != "end"]
    if not points:
        yield Text("no special points")
        return
    headings = ("kind", diagram.parameter, "branch", "multiplicity")
    table = _table("special points", headings, {diagram.parameter, "branch", "multiplicity"})
    for point in points:
        kind = point.kind.replace("_", " ") + (f" of {point.name}" if point.name else "")
        table.add_row(kind, f"{point.parameter:.10g}", str(point.branch), str(point.multiplicity))
    yield table


def _failures(diagram: Diagram) -> Iterator[RenderableType]:
    """Why branches failed."""
    for point in diagram.special_points:
        if point.reason:
            yield Text(f"branch {point.branch} failed at {point.parameter:.10g}: {point.reason}")
