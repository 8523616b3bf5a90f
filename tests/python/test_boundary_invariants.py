"""What must hold of every held and loaded ribbon: symmetries, balance, and the work of its ends and loads."""

from functools import cache

import numpy as np
import pytest
import ribbonrs as rb
from held import AXES, in_space, largest, matrices, quaternion, turn

LENGTH = 10.0
LEAF = rb.Ribbon(LENGTH, 1.0, 0.1)
ETA2 = 0.1**2
UNIT = ETA2 / 12 / LENGTH**2
"""EI2/L^2, the unit of forces that bend the ribbon; moments are in units of it times L."""
ROD = rb.LinearLaw(EA=1.0, EI1=1 / 12, EI2=ETA2 / 12, GJ=ETA2 / 9, intrinsic=(0.0, 1e-3, 0.05, 0.1))
CLOSE = 1e-11
"""Ten times the tolerance of the solver, 1e-12."""
END = rb.Clamped((0.5, 0.3, 9.2), quaternion(turn([0.2, 0.5, 0.3])))
GRAVITY = (UNIT, 0.5 * UNIT, -UNIT)
S = np.linspace(0.0, LENGTH, 21)


def growth(chiral=0.03, thick=0.05):
    return rb.growth.edge(2.0 * ETA2) + rb.growth.chiral(chiral) + rb.growth.thickness(thick)


def loads(P=None, at=lambda S: S):
    """Two point loads and a line load, mapped by the matrix P (moments as axial vectors) and S -> at(S)."""
    P = np.eye(3) if P is None else P
    axial = np.linalg.det(P) * P
    points = [
        rb.PointLoad(at(3.0), P @ [2.0 * UNIT, 0.0, UNIT], axial @ [0.0, 3.0 * UNIT, -2.0 * UNIT]),
        rb.PointLoad(at(7.5), P @ [0.0, -UNIT, 0.5 * UNIT]),
    ]

    def wind(S):
        return UNIT * np.stack([np.cos(at(S)), 0.3 + 0.0 * S, np.sin(0.4 * at(S))], axis=1) @ P.T

    return [*points, rb.LineLoad(wind, axial @ [0.0, UNIT, 0.5 * UNIT])]


SCENES = {
    "clamped": rb.Scene(LEAF, growth(), end=END),
    "heavy": rb.Scene(LEAF, growth(), end=END, gravity=GRAVITY),
    "loaded": rb.Scene(LEAF, growth(), end=END, gravity=GRAVITY, loads=loads()),
    "pinned": rb.Scene(
        LEAF, growth(), end=rb.Pinned(END.position, (0.0, 20.0 * UNIT, 10.0 * UNIT)), loads=loads()[:2]
    ),
    "cantilever": rb.Scene(
        LEAF,
        growth(),
        end=rb.Free((3.0 * UNIT, 0.5 * UNIT, -UNIT), (0.0, 20.0 * UNIT, 5.0 * UNIT)),
        gravity=GRAVITY,
        loads=loads(),
    ),
    "rod": rb.Scene(LEAF, law=ROD, end=END, gravity=GRAVITY, loads=loads()),
}


@cache
def solved(name):
    return rb.solve(SCENES[name], tol=1e-12)


def image(name, P, shift=(0.0, 0.0, 0.0), **changes):
    """The scene mapped by r -> P r + shift, with the end map R -> P R Q that keeps frames right-handed."""
    scene = SCENES[name]
    Q = np.diag([1.0, np.linalg.det(P), 1.0])
    axial = np.linalg.det(P) * P

    def place(r):
        return P @ r + shift

    def orientation(end):
        w, *v = end.quaternion
        return quaternion(P @ turn(2.0 * np.arctan2(np.linalg.norm(v), w) * unit(v)) @ Q)

    start = rb.Clamped(place(np.zeros(3)), quaternion(P @ Q))
    match scene.end:
        case rb.Clamped():
            end = rb.Clamped(place(np.array(scene.end.position)), orientation(scene.end))
        case rb.Pinned():
            end = rb.Pinned(place(np.array(scene.end.position)), axial @ scene.end.moment)
        case _:
            end = rb.Free(P @ scene.end.force, axial @ scene.end.moment)
    mapped = [*loads(P)[: len(scene.loads)]]
    settings = {
        "ribbon": LEAF,
        "growth": scene.growth,
        "start": start,
        "end": end,
        "gravity": P @ scene.gravity,
        "loads": mapped,
        "law": scene.law,
    }
    return rb.Scene(**(settings | changes))


def unit(v):
    norm = np.linalg.norm(v)
    return np.array(v) / norm if norm > 0.0 else np.zeros(3)


