"""Dead loads on the ribbon: at a point, along a line, and its weight.

Components are on the fixed basis and keep their direction whatever the ribbon does. S = X3/a is the arc
length of the undeformed ribbon; forces are in units of Y h a, moments in Y h a^2, along a line per unit S.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from .along import Amplitude, check_covers, function_of_s
from .arrays import Array, real_array
from .check import Numbers, Vector, load_vector, number, positive
from .errors import InputError
from .pieces import Pieces
from .resolve import adapted
from .ribbon import Ribbon
from .samples import is_samples

__all__ = ["LineInput", "LineLoad", "Load", "PointLoad", "weight"]

LineInput: TypeAlias = Numbers | tuple[ArrayLike, ArrayLike] | Callable[[Array], ArrayLike]
"""Three numbers, samples (S, values) with values (m, 3), or a function of S."""

PROBES = 33
"""Points at which a function of S is called before it is resolved."""


@dataclass(frozen=True, init=False)
class PointLoad:
    """A dead force and moment on one cross-section.

    Parameters
    ----------
    S : float
        Where, strictly inside the ribbon. Several loads at the same S add.
    force, moment : sequence of 3 float
        In units of Y h a and Y h a^2.
    follower : bool
        Only False: loads that turn with the ribbon are not solved.

    Raises
    ------
    InputError
        If a number is not finite or a component larger than 1e60, or a vector has the wrong length.
    """

    S: float
    force: Vector
    moment: Vector

    def __init__(
        self,
        S: float,
        force: Numbers = (0.0, 0.0, 0.0),
        moment: Numbers = (0.0, 0.0, 0.0),
        follower: bool = False,
    ) -> None:
        _check_dead("point_load.follower", follower)
        object.__setattr__(self, "S", number("point_load.S", S))
        object.__setattr__(self, "force", load_vector("point_load.force", force))
        object.__setattr__(self, "moment", load_vector("point_load.moment", moment))

    @property
    def acts(self) -> bool:
        """Whether it is not zero."""
        return any(self.force) or any(self.moment)

    def forces(self, length: float) -> Array:
        """Return what force acts: array (1, 3)."""
        return np.array([self.force])

    def numbers(self, length: float) -> list[float]:
        """Return numbers to which it is in proportion."""
        return [*self.force, *self.moment]

    def scaled(self, factor: float, length: float) -> PointLoad:
        """Return `factor` times the load."""
        force, moment = (tuple(factor * entry for entry in v) for v in (self.force, self.moment))
        return PointLoad(self.S, force, moment)


@dataclass(frozen=True, init=False)
class LineLoad:
    """A dead force and moment per unit S, along the whole ribbon.

    Parameters
    ----------
    force, moment : sequence of 3 float, (S, values), or callable
        In units of Y h a and Y h a^2 per unit S: three numbers; a tuple of samples, S (m,) and values (m, 3),
        joined by lines, in which the same S twice is a jump; or a function of S, called with an array (m,)
        and returning one (m, 3). Kept as three components.
    follower : bool
        Only False: loads that turn with the ribbon are not solved.

    Raises
    ------
    InputError
        Anything else, and numbers that are not finite or larger than 1e60.

    Examples
    --------
    A wind that grows towards the tip of a ribbon 10 widths long:

    >>> wind = LineLoad(force=([0.0, 10.0], [[0.0, 0.0, 0.0], [1e-5, 0.0, 0.0]]))
    >>> wind.along(10.0)["force"][0].evaluate(5.0).item()
    5e-06
    """

    force: tuple[Amplitude, Amplitude, Amplitude]
    moment: tuple[Amplitude, Amplitude, Amplitude]

    def __init__(
        self,
        force: LineInput = (0.0, 0.0, 0.0),
        moment: LineInput = (0.0, 0.0, 0.0),
        follower: bool = False,
    ) -> None:
        _check_dead("line_load.follower", follower)
        object.__setattr__(self, "force", _components("line_load.force", force))
        object.__setattr__(self, "moment", _components("line_load.moment", moment))

    @property
    def acts(self) -> bool:
        """Whether it is not zero; functions and samples count as something."""
        return any(component != 0.0 for component in (*self.force, *self.moment))

    def forces(self, length: float) -> Array:
        """Return the force at points along a ribbon of this `length` over its width: array (n, 3)."""
        S = np.linspace(0.0, length, PROBES)
        known = self.along(length)["force"]
        values = [f.evaluate(S) if isinstance(f, Pieces) else np.full(PROBES, f) for f in known]
        return np.stack(values, axis=1)

    def along(self, length: float) -> dict[str, list[float | Pieces]]:
        """Return the components of "force" and "moment" as numbers or pieces that cover [0, length].

        Raises
        ------
        InputError
            If samples do not reach from 0 to `length`, or a function cannot be resolved there.
        """
        if length not in self._known:
            self._known[length] = {
                name: [
                    _resolved(f"line_load.{name}", i, f, length) for i, f in enumerate(getattr(self, name))
                ]
                for name in ("force", "moment")
            }
        return self._known[length]

    @property
    def uniform(self) -> bool:
        """Whether it is the same all along."""
        return all(isinstance(component, float) for component in (*self.force, *self.moment))

    def numbers(self, length: float) -> list[float]:
        """Return numbers to which it is in proportion along a ribbon of this `length` over its width."""
        known = [component for components in self.along(length).values() for component in components]
        parts = [f.coefficients if isinstance(f, Pieces) else ((f,),) for f in known]
        return [c for pieces in parts for piece in pieces for c in piece]

    def scaled(self, factor: float, length: float) -> LineLoad:
        """Return `factor` times the load on a ribbon of this `length` over its width."""
        return LineLoad.of(
            **{
                name: tuple(f.scaled(factor) if isinstance(f, Pieces) else factor * f for f in components)
                for name, components in self.along(length).items()
            }
        )

    def with_(self, field: str, components: tuple[Amplitude, ...]) -> LineLoad:
        """Return the same with other components of "force" or "moment"."""
        return LineLoad.of(**{"force": self.force, "moment": self.moment, field: components})

    @classmethod
    def of(cls, force: tuple[Amplitude, ...], moment: tuple[Amplitude, ...]) -> LineLoad:
        """Return a load of these three components each, as they are kept."""
        made = cls()
        for name, components in (("force", force), ("moment", moment)):
            numbers = all(isinstance(component, float) for component in components)
            kept = _components(f"line_load.{name}", components) if numbers else tuple(components)
            object.__setattr__(made, name, kept)
        return made

    @cached_property
    def _known(self) -> dict[float, dict[str, list[float | Pieces]]]:
        """What `along` returned for each length so far."""
        return {}


Load: TypeAlias = PointLoad | LineLoad
"""A load on the ribbon between its ends."""


def weight(ribbon: Ribbon, density: float, g: Numbers) -> Vector:
    r"""Return the weight of a ribbon per unit S, as `gravity=` of a scene takes it.

    .. math:: p = \frac{\varrho\, a\, h\, a\, g}{Y h a} = \frac{\varrho\, a\, g}{Y}

    Parameters
    ----------
    ribbon : Ribbon
        Of uniform width and thickness.
    density : float
        Mass per volume, in units that agree with those of the ribbon's lengths and of Young's modulus.
    g : sequence of 3 float
        Acceleration of gravity on the fixed basis: (0, 0, -9.81) for a ribbon clamped upright.

    Raises
    ------
    InputError
        An argument that is not that.

    Examples
    --------
    A strip of rubber, 10 mm wide, that stands on its end; SI units:

    >>> import ribbonrs as rb
    >>> strip = rb.Ribbon(0.2, 0.01, 0.001, material=rb.Isotropic(Y=1e6))
    >>> rb.weight(strip, density=1000.0, g=(0.0, 0.0, -10.0))
    (0.0, 0.0, -0.0001)
    """
    if not isinstance(ribbon, Ribbon):
        raise InputError("weight.ribbon", ribbon, "a Ribbon")
    if ribbon.varies:
        expected = "uniform width and thickness; of a ribbon that varies use LineLoad(force=) with a function"
        raise InputError("weight.ribbon", ribbon, expected)
    unit = positive("weight.density", density) * ribbon.width / ribbon.material.Y
    x, y, z = load_vector("weight.g", g)
    return load_vector("weight", (unit * x + 0.0, unit * y + 0.0, unit * z + 0.0))


@dataclass(frozen=True)
class _Component:
    """One component of the user's function of S."""

    function: Callable[[Array], Any]
    i: int

    def __call__(self, S: Array) -> Any:
        return np.asarray(self.function(S))[..., self.i]


