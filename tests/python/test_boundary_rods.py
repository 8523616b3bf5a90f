"""Classical rods in space against closed forms: couples, helices, bends, hanging chains, twist, rings."""

import itertools
import math

import numpy as np
import pytest
import ribbonrs as rb
from held import AXES, in_space, largest, matrices, rod, strip, turn
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk

CLOSE = 1e-11
"""Ten times the tolerance of the solver, 1e-12: of positions over the length, angles, curvatures times it."""
S = np.linspace(0.0, 1.0, 13)


# --- end couples: the moment is the same everywhere


@pytest.mark.parametrize("circles", [0.5, 1.0, 2.0, 3.0, -2.0])
@pytest.mark.parametrize("axis", [0, 1])
def test_circles_by_an_end_moment(circles, axis):
    law = rb.LinearLaw(EI1=(1.0, 4.0)[axis], EI2=(4.0, 1.0)[axis], GJ=0.5, inextensible=True)
    rate = 2.0 * math.pi * circles
    state = rb.solve(rod(law=law, end=rb.Free(moment=rate * AXES[axis])), tol=1e-12)
    at = state.at(S)
    # d3 turns about E_axis, from E3 towards E_axis x E3
    side = np.cross(AXES[axis], AXES[2])
    angle = rate * S
    place = np.outer(1.0 - np.cos(angle), side) / rate + np.outer(np.sin(angle), AXES[2]) / rate
    assert largest(at.position - place) < CLOSE
    tangent = np.outer(np.sin(angle), side) + np.outer(np.cos(angle), AXES[2])
    assert largest(at.directors[:, 2] - tangent) < CLOSE
    assert largest(at.strains[:, 1 + axis] - rate) < CLOSE * abs(rate)
    assert state.energy == pytest.approx(0.5 * rate**2, rel=CLOSE)


def precession(M, R0, stiffness, natural_twist, S):
    """Orientation (n, 3, 3) and strains of an isotropic rod under a constant moment.

    M.d3 is constant, and omega = M/EI + (K3 - M.d3/EI) d3: the frame turns about M, and spins about d3.
    """
    EI, GJ = stiffness
    axial = M @ R0[:, 2]
    K3 = natural_twist + axial / GJ
    R = np.array([turn(s * M / EI) @ R0 @ turn([0.0, 0.0, s * (K3 - axial / EI)]) for s in S])
    K = np.einsum("nji,j->ni", R, M) / EI
    K[:, 2] = K3
    return R, K


def helix_of(M, R0, EI, S):
    """The centreline (n, 3) whose tangent turns about M at the rate |M|/EI."""
    rate = np.linalg.norm(M) / EI
    axis = M / np.linalg.norm(M)
    t = R0[:, 2]
    along = (t @ axis) * axis
    across = t - along
    side = np.cross(axis, t)
    angle = rate * S
    return np.outer(S, along) + (np.outer(np.sin(angle), across) + np.outer(1.0 - np.cos(angle), side)) / rate


@pytest.mark.parametrize("GJ", [1.0, 0.3, 2.5])
@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("twist", [0.0, 3.0])
def test_helix_under_an_end_couple(GJ, seed, twist):
    rng = np.random.default_rng(seed)
    M, rotvec, origin = rng.normal(size=3), rng.normal(size=3), rng.normal(size=3)
    M *= rng.uniform(2.0, 20.0) / np.linalg.norm(M)
    law = rb.LinearLaw(EI1=1.0, EI2=1.0, GJ=GJ, inextensible=True, intrinsic=(0.0, 0.0, 0.0, twist))
    scene = rod(law=law, start=rb.Clamped(origin, rotvec), end=rb.Free(moment=M))
    state = rb.solve(scene, tol=1e-12)
    at, R0 = state.at(S), turn(rotvec)
    R, K = precession(M, R0, (1.0, GJ), twist, S)
    assert largest(matrices(at) - R) < CLOSE
    assert largest(at.position - origin - helix_of(M, R0, 1.0, S)) < CLOSE
    size = max(1.0, largest(K))
    assert largest(at.strains[:, 1:] - K) < CLOSE * size
    assert largest(in_space(at, "moment") - M) < 1e-13 * size
    assert largest(state.reactions.start.moment + M) < 1e-13 * size


