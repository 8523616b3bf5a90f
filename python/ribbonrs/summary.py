"""What `ribbonrs run` prints about a scene and its equilibria."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import fields

from rich.box import SIMPLE_HEAD
from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from .helix import Helix
from .pieces import Pieces
from .scene import Scene
from .state import State
from .terms import Shape, Term

__all__ = ["summary"]


def summary(scene: Scene, state: State, others: list[State]) -> Group:
    """Return the summary of `state` and of the `others` that the scene allows, to be printed by rich."""
    return Group(_scene_table(scene, state), _state_table(state), *_others_table(others))


def _scene_table(scene: Scene, state: State) -> Table:
    ribbon = scene.ribbon
    material = ribbon.material
    constants = ", ".join(f"{f.name} = {getattr(material, f.name):g}" for f in fields(material))
    grown = " + ".join(map(_grown, scene.growth.terms))
    size = scene.growth.size(ribbon.thickness_ratio)
    table = Table.grid(padding=(0, 3))
    table.add_column(style="dim")
    table.add_column()
    table.add_row(
        "ribbon",
        f"{ribbon.length:g} long, {ribbon.width:g} wide, {ribbon.thickness:g} thick; "
        f"thickness/width {ribbon.thickness_ratio:g}, length/width {ribbon.length_ratio:g}",
    )
    table.add_row("material", f"{type(material).__name__}, {constants}")
    table.add_row("growth", f"{grown}; largest growth strain {size:.3g}")
    if scene.law != "full":
        table.add_row("law", scene.law)
    table.add_row("shape", Text(_described(state), style="bold"))
    table.add_row("stability", _stability(state))
    return table


def _grown(term: Term) -> str:
    """A growth with its fields: the amplitude alone does not tell a cylinder from a saddle."""
    amplitude = term.amplitude
    factor = amplitude if isinstance(amplitude, float) else 1.0
    fields = ", ".join(f"{name} = {_profile(shape, factor)}" for name, shape in term.shape)
    size = f"{amplitude:g}" if isinstance(amplitude, float) else "varying along S"
    return f"{term.name} {size} ({fields})"


def _profile(shape: Shape, factor: float) -> str:
    if isinstance(shape, Pieces):
        count = len(shape.coefficients)
        return f"{count} pieces" if count > 1 else f"a function of degree {shape.degree}"
    return _polynomial([factor * c for c in shape])


def _polynomial(coefficients: list[float]) -> str:
    """As `0.24 x^2`, with x = X2/a."""
    powers = ("", " x", *(f" x^{k}" for k in range(2, len(coefficients))))
    terms = [f"{c:g}{power}" for c, power in zip(coefficients, powers, strict=False) if c != 0.0]
    return " + ".join(terms).replace("+ -", "- ") or "0"


def _described(state: State) -> str:
    handed = state.helix.handedness
    return state.phase if handed == "none" else f"{state.phase}, {handed}-handed"


def _stability(state: State) -> str:
    if state.stable:
        return "stable (section_index 0)"
    return f"unstable (section_index {state.section_index})"


def _state_table(state: State) -> Table:
    table = Table(box=SIMPLE_HEAD)
    for heading in ("", "symbol"):
        table.add_column(heading)
    for heading in ("dimensionless", "in your units"):
        table.add_column(heading, justify="right")
    for row in _state_rows(state):
        table.add_row(*row)
    return table


def _state_rows(state: State) -> Iterator[tuple[str, str, str, str]]:
    names = ("axial strain", "curvature in the plane", "curvature out of the plane", "twist")
    physical = state.physical
    for name, symbol, value, unit in zip(
        names, ("eps", "K1", "K2", "K3"), state.strain, physical.strains[0], strict=True
    ):
        yield name, symbol, _figures(value), _figures(unit)
    for name, symbol, field in (
        ("radius of the helix", "R", "radius"),
        ("pitch of the helix", "p", "pitch"),
    ):
        yield name, symbol, _length(state.helix, field), _length(physical.helix, field)
    yield "turns", "", f"{state.helix.turns:.4g}", ""
    yield "energy per length", "Pi", _figures(state.energy), _figures(physical.energy)


def _length(helix: Helix, field: str) -> str:
    value = getattr(helix, field)
    return _figures(value) if math.isfinite(value) else "none (straight)"


def _figures(value: float) -> str:
    return f"{value + 0.0:.6g}"  # + 0.0 shows -0.0 as 0


def _others_table(others: list[State]) -> Iterator[RenderableType]:
    if not others:
        yield Text("no other equilibrium")
        return
    table = Table(title="other equilibria", title_justify="left", box=SIMPLE_HEAD, pad_edge=False)
    table.add_column("shape", no_wrap=True)
    for heading in ("eps", "K1", "K2", "K3", "energy"):
        table.add_column(heading, justify="right", no_wrap=True)
    table.add_column("index", no_wrap=True)
    for state in others:
        handed = state.helix.handedness
        shape = state.phase if handed == "none" else f"{state.phase}, {handed}"
        values = (f"{value + 0.0:.4g}" for value in (*state.strain, state.energy))
        table.add_row(shape, *values, "0, stable" if state.stable else f"{state.section_index}")
    yield table
