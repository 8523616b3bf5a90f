"""What is known of the stability of the equilibria between the points of a branch."""

from __future__ import annotations

from collections.abc import Iterator

from .branch import Branch
from .diagram import Diagram

__all__ = ["neutral", "stability", "stable_spans"]

NEUTRAL = {"fold", "branch_point", "section_instability", "branch point", "section instability"}
"""Kinds of special points, and of ends, at which a direction becomes neutral."""


def neutral(diagram: Diagram, branch: Branch) -> frozenset[int]:
    """Return the points at which stability changes, and which tell nothing of what is beside them."""
    places = {
        point.place
        for point in diagram.special_points
        if point.branch == branch.number and {point.kind, point.name} & NEUTRAL
    }
    return frozenset(places)


def stability(branch: Branch, neutral: frozenset[int]) -> list[str]:
    """Return what is known of the equilibria between point i and i + 1."""
    told = []
    for i in range(branch.parameter.size - 1):
        ends = [j for j in (i, i + 1) if j not in neutral] or [i, i + 1]
        known, stable = branch.known[ends].all(), branch.stable[ends].all()
        told.append("stable" if stable else ("unstable" if known else "stability not known"))
    return told


def stable_spans(diagram: Diagram, branch: Branch) -> Iterator[tuple[float, float]]:
    """Yield where the equilibria are stable, in the order of the branch, as values of the parameter.

    A part of the branch on which the parameter turns back is more than one.
    """
    values = branch.parameter.tolist()
    begun: float | None = None
    rises = True
    for i, told in enumerate(stability(branch, neutral(diagram, branch))):
        turns = begun is not None and (values[i + 1] > values[i]) != rises
        if begun is not None and (told != "stable" or turns):
            yield begun, values[i]
            begun = None
        if told == "stable" and begun is None:
            begun, rises = values[i], values[i + 1] > values[i]
    if begun is not None:
        yield begun, values[-1]
