"""Helpers of the generated methods (_studies.py): they convert arguments to texts of the options of the program, and run a verb."""

from __future__ import annotations

import os
import sys
import warnings
from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import _softland
from ._bench import bench_of
from ._closing import Closing
from ._errors import InvalidInput
from ._outcome import Outcome
from ._progress import Progress, shown
from ._tuning import PracticeDevice, Tuning
from ._waveform import OwnWaveform, Waveform

if TYPE_CHECKING:
    from ._results import Store

Told = Mapping[str, "Sequence[Any] | None"]


def _quantity(value: float | str | None, unit: str) -> list[str] | None:
    """Returns a quantity as text; a number is in the SI unit."""
    return None if value is None else [value if isinstance(value, str) else f"{float(value)!r} {unit}".rstrip()]


def _whole(value: int | None) -> list[str] | None:
    return None if value is None else [str(int(value))]


def _text(value: str | int | None) -> list[str] | None:
    return None if value is None or value == "" else [str(value)]


def _path(value: str | os.PathLike[str] | None) -> list[str] | None:
    return None if value is None else [os.fspath(value)]


def _paths(values: Sequence[str | os.PathLike[str]]) -> list[str]:
    return [os.fspath(one) for one in values]


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


def _settings(values: Mapping[str, Any] | Sequence[str] | None) -> list[str] | None:
    """Returns texts KEY=VALUE of a mapping, or given texts unchanged."""
    if not isinstance(values, Mapping):
        return None if values is None else list(values)
    return [f"{key}={str(one).lower() if isinstance(one, bool) else one}" for key, one in values.items()]


def _errors(errors: Mapping[str, float | str] | None, *more: str) -> dict[str, list[str] | None]:
    """Returns errors of instruments as the options of the same names."""
    units = {"edge_error": "s", "unseen": "s", "gain_error": "", "shot_error": "", **dict.fromkeys(more, "s")}
    for name in errors or {}:
        if name not in units:
            raise ValueError(f"errors: unknown name {name!r}; choose from {', '.join(units)}")
    return {name.replace("_", "-"): _quantity(value, units[name]) for name, value in (errors or {}).items()}


def command() -> str:
    return f"python3 {sys.argv[0]}".strip() if sys.argv and sys.argv[0] not in ("", "-c") else "python3"


def natives(waveforms: Mapping[str, Waveform] | None) -> dict[str, Any]:
    return {drive: waveform._native for drive, waveform in (waveforms or {}).items()}


def texts(told: Told) -> dict[str, list[str]]:
    return {option: list(values) for option, values in told.items() if values}


class Studying:
    """Base class of a scene, with the computations that have Python code of their own."""

    _native: _softland.Scene

    def _simulate(self, told: Told, progress: bool | Progress | None, waveforms: Mapping[str, Waveform] | None) -> Closing:
        with shown(progress) as tell:
            return Closing(self._native.simulate(texts(told), natives(waveforms), command(), tell))

    def _optimize(
        self,
        told: Told,
        progress: bool | Progress | None,
        objective: Callable[[dict[str, Any], dict[str, float]], Any] | None,
        lands_first: bool,
        own_waveforms: Sequence[OwnWaveform],
        start: Sequence[Mapping[str, Waveform]],
        out: str | os.PathLike[str] | None,
        callback: Callable[[int, float, float, float], Any] | None,
    ) -> Outcome:
        name = getattr(objective, "__name__", "own")
        objects = {
            "objective": None if objective is None else _softland.PythonObjective(name, objective, lands_first),
            "own_waveforms": [one._function for one in own_waveforms],
            "starts": [natives(one) for one in start],
            "out": "" if out is None else os.fspath(out),
            "callback": callback,
            "command": command(),
        }
        with shown(progress) as tell:
            return Outcome(_softland.optimize(self._native, texts(told), {**objects, "progress": tell}))

    def _explore(self, told: Told, progress: bool | Progress | None) -> Store:
        from ._results import Store

        if not told["vary"]:
            raise InvalidInput('vary: no key varies: give {"gap.contact": "1.6 um:2.4 um:7"}')
        with shown(progress) as tell:
            _softland.explore(self._native, texts(told), command(), tell)
        return Store(Path((told["out"] or [""])[0]))

    def _export(self, told: Told, progress: bool | Progress | None, waveforms: Mapping[str, Waveform] | None) -> str:
        """Warns if the switch closes less well under the samples than under the waveform itself."""
        scene = self._native.copy() if waveforms else self._native
        for drive, one in (waveforms or {}).items():
            is_own = one.family not in _softland.families
            scene.set_waveform(drive, (Waveform.table(*one.points(self._native.duration())) if is_own else one)._native)
        with shown(progress) as tell:
            found = scene.study("export", texts(told), {}, command(), tell)
        for line in found.notes:
            if not line.startswith(("as sampled", "amplifier of drive")):
                warnings.warn(line.removeprefix("warning: "), stacklevel=4)
        return found.text

    def _device(self, told: Told, progress: bool | Progress | None, errors: Mapping[str, float | str] | None) -> PracticeDevice:
        with shown(progress) as tell:
            return PracticeDevice(_softland.PracticeDevice(self._native, texts({**told, **_errors(errors)}), tell))

    def _tuning(
        self,
        told: Told,
        progress: bool | Progress | None,
        errors: Mapping[str, float | str] | None,
        out: str | os.PathLike[str] | None,
    ) -> Tuning:
        folder = None if out is None else Path(out)
        if folder is not None:
            folder.mkdir(parents=True, exist_ok=True)
        elif told["resume"]:
            raise ValueError("resume: requires `out`, the folder of the tuning to continue")
        log = "" if folder is None else str(folder / "closings.jsonl")
        with shown(progress) as tell:
            return Tuning(_softland.Tuning(self._native, texts({**told, **_errors(errors, "trigger_delay")}), log, command(), tell), folder)

    def _study(
        self, verb: str, told: Told, progress: bool | Progress | None, waveforms: Mapping[str, Mapping[str, Waveform]] | None = None
    ) -> Outcome:
        with ExitStack() as stack:
            # Given measurements are in a temporary file during the fit.
            texts = {
                option: [one if isinstance(one, str) else stack.enter_context(bench_of(one)) for one in values]
                for option, values in told.items()
                if values
            }
            tell = stack.enter_context(shown(progress))
            others = {name: natives(one) for name, one in (waveforms or {}).items()}
            outcome = Outcome(self._native.study(verb, texts, others, command(), tell))
        return outcome