# --- a helix by a wrench along its axis


@pytest.mark.parametrize(
    ("kappa", "tau", "m3", "phase"),
    [(4.0, 3.0, 2.0, 0.4), (2.0, -5.0, -1.0, 2.0), (6.0, 1.0, 0.0, -1.0), (3.0, 3.0, 5.0, 0.0)],
)
def test_helix_of_kirchhoff(kappa, tau, m3, phase):
    # M = EI kappa b + m3 t, N = F (tau t + kappa b)/(kappa^2 + tau^2)^(1/2): M' + t x N = 0 gives F
    EI, GJ = 1.0, 0.6
    rate = math.hypot(kappa, tau)
    force = rate * (m3 - EI * tau)
    # normal at an angle to d1; the material frame spins relative to it
    spin = m3 / GJ - tau
    angle = phase - spin * S
    K = np.stack([-kappa * np.sin(angle), kappa * np.cos(angle), np.full_like(S, m3 / GJ)], axis=1)
    normal = np.array([math.cos(phase), math.sin(phase), 0.0])  # of the curve, at the start
    binormal = np.cross(AXES[2], normal)
    axis = (tau * AXES[2] + kappa * binormal) / rate
    moment = turn(rate * axis) @ (EI * kappa * binormal + m3 * AXES[2])
    law = rb.LinearLaw(EI1=EI, EI2=EI, GJ=GJ, inextensible=True)
    scene = rod(law=law, end=rb.Free(force=force * axis, moment=moment))
    fine = np.linspace(phase, phase - spin, 201)
    guess = np.stack(
        [0 * fine, -kappa * np.sin(fine), kappa * np.cos(fine), np.full_like(fine, m3 / GJ)], axis=1
    )
    state = rb.solve(scene, guess=guess, tol=1e-12)
    at = state.at(S)
    assert largest(at.strains[:, 1:] - K) < CLOSE * rate
    assert largest(at.position - helix_of(rate * axis, np.eye(3), 1.0, S)) < CLOSE
    # the wrench about the origin is the same everywhere, and along the axis of the helix
    assert largest(in_space(at, "force") - force * axis) < CLOSE * max(1.0, abs(force))


# --- a bend out of its plane


def test_45_degree_bend():
    # Bathe & Bolourchi 1979: radius 100, section 1 x 1, E = 1e7, nu = 0, 600 at the tip across the plane;
    # with the polar moment of inertia, 1/6, as Simo & Vu-Quoc 1986 took it for twist
    Y = 1e7
    law = rb.LinearLaw(EA=1.0, EI1=1 / 12, EI2=1 / 12, GJ=0.5 / 6, intrinsic=(0.0, 0.0, 0.01, 0.0))
    scene = rod(25.0 * math.pi, law, end=rb.Free(force=(0.0, 600.0 / Y, 0.0)))
    x, z, y = rb.solve(scene).position[-1]
    # published by one decimal, or two, of coarse elements
    assert (x, y, z) == pytest.approx((15.79, 47.23, 53.37), rel=0.01)
    unloaded = rb.solve(rod(25.0 * math.pi, law)).position[-1]
    corner = 100.0 * math.sin(math.pi / 4)
    assert unloaded == pytest.approx((100.0 - corner, 0.0, corner), abs=1e-9)


# --- a chain


SPAN = 0.6
PARAMETER = brentq(lambda c: 2.0 * c * math.sinh(0.5 * SPAN / c) - 1.0, 0.05, 5.0, xtol=1e-15)
"""Horizontal force over the weight per length of a catenary of length 1."""
SAG = PARAMETER * (math.cosh(0.5 * SPAN / PARAMETER) - 1.0)


