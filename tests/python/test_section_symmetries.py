"""Exact properties of the compiled section laws: mirror images, scaling with eta, continuity."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from sections import EDGE, SKEW, Fields, law, numbers, samples


@pytest.mark.parametrize("form", ["closed", "general", "second-order"])
def test_mirror_images_of_even_achiral_growth(form: str) -> None:
    tested, strains = law(0.1, EDGE, form), samples(0.1, 4)
    for flip in ([1, 1, -1, 1], [1, 1, 1, -1]):
        signs = np.array(flip, dtype=float)
        np.testing.assert_array_equal(tested.energy(strains * signs), tested.energy(strains))
        np.testing.assert_array_equal(tested.gradient(strains * signs), tested.gradient(strains) * signs)
        mirrored = tested.hessian(strains) * np.multiply.outer(signs, signs)
        np.testing.assert_array_equal(tested.hessian(strains * signs), mirrored)


def test_growth_turned_over_or_end_for_end() -> None:
    """Half turns about d1 and d3 change the signs of two directions each."""
    strains = samples(0.1, 5)
    fields = {**SKEW, "d23": [0.03, 0.1], "g31": [0.0, 0.02, 0.03]}
    tested = law(0.1, fields, "general")

    def odd(name: str, factor: int) -> list[float]:
        return [factor * c * (-1) ** k for k, c in enumerate(fields[name])]

    # About d1, X2 and X3 change sign, and with them g21 and g31. About d3, X1 and X2 do, and with them d33,
    # d22 and g31; d23 changes sign twice, as a shear of X2 and as a gradient in X1.
    turns = [({"g21", "g31"}, [1.0, -1.0, 1.0, 1.0]), ({"d33", "d22", "g31"}, [1.0, -1.0, -1.0, 1.0])]
    for changed, flips in turns:
        signs = np.array(flips)
        turned = law(0.1, {name: odd(name, -1 if name in changed else 1) for name in fields}, "general")
        for (a, scale), (b, _) in zip(
            numbers(tested, strains), numbers(turned, strains * signs), strict=True
        ):
            flipped = {1: 1.0, 2: signs, 3: np.multiply.outer(signs, signs)}[a.ndim]
            assert np.all(np.abs(a - b * flipped) <= 1e-14 * scale)


@pytest.mark.parametrize("form", ["closed", "general"])
def test_everything_scales_with_eta(form: str) -> None:
    """Pi/eta^4 depends on eps/eta^2, K1/eta^2, K2/eta, K3/eta and the growth in the same units alone."""
    fields = {"gamma33": [0.2, 0.0, 3.0], "d33": [0.4], "d23": [1.3], "d22": [-0.7]}
    strains = samples(1.0, 6)

    def scaled(eta: float) -> list[tuple[Any, Any]]:
        growth = {n: [c * (eta**2 if n == "gamma33" else eta) for c in v] for n, v in fields.items()}
        units = np.array([eta**2, eta**2, eta, eta])
        back = {1: eta**-4, 2: units / eta**4, 3: np.multiply.outer(units, units) / eta**4}
        pairs = numbers(law(eta, growth, form), strains * units)
        return [(value * back[value.ndim], scale * back[value.ndim]) for value, scale in pairs]

    for (a, _), (b, _) in zip(scaled(0.5), scaled(2.0**-12), strict=True):
        np.testing.assert_array_equal(a, b)
    for (a, scale), (b, _) in zip(scaled(0.5), scaled(0.013), strict=True):
        assert np.all(np.abs(a - b) <= 1e-13 * scale)


DENSE = np.exp(np.arange(np.log(1e-3), np.log(2e6), 1e-3))  # K2/eta


def test_closed_form_equals_general_law() -> None:
    """Dense in K2: the two change their method at different places, so a jump in either would show."""
    eta = 0.1
    for fields in (
        {"gamma33": [0.3, -0.2, 4.0], "d23": [0.1]},
        {"gamma33": [0, 0, -0.4], "d33": [0.3], "d22": [0.2]},
    ):
        for K3 in (0.0, 0.3):
            strains = np.zeros((DENSE.size, 4))
            strains[:, 2], strains[:, 3] = DENSE * eta, K3
            closed, general = (numbers(law(eta, fields, form), strains) for form in ("closed", "general"))
            for (a, scale), (b, _) in zip(closed, general, strict=True):
                # terms of the second derivatives are up to a hundred times their sum here
                assert np.max(np.abs(a - b) / scale) <= (1e-13 if a.ndim == 3 else 5e-15)


@pytest.mark.parametrize(("fields", "form"), [(EDGE, "closed"), (EDGE, "general"), (SKEW, "general")])
def test_no_jump_anywhere_in_curvature(fields: Fields, form: str) -> None:
    """Each value agrees with the sixth-order interpolant of its neighbours, which a jump would not."""
    eta = 0.1
    strains = np.zeros((DENSE.size, 4))
    strains[:, 2], strains[:, 3] = DENSE * eta, 0.2
    for value, scale in numbers(law(eta, fields, form), strains):
        near = [value[3 + s : value.shape[0] - 3 + s] for s in (-3, -2, -1, 0, 1, 2, 3)]
        predicted = (near[0] + near[6] - 6 * (near[1] + near[5]) + 15 * (near[2] + near[4])) / 20
        assert np.max(np.abs(predicted - near[3]) / scale[3:-3]) <= 1e-14
    beside = strains.copy()
    beside[:, 2] = np.nextafter(strains[:, 2], np.inf)
    for (a, scale), (b, _) in zip(
        numbers(law(eta, fields, form), strains), numbers(law(eta, fields, form), beside), strict=True
    ):
        assert np.max(np.abs(a - b) / scale) <= 1e-14


def test_no_jump_at_zero_curvature() -> None:
    strains = np.zeros((3, 4))
    strains[:, 2], strains[:, 3] = [0.0, 5e-324, 1e-160], 0.2
    for form in ("closed", "general"):
        for value, scale in numbers(law(0.1, SKEW if form == "general" else EDGE, form), strains):
            assert np.all(np.abs(value[1:] - value[0]) <= 1e-15 * scale[1:])
