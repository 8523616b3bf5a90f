"""The relaxed section of a ribbon whose edges grow, in numpy: as `auto/edge_law.f90`, many sections at once.

Functions are analytic, so complex steps give derivatives.
"""

from __future__ import annotations

from math import factorial
from typing import Any

import numpy as np

Array = np.ndarray[Any, Any]

TERMS = 12
P = np.array([4 * (k + 1) / factorial(4 * k + 6) for k in range(TERMS)])
Q = np.array([1 / factorial(4 * k + 1) for k in range(TERMS)])


def sigma(y: Array) -> tuple[Array, Array, Array]:
    """Return (1 - tau)/y and its first two derivatives, y = 9 (K2/eta)^2/4."""
    values = []
    for series in (P, Q):
        v, v1, v2 = series[-1] + 0 * y, 0 * y, 0 * y
        for coefficient in series[-2::-1]:
            v2 = v2 * y + 2 * v1
            v1 = v1 * y + v
            v = v * y + coefficient
        values.append((v, v1, v2))
    (u, u1, u2), (v, v1, v2) = values
    s = u / v
    s1 = (u1 - s * v1) / v
    return s, s1, (u2 - 2 * s1 * v1 - s * v2) / v


def relaxed(k2: Array, k3: Array, x: float) -> tuple[Array, ...]:
    """Return first and second derivatives (2, 3, 22, 23, 33) of k2^2/24 + sigma a^2/32."""
    s, s1, s2 = sigma(2.25 * k2**2)
    d, d2 = 4.5 * k2 * s1, 20.25 * k2**2 * s2 + 4.5 * s1
    a = k2**2 + 2 * k3**2 - 16 * x
    return (
        k2 / 12 + (d * a + 4 * s * k2) * a / 32,
        s * a * k3 / 4,
        1 / 12 + (d2 * a**2 + 8 * d * a * k2 + 8 * s * k2**2 + 4 * s * a) / 32,
        (d * a + 2 * s * k2) * k3 / 4,
        s * (a + 4 * k3**2) / 4,
    )


def section(strain: Array, x: float) -> tuple[Array, Array, Array]:
    """Return (n3, m1, m2, m3) (4, n) of strains (e, k1, k2, k3), and derivatives with these and with x."""
    e, k1, k2, k3 = strain
    f2, f3, f22, f23, f33 = relaxed(k2, k3, x)
    s, s1, _ = sigma(2.25 * k2**2)
    a, d = k2**2 + 2 * k3**2 - 16 * x, 4.5 * k2 * s1
    g = e + k3**2 / 24 - x / 3
    h = np.zeros((4, *strain.shape))
    h[0, 0], h[1, 1], h[2, 2] = 1.0, 1 / 12, f22
    h[0, 3] = h[3, 0] = k3 / 12
    h[2, 3] = h[3, 2] = f23
    h[3, 3] = 1 / 9 + g / 12 + k3**2 / 144 + f33
    hx = np.stack([0 * e - 1 / 3, 0 * e, -(d * a + 2 * s * k2), -4 * s * k3 - k3 / 36])
    return np.stack([g, k1 / 12, f2, k3 * (1 / 9 + g / 12) + f3]), h, hx


def inverse(wrench: Array, x: float, k: Array) -> tuple[Array, Array]:
    """Return strains (4, n) and compliances (4, 4, n) of (n3, m1, m2, m3), guessed (k2, k3) (2, n)."""
    k2, k3 = k
    twist = 1 / 9 + wrench[0] / 12
    for _ in range(40):
        f2, f3, f22, f23, f33 = relaxed(k2, k3, x)
        r2, r3, f33 = f2 - wrench[2], f3 + twist * k3 - wrench[3], f33 + twist
        determinant = f22 * f33 - f23**2
        step2, step3 = (f33 * r2 - f23 * r3) / determinant, (f22 * r3 - f23 * r2) / determinant
        k2, k3 = k2 - step2, k3 - step3
        if np.max(np.abs(step2) + np.abs(step3), initial=0.0) < 1e-8:
            break
    strain = np.stack([wrench[0] - k3**2 / 24 + x / 3, 12 * wrench[1], k2, k3])
    c = np.zeros((4, *strain.shape), dtype=strain.dtype)
    c[1, 1] = 12
    c[2, 2], c[3, 3] = f33 / determinant, f22 / determinant
    c[2, 3] = c[3, 2] = -f23 / determinant
    c[2:, 0] = c[0, 2:] = -c[2:, 3] * k3 / 12
    c[0, 0] = 1 - k3 / 12 * c[3, 0]
    return strain, c
