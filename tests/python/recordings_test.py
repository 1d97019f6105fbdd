"""Files of instruments as arrays, and the waveforms of a scene as files for instruments."""

import os
import pathlib
import subprocess
import tempfile
import unittest
import warnings

import numpy as np
import softland

SCENES = pathlib.Path(__file__).resolve().parents[2] / "scenes"
GOLD = SCENES / "mem-gold.toml"
PROGRAM = os.environ["SOFTLAND_PROGRAM"]


class Recordings(unittest.TestCase):
    def setUp(self):
        self.place = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.place.name)

    def tearDown(self):
        self.place.cleanup()

    def written(self, text, name="scope.csv"):
        path = self.folder / name
        path.write_text(text)
        return path

    def scope(self):
        """As an oscilloscope writes it: two channels, one of them in mV."""
        rng = np.random.default_rng(1)
        rows = np.column_stack([np.arange(-200, 800) * 1e-8, 3 * rng.random(1000), 500 * rng.random(1000)])
        lines = "\n".join(f"{t:.2e},{a:.6f},{b:.6f}" for t, a, b in rows)
        return self.written(f"Model,DSO-X 3034\nx-axis,CH1,CH2\nsecond,Volt,mV\n{lines}\n")

    def test_channels_are_arrays_in_si_units(self):
        path = self.scope()
        right = np.genfromtxt(path, delimiter=",", skip_header=3)
        record = softland.read(path)
        self.assertEqual(list(record), ["CH1", "CH2"])
        np.testing.assert_allclose(record.times, right[:, 0], atol=1e-18)
        np.testing.assert_array_equal(record["CH1"], right[:, 1])
        np.testing.assert_allclose(record["CH2"], 1e-3 * right[:, 2], rtol=1e-15)
        self.assertEqual(record.units["CH2"], "mV")
        self.assertEqual(list(softland.read(path, column="CH2")), ["CH2"])
        self.assertEqual(list(softland.read(path, column=2)), ["CH1"])
        said = subprocess.run([PROGRAM, "read", path], capture_output=True, text=True, check=True).stdout
        self.assertEqual(repr(record), said.rstrip())
        self.assertIn("<svg", record._repr_html_())

    def test_what_can_be_read_in_two_ways_is_refused_with_the_key_that_decides(self):
        path = self.written("".join(f"{k * k}\n" for k in range(20)))
        record = softland.read(path)
        self.assertEqual(len(record.times), 0)
        even = softland.read(path, interval="8 ns")
        np.testing.assert_allclose(even.times, 8e-9 * np.arange(20))
        np.testing.assert_array_equal(softland.read(path, interval=8e-9).times, even.times)
        with self.assertRaisesRegex(softland.InvalidInput, "decimal"):
            softland.read(self.written("0,5,1,25\n0,6,1,35\n0,7,1,45\n", "commas.csv"))
        with self.assertRaisesRegex(softland.InvalidInput, "CH3"):
            softland.read(self.scope(), column="CH3")
        with self.assertRaises(softland.InvalidInput):
            softland.read(self.folder / "nothing.csv")

    def test_a_record_drives_a_switch(self):
        scene = softland.load(GOLD)
        pulse = softland.Waveform("pulse", levels=["20 V", "8 V", "16 V"], times=["12 us", "30 us"], edge="1 us")
        times = np.arange(-50, 4000) * 1e-8
        path = self.written("time_s,drive\n" + "".join(f"{t!r},{v!r}\n" for t, v in zip(times, np.where(times < 0, 0, pulse(times)) / 20)))
        told = softland.read(path).waveform(scale=20)
        closing, right = (scene.simulate(errors=False, waveforms={"main": one}) for one in (told, pulse))
        # Straight lines over ramps of 1 us, whose corners may be a sample off: 10 ns of some 40 us.
        self.assertLess(abs(closing.initial_contact_time / right.initial_contact_time - 1), 1e-3)

    def test_edges_of_a_contact_are_where_straight_lines_cross(self):
        times = np.array([-1.0, 0, 1, 2, 3, 4, 5]) * 1e-6
        volts = np.array([0.0, 0, 0, 2, 2, 0, 4])
        np.testing.assert_allclose(softland.contact_edges(times, volts, "1 V"), [[1.5e-6, 1], [3.5e-6, 0], [4.25e-6, 1]], rtol=1e-12)
        np.testing.assert_allclose(softland.contact_edges(times, volts, 1.0, merge="1 us"), [[1.5e-6, 1]], rtol=1e-12)
        below = softland.contact_edges(times, 4 - volts, 3.0, closed="below")
        np.testing.assert_array_equal(below, softland.contact_edges(times, volts, 1.0))
        with self.assertRaisesRegex(softland.InvalidInput, "must be open at t = 0"):
            softland.contact_edges(times, volts, 1.0, closed="below")
        with self.assertRaises(softland.InvalidInput):
            softland.contact_edges(times[::-1], volts, 1.0)
        with self.assertRaises(softland.InvalidInput):
            softland.contact_edges(times, volts[1:], 1.0)


