#!/usr/bin/env python3
"""Runs `softland optimize` with its defaults over switches, actuators and seeds: the tables of results/race.md.

    bench/run_race.py PROGRAM FOLDER [--seeds 1,2,3] [--scene FILE ...]

Searches with a result in FOLDER are not run again. Runs one search at a time, on all cores.
"""
import argparse
import json
import pathlib
import resource
import subprocess
import time

SCENES = pathlib.Path(__file__).parent.parent / "scenes"
PAIRS = [(SCENES / f"{name}.toml", actuator) for name, actuator in
         (("mem-gold", "electrostatic"), ("mem-gold-pzt", "pzt"), ("mem-gold-pzt", "electrostatic"), ("mem-gold-pzt", "both"),
          ("two-electrodes", "electrostatic"), ("nem-tin", "electrostatic"), ("gap-closing-actuator", "electrostatic"))]
SPEED, HEIGHT, TIME, FORCE = ("largest_impact_velocity_m_s", "major_bounce_height_m", "initial_contact_time_s", "peak_contact_force_N")


def searched(program, folder, scene, actuator, seed):
    """Returns result, wall time and processor time [s]."""
    place = folder / f"{scene.stem}-{actuator}-{seed}"
    kept = place / "cost.json"
    if not kept.exists():
        before, begun = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
        run = subprocess.run([program, "optimize", scene, "--actuator", actuator, "--seed", str(seed), "--quiet", "--out",
                              place], capture_output=True, text=True, check=False)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        if run.returncode not in (0, 4):
            raise SystemExit(f"{place}: {run.stderr}")
        kept.write_text(json.dumps({"wall_s": time.monotonic() - begun, "status": run.returncode,
                                    "processor_s": after.ru_utime - before.ru_utime}))
    return json.loads((place / "result.json").read_text()), json.loads(kept.read_text())


def quantity(value, unit):
    """Returns the value with three digits and a prefix."""
    if value is None:
        return "∞"
    if value == 0:
        return "none"
    for factor, prefix in ((1, ""), (1e-3, "m"), (1e-6, "µ"), (1e-9, "n"), (1e-12, "p")):
        if abs(value) >= factor:
            return f"{value / factor:.3g} {prefix}{unit}"
    return f"{value:.1e} {unit}"


def cells(row):
    at = row["quantile_95"]
    return [f"{100 * row['bounce_free']:.1f} %", quantity(at[SPEED], "m/s"), quantity(at[HEIGHT], "m"), quantity(at[TIME], "s"),
            quantity(at[FORCE], "N"), f"{100 * row['does_not_close']:.1f} %"]


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return lines + ["| " + " | ".join(str(c) for c in row) + " |" for row in rows] + [""]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--seeds", default="1,2,3")
    parser.add_argument("--scene", type=pathlib.Path, action="append", default=[], help="one more, of electrostatic drives")
    asked = parser.parse_args()
    seeds = [int(s) for s in asked.seeds.split(",")]
    figures, measured, winners = [], [], {}
    for scene, actuator in PAIRS + [(scene, "electrostatic") for scene in asked.scene]:
        for seed in seeds:
            result, cost = searched(asked.program, asked.folder, scene, actuator, seed)
            devices = result["devices"]
            rows = {row["name"]: row for row in devices["rows"]}
            name = f"{scene.stem}, {actuator}"
            if seed == seeds[0]:
                figures.append([name, "plain step", ""] + cells(rows["plain step"]) + ["", ""])
            chosen = devices["chosen"]
            won = f"{chosen['waveform']} by {chosen['measure']}" if chosen["measure"] else "plain step"
            winners[won] = winners.get(won, []) + [f"{name} {seed}"]
            figures.append([name, won, seed] + cells(rows["for the devices"]) + [round(cost["processor_s"]), round(cost["wall_s"])])
            for row in devices["rows"]:
                if row["name"] not in ("plain step", "for the devices"):
                    measured.append([name, row["name"], seed] + cells(row))
    figure_heads = ["no rebound", "impact", "rebound", "contact", "force", "stay open"]
    text = ["# What a search for devices comes to", "",
            "`bench/run_race.py PROGRAM FOLDER`: `softland optimize SCENE --actuator ACTUATOR --seed N` with the defaults, 2000 fresh devices.",
            "Figures are those that 95 % of the devices stay below. Times are of one search on two cores.", ""]
    text += ["## Winners", ""] + table(["switch", "waveform", "seed"] + figure_heads + ["processor s", "wall s"], figures)
    text += ["## On the nominal design, and in measured units", ""] + table(["switch", "waveform", "seed"] + figure_heads, measured)
    text += ["## Which candidate won where", ""] + table(["candidate", "won"], [[w, "; ".join(places)] for w, places in sorted(winners.items())])
    print("\n".join(text))


if __name__ == "__main__":
    main()
