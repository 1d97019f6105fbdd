#!/usr/bin/python3
"""Finds how softly 95 % of the devices can be closed within a given time, by one robust search for each limit of the closing time.

    bench/run_robust_front.py BUILD/apps/softland results

Writes robust-front.md and robust-front.svg into the folder. Takes about ten minutes on two cores.
"""
import datetime
import json
import math
import pathlib
import subprocess
import sys
import tempfile
import time

from drawing import BOLD, INK, PENS, drawing, line, words
from tables import machine, prefixed, revision

SCENE = pathlib.Path(__file__).resolve().parent.parent / "scenes" / "mem-gold.toml"
CEILINGS = (42, 46, 50, 55, 60, 65, 80, 100, 140, 220)  # limits of the first contact of 95 % of the devices [us]
KNOWN = {
    "nothing": [],
    "Vdp to 1 %, period to 0.5 %": ["--calibrate", "Vdp:1 %,frequency:0.5 %"],
}
BUDGET = 60000  # number of closings of one search
FAMILY = "knots:5"
TIME, SPEED, HEIGHT = "initial_contact_time_s", "largest_impact_velocity_m_s", "major_bounce_height_m"


def quantile(drive, key):
    found = next(q for q in drive["figures"][key]["quantiles"] if q["probability"] == 0.95)
    return found["value"], found["interval"]


def words_of(ceiling, known):
    return ["--robust", "cvar:0.9", "--waveform", FAMILY, "--constrain", f"initial_contact_time < {ceiling} us",
            "--budget", str(BUDGET), *KNOWN[known]]


def search(program, ceiling, known):
    """Returns the plain step and the winner on devices that are new to the search, and the time of the search [s]."""
    with tempfile.TemporaryDirectory() as folder:
        begin = time.monotonic()
        done = subprocess.run([program, "optimize", SCENE, *words_of(ceiling, known), "--out", folder, "--quiet"],
                              capture_output=True, text=True, check=False)
        seconds = time.monotonic() - begin
        if done.returncode not in (0, 4):
            sys.exit(f"{ceiling} us, {known}: exit status {done.returncode}\n{done.stderr}")
        drives = json.loads(pathlib.Path(folder, "robustness.json").read_text(encoding="utf-8"))["drives"]
        return drives[0], drives[-1], seconds


def keeps(drive, ceiling):
    """True if 95 % of the fresh devices are within the limit, as far as their confidence interval shows."""
    return quantile(drive, TIME)[1][0] <= ceiling * 1e-6


def picture(found, step):
    width, height, left, top, right, bottom = 900, 560, 84, 128, 870, 490
    times, speeds = (30e-6, 250e-6), (5e-3, 130e-3)
    across = lambda t: left + (right - left) * math.log(t / times[0]) / math.log(times[1] / times[0])
    down = lambda v: bottom - (bottom - top) * math.log(v / speeds[0]) / math.log(speeds[1] / speeds[0])
    out = []
    for tick in (30, 40, 50, 60, 80, 100, 150, 200, 250):
        x = across(tick * 1e-6)
        out += [line(x, top, x, bottom), words(x, bottom + 18, tick, anchor="middle")]
    for tick in (5, 10, 20, 50, 100):
        y = down(tick * 1e-3)
        out += [line(left, y, right, y), words(left - 8, y + 4, tick, anchor="end")]
    out += [words((left + right) / 2, bottom + 40, "first contact of 95 % of the devices (us)".replace("us", "µs"), anchor="middle"),
            words(26, (top + bottom) / 2, "largest impact velocity of 95 % (mm/s)", anchor="middle",
                  more=f' transform="rotate(-90 26 {(top + bottom) / 2:.1f})"')]
    for (colour, dash), (known, winners) in zip(PENS, found.items()):
        points = sorted((quantile(drive, TIME)[0], quantile(drive, SPEED)) for ceiling, drive, _ in winners if keeps(drive, ceiling))
        front = [p for p in points if all(q[1][0] > p[1][0] or q[0] >= p[0] for q in points)]
        path = " ".join(f"{across(t):.1f},{down(v[0]):.1f}" for t, v in front)
        out.append(f'<polyline points="{path}" fill="none" stroke="{colour}" stroke-width="1.8" stroke-dasharray="{dash or "none"}"/>')
        for t, (v, (low, high)) in points:
            out += [line(across(t), down(low), across(t), down(high), colour, ' stroke-width="1.5"'),
                    f'<circle cx="{across(t):.1f}" cy="{down(v):.1f}" r="4" fill="{colour}"/>']
        t, (v, _) = front[-1]
        side = "end" if across(t) > (left + right) / 2 else "start"
        out.append(words(across(t) - 6, down(v) + 22, f"known of every device: {known}", 13, side, INK))
    x, y = across(quantile(step, TIME)[0]), down(quantile(step, SPEED)[0])
    out += [f'<path d="M{x - 5:.1f},{y:.1f}h10M{x:.1f},{y - 5:.1f}v10" stroke="{INK}" stroke-width="2"/>',
            words(x + 10, y + 4, "plain step", 13, colour=INK, more=BOLD)]
    return drawing(width, height, ["Softer takes longer: what 95 % of the devices stay below"], [
        f"mem-gold under its spread; every dot is one search (cvar:0.9, {FAMILY}, {BUDGET} closings) under a ceiling of the closing time, judged",
        "on 2000 fresh devices over the whole window. Bars: 95 % confidence. The line joins what no other dot is both faster and softer than."],
        out)


def main():
    program, folder = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
    found = {known: [] for known in KNOWN}
    for known, winners in found.items():
        for ceiling in CEILINGS:
            step, winner, seconds = search(program, ceiling, known)
            winners.append((ceiling, winner, seconds))
            print(f"{known}, {ceiling} us: {prefixed(quantile(winner, SPEED)[0], 'm/s')}, {seconds:.0f} s", file=sys.stderr, flush=True)
    text = [f"""# Impact velocity against closing time, of 95 % of the devices

One search per ceiling of the first contact and knowledge of the devices; each winner is judged on 2000 devices that no search has seen, over the whole window. Values
are 95 % quantiles, with 95 % confidence in brackets; v is the largest impact velocity of all touches. A ceiling that 95 % of the fresh devices do not keep is marked.

- made by `bench/run_robust_front.py BUILD/apps/softland results`, {datetime.date.today()}, revision {revision()}
- one search: `softland optimize scenes/mem-gold.toml {" ".join(f'"{w}"' if " " in w else w for w in words_of(CEILINGS[0], "nothing"))}`
- machine: {machine()}

![largest impact velocity against first contact](robust-front.svg)

| known | ceiling | t_i | v | B_H | time of the search |
|---|---|---|---|---|---|"""]
    cell = lambda drive, key, unit: "{} ({} to {})".format(*(prefixed(v, unit) for v in
                                                           (quantile(drive, key)[0], *quantile(drive, key)[1])))
    row = lambda known, ceiling, drive, spent: text.append(
        f"| {known} | {ceiling} | {cell(drive, TIME, 's')} | {cell(drive, SPEED, 'm/s')} | {cell(drive, HEIGHT, 'm')} | {spent} |")
    row("plain step", "", step, "")
    for known, winners in found.items():
        for ceiling, drive, seconds in winners:
            row(known, f"{ceiling} us" + ("" if keeps(drive, ceiling) else ", not kept"), drive, f"{seconds:.0f} s")
    (folder / "robust-front.md").write_text("\n".join(text) + "\n", encoding="utf-8")
    (folder / "robust-front.svg").write_text(picture(found, step), encoding="utf-8")


if __name__ == "__main__":
    main()
