"""The section law far outside what shapes need, against closed forms in 64-bit mantissas.

sigma of z^4 = w is a quotient of two series with positive terms only,

    sigma = sum_{k>0} 4k w^(k-1)/(4k+2)! / sum_{k>=0} w^k/(4k+1)!,

for sinh z + sin z and cosh z - cos z have every fourth term of twice the exponential; above z = 6 it is the
quotient of the functions themselves. Derivatives are complex steps.
"""

from __future__ import annotations

from math import factorial

import numpy as np
from ribbonrs._core import SectionLaw

from .row import Row

INCOMPRESSIBLE = (4 / 3, 4 / 3, 2 / 3, 1 / 3)
STEP = np.longdouble("1e-60")
"""Of the complex steps: nothing is subtracted, so that only its square must vanish."""

ALLOWED = {"energy": 3e-15, "gradient": 3e-15, "hessian": 1e-13}
"""Relative errors, of the scales below: a dozen roundings of values, a few hundred of second derivatives."""


def sigma(w):
    """Sigma and its derivative at complex w = z^4 of any size."""
    z = np.sqrt(np.sqrt(w))
    small = z.real < 6.0
    value, slope = np.empty_like(w), np.empty_like(w)
    value[small], slope[small] = quotient_of_series(w[small])
    value[~small], slope[~small] = quotient_of_functions(z[~small])
    return value, slope


def quotient_of_series(w):
    """For z < 6: 16 terms leave less than 1e-30."""
    above = [np.longdouble(4 * k) / np.longdouble(factorial(4 * k + 2)) for k in range(1, 17)]
    below = [1 / np.longdouble(factorial(4 * k + 1)) for k in range(17)]

    def series(c):
        value, slope = np.zeros_like(w), np.zeros_like(w)
        for coefficient in reversed(c):
            slope = slope * w + value
            value = value * w + coefficient
        return value, slope

    (a, da), (b, db) = series(above), series(below)
    return a / b, (da - a / b * db) / b


def quotient_of_functions(z):
    """With exp(-z) divided out."""
    decay = np.exp(-z)
    bottom = 0.5 * (1 - decay**2) + decay * np.sin(z)
    f = (0.5 * (1 + decay**2) - decay * np.cos(z)) / bottom
    g = (0.5 * (1 + decay**2) + decay * np.cos(z)) / bottom
    tau = 2 / z * f
    slope = -tau / z + 2 / z * (1 - f * g)
    value = (1 - tau) / z**4
    return value, (-slope / z**4 - 4 * value / z) / (4 * z**3)


def energy(eta, growth, e):
    """Pi of strains (4, n), complex, for edge growth, chirality and gradients along and across."""
    xi, d, along, across = growth
    eps, K1, K2, K3 = e
    W = K3**2 + K2 * (K2 / 2 + along / 2 + across) - 8 * xi
    soft = sigma(9 * (K2 / (2 * eta)) ** 2)[0] / 8 * W**2
    bending = eta**2 / 24 * (K2 + along) ** 2 + eta**2 / 18 * (K3 - d / 2) ** 2
    return (eps + K3**2 / 24 - xi / 3) ** 2 / 2 + K1**2 / 24 + bending + soft


def gradient(eta, growth, e):
    """dPi/d(eps, K1, K2, K3) of strains (4, n), complex."""
    xi, d, along, across = growth
    eps, K1, K2, K3 = e
    W = K3**2 + K2 * (K2 / 2 + along / 2 + across) - 8 * xi
    s, ds = sigma(9 * (K2 / (2 * eta)) ** 2)
    A = eps + K3**2 / 24 - xi / 3
    m2 = (
        eta**2 / 12 * (K2 + along)
        + s / 4 * W * (K2 + along / 2 + across)
        + ds * 9 * K2 / (16 * eta**2) * W**2
    )
    m3 = A * K3 / 12 + eta**2 / 9 * (K3 - d / 2) + s / 2 * W * K3
    return np.stack([A, K1 / 12, m2, m3])


def by_complex_steps(function, eta, growth, strains):
    """Derivatives of function of strains (4, n) in each direction: appended as a last axis of four."""
    parts = []
    for i in range(4):
        moved = strains.astype(np.clongdouble)
        size = np.maximum(np.abs(strains[i]), eta)
        moved[i] += 1j * STEP * size
        parts.append(function(eta, growth, moved).imag / (STEP * size))
    return np.stack(parts, axis=-1)


