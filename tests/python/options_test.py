"""The program and Python have the same options of every verb; what only one of them has stands here, with its reason."""

import inspect
import os
import re
import subprocess
import unittest

import softland

PROGRAM = os.environ["SOFTLAND_PROGRAM"]
METHODS = {
    "simulate": softland.Scene.simulate, "optimize": softland.Scene.optimize, "explore": softland.Scene.explore, "tune": softland.Scene.tuning, "device": softland.Scene.device,
    "export": softland.Scene.export, "check": softland.Scene.checked, "pull-in": softland.Scene.pull_in, "effects": softland.Scene.effects, "accuracy": softland.Scene.accuracy,
    "limit": softland.Scene.limit, "release": softland.Scene.opening, "cycle": softland.Scene.cycle, "robustness": softland.Scene.robustness, "fit": softland.Scene.fit, "calibrate": softland.Scene.calibrate,
}  # fmt: skip
NO_METHOD = {
    "modes": "scene.modes() has the modes of a scene, and tables of other programs are arrays in Python",
    "table": "softland.open(store) has the rows",
    "status": "softland.open(store) has the rows",
    "merge": "a store is made in the shell",
    "slurm": "a cluster runs the program",
    "new": "softland.shipped() has scenes to start from",
    "report": "Outcome.save() writes the pages",
    "read": "softland.read() needs no scene",
}
PROGRAM_ALONE = {
    "": {
        "help": "Python has docstrings",
        "set": "scene[key] = value",
        "quiet": "progress=False",
        "json": "an Outcome is the record",
        "out": "Outcome.save(folder)",
    },
    "optimize": {"seeds": "a loop over seed", "limit": "scene.limit()", "cycle": "scene.cycle(search=True)", "duty": "scene.cycle(search=True)"},
    "explore": {
        "list": "an Evaluator takes rows",
        "point": "Store has the points",
    },
    "tune": {
        **{name: "the device is a function in Python" for name in ("device", "by-hand", "format", "sample-rate", "bits", "amplifier", "contact", "timeout")},
        **{name: "errors" for name in ("edge-error", "unseen", "gain-error", "shot-error", "trigger-delay")},
        "closings": "of Tuning.run()",
    },
    "device": {**{name: "errors" for name in ("edge-error", "unseen", "gain-error", "shot-error")}, "model": "more_modes, gas, stiffness and set"},
    "export": {"device-vdp": "measured", "device-frequency": "measured", "RESULT": "the scene itself"},
}
PYTHON_ALONE = {
    "": {"progress": "a function may be told"},
    "simulate": {"errors": "a loop may leave out the second run", "waveforms": "functions of Python may drive"},
    "optimize": {name: "a function or an object of Python" for name in ("objective", "lands_first", "own_waveforms", "callback")} | {"out": "evaluations are kept there while it runs"},
    "explore": {"out": "the store"},
    "tune": {"errors": "the four options of instruments", "out": "closings are kept there while it runs"},
    "device": {"errors": "the four options of instruments", "more_modes": "--model", "gas": "--model", "stiffness": "--model", "set": "--model"},
    "export": {"waveforms": "in the place of the scene's", "jobs": "the program takes all cores"},
}
RENAMED = {("explore", "option"): "options", ("fit", "unknown"): "unknowns", ("limit", "no-curves"): "curves", ("calibrate", "error"): "errors", ("robustness", "RESULT"): "waveforms", ("cycle", "RESULT"): "waveforms", ("cycle", "no-scan"): "scan"}


def options_of(verb: str) -> set[str]:
    text = subprocess.run([PROGRAM, verb, "--help"], capture_output=True, text=True, check=True).stdout
    words = set(re.findall(r"^  (?:-\w,)?--([a-z-]+)", text, re.MULTILINE))
    return words | set(re.findall(r"^  (RESULT)\b", text, re.MULTILINE))


class Options(unittest.TestCase):
    def test_every_verb_has_a_method_or_a_reason(self):
        text = subprocess.run([PROGRAM, "--help"], capture_output=True, text=True, check=True).stdout
        verbs = set(re.findall(r"^  ([a-z-]+) {3,}", text.partition("Verbs:")[2], re.MULTILINE))
        self.assertGreater(len(verbs), 20)
        self.assertEqual(verbs, set(METHODS) | set(NO_METHOD))

    def test_the_program_and_python_have_the_same(self):
        for verb, method in METHODS.items():
            with self.subTest(verb):
                alone = set(PROGRAM_ALONE[""]) | set(PROGRAM_ALONE.get(verb, {}))
                told = options_of(verb)
                self.assertLessEqual(set(PROGRAM_ALONE.get(verb, {})), told, "listed as of the program alone, and not there")
                there = {RENAMED.get((verb, name), name.replace("-", "_")) for name in told - alone}
                python = set(inspect.signature(method).parameters) - {"self"}
                here = set(PYTHON_ALONE.get(verb, {}))
                self.assertLessEqual(here, python, "listed as of Python alone, and not there")
                self.assertEqual(there, python - here - set(PYTHON_ALONE[""]))

    def test_what_stands_in_the_way_of_a_value_is_said_in_the_names_of_python(self):
        scene = softland.shipped("mem-gold")
        with self.assertRaisesRegex(softland.InvalidInput, r"^impact_velocity 0.0 m/s: must be a velocity above 0 m/s"):
            scene.limit(impact_velocity=0)
        with self.assertRaisesRegex(softland.InvalidInput, r"^samples 0: must be a whole number from 1 on"):
            scene.robustness(samples=0)
        with self.assertRaisesRegex(softland.InvalidInput, r"^errors Vdp:2: must be Vdp"):
            scene.calibrate(errors={"Vdp": 2})
        with self.assertRaisesRegex(softland.InvalidInput, r"^bias nix=1.0 V: unknown drive"):
            scene.pull_in(bias={"nix": 1})
        with self.assertRaisesRegex(softland.InvalidInput, r"^hold_step late: must be chosen or fixed"):
            scene.optimize(hold_step="late")
        with self.assertRaisesRegex(softland.InvalidInput, r"^budget many: must be a whole number"):
            scene.explore({"gap.contact": "1.6 um:2.4 um:3"}, "no.sqlite", study="optimize", options={"budget": "many"})
        with self.assertRaisesRegex(softland.InvalidInput, r"^unseen 1 V: must be a time"):
            scene.tuning(errors={"unseen": "1 V"})


if __name__ == "__main__":
    unittest.main()
