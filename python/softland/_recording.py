"""Reads files of instruments to arrays."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import numpy.typing as npt

from . import _softland
from ._units import number
from ._waveform import Waveform

if TYPE_CHECKING:
    import pandas

Array = npt.NDArray[np.float64]


class Recording(Mapping[str, Array]):
    """A record over time: a mapping from names of channels to values, (n,) in SI units, NaN for missing numbers. Made by `softland.read`.

    file: name of the file.
    format: format of the file.
    times: times [s], (n,); empty if the file has none.
    units: by channel, its unit in the file, such as "mV"; empty if the file has none.
    notes: assumptions about the file.
    left_out: data that were not read.
    """

    def __init__(self, native: _softland.Recording) -> None:
        self._native = native
        self.file = native.file
        self.format = native.format
        self.times: Array = np.asarray(native.times)
        self.notes = native.notes
        self.left_out = native.left_out
        channels = native.channels
        names = [name for name, *_ in channels]
        keys = [name if names.count(name) == 1 else f"{name} (column {column})" for name, _, _, column, _, _ in channels]
        self._values: dict[str, Array] = {key: np.asarray(one[4]) for key, one in zip(keys, channels)}
        self.units: dict[str, str] = {key: one[2] for key, one in zip(keys, channels)}

    def __getitem__(self, channel: str) -> Array:
        return self._values[channel]

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    def _only(self, channel: str | None) -> Array:
        if channel is not None:
            return self._values[channel]
        if len(self._values) != 1:
            raise ValueError(f"channel: name one of several: {', '.join(self._values)}")
        return next(iter(self._values.values()))

    def contact_edges(self, threshold: float | str, channel: str | None = None, **options: Any) -> Array:
        """Returns the times at which a contact closes and opens, (n, 2), from its voltage.

        threshold: voltage that separates the states [V].
        channel: name of the channel; optional if there is one.
        options: those of `softland.contact_edges`.
        """
        return contact_edges(self.times, self._only(channel), threshold, **options)

    def waveform(self, channel: str | None = None, *, scale: float = 1.0) -> Waveform:
        """Returns a waveform of straight lines through the samples from t = 0 on [V].

        channel: name of the channel; optional if there is one.
        scale: volts at the switch per volt of the file.
        """
        values = self._only(channel) * scale
        kept = (self.times >= 0) & np.isfinite(values)
        times, volts = self.times[kept], values[kept]
        if len(times) and times[0] > 0:
            times, volts = np.insert(times, 0, 0.0), np.insert(volts, 0, volts[0])
        return Waveform.table(times, volts)

    def table(self) -> pandas.DataFrame:
        """Returns all channels as a pandas table with the times as index."""
        import pandas

        return pandas.DataFrame(self._values, index=pandas.Index(self.times, name="time [s]") if len(self.times) else None)

    def plot(self, ax: Any = None) -> Any:
        """Draws all channels against time with matplotlib; returns the axes."""
        from ._plots import axes

        ax = axes(ax)
        for name, values in self._values.items():
            ax.plot(1e6 * self.times, values, linewidth=1, label=name)
        ax.set_xlabel("time [µs]")
        ax.legend()
        return ax

    def __repr__(self) -> str:
        return self._native.text.rstrip()

    def _repr_html_(self) -> str:
        """The plot of `softland read --plot`, for notebooks."""
        return self._native.svg

    def __reduce__(self) -> Any:
        raise TypeError("a recording cannot be pickled: its times and channels can")


def read(
    file: str | os.PathLike[str],
    *,
    column: str | int | None = None,
    time_column: str | int | None = None,
    interval: float | str | None = None,
    skip: int | None = None,
    time_unit: str | None = None,
    decimal: Literal[".", ","] | None = None,
) -> Recording:
    """Reads a file of an oscilloscope, a generator, a logger or a simulator, as `softland read`: CSV of twelve makers, SPICE PWL, VCD, UFF 58 (docs/files.md).

    column: name or number, from 1, of the channel to read.
    time_column: the same for the times.
    interval: time between samples [s], if the file does not give it, or "uneven".
    skip: number of lines at the beginning to skip.
    time_unit: unit of the times, such as "us".
    decimal: the decimal sign.

    Raises InvalidInput with file, line, column and rule for an unreadable file, and for an ambiguous one with the key that decides.
    """
    given = {"column": column, "time_column": time_column, "skip": skip, "time_unit": time_unit, "decimal": decimal}
    words = [f"{key}={value}" for key, value in given.items() if value is not None]
    if interval is not None:
        words.append(f"interval={interval}" if isinstance(interval, str) else f"interval={interval!r} s")
    return Recording(_softland.Recording.read(os.fspath(file), words))


def contact_edges(
    times: npt.ArrayLike,
    volts: npt.ArrayLike,
    threshold: float | str,
    *,
    closed: Literal["above", "below"] = "above",
    hysteresis: float | str = 0.0,
    merge: float | str = 0.0,
    from_zero: bool = True,
) -> Array:
    """Returns the times at which a contact closes and opens, from its voltage: (n, 2), a row for each edge with time [s] and 1 (closes) or 0 (opens).

    times: times of the samples [s], (n,).
    volts: voltage of the contact [V], (n,), with straight lines between the samples.
    threshold: voltage that separates the states [V].
    closed: side of the threshold on which the contact is closed.
    hysteresis: width of the band about the threshold [V].
    merge: duration [s]; shorter states are ignored.
    from_zero: return edges from t = 0 on, when the drives begin.

    The result can be "edges_s" of `Tuning.learn`. Raises InvalidInput for a contact that is closed at t = 0.
    """
    if closed not in ("above", "below"):
        raise ValueError(f"closed {closed!r}: must be above or below")
    level, width, least = (float(number(one)) for one in (threshold, hysteresis, merge))
    edges = _softland.contact_edges(np.asarray(times, float), np.asarray(volts, float), level, closed == "below", width, least, from_zero)
    return np.asarray(edges)


__all__ = ["Recording", "contact_edges", "read"]
