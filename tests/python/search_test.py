"""Searches: own objectives and waveforms, callbacks, Ctrl-C."""

import os
import pathlib
import signal
import sqlite3
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


def swell(hold, limit):
    """The waveform of examples/05_own_waveform.cc."""

    def between(start, end, part):
        return start + (end - start) / 2 * (1 - np.cos(np.pi * np.minimum(1, part)))

    def voltage(t, x):
        high, low, up, down, back = x
        return np.where(t < up, between(0, high, t / up),
                        np.where(t < up + down, between(high, low, (t - up) / down), between(low, hold, (t - up - down) / back)))  # fmt: skip

    return softland.OwnWaveform(
        "swell",
        voltage,
        lambda x: np.cumsum(x[2:]),
        {
            "high_V": (0, limit, 1.1 * hold),
            "low_V": (0, limit, 0.6 * hold),
            "up_s": ("1 us", "50 us", "10 us"),
            "down_s": ("1 us", "50 us", "25 us"),
            "back_s": ("1 us", "50 us", "10 us"),
        },
    )


class Searches(unittest.TestCase):
    def test_an_own_waveform_is_run_and_searched_like_in_cpp(self):
        scene = softland.load(GOLD)
        hold = scene.waveforms["main"].hold_level
        own = swell(hold, 1.2 * hold)  # the driver of the scene: 1.5 Vdp at a hold voltage of 1.25
        as_it_stands = scene.simulate(errors=False, waveforms={"main": own})
        # The C++ example prints 51.86 us, 51.45 mm/s.
        self.assertAlmostEqual(as_it_stands.initial_contact_time * 1e6, 51.86, places=2)
        self.assertAlmostEqual(as_it_stands.impact_velocity * 1e3, 51.45, places=2)
        found = scene.optimize(robust="none", own_waveforms=[own], waveform="swell", budget=300)
        self.assertLess(found.metrics.impact_velocity, 0.5 * as_it_stands.impact_velocity)
        self.assertIn("main.high_V", found["best"]["parameters"])

    def test_an_own_objective_leads_the_search(self):
        scene = softland.load(GOLD)
        calls = []

        def gentle(closing, step):
            calls.append(closing["impact_velocity"])
            return closing["peak_contact_force"] / step["peak_contact_force"]

        found = scene.optimize(robust="none", objective=gentle, lands_first=False, budget=200)
        self.assertGreater(len(calls), 100)
        self.assertLess(found.metrics.peak_contact_force, found.baseline.metrics.peak_contact_force)

    def test_over_devices_an_objective_gets_arrays_once_for_a_candidate(self):
        scene = softland.load(GOLD)
        sizes = []

        def gentle(closing, step):
            sizes.append(np.shape(closing["peak_contact_force"]))
            return closing["peak_contact_force"] / step["peak_contact_force"]

        options = {"robust": "cvar:0.9", "waveform": "pulse", "budget": 1500, "samples": 32}
        found = scene.optimize(objective=gentle, **options)
        built_in = scene.optimize(target="force", **options)
        self.assertEqual(found.best.parameters.to_json(), built_in.best.parameters.to_json())
        of_devices = [size for size in sizes if size != ()]
        self.assertGreater(max(size[0] for size in of_devices), 16)
        self.assertLess(len(sizes), 1500 / 8)  # closings for each call
        with self.assertRaisesRegex(softland.InvalidInput, "1 values for .* devices.*array"):
            scene.optimize(objective=lambda closing, step: np.mean(closing["impact_velocity"]) / step["impact_velocity"], **options)

    def test_what_an_objective_raises_comes_out_at_once(self):
        def broken(closing, step):
            raise ZeroDivisionError("mine")

        began = time.monotonic()
        with self.assertRaisesRegex(ZeroDivisionError, "mine"):
            softland.load(GOLD).optimize(robust="none", objective=broken, budget=2500)
        self.assertLess(time.monotonic() - began, 3)

    def test_a_callback_sees_every_evaluation_and_ends_the_search(self):
        seen = []

        def callback(evaluations, best, of_step, now):
            seen.append(evaluations)
            return evaluations >= 100

        found = softland.load(GOLD).optimize(robust="none", budget=2000, jobs=1, callback=callback)
        self.assertLess(seen[-1], 200)
        self.assertLess(found.metrics.impact_velocity, found.baseline.metrics.impact_velocity)

    def test_progress_is_told(self):
        told = []
        softland.load(GOLD).robustness(samples=2000, progress=lambda what, part: told.append((what, part)))
        self.assertTrue(all(0 <= part <= 1 for _, part in told))
        self.assertTrue(any("devices" in what for what, _ in told))


