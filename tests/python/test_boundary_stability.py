"""The stability index under the end conditions, against classical loads and a dense count."""

import math

import numpy as np
import pytest
import ribbonrs as rb

UNIT = rb.Ribbon(1.0, 1.0, 0.1)
Z = (0.0, 0.0, 1.0)


def rod(EI1=1e3, EA=1e6, **k):
    return rb.LinearLaw(EA=EA, EI1=EI1, EI2=1.0, GJ=1.0, **k)


def straight(force, end, *, law=None, start=None, **k):
    """The straight rod under an axial force, from a guess that knows it."""
    law = rod() if law is None else law
    scene = rb.Scene(UNIT, None, start=start or rb.Clamped(), end=end, law=law, **k)
    state = rb.solve(scene, guess=(-force / 1e6, 0.0, 0.0, 0.0))
    assert np.max(np.abs(state.strains[:, 1:])) < 1e-9  # it is the straight one
    return state


def shortened(force):
    return (0.0, 0.0, 1.0 - force / 1e6)


# (what the end is under an axial force P, buckling loads in units of pi^2 EI/L^2)
COLUMNS = {
    "clamped-free": (lambda P: {"end": rb.Free(force=(0.0, 0.0, -P))}, (0.25, 2.25, 6.25)),
    "clamped-sliding": (lambda P: {"end": rb.Sliding(force=-P)}, (4.0, 8.183)),
    "clamped-clamped": (lambda P: {"end": rb.Clamped(shortened(P))}, (4.0, 8.183)),
    "hinged-hinged": (
        lambda P: {"start": rb.Hinged(2), "end": rb.Hinged(2, shortened(P))},
        (1.0, 4.0, 9.0),
    ),
    "clamped-hinged": (lambda P: {"end": rb.Hinged(2, shortened(P))}, (2.04575, 6.04680)),
}


@pytest.mark.parametrize("name", COLUMNS)
def test_columns_of_euler(name):
    ends, loads = COLUMNS[name]
    for count, load in enumerate(loads):
        # the compression of the rod changes its loads by P/EA
        for factor, index in ((1.0 - 1e-3, count), (1.0 + 1e-3, count + 1)):
            force = factor * load * math.pi**2
            state = straight(force, **ends(force))
            assert (state.index, state.stable) == (index, index == 0), factor


@pytest.mark.parametrize(("weight", "index"), [(7.8373, 0), (7.8374, 1)])
def test_column_of_greenhill(weight, index):
    law = rb.LinearLaw(EI1=1e3, EI2=1.0, GJ=1.0, inextensible=True)
    scene = rb.Scene(UNIT, None, gravity=(0.0, 0.0, -weight), law=law)
    assert rb.solve(scene, guess=(0.0, 0.0, 0.0, 0.0)).index == index  # 7.837347


@pytest.mark.parametrize(("force", "index"), [(4.0125, 0), (4.0127, 1)])
def test_cantilever_of_prandtl_and_michell(force, index):
    law = rb.LinearLaw(EI1=math.inf, EI2=1.0, GJ=1.0, inextensible=True)
    scene = rb.Scene(UNIT, None, end=rb.Free(force=(0.0, force, 0.0)), law=law)
    assert rb.solve(scene, guess=(0.0, 0.0, 0.0, 0.0)).index == index  # 4.012599


@pytest.mark.parametrize(("weight", "index"), [(12.853, 0), (12.855, 1)])
def test_cantilever_that_tips_over_by_its_weight(weight, index):
    law = rb.LinearLaw(EI1=math.inf, EI2=1.0, GJ=1.0, inextensible=True)
    scene = rb.Scene(UNIT, None, gravity=(0.0, weight, 0.0), law=law)
    assert rb.solve(scene, guess=(0.0, 0.0, 0.0, 0.0)).index == index  # 12.853763


