#!/usr/bin/env python3
"""Compares every target of a search with every other: is a search for a figure the best in that figure?

    bench/run_targets.py BUILD/apps/softland [--seeds N] [--targets A,B] [--searches SCENE:ACTUATOR,...] [--optimizer NAME] [--keep FILE] > results/targets.md

Runs `softland optimize` with the default budget for every shipped scene that allows a search, every target and the seeds 1 to N (default 3).
With --keep the searches are kept in a file and not run again. Takes about ten minutes for each seed on two idle cores.
"""
import argparse
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
SEARCHES = [("mem-gold.toml", "electrostatic"), ("mem-gold-pzt.toml", "electrostatic"), ("mem-gold-pzt.toml", "pzt"),
            ("mem-gold-pzt.toml", "both"), ("nem-tin.toml", "electrostatic"), ("two-electrodes.toml", "electrostatic"),
            ("gap-closing-actuator.toml", "electrostatic")]
# Targets have a figure, its key, and the unit in which it is printed.
FIGURES = {"bounce": "major_bounce_height_m", "settling": "permanent_contact_time_s", "rebound": "major_bounce_height_m",
           "count": "bounce_count", "impact": "impact_velocity_m_s", "energy": "impact_energy_J", "force": "peak_contact_force_N",
           "drive": "drive_energy_J", "steady": "steady_force_time_s"}
UNITS = {"permanent_contact_time_s": ("t_p [us]", 1e6), "bounce_count": ("N_B", 1), "major_bounce_height_m": ("B_H [nm]", 1e9),
         "impact_velocity_m_s": ("v_i [mm/s]", 1e3), "impact_energy_J": ("E_i [fJ]", 1e15),
         "peak_contact_force_N": ("F [uN]", 1e6), "drive_energy_J": ("E_d [fJ]", 1e15),
         "steady_force_time_s": ("t_F [us]", 1e6)}
TOLERATED = 0.05
SIGNIFICANT = {"nem-tin.toml": 1e-11}  # [m]; the other scenes have the default, 1e-9


def search(program, scene, actuator, target, seed, optimizer):
    """Returns the data of one search for the table."""
    with tempfile.TemporaryDirectory() as out:
        command = [program, "optimize", SCENES / scene, "--robust", "none", "--target", target, "--actuator", actuator, "--seed", str(seed), "--optimizer",
                   optimizer, "--quiet", "--json", "-", "--out", out]
        start = time.monotonic()
        run = subprocess.run(command, capture_output=True, text=True)
        wall = time.monotonic() - start
    if run.returncode not in (0, 4):
        sys.exit(f"{' '.join(map(str, command))}: exit status {run.returncode}\n{run.stderr}")
    result = json.loads(run.stdout)
    return {"metrics": result.get("best", {}).get("metrics"), "goal": result["goal_met"], "wall": wall,
            "checks": [check["metrics"]["bounce_count"] for check in result.get("checks", [])]}


def rank(target, metrics, significant):
    """Returns the order of results: first by rebounds, of which insignificant ones count as none, then by the target's own figure."""
    figure = metrics and metrics[FIGURES[target]]
    if figure is None or not metrics["settled"]:
        return (2, 0.0)
    if FIGURES[target] == "major_bounce_height_m":
        figure = max(figure, significant)
    return (min(metrics["bounce_count"], 1), figure)


def beaten(mine, other):
    return other[0] < mine[0] or (other[0] == mine[0] and other[1] < (1 - TOLERATED) * mine[1])


def cell(value, scale):
    return "-" if value is None else f"{value * scale:.4g}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--targets", default=",".join(FIGURES))
    parser.add_argument("--searches", default=",".join(":".join(one) for one in SEARCHES))
    parser.add_argument("--optimizer", default="auto")
    parser.add_argument("--keep", type=pathlib.Path)
    given = parser.parse_args()
    targets = given.targets.split(",")
    searches = [tuple(one.split(":")) for one in given.searches.split(",")]
    # The command of this table, which names the part for a part of the table.
    options = [f"--seeds {given.seeds}"] * (given.seeds != 3) + [f"--targets {given.targets}"] * (targets != list(FIGURES))
    options += [f"--searches {given.searches}"] * (searches != SEARCHES)
    print(f"""# Every target against every other

The searches are `softland optimize SCENE --target T --actuator A --seed N --optimizer {given.optimizer}` with the default budgets. The last column names the other targets
whose winner, on the same scene with the same seed, is better in this target's own figure by more than {TOLERATED:.0%}, or has no significant rebound where this one has.

- made by `bench/run_targets.py {" ".join(["BUILD/apps/softland"] + options)} > results/targets.md`, {datetime.date.today().isoformat()}, revision {revision()}
- machine: {machine()}
""")
    kept = json.loads(given.keep.read_text()) if given.keep and given.keep.exists() else {}
    for seed in range(1, given.seeds + 1):
        for scene, actuator in searches:
            for target in targets:
                name = " ".join([scene, actuator, target, str(seed), given.optimizer])
                if name not in kept:
                    kept[name] = search(given.program, scene, actuator, target, seed, given.optimizer)
                    if given.keep:
                        given.keep.write_text(json.dumps(kept))
    runs = losers = goals = 0
    for scene, actuator in searches:
        print(f"## {scene}, {actuator}\n")
        print(f"| target | seed | time [s] | t_i [us] | {' | '.join(name for name, _ in UNITS.values())} | goal | checks: N_B | beaten by |")
        print("|---|---|---|---|" + "---|" * (len(UNITS) + 3))
        for seed in range(1, given.seeds + 1):
            found = {t: kept[" ".join([scene, actuator, t, str(seed), given.optimizer])] for t in targets}
            for t, one in found.items():
                mine = rank(t, one["metrics"], SIGNIFICANT.get(scene, 1e-9))
                better = [u for u in targets if u != t and beaten(mine, rank(t, found[u]["metrics"], SIGNIFICANT.get(scene, 1e-9)))]
                runs += 1
                losers += bool(better)
                goals += one["goal"]
                m = one["metrics"] or {}
                figures = " | ".join(cell(m.get(key), scale) for key, (_, scale) in UNITS.items())
                print(f"| {t} | {seed} | {one['wall']:.1f} | {cell(m.get('initial_contact_time_s'), 1e6)} | {figures} | "
                      f"{'met' if one['goal'] else 'not met'} | {', '.join(map(str, one['checks']))} | {', '.join(better)} |")
        print()
    print(f"{runs} searches, {goals} goals met, {losers} beaten in their own figure by another target's winner.")


if __name__ == "__main__":
    main()