class Fits(unittest.TestCase):
    def test_measurements_as_arrays_are_those_of_a_bench_file(self):
        scene = softland.load(GOLD)
        device = softland.load(GOLD, set={"gap.contact": 1.03 * scene["gap.contact"], "gap.electrode": 1.03 * scene["gap.electrode"]})
        closing = device.simulate(errors=False, waveforms=dict(scene.waveforms))
        times = np.arange(0, 10_000) * 1e-8
        closed = np.interp(times, closing.trajectory["time"], closing.trajectory["gap"]) <= 0
        volts = np.where((times > 0) & closed, 5.0, 0.0)
        frequency = float(device.modes().frequencies[0])
        measured = [
            {"quantity": "contact", "times": times, "values": volts, "threshold": 2.5, "error": 30e-9},
            {"quantity": "frequency", "value": np.array([frequency]), "error": "0.5 %"},
            {"quantity": "closing_time", "levels": [20.0, 25.0], "values": [device_time(device, 20.0), device_time(device, 25.0)], "error": 50e-9},
        ]
        found = scene.fit(measured, ["gaps"])
        # The device's gaps are 3 % larger; that of the contact is known to the sampling of 10 ns.
        self.assertLess(abs(found.unknowns[0]["value"] - 1.03), 3 * found.unknowns[0].standard_error)
        self.assertLess(found.unknowns[0].standard_error, 2e-3)
        with tempfile.TemporaryDirectory() as folder:
            place = pathlib.Path(folder)
            np.savetxt(place / "scope.csv", np.column_stack([times, volts]), delimiter=",", header="time_s,voltage_V", comments="")
            (place / "times.csv").write_text("voltage_V,closing_time_s\n" + "".join(f"{v!r},{t!r}\n" for v, t in zip((20.0, 25.0), measured[2]["values"])))
            (place / "bench.toml").write_text(
                '[[measurement]]\nquantity = "contact"\nfile = "scope.csv"\nthreshold = "2.5 V"\nerror = "30 ns"\n'
                f'[[measurement]]\nquantity = "frequency"\nvalue = ["{frequency!r} Hz"]\nerror = "0.5 %"\n'
                '[[measurement]]\nquantity = "closing_time"\nfile = "times.csv"\nerror = "50 ns"\n'
            )
            same = scene.fit(place / "bench.toml", ["gaps"])
            relative = scene.fit([{**measured[1]}, {"quantity": "closing_time", "file": os.path.relpath(place / "times.csv"), "error": "50 ns"}], ["gaps"])
        self.assertEqual(found.unknowns[0].to_json(), same.unknowns[0].to_json())
        self.assertLess(abs(relative.unknowns[0]["value"] - 1.03), 3 * relative.unknowns[0].standard_error)
        with self.assertRaisesRegex(softland.InvalidInput, "quantity"):
            scene.fit([{"quantity": "frequencies", "value": 1.0}])


def device_time(device, volts):
    step = softland.Waveform("step", level=volts)
    free = softland.load(device.text, set={"driver.main.max_voltage": "30 V"})
    return float(free.simulate(errors=False, waveforms={"main": step}).initial_contact_time)


class Exports(unittest.TestCase):
    def by_program(self, *options):
        return subprocess.run([PROGRAM, "export", GOLD, *options], capture_output=True, text=True, check=True)

    def test_texts_are_those_of_the_program(self):
        scene = softland.load(GOLD)
        samples = {"sample_rate": "27 MHz", "bits": 14}
        told = ("--sample-rate", "27 MHz", "--bits", "14")
        for format in ("csv", "spice-pwl", "spice-model", "spice-bench", "verilog-a"):
            self.assertEqual(scene.export(format), self.by_program("--format", format).stdout, format)
        for format in ("keysight-arb", "siglent-csv", "tektronix-csv", "rigol-csv", "digilent-csv", "codes"):
            self.assertEqual(scene.export(format, **samples), self.by_program("--format", format, *told).stdout, format)
        arb = scene.export("keysight-arb", sample_rate=27e6, bits=14, amplifier=20, marker=0.0)
        self.assertEqual(arb, self.by_program("--format", "keysight-arb", *told, "--amplifier", "20", "--marker", "0 s").stdout)
        device = {"Vdp": "16.5 V", "frequency": "37.5 kHz"}
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            own = scene.export(measured=device)
        self.assertEqual(own, self.by_program("--measured", "Vdp=16.5 V,frequency=37.5 kHz").stdout)
        self.assertNotEqual(own, scene.export())

    def test_waveforms_in_the_place_of_the_scenes(self):
        scene = softland.load(GOLD)
        hold = scene.waveforms["main"].hold_level
        ramp = softland.OwnWaveform("ramp", lambda t, x: hold * np.minimum(t / 20e-6, 1) ** 2, [20e-6])
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "ramp.csv"
            path.write_text(scene.export(waveforms={"main": ramp}))
            back = softland.read(path, interval="uneven").waveform()
        times = np.linspace(0, 30e-6, 301)
        np.testing.assert_allclose(back(times), ramp(times), atol=2e-3)
        self.assertEqual(scene.waveforms["main"].hold_level, hold)  # unchanged

    def test_what_is_lost_by_samples_is_a_warning(self):
        scene = softland.load(GOLD)
        scene.waveforms["main"] = softland.Waveform("pulse", levels=[20.9, 1.7, scene.waveforms["main"].hold_level], times=["16.3 us", "35.9 us"], edge="1 us")
        with self.assertWarnsRegex(UserWarning, "Vdp.*error is taken to be"):
            scene.export(measured={"Vdp": "14.3 V"})
        with self.assertRaisesRegex(softland.InvalidInput, "sample_rate"):
            scene.export("rigol-csv")
        with self.assertRaisesRegex(softland.InvalidInput, "format"):
            scene.export("wav")


if __name__ == "__main__":
    unittest.main()
