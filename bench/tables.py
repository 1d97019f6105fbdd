"""Functions that the scripts for tables of results/ share."""
import csv
import io
import os
import pathlib
import platform
import subprocess


def prefixed(value, unit, digits=3):
    if value is None:
        return "-"
    for factor, prefix in ((1, ""), (1e-3, "m"), (1e-6, "u"), (1e-9, "n"), (1e-12, "p")):
        if abs(value) >= factor:
            return f"{value / factor:.{digits}g} {prefix}{unit}"
    return f"0 {unit}"


def machine():
    with open("/proc/cpuinfo", encoding="utf-8") as info:
        names = [line.split(":", 1)[1].strip() for line in info if line.startswith("model name")]
    return f"{names[0] if names else platform.machine()}, {os.cpu_count()} cores, {platform.system()} {platform.release()}"


def revision():
    """Returns the revision of the sources from which a table is made, with a mark if they were changed since."""
    return subprocess.run(["git", "-C", pathlib.Path(__file__).parent, "describe", "--always", "--dirty"], capture_output=True, text=True,
                          check=True).stdout.strip()


def rows_of(program, store):
    """Returns the rows of a store of an exploration: a dictionary for each point, with numbers where possible."""
    text = subprocess.run([program, "table", store, "--csv"], capture_output=True, text=True, check=True).stdout
    return [{k: float(v) if k not in ("status", "reason") and v else v for k, v in row.items()} for row in csv.DictReader(io.StringIO(text))]