class Kept(unittest.TestCase):
    """Searches in a folder, which Python and the program go on with."""

    OPTIONS = {"robust": "none", "waveform": "pulse", "jobs": 1}
    WORDS = ["optimize", GOLD, "--robust", "none", "--waveform", "pulse", "--jobs", "1", "--quiet"]

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.out = pathlib.Path(self.folder.name)

    def program(self, *words):
        run = subprocess.run([PROGRAM, *words], capture_output=True, text=True, check=False)
        self.assertIn(run.returncode, (0, 4), run.stderr)
        return run.stdout

    def text(self, name, file):
        return (self.out / name / file).read_text()

    def count(self, name, of):
        with sqlite3.connect(self.out / name / "evaluations.sqlite") as store:
            return store.execute(f"select count(*) from {of}").fetchone()[0]

    def test_leaves_the_files_of_the_program(self):
        found = softland.load(GOLD).optimize(**self.OPTIONS, budget=150, out=self.out / "python")
        self.program(*self.WORDS, "--budget", "150", "--out", self.out / "program")
        names = {file.name for file in (self.out / "program").iterdir()}
        self.assertEqual({file.name for file in (self.out / "python").iterdir()}, names)
        for file in ("best.toml", "best.csv", "evaluations.csv", "trajectory.csv"):
            self.assertEqual(self.text("python", file), self.text("program", file), file)
        self.assertEqual(self.count("python", "results"), self.count("program", "results"))
        self.assertEqual(found.file("best.toml"), self.text("python", "best.toml"))

    def test_goes_on_with_a_search_of_the_program_and_the_other_way_round(self):
        scene = softland.load(GOLD)
        whole = scene.optimize(**self.OPTIONS, budget=200)
        self.program(*self.WORDS, "--budget", "90", "--out", self.out / "begun")
        begun = self.count("begun", "results")
        longer = scene.optimize(**self.OPTIONS, budget=200, out=self.out / "begun", resume=True)
        self.assertEqual(longer.file("best.toml"), whole.file("best.toml"))
        self.assertGreater(self.count("begun", "results"), begun)
        self.assertEqual(self.count("begun", "session"), 2)
        scene.optimize(**self.OPTIONS, budget=90, out=self.out / "other")
        self.program("optimize", "--resume", "--quiet", "--out", self.out / "other", "--budget", "200")
        self.assertEqual(self.text("other", "best.toml"), whole.file("best.toml"))
        self.assertEqual(self.count("other", "session"), 2)

    def test_what_is_there_is_not_simulated_again(self):
        scene = softland.load(GOLD)
        scene.optimize(**self.OPTIONS, budget=1500, out=self.out / "kept")
        began = time.process_time()
        again = scene.optimize(**self.OPTIONS, budget=1500, out=self.out / "kept", resume=True)
        recalled = time.process_time() - began
        began = time.process_time()
        self.assertEqual(scene.optimize(**self.OPTIONS, budget=1500).file("best.toml"), again.file("best.toml"))
        self.assertLess(recalled, 0.7 * (time.process_time() - began))

    def test_refuses_what_no_folder_can_hold(self):
        scene = softland.load(GOLD)
        with self.assertRaisesRegex(softland.InvalidInput, "out: must not be given for a search with Python functions"):
            scene.optimize(objective=lambda closing, step: 1.0, out=self.out / "own")
        with self.assertRaisesRegex(softland.InvalidInput, "resume: requires `out`"):
            scene.optimize(resume=True)
        scene.optimize(**self.OPTIONS, budget=20, out=self.out / "other")
        with self.assertRaisesRegex(softland.InvalidInput, "resume: .*holds another search: it is for target bounce, not impact"):
            scene.optimize(**self.OPTIONS, target="impact", out=self.out / "other", resume=True)
        with self.assertRaisesRegex(softland.InvalidInput, "out .*best.toml is a folder"):
            (self.out / "taken" / "best.toml").mkdir(parents=True)
            scene.optimize(**self.OPTIONS, out=self.out / "taken")


class Interrupts(unittest.TestCase):
    def interrupted(self, work):
        """Seconds from SIGINT to the end of a Python that runs `work`."""
        script = textwrap.dedent(f"""
            import softland, sys, time
            scene = softland.load({str(GOLD)!r})
            print("begins", flush=True)
            try:
                {work}
            except KeyboardInterrupt:
                print("stopped", flush=True)
                sys.exit(7)
        """)
        with tempfile.NamedTemporaryFile("w", suffix=".py") as file:
            file.write(script)
            file.flush()
            run = subprocess.Popen([sys.executable, file.name], stdout=subprocess.PIPE, text=True, env=os.environ)
            self.assertEqual(run.stdout.readline(), "begins\n")
            time.sleep(2.5)
            sent = time.monotonic()
            run.send_signal(signal.SIGINT)
            try:
                told, _ = run.communicate(timeout=10)
            finally:
                run.kill()
            took = time.monotonic() - sent
            self.assertEqual((told, run.returncode), ("stopped\n", 7))
        return took

    def test_ctrl_c_stops_within_a_fifth_of_a_second(self):
        for work in (
            'scene.optimize(robust="cvar:0.9", budget=10**7)',
            'scene.optimize(robust="none", budget=10**7)',
            "scene.optimize(budget=10**7)",
            "scene.robustness(samples=10**5)",
            'scene.evaluator(["gap.contact"], ["impact_velocity"])([[2e-6]] * 10**5)',
        ):
            with self.subTest(work=work):
                # A machine that does other things, too: the least of three.
                self.assertLess(min(self.interrupted(work) for _ in range(3)), 0.2)


if __name__ == "__main__":
    unittest.main()
