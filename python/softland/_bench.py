"""Writes measurements from Python to the bench file that `fit` reads."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

_UNITS = {
    "pull_in": "V", "release": "V", "frequency": "Hz", "capacitance": "F", "closing_time": "s", "position": "m", "velocity": "m/s", "contact": "V",
}  # fmt: skip
_COLUMNS = {"closing_time": "closing_time_s", "capacitance": "capacitance_F", "frequency": "frequency_Hz",
            "position": "position_m", "velocity": "velocity_m_s", "contact": "voltage_V"}  # fmt: skip
Measurement = Mapping[str, Any]


@contextmanager
def bench_of(data: str | os.PathLike[str] | Sequence[Measurement]) -> Iterator[str]:
    """Yields the path of a bench file: the given one, or a temporary file with the given measurements."""
    if isinstance(data, (str, os.PathLike)):
        yield os.fspath(data)
        return
    with TemporaryDirectory() as folder:
        path = Path(folder) / "measurements.toml"
        path.write_text("\n".join(_section(one, Path(folder), k) for k, one in enumerate(data, 1)))
        yield str(path)


def _section(measurement: Measurement, folder: Path, number: int) -> str:
    from ._scene import _toml

    given = dict(measurement)
    quantity = str(given.get("quantity", ""))
    unit = _UNITS.get(quantity, "")
    if "values" in given and ("times" in given or "levels" in given):
        times = "times" in given
        rows = np.column_stack([np.asarray(given.pop("times" if times else "levels"), float), np.asarray(given.pop("values"), float)])
        header = f"{'time_s' if times else 'level_V'},{_COLUMNS.get(quantity, quantity)}"
        file = folder / f"{number}.csv"
        file.write_text(header + "\n" + "".join(f"{a!r},{b!r}\n" for a, b in rows.tolist()))
        given["file"] = str(file)
    elif "file" in given:
        given["file"] = str(Path(given["file"]).absolute())
    if str(given.get("waveform", "scene")) != "scene":
        given["waveform"] = str(Path(given["waveform"]).absolute())
    for key, of in {"value": unit, "error": "s" if quantity == "contact" else unit, "level": "V", "threshold": "V", "hysteresis": "V", "merge": "s"}.items():
        if key in given:
            given[key] = _with_unit(given[key], of)
    return "[[measurement]]\n" + "".join(f"{key} = {_toml(value)}\n" for key, value in given.items())


def _with_unit(value: Any, unit: str) -> Any:
    """Returns a value as text; numbers are in SI units."""
    if isinstance(value, np.ndarray):
        value = value.tolist()
    if isinstance(value, (list, tuple)):
        return [_with_unit(one, unit) for one in value]
    if isinstance(value, (int, float, np.number)) and not isinstance(value, bool):
        return f"{float(value)!r} {unit}"
    return value
