"""How the ribbon grows: small growth strains over its cross-section and along it.

The growth tensor is G = I + g. Of g these parts act, as functions of x = X2/a across the width:

- gamma33: axial growth of the mid-surface; gamma22 and gamma23: its transverse and shear growth g22 and
  g23 + g32, which only move points within the cross-section;
- d33, d22, d23: gradients through the thickness, g33 = gamma33 + (X1/a) d33 and alike for g22 and
  g23 + g32;
- g21, g31: transverse shear growth.

Growths add: ``edge(0.06) + chiral(0.04)``. Amplitudes are numbers or vary with S = X3/a along the ribbon.
"""

from __future__ import annotations

from .along import AlongInput, Amplitude, amplitude
from .measured import from_csv, stations
from .profile import Profile, path_of
from .terms import FIELDS, Growth, Shape, Term

__all__ = [
    "FIELDS",
    "Growth",
    "Profile",
    "Shape",
    "Term",
    "chiral",
    "edge",
    "from_csv",
    "stations",
    "thickness",
]


def edge(xi: AlongInput, name: str = "edge") -> Growth:
    """Return growth along the ribbon that is largest at its edges, g33 = xi (2 X2/a)^2.

    Parameters
    ----------
    xi : float, (S, values), or callable
        Growth strain at the edges; the amplitude. A number, or varying along the ribbon: a tuple of samples
        over S = X3/a joined by lines, in which the same S twice is a jump, or a function of S, called with an
        array.
    name : str
        Name of this growth within a sum.

    Notes
    -----
    Source: Liu, Li & Liu, eq. (51).

    Examples
    --------
    Only the outer half of a ribbon 10 widths long grows:

    >>> edge(([0.0, 5.0, 5.0, 10.0], [0.0, 0.0, 0.06, 0.06])).values(x=0.5, S=[4.0, 6.0])
    {'gamma33': array([0.  , 0.06])}
    """
    return _single(name, amplitude(path_of(name), xi), (("gamma33", (0.0, 0.0, 4.0)),))


def thickness(xi: AlongInput, transverse: AlongInput = 0.0, name: str = "thickness") -> Growth:
    """Return growth that varies through the thickness, g33 = xi X1/a and g22 = transverse X1/a.

    Parameters
    ----------
    xi : float, (S, values), or callable
        Gradient of the growth along the ribbon; the amplitude (where it is zero, `transverse` is). May vary
        along the ribbon as in `edge`.
    transverse : float, (S, values), or callable
        Gradient of the growth across it; ``-xi / 2`` makes a saddle. If it or `xi` varies along the ribbon,
        it is a growth of its own in the sum, named ``thickness_transverse``.
    name : str
        Name of this growth within a sum.

    Notes
    -----
    Source: Liu, Li & Liu, eq. (44), without the transverse part.
    """
    along = amplitude(f"{path_of(name)}.xi", xi)
    across = amplitude(f"{path_of(name)}.transverse", transverse)
    if across == 0.0:
        return _single(name, along, (("d33", (1.0,)),))
    if along == 0.0:
        return _single(name, across, (("d22", (1.0,)),))
    if isinstance(along, float) and isinstance(across, float):
        return _single(name, along, (("d33", (1.0,)), ("d22", (across / along,))))
    return _single(name, along, (("d33", (1.0,)),)) + _single(
        f"{name}_transverse", across, (("d22", (1.0,)),)
    )


def chiral(d: AlongInput, name: str = "chiral") -> Growth:
    """Return shear growth that varies through the thickness, g23 + g32 = d X1/a.

    It gives the ribbon a natural twist, of the sign of `d`: oblique fibres, say.

    Parameters
    ----------
    d : float, (S, values), or callable
        Gradient of the shear growth; the amplitude. May vary along the ribbon as in `edge`.
    name : str
        Name of this growth within a sum.
    """
    return _single(name, amplitude(path_of(name), d), (("d23", (1.0,)),))


def _single(name: str, amplitude: Amplitude, shape: tuple[tuple[str, Shape], ...]) -> Growth:
    return Growth((Term(name, amplitude, shape),))
