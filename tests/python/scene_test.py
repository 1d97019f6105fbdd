"""Scenes: reading, changing, and what is said of mistakes."""

import math
import os
import pathlib
import pickle
import tempfile
import unittest

import numpy as np
import softland

SCENES = pathlib.Path(__file__).resolve().parents[2] / "scenes"
GOLD = SCENES / "mem-gold.toml"


class Scenes(unittest.TestCase):
    def test_keys_read_as_quantities_and_change_by_text_and_by_number(self):
        scene = softland.load(GOLD)
        self.assertEqual(scene["gap.contact"].unit, "m")
        scene["gap.contact"] = "2.1 um"
        self.assertEqual(scene["gap.contact"], 2.1e-6)
        scene["gap.contact"] = 2.2e-6
        self.assertEqual(scene["gap.contact"], 2.2e-6)
        scene["gap.contact"] = np.float64(2.3e-6)
        self.assertEqual(scene["gap.contact"], 2.3e-6)
        with self.assertRaisesRegex(softland.InvalidInput, "3 m"):  # a whole number counts in the SI unit as well
            scene["gap.contact"] = 3
        scene["structure.modes"] = 6
        self.assertEqual(scene["structure.modes"], 6)
        scene["electrode.main.span"] = ["60 um", "200 um"]
        self.assertEqual(scene["electrode.main.span[2]"], 200e-6)

    def test_a_refused_change_changes_nothing_and_says_key_file_and_line(self):
        scene = softland.load(GOLD)
        before = scene.text
        with self.assertRaises(softland.InvalidInput) as raised:
            scene["gap.contact"] = "-1 um"
        self.assertEqual(raised.exception.key, "gap.contact")
        self.assertIn("gap.contact", raised.exception.message)
        with self.assertRaises(softland.InvalidInput) as raised:
            scene["gap.contakt"] = "1 um"
        self.assertIn("did you mean 'contact'", str(raised.exception))
        with self.assertRaises(softland.InvalidInput) as raised:
            scene["gap.contakt"] = 1e-6
        self.assertIn("did you mean 'contact'", str(raised.exception))
        self.assertEqual(scene.text, before)
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "bad.toml"
            path.write_text(GOLD.read_text().replace('length = "', 'length = "-', 1))
            with self.assertRaises(softland.InvalidInput) as raised:
                softland.load(path)
            self.assertEqual(raised.exception.key, "structure.length")
            self.assertEqual(raised.exception.file, str(path))
            line = path.read_text().splitlines()[raised.exception.line - 1]
            self.assertTrue(line.startswith("length"), line)
        with self.assertRaises(softland.InvalidInput):
            softland.load('[gap]\nelectrode = "3 mm"\ncontact = 7\n')

    def test_several_changes_are_all_made_or_none(self):
        scene = softland.load(GOLD)
        scene.update({"gap.electrode": "5 um", "gap.contact": "4 um"})
        self.assertEqual(scene["gap.contact"], 4e-6)
        with self.assertRaises(softland.InvalidInput):
            scene.update({"gap.electrode": "6 um", "gap.contact": "7 um"})
        self.assertEqual(scene["gap.electrode"], 5e-6)

    def test_text_file_and_pickle_give_the_same_closing(self):
        scene = softland.load(GOLD, set={"gap.contact": "1.9 um"})
        first = scene.simulate(errors=False)
        for same in (softland.load(scene.text), pickle.loads(pickle.dumps(scene)), scene.copy()):
            self.assertEqual(repr(same.simulate(errors=False)), repr(first))
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "mine.toml")
            scene.save(path)
            again = softland.load(path)
            again.save(path)  # a file that was read may be replaced
            self.assertEqual(repr(again.simulate(errors=False)), repr(first))

    def test_units(self):
        length = softland.units("250 um")
        self.assertEqual((float(length), length.unit), (250e-6, "m"))
        with self.assertRaises(softland.InvalidInput):
            softland.units("250 furlong")

    def test_missing_keys_raise_key_errors(self):
        scene = softland.load(GOLD)
        with self.assertRaises(KeyError):
            scene["gap.nothing"]
        self.assertIn("gap.contact", list(scene))
        with self.assertRaises(softland.InvalidInput):
            del scene["gap.contact"]
        self.assertIn("contact", scene.resolved().text)


