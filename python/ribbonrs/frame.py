r"""Centreline and directors from strains.

Conventions
-----------
* Directors: right-handed orthonormal d1 (thickness), d2 (width), d3 (tangent); `directors` stores them
  as rows, components in the fixed basis E1, E2, E3.
* Quaternion: scalar first, (q0, q1, q2, q3), Hamilton product, body to space: d_i = q E_i q*.
  The rows of the directors are those of Liu, Li & Liu, eq. (65).
* Strains: eps, K1, K2, K3, with d_i' = omega x d_i, omega = K_i d_i (body components), r' = (1 + eps) d3
  (eqs. (5), (66)), hence q' = (1/2) q (0, K1, K2, K3) (eq. (67)). K1 bends in the plane of the ribbon,
  K2 out of it, K3 twists; K3 > 0 makes a right-handed helix.
* Lengths in units of the width a, curvatures in 1/a; S = X3/a. Any consistent unit of length serves.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from . import _core
from .arrays import Array, real_array, vector
from .errors import InputError

__all__ = ["directors", "integrate_frame"]

# A quaternion typed with nine digits is taken as a unit quaternion, anything worse as a mistake.
UNIT_TOLERANCE = 1e-8


def integrate_frame(
    S: ArrayLike,
    strains: ArrayLike | Callable[[Array], ArrayLike],
    position: ArrayLike = (0.0, 0.0, 0.0),
    quaternion: ArrayLike = (1.0, 0.0, 0.0, 0.0),
) -> tuple[Array, Array]:
    r"""Integrate the frame along the centreline: strains in, positions and quaternions out.

    Solves :math:`r' = (1 + \varepsilon) d_3`, :math:`q' = \tfrac12\, q\,(0, K_1, K_2, K_3)` from the pose at
    ``S[0]``. Every step is a rigid motion, so quaternions keep unit norm and a rigid motion of the
    starting pose moves the whole ribbon rigidly.

    Parameters
    ----------
    S : (n,) array
        Where the pose is wanted, n >= 2, strictly increasing or strictly decreasing.
    strains : array or callable
        eps, K1, K2, K3 in one of three forms. ``(n - 1, 4)``: constant on each segment, integrated exactly.
        ``(n, 4)``: values at ``S``, joined by cubics, order 4. Callable: order 6; it is called
        once, with an array of 3 (n - 1) values of S running from ``S[0]`` to ``S[-1]``, and returns an
        array (3 (n - 1), 4).
    position, quaternion : (3,), (4,) array
        Pose at ``S[0]``; the quaternion scalar first, unit to within 1e-8 (then normalised).

    Returns
    -------
    position : (n, 3) array
        Centreline in the fixed basis.
    quaternion : (n, 4) array
        Unit quaternions; `directors` turns them into d1, d2, d3.

    Raises
    ------
    InputError
        Wrong shape, non-finite or non-numeric entry, S not strictly monotonic, quaternion not unit.

    Notes
    -----
    Source: Liu, Li & Liu, eqs. (65)-(67).

    Examples
    --------
    A quarter of a circle of radius 2 (K2 = 1/2), which ends 2 ahead and 2 towards d1:

    >>> import numpy as np
    >>> import ribbonrs as rb
    >>> position, quaternion = rb.integrate_frame([0.0, np.pi], [[0.0, 0.0, 0.5, 0.0]])
    >>> print(position[-1].round(12))
    [2. 0. 2.]

    The same bend growing along the length:

    >>> S = np.linspace(0.0, 10.0, 101)
    >>> position, quaternion = rb.integrate_frame(S, lambda s: np.outer(s, [0.0, 0.0, 0.1, 0.0]))
    >>> position.shape, quaternion.shape
    ((101, 3), (101, 4))
    """
    nodes = real_array("S", S, "at least two finite numbers, strictly monotonic")
    if nodes.ndim != 1 or nodes.size < 2:
        raise InputError("S.shape", nodes.shape, "(n,) with n >= 2")
    steps = np.diff(nodes)
    if not (np.all(steps > 0.0) or np.all(steps < 0.0)):
        raise InputError("S", "not monotonic", "strictly increasing or strictly decreasing numbers")
    origin = vector("position", position, 3, "three finite numbers")
    pose = unit_quaternion("quaternion", quaternion)

    n = nodes.size
    if callable(strains):
        points = _core.gauss_points(nodes)
        values = _called(strains, points.ravel())
        return _core.integrate_gauss(nodes, values.reshape(n - 1, 3, 4), origin, pose)
    expected = f"({n - 1}, 4) constant per segment, ({n}, 4) at the nodes, or a callable of S"
    values = real_array("strains", strains, expected)
    if values.shape == (n - 1, 4):
        return _core.integrate_segments(nodes, values, origin, pose)
    if values.shape == (n, 4):
        return _core.integrate_nodal(nodes, values, origin, pose)
    raise InputError("strains.shape", values.shape, expected)


def directors(quaternion: ArrayLike) -> Array:
    """Directors of unit quaternions (..., 4): array (..., 3, 3) with rows d1, d2, d3 in the fixed basis.

    Notes
    -----
    Source: Liu, Li & Liu, eq. (65).

    Examples
    --------
    >>> print(directors([1.0, 0.0, 0.0, 0.0]))
    [[1. 0. 0.]
     [0. 1. 0.]
     [0. 0. 1.]]
    """
    q = real_array("quaternion", quaternion, "finite numbers of shape (..., 4)")
    if q.ndim == 0 or q.shape[-1] != 4:
        raise InputError("quaternion.shape", q.shape, "(..., 4), scalar first")
    q0, q1, q2, q3 = np.moveaxis(q, -1, 0)
    rows = np.empty((*q.shape[:-1], 3, 3))
    # the diagonal as 1 - 2 (...) keeps a rotation near the identity accurate
    rows[..., 0, 0] = 1.0 - 2.0 * (q2 * q2 + q3 * q3)
    rows[..., 0, 1] = 2.0 * (q1 * q2 + q0 * q3)
    rows[..., 0, 2] = 2.0 * (q1 * q3 - q0 * q2)
    rows[..., 1, 0] = 2.0 * (q1 * q2 - q0 * q3)
    rows[..., 1, 1] = 1.0 - 2.0 * (q1 * q1 + q3 * q3)
    rows[..., 1, 2] = 2.0 * (q2 * q3 + q0 * q1)
    rows[..., 2, 0] = 2.0 * (q1 * q3 + q0 * q2)
    rows[..., 2, 1] = 2.0 * (q2 * q3 - q0 * q1)
    rows[..., 2, 2] = 1.0 - 2.0 * (q1 * q1 + q2 * q2)
    return rows


def unit_quaternion(field: str, value: Any) -> Array:
    """Return `value` normalised, or raise `InputError` if it is not a unit quaternion to within 1e-8."""
    expected = "a unit quaternion (q0, q1, q2, q3), scalar first"
    q = vector(field, value, 4, expected)
    norm = float(np.linalg.norm(q))
    if abs(norm - 1.0) > UNIT_TOLERANCE:
        raise InputError(f"|{field}|", norm, expected)
    return q / norm


def _called(strains: Callable[[Array], ArrayLike], points: Array) -> Array:
    expected = f"an array ({points.size}, 4) for the {points.size} values of S it is called with"
    values = real_array("strains(S)", strains(points), expected)
    if values.shape != (points.size, 4):
        raise InputError("strains(S).shape", values.shape, expected)
    return values