def _check_dead(field: str, follower: object) -> None:
    if follower is not False:
        expected = "False, dead loads; follower loads have no potential and are not solved"
        raise InputError(field, follower, expected)


def _components(field: str, value: Any) -> tuple[Amplitude, ...]:
    """The three components of what the user gave, checked as far as it can be without the length."""
    if callable(value):
        return tuple(_Component(value, i) for i in range(3))
    if not is_samples(value):
        return load_vector(field, value)
    expected = "samples (S, values), S a list (m,) of numbers and values (m, 3)"
    if len(value) != 2:
        raise InputError(field, value, expected)
    values = real_array(f"{field}.values", value[1], expected)
    if values.ndim != 2 or values.shape[1] != 3:
        raise InputError(f"{field}.values.shape", values.shape, expected)
    return tuple(function_of_s(field, (value[0], values[:, i])) for i in range(3))


def _resolved(field: str, i: int, component: Amplitude, length: float) -> float | Pieces:
    """A component over [0, length]."""
    if isinstance(component, Pieces):
        check_covers(field, component, length)
        return component
    if isinstance(component, _Component):
        _check_shape(field, component.function, length)
        return adapted(f"{field}[{i}]", component, length)
    assert isinstance(component, float)
    return component


def _check_shape(field: str, function: Callable[[Array], Any], length: float) -> None:
    """Check that a function returns three columns; what it does else is found when it is resolved."""
    S = np.linspace(0.0, length, PROBES)
    try:
        shape = np.shape(function(S.copy()))
    except Exception:  # whatever the user's function raises
        shape = (PROBES, 3)
    if shape != (PROBES, 3):
        expected = f"a function of S that takes an array (m,) and returns one (m, 3), not {shape}"
        raise InputError(field, function, expected)
