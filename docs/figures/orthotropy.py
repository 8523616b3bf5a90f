"""When an edge-grown ribbon bends, when it twists, and what its material has to do with it.

    python docs/figures/orthotropy.py        prints the tables of docs/materials.md, writes orthotropy.png

Every threshold is found by bisection on the shapes that `ribbonrs.natural_shapes` returns and on their
stability, and printed beside its formula. Growth xi is in units of eta^2 = (thickness/width)^2. Rho is
Q23/(Q33 Q22)^(1/2); Gamma is G over Huber's modulus, ((Q33 Q22)^(1/2) - Q23)/2: 1 in isotropic materials.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import ribbonrs as rb

ETA = 1e-3  # the thresholds do not depend on it, and growth stays small up to xi = 1e5 eta^2
NUS = (0.0, 0.3, 0.5)
BLUE, ORANGE, GREEN, PURPLE = "#0072B2", "#D55E00", "#009E73", "#CC79A7"  # Okabe and Ito


def material(transverse: float, nu: float, shear: float) -> rb.Orthotropic:
    """Of Young's modulus E33 = 1: transverse is Q22/E33, nu is Q23/Q22, shear is G/E33."""
    return rb.Orthotropic(1.0 + nu**2 * transverse, transverse, nu * transverse, shear)


def shapes(of: rb.Orthotropic | rb.Isotropic, xi: float = 0.0, omega: float = 0.0) -> dict[str, rb.State]:
    """The natural shapes by phase, mirror images left out; omega is the natural twist over eta."""
    growth = rb.growth.edge(xi * ETA**2) + rb.growth.chiral(2 * omega * ETA)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", rb.RibbonWarning)  # beside a threshold two shapes are one
        states = rb.natural_shapes(rb.Ribbon(1.0, 1.0, ETA, of), growth)
    return {state.phase: state for state in reversed(states)}


def crossing(true_above: Callable[[float], bool], low: float, high: float) -> float:
    """Where a statement turns true, by bisection."""
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (low, middle) if true_above(middle) else (middle, high)
    return high


# --------------------------------------------------------------------------------------- found by the program


def loses(of: rb.Orthotropic | rb.Isotropic, phase: str, index: int, low: float, high: float) -> float:
    """Growth at which a phase has that many unstable directions."""
    return crossing(lambda xi: shapes(of, xi)[phase].section_index >= index, low, high)


def coils(of: rb.Orthotropic | rb.Isotropic) -> float:
    """(kappa0 w^2/t)^(1/2) at which a ribbon of natural twist kappa0 turns from helicoid to helix."""
    return math.sqrt(crossing(lambda omega: "helical" in shapes(of, omega=omega), 1.0, 1e3))


def shear_of_twist(transverse: float, nu: float, beyond: float) -> float:
    """G/E33 below which the twisted shape is stable, at a multiple of the growth at which it appears."""

    def unstable(shear: float) -> bool:
        return shapes(material(transverse, nu, shear), 15 * shear * beyond)["twisted"].section_index > 0

    bound = huber(transverse, nu)
    return crossing(unstable, bound / 10, bound * 2)


# ---------------------------------------------------------------------------------------------- by formula


def bend(transverse: float, nu: float, sign: int = 1) -> float:
    """Growth at which the flat ribbon bends."""
    p = 5.25 * nu * transverse
    return -p + sign * math.sqrt(p**2 + 39.375 * transverse)


def huber(transverse: float, nu: float) -> float:
    """G/E33 of an orthotropic ribbon that is isotropic but for a change of scale."""
    return (math.sqrt((1.0 + nu**2 * transverse) * transverse) - nu * transverse) / 2


def critical(transverse: float, nu: float) -> float:
    """Gamma below which an edge-grown ribbon twists."""
    rho = nu * math.sqrt(transverse / (1.0 + nu**2 * transverse))
    return (1.0 + rho) / (rho + math.sqrt((10.0 - 3.0 * rho**2) / 7.0))


def chiral_coils(nu: float) -> float:
    """What `coils` finds in an isotropic ribbon."""
    p = 42.0 * nu / (1.0 - nu**2)
    twist = math.sqrt(p + math.sqrt(p**2 + 2520.0 / (1.0 - nu**2)))
    return math.sqrt(twist + twist**3 * (1.0 + nu) / 60.0)


def helix(transverse: float, nu: float, shear: float) -> tuple[float, float]:
    """K2/eta of the helix and the growth at which the bent ribbon becomes one, for 1 > Gamma > critical."""
    beta2, g = transverse / 12, shear / 6
    level = beta2 * (1.0 - 24.0 * g * nu) / (12.0 * g**2)

    def tau(z: float) -> float:
        return 2 / z * (math.cosh(z) - math.cos(z)) / (math.sinh(z) + math.sin(z))

    def slope(z: float) -> float:
        """d(1/sigma)/d(z^4): falls from 10/7 to 1."""
        t = tau(z)
        ratio = (math.cosh(z) + math.cos(z)) / (math.sinh(z) + math.sin(z))
        return (1 - t + (2 - t - z * t * ratio) / 4) / (1 - t) ** 2

    z = crossing(lambda z: slope(z) < level, 0.1, 500.0)
    k = 2 * math.sqrt(beta2) * z**2
    return k, (nu * k**2 + 4 * g * z**4 / (1 - tau(z))) / 8


