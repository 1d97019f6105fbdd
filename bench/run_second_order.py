#!/usr/bin/python3
"""Second-order statistics of a closing, with each parameter varied alone, at two step heights, as in Bognash's thesis (2019).

    bench/run_second_order.py BUILD/apps/softland results

Writes second-order.md and second-order.svg into the folder. Takes about four minutes on an idle core.
"""
import csv
import datetime
import json
import pathlib
import statistics
import subprocess
import sys
import tempfile

from drawing import BOLD, GRID, INK, PENS, drawing, line, words
from tables import machine, prefixed, revision

SCENE = pathlib.Path(__file__).resolve().parent.parent / "scenes" / "mem-gold.toml"
LEVELS = (1.25, 1.5)  # [Vdp of the nominal device]
SPREADS = (0.01, 0.02, 0.04)  # standard deviations of the parameter over its mean
DEVICES = 512
TOLERANCE = 1e-5  # tolerance of the integrator, as in `softland robustness`
VOLTAGE = "voltage"
PARAMETERS = {
    "asperity radius": ["contact.asperity_radius"],
    "asperity density": ["contact.asperity_density"],
    "pad length": ["contact.pad_length"],
    "modulus": ["structure.youngs_modulus", "contact.effective_modulus"],
    "width": ["structure.width"],
    "thickness": ["structure.thickness"],
    VOLTAGE: [],
}
FIGURES = {"t_i": ("initial_contact_time_s", "s"), "B_H": ("major_bounce_height_m", "m"), "v_i": ("impact_velocity_m_s", "m/s"),
           "t_p": ("permanent_contact_time_s", "s"), "N_B": ("bounce_count", "")}


def run(program, *words):
    done = subprocess.run([program, *words, "--quiet"], capture_output=True, text=True, check=False)
    if done.returncode not in (0, 4):
        sys.exit(f"{' '.join(map(str, words))}: exit status {done.returncode}\n{done.stderr}")
    return done.stdout


def step(volts):
    return ["--set", f"waveform.main.level={volts!r} V", "--set", f"driver.main.max_voltage={2 * volts!r} V"]


def spread_of(parameter, spread):
    return f'spread={{varied={{keys={json.dumps(PARAMETERS[parameter])}, distribution="normal", cov={spread!r}}}}}'


def devices(program, volts, parameter, spread):
    """Returns (parameter over its mean, figures by key) for each device, without the figures that a device does not have."""
    with tempfile.TemporaryDirectory() as folder:
        run(program, "robustness", SCENE, *step(volts), "--set", f"simulate.tolerance={TOLERANCE!r}", "--set",
            spread_of(parameter, spread), "--samples", str(DEVICES), "--out", folder)
        with open(pathlib.Path(folder, "devices.csv"), encoding="utf-8", newline="") as table:
            rows = list(csv.DictReader(table))
        drive = json.loads(pathlib.Path(folder, "robustness.json").read_text(encoding="utf-8"))["drives"][0]
    found = [(float(row["varied"]), {key: float(row[f"plain step: {key}"]) for key, _ in FIGURES.values()
                                     if row[f"plain step: {key}"]}) for row in rows]
    for key, _ in FIGURES.values():  # repeat the program's own statistics as a check
        own, ours = drive["figures"][key], figures(found, key)
        for name, value in (("mean", statistics.mean(ours)), ("standard_deviation", statistics.stdev(ours))):
            if not abs(own[name] - value) <= 1e-9 * abs(own["mean"]):
                sys.exit(f"{parameter}, {key}: the program's {name} is {own[name]}, that of its devices {value}")
    return found


def voltages(program, volts, spread):
    """Returns the same for the drive's voltage, which [spread] does not vary: closings at the middles of equally probable intervals."""
    found = []
    for k in range(DEVICES):
        factor = statistics.NormalDist(1, spread).inv_cdf((k + 0.5) / DEVICES)
        metrics = json.loads(run(program, "simulate", SCENE, *step(volts * factor), "--set",
                                 f"simulate.tolerance={TOLERANCE!r}", "--json", "-"))["metrics"]
        found.append((factor, {key: metrics[key] for key, _ in FIGURES.values() if metrics[key] is not None}))
    return found


def figures(sample, key):
    return [of_device[key] for _, of_device in sample if key in of_device]


class Statistics:
    """Statistics of one figure over the devices that have it."""

    def __init__(self, sample, key):
        values = figures(sample, key)
        self.mean, self.deviation = statistics.mean(values), statistics.stdev(values)
        self.variation = self.deviation / self.mean
        shares = statistics.quantiles(values, n=20, method="inclusive")
        self.low, self.median, self.high = shares[0], shares[9], shares[18]
        self.missing = len(sample) - len(values)


