"""How the methods that the build makes (_studies.py) ask the library: what was told, as texts of the program's options."""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from typing import Any

from . import _softland
from ._bench import bench_of
from ._outcome import Outcome
from ._progress import Progress, shown
from ._waveform import Waveform

Told = Mapping[str, "Sequence[Any] | None"]


def _quantity(value: float | str | None, unit: str) -> list[str] | None:
    """A number counts in the SI unit."""
    return None if value is None else [value if isinstance(value, str) else f"{float(value)!r} {unit}".rstrip()]


def _whole(value: int | None) -> list[str] | None:
    return None if value is None else [str(int(value))]


def _text(value: str) -> list[str] | None:
    return [value] if value else None


def _path(value: str | os.PathLike[str] | None) -> list[str] | None:
    return None if value is None else [os.fspath(value)]


def _flag(value: bool) -> list[str] | None:
    return [""] if value else None


def _joined(values: str | Sequence[float] | None) -> list[str] | None:
    if values is None or isinstance(values, str):
        return None if values is None else [values]
    return [",".join(repr(float(one)) for one in values)] if len(values) else None


def _pairs(values: Mapping[str, float | str] | None, between: str) -> list[str] | None:
    return [",".join(f"{key}{between}{one}" for key, one in values.items())] if values else None


def _assigned(values: Mapping[str, float | str] | None) -> list[str] | None:
    return [f"{key}={one if isinstance(one, str) else f'{float(one)!r} V'}" for key, one in values.items()] if values else None


def command() -> str:
    return f"python3 {sys.argv[0]}".strip() if sys.argv and sys.argv[0] not in ("", "-c") else "python3"


def natives(waveforms: Mapping[str, Waveform] | None) -> dict[str, Any]:
    return {drive: waveform._native for drive, waveform in (waveforms or {}).items()}


class Studying:
    """A scene that can be asked."""

    _native: _softland.Scene

    def _study(
        self, verb: str, told: Told, progress: bool | Progress | None, waveforms: Mapping[str, Mapping[str, Waveform]] | None = None
    ) -> Outcome:
        with ExitStack() as stack:
            # Measurements stand in a file for as long as they are asked for.
            texts = {
                option: [one if isinstance(one, str) else stack.enter_context(bench_of(one)) for one in values]
                for option, values in told.items()
                if values
            }
            tell = stack.enter_context(shown(progress))
            others = {name: natives(one) for name, one in (waveforms or {}).items()}
            outcome = Outcome(self._native.study(verb, texts, others, command(), tell))
        return outcome
