#!/usr/bin/python3
"""Runs searches over varied devices, and evaluates each result on 2000 fresh devices over the whole window.

    bench/run_robust_search.py BUILD/apps/softland [NAME ...] > results/robust-search.md

Names select searches. Takes about half an hour on two cores.
"""
import datetime
import json
import pathlib
import subprocess
import sys
import tempfile
import time

from tables import machine, prefixed, revision

SCENES = pathlib.Path(__file__).resolve().parent.parent / "scenes"
GOLD = ["mem-gold.toml", "--robust", "cvar:0.9"]
PZT = ["mem-gold-pzt.toml", "--robust", "cvar:0.9"]
BOTH_QUICKLY = PZT + ["--actuator", "both", "--waveform", "bspline:8", "--constrain", "initial_contact_time < 45 us", "--budget", "150000"]
UNITS = ["--calibrate", "Vdp,frequency"]
# The searches, each with its description. The later ones continue from a winner.
SEARCHES = {
    "gold-65us": ("gold, nothing known, t_i 95 % below 65 us", GOLD + [
        "--waveform", "knots:4", "--constrain", "initial_contact_time < 65 us", "--budget", "150000"]),
    "gold-220us": ("gold, nothing known, below 220 us", GOLD + [
        "--waveform", "knots:6", "--constrain", "initial_contact_time < 220 us", "--budget", "150000", "--seed", "2"]),
    "gold-units": ("gold, Vdp and period known", GOLD + ["--waveform", "catch", *UNITS, "--budget", "100000", "--seed", "2"]),
    "gold-units-yield": ("gold, Vdp and period known, by yield", [
        "mem-gold.toml", "--robust", "yield:bounce_count == 0", "--waveform", "catch", *UNITS, "--budget", "100000"]),
    "gold-errors": ("gold, Vdp to 1 %, period to 0.5 %", GOLD + [
        "--waveform", "knots:5", "--calibrate", "Vdp:1 %,frequency:0.5 %", "--budget", "150000"]),
    "pzt-both-45us": ("piezo and electrode, below 45 us", BOTH_QUICKLY, BOTH_QUICKLY + ["--seed", "11"],
                      BOTH_QUICKLY + ["--seed", "21"]),
    "pzt-both-200us": ("piezo and electrode, below 200 us", PZT + [
        "--actuator", "both", "--waveform", "knots:4", "--constrain", "initial_contact_time < 200 us", "--budget", "200000",
        "--seed", "3"]),
    "pzt-alone": ("piezo alone", PZT + ["--actuator", "pzt", "--budget", "100000"]),
    "nem-tin": ("nem-tin, nothing known", ["nem-tin.toml", "--robust", "cvar:0.9", "--waveform", "pulse", "--budget", "60000"]),
    "two-electrodes": ("two electrodes, nothing known", ["two-electrodes.toml", "--robust", "cvar:0.9", "--waveform", "pulse", "--budget", "60000",
                                                        "--seed", "2"]),
}


def at_95_percent(drive, key, unit):
    q = next(q for q in drive["figures"][key]["quantiles"] if q["probability"] == 0.95)
    low, high = q["interval"]
    return f"{prefixed(q['value'], unit)} ({prefixed(low, unit)} to {prefixed(high, unit)})"


def share(part):
    return f"{100 * part['share']:.1f} % ({100 * part['interval'][0]:.1f} to {100 * part['interval'][1]:.1f})"


def command(words):
    quoted = [f'"{word}"' if " " in word or "," in word else word for word in words[1:]]
    return " ".join(["softland optimize", f"scenes/{words[0]}", *quoted])


def row(name, drive, *more):
    cells = [name, at_95_percent(drive, "largest_impact_velocity_m_s", "m/s"), at_95_percent(drive, "major_bounce_height_m", "m"),
             at_95_percent(drive, "initial_contact_time_s", "s"), share(drive["bounce_free"]), *more]
    return "| " + " | ".join(cells) + " |"


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    chosen = sys.argv[2:] or list(SEARCHES)
    print(f"""# Searches over varied devices

`softland optimize ... --robust ...` runs on the shipped scenes with their own `[spread]`: 2 % of thickness, 2 % of both gaps by one factor, 3 % of the modulus,
one standard deviation, normal; see the scenes for the others. Each winner is judged on 2000 devices that no search has seen, over the scene's whole window.
Values are 95th percentiles, with the 95 % confidence interval in brackets; v is the largest impact velocity of all touches.

- made by `bench/run_robust_search.py BUILD/apps/softland > results/robust-search.md`, {datetime.date.today()}, revision {revision()}
- machine: {machine()}

| search | v | B_H | t_i | without a rebound | cost on fresh devices (searched) | closings | time |
|---|---|---|---|---|---|---|---|""")
    steps, commands, worth = {}, [], []
    with tempfile.TemporaryDirectory() as folder:
        for name in chosen:
            what, *rounds = SEARCHES[name]
            closings, begin = 0, time.monotonic()
            for number, words in enumerate(rounds):
                place = f"{name}-{number + 1}"
                start = ["--start", f"{name}-{number}/best.toml"] if number else []
                done = subprocess.run([program, "optimize", SCENES / words[0], *words[1:], *start, "--out", place, "--quiet"],
                                      capture_output=True, text=True, cwd=folder)
                if done.returncode not in (0, 4):
                    sys.exit(f"{name}: exit status {done.returncode}\n{done.stderr}")
                commands.append(command([*words, *start, "--out", place]) if len(rounds) > 1 else command(words))
                out = pathlib.Path(folder, place)
                closings += json.loads((out / "result.json").read_text())["robust"]["closings"]
            seconds = time.monotonic() - begin
            found = json.loads((out / "result.json").read_text())
            verdict = json.loads((out / "robustness.json").read_text())
            print(row(what, verdict["drives"][-1],
                      f"{found['best']['cost']:.3f} ({found['robust']['cost_on_searched_devices']:.3f})",
                      f"{closings:.0f}", f"{seconds:.0f} s"), flush=True)
            steps[rounds[0][0]] = verdict["drives"][0]
            if verdict["by_knowledge"]:
                worth.append((what, verdict["by_knowledge"]))
    for scene, step in steps.items():
        print(row(f"plain step of {scene}", step, "", "", ""))
    for what, drives in worth:
        print(f"\n## What measuring is worth: {what}\n\n| known of every device | v | B_H | t_i | without a rebound |\n|---|---|---|---|---|")
        for drive in drives:
            print(row(drive["name"], drive))
    print("\n## Commands\n\n```sh")
    print("\n".join(commands))
    print("```")


if __name__ == "__main__":
    main()
