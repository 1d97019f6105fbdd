"""A waveform tuned on one device, closing after closing."""

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
    """One closing that a device is asked for, open loop.

    Attributes: `number`, from 1; `waveforms`, {drive: Waveform}, tables that begin at t = 0, in volts at the switch; `amplifiers`, {drive: volts at the
    switch per volt of its generator}, 1 where [driver] has no amplifier; `hold`, how long the last levels are held [s]; `duration`, how long the contact is
    recorded from t = 0 on [s].
    """

    def __init__(self, told: tuple[int, float, float, dict[str, _softland.Waveform], str]) -> None:
        self.number, self.hold, self.duration, drives, self._line = told
        self.waveforms = {drive: Waveform._of(one) for drive, one in drives.items()}
        self.amplifiers = {drive: float(one.get("amplifier", 1)) for drive, one in self.line["drives"].items()}

    def points(self, drive: str = "main") -> tuple[Array, Array]:
        """Times [s] and voltages [V] between which a drive goes straight, (n,) and (n,); two of one time are a jump, the last one is held."""
        table = self.waveforms[drive].parameters
        return np.array(table["times"]), np.array(table["voltages"])

    def samples(self, rate: float, drive: str = "main") -> Array:
        """Voltages at the switch [V] at k / rate [Hz], (n,), from t = 0 up to `duration`; a generator plays them over `amplifiers[drive]`."""
        return np.asarray(self.waveforms[drive](np.arange(int(np.ceil(self.duration * rate)) + 1) / rate))

    @property
    def line(self) -> dict[str, Any]:
        """As a program is told by `softland tune --device` (docs/tune.md)."""
        return dict(json.loads(self._line))

    def __repr__(self) -> str:
        return f"<Shot {self.number}: {', '.join(self.waveforms)}, recorded for {self.duration:.4g} s>"


Device = Callable[[Shot], "Mapping[str, Any] | None"]


class Tuning:
    """A tuning under way: made by `Scene.tuning`, and run by `run(device)`, or shot by shot: `learn(fire(tuning.shot()))`.

    All closings stay in it whatever the device raises, and on Ctrl-C: `run` goes on where it stopped, `result()` tells what is known by now. With
    `out` they are on the disk as well, each before the next is fired. Use it from one thread at a time.
    """

    def __init__(self, native: _softland.Tuning, out: Path | None) -> None:
        self._native = native
        self._out = out
        self._pending: str | None = None

    @property
    def closings(self) -> int:
        """Closings that were learned."""
        return self._native.closings

    @property
    def is_done(self) -> bool:
        """Whether five in a row were without a bounce."""
        return self._native.is_done

    def shot(self) -> Shot:
        """What is to be fired next; the same until an answer is learned."""
        return Shot(self._native.shot())

    def learn(self, answer: Mapping[str, Any] | None, progress: bool | Progress | None = False) -> str:
        """Learns what the contact did under `shot()`, and proposes the next shot. Returns a line about this closing and the next.

        answer: {"edges_s": [[time, 1 closes or 0 opens], ...]} or {"closing_time_s": t or None, "bounce_count": n}, either with "loudness"; or
            {"error": "no trigger"}: the same waveform comes again. None, or no edges: the contact stayed open.
        Raises InvalidInput for what cannot be an answer, which is not learned. After Ctrl-C here the answer is on record: the next call learns that one.
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
        except KeyboardInterrupt:  # recorded, and not learned yet
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
        """Fires shots until five closings in a row are without a bounce, or `closings` are used. The last one is of the waveform kept.

        device: called with each `Shot`, returns an answer as `learn` takes it. What it raises comes through.
        callback: called with a line about each closing; one that returns True ends the tuning.
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
        """What is known by now: a `Record` of tune.json with the files best.toml, best.csv, tune.json, tune.html. `end` is its `status`."""
        return Outcome(self._native.outcome(end))

    def _write(self, end: str) -> None:
        if self._out is not None:
            self.result(end).save(self._out)

    def __repr__(self) -> str:
        return f"<Tuning: {self.closings} closings>"


class PracticeDevice:
    """A simulated device in a simulated laboratory, as `softland device`: one of the scene's spread, told of by nothing but its answers.

    Called with a `Shot` it returns {"shot": number, "edges_s": [[time, 1 closes or 0 opens], ...]}. Shots do not depend on each other. Made by
    `Scene.device`.
    """

    def __init__(self, native: _softland.PracticeDevice) -> None:
        self._native = native

    def __call__(self, shot: Shot) -> dict[str, Any]:
        return dict(json.loads(self._native.answer(shot._line)))


def _plain(value: Any) -> Any:
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, np.generic):
        return value.item()
    raise TypeError(f"{value!r} cannot be part of an answer")


__all__ = ["Device", "PracticeDevice", "Shot", "Tuning"]

