"""The evaluator: bits of `robustness`, gaps as NaN, slopes against differences, threads and pickles."""


import math
import pathlib
import pickle
import unittest
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import softland

SCENES = pathlib.Path(__file__).resolve().parents[2] / "scenes"
GOLD = SCENES / "mem-gold.toml"
KEYS = ["structure.thickness", "gap.electrode", "gap.contact", "structure.youngs_modulus"]
FIGURES = ["initial_contact_time", "impact_velocity", "major_bounce_height", "bounce_count"]


class Evaluators(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scene = softland.load(GOLD)
        cls.evaluate = cls.scene.evaluator(KEYS, FIGURES)

    def rows(self, n=20, seed=1):
        return self.evaluate.nominal * (1 + 0.02 * np.random.default_rng(seed).standard_normal((n, len(KEYS))))

    def test_rows_are_the_devices_of_robustness_to_the_bit(self):
        spread = softland.load(GOLD)
        if any(key.startswith("spread.") for key in spread):
            del spread["spread"]
        spread.update({f'spread."{key}"': {"distribution": "normal", "standard_deviation": f"{0.02 * x!r} {unit}"}
                       for key, x, unit in zip(KEYS, self.evaluate.nominal, self.evaluate.units)})  # fmt: skip
        found = spread.robustness(samples=64)
        lines = found.file("devices.csv").splitlines()
        header = lines[0].split(",")
        column = {name: k for k, name in enumerate(header)}
        rows = np.array([[float(line.split(",")[next(k for name, k in column.items() if name.startswith(key))]) for key in KEYS] for line in lines[1:]])
        own = [name for name in header if name.endswith("initial_contact_time_s")][-1]
        times = np.array([float(line.split(",")[column[own]] or "nan") for line in lines[1:]])
        np.testing.assert_array_equal(self.evaluate(rows)[:, 0], times)

    def test_a_row_does_not_depend_on_other_rows_and_threads(self):
        rows = self.rows(300)
        all_ = self.evaluate(rows)
        np.testing.assert_array_equal(self.evaluate(rows[137]), all_[137])
        one = self.scene.evaluator(KEYS, FIGURES, jobs=1)
        np.testing.assert_array_equal(one(rows), all_)
        with ThreadPoolExecutor(4) as pool:
            for part in pool.map(one, [rows[:100]] * 8):
                np.testing.assert_array_equal(part, all_[:100])

    def test_what_cannot_be_is_nan_with_status_and_reason(self):
        rows = self.rows(3)
        rows[1, 2] = 2 * rows[1, 1]  # a contact beyond the electrode
        rows[2, 0] = math.nan
        values = self.evaluate(rows)
        self.assertTrue(np.isfinite(values[0]).all())
        self.assertTrue(np.isnan(values[1:]).all())
        self.assertEqual(list(self.evaluate.status[1:]), ["infeasible", "infeasible"])
        self.assertEqual(sorted(self.evaluate.reasons), [1, 2])

    def test_the_jacobian_is_the_limit_of_differences(self):
        evaluate = self.scene.evaluator(KEYS, FIGURES[:2], tolerance=1e-9)
        x = evaluate.nominal * [1.01, 0.99, 1.01, 0.98]
        slopes = evaluate.jacobian(x)
        self.assertEqual(slopes.shape, (2, 4))
        for k in range(4):
            h = np.zeros(4)
            h[k] = 1e-4 * x[k]
            difference = (evaluate(x + h) - evaluate(x - h)) / (2 * h[k])
            # Second differences of 1e-4 are 1e-8; closings at 1e-9 over 2e-4 leave 1e-5.
            np.testing.assert_allclose(slopes[:, k], difference, rtol=1e-3, atol=1e-5 * np.max(np.abs(slopes[:, k])))

    def test_where_no_slope_exists_the_reason_is_raised(self):
        with self.assertRaisesRegex(softland.InvalidInput, "bounce_count"):
            self.evaluate.jacobian(self.evaluate.nominal)
        level = self.scene.waveforms["main"].hold_level
        rounded = softland.load(GOLD, set={"driver.main.sample_rate": "10 MHz", "driver.main.bits": 10})
        with self.assertRaisesRegex(softland.InvalidInput, "bits"):
            rounded.evaluator(["waveform.main.level"], ["impact_velocity"]).jacobian([level])
        static = softland.load(GOLD, set={"waveform.main.level": "1.3 Vsp"})
        with self.assertRaisesRegex(softland.InvalidInput, "Vdp"):
            static.evaluator(["gap.contact"], ["impact_velocity"], vdp="each").jacobian([2e-6])

    def differences(self, evaluate, x, step=1e-4):
        """Central ones of every key by its own size."""
        columns = []
        for k in range(len(x)):
            h = np.zeros(len(x))
            h[k] = step * abs(x[k])
            columns.append((evaluate(x + h) - evaluate(x - h)) / (2 * h[k]))
        return np.array(columns).T

    def assert_slopes(self, evaluate, x):
        slopes, differences = evaluate.jacobian(x), self.differences(evaluate, x)
        size = np.max(np.abs(differences * x), axis=1, keepdims=True) / np.abs(x)
        # Second differences of 1e-4 are 1e-8; closings at 1e-9 over 2e-4 leave 1e-5.
        self.assertLess(np.max(np.abs(slopes - differences) / size), 1e-3, (slopes, differences))

    def test_slopes_by_parameters_of_waveforms_are_limits_of_differences(self):
        scene = self.scene.copy()
        hold = scene.waveforms["main"].hold_level
        scene.waveforms["main"] = softland.Waveform("pulse", levels=[1.1 * hold, 0.6 * hold, hold], times=["12 us", "30 us"], edge="1 us")
        keys = ["waveform.main.levels[1]", "waveform.main.levels[2]", "gap.contact", "waveform.main.times[2]", "waveform.main.edge", "driver.main.gain"]
        evaluate = scene.evaluator(keys, FIGURES[:2], tolerance=1e-9)
        self.assert_slopes(evaluate, evaluate.nominal * [1.01, 0.98, 1.02, 0.99, 1.05, 0.995])
        self.assert_slopes(scene.evaluator(keys[:2], FIGURES[:2], tolerance=1e-9), np.array([1.05 * hold, 0.65 * hold]))
        beyond = evaluate.nominal * [3, 1, 1, 1, 1, 1]
        self.assertTrue(np.isnan(evaluate(beyond)).all())
        with self.assertRaisesRegex(softland.InvalidInput, "max"):
            evaluate.jacobian(beyond)

    def test_slopes_where_volts_follow_each_row_are_limits_of_differences(self):
        evaluate = self.scene.evaluator(["gap.contact", "structure.thickness", "waveform.main.level"], FIGURES[:2], vdp="each", tolerance=1e-9)
        self.assert_slopes(evaluate, evaluate.nominal * [1.02, 0.99, 1.03])
        volts = softland.load(GOLD, set={"waveform.main.level": 17.7})
        fixed = volts.evaluator(["gap.contact", "waveform.main.level"], FIGURES[:2], vdp="each", tolerance=1e-9)
        self.assert_slopes(fixed, fixed.nominal * [1.02, 1.01])

    def test_it_survives_a_pickle(self):
        rows = self.rows(5)
        np.testing.assert_array_equal(pickle.loads(pickle.dumps(self.evaluate))(rows), self.evaluate(rows))

    def test_parameters_of_waveforms_and_errors_of_drives(self):
        level = self.scene.waveforms["main"].hold_level
        by_level = self.scene.evaluator(["waveform.main.level"], ["impact_velocity"])
        by_gain = self.scene.evaluator(["driver.main.gain"], ["impact_velocity"])
        self.assertEqual(by_level.nominal[0], level)
        self.assertEqual(by_level.units, ["V"])
        a, b = by_level([[level], [0.97 * level]]), by_gain([[1.0], [0.97]])
        np.testing.assert_allclose(a, b, rtol=1e-9)
        self.assertGreater(a[0, 0], a[1, 0])
        beyond = by_level([[100 * level]])
        self.assertTrue(np.isnan(beyond[0, 0]))
        self.assertIn("max", by_level.reasons[0])

    def test_volts_that_follow_each_row(self):
        keys = ["gap.contact", "structure.length"]
        each = self.scene.evaluator(keys, FIGURES[:2], vdp="each", tolerance=1e-8)
        x = each.nominal * [1.03, 0.97]
        scene = softland.load(GOLD, set={"gap.contact": x[0], "structure.length": x[1]})
        closing = scene.simulate()
        np.testing.assert_allclose(each(x), [closing.initial_contact_time, closing.impact_velocity], rtol=1e-5)
        nominal = self.scene.evaluator(keys, FIGURES[:2])
        self.assertGreater(abs(nominal(x)[1] / each(x)[1] - 1), 1e-3)

    def test_bad_keys_and_figures_are_refused_with_a_hint(self):
        with self.assertRaisesRegex(softland.InvalidInput, "thickness"):
            self.scene.evaluator(["structure.thicknes"], ["impact_velocity"])
        with self.assertRaisesRegex(softland.InvalidInput, "impact_velocity"):
            self.scene.evaluator(["structure.thickness"], ["impact"])
        with self.assertRaisesRegex(softland.InvalidInput, "level"):
            self.scene.evaluator(["waveform.main.levle"], ["impact_velocity"])
        with self.assertRaisesRegex(softland.InvalidInput, r"\(n, 4\), got \(3, 7\)"):
            self.evaluate(np.zeros((3, 7)))
        one = self.scene.evaluator("gap.contact", "impact_velocity")
        self.assertEqual((one.keys, one.figures), (["gap.contact"], ["impact_velocity"]))
        with self.assertRaisesRegex(softland.InvalidInput, r"x\[:, None\]"):
            one(np.linspace(1.9e-6, 2.1e-6, 5))

    def test_scipy_takes_one_figure_in_whole_populations(self):
        try:
            from scipy.optimize import differential_evolution
        except ImportError:
            self.skipTest("no SciPy; needs: python3-scipy")
        level = self.scene.waveforms["main"].hold_level
        evaluate = self.scene.evaluator(["waveform.main.level"], ["impact_velocity"])
        found = differential_evolution(evaluate.one(), [(0.95 * level, 1.05 * level)], vectorized=True, updating="deferred", maxiter=5, seed=1, polish=False)
        self.assertAlmostEqual(found.x[0] / level, 0.95, places=2)  # the slower, the softer


if __name__ == "__main__":
    unittest.main()
