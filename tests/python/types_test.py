"""`mypy --strict` finds nothing in the package and in the examples."""

import importlib.util
import pathlib
import subprocess
import sys
import tempfile

import softland

ROOT = pathlib.Path(__file__).resolve().parents[2]
PACKAGES = pathlib.Path(softland.__file__).parents[1]

if importlib.util.find_spec("mypy") is None:
    print("skipped: no mypy; needs: mypy")
    sys.exit(77)
with tempfile.TemporaryDirectory() as cache:
    command = [sys.executable, "-m", "mypy", "--strict", "--cache-dir", cache, "--ignore-missing-imports"]
    runs = [["-p", "softland"], *([str(path)] for path in sorted((ROOT / "examples" / "python").glob("[0-9]*.py")))]
    failed = [run for run in runs if subprocess.run([*command, *run], cwd=PACKAGES).returncode != 0]
sys.exit(1 if failed else 0)
