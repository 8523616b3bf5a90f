"""The planar elastica against its elliptic integrals."""

import math
from functools import cache

import numpy as np
import pytest
import ribbonrs as rb
from held import AXES, in_space, largest, rod, turn
from mpmath import mp, mpf

LENGTHS = np.linspace(0.0, 1.0, 9)
CLOSE = 1e-11
"""Ten times the tolerance of the solver, 1e-12: what is compared is of order one, or divided by its size."""


@cache
def exact(a):
    """Elastica of length 1, a = P L^2/EI: tangent angle, deflection, height and curvature at LENGTHS.

    With p sin phi = ((1 + sin theta)/2)^(1/2), u = F(phi, p^2) grows by a^(1/2) per unit of S.
    """
    with mp.workdps(30):
        root = mp.sqrt(mpf(a))

        def first(y):
            """Phi at the base and p^2, of a tip angle pi/2 - exp(-y)."""
            m = (1 + mp.cos(mp.exp(-y))) / 2
            return mp.asin(1 / mp.sqrt(2 * m)), m

        def excess(y):
            phi, m = first(y)
            return mp.ellipk(m) - mp.ellipf(phi, m) - root

        # from a tip angle of 1e-9 to one that only a far greater force reaches
        straight = -mp.log(mp.pi / 2 - mpf(10) ** -9)
        tip = mp.findroot(excess, (straight, root + 3), solver="illinois", tol=1e-48, maxsteps=200)
        phi, m = first(tip)
        start = mp.ellipf(phi, m)
        rows = []
        for S in LENGTHS:
            u = start + root * mpf(float(S))
            sn, cn = (mp.ellipfun(name, u, m=m) for name in ("sn", "cn"))
            # the amplitude stays within [0, pi/2]
            amplitude = mp.atan2(sn, cn)
            theta = mp.asin(2 * m * sn**2 - 1)
            deflection = mpf(float(S)) - 2 * (mp.ellipe(amplitude, m) - mp.ellipe(phi, m)) / root
            curvature = 2 * mp.sqrt(m) * root * cn
            height = 2 * mp.sqrt(m) / root * (mp.ellipfun("cn", start, m=m) - cn)
            rows.append([float(x) for x in (theta, deflection, height, curvature)])
        return np.array(rows).T


PRINTED = {
    1.0: (0.46135195, 0.056433236, 0.30172077),
    5.0: (1.2153681, 0.38762836, 0.71379152),
    10.0: (1.4302855, 0.55499560, 0.81060902),
}
"""P L^2/EI: tip angle, shortening and deflection over L (Mattiasson 1981)."""


@pytest.mark.parametrize("a", PRINTED)
def test_the_integrals_and_the_solver_give_the_printed_values(a):
    theta, deflection, height, _ = exact(a)[:, -1]
    # eight digits are printed
    assert (theta, 1.0 - height, deflection) == pytest.approx(PRINTED[a], rel=5e-8)
    state = rb.solve(rod(end=rb.Free(force=(a, 0.0, 0.0))))
    x, _, z = state.position[-1]
    tip = math.acos(state.directors[-1, 2, 2])
    assert (tip, 1.0 - z, x) == pytest.approx(PRINTED[a], rel=5e-8)


@pytest.mark.parametrize("a", [0.1, 1.0, 5.0, 10.0, 40.0, 200.0])
@pytest.mark.parametrize("plane", [0, 1])
def test_cantilever(a, plane):
    theta, deflection, height, curvature = exact(a)
    # stiffer across the plane, so that it does not turn over
    law = rb.LinearLaw(EI1=(3.0, 1.0)[plane], EI2=(1.0, 3.0)[plane], GJ=0.4, inextensible=True)
    state = rb.solve(rod(law=law, end=rb.Free(force=a * AXES[plane])), tol=1e-12)
    at = state.at(LENGTHS)
    sideways = AXES[plane]
    assert largest(at.position - np.outer(deflection, sideways) - np.outer(height, AXES[2])) < CLOSE
    tangent = np.outer(np.sin(theta), sideways) + np.outer(np.cos(theta), AXES[2])
    assert largest(at.directors[:, 2] - tangent) < CLOSE
    # bending towards E1 is K2 > 0, towards E2 it is K1 < 0
    bending = (at.strains[:, 2], -at.strains[:, 1])[plane]
    assert largest(bending - curvature) < CLOSE * max(1.0, curvature[0])
    base = state.reactions.start
    assert largest(base.force + a * sideways) < CLOSE * a
    axis = np.cross(AXES[2], sideways)
    assert largest(base.moment + curvature[0] * axis) < CLOSE * a
    assert largest(in_space(at, "moment") - np.outer(curvature, axis)) < CLOSE * a