class Closings(unittest.TestCase):
    def test_figures_know_unit_and_error(self):
        closing = softland.load(GOLD).simulate()
        self.assertEqual(closing.impact_velocity.unit, "m/s")
        self.assertTrue(0 < closing.impact_velocity.error < 1e-4 * closing.impact_velocity)
        self.assertTrue(math.isnan(softland.load(GOLD).simulate(errors=False).impact_velocity.error))
        with self.assertRaises(AttributeError):
            closing.nothing

    def test_the_tip_of_the_shape_is_the_deflection_of_the_trajectory(self):
        scene = softland.load(GOLD, set={"simulate.duration": "60 us"})
        closing = scene.simulate(errors=False)
        run = closing.trajectory
        x, y = closing.shape(run["time"], 2001)
        length, pad = scene["structure.length"], scene["contact.pad_length"]
        at = np.argmin(np.abs(x - (length - pad / 2)))
        self.assertLess(abs(x[at] - (length - pad / 2)), 1e-12)
        # Knots lie on steps, between which the quintic is as exact as the integration.
        self.assertLess(np.max(np.abs(y[:, at] - run["deflection"])), 1e-11)
        self.assertLess(np.max(np.abs(y[:, 0])), 1e-20)  # the clamp
        with self.assertRaises(ValueError):
            closing.shape(1.0)

    def test_a_table_of_modes_moves_like_the_beam_whose_modes_it_holds(self):
        short = {"simulate.duration": "50 us"}
        beam, table = (softland.load(SCENES / name, set=short) for name in ("mem-gold.toml", "mem-gold-modes.toml"))
        x, shapes = beam.modes().x, beam.modes().shapes
        np.testing.assert_allclose(table.modes().x, x, rtol=1e-12)
        # 101 places of the closed form, a cubic between them: 1e-6 of the largest value of the fourth mode.
        np.testing.assert_allclose(table.modes(301).shapes, beam.modes(301).shapes, atol=1e-5 * np.max(np.abs(shapes)))
        times = np.linspace(0, 45e-6, 10)
        own, same = (scene.simulate(errors=False).shape(times)[1] for scene in (beam, table))
        self.assertEqual(same.shape, (10, 101))
        self.assertGreater(np.max(own), 1.5e-6)
        self.assertLess(np.max(np.abs(same - own)), 1e-4 * np.max(own))

    def test_modes_are_those_of_the_program(self):
        modes = softland.load(GOLD).modes()
        self.assertEqual(modes.shapes.shape, (101, 4))
        # A uniform cantilever: the first two roots of cos x cosh x = -1.
        self.assertAlmostEqual(modes.frequencies[1] / modes.frequencies[0], (4.694091133 / 1.875104069) ** 2, places=6)

    def test_own_waveform_runs_like_the_family_of_the_same_voltage(self):
        scene = softland.load(GOLD)
        hold = scene.waveforms["main"].hold_level
        ramp = softland.Waveform("step", level=hold, rise_time="20 us")
        own = softland.OwnWaveform("ramp", lambda t, x: np.minimum(t / 20e-6, 1) * hold, [20e-6])
        a = scene.simulate(errors=False, waveforms={"main": ramp})
        b = scene.simulate(errors=False, waveforms={"main": own})
        self.assertLess(abs(a.impact_velocity - b.impact_velocity), 1e-5 * a.impact_velocity)

    def test_what_a_function_raises_comes_out(self):
        def broken(times, x):
            raise ZeroDivisionError("mine")

        with self.assertRaises(ZeroDivisionError):
            softland.OwnWaveform("broken", broken, [1e-5])


class Waveforms(unittest.TestCase):
    def test_build_scale_resample_and_export(self):
        pulse = softland.Waveform("pulse", levels=["20 V", "8 V", "16 V"], times=["12 us", "30 us"], edge="1 us")
        self.assertEqual(pulse(20e-6), 8)
        self.assertEqual(pulse.scaled(volts=2, time=3)(60e-6), 16)
        self.assertEqual(pulse.hold_level, 16)
        table = pulse.resampled("1 MHz", "50 us")
        self.assertEqual(table.family, "table")
        np.testing.assert_allclose(table(np.array([5e-6, 20e-6])), [20, 8])
        self.assertEqual(pulse.csv("50 us").splitlines()[0], "time_s,main")
        self.assertIn(".subckt softland_main", pulse.spice("50 us"))
        self.assertEqual(pickle.loads(pickle.dumps(pulse)).parameters, pulse.parameters)
        with self.assertRaises(softland.InvalidInput):
            softland.Waveform("pulse", levels=[1, 2], times=[], edge=0)
        with self.assertRaises(softland.InvalidInput) as raised:
            softland.Waveform("pulze")
        self.assertIn("pulse", str(raised.exception))

    def test_a_scene_takes_a_waveform_and_gives_it_back(self):
        scene = softland.load(GOLD)
        pulse = softland.Waveform("pulse", levels=["20 V", "8 V", "16 V"], times=["12 us", "30 us"], edge="1 us")
        scene.waveforms["main"] = pulse
        self.assertEqual(scene.waveforms["main"].parameters, pulse.parameters)
        self.assertEqual(scene["waveform.main.family"], "pulse")


if __name__ == "__main__":
    unittest.main()
