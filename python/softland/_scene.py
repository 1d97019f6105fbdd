"""A scene, and what softland tells of it."""

from __future__ import annotations

import json
import os
import sys
import warnings
from collections.abc import Callable, Iterator, Mapping, MutableMapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, Union

import numpy as np
import numpy.typing as npt

from . import _softland
from ._closing import Closing
from ._evaluator import Evaluator
from ._files import write_whole
from ._outcome import Outcome
from ._progress import Progress, shown
from ._records import Quantity, read
from ._studies import Studies
from ._studying import command, natives
from ._tuning import Device, PracticeDevice, Tuning, laboratory, tuning_of
from ._units import number, units
from ._waveform import OwnWaveform, Waveform

if TYPE_CHECKING:
    from ._results import Store

Array = npt.NDArray[np.float64]
Value = Union[str, float, int, bool, Sequence[Any], Mapping[str, Any]]
Actuator = Literal["electrostatic", "pzt", "both"]


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


def _told(value: float | str | None, unit: str) -> str | None:
    """As an option of the program is told it."""
    return value if value is None or isinstance(value, str) else f"{float(value)!r} {unit}"


def _jobs(jobs: int | None) -> int:
    return jobs if jobs is not None else os.cpu_count() or 1


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

    # What drives it.

    @property
    def drives(self) -> list[str]:
        """Names of the drives: the electrodes in order, then dispersion and piezo, if there are any."""
        return self._native.drives()

    @property
    def waveforms(self) -> Waveforms:
        """The waveforms by drive, in volts; assigning one changes the scene."""
        return Waveforms(self)

    # The verbs of the program; Studies has the others.

    def simulate(
        self,
        *,
        errors: bool = True,
        certify: bool = False,
        waveforms: Mapping[str, Waveform] | None = None,
        jobs: int | None = None,
        progress: bool | Progress | None = False,
    ) -> Closing:
        """The closing under the scene's waveforms, as `softland simulate` runs it, to the same bits.

        errors: a second, tighter run measures the error of each figure, and refines the first where the scene asks for more accuracy.
        certify: errors that cover the true ones, and clouds of runs for ill-conditioned figures.
        waveforms: of some drives other ones than the scene's, in volts; own waveforms too.
        jobs: threads of a certified run; they change nothing.
        Numerical trouble is the status of the closing. Raises InvalidInput.
        """
        with shown(progress) as tell:
            return Closing(self._native.simulate(errors, certify, _jobs(jobs), natives(waveforms), command(), tell))

    def modes(self, places: int = 101) -> Modes:
        """Natural frequencies and mode shapes."""
        return Modes(self._native.frequencies(), *self._native.shapes(places))

    def optimize(
        self,
        *,
        target: str = "bounce",
        actuator: Actuator | None = None,
        robust: str = "auto",
        waveform: str = "",
        objective: Callable[[dict[str, Any], dict[str, float]], Any] | None = None,
        lands_first: bool = True,
        own_waveforms: Sequence[OwnWaveform] = (),
        constrain: Sequence[str] = (),
        start: Sequence[Mapping[str, Waveform]] = (),
        optimizer: str = "",
        hold_step: str = "",
        calibrate: str = "",
        budget: int | str | None = None,
        samples: int | None = None,
        seed: int = 1,
        jobs: int | None = None,
        out: str | os.PathLike[str] | None = None,
        resume: bool = False,
        callback: Callable[[int, float, float, float], Any] | None = None,
        progress: bool | Progress | None = None,
    ) -> Outcome:
        """The search for a waveform, as `softland optimize`; its result has the same keys as result.json, and `files` such as best.toml.

        target: "bounce", "settling", "rebound", "count", "impact", "energy", "force", "drive", "steady", or a sum "0.7 bounce + 0.3 energy".
        actuator: without one all drives that the scene has, and with another `robust` than "auto" the electrode.
        robust: "auto", for the drawing and for devices; "none", for the drawing alone; a measure such as "cvar:0.9", for devices by it alone.
        waveform: a family, or several "pulse+knots"; names of `own_waveforms` too.
        objective: (closing, step) -> F in the place of a target: both are dicts of figures [SI], of a candidate and of the plain step; F >= 0, about 1
            for the step, is minimised. lands_first: among waveforms that land without a significant rebound. Over devices it is called once for a
            candidate: the figures of `closing` are arrays (devices,) of those that close, and it returns an array; of the drawing they are floats.
        constrain: conditions, "peak_contact_force < 20 uN".
        start: waveforms by drive [V] to begin with.
        hold_step: with actuator "pzt", "chosen" (the instant of the electrode's plain step is searched) or "fixed" (t = 0).
        optimizer: a method, where it is not to be "auto"; calibrate: what is measured on every device, "Vdp:1 %,frequency".
        budget: evaluations, or closings of devices; or time, "90 s". samples: devices.
        out: folder in which all evaluations are kept while the search runs, and its files when it ends. resume: goes on with the search in that
            folder, of Python or of the program, that was interrupted or ended by its budget; nothing is simulated twice.
        callback: (evaluations, best cost, cost of the plain step, cost now) after each evaluation on record; one that returns True ends the search, of
            which the best so far is then the result.
        """
        request = {
            "target": target, "actuator": actuator, "robust": robust, "waveform": waveform,
            "objective": None if objective is None else _softland.PythonObjective(getattr(objective, "__name__", "own"), objective, lands_first),
            "own_waveforms": [one._function for one in own_waveforms], "constrain": list(constrain), "starts": [natives(one) for one in start],
            "optimizer": optimizer, "hold-step": hold_step, "calibrate": calibrate, "budget": budget, "samples": samples, "seed": seed, "jobs": _jobs(jobs), "callback": callback, "command": command(),
            "out": "" if out is None else os.fspath(out), "resume": resume,
        }  # fmt: skip
        with shown(progress) as tell:
            return Outcome(_softland.optimize(self._native, {**request, "progress": tell}))

    def explore(
        self,
        vary: Mapping[str, str] | Sequence[str],
        out: str | os.PathLike[str] = "softland-out.sqlite",
        *,
        study: Literal["simulate", "pull-in", "robustness", "optimize", "limit", "release", "effects", "check"] = "simulate",
        sample: str = "",
        pareto: Sequence[str] = (),
        options: Mapping[str, Any] | None = None,
        resume: bool = False,
        shard: str = "",
        seed: int = 1,
        jobs: int | None = None,
        progress: bool | Progress | None = None,
    ) -> Store:
        """An exploration of the design space, as `softland explore`: a row in the store `out` for every point, which is returned.

        vary: what varies, {"gap.contact": "1.6 um:2.4 um:7"}: LOW:HIGH:N, with :log in equal ratios, or A,B,C; "gap.electrode*gap.contact" by one
            factor; all combinations.
        sample: "sobol:256" or "lhs:256" points in the box of LOW:HIGH instead.
        pareto: figures of which the front is searched: ["initial_contact_time", "max:bounce_free"]; sample "nsga2:N" says with how many points.
        study: what is asked of every point; options: of it, by their names on the command line: {"certify": True}, {"samples": 200}, {"target": "energy"}.
        resume: go on with the store: points that it holds are not computed again. shard: "2/8", the second of eight parts.
        Ctrl-C raises KeyboardInterrupt; the rows that are done are in the store.
        """
        from ._results import Store

        words = [f"{key}={values}" for key, values in vary.items()] if isinstance(vary, Mapping) else list(vary)
        given = {name: str(value).lower() if isinstance(value, bool) else str(value) for name, value in (options or {}).items()}
        request = {
            "vary": words, "out": os.fspath(out), "study": study, "sample": sample, "pareto": ",".join(pareto), "options": given,
            "resume": resume, "shard": shard, "seed": seed, "jobs": _jobs(jobs), "command": command(),
        }  # fmt: skip
        with shown(progress) as tell:
            _softland.explore(self._native, {**request, "progress": tell})
        return Store(Path(out))

    def export(
        self,
        format: str = "csv",
        *,
        waveforms: Mapping[str, Waveform] | None = None,
        drive: str = "",
        signal: Literal["told", "output"] = "told",
        sample_rate: float | str | None = None,
        bits: int | None = None,
        amplifier: float | None = None,
        marker: float | str | None = None,
        measured: Mapping[str, str] | None = None,
        jobs: int | None = None,
        progress: bool | Progress | None = False,
    ) -> str:
        """The scene's waveforms as the text of a file for others, as `softland export`.

        format: "csv"; of generators "keysight-arb", "siglent-csv", "tektronix-csv", "rigol-csv", "digilent-csv"; "codes", samples as integers; of circuit
            simulators "spice-pwl", and the switch itself, "spice-model", "spice-bench", "verilog-a".
        waveforms: in the place of some of the scene's, in volts; own waveforms as tables. drive: of several this one.
        signal: what the source is told, or its output. sample_rate [Hz], bits: instead of those of [driver].
        amplifier: volts at the switch per volt of the generator, instead of that of [driver]. marker: when the sync output falls [s] (keysight-arb).
        measured: {"Vdp": "54.2 V", "frequency": "10.2 kHz"} of a device that gets its own waveform.
        Warns where the switch does not close under the samples as well as under the waveform itself. Raises InvalidInput.
        """
        scene = self
        if waveforms:
            scene = self.copy()
            for name, waveform in waveforms.items():
                own = waveform.family not in _softland.families
                scene.waveforms[name] = Waveform.table(*waveform.points(self._native.duration())) if own else waveform
        request = {
            "format": format, "signal": signal, "drive": drive, "sample_rate": _told(sample_rate, "Hz"), "bits": None if bits is None else str(bits),
            "amplifier": None if amplifier is None else repr(float(amplifier)), "marker": _told(marker, "s"),
            "measured": ",".join(f"{key}={value}" for key, value in (measured or {}).items()), "jobs": _jobs(jobs),
        }  # fmt: skip
        with shown(progress) as tell:
            text, said = _softland.export(scene._native, request, tell)
        for line in said:
            if not line.startswith(("as sampled", "amplifier of drive")):
                warnings.warn(line.removeprefix("warning: "), stacklevel=2)
        return text

    def tuning(
        self,
        *,
        actuator: Actuator = "electrostatic",
        constrain: str = "",
        errors: Mapping[str, float | str] | None = None,
        recipes: int | None = None,
        effort: float | None = None,
        wafer: Sequence[str | os.PathLike[str]] = (),
        out: str | os.PathLike[str] | None = None,
        resume: bool = False,
        seed: int = 1,
        jobs: int | None = None,
        progress: bool | Progress | None = None,
    ) -> Tuning:
        """A tuning on one device that is ready for its first shot: the waveform for the drawing is searched, which takes half a minute or so.

        actuator: which drives are shaped. constrain: "initial_contact_time < 33 us", or "< 1.1 step".
        errors: of the instruments, one standard deviation: edge_error [s], unseen [s], gain_error, shot_error, and trigger_delay [s], by which records may
            begin later or earlier than the drives; default: the usual ones (docs/tune.md).
        recipes: waveforms searched before the first closing, 1 to 5. effort: evaluations of every search, over the usual.
        wafer: folders of tunings of devices of the same wafer that have ended.
        out: folder for closings.jsonl, where each closing is before the next is fired, and for the files of the program. resume: goes on with the
            closings there, none of which is fired again; scene and options as before. Program and Python may go on with each other's.
        Same answers, same proposals, whatever `jobs` is. Raises InvalidInput.
        """
        request = {
            "actuator": actuator, "constrain": constrain, **laboratory(errors, "trigger_delay"), "recipes": recipes, "effort": effort,
            "wafer": [os.fspath(one) for one in wafer], "seed": seed, "jobs": _jobs(jobs), "command": command(),
        }  # fmt: skip
        return tuning_of(self._native, request, out, resume, progress)

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

    def device(
        self,
        *,
        seed: int = 1,
        errors: Mapping[str, float | str] | None = None,
        drift: float = 0.0,
        trigger_delay: float | str = 0.0,
        more_modes: int = 0,
        gas: str = "",
        stiffness: float = 1.0,
        set: Mapping[str, str] | None = None,
    ) -> PracticeDevice:
        """A simulated device to practise on, as `softland device`: one of the scene's [spread], or of the usual one, chosen by `seed`.

        errors: of its instruments, as in `tuning`, but for trigger_delay. drift: share by which all volts change from one shot to the next.
        trigger_delay: by how much its records begin later than the drives [s]; earlier where it is below 0.
        more_modes, gas, stiffness (a factor, of the contact) and set ({"gap.contact": "2.05 um"}): a physics that the scene does not know.
        """
        request = {
            **laboratory(errors), "seed": seed, "drift": drift, "trigger_delay": float(number(trigger_delay)), "more_modes": more_modes, "gas": gas,
            "stiffness": stiffness, "set": [f"{key}={value}" for key, value in (set or {}).items()],
        }  # fmt: skip
        return PracticeDevice(_softland.PracticeDevice(self._native, request))

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
