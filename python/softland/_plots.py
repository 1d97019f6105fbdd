"""Plots by matplotlib, which is imported at the first plot."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ._closing import Closing


def axes(ax: Any = None) -> Any:
    """Returns the given axes, or new ones."""
    if ax is not None:
        return ax
    import matplotlib.pyplot as plt

    return plt.subplots(layout="constrained")[1]


def plot_closing(closing: Closing) -> Any:
    """Gap and voltages of a closing against time; returns the figure."""
    import matplotlib.pyplot as plt

    figure, (above, below) = plt.subplots(2, 1, sharex=True, layout="constrained", height_ratios=[2, 1])
    run = closing.trajectory
    above.plot(1e6 * run["time"], 1e6 * run["gap"], linewidth=1)
    above.axhline(0, color="0.6", linewidth=0.8)
    above.set_ylabel("gap at the contact [µm]")
    if closing.touched:
        touch = 1e6 * closing.initial_contact_time
        above.axvline(touch, color="0.6", linewidth=0.8, linestyle=":")
        above.set_title(f"first contact at {touch:.4g} µs, {closing.impact_velocity * 1e3:.3g} mm/s", fontsize="medium")
    for drive in closing.drives:
        times, volts = closing.voltage(drive)
        below.plot(1e6 * times, volts, linewidth=1, label=drive)
    below.axhline(0, color="0.6", linewidth=0.8)
    below.set_xlabel("time [µs]")
    below.set_ylabel("drive [V]")
    below.legend()
    return figure
