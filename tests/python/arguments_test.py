"""Every public function refuses arguments of a wrong type, and names argument, type due and value. Oracle: the signatures themselves."""

import collections.abc
import inspect
import tempfile
import typing
import unittest
from pathlib import Path

import numpy as np
import numpy.typing as npt
import softland
from softland import _arguments

FEW = {
    "simulate.duration": "60 us",
    "structure.modes": 1,
    "waveform.main.level": "17.771 V",
    "driver.main.max_voltage": "25 V",
}


class Nothing:
    """An object that fits nothing."""

    def __repr__(self) -> str:
        return "<nothing>"


BAD = [Nothing(), b"bytes", 3 + 4j, {1: Nothing()}, [Nothing()]]


def sample(hint):
    """A value that fits an annotation; LookupError where none is known."""
    origin, inner = typing.get_origin(hint), typing.get_args(hint)
    if hint is typing.Any or hint is None or hint is type(None):
        return None
    if hint == npt.ArrayLike or origin is np.ndarray:
        return [1.0]
    if origin is typing.Union or isinstance(hint, type(int | str)):
        return sample(inner[0])
    if origin is typing.Literal:
        return inner[0]
    if origin is collections.abc.Callable:
        return lambda *_: None
    plain = {bool: True, int: 1, float: 1.0, str: "main"}
    if hint in plain:
        return plain[hint]
    kind = origin if origin is not None else hint
    if isinstance(kind, type):
        if issubclass(kind, collections.abc.Mapping):
            return {}
        if kind in (collections.abc.Sequence, collections.abc.Iterable, list):
            return []
        if issubclass(kind, tuple):
            return tuple(sample(one) for one in inner if one is not Ellipsis)
        if issubclass(kind, Path):
            return Path("x")
    raise LookupError(hint)


def functions():
    """(name, class or None, function) of all that is public."""
    for name in softland.__all__:
        one = getattr(softland, name)
        if inspect.isclass(one):
            for key, function in vars(one).items():
                function = getattr(function, "__func__", function)
                if hasattr(function, "__wrapped__") and inspect.isfunction(function):
                    yield (name if key == "__init__" else f"{name}.{key}"), one, function
        elif inspect.isfunction(one):
            yield name, None, one


