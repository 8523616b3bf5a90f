"""Quantities of a state that a bifurcation diagram may show: their names and what the field calls them."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from .arrays import Array
from .errors import InputError

if TYPE_CHECKING:
    from .branch import Branch

__all__ = ["QUANTITIES", "check_quantity", "label", "parameter_label", "vector_of"]

STRAINS = ("eps", "K1", "K2", "K3")
WRENCHES = ("start.force", "start.moment", "end.force", "end.moment")
"""Columns of the reactions, three each."""

QUANTITIES = (
    *STRAINS,
    "energy",
    "load_potential",
    "total_energy",
    *(f"position[{k}]" for k in range(3)),
    *(f"{wrench}[{k}]" for wrench in WRENCHES for k in range(3)),
    "index",
)
"""Strains and energies are means over S, positions are at S = L; dimensionless."""

LABELS = {
    "eps": r"axial strain $\varepsilon$",
    "K1": "curvature in the plane $K_1$",
    "K2": "curvature $K_2$",
    "K3": "twist $K_3$",
    "energy": r"energy $\Pi$",
    "load_potential": "potential of the loads",
    "total_energy": r"energy $\Pi$ and potential of the loads",
    "index": "number of unstable directions",
}

SYMBOLS = (
    (r"growth\.edge\.amplitude", r"edge growth $\xi$"),
    (r"growth\.thickness\.amplitude", r"growth through the thickness $\xi$"),
    (r"growth\.chiral\.amplitude", "shear growth through the thickness $d$"),
    (r"growth\.(.*)\.amplitude", r"amplitude of the growth {1}"),
    (r"ribbon\.thickness", "thickness $h$"),
    (r"ribbon\.length", "length $l_0$"),
    (r"start\.position\[(\d)\]", r"place of the start along $E_{up[1]}$"),
    (r"end\.position\[(\d)\]", r"place of the end along $E_{up[1]}$"),
    (r"(start|end)\.twist_turns", r"turns of the {1}"),
    (r"(start|end)\.force\[(\d)\]", r"force $F_{up[2]}$ on the {1}"),
    (r"(start|end)\.moment\[(\d)\]", r"moment $M_{up[2]}$ on the {1}"),
    (r"(start|end)\.(force|moment)", r"{2} on the {1}"),
    (r"gravity\[(\d)\]", r"force per length $p_{up[1]}$"),
    (r"loads\[(\d+)\]\.(force|moment)\[(\d)\]", r"{2} of load {1} along $E_{up[3]}$"),
    ("load_factor", r"load factor $\lambda$"),
    (r"law\.intrinsic\[0\]", r"intrinsic $\varepsilon^0$"),
    (r"law\.intrinsic\[([1-3])\]", r"intrinsic $K_{1}^0$"),
)
"""How a parameter of this name is written: {1} is the first group of the pattern, {up[1]} one more."""


def check_quantity(field: str, quantity: object) -> str:
    """Return the name of a quantity; an `InputError` that knows the nearest one if there is none."""
    if isinstance(quantity, str) and quantity in QUANTITIES:
        return quantity
    known = ", ".join(
        re.sub(r"\[0\]", "[0..2]", name) for name in QUANTITIES if not re.search(r"[12]\]", name)
    )
    expected = f"one of {known}"
    if isinstance(quantity, str):
        from difflib import get_close_matches

        expected += f"; the nearest is {get_close_matches(quantity, QUANTITIES, n=1, cutoff=0.0)[0]}"
    raise InputError(field, quantity, expected)


def vector_of(quantity: str) -> tuple[str, int] | None:
    """Return the vector and the component of a quantity that is one: ("position", 2)."""
    found = re.fullmatch(r"(.*)\[(\d)\]", quantity)
    return None if found is None else (found[1], int(found[2]))


def values_of(branch: Branch, quantity: str) -> Array:
    """Return a quantity at every point of a branch."""
    if quantity in STRAINS:
        return branch.strains[:, STRAINS.index(quantity)]
    vector = vector_of(quantity)
    if vector is None:
        total = branch.energy + branch.load_potential
        return total if quantity == "total_energy" else np.asarray(getattr(branch, quantity))
    name, k = vector
    column = k if name == "position" else 3 * WRENCHES.index(name) + k
    return np.asarray((branch.position if name == "position" else branch.reactions)[:, column])


def label(quantity: str, varies: bool) -> str:
    """Return what an axis of the quantity says, of states that vary along S or not."""
    vector = vector_of(quantity)
    if vector is None:
        return f"mean {LABELS[quantity]}" if varies and quantity in STRAINS else LABELS[quantity]
    name, k = vector
    if name == "position":
        return f"place of the end along $E_{k + 1}$"
    side, kind = name.split(".")
    return f"{kind} ${'F' if kind == 'force' else 'M'}_{k + 1}$ on the {side}"


def parameter_label(name: str) -> str:
    """Return what an axis of the parameter says, in two lines: what it is with its symbol, and its name."""
    return f"{next(_written(name), name)}\n({_plain(name)})"


def _written(name: str) -> Iterator[str]:
    for pattern, text in SYMBOLS:
        found = re.fullmatch(pattern, name)
        if found:
            groups = [_plain(group) for group in (found[0], *found.groups())]
            yield text.format(*groups, up=[int(group) + 1 if group.isdecimal() else 0 for group in groups])


def _plain(name: str) -> str:
    """A name of the user's without mathematics in it."""
    return name.replace("$", r"\$")