def steepest(sample):
    """Returns the interval of half a per cent of the parameter, within two deviations, in which B_H changes most: parameter and B_H at both ends."""
    key, most = FIGURES["B_H"][0], 2 * max(SPREADS)
    points = sorted((x, of_device[key]) for x, of_device in sample if key in of_device and abs(x - 1) <= most)
    best = None
    for i, (x, height) in enumerate(points):
        for other, height_there in points[i + 1:]:
            if other - x > 0.005:
                break
            if best is None or abs(height_there - height) > abs(best[1][1] - best[0][1]):
                best = ((x, height), (other, height_there))
    return best


def percent(value, digits=3):
    return f"{100 * value:.{digits}g} %"


def table(head, rows):
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


# ---- the picture

def ratios(samples, level, symbol, left, top, width):
    """Draws the deviation of the figure over that of the parameter, both relative, for each spread: if it grows, variances mislead."""
    height, label, most = 24 * len(PARAMETERS), 104, 6.0
    x = lambda ratio: left + label + (width - label - 12) * min(ratio, most) / most
    out = [words(left, top, f"{symbol} at {level:g} V_dp", 14, colour=INK, more=BOLD)]
    for tick in range(int(most) + 1):
        out += [line(x(tick), top + 12, x(tick), top + 12 + height), words(x(tick), top + 28 + height, tick, anchor="middle")]
    out.append(words(x(most / 2), top + 46 + height, "deviation of the figure over that of the parameter", anchor="middle"))
    for row, parameter in enumerate(PARAMETERS):
        y = top + 24 + 24 * row
        out.append(words(left + label - 10, y + 4, parameter, 12.5, "end", INK))
        found = [Statistics(samples[level, parameter, s], FIGURES[symbol][0]).variation / s for s in SPREADS]
        out.append(line(x(min(found)), y, x(max(found)), y, PENS[0][0], ' stroke-width="1.5"'))
        for size, ratio in zip((2.5, 4, 5.5), found):
            out.append(f'<circle cx="{x(ratio):.1f}" cy="{y:.1f}" r="{size}" fill="{PENS[0][0]}" fill-opacity="0.75"/>')
    return out


def courses(samples, level, left, top, width):
    """Draws B_H against the varied parameter."""
    height, margin, key = 230, 46, FIGURES["B_H"][0]
    drawn = ("thickness", VOLTAGE, "width", "modulus")
    most_x, most_y = 0.08, 1e-6
    x = lambda value: left + margin + (width - margin - 12) * (value - 1 + most_x) / (2 * most_x)
    y = lambda value: top + 34 + height * (1 - value / most_y)
    out = [words(left, top, f"B_H at {level:g} V_dp, against what varies", 14, colour=INK, more=BOLD)]
    at = left + margin
    for (colour, dash), parameter in zip(PENS, drawn):
        out += [line(at, top + 17, at + 24, top + 17, colour, f' stroke-width="2" stroke-dasharray="{dash or "none"}"'),
                words(at + 30, top + 21, parameter, 12.5, colour=INK)]
        at += 44 + 6.6 * len(parameter)
    for tick in range(-8, 9, 4):
        out += [line(x(1 + tick / 100), y(0), x(1 + tick / 100), y(most_y)),
                words(x(1 + tick / 100), y(0) + 17, f"{tick:+d}".replace("-", "−").replace("+0", "0"), anchor="middle")]
    for tick in range(0, 11, 2):
        out += [line(x(1 - most_x), y(tick * 1e-7), x(1 + most_x), y(tick * 1e-7)),
                words(left + margin - 8, y(tick * 1e-7) + 4, tick * 100, anchor="end")]
    out += [words(x(1), y(0) + 35, "change of the parameter (%)", anchor="middle"),
            words(left + 4, y(most_y / 2), "B_H (nm)", anchor="middle",
                  more=f' transform="rotate(-90 {left + 4:.1f} {y(most_y / 2):.1f})"')]
    for (colour, dash), parameter in zip(PENS, drawn):
        points = sorted((value, of_device[key]) for value, of_device in samples[level, parameter, max(SPREADS)]
                        if key in of_device and abs(value - 1) <= most_x)
        path = " ".join(f"{x(value):.1f},{y(min(height_there, most_y)):.1f}" for value, height_there in points)
        out.append(f'<polyline points="{path}" fill="none" stroke="{colour}" stroke-width="1.8" '
                   f'stroke-dasharray="{dash or "none"}" stroke-linejoin="round"/>')
    return out


