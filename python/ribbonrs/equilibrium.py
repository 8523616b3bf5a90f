r"""Equilibria of a scene: without load the roots of dPi = 0, of a ribbon that varies in branches."""

from __future__ import annotations

import math
import warnings
from collections.abc import Iterable
from typing import TypeAlias, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core, boundary
from .arrays import Array, count, vector
from .course import Along, Uniform
from .errors import ConvergenceError, InputError, RibbonWarning
from .growth import Growth
from .law import SectionLaw
from .linear import LinearLaw
from .report import Event, Report
from .ribbon import Ribbon
from .scene import Scene
from .state import State

__all__ = ["NODES", "chosen", "equilibria", "natural_shapes", "solve", "uniform_states"]

NODES = 101
"""Default number of nodes of a state."""

SERIES_RADIUS = 7.4578
"""|K2|/eta up to which the quadratic law's expansion converges in an incompressible material.

From the least zero of sinh z + sin z; in others in proportion to (Q22/Y)^(1/2)."""

METHODS = ("pointwise", "collocation")
"""What `solve` may be told to use."""

METHOD = "pointwise natural shape"
METHOD_ALONG = "natural shapes followed along the ribbon"

TOLERANCE = 1e-12
"""What the elements of a branch in the core may miss, relative to the size of the strains."""

_Growths: TypeAlias = list[Growth] | tuple[Growth, ...]
_Shapes: TypeAlias = tuple[Array, Array, NDArray[np.int64], list[str], NDArray[np.bool_]]


@overload
def natural_shapes(ribbon: Ribbon, growth: Growth) -> list[State]: ...
@overload
def natural_shapes(ribbon: Ribbon, growth: _Growths) -> list[list[State]]: ...
def natural_shapes(ribbon: Ribbon, growth: Growth | _Growths) -> list[State] | list[list[State]]:
    r"""Return every unloaded equilibrium of a ribbon, lowest energy first.

    Of a uniform ribbon, all strains at which
    :math:`\partial\Pi/\partial\varepsilon = \partial\Pi/\partial K_i = 0`: minima, saddles and maxima, mirror
    images included, of which K2 > 0, then K3 > 0 comes first. Complete up to pairs closer than 1e-6 in K/eta:
    a state that stands for several has ``resolved = False``, and a `RibbonWarning` says so.

    Of a ribbon that varies along its length, every branch of stable shapes that starts at S = 0, followed to
    the other end; those with the fewest jumps come first, then those of lowest energy.

    Parameters
    ----------
    ribbon : Ribbon
        Dimensions and material.
    growth : Growth or list of Growth
        A list gives a list of lists, one for each growth, found on all cores.

    Raises
    ------
    InputError
        Growth too large for the theory (see `Scene`); of a list it is ``growth[i]``.
    ConvergenceError
        A branch cannot be followed along the ribbon.

    Notes
    -----
    Source: Liu, Li & Liu, eqs. (40)-(43) without loads, where N = M = 0 all along.

    Examples
    --------
    >>> import ribbonrs as rb
    >>> leaf = rb.Ribbon(length=10.0, width=1.0, thickness=0.1)
    >>> [(state.phase, state.section_index) for state in rb.natural_shapes(leaf, rb.growth.edge(0.048))]
    [('bent', 0), ('bent', 0), ('flat', 1)]
    >>> growths = [rb.growth.edge(xi) for xi in (0.04, 0.048, 0.06)]
    >>> [[state.phase for state in states if state.stable] for states in rb.natural_shapes(leaf, growths)]
    [['flat'], ['bent', 'bent'], ['bent', 'bent']]
    """
    if not isinstance(growth, list | tuple):
        _check_growth("growth", growth)
        return _all_equilibria([Scene(ribbon, growth)], NODES)[0]
    scenes = [_scene(ribbon, one, i) for i, one in enumerate(growth)]
    return _all_equilibria(scenes, NODES)


