"""Tunings on devices that are Python functions: the proposals of the program, and nothing lost whatever the function does."""

import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import textwrap
import time
import unittest

import numpy as np
import softland

SCENES = pathlib.Path(__file__).resolve().parents[2] / "scenes"
GOLD = SCENES / "mem-gold.toml"
PROGRAM = os.environ["SOFTLAND_PROGRAM"]
QUICK = {"effort": 0.05}
OF_THE_RUN = ("command", "made_with", "reproduce", "version")


def without_run(record):
    return {key: value for key, value in record.items() if key not in OF_THE_RUN}


class Tunings(unittest.TestCase):
    def setUp(self):
        self.place = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.place.name)
        self.scene = softland.load(GOLD)

    def tearDown(self):
        self.place.cleanup()

    def tuned_by_program(self, closings, out, *more):
        device = f"{PROGRAM} device {GOLD} --seed 7 --model modes=+1"
        command = [PROGRAM, "tune", GOLD, "--device", device, "--effort", "0.05", "--closings", closings, "--out", out, "--quiet", *more]
        subprocess.run([*map(str, command)], capture_output=True, check=False)
        return [json.loads(line) for line in (out / "closings.jsonl").read_text().splitlines()]

    def test_shots_and_answers_are_those_of_the_program(self):
        theirs = self.tuned_by_program(3, self.folder / "theirs")
        device = self.scene.device(seed=7, more_modes=1)
        found = self.scene.tune(device, closings=3, out=self.folder / "ours", **QUICK)
        ours = [json.loads(line) for line in (self.folder / "ours" / "closings.jsonl").read_text().splitlines()]
        self.assertEqual(ours, theirs)
        program = json.loads((self.folder / "theirs" / "tune.json").read_text())
        self.assertEqual(without_run(found.to_json()), without_run(program))
        self.assertEqual(found.status, "closings_used")
        for name in ("best.toml", "best.csv"):
            self.assertEqual((self.folder / "ours" / name).read_bytes(), (self.folder / "theirs" / name).read_bytes(), name)
        self.assertEqual({path.name for path in (self.folder / "ours").iterdir()}, {"best.toml", "best.csv", "closings.jsonl", "tune.html", "tune.json"})
        self.assertEqual(softland.open(self.folder / "ours").closings[0].keys(), found.closings[0].keys())
        # The program goes on with what Python has begun, and fires none of it again.
        both = self.tuned_by_program(4, self.folder / "ours", "--resume")
        self.assertEqual(both[: len(ours)], ours)
        self.assertEqual(len(both), len(ours) + 1)

    def test_a_device_gets_waveforms_and_samples(self):
        seen = []

        def device(shot):
            seen.append(shot)
            times, volts = shot.points()
            self.assertEqual(times[0], 0)
            self.assertEqual(shot.waveforms["main"].hold_level, volts[-1])
            self.assertAlmostEqual(shot.duration, times[-1] + shot.hold, places=12)
            samples = shot.samples(1e8)
            self.assertEqual(len(samples), int(np.ceil(shot.duration * 1e8)) + 1)
            self.assertEqual(samples[1234], shot.waveforms["main"](1234e-8))
            self.assertEqual(shot.line["drives"]["main"]["V"], volts.tolist())
            return {"edges_s": np.array([[40e-6, 1], [41e-6, 0], [43e-6, 1]]), "loudness": np.float64(2)}

        said = []
        found = self.scene.tune(device, closings=2, callback=said.append, **QUICK)
        self.assertEqual([shot.number for shot in seen], [1, 2])
        self.assertEqual([shot.amplifiers for shot in seen], [{"main": 1}, {"main": 1}])
        self.assertIn("one bounce", said[0])
        self.assertEqual(len(found.closings), 2)

    def test_volts_are_those_at_the_switch_behind_an_amplifier(self):
        plain = self.scene.tuning(**QUICK).shot()
        self.scene["driver.main.amplifier"] = 20
        amplified = self.scene.tuning(**QUICK).shot()
        self.assertEqual(amplified.amplifiers, {"main": 20})
        self.assertEqual(amplified.line["drives"]["main"], {**plain.line["drives"]["main"], "amplifier": 20})
        self.assertTrue(self.scene.device(seed=7)(amplified).items() == self.scene.device(seed=7)(plain).items())

    def test_records_begin_late_by_a_trigger_delay(self):
        shot = self.scene.tuning(**QUICK).shot()
        exact, late = self.scene.device(seed=7)(shot)["edges_s"], self.scene.device(seed=7, trigger_delay="1 us")(shot)["edges_s"]
        np.testing.assert_allclose([edge[0] for edge in late], [edge[0] - 1e-6 for edge in exact], rtol=0, atol=1e-12)
        known = {one.name: one for one in self.scene.tuning(errors={"trigger_delay": "3 us"}, **QUICK).result().belief.quantities}
        self.assertAlmostEqual(known["trigger delay"].prior_deviation / 3e-6, 1, places=2)
        with self.assertRaisesRegex(ValueError, "trigger_delay"):
            self.scene.device(errors={"trigger_delay": 1e-6})

    def test_what_a_device_raises_comes_out_and_nothing_is_lost(self):
        simulated = self.scene.device(seed=7)
        fired = []

        def device(shot):
            fired.append(shot.number)
            if len(fired) == 3:
                raise ZeroDivisionError("no trigger")
            return simulated(shot)

        with self.assertRaisesRegex(ZeroDivisionError, "^no trigger$") as raised:
            self.scene.tune(device, out=self.folder, **QUICK)
        tuning = raised.exception.tuning
        self.assertEqual(tuning.closings, 2)
        self.assertEqual(softland.open(self.folder).status, "failed")
        self.assertEqual(len(softland.open(self.folder).closings), 2)
        tuning.run(device, closings=3)
        self.assertEqual(fired, [1, 2, 3, 3])
        again = self.scene.tuning(out=self.folder, resume=True, **QUICK)
        self.assertEqual(again.closings, 3)
        self.assertEqual(again.shot().line, tuning.shot().line)

    def test_answers_that_cannot_be_are_refused_and_not_learned(self):
        tuning = self.scene.tuning(**QUICK)
        for answer, words in (
            ({"edges": []}, "edges"),
            ({"edges_s": [[40e-6, 0]]}, "first edge closes"),
            ({"closing_time_s": -1.0}, "closing_time_s"),
        ):
            with self.assertRaisesRegex(softland.InvalidInput, words):
                tuning.learn(answer)
        self.assertEqual((tuning.closings, tuning.shot().number), (0, 1))
        with self.assertRaises(TypeError):
            tuning.learn({"edges_s": object()})
        with self.assertRaisesRegex(softland.InvalidInput, "3 shots in a row gave no record.*no trigger"):
            tuning.run(lambda shot: {"error": "no trigger"})
        self.assertEqual(tuning.closings, 0)
        tuning.run(lambda shot: None, closings=1)  # it stayed open
        self.assertIsNone(tuning.result().closings[-1].to_json().get("touch_s"))

    def test_what_follows_a_refused_answer_is_on_record(self):
        tuning = self.scene.tuning(out=self.folder, **QUICK)
        with self.assertRaisesRegex(softland.InvalidInput, "first edge closes"):
            tuning.learn({"edges_s": [[40e-6, 0]]})
        tuning.learn(self.scene.device(seed=7)(tuning.shot()))
        again = self.scene.tuning(out=self.folder, resume=True, **QUICK)
        self.assertEqual((again.closings, again.shot().line), (1, tuning.shot().line))

    def test_bad_options_are_refused(self):
        for options, words in (
            ({"actuator": "magnet"}, "actuator"),
            ({"constrain": "initial_contact_tim < 3 us"}, "constrain"),
            ({"effort": -1.0}, "effort"),
            ({"errors": {"edge_error": -1.0}}, "edge_error"),
            ({"errors": {"trigger_delay": -1.0}}, "trigger_delay"),
            ({"wafer": [self.folder]}, "tune.json"),
        ):
            with self.assertRaisesRegex(softland.InvalidInput, words):
                self.scene.tuning(**options)
        with self.assertRaisesRegex(ValueError, "edge_errors"):
            self.scene.device(errors={"edge_errors": 1e-9})
        with self.assertRaises(softland.InvalidInput):
            self.scene.device(stiffness=0.0)
        with self.assertRaises(softland.InvalidInput):
            self.scene.device(set={"gap.contakt": "2 um"})

    def test_ctrl_c_ends_a_tuning_and_keeps_the_closings(self):
        script = textwrap.dedent(f"""
            import softland, sys
            scene = softland.load({str(GOLD)!r})
            simulated = scene.device(seed=7)
            tuning = scene.tuning(effort=0.05, out={str(self.folder)!r})
            tuning.learn(simulated(tuning.shot()))
            def device(shot):
                print("fired", flush=True)
                return simulated(shot)
            try:
                tuning.run(device)
            except KeyboardInterrupt:
                print("stopped", flush=True)
                sys.exit(7)
        """)
        run = subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True, env=os.environ)
        try:
            self.assertEqual(run.stdout.readline(), "fired\n")
            time.sleep(0.1)
            sent = time.monotonic()
            run.send_signal(signal.SIGINT)
            told, _ = run.communicate(timeout=30)
        finally:
            run.kill()
        self.assertLess(time.monotonic() - sent, 2)
        self.assertTrue(told.endswith("stopped\n"), told)
        self.assertEqual(run.returncode, 7)
        kept = [json.loads(line) for line in (self.folder / "closings.jsonl").read_text().splitlines()]
        self.assertGreaterEqual(len(kept), 4)  # origin, recipes, two closings
        self.assertEqual(softland.open(self.folder).status, "interrupted")
        self.assertGreaterEqual(self.scene.tuning(out=self.folder, resume=True, **QUICK).closings, 2)


if __name__ == "__main__":
    unittest.main()
