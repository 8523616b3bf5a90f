"""Checks of what figures are given."""

from __future__ import annotations

from ..check import Numbers, number, numbers
from ..errors import InputError
from ..ribbon import THINNEST

__all__ = ["growths", "ratio", "ratios"]


def ratio(field: str, value: object) -> float:
    """Return a thickness over width."""
    expected = f"a number from {THINNEST:g} to 1"
    eta = number(field, value, expected)
    if not THINNEST <= eta < 1.0:
        raise InputError(field, value, expected)
    return eta


def ratios(field: str, values: Numbers) -> tuple[float, ...]:
    """Return one or more thicknesses over width."""
    found = numbers(field, values, "a list of numbers, thickness over width")
    if not found:
        raise InputError(field, values, "at least one thickness over width")
    return tuple(ratio(f"{field}[{i}]", value) for i, value in enumerate(found))


def growths(field: str, values: Numbers) -> tuple[float, ...]:
    """Return one or more growths."""
    found = numbers(field, values, "a list of numbers, growth strains")
    if not found:
        raise InputError(field, values, "at least one growth strain")
    return found
