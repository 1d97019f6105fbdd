#!/usr/bin/python3
"""Bounces of published switches, simulated beside what their measurements say.

    bench/run_published_bounce.py BUILD/apps/softland results

Writes published-bounce.md and published-bounce.svg into the folder. Takes one to three minutes.
"""
import csv
import datetime
import functools
import json
import math
import pathlib
import subprocess
import sys
import tempfile

from drawing import BOLD, GRID, INK, MUTED, PENS, drawing, line, words
from tables import machine, prefixed, revision

SCENES = pathlib.Path(__file__).resolve().parent.parent / "scenes"
ACTUATOR, PLATE = SCENES / "published" / "gap-closing-bounce.toml", SCENES / "two-electrodes.toml"

# The authors' scripts give these times [us] of their two traces: the arrows of the closing, and the windows in which they look for a bounce.
CLOSING, CLOSING_BOUNCE = 60.1, (65, 70)
OPENING_LATEST, OPENING_BOUNCE = 30, (30, 60)
ALIGNED = ((76.5, 4.0), (61.2, 4.0))  # overlap and width of the springs [um] with which their own simulation "aligns well with data"
SERIES = [(length, 3.0) for length in (15.3, 22.95, 30.6, 38.25, 45.9, 53.55, 61.2, 68.85, 76.5)]
SERIES += [(76.5, width) for width in (3.5, 4.0, 4.5, 5.0, 5.5)] + [(61.2, 4.0)]
OPENINGS = ((15.3, 40, 23.57), (15.3, 60, 21.73), (45.9, 25, 38.73), (45.9, 60, 32.70), (76.5, 20, 68.03), (76.5, 60, 52.5))  # um, V, us
STOPS = ("3e4", "3e5", "1e6")  # stiffness of the stops [N/m] beside the scene's 1e5
SEEN = 1e-3  # height from which a rebound counts [um], as in the scene
OPENED_FROM = 50  # [V], as in the authors' script of the bounces
BLECKE = 0.20  # [m/s]


def simulate(program, scene, settings, folder=None):
    command = [program, "simulate", scene, "--json", "-", "--quiet"]
    for key, value in settings.items():
        command += ["--set", f"{key}={value}"]
    done = subprocess.run([*command, *(["--out", folder] if folder else [])], capture_output=True, text=True, check=False)
    if not done.stdout:
        sys.exit(f"{' '.join(map(str, command))}: exit status {done.returncode}\n{done.stderr}")
    return json.loads(done.stdout)


# ---- the gap-closing actuators


def actuator(length, width, etch=0.4):
    """Returns the settings that make the scene an actuator of this overlap, width of the springs and depth of the etch per edge, all in um."""
    modulus, layer, density = 169e9 / (1 - 0.069**2), 40e-6, 2300
    length, width, u = length * 1e-6, width * 1e-6, etch * 1e-6
    finger, hole, spring, facing = 5.01e-6 - 2 * u, 8e-6 + 2 * u, width - 2 * u, length - u
    area = (20e-6 - 2 * u) * (860e-6 - 2 * u) - 61 * hole**2 + 2 * (10e-6 - 2 * u) * (45e-6 - u) + 70 * (facing + 10e-6) * finger
    return {"structure.mass": f"{density * layer * (area + 26 / 35 * spring * 241e-6)!r} kg",
            "structure.stiffness": f"{2 * modulus * (spring / 241e-6)**3 * layer!r} N/m", "structure.area": f"{70 * facing * layer!r} m^2",
            "structure.thickness": f"{finger!r} m", "gas.film_length": f"{facing!r} m", "gas.slit_length": f"{finger / 2!r} m",
            "gap.electrode": f"{4.83 + 2 * etch!r} um", "electrode.main.gap": f"{7.75 + 2 * etch!r} um", "gas.far_gap": f"{7.75 + 2 * etch!r} um",
            "contact.stop.gap": f"{3.83 + 2 * etch!r} um", "driver.main.max_voltage": "200 V"}


