"""Waveforms as Python objects."""

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
    """A drive voltage against time: a function of [s] in [V]. It is immutable; methods return new waveforms.

    >>> pulse = softland.Waveform("pulse", levels=["20 V", "8 V", "16 V"], times=["12 us", "30 us"], edge="1 us")
    >>> pulse(20e-6)
    8.0

    family: family, such as "pulse": docs/theory/sources.md and docs/reference/keys.md have all, with their parameters.
    parameters: parameters of the family, numbers in SI units or text with a unit; Vsp and Vdp are valid only in a scene.

    Raises InvalidInput with parameter, value and rule.
    """

    def __init__(self, family: str, **parameters: Any) -> None:
        self._native = _softland.Waveform.made(family, {key: number(value) for key, value in parameters.items()})

    @classmethod
    def table(cls, times: npt.ArrayLike, voltages: npt.ArrayLike) -> Waveform:
        """Returns the waveform of straight lines between points (times [s] from 0 on, voltages [V], both of shape (n,)); two points of the same time are a jump."""
        return cls("table", times=np.asarray(times, float).tolist(), voltages=np.asarray(voltages, float).tolist())

    @classmethod
    def _of(cls, native: _softland.Waveform) -> Waveform:
        self = cls.__new__(cls)
        self._native = native
        return self

    @property
    def family(self) -> str:
        """Family: step, harmonic, pulse, table, s-curve, chirp, bspline or sines; the name of an own waveform."""
        return self._native.family

    @property
    def parameters(self) -> dict[str, float | list[float]]:
        """Parameters of the family, in SI units."""
        return self._native.parameters

    @property
    def hold_level(self) -> float:
        """Final voltage [V]."""
        return self._native.hold_level

    @property
    def breakpoints(self) -> Array:
        """Times at which the voltage kinks or jumps, including 0 [s], (n,)."""
        return np.asarray(self._native.breakpoints)

    def __call__(self, time: npt.ArrayLike) -> Any:
        """Returns the voltage at a time, or at an array of times, (n,) -> (n,), [s] -> [V]; at a jump the voltage after it."""
        times = np.asarray(time, float)
        volts = self._native.voltage(np.atleast_1d(times))
        return float(volts[0]) if times.ndim == 0 else volts

    def scaled(self, volts: float = 1.0, time: float = 1.0) -> Waveform:
        """Returns the waveform with its voltages multiplied by `volts` and its times by `time`, both above 0."""
        return Waveform._of(self._native.scaled(volts, time))

    def resampled(self, rate: float | str, end: float | str) -> Waveform:
        """Returns a table of the voltages at k / rate [Hz] up to `end` [s], with straight lines between them; the last one is the hold voltage."""
        return Waveform._of(self._native.resampled(number(rate), number(end)))

    def points(self, end: float | str, tolerance: float = 1e-3) -> tuple[Array, Array]:
        """Returns times [s], (n,), and voltages [V], (n,); straight lines between them stay within `tolerance` [V] of the waveform up to `end` [s]."""
        points = np.asarray(self._native.points(number(end), tolerance), float).reshape(-1, 2)
        return points[:, 0], points[:, 1]

    def csv(self, end: float | str, drive: str = "main") -> str:
        """Returns the text of a CSV file for a generator, with a header time_s,DRIVE."""
        return self._native.csv(drive, number(end))

    def spice(self, end: float | str, drive: str = "main") -> str:
        """Returns the text of a SPICE file with a subcircuit softland_DRIVE that holds a PWL source."""
        return self._native.spice(drive, number(end))

    def plot(self, end: float | str, ax: Any = None) -> Any:
        """Draws the waveform up to `end` [s] with matplotlib; returns the axes."""
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
    """A waveform defined by a Python function, for simulations and searches.

    voltage: function (times, x) -> volts of arrays, (n,), (d,) -> (n,), [s] -> [V], smooth between the breakpoints. It is called a few times for each
        candidate, from several threads in turn.
    breakpoints: times at which the voltage kinks or jumps [s], above 0 and increasing, or a function (x) -> times. After the last one the voltage is
        constant; without breakpoints it must be constant from t = 0 on.
    parameters: {name: (lower, upper, start)}, the bounds and the start of a search; names should end in the unit ("rise_s").
    x: values of the parameters; default: their starts.

    A scene file cannot hold this waveform, but it can hold `Waveform.table(*own.points(end))`.
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
        """Returns the waveform with these values of its parameters."""
        values = list(x.values()) if isinstance(x, Mapping) else list(x)
        return Waveform._of(_softland.Waveform.own(self._function, [float(one) for one in values]))
