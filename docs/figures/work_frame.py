"""Error against time of the frame along a ribbon.

    python docs/figures/work_frame.py        writes work_frame.csv and work_frame.png beside this file

The reference is a frame that is prescribed: rotations psi about E3, theta about E2, phi about E3 again,
functions of S in closed form, whose derivatives are the strains

    K1 = theta' sin phi - psi' sin theta cos phi,  K2 = theta' cos phi + psi' sin theta sin phi,
    K3 = phi' + psi' cos theta,                    eps = 0.05 cos S,

and whose position is the integral of (1 + eps) d3, by mpmath with 30 digits. The helix is its own closed
form. The error is the larger one of position over length and angle at S = 10. Times hold the calls of the
strains. This package is given them in arrays, scipy's methods one S after the other: that is how each is
called from Python.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
import ribbonrs as rb
from matplotlib.axes import Axes
from measure import FLOOR, FOLDER, seconds, write
from mpmath import mp, mpf
from ribbonrs.figures.style import COLOURS, PAGE, new_figure, styled
from scipy.integrate import solve_ivp

Array = np.ndarray[Any, Any]
LENGTH = 10.0
SEGMENTS = [4 * 2**k for k in range(14)]
TOLERANCES = [10.0**-k for k in range(3, 14)]
LAYER = 0.05
KINK = 7 / 3


class Angles(NamedTuple):
    """psi, theta, phi, and their derivatives, of S and a module with sin, cos, tanh, sqrt."""

    angles: Callable[[Any, Any], tuple[Any, Any, Any]]
    rates: Callable[[Any, Any], tuple[Any, Any, Any]]
    breaks: tuple[float, ...] = (0.0, LENGTH)


def smooth() -> Angles:
    """Angles that change over the whole length."""
    return Angles(
        lambda s, m: (s, 0.5 + m.sin(s) / 2, s / 2),
        lambda s, m: (1.0 + 0.0 * s, m.cos(s) / 2, 0.5 + 0.0 * s),
        tuple(np.linspace(0.0, LENGTH, 11)),
    )


def steep() -> Angles:
    """A turn of the tangent within a fiftieth of the length, at S = 10/3."""
    third = 10.0 / 3.0
    return Angles(
        lambda s, m: (s, 0.8 + 0.5 * m.tanh((s - third) / LAYER), s / 2),
        lambda s, m: (1.0 + 0.0 * s, 0.5 / LAYER * (1 - m.tanh((s - third) / LAYER) ** 2), 0.5 + 0.0 * s),
        (0.0, 1.0, 2.0, *(third + LAYER * np.arange(-16.0, 17.0, 2.0)), 5.0, 6.0, 7.0, 8.0, 9.0, LENGTH),
    )


def kinked() -> Angles:
    """Curvatures with a kink at S = 7/3: theta' is |S - 7/3|/10."""
    return Angles(
        lambda s, m: (s, 1.0 + (s - KINK) * abs(s - KINK) / 20, s / 2),
        lambda s, m: (1.0 + 0.0 * s, abs(s - KINK) / 10, 0.5 + 0.0 * s),
        (0.0, 1.0, KINK, *np.arange(3.0, LENGTH + 1.0)),
    )


class Case(NamedTuple):
    """Strains (n, 4) of S (n,), where they start from, and the exact pose at the end."""

    strains: Callable[[Array], Array]
    start: Array
    position: Array
    quaternion: Array


def prescribed(angles: Angles) -> Case:
    """The case of a frame that is known."""

    def strains(S: Array) -> Array:
        _, theta, phi = angles.angles(S, np)
        dpsi, dtheta, dphi = angles.rates(S, np)
        sin, cos = np.sin(phi), np.cos(phi)
        bending = dtheta * sin - dpsi * np.sin(theta) * cos, dtheta * cos + dpsi * np.sin(theta) * sin
        return np.stack([0.05 * np.cos(S), *bending, dphi + dpsi * np.cos(theta)], axis=-1)

    def quaternion(S: float) -> Array:
        psi, theta, phi = (x / 2 for x in angles.angles(mpf(S), mp))
        sine, cosine = mp.sin(theta), mp.cos(theta)
        parts = cosine * mp.cos(psi + phi), sine * mp.sin(phi - psi), sine * mp.cos(phi - psi)
        return np.array([float(x) for x in (*parts, cosine * mp.sin(psi + phi))])

    def tangent(i: int, s: Any) -> Any:
        psi, theta, _ = angles.angles(s, mp)
        along = (mp.sin(theta) * mp.cos(psi), mp.sin(theta) * mp.sin(psi), mp.cos(theta))[i]
        return (1 + mpf(0.05) * mp.cos(s)) * along

    with mp.workdps(30):
        pieces = list(pairwise(map(mpf, angles.breaks)))
        position = [
            float(sum(mp.quad(partial(tangent, i), piece, maxdegree=5) for piece in pieces)) for i in range(3)
        ]
        return Case(strains, quaternion(0.0), np.array(position), quaternion(LENGTH))


def helix(strain: Sequence[float], length: float) -> tuple[Array, Array]:
    """Position and quaternion after constant strain: a turn by |K| S, and the way along its axis."""
    with mp.workdps(30):
        eps, *K = map(mpf, strain)
        size = mp.sqrt(sum(k * k for k in K))
        axis, angle = [k / size for k in K], size * length
        d3 = (mpf(0), mpf(0), mpf(1))
        across = [axis[(i + 1) % 3] * d3[(i + 2) % 3] - axis[(i + 2) % 3] * d3[(i + 1) % 3] for i in range(3)]
        position = [
            (1 + eps)
            * (
                mp.sin(angle) / size * d3[i]
                + (1 - mp.cos(angle)) / size * across[i]
                + (length - mp.sin(angle) / size) * axis[2] * axis[i]
            )
            for i in range(3)
        ]
        turned = [mp.cos(angle / 2), *(mp.sin(angle / 2) * a for a in axis)]
        return np.array([float(x) for x in position]), np.array([float(x) for x in turned])


