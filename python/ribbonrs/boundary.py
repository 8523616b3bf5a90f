"""Ribbons that are loaded or held: from a guess and the core's solution to a state."""

from __future__ import annotations

import math
import warnings

import numpy as np
from numpy.typing import ArrayLike

from . import _core
from .arrays import Array, count, real_array
from .check import number
from .course import Held
from .ends import pose
from .errors import ConvergenceError, InputError, RibbonWarning
from .frame import directors, integrate_frame
from .linear import LinearLaw
from .loads import PointLoad
from .problem import problem_of
from .report import Event, Report
from .scene import Scene
from .state import State

__all__ = ["degree_of", "equilibrium", "state_of", "tolerance"]

METHOD = "Gauss collocation"

HIGHEST = 8
"""Highest degree of the collocation."""

LARGEST_STRAIN = 0.1
"""Axial strain beyond that of growth that the theory is good for."""

SAMPLES = 201
"""Points, at least, at which a guess is handed to the core, besides its own breaks."""

TURN = 0.5
"""Angle, in radians, by which a guess turns from one of them to the next, at most."""

MOST_SAMPLES = 100_000
"""Points that are too many: a mesh for what turns so often is refused."""

SAME = 1e-12
"""Distance of two places, over the length, that is rounding."""

TOLD = 5
"""Kinks that a warning names."""

ADVICE = {
    "singular": "a guess= nearer to one of the equilibria that meet here, or a slightly different load",
    "diverged": "a smaller load, or guess= the solution for one",
    "unresolved": "a larger tol, or growth and loads that vary less along the ribbon",
}
"""What to try next, by how the solve ended."""


def tolerance(field: str, value: object) -> float:
    """Return a tolerance of the solver."""
    expected = "a number in [1e-14, 1)"
    tol = number(field, value, expected)
    if not 1e-14 <= tol < 1.0:
        raise InputError(field, value, expected)
    return tol


def degree_of(field: str, value: object) -> int | None:
    """Return a degree of the collocation; None leaves it to the core."""
    return None if value is None else count(field, value, 1, HIGHEST)


def equilibrium(
    scene: Scene, guess: State | ArrayLike | None, tol: float, degree: int | None, n: int
) -> State:
    """Return the equilibrium of `scene` that is continued from `guess` or from zero load.

    Arguments and errors as for `ribbonrs.solve`.
    """
    start = None if guess is None else _core_guess(scene, guess)
    try:
        solution = problem_of(scene).solve(tol, degree, start)
    except ValueError as error:
        raise InputError("scene", scene, f"one that can be solved, not: {error}") from None
    if not solution.converged:
        raise _failure(scene, solution, tol, n)
    if solution.status == "rounding_limited":
        message = f"tol = {tol:g} is below rounding: the error is about {solution.error:.1e}"
        warnings.warn(message, RibbonWarning, stacklevel=4)
    state = state_of(scene, solution, tol, n)
    if guess is None and state.stable is False:
        _warn_unstable(state)
    _warn_stretched(state, solution)
    _warn_kinked(state)
    return state


def _warn_unstable(state: State) -> None:
    told = f"index = {state.index:g}: the state is unstable"
    if state.section_index > 0:
        told = f"section_index = {state.section_index}: the state is unstable where its sections are"
    message = f"{told}; no stable one was found, which guess= may lead to"
    warnings.warn(message, RibbonWarning, stacklevel=5)


def _warn_kinked(state: State) -> None:
    kinks = [event.S for event in state.report.events if event.kind == "jump"]
    if kinks:
        told = ", ".join(f"{S:.6g}" for S in kinks[:TOLD]) + (", ..." if kinks[TOLD:] else "")
        message = f"the shape jumps along the ribbon, at S = {told}: equilibrium leaves open where exactly"
        warnings.warn(message, RibbonWarning, stacklevel=5)


def _warn_stretched(state: State, solution: _core.BoundarySolution) -> None:
    """Warn where strains are beyond the theory, of the ribbon and not of a law of its own."""
    if isinstance(state.scene.law, LinearLaw):
        return
    # What is far below the limit at stages and nodes is below it between them, too.
    if max(abs(strain[0]) for strain in solution.extremes) <= LARGEST_STRAIN / 2.0:
        return
    eps = state.strains[:, 0]
    largest = float(eps[np.argmax(np.abs(eps))])
    if abs(largest) > LARGEST_STRAIN + state.scene.growth_size:
        message = f"eps = {largest:.3g}: the theory is for strains small against 1"
        warnings.warn(message, RibbonWarning, stacklevel=5)