def picture(samples, headline, explanation):
    width, column, gap = 900, 414, 28
    out = []
    for i, level in enumerate(LEVELS):
        left = 22 + i * (column + gap)
        out += ratios(samples, level, "t_i", left, 128, column)
        out += ratios(samples, level, "B_H", left, 386, column)
        out += courses(samples, level, left, 644, column)
    return drawing(width, 970, headline, explanation, out)


# ---- the table

def by_influence(samples, level, symbol, spread):
    """Returns the parameters with the resulting deviation of the figure, the most influential first."""
    key = FIGURES[symbol][0]
    found = {p: Statistics(samples[level, p, spread], key).variation for p in PARAMETERS}
    return sorted(found.items(), key=lambda item: -item[1])


def jump_words(found):
    ((x, before), (there, after)), level, parameter = found
    return (f"{100 * (after / before - 1):+.2g} % between {100 * (x - 1):+.1f} and {100 * (there - 1):+.1f} % of the {parameter} at "
            f"{level:g} V_dp ({prefixed(before, 'm')} to {prefixed(after, 'm')})")


def beside_the_thesis(samples):
    middle, large = SPREADS[1:]
    out = []
    for symbol in ("t_i", "B_H"):
        ranks = [f"at {level:g} V_dp " + ", ".join(f"{p} ({percent(v, 2)})" for p, v in by_influence(samples, level, symbol, middle)[:4])
                 for level in LEVELS]
        first = {p for level in LEVELS for p, _ in by_influence(samples, level, symbol, middle)[:2]}
        holds = "Holds" if first == {"width", VOLTAGE} else "In part" if first & {"width", VOLTAGE} else "Not here"
        out.append(f"- *Width and voltage dominate {symbol}.* {holds}: with {percent(middle)} of each, {'; '.join(ranks)}.")
    most = max(Statistics(samples[level, p, large], FIGURES[symbol][0]).variation
               for level in LEVELS for p in ("asperity radius", "asperity density") for symbol in ("t_i", "B_H"))
    out.append(f"- *Asperity radius and density do nothing.* {'Holds' if most < 0.01 else 'Not here'}: with {percent(large)} of "
               f"either, t_i and B_H vary by at most {percent(most, 2)}.")

    def relative(found):
        (_, before), (_, after) = found[0]
        return abs(after / before - 1)

    jumps = [(steepest(samples[level, p, large]), level, p) for level in LEVELS for p in PARAMETERS]
    of_width, of_any = max((j for j in jumps if j[2] == "width"), key=relative), max(jumps, key=relative)
    out.append(f"- *B_H jumps by half at 4 % of the width.* {'Holds' if relative(of_width) > 0.25 else 'Not of the width'}: its steepest "
               f"change within half a per cent is {jump_words(of_width)}; that of all parameters is {jump_words(of_any)}.")
    least = {symbol: min(Statistics(samples[level, p, SPREADS[0]], FIGURES[symbol][0]).variation
                         for level in LEVELS for p in PARAMETERS) for symbol in ("t_p", "N_B")}
    out.append(f"- Permanent contact and the number of rebounds are chaotic past the first rebounds: whatever varies by "
               f"{percent(SPREADS[0])}, asperities included, t_p varies by at least {percent(least['t_p'], 2)} and N_B by "
               f"{percent(least['N_B'], 2)}. Only what is above that tells parameters apart.")
    missing = sum(Statistics(sample, key).missing for sample in samples.values() for key, _ in FIGURES.values())
    if missing:
        out.append(f"- Of {len(samples) * DEVICES * len(FIGURES)} figures {missing} are missing, of devices that do not close or do "
                   "not settle in the window; they are left out.")
    return out


