#!/usr/bin/python3
"""Measures how fast the shipped switches can be cycled, with plain steps and with found waveforms.

    bench/run_cycles.py BUILD/apps/softland results [SCENE ...]

Writes cycles.md into the folder, for the named scenes or for all. Takes about half an hour.
"""
import datetime
import json
import math
import pathlib
import subprocess
import sys
import tempfile
import time

from tables import machine, prefixed, revision

SCENES = pathlib.Path(__file__).resolve().parent.parent / "scenes"
SWITCHES = (("mem-gold", "electrostatic"), ("mem-gold-pzt", "electrostatic"), ("mem-gold-pzt", "both"), ("ohmic-gold", "electrostatic"),
            ("two-electrodes", "electrostatic"), ("gap-closing-actuator", "electrostatic"), ("nem-tin", "electrostatic"),
            ("capacitive-bridge", "electrostatic"))
QUICK = {"capacitive-bridge": 150}  # evaluations for a scene whose closing takes a second
PERIODS = 5  # periods of the first mode in a cycle of the second table


def run(program, *words, usual=(0, 4)):
    begin = time.monotonic()
    done = subprocess.run([program, *words, "--quiet"], capture_output=True, text=True, check=False)
    if done.returncode not in usual:
        sys.exit(f"{' '.join(map(str, words))}: exit status {done.returncode}\n{done.stderr}")
    return time.monotonic() - begin


def rate(value):
    if value is None:
        return "none"
    for factor, prefix in ((1e9, "G"), (1e6, "M"), (1e3, "k")):
        if value >= factor:
            return f"{value / factor:.3g} {prefix}Hz"
    return f"{value:.3g} Hz"


def hardest(drive):
    """Returns the largest impact velocity and the highest rebound of all cycles, or a text if the switch does not close or open in one."""
    cycles = drive["cycles"]
    if any(c["initial_contact_time_s"] is None for c in cycles):
        return "stays open"
    if any(c["opening_time_s"] is None for c in cycles):
        return "stays closed"
    velocity, height = (max(c[key] for c in cycles) for key in ("largest_impact_velocity_m_s", "major_bounce_height_m"))
    return f"{prefixed(velocity, 'm/s')}, {prefixed(height, 'm')}" if height > 0 else f"{prefixed(velocity, 'm/s')}, none"


def energy(drive):
    if not drive["cycles"]:
        return "-"
    joules = drive["cycles"][-1]["drive_energy_J"]
    return prefixed(joules, "J") if joules >= 1e-12 else f"{1e15 * joules:.3g} fJ"


def main():
    program, folder = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
    rates, pairs = [], []
    for scene, actuator in SWITCHES:
        if sys.argv[3:] and scene not in sys.argv[3:]:
            continue
        file, drives = SCENES / f"{scene}.toml", ["--actuator", actuator]
        budget = ["--budget", str(QUICK[scene])] if scene in QUICK else []
        name = f"{scene}, {actuator}"
        with tempfile.TemporaryDirectory() as place:
            out = pathlib.Path(place)
            run(program, "optimize", file, "--robust", "none", *drives, *budget, "--out", out / "closed")
            run(program, "release", file, *drives, *budget, "--out", out / "opened")
            devices = "0" if scene in QUICK else "20"
            run(program, "cycle", file, out / "closed/best.toml", out / "opened/release.toml", "--samples", devices, "--out", out / "cycled")
            found = json.loads((out / "cycled/cycle.json").read_text(encoding="utf-8"))
            plain, ours = found["drives"]
            of = [rate(d["devices"]["largest_rate_50_Hz"]) if d["devices"] else "-" for d in (plain, ours)]
            rates.append(f"| {name} | {rate(plain['largest_rate_Hz'])} | {rate(ours['largest_rate_Hz'])} | {of[0]} | {of[1]} | "
                         f"{energy(plain)} | {energy(ours)} |")
            print(rates[-1], file=sys.stderr, flush=True)
            run(program, "modes", file, "--json", out / "modes.json")
            first = json.loads((out / "modes.json").read_text(encoding="utf-8"))["natural_frequencies_rad_s"][0]
            hertz = f"{first / (2 * math.pi * PERIODS):.3g} Hz"
            seconds = run(program, "optimize", file, "--cycle", hertz, *drives, *budget, "--out", out / "pair")
            run(program, "cycle", file, out / "closed/best.toml", out / "opened/release.toml", "--rate", hertz, "--no-scan", "--out", out / "apart",
                usual=(0, 2, 4))  # 2: they last longer than their part of a cycle
            pair = json.loads((out / "pair/cycle.json").read_text(encoding="utf-8"))
            apart = out / "apart/cycle.json"
            apart = hardest(json.loads(apart.read_text(encoding="utf-8"))["drives"][1]) if apart.exists() else "too long"
            pairs.append(f"| {name} | {rate(pair['rate_Hz'])} | {hardest(pair['drives'][0])} | {apart} | "
                         f"{hardest(pair['drives'][1])} | {pair['search']['plain_cost']:.3g} | {pair['search']['cost']:.3g} | {seconds:.0f} s |")
            print(pairs[-1], file=sys.stderr, flush=True)
    text = [f"""# How fast a switch may be cycled

`softland cycle SCENE closed/best.toml opened/release.toml`, where `closed` is of `softland optimize SCENE --robust none` and `opened` of `softland release SCENE`, with the defaults (bridge: --budget {QUICK['capacitive-bridge']}) and a duty of 50 %.
A rate is steady where ten cycles close and open, and land within 5 % as fast and as high as the first. The largest is that below which every rate of the scan was steady, in steps of 5 %. The energy is that of the sources in the last
cycle at the rate of the waveforms. See [docs/reference/opening.md](../docs/reference/opening.md#cycles).

- made by `bench/run_cycles.py BUILD/apps/softland results`, {datetime.date.today()}, revision {revision()}
- machine: {machine()}

| switch, drives | plain | waveforms | half of 20 devices: plain | waveforms | energy: plain | waveforms |
|---|---|---|---|---|---|---|""", *rates, f"""
## Faster than that

A cycle of {PERIODS} periods of the first mode begins with the vibration that the one before has left. `softland optimize SCENE --cycle RATE` searches both waveforms for it. The table has the largest impact velocity and the highest rebound of ten cycles.

| switch, drives | rate | plain | waveforms found apart | pair for the rate | cost: plain | pair | search |
|---|---|---|---|---|---|---|---|""", *pairs]
    (folder / "cycles.md").write_text("\n".join(text) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
