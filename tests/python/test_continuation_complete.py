"""Branches that are easily lost: met twice by one, alike but shifted, limited by rounding, past a step."""

from __future__ import annotations

import math

import numpy as np
import pytest
import ribbonrs as rb
from continued import places
from held import rod
from scipy.integrate import quad
from scipy.optimize import fsolve
from scipy.spatial.transform import Rotation


def test_branch_point_that_a_closed_branch_meets_twice() -> None:
    # A ring whose sections are turned by theta: K1 = 2 pi sin(theta), K2 = 2 pi cos(theta) with natural K1
    # k = 2 pi (1 - EI2/EI1) sin(theta), and K1 = 2 pi, K2 = 0 for all k, which meets that at sin(theta) = 1.
    EI1 = 1.7
    law = rb.LinearLaw(EI1=EI1, EI2=1.0, GJ=0.8, inextensible=True)
    scene = rod(law=law, start=rb.Closed())
    diagram = rb.trace(scene, "law.intrinsic[1]", (-9.0, 9.0), start=rb.solve(scene), depth=1)
    assert diagram.branches[0].ended == ("start", "closed")
    assert len(places(diagram, "branch_point", 0)) == 2
    meets = 2.0 * math.pi * (1.0 - 1.0 / EI1)
    # exact but for the square of the place at which it is located, 1e-4
    np.testing.assert_allclose(np.abs(places(diagram, "branch_point", 0)), meets, rtol=1e-8)
    (ring,) = (state for state in diagram.states_at(5.0) if state.stable)
    np.testing.assert_allclose(np.abs(ring.strains[:, 1]), 2.0 * math.pi, rtol=1e-10)


def test_halves_that_differ_by_a_shift_along_the_rod_are_two_branches() -> None:
    # Strains of one half are those of the other half a period on, with K1 reversed: all their means agree,
    # but the clamps are elsewhere on the wave, and the index differs.
    def scene(rotation: tuple[float, ...]) -> rb.Scene:
        law = rb.LinearLaw(EI1=1.3, EI2=1.0, GJ=0.4, inextensible=True, intrinsic=(0.0, 0.0, -5.0, 0.0))
        start = rb.Clamped(rotation=rotation)
        d3 = Rotation.from_quat(np.roll(rotation, -1)).as_matrix()[:, 2]
        place = tuple(0.5640896051323029 * d3)
        return rod(law=law, start=start, end=rb.Clamped(position=place, rotation=rotation))

    for rotation in ((1.0, 0.0, 0.0, 0.0), (0.5, 0.5, -0.5, 0.5), (0.8, 0.0, 0.36, 0.48)):
        turned = scene(rotation)
        diagram = rb.trace(turned, "law.intrinsic[2]", (-5.0, 5.0), start=rb.solve(turned), depth=1)
        halves = [state for state in diagram.states_at(-2.0) if abs(state.energy - 22.08576423) < 1e-6]
        assert {state.index for state in halves} == {1.0, 2.0}


def loop(distance: float, guess: list[float]) -> tuple[list[float], float, float]:
    """One turn between clamps, theta' = sqrt(k0^2 + 4 N sin^2(theta/2)): (log k0, log N), energy, force."""

    def rate(theta: float, k0: float, N: float) -> float:
        return math.sqrt(k0 * k0 + 4.0 * N * math.sin(theta / 2.0) ** 2)

    def integral(weigh: object, k0: float, N: float) -> float:
        how = {"epsabs": 1e-13, "epsrel": 1e-12, "limit": 400}
        return 2.0 * quad(lambda theta: weigh(theta, rate(theta, k0, N)), 0.0, math.pi, **how)[0]

    def misses(p: list[float]) -> list[float]:
        k0, N = np.exp(p)
        length = integral(lambda _, r: 1.0 / r, k0, N)
        return [length - 1.0, integral(lambda theta, r: math.cos(theta) / r, k0, N) - distance]

    found = fsolve(misses, guess, xtol=1e-13)
    k0, N = np.exp(found)
    return found, 0.5 * integral(lambda _, r: r, k0, N), N


def test_a_loop_is_followed_where_rounding_limits_every_mesh() -> None:
    # The loop may slide along the rod, more softly the tighter it is: rounding, amplified by that, is above
    # tol from 0.7 on.
    law = rb.LinearLaw(EI1=3.0, EI2=1.0, GJ=1.5, inextensible=True)
    scene = rod(law=law, end=rb.Clamped(position=(0.0, 0.0, 0.3)))
    start = rb.solve(scene, guess=np.array([0.0, 0.0, 2.0 * math.pi, 0.0]))
    diagram = rb.trace(scene, "end.position[2]", (0.3, 0.78), start=start, depth=0)
    assert diagram.branches[0].ended == ("start", "span")
    guess = [0.0, 4.0]
    for distance in (0.4, 0.5, 0.6, 0.7, 0.74, 0.77):
        guess, energy, force = loop(distance, guess)
        (state,) = diagram.states_at(distance)
        # that the loop slides costs no energy: of the square of it
        assert state.energy == pytest.approx(energy, rel=1e-9)
        assert state.reactions.end.force[2] == pytest.approx(force, rel=1e-7)


