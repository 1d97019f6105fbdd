"""The result of a verb: the record of its JSON, and the files that the program writes."""

from __future__ import annotations

import io
import json
import math
import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import _softland
from ._files import write_whole
from ._records import Record

if TYPE_CHECKING:
    import pandas


class Outcome(Record):
    """The result of a verb: a `Record` of the JSON of the program, which can be saved to the same files. Made by `Scene.limit` and the other verbs."""

    def __init__(self, native: _softland.Outcome) -> None:
        super().__init__(json.loads(native.json))
        self._native = native

    @property
    def files(self) -> list[str]:
        """Names of the files that `save` writes."""
        return self._native.files

    def file(self, name: str) -> str:
        """Returns the content of one of these files. Raises KeyError for another name."""
        if name not in self._native.files:
            raise KeyError(f"unknown file {name!r}; choose from {', '.join(self._native.files)}")
        return self._native.file(name).decode("utf-8", "replace")

    def save(self, folder: str | os.PathLike[str]) -> Path:
        """Writes these files to a folder, which is created if missing. Returns the folder."""
        place = Path(folder)
        place.mkdir(parents=True, exist_ok=True)
        for name in self._native.files:
            write_whole(place / name, self._native.file(name))
        return place

    def table(self) -> pandas.DataFrame:
        """Returns the result as a pandas table: for `robustness` a row for each device, else a row for each number. Names contain the SI units."""
        import pandas

        if "devices.csv" in self._native.files:
            return pandas.read_csv(io.StringIO(self.file("devices.csv")))
        return pandas.DataFrame(numbers_of(self._data), columns=["key", "value"])

    def __getstate__(self) -> Any:
        raise TypeError("a result cannot be pickled: pickle its to_json()")


def numbers_of(data: Any, before: str = "") -> list[tuple[str, Any]]:
    """Yields (path of keys, number or text) of all leaves of a JSON object, except those in lists."""
    rows: list[tuple[str, Any]] = []
    for key, value in data.items():
        path = f"{before}.{key}" if before else key
        if isinstance(value, dict):
            rows += numbers_of(value, path)
        elif not isinstance(value, list):
            rows.append((path, math.nan if value is None else value))
    return rows
