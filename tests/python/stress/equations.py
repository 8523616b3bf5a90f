"""How far a state is from the equations of the ribbon, by means that share nothing with the solver.

The frame is integrated anew from the strains that the state says it has, with 10 Gauss points a step on the
equations for rotation matrices; the law enters by its gradient, balance by integrals of the loads.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
import ribbonrs as rb
from numpy.polynomial.legendre import leggauss, legint, legval, legvander
from ribbonrs.ends import pose

POINTS = 10
TURN = 0.5
"""Radians a step turns at most: with 10 Gauss points what is in between is right to rounding, too."""


@lru_cache
def gauss():
    """Nodes c (s,) and weights b (s,) on [0, 1], and integrals a (s, s) of the Lagrange polynomials to c."""
    y, w = leggauss(POINTS)
    values = legvander(y, POINTS - 1)
    integrals = legval(y, legint(np.eye(POINTS), lbnd=-1.0)).T
    # discrete orthogonality: the coefficients of a function are (2n + 1)/2 sum_k w_k P_n(y_k) f_k
    coefficients = (np.arange(POINTS) + 0.5)[:, None] * values.T * w
    return 0.5 * (y + 1.0), 0.5 * w, 0.5 * integrals @ coefficients


def cross_matrix(v):
    """Matrices (..., 3, 3) with [v] w = v x w."""
    x, y, z = np.moveaxis(v, -1, 0)
    zero = np.zeros_like(x)
    return np.stack([zero, -z, y, z, zero, -x, -y, x, zero], axis=-1).reshape((*v.shape[:-1], 3, 3))


def matrix(q):
    """Columns d1, d2, d3 of a unit quaternion, scalar first."""
    v = cross_matrix(np.asarray(q[1:]))
    return np.eye(3) + 2.0 * q[0] * v + 2.0 * v @ v


def steps_of(state):
    """Ends of steps that turn by at most TURN and end where the elements of the state do."""
    length = state.scene.ribbon.length_ratio
    breaks = np.asarray(getattr(state.course, "breaks", [0.0, length]), dtype=float)
    middle = breaks[:-1, None] + np.diff(breaks)[:, None] * np.array([0.07, 0.5, 0.93])
    curvature = np.linalg.norm(state.at(middle).strains[..., 1:], axis=-1).max(axis=1)
    counts = np.maximum(2, np.ceil(1.3 * curvature * np.diff(breaks) / TURN)).astype(int)
    pieces = zip(breaks[:-1], breaks[1:], counts, strict=True)
    return np.concatenate([*(np.linspace(a, b, n, endpoint=False) for a, b, n in pieces), breaks[-1:]])


class Frame:
    """The ribbon integrated from its start by its strains: poses at the Gauss points and at the far end."""

    def __init__(self, state):
        c, b, a = gauss()
        ends = steps_of(state)
        h = np.diff(ends)
        self.S = ends[:-1, None] + h[:, None] * c
        self.weights = h[:, None] * b
        self.sections = state.at(self.S)
        strains = self.sections.strains
        # R_j = 1 + h sum_k a_jk R_k [K_k], a linear system for the transposes of the R_j of each step
        transposed = -cross_matrix(strains[..., 1:])
        system = -h[:, None, None, None, None] * np.einsum("jk,nkpq->njpkq", a, transposed)
        system = system.reshape(h.size, 3 * POINTS, 3 * POINTS) + np.eye(3 * POINTS)
        right = np.tile(np.eye(3), (h.size, POINTS, 1))
        local = np.linalg.solve(system, right).reshape(h.size, POINTS, 3, 3)
        rates = (1.0 + strains[..., :1]) * local[..., 2, :]
        turn = np.eye(3) + np.einsum("n,j,njpq,njqr->npr", h, b, transposed, local)
        moved = np.einsum("n,jk,nkp->njp", h, a, rates)
        moves = np.einsum("n,k,nkp->np", h, b, rates)
        R, r = matrix(state.quaternion[0]), np.array(state.position[0])
        turned, places = np.empty((h.size, 3, 3)), np.empty((h.size, 3))
        for i in range(h.size):
            turned[i], places[i] = R, r
            r = r + R @ moves[i]
            R = R @ turn[i].T
        self.position = places[:, None] + np.einsum("npq,njq->njp", turned, moved)
        self.directors = np.einsum("npq,njrq->njrp", turned, local)  # rows d1, d2, d3
        self.end = r, R


def misses(state):
    """The largest misses of a state: a dict of name to number, all of which ought to be tiny.

    strains: the law, as a change of eps and of curvatures times the length, backward; frame: positions over
    the length and directors; balance: force and M + r x N against the loads beyond, over the largest moment;
    start, end: the conditions there, of the frame that is integrated anew; energy: relative.
    """
    scene, frame = state.scene, Frame(state)
    length = scene.ribbon.length_ratio
    found = {"frame": _frame(state, frame, length), "strains": _law(scene, frame, length)}
    N, M = (
        np.einsum("njp,njpq->njq", v, frame.directors) for v in (frame.sections.force, frame.sections.moment)
    )
    ends = state.at([0.0, length])
    force, moment = (np.einsum("np,npq->nq", v, ends.directors) for v in (ends.force, ends.moment))
    unit = max(np.abs(M).max(), length * np.abs(N).max(), soft_of(scene))
    found["balance"] = _balance(scene, frame, N, M, force[1], moment[1], length) / unit
    r, R = frame.end
    found["start"] = _end(
        scene.start, pose(scene.start)[0], ends.position[0], ends.directors[0].T, None, None, length, unit
    )
    found["end"] = _end(scene.end, scene.places[1], r, R, force[1], moment[1], length, unit)
    found["energy"] = _energy(state, scene, frame, length)
    return found


def soft_of(scene):
    """The moment that bends the ribbon by about a radian."""
    EI2 = scene.law.EI2 if isinstance(scene.law, rb.LinearLaw) else scene.ribbon.thickness_ratio**2 / 12.0
    return EI2 / scene.ribbon.length_ratio


def _frame(state, frame, length):
    away = np.abs(frame.position - frame.sections.position).max() / length
    return max(away, np.abs(frame.directors - frame.sections.directors).max())


def _law(scene, frame, length):
    strains = frame.sections.strains.reshape(-1, 4)
    S = frame.S.ravel()
    resultants = np.column_stack([frame.sections.force[..., 2].ravel(), frame.sections.moment.reshape(-1, 3)])
    if isinstance(scene.law, rb.LinearLaw):
        away = strains - scene.law.intrinsic - np.array(scene.law.compliance) * resultants
        return np.max(np.abs(away) * np.array([1.0, length, length, length]))
    law = scene.section_law
    stiffness = np.abs(law.hessian(strains, S)) @ np.array([1.0, *(1.0 / length,) * 3])
    return np.max(np.abs(law.gradient(strains, S) - resultants) / stiffness)


def _balance(scene, frame, N, M, force, moment, length):
    """N and M less what loads beyond each section make of those at the end."""
    r, _ = frame.end
    p = np.array(scene.gravity)
    arm = frame.weights[..., None] * frame.position
    # integrals of r from each Gauss point to the far end
    a = gauss()[2]
    h = frame.weights.sum(axis=1)
    after = np.concatenate([np.cumsum(arm.sum(axis=1)[::-1], axis=0)[::-1][1:], np.zeros((1, 3))])
    inside = arm.sum(axis=1)[:, None] - np.einsum("n,jk,nkp->njp", h, a, frame.position)
    beyond = after[:, None] + inside
    rest = (length - frame.S)[..., None]
    expected_force = force + rest * p
    expected_moment = (
        moment + np.cross(r - frame.position, force) + np.cross(beyond - rest * frame.position, p)
    )
    return max(length * np.abs(N - expected_force).max(), np.abs(M - expected_moment).max())


def _end(end, place, r, R, force, moment, length, unit):
    away = np.abs(r - np.array(place)) / length
    match end:
        case rb.Clamped():
            return max(away.max(), np.abs(R - matrix(end.quaternion)).max())
        case rb.Free():
            return max(length * np.abs(force - end.force).max(), np.abs(moment - end.moment).max()) / unit
        case rb.Pinned():
            return max(away.max(), np.abs(moment - end.moment).max() / unit)
        case rb.Sliding():
            axis = np.array(end.axis)
            off = r - np.array(place)
            off = np.abs(off - axis * (axis @ off)).max() / length
            pull = length * abs(axis @ force - end.force) / unit
            return max(off, np.abs(R - matrix(end.quaternion)).max(), pull)
    raise TypeError(end)


def _energy(state, scene, frame, length):
    if isinstance(scene.law, rb.LinearLaw):
        resultants = np.concatenate([frame.sections.force[..., 2:], frame.sections.moment], axis=-1)
        density = 0.5 * resultants**2 @ np.array(scene.law.compliance)
    else:
        strains = frame.sections.strains
        density = scene.section_law.energy(strains.reshape(-1, 4), frame.S.ravel()).reshape(frame.S.shape)
    mean = float(np.sum(frame.weights * density)) / length
    return abs(mean - state.energy) / max(abs(mean), soft_of(scene) / length)
