"""A rod with constant N and C = M + r x N, in numpy: as `auto/rod.f90`, many points at once."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

Array = np.ndarray[Any, Any]
Law = Callable[[Array], tuple[Array, Array]]
"""Strains (4, n) and compliances (4, 4, n) of (n3, m1, m2, m3)."""

# Bilinear forms of a quaternion: d_i . E_j = q B_ij q, and q (0, e_i)/2 = T_i q.
B = np.zeros((3, 3, 4, 4))
for i, j, terms in (
    (0, 0, "+00+11-22-33"), (0, 1, "+12+21+03+30"), (0, 2, "+13+31-02-20"),
    (1, 0, "+12+21-03-30"), (1, 1, "+00-11+22-33"), (1, 2, "+23+32+01+10"),
    (2, 0, "+13+31+02+20"), (2, 1, "+23+32-01-10"), (2, 2, "+00-11-22+33"),
):  # fmt: skip
    for sign, row, column in zip(terms[::3], terms[1::3], terms[2::3], strict=True):
        B[i, j, int(row), int(column)] = float(sign + "1")
T = np.zeros((3, 4, 4))
T[0] = [[0, -1, 0, 0], [1, 0, 0, 0], [0, 0, 0, 1], [0, 0, -1, 0]]
T[1] = [[0, 0, -1, 0], [0, 0, 0, -1], [1, 0, 0, 0], [0, 1, 0, 0]]
T[2] = [[0, 0, 0, -1], [0, 0, 1, 0], [0, -1, 0, 0], [1, 0, 0, 0]]
T /= 2
EPSILON = np.zeros((3, 3, 3))
for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
    EPSILON[i, j, k], EPSILON[i, k, j] = 1.0, -1.0


def field(u: Array, n: Array, c: Array, law: Law) -> tuple[Array, Array, Array]:
    """Return u' (7, p) of states (r, q) (7, p), and its derivatives with them (7, 7, p) and (N, C) (7, 6, p).

    N and C are (3,) or (3, p).
    """
    r, q = u[:3], u[3:]
    dq = 2 * np.einsum("ijab,bp->ijap", B, q)
    d = np.einsum("ijap,ap->ijp", dq, q) / 2
    if n.ndim == 1:
        n, c = n[:, None] + 0 * r, c[:, None] + 0 * r
    m = c - np.cross(r, n, axis=0)
    e, s = law(np.concatenate([np.sum(d[2] * n, axis=0)[None], np.sum(d * m, axis=1)]))
    f = np.concatenate([(1 + e[0]) * d[2], np.einsum("iab,bp,ip->ap", T, q, e[1:])])

    wrench_u = np.zeros((4, 7, u.shape[1]), dtype=f.dtype)
    wrench_w = np.zeros((4, 6, u.shape[1]), dtype=f.dtype)
    wrench_u[1:, :3] = np.einsum("jkl,ikp,lp->ijp", EPSILON, d, n)
    wrench_w[1:, :3] = -np.einsum("jkl,ikp,lp->ijp", EPSILON, d, r)
    wrench_w[1:, 3:] = d
    wrench_w[0, :3] = d[2]
    wrench_u[0, 3:] = np.einsum("jap,jp->ap", dq[2], n)
    wrench_u[1:, 3:] = np.einsum("ijap,jp->iap", dq, m)
    turn = np.einsum("iab,bp->aip", T, q)
    strain_u, strain_w = (np.einsum("ijp,jkp->ikp", s, w) for w in (wrench_u, wrench_w))
    du, dw = (
        np.concatenate([d[2][:, None] * e_w[0], np.einsum("aip,ikp->akp", turn, e_w[1:])])
        for e_w in (strain_u, strain_w)
    )
    du[:3, 3:] += (1 + e[0]) * dq[2]
    du[3:, 3:] += np.einsum("iab,ip->abp", T, e[1:])
    return f, du, dw
