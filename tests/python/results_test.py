"""What the program wrote is read, and what Python found is written as the program does."""

import json
import os
import pathlib
import subprocess
import tempfile
import unittest

import numpy as np
import softland

SCENES = pathlib.Path(__file__).resolve().parents[2] / "scenes"
GOLD = SCENES / "mem-gold.toml"
PROGRAM = os.environ["SOFTLAND_PROGRAM"]


class Results(unittest.TestCase):
    def setUp(self):
        self.place = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.place.name)

    def tearDown(self):
        self.place.cleanup()

    def run_program(self, *words):
        subprocess.run([PROGRAM, *map(str, words)], check=True, capture_output=True)

    def test_a_folder_of_the_program(self):
        self.run_program("optimize", GOLD, "--robust", "none", "--budget", 200, "--out", self.folder / "run")
        found = softland.open(self.folder / "run")
        self.assertIn("best.toml", found.files)
        closing = found.scene().simulate()
        self.assertEqual(closing.impact_velocity, found.metrics.impact_velocity)
        self.assertEqual(closing.impact_velocity.unit, found.metrics.impact_velocity.unit)
        again = softland.load(GOLD).simulate(errors=False, waveforms=found.waveforms())
        self.assertLess(abs(again.initial_contact_time / closing.initial_contact_time - 1), 1e-6)
        self.assertGreater(len(found.trajectory()), 100)

    def test_python_writes_the_files_of_the_program(self):
        folder = softland.load(GOLD).simulate().save(self.folder / "mine")
        self.run_program("simulate", GOLD, "--out", self.folder / "theirs")
        names = {"result.json", "report.html", "gap.svg", "trajectory.csv"}
        self.assertEqual(names, {path.name for path in folder.iterdir()})
        for name in ("gap.svg", "trajectory.csv"):
            self.assertEqual((folder / name).read_bytes(), (self.folder / "theirs" / name).read_bytes(), name)
        self.run_program("report", folder)
        self.assertEqual(softland.open(folder).metrics.impact_velocity, softland.load(GOLD).simulate().impact_velocity)
        json.loads((folder / "result.json").read_text())

    def test_a_search_leaves_the_files_of_the_program(self):
        found = softland.load(GOLD).optimize(robust="yield", waveform="catch", budget=400, samples=8, jobs=2)
        folder = found.save(self.folder / "mine")
        words = ["--robust", "yield", "--waveform", "catch", "--budget", 400, "--samples", 8, "--jobs", 2]
        subprocess.run([PROGRAM, "optimize", GOLD, *map(str, words), "--out", self.folder / "theirs"], capture_output=True)
        theirs = {path.name for path in (self.folder / "theirs").iterdir()}
        kept = {name for name in theirs if name.startswith("evaluations.") or name.endswith(".lock")}
        self.assertEqual(theirs - kept, {path.name for path in folder.iterdir()})
        self.assertIn("robustness.html", theirs)
        for name in ("best.toml", "best.csv", "gap.svg", "trajectory.csv"):
            self.assertEqual((folder / name).read_bytes(), (self.folder / "theirs" / name).read_bytes(), name)

    def test_a_store(self):
        store = self.folder / "map.sqlite"
        self.run_program("explore", GOLD, "--vary", "gap.contact=1.8 um:2.2 um:3", "--vary", "structure.thickness=1.9 um:2.1 um:2", "--out", store)
        found = softland.open(store)
        self.assertEqual((len(found), found.points), (6, 6))
        rows = found.rows()
        scene = softland.load(GOLD)
        columns = {name: key for key, (name, _) in found.columns.items()}
        scene.update({key: float(rows[columns[key]][4]) for key in ("gap.contact", "structure.thickness")})
        self.assertEqual(scene.simulate().impact_velocity, rows["impact_velocity_m_s"][4])
        self.assertEqual(found.columns["impact_velocity_m_s"][1], "m/s")
        self.assertTrue(np.all(rows["status"] != ""))

    def test_an_exploration_has_the_rows_of_the_program(self):
        vary = {"gap.contact": "1.8 um:2.2 um:3", "structure.thickness": "1.9 um:2.1 um:2"}
        mine = softland.load(GOLD).explore(vary, self.folder / "mine.sqlite")
        self.run_program("explore", GOLD, *(word for key, values in vary.items() for word in ("--vary", f"{key}={values}")), "--out", self.folder / "theirs.sqlite")
        theirs = softland.open(self.folder / "theirs.sqlite")
        self.assertEqual(mine.plan, theirs.plan)
        self.assertEqual(mine.columns, theirs.columns)
        for name in mine.columns:
            np.testing.assert_array_equal(mine.rows()[name], theirs.rows()[name])
        # Existing rows are not computed again, and a longer plan begins with them.
        vary["gap.contact"] = "1.8 um:2.2 um:5"
        self.assertEqual(len(softland.load(GOLD).explore(vary, self.folder / "mine.sqlite", resume=True)), 10)

    def test_a_front_and_what_is_asked_of_its_points(self):
        front = softland.load(GOLD).explore(
            {"waveform.main.level": "1.05 Vdp:1.6 Vdp"}, self.folder / "front.sqlite", pareto=["initial_contact_time", "impact_velocity"], sample="nsga2:60"
        )
        self.assertEqual(len(front), 60)
        yields = softland.load(GOLD).explore({"gap.contact": "1.9 um,2 um"}, self.folder / "yield.sqlite", study="robustness", options={"samples": 16})
        self.assertTrue(np.all(yields.rows()["closing_yield"] <= 1))

    def test_an_exploration_that_cannot_be_is_refused_by_name(self):
        scene = softland.load(GOLD)
        for vary, more, words in (
            ({}, {}, "no key varies"),
            ({"gap.breadth": "1 um:2 um:3"}, {}, "gap.breadth"),
            ({"gap.contact": "1.9 um,2 um"}, {"study": "beauty"}, "study beauty: must be"),
            ({"gap.contact": "1.9 um,2 um"}, {"options": {"samples": 5}}, "belongs to study robustness"),
            ({"gap.contact": "1.9 um,2 um"}, {"shard": "1/3"}, "shard 1/3: a study of 2 points has at most 2 parts"),
            ({"gap.contact": "1.9 um:2 um"}, {"pareto": ["impact_velocity"]}, "at least two figures"),
        ):
            with self.assertRaisesRegex(softland.InvalidInput, words):
                scene.explore(vary, self.folder / "none.sqlite", **more)
            self.assertFalse((self.folder / "none.sqlite").exists(), words)

    def test_what_is_nothing_of_ours_is_refused(self):
        with self.assertRaises(softland.InvalidInput):
            softland.open(self.folder)
        with self.assertRaises(softland.InvalidInput):
            softland.open(self.folder / "nothing")


if __name__ == "__main__":
    unittest.main()
