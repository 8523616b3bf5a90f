"""Numerical core of ribbonrs: arrays in, arrays out. Use the functions and classes of `ribbonrs` instead."""

from collections.abc import Mapping, Sequence
from typing import TypeAlias, final

import numpy as np
from numpy.typing import NDArray

__all__ = [
    "SectionLaw",
    "gauss_points",
    "helix",
    "integrate_gauss",
    "integrate_nodal",
    "integrate_segments",
]

_Array: TypeAlias = NDArray[np.float64]
_Poses: TypeAlias = tuple[_Array, _Array]

@final
class SectionLaw:
    """Relaxed cross-section energy of a growing ribbon."""

    def __new__(
        cls,
        eta: float,
        stiffness: tuple[float, float, float, float],
        fields: Mapping[str, Sequence[float]],
        form: str = "auto",
    ) -> SectionLaw: ...
    @property
    def form(self) -> str: ...
    @property
    def eta(self) -> float: ...
    def energy(self, strains: _Array) -> _Array: ...
    def gradient(self, strains: _Array) -> _Array: ...
    def hessian(self, strains: _Array) -> _Array: ...
    def deflection(self, strain: Sequence[float] | _Array, x: _Array, derivative: int = 0) -> _Array: ...
    def displacements(self, strain: Sequence[float] | _Array, x: _Array) -> _Array: ...
    def natural_shapes(
        self,
    ) -> tuple[_Array, _Array, NDArray[np.int64], list[str], NDArray[np.bool_]]: ...

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
