"""The scalar parameters of a scene: what can be varied while everything else stays as it is."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, TypeAlias

from .check import number
from .ends import Clamped, Closed, Free, Hinged, Pinned, Sliding
from .errors import InputError, RibbonWarning
from .linear import LinearLaw
from .loads import LineLoad
from .scene import Scene
from .terms import Term

__all__ = ["Parameter", "parameter_of", "parameters"]

FEW = 12
"""So many names fit in a line."""

LOAD_FACTOR = "load_factor"

_Path: TypeAlias = tuple[str | int, ...]
"""Where a number is in a scene: names of fields, and places in tuples."""

VECTORS = {
    Free: ("force", "moment"),
    Pinned: ("position", "moment"),
    Hinged: ("position",),
    Clamped: ("position",),
    Sliding: (),
}
"""The fields of an end that have three components."""

NUMBERS = {
    Free: (),
    Pinned: (),
    Hinged: ("moment",),
    Clamped: ("twist_turns",),
    Sliding: ("twist_turns", "force"),
}
"""The fields of an end that are numbers."""


@dataclass(frozen=True)
class Parameter:
    """One number of a scene.

    Attributes
    ----------
    name : str
        As in `parameters`.
    base : Scene
        The scene that has it.
    read : callable
        What it is in a scene that is `base` but for its value.
    write : callable
        The scene with another value.
    """

    name: str
    base: Scene
    read: Callable[[Scene], float]
    write: Callable[[Scene, float], Scene]

    @property
    def value(self) -> float:
        """What it is in `base`."""
        return self.read(self.base)

    def scene(self, value: float) -> Scene:
        """Return `base` with this value, all else kept; silent about growth that is rather large.

        Raises
        ------
        InputError
            If there is no such scene: its message is that of the class that refuses.
        """
        value = number(self.name, value)
        if value == self.value:
            return self.base
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RibbonWarning)
            return self.write(self.base, value)


def parameters(scene: Scene) -> tuple[str, ...]:
    """Return the names of the numbers of `scene` that `trace` can vary.

    - ``growth.<name>.amplitude`` of each growth; of one that varies along S a factor, 1 as given,
    - ``ribbon.thickness`` (dimensionless loads stay the same), and ``ribbon.length`` if nothing is a function
      of S or at a fixed S,
    - ``start.`` and ``end.`` with ``force[k]``, ``moment[k]``, ``position[k]`` or ``twist_turns``, as the
      ends have them; k = 0, 1, 2 are the components on E1, E2, E3,
    - ``gravity[k]``, ``loads[i].force[k]`` and ``loads[i].moment[k]``,
    - ``load_factor`` of all loads together, 1 as given, if there are any,
    - ``law.intrinsic[0]`` to ``[3]`` of a `LinearLaw`.

    Values are in the units of the scene: thickness and length in the user's, all else dimensionless.

    Raises
    ------
    InputError
        If `scene` is no Scene.

    Examples
    --------
    >>> import ribbonrs as rb
    >>> scene = rb.Scene(rb.Ribbon(10.0, 1.0, 0.1), rb.growth.edge(0.06), end=rb.Pinned())
    >>> for name in rb.parameters(scene)[:6]:
    ...     print(name)
    growth.edge.amplitude
    ribbon.thickness
    ribbon.length
    start.position[0]
    start.position[1]
    start.position[2]
    """
    if not isinstance(scene, Scene):
        raise InputError("scene", scene, "a Scene")
    return tuple(parameter.name for parameter in _all(scene))


def parameter_of(scene: Scene, name: object) -> Parameter:
    """Return the parameter of this name; an `InputError` that knows the nearest one if there is none."""
    if isinstance(name, str):
        for parameter in _all(scene):
            if parameter.name == name:
                return parameter
    known = parameters(scene)
    expected = f"one of {', '.join(known)}" if len(known) <= FEW else "a name that parameters(scene) lists"
    if isinstance(name, str):
        from difflib import get_close_matches

        expected += f"; the nearest is {get_close_matches(name, known, n=1, cutoff=0.0)[0]}"
    raise InputError("trace.parameter", name, expected)


def _all(scene: Scene) -> Iterator[Parameter]:
    for i, term in enumerate(scene.growth.terms):
        if isinstance(term.amplitude, float):
            yield _entry(scene, "growth", "terms", i, "amplitude", name=term.path)
        else:
            yield Parameter(term.path, scene, partial(_amplitude_factor, scene, i), partial(_amplified, i))
    if not isinstance(scene.law, LinearLaw):
        yield _entry(scene, "ribbon", "thickness")
    if not _along(scene):
        yield _entry(scene, "ribbon", "length")
    for side in ("start", "end"):
        yield from _of_end(scene, side)
    yield from _components(scene, "gravity")
    for i, load in enumerate(scene.loads):
        for field in ("force", "moment"):
            if all(isinstance(component, float) for component in getattr(load, field)):
                yield from _components(scene, "loads", i, field)
    if _loads(scene):
        yield Parameter(LOAD_FACTOR, scene, partial(_load_factor, scene), _loaded)
    if isinstance(scene.law, LinearLaw):
        yield from (_entry(scene, "law", "intrinsic", k) for k in range(4))


def _of_end(scene: Scene, side: str) -> Iterator[Parameter]:
    """The numbers of the start or the end; neither is there if the ribbon is closed."""
    end = getattr(scene, side)
    if isinstance(scene.start, Closed):
        return
    for field in VECTORS[type(end)]:
        yield from _components(scene, side, field)
    for field in NUMBERS[type(end)]:
        yield _entry(scene, side, field)


def _components(scene: Scene, *path: str | int) -> Iterator[Parameter]:
    return (_entry(scene, *path, k) for k in range(3))


def _along(scene: Scene) -> bool:
    """Whether anything is a function of S or at a fixed S, which another length would leave behind."""
    varies = scene.ribbon.varies or scene.growth.varies
    return varies or not all(isinstance(load, LineLoad) and load.uniform for load in scene.loads)


def _entry(scene: Scene, *path: str | int, name: str = "") -> Parameter:
    """The number at this place of a scene."""
    written = "".join(f"[{step}]" if isinstance(step, int) else f".{step}" for step in path)[1:]
    return Parameter(name or written, scene, partial(_found, path), partial(_replaced_in, path))


def _found(path: _Path, scene: Scene) -> float:
    found: Any = _placed(path, scene)
    for step in path:
        found = found[step] if isinstance(step, int) else getattr(found, step)
    return float(found)


def _replaced_in(path: _Path, scene: Scene, value: float) -> Scene:
    changed: Scene = _replaced(_placed(path, scene), path, value)
    return changed


def _placed(path: _Path, scene: Scene) -> Scene:
    """The scene with the position said that is asked for, where it is left to the ribbon."""
    side, field, *_ = path
    if field != "position" or getattr(scene, str(side)).position is not None:
        return scene
    place = scene.places[("start", "end").index(str(side))]
    return _replaced(scene, (side, field), place)  # type: ignore[no-any-return]


def _replaced(whole: Any, path: _Path, value: object) -> Any:
    """A copy of a dataclass or a tuple in which the entry at `path` is this value, checked anew."""
    if not path:
        return value
    step, *rest = path
    if isinstance(step, int):
        return (*whole[:step], _replaced(whole[step], tuple(rest), value), *whole[step + 1 :])
    changed = _replaced(getattr(whole, step), tuple(rest), value)
    return whole.with_(step, changed) if isinstance(whole, LineLoad) else replace(whole, **{step: changed})


def _amplitude_factor(base: Scene, i: int, scene: Scene) -> float:
    """How much larger the amplitude is than in `base`, where it is largest."""
    sizes = [_size(one.growth.terms[i], one.ribbon.length_ratio) for one in (scene, base)]
    return sizes[0] / sizes[1] if sizes[1] != 0.0 else 1.0


def _size(term: Term, length: float) -> float:
    """A number to which the amplitude is in proportion."""
    amplitude = term.along(length)
    if isinstance(amplitude, float):
        return amplitude
    return max((c for piece in amplitude.coefficients for c in piece), key=abs)


def _amplified(i: int, scene: Scene, factor: float) -> Scene:
    amplitude = scene.growth.terms[i].along(scene.ribbon.length_ratio)
    assert not isinstance(amplitude, float)
    changed: Scene = _replaced(scene, ("growth", "terms", i, "amplitude"), amplitude.scaled(factor))
    return changed


def _loads(scene: Scene) -> list[float]:
    """Numbers to which all loads are in proportion, in the same order for the same loads; those not zero."""
    numbers = [*scene.gravity]
    for load in scene.loads:
        numbers += load.numbers(scene.ribbon.length_ratio)
    for end in (scene.start, scene.end):
        for field in ("force", "moment"):
            value = getattr(end, field, ())
            numbers += value if isinstance(value, tuple) else (value,)
    return [entry for entry in numbers if entry != 0.0]


def _load_factor(base: Scene, scene: Scene) -> float:
    """How much larger the loads are than those of `base`."""
    largest = [max(_loads(one), key=abs, default=0.0) for one in (scene, base)]
    return largest[0] / largest[1]


def _loaded(scene: Scene, factor: float) -> Scene:
    """The scene with all dead loads multiplied."""
    length = scene.ribbon.length_ratio
    x, y, z = scene.gravity
    return replace(
        scene,
        start=_end_loaded(scene.start, factor),
        end=_end_loaded(scene.end, factor),
        gravity=(factor * x, factor * y, factor * z),
        loads=tuple(load.scaled(factor, length) for load in scene.loads),
    )


def _end_loaded(end: Any, factor: float) -> Any:
    changed = {}
    for field in ("force", "moment"):
        value = getattr(end, field, None)
        if isinstance(value, tuple):
            changed[field] = tuple(factor * entry for entry in value)
        elif value is not None:
            changed[field] = factor * value
    return replace(end, **changed)
