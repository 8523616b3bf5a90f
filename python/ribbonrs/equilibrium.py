r"""Unloaded equilibria of a ribbon of uniform growth: the pointwise roots of dPi = 0."""

from __future__ import annotations

import math
import warnings

import numpy as np
from numpy.typing import ArrayLike

from .arrays import count, vector
from .check import number
from .errors import ConvergenceError, InputError, RibbonWarning
from .growth import Growth
from .law import SectionLaw
from .ribbon import Ribbon
from .scene import Scene
from .state import Report, State

__all__ = ["NODES", "equilibria", "natural_shapes", "solve"]

NODES = 101
"""Default number of nodes of a state."""

SERIES_RADIUS = 7.4578
"""|K2|/eta up to which the quadratic law's expansion converges in an incompressible material.

From the least zero of sinh z + sin z; in others in proportion to (Q22/Y)^(1/2)."""

METHOD = "pointwise natural shape"


def natural_shapes(ribbon: Ribbon, growth: Growth) -> list[State]:
    r"""Return every unloaded equilibrium of a uniform ribbon, lowest energy first.

    All strains at which :math:`\partial\Pi/\partial\varepsilon = \partial\Pi/\partial K_i = 0`: minima,
    saddles and maxima, mirror images included, of which K2 > 0, then K3 > 0 comes first. Complete up to
    pairs closer than 1e-6 in K/eta: a state that stands for several has ``resolved = False``, and a
    `RibbonWarning` says so.

    Raises
    ------
    InputError
        Growth too large for the theory (see `Scene`).

    Notes
    -----
    Source: Liu, Li & Liu, eqs. (40)-(43) without loads, where N = M = 0 all along.

    Examples
    --------
    >>> import ribbonrs as rb
    >>> leaf = rb.Ribbon(length=10.0, width=1.0, thickness=0.1)
    >>> [(state.phase, state.section_index) for state in rb.natural_shapes(leaf, rb.growth.edge(0.048))]
    [('bent', 0), ('bent', 0), ('flat', 1)]
    """
    return equilibria(Scene(ribbon, growth))


def solve(
    scene: Scene,
    guess: State | ArrayLike | None = None,
    tol: float = 1e-10,
    degree: int | None = None,
    n: int = NODES,
) -> State:
    r"""Return an equilibrium of `scene`: an unloaded ribbon, clamped at its start.

    Without `guess` the stable one of lowest energy, of mirror images the one with K2 > 0, then K3 > 0.

    Parameters
    ----------
    scene : Scene
        What to solve.
    guess : State or (4,) array, optional
        A state, or eps, K1, K2, K3: return the equilibrium nearest to it in (K2, K3), stable or not.
    tol, degree : float, int
        Tolerance in [1e-14, 1) and polynomial degree of the collocation for loaded ribbons, which this
        version does not solve; natural shapes are found to rounding.
    n : int
        Number of nodes of the state, at least 2, equally spaced.

    Raises
    ------
    InputError
        An argument out of range, or growth that the scene's law cannot represent.
    ConvergenceError
        No equilibrium is stable, as happens with ``law="quadratic"``.

    Warns
    -----
    RibbonWarning
        With ``law="quadratic"``, if \|K2\|/eta > 7.46 (incompressible material), where its series diverges.

    Examples
    --------
    >>> import ribbonrs as rb
    >>> leaf = rb.Ribbon(length=10.0, width=1.0, thickness=0.1)
    >>> state = rb.solve(rb.Scene(leaf, rb.growth.edge(0.06) + rb.growth.chiral(0.04)))
    >>> state.phase, state.stable, state.helix.handedness
    ('helical', True, 'right')
    """
    if not isinstance(scene, Scene):
        raise InputError("scene", scene, "a Scene")
    expected = "a number in [1e-14, 1)"
    if not 1e-14 <= number("tol", tol, expected) < 1.0:
        raise InputError("tol", tol, expected)
    if degree is not None:
        count("degree", degree, 1)
    states = equilibria(scene, n)
    state = _stable(states) if guess is None else _nearest(states, guess)
    k2 = abs(state.strain[2]) / scene.ribbon.thickness_ratio
    material = scene.ribbon.material
    radius = SERIES_RADIUS * math.sqrt(0.75 * material.stiffness[1] / material.Y)
    if scene.law == "quadratic" and k2 > radius:
        warnings.warn(
            f"|K2|/eta = {k2:.3g} is beyond {radius:.3g}, where the quadratic law's series diverges",
            RibbonWarning,
            stacklevel=2,
        )
    return state


def equilibria(scene: Scene, n: int = NODES) -> list[State]:
    """Return every equilibrium of `scene`, with its law and start, in the order of `natural_shapes`."""
    nodes = np.linspace(0.0, scene.ribbon.length_ratio, count("n", n, 2), dtype=np.float64)
    nodes.setflags(write=False)
    law = SectionLaw.of(scene.ribbon, scene.growth, scene.law)
    strains, energies, indices, phases, resolved = law.core().natural_shapes()
    unresolved = int(np.count_nonzero(~resolved))
    if unresolved:
        warnings.warn(
            f"{unresolved} of {len(phases)} equilibria stand for several closer than 1e-6 in K/eta",
            RibbonWarning,
            stacklevel=3,
        )
    strains += 0.0  # no negative zeros
    residuals = np.linalg.norm(law.gradient(strains), axis=-1)
    strains.setflags(write=False)
    return [
        State(
            scene=scene,
            strain=strains[i],
            energy=float(energies[i]),
            section_index=int(indices[i]),
            phase=phase,
            resolved=bool(resolved[i]),
            report=Report(METHOD, len(phases), unresolved, float(residuals[i])),
            S=nodes,
        )
        for i, phase in enumerate(phases)
    ]


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
        strain = guess.strain
    else:
        strain = vector("guess", guess, 4, "a State, or eps, K1, K2, K3")

    def distance(state: State) -> float:
        return float(np.linalg.norm(state.strain[2:] - strain[2:]))

    return min(states, key=distance)
