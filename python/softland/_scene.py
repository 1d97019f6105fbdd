"""A scene, and what softland tells of it."""

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
    """A value as TOML on one line."""
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
    """Whether a number with a unit is written there."""
    try:
        return bool(_softland.units(native.written(key) or "")[1])
    except ValueError:
        return False


class Waveforms(Mapping[str, Waveform]):
    """The waveforms of a scene by drive, in volts; `scene.waveforms["main"] = waveform` gives it another."""

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
    """A scene: a mapping of the keys of its file, "gap.contact", to what is written there.

    >>> scene = softland.load("my.toml")
    >>> scene["gap.contact"]
    2e-06 m
    >>> scene["gap.contact"] = "2.1 um"          # or 2.1e-6: numbers count in SI units
    >>> scene["electrode.main.span"] = ["60 um", "tip"]

    Reading gives `Quantity` for what has a unit, else text, numbers, flags and lists as they are written; KeyError where nothing is written, though
    a default may be in force: `scene.resolved()` has all of them. Every change is checked as the program checks a file: it raises InvalidInput in
    the words of the program, and then nothing has changed. `update` makes several changes at once, of which only the result must be a scene.
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
        """All of these changes, or none of them: update({"gap.electrode": "4 um", "gap.contact": "2.4 um"})."""
        self._native.change([_change(self._native, key, value) for key, value in dict(*others, **more).items()])

    def _tree(self) -> Any:
        return json.loads(self._native.json)

    @property
    def text(self) -> str:
        """As TOML: read again it is the same scene, digit for digit."""
        return self._native.text

    @property
    def name(self) -> str:
        """What messages call it."""
        return self._native.name

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the text to a file, whole."""
        write_whole(path, self.text.encode())

    def copy(self) -> Scene:
        """One that can be changed without this one."""
        return Scene(self._native.copy())

    def resolved(self) -> Scene:
        """The scene with every default written out and every voltage in volts."""
        return Scene(self._native.resolved())

    def check(self) -> list[str]:
        """Makes the scene ready to run, and returns its warnings. Raises InvalidInput for one that cannot be run."""
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
        """Natural frequencies and mode shapes."""
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
        """Tunes a waveform on one device, as `softland tune`: until five closings in a row are without a bounce, or `closings` are used.

        device: a function that gets a `Shot`, the waveforms to be fired, and returns when the contact was closed: see `Tuning.learn`. `scene.device()` is
            a simulated one.
        callback: called with a line about each closing; one that returns True ends the tuning.
        options: those of `tuning`; `out="folder"` keeps everything there.
        The result is a `Record` of tune.json. What the device raises comes through; the exception's `tuning` has the closings until then, and goes on
        with `error.tuning.run(device)`.
        """
        tuning = self.tuning(progress=progress, **options)
        try:
            return tuning.run(device, closings=closings, callback=callback, progress=progress)
        except BaseException as error:
            with suppress(AttributeError):  # of an exception that takes no attributes
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
        """Figures as a function of numbers of the scene: (n, d) -> (n, m).

        keys: what [spread] may name ("gap.contact", "electrode.main.span[2]", "driver.main.gain"), and parameters of waveforms in volts
            ("waveform.main.level", "waveform.main.times[1]").
        figures: names such as "impact_velocity".
        vdp: whose pull-in voltages the units Vsp and Vdp stand for: "nominal", every row gets the volts of the scene; "each", every row is a scene of
            its own, of which any number that is written may vary, in the unit that it is written in, Vdp too.
        jobs: threads; default: one per core. tolerance: of the integrator; with 1e-5 95 % quantiles of rebounds move by less than 0.4 %.
        """
        given = [[one] if isinstance(one, str) else one for one in (keys, figures)]
        return Evaluator(self, given[0], given[1], vdp, jobs, tolerance)

    def __repr__(self) -> str:
        title = self._tree().get("title", "")
        return f"<Scene {self.name}{': ' + title if title else ''}>"

    def __reduce__(self) -> Any:
        return _rebuilt, (self.text, self.name, str(Path(self._native.directory).absolute()))


class Modes:
    """Natural modes. `frequencies` [Hz] and `angular_frequencies` [rad/s], (n,); `x` [m], (p,); `shapes` [kg^(-1/2)], (p, n), mass-normalised."""

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
    """Text with a unit as a quantity; lists element by element; tables as they are."""
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
    """The parts of a path: spread."structure.thickness".cov, electrode.main.span[2]."""
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
    """A scene from a file, or from text: what has more than one line, or a '=', is text.

    set: changes, as `--set` of the program makes them: {"gap.contact": "2.1 um"}.
    Raises InvalidInput (message, key, file, line) in the words of the program.
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
    """A scene that softland ships, by its name: shipped("mem-gold")."""
    folder = Path(_softland.scenes)
    names = sorted(path.stem for path in folder.glob("*.toml"))
    if name not in names:
        raise KeyError(f"no shipped scene {name!r}; there are {', '.join(names)}")
    return load(folder / f"{name}.toml")


__all__ = ["Scene", "Waveforms", "Modes", "load", "shipped", "read", "units"]
