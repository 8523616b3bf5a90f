"""The state that a trace starts with."""

from __future__ import annotations

import warnings

import numpy as np

from . import _core
from .course import Held
from .ends import Closed
from .equilibrium import solve
from .errors import ConvergenceError, InputError, RibbonWarning
from .linear import LinearLaw
from .parameter import Parameter
from .record import record_of, same
from .scene import Scene
from .state import State

__all__ = ["start_of"]

INSIDE = 1e-12
"""How far beyond the span, relative to it, rounding may put a start."""

ASIDE = (0.05, 5e-3, 5e-4, 5e-5, 5e-6)
"""How far aside, in the span, is looked for what a start is that may be moved freely, in turn."""

ALIKE = 0.05
"""Difference of the mean squares of curvatures of two such states, relative to the larger or to 1/L^2."""


def start_of(
    parameter: Parameter,
    start: State | None,
    span: tuple[float, float],
    scene: Scene,
    tol: float,
    degree: int | None,
) -> tuple[float, _core.BoundarySolution]:
    """Return where a trace starts: value of the parameter, and a solution there."""
    if start is None:
        value = span[0]
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RibbonWarning)  # branches say what is stable
            start = solve(scene, tol=tol, degree=degree, method="collocation")
    else:
        value = _value_of(parameter, start, span)
    if not isinstance(start.course, Held):
        start = solve(start.scene, guess=start, tol=tol, degree=degree, method="collocation")
    value, start = _beside(parameter, start, value, span, tol, degree)
    return value, _solution(start)


def _solution(state: State) -> _core.BoundarySolution:
    assert isinstance(state.course, Held)  # by collocation
    return state.course.solution


def _value_of(parameter: Parameter, start: State, span: tuple[float, float]) -> float:
    """The value of the parameter in the scene of a start, which is the one traced but for that."""
    if not isinstance(start, State):
        raise InputError("start", start, "a State")
    expected = f"a state of the scene that is traced, which may differ in {parameter.name} alone"
    theirs = record_of(start.scene)
    try:
        value = parameter.read(start.scene)
        alike = same(record_of(parameter.scene(value)), theirs)
        # A place that is left to the ribbon may be written out.
        alike = alike or same(record_of(parameter.write(parameter.base, value)), theirs)
    except (InputError, AttributeError, IndexError, TypeError):
        raise InputError("start", start, expected) from None
    if not alike:
        raise InputError("start", start, expected)
    slack = INSIDE * (span[1] - span[0])
    if not span[0] - slack <= value <= span[1] + slack:
        expected = f"a state with {parameter.name} in the span, from {span[0]:g} to {span[1]:g}"
        raise InputError("start", start, f"{expected}, not {value:g}")
    return min(max(value, span[0]), span[1])


def _beside(
    parameter: Parameter,
    start: State,
    value: float,
    span: tuple[float, float],
    tol: float,
    degree: int | None,
) -> tuple[float, State]:
    """The start, or what it is a little beside its value of the parameter, with that.

    Where it may be moved freely but beside it not: a buckled rod that is the same in all directions may be
    turned about the line of its ends, until a weight, however small, tells where it hangs.
    """
    free = _free_motions(start)
    if free == 0:
        return value, start
    for part in ASIDE:
        step = part * (span[1] - span[0])
        aside = value + step if value + step <= span[1] else value - step
        found = []
        for guess in (start, None):
            state = _solved(parameter, aside, guess, tol, degree)
            if state is None:
                continue
            if _free_motions(state) >= free:
                return value, start
            if _alike(state, start):
                found.append(state)
            if found and _index(found[0]) <= _index(start):
                break
        if found:
            return aside, min(found, key=_index)
    return value, start


def _solved(
    parameter: Parameter, value: float, guess: State | None, tol: float, degree: int | None
) -> State | None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RibbonWarning)
        try:
            return solve(parameter.scene(value), guess=guess, tol=tol, degree=degree, method="collocation")
        except (ConvergenceError, InputError):
            return None


def _free_motions(state: State) -> int:
    """How many there are of what is closed, or the same in all directions: of others there are none."""
    law = state.scene.law
    round_rod = isinstance(law, LinearLaw) and law.EI1 == law.EI2
    return _solution(state).free_motions() if round_rod or isinstance(state.scene.start, Closed) else 0


def _index(state: State) -> float:
    return 0.0 if state.index is None else state.index


def _alike(a: State, b: State) -> bool:
    """Whether two states are nearly the same but for a motion that leaves the curvatures what they are."""
    squares = [np.mean(state.strains[:, 1:] ** 2, axis=0) for state in (a, b)]
    sizes = np.array([[mean[0] + mean[1], mean[2]] for mean in squares])
    scale = max(np.max(sizes), 1.0 / a.scene.ribbon.length_ratio**2)
    return bool(np.all(np.abs(sizes[0] - sizes[1]) < ALIKE * scale))
