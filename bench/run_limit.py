#!/usr/bin/python3
"""Finds the least time in which any waveform can close the shipped switches softly, and a waveform that does so.

    bench/run_limit.py BUILD/apps/softland results

Writes limit.md and limit.svg into the folder. Takes about five minutes.
"""
import datetime
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

from tables import machine, prefixed, revision

SCENES = pathlib.Path(__file__).resolve().parent.parent / "scenes"
PICTURED = "mem-gold"
SLOW_PIEZO = ("driver.piezo.max_slew=0.2 V/us",)
SLOW_BOTH = (*SLOW_PIEZO, "driver.main.max_slew=20 V/us", "waveform.main.rise_time=1.5 us")
SWITCHES = (("mem-gold", "electrostatic", ()), ("two-electrodes", "electrostatic", ()), ("gap-closing-actuator", "electrostatic", ()),
            ("nem-tin", "electrostatic", ()), ("mem-gold-pzt", "electrostatic", ()), ("mem-gold-pzt", "pzt", ()), ("mem-gold-pzt", "pzt", ("structure.modes=6",)),
            ("mem-gold-pzt", "both", ()), ("mem-gold-pzt", "pzt", SLOW_PIEZO), ("mem-gold-pzt", "both", SLOW_BOTH))


def least(found):
    return prefixed(found["least_time_s"], "s", 4) if found["status"] == "done" else found["message"] or found["status"]


def after(landing):
    if landing is None:
        return "none", ""
    metrics = landing["metrics"]
    way = "at rest" if landing["at_rest"] else f"a catch of {prefixed(landing['catch_s'] - landing['catch_delay_s'], 's')}"
    if landing["catch_delay_s"]:
        way += f" after {prefixed(landing['catch_delay_s'], 's')}"
    rebound = prefixed(metrics["major_bounce_height_m"], "m") if metrics["major_bounce_height_m"] else "none"
    doubts = [f"{prefixed(c['metrics']['major_bounce_height_m'], 'm')} with {c['name']}" for c in landing["confirmed_by"]
              if c["metrics"]["bounce_count"]]
    return f"{prefixed(metrics['initial_contact_time_s'], 's', 4)}, {way}", ", ".join([rebound, *doubts])


def main():
    program, folder = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
    rows = []
    for name, actuator, changes in SWITCHES:
        with tempfile.TemporaryDirectory() as out:
            begin = time.monotonic()
            curves = [] if name == PICTURED else ["--no-curves"]
            for change in changes:
                curves += ["--set", change]
            done = subprocess.run([program, "limit", SCENES / f"{name}.toml", "--actuator", actuator, "--out", out, "--quiet", *curves],
                                  capture_output=True, text=True, check=False)
            seconds = time.monotonic() - begin
            if done.returncode not in (0, 3, 4):
                sys.exit(f"{name}, {actuator}: exit status {done.returncode}\n{done.stderr}")
            found = json.loads(pathlib.Path(out, "limit.json").read_text(encoding="utf-8"))
            if name == PICTURED:
                shutil.copy(pathlib.Path(out, "limit.svg"), folder / "limit.svg")
        touch, rebounds = after(found["landing"])
        step = found["plain_step"]
        rows.append(f"| {', '.join((name, actuator, *changes))} | {prefixed(step['initial_contact_time_s'], 's', 4)} | "
                    f"{prefixed(found['permitted_impact_velocity_m_s'], 'm/s')} | {least(found['touch'])} | {least(found['at_rest'])} | "
                    f"{touch} | {rebounds} | {seconds:.0f} s |")
        print(rows[-1], file=sys.stderr, flush=True)
    text = [f"""# The limit of what any waveform can do

The least time in which any waveform within the limits of the drivers brings the contact point to its plane, at a hundredth of the plain step's impact velocity or less; the
least time with every mode at rest; and the quickest landing without a significant rebound that was found from there, or the one that rebounds least. Nothing varies. See
[docs/reference/verification.md](../docs/reference/verification.md#the-limit).

- made by `bench/run_limit.py BUILD/apps/softland results`, {datetime.date.today()}, revision {revision()}
- one of them: `softland limit scenes/mem-gold.toml --out limit`
- machine: {machine()}

![a landing, its drive, and the least time over the peak voltage and over the permitted speed](limit.svg)

| switch, drives | plain step touches at | permitted speed | least time of a touch | with every mode at rest | landing | its highest rebound | time |
|---|---|---|---|---|---|---|---|""", *rows, """
Every time is that of the model with its number of modes, 4 for the beams where no other is named. Where "with 6 modes" stands in the last but one column, two more modes undo the landing: jumps of the piezo's voltage ring modes that the scene does not have. Such a time is the least of the scene's own
modes, and no promise. A limit of the slew keeps them down: the slower, the better the landing holds."""]
    (folder / "limit.md").write_text("\n".join(text) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
