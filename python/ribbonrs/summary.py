"""What `ribbonrs run` prints about a scene and its equilibria."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import fields
from itertools import groupby

import numpy as np
from rich.box import SIMPLE_HEAD
from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from .arrays import Array
from .course import Held
from .ends import Closed
from .helix import Helix
from .linear import LinearLaw
from .loads import PointLoad
from .pieces import Pieces
from .scene import Scene
from .state import State, shown_strains
from .terms import Shape, Term

__all__ = ["summary"]

NOISE = 1e-12
"""Components of reactions below this, or the error of the solution, times the largest are shown as 0."""

SLIGHT = 1e-5
"""Parts below this are not told apart."""


def summary(scene: Scene, state: State, others: list[State]) -> Group:
    """Return the summary of `state` and of the `others` that the scene allows, to be printed by rich."""
    beside = _boundary_tables(state) if isinstance(state.course, Held) else _others_table(state, others)
    return Group(_scene_table(scene, state), _state_table(state), *_events_table(state), *beside)


def _scene_table(scene: Scene, state: State) -> Table:
    ribbon = scene.ribbon
    material = ribbon.material
    constants = ", ".join(f"{f.name} = {getattr(material, f.name):g}" for f in fields(material))
    table = Table.grid(padding=(0, 3))
    table.add_column(style="dim")
    table.add_column()
    table.add_row(
        "ribbon",
        f"{ribbon.length:g} long, {ribbon.width:g} wide, {ribbon.thickness:g} thick; "
        f"thickness/width {ribbon.thickness_ratio:g}, length/width {ribbon.length_ratio:g}",
    )
    for name, factor in (("width", ribbon.width_pieces), ("thickness", ribbon.thickness_pieces)):
        if factor is not None:
            values = factor.evaluate([*factor.breaks, *state.S])
            told = f"from {np.min(values):.3g} to {np.max(values):.3g} of the above, varying along S"
            table.add_row(name, told)
    table.add_row("material", f"{type(material).__name__}, {constants}")
    table.add_row("growth", _growth(scene))
    if scene.loaded:
        for row in _held_rows(scene):
            table.add_row(*row)
    if scene.law != "full":
        table.add_row("law", _law(scene.law))
    table.add_row("shape", Text(_described(state), style="bold"))
    table.add_row("stability", _stability(state))
    if not isinstance(scene.law, LinearLaw):
        table.add_row("neglected", f"{_percent(state.neglected)} of the strains")
    return table


def _growth(scene: Scene) -> str:
    alike = groupby(scene.growth.terms, _grown)
    grown = " + ".join(f"{_names([term.name for term in terms])} {told}" for told, terms in alike)
    return f"{grown}; largest growth strain {scene.growth_size:.3g}" if grown else "none"


def _held_rows(scene: Scene) -> Iterator[tuple[str, str]]:
    """How the ribbon is held and loaded."""
    closed = isinstance(scene.start, Closed)
    for name, end in (("start", scene.start), *(() if closed else (("end", scene.end),))):
        given = {f.name: getattr(end, f.name) for f in fields(end)}
        said = ", ".join(f"{key} {_told(value)}" for key, value in given.items() if _says(value))
        yield name, f"{type(end).__name__.lower()}{', ' if said else ''}{said}"
    if any(scene.gravity):
        yield "gravity", f"{_told(scene.gravity)} per unit S"
    for load in scene.loads:
        where = f"at S = {load.S:g}" if isinstance(load, PointLoad) else "per unit S"
        parts = ", ".join(
            f"{key} {_told(v)}" for key in ("force", "moment") if _says(v := getattr(load, key))
        )
        yield "load", f"{parts or 'zero'} {where}"


def _says(value: object) -> bool:
    """Whether a value is not a default."""
    return any(entry != 0.0 for entry in value) if isinstance(value, tuple) else value not in (None, 0.0)


def _told(value: object) -> str:
    """A number or a vector; one of functions is only said to vary."""
    if isinstance(value, float | int):
        return f"{value:g}"
    if isinstance(value, tuple) and all(isinstance(entry, float) for entry in value):
        return f"({', '.join(map(_told, value))})"
    return "varying"


def _law(law: str | LinearLaw) -> str:
    if isinstance(law, str):
        return law
    stiffnesses = {f.name: getattr(law, f.name) for f in fields(law)}
    return ", ".join(f"{name} = {_told(value)}" for name, value in stiffnesses.items() if _says(value))


def _names(names: list[str]) -> str:
    """One name, or the first and the last of many growths that are told alike, as stations are."""
    return names[0] if len(names) == 1 else f"{names[0]} ... {names[-1]}"


def _grown(term: Term) -> str:
    """A growth without its name, with its fields: the amplitude does not tell a cylinder from a saddle."""
    amplitude = term.amplitude
    factor = amplitude if isinstance(amplitude, float) else 1.0
    fields = ", ".join(f"{name} = {_profile(shape, factor)}" for name, shape in term.shape)
    size = f"{amplitude:g}" if isinstance(amplitude, float) else "varying along S"
    return f"{size} ({fields})"


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
    """As `helical, right-handed` or `curved: flat, then bent`."""
    if state.phases[1:]:
        return f"{state.phase}: {', then '.join(state.phases)}"
    handed = _handed(state)
    return f"{state.phase}, {handed}-handed" if handed else state.phase


def _handed(state: State) -> str:
    """The handedness of the helix, empty without one."""
    handed = "none" if state.helix is None else state.helix.handedness
    return "" if handed == "none" else handed


def _stability(state: State) -> str:
    if state.stable is None:
        return "not defined, as the loads have no potential; each section is stable (section_index 0)"
    if state.stable:
        return "stable (section_index 0)"
    if state.section_index == 0:
        return f"unstable (index {state.index:.0f})"
    return f"unstable (section_index {state.section_index})"


def _percent(part: float) -> str:
    return f"{100.0 * part:.2g} %" if part >= SLIGHT else f"less than {100.0 * SLIGHT:g} %"


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
    physical, a = state.physical, state.scene.ribbon.width
    symbols, units = ("eps", "K1", "K2", "K3"), (1.0, a, a, a)
    for name, symbol, values, unit in zip(names, symbols, shown_strains(state).T, units, strict=True):
        yield name, symbol, _range(values), _range(values / unit)
    if state.helix is not None and physical.helix is not None:
        for name, symbol, field in (
            ("radius of the helix", "R", "radius"),
            ("pitch of the helix", "p", "pitch"),
        ):
            yield name, symbol, _length(state.helix, field), _length(physical.helix, field)
        yield "turns", "", f"{state.helix.turns:.4g}", ""
    yield "energy per length", "Pi", _figures(state.energy), _figures(physical.energy)
    if isinstance(state.course, Held):
        potential = _figures(state.load_potential), _figures(physical.load_potential)
        yield "potential of the loads", "", *potential


def _length(helix: Helix, field: str) -> str:
    value = getattr(helix, field)
    return _figures(value) if math.isfinite(value) else "none (straight)"


def _figures(value: float) -> str:
    return f"{value + 0.0:.6g}"  # + 0.0 shows -0.0 as 0


def _range(values: Array) -> str:
    """The value, or the least and the greatest if six figures tell them apart."""
    least, greatest = _figures(np.min(values)), _figures(np.max(values))
    return least if least == greatest else f"{least} to {greatest}"


def _events_table(state: State) -> Iterator[RenderableType]:
    """Where the strains are not smooth: a jump with K2 and K3 before and after."""
    if not state.report.events:
        return
    table = Table(title="along the ribbon", title_justify="left", box=SIMPLE_HEAD, pad_edge=False)
    table.add_column("S", justify="right", no_wrap=True)
    table.add_column("", no_wrap=True)
    for heading in ("K2 before", "K3", "K2 after", "K3"):
        table.add_column(heading, justify="right", no_wrap=True)
    for event in state.report.events:
        small = state.report.error / state.scene.ribbon.length_ratio
        curvatures = np.array([*event.before[2:], *event.after[2:]])
        values = (f"{value + 0.0:.4g}" for value in np.where(np.abs(curvatures) <= small, 0.0, curvatures))
        table.add_row(f"{event.S:.6g}", event.kind, *values)
    yield table


def _boundary_tables(state: State) -> Iterator[RenderableType]:
    """What the ends exert on the ribbon, and how well it is known."""
    title = "reactions on E1, E2, E3: dimensionless, in your units"
    table = Table(title=title, title_justify="left", box=None, pad_edge=False, show_header=False)
    table.add_column(no_wrap=True)
    for _ in range(6):
        table.add_column(justify="right", no_wrap=True)
    report, length = state.report, state.scene.ribbon.length_ratio
    largest = {
        kind: max(float(np.max(np.abs(getattr(w, kind)))) for w in vars(state.reactions).values())
        for kind in ("force", "moment")
    }
    # a force is small beside moments if its own about any place of the ribbon is, and the other way round
    scales = {
        "force": max(largest["force"], largest["moment"] / length),
        "moment": max(largest["moment"], largest["force"] * length),
    }
    for name in ("start", "end"):
        for kind, scale in scales.items():
            both = [getattr(getattr(r, name), kind) for r in (state.reactions, state.physical.reactions)]
            small = max(NOISE, report.error) * scale
            rows = (np.where(np.abs(both[0]) <= small, 0.0, values) for values in both)
            table.add_row(f"{kind} of the {name}", *(f"{v + 0.0:.4g}" for row in rows for v in row))
    yield table
    yield Text(
        f"{report.status} on {report.elements} elements of degree {report.degree}, "
        f"{report.iterations} Newton steps; error about {report.error:.1e}, residual {report.residual:.1e}"
    )


def _others_table(state: State, others: list[State]) -> Iterator[RenderableType]:
    if not others:
        yield Text("no other equilibrium" if state.uniform else "no other shape is stable at the start")
        return
    title = "other equilibria" if state.uniform else "other stable shapes, strains at S = 0"
    table = Table(title=title, title_justify="left", box=SIMPLE_HEAD, pad_edge=False)
    table.add_column("shape", no_wrap=True)
    for heading in ("eps", "K1", "K2", "K3", "energy"):
        table.add_column(heading, justify="right", no_wrap=True)
    table.add_column("index", no_wrap=True)
    for other in others:
        shape = ", ".join(filter(None, (*other.phases, _handed(other))))
        values = (f"{value + 0.0:.4g}" for value in (*other.strains[0], other.energy))
        table.add_row(shape, *values, "0, stable" if other.stable else f"{other.section_index}")
    yield table
