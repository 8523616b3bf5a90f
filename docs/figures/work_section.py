"""Error against time of the energy of one section.

    python docs/figures/work_section.py        writes work_section.csv and work_section.png beside this file

Edge growth xi = 6 eta^2, eta = 0.1, eps = K1 = 0; in each panel sections with |K2| within a tenth of what
it says and |K3| up to 3 eta. The error is the largest relative one of 40 sections, against the printed
formula, Liu, Li & Liu, eqs. (57) and (58), with as many digits as its cancellation costs
(tests/python/reference.py). The time is that of a section, in arrays of 4,000, which one thread does; of
finite differences, of one. The sum over a given number of modes is this package's formula in numpy, which
tells of the number of modes and not of its run time.
"""

from __future__ import annotations

import sys
from functools import cache, partial
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from measure import FLOOR, FOLDER, seconds, write
from printed_formulas import INCOMPRESSIBLE, printed
from ribbonrs._core import SectionLaw
from ribbonrs.figures.style import COLOURS, INK, PAGE, new_figure, styled
from scipy.linalg import LinAlgError, solveh_banded

sys.path.insert(0, str(Path(__file__).parents[2] / "tests" / "python"))
from reference import twist

Array = np.ndarray[Any, Any]
ETA, XI = 0.1, 0.06
BENDING = (0.01, 1.0, 20.0, 400.0)
MANY, CHECKED = 4_000, 40
MODES = (4, 8, 16, 32, 64)
CELLS = (8, 16, 32, 64, 128, 256, 512, 1024, 2048, 4096)
FORMS = {"closed": "closed form", "general": "general form", "second-order": "second order in $K_2$, (59)"}


def strains(bending: float) -> Array:
    """Strains (MANY, 4) of sections about |K2| = bending eta."""
    rng = np.random.default_rng(7)
    K2 = bending * ETA * rng.uniform(0.9, 1.1, MANY)
    K3 = 3.0 * ETA * rng.uniform(-1.0, 1.0, MANY)
    return np.column_stack([np.zeros((MANY, 2)), K2, K3])


@cache
def table(modes: int) -> tuple[Array, Array, float]:
    """Singular values of so many even functions, what the parabola has of each, and its size."""
    n = 2.0 * np.arange(modes)
    off = 0.25 / ((2 * n + 3) * np.sqrt((2 * n + 1) * (2 * n + 5)))
    F = np.diag(off) + np.diag(-0.5 / ((2 * n[1:] + 3) * (2 * n[1:] - 1)), -1) + np.diag(off[1:-1], -2)
    _, sigma, right = np.linalg.svd(F)
    return sigma, right[:, 0], float(off[0])


def modal(modes: int, strain: Array) -> Array:
    """The energies with so many even modes of the section: a sum of squares over singular values."""
    sigma, parts, size = table(modes)
    K2, K3 = strain[:, 2], strain[:, 3]
    mismatch = (K3**2 + K2**2 / 2 - 8 * XI) * size
    k2 = 9.0 * (K2 / ETA) ** 2
    relaxed = sum(c**2 / (1.0 + s**2 * k2) for c, s in zip(parts, sigma, strict=True))
    stiff = (K3**2 / 24 - XI / 3) ** 2 / 2 + ETA**2 * (K2**2 / 24 + K3**2 / 18)
    return np.asarray(stiff + mismatch**2 * relaxed / 2)


def differences(cells: int, strain: Array) -> float:
    """The least energy of one section on a grid of equal cells: normal equations with five diagonals.

    1/2 int (P - K2 U)^2 + (eta^2/18) int (U'' + K2/2)^2, P free of its components on 1 and x, by the
    trapezoidal rule and central differences; U'' + K2/2 vanishes at the edges. The energy is of order 2.
    """
    _, _, K2, K3 = strain
    x = np.linspace(-0.5, 0.5, cells + 1)
    h = 1.0 / cells
    weight = np.full(cells + 1, h)
    weight[[0, -1]] /= 2
    P = K3**2 * (x**2 - 1 / 12) / 2 - 4 * XI * (x**2 - 1 / 12)
    # D^T D of second differences D, in the upper form of scipy, and D^T (1, ..., 1).
    bands = np.array([1.0, -4.0, 6.0])[:, None] * np.ones(cells + 1)
    bands[1, [1, -1]] = -2.0
    bands[2, [0, 1, -2, -1]] = 1.0, 5.0, 5.0, 1.0
    bands *= ETA**2 / 9 / h**3
    bands[2] += weight * K2**2
    right = weight * K2 * P
    right[[0, 1, -2, -1]] -= ETA**2 / 9 / h * (K2 / 2) * np.array([1.0, -1.0, -1.0, 1.0])
    try:
        U = solveh_banded(bands, right)
    except LinAlgError:
        # Rounding has made the matrix indefinite: fine grids where K2 is small.
        return np.nan
    B = np.diff(U, 2) / h**2 + K2 / 2
    soft = weight @ (P - K2 * U) ** 2 / 2 + ETA**2 / 18 * h * (B @ B)
    return float(soft + (K3**2 / 24 - XI / 3) ** 2 / 2 + ETA**2 * (K2**2 / 24 + K3**2 / 18))


