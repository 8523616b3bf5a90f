"""Numerical core of ribbonrs: arrays in, arrays out. Use the functions and classes of `ribbonrs` instead."""

from collections.abc import Mapping, Sequence
from typing import TypeAlias, final

import numpy as np
from numpy.typing import NDArray

__all__ = [
    "NaturalBranch",
    "SectionLaw",
    "gauss_points",
    "helix",
    "integrate_gauss",
    "integrate_nodal",
    "integrate_segments",
    "natural_shapes_of",
]

_Array: TypeAlias = NDArray[np.float64]
_Poses: TypeAlias = tuple[_Array, _Array]
_Pieces: TypeAlias = tuple[list[float], list[list[float]]]
_Shapes: TypeAlias = tuple[_Array, _Array, NDArray[np.int64], list[str], NDArray[np.bool_]]

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