# --------------------------------------------------------------------------------------------------- tables


def isotropic_table() -> None:
    """Isotropic materials: edges or middle growing, and natural twist."""
    print("isotropic: found by the program, and how far the formula is off\n")
    print("  nu    flat bends     flat twists    middle grows: bends   helicoid coils at w (kappa0/t)^(1/2)")
    for nu in (-0.5, 0.0, 0.1, 0.3, 0.45, 0.5):
        of, transverse = rb.Isotropic(nu=nu), 1 / (1 - nu**2)
        pairs = [
            (loses(of, "flat", 1, 1.0, 14.0), bend(transverse, nu)),
            (loses(of, "flat", 2, 1.0, 20.0), 7.5 / (1 + nu)),
            (-crossing(lambda xi, of=of: "bent" in shapes(of, -xi), 1.0, 20.0), bend(transverse, nu, -1)),
            (coils(of), chiral_coils(nu)),
        ]
        print(
            f"{nu:5.2f}"
            + "".join(f"  {found:11.6f} ({abs(found / exact - 1):.0e})" for found, exact in pairs)
        )


def twist_table() -> list[tuple[float, float, float]]:
    """The shear modulus below which twist is stable: nu, Q22/E33, G/E33."""
    print(
        "\nG/E33 below which the twisted ribbon is stable, at multiples of the growth at which it appears\n"
    )
    print("   nu  Q22/E33       1.001          10         100     formula     Gamma*")
    found = []
    for nu in NUS:
        for transverse in np.logspace(-2, 1, 7).tolist():
            at = [shear_of_twist(transverse, nu, beyond) for beyond in (1.001, 10.0, 100.0)]
            gamma = critical(transverse, nu)
            exact = gamma * huber(transverse, nu)
            found.append((nu, transverse, at[0]))
            cells = "".join(f"{g:12.8f}" for g in (*at, exact))
            print(f"{nu:5.2f} {transverse:8.4f}{cells}   {gamma:.6f}")
    return found


def sequence_table(nu: float) -> list[tuple[float, str, float]]:
    """Thresholds of a ribbon that is isotropic but for its shear modulus: Gamma, what happens, growth."""
    transverse = 1 / (1 - nu**2)
    limit = critical(transverse, nu)
    print(f"\nisotropic with nu = {nu} but for G: growth at which the shapes change, found (formula)\n")
    rows = []
    near = [limit - 0.005, limit + 0.005]
    for gamma in sorted([0.7, 0.75, 0.8, 0.85, *near, 0.9, 0.92, 0.94, 0.96, 1.0, 1.05, 1.1]):
        shear = gamma * huber(transverse, nu)
        of, first = material(transverse, nu, shear), bend(transverse, nu)
        if gamma < limit:
            onset = loses(of, "flat", 1, 0.1, first)
            print(f"  Gamma = {gamma:.4f}  flat -> twisted {onset:10.6f} ({15 * shear:10.6f})")
            rows.append((gamma, "twist", onset))
            continue
        onset = loses(of, "flat", 1, 0.1, 2 * first)
        line = f"  Gamma = {gamma:.4f}  flat -> bent    {onset:10.6f} ({first:10.6f})"
        rows.append((gamma, "bend", onset))
        if gamma < 1.0:
            k, exact = helix(transverse, nu, shear)
            coil = loses(of, "bent", 1, first * 1.001, exact * 2)
            early, late = (shapes(of, coil * factor)["helical"].strain[2] / ETA for factor in (1.1, 10.0))
            line += f"   bent -> helical {coil:11.6f} ({exact:11.6f})"
            line += f"   K2/eta = {early:.6f}, {late:.6f} ({k:.6f})"
            rows.append((gamma, "helix", coil))
        print(line)
    return rows


def examples() -> None:
    """Materials of given engineering constants: along, across, Poisson's ratio along, shear."""
    print("\nE33, E22, nu32, G              rho   Gamma  Gamma*   edge growth makes it")
    for name, along, across, nu32, shear in (
        ("carbon fibre, along", 140.0, 10.0, 0.3, 5.0),
        ("carbon fibre, across", 10.0, 140.0, 0.3 * 10 / 140, 5.0),
        ("spruce, along", 11.0, 0.45, 0.45, 0.7),
        ("paper, machine direction", 8.0, 4.0, 0.41, 2.2),
        ("isotropic, nu = 0.3", 1.0, 1.0, 0.3, 1 / 2.6),
    ):
        coupling = 1 - nu32**2 * across / along
        Q33, Q22, Q23 = along / coupling, across / coupling, nu32 * across / coupling
        of, rho = rb.Orthotropic(Q33, Q22, Q23, shear), Q23 / math.sqrt(Q33 * Q22)
        gamma, limit = 2 * shear / (math.sqrt(Q33 * Q22) - Q23), critical(Q22 / of.Y, Q23 / Q22)
        onset = loses(of, "flat", 1, 0.01, 40.0)
        states = shapes(of, 1.01 * onset)
        (stable,) = (phase for phase, state in states.items() if state.stable)
        print(f"{name:28s} {rho:6.3f}  {gamma:6.3f}  {limit:6.3f}   {stable} at xi = {onset:.3f} eta^2")