def assert_same(one, other, P, signs, shift=(0.0, 0.0, 0.0)):
    """Check that `other` is the image of `one`, its strains multiplied by the signs."""
    a, b = one.at(S), other.at(S)
    assert largest(b.position - a.position @ P.T - shift) < CLOSE * LENGTH
    Q = np.diag([1.0, np.linalg.det(P), 1.0])
    assert largest(matrices(b) - P @ matrices(a) @ Q) < CLOSE
    assert largest((b.strains - a.strains * signs) * [1.0, *[LENGTH] * 3]) < CLOSE
    size = max(largest(a.force), UNIT)
    assert largest(in_space(b, "force") - in_space(a, "force") @ P.T) < CLOSE * size
    moment = max(largest(a.moment), UNIT * LENGTH)
    axial = np.linalg.det(P) * P
    assert largest(in_space(b, "moment") - in_space(a, "moment") @ axial.T) < CLOSE * moment
    assert other.energy == pytest.approx(one.energy, rel=CLOSE)


@pytest.mark.parametrize("name", SCENES)
@pytest.mark.parametrize("seed", range(3))
def test_rigid_motions(name, seed):
    rng = np.random.default_rng(seed)
    R, shift = turn(rng.normal(size=3)), 5.0 * rng.normal(size=3)
    state = rb.solve(image(name, R, shift), tol=1e-12)
    assert_same(solved(name), state, R, np.ones(4), shift)


@pytest.mark.parametrize("name", ["clamped", "heavy", "loaded", "pinned", "cantilever"])
def test_mirror_image(name):
    # in the plane E1, E3: handedness, K1 and K3 change sign
    P = np.diag([1.0, -1.0, 1.0])
    one, signs = solved(name), np.array([1.0, -1.0, 1.0, -1.0])
    scene = image(name, P, growth=growth(chiral=-0.03))
    fine = one.at(np.linspace(0.0, LENGTH, 401)).strains
    guess = None if name == "cantilever" else fine * signs
    assert_same(one, rb.solve(scene, guess=guess, tol=1e-12), P, signs)


@pytest.mark.parametrize("name", ["clamped", "heavy", "loaded", "cantilever", "rod"])
def test_seen_from_the_other_end(name):
    # S -> L - S, with d2 and d3 reversed: K1 changes sign, and what acts across a section
    one, D = solved(name), np.diag([1.0, -1.0, -1.0])
    scene = SCENES[name]
    law = scene.law
    if name == "rod":
        law = rb.LinearLaw(EA=1.0, EI1=1 / 12, EI2=ETA2 / 12, GJ=ETA2 / 9, intrinsic=(0.0, -1e-3, 0.05, 0.1))
    first = scene.end
    if isinstance(first, rb.Clamped):
        # the quaternion times that of a half turn about d1
        q0, q1, q2, q3 = first.quaternion
        first = rb.Clamped(first.position, (-q1, q0, q3, -q2))
    points = [load for load in loads(at=lambda S: LENGTH - S) if len(scene.loads) > 0]
    other = rb.Scene(
        LEAF,
        scene.growth,
        start=first,
        end=rb.Clamped((0.0, 0.0, 0.0), (0.0, 1.0, 0.0, 0.0)),
        gravity=scene.gravity,
        loads=points,
        law=law,
    )
    signs = np.array([1.0, -1.0, 1.0, 1.0])
    fine = one.at(np.linspace(LENGTH, 0.0, 401)).strains
    guess = None if name == "cantilever" else fine * signs
    state = rb.solve(other, guess=guess, tol=1e-12)
    # not at the point loads, which are seen from the right
    a, b = one.at(LENGTH - S[1::2] + 0.1), state.at(S[1::2] - 0.1)
    assert largest(a.position - b.position) < CLOSE * LENGTH
    assert largest(matrices(b) - matrices(a) @ D) < CLOSE
    assert largest((b.strains - a.strains * signs) * [1.0, *[LENGTH] * 3]) < CLOSE
    assert largest(in_space(a, "force") + in_space(b, "force")) < CLOSE * max(UNIT, largest(a.force))
    assert largest(in_space(a, "moment") + in_space(b, "moment")) < CLOSE * largest(a.moment)
    assert state.energy == pytest.approx(one.energy, rel=CLOSE)


def integral(state, f):
    """Integral of f(S, sections) (n, k) over the ribbon: Gauss points on the elements."""
    x, w = np.polynomial.legendre.leggauss(10)
    breaks = state.course.breaks
    h, mid = 0.5 * np.diff(breaks), 0.5 * (breaks[1:] + breaks[:-1])
    places = (mid[:, None] + h[:, None] * x).ravel()
    weights = (h[:, None] * w).ravel()
    return weights @ f(places, state.at(places))


def acting(scene, places):
    """Force and couple per unit S (n, 3), of gravity and line loads."""
    p, c = np.tile(scene.gravity, (places.size, 1)), np.zeros((places.size, 3))
    for load in scene.loads:
        if isinstance(load, rb.LineLoad):
            p = p + np.stack([f(places) for f in load.force], axis=1)
            c = c + np.array(load.moment)
    return p, c


