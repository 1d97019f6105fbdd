#!/usr/bin/python3
"""Compares every optimizer and every waveform family with `auto` and the default families, on eight switches: costs, times, a performance profile.

    bench/run_comparison.py BUILD/apps/softland STORE.jsonl results [--auto]

Runs `softland optimize --target bounce` with the default budgets, one thread each, two at a time, and appends a line per search to the
store. Searches that are in the store are not run again. Then writes comparison.md and comparison.svg. Takes about an hour on two cores. With --auto
only the searches of auto with the default families are run (a quarter of an hour) and compared with the least costs in comparison.md;
their table is printed.
"""
import concurrent.futures
import datetime
import json
import math
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

from drawing import BOLD, INK, PENS, drawing, line, words
from tables import machine, revision

HERE = pathlib.Path(__file__).resolve().parent
SCENES = HERE.parent / "scenes"
CASES = {"gold": ("mem-gold.toml", "electrostatic", []),
         "gold, 290 um": ("mem-gold.toml", "electrostatic", ["structure.length=290 um"]),
         "gold with piezo, electrode": ("mem-gold-pzt.toml", "electrostatic", []),
         "gold with piezo, piezo": ("mem-gold-pzt.toml", "pzt", []),
         "gold with piezo, both": ("mem-gold-pzt.toml", "both", []),
         "nem-tin": ("nem-tin.toml", "electrostatic", []),
         "nem-tin, 1.15 Vdp": ("nem-tin.toml", "electrostatic", ["waveform.main.level=1.15 Vdp"]),
         "plate, two electrodes": ("two-electrodes.toml", "electrostatic", [])}
OPTIMIZERS = ["bobyqa", "sbplx", "nelder-mead", "slsqp", "mma", "ccsaq", "ipopt", "cma-es", "crs2", "isres", "esch", "direct-l", "mlsl"]
FAMILIES = ["step", "pulse", "harmonic", "catch", "ramp", "staircase", "knots", "coast", "dual-pulse", "pulses", "s-curve", "dither", "chirp",
            "bspline", "sines"]
SEEDS, AUTO_SEEDS = range(1, 2), range(1, 11)


def family_of(case):
    """Returns the searches with which the optimizers are compared."""
    return "sines" if CASES[case][1] == "pzt" else "catch"


def searches(others=True):
    for case in CASES:
        for seed in AUTO_SEEDS:
            yield case, "auto", "", seed
        for seed in SEEDS if others else ():
            for name in OPTIMIZERS:
                yield case, name, family_of(case), seed
            for family in FAMILIES:
                yield case, "auto", family, seed


def search(program, case, optimizer, family, seed):
    scene, actuator, changes = CASES[case]
    with tempfile.TemporaryDirectory() as out:
        command = [program, "optimize", SCENES / scene, "--robust", "none", "--actuator", actuator, "--optimizer", optimizer, "--seed", str(seed), "--jobs", "1",
                   "--quiet", "--json", "-", "--out", out]
        if family:
            command += ["--waveform", family]
        for change in changes:
            command += ["--set", change]
        start = time.monotonic()
        run = subprocess.run(command, capture_output=True, text=True)
        row = {"case": case, "optimizer": optimizer, "family": family, "seed": seed, "status": run.returncode,
               "time": time.monotonic() - start}
        if run.returncode in (0, 4):
            found = json.loads(run.stdout)
            row |= {"waveform": found["waveform"], "evaluations": found["evaluations"], "met": found["goal_met"],
                    "variables": len(found["best"]["parameters"]), "cost": found["best"]["cost"], "metrics": found["metrics"],
                    "rebounds": [check["metrics"]["bounce_count"] for check in found["checks"]]}
        else:
            row["error"] = run.stderr.strip().splitlines()[-1] if run.stderr.strip() else ""
        return row


def run_all(program, store, wanted):
    known = [json.loads(line) for line in store.read_text().splitlines()] if store.exists() else []
    done = {(r["case"], r["optimizer"], r["family"], r["seed"]) for r in known}
    with concurrent.futures.ThreadPoolExecutor(2) as pool, store.open("a") as out:
        for row in pool.map(lambda s: search(program, *s), [s for s in wanted if s not in done]):
            known.append(row)
            out.write(json.dumps(row) + "\n")
            out.flush()
    return known