def chains(end):
    """Hanging rods, ever softer, each from the one before."""
    state = None
    for EI in (4e-4, 1e-4, 2.5e-5, 6.25e-6):
        law = rb.LinearLaw(EI1=10 * EI, EI2=EI, GJ=EI, inextensible=True)
        scene = rod(law=law, start=end(), end=end(position=(0.0, 0.0, SPAN)), gravity=(1.0, 0.0, 0.0))
        state = rb.solve(scene, guess=state)
        yield state


@pytest.mark.parametrize("end", [rb.Pinned, rb.Hinged, rb.Clamped])
def test_soft_rods_hang_in_a_catenary(end):
    errors = []
    for state in chains(end):
        at = state.at([0.0, 0.25, 0.5, 0.75, 1.0])
        force = in_space(at, "force")
        # exact at any stiffness; the force is found to the tolerance, 1e-10
        assert largest(force[:, 2] - force[0, 2]) < 1e-12
        assert largest(np.diff(force[:, 0]) + 0.25) < 1e-12
        start, far = state.reactions.start.force, state.reactions.end.force
        assert start + far == pytest.approx((-1.0, 0.0, 0.0), abs=1e-12)
        assert (start[0], far[0]) == pytest.approx((-0.5, -0.5), abs=1e-9)
        errors.append([abs(at.position[2, 0] - SAG), abs(far[2] - PARAMETER)])
    (*_, before, last) = np.array(errors)
    # bending acts in boundary layers of width (EI/force)^(1/2): the force differs by their size if the
    # ends turn the rod, else by its square
    ratio = (before / last)[1]
    assert ratio == pytest.approx(2.0 if end is rb.Clamped else 4.0, rel=0.15)
    EI = state.scene.law.EI2
    assert last[1] < (5.0 * math.sqrt(EI) if end is rb.Clamped else 40.0 * EI)
    assert last[0] < 40.0 * EI


# --- twist


@pytest.mark.parametrize("turns", [0.25, 0.5, 1.0, 1.5, 2.0, 3.0, 5.0, -1.0, -2.5])
@pytest.mark.parametrize("held", ["sliding", "clamped"])
def test_every_turn_of_an_end_is_kept(turns, held):
    # under tension T a straight rod stays so to a twisting moment of 2 (EI T)^(1/2)
    EA, GJ, tension = 1e4, 0.7, 500.0
    assert 2.0 * math.pi * 5.0 * GJ < 2.0 * math.sqrt(1.0 * tension)
    law = rb.LinearLaw(EA=EA, EI1=2.0, EI2=1.0, GJ=GJ)
    end = (
        rb.Sliding(twist_turns=turns, force=tension)
        if held == "sliding"
        else rb.Clamped(position=(0.0, 0.0, 1.0 + tension / EA), twist_turns=turns)
    )
    state = rb.solve(rod(law=law, end=end), tol=1e-12)
    rate = 2.0 * math.pi * turns
    assert largest(state.strains - (tension / EA, 0.0, 0.0, rate)) < CLOSE * max(1.0, abs(rate))
    assert largest(state.position - np.outer((1.0 + tension / EA) * state.S, AXES[2])) < CLOSE
    assert largest(state.reactions.end.moment - (0.0, 0.0, GJ * rate)) < CLOSE * max(1.0, GJ * abs(rate))
    assert state.reactions.end.force == pytest.approx((0.0, 0.0, tension), rel=1e-9)


@pytest.mark.parametrize("turns", [0.75, 1.25, 2.25, -1.75])
def test_turns_of_a_bent_rod_are_kept(turns):
    # no closed form: but twist plus writhe of an open rod near the straight one do not change in steps
    law = rb.LinearLaw(EI1=2.0, EI2=1.0, GJ=0.4, inextensible=True)
    end = rb.Clamped(position=(0.0, 0.0, 0.995), twist_turns=turns)
    scene = rod(law=law, end=end, gravity=(1.0, 0.3, 0.0))
    state = rb.solve(scene)
    d3 = state.at(np.linspace(0.0, 1.0, 4001)).directors[:, 2]
    K3 = state.at(np.linspace(0.0, 1.0, 4001)).strains[:, 3]
    total = np.trapezoid(K3, dx=1 / 4000)
    # the frame turns about E3 by K3 and by the solid angle of the tangents (Fuller 1978)
    solid = np.sum(d3[:-1, 0] * d3[1:, 1] - d3[:-1, 1] * d3[1:, 0]) / 2.0
    assert (total + solid) / (2.0 * math.pi) == pytest.approx(turns, abs=0.1)


