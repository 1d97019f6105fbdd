"""The module gives the bits of the program of the same build: every shipped scene, to the last digit of its JSON."""

import json
import os
import pathlib
import subprocess
import tempfile
import unittest

import softland

SCENES = pathlib.Path(__file__).resolve().parents[2] / "scenes"
PROGRAM = os.environ["SOFTLAND_PROGRAM"]
# Keys that say when, how fast and by what the result was made.
OF_THE_RUN = ("command", "made_with", "reproduce", "version")


def figures(result):
    kept = {key: value for key, value in result.items() if key not in OF_THE_RUN}
    kept.get("work", {}).pop("wall_s", None)
    return kept


def said_by_program(verb, scene, *options):
    done = subprocess.run([PROGRAM, verb, str(scene), *options, "--json", "-"], capture_output=True, text=True)
    return json.loads(done.stdout)


class Bits(unittest.TestCase):
    def test_simulate_every_shipped_scene(self):
        scenes = sorted(SCENES.glob("*.toml"))
        self.assertGreater(len(scenes), 5)
        for path in scenes:
            with self.subTest(scene=path.name):
                theirs = figures(said_by_program("simulate", path))
                ours = figures(softland.load(path).simulate().result().to_json())
                self.assertIn("metrics", theirs)
                for key, value in theirs.items():
                    self.assertEqual(ours[key], value, f"{path.name}: {key}")

    def test_pull_in(self):
        for name in ("mem-gold.toml", "mem-gold-pzt.toml"):
            ours = softland.load(SCENES / name).pull_in().to_json()
            self.assertEqual(figures(ours), figures(said_by_program("pull-in", SCENES / name)))

    def test_robustness_of_200_devices(self):
        path = SCENES / "mem-gold.toml"
        found = softland.load(path).robustness(samples=200)
        with tempfile.TemporaryDirectory() as folder:
            theirs = said_by_program("robustness", path, "--samples", "200", "--out", folder)
            devices = (pathlib.Path(folder) / "devices.csv").read_text()
        ours, theirs = figures(found.to_json()), figures(theirs)
        for drive in (*ours["drives"], *theirs["drives"]):
            drive.pop("name", None)
        # Figures from linear algebra, as the equilibrium that steady_force_time is held against and exact derivatives, are compiled into program
        # and module from different copies of the same templates: the last digits differ. All other figures of all devices have the same bits.
        _nearly(self, ours, theirs)
        own, other = ([line.split(",") for line in text.splitlines()] for text in (found.file("devices.csv"), devices))
        self.assertEqual(len(own), len(other))
        compared = 0
        for k in range(len(other[0])):
            if "steady_force_time" in other[0][k]:
                continue
            compared += 1
            self.assertEqual([row[k] for row in own[1:]], [row[k] for row in other[1:]], other[0][k])
        self.assertGreater(compared, 10)

    def test_other_verbs(self):
        path = SCENES / "mem-gold.toml"
        scene = softland.load(path)
        with tempfile.TemporaryDirectory() as folder:
            place = pathlib.Path(folder)
            best = place / "best.toml"
            best.write_text(scene.optimize(robust="none", budget=300).file("best.toml"))
            for verb, found, of, options in (
                ("limit", scene.limit(curves=False), path, ("--no-curves", "--out", place / "limit")),
                ("release", scene.opening(budget=100, samples=16), path, ("--budget", "100", "--samples", "16", "--out", place / "release")),
                ("calibrate", softland.load(best).calibrate(samples=16), best, ("--samples", "16")),
            ):
                with self.subTest(verb=verb):
                    ours, theirs = figures(found.to_json()), figures(said_by_program(verb, of, *map(str, options)))
                    self.assertGreater(len(theirs), 2)
                    _nearly(self, _without(ours), _without(theirs))
                    if verb == "calibrate":
                        continue
                    left = {one.name for one in (place / verb).iterdir() if not one.name.startswith(".")}
                    self.assertEqual(set(found.files), left)
                    for name in left - {f"{verb}.json"}:
                        self.assertEqual(found.file(name), (place / verb / name).read_text(), name)

    def test_effects(self):
        path = SCENES / "mem-gold.toml"
        ours, theirs = (one["effects"] for one in (softland.load(path).effects().to_json(), said_by_program("effects", path)))
        # The time of a law depends on the machine. Differences of the last digits decide other figures of a compressible film after many rebounds.
        sound = ("initial_contact_time_s", "impact_velocity_m_s", "peak_contact_force_N")
        for one, other in zip(ours, theirs, strict=True):
            self.assertEqual(one["choice"], other["choice"])
            _nearly(self, {key: one["metrics"][key] for key in sound}, {key: other["metrics"][key] for key in sound})

    def test_accuracy_has_the_settings_of_the_program(self):
        path = SCENES / "mem-gold.toml"
        short = {"simulate.duration": "40 us"}
        ours = softland.load(path, set=short).accuracy().to_json()
        theirs = said_by_program("accuracy", path, "--set", "simulate.duration=40 us")
        self.assertEqual(ours.keys(), theirs.keys())  # figures depend on how fast the machine is

    def test_a_fit(self):
        path = SCENES / "mem-gold.toml"
        with tempfile.TemporaryDirectory() as folder:
            bench = pathlib.Path(folder) / "bench.toml"
            bench.write_text('[[measurement]]\nquantity = "frequency"\nvalue = "40 kHz"\nerror = "0.1 %"\n')
            options = ("--data", str(bench), "--unknown", "structure.thickness", "--out", str(pathlib.Path(folder) / "fit"))
            ours = softland.load(path).fit(bench, ["structure.thickness"])
            theirs = said_by_program("fit", path, *options)
            self.assertEqual(figures(ours.to_json()).keys(), figures(theirs).keys())
            self.assertEqual(ours["unknowns"][0].to_json(), theirs["unknowns"][0])
            self.assertEqual(
                softland.load(ours.file("fitted.toml"))["structure.thickness"],
                softland.load(pathlib.Path(folder) / "fit" / "fitted.toml")["structure.thickness"],
            )

    def test_a_search(self):
        path = SCENES / "mem-gold.toml"
        ours = softland.load(path).optimize(robust="none", budget=300, jobs=2).to_json()
        theirs = said_by_program("optimize", path, "--robust", "none", "--budget", "300", "--jobs", "2")
        for key in ("best", "metrics", "evaluations", "goal_met", "termination"):
            if key in theirs:
                self.assertEqual(_without(ours[key]), _without(theirs[key]), key)


def _nearly(test, ours, theirs):
    """The same but for 1e-9 of each number; `error` is a difference of such sums, of which less is left."""
    if isinstance(theirs, dict):
        test.assertEqual(set(ours), set(theirs))
        for key in theirs:
            if key != "error":
                _nearly(test, ours[key], theirs[key])
    elif isinstance(theirs, list):
        test.assertEqual(len(ours), len(theirs))
        for one, other in zip(ours, theirs):
            _nearly(test, one, other)
    elif isinstance(theirs, float):
        test.assertLess(abs(ours - theirs), 1e-9 * abs(theirs) + 1e-300)
    else:
        test.assertEqual(ours, theirs)


def _without(value):
    if isinstance(value, dict):
        return {key: _without(one) for key, one in value.items() if key not in ("wall_s", "trajectory", "rebounds", "curve")}
    return value


if __name__ == "__main__":
    unittest.main()
