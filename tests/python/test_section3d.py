"""How good the section law is: against the section as a body in three dimensions, at nu = 0.3."""

import numpy as np
import pytest
import ribbonrs as rb
from foppl_von_karman import isotropic, threshold
from scipy.optimize import brentq
from section3d import Section

NU = 0.3
MATERIAL = rb.Isotropic(nu=NU)
ETAS = np.array([0.1, 0.05, 0.025])
EDGE = 0.630
"""Saint-Venant: a bar a x h has the torsional stiffness G a h^3/3 (1 - 0.630 h/a + ...)."""


def tensor(growth):
    """g at X1, X2, of which the shear g23 + g32 = X1 d23 is halved."""

    def g(X1, X2):
        fields = {**dict.fromkeys(rb.growth.FIELDS, np.zeros(X1.size)), **growth.values(X2)}
        tensor = np.zeros((X1.size, 3, 3))
        tensor[:, 2, 2] = fields["gamma33"] + X1 * fields["d33"]
        tensor[:, 1, 1] = X1 * fields["d22"]
        tensor[:, 1, 2] = tensor[:, 2, 1] = X1 * fields["d23"] / 2
        return tensor

    return g


def part_off(growth, strain, eta):
    """The law's energy over that of the body, less 1."""
    body = Section(eta, NU, tensor(growth)).energy(strain)
    return float(rb.SectionLaw(eta, growth, MATERIAL).energy(strain)) / body - 1


def saint_venant(eta):
    """The torsional stiffness of a rectangle over G a h^3, his series."""
    n = np.arange(1, 40, 2)
    return (1 - 192 * eta / np.pi**5 * np.sum(np.tanh(n * np.pi / 2 / eta) / n**5)) / 3


@pytest.mark.parametrize("eta", ETAS[:2])
def test_torsion_is_saint_venants(eta):
    K3 = 1e-5
    energy = Section(eta, NU, through=7, across=40).energy([0.0, 0.0, 0.0, K3])
    # The corners of the section limit the convergence of polynomials.
    assert energy / (0.5 * K3**2 * eta**2 / (2 * (1 + NU))) == pytest.approx(saint_venant(eta), rel=1e-5)
    assert 3 * saint_venant(eta) == pytest.approx(1 - EDGE * eta, abs=1e-4)


def test_a_stretched_body_by_hand():
    """E33 = eps + eps^2/2 under free sides: half its square."""
    assert Section(0.1, NU).energy([0.03, 0, 0, 0]) == pytest.approx((0.03 + 0.03**2 / 2) ** 2 / 2, rel=1e-12)


def test_a_cylinder_is_free_of_stress():
    growth = rb.growth.thickness(0.3)
    body = Section(0.1, NU, tensor(growth))
    flat = body.energy([0.0, 0.0, 0.0, 0.0])
    assert flat > 1e-5
    assert body.energy([0.0, 0.0, -0.3, 0.0], tol=1e-3) < 1e-25


@pytest.mark.parametrize("growth", ["edge", "saddle"])
def test_bent_sections_are_off_by_second_order(growth):
    """At fixed K/eta and growth in proportion; from 0.1 on."""

    def off(eta):
        if growth == "edge":
            return part_off(rb.growth.edge(5 * eta**2), [eta**2, 0.0, 3 * eta, 0.0], eta)
        return part_off(rb.growth.thickness(3 * eta, -1.5 * eta), [0.0, 0.0, -2 * eta, 0.0], eta)

    parts = np.array([off(eta) for eta in ETAS])
    assert abs(parts[0]) < 0.06
    # The fourth order shows: what the measured order misses falls to a quarter.
    early, late = np.abs(np.log2(parts[:-1] / parts[1:]) - 2.0)
    assert early < 0.25
    assert late < early / 3


def test_twisted_sections_are_off_by_the_edges_of_saint_venants_bar():
    """By the part EDGE eta of the energy of twist, and second order."""
    strain = np.array([0.0, 0.0, 0.0, 2.0])
    rest = []
    for eta in ETAS:
        none = rb.growth.Growth(())
        energy = float(rb.SectionLaw(eta, none, MATERIAL).energy(strain * eta))
        twist = eta**4 * strain[3] ** 2 / 12 / (1 + NU)
        rest.append(part_off(none, strain * eta, eta) - EDGE * eta * twist / energy)
    assert abs(rest[0]) < 0.02
    # Corners of the section and the product of both parts: between second and third order is not told apart.
    assert rest[1] < 0.4 * rest[0]
    assert rest[2] < 0.4 * rest[1]


def onset(strain, long_waves, eta):
    """xi/eta^2 at which the flat body loses its stiffness against K2 (2) or K3 (3)."""

    def stiffness(scaled):
        xi, step, curvature = scaled * eta**2, 1e-2 * eta**2, 0.05 * eta
        body = Section(eta, NU, tensor(rb.growth.edge(xi)), through=4, across=20)

        def energy(eps, strains=(0.0, 0.0, 0.0)):
            return body.energy([eps, *strains], tol=1e-15)

        below, flat, above = (energy(xi / 3 + n * step) for n in (-1, 0, 1))
        eps = xi / 3 - step * (above - below) / 2 / (above - 2 * flat + below)  # no force
        bent = np.zeros(3)
        bent[strain - 1] = curvature
        return (energy(eps, bent) - energy(eps)) / curvature**2 / eta**2

    return brentq(stiffness, 0.85 * long_waves, 1.05 * long_waves, xtol=1e-4)


def test_thresholds_of_the_body():
    """Bending later by second order; twist earlier by EDGE eta and second order."""
    for strain, twist, first in ((2, False, 0.0), (3, True, -EDGE)):
        limit = threshold(0.0, twist, isotropic(NU))
        off = np.array([onset(strain, limit, eta) for eta in ETAS]) / limit - 1
        told = {2: [0.0108, 0.0026, 0.0007], 3: [-0.019, -0.020, -0.013]}[strain]
        assert off == pytest.approx(told, abs=5e-5 if strain == 2 else 5e-4)
        rest = off - first * ETAS
        # What curvatures of 0.05 eta add is below 1e-4.
        assert rest[:-1] / rest[1:] == pytest.approx(4.0, rel=0.15)


SHAPES = {
    "bent": lambda eta: rb.growth.edge(8 * eta**2),
    "helical": lambda eta: rb.growth.edge(8 * eta**2) + rb.growth.chiral(0.8 * eta**2),
    "saddle": lambda eta: rb.growth.thickness(4 * eta, -2 * eta),
}


@pytest.mark.parametrize("eta", ETAS)
@pytest.mark.parametrize("shape", SHAPES)
def test_the_neglected_strains_tell_by_how_much(shape, eta):
    growth = SHAPES[shape](eta)
    state = rb.solve(rb.Scene(rb.Ribbon(10.0, 1.0, eta, MATERIAL), growth))
    part = abs(part_off(growth, state.strain, eta))
    assert part < 2 * state.neglected
    assert part > state.neglected / 4
