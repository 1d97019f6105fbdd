#!/usr/bin/python3
"""Compares the winners of searches with the plain step on varied devices of [spread].

    bench/run_robustness.py BUILD/apps/softland > results/robustness.md

Searches the shipped scenes that bounce, for three seeds, then closes the same 2000
devices under all results, over the scene's whole window. Takes about four minutes on two cores.
"""
import datetime
import json
import pathlib
import subprocess
import sys
import tempfile

from tables import machine, prefixed, revision

SCENES = pathlib.Path(__file__).resolve().parent.parent / "scenes"
TASKS = [("mem-gold.toml", "electrostatic"), ("mem-gold-pzt.toml", "pzt"), ("mem-gold-pzt.toml", "both"),
         ("nem-tin.toml", "electrostatic"), ("two-electrodes.toml", "electrostatic")]
SEEDS = (1, 2, 3)
DEVICES = 2000


def run(program, *words):
    done = subprocess.run([program, *words, "--quiet"], capture_output=True, text=True)
    if done.returncode not in (0, 4):
        sys.exit(f"{' '.join(map(str, words))}: exit status {done.returncode}\n{done.stderr}")
    return done.stdout


def quantiles(drive, key, unit):
    values = [q["value"] for q in drive["figures"][key]["quantiles"]]
    return f"{prefixed(values[1], unit)} / {prefixed(values[2], unit)}"


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    print(f"""# Winners on varied devices

The commands are `softland optimize SCENE --actuator ... --seed N`, then `softland robustness SCENE WINNER ... --samples {DEVICES}`. All
waveforms get the same devices, drawn from the scene's `[spread]` (2 % of thickness, 2 % of both gaps by one factor, 3 % of the
modulus; plates 6 % of the stiffness and 2 % of the mass instead; one standard deviation, normal). The voltages are those that the
search found for the nominal device. Cells have the median / 95th percentile; v is the largest impact velocity of all touches.

- made by `bench/run_robustness.py BUILD/apps/softland > results/robustness.md`, {datetime.date.today()}, revision {revision()}
- machine: {machine()}

A waveform in fixed volts that lands the nominal design without a rebound does so on few devices. A dash means that as many devices
do not close, or do not settle in the window.
""")
    for scene, actuator in TASKS:
        with tempfile.TemporaryDirectory() as folder:
            found = []
            for seed in SEEDS:
                out = f"{folder}/seed-{seed}"
                run(program, "optimize", SCENES / scene, "--robust", "none", "--actuator", actuator, "--seed", str(seed), "--out", out)
                if pathlib.Path(out, "best.toml").exists():
                    found.append(out)
            judged = json.loads(run(program, "robustness", SCENES / scene, *found, "--samples", str(DEVICES), "--json", "-"))
        print(f"## {scene}, {actuator}\n")
        print("| drive | close | without a rebound (95 % confidence) | t_i | v | B_H | t_p |\n|---|---|---|---|---|---|---|")
        for drive in judged["drives"]:
            free = drive["bounce_free"]
            low, high = (100 * x for x in free["interval"])
            print(f"| {pathlib.Path(drive['name']).name} | {100 * drive['closing']['share']:.1f} % | "
                  f"{100 * free['share']:.1f} % ({low:.1f} to {high:.1f}) | {quantiles(drive, 'initial_contact_time_s', 's')} | "
                  f"{quantiles(drive, 'largest_impact_velocity_m_s', 'm/s')} | {quantiles(drive, 'major_bounce_height_m', 'm')} | "
                  f"{quantiles(drive, 'permanent_contact_time_s', 's')} |")
        print(flush=True)


if __name__ == "__main__":
    main()