def solve(
    scene: Scene,
    guess: State | ArrayLike | None = None,
    tol: float = 1e-10,
    degree: int | None = None,
    n: int = NODES,
    method: str | None = None,
) -> State:
    r"""Return an equilibrium of `scene`.

    Of an unloaded ribbon clamped at its start and free at its end, without `guess` the stable one of lowest
    energy, of mirror images the one with K2 > 0, then K3 > 0; of a ribbon that varies along its length, the
    branch of stable shapes with the fewest jumps, then of lowest energy. Of a ribbon that is loaded or held
    otherwise, the one continued from `guess`, or from zero load; if the latter is unstable, a stable one into
    which it falls when it is disturbed, where one is found.

    Parameters
    ----------
    scene : Scene
        What to solve.
    guess : State, (4,) or (n, 4) array, optional
        A state, or eps, K1, K2, K3. Of natural shapes the nearest to it in (K2, K3) at S = 0 is returned,
        stable or not if the ribbon is uniform. A boundary-value problem starts from it; there the strains may
        also be given at n equally spaced S.
    tol : float
        Tolerance of the boundary-value problem in [1e-14, 1), for positions over the length, angles, eps and
        curvatures times the length. Natural shapes are found to rounding.
    degree : int, optional
        Degree of its collocation, 1 to 8.
    n : int
        Number of nodes of the state, at least 2, equally spaced.
    method : str, optional
        "pointwise" for natural shapes, "collocation" for the boundary-value problem, which also solves
        unloaded ribbons; None chooses.

    Raises
    ------
    InputError
        An argument out of range, or growth that the scene's law cannot represent.
    ConvergenceError
        No equilibrium is stable, as happens with ``law="quadratic"``, a branch cannot be followed, or the
        boundary-value problem is not solved: the error has the last solution on the way.

    Warns
    -----
    RibbonWarning
        Where the shape jumps along the ribbon; if a held or loaded one is unstable (and no guess asks for it)
        or stretched by more than a tenth; if rounding is larger than `tol`; if the ribbon bends so much
        that the law of growth that jumps loses digits; and with ``law="quadratic"``, if \|K2\|/eta > 7.46
        (incompressible material), where its series diverges.

    Examples
    --------
    >>> import ribbonrs as rb
    >>> leaf = rb.Ribbon(length=10.0, width=1.0, thickness=0.1)
    >>> state = rb.solve(rb.Scene(leaf, rb.growth.edge(0.06) + rb.growth.chiral(0.04)))
    >>> state.phase, state.stable, state.helix.handedness
    ('helical', True, 'right')

    Edges that grow towards the tip only:

    >>> state = rb.solve(rb.Scene(leaf, rb.growth.edge(([0.0, 10.0], [0.0, 0.06]))))
    >>> state.phases, [(event.kind, round(event.S, 4)) for event in state.report.events]
    (('flat', 'bent'), [('bifurcation', 7.5779)])
    """
    if not isinstance(scene, Scene):
        raise InputError("scene", scene, "a Scene")
    tol = boundary.tolerance("tol", tol)
    degree = boundary.degree_of("degree", degree)
    if method is not None and (not isinstance(method, str) or method not in METHODS):
        raise InputError("method", method, f"one of {', '.join(METHODS)}, or None")
    if method == "pointwise" and scene.loaded:
        raise InputError("method", method, "'collocation', since the ribbon is loaded or held")
    if method == "collocation" or scene.loaded:
        return _held(scene, guess, tol, degree, n)
    return chosen(_all_equilibria([scene], n)[0], guess)


def _held(scene: Scene, guess: State | ArrayLike | None, tol: float, degree: int | None, n: int) -> State:
    """The solution of the boundary-value problem, with its warnings."""
    state = boundary.equilibrium(scene, guess, tol, degree, count("n", n, 2))
    if not isinstance(scene.law, LinearLaw):
        _warn_beyond_modes([(scene.section_law, [state])])
    if scene.law == "quadratic":
        _warn_beyond_radius(state)
    return state


