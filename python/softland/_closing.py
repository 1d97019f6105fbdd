"""One closing."""

from __future__ import annotations

import html
import math
import os
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from . import _softland
from ._outcome import Outcome
from ._records import Quantity

if TYPE_CHECKING:
    import pandas

Array = npt.NDArray[np.float64]

_KNOT = np.dtype([("time", "f8"), ("gap", "f8"), ("deflection", "f8"), ("velocity", "f8"), ("acceleration", "f8"), ("contact_force", "f8")])


class Closing:
    """A simulated closing: figures of merit, the trajectory of the contact point, and the motion of the whole beam.

    Every figure is an attribute, named as in the JSON of the program without its unit: `closing.impact_velocity` is a float [m/s] with
    attributes `unit` and `error`. The error is absolute: the difference of two runs or, for a certified closing, a bound. Figures that do not exist
    are NaN. docs/reference/figures.md has the figures. Made by `Scene.simulate`.
    """

    def __init__(self, native: _softland.Closing) -> None:
        self._native = native
        self._figures: dict[str, Any] = {
            name: told if isinstance(told, bool) else Quantity(told[0], told[2], told[1]) for name, told in native.figures.items()
        }
        self._motion: tuple[Array, Array] | None = None

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        try:
            return self._figures[name]
        except KeyError:
            raise AttributeError(f"unknown attribute {name!r}; the figures are {', '.join(self._figures)}") from None

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self._figures]

    @property
    def figures(self) -> dict[str, Any]:
        """All figures by name: a `Quantity` each, but `settled` is True or False."""
        return dict(self._figures)

    @property
    def status(self) -> str:
        """Outcome: done, open, no_contact, not_settled, collapsed_at_rest, collapsed_onto_electrode or numerical_failure."""
        return self._native.status

    @property
    def message(self) -> str:
        """Reason if the simulation is not done; else empty."""
        return self._native.message

    @property
    def warnings(self) -> list[str]:
        """Warnings about the scene, about laws beyond their range of validity, and about ill-conditioned figures."""
        return self._native.warnings

    @property
    def touched(self) -> bool:
        """True if the contact point reached the contact plane."""
        return not math.isnan(self._figures["initial_contact_time"])

    @property
    def drives(self) -> list[str]:
        """Names of the drives."""
        return self._native.drives

    @property
    def trajectory(self) -> npt.NDArray[np.void]:
        """The trajectory of the contact point, a structured array (n,): time [s]; gap to the contact plane and deflection towards it [m]; velocity [m/s];
        acceleration [m/s^2]; contact_force on the beam [N]. Rows are the steps of the integrator; of long runs, only those needed for the same plot.
        """
        points = self._native.points
        run = np.empty(len(points), _KNOT)
        for name, column in zip(("time", "deflection", "velocity", "acceleration", "contact_force"), points.T):
            run[name] = column
        run["gap"] = self._native.contact_gap - run["deflection"]
        return run

    @property
    def rebounds(self) -> npt.NDArray[np.void]:
        """All rebounds, a structured array (n,): begin and end [s] (NaN if the rebound lasts beyond the simulation), height [m]."""
        rows = self._native.rebounds
        all_ = np.empty(len(rows), [("begin", "f8"), ("end", "f8"), ("height", "f8")])
        for name, column in zip(("begin", "end", "height"), rows.T):
            all_[name] = column
        return all_

    @property
    def motion(self) -> npt.NDArray[np.void]:
        """All modes, a structured array (n,): time [s]; q (modes,) [m kg^(1/2)], v and a, its first and second derivatives. Each step of the
        integrator has two rows, its begin and its end, because accelerations jump at make and break of contact. The closing is simulated again for this.
        """
        times, states = self._arcs()
        modes = states.shape[-1]
        run = np.empty(2 * len(times), [("time", "f8"), ("q", "f8", (modes,)), ("v", "f8", (modes,)), ("a", "f8", (modes,))])
        run["time"] = times.ravel()
        for k, name in enumerate(("q", "v", "a")):
            run[name] = states[:, :, k].reshape(-1, modes)
        return run

    def shape(self, time: npt.ArrayLike, places: int = 101) -> tuple[Array, Array]:
        """Returns the places x [m], (p,), and the deflection y of the whole beam towards the electrode [m], (p,) or (n, p).

        time: a time [s], or times (n,) [s]; y has a row for each of several.
        places: number p of places; a plate has its quadrature points instead.

        Within a step, the modes are quintic polynomials with q, v and a of both ends. Raises ValueError for a time outside the simulation.
        """
        times, states = self._arcs()
        given = np.asarray(time, float)
        t = np.atleast_1d(given)
        if not (np.all(t >= 0) and np.all(t <= times[-1, 1])):
            raise ValueError(f"time: must be from 0 to the end of the run, {times[-1, 1]:.6g} s")
        k = np.clip(np.searchsorted(times[:, 0], t, side="right") - 1, 0, len(times) - 1)
        x, shapes = self._native.shapes(places)
        y = _quintic(t, times[k], states[k]) @ shapes.T
        return x, y[0] if given.ndim == 0 else y

    def voltage(self, drive: str, times: npt.ArrayLike | None = None) -> tuple[Array, Array]:
        """Returns times [s], (n,), and the applied voltage of a drive at these times [V], (n,).

        times: times (n,) [s]; default: 2001 even times over the simulation.
        """
        t = np.linspace(0, self._native.duration, 2001) if times is None else np.asarray(times, float)
        return t, self._native.voltage(drive, np.atleast_1d(t))

    def _arcs(self) -> tuple[Array, Array]:
        if self._motion is None:
            self._motion = self._native.motion()
        return self._motion

    def result(self) -> Outcome:
        """Returns the whole result, a `Record` of the JSON that `softland simulate` writes, with its files."""
        return Outcome(self._native.outcome())

    def save(self, folder: str | os.PathLike[str]) -> Any:
        """Writes result.json, report.html, gap.svg and trajectory.csv into a folder, as `softland simulate --out` does."""
        return self.result().save(folder)

    def table(self) -> pandas.DataFrame:
        """Returns the figures as a pandas table: value, error and unit by name."""
        import pandas

        rows = {name: (float(one), one.error, one.unit) for name, one in self._figures.items() if not isinstance(one, bool)}
        return pandas.DataFrame(list(rows.values()), index=list(rows), columns=["value", "error", "unit"])

    def plot(self) -> Any:
        """Draws gap and drives against time with matplotlib; returns the figure."""
        from ._plots import plot_closing

        return plot_closing(self)

    def __repr__(self) -> str:
        rows = [f"Closing: {self.status}"]
        rows += [f"  {name}: {value!r}" for name, value in self._figures.items() if not math.isnan(value)]
        return "\n".join(rows)

    def _repr_html_(self) -> str:
        """The chart of the report and a table of the figures, for notebooks."""
        rows = "".join(
            f"<tr><td>{html.escape(name)}</td><td style='text-align:right'>{float(value):.6g}</td><td>{html.escape(value.unit)}</td></tr>"
            for name, value in self._figures.items()
            if not isinstance(value, bool) and not math.isnan(value)
        )
        chart = self._native.outcome().file("gap.svg").decode().replace("<svg ", "<svg style='max-width:100%;height:auto' ", 1)
        return f"<div style='max-width:46em'>{chart}</div><table>{rows}</table>"


def _quintic(t: Array, ends: Array, states: Array) -> Array:
    """Returns q (n, modes) at times t (n,) within steps `ends` (n, 2), from q, v and a at both ends (n, 2, 3, modes)."""
    h = (ends[:, 1] - ends[:, 0])[:, None]
    s = np.where(h > 0, (t - ends[:, 0])[:, None] / np.where(h > 0, h, 1), 0)
    q0, v0, a0 = states[:, 0, 0], states[:, 0, 1] * h, states[:, 0, 2] * h**2
    q1, v1, a1 = states[:, 1, 0], states[:, 1, 1] * h, states[:, 1, 2] * h**2
    c3 = 10 * (q1 - q0) - 6 * v0 - 4 * v1 - 1.5 * a0 + 0.5 * a1
    c4 = -15 * (q1 - q0) + 8 * v0 + 7 * v1 + 1.5 * a0 - a1
    c5 = 6 * (q1 - q0) - 3 * (v0 + v1) - 0.5 * (a0 - a1)
    return np.asarray(q0 + s * (v0 + s * (a0 / 2 + s * (c3 + s * (c4 + s * c5)))))