# --- rings


def ring(link, EI1=1.0, EI2=1.0, GJ=1.0, length=1.0):
    law = rb.LinearLaw(EI1=EI1, EI2=EI2, GJ=GJ, inextensible=True)
    return rb.solve(rod(length, law, start=rb.Closed(link)), tol=1e-12)


@pytest.mark.parametrize(("EI1", "GJ"), [(4.0, 0.7), (100.0, 5.0), (1.0, 1.0)])
def test_a_ring_is_a_circle(EI1, GJ):
    state = ring(0.0, EI1=EI1, GJ=GJ, length=3.0)
    k = 2.0 * math.pi / 3.0
    bending = np.hypot(state.strains[:, 1], state.strains[:, 2])
    assert largest(bending - k) < CLOSE
    assert largest(state.strains[:, [0, 3]]) < CLOSE
    if EI1 > 1.0:  # else it may lie in any plane
        assert largest(state.strains[:, 1]) < CLOSE
    assert state.energy * 3.0 == pytest.approx(2.0 * math.pi**2 / 3.0, rel=CLOSE)
    assert largest(state.position[-1]) < 3.0 * CLOSE
    assert np.linalg.norm(state.reactions.start.force) < CLOSE
    assert np.linalg.norm(state.reactions.start.moment) == pytest.approx(k, rel=CLOSE)


@pytest.mark.parametrize("link", [1.0, -1.0])
def test_a_round_rod_closed_after_a_turn_stays_a_circle(link):
    # below sqrt(3) EI/GJ turns (Michell, Zajac)
    state = ring(link, GJ=0.7)
    assert largest(np.hypot(state.strains[:, 1], state.strains[:, 2]) - 2.0 * math.pi) < 1e2 * CLOSE
    assert largest(state.strains[:, 3] - 2.0 * math.pi * link) < 1e2 * CLOSE
    assert state.energy == pytest.approx(2.0 * math.pi**2 * 1.7, rel=CLOSE)


def writhe_and_twist(state, n):
    """Writhe of the polygon through n points and total twist in turns: their sum is the link."""
    at = state.at(np.linspace(0.0, state.S[-1], n + 1))
    r, h = at.position, state.S[-1] / n
    twist = np.sum(at.strains[:-1, 3]) * h / (2.0 * math.pi)
    mid, edge = 0.5 * (r[1:] + r[:-1]), np.diff(r, axis=0)
    i, j = map(np.array, zip(*itertools.combinations(range(n), 2), strict=True))
    apart = mid[i] - mid[j]
    size = np.linalg.norm(apart, axis=1) ** 3
    gauss = np.einsum("ni,ni->n", np.cross(edge[i], edge[j]), apart) / size
    return np.sum(gauss) / (2.0 * math.pi), twist


@pytest.mark.parametrize("link", [0.5, 1.0, 1.5, -0.5])
def test_twisted_rings_of_a_strip_close(link):
    state = ring(link, EI1=10.0, EI2=1.0, GJ=1.2)
    report = state.report
    assert report.status == "converged"
    assert report.residual < 1e-11
    first, last = state.at([0.0, 1.0]).directors
    sign = -1.0 if link % 1.0 else 1.0
    assert largest(last - np.diag([sign, sign, 1.0]) @ first) < CLOSE
    assert largest(state.position[[0, -1]]) < CLOSE
    start, end = state.reactions.start, state.reactions.end
    size = np.linalg.norm(start.moment)
    assert largest(start.force + end.force) < CLOSE * size
    assert largest(start.moment + end.moment) < CLOSE * size
    assert state.energy > 2.0 * math.pi**2
    # force and moment about the origin are the same everywhere
    force, moment = in_space(state, "force"), in_space(state, "moment")
    about = moment + np.cross(state.position, force)
    assert largest(force - force[0]) < CLOSE * size
    assert largest(about - about[0]) < CLOSE * size
    # Calugareanu, Fuller, White; the polygon's error falls as 1/n^2
    coarse, fine = (np.sum(writhe_and_twist(state, n)) for n in (200, 400))
    assert fine + (fine - coarse) / 3.0 == pytest.approx(link, abs=1e-3)


