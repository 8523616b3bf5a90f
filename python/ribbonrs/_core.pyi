"""Numerical core of ribbonrs: arrays in, arrays out. Use the functions and classes of `ribbonrs` instead."""

from collections.abc import Callable, Mapping, Sequence
from typing import TypeAlias, final

import numpy as np
from numpy.typing import NDArray

__all__ = [
    "BoundaryProblem",
    "BoundarySolution",
    "LinearLaw",
    "NaturalBranch",
    "SectionLaw",
    "Trace",
    "TracedBranch",
    "gauss_points",
    "helix",
    "integrate_gauss",
    "integrate_nodal",
    "integrate_segments",
    "map_outline",
    "natural_shapes_of",
    "phase_map",
    "trace",
    "trace_natural",
]

_Array: TypeAlias = NDArray[np.float64]
_Poses: TypeAlias = tuple[_Array, _Array]
_Pieces: TypeAlias = tuple[list[float], list[list[float]]]
_Shapes: TypeAlias = tuple[_Array, _Array, NDArray[np.int64], list[str], NDArray[np.bool_]]
_Vec: TypeAlias = Sequence[float]
_Along: TypeAlias = float | _Pieces
_End: TypeAlias = tuple[str, _Vec, _Vec, float, _Vec, _Vec, _Vec]
_State: TypeAlias = tuple[list[float], list[float], list[float], list[float]]
_Parts: TypeAlias = tuple[
    int, list[float], list[_State], list[list[float]], tuple[str, str], list[float], list[int], list[float]
]
_Side: TypeAlias = tuple[int, bytes] | None
_Line: TypeAlias = tuple[_Array, _Array, _Side, _Side]
_Changes: TypeAlias = Sequence[tuple[int, Sequence[tuple[float, float, int, int]]]]
_Guess: TypeAlias = tuple[_Array, _Array, _Array, _Array, _Array, _Array]

@final
class SectionLaw:
    """Relaxed cross-section energy of a growing ribbon."""

    def __new__(
        cls,
        eta: float,
        stiffness: tuple[float, float, float, float],
        terms: Sequence[tuple[float | _Pieces, Mapping[str, Sequence[float] | _Pieces]]],
        form: str = "auto",
        width: float | _Pieces | None = None,
        thickness: float | _Pieces | None = None,
    ) -> SectionLaw: ...
    @property
    def form(self) -> str: ...
    @property
    def eta(self) -> float: ...
    @property
    def varies(self) -> bool: ...
    def resolved_curvature(self, S: float = 0.0) -> float: ...
    def energy(self, strains: _Array, S: _Array | None = None) -> _Array: ...
    def gradient(self, strains: _Array, S: _Array | None = None) -> _Array: ...
    def hessian(self, strains: _Array, S: _Array | None = None) -> _Array: ...
    def deflection(
        self, strain: Sequence[float] | _Array, x: _Array, derivative: int = 0, S: float = 0.0
    ) -> _Array: ...
    def displacements(self, strain: Sequence[float] | _Array, x: _Array, S: float = 0.0) -> _Array: ...
    def natural_shapes(self, S: float = 0.0) -> _Shapes: ...
    def natural_branches(self, length: float) -> list[NaturalBranch]: ...

@final
class NaturalBranch:
    """A stable natural shape all along a ribbon that varies."""

    def __new__(
        cls,
        breaks: Sequence[float],
        series: Sequence[Sequence[Sequence[float]]],
        events: Sequence[tuple[float, str, Sequence[float], Sequence[float]]],
        energy: float,
        phases: Sequence[str],
    ) -> NaturalBranch: ...
    @property
    def breaks(self) -> _Array: ...
    @property
    def energy(self) -> float: ...
    @property
    def phases(self) -> list[str]: ...
    @property
    def events(self) -> list[tuple[float, str, list[float], list[float]]]: ...
    def strains(self, S: _Array) -> _Array: ...
    def poses(
        self, S: _Array, position: Sequence[float] | _Array, quaternion: Sequence[float] | _Array
    ) -> _Poses: ...

@final
class LinearLaw:
    """Forces and moments linear in the strains."""

    def __new__(cls, compliance: _Vec, intrinsic: _Vec) -> LinearLaw: ...

@final
class BoundaryProblem:
    """A ribbon that is loaded or held at its ends."""

    def __new__(
        cls,
        law: SectionLaw | LinearLaw,
        linear: bool,
        length: float,
        start: _End,
        end: _End,
        points: Sequence[tuple[float, _Vec, _Vec]],
        force: Sequence[_Along],
        moment: Sequence[_Along],
    ) -> BoundaryProblem: ...
    def solve(
        self, tol: float, degree: int | None = None, guess: _Guess | None = None
    ) -> BoundarySolution: ...
    def find(self, tol: float, degree: int | None, most: int) -> list[BoundarySolution]: ...
    def restored(self, parts: _Parts) -> BoundarySolution: ...

