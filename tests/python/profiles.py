"""Profiles across the width, and how they are refused."""

import numpy as np
import pytest
import ribbonrs as rb

EPS = np.finfo(float).eps
X = np.random.default_rng(7).uniform(-0.5, 0.5, 4000)


def gamma33(x=X, **given):
    """The axial growth of a profile at x."""
    return rb.growth.Profile(**given).values(x)["gamma33"]


def shape(**given):
    """The one field of a profile as it is kept."""
    return rb.growth.Profile(**given).terms[0].shape[0][1]


def line(**given):
    """The one line in which a profile is refused."""
    with pytest.raises(rb.InputError) as caught:
        rb.growth.Profile(**given)
    assert len(str(caught.value).splitlines()) == 1
    assert len(str(caught.value)) < 400
    return str(caught.value)
