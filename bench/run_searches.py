#!/usr/bin/python3
"""Runs searches over seeds and variants of the shipped scenes, and confirms each winner by a second program.

    bench/run_searches.py BUILD/apps/softland > results/searches.md

Runs `softland optimize` on all cores, then gives the exported best.csv to peers/closing_scipy.py (LSODA at 1e-9, its own equations).
Needs NumPy and SciPy. Takes about five minutes on two cores.
"""
import datetime
import json
import pathlib
import subprocess
import sys
import tempfile
import time

from tables import machine, revision

HERE = pathlib.Path(__file__).resolve().parent
SCENES = HERE.parent / "scenes"
SEEDS = range(1, 6)
# Keys of the scene, and the same fields of the peer's device [SI]; "" is the scene itself.
VARIANTS = [("", []), ("structure.length=290 um", ["length=290e-6"]), ("structure.length=245 um", ["length=245e-6"]),
            ("gap.contact=1.6 um", ["contact_gap=1.6e-6"]), ("gap.contact=2.3 um", ["contact_gap=2.3e-6"]),
            ("gap.electrode=3 um", ["gap=3e-6"]), ("gap.electrode=4.2 um", ["gap=4.2e-6"]),
            ("structure.thickness=1.65 um", ["thickness=1.65e-6"]), ("structure.thickness=2.4 um", ["thickness=2.4e-6"]),
            ('electrode.main.span=["75 um","200 um"]', ["electrode_begin=75e-6", "electrode_end=200e-6"]),
            ('electrode.main.span=["48 um","225 um"]', ["electrode_begin=48e-6", "electrode_end=225e-6"])]


def search(program, scene, actuator, seed, variant):
    """Returns the result of one search, its wall time [s] and the peer's figures of the exported waveform."""
    with tempfile.TemporaryDirectory() as out:
        command = [program, "optimize", SCENES / scene, "--robust", "none", "--target", "bounce", "--actuator", actuator, "--waveform", "pulse", "--seed",
                   str(seed), "--quiet", "--json", "-", "--out", out]
        if variant[0]:
            command += ["--set", variant[0]]
        start = time.monotonic()
        run = subprocess.run(command, capture_output=True, text=True)
        wall = time.monotonic() - start
        if run.returncode not in (0, 4):
            sys.exit(f"{' '.join(map(str, command))}: exit status {run.returncode}\n{run.stderr}")
        result = json.loads(run.stdout)
        peer = [sys.executable, HERE / "peers" / "closing_scipy.py", "--method", "odeint", "--rtol", "1e-9", "--window", "600e-6",
                "--breakpoints", pathlib.Path(out) / "best.csv", "--runs", "1"]
        if actuator != "electrostatic":
            peer.append("--pzt")
        if variant[1]:
            peer += ["--device", *variant[1]]
        confirmed = json.loads(subprocess.run(peer, capture_output=True, text=True, check=True).stdout)
    return result, wall, confirmed


def micro(seconds):
    return "-" if seconds is None else f"{seconds * 1e6:.2f}"


def row(name, seed, found):
    result, wall, peer = found
    best, base = result["best"]["metrics"], result["baseline"]["metrics"]
    tight = ", ".join(str(check["metrics"]["bounce_count"]) for check in result["checks"])
    return (f"| {name} | {seed} | {result['evaluations']} | {wall:.1f} | {micro(base['permanent_contact_time_s'])} | {base['bounce_count']} "
            f"| {base['major_bounce_height_m'] * 1e9:.0f} | {micro(best['permanent_contact_time_s'])} | {best['bounce_count']} "
            f"| {best['major_bounce_height_m'] * 1e9:.3f} | {best['impact_velocity_m_s'] * 1e3:.2f} | {tight} "
            f"| {micro(peer['initial_contact_time_s'])} | {peer['bounce_count']} | {peer['impact_velocity_m_s'] * 1e3:.2f} |")


HEAD = """| scene | seed | evaluations | time [s] | step: t_p [us] | N_B | B_H [nm] | found: t_p [us] | N_B | B_H [nm] | v_i [mm/s] | N_B at 1e-9, with 6 modes | peer: t_i [us] | N_B | v_i [mm/s] |
|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|"""


def main():
    if len(sys.argv) != 2:
        sys.exit("usage: run_searches.py BUILD/apps/softland > results/searches.md")
    program = sys.argv[1]
    print(f"""# Searches over seeds and variants

The searches are `softland optimize SCENE --target bounce --actuator ... --waveform pulse --seed N [--set VARIANT]` with the default budgets. A significant
rebound is one above 1 nm. "Found" is what the search reports. "Peer" is what `bench/peers/closing_scipy.py` (SciPy's LSODA at rtol 1e-9, its own equations and
modes, window 600 us) gives for the exported `best.csv`.

- made by `bench/run_searches.py BUILD/apps/softland > results/searches.md`, {datetime.date.today().isoformat()}, revision {revision()}
- machine: {machine()}
""")
    for title, scene, actuator, variants in (("Electrostatic pulse, scenes/mem-gold.toml", "mem-gold.toml", "electrostatic", VARIANTS),
                                             ("PZT pulse within +-1 V, scenes/mem-gold-pzt.toml", "mem-gold-pzt.toml", "pzt", VARIANTS)):
        print(f"## {title}\n\n{HEAD}")
        for variant in variants:
            for seed in SEEDS if not variant[0] else SEEDS[:2]:
                found = search(program, scene, actuator, seed, variant)
                print(row(f"`{variant[0]}`" if variant[0] else "as shipped", seed, found), flush=True)
        print()


if __name__ == "__main__":
    main()