@final
class BoundarySolution:
    """An equilibrium of a boundary-value problem, or how far the solver came."""

    @property
    def status(self) -> str: ...
    @property
    def reason(self) -> str: ...
    @property
    def converged(self) -> bool: ...
    @property
    def fraction(self) -> float: ...
    @property
    def breaks(self) -> _Array: ...
    @property
    def kinks(self) -> list[float]: ...
    @property
    def degree(self) -> int: ...
    @property
    def energy(self) -> float: ...
    @property
    def load_potential(self) -> float: ...
    @property
    def section_index(self) -> int: ...
    @property
    def extremes(self) -> list[list[float]]: ...
    @property
    def index(self) -> int | None: ...
    def free_motions(self) -> int: ...
    @property
    def error(self) -> float: ...
    @property
    def residual(self) -> float: ...
    @property
    def condition(self) -> float: ...
    @property
    def iterations(self) -> int: ...
    @property
    def factorisations(self) -> int: ...
    @property
    def meshes(self) -> int: ...
    @property
    def load_steps(self) -> int: ...
    @property
    def residuals(self) -> list[float]: ...
    def is_uniform(self, most: Sequence[float]) -> bool: ...
    def at(self, S: _Array) -> tuple[_Array, _Array, _Array, _Array, _Array]: ...
    def reactions(self) -> list[_Array]: ...
    def parts(self) -> _Parts: ...

@final
class TracedBranch:
    """Equilibria along a branch, k points; what `trace_natural` gives is of a ribbon of length 1."""

    @property
    def parameter(self) -> _Array: ...
    @property
    def energy(self) -> _Array: ...
    @property
    def load_potential(self) -> _Array: ...
    @property
    def section_index(self) -> NDArray[np.int64]: ...
    @property
    def index(self) -> _Array: ...
    @property
    def strains(self) -> _Array: ...
    @property
    def position(self) -> _Array: ...
    @property
    def reactions(self) -> _Array: ...
    @property
    def ended(self) -> tuple[str, str]: ...
    @property
    def reason(self) -> str: ...
    @property
    def origin(self) -> int | None: ...
    @property
    def mirrored(self) -> bool: ...
    def solution(self, i: int) -> BoundarySolution | None: ...
    def locus(
        self,
        place: int,
        kind: str,
        corners: Sequence[BoundaryProblem] | Sequence[SectionLaw],
        other_span: tuple[float, float],
        other_value: float,
        max_steps: int,
        tol: float,
    ) -> tuple[_Array, tuple[str, str]]: ...
    def between(self, i: int, fraction: float) -> tuple[float, _Array, BoundarySolution | None]: ...
    def at_value(self, i: int, value: float) -> tuple[float, _Array, BoundarySolution | None]: ...

@final
class Trace:
    """Branches of equilibria and their special points: kind, branch, point, parameter, multiplicity."""

    @property
    def branches(self) -> list[TracedBranch]: ...
    @property
    def special_points(self) -> list[tuple[str, int, int, float, int]]: ...
    @property
    def work(self) -> tuple[int, float, float, float, float] | None: ...

def trace(
    problems: tuple[BoundaryProblem, BoundaryProblem],
    span: tuple[float, float],
    start: BoundarySolution,
    start_value: float,
    values: Sequence[float],
    depth: int,
    max_steps: int,
    tol: float,
    degree: int | None,
) -> Trace: ...
def trace_natural(
    laws: tuple[SectionLaw, SectionLaw],
    span: tuple[float, float],
    values: Sequence[float],
    depth: int,
    max_steps: int,
) -> Trace: ...
def phase_map(
    laws: Sequence[SectionLaw],
    xs: Sequence[float],
    ys: Sequence[float],
    tol: float,
    report: Callable[[int], object] | None = None,
) -> tuple[NDArray[np.int8], NDArray[np.uint8], _Array, NDArray[np.bool_], list[_Line], bool]: ...
def map_outline(
    classes: NDArray[np.int64],
    xs: Sequence[float],
    ys: Sequence[float],
    along_x: _Changes,
    along_y: _Changes,
) -> list[tuple[_Array, _Array, int, int]]: ...
def natural_shapes_of(laws: Sequence[SectionLaw]) -> list[_Shapes]: ...
def helix(
    S: _Array,
    strain: Sequence[float] | _Array,
    position: Sequence[float] | _Array,
    quaternion: Sequence[float] | _Array,
) -> _Poses: ...
def integrate_segments(
    S: _Array, strains: _Array, position: Sequence[float] | _Array, quaternion: Sequence[float] | _Array
) -> _Poses: ...
def integrate_nodal(
    S: _Array, strains: _Array, position: Sequence[float] | _Array, quaternion: Sequence[float] | _Array
) -> _Poses: ...
def gauss_points(S: _Array) -> _Array: ...
def integrate_gauss(
    S: _Array, strains: _Array, position: Sequence[float] | _Array, quaternion: Sequence[float] | _Array
) -> _Poses: ...
