"""How a state was found, and where along the ribbon it is not smooth."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["Event", "Report"]


@dataclass(frozen=True)
class Event:
    """A place along the ribbon where the strains are not smooth.

    Attributes
    ----------
    S : float
        Where.
    kind : str
        "bifurcation": the strains have a corner, where the shape went over to another that begins there;
        "jump": the shape ends at a fold, or sections of a held ribbon on both sides are in different
        phases, and the ribbon has a kink; "growth jump": growth, width or
        thickness jumps; "point load": forces and moments jump.
    before, after : tuple of float
        eps, K1, K2, K3 on both sides.
    """

    S: float
    kind: str
    before: tuple[float, ...]
    after: tuple[float, ...]


@dataclass(frozen=True)
class Report:
    """How a state was found."""

    method: str
    equilibria: int
    """Number of unloaded equilibria found; of a ribbon that varies, of its stable branches; 1 of a
    boundary-value problem."""
    unresolved: int
    """How many of them stand for several closer than 1e-6 in K/eta."""
    gradient_norm: float
    """Norm of (n3, m1, m2, m3) at the state, its largest at the nodes, evaluated anew: zero but for rounding
    and, of a ribbon that varies, for `tolerance`. Of a boundary-value problem the `residual`."""
    events: tuple[Event, ...] = ()
    """Where the strains are not smooth, in order of S."""
    elements: int = 1
    """Number of elements on which the strains are polynomials in S."""
    tolerance: float = 0.0
    """What these may miss of the natural shapes, relative to the size of the strains; more where they are
    shorter than 1e-4 of the ribbon, next to an event. Of a boundary-value problem the tolerance asked for."""
    status: str = "converged"
    """How it ended: "converged", or "rounding_limited" if rounding is larger than the tolerance; of the state
    in a `ConvergenceError` "singular", "diverged" or "unresolved"."""
    degree: int = 0
    """Degree of the collocation; this and what follows are of boundary-value problems."""
    error: float = 0.0
    """Estimate of the largest error: of positions over the length, of angles, of eps and of curvatures times
    the length."""
    residual: float = 0.0
    """What the solution leaves of the equations, evaluated between the collocation points."""
    condition: float | None = None
    """Estimate of the condition number of the last linear system."""
    iterations: int = 0
    """Newton steps, on all meshes and for all parts of the loads."""
    factorisations: int = 0
    """Linear systems factorised."""
    meshes: int = 0
    """Meshes tried."""
    load_steps: int = 0
    """Parts in which the loads were put on."""
    residuals: tuple[float, ...] = ()
    """Size of the Newton steps of the last solve."""
