#!/usr/bin/python3
"""Maps over amplitude and frequency of a dither on top of the step: where it helps the gold cantilevers, and where it harms.

    bench/run_dither_maps.py BUILD/apps/softland results [STORES]

Writes dither-maps.md and dither-maps-*.svg into the folder. Takes about half an hour on one core. With a folder STORES the rows are kept
there, and a second run reuses them.
"""
import bisect
import csv
import datetime
import io
import json
import math
import pathlib
import statistics
import subprocess
import sys
import tempfile
import tomllib

from drawing import BOLD, INK, MUTED, drawing, line, tiles, words
from tables import machine, prefixed, revision

SCENES = pathlib.Path(__file__).resolve().parent.parent / "scenes"
LEVELS = (1.1, 1.25, 1.5)  # levels of the step [Vdp]
CONTACTS = {"lossless": [], "plastic": ["contact.model=elastic-plastic", "contact.hardness=1.5 GPa"]}
T_I, T_P, B_H, N_B = "initial_contact_time_s", "permanent_contact_time_s", "major_bounce_height_m", "bounce_count"
NEAR = 0.005  # relative difference of neighbours of a setting in level and frequency
PHASES = 12  # number of phases of the thesis' dithers
ENDS = 10  # number of end times of a dither that ends, from 0.75 to 1.5 times the usual one
STEPS = 27  # number of runs of the plain step in the same range of levels
ROOM = "driver.main.max_voltage=1.9 Vdp"  # a dither on 1.5 Vdp exceeds the limit of the shipped driver
CANDIDATES = 1  # number of settings of each map, those of least t_p, whose neighbours are run


class Drive:
    def __init__(self, short, title, scene, key, end, amplitudes, frequencies, natural, ticks, thesis):
        self.name = self.actuator = "electrostatic" if key == "main" else "pzt"
        self.short, self.title, self.scene, self.key = short, title, SCENES / f"{scene}.toml", key
        self.end = end  # end of a dither that ends [us]
        self.amplitudes, self.frequencies = amplitudes, frequencies  # [%], [krad/s]
        self.natural, self.ticks, self.thesis = natural, ticks, thesis  # [krad/s], [krad/s], level: ([%], [krad/s])

    def level_key(self):
        return "waveform.main.base" if self.key == "main" else "waveform.main.level"

    def changes(self, level, ended):
        """Returns the assignments that add a dither to the scene's step, with placeholders for amplitude and frequency."""
        dither = 'family = "harmonic", amplitude = "1 %", angular_frequency = "100 krad/s"' + (f', end = "{self.end} us"' if ended else "")
        if self.key == "main":
            return [f'waveform.main={{{dither}, base = "{level} Vdp"}}', ROOM]
        return [f"waveform.main.level={level} Vdp", f"waveform.piezo={{{dither}}}",
                'driver.piezo={min_voltage = "-10 V", max_voltage = "10 V"}']


ELECTRODE = Drive("electrode", "a dither of the electrode's voltage", "mem-gold", "main", 60, (1, 2, 3, 4, 5, 6, 8, 10, 12, 15, 20),
                  range(10, 411, 10), (65.3, 409.2), (100, 200, 300, 400), {1.1: (15, 180.543), 1.25: (15, 180.543), 1.5: (20, 380.386)})
PIEZO = Drive("piezo", "a dither of the piezo's voltage", "mem-gold-pzt", "piezo", 40, (0.1, 0.2, 0.5, 1, 2, 4, 7, 10, 15, 20),
              range(40, 1761, 40), (97.1, 615.5, 1736.9), (400, 800, 1200, 1600),
              {1.1: (10, 647.465), 1.25: (15, 1205.005), 1.5: (20, 1681.81)})
PICTURES = ((ELECTRODE, "lossless"), (ELECTRODE, "plastic"), (PIEZO, "lossless"))


def setting(text):
    return [word for change in text for word in ("--set", change)]


def run(*arguments):
    done = subprocess.run([str(a) for a in arguments], capture_output=True, text=True, check=False)
    if done.returncode not in (0, 4):
        sys.exit(f"{' '.join(map(str, arguments))}: exit status {done.returncode}\n{done.stderr}")
    return done.stdout


