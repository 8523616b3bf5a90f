"""Every example in a docstring of the package runs and prints what it says."""

import doctest
import importlib
import pkgutil

import pytest
import ribbonrs

MODULES = sorted(
    m.name for m in pkgutil.iter_modules(ribbonrs.__path__) if m.name not in ("__main__", "_core")
)
WITH_EXAMPLES = {
    "continuation",
    "deflation",
    "equilibrium",
    "errors",
    "frame",
    "growth",
    "law",
    "locus",
    "measured",
    "parameter",
    "phasediagram",
    "pieces",
    "profile",
    "ribbon",
    "terms",
}


@pytest.mark.parametrize("name", [*MODULES, "__init__"])
def test_examples(name):
    module = ribbonrs if name == "__init__" else importlib.import_module(f"ribbonrs.{name}")
    result = doctest.testmod(module)
    assert result.failed == 0
    if name in WITH_EXAMPLES:
        assert result.attempted > 0
