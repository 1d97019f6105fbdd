"""Waveforms as objects."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _softland
from ._units import number

Array = npt.NDArray[np.float64]


class Waveform:
    """A drive voltage against time [V], [s]. It does not change; what changes it gives a new one.

    >>> pulse = softland.Waveform("pulse", levels=["20 V", "8 V", "16 V"], times=["12 us", "30 us"], edge="1 us")
    >>> pulse(20e-6)
    8.0

    The families and their parameters are those of docs/figures.md and docs/scene.md, numbers in SI units or text with a unit; Vsp and Vdp belong
    to a scene, and stand there. Raises InvalidInput that names parameter, value and rule.
    """

    def __init__(self, family: str, **parameters: Any) -> None:
        self._native = _softland.Waveform.made(family, {key: number(value) for key, value in parameters.items()})

    @classmethod
    def table(cls, times: npt.ArrayLike, voltages: npt.ArrayLike) -> Waveform:
        """Straight lines between points (times [s] from 0 on, voltages [V], both of shape (n,)); two points of one time are a jump."""
        return cls("table", times=np.asarray(times, float).tolist(), voltages=np.asarray(voltages, float).tolist())

    @classmethod
    def _of(cls, native: _softland.Waveform) -> Waveform:
        self = cls.__new__(cls)
        self._native = native
        return self

    @property
    def family(self) -> str:
        """step, harmonic, pulse, table, s-curve, chirp, bspline or sines; of an own waveform its name."""
        return self._native.family

    @property
    def parameters(self) -> dict[str, float | list[float]]:
        """Of the family, in SI units."""
        return self._native.parameters

    @property
    def hold_level(self) -> float:
        """What it ends on [V]."""
        return self._native.hold_level

    @property
    def breakpoints(self) -> Array:
        """Times at which it kinks or jumps, 0 among them [s]."""
        return np.asarray(self._native.breakpoints)

    def __call__(self, time: npt.ArrayLike) -> Any:
        """The voltage at a time, or at an array of times [s] -> [V]; where it jumps, that after the jump."""
        times = np.asarray(time, float)
        volts = self._native.voltage(np.atleast_1d(times))
        return float(volts[0]) if times.ndim == 0 else volts

    def scaled(self, volts: float = 1.0, time: float = 1.0) -> Waveform:
        """With its voltages times `volts` and its times times `time`, both above 0."""
        return Waveform._of(self._native.scaled(volts, time))

    def resampled(self, rate: float | str, end: float | str) -> Waveform:
        """A table of its values at k / rate [Hz] up to `end` [s], straight lines between them; the last one is the hold level."""
        return Waveform._of(self._native.resampled(number(rate), number(end)))

    def points(self, end: float | str, tolerance: float = 1e-3) -> tuple[Array, Array]:
        """Times [s] and voltages [V] whose straight connections stay within `tolerance` [V] of it up to `end` [s]."""
        points = np.asarray(self._native.points(number(end), tolerance), float).reshape(-1, 2)
        return points[:, 0], points[:, 1]

    def csv(self, end: float | str, drive: str = "main") -> str:
        """For a generator: the text of a CSV file with a header time_s,DRIVE."""
        return self._native.csv(drive, number(end))

    def spice(self, end: float | str, drive: str = "main") -> str:
        """For a circuit simulator: the text of a file with a subcircuit softland_DRIVE that holds a PWL source."""
        return self._native.spice(drive, number(end))

    def plot(self, end: float | str, ax: Any = None) -> Any:
        """Draws it up to `end` [s] with matplotlib; returns the axes."""
        from ._plots import axes

        ax = axes(ax)
        times, volts = self.points(end, 1e-3 * float(np.max(np.abs(self._native.range()))) or 1e-3)
        ax.plot(1e6 * times, volts)
        ax.set_xlabel("time [µs]")
        ax.set_ylabel("voltage [V]")
        return ax

    def __repr__(self) -> str:
        if not self.parameters:
            return f"<own waveform {self.family!r}>"
        return f"Waveform({self.family!r}, " + ", ".join(f"{key}={value!r}" for key, value in self.parameters.items()) + ")"

    def __reduce__(self) -> Any:
        if self.family not in _softland.families:
            raise TypeError(f"the own waveform {self.family!r} cannot be pickled: a table of its points can")
        return _rebuilt, (self.family, {key: value for key, value in self.parameters.items() if value != math.inf})


def _rebuilt(family: str, parameters: Mapping[str, Any]) -> Waveform:
    return Waveform(family, **parameters)


class OwnWaveform(Waveform):
    """A waveform that is a Python function: to be run, and to be searched.

    voltage: (times, x) -> volts, arrays of shape (n,), (d,) -> (n,) [s] -> [V]: smooth between the breakpoints. It is called a few times for each
        candidate, from several threads in turn.
    breakpoints: the times at which it kinks or jumps [s], above 0 and increasing, or a function (x) -> these. From the last one on it stays;
        without one it must be constant.
    parameters: {name: (lower, upper, start)}, between which bounds a search varies x; names by custom with their unit ("rise_s").
    x: values of these; default: their starts.

    No scene file can hold it: `Waveform.table(*own.points(end))` can stand in one.
    """

    def __init__(
        self,
        name: str,
        voltage: Callable[[Array, Array], npt.ArrayLike],
        breakpoints: Sequence[float] | Callable[[Array], npt.ArrayLike],
        parameters: Mapping[str, tuple[float | str, float | str, float | str]] | None = None,
        x: Sequence[float] | None = None,
    ) -> None:
        rows = [(key, *(number(one) for one in bounds)) for key, bounds in (parameters or {}).items()]
        self._function = _softland.PythonWaveform(name, rows, breakpoints if callable(breakpoints) else np.asarray(breakpoints, float), voltage)
        self._native = _softland.Waveform.own(self._function, None if x is None else list(map(float, x)))

    def at(self, x: Sequence[float] | Mapping[str, float]) -> Waveform:
        """The waveform with these values of its parameters."""
        values = list(x.values()) if isinstance(x, Mapping) else list(x)
        return Waveform._of(_softland.Waveform.own(self._function, [float(one) for one in values]))