def explored(program, store, scene, changes, points):
    """Returns the rows of an exploration as numbers, with None for missing ones."""
    begun = ["--resume"] if store.exists() else []
    run(program, "explore", scene, *setting(changes), *points, "--out", store, "--jobs", 1, "--quiet", *begun)
    text = run(program, "table", store, "--csv")
    number = lambda key, value: value if key in ("status", "reason") else float(value) if value else None
    return [{key: number(key, value) for key, value in row.items()} for row in csv.DictReader(io.StringIO(text))]


def grid_options(d):
    return ["--vary", f"waveform.{d.key}.amplitude=" + ",".join(f"{a} %" for a in d.amplitudes),
            "--vary", f"waveform.{d.key}.angular_frequency={d.frequencies[0]} krad/s:{d.frequencies[-1]} krad/s:{len(d.frequencies)}"]


def label(d, level, contact, ended):
    return f"{d.name}-{level}-{contact}-{'ended' if ended else 'unended'}"


def mapped(program, stores, d, level, contact, ended):
    name = label(d, level, contact, ended)
    rows = explored(program, stores / f"{name}.sqlite", d.scene, d.changes(level, ended) + CONTACTS[contact], grid_options(d))
    print(name, len(rows), file=sys.stderr, flush=True)
    cells = [(a, f) for a in d.amplitudes for f in d.frequencies]
    return dict(zip(cells, rows, strict=True))