@pytest.mark.parametrize("name", SCENES)
def test_the_ribbon_as_a_whole_is_in_balance(name):
    state, scene = solved(name), SCENES[name]
    ends = [(state.reactions.start, state.position[0]), (state.reactions.end, state.position[-1])]
    forces = [end.force for end, _ in ends]
    moments = [end.moment + np.cross(r, end.force) for end, r in ends]
    for load in scene.loads:
        if isinstance(load, rb.PointLoad):
            forces.append(np.array(load.force))
            moments.append(load.moment + np.cross(state.at(load.S).position, load.force))

    def wrench(places, sections):
        p, c = acting(scene, places)
        return np.hstack([p, c + np.cross(sections.position, p)])

    whole = integral(state, wrench)
    forces.append(whole[:3])
    moments.append(whole[3:])
    assert largest(np.sum(forces, axis=0)) < 1e-12 * largest(forces)
    assert largest(np.sum(moments, axis=0)) < 1e-12 * largest(moments)


def slope(total, step):
    """The derivative at 0 by central differences, extrapolated: errors of step^4."""
    coarse, fine = ((total(h) - total(-h)) / (2.0 * h) for h in (step, 0.5 * step))
    return (4.0 * fine - coarse) / 3.0


def total_energy(scene, guess):
    state = rb.solve(scene, guess=guess, tol=1e-13)
    return (state.energy + state.load_potential) * LENGTH


@pytest.mark.parametrize("name", ["clamped", "loaded", "rod"])
@pytest.mark.parametrize("end", ["start", "end"])
def test_ends_do_work_on_the_ribbon(name, end):
    scene, state = SCENES[name], solved(name)
    place, (w, *v) = (
        (np.zeros(3), rb.Clamped().quaternion) if end == "start" else (END.position, END.quaternion)
    )
    R = turn(2.0 * np.arctan2(np.linalg.norm(v), w) * unit(v))
    # all but the couples in space, which have no potential
    held = [load for load in scene.loads if isinstance(load, rb.PointLoad)]
    held = [rb.PointLoad(load.S, load.force) for load in held]
    kept = {
        "ribbon": LEAF,
        "growth": scene.growth,
        "start": rb.Clamped(),
        "end": END,
        "gravity": scene.gravity,
        "loads": held,
        "law": scene.law,
    }
    state = rb.solve(rb.Scene(**kept), guess=state, tol=1e-13)
    wrench = getattr(state.reactions, end)
    for i, axis in enumerate(AXES):

        def shifted(h, axis=axis):
            clamp = rb.Clamped(place + h * axis, quaternion(R))
            return total_energy(rb.Scene(**(kept | {end: clamp})), state)

        def turned(h, axis=axis):
            clamp = rb.Clamped(place, quaternion(turn(h * axis) @ R))
            return total_energy(rb.Scene(**(kept | {end: clamp})), state)

        # the error of the differences, 1e-9 of the force, falls with the fourth power of the steps
        unit_force = largest([wrench.force, wrench.moment / LENGTH])
        assert slope(shifted, 0.005) == pytest.approx(wrench.force[i], abs=1e-8 * unit_force)
        assert slope(turned, 0.0025) == pytest.approx(wrench.moment[i], abs=1e-8 * unit_force * LENGTH)


def test_loads_lose_what_they_move():
    # d(total)/d(force) = -displacement, d(total)/d(gravity) = -integral of r
    base = {"ribbon": LEAF, "growth": growth()}
    force, point = np.array([3.0, 0.5, -1.0]) * UNIT, np.array([2.0, 1.0, 1.0]) * UNIT

    def scene(h=0.0, axis=AXES[0], which=None):
        more = {name: h * axis * (name == which) for name in ("force", "point", "gravity")}
        return rb.Scene(
            **base,
            end=rb.Free(force + more["force"]),
            loads=[rb.PointLoad(4.0, point + more["point"])],
            gravity=GRAVITY + more["gravity"],
        )

    state = rb.solve(scene(), tol=1e-13)
    expected = {
        "force": state.position[-1],
        "point": state.at(4.0).position,
        "gravity": integral(state, lambda _, sections: sections.position),
    }
    for which, r in expected.items():
        for i, axis in enumerate(AXES):
            found = slope(
                lambda h, axis=axis, which=which: total_energy(scene(h, axis, which), state), 0.02 * UNIT
            )
            assert found == pytest.approx(-r[i], abs=1e-7 * LENGTH)


@pytest.mark.parametrize("name", ["clamped", "rod"])
def test_energy_is_that_of_the_strains(name):
    state = solved(name)
    if name == "rod":
        stiffness = np.array([1.0, 1 / 12, ETA2 / 12, ETA2 / 9])

        def density(places, sections):
            return 0.5 * (sections.strains - ROD.intrinsic) ** 2 @ stiffness

    else:

        def density(places, sections):
            return state.section_law.energy(sections.strains)

    assert integral(state, density) / LENGTH == pytest.approx(state.energy, rel=CLOSE)