def test_a_ring_of_its_natural_curvature_bears_no_load():
    leaf, growth = strip(20.0), rb.growth.thickness(-2.0 * math.pi / 20.0)
    state = rb.solve(rb.Scene(leaf, growth, start=rb.Closed()), tol=1e-12)
    assert largest(state.strains - (0.0, 0.0, 2.0 * math.pi / 20.0, 0.0)) < CLOSE
    assert abs(state.energy) < 1e-24
    assert largest(np.concatenate([state.reactions.start.force, state.reactions.start.moment])) < 1e-14


@pytest.mark.parametrize("turns", [90.0, 101.0, 129.6])
def test_guesses_keep_their_turns(turns):
    # more than half a turn from one of the sections that a guess is handed over at to the next
    law = rb.LinearLaw(EI1=5.0, EI2=1.0, GJ=0.7, inextensible=True)
    scene = rod(length=300.0, law=law, end=rb.Sliding(force=1.0, twist_turns=turns))
    twist = 2.0 * math.pi * turns / 300.0
    state = rb.solve(scene, guess=(0.0, 0.0, 0.0, twist))
    again = rb.solve(scene, guess=state)
    for found in (state, again):
        np.testing.assert_allclose(found.strains[:, 3], twist, rtol=1e-10)


# --- rods that are far stiffer across than along: what is plane to a user


PLANE = {
    "stiffer": (1e5, 1e4),
    "much stiffer": (1e6, 1e3),
    "nearly rigid": (1e8, 1e8),
    "rigid across": (math.inf, 1e4),
    "rigid but for bending": (math.inf, math.inf),
}


@pytest.mark.parametrize("distance", [0.9, 0.5])
@pytest.mark.parametrize("ends", ["hinged", "clamped"])
@pytest.mark.parametrize("name", PLANE)
def test_plane_elastica_of_rods_that_are_stiff_across(name, ends, distance):
    EI1, GJ = PLANE[name]
    law = rb.LinearLaw(EI1=EI1, EI2=1.0, GJ=GJ, inextensible=True)
    place = (0.0, 0.0, distance)
    if ends == "hinged":
        scene = rod(law=law, start=rb.Hinged(2), end=rb.Hinged(2, position=place))
    else:
        scene = rod(law=law, end=rb.Clamped(position=place))
    state = rb.solve(scene)
    # half a wave between hinges, one between clamps: distance = 2 E(m)/K(m) - 1, force (2 K(m))^2 of a half
    m = brentq(lambda m: 2.0 * ellipe(m) / ellipk(m) - 1.0 - distance, 1e-6, 0.999, xtol=1e-14)
    force = (2.0 * ellipk(m)) ** 2 * (4.0 if ends == "clamped" else 1.0)
    assert state.stable
    # tol = 1e-10 of the shape, the force is of the size of 10 to 50
    assert -state.reactions.end.force[2] == pytest.approx(force, rel=1e-10)
    assert abs(state.position[:, 1]).max() < 1e-10


def test_a_rod_that_only_twists_is_not_shortened():
    # With no way to bend there is no equilibrium, which is told soon, and in little memory.
    law = rb.LinearLaw(EI1=math.inf, EI2=math.inf, GJ=1.0, inextensible=True)
    with pytest.raises(rb.ConvergenceError):
        rb.solve(rod(law=law, end=rb.Hinged(2, position=(0.0, 0.0, 0.5))))


