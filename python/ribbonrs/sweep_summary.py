"""What `ribbonrs sweep` prints: how much of the diagram each phase takes, and its boundaries."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from rich.box import SIMPLE_HEAD
from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from .phasediagram import PhaseDiagram

__all__ = ["sweep_summary"]


def sweep_summary(diagram: PhaseDiagram, seconds: float) -> Group:
    """Return the tables of a diagram, which took so long, to be printed by rich."""
    ny, nx = diagram.phase.shape
    axes = " and ".join(
        f"{axis.name} from {axis.span[0]:g} to {axis.span[1]:g}" for axis in (diagram.x, diagram.y)
    )
    points = f"{nx} x {ny} points, boundaries to {diagram.tol:g} of the spans, in {seconds:.2g} s"
    told = [_areas(diagram), *_boundaries(diagram), *_missing(diagram)]
    return Group(Text(axes, style="bold"), Text(points), *told)


def _areas(diagram: PhaseDiagram) -> Table:
    table = Table(title="phases", title_justify="left", box=SIMPLE_HEAD, pad_edge=False)
    table.add_column("phase", no_wrap=True)
    table.add_column("part of the diagram", justify="right", no_wrap=True)
    for phase, area in diagram.areas.items():
        table.add_row(phase, f"{100.0 * area:.3g} %" if area >= 1e-5 else "< 0.001 %")
    return table


def _boundaries(diagram: PhaseDiagram) -> Iterator[RenderableType]:
    lines: dict[tuple[str, str], list[int]] = {}
    for line in diagram.boundaries:
        first, second = sorted(line.phases)
        lines.setdefault((f"{first} and {second}", line.kind), []).append(len(line.points))
    if not lines:
        yield Text("no boundaries")
        return
    table = Table(title="boundaries", title_justify="left", box=SIMPLE_HEAD, pad_edge=False)
    for heading in ("between", "kind"):
        table.add_column(heading, no_wrap=True)
    for heading in ("lines", "points"):
        table.add_column(heading, justify="right", no_wrap=True)
    for (between, kind), sizes in lines.items():
        table.add_row(between, kind, str(len(sizes)), str(sum(sizes)))
    yield table


def _missing(diagram: PhaseDiagram) -> Iterator[RenderableType]:
    unresolved = int(np.count_nonzero(diagram.done & ~diagram.resolved))
    if unresolved:
        yield Text(f"{_points(unresolved)} with states that are not told apart")
    for reason in dict.fromkeys(diagram.reasons.values()):
        count = sum(other == reason for other in diagram.reasons.values())
        yield Text(f"{_points(count)} without a state: {reason}")


def _points(count: int) -> str:
    return f"{count} point" if count == 1 else f"{count} points"
