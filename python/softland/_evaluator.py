"""Figures of merit as a function of values of a scene."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import numpy.typing as npt

from . import _softland
from ._errors import InvalidInput
from ._progress import Progress, shown

if TYPE_CHECKING:
    from ._scene import Scene

Array = npt.NDArray[np.float64]


class Evaluator:
    """A function of arrays that maps rows of values of keys to rows of figures, (n, d) -> (n, m), in SI units. Made by `Scene.evaluator`.

    The scene is prepared once. Rows are simulated on all cores. The figures of a row do not depend on the other rows, and equal those of
    `softland robustness` for the same device; figures that do not exist are NaN. An evaluator can be called from several threads and pickled, and
    works with SciPy, Optuna, OpenTURNS, scikit-learn and Dask.

    keys: names of the columns of x, (d,).
    units: units of these columns, (d,).
    figures: names of the columns of the result, (m,).
    nominal: values in the scene, (d,).
    jobs: number of threads.
    """

    def __init__(
        self, scene: Scene, keys: Sequence[str], figures: Sequence[str], vdp: Literal["nominal", "each"], jobs: int | None, tolerance: float
    ) -> None:
        self._scene = scene.copy()
        self._given = (list(keys), list(figures), vdp, jobs, tolerance)
        self._native = _softland.Evaluator(self._scene._native, list(keys), list(figures), vdp, tolerance, None)
        self.keys: list[str] = self._native.keys
        self.units: list[str] = self._native.units
        self.figures: list[str] = [name for name, _ in self._native.figures]
        self.nominal: Array = self._native.nominal
        self.jobs = jobs if jobs is not None else os.cpu_count() or 1
        self._status: list[str] = []
        self._reasons: dict[int, str] = {}

    def __call__(self, x: npt.ArrayLike, progress: bool | Progress | None = False) -> Array:
        """Returns the figures of rows, (n, d) -> (n, m), or of one row, (d,) -> (m,).

        progress: True for a bar, or a function (what, part).

        Raises InvalidInput for another shape, KeyboardInterrupt on Ctrl-C.
        """
        rows = np.asarray(x, float)
        if rows.ndim not in (1, 2) or rows.shape[-1] != len(self.keys):
            hint = ": one key, so x[:, None]" if len(self.keys) == 1 and rows.ndim == 1 else ""
            raise InvalidInput(f"evaluator: expected rows of {', '.join(self.keys)}, shape (n, {len(self.keys)}), got {rows.shape}{hint}")
        with shown(progress) as tell:
            values, self._status, self._reasons = self._native.evaluate(np.atleast_2d(rows), self.jobs, tell)
        return np.asarray(values[0] if rows.ndim == 1 else values)

    @property
    def status(self) -> npt.NDArray[np.str_]:
        """Status of each row of the last call, (n,): "done", ..., or "infeasible" for an impossible device or waveform."""
        return np.array(self._status, dtype=np.str_)

    @property
    def reasons(self) -> dict[int, str]:
        """Reasons why rows of the last call have no figures, by number of the row."""
        return dict(self._reasons)

    def jacobian(self, x: npt.ArrayLike) -> Array:
        """Returns the exact derivatives of the figures by the keys at a row, (d,) -> (m, d), also through impacts and rebounds.

        Raises InvalidInput with the reason if there is no derivative: for counts, for a source that rounds to bits, and for vdp="each" unless either all
        voltages or none are multiples of Vdp of one electrode.
        """
        return np.asarray(self._native.jacobian(np.asarray(x, float)))

    def one(self, figure: str | int = 0) -> Any:
        """Returns the function of one figure for `scipy.optimize` with vectorized=True: (d, n) -> (n,), and (d,) -> float."""
        column = figure if isinstance(figure, int) else self.figures.index(figure)

        def function(x: npt.ArrayLike) -> Any:
            points = np.asarray(x, float)
            if points.ndim == 1:
                return float(self(points)[column])
            return self(points.T)[:, column]

        return function

    def __repr__(self) -> str:
        return f"Evaluator({', '.join(self.keys)} -> {', '.join(self.figures)})"

    def __reduce__(self) -> Any:
        return Evaluator, (self._scene, *self._given)
