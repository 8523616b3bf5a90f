"""The table [sweep] of a scene file: over which two parameters to find the phases of the scene."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from .growthtable import Table
from .phasediagram import PhaseDiagram, check_parameters, phase_diagram
from .scene import Scene

__all__ = ["SweepTable", "Sweeping"]


@dataclass(frozen=True)
class Sweeping:
    """What `ribbonrs sweep` is asked for."""

    x: tuple[Any, Any]
    y: tuple[Any, Any]
    options: dict[str, Any]
    """`n` and `tol` for `phase_diagram`, if they are given."""

    def check(self, scene: Scene) -> None:
        """Refuse parameters that the scene does not have."""
        check_parameters(scene, self.x, self.y)

    def diagram(self, scene: Scene) -> PhaseDiagram:
        """Find the phases of the scene."""
        return phase_diagram(scene, self.x, self.y, **self.options)


class _AxisTable(Table):
    parameter: Any
    span: Any


class SweepTable(Table):
    """The table [sweep]."""

    x: _AxisTable
    y: _AxisTable
    n: Any = None
    tol: Any = None

    def make(self) -> Sweeping:
        """Return what it says; it is checked with the scene."""
        given = self.given()
        x, y = ((axis.parameter, axis.span) for axis in (self.x, self.y))
        return Sweeping(x, y, {key: given[key] for key in ("n", "tol") if key in given})