@pytest.mark.parametrize("held", ["start", "end"])
@pytest.mark.parametrize("seed", range(4))
def test_rotated_clamp_at_either_end(held, seed):
    rng = np.random.default_rng(seed)
    rotvec, origin, a = rng.normal(size=3), rng.normal(size=3), float(rng.uniform(0.5, 30.0))
    R = turn(rotvec)
    theta, deflection, height, curvature = exact(a)
    clamp, tip = rb.Clamped(origin, rotvec), rb.Free(force=a * R[:, 0])
    if held == "start":
        state = rb.solve(rod(start=clamp, end=tip), tol=1e-12)
        sign, wrench = 1.0, state.reactions.start
    else:  # the ribbon comes in from the other side: backwards along d3
        state = rb.solve(rod(start=tip, end=clamp), tol=1e-12)
        sign, wrench = -1.0, state.reactions.end
    at = state.at(LENGTHS if held == "start" else 1.0 - LENGTHS)
    place = origin + np.outer(deflection, R[:, 0]) + sign * np.outer(height, R[:, 2])
    assert largest(at.position - place) < CLOSE
    tangent = sign * np.outer(np.sin(theta), R[:, 0]) + np.outer(np.cos(theta), R[:, 2])
    assert largest(at.directors[:, 2] - tangent) < CLOSE
    assert largest(at.strains[:, 2] - curvature) < CLOSE * max(1.0, curvature[0])
    assert largest(wrench.moment + sign * curvature[0] * R[:, 1]) < CLOSE * a
    assert largest(wrench.force + a * R[:, 0]) < CLOSE * a


def test_stretch_of_an_extensible_elastica():
    # theta'^2/2 = f(theta_L) - f(theta) with f = a sin + b (a sin)^2/2, b = EI/(EA L^2), by quadrature
    a, b = 6.0, 0.01
    with mp.workdps(25):

        def f(theta):
            return a * mp.sin(theta) + mpf(b) / 2 * (a * mp.sin(theta)) ** 2

        def rate(tip, v):
            """dS/dv and theta; theta = tip (1 - v^2) takes the singularity at the tip away."""
            theta = tip * (1 - v * v)
            # f(tip) - f(theta) over v^2, without cancellation
            half = tip * v * v / 2
            sines = 2 * mp.cos(tip - half) * (mp.sin(half) / (v * v))
            rise = a * sines * (1 + mpf(b) / 2 * a * (mp.sin(tip) + mp.sin(theta)))
            return 2 * tip / mp.sqrt(2 * rise), theta

        def length(tip):
            return mp.quad(lambda v: rate(tip, v)[0], [0, 1])

        def deflection(v):
            slope, theta = rate(tip, v)
            return slope * mp.sin(theta) * (1 + b * a * mp.sin(theta))

        tip = mp.findroot(lambda angle: length(angle) - 1, (1.2, 1.3), solver="secant")
        x = float(mp.quad(deflection, [0, 1]))
        base = float(mp.sqrt(2 * f(tip)))
        tip = float(tip)
    law = rb.LinearLaw(EA=1.0 / b, EI1=1.0, EI2=1.0, GJ=1.0)
    state = rb.solve(rod(law=law, end=rb.Free(force=(a, 0.0, 0.0))), tol=1e-12)
    assert state.position[-1, 0] == pytest.approx(x, abs=CLOSE)
    assert math.asin(state.directors[-1, 2, 0]) == pytest.approx(tip, abs=CLOSE)
    assert state.strains[0, 2] == pytest.approx(base, abs=CLOSE * base)
    assert state.strains[-1, 0] == pytest.approx(b * a * math.sin(tip), abs=CLOSE)
