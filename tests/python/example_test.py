"""example_test.py NAME: the last line of examples/python/NAME.py is what it must be."""

import importlib.util
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
# Numbers of the last line, each with the part of itself by which it may differ, and what the example needs beside NumPy.
EXPECTED = {
    "01_first_closing": ([(85.6, 0.005), (95.6, 0.005)], None),
    "02_own_waveform": ([(40.75, 0.01), (7.13, 0.02)], None),
    "03_scipy": ([(0.17, 0.1), (85.6, 0.005)], "scipy"),
    "04_dither_map": ([(254, 0.01), (164, 0.01)], None),
    "05_openturns": ([(0.57, 0.1), (0.56, 0.1)], "openturns"),
    "07_robust_design": ([(95, 0), (500, 0), (43.9, 0.02), (106.7, 0.02)], None),
    "08_dask": ([(100_000, 0), (95, 0), (101.7, 0.01)], "distributed"),
    "09_optuna": ([(1600, 0), (40, 0), (2.6, 0.3), (85.6, 0.005)], "optuna"),
    "10_tuning": ([(5, 0), (6, 0.35), (59, 0.05)], None),
    "06_store": ([(97.4, 0.01), (15, 0)], None),
}

name = sys.argv[1]
expected, needs = EXPECTED[name]
if needs and importlib.util.find_spec(needs) is None:
    print(f"skipped: no {needs}; needs: python3-{needs}")
    sys.exit(77)
run = subprocess.run([sys.executable, ROOT / "examples" / "python" / f"{name}.py"], capture_output=True, text=True)
print(run.stdout + run.stderr)
if run.returncode != 0:
    sys.exit(1)
last = run.stdout.strip().splitlines()[-1]
numbers = [float(one) for one in re.findall(r"(?<![\w.])-?\d+(?:\.\d+)?(?![\w.])", last)]
for (value, tolerance), found in zip(expected, numbers, strict=False):
    if not abs(found - value) <= tolerance * abs(value):
        print(f"'{last}': {found} is not {value} within {tolerance * 100:.3g} %")
        sys.exit(1)
if name == "08_dask" and "the same" not in last:
    print(f"'{last}': the table of the cluster is another")
    sys.exit(1)
if len(numbers) < len(expected):
    print(f"'{last}' has {len(numbers)} numbers, not {len(expected)}")
    sys.exit(1)
