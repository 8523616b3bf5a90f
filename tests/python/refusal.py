"""What every number refuses, and how a refusal looks."""

import math

import numpy as np
import pytest
import ribbonrs as rb

NOT_NUMBERS = [True, "1", None, [1.0], 1j, np.bool_(True), np.array([1.0]), object()]
NOT_FINITE = [math.nan, math.inf, -math.inf, np.float64("nan"), 10**400, pytest.param(16**5000, id="huge")]


def refuses(field, make):
    """Check that `make` raises one InputError line about `field`."""
    with pytest.raises(rb.InputError) as caught:
        make()
    error = caught.value
    assert error.field == field
    assert error.expected
    assert str(error).startswith(field)
    assert ": expected " in str(error)
    assert len(str(error).splitlines()) == 1
    assert len(str(error)) < 400
