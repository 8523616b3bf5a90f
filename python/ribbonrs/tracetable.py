"""The table [trace] of a scene file: what to follow the equilibria of the scene along."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from .continuation import check_span, check_values, trace
from .diagram import Diagram
from .errors import InputError
from .growthtable import Table
from .parameter import parameter_of
from .quantity import check_quantity
from .scene import Scene

__all__ = ["TraceTable", "Tracing"]


OPTIONS = ("values", "depth", "max_steps")
"""Keys that are arguments of `trace`."""


@dataclass(frozen=True)
class Tracing:
    """What `ribbonrs trace` is asked for."""

    parameter: str
    span: tuple[float, float]
    options: dict[str, Any]
    """`values`, `depth` and `max_steps` for `trace`, if they are given."""
    quantity: str

    def check(self, scene: Scene) -> None:
        """Refuse a parameter that the scene does not have."""
        parameter_of(scene, self.parameter)

    def diagram(self, scene: Scene, **options: Any) -> Diagram:
        """Trace the scene; `options` are those of `solve`."""
        return trace(scene, self.parameter, self.span, **self.options, **options)


class TraceTable(Table):
    """The table [trace]."""

    parameter: Any
    span: Any
    values: Any = None
    depth: Any = None
    max_steps: Any = None
    quantity: Any = None

    def make(self) -> Tracing:
        """Return what it says, as far as it can be checked without the scene."""
        if not isinstance(self.parameter, str):
            raise InputError("trace.parameter", self.parameter, "a name, such as 'growth.edge.amplitude'")
        span = check_span(self.span)
        given = self.given()
        options: dict[str, Any] = {key: given[key] for key in OPTIONS if key in given}
        if "values" in options:
            options["values"] = check_values(options["values"], span)
        quantity = check_quantity("trace.quantity", given.get("quantity", "K3"))
        return Tracing(self.parameter, span, options, quantity)