def name_of(row):
    return row["optimizer"] if row["optimizer"] != "auto" else row["family"] or "auto"


def ratios(rows, best):
    """Returns the cost over the best cost of the case; infinite with a rebound, and if nothing was found."""
    return [row["cost"] / best[row["case"]] if row.get("met") else math.inf for row in rows]


def share_within(values, factor):
    return sum(v <= factor for v in values) / len(values)


def picture(contenders, best):
    width, height, left, top, right, bottom = 900, 560, 84, 128, 640, 490
    most = 5
    across = lambda factor: left + (right - left) * math.log(factor) / math.log(most)
    down = lambda share: bottom - (bottom - top) * share
    out = []
    for tick in (1, 1.2, 1.5, 2, 3, 5):
        out += [line(across(tick), top, across(tick), bottom), words(across(tick), bottom + 18, tick, anchor="middle")]
    for tick in (0, 0.25, 0.5, 0.75, 1):
        out += [line(left, down(tick), right, down(tick)), words(left - 8, down(tick) + 4, f"{100 * tick:.0f} %", anchor="end")]
    out += [words((left + right) / 2, bottom + 40, "cost over the best of all searches of the same switch", anchor="middle"),
            words(26, (top + bottom) / 2, "share of the searches", anchor="middle", more=f' transform="rotate(-90 26 {(top + bottom) / 2:.1f})"')]
    for place, (name, rows) in enumerate(contenders):
        colour, dash = PENS[place % len(PENS)]
        wide = 3.2 if place == 0 else 1.6
        steps, path = sorted(ratios(rows, best)), []
        for k, value in enumerate(steps):
            if value > most:
                break
            path += [f"{across(value):.1f},{down(k / len(steps)):.1f}", f"{across(value):.1f},{down((k + 1) / len(steps)):.1f}"]
        if path:
            path = [f"{left},{down(0):.1f}", *path, f"{right},{path[-1].split(',')[1]}"]
            out.append(f'<polyline points="{" ".join(path)}" fill="none" stroke="{colour}" stroke-width="{wide}" '
                       f'stroke-dasharray="{dash or "none"}"/>')
        y = top + 14 + 24 * place
        out += [f'<line x1="{right + 18}" y1="{y}" x2="{right + 52}" y2="{y}" stroke="{colour}" stroke-width="{wide}" '
                f'stroke-dasharray="{dash or "none"}"/>',
                words(right + 60, y + 4, name, 13, colour=INK, more=BOLD if place == 0 else "")]
    return drawing(width, height, ["How near every search comes to the best of all"], [
        "Eight switches; the part of a contender's searches whose winner lands without a rebound at no more than so many times",
        "the least cost that any search found for the switch. Higher and further left is better."], out)


HEAD = """| switch | families of the winners | parameters | least cost of all | found by | cost of auto over it: least, median, most | within 5 % | t_i [us] | v_i [mm/s] | B_H [nm] | median time |
|---|---|---|---|---|---|---|---|---|---|---|"""


def table_of_auto(auto, best, found_by):
    span = lambda values, digits: f"{min(values):.{digits}g}" if max(values) - min(values) < 1e-3 * max(map(abs, values)) else \
        f"{min(values):.{digits}g} to {max(values):.{digits}g}"
    lines = [HEAD]
    for case in CASES:
        own = [r for r in auto if r["case"] == case]
        values = ratios(own, best)
        m = [r["metrics"] for r in own]
        lines.append("| {} | {} | {} | {:.5f} | {} | {:.3f}, {:.3f}, {:.3f} | {} of {} | {} | {} | {} | {:.1f} s |".format(
            case, ", ".join(sorted({r["waveform"] for r in own})), span([r["variables"] for r in own], 2), best[case], found_by[case],
            min(values), statistics.median(values), max(values), sum(v <= 1.05 for v in values), len(values),
            span([x["initial_contact_time_s"] * 1e6 for x in m], 4), span([x["impact_velocity_m_s"] * 1e3 for x in m], 3),
            span([x["major_bounce_height_m"] * 1e9 for x in m], 2), statistics.median(r["time"] for r in own)))
    lines.append(f"\nOf all {len(auto)} searches of auto {100 * share_within(ratios(auto, best), 1.05):.0f} % are within 5 % of the best of all, "
                 f"{100 * share_within(ratios(auto, best), 1.2):.0f} % within 20 %. The aim was 90 % within 5 %.")
    return "\n".join(lines)


