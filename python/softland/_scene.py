"""A scene, with the computations of softland as its methods."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterator, Mapping, MutableMapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any, Literal, Union

import numpy as np
import numpy.typing as npt

from . import _softland
from ._evaluator import Evaluator
from ._files import write_whole
from ._outcome import Outcome
from ._progress import Progress
from ._records import Quantity, read
from ._studies import Studies
from ._tuning import Device
from ._units import units
from ._waveform import Waveform

Array = npt.NDArray[np.float64]
Value = Union[str, float, int, bool, Sequence[Any], Mapping[str, Any]]


def _toml(value: Any) -> str:
    """Returns a value as TOML on one line."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{json.dumps(key)} = {_toml(one)}" for key, one in value.items()) + "}"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(_toml(one) for one in value) + "]"
    return repr(float(value)) if isinstance(value, float) else str(value)


def _change(native: _softland.Scene, key: str, value: Any) -> tuple[str, Any]:
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, np.ndarray):
        value = value.tolist()
    if isinstance(value, int) and not isinstance(value, bool) and _holds_quantity(native, key):
        value = float(value)
    if isinstance(value, (bool, int)):
        return key, value
    if isinstance(value, float):
        return key, float(value)
    return key, value if isinstance(value, str) else _toml(value)


def _holds_quantity(native: _softland.Scene, key: str) -> bool:
    """Returns True if the value of a key in the scene is a number with a unit."""
    try:
        return bool(_softland.units(native.written(key) or "")[1])
    except ValueError:
        return False


class Waveforms(Mapping[str, Waveform]):
    """The waveforms of a scene by drive, in volts; `scene.waveforms["main"] = waveform` replaces one."""

    def __init__(self, scene: Scene) -> None:
        self._scene = scene

    def _all(self) -> dict[str, Any]:
        return self._scene._native.waveforms()

    def __getitem__(self, drive: str) -> Waveform:
        return Waveform._of(self._all()[drive])

    def __setitem__(self, drive: str, waveform: Waveform) -> None:
        self._scene._native.set_waveform(drive, waveform._native)

    def __iter__(self) -> Iterator[str]:
        return iter(self._all())

    def __len__(self) -> int:
        return len(self._all())