def stops(stiffness):
    return {"contact.stop.stiffness": f"{stiffness} N/m", "contact.back.stiffness": f"{stiffness} N/m"}


def course(program, settings):
    """Returns times [us] and contact gaps [um] of a run."""
    with tempfile.TemporaryDirectory() as folder:
        simulate(program, ACTUATOR, settings, folder)
        with open(pathlib.Path(folder, "trajectory.csv"), encoding="utf-8", newline="") as table:
            rows = list(csv.DictReader(table))
    return [float(row["time_s"]) * 1e6 for row in rows], [float(row["tip_gap_m"]) * 1e6 for row in rows]


def touches(times, gaps, plane, outwards):
    """Returns the times at which the gap passes the plane, outwards or inwards."""
    side = [gap - plane if outwards else plane - gap for gap in gaps]
    return [t + (0 - s) / (later - s) * (after - t) for t, after, s, later in zip(times, times[1:], side, side[1:]) if s < 0 <= later]


def bounces_end(times, gaps):
    """Returns the times at which the stop is touched first, and again after each rebound above SEEN."""
    ends = touches(times, gaps, 0, False)
    begun = ends[:1]
    for begin, end in zip(ends, ends[1:]):
        if max(gap for t, gap in zip(times, gaps) if begin <= t <= end) >= SEEN:
            begun.append(end)
    return begun


def closing(program, settings, volts):
    return course(program, {**settings, "waveform.main.level": f"{volts!r} V"})


def opening(program, settings, volts=OPENED_FROM):
    return course(program, {**settings, "waveform.main.before": f"{volts!r} V", "waveform.main.before_state": "closed", "waveform.main.level": "0 V"})


def voltage(program, settings, time):
    """Returns the voltage [V] of the step with which the actuator first touches its stop at the time [us]."""
    low, high = 5.0, 200.0
    while high - low > 1e-3:
        volts = (low + high) / 2
        touch = simulate(program, ACTUATOR, {**settings, "waveform.main.level": f"{volts!r} V"})["metrics"]["initial_contact_time_s"]
        low, high = (volts, high) if touch is None or touch * 1e6 > time else (low, volts)
    return high


class Bounces:
    """Touches of both stops [us]: of an opening from its begin, of a closing in CLOSING us from its first touch."""

    def __init__(self, program, settings, opened_from=OPENED_FROM, back=1e-3):
        plane = float(settings["contact.stop.gap"].split()[0])
        self.volts = voltage(program, settings, CLOSING)
        self.closing = closing(program, settings, self.volts)
        self.opening = opening(program, settings, opened_from)
        of_stop = bounces_end(*self.closing)
        self.stop = [t - of_stop[0] for t in of_stop]
        self.back = touches(*self.opening, plane + back, True)

    def first_in_window(self):
        return self.back[0] < OPENING_LATEST

    def second_in_window(self):
        return OPENING_BOUNCE[0] <= self.back[1] <= OPENING_BOUNCE[1]

    def closing_in_window(self):
        return any(CLOSING_BOUNCE[0] <= CLOSING + t <= CLOSING_BOUNCE[1] for t in self.stop)

    def flights(self):
        return ", ".join(f"{t:.1f}" for t in self.stop[1:4]) + (" ..." if len(self.stop) > 4 else "")


def yes(is_so):
    return "yes" if is_so else "no"


def beside(value, window):
    low, high = window
    return "inside" if low <= value <= high else f"{low - value:.1f} us early" if value < low else f"{value - high:.1f} us late"