def equilibria(scene: Scene, n: int = NODES) -> list[State]:
    """Return every equilibrium of an unloaded `scene`, in the order of `natural_shapes`."""
    return _all_equilibria([scene], n)[0]


def chosen(states: list[State], guess: State | ArrayLike | None = None) -> State:
    """Return the one of the `equilibria` of a scene that `solve` returns, with its warnings."""
    state = _stable(states) if guess is None else _nearest(states, guess)
    scene = state.scene
    if scene.law == "quadratic":
        _warn_beyond_radius(state)
    jumps = [event for event in state.report.events if event.kind == "jump"]
    if jumps:
        told = "; ".join(map(_told, jumps))
        warnings.warn(f"the shape jumps along the ribbon: {told}", RibbonWarning, stacklevel=3)
    return state


def _warn_beyond_radius(state: State) -> None:
    """Of a ribbon that varies the stable shapes of this law are all unbent."""
    ribbon = state.scene.ribbon
    k2 = float(np.max(np.abs(state.strains[:, 2]))) / ribbon.thickness_ratio
    radius = SERIES_RADIUS * math.sqrt(0.75 * ribbon.material.stiffness[1] / ribbon.material.Y)
    if k2 > radius:
        warnings.warn(
            f"|K2|/eta = {k2:.3g} is beyond {radius:.3g}, where the quadratic law's series diverges",
            RibbonWarning,
            stacklevel=4,
        )


def _told(event: Event) -> str:
    """As `S = 3.2 from K2 = -0.3, K3 = 0 to K2 = 0.2, K3 = 0.1`."""
    before, after = (
        f"K2 = {K2 + 0.0:.4g}, K3 = {K3 + 0.0:.4g}" for *_, K2, K3 in (event.before, event.after)
    )
    return f"S = {event.S:.6g} from {before} to {after}"


def _check_growth(field: str, growth: object) -> None:
    """A scene may be without growth, but nobody asks for the natural shapes of what does not grow."""
    if growth is None:
        raise InputError(field, growth, "a Growth, such as growth.edge(0.06)")


def _scene(ribbon: Ribbon, growth: Growth, i: int) -> Scene:
    """The scene of one growth of a list, which errors name."""
    _check_growth(f"growth[{i}]", growth)
    try:
        return Scene(ribbon, growth)
    except InputError as error:
        if not error.field.startswith("growth"):
            raise
        field = f"growth[{i}]{error.field.removeprefix('growth')}"
        raise InputError(field, error.value, error.expected) from None


def _all_equilibria(scenes: list[Scene], n: int) -> list[list[State]]:
    """Every equilibrium of each scene of one ribbon; the uniform ones are handed to the core at once."""
    size = count("n", n, 2)
    laws = [scene.section_law for scene in scenes]
    shared = [law.core() for law in laws if not law.varies]
    # A single one is not worth waking the other cores.
    shapes = _core.natural_shapes_of(shared) if shared[1:] else [core.natural_shapes() for core in shared]
    found = iter(shapes)
    nodes = np.linspace(0.0, scenes[0].ribbon.length_ratio if scenes else 0.0, size, dtype=np.float64)
    nodes.setflags(write=False)
    all_states = [
        _branches(scene, law, nodes) if law.varies else uniform_states(scene, law.core(), nodes, next(found))
        for scene, law in zip(scenes, laws, strict=True)
    ]
    _warn_unresolved([state for states in all_states for state in states])
    _warn_beyond_modes(zip(laws, all_states, strict=True))
    return all_states


def _warn_unresolved(states: list[State]) -> None:
    unresolved = sum(not state.resolved for state in states)
    if unresolved:
        warnings.warn(
            f"{unresolved} of {len(states)} equilibria stand for several closer than 1e-6 in K/eta",
            RibbonWarning,
            stacklevel=4,
        )