def samples(rng, eta, n, largest):
    """Strains (4, n): K2/eta 0, subnormal, and from 1e-20 to `largest`; the others of sizes that matter."""
    k = rng.normal(size=(4, n)) * 10.0 ** rng.uniform(-2.0, 2.0, (4, n))
    k[2] = rng.choice([-1.0, 1.0], n) * 10.0 ** rng.uniform(-20.0, np.log10(largest), n)
    k[2, ::7] = rng.choice([-1.0, 1.0], k[2, ::7].size) * 10.0 ** rng.uniform(-3.0, 3.0, k[2, ::7].size)
    strains = k * np.array([eta**2, eta**2, eta, eta])[:, None]
    strains[2, ::50] = 0.0
    strains[2, 1::50] = 5e-324 * rng.integers(1, 1000, strains[2, 1::50].size)
    return strains


def random_growth(rng, eta):
    """Edge growth up to 1e6 eta^2 of both signs, and gradients up to 1e2 eta."""
    xi = rng.choice([-1.0, 1.0]) * 10.0 ** rng.uniform(-3.0, 6.0) * eta**2
    return xi, *(rng.normal(size=3) * eta * 10.0 ** rng.uniform(-3.0, 2.0, 3))


def law_of(eta, growth, form):
    """The compiled law."""
    xi, d, along, across = growth
    fields = {"gamma33": [0.0, 0.0, 4.0 * xi], "d23": [d], "d33": [along], "d22": [across]}
    return SectionLaw(eta, INCOMPRESSIBLE, [(1.0, fields)], form)


def errors(law, eta, growth, strains):
    """The largest relative errors of energy, gradient and Hessian at strains (4, n)."""
    exact = strains.astype(np.clongdouble)
    h, terms = np.longdouble(eta), tuple(map(np.longdouble, growth))
    Pi = energy(h, terms, exact).real
    g = by_complex_steps(energy, h, terms, strains)
    H = np.moveaxis(by_complex_steps(gradient, h, terms, strains), 0, 1)
    rows = np.ascontiguousarray(strains.T)
    stiffness = np.abs(np.einsum("nii->ni", H)) + np.array([1, 1 / 12, h**2 / 12, h**2 / 9])
    # the terms of the second derivative in K2 cancel where it passes through zero, at K2/eta = 4.307 for one
    stiffness[:, 2] += 2 * Pi / (strains[2] ** 2 + h**2)
    # the square of the rounding of the growth and of the strains
    squares = 1e-32 * (terms[0] ** 2 + strains[3] ** 4 + strains[2] ** 4)
    gradient_scale = np.abs(g) + np.sqrt(2 * (Pi + squares)[:, None] * stiffness)
    hessian_scale = np.abs(H) + np.sqrt(stiffness[:, :, None] * stiffness[:, None, :])
    return {
        "energy": worst(law.energy(rows), Pi, Pi + squares),
        "gradient": worst(law.gradient(rows), g, gradient_scale),
        "hessian": worst(law.hessian(rows), H, hessian_scale),
    }


def worst(found, exact, scale):
    """The largest error over its scale; infinite if a number is not finite."""
    if not np.all(np.isfinite(found)):
        return np.inf
    return float(np.max(np.abs(found - exact) / scale))


def rows(laws=1000, n=1000):
    """Random laws at random strains, closed form to K2/eta = 1e8 and modes to 1e6."""
    for form, largest in (("closed", 1e8), ("general", 1e6)):
        rng = np.random.default_rng(7)
        found = dict.fromkeys(ALLOWED, 0.0)
        for _ in range(laws):
            eta = float(10.0 ** rng.uniform(-6.0, np.log10(0.5)))
            growth = random_growth(rng, eta)
            law = law_of(eta, growth, form)
            for name, error in errors(law, eta, growth, samples(rng, eta, n, largest)).items():
                found[name] = max(found[name], error)
        for name, error in found.items():
            what = f"{form} form, {name}, K2/eta to {largest:.0e}"
            yield Row("section law", what, laws * n, error, ALLOWED[name], "relative")
