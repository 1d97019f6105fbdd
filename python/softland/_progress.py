"""Progress of long computations, by tqdm if it is installed."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

Progress = Callable[[str, float], None]


@contextmanager
def shown(progress: bool | Progress | None) -> Iterator[Progress | None]:
    """Returns the progress callback: the function of the user; a bar of tqdm for True, or for None at a terminal or in a notebook; else None."""
    if callable(progress):
        yield progress
        return
    if progress is None:
        progress = sys.stderr.isatty() or "ipykernel" in sys.modules
    bar: Any = None
    if progress:
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # tqdm warns in a notebook without ipywidgets, where it shows a bar of text
                from tqdm.auto import tqdm
        except ImportError:
            yield None
            return

        def tell(what: str, part: float) -> None:
            nonlocal bar
            if bar is None:
                bar = tqdm(total=100, bar_format="{desc}: {percentage:3.0f} %|{bar}| {elapsed}", leave=False)
            bar.set_description_str(what, refresh=False)
            bar.n = round(100 * part, 1)
            bar.refresh()

        try:
            yield tell
        finally:
            if bar is not None:
                bar.close()
        return
    yield None