class Arguments(unittest.TestCase):
    def test_every_argument_of_every_public_function(self) -> None:
        tried, names = 0, set()
        for name, owner, function in functions():
            inner = function.__wrapped__
            hints = _arguments._hints(inner)
            parameters = inspect.signature(inner).parameters
            first = next(iter(parameters), None) if owner is not None else None
            for parameter, hint in hints.items():
                if hint is typing.Any or parameters[parameter].kind in (inspect.Parameter.VAR_KEYWORD, inspect.Parameter.VAR_POSITIONAL):
                    continue
                given = {}
                try:
                    for key, other in parameters.items():
                        if key in (first, parameter) or other.default is not inspect.Parameter.empty:
                            continue
                        if other.kind in (inspect.Parameter.VAR_KEYWORD, inspect.Parameter.VAR_POSITIONAL):
                            continue
                        given[key] = sample(hints.get(key, typing.Any))
                except LookupError:
                    continue
                subject = [] if first is None else [owner.__new__(owner) if first == "self" else owner]
                for bad in BAD:
                    if _arguments._fits(bad, hint):
                        continue
                    with self.subTest(function=name, argument=parameter, value=bad), self.assertRaises(TypeError) as caught:
                        function(*subject, **{**given, parameter: bad})
                    said = str(caught.exception)
                    self.assertIsInstance(caught.exception, softland.InvalidInput, said)
                    self.assertIn(f"{name}: {parameter} must be ", said)
                    self.assertIn(f"({type(bad).__name__})", said)
                    self.assertEqual(caught.exception.key, parameter)
                    for words in ("incompatible", "Invoked with", "Unable to cast", "C++"):
                        self.assertNotIn(words, said)
                    tried += 1
                    names.add(name)
        self.assertGreater(tried, 300)
        self.assertGreater(len(names), 40)

    def test_what_fits_is_taken(self) -> None:
        scene = softland.shipped("mem-gold")
        scene.update({**FEW, "waveform.main.level": np.float64(17.5), "structure.modes": np.int64(1)})
        scene["electrode.main.span"] = ("60 um", "tip")
        with tempfile.TemporaryDirectory() as folder:
            scene.save(Path(folder) / "scene.toml")
            self.assertEqual(len(softland.load(Path(folder) / "scene.toml").drives), 1)
        ramp = softland.Waveform.table((0, 1e-6), np.array([0, 5]))
        self.assertEqual(ramp(2e-6), 5)
        self.assertEqual(ramp.resampled("1 MHz", np.float32(1e-5)).hold_level, 5)

    def test_what_functions_of_the_user_give(self) -> None:
        with self.assertRaisesRegex(softland.InvalidInput, r"own waveform 'wrong' returned 'volts' \(str\); it must return an array of numbers"):
            softland.OwnWaveform("wrong", lambda t, x: "volts", [1e-6])
        with self.assertRaisesRegex(softland.InvalidInput, r"breakpoints of the own waveform 'wrong' returned 'times' \(str\)"):
            softland.OwnWaveform("wrong", lambda t, x: t, lambda x: "times")
        with self.assertRaisesRegex(softland.InvalidInput, "no breakpoints, so that it would keep its voltage at t = 0 s, 0 V"):
            softland.OwnWaveform("zero", lambda t, x: 1e6 * np.minimum(t, 20e-6), [])
        with self.assertRaisesRegex(softland.InvalidInput, r"step: level must be a number, not \[1, 2\]"):
            softland.Waveform("step", level=[1, 2])
        with self.assertRaisesRegex(softland.InvalidInput, "pulse: levels must be a list of numbers, not 3"):
            softland.Waveform("pulse", levels=3, times=[])

    def test_a_run_that_begins_closed(self) -> None:
        scene = softland.shipped("mem-gold")
        scene.update(FEW)
        scene.update({"waveform.main": {"family": "step", "level": "0 V", "before": "20 V"}, "simulate.duration": "2 ms"})
        collapsed = scene.simulate()
        self.assertEqual(collapsed.status, "collapsed_at_rest")
        self.assertIn('waveform.main.before_state = "closed" begins there', collapsed.message)
        scene["waveform.main.before_state"] = "closed"
        opened = scene.simulate()
        self.assertFalse(opened.touched)
        self.assertGreater(opened.trajectory["position"][0] if "position" in (opened.trajectory.dtype.names or ()) else 1, 0)
        with self.assertRaisesRegex(softland.InvalidInput, "waveform.main.before_state.*from the open state"):
            scene.optimize(budget=1)
        with self.assertRaisesRegex(softland.InvalidInput, "waveform.main.before_state.*from the open state"):
            scene.evaluator(["gap.contact"], ["impact_velocity"])

    def test_progress_never_runs_back(self) -> None:
        scene = softland.shipped("mem-gold")
        scene.update({"simulate.duration": "100 us", "structure.modes": 1})
        for study in (
            lambda tell: scene.simulate(certify=True, progress=tell),
            lambda tell: scene.pull_in(progress=tell),
            lambda tell: scene.effects(progress=tell),
            lambda tell: scene.robustness(samples=16, progress=tell),
            lambda tell: scene.limit(curves=False, progress=tell),
            lambda tell: scene.opening(budget=50, samples=8, progress=tell),
        ):
            most: dict[str, float] = {}

            def tell(what: str, part: float, most: dict[str, float] = most) -> None:
                self.assertGreaterEqual(part, most.get(what, 0.0), what)
                self.assertLessEqual(part, 1.0, what)
                most[what] = part

            study(tell)


if __name__ == "__main__":
    unittest.main()
