"""The orders of convergence of the boundary-value solver on uniform meshes.

    python docs/figures/orders.py          writes orders.png beside this file, from orders.csv
    python docs/figures/orders.py --run    writes orders.csv first, by `cargo bench --bench orders`

Left: the elastica, an inextensible cantilever under P L^2 = 3 EI, against its elliptic integrals. Right: a
ribbon with grown edges between clamps a quarter of a turn apart, with weight and a point load, against degree
8 to 1e-13. The error is the largest of those of position/L, angle, strain and K L at S = 0.37 L, inside an
element.
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from mpmath import mp, mpf

DATA = Path(__file__).with_suffix(".csv")
LOAD, PLACE = 3, mpf("0.37")
TITLES = {"elastica": "elastica", "ribbon": "grown ribbon, held and loaded"}
ROUNDING = {"elastica": 1e-14, "ribbon": 1e-12}
"""Errors below this say nothing about an order."""


def elastica(load: float = LOAD, place: Any = PLACE) -> np.ndarray[Any, Any]:
    """Position, quaternion, strain and curvatures of the elastica at a place, in the order of the table.

    With p sin phi = ((1 + sin theta)/2)^(1/2), u = F(phi, p^2) grows by load^(1/2) per unit of S.
    """
    with mp.workdps(40):
        root = mp.sqrt(load)

        def base(tip: Any) -> tuple[Any, Any]:
            """Phi at the base and p^2, of a tip angle."""
            m = (1 + mp.sin(tip)) / 2
            return mp.asin(1 / mp.sqrt(2 * m)), m

        def excess(tip: Any) -> Any:
            phi, m = base(tip)
            return mp.ellipk(m) - mp.ellipf(phi, m) - root

        phi, m = base(mp.findroot(excess, (mpf("0.5"), mpf("1.5")), solver="illinois", tol=1e-60))
        start = mp.ellipf(phi, m)
        u = start + root * place
        sn, cn = (mp.ellipfun(name, u, m=m) for name in ("sn", "cn"))
        x = place - 2 * (mp.ellipe(mp.atan2(sn, cn), m) - mp.ellipe(phi, m)) / root
        z = 2 * mp.sqrt(m) / root * (mp.ellipfun("cn", start, m=m) - cn)
        half = mp.asin(2 * m * sn**2 - 1) / 2
        curvature = 2 * mp.sqrt(m) * root * cn
        row = [x, 0, z, mp.cos(half), 0, mp.sin(half), 0, 0, 0, curvature, 0]
        return np.array([float(value) for value in row])


def largest(state: Any, exact: Any) -> float:
    """Largest error of position/L, angle, strain and K L."""
    difference, total = state - exact, state + exact
    turn = 2 * min(np.linalg.norm(difference[3:7]), np.linalg.norm(total[3:7]))
    return float(max(np.linalg.norm(difference[:3]), turn, np.linalg.norm(difference[7:])))


def errors() -> dict[str, dict[int, tuple[np.ndarray[Any, Any], np.ndarray[Any, Any]]]]:
    """Numbers of elements and errors, by scene and degree."""
    table = np.genfromtxt(DATA, delimiter=",", names=True, dtype=None, encoding="utf-8")
    states = np.array([list(row)[4:] for row in table], dtype=float)
    found: dict[str, dict[int, tuple[Any, Any]]] = {}
    for scene in TITLES:
        own = table["scene"] == scene
        reference = states[own & (table["elements"] == 0)][0]
        exact = elastica() if scene == "elastica" else reference
        print(f"{scene}: the reference is off by {largest(reference, exact):.1e}")
        ratios: list[float] = []
        found[scene] = {}
        for degree in np.unique(table["degree"]):
            rows = own & (table["degree"] == degree) & (table["elements"] > 0)
            error = np.array([largest(state, exact) for state in states[rows]])
            found[scene][int(degree)] = (table["elements"][rows], error)
            clear = (error > 1e-12) & (error < 1e-2)
            ratios.extend((table["estimate"][rows] / error)[clear])
        print(f"{scene}: {len(ratios)} estimates are {min(ratios):.2f} to {max(ratios):.2f} times the error")
    return found


def main() -> None:
    """Print the orders and draw the errors."""
    if "--run" in sys.argv[1:]:
        command = ["cargo", "bench", "--quiet", "--bench", "orders"]
        result = subprocess.run(command, cwd=DATA.parents[2], check=True, stdout=subprocess.PIPE, text=True)
        DATA.write_text(result.stdout)
    figure, axes = plt.subplots(1, 2, figsize=(9.0, 4.6), sharey=True, layout="constrained")
    colours = plt.get_cmap("viridis")(np.linspace(0.0, 0.9, 8))
    for axis, (scene, by_degree) in zip(axes, errors().items(), strict=True):
        for (degree, (elements, error)), colour in zip(by_degree.items(), colours, strict=True):
            axis.loglog(
                elements, np.maximum(error, 1e-17), "o-", ms=3.5, lw=1.4, color=colour, label=f"{degree}"
            )
            last = np.flatnonzero(error > ROUNDING[scene])[-1]
            orders = np.log(error[:last] / error[1 : last + 1]) / np.log(
                elements[1 : last + 1] / elements[:last]
            )
            print(f"{scene}, degree {degree}:", *(f"{order:.1f}" for order in orders))
            # The order, through the last point that rounding leaves alone.
            span = elements[last] * np.array([0.5, 1.4])
            slope = error[last] * (elements[last] / span) ** (2.0 * degree)
            axis.loglog(
                span, slope, ":", lw=1.2, color="k", label="slope 2 x degree" if degree == 8 else None
            )
        axis.set_title(TITLES[scene], fontsize=10)
        axis.set_xlabel("elements")
        axis.set_ylim(1e-16, 10.0)
        axis.set_xlim(1.5, 500.0)
        axis.grid(alpha=0.3)
    axes[0].set_ylabel("error")
    handles, names = axes[0].get_legend_handles_labels()
    figure.legend(handles, names, title="degree", fontsize=8, title_fontsize=8, loc="outside right center")
    figure.savefig(DATA.with_suffix(".png"), dpi=150)


if __name__ == "__main__":
    main()
