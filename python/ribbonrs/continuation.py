"""Numerical continuation: how the equilibria of a scene change with one of its parameters."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial

from . import _core
from .arrays import count
from .boundary import degree_of, tolerance
from .branch import Branch, SpecialPoint, root
from .check import Numbers, number, numbers
from .diagram import Diagram, Work
from .equilibrium import NODES
from .errors import InputError, RibbonWarning
from .parameter import Parameter, parameter_of
from .problem import problem_of
from .scene import GROWTH_WARNING, Scene
from .start import start_of
from .state import State
from .traced import Maker

__all__ = ["check_span", "check_values", "trace"]

DEEPEST = 20
"""Most branch points that a branch may be away from those the trace started with."""

JUMP = 1e-3
"""What is left of a function at a change of its sign, relative to its values beside it, if it is no zero."""

Function = Callable[[State], float]


def trace(
    scene: Scene,
    parameter: str,
    span: Numbers,
    *,
    start: State | None = None,
    values: Numbers = (),
    functions: Mapping[str, Function] | None = None,
    depth: int = 2,
    max_steps: int = 1000,
    tol: float = 1e-10,
    degree: int | None = None,
    n: int = NODES,
) -> Diagram:
    r"""Follow the equilibria of `scene` as one of its parameters varies.

    Of an unloaded uniform ribbon with a free end every branch of natural shapes that reaches into the span
    is followed. Of a ribbon that is loaded, held otherwise, or varies along its length, the branch of `start`
    and those that branch off from it; mirror images are not followed but noted in ``mirrored``.

    Parameters
    ----------
    scene : Scene
        What to follow; its own value of the parameter does not matter.
    parameter : str
        One of `parameters`.
    span : sequence of 2 float
        The least and the greatest value of the parameter.
    start : State, optional
        From where to go both ways: an equilibrium of the scene with any value of the parameter in the span.
        None is the one that `solve` gives at its lower end.
    values : sequence of float
        Values of the parameter in the span at which there will be points, special ones of kind "value".
    functions : mapping of str to callable, optional
        Functions of a state, by name. Where one is zero on a branch is a special point of kind "zero".
    depth : int
        How many branch points in a row branches are followed through, 0 to 20.
    max_steps : int
        Most points on a branch.
    tol, n
        As of `solve`.
    degree : int, optional
        As of `solve`; if it is not given, 5, 6 where `tol` is 1e-6 or less, or 7 where it is 1e-10 or less.

    Raises
    ------
    InputError
        An argument that is not what is said above, or no scene at an end of the span.
    ConvergenceError
        No equilibrium to start from.

    Warns
    -----
    RibbonWarning
        Once, if a growth strain exceeds 0.1 in the span.

    Notes
    -----
    Pseudo-arclength continuation (Keller 1977). Stability along branches is in their `index`, and every
    branch says how it ended.

    Examples
    --------
    How an edge that grows bends a ribbon:

    >>> import ribbonrs as rb
    >>> scene = rb.Scene(rb.Ribbon(10.0, 1.0, 0.1), rb.growth.edge(0.06))
    >>> diagram = rb.trace(scene, "growth.edge.amplitude", (0.0, 0.08))
    >>> round(diagram.special_points[0].parameter, 8)
    0.04546738
    """
    if not isinstance(scene, Scene):
        raise InputError("scene", scene, "a Scene")
    traced = parameter_of(scene, parameter)
    low, high = check_span(span)
    wanted = check_values(values, (low, high))
    named = _functions(functions)
    depth = count("trace.depth", depth, 0, DEEPEST)
    max_steps = count("trace.max_steps", max_steps, 1)
    tol = tolerance("tol", tol)
    degree = degree_of("degree", degree) or _degree(tol)
    maker = Maker(traced, tol, count("n", n, 2))
    scenes = _at(traced, low, 0), _at(traced, high, 1)
    _warn_growth(scenes)
    natural = start is None and not any(map(_boundary_valued, scenes))
    if natural:
        laws = scenes[0].section_law.core(), scenes[1].section_law.core()
        found = _core.trace_natural(laws, (low, high), wanted, depth, max_steps)
    else:
        value, given = start_of(traced, start, (low, high), scenes[0], tol, degree)
        problems = problem_of(scenes[0]), problem_of(scenes[1])
        try:
            found = _core.trace(problems, (low, high), given, value, wanted, depth, max_steps, tol, degree)
        except ValueError as error:
            if start is None:
                raise InputError("scene", scene, f"one that can be traced, not: {error}") from None
            raise InputError("start", start, f"an equilibrium of the scene, not: {error}") from None
    branches = tuple(Branch.of(i, branch, maker, natural) for i, branch in enumerate(found.branches))
    special = [
        SpecialPoint(
            kind.replace(" ", "_"), value, multiplicity, i, place, make=partial(branches[i].state, place)
        )
        for kind, i, place, value, multiplicity in found.special_points
    ]
    zeros = [zero for branch in branches for name in named for zero in _zeros(branch, name, named[name])]
    points = (*special, *zeros, *ends(branches))
    return Diagram(scene, traced.name, (low, high), branches, points, _work(found, branches))


def _degree(tol: float) -> int:
    """Of about the least time: elements of a higher one are dearer, but fewer, and remade less often."""
    return 5 if tol > 1e-6 else 6 if tol > 1e-10 else 7


def _work(found: _core.Trace, branches: Sequence[Branch]) -> Work | None:
    if found.work is None:
        return None
    linearisations, assembly, factorisation, index, seconds = found.work
    points = sum(branch.parameter.size for branch in branches)
    rest = seconds - assembly - factorisation - index
    return Work(points, linearisations, assembly, factorisation, index, rest)


def check_span(span: Numbers) -> tuple[float, float]:
    """Return the ends of a span."""
    expected = "two finite numbers, the lower one first"
    entries = numbers("trace.span", span, expected)
    if len(entries) != 2 or not entries[0] < entries[1]:
        raise InputError("trace.span", span, expected)
    return entries[0], entries[1]


def check_values(values: Numbers, span: tuple[float, float]) -> tuple[float, ...]:
    """Return values in the span, in ascending order."""
    entries = numbers("trace.values", values)
    for i, entry in enumerate(entries):
        if not span[0] <= entry <= span[1]:
            expected = f"a number in the span, from {span[0]:g} to {span[1]:g}"
            raise InputError(f"trace.values[{i}]", entry, expected)
    return tuple(sorted(set(entries)))


def ends(branches: Sequence[Branch]) -> Iterator[SpecialPoint]:
    """Yield both ends of every branch."""
    for branch in branches:
        for place, how in zip((0, branch.parameter.size - 1), branch.ended, strict=True):
            value, reason = float(branch.parameter[place]), branch.reason if how == "failed" else ""
            yield SpecialPoint(
                "end", value, 1, branch.number, place, how, reason, make=partial(branch.state, place)
            )


def _functions(functions: Mapping[str, Function] | None) -> Mapping[str, Function]:
    if functions is None:
        return {}
    expected = "a mapping from names to functions of a State"
    if not isinstance(functions, Mapping):
        raise InputError("trace.functions", functions, expected)
    for name, function in functions.items():
        if not isinstance(name, str) or not callable(function):
            raise InputError("trace.functions", functions, expected)
    return functions


def _at(parameter: Parameter, value: float, i: int) -> Scene:
    """The scene at an end of the span."""
    try:
        return parameter.scene(value)
    except InputError as error:
        expected = f"a value that {parameter.name} can have, not: {error}"
        raise InputError(f"trace.span[{i}]", value, expected) from None


def _warn_growth(scenes: tuple[Scene, Scene]) -> None:
    size = max((scene.growth_size for scene in scenes if not scene.grows_little), default=0.0)
    if size > GROWTH_WARNING:
        message = f"growth.size = {size:.3g} in the span: the theory is for growth small against 1"
        warnings.warn(message, RibbonWarning, stacklevel=3)


def _boundary_valued(scene: Scene) -> bool:
    """Whether its states are not all natural shapes of one section."""
    return scene.loaded or scene.section_law.varies


def _zeros(branch: Branch, name: str, function: Function) -> Iterator[SpecialPoint]:
    """The zeros of a function of the state along a branch."""

    def value(state: State) -> float:
        return number(f"trace.functions[{name!r}]", function(state), "a finite number for every state")

    def between(i: int, fraction: float) -> float:
        return value(branch.between(i, fraction))

    found = [value(branch.state(i)) for i in range(branch.parameter.size)]
    for i, here in enumerate(found):
        if here == 0.0:
            parameter = float(branch.parameter[i])
            yield SpecialPoint("zero", parameter, 1, branch.number, i, name, make=partial(branch.state, i))
        elif i + 1 < len(found) and here * found[i + 1] < 0.0:
            fraction = root(partial(between, i), (here, found[i + 1]))
            if abs(between(i, fraction)) > JUMP * max(abs(here), abs(found[i + 1])):
                continue  # it jumps or has a pole there
            parameter = branch.source.between(i, fraction)[0]
            make = partial(branch.between, i, fraction)
            yield SpecialPoint("zero", parameter, 1, branch.number, i, name, make=make)
