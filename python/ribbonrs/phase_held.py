"""Phase diagrams of held or loaded ribbons: one state followed from point to point."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor, wait
from os import cpu_count
from threading import Event
from typing import Any, TypeAlias

import numpy as np

from . import _core
from .arrays import Array
from .equilibrium import solve
from .errors import ConvergenceError, InputError, RibbonWarning
from .phasediagram import PHASES, Boundary, PhaseDiagram, Plane, fractions
from .scene import Scene
from .state import State
from .telling import Telling

__all__ = ["held_diagram"]

NODES = 21
"""Nodes of each state, for the means of its curvatures."""

POLL = 0.05
"""Seconds between looks at what is done: how soon an interrupt is answered."""

_Found: TypeAlias = State | str
"""The state at a point, or why there is none."""

_Place: TypeAlias = tuple[float, float]
"""A point of the unit square."""


def named(state: State) -> str:
    """Return the phase of a state, and what is not as in a stable one."""
    if state.stable:
        return state.phase
    return f"{state.phase}, {'stability not known' if state.stable is None else 'unstable'}"


def held_diagram(
    scene: Scene, plane: Plane, shape: tuple[int, int], tol: float, telling: Telling
) -> PhaseDiagram:
    """Return the diagram of the state that is followed from the least values of both parameters."""
    work = _Work(plane, shape, tol, telling)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RibbonWarning)  # phases say what is stable
        interrupted = work.run()
    return work.diagram(scene, interrupted)


class _Work:
    """The points and edges of a diagram, and what is known of them."""

    def __init__(self, plane: Plane, shape: tuple[int, int], tol: float, telling: Telling) -> None:
        self.plane, self.tol, self.telling = plane, tol, telling
        self.nx, self.ny = shape
        self.xs, self.ys = fractions(self.nx), fractions(self.ny)
        self.states: dict[tuple[int, int], _Found] = {}
        self.changes: tuple[dict[int, list[Any]], dict[int, list[Any]]] = {}, {}
        self.phases: list[str] = []
        self.stopped = Event()

    def run(self) -> bool:
        """Do all of it; return whether that was interrupted."""
        pool = ThreadPoolExecutor(cpu_count() or 1)
        try:
            self._until_done([pool.submit(self._column)])
            self._until_done([pool.submit(self._row, j) for j in range(self.ny)])
            self._until_done([pool.submit(self._edge, *edge) for edge in self._changing()])
        except KeyboardInterrupt:
            return True
        finally:
            self.stopped.set()
            pool.shutdown(cancel_futures=True)
        return False

    def _until_done(self, futures: Sequence[Future[None]]) -> None:
        remaining = set(futures)
        while remaining:
            _, remaining = wait(remaining, POLL)
            self.telling(len(self.states))
        for future in futures:
            future.result()

    def _column(self) -> None:
        self._follow([(j, 0) for j in range(self.ny)], None)

    def _row(self, j: int) -> None:
        first = self.states.get((j, 0))
        self._follow([(j, i) for i in range(1, self.nx)], first if isinstance(first, State) else None)

    def _follow(self, places: Sequence[tuple[int, int]], guess: State | None) -> None:
        for j, i in places:
            if self.stopped.is_set():
                return
            found = self._solved((float(self.xs[i]), float(self.ys[j])), guess)
            self.states[j, i] = found
            guess = found if isinstance(found, State) else guess

    def _solved(self, place: _Place, guess: State | None) -> _Found:
        """The state at a place to which one leads, or else the one that a scene on its own has."""
        x, y = (float(self.plane.values(k, np.array(t))) for k, t in enumerate(place))
        try:
            scene = self.plane.scene(x, y)
        except InputError as error:
            return str(error)
        reason = ""
        for start in (guess, None) if guess is not None else (None,):
            try:
                return solve(scene, guess=start, n=NODES)
            except ConvergenceError as error:
                reason = str(error)
            except InputError as error:
                return str(error)
        return reason

    def _phase(self, place: tuple[int, int]) -> str:
        found = self.states.get(place)
        return named(found) if isinstance(found, State) else ""

    def _changing(self) -> Iterator[tuple[int, int, tuple[int, int], tuple[int, int]]]:
        """The edges between points of different phases: direction, number, and both points."""
        for j in range(self.ny):
            for i in range(self.nx):
                neighbours = ((0, j * (self.nx - 1) + i, (j, i + 1)), (1, j * self.nx + i, (j + 1, i)))
                for direction, edge, other in neighbours:
                    if other[0] < self.ny and other[1] < self.nx:
                        phases = self._phase((j, i)), self._phase(other)
                        if "" not in phases and phases[0] != phases[1]:
                            yield direction, edge, (j, i), other

    def _edge(self, direction: int, edge: int, first: tuple[int, int], last: tuple[int, int]) -> None:
        """Bisect an edge for where the phase of its first point ends."""
        ends = [(float(self.xs[i]), float(self.ys[j])) for j, i in (first, last)]
        state = self.states[first]
        assert isinstance(state, State)
        before, after = self._phase(first), self._phase(last)
        low, high, length = 0.0, 1.0, ends[1][direction] - ends[0][direction]

        def at(t: float) -> _Place:
            place = list(ends[0])
            place[direction] += t * length
            return place[0], place[1]

        while (high - low) * length > self.tol:
            if self.stopped.is_set():
                return
            found = self._solved(at(0.5 * (low + high)), state)
            if isinstance(found, State) and named(found) == before:
                low, state = 0.5 * (low + high), found
            else:
                high = 0.5 * (low + high)
        x, y = at(0.5 * (low + high))
        self.changes[direction][edge] = [(x, y, before, after)]

    def diagram(self, scene: Scene, interrupted: bool) -> PhaseDiagram:
        """Return what is known."""
        grid = [(j, i) for j in range(self.ny) for i in range(self.nx)]
        shape = self.ny, self.nx
        phase = np.array([self._phase(place) for place in grid]).reshape(shape)
        self.phases = sorted(set(phase.ravel().tolist()) - {""})
        count = [isinstance(s := self.states.get(place), State) and bool(s.stable) for place in grid]
        x, y = self.plane.axes((self.nx, self.ny))
        lines = self._lines(phase)
        return PhaseDiagram(
            scene=scene,
            x=x,
            y=y,
            phase=phase,
            stable=np.zeros((*shape, len(PHASES)), dtype=np.int64),
            stable_count=np.array(count, dtype=np.int64).reshape(shape),
            energy=self._numbers(lambda state: state.energy),
            K2=self._numbers(lambda state: float(np.mean(state.strains[:, 2]))),
            K3=self._numbers(lambda state: float(np.mean(state.strains[:, 3]))),
            resolved=np.array([isinstance(self.states.get(place), State) for place in grid]).reshape(shape),
            done=phase != "",
            boundaries=tuple(line for line in lines if "" not in line.phases),
            rim=tuple(line for line in lines if "" in line.phases),
            reasons={place: found for place, found in self.states.items() if isinstance(found, str)},
            tol=self.tol,
            interrupted=interrupted,
        )

    def _numbers(self, of: Callable[[State], float]) -> Array:
        values = np.full((self.ny, self.nx), np.nan)
        for place, found in self.states.items():
            if isinstance(found, State):
                values[place] = of(found)
        return values

    def _lines(self, phase: Any) -> list[Boundary]:
        number = {name: k for k, name in enumerate(self.phases)} | {"": -1}
        codes = np.vectorize(number.__getitem__, otypes=[np.int64])(phase)
        changes = [
            [
                (edge, [(x, y, number[before], number[after]) for x, y, before, after in found])
                for edge, found in sorted(edges.items())
            ]
            for edges in self.changes
        ]
        lines = _core.map_outline(codes, self.xs.tolist(), self.ys.tolist(), *changes)
        names = [*self.phases, ""]
        found = []
        for points, jump, left, right in lines:
            if left < 0:  # what is known on the left
                points, jump, left, right = points[::-1], jump[::-1], right, left
            found.append(Boundary(self.plane.points(points), (names[left], names[right]), ((), ()), jump))
        return found
