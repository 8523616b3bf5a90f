"""When a flat strip whose edges grow leaves its plane, by the length of the waves.

    python docs/figures/flat_strip.py        prints the table of docs/validity.md, writes flat_strip.png

Lines are the linear stability analysis of the strip as a plate (tests/python/foppl_von_karman.py), marks the
growth at which a stiffness of the flat section vanishes in `ribbonrs.SectionLaw`. Growth is in units of
eta^2 = (thickness/width)^2, wave numbers in units of 1/width; the material is incompressible.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import ribbonrs as rb
from ribbonrs.figures.style import COLUMN, PHASES, new_figure, styled
from scipy.optimize import brentq

sys.path.insert(0, str(Path(__file__).parents[2] / "tests" / "python"))
from foppl_von_karman import threshold

ETA = 1e-2  # the thresholds do not depend on it
TABLE = (0.0, 0.02, 0.1, 0.5, 1.0, 2.0, 4.0)
WAVES = {False: "waves of bending", True: "waves of twist"}
KINDS = {False: ("bent", 2), True: ("twisted", 3)}


def of_section_law(strain: int) -> float:
    """Growth at which the flat section loses its stiffness against K2 or K3."""

    def stiffness(xi: float) -> float:
        law = rb.SectionLaw(ETA, rb.growth.edge(xi * ETA**2))
        return float(law.hessian([xi * ETA**2 / 3, 0.0, 0.0, 0.0])[strain, strain]) / ETA**2

    return float(brentq(stiffness, 4.0, 6.0, xtol=1e-12))


@styled
def main() -> None:
    """Print the thresholds and draw them."""
    laws = {twist: of_section_law(strain) for twist, (_, strain) in KINDS.items()}
    print("k", *WAVES.values(), sep=" | ")
    for k in TABLE:
        print(k, *(f"{threshold(k, twist):.4f}" for twist in WAVES), sep=" | ")
    print("section law", *(f"{laws[twist]:.4f}" for twist in WAVES), sep=" | ")
    figure = new_figure(COLUMN, 2.6)
    axis = figure.add_subplot()
    waves = np.linspace(0.0, 4.0, 81)
    for twist, name in WAVES.items():
        colour = PHASES[KINDS[twist][0]]
        axis.plot(waves, [threshold(k, twist) for k in waves], color=colour, label=f"plate, {name}")
        axis.plot(0.0, laws[twist], "o", color=colour, clip_on=False, zorder=5)
    axis.plot([], [], "o", color="0.4", label="section law")
    axis.set_xlim(0.0, 4.0)
    axis.set_ylim(0.0, 12.0)
    axis.set_xlabel(r"wave number $k a$")
    axis.set_ylabel(r"growth of the edges $\xi/\eta^2$")
    axis.legend(loc="lower right")
    axis.annotate("flat", (0.5, 2.2), color=PHASES["flat"])
    lengths = axis.secondary_xaxis("top")
    numbers = (20, 6, 4, 3, 2, 1.6)
    lengths.set_xticks([2 * np.pi / n for n in numbers], [f"{n:g}" for n in numbers])
    lengths.set_xlabel("wave length in widths")
    figure.savefig(Path(__file__).with_suffix(".png"))


if __name__ == "__main__":
    main()
