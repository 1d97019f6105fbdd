"""What files of instruments hold, as arrays."""

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
    """A record over time: a mapping of the names of its channels to their values, (n,) in SI units, NaN where a number is missing.

    Attributes: `file`; `format`, what wrote it; `times` (n,) [s], empty where the file has none; `units` {channel: unit of `record[channel]` in the
    file, "mV", empty where it names none}; `notes` and `left_out`, what is to be known of what was taken. Made by `softland.read`.
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
            raise ValueError(f"channel: there are several: {', '.join(self._values)}")
        return next(iter(self._values.values()))

    def contact_edges(self, threshold: float | str, channel: str | None = None, **options: Any) -> Array:
        """Of the voltage of a contact when it closes and opens, (n, 2): see `softland.contact_edges`. channel: not needed where there is one."""
        return contact_edges(self.times, self._only(channel), threshold, **options)

    def waveform(self, channel: str | None = None, *, scale: float = 1.0) -> Waveform:
        """A drive of straight lines through the samples from t = 0 on [V], times `scale`, volts at the switch per volt of the file."""
        values = self._only(channel) * scale
        kept = (self.times >= 0) & np.isfinite(values)
        times, volts = self.times[kept], values[kept]
        if len(times) and times[0] > 0:
            times, volts = np.insert(times, 0, 0.0), np.insert(volts, 0, volts[0])
        return Waveform.table(times, volts)

    def table(self) -> pandas.DataFrame:
        """All channels in pandas, with the times as index."""
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
        """The picture of `softland read --plot`, for notebooks."""
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
    """What a file of an oscilloscope, a generator, a logger or a simulator holds, as `softland read`: CSV of twelve makers, SPICE PWL, VCD, UFF 58 (docs/files.md).

    column: name or place, from 1, of the channel that is wanted; time_column: the same of the times. interval: between samples [s], where the file does not
    say it, or "uneven". skip: lines at the beginning that are left out. time_unit: "us". decimal: the decimal sign.
    Raises InvalidInput with file, line, column and rule for what cannot be read, or can be read in two ways, with the key that decides.
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
    """When a voltage says that a contact closes and opens: (n, 2), a row for each edge, time [s] and 1 where it closes, 0 where it opens.

    times [s] and volts [V], both (n,). The contact is closed where they are above (or below) the threshold [V], by straight lines between samples;
    hysteresis about it [V]; states that last for less than `merge` [s] are none. from_zero: edges from t = 0 on, when the drives begin.
    What `Tuning.learn` takes as "edges_s". Raises InvalidInput for a contact that is closed at t = 0 already.
    """
    if closed not in ("above", "below"):
        raise ValueError(f"closed {closed!r}: must be above or below")
    level, width, least = (float(number(one)) for one in (threshold, hysteresis, merge))
    edges = _softland.contact_edges(np.asarray(times, float), np.asarray(volts, float), level, closed == "below", width, least, from_zero)
    return np.asarray(edges)


__all__ = ["Recording", "contact_edges", "read"]
