"""The formulas of Liu, Li & Liu's section 3 as they are printed, slips and all.

In units a = 1, Y_e = 1, h = eta: curvatures K, deflections U = u1/a, energies Pi = W/(Y_e h a). What is
printed of the absolute value or the sign of a curvature is kept; a root of a negative number is NaN.
"""

from __future__ import annotations

import numpy as np

from ..arrays import Array

__all__ = [
    "edge_deflection",
    "edge_energy",
    "gradient_second_order",
    "second_order",
    "thickness_deflection",
    "thickness_energy",
    "twist_of",
]


def _shape(x: Array, K2: float, eta: float) -> Array:
    """What multiplies the amplitude in eqs. (47) and (55), without sign(K2), at X2 = x."""
    q = np.sqrt(3.0 * abs(K2) / (2.0 * eta))
    c, s, ch, sh = np.cos(q / 2.0), np.sin(q / 2.0), np.cosh(q / 2.0), np.sinh(q / 2.0)
    first = (ch * s - c * sh) * np.cos(q * x) * np.cosh(q * x)
    second = (ch * s + c * sh) * np.sin(q * x) * np.sinh(q * x)
    shape: Array = (first - second) / (2.0 * q**2 * (np.sin(q) + np.sinh(q)))
    return shape


def _ratio(K2: float, eta: float) -> float:
    """(cos aq - cosh aq)/(sin aq + sinh aq), in eqs. (50) and (58)."""
    q = np.sqrt(3.0 * abs(K2) / (2.0 * eta))
    return float((np.cos(q) - np.cosh(q)) / (np.sin(q) + np.sinh(q)))


def _power(base: float, exponent: float) -> float:
    """A power that is NaN where it is not real."""
    return base**exponent if base >= 0.0 else np.nan


def thickness_deflection(x: Array, K2: float, eta: float, sign: bool = True) -> Array:
    """Eq. (48), the deflection under a gradient through the thickness; or it without its sign(kappa2)."""
    return _shape(x, K2, eta) * K2 / (np.sign(K2) if sign else 1.0)


def thickness_energy(K2: float, eta: float, xi: float) -> float:
    """Eqs. (49)-(50) at eps = K1 = 0."""
    V = eta**2.5 * _power(K2 * (K2 + 2.0 * xi), 0.5) / (18.0 * 6.0**0.5) * _ratio(K2, eta)
    return float(eta**2 / 18.0 * (K2 + xi) ** 2 + V)


def edge_deflection(x: Array, strain: Array, eta: float, xi: float, sign: bool = True) -> Array:
    """Eq. (56), the deflection under growth of the edges, T read as X2; or it without its sign(kappa2)."""
    _, _, K2, K3 = strain
    amplitude = (K2**2 + 2.0 * K3**2 - 16.0 * xi) / K2
    particular = (12.0 * x**2 - 1.0) * (K3**2 - 8.0 * xi) / (24.0 * K2)
    deflection: Array = _shape(x, K2, eta) * amplitude / (np.sign(K2) if sign else 1.0) + particular
    return deflection


def edge_energy(strain: Array, eta: float, xi: float) -> float:
    """Eqs. (57)-(58) at one strain."""
    eps, K1, K2, K3 = strain.tolist()
    crown = K2**2 + 2.0 * K3**2 - 16.0 * xi
    V = eta**2.5 * crown**2 / (18.0 * 6.0**0.5 * _power(K2, 2.5)) * _ratio(K2, eta)
    linear = (xi - 6.0 * eps) / 9.0 + 64.0 * eta**2 * xi / (9.0 * K2**2)
    linear -= 8.0 * eta**2 * (K2**2 + 2.0 * K3**2) / (9.0 * K2**2) + K3**2 / 36.0
    stretch = (eps + K3**2 / 24.0) ** 2 / 2.0 + K1**2 / 24.0
    return float(stretch + eta**2 / 18.0 * (K2**2 + K3**2) ** 2 / K2**2 + linear * xi / 2.0 + V)


def second_order(strains: Array, eta: float, xi: float) -> Array:
    """Eq. (59): energies (...) at strains (..., 4)."""
    eps, K1, K2, K3 = np.moveaxis(strains, -1, 0)
    soft = (K3**2 + 60.0 * eta**2 - 8.0 * xi) / 1440.0 - (K3**2 - 8.0 * xi) ** 2 / (80640.0 * eta**2)
    uniform = (eps + K3**2 / 24.0) ** 2 / 2.0 + K1**2 / 24.0 + K3**4 / 1440.0
    uniform = uniform + K3**2 / 360.0 * (20.0 * eta**2 - 9.0 * xi) - eps * xi / 3.0 + xi**2 / 10.0
    energies: Array = uniform + K2**2 * soft
    return energies


def gradient_second_order(strains: Array, eta: float, xi: float) -> Array:
    """Eq. (61): n3, m1, m2, m3 (..., 4) at strains (..., 4)."""
    eps, K1, K2, K3 = np.moveaxis(strains, -1, 0)
    soft = (K3**2 + 60.0 * eta**2 - 8.0 * xi) / 720.0 - (K3**2 - 8.0 * xi) ** 2 / (40320.0 * eta**2)
    linear = eps / 12.0 + eta**2 / 9.0 - xi / 20.0 + K2**2 * (1.0 / 720.0 + xi / (2520.0 * eta**2))
    m3 = K3 * linear + K3**3 * (1.0 / 160.0 - K2**2 / (20160.0 * eta**2))
    return np.stack([K3**2 / 24.0 + eps - xi / 3.0, K1 / 12.0, K2 * soft, m3], axis=-1)


def twist_of(eta: float, xi: float) -> float:
    """Eq. (64), the twist of an unloaded ribbon."""
    return float(2.0 * 2.0**0.5 * (xi - 5.0 * eta**2) ** 0.5)