def document(samples, pull_in):
    small, middle, large = SPREADS
    times = f"{large / small:g} times"
    out = [f"""# Second-order statistics, each parameter alone

What chapter 4 of Bognash's thesis (2019, "Bouncing of MEM/NEM switches", University of Western Ontario) asks: how first contact t_i and
the highest rebound B_H of a plain step vary when one parameter is random. Here with `scenes/mem-gold.toml`, the gold cantilever that stands
in for its switch (a reconstruction: parameter tables and spreads of the thesis are not public), closed by steps of {LEVELS[0]:g} and
{LEVELS[1]:g} V_dp, in the volts of the nominal device (V_dp = {pull_in:.4f} V).

- made by `bench/run_second_order.py BUILD/apps/softland results`, {datetime.date.today()}, revision {revision()}
- machine: {machine()}

Every parameter is normal with standard deviations of {", ".join(map(percent, SPREADS))} of its mean, all others are as drawn;
{DEVICES} devices each, integrator tolerance {TOLERANCE:g}, window 600 us. The modulus is that of the beam and of its contact, by one factor. A row is

```sh
softland robustness scenes/mem-gold.toml --samples {DEVICES} --set simulate.tolerance={TOLERANCE!r} \\
  --set waveform.main.level="{LEVELS[0] * pull_in:.4f} V" --set driver.main.max_voltage="{2 * LEVELS[0] * pull_in:.4f} V" \\
  --set '{spread_of("width", middle)}'
```

but that of the voltage: {DEVICES} runs of `softland simulate`, with the levels in the middle of as many equally probable intervals.

![Influence of each parameter, and B_H against it](second-order.svg)
"""]
    for level in LEVELS:
        shares, quantiles = [], []
        for parameter in PARAMETERS:
            shares.append([parameter] + [percent(Statistics(samples[level, parameter, s], FIGURES[symbol][0]).variation, 2)
                                         for symbol in ("t_i", "B_H", "v_i") for s in SPREADS])
            cells = [parameter]
            for symbol, (key, unit) in FIGURES.items():
                s = Statistics(samples[level, parameter, middle], key)
                cells.append(f"{prefixed(s.mean, unit, 4)} ± {prefixed(s.deviation, unit)}" if unit else f"{s.mean:.0f} ± {s.deviation:.1f}")
                if symbol in ("t_i", "B_H"):
                    cells.append(" / ".join(prefixed(q, unit, 4) for q in (s.low, s.median, s.high)))
            quantiles.append(cells)
        out += [f"## {level:g} V_dp\n\nStandard deviation of the figures over their mean, where that of the parameter is "
                f"{', '.join(map(percent, SPREADS))}:\n",
                table(["varies"] + [f"{symbol}, {percent(s)}" for symbol in ("t_i", "B_H", "v_i") for s in SPREADS], shares), "",
                f"Where it is {percent(middle)}, mean ± standard deviation, and 5 / 50 / 95 % quantiles:\n",
                table(["varies", "t_i", "t_i, quantiles", "B_H", "B_H, quantiles", "v_i", "t_p", "N_B"], quantiles), ""]
    out.append(f"""## Where variances mislead

The largest change of B_H within half a per cent of the parameter, at most {100 * 2 * large:g} % away, and by how much the standard deviation of B_H
grows from {percent(small)} of the parameter to {percent(large)}: {times} where B_H is linear in it.
""")
    rows = []
    for level in LEVELS:
        for parameter in PARAMETERS:
            (x, before), (there, after) = steepest(samples[level, parameter, large])
            narrow, wide = (Statistics(samples[level, parameter, s], FIGURES["B_H"][0]).deviation for s in (small, large))
            rows.append([f"{level:g} V_dp", parameter, f"{prefixed(before, 'm')} at {100 * (x - 1):+.2f} %, {prefixed(after, 'm')} at "
                         f"{100 * (there - 1):+.2f} %", f"{100 * (after / before - 1):+.1f} %", f"{wide / narrow:.1f} times"])
    out += [table(["step", "varies", "steepest", "change", "deviation grows"], rows), "", "## Beside the thesis\n",
            *beside_the_thesis(samples)]
    return "\n".join(out) + "\n"


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    program, folder = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
    pull_in = json.loads(run(program, "pull-in", SCENE, "--json", "-"))["pull_in"]["dynamic_V"]
    samples = {}
    for level in LEVELS:
        for parameter in PARAMETERS:
            for spread in SPREADS:
                samples[level, parameter, spread] = (voltages(program, level * pull_in, spread) if parameter == VOLTAGE else
                                                     devices(program, level * pull_in, parameter, spread))
    (folder / "second-order.md").write_text(document(samples, pull_in), encoding="utf-8")
    first, second = (p for p, _ in by_influence(samples, LEVELS[0], "t_i", SPREADS[1])[:2])
    (folder / "second-order.svg").write_text(picture(
        samples, [f"{first.capitalize()} and {second} decide when a step closes the gold cantilever"],
        [f"Each parameter alone, normal, with standard deviations of {', '.join(map(percent, SPREADS))} (small to large dots); {DEVICES} devices each.",
         "Where the dots of a row differ, the figure is not linear in the parameter, and its variance depends on the spread."]),
        encoding="utf-8")


if __name__ == "__main__":
    main()
