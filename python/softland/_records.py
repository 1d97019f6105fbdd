"""Numbers with unit and error, and results whose attributes are the keys of the JSON of softland without the unit."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

# Endings of the keys of every JSON of softland, with their units.
_ENDINGS = {
    "_rad2_s2": "rad^2/s^2", "_rad_s": "rad/s", "_m_s2": "m/s^2", "_m_s": "m/s", "_V_s": "V/s", "_N_m": "N/m", "_kg_m3": "kg/m^3",
    "_s": "s", "_m": "m", "_V": "V", "_N": "N", "_J": "J", "_F": "F", "_Hz": "Hz", "_Pa": "Pa", "_K": "K", "_W": "W", "_C": "C", "_A": "A",
}  # fmt: skip


def unit_of_key(key: str) -> tuple[str, str]:
    """Splits a key: "impact_velocity_m_s" gives ("impact_velocity", "m/s"); the unit is empty if the key has none."""
    for ending, unit in _ENDINGS.items():
        if key.endswith(ending) and len(key) > len(ending):
            return key[: -len(ending)], unit
    return key, ""


class Quantity(float):
    """A float in SI units with its unit and its error. Arithmetic gives plain floats.

    unit: SI symbol, such as "m/s"; empty for a plain number.
    error: absolute, in the same unit; NaN if not estimated.
    """

    __slots__ = ("unit", "error")
    unit: str
    error: float

    def __new__(cls, value: float, unit: str = "", error: float = math.nan) -> Quantity:
        self = super().__new__(cls, value)
        self.unit = unit
        self.error = error
        return self

    def __reduce__(self) -> tuple[type[Quantity], tuple[float, str, float]]:
        return Quantity, (float(self), self.unit, self.error)

    def __repr__(self) -> str:
        value = float.__repr__(self)
        if not math.isnan(self.error):
            value += f" ± {self.error:.2g}"
        return f"{value} {self.unit}" if self.unit else value


class Record(Mapping[str, Any]):
    """A part of a result. Its keys are those of the JSON that the program writes; attributes have the same names without the unit.

    >>> found.pull_in.static            # found["pull_in"]["static_V"]
    16.209 V

    Numbers whose key has a unit are `Quantity`, NaN where the program writes null; lists of them are NumPy arrays (n,).
    docs/reference/json.md has the keys of each verb. Made by `softland.open`, and by the verbs as `Outcome`.
    """

    def __init__(self, data: Mapping[str, Any], errors: Mapping[str, Any] | None = None) -> None:
        self._data = dict(data)
        self._errors = dict(errors or {})

    def __getitem__(self, key: str) -> Any:
        return self._value(key)

    def __iter__(self) -> Iterator[str]:
        return iter(self._data)

    def __len__(self) -> int:
        return len(self._data)

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        if name in self._data:
            return self._value(name)
        for key in self._data:
            if unit_of_key(key)[0] == name:
                return self._value(key)
        raise AttributeError(f"unknown attribute {name!r}; choose from {', '.join(self.__dir__())}")

    def __dir__(self) -> list[str]:
        return [unit_of_key(key)[0] for key in self._data]

    def __repr__(self) -> str:
        return "\n".join(_lines(self)) or "Record()"

    def to_json(self) -> Any:
        """Returns plain dicts, lists, floats and None, as json.dump() accepts them."""
        return self._data

    def _value(self, key: str) -> Any:
        return _wrapped(self._data[key], unit_of_key(key)[1], self._errors.get(key))


def _wrapped(value: Any, unit: str, error: Any = None) -> Any:
    if isinstance(value, Mapping):
        if unit and all(isinstance(one, (int, float)) or one is None for one in value.values()):
            return {key: _wrapped(one, unit) for key, one in value.items()}
        return Record(value)
    if isinstance(value, list):
        if value and all(isinstance(one, (int, float)) and not isinstance(one, bool) or one is None for one in value):
            return np.array([math.nan if one is None else one for one in value], dtype=float)
        return [_wrapped(one, "") for one in value]
    if isinstance(value, bool) or isinstance(value, str):
        return value
    if value is None:
        return Quantity(math.nan, unit) if unit else None
    if isinstance(value, float) or unit:
        return Quantity(value, unit, math.nan if error is None else float(error))
    return value


# The origin of a result, which its representation leaves out.
_ORIGIN = ("command", "made_with", "reproduce", "scene", "scene_toml", "version", "curves")


def _lines(record: Record, depth: int = 0) -> Iterator[str]:
    for key in record:
        name = unit_of_key(key)[0]
        value = record[key]
        if (depth == 0 and key in _ORIGIN) or (isinstance(value, float) and math.isnan(value)):
            continue
        if isinstance(value, Record):
            yield "  " * depth + f"{name}: {'' if depth < 2 else '...'}".rstrip()
            if depth < 2:
                yield from _lines(value, depth + 1)
        elif isinstance(value, list) and (len(value) > 4 or any(isinstance(one, Record) for one in value)):
            yield "  " * depth + f"{name}: {len(value)} of them"
        elif isinstance(value, str) and len(value) > 200:
            yield "  " * depth + f"{name}: {value[:60]!r}..."
        else:
            text = np.array2string(value, threshold=6) if isinstance(value, np.ndarray) else repr(value)
            yield "  " * depth + f"{name}: {text}"


def read(text: str) -> Record:
    """Returns the record of the text of a JSON object."""
    return Record(json.loads(text))