def variants():
    nominal = actuator(*ALIGNED[0])
    yield "as the scene", nominal, {}
    for stiffness in STOPS:
        yield f"stops of {stiffness} N/m", {**nominal, **stops(stiffness)}, {}
    for restitution in (0.8, 0.5):
        unloading = 1e5 / restitution**2
        law = f'model="hysteretic",stiffness="1e5 N/m",unloading_stiffness="{unloading!r} N/m"'
        yield (f"stops with a restitution of {restitution:g}",
               {**nominal, "contact.stop": f'{{gap="4.63 um",{law}}}', "contact.back": f'{{side="far",gap="1 nm",{law}}}', "contact.stop.gap": "4.63 um"}, {})
    for beyond in (0.2, 0.8):
        yield f"back stop {beyond:g} um beyond rest", {**nominal, "contact.back.gap": f"{beyond!r} um"}, {"back": beyond}
    for etch in (0.3, 0.5):
        yield f"etch of {etch:g} um per edge", actuator(*ALIGNED[0], etch), {}
    yield "opened from 30 V", nominal, {"opened_from": 30}


# ---- the plate switch


def plates(program):
    """Yields contact, step and figures of the plate, closed by its lower electrode alone."""
    contacts = {"rigid, restitution 0.53": 'contact={model="rigid",restitution=0.5266}',
                "spring of 2e4 N/m, restitution 0.53": 'contact={model="hysteretic",stiffness="2e4 N/m",unloading_stiffness="72117 N/m"}',
                "rigid, restitution 0.1": 'contact={model="rigid",restitution=0.1}'}
    for name, setting in contacts.items():
        key, _, value = setting.partition("=")
        for level in ("1 Vsp", "1.25 Vdp"):
            settings = {"waveform.upper": '{family="step",level="0 V"}', key: value, "waveform.main.level": level}
            yield name, level, simulate(program, PLATE, settings)["metrics"]


# ---- the page