def test_ring_that_is_twisted():
    # Michell, Zajac: the ring of EI1 = EI2 buckles at sqrt(3) EI/GJ turns of twist
    for turns, stable in ((1.0, True), (2.0, False)):
        law = rb.LinearLaw(EI1=1.0, EI2=1.0, GJ=1.0, inextensible=True)
        k, psi = 2.0 * math.pi, 2.0 * math.pi * turns * np.linspace(0.0, 1.0, 401)
        twist = np.full(psi.size, 2.0 * math.pi * turns)
        guess = np.column_stack([0.0 * psi, k * np.sin(psi), k * np.cos(psi), twist])
        state = rb.solve(rb.Scene(UNIT, None, start=rb.Closed(turns), law=law), guess=guess)
        assert np.max(np.abs(state.strains[:, 3] - 2.0 * math.pi * turns)) < 1e-8
        assert state.stable is stable


def test_a_moment_fixed_in_space_has_no_potential():
    scene = rb.Scene(UNIT, None, end=rb.Free(moment=(0.0, 1.0, 0.0)), law=rod())
    assert (rb.solve(scene).index, rb.solve(scene).stable) == (None, None)
    hinged = rb.Scene(UNIT, None, end=rb.Hinged(2, moment=1.0), law=rod())
    assert rb.solve(hinged).index == 0


def test_the_mesh_does_not_matter():
    leaf = rb.Ribbon(10.0, 1.0, 0.1)
    for xi, position in ((0.02, (0.0, 0.0, 9.0)), (0.0, (2.0, 1.0, 6.0))):
        scene = rb.Scene(leaf, rb.growth.edge(xi), end=rb.Clamped(position))
        first = rb.solve(scene, tol=1e-6)
        states = [
            first,
            *(rb.solve(scene, guess=first, tol=tol, degree=d) for tol, d in ((1e-9, 3), (1e-12, 8))),
        ]
        assert len({state.report.elements for state in states}) > 1
        assert len({state.index for state in states}) == 1


# --- an independent count: the energy itself, of piecewise constant strains, by differences


def negative_directions(state, segments):
    """Number of negative eigenvalues of the energy of `segments` constant strains under the end conditions.

    The poses are exact, by `integrate_frame`; the ends are kept by projection on the null space of their
    derivative, the curvature of that constraint by Lagrange multipliers. None of the solver's matrices enter.
    """
    scene = state.scene
    L = scene.ribbon.length_ratio
    S = np.linspace(0.0, L, segments + 1)
    middle = 0.5 * (S[1:] + S[:-1])
    h = L / segments
    law = scene.section_law
    e0 = state.at(middle).strains
    scale = np.array([0.01, 1.0, 0.1, 0.1]) / L  # of the size of what moves the end alike
    gravity = np.array(scene.gravity)
    force = np.array(getattr(scene.end, "force", (0.0, 0.0, 0.0)))

    def end(y):
        strains = e0 + (y.reshape(-1, 4) * scale)
        position, quaternion = rb.integrate_frame(S, strains)
        energy = h * float(np.sum(law.energy(strains)))
        energy -= float(position[-1] @ force)
        # the weight of each segment, by Simpson's rule on its exact curve
        fine = rb.integrate_frame(np.linspace(0.0, L, 2 * segments + 1), np.repeat(strains, 2, axis=0))[0]
        weights = np.full(2 * segments + 1, 2.0)
        weights[1::2], weights[[0, -1]] = 4.0, 1.0
        energy -= float(weights @ (fine @ gravity)) * h / 6.0
        return energy, position[-1], quaternion[-1]

    held = end(np.zeros(4 * segments))

    def constraint(y):
        energy, position, (q0, *q) = end(y)
        p0, *p = held[2]
        turn = p0 * np.array(q) - q0 * np.array(p) - np.cross(p, q)
        away = position - held[1]
        return energy, np.concatenate([away, 2.0 * turn]) if isinstance(scene.end, rb.Clamped) else np.zeros(
            0
        )

    n, step = 4 * segments, 1e-3
    values = {}

    def at(*moves):
        y = np.zeros(n)
        for i, sign in moves:
            y[i] += sign * step
        key = tuple(sorted(moves))
        if key not in values:
            energy, c = constraint(y)
            values[key] = np.concatenate([[energy], c])
        return values[key]

    zero = at()
    first = np.array([(at((i, 1)) - at((i, -1))) / (2.0 * step) for i in range(n)])  # (n, 1 + m)
    second = np.empty((n, n, zero.size))
    for i in range(n):
        second[i, i] = (at((i, 1)) - 2.0 * zero + at((i, -1))) / step**2
        for j in range(i):
            mixed = at((i, 1), (j, 1)) - at((i, 1), (j, -1)) - at((i, -1), (j, 1)) + at((i, -1), (j, -1))
            second[i, j] = second[j, i] = mixed / (4.0 * step**2)
    gradient, jacobian = first[:, 0], first[:, 1:]
    multipliers = np.linalg.lstsq(jacobian, gradient, rcond=None)[0] if jacobian.size else np.zeros(0)
    hessian = second[..., 0] - second[..., 1:] @ multipliers
    if jacobian.size:
        null = np.linalg.svd(jacobian.T)[2][jacobian.shape[1] :].T
        hessian = null.T @ hessian @ null
    values = np.linalg.eigvalsh(hessian)
    return int(np.sum(values < -1e-6 * np.max(np.abs(values)))), values