def measured(bending: float) -> list[tuple[str, int, float, float]]:
    """Name, size, seconds of a section and largest relative error of every way to its energy."""
    strain = strains(bending)
    exact = [twist(ETA, XI, row).energy for row in strain[:CHECKED].tolist()]

    def error(energies: Any) -> float:
        return float(np.max([float(abs(v / e - 1)) for v, e in zip(energies, exact, strict=True)]))

    growth = [(1.0, {"gamma33": [0.0, 0.0, 4 * XI]})]
    laws = {name: SectionLaw(ETA, INCOMPRESSIBLE, growth, form) for form, name in FORMS.items()}
    whole: dict[tuple[str, int], Any] = {(name, 0): law.energy for name, law in laws.items()}
    whole["printed formula (57), (58)", 0] = lambda s: printed(s[:, 2], ETA, XI, s[:, 3], np)
    for modes in MODES:
        whole["sum over 4 to 64 modes, numpy", modes] = partial(modal, modes)
    runs: dict[tuple[str, int], Any] = {name: partial(run, strain) for name, run in whole.items()}
    errors = {name: error(run(strain[:CHECKED])) for name, run in whole.items()}
    for cells in CELLS:
        name = ("finite differences, scipy", cells)
        runs[name] = partial(differences, cells, strain[0])
        errors[name] = error([differences(cells, row) for row in strain[:CHECKED]])
    times = seconds(runs)
    return [(*name, times[name] / (MANY if name in whole else 1), errors[name]) for name in runs]


@styled
def draw(found: dict[float, list[tuple[str, int, float, float]]]) -> None:
    """A panel for each bending; colours of Okabe and Ito, and a mark of its own for each way."""
    figure = new_figure(PAGE, 5.0)
    panels: list[Axes] = list(figure.subplots(2, 2, sharex=True, sharey=True).flat)
    marks = "*sv^Do"
    for axes, (bending, rows) in zip(panels, found.items(), strict=True):
        for i, name in enumerate(dict.fromkeys(row[0] for row in rows)):
            points = [(time, np.maximum(error, FLOOR)) for n, _, time, error in rows if n == name]
            size = 9.0 if marks[i] == "*" else 4.5
            colour = COLOURS[(1, 5, 6, 2, 3, 0)[i]]
            axes.loglog(*zip(*points, strict=True), marks[i] + "-", color=colour, ms=size, lw=1.0, label=name)
        axes.set_title(rf"$|K_2| = {bending:g}\,\eta$")
        axes.axhline(2.0**-53, color="0.6", lw=0.6, zorder=0)
        axes.grid(alpha=0.25, lw=0.4)
    panels[0].text(1.1e-3, 1.4 * 2.0**-53, "rounding unit", color=INK, fontsize=6.5, ha="right")
    for axes in panels[2:]:
        axes.set_xlabel("seconds a section")
    for axes in panels[::2]:
        axes.set_ylabel("relative error of the energy")
    panels[0].set_ylim(1e-17, 1e2)
    panels[0].set_xlim(5e-9, 1.5e-3)
    handles, names = panels[0].get_legend_handles_labels()
    figure.legend(handles, names, loc="outside lower center", ncols=3)
    figure.savefig(FOLDER / "work_section.png")


def main() -> None:
    """Measure, print, write and draw."""
    found = {bending: measured(bending) for bending in BENDING}
    rows = [(bending, *row) for bending, panel in found.items() for row in panel]
    for row in rows:
        print("|K2| = {:g} eta | {} {} | {:.2e} s | {:.1e}".format(*row))
    write("work_section", ("K2_over_eta", "method", "size", "seconds", "error"), rows)
    draw(found)


if __name__ == "__main__":
    main()
