"""Traces in tests: special points by kind, and what the index does at them."""

import numpy as np


def places(diagram, kind, branch=None):
    """Parameters of the special points of a kind, ascending."""
    points = [p for p in diagram.special_points if p.kind == kind]
    return np.sort([p.parameter for p in points if branch is None or p.branch == branch])


def kinds(diagram):
    """The kinds of the special points but the ends."""
    return {p.kind for p in diagram.special_points if p.kind != "end"}


def changes(diagram, branch=0):
    """By how much the index changes at the special points of a branch, in its order: (kind, by how much).

    The index is that of the points just before and after; at a special point itself it may be either.
    """
    branch = diagram.branches[branch]
    special = sorted(
        (p for p in diagram.special_points if p.branch == branch.number and p.kind not in ("end", "zero")),
        key=lambda p: p.place,
    )
    held = {p.place for p in special if p.kind != "value"}
    for p in special:
        before = max(i for i in range(p.place) if i not in held)
        after = min(i for i in range(p.place + 1, branch.index.size) if i not in held)
        crossed = [q for q in special if before < q.place < after and q.kind != "value"]
        if p.kind != "value" and len(crossed) == 1:
            yield p.kind, p.multiplicity, branch.index[after] - branch.index[before]


def along(diagram, branch=0):
    """The indices a branch has between its special points, without repetition."""
    branch = diagram.branches[branch]
    special = {p.place for p in diagram.special_points if p.branch == branch.number and p.kind != "end"}
    free = [branch.index[i] for i in range(branch.index.size) if i not in special]
    return [v for i, v in enumerate(free) if i == 0 or v != free[i - 1]]
