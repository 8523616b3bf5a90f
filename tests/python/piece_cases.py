"""Growth in pieces, and the strains and materials that the references and the law are tried with."""

from __future__ import annotations

from sections import INCOMPRESSIBLE, ORTHOTROPIC

MATERIALS = {"incompressible": INCOMPRESSIBLE, "nu=0": (1.0, 1.0, 0.0, 0.5), "orthotropic": ORTHOTROPIC}

Fields = dict[str, list[list[float]]]
"""For each field the coefficients in x of each piece, lowest power first."""

# Breaks, and growth in units of eta^2 (gamma33) or eta: the sizes at which shapes change.
Case = tuple[list[float], Fields]
CASES: dict[str, Case] = {
    "step at the centre": ([0.0], {"gamma33": [[0.0], [8.0]]}),
    "step off the centre": ([-0.31], {"gamma33": [[-5.0], [7.0]]}),
    "step at an edge": ([0.49], {"gamma33": [[0.0], [30.0]]}),
    "steps": ([-0.4, -0.1, 0.05, 0.2, 0.45], {"gamma33": [[3.0], [-9.0], [6.0], [0.0], [12.0], [-4.0]]}),
    "kink": ([0.0], {"gamma33": [[0.0, -20.0], [0.0, 20.0]]}),
    "steps through the thickness": (
        [-0.2, 0.3],
        {"d33": [[2.0], [-1.0], [0.5]], "d22": [[-3.0], [1.0], [4.0]], "d23": [[1.0], [-2.0], [0.0]]},
    ),
    "step of the transverse shear": ([0.1], {"g21": [[0.0], [1.5]], "gamma33": [[2.0], [2.0]]}),
    "cubics": (
        [-0.25, 0.15],
        {
            "gamma33": [[1.0, -8.0, 20.0, 30.0], [0.0, 5.0, -40.0, 60.0], [-3.0, 0.0, 9.0, -70.0]],
            "d33": [[1.0, 2.0, -3.0, 5.0], [0.0, 1.0, 4.0, -8.0], [-1.0, 0.0, 2.0, 9.0]],
            "d22": [[0.0, -2.0, 1.0, 7.0], [1.0, 1.0, -5.0, 3.0], [2.0, -3.0, 0.0, 4.0]],
        },
    ),
    "mixture": (
        [-0.25, 0.125],
        {
            "gamma33": [[4.0], [0.0, 10.0, -60.0], [1.0, 0.0, 0.0, 0.0, 90.0]],
            "d33": [[0.0], [1.5], [0.0, 2.0]],
            "d22": [[0.0, 3.0], [-1.0], [2.0]],
            "d23": [[1.0], [0.0, 4.0], [-2.0]],
            "g21": [[-0.5], [0.0, 2.0], [0.203125, 0.0, 3.0]],
            "g31": [[0.0, 1.0, 2.0], [0.0, 0.5], [0.0625]],
        },
    ),
}


def sized(fields: Fields, eta: float) -> Fields:
    """Growth of a case at one thickness ratio."""
    return {
        name: [[c * (eta**2 if name == "gamma33" else eta) for c in piece] for piece in pieces]
        for name, pieces in fields.items()
    }


def strain(eta: float, k2: float) -> tuple[float, float, float, float]:
    """A strain whose parts all weigh in the energy."""
    return (0.8 * eta**2, -0.6 * eta**2, k2 * eta, 1.3 * eta)