def test_clamps_turned_to_the_last_bit_are_the_same() -> None:
    # A quaternion of this vector has a norm of 1 but for rounding, and is the same if it is given anew.
    rotation = (0.11998518245746842, 0.4923802043326623, 0.12653434343498401)
    end = rb.Clamped(position=(0.0, 0.0, 0.95), rotation=rotation)
    assert rb.Clamped(rotation=end.rotation).rotation == end.rotation
    scene = rod(law=rb.LinearLaw(EI1=3.0, EI2=1.0, GJ=1.0, inextensible=True), end=end)
    assert rb.trace(scene, "end.twist_turns", (0.0, 0.05), depth=0).branches[0].ended == ("start", "span")


def test_steps_beyond_where_a_ribbon_can_be_are_shortened() -> None:
    # Along its thickness a step may lead where there is none.
    growth = rb.growth.edge(0.024)
    scene = rb.Scene(rb.Ribbon(10.0, 1.0, 0.05), growth)
    diagram = rb.trace(scene, "ribbon.thickness", (0.02, 0.3), depth=4)
    assert all("failed" not in branch.ended for branch in diagram.branches)
    for thickness in (0.025, 0.05, 0.1, 0.2):
        ribbon = rb.Ribbon(10.0, 1.0, thickness)
        known = {tuple(abs(shape.strains[0, 1:]).round(9)) for shape in rb.natural_shapes(ribbon, growth)}
        traced = {tuple(abs(state.strains[0, 1:]).round(9)) for state in diagram.states_at(thickness)}
        assert traced == known


def test_point_loads_stay_where_they_are_on_meshes_of_traces() -> None:
    # S/L times L is not S for one in fourteen of these places.
    L, eta, P = 10.0, 0.1, 2e-7
    for S in np.round(np.arange(1.0, 9.0, 0.1), 10).tolist():
        scene = rb.Scene(rb.Ribbon(L, 1.0, eta), loads=[rb.PointLoad(S, force=(P, 0.0, 0.0))])
        traced = rb.trace(scene, "loads[0].force[0]", (0.0, P), depth=0).branches[0].state(-1)
        # the moment at the clamp is P S but for the square of the slope, P S^2/(2 EI) < 1e-2
        assert abs(traced.reactions.start.moment[1]) == pytest.approx(P * S, rel=1e-4)
        assert traced.energy == pytest.approx(rb.solve(scene).energy, rel=1e-9)


def test_free_ribbons_take_few_steps_along_an_amplitude() -> None:
    # Relaxed gradients are quadratic in growth: by their derivative steps are predicted.
    eta = 0.002
    profile = rb.growth.Profile(
        gamma33=[[2.2e-5, -9.2e-5, -7.2e-5], [-1.1e-5, 7.5e-5], [-1.1e-5], [1.9e-4, -5.9e-5, -3.8e-6, -1e-4]],
        d22=[[-2.2e-3, -3.3e-3, -6e-5, 1.5e-3], [-3.8e-3, 2.5e-3, -4.9e-3], [-2.7e-3], [-2.7e-3, 1.9e-3]],
        d23=[[-4.9e-3, -3.8e-4, 3e-4, -3.6e-3], [2.6e-4, -2.3e-3, 6.7e-3], [-1.2e-3, 6.5e-4], [4.3e-3]],
        breaks=(-0.3157, -0.1152, 0.3722),
        name="profile",
    )
    scene = rb.Scene(rb.Ribbon(10.0, 1.0, eta), profile + rb.growth.edge(-8.65 * eta**2))
    diagram = rb.trace(scene, "growth.profile.amplitude", (-0.34, 2.34))
    assert all(branch.ended[1] == "span" for branch in diagram.branches)
    assert max(branch.parameter.size for branch in diagram.branches) < 60
    shapes = rb.natural_shapes(scene.ribbon, scene.growth)
    assert len(diagram.states_at(1.0)) == len(shapes)