# --------------------------------------------------------------------------------------------------- figure


def draw(
    border: list[tuple[float, float, float]], sequence: list[tuple[float, str, float]], nu: float
) -> None:
    """Left: the border of twist for several materials; right: the shapes against Gamma and growth."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(9.6, 4.4), layout="constrained")
    across = np.logspace(-2, 1, 200)
    for value, colour, marker, style in zip(NUS, (BLUE, ORANGE, GREEN), "os^", ("-", "--", ":"), strict=True):
        edge = [critical(r, value) * huber(r, value) for r in across.tolist()]
        left.plot(across, edge, color=colour, linestyle=style, linewidth=1.2)
        points = [(r, g) for v, r, g in border if v == value]
        left.plot(
            *zip(*points, strict=True),
            marker,
            color=colour,
            markersize=4.5,
            clip_on=False,
            label=rf"$\nu = {value}$",
        )
        left.plot(
            1 / (1 - value**2), 0.5 / (1 + value), "*", color=colour, markersize=11, markeredgecolor="k"
        )
    left.plot([], [], "*", color="w", markersize=11, markeredgecolor="k", label="isotropic")
    left.text(0.02, 0.35, "edge growth\nbends the ribbon", color="0.25")
    left.text(0.5, 0.04, "edge growth\ntwists the ribbon", color="0.25")
    left.set(xscale="log", yscale="log", xlim=(0.01, 10), xlabel=r"across: $Q_{22}/E_{33}$")
    left.set(ylabel=r"shear: $G/E_{33}$")
    left.legend(frameon=False, loc="upper left")

    transverse = 1 / (1 - nu**2)
    limit, first, top, low, high = critical(transverse, nu), bend(transverse, nu), 300.0, 0.7, 1.1
    below = np.linspace(low, limit, 50)
    twist = 15 * huber(transverse, nu) * below
    gammas = limit + (1 - limit) * np.linspace(1e-3, 0.99, 200) ** 1.5
    coil = [helix(transverse, nu, gamma * huber(transverse, nu))[1] for gamma in gammas.tolist()]
    gammas, coil = np.array([limit, *gammas, high]), np.minimum([first, *coil, top], top)
    right.fill_between(below, twist, top, color=BLUE, alpha=0.18, linewidth=0)
    right.fill_between(gammas, first, coil, color=ORANGE, alpha=0.18, linewidth=0)
    right.fill_between(gammas, coil, top, color=PURPLE, alpha=0.3, linewidth=0)
    right.plot(below, twist, color=BLUE)
    right.plot([limit, high], [first, first], color=ORANGE)
    right.plot(gammas[coil < top], coil[coil < top], color=PURPLE)
    right.plot([limit, limit], [first, top], color="0.3", linewidth=1)
    for what, colour, marker in (("twist", BLUE, "o"), ("bend", ORANGE, "s"), ("helix", PURPLE, "^")):
        points = [(gamma, xi) for gamma, kind, xi in sequence if kind == what and xi < top]
        right.plot(*zip(*points, strict=True), marker, color=colour, markersize=5, clip_on=False)
    right.axvline(1.0, color="0.5", linewidth=0.8, linestyle=":")
    right.text(1.003, 7.0, "isotropic", color="0.35", rotation=90, va="bottom")
    for text, x, y in (("flat", 0.8, 3.4), ("twisted", 0.78, 40), ("bent", 1.03, 40)):
        right.text(x, y, text, ha="center")
    right.annotate("helical", (0.893, 150), (0.8, 150), va="center", arrowprops={"arrowstyle": "-"})
    right.set(xlim=(low, high), ylim=(3, top), yscale="log", ylabel=r"growth of the edges $\xi/\eta^2$")
    right.set(xlabel=r"$\Gamma = 2G/(\sqrt{Q_{33} Q_{22}} - Q_{23})$")
    right.set_title(rf"isotropic with $\nu = {nu}$ but for $G$", fontsize=10)
    for axes in (left, right):
        axes.spines[["top", "right"]].set_visible(False)
    figure.savefig(Path(__file__).with_suffix(".png"), dpi=180)


def main() -> None:
    """Print the tables and draw the figure."""
    isotropic_table()
    border = twist_table()
    sequence = sequence_table(0.3)
    examples()
    draw(border, sequence, 0.3)


if __name__ == "__main__":
    main()