def print_auto(program, store, folder):
    """Compares with the least costs in the tables of comparison.md."""
    auto = run_all(program, store, searches(others=False))
    cells = [line.split(" | ") for line in (folder / "comparison.md").read_text().splitlines() if line.startswith("| ")]
    told = [(row[0][2:], float(row[3]), row[4]) for row in cells if row[0][2:] in CASES]
    known = {case: min((cost, name) for c, cost, name in told if c == case) for case in CASES}
    for row in auto:
        if row.get("met") and row["cost"] < known[row["case"]][0]:
            known[row["case"]] = row["cost"], "auto"
    print(table_of_auto(auto, {case: known[case][0] for case in CASES}, {case: known[case][1] for case in CASES}))


def main():
    program, store, folder = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])
    if sys.argv[4:] == ["--auto"]:
        return print_auto(program, store, folder)
    wanted = list(searches())
    rows = [r for r in run_all(program, store, wanted) if (r["case"], r["optimizer"], r["family"], r["seed"]) in wanted]
    best = {case: min((r["cost"] for r in rows if r["case"] == case and r.get("met")), default=math.inf) for case in CASES}
    named = {}
    for row in rows:
        named.setdefault(name_of(row), []).append(row)
    auto = named.pop("auto")
    ranked = sorted(named.items(), key=lambda item: (-share_within(ratios(item[1], best), 1.05), -share_within(ratios(item[1], best), 2)))
    text = [f"""# auto against every optimizer and every family

`softland optimize SCENE --target bounce` with the default budgets (5000 evaluations for an electrode, 12 000 for several drives, 20 000 for a piezo) on eight switches. `auto` with the default families from ten
seeds; every other optimizer with one family (`catch`, `sines` for the piezo), and `auto` with every single family, from one. A search has won as far as its cost is near the least that any of
all these searches found for the same switch; one that does not land without a rebound has not.

- made by `bench/run_comparison.py BUILD/apps/softland STORE results`, {datetime.date.today()}, revision {revision()}
- machine: {machine()}; two searches at a time, one thread each

![performance profiles](comparison.svg)

## auto, ten seeds
"""]
    found_by = {}
    for case in CASES:
        winner = min((r for r in rows if r["case"] == case and r.get("met")), key=lambda r: r["cost"])
        found_by[case] = name_of(winner) + (", " + winner["optimizer"] if winner["family"] else "")
    text.append(table_of_auto(auto, best, found_by))
    for title, wanted in (("Optimizers, with one family", OPTIMIZERS), ("Families, with auto", FAMILIES)):
        text.append(f"\n## {title}\n\nMedian cost over the least of all; - where half of the searches do not land without a rebound.\n\n"
                    f"| | {' | '.join(CASES)} | within 5 % | within a factor 2 | land |\n|---|{'---|' * len(CASES)}---|---|---|")
        for name in wanted:
            mine = named.get(name, [])
            if not mine:
                continue
            cell = []
            for case in CASES:
                values = ratios([r for r in mine if r["case"] == case], best)
                middle = statistics.median(values) if values else math.inf
                cell.append(f"{middle:.2f}" if math.isfinite(middle) else "-")
            values = ratios(mine, best)
            text.append(f"| {name} | {' | '.join(cell)} | {100 * share_within(values, 1.05):.0f} % | {100 * share_within(values, 2):.0f} % | "
                        f"{100 * share_within(values, 1e9):.0f} % |")
    (folder / "comparison.md").write_text("\n".join(text) + "\n", encoding="utf-8")
    (folder / "comparison.svg").write_text(picture([("auto", auto), *ranked[:3]], best), encoding="utf-8")


if __name__ == "__main__":
    main()
