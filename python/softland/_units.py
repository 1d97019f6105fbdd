"""Converts text with a unit to SI numbers."""

from __future__ import annotations

from typing import Any

from . import _softland
from ._records import Quantity


def units(text: str) -> Quantity:
    """Returns the SI number of a text, as the program reads it: units("250 um") is 0.00025 with the unit "m".

    Vsp and Vdp are not converted. Raises InvalidInput with the broken rule.
    """
    value, unit = _softland.units(text)
    return Quantity(value, unit)


def number(value: Any) -> Any:
    """Returns a number unchanged, a text with a unit as its SI number, and lists element by element."""
    if isinstance(value, str):
        return float(units(value))
    if isinstance(value, (list, tuple)):
        return [number(one) for one in value]
    return value
