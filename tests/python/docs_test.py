"""The code of docs/python.md runs: block after block, each with the scene of the first one, beside the files that it speaks of."""

import os
import pathlib
import re
import tempfile
import unittest

import numpy as np
import softland

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "python.md"
# Calls that would take minutes, or a laboratory, with their replacements.
SHORTER = {"scene.tune(fire, ": "scene.tune(fire, closings=1, effort=0.05, "}


def write_scope(path):
    """Drive over 20 and the voltage at a contact that pulls 5 V down, of a closing of the scene, as an oscilloscope writes them."""
    closing = softland.shipped("mem-gold").simulate(errors=False)
    times = np.arange(-100, 15_000) * 1e-8
    course = closing.trajectory
    closed = (times > 0) & (np.interp(times, course["time"], course["gap"]) <= 0)
    _, drive = closing.voltage("main", np.maximum(times, 0))
    rows = np.column_stack([times, np.where(times < 0, 0, drive) / 20, np.where(closed, 0.0, 5.0)])
    np.savetxt(path, rows, delimiter=",", header="x-axis,CH1,CH2\nsecond,Volt,Volt", comments="", fmt="%.9g")


class Page(unittest.TestCase):
    def test_every_block_runs(self):
        blocks = re.findall(r"```python\n(.*?)```", PAGE.read_text(), flags=re.DOTALL)
        self.assertGreater(len(blocks), 7)
        names = {}
        with tempfile.TemporaryDirectory() as folder:
            os.symlink(ROOT / "scenes", pathlib.Path(folder) / "scenes")
            write_scope(pathlib.Path(folder) / "scope.csv")
            before = os.getcwd()
            os.chdir(folder)
            try:
                names.update(t=np.array([0, 1e-5, 1e-4]), v=np.array([0, 18.0, 17.0]))
                for block in blocks:
                    for given, instead in SHORTER.items():
                        block = block.replace(given, instead)
                    if "scene" in names:
                        names["scene"] = softland.load("scenes/mem-gold.toml")
                    with self.subTest(block=block):
                        exec(compile(block, str(PAGE), "exec"), names)
            finally:
                os.chdir(before)
        self.assertEqual(names["y"].shape, (10_000, 2))
        # The device of the record is that of the nominal design.
        self.assertLess(abs(names["found"].unknowns[0]["value"] - 1), 0.005)


if __name__ == "__main__":
    unittest.main()