class Cloud:
    """Runs with indistinguishable drives. A figure is given as its median and range; a run without the figure counts as the worst."""

    def __init__(self, rows):
        self.rows = rows

    def nominal(self):
        return self.rows[len(self.rows) // 2]

    def range(self, key):
        values = [math.inf if row[key] is None else row[key] for row in self.rows]
        return statistics.median(values), min(values), max(values)


def steps(program, stores, d, level, contact):
    """Returns the runs of the plain step and of slightly higher and lower ones. The middle row is the step itself."""
    store = stores / f"{d.name}-{level}-{contact}-step.sqlite"
    around = f"waveform.main.level={level * (1 - NEAR):.10g} Vdp:{level * (1 + NEAR):.10g} Vdp:{STEPS}"
    return Cloud(explored(program, store, d.scene, [ROOM, *CONTACTS[contact]], ["--vary", around]))


def neighbours(program, stores, d, level, contact, ended, settings, factors=(1 - NEAR, 1, 1 + NEAR)):
    """Returns, for each setting (amplitude, frequency), its neighbours in level and frequency. The middle run is the setting itself."""
    name = label(d, level, contact, ended) + f"-near-{len(factors)}"
    lines = [f"{d.level_key()} [Vdp],waveform.{d.key}.amplitude [%],waveform.{d.key}.angular_frequency [rad/s]"]
    lines += [f"{level * u:.10g},{a},{f * v * 1e3:.10g}" for a, f in settings for u in factors for v in factors]
    listed = stores / f"{name}.csv"
    listed.write_text("\n".join(lines) + "\n", encoding="utf-8")
    rows = explored(program, stores / f"{name}.sqlite", d.scene, [*d.changes(level, ended), ROOM, *CONTACTS[contact]], ["--list", listed])
    each = len(factors)**2
    return {setting: Cloud(rows[each * k:each * (k + 1)]) for k, setting in enumerate(settings)}


def searched(program, stores, d, level, contact):
    """Returns the result of a search for a pulse, and nine neighbours in voltages and times."""
    out = stores / f"{d.name}-{level}-{contact}-search"
    if not (out / "result.json").exists():
        run(program, "optimize", d.scene, "--robust", "none", *setting([f"waveform.main.level={level} Vdp", *CONTACTS[contact]]),
            "--actuator", d.actuator, "--out", out, "--jobs", 1, "--quiet")
    result = json.loads((out / "result.json").read_text(encoding="utf-8"))
    pulse = tomllib.loads((out / "best.toml").read_text(encoding="utf-8"))["waveform"][d.key]
    all_of = lambda key: "*".join(f"waveform.{d.key}.{key}[{k + 1}]" for k in range(len(pulse[key])))
    part = [f"{100 * u:.10g}" for u in (1 - NEAR, 1, 1 + NEAR)]
    volts = (f"{all_of('levels')}=" if d.key == "main" else "waveform.main.level=") + ",".join(f"{u} %" for u in part)
    times = f"{all_of('times')}=" + ",".join(f"{u} %" for u in part)
    store, scene = stores / f"{d.name}-{level}-{contact}-search-near.sqlite", out / "best.toml"
    return result, Cloud(explored(program, store, scene, [ROOM], ["--vary", volts, "--vary", times]))


def certified(program, d, changes):
    """Returns t_p of a drive as median and range over runs whose drives differ by parts in 1e9."""
    found = json.loads(run(program, "simulate", d.scene, *setting(changes), "--certify", "--jobs", 1, "--quiet",
                           "--json", "-"))
    cloud = found["certified"].get(T_P)
    value = found["metrics"][T_P]
    return (cloud["median"], cloud["low"], cloud["high"]) if cloud else (value, value, value)


class Scale:
    """Colours of a figure relative to the plain step: nine classes from blue (lower) to orange (higher), with their bounds."""

    colours = ("#08519c", "#3787c0", "#86bde0", "#cfe5f3", "#f7f7f5", "#fde0c5", "#f5ae78", "#dd6f2b", "#993404")

    def __init__(self, *bounds):
        self.bounds = bounds

    def colour(self, ratio):
        return self.colours[bisect.bisect_right(self.bounds, ratio)]


TIMES_AND_HEIGHTS, CONTACT_TIMES = Scale(0.5, 0.7, 0.8, 0.9, 1.1, 1.25, 1.5, 2), Scale(0.8, 0.9, 0.95, 0.99, 1.01, 1.05, 1.1, 1.2)
UNSETTLED, FAILED = "#c3c9cf", "#2b3138"
FAILS = ("numerical_failure", "no_contact")


def panel(found, key, reference, scale, d, level, box):
    """Returns one map in its box; `reference` is the figure of the plain step."""
    left, top, right, bottom = box
    def colour(row):
        if row["status"] in FAILS:
            return FAILED
        return UNSETTLED if row[T_P if key == N_B else key] is None else scale.colour(row[key] / reference)
    out = tiles(*box, len(d.frequencies), len(d.amplitudes), [[colour(found[a, f]) for f in d.frequencies] for a in d.amplitudes])
    half = (d.frequencies[1] - d.frequencies[0]) / 2
    low, high = d.frequencies[0] - half, d.frequencies[-1] + half
    across = lambda f: left + (right - left) * (f - low) / (high - low)
    up = lambda a: bottom - (bottom - top) * (d.amplitudes.index(a) + 0.5) / len(d.amplitudes)
    out += [line(across(f), top, across(f), bottom, INK, ' stroke-dasharray="2 3" stroke-width="0.8"') for f in d.natural if low < f < high]
    a, f = d.thesis[level]
    out.append(f'<circle cx="{across(f):.1f}" cy="{up(a):.1f}" r="5" fill="none" stroke="#fff" stroke-width="4"/>'
               f'<circle cx="{across(f):.1f}" cy="{up(a):.1f}" r="5" fill="none" stroke="{INK}" stroke-width="1.8"/>')
    for tick in d.ticks:
        out += [line(across(tick), bottom, across(tick), bottom + 4, MUTED), words(across(tick), bottom + 16, tick, 11, "middle")]
    return out + [f'<rect x="{left:.1f}" y="{top:.1f}" width="{right - left:.1f}" height="{bottom - top:.1f}" fill="none" stroke="{MUTED}"/>']


def amplitudes_beside(d, left, top, bottom):
    high = (bottom - top) / len(d.amplitudes)
    return [words(left - 6, bottom - (k + 0.5) * high + 3.5, f"{a:g}", 10, "end") for k, a in enumerate(d.amplitudes)]


def key_of(scale, x, y, title, states):
    """Returns the legend of a scale in one line."""
    out, size = [words(x, y + 11, title, 12, colour=INK)], 46
    x += 8 + 6.4 * len(title)
    for k, colour in enumerate(scale.colours):
        out.append(f'<rect x="{x + k * size:.1f}" y="{y}" width="{size}" height="14" fill="{colour}"/>')
        if k:
            out.append(words(x + k * size, y + 28, f"{scale.bounds[k - 1]:g}", 11, "middle"))
    out.append(f'<rect x="{x:.1f}" y="{y}" width="{9 * size}" height="14" fill="none" stroke="{MUTED}"/>')
    x += 9 * size + 26
    for colour, text in states:
        out += [f'<rect x="{x:.1f}" y="{y}" width="24" height="14" fill="{colour}"/>', words(x + 30, y + 11, text, 12)]
        x += 50 + 6.2 * len(text)
    return out


STATES = ((UNSETTLED, "not settled after 600 µs"), (FAILED, "driven to within 35 nm of the electrode"))
WIDE, HIGH, APART = 244, 150, 22  # size of a map, and distance between two maps
LEFT, TOP = 96, 162


def of_level(level):
    return f"{level} V_dp"


def rows_of_maps(columns):
    """Returns maps of the three levels, one below the other. A column has a title, a drive, and a function from level and box to a map."""
    out = []
    for j, (title, d, make, first) in enumerate(columns):
        left = LEFT + sum(WIDE + APART + (62 if columns[i + 1][3] else 0) for i in range(j))
        out.append(words(left, TOP - 30, title, 13, colour=INK, more=BOLD))
        for i, level in enumerate(LEVELS):
            top = TOP + i * (HIGH + 52)
            box = (left, top, left + WIDE, top + HIGH)
            drawn, note = make(level, box)
            out += drawn + [words(left, top - 7, note, 12)]
            if first:
                out += amplitudes_beside(d, left, top, top + HIGH)
                out.append(words(left - 40, top + HIGH / 2, "amplitude (% of the level)", 11, "middle",
                                 more=f' transform="rotate(-90 {left - 40} {top + HIGH / 2})"'))
        out.append(words(left + WIDE / 2, TOP + 3 * (HIGH + 52) - 18, "frequency of the dither (krad/s)", 11, "middle"))
    return out


def picture(d, contact, maps, stepped):
    """Returns the maps of t_p and B_H of one drive and contact."""
    def column(title, key, ended):
        def make(level, box):
            step = stepped[d.name, level, contact]
            reference, least, most = step.range(T_P) if key == T_P else (step.nominal()[B_H],) * 3
            note = (f"{of_level(level)}: step {reference * 1e6:.0f} µs ({least * 1e6:.0f} to {most * 1e6:.0f})" if key == T_P
                    else f"{of_level(level)}: step {reference * 1e9:.0f} nm")
            return panel(maps[d.name, level, contact, ended], key, reference, TIMES_AND_HEIGHTS, d, level, box), note
        return make
    columns = [(f"{name}, {'ends at ' + str(d.end) + ' µs' if ended else 'never ends'}", d, column(name, key, ended), not k)
               for k, (name, key, ended) in enumerate((("t_p", T_P, False), ("t_p", T_P, True), ("B_H", B_H, False), ("B_H", B_H, True)))]
    natural = ", ".join(map(str, d.natural))
    width, y = LEFT + 4 * (WIDE + APART) + 4, TOP + 3 * (HIGH + 52) + 4
    return drawing(width, y + 48, [f"What {d.title} does to a switch that bounces: {contact} contact"], [
        "Permanent contact t_p and highest rebound B_H over those of the plain step of the same level: blue is better, orange worse.",
        f"Rings: the settings of Bognash 2019. Broken lines: natural frequencies ({natural} krad/s). The step's t_p is chaotic: "
        f"median and range of {STEPS}",
        f"runs within ±{100 * NEAR:g} % of the level, and colours of t_p within that range mean nothing. The scale of the amplitudes is uneven."],
        rows_of_maps(columns) + key_of(TIMES_AND_HEIGHTS, LEFT, y, "over the plain step", STATES))


def picture_of_contacts(maps, stepped):
    """Returns the maps of t_i and N_B of both drives, with a lossless contact."""
    def column(d, key, ended, scale):
        def make(level, box):
            step = stepped[d.name, level, "lossless"]
            reference = step.nominal()[T_I] if key == T_I else step.range(N_B)[0]
            note = f"{of_level(level)}: step {reference * 1e6:.1f} µs" if key == T_I else f"{of_level(level)}: step {reference:.0f}"
            return panel(maps[d.name, level, "lossless", ended], key, reference, scale, d, level, box), note
        return make
    columns = []
    for d in (ELECTRODE, PIEZO):
        columns += [(f"t_i, {d.short}", d, column(d, T_I, False, CONTACT_TIMES), True),
                    (f"N_B, {d.short}, never ends", d, column(d, N_B, False, TIMES_AND_HEIGHTS), False),
                    (f"N_B, {d.short}, ends at {d.end} µs", d, column(d, N_B, True, TIMES_AND_HEIGHTS), False)]
    width, y = LEFT + 6 * (WIDE + APART) + 66, TOP + 3 * (HIGH + 52) + 4
    return drawing(width, y + 92, ["What a dither does to first contact and to the number of rebounds: lossless contact"], [
        "First contact t_i and number of rebounds N_B over those of the plain step of the same level (of N_B the median of its runs, as chaotic as t_p).",
        "Left three columns: a dither of the electrode's voltage; right three: of the piezo's. Rings: the settings of Bognash 2019. "
        "Broken lines: natural frequencies.", "t_i is that of the dither that never ends."],
        rows_of_maps(columns) + key_of(CONTACT_TIMES, LEFT, y, "t_i over the plain step", STATES) +
        key_of(TIMES_AND_HEIGHTS, LEFT, y + 42, "N_B over the plain step", ()))


TEXT = """# Where a dither helps, and where it harms

The gold cantilevers under a step of 1.1, 1.25 or 1.5 V_dp (the level) with a sine on top, V(t) = level · (1 + p sin ωt), or with p · level · sin ωt on the piezo beside it, as in Bognash 2019:
amplitudes p up to 20 %, frequencies up to the second natural one, with the piezo to the third; dithers that never end, and dithers that end soon after the first contact, at {main_end} µs ({piezo_end} µs
with the piezo); the lossless contact of the scenes, and a plastic one (`elastic-plastic`, hardness 1.5 GPa). Switches and contacts are reconstructions. Whether the dithers of the thesis end, and with
which phase they begin, is not known.

- **A dither of the electrode that never ends does not settle the switch sooner.** In none of 6 maps does the best point stand the test below; nearest to it comes 20 % at 10 krad/s (plastic, 1.5 V_dp, 170 of
  208 µs), which raises the level for a while rather than shakes. Between 240 and 290 krad/s, near the first frequency of the beam with its tip pinned (286 krad/s at 0 V), 1 to 3 % are enough to keep it
  from settling; at 1.1 V_dp nearly everything from 4 % on is. It can lower the highest rebound: 465 to 235 nm by 6 % at 210 krad/s and 1.5 V_dp.
- **One that ends helps where it arrives with the right phase**: in a tongue at 140 to 150, 160 to 180 and 220 to 230 krad/s for the three levels. There B_H falls from 486, 496 and 465 nm to 35, 99 and
  115 nm, and t_p from 407, 313 and 269 µs to 260, 191 and 185 µs (medians of neighbours, beyond the range of the step); with a plastic contact as well. Beside the tongue B_H grows, up to 2.4 µm.
- **The thesis' setting for 1.25 V_dp lies in this tongue** (15 %, 180543 rad/s) if the dither begins with sin 0 and ends: B_H 496 to 154 nm and t_p 313 to 255 µs (209 to 266), with a plastic contact 528 to
  102 nm and 281 to 193 µs. Any end from 45 to 90 µs does (B_H at most 284 nm). Other phases give up to 1390 nm, and if it never ends the switch does not settle. The same dither harms at 1.1 V_dp
  (1022 nm); the one for 1.5 V_dp hardly matters (416 of 465 nm).
- **The piezo's dithers of the thesis harm at every level**, ended or not: the switch does not settle, or the beam is driven into the electrode. From 4 % on (where the shipped driver's 1 V ends: 4.0,
  3.6 and 3.0 % of the three levels) nearly every dither of the piezo does. What helps is slow and small: 1 to 2 % at 40 to 80 krad/s, hardly a period until contact, ended: t_p 487 to 324 and 360
  to 296 µs at 1.1 and 1.25 V_dp, nothing at 1.5.
- **Searched pulses do far better**, within the shipped drivers' limits: by the electrode no rebound, t_p 39 to 52 µs and impacts at 1.8 to 8.4 instead of 58 to 149 mm/s at every level and contact; by
  the piezo none and 53 and 32 µs at 1.1 and 1.25 V_dp, and 33 nm and 123 µs at 1.5. They are no less sensitive:
  ±{near} % brings small rebounds back (electrode: up to 44 nm, median t_p 42 to 156 µs; piezo: up to 199 nm, 141 to 303 µs).

t_p and N_B are chaotic: a number of points that settle sooner than the step says little, since of the step's own runs half settle sooner than their median. "Helps" below means that the median of the nine
neighbours of the best point is below the least of {steps} runs of the step. Of what was found by hand before, 5 % at 220 krad/s and 1.5 V_dp never ending (t_p 221 µs here, 252 before) and
5 % at 160 krad/s and 1.25 V_dp with a plastic contact (260 and 240) stand at the edge of and within what steps do by themselves (222 to 288, 234 to 294), though the former does lower B_H (293 of 465 nm).
B_H of a dither that ends is well-conditioned; of one that never ends it may be a rebound long after the first contact.

- made by `bench/run_dither_maps.py BUILD/apps/softland results`, {date}, revision {revision}
- one map: `softland explore scenes/mem-gold.toml {command}`; {points} points in all
- machine: {machine}; the machine was shared, and times are not measured
- not run to the end: the piezo with a plastic contact

![electrode, lossless contact](dither-maps-electrostatic-lossless.svg)

![electrode, plastic contact](dither-maps-electrostatic-plastic.svg)

![piezo, lossless contact](dither-maps-pzt-lossless.svg)

![first contact and number of rebounds](dither-maps-contacts.svg)

In the tables levels are in V_dp, times in µs, heights in nm, settings are amplitude and frequency in krad/s. Of neighbours and clouds stand median and range; a dash is what does not settle, or fails:
the beam comes within 35 nm of the electrode. "Shorter" and "lower" count points of the map.

## Time to permanent contact

| drive | contact | level | dither | points | not settled | failed | step's t_p | shorter than its median by 1 % | than its shortest by 1 % | best point | its neighbours | helps | longest |
|---|---|---|---|---|---|---|---|---|---|---|---|---|---|
{times}

The best find of each drive and contact, by `softland simulate --certify`: runs that differ by parts in 1e9.

| drive | contact | level | dither | setting | t_p | t_p of the step |
|---|---|---|---|---|---|---|
{certified}

## Highest rebound and number of rebounds

| drive | contact | level | dither | step's B_H | lower by 10 % | of them settled | lowest | its neighbours | highest | step's N_B | fewest of those settled |
|---|---|---|---|---|---|---|---|---|---|---|---|
{heights}

## First contact

Lossless contact, dithers that never end.

| drive | level | step's t_i | earlier by 1 % | later by 1 % | earliest | latest |
|---|---|---|---|---|---|---|
{contacts}

## The settings of the thesis

"Over phases": B_H for {phases} phases of the sine from 0 to 330 degrees; "over ends": for {ends} ends from 0.75 to 1.5 times the usual one.

| drive | contact | level | dither | setting | t_i, of the step's | t_p, neighbours | t_p of the step | B_H, of the step's | over phases | over ends | N_B, of the step's | state |
|---|---|---|---|---|---|---|---|---|---|---|---|---|
{thesis}

## What searched pulses reach

`softland optimize` with its default pulse and budget, within the shipped limits of the drivers (at 1.5 V_dp the electrode cannot go above its hold level, which the dithers here do). Neighbours of a
pulse: ±{near} % in its times, and in its volts or, of the piezo, in the electrode's level. "Best dither": median and range of the neighbours of the best point of both maps.

| drive | contact | level | step's t_p | best dither's t_p | pulse's t_p | its neighbours | step's B_H | lowest of a dither | pulse's B_H | its neighbours | v_i [mm/s], of the step's |
|---|---|---|---|---|---|---|---|---|---|---|---|
{pulses}
"""


def unit(value, factor, digits=0):
    return "-" if value is None or math.isinf(value) else f"{value * factor:.{digits}f}"


def spread_of(cloud, key, factor):
    """Returns median and range, with a dash for a run that does not settle or fails."""
    return "{} ({} to {})".format(*(unit(v, factor) for v in cloud.range(key)))


def at(setting):
    return f"{setting[0]:g} %, {setting[1]:.7g}"


class Study:
    """One map, with the plain step for comparison and the neighbours of its best settings."""

    def __init__(self, program, stores, d, level, contact, ended, step):
        self.d, self.level, self.contact, self.ended, self.step = d, level, contact, ended, step
        self.found = mapped(program, stores, d, level, contact, ended)
        self.settled = {s: row for s, row in self.found.items() if row[T_P] is not None}
        self.whole = {s: row for s, row in self.found.items() if row["status"] not in FAILS}
        by = lambda key: lambda s: self.found[s][key]
        self.soonest, self.lowest = sorted(self.settled, key=by(T_P))[:CANDIDATES], min(self.whole, key=by(B_H))
        of_thesis = [d.thesis[level]]
        settings = list(dict.fromkeys([*self.soonest, self.lowest, *(of_thesis if d.key == "main" else [])]))
        self.near = neighbours(program, stores, d, level, contact, ended, settings)
        if d.key == "piezo":  # far from any setting that helps: a few neighbours suffice
            self.near |= neighbours(program, stores, d, level, contact, ended, of_thesis, (1,))
        other = lambda what, values: Cloud(explored(program, stores / f"{label(d, level, contact, ended)}-{what}.sqlite", d.scene,
                                                    self.changes(d.thesis[level]), ["--vary", f"waveform.main.{what}={values}"]))
        self.phases = other("phase", f"0 deg:330 deg:{PHASES}") if d.key == "main" else None
        self.ends = other("end", f"{0.75 * d.end:g} us:{1.5 * d.end:g} us:{ENDS}") if d.key == "main" and ended else None
        self.surest = min(self.soonest, key=lambda s: self.near[s].range(T_P)[0], default=None)

    def changes(self, setting):
        a, f = setting
        replaced = [c.replace('amplitude = "1 %"', f'amplitude = "{a} %"').replace('"100 krad/s"', f'"{f} krad/s"')
                    for c in self.d.changes(self.level, self.ended)]
        return replaced + CONTACTS[self.contact]

    def name(self):
        return f"{self.d.short} | {self.contact} | {self.level} | {'ends' if self.ended else 'never ends'}"

    def helps(self):
        """True if half of the neighbours of the most reliable setting settle before every neighbour of the plain step."""
        return bool(self.surest) and self.near[self.surest].range(T_P)[0] < self.step.range(T_P)[1]

    def row_of_times(self):
        median, least, _ = self.step.range(T_P)
        shorter = sum(row[T_P] < 0.99 * median for row in self.settled.values())
        clearly = sum(row[T_P] < 0.99 * least for row in self.settled.values())
        last = max(self.settled, key=lambda s: self.settled[s][T_P], default=None)
        return (f"| {self.name()} | {len(self.found)} | {len(self.whole) - len(self.settled)} | {len(self.found) - len(self.whole)} | "
                f"{spread_of(self.step, T_P, 1e6)} | {shorter} | {clearly} | "
                + (f"{unit(self.settled[self.surest][T_P], 1e6)} at {at(self.surest)} | {spread_of(self.near[self.surest], T_P, 1e6)} | "
                   f"{'yes' if self.helps() else 'no'} | {unit(self.settled[last][T_P], 1e6)} at {at(last)} |" if last else "- | - | no | - |"))

    def row_of_heights(self):
        step = self.step.nominal()[B_H]
        lower = [s for s, row in self.whole.items() if row[B_H] < 0.9 * step]
        highest = max(self.whole, key=lambda s: self.whole[s][B_H])
        few = lambda rows, pick: pick(rows, key=lambda s: rows[s][N_B])
        rebounds = self.settled or self.whole
        return (f"| {self.name()} | {unit(step, 1e9)} | {len(lower)} | {sum(s in self.settled for s in lower)} | "
                f"{unit(self.found[self.lowest][B_H], 1e9)} at {at(self.lowest)} | {spread_of(self.near[self.lowest], B_H, 1e9)} | "
                f"{unit(self.whole[highest][B_H], 1e9)} at {at(highest)} | {spread_of(self.step, N_B, 1)} | "
                f"{rebounds[few(rebounds, min)][N_B]:.0f} at {at(few(rebounds, min))} |")

    def row_of_thesis(self):
        setting = self.d.thesis[self.level]
        cloud = self.near[setting]
        run_itself = cloud.nominal()
        step = self.step.nominal()
        state = "failed" if run_itself["status"] in FAILS else run_itself["status"].replace("_", " ")
        return (f"| {self.name()} | {at(setting)} | {unit(run_itself[T_I], 1e6, 1)} of {unit(step[T_I], 1e6, 1)} | "
                f"{spread_of(cloud, T_P, 1e6)} | {spread_of(self.step, T_P, 1e6)} | "
                f"{unit(run_itself[B_H], 1e9)} of {unit(step[B_H], 1e9)} | "
                f"{spread_of(self.phases, B_H, 1e9) if self.phases else ''} | {spread_of(self.ends, B_H, 1e9) if self.ends else ''} | {unit(run_itself[N_B], 1)} of {unit(step[N_B], 1)} | {state} |")


def row_of_contact(study):
    rows = {s: row for s, row in study.found.items() if row[T_I] is not None}
    first, last = (pick(rows, key=lambda s: rows[s][T_I]) for pick in (min, max))
    step = study.step.nominal()[T_I]
    return (f"| {study.d.short} | {study.level} | {unit(step, 1e6, 1)} | {sum(row[T_I] < 0.99 * step for row in rows.values())} | "
            f"{sum(row[T_I] > 1.01 * step for row in rows.values())} | {unit(rows[first][T_I], 1e6, 1)} at {at(first)} | "
            f"{unit(rows[last][T_I], 1e6, 1)} at {at(last)} |")


def row_of_pulse(program, stores, d, level, contact, studies):
    result, near = searched(program, stores, d, level, contact)
    step, pulse = result["baseline"]["metrics"], result["metrics"]
    own = [s for s in studies if (s.d, s.level, s.contact) == (d, level, contact) and s.surest]
    best = min(own, key=lambda s: s.near[s.surest].range(T_P)[0], default=None)
    low = min((s for s in studies if (s.d, s.level, s.contact) == (d, level, contact)), key=lambda s: s.found[s.lowest][B_H])
    return (f"| {d.short} | {contact} | {level} | {unit(best.step.range(T_P)[0], 1e6)} | {spread_of(best.near[best.surest], T_P, 1e6)} | "
            f"{unit(pulse[T_P], 1e6, 1)} | {spread_of(near, T_P, 1e6)} | {unit(step[B_H], 1e9)} | {unit(low.found[low.lowest][B_H], 1e9)} | "
            f"{unit(pulse[B_H], 1e9, 2)} | {spread_of(near, B_H, 1e9)} | {1e3 * pulse['impact_velocity_m_s']:.3g} of "
            f"{1e3 * step['impact_velocity_m_s']:.3g} |")


def row_of_certified(program, study):
    step_level = [f"waveform.main.level={study.level} Vdp", *CONTACTS[study.contact]]
    show = lambda c: "{} ({} to {})".format(*(unit(v, 1e6) for v in c))
    return (f"| {study.name()} | {at(study.surest)} | {show(certified(program, study.d, study.changes(study.surest)))} | "
            f"{show(certified(program, study.d, step_level))} |")


def report(program, stores, studies):
    pulses = [row_of_pulse(program, stores, d, level, contact, studies) for d, contact in PICTURES for level in LEVELS]
    sure = []
    for d, contact in PICTURES:
        gain = lambda s: s.near[s.surest].range(T_P)[0] / s.step.range(T_P)[0]
        sure.append(row_of_certified(program, min((s for s in studies if (s.d, s.contact) == (d, contact) and s.surest), key=gain)))
    one = next(s for s in studies if s.d.key == "main" and s.level == 1.25)
    words_of = lambda values: " ".join(f"'{v}'" if any(c in str(v) for c in ' {"') else str(v) for v in values)
    command = words_of([*setting(one.d.changes(one.level, one.ended)), *grid_options(one.d)])
    rows = lambda lines: "\n".join(lines)
    return TEXT.format(
        date=datetime.date.today(), revision=revision(), machine=machine(), command=command, points=sum(len(s.found) for s in studies),
        near=f"{100 * NEAR:g}", steps=STEPS, phases=PHASES, ends=ENDS, main_end=ELECTRODE.end, piezo_end=PIEZO.end, candidates=CANDIDATES,
        times=rows(s.row_of_times() for s in studies), heights=rows(s.row_of_heights() for s in studies),
        contacts=rows(row_of_contact(s) for s in studies if not s.ended and s.contact == "lossless"),
        thesis=rows(s.row_of_thesis() for s in studies), pulses=rows(pulses), certified=rows(sure))


def main():
    program, folder = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
    with tempfile.TemporaryDirectory() as temporary:
        stores = pathlib.Path(sys.argv[3] if len(sys.argv) > 3 else temporary)
        stepped = {(d.name, level, contact): steps(program, stores, d, level, contact)
                   for d, contact in PICTURES for level in LEVELS}
        studies = [Study(program, stores, d, level, contact, ended, stepped[d.name, level, contact])
                   for d, contact in PICTURES for level in LEVELS for ended in (False, True)]
        maps = {(s.d.name, s.level, s.contact, s.ended): s.found for s in studies}
        text = report(program, stores, studies)
    for d, contact in PICTURES:
        (folder / f"dither-maps-{d.name}-{contact}.svg").write_text(picture(d, contact, maps, stepped), encoding="utf-8")
    (folder / "dither-maps-contacts.svg").write_text(picture_of_contacts(maps, stepped), encoding="utf-8")
    (folder / "dither-maps.md").write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