def _warn_beyond_modes(found: Iterable[tuple[SectionLaw, list[State]]]) -> None:
    """Warn, once, of a shape that bends, where it bends most, beyond the modes of growth that jumps."""
    for law, states in found:
        core = law.core()
        if not law.varies and core.resolved_curvature() == math.inf:
            continue
        for state in states:
            K2 = np.abs(state.course.strains(state.S)[:, 2])
            most = int(np.argmax(K2))
            limit = core.resolved_curvature(float(state.S[most]))
            if K2[most] > limit:
                message = f"|K2| = {K2[most]:.3g} is beyond {limit:.3g}, where growth that jumps loses digits"
                warnings.warn(message, RibbonWarning, stacklevel=4)
                return


def uniform_states(scene: Scene, core: _core.SectionLaw, nodes: Array, shapes: _Shapes) -> list[State]:
    """Return the states of a uniform ribbon from what the core found."""
    strains, energies, indices, phases, resolved = shapes
    unresolved = len(phases) - int(np.count_nonzero(resolved))
    strains += 0.0  # no negative zeros
    residuals = np.linalg.norm(core.gradient(strains), axis=-1)
    strains.setflags(write=False)
    columns = (energies.tolist(), indices.tolist(), phases, resolved.tolist(), residuals.tolist())
    return [
        State(
            scene=scene,
            course=Uniform(strain),
            energy=energy,
            section_index=index,
            phases=(phase,),
            resolved=told_apart,
            report=Report(METHOD, len(phases), unresolved, residual),
            S=nodes,
        )
        for strain, energy, index, phase, told_apart, residual in zip(strains, *columns, strict=True)
    ]


def _branches(scene: Scene, law: SectionLaw, nodes: Array) -> list[State]:
    """The states of a ribbon that varies."""
    length = scene.ribbon.length_ratio
    try:
        branches = law.core().natural_branches(length)
    except ValueError as error:
        other = 'law="full"' if scene.law != "full" else "growth, width and thickness that vary less along it"
        reason = f"no natural shape all along the ribbon, {error}"
        raise ConvergenceError(reason, np.empty((0, 4)), (), other) from None
    states = []
    for branch in branches:
        course = Along(branch, length)
        residual = np.max(np.linalg.norm(law.gradient(course.strains(nodes), nodes), axis=-1))
        events = tuple(
            Event(S, kind, tuple(before), tuple(after)) for S, kind, before, after in branch.events
        )
        elements = branch.breaks.size - 1
        report = Report(METHOD_ALONG, len(branches), 0, float(residual), events, elements, TOLERANCE)
        state = State(
            scene=scene,
            course=course,
            energy=branch.energy,
            section_index=0,
            phases=tuple(branch.phases),
            resolved=True,
            report=report,
            S=nodes,
        )
        states.append(state)
    return states


def _stable(states: list[State]) -> State:
    """The first stable state: they come in order of energy, of mirror images K2 > 0, then K3 > 0 first.

    Just past a bifurcation the stable states may be merged with the unstable one between them.
    """
    for group in ([s for s in states if s.stable], [s for s in states if not s.resolved]):
        if group:
            return group[0]
    # The full law always has a minimum; the energy of its expansion may be unbounded below.
    raise ConvergenceError(
        f"none of the {len(states)} equilibria is stable",
        states[0].strain,
        (states[0].report.gradient_norm,),
        'law="full", or guess= for an unstable one',
    )


def _nearest(states: list[State], guess: State | ArrayLike) -> State:
    if isinstance(guess, State):
        strain = _first(guess)
    else:
        strain = vector("guess", guess, 4, "a State, or eps, K1, K2, K3")

    def distance(state: State) -> float:
        return float(np.linalg.norm((_first(state) - strain)[2:]))

    return min(states, key=distance)


def _first(state: State) -> Array:
    """The strains (4,) at S = 0."""
    first: Array = state.course.strains(np.zeros(1))[0]
    return first