# --- hinges, chains and coils that are reached the long way


@pytest.mark.parametrize(
    ("start", "director", "place"),
    [
        (rb.Clamped(rotation=(0.0, 3.0, 0.0)), 3, (0.0, 0.0, 0.8)),
        (rb.Clamped(rotation=(0.0, 1.7, 0.0)), 3, (0.3, 0.0, 0.5)),
        (rb.Clamped(rotation=(0.0, 0.0, 3.0)), 2, (0.0, 0.0, 0.8)),
        (rb.Clamped(twist_turns=0.5), 2, (0.0, 0.0, 0.8)),
    ],
)
def test_the_director_of_a_hinge_points_along_its_axis(start, director, place):
    law = rb.LinearLaw(EI1=1.0, EI2=0.5, GJ=0.3, inextensible=True)
    scene = rod(law=law, start=start, end=rb.Hinged(director, position=place))
    for state in [rb.solve(scene), *rb.find_states(scene, most=4)]:
        assert state.directors[-1, director - 1, director - 1] == pytest.approx(1.0, abs=1e-12)


@pytest.mark.parametrize("EI", [1e-4, 1e-5, 1e-6])
def test_hanging_rods_that_hardly_bend_are_catenaries(EI):
    span = 0.7
    a = brentq(lambda a: 2.0 * a * math.sinh(span / (2.0 * a)) - 1.0, 0.05, 5.0, xtol=1e-15)
    sag = a * (math.cosh(span / (2.0 * a)) - 1.0)
    law = rb.LinearLaw(EI1=10.0 * EI, EI2=EI, GJ=EI, inextensible=True)
    ends = {"start": rb.Pinned(), "end": rb.Pinned(position=(0.0, 0.0, span))}
    # forces are a million times those of bending: rounding of them is more than the default of tol
    state = rb.solve(rod(law=law, gravity=(-1.0, 0.0, 0.0), **ends), tol=1e-8)
    assert state.stable
    # bending adds to the energy in proportion to EI
    assert -state.at(np.array([0.5])).position[0, 0] == pytest.approx(sag, abs=3.0 * EI)


@pytest.mark.parametrize("GJ", [1e-2, 1e-4, 1e-6])
def test_torsion_does_not_enter_the_plane_elastica(GJ):
    law = rb.LinearLaw(EI1=2.0, EI2=1.0, GJ=GJ, inextensible=True)
    state = rb.solve(rod(law=law, end=rb.Clamped(position=(0.0, 0.0, 0.7))))
    m = brentq(lambda m: 2.0 * ellipe(m) / ellipk(m) - 1.7, 1e-6, 0.999, xtol=1e-14)
    assert state.stable
    # a shape that is out of plane by 1e-10 of GJ is what tol leaves
    assert -state.reactions.end.force[2] == pytest.approx(4.0 * (2.0 * ellipk(m)) ** 2, rel=1e-9)


@pytest.mark.parametrize("circles", [10.0, 25.0, 50.0])
def test_many_circles_by_an_end_moment(circles):
    moment = 2.0 * math.pi * circles
    law = rb.LinearLaw(EI1=math.inf, EI2=1.0, GJ=1.0, inextensible=True)
    state = rb.solve(rod(law=law, end=rb.Free(moment=(0.0, moment, 0.0))))
    np.testing.assert_allclose(state.strains[:, 2], moment, rtol=1e-12)


def test_an_arch_swings_to_where_its_loads_are_low():
    law = rb.LinearLaw(EI1=92.4, EI2=0.0283, GJ=0.05, inextensible=True)
    loads = [
        rb.PointLoad(0.25, force=(-0.0194, -0.01637, -0.04406)),
        rb.PointLoad(0.0896, force=(0.02638, -0.00564, 0.02086)),
    ]
    end = rb.Pinned(position=(0.1094, 0.9101, -0.0025))
    assert rb.solve(rod(law=law, start=rb.Pinned(), end=end, loads=loads)).stable
