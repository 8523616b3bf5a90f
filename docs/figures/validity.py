"""How far the section law is from the section as a body in three dimensions, and what states say of it.

    python docs/figures/validity.py        prints the tables of docs/validity.md, writes validity.png

First the energy of natural shapes, for growth in proportion to eta^2 (through the thickness to eta), by the
law and by the body (tests/python/section3d.py) at the same strains, nu = 0.3, beside `State.neglected`. Then
the neglected strains of every example.
"""

from __future__ import annotations

import sys
import warnings
from collections.abc import Callable
from pathlib import Path

import ribbonrs as rb
from ribbonrs.figures.style import COLOURS, COLUMN, new_figure, styled
from ribbonrs.scenefile import read

sys.path.insert(0, str(Path(__file__).parents[2] / "tests" / "python"))
from test_section3d import MATERIAL, part_off

ETAS = (0.2, 0.1, 0.05, 0.025, 0.0125)
SHAPES: dict[str, tuple[str, Callable[[float], rb.Growth]]] = {
    "bent": ("bent", lambda eta: rb.growth.edge(8 * eta**2)),
    "twisted": ("twisted", lambda eta: rb.growth.edge(8 * eta**2)),
    "saddle": ("bent", lambda eta: rb.growth.thickness(4 * eta, -2 * eta)),
}
EXAMPLES = Path(__file__).parents[2] / "examples"


def natural_shape(eta: float, growth: rb.Growth, phase: str) -> rb.State:
    """The first of this phase, stable or not."""
    shapes = rb.natural_shapes(rb.Ribbon(10.0, 1.0, eta, MATERIAL), growth)
    return next(state for state in shapes if state.phase == phase)


@styled
def main() -> None:
    """Print the errors and draw them."""
    warnings.simplefilter("ignore", rb.RibbonWarning)  # what is stretched is shown
    figure = new_figure(COLUMN, 2.9)
    axis = figure.add_subplot()
    for (name, (phase, growth)), colour in zip(SHAPES.items(), COLOURS[1:], strict=False):
        states = [natural_shape(eta, growth(eta), phase) for eta in ETAS]
        parts = [part_off(growth(eta), state.strain, eta) for eta, state in zip(ETAS, states, strict=True)]
        for eta, state, part in zip(ETAS, states, parts, strict=True):
            print(f"{name} | {eta} | {part:.3%} | {state.neglected:.3%}")
        axis.loglog(ETAS, parts, "o-", color=colour)
        axis.plot([], [], color=colour, label=name)
        axis.loglog(ETAS, [state.neglected for state in states], "--", color=colour)
    axis.set_ylim(2e-5, 2.0)
    axis.plot([], [], "o-", color="0.4", label="energy off by")
    axis.plot([], [], "--", color="0.4", label="neglected strains")
    axis.set_xticks(ETAS, [f"{eta:g}" for eta in ETAS])
    axis.minorticks_off()
    axis.set_xlabel(r"thickness over width $\eta$")
    axis.set_ylabel("part of the energy, of the strains")
    axis.legend(loc="upper left")
    figure.savefig(Path(__file__).with_suffix(".png"))
    for path in sorted(EXAMPLES.glob("*.toml")):
        job = read(path)
        print(f"{path.stem} | {rb.solve(job.scene, **job.options).neglected:.1%}")


if __name__ == "__main__":
    main()