LEAF = rb.Ribbon(6.0, 1.0, 0.1)
EI = 0.01 / 12.0


@pytest.mark.parametrize(
    ("growth", "k", "guess", "expected"),
    [
        (None, {"end": rb.Free(force=(0.0, 0.0, -30.0 * EI / 36.0))}, (0.0, 0.0, 0.0, 0.0), 2),
        (rb.growth.edge(0.02), {"end": rb.Clamped((0.0, 0.0, 5.5))}, None, 0),
        (rb.growth.chiral(0.05), {"gravity": (0.0, 10.0 * EI / 216.0, 0.0)}, None, 0),
        (rb.growth.chiral(0.01), {"end": rb.Free(force=(0.0, 20.0 * EI / 36.0, 0.0))}, None, 0),
    ],
    ids=["column", "arch", "weight", "side"],
)
def test_a_dense_count_agrees(growth, k, guess, expected):
    state = rb.solve(rb.Scene(LEAF, growth, **k), guess=guess)
    count, values = negative_directions(state, 12)
    assert count == expected, values[:4]
    assert state.index == expected


@pytest.mark.parametrize("EI1", [10.0, 1e6, math.inf])
def test_stiffness_that_is_not_used_does_not_matter(EI1):
    # a planar state is the same for every EI1, and stiffer ones are not less stable
    law = rb.LinearLaw(EI1=EI1, EI2=1.0, GJ=1.0, inextensible=True)
    scene = rb.Scene(UNIT, None, law=law, end=rb.Free((50.0, 0.0, 0.0)))
    assert [rb.solve(scene, degree=degree).index for degree in (2, 3, 5, 7)] == [0.0] * 4


def test_a_rod_that_is_rigid_about_its_hinge():
    """Index 0 by finite elements of the second variation, which stay positive on 500 to 8000 of them.

    GJ/EI1 = 3.5e5, hinged about the director d2, the other end moved and clamped.
    """
    end = rb.Clamped((-4.375967230169156, -4.54617222544969, -0.7841341689740478))

    def scene(EI2, **k):
        law = rb.LinearLaw(EI1=0.0010627025041916817, EI2=EI2, GJ=369.46712440877405, **k)
        return rb.Scene(rb.Ribbon(30.0, 1.0, 0.1), law=law, start=rb.Hinged(2), end=end)

    state = rb.solve(scene(math.inf, EA=3738.0))
    assert state.index == 0.0
    for EI2 in (math.inf, 1e5, 1e4, 1e3):
        state = rb.solve(scene(EI2, inextensible=True), guess=state)
        assert state.index == 0.0


@pytest.mark.parametrize("eta", [1e-2, 1e-3, 1e-5])
def test_thin_ribbons(eta):
    force = 5.0 * eta**2 / 12.0 / 100.0
    scene = rb.Scene(rb.Ribbon(10.0, 1.0, eta), None, end=rb.Free((force, 0.0, 0.0)))
    assert [rb.solve(scene, degree=degree, tol=1e-8).index for degree in (2, 3, 5)] == [0.0] * 3