def test_points_of_a_branch_that_fails_meet_the_tolerance() -> None:
    eta = 0.01308589
    growth = rb.growth.Profile(
        gamma33=[0.35322 * eta**2, -0.51916 * eta**2, -0.09301 * eta**2],
        d33=[0.30087 * eta, 0.36748 * eta],
        d22=[0.94518 * eta],
        d23=[-0.3925 * eta, -0.02606 * eta, 0.30535 * eta],
    )
    ribbon = rb.Ribbon(6.90947, 1.0, eta, material=rb.Isotropic(Y=3.0, nu=0.293114))
    end = rb.Clamped(position=(0, 0, 6.8078), rotation=(0.7406, 0.08422, 0.51668), twist_turns=-0.17311)
    scene = rb.Scene(ribbon, growth, end=end)
    # On elements of the default degree it does not fail.
    (branch,) = rb.trace(scene, "end.position[2]", (6.39326, 6.87692), depth=0, degree=5).branches
    assert branch.ended[1] == "failed"
    assert branch.parameter.size > 1
    assert all(branch.state(i).report.error <= 1e-10 for i in range(branch.parameter.size))


@pytest.mark.parametrize("omega", [0.25, 0.75, 1.5, 2.5])
@pytest.mark.parametrize("first", ["ribbon.thickness", "growth.edge.amplitude"])
def test_locus_of_the_helical_threshold_by_either_parameter(first: str, omega: float) -> None:
    # xi = 4.5467 eta^2 + k^2/8 at k = K3 = d/2 / (1 - 18.187/20); along the thickness the trace begins with a
    # helix, which meets the twisted ribbon from the side
    eta, c = 0.02, (math.sqrt(259.0) - 7.0) / 2.0
    d = 2.0 * omega * eta
    k = 0.5 * d / (1.0 - (math.sqrt(1036.0) - 14.0) / 20.0)

    def threshold(eta: float) -> float:
        return c * eta**2 + k**2 / 8.0

    xi = threshold(eta)
    scene = rb.Scene(rb.Ribbon(10.0, 1.0, eta), rb.growth.edge(xi) + rb.growth.chiral(d))
    spans = {"ribbon.thickness": (0.6 * eta, 1.5 * eta), "growth.edge.amplitude": (0.5 * xi, 1.6 * xi)}
    other = {"ribbon.thickness": "growth.edge.amplitude", "growth.edge.amplitude": "ribbon.thickness"}[first]
    diagram = rb.trace(scene, first, spans[first], depth=1)
    here = eta if first == "ribbon.thickness" else xi
    points = [p for p in diagram.special_points if p.kind == "branch_point"]
    point = min(points, key=lambda p: abs(p.parameter / here - 1.0))
    assert point.parameter == pytest.approx(here, rel=1e-9)
    locus = rb.trace_locus(diagram, point, other, spans[other])
    assert locus.ended == ("span", "span")
    assert len(locus.values) < 80
    values = locus.values if first == "ribbon.thickness" else locus.values[:, ::-1]
    np.testing.assert_allclose(values[:, 1], threshold(values[:, 0]), rtol=1e-10)


def test_a_tape_spring_ends_where_its_section_bears_no_more() -> None:
    # curved across, bent by a force at its tip: determinate up to the greatest moment of the section, which
    # the clamp meets first, at 3.6473562e-6 by shooting
    strip = rb.Scene(rb.Ribbon(10.0, 1.0, 0.02), rb.growth.Profile(d22=[0.6]))
    start = rb.solve(strip, method="collocation")
    (branch,) = rb.trace(strip, "end.force[0]", (0.0, 6.6667e-6), start=start, depth=0).branches
    assert branch.ended == ("start", "section instability")
    assert branch.parameter[-1] == pytest.approx(3.6473562e-6, rel=1e-6)


@pytest.mark.parametrize("amplitude", [1.8, 2.3, 2.5])
def test_rings_next_to_a_section_instability(amplitude: float) -> None:
    # the ring bears any gradient through its thickness, and all its ways to bend soften at once
    scene = rb.Scene(rb.Ribbon(10.0, 1.0, 0.05), rb.growth.thickness(0.01), start=rb.Closed())
    diagram = rb.trace(scene, "growth.thickness.amplitude", (0.0, 1.2 * math.pi))
    (state,) = diagram.states_at(amplitude)
    np.testing.assert_allclose(state.strains[:, 2], 2.0 * math.pi / 10.0, rtol=1e-9)
    assert state.stable


@pytest.mark.parametrize(("own", "asked"), [(5, None), (5, 8), (7, 3), (4, 5)])
def test_a_start_may_have_elements_of_another_degree(own: int, asked: int | None) -> None:
    scene = rb.Scene(rb.Ribbon(10.0, 1.0, 0.1), law="linear", end=rb.Clamped(position=(0, 0, 9.0)))
    start = rb.solve(scene, degree=own)
    diagram = rb.trace(scene, "end.position[2]", (8.5, 9.0), start=start, depth=0, degree=asked)
    (first,) = diagram.states_at(9.0)
    assert first.report.degree == (asked or 7)
    # Both are the same equilibrium, to the tolerance of either, 1e-10.
    force = first.reactions.start.force
    assert force == pytest.approx(start.reactions.start.force, abs=1e-8 * abs(force[2]))
