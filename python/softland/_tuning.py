"""Tuning of a waveform on one device, closing after closing."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _softland
from ._outcome import Outcome
from ._progress import Progress, shown
from ._waveform import Waveform

Array = npt.NDArray[np.float64]


class Shot:
    """A requested closing of a device, open loop: the waveforms to apply. Made by `Tuning.shot`.

    number: number of the shot, from 1.
    waveforms: by drive, tables that begin at t = 0, in volts at the switch.
    amplifiers: by drive, volts at the switch per volt of its generator; 1 where [driver] has no amplifier.
    hold: duration of the last levels [s].
    duration: duration of the record of the contact, from t = 0 on [s].
    """

    def __init__(self, told: tuple[int, float, float, dict[str, _softland.Waveform], str]) -> None:
        self.number, self.hold, self.duration, drives, self._line = told
        self.waveforms = {drive: Waveform._of(one) for drive, one in drives.items()}
        self.amplifiers = {drive: float(one.get("amplifier", 1)) for drive, one in self.line["drives"].items()}

    def points(self, drive: str = "main") -> tuple[Array, Array]:
        """Returns times [s] and voltages [V] that straight lines connect, (n,) and (n,); two equal times are a jump, the last voltage is held."""
        table = self.waveforms[drive].parameters
        return np.array(table["times"]), np.array(table["voltages"])

    def samples(self, rate: float, drive: str = "main") -> Array:
        """Returns the voltages at the switch [V] at k / rate [Hz], (n,), from t = 0 to `duration`; divide by `amplifiers[drive]` for a generator."""
        return np.asarray(self.waveforms[drive](np.arange(int(np.ceil(self.duration * rate)) + 1) / rate))

    @property
    def line(self) -> dict[str, Any]:
        """The line that `softland tune --device` sends to a command (docs/tune.md)."""
        return dict(json.loads(self._line))

    def __repr__(self) -> str:
        return f"<Shot {self.number}: {', '.join(self.waveforms)}, recorded for {self.duration:.4g} s>"


Device = Callable[[Shot], "Mapping[str, Any] | None"]


class Tuning:
    """A tuning of a waveform on one device. Made by `Scene.tuning`, and run by `run(device)`, or shot by shot by
    `learn(fire(tuning.shot()))`.

    All closings are kept after an exception of the device and after Ctrl-C: `run` continues, and `result()` returns the results so far. With `out`, each
    closing is written to the disk before the next shot. Use a tuning from one thread at a time.
    """

    def __init__(self, native: _softland.Tuning, out: Path | None) -> None:
        self._native = native
        self._out = out
        self._pending: str | None = None

    @property
    def closings(self) -> int:
        """Number of closings whose records were used."""
        return self._native.closings

    @property
    def is_done(self) -> bool:
        """True if the last five closings were bounce-free."""
        return self._native.is_done

    def shot(self) -> Shot:
        """Returns the next shot; the same one until learn() is called."""
        return Shot(self._native.shot())

    def learn(self, answer: Mapping[str, Any] | None, progress: bool | Progress | None = False) -> str:
        """Updates the model of the device by the record of the contact under `shot()`, and finds the next shot. Returns a line about both.

        answer: {"edges_s": [[time in s, 1 closes or 0 opens], ...]} or {"closing_time_s": t or None, "bounce_count": n}, optionally with "loudness"; or
            {"error": "no trigger"} to repeat the shot. None, or no edges: the contact stayed open.

        Raises InvalidInput for an invalid answer, which is not used. After Ctrl-C in this call the answer is stored, and the next call uses it.
        """
        self._pending = self._pending or json.dumps({**(answer or {"edges_s": []}), "shot": self._native.shot()[0]}, default=_plain)
        self._learn_pending(progress)
        return self._native.words

    def _learn_pending(self, progress: bool | Progress | None) -> None:
        if self._pending is None:
            return
        try:
            with shown(progress) as tell:
                self._native.learn(self._pending, tell)
        except KeyboardInterrupt:  # the record is stored, but not used yet
            raise
        except BaseException:
            self._pending = None
            raise
        self._pending = None

    def run(
        self,
        device: Device,
        *,
        closings: int = 30,
        callback: Callable[[str], Any] | None = None,
        progress: bool | Progress | None = None,
    ) -> Outcome:
        """Fires shots until five closings in a row are bounce-free, or the number `closings` is reached. The last shot has the final waveform.

        device: called with each `Shot`; returns an answer for `learn`. Its exceptions are raised.
        callback: called with a line about each closing; if it returns True, the tuning ends.
        """
        end = "failed"
        try:
            self._learn_pending(progress)
            while True:
                ended = self._native.ends(closings)
                if ended is not None:
                    end = ended
                    break
                words = self.learn(device(self.shot()), progress)
                self._write("under_way")
                if callback is not None and callback(words):
                    end = "stopped"
                    break
                self._native.throw_if_failing()
        except KeyboardInterrupt:
            end = "interrupted"
            raise
        finally:
            self._write(end)
        return self.result(end)

    def result(self, end: str = "under_way") -> Outcome:
        """Returns the results so far: a `Record` of tune.json with the files best.toml, best.csv, tune.json, tune.html. `end` becomes its `status`."""
        return Outcome(self._native.outcome(end))

    def _write(self, end: str) -> None:
        if self._out is not None:
            self.result(end).save(self._out)

    def __repr__(self) -> str:
        return f"<Tuning: {self.closings} closings>"


class PracticeDevice:
    """A simulated device in a laboratory, as `softland device`: a device drawn from [spread] of the scene, known only by its answers.

    Shots do not depend on each other. Made by `Scene.device`.
    """

    def __init__(self, native: _softland.PracticeDevice) -> None:
        self._native = native

    def __call__(self, shot: Shot) -> dict[str, Any]:
        """Returns the record of the contact under a shot: {"shot": number, "edges_s": [[time in s, 1 closes or 0 opens], ...]}."""
        return dict(json.loads(self._native.answer(shot._line)))


def _plain(value: Any) -> Any:
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, np.generic):
        return value.item()
    raise TypeError(f"{value!r} cannot be part of an answer")


__all__ = ["Device", "PracticeDevice", "Shot", "Tuning"]

