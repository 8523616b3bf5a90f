"""Energy over bending and twist, without and with chirality: the figure of docs/helices.md."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import ribbonrs as rb
from matplotlib.axes import Axes
from ribbonrs.figures.style import COLOURS, INK, PAGE, PHASES, new_figure, styled

ETA, X = 0.01, 60.0
OMEGAS = (0.0, 1.0)
REACH = 27.0


def growth(omega: float) -> rb.Growth:
    """Edge growth X eta^2 and a natural twist omega eta."""
    return rb.growth.edge(X * ETA**2) + rb.growth.chiral(2 * omega * ETA)


def draw_energy(axes: Axes, omega: float) -> None:
    """Energy over k2 and k3, with eps relaxed, the circle and all equilibria."""
    k = np.linspace(-REACH, REACH, 241)
    k2, k3 = np.meshgrid(k, k)
    zero = np.zeros_like(k2)
    strains = ETA * np.stack([ETA * (X / 3 - k3**2 / 24), zero, k2, k3], axis=-1)
    energy = rb.SectionLaw(ETA, growth(omega)).energy(strains) / ETA**4
    levels = energy.min() + np.array([0.0, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0])
    axes.contourf(k2, k3, energy, levels, cmap="Blues_r", extend="max")
    axes.contour(k2, k3, energy, levels[1:], colors="w", linewidths=0.4)
    angle = np.linspace(0.0, 2 * np.pi, 200)
    radius = np.sqrt(8 * X)
    axes.plot(radius * np.cos(angle), radius * np.sin(angle), ":", color=INK, linewidth=1.0)
    for shape in rb.natural_shapes(rb.Ribbon(10.0, 1.0, ETA), growth(omega)):
        face = PHASES[shape.phase] if shape.stable else "w"
        axes.plot(*shape.strain[2:] / ETA, "o", color=face, markeredgecolor=PHASES[shape.phase], markersize=5)
    axes.set(xlabel=r"bending $K_2/\eta$", xticks=(-20, 0, 20), yticks=(-20, 0, 20))
    axes.set_title(rf"$\omega = {omega:g}$")
    axes.set_aspect("equal")


def draw_circle(axes: Axes) -> None:
    """Energy on the circle over the angle from bending towards twist."""
    angle = np.linspace(0.0, 90.0, 181)
    k2, k3 = (np.sqrt(8 * X) * f(np.radians(angle)) for f in (np.cos, np.sin))
    strains = ETA * np.stack([ETA * (X / 3 - k3**2 / 24), 0 * k2, k2, k3], axis=-1)
    for omega, style, colour in zip((0.0, 0.2, 1.0), ("-", "--", "-."), COLOURS[:3], strict=True):
        energy = rb.SectionLaw(ETA, growth(omega)).energy(strains) / ETA**4 - omega**2 / 18
        axes.plot(angle, energy, style, color=colour, label=rf"$\omega = {omega:g}$")
        axes.plot(angle[np.argmin(energy)], energy.min(), "o", color=colour, clip_on=False)
    axes.set(xlim=(0.0, 90.0), xticks=(0, 45, 90), xlabel="angle on the circle (degrees)")
    axes.set(ylabel=r"energy$/\eta^4 - \omega^2/18$")
    axes.set_title("bent: 0, twisted: 90")
    axes.legend(loc="upper left")


@styled
def main() -> None:
    """Draw the figure beside this file."""
    figure = new_figure(PAGE, 2.4)
    left, middle, right = figure.subplots(1, 3)
    for axes, omega in zip((left, middle), OMEGAS, strict=True):
        draw_energy(axes, omega)
    left.set_ylabel(r"twist $K_3/\eta$")
    draw_circle(right)
    figure.savefig(Path(__file__).with_suffix(".png"), dpi=200)


if __name__ == "__main__":
    main()
