"""What the outputs of the scenes are: closed forms, elliptic integrals, and shooting to 1e-13.

    python benches/peers/reference.py      writes reference.csv beside this file

The order of the outputs is that in `scenes.py`; positions are over L.
"""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Any

import mpmath as mp
import numpy as np
from rod import field
from scenes import canonical, grown, strip
from scipy.integrate import solve_ivp

Array = np.ndarray[Any, Any]
STEP = 1e-30
"""Of complex steps."""

MAX_STEP = 0.02
"""Of the integration, whose control of errors does not see the derivatives."""


def s1() -> Array:
    """Thresholds of bending and twist, (eps, K2) at xi = 8 eta^2, and where the circular arc ends."""
    eta, x, length = mp.mpf("0.1"), 8, 10

    def energy(k2: Any) -> Any:
        z = mp.sqrt(3 * k2 / 2)
        tau = 2 / z * (mp.cosh(z) - mp.cos(z)) / (mp.sinh(z) + mp.sin(z))
        return k2**2 / 24 + (1 - tau) / z**4 * (k2**2 - 16 * x) ** 2 / 32

    with mp.workdps(40):
        k2 = mp.findroot(lambda k: mp.diff(energy, k), 4.9)
        eps, angle = mp.mpf(x) / 3 * eta**2, k2 * eta * length
        end = (1 + eps) * (1 - mp.cos(angle)) / angle, (1 + eps) * mp.sin(angle) / angle
        values = (mp.sqrt(259) - 7) / 2, mp.mpf(5), k2, *end
        return np.array([float(value) for value in values])


def s3() -> Array:
    """Euler's load, and the tip (across, along) at P L^2 = 10 EI by elliptic integrals."""
    with mp.workdps(40):
        k = mp.findroot(lambda k: mp.ellipk(k**2) - mp.sqrt(10), (0.9, 0.999), solver="illinois", tol=1e-60)
        along = 2 * mp.ellipe(k**2) / mp.sqrt(10) - 1
        return np.array([float(v) for v in (mp.pi**2 / 4, 2 * k / mp.sqrt(10), along)])


def shot(start: Array, n: Array, c: Array, law: Any, places: Any = (1.0,)) -> Array:
    """Return states (7, p, places) along rods with wrenches (3, p) from the clamp."""
    p = n.shape[1]
    complex_start = np.repeat(start[:, None], p, axis=1).astype(complex)

    def rate(_: float, u: Array) -> Array:
        return field(u.reshape(7, p), n, c, law)[0].ravel()

    solution = solve_ivp(
        rate,
        (0.0, 1.0),
        complex_start.ravel(),
        method="DOP853",
        rtol=1e-13,
        atol=1e-14,
        max_step=MAX_STEP,
        t_eval=places,
    )
    return solution.y.reshape(7, p, len(places))


CLAMP = np.array([0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0])


def solved(residual: Any, w: Array) -> tuple[Array, Array]:
    """Return a zero of a function of (m, p) unknowns, and its Jacobian there, by Newton's method."""
    small = False
    for _ in range(20):
        steps = np.concatenate([np.zeros((w.size, 1)), 1j * STEP * np.eye(w.size)], axis=1)
        values = residual(w[:, None] + steps)
        jacobian = values[:, 1:].imag / STEP
        # At a bifurcation one direction is left alone, and beside it rounding limits it.
        change = np.linalg.lstsq(jacobian, values[:, 0].real, rcond=1e-8)[0]
        w = w - change
        if small:
            return w, jacobian
        small = bool(np.max(np.abs(change) / (1 + np.abs(w))) < 1e-6)
    raise ArithmeticError(f"shooting does not converge, {change}")


def singular(equations: Any, guess: Array, first: float, second: float) -> float:
    """Return the parameter near two others at which the Jacobian of equations(parameter, w) is singular."""

    def determinant(parameter: float) -> float:
        guess[:], jacobian = solved(partial(equations, parameter), guess)
        return float(np.linalg.det(jacobian))

    values = determinant(first), determinant(second)
    for _ in range(12):
        third = second - values[1] * (second - first) / (values[1] - values[0])
        first, second, values = second, third, (values[1], determinant(third))
        if abs(second - first) < 1e-9 * abs(second):  # the next step would be below rounding
            return second
    raise ArithmeticError("no bifurcation found")


def s2() -> Array:
    """Lateral buckling load, in sqrt(EI2 GJ)/L^2, and at twice that the end and the moment at the clamp.

    Signs of what is sideways are those of either of two mirror images, and left out.
    """

    def unbalanced(p: float, w: Array) -> Array:
        zero = 0 * w[0]
        end = shot(CLAMP, np.stack([zero, zero - p, zero]), np.stack([w[0], zero, w[1]]), strip)[:, :, 0]
        return np.stack([w[0] - p * end[2], w[1] + p * end[0]])

    critical = singular(unbalanced, np.array([4.07, 0.0]), 4.06, 4.07)
    w, _ = solved(partial(unbalanced, 2 * critical), np.array([4.94, 3.75]))
    c = np.array([[w[0]], [0.0], [w[1]]])
    end = shot(CLAMP, np.array([[0.0], [-2 * critical], [0.0]]), c, strip)[:3, 0, 0].real
    return np.array([critical, abs(end[0]), end[1], end[2], w[0], abs(w[1])])


def s4() -> Array:
    """Distance of the clamps at the bifurcation; N, C and middle of the state without symmetry at 0.9."""

    def misses(z: float, w: Array) -> Array:
        end = shot(CLAMP, w[:3], w[3:], partial(grown, np.zeros((2, w.shape[1]))))[:, :, 0]
        return np.concatenate([end[:2], end[2:3] - z, end[3:6]])

    critical = singular(misses, np.array([0.9, 0.0, -10.2, 0.49, 0.45, 0.29]), 0.9629, 0.9633)
    w, _ = solved(partial(misses, 0.9), np.array([0.00946, -0.7812, -5.9582, 0.76473, -0.37478, 0.53466]))
    middle = shot(CLAMP, w[:3, None], w[3:, None], partial(grown, np.zeros((2, 1))), (0.5,))[:3, 0, 0].real
    return np.array([critical, *canonical(w[:3], w[3:], middle)])


def main() -> None:
    """Write the outputs of every scene."""
    lines = [",".join([f.__name__, *(repr(v) for v in f().tolist())]) for f in (s1, s2, s3, s4)]
    Path(__file__).with_suffix(".csv").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