def constant() -> Case:
    """The same strain all along."""
    strain = (0.02, 0.1, 0.7, 1.1)
    start = np.array([1.0, 0.0, 0.0, 0.0])
    return Case(lambda S: np.tile(strain, (*np.shape(S), 1)), start, *helix(strain, LENGTH))


CASES = {
    "constant": constant,
    "smooth": lambda: prescribed(smooth()),
    "steep": lambda: prescribed(steep()),
    "kinked": lambda: prescribed(kinked()),
}


def error(case: Case, position: Array, quaternion: Array) -> float:
    """The larger error of position over length, and angle, at the end."""
    turn = min(float(np.linalg.norm(quaternion - s * case.quaternion)) for s in (1.0, -1.0))
    return max(float(np.linalg.norm(position - case.position)) / LENGTH, 2.0 * turn)


def core(case: Case, method: str, segments: int) -> tuple[Array, Array]:
    """Pose at the end by this package."""
    S = np.linspace(0.0, LENGTH, segments + 1)
    if method == AT_KINK:
        S = np.union1d(S, [KINK])
    match method:
        case "constant on segments":
            given: Any = case.strains((S[:-1] + S[1:]) / 2)
        case "at nodes, cubic":
            given = case.strains(S)
        case _:
            given = case.strains
    position, quaternion = rb.integrate_frame(S, given, (0.0, 0.0, 0.0), case.start)
    return position[-1], quaternion[-1]


def general(case: Case, method: str, tolerance: float) -> tuple[Array, Array]:
    """Pose at the end by scipy, of position and quaternion as seven equations."""

    def rates(s: float, y: Array) -> Array:
        eps, K1, K2, K3 = case.strains(np.array([s]))[0].tolist()
        a, b, c, d = y[3:].tolist()
        stretch = 1.0 + eps
        return np.array(
            [
                stretch * 2.0 * (b * d + a * c),
                stretch * 2.0 * (c * d - a * b),
                stretch * (a * a - b * b - c * c + d * d),
                0.5 * (-b * K1 - c * K2 - d * K3),
                0.5 * (a * K1 + c * K3 - d * K2),
                0.5 * (a * K2 + d * K1 - b * K3),
                0.5 * (a * K3 + b * K2 - c * K1),
            ]
        )

    y0 = np.concatenate([np.zeros(3), case.start])
    found = solve_ivp(rates, (0.0, LENGTH), y0, method, [LENGTH], rtol=tolerance, atol=tolerance)
    return found.y[:3, -1], found.y[3:, -1]


AT_KINK = "the same, a node at the kink"
CORE = ("constant on segments", "at nodes, cubic", "function, Gauss points", AT_KINK)
SCIPY = ("DOP853", "Radau")


def measured(name: str) -> list[tuple[str, float, float, float]]:
    """Method, segments or tolerance, seconds and error."""
    case = CASES[name]()
    runs: dict[tuple[str, float], Callable[[], tuple[Array, Array]]] = {}
    for method in CORE if name == "kinked" else CORE[:-1]:
        for segments in SEGMENTS:
            runs[method, segments] = partial(core, case, method, segments)
    for tolerance in TOLERANCES:
        runs["DOP853", tolerance] = partial(general, case, "DOP853", tolerance)
        # Of order 5 only: what is finer takes seconds.
        if tolerance > 3e-10:
            runs["Radau", tolerance] = partial(general, case, "Radau", tolerance)
    errors = {name: error(case, *run()) for name, run in runs.items()}
    quick = {name: run for name, run in runs.items() if name[0] in CORE}
    times = seconds(quick) | seconds({name: run for name, run in runs.items() if name not in quick}, 3)
    return [(*name, times[name], errors[name]) for name in runs]


@styled
def draw(found: dict[str, list[tuple[str, float, float, float]]]) -> None:
    """A panel for each case."""
    figure = new_figure(PAGE, 5.0)
    panels: list[Axes] = list(figure.subplots(2, 2, sharex=True, sharey=True).flat)
    looks = dict(zip((*CORE, *SCIPY), zip((5, 3, 1, 0, 2, 6), "osDx^v", strict=True), strict=True))
    for axes, (name, rows) in zip(panels, found.items(), strict=True):
        for method in dict.fromkeys(row[0] for row in rows):
            colour, mark = looks[method]
            points = [(time, max(e, FLOOR)) for m, _, time, e in rows if m == method]
            line = mark + "-"
            axes.loglog(*zip(*points, strict=True), line, color=COLOURS[colour], ms=3.5, lw=1.0, label=method)
        axes.set_title(name)
        axes.grid(alpha=0.25, lw=0.4)
    for axes in panels[2:]:
        axes.set_xlabel("seconds")
    for axes in panels[::2]:
        axes.set_ylabel("error of position/$L$ and angle")
    panels[0].set_ylim(1e-17, 10.0)
    handles, names = panels[3].get_legend_handles_labels()
    figure.legend(handles, names, loc="outside lower center", ncols=3)
    figure.savefig(FOLDER / "work_frame.png")


def main() -> None:
    """Measure, print, write and draw."""
    found = {name: measured(name) for name in CASES}
    rows = [(name, *row) for name, panel in found.items() for row in panel]
    for row in rows:
        print("{} | {} {:g} | {:.2e} s | {:.1e}".format(*row))
    write("work_frame", ("strains", "method", "segments_or_tolerance", "seconds", "error"), rows)
    draw(found)


if __name__ == "__main__":
    main()
