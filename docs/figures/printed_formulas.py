"""How the printed closed form of the section energy loses its digits, and the laws of this package do not.

    python docs/figures/printed_formulas.py        writes printed_formulas.png beside this file

Edge growth, xi = 6 eta^2, eta = 0.1, K3 = 2 eta, eps = K1 = 0, over |K2|/eta. The reference is the same
printed formula, Liu, Li & Liu, eqs. (57) and (58), in mpmath with more digits than its cancellation costs.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import mpmath
import numpy as np
from ribbonrs._core import SectionLaw

ETA, XI, K3 = 0.1, 0.06, 0.2
K2 = ETA * np.logspace(-10, 6, 641)
INCOMPRESSIBLE = (4 / 3, 4 / 3, 2 / 3, 1 / 3)
FLOOR = 1e-17  # where an exact result is drawn


def printed(K2: Any, eta: Any, xi: Any, K3: Any, m: Any) -> Any:
    """Eqs. (57) and (58) at eps = K1 = 0, operation by operation; m holds sin, cos, sinh, cosh, sqrt."""
    z = m.sqrt(3 * K2 / (2 * eta))
    bracket = (
        xi / 9 + 64 * eta**2 * xi / (9 * K2**2) - 8 * eta**2 * (K2**2 + 2 * K3**2) / (9 * K2**2) - K3**2 / 36
    )
    edge = (K2**2 + 2 * K3**2 - 16 * xi) ** 2 * (m.cos(z) - m.cosh(z)) / (m.sin(z) + m.sinh(z))
    layers = eta**2 * m.sqrt(eta) / (18 * m.sqrt(6) * K2**2 * m.sqrt(K2)) * edge
    return (K3**2 / 24) ** 2 / 2 + eta**2 / 18 * (K2**2 + K3**2) ** 2 / K2**2 + bracket * xi / 2 + layers


def reference(K2: float) -> Any:
    """The same in 120 digits, at the same doubles."""
    with mpmath.workdps(120):
        return printed(*(mpmath.mpf(v) for v in (K2, ETA, XI, K3)), mpmath)


def errors() -> dict[str, Any]:
    """Relative error of each law at every K2; NaN where it overflows."""
    exact = [reference(k) for k in K2.tolist()]
    strains = np.zeros((K2.size, 4))
    strains[:, 2], strains[:, 3] = K2, K3
    fields = {"gamma33": [0.0, 0.0, 4 * XI]}
    with np.errstate(over="ignore", invalid="ignore"):
        energies = {"printed formula in doubles": printed(K2, ETA, XI, K3, np)}
    for form in ("closed", "general"):
        energies[f"ribbonrs, {form} form"] = SectionLaw(ETA, INCOMPRESSIBLE, [(1.0, fields)], form).energy(
            strains
        )
    return {
        name: np.array(
            [float(abs(v - e) / e) if np.isfinite(v) else np.nan for v, e in zip(values, exact, strict=True)]
        )
        for name, values in energies.items()
    }


def draw(found: dict[str, Any], path: Path) -> None:
    """Log-log figure; colours of Okabe and Ito, told apart by marker as well."""
    k = K2 / ETA
    styles = [("#D55E00", "o", 8), ("#0072B2", "s", 4), ("#E69F00", "^", 4)]
    figure, axes = plt.subplots(figsize=(7.2, 4.4), layout="constrained")
    axes.axhspan(1, 1e30, color="0.93", zorder=0)
    axes.text(2e-10, 8.0, "no correct digit", color="0.35", va="center")
    for (name, error), (colour, marker, size) in zip(found.items(), styles, strict=True):
        axes.scatter(k, np.maximum(error, FLOOR), s=size, c=colour, marker=marker, linewidths=0, label=name)
    overflow = k[np.isnan(found["printed formula in doubles"])]
    axes.axvspan(overflow.min(), k.max(), color="#D55E00", alpha=0.15, zorder=0)
    axes.annotate(
        "printed formula\noverflows",
        (overflow.min(), 1e-6),
        (1.5e4, 1e-6),
        ha="right",
        va="center",
        color="#D55E00",
        arrowprops={"arrowstyle": "->", "color": "#D55E00"},
    )
    axes.axhline(2.0**-53, color="0.4", linewidth=0.8)
    axes.text(1.4e6, 2.0**-53, "rounding\nunit", color="0.3", va="center", fontsize=8)
    axes.set(
        xscale="log",
        yscale="log",
        xlim=(k.min(), k.max()),
        ylim=(5e-18, 1e18),
        xlabel=r"bending $|K_2|/\eta$",
        ylabel="relative error of the energy",
    )
    axes.set_yticks(10.0 ** np.arange(-16, 17, 4))
    axes.minorticks_off()
    axes.legend(frameon=False, loc="upper right", markerscale=2.5)
    axes.spines[["top", "right"]].set_visible(False)
    figure.savefig(path, dpi=180)


def main() -> None:
    """Write the figure and print the errors at whole decades."""
    found = errors()
    draw(found, Path(__file__).with_suffix(".png"))
    print("|K2|/eta  " + "  ".join(f"{name:>27}" for name in found))
    for i in range(0, K2.size, 40):
        cells = ("overflow" if np.isnan(e[i]) else f"{e[i]:.1e}" for e in found.values())
        print(f"{K2[i] / ETA:8.0e}  " + "  ".join(f"{cell:>27}" for cell in cells))


if __name__ == "__main__":
    main()