def table(head, rows):
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def panel(curves, window, axes, box, title, label):
    """Draws courses over time with the measured window shaded; an axis is its end, its ticks and its label."""
    left, top, right, bottom = box
    (wide, across, below), (high, up, beside_it) = axes
    x, y = lambda t: left + (right - left) * t / wide, lambda g: bottom - (bottom - top) * g / high
    out = [words(left, top - 32, title, 14, colour=INK, more=BOLD),
           f'<rect x="{x(window[0]):.1f}" y="{top}" width="{x(window[1]) - x(window[0]):.1f}" height="{bottom - top}" fill="{GRID}"/>',
           words((x(window[0]) + x(window[1])) / 2, top + 16, label, 11, "middle")]
    for tick in across:
        out += [line(x(tick), bottom, x(tick), bottom + 4, MUTED), words(x(tick), bottom + 18, f"{tick:g}", 11, "middle")]
    for tick in up:
        out += [line(left, y(tick), right, y(tick)), words(left - 6, y(tick) + 4, f"{tick:g}", 11, "end")]
    out += [words((left + right) / 2, bottom + 36, below, 12, "middle"), words(left - 30, top - 12, beside_it, 12)]
    for k, (name, times, heights) in enumerate(curves):
        colour, dashes = PENS[k]
        points = " ".join(f"{x(t):.1f},{y(max(0, h)):.1f}" for t, h in zip(times, heights) if 0 <= t <= wide)
        out.append(f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="1.8"' + (f' stroke-dasharray="{dashes}"' if dashes else "") + "/>")
        out += [line(left + 4, bottom + 56 + 18 * k, left + 34, bottom + 56 + 18 * k, colour, ' stroke-width="2"' + (f' stroke-dasharray="{dashes}"' if dashes else "")),
                words(left + 42, bottom + 60 + 18 * k, name, 12)]
    return out


def named(length, width):
    return f"overlap {length:g} um, springs {width:g} um"


def picture(found):
    opened = [(named(*one), found[one].opening[0], [4.63 - g for g in found[one].opening[1]]) for one in ALIGNED]
    closed = []
    for one in (ALIGNED[0], ALIGNED[1], (30.6, 3.0), (22.95, 3.0)):
        begin = touches(*found[one].closing, 0, False)[0]
        closed.append((named(*one), [t - begin for t in found[one].closing[0]], [1e3 * g for g in found[one].closing[1]]))
    after = [t - CLOSING for t in CLOSING_BOUNCE]
    parts = panel(opened, OPENING_BOUNCE, ((120, range(0, 121, 20), "time since the voltage fell [us]"), (5, range(6), "distance to the back stop [um]")),
                  (70, 130, 480, 330), "Opening", "second touch measured")
    parts += panel(closed, after, ((12, range(0, 13, 2), "time since the first touch [us]"), (500, range(0, 501, 100), "distance to the stop [nm]")),
                   (560, 130, 970, 330), "Closing in 60.1 us", "a touch measured")
    return drawing(1000, 470, ["Bounces of gap-closing actuators: simulated courses, and where the measured traces touch"],
                   ["Measured by Rauf et al. (2022); the text does not say which actuator the traces belong to. Nothing is fitted."], parts)


def page(found, varied, opened, landed):
    first, second = (found[one] for one in ALIGNED)
    after = tuple(t - CLOSING for t in CLOSING_BOUNCE)

    def last(bounces):
        return f"{bounces.stop[-1]:.1f} us"

    plain = next(m for name, level, m in landed if name.startswith("rigid, restitution 0.53") and level == "1 Vsp")
    sprung = next(m for name, level, m in landed if name.startswith("spring") and level == "1 Vsp")
    summary = [["opening: back stop first touched", f"before {OPENING_LATEST} us", f"{first.back[0]:.1f} us", beside(first.back[0], (0, OPENING_LATEST)),
                f"{second.back[0]:.1f} us", beside(second.back[0], (0, OPENING_LATEST))],
               ["opening: touched again", "30 to 60 us", f"{first.back[1]:.1f} us", beside(first.back[1], OPENING_BOUNCE), f"{second.back[1]:.1f} us",
                beside(second.back[1], OPENING_BOUNCE)],
               ["closing: stop first touched", f"{CLOSING} us", "chosen so", "-", "chosen so", "-"],
               ["closing: a touch that ends a bounce, after the first", f"{after[0]:.1f} to {after[1]:.1f} us", f"the last one {last(first)}",
                beside(first.stop[-1], after), f"the last one {last(second)}", beside(second.stop[-1], after)]]
    rows = [[f"{length:g}", f"{width:g}", f"{b.back[0]:.1f}", yes(b.first_in_window()), f"{b.back[1]:.1f}", yes(b.second_in_window()), f"{b.volts:.1f}",
             b.flights(), yes(b.closing_in_window())] for (length, width), b in found.items()]
    both = [one for one, b in found.items() if b.first_in_window() and b.second_in_window()]
    closers = [one for one, b in found.items() if b.closing_in_window()]
    everything = [one for one in both if one in closers]
    shorter = 52.5 / opened[76.5, 60][0]
    changes = [[name, f"{b.back[0]:.1f}", f"{b.back[1]:.1f}", f"{b.back[1] - b.back[0]:.1f}", f"{b.volts:.1f}", b.flights() or "-", yes(b.closing_in_window())]
               for name, b in varied]
    openings = [[f"{length:g}", f"{volts:g}", f"{said:g}"] + [cell for simulated in opened[length, volts]
                                                             for cell in (f"{simulated:.2f}", f"{100 * (simulated / said - 1):+.1f} %")]
                for length, volts, said in OPENINGS]
    lands = [[name, level, prefixed(m["impact_velocity_m_s"], "m/s"), prefixed(m["major_bounce_height_m"] or 0, "m"), prefixed(m["first_rebound_time_s"] or 0, "s"),
              prefixed(m["permanent_contact_time_s"] - m["initial_contact_time_s"], "s")] for name, level, m in landed]
    list_of = lambda some: ", ".join(f"{length:g}/{width:g}" for length, width in some) or "none"
    return f"""# Bounces: simulated against measured

    bench/run_published_bounce.py BUILD/apps/softland results

No open text that was found gives one named switch with its drive and its measured bounce. Two measurements come with a device that can be rebuilt, and
each is compared as far as its text goes: oscilloscope traces of silicon actuators, and the landings of Sandia's plate switch. Measured openings take
the place of what is missing. No number is tuned to a bounce; the voltage of a closing is chosen by its measured duration.

- made by the command above, {datetime.date.today()}, on top of revision {revision()}
- machine: {machine()}

![Simulated openings and closings, and the measured windows](published-bounce.svg)

## Gap-closing actuators of Rauf et al.

`scenes/published/gap-closing-bounce.toml`: overlap 76.5 um, springs of 4 um. The second actuator has an overlap of 61.2 um.

{table(["bounce", "measured", "76.5 um", "", "61.2 um", ""], summary)}

**What was measured.** The traces are binary files. The scripts that plot them were read (github ahadrauf/gca_dynamics):

- The arrow "Pull-in Time" ends at 0.7539 of an axis from -14.5 to 84.5 us: {CLOSING} us. "Switch Bounce" is the peak of the sensed voltage from 65 to 70 us.
- On opening, "Signal Drop" lies before 30 us. "Switch Bounce" is the peak from 30 to 60 us.
- The sensed voltage rises while the contact is open and drops at a touch (`sim_switchbounce.py`). A peak is therefore the end of a bounce.
- The text names no actuator. `sim_switchbounce.py` says of its own simulation: "61.2 and 4.0 align well with data", "so [do] 76.5 and 4.0".

**What differs, and why.**

- **Opening.** The first bounce lasts {first.back[1] - first.back[0]:.1f} us at 76.5 um and {second.back[1] - second.back[0]:.1f} us at 61.2 um: half a period of free vibration, whatever the stop gives back. The
  first touch comes late at 76.5 um. Bent fingers push the spine off, which is not modelled. An opening shorter by the factor of the springs of 3 um,
  {shorter:.2f} (below), would touch at {shorter * first.back[0]:.1f} and {shorter * first.back[0] + first.back[1] - first.back[0]:.1f} us, inside both windows.
- **Closing.** The simulated bounce is over before the measured one ends. It depends on the stops, of which only the size is published: stiffer ones bounce
  longer, soft or lossy ones less or not at all. {"None" if not any(b.closing_in_window() for _, b in varied) else "One"} of the changes below brings it into the window. The two arms of a stop, 9.2 x 44.6 um, yield by 3e4 N/m together
  if they are hit at their ends. Fingers and spine are rigid here; real fingers vibrate after the impact and can open the contact again.
- **Another actuator.** Both touches of an opening are inside their windows for {list_of(both)} (overlap/springs in um). A touch of the closing is inside for
  {list_of(closers)}. No actuator has all three{f" but {list_of(everything)}" if everything else ""}.
- **Verdict.** The opening of either actuator that the authors name is within {max(first.back[1], second.back[1]) - OPENING_BOUNCE[1]:.1f} us of its windows. The closing of neither is inside; those of
  {len(closers)} actuators with a shorter overlap and softer springs are. The text decides neither, for want of the actuator, its voltage and its stops.

### Every actuator of the series

Times in us; those of a closing count from its first touch, and rebounds from 1 nm on count. Springs of 2 and 2.5 um open later still.

{table(["overlap [um]", "springs [um]", "first back touch", "before 30", "second", "30 to 60", "closing [V]", "bounces end after", "4.9 to 9.9"], rows)}

### What was not published, varied

Overlap 76.5 um, springs of 4 um. The voltage of every closing is again that of a first touch at {CLOSING} us.

{table(["change", "first back touch [us]", "second [us]", "bounce lasts [us]", "closing [V]", "its bounces end after [us]", "4.9 to 9.9"], changes)}

The scene has lossless stops of 1e5 N/m, the back one at rest, as the authors' script has elastic ones there.

### Openings measured

Time from the fall of the voltage to the rest position, springs of 3 um, as published with the paper.

{table(["overlap [um]", "from [V]", "measured [us]", "stops of 1e5 N/m", "", "stops of 1e6 N/m", ""], openings)}

Measured openings from a higher voltage are shorter. Bent fingers give back their energy, which grows with overlap and voltage and is not modelled. A stop that was
pressed in gives back some too: the softer it is, the shorter the opening.

## Sandia's plate switch

Measured by Blecke, Epp, Sumali & Parker, J. MEMS 18(2) (2009) 458 (abstract): after 5 to 10 learned closings three switches land at no more than {BLECKE:.2f} m/s, "eliminating
bounce". The plate is `scenes/two-electrodes.toml` with its upper electrode at 0 V: mass, stiffness, area, gap, travel and damping are those that Rahim & Younis
(2016, Table 1) give for a plate switch after Sandia's. A plain step to its pull-in voltage lands it at {plain["impact_velocity_m_s"]:.3f} m/s.

{table(["contact", "step", "impact", "highest rebound", "first rebound lasts", "touches go on for"], lands)}

**What differs, and why.** The measured switches do not bounce at {BLECKE:.2f} m/s; the rebuilt one does, by {prefixed(sprung["major_bounce_height_m"], "m")} to
{prefixed(plain["major_bounce_height_m"], "m")} with the published damping in contact.

- The published contact, 61 kHz and a damping ratio of 0.2, is a spring of 312 N/m. It does not hold the plate off the electrode at any voltage that closes the switch, so that
  a stiff contact with the restitution of that damping ratio, 0.53, stands in. A contact that adheres or yields gives back less, as the rows with 0.1 show.
- {BLECKE:.2f} m/s is an upper limit over all landings, and the text that was read does not say how short an opening of the contact can be and still count as a bounce.
- The hold voltage, whose force ends a rebound, is not in the text. The plain step at 1.25 V_dp shows what a higher one does together with a faster landing.

## Bounces that cannot be compared

| publication | what was read | what is missing |
|---|---|---|
| Blecke et al. 2009; Allen, Massad & Field, IMECE2006-13175; Tung et al. 2014 | first page | dimensions, drive, bounce times; of Tung: bounces of about 0.1 and 10 us |
| McCarthy et al. 2002; Guo et al. 2007; Decuzzi et al. 2006; Do et al. 2011 | abstract | dimensions, times |
| Northeastern microswitch (lecture slides) | plan view: 152, 63, 44, 24 um; contact tips of 2 um | thickness, gaps, voltage, the curves of "comparison of model and experiment" |
| Czaplewski et al. 2006; Sumali et al. 2007 | title | everything |
| Steeneken et al. 2005, capacitive switch | abstract: bounce on closing at low pressure | dimensions, pressure, times |
| Fruehling et al. 2012, Omron 2SMES-01 | abstract: the first bounce lasts up to 20 % longer after 200 million cycles | dimensions, times in seconds |
| Peschot et al. 2012 | abstract: contacts that approach at nm/s open again; at 1 um/s they do not | the switch; attraction by the contact's own voltage is not in softland |
| Northeastern opening times, TRIB2004 41812/75 | abstract | numbers |
"""


def main():
    program, folder = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
    found = {one: Bounces(program, actuator(*one)) for one in SERIES}
    varied = [(name, Bounces(program, settings, **more)) for name, settings, more in variants()]
    opened = {(length, volts): [touches(*opening(program, {**actuator(length, 3.0), **stops(stiffness)}, volts), 4.63 + 1e-3, True)[0]
                                for stiffness in ("1e5", "1e6")] for length, volts, _ in OPENINGS}
    (folder / "published-bounce.md").write_text(page(found, varied, opened, list(plates(program))), encoding="utf-8")
    (folder / "published-bounce.svg").write_text(picture(found), encoding="utf-8")


main()