def _core_guess(scene: Scene, guess: State | ArrayLike) -> _core._Guess:
    """S, strains, positions, quaternions, and forces and moments in the fixed basis."""
    length = scene.ribbon.length_ratio
    if isinstance(guess, State):
        reach = guess.scene.ribbon.length_ratio
        S = np.linspace(0.0, reach, _samples(guess.strains, reach))
        if isinstance(guess.course, Held):
            S = np.concatenate([_apart(S, guess.course.breaks), guess.course.breaks])
        # Strains are known on both sides of a jump.
        jumps = np.array([event.S for event in guess.report.events if event.kind == "jump"])
        S = np.concatenate([_apart(S, jumps), np.nextafter(jumps, 0.0), jumps])
        S.sort()
        known = guess.at(S)
        scaled = length / reach
        poses = scaled * known.position, known.quaternion
        strains, resultants = known.strains / [1.0, scaled, scaled, scaled], (known.force, known.moment)
        S = scaled * S
        # Both sides of a jump, which rounding may have joined.
        joined = np.flatnonzero(np.diff(S) <= 0.0)
        S[joined] = np.nextafter(S[joined + 1], 0.0)
    else:
        strains = _strains(guess)
        given = np.linspace(0.0, length, len(strains))
        S = np.linspace(0.0, length, max(len(strains), _samples(strains, length)))
        strains = np.column_stack([np.interp(S, given, column) for column in strains.T])
        strains = _unstretched(scene, strains, S)
        poses = integrate_frame(S, strains, *pose(scene.start))
        # The solver finds the forces that fit strains best.
        return S, strains, *poses, np.empty((0, 3)), np.empty((0, 3))
    axes = directors(poses[1])
    force, moment = (np.einsum("ni,nij->nj", components, axes) for components in resultants)
    return S, strains, *poses, force, moment


def _apart(S: Array, others: Array) -> Array:
    """The places that are none of others but for rounding."""
    if others.size == 0:
        return S
    after = np.searchsorted(others, S).clip(0, others.size - 1)
    near = np.minimum(np.abs(others[after] - S), np.abs(others[after - 1] - S))
    kept: Array = S[near > SAME * S[-1]]
    return kept


def _samples(strains: Array, length: float) -> int:
    """How many sections of a guess tell by which way round each turns to the next."""
    largest = float(np.linalg.norm(strains[:, 1:], axis=1).max())
    return max(SAMPLES, math.ceil(min(largest * length / TURN, MOST_SAMPLES)) + 1)


def _strains(guess: ArrayLike) -> Array:
    """Strains (n, 4) at equally spaced nodes; one row is the same everywhere."""
    expected = "a State, eps, K1, K2, K3, or an array (n, 4) of them at equally spaced S, n >= 2"
    strains = real_array("guess", guess, expected)
    if strains.shape == (4,):
        return np.tile(strains, (2, 1))
    if strains.ndim != 2 or strains.shape[0] < 2 or strains.shape[1] != 4:
        raise InputError("guess.shape", strains.shape, expected)
    return strains


def _unstretched(scene: Scene, strains: Array, S: Array) -> Array:
    """Strains with the same K2 and K3, and eps and K1 such that n3 = m1 = 0: a guess is for the soft ones."""
    if isinstance(scene.law, LinearLaw):
        # Of a rod all curvatures may be soft.
        return np.column_stack([np.full(S.size, scene.law.intrinsic[0]), strains[:, 1:]])
    law = scene.section_law
    # The energy is quadratic in eps and K1, which do not meet.
    gradient, hessian = law.gradient(strains, S), law.hessian(strains, S)
    change = gradient[:, :2] / np.diagonal(hessian, axis1=1, axis2=2)[:, :2]
    return np.column_stack([strains[:, :2] - change, strains[:, 2:]])


def state_of(scene: Scene, solution: _core.BoundarySolution, tol: float, n: int) -> State:
    """Return the state of what the core solved."""
    length = scene.ribbon.length_ratio
    nodes = np.linspace(0.0, length, n)
    nodes.setflags(write=False)
    course = Held(solution, scene)
    return State(
        scene=scene,
        course=course,
        energy=solution.energy / length,
        section_index=solution.section_index,
        phases=(course.phase,),
        resolved=True,
        report=_report(scene, solution, tol),
        S=nodes,
        load_potential=solution.load_potential / length,
    )


def _report(scene: Scene, solution: _core.BoundarySolution, tol: float) -> Report:
    return Report(
        method=METHOD,
        equilibria=1,
        unresolved=0,
        gradient_norm=solution.residual,
        events=_events(scene, solution),
        elements=solution.breaks.size - 1,
        tolerance=tol,
        status=solution.status,
        degree=solution.degree,
        error=solution.error,
        residual=solution.residual,
        condition=solution.condition,
        iterations=solution.iterations,
        factorisations=solution.factorisations,
        meshes=solution.meshes,
        load_steps=solution.load_steps,
        residuals=tuple(solution.residuals),
    )


def _events(scene: Scene, solution: _core.BoundarySolution) -> tuple[Event, ...]:
    """The point loads, and kinks between sections of different phases, with the strains on both sides."""
    kinds = dict.fromkeys(solution.kinks, "jump")
    kinds |= {load.S: "point load" for load in scene.loads if isinstance(load, PointLoad) and load.acts}
    if not kinds:
        return ()
    places = np.array(sorted(kinds))
    before, after = (solution.at(S)[0].tolist() for S in (np.nextafter(places, 0.0), places))
    return tuple(
        Event(S, kinds[S], tuple(b), tuple(a)) for S, b, a in zip(places.tolist(), before, after, strict=True)
    )


def _failure(scene: Scene, solution: _core.BoundarySolution, tol: float, n: int) -> ConvergenceError:
    """The error that says how far it went and what to try."""
    state = state_of(scene, solution, tol, n) if solution.fraction > 0.0 else None
    iterate = solution.at(np.linspace(0.0, scene.ribbon.length_ratio, n))[0]
    advice = ADVICE.get(solution.status, ADVICE["diverged"])
    residuals = tuple(solution.residuals)
    return ConvergenceError(solution.reason, iterate, residuals, advice, state, solution.fraction)
