"""Several equilibria of a ribbon that is held and loaded."""

from __future__ import annotations

from .arrays import count
from .boundary import degree_of, state_of, tolerance
from .equilibrium import NODES, equilibria
from .errors import InputError
from .problem import problem_of
from .scene import Scene
from .state import State

__all__ = ["find_states"]

MOST = 1000
"""Most equilibria that may be asked for."""


def find_states(
    scene: Scene, most: int = 10, tol: float = 1e-10, degree: int | None = None, n: int = NODES
) -> list[State]:
    r"""Return equilibria of `scene`, stable and unstable, those of least total energy first.

    Of an unloaded ribbon they are all there are, as of `natural_shapes`. Of one that is loaded or held
    otherwise, the one that `solve` gives without a guess and those that deflation finds, with no promise
    that there are no others; of mirror images one. Where both ends are turned by so many turns they all are,
    but for two more or less, which a ribbon that may cross itself loses.

    Parameters
    ----------
    scene : Scene
        What to solve.
    most : int
        How many are looked for, 1 to 1000. Of an unloaded ribbon all are returned.
    tol, degree, n
        As of `solve`.

    Raises
    ------
    InputError
        An argument that is not that.

    Notes
    -----
    Newton's method for :math:`\prod_i (|x - x_i|^{-2} + 1)\, F(x) = 0` does not converge to the equilibria
    :math:`x_i` that are known. It starts from waves of bending and twist on the natural, straight and twisted
    shapes, then on all that was found, and ends after some two seconds for every equilibrium that is asked
    for. Source: Farrell, Birkisson & Funke (2015).

    Examples
    --------
    A strip between clamps, shortened by 5 %, buckles in one half wave, or in two, which is unstable:

    >>> import ribbonrs as rb
    >>> strip = rb.Scene(rb.Ribbon(10.0, 1.0, 0.1), end=rb.Clamped(position=(0.0, 0.0, 9.5)))
    >>> [state.index for state in rb.find_states(strip, most=2)]
    [0.0, 1.0]
    """
    if not isinstance(scene, Scene):
        raise InputError("scene", scene, "a Scene")
    most = count("find_states.most", most, 1, MOST)
    tol, degree, n = tolerance("tol", tol), degree_of("degree", degree), count("n", n, 2)
    if not scene.loaded:
        return equilibria(scene, n)
    try:
        found = problem_of(scene).find(tol, degree, most)
    except ValueError as error:
        raise InputError("scene", scene, f"one that can be solved, not: {error}") from None
    states = [state_of(scene, solution, tol, n) for solution in found]
    return sorted(states, key=lambda state: state.energy + state.load_potential)
