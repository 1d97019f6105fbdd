"""Reads results that the program wrote."""

from __future__ import annotations

import json
import math
import os
import sqlite3
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ._errors import InvalidInput
from ._records import Record
from ._scene import Scene, load
from ._waveform import Waveform

if TYPE_CHECKING:
    import pandas

_JSON = ("result.json", "robustness.json", "limit.json", "release.json", "accuracy.json", "fit.json", "tune.json")
_STORE = 0x536F4C61  # the application id of every store
_LAST = "(SELECT plan FROM session ORDER BY session DESC LIMIT 1)"


class Result(Record):
    """A result folder of the program, or a JSON file in it: a `Record` of the JSON. Made by `softland.open`."""

    def __init__(self, path: Path) -> None:
        super().__init__(json.loads(path.read_text()))
        self._path = path

    @property
    def folder(self) -> Path:
        """Path of the folder of the files."""
        return self._path.parent

    @property
    def files(self) -> list[str]:
        """Names of the files in the folder."""
        return sorted(path.name for path in self.folder.iterdir() if path.is_file())

    def scene(self, name: str = "best.toml") -> Scene:
        """Returns a scene of the folder: best.toml, drawing.toml, calibrated.toml or worst-1.toml; for a simulation, the simulated scene."""
        path = self.folder / name
        if not path.exists() and isinstance(self._data.get("scene_toml"), str):
            return load(self._data["scene_toml"])
        return load(path)

    def waveforms(self) -> dict[str, Waveform]:
        """Returns the waveforms of the result by drive, as tables [s], [V]."""
        part = self._data.get("best", self._data)
        return {drive: Waveform.table(*np.array(points).T) for drive, points in part.get("waveforms", {}).items()}

    def trajectory(self) -> npt.NDArray[np.void]:
        """Returns the content of trajectory.csv as a structured array (n,) with the columns of the file (time_s, tip_gap_m, ...)."""
        course: npt.NDArray[np.void] = np.genfromtxt(self.folder / "trajectory.csv", delimiter=",", names=True)  # type: ignore[assignment]
        return course

    def table(self) -> pandas.DataFrame:
        """Returns devices.csv as a pandas table, with a row for each device."""
        import pandas

        return pandas.read_csv(self.folder / "devices.csv")


class Store:
    """A store of `softland explore` or of a search: rows in one SQLite file, readable even while another process writes to it.

    Only the plan and the rows of the last session are read, if the store was continued with another plan.
    Made by `softland.open`.

    plan: text of the plan.
    columns: by key, name and unit of the column.
    points: number of planned points.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        with self._opened() as database:
            if database.execute("PRAGMA application_id").fetchone()[0] != _STORE:
                raise InvalidInput(f"{path}: must be a store of softland")
            self.plan: str
            self.points: int
            self.plan, self.points = database.execute("SELECT text, points FROM study WHERE plan = " + _LAST).fetchone()
            self.columns: dict[str, tuple[str, str]] = {
                key: (name, unit) for key, name, unit in database.execute("SELECT key, name, unit FROM columns ORDER BY position")
            }

    def _opened(self) -> Any:
        return sqlite3.connect(f"file:{self._path}?mode=ro", uri=True)

    def __len__(self) -> int:
        """Returns the number of rows in the store."""
        with self._opened() as database:
            return int(database.execute("SELECT count(*) FROM results WHERE plan = " + _LAST).fetchone()[0])

    def rows(self) -> npt.NDArray[np.void]:
        """Returns all rows by point, a structured array (n,): point, the columns (SI units; NaN for missing values), status, reason."""
        names = ", ".join('"' + key.replace('"', '""') + '"' for key in self.columns)
        with self._opened() as database:
            rows = database.execute(f"SELECT point, {names}, status, reason FROM results WHERE plan = {_LAST} ORDER BY point").fetchall()
        fields = [("point", "i8"), *((key, "f8") for key in self.columns), ("status", "U40"), ("reason", "O")]
        return np.array([tuple(math.nan if one is None else one for one in row) for row in rows], dtype=fields)

    def table(self) -> pandas.DataFrame:
        """Returns all rows as a pandas table with the point as index."""
        import pandas

        rows = self.rows()
        return pandas.DataFrame({name: rows[name] for name in rows.dtype.names or ()}).set_index("point")

    def __repr__(self) -> str:
        return f"<Store {self._path}: {len(self)} of {self.points} points>"


def open(path: str | os.PathLike[str]) -> Result | Store:
    """Reads a result of the program: a folder of --out, a JSON file of it, or a store. Raises InvalidInput for anything else."""
    place = Path(path)
    if place.is_dir():
        for name in _JSON:
            if (place / name).exists():
                return Result(place / name)
        raise InvalidInput(f"{place}: must hold a result of softland, one of {', '.join(_JSON)}")
    if not place.exists():
        raise InvalidInput(f"{place}: does not exist")
    if place.suffix == ".json":
        return Result(place)
    with place.open("rb") as file:
        if file.read(16) != b"SQLite format 3\0":
            raise InvalidInput(f"{place}: must be a folder of results, a JSON file or a store")
    return Store(place)