class Scene(Studies, MutableMapping[str, Any]):
    """A scene: a mapping from keys of its file, such as "gap.contact", to their values.

    >>> scene = softland.load("my.toml")
    >>> scene["gap.contact"]
    2e-06 m
    >>> scene["gap.contact"] = "2.1 um"          # or 2.1e-6: numbers are in SI units
    >>> scene["electrode.main.span"] = ["60 um", "tip"]

    Reading a key gives a `Quantity` for a value with a unit, else text, number, flag or list as in the file. It raises KeyError for a key that is not in
    the file; `scene.resolved()` also has all defaults. Every change is checked as the program checks a file. An invalid change raises InvalidInput and
    is not made. `update` makes several changes at once; only the final scene must be valid. Made by `softland.load` and `softland.shipped`.
    """

    def __init__(self, native: _softland.Scene) -> None:
        self._native = native

    # The file.

    def __getitem__(self, key: str) -> Any:
        node = self._tree()
        for part in _parts(key):
            if isinstance(part, int):
                if not isinstance(node, list) or not 1 <= part <= len(node):
                    raise KeyError(key)
                node = node[part - 1]
            elif isinstance(node, dict) and part in node:
                node = node[part]
            else:
                raise KeyError(key)
        return _read(node)

    def __setitem__(self, key: str, value: Value) -> None:
        self._native.change([_change(self._native, key, value)])

    def __delitem__(self, key: str) -> None:
        self[key]
        self._native.erase(key)

    def __iter__(self) -> Iterator[str]:
        return iter(_paths(self._tree()))

    def __len__(self) -> int:
        return len(_paths(self._tree()))

    def update(self, *others: Any, **more: Any) -> None:
        """Makes all of these changes, or none of them: update({"gap.electrode": "4 um", "gap.contact": "2.4 um"}). Raises InvalidInput then."""
        self._native.change([_change(self._native, key, value) for key, value in dict(*others, **more).items()])

    def _tree(self) -> Any:
        return json.loads(self._native.json)

    @property
    def text(self) -> str:
        """The scene as TOML text, from which the same scene is read, digit for digit."""
        return self._native.text

    @property
    def name(self) -> str:
        """Name of the scene in messages."""
        return self._native.name

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the text to a file, atomically."""
        write_whole(path, self.text.encode())

    def copy(self) -> Scene:
        """Returns an independent copy."""
        return Scene(self._native.copy())

    def resolved(self) -> Scene:
        """Returns the scene with every default written out and every voltage in volts."""
        return Scene(self._native.resolved())

    def check(self) -> list[str]:
        """Prepares the scene for simulation, and returns its warnings. Raises InvalidInput for a scene that cannot be simulated."""
        return self._native.warnings()

    # The following are the drives and the verbs.

    @property
    def drives(self) -> list[str]:
        """Names of the drives: the electrodes in order, then dispersion and piezo, if there are any."""
        return self._native.drives()

    @property
    def waveforms(self) -> Waveforms:
        """The waveforms by drive, in volts; assigning one changes the scene."""
        return Waveforms(self)

    # The verbs of the program; Studies has the others.

    def modes(self, places: int = 101) -> Modes:
        """Returns natural frequencies and mode shapes.

        places: number p of places along the beam; a plate has its quadrature points instead.
        """
        return Modes(self._native.frequencies(), *self._native.shapes(places))

    def tune(
        self,
        device: Device,
        *,
        closings: int = 30,
        callback: Callable[[str], Any] | None = None,
        progress: bool | Progress | None = None,
        **options: Any,
    ) -> Outcome:
        """Tunes a waveform on one device, as `softland tune`: until five closings in a row are bounce-free, or the number `closings` is reached.

        device: a function that gets a `Shot`, the waveforms to apply, and returns the times at which the contact was closed: see `Tuning.learn`.
            `scene.device()` is a simulated device.
        callback: called with a line about each closing; if it returns True, the tuning ends.
        options: those of `tuning`; `out="folder"` stores all closings there.
        The result is a `Record` of tune.json. An exception of the device is raised; its attribute `tuning` has the closings so far, and
        `error.tuning.run(device)` continues.
        """
        tuning = self.tuning(progress=progress, **options)
        try:
            return tuning.run(device, closings=closings, callback=callback, progress=progress)
        except BaseException as error:
            with suppress(AttributeError):  # some exceptions do not accept attributes
                error.tuning = tuning  # type: ignore[attr-defined]
            raise

    def evaluator(
        self,
        keys: str | Sequence[str],
        figures: str | Sequence[str],
        *,
        vdp: Literal["nominal", "each"] = "nominal",
        jobs: int | None = None,
        tolerance: float = 1e-5,
    ) -> Evaluator:
        """Returns the figures as a function of values of the scene, (n, d) -> (n, m).

        keys: keys that [spread] may name ("gap.contact", "electrode.main.span[2]", "driver.main.gain"), and parameters of waveforms in volts
            ("waveform.main.level", "waveform.main.times[1]").
        figures: names such as "impact_velocity".
        vdp: pull-in voltages to which the units Vsp and Vdp refer. With "nominal" they are those of the scene, and every row has its voltages. With "each"
            they are those of the row, which is then a scene of its own. Then every number in the file may vary, in the unit of the file.
        jobs: number of threads; default: one per core.
        tolerance: tolerance of the integrator; with 1e-5, the 95th percentile of rebounds changes by less than 0.4 %.
        """
        given = [[one] if isinstance(one, str) else one for one in (keys, figures)]
        return Evaluator(self, given[0], given[1], vdp, jobs, tolerance)

    def __repr__(self) -> str:
        title = self._tree().get("title", "")
        return f"<Scene {self.name}{': ' + title if title else ''}>"

    def __reduce__(self) -> Any:
        return _rebuilt, (self.text, self.name, str(Path(self._native.directory).absolute()))


class Modes:
    """Natural modes. Made by `Scene.modes`.

    frequencies: frequencies [Hz], (n,).
    angular_frequencies: angular frequencies [rad/s], (n,).
    x: places along the structure [m], (p,).
    shapes: mass-normalised shapes [kg^(-1/2)], (p, n).
    """

    def __init__(self, angular: Array, x: Array, shapes: Array) -> None:
        self.angular_frequencies = angular
        self.frequencies = angular / (2 * np.pi)
        self.x = x
        self.shapes = shapes

    def plot(self, ax: Any = None) -> Any:
        """Draws the shapes with matplotlib; returns the axes."""
        from ._plots import axes

        ax = axes(ax)
        for frequency, shape in zip(self.frequencies, self.shapes.T):
            ax.plot(1e6 * self.x, shape / np.max(np.abs(shape)), label=f"{frequency / 1e3:.4g} kHz")
        ax.set_xlabel("from the clamped end [µm]")
        ax.legend()
        return ax

    def __repr__(self) -> str:
        return "Modes: " + ", ".join(f"{one:.6g} Hz" for one in self.frequencies)


def _rebuilt(text: str, name: str, directory: str) -> Scene:
    return Scene(_softland.Scene.parse(text, name, directory))


def _read(node: Any) -> Any:
    """Returns text with a unit as a quantity, lists element by element, and tables unchanged."""
    if isinstance(node, str):
        try:
            value, unit = _softland.units(node)
        except ValueError:
            return node
        is_number = node.strip()[:1] in "+-.0123456789" and any(c.isdigit() for c in node)
        return Quantity(value, unit) if is_number else node
    if isinstance(node, list):
        return [_read(one) for one in node]
    return node


def _parts(key: str) -> list[str | int]:
    """Splits a path into its parts: spread."structure.thickness".cov, electrode.main.span[2]."""
    parts: list[str | int] = []
    rest = key
    while rest:
        if rest[0] == '"' and '"' in rest[1:]:
            word, _, rest = rest[1:].partition('"')
            parts.append(word)
            rest = rest.removeprefix(".")
            continue
        word, _, rest = rest.partition(".")
        base, bracket, index = word.partition("[")
        parts.append(base)
        if bracket and index.endswith("]") and index[:-1].isdigit():
            parts.append(int(index[:-1]))
    return parts


def _paths(node: Any, before: str = "") -> list[str]:
    paths: list[str] = []
    for key, value in node.items():
        word = key if all(c.isalnum() or c in "_-" for c in key) else f'"{key}"'
        path = f"{before}.{word}" if before else word
        paths += _paths(value, path) if isinstance(value, dict) else [path]
    return paths


def load(scene: str | os.PathLike[str], set: Mapping[str, Value] | None = None) -> Scene:
    """Returns the scene of a file or of a text. An argument with several lines, or with a '=', is a text.

    set: changes, as `--set` of the program makes them: {"gap.contact": "2.1 um"}.
    Raises InvalidInput with message, key, file and line.
    """
    given = os.fspath(scene)
    if isinstance(scene, str) and ("\n" in given or "=" in given):
        native = _softland.Scene.parse(given, "text", ".")
    else:
        native = _softland.Scene.load(given)
    if set:
        native.change([_change(native, key, value) for key, value in set.items()])
    else:
        native.check()
    return Scene(native)


def shipped(name: str) -> Scene:
    """Returns a scene that is shipped with softland, by its name: shipped("mem-gold"). Raises KeyError for another name."""
    folder = Path(_softland.scenes)
    names = sorted(path.stem for path in folder.glob("*.toml"))
    if name not in names:
        raise KeyError(f"unknown shipped scene {name!r}; choose from {', '.join(names)}")
    return load(folder / f"{name}.toml")


__all__ = ["Scene", "Waveforms", "Modes", "load", "shipped", "read", "units"]
