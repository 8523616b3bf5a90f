"""How the energy converges for growth that jumps and for growth given by samples.

    python docs/figures/convergence.py        writes convergence.png beside this file

Left: a step of axial growth. The exact solution is the reference of the tests
(tests/python/exact_pieces.py), 50 digits; against it the Legendre basis of the whole width with n functions,
with and without the energy of what it leaves out, the finite-difference relaxation of the tests with n cells,
and this package, whose n is the number of modes, 12. Right: smooth growth given by n samples, joined by lines
or by a spline, against the function.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import ribbonrs as rb
from numpy.polynomial.legendre import Legendre

sys.path.insert(0, str(Path(__file__).parents[2] / "tests" / "python"))
from exact_pieces import Exact
from relaxation import discrete, functions

ETA = 0.1
STRAIN = [0.01, 0.0, 5 * ETA, ETA]
STEP, AT = 0.02, 0.1
FIELDS = {"gamma33": [[0.0], [STEP]]}
INCOMPRESSIBLE = (4 / 3, 4 / 3, 2 / 3, 1 / 3)
SIZES = [4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128, 192, 256, 384, 512]
SAMPLES = [6, 8, 11, 16, 23, 32, 45, 64, 91, 128, 181, 256, 362, 512]


def double_integral(n: int) -> Any:
    """The deflections (n + 2, n) of the curvatures p_0 .. p_{n-1}, orthonormal Legendre polynomials of 2x."""
    F = np.zeros((n + 2, n))
    for j in range(n):
        if j >= 2:
            F[j, j] = -0.5 / ((2 * j + 3) * (2 * j - 1))
            F[j - 2, j] = 0.25 / ((2 * j - 1) * np.sqrt((2 * j - 3) * (2 * j + 1)))
        F[j + 2, j] = 0.25 / ((2 * j + 3) * np.sqrt((2 * j + 1) * (2 * j + 5)))
    F[:2] = 0.0
    return F


def legendre_energy(n: int, keep: bool) -> float:
    """The energy with n Legendre polynomials of the whole width; `keep` the mismatch they do not hold."""
    eps, _, K2, K3 = STRAIN
    beta2, nu = 1 / 9, 0.5
    t = 2 * AT
    # Coefficients of the step, from int P_k = (P_{k+1} - P_{k-1})/(2k+1).
    above = [Legendre.basis(k)(t) for k in range(n + 3)]
    step = [STEP * (1 - t) / 2] + [
        STEP * np.sqrt(2 * k + 1) * (above[k - 1] - above[k + 1]) / (2 * (2 * k + 1)) for k in range(1, n + 2)
    ]
    w = -np.array(step)
    w[2] += (K3**2 + nu * K2**2) / (12 * np.sqrt(5))
    mean, slope = eps + K3**2 / 24 + w[0], w[1]
    w[:2] = 0.0
    rest = STEP**2 * (0.5 - AT) - sum(c * c for c in step)
    k = K2 / ETA
    relaxed = w @ np.linalg.solve(np.eye(n + 2) + k**2 / beta2 * double_integral(n) @ double_integral(n).T, w)
    bending = ETA**2 * (K2**2 / 24 + K3**2 / 18)
    return 0.5 * (mean**2 + slope**2 + relaxed + (rest if keep else 0.0)) + bending


def step_errors() -> dict[str, tuple[list[int], list[float]]]:
    """Numbers of unknowns and relative errors of the energy of a step."""
    exact = Exact(ETA, [AT], FIELDS, INCOMPRESSIBLE)(STRAIN).energy

    def error(energy: float) -> float:
        return float(abs(energy - exact) / exact)

    law = rb.SectionLaw(ETA, rb.growth.Profile(gamma33=FIELDS["gamma33"], breaks=[AT]))
    shares = [(n, [round(0.6 * n), n - round(0.6 * n)]) for n in SIZES]
    grids = [discrete(ETA, [AT], functions(FIELDS), STRAIN, INCOMPRESSIBLE, cells) for _, cells in shares]
    return {
        "finite differences": (SIZES, [error(grid.energy) for grid in grids]),
        "Legendre, truncated": (SIZES, [error(legendre_energy(n, False)) for n in SIZES]),
        "Legendre, with the rest": (SIZES, [error(legendre_energy(n, True)) for n in SIZES]),
        "ribbonrs": ([12], [error(float(law.energy(STRAIN)))]),
    }


def sampled_errors() -> dict[str, tuple[list[int], list[float]]]:
    """Numbers of samples and relative errors of the energy of smooth growth."""

    def growth(x: Any) -> Any:
        return 0.03 * np.cos(2 * np.pi * x) + 0.01 * np.sin(5 * x)

    def energy(given: Any, spline: bool = False) -> float:
        return float(rb.SectionLaw(ETA, rb.growth.Profile(gamma33=given, spline=spline)).energy(STRAIN))

    exact = energy(growth)
    errors: dict[str, tuple[list[int], list[float]]] = {}
    for name, spline in (("joined by lines", False), ("cubic spline", True)):
        grids = [np.linspace(-0.5, 0.5, n) for n in SAMPLES]
        errors[name] = (SAMPLES, [abs(energy((x, growth(x)), spline) / exact - 1) for x in grids])
    return errors


def main() -> None:
    """Print the errors and draw them."""
    figure, axes = plt.subplots(1, 2, figsize=(8.0, 3.4), sharey=True, layout="constrained")
    colours = ["#0072B2", "#E69F00", "#009E73", "#D55E00"]
    titles = ("a step: unknowns", "smooth growth: samples")
    for axis, title, all_errors in zip(axes, titles, (step_errors(), sampled_errors()), strict=True):
        for (name, (sizes, errors)), colour in zip(all_errors.items(), colours, strict=False):
            print(title, "|", name, "|", *(f"{n}: {e:.1e}" for n, e in zip(sizes, errors, strict=True)))
            marker = "*" if len(sizes) == 1 else "."
            axis.loglog(
                sizes,
                np.maximum(errors, 1e-17),
                marker=marker,
                ms=12 if marker == "*" else 6,
                ls="none" if marker == "*" else "-",
                color=colour,
                label=name,
            )
        axis.set_xlabel(title)
        axis.set_ylim(1e-22, 1.0)
        axis.legend(fontsize=8, loc="lower right")
        axis.grid(alpha=0.3)
    axes[0].set_ylabel("relative error of the energy")
    figure.savefig(Path(__file__).with_suffix(".png"), dpi=150)


if __name__ == "__main__":
    main()
