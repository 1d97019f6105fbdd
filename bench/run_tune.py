#!/usr/bin/python3
"""Measures the tuning by the contact on devices that no belief has seen.

    bench/run_tune.py BUILD/bench/bench_tune results FOLDER

Writes tune.md into results, and the output of every case into FOLDER. A case with an output there is not run again. Takes two to
three hours.
"""
import datetime
import pathlib
import re
import subprocess
import sys

from tables import machine, revision

WRONG = ("--devices", "8", "--closings", "8", "--first-device", "3001")
SHORT = ("--devices", "8", "--closings", "4", "--first-device", "3001")
PLATE = ("--modes", "0", "--devices", "12", "--closings", "6", "--first-device", "5001")
BASELINE = ("--devices", "40", "--first-device", "1001")
GOLD = ("gold", "mem-gold", ("--devices", "200", "--first-device", "1001"))
BASELINES = (("knob", "one knob: all volts times s", (*BASELINE, "--method", "knob")),
             ("secant", "secant on the length of the pulse", (*BASELINE, "--method", "secant")),
             ("nelder-mead", "Nelder-Mead on pulse and coast", (*BASELINE, "--method", "nelder-mead")))
CASES = (("both", "mem-gold-pzt, both drives, quasi-static", ("--scene", "mem-gold-pzt.toml", "--actuator", "both", "--devices", "12", "--first-device", "2001")),
         ("two-electrodes", "two-electrodes, below 26 nm (a hundredth of the travel) and 1 nm",
          ("--scene", "two-electrodes.toml", *PLATE, "--good", "26e-9")),
         ("pzt", "mem-gold-pzt, piezo alone, quasi-static", ("--scene", "mem-gold-pzt.toml", "--actuator", "pzt", "--devices", "10", "--closings", "6", "--first-device", "5001")),
         ("bridge", "nickel bridge between two clamps, below 15 nm (a hundredth of the travel) and 1 nm",
          ("--scene", "nickel-bridge.toml", "--devices", "10", "--closings", "6", "--first-device", "5001", "--good", "15e-9")),
         ("plate", "plate of the two-electrodes scene, closed by its lower electrode alone, below 26 nm (a hundredth of the travel) and 1 nm",
          ("--scene", "plate-switch.toml", *PLATE, "--good", "26e-9")),
         ("gap-closing", "gap-closing-actuator", ("--scene", "gap-closing-actuator.toml", *PLATE)),
         ("nem", "nem-tin, edges to 20 ps, openings below 40 ps unseen, below 0.1 and 0.01 nm",
          ("--scene", "nem-tin.toml", "--devices", "8", "--closings", "6", "--edge-error", "2e-11", "--unseen", "4e-11", "--first-device", "5001",
           "--good", "1e-10", "--very-good", "1e-11")),
         ("veijola", "the device has gas veijola", ("--devices", "10", "--closings", "8", "--first-device", "3001", "--gas", "veijola")),
         ("stiffness", "its contact is stiffer by 10 %", (*WRONG, "--stiffness", "1.1")),
         ("six", "veijola, stiffness +10 %, contact gap alone +1.5 %, damping ratio 0.002, electrode shifted by 0.5 um, at once",
          (*WRONG, "--gas", "veijola", "--stiffness", "1.1", "--model-set", "gap.contact=2.03 um", "--model-set",
           "structure.damping_ratio=0.002", "--model-set", 'electrode.main.span=["60.5 um","240.5 um"]')),
         ("ratio8", "its contact gap alone is wider by 8 %",
          ("--devices", "10", "--closings", "8", "--first-device", "3001", "--model-set", "gap.contact=2.16 um")),
         ("edge200", "edges to 200 ns, openings below 400 ns unseen", (*SHORT, "--edge-error", "200e-9", "--unseen", "400e-9")),
         ("shot01", "gain 0.1 % from shot to shot", (*SHORT, "--shot-error", "0.001")))
LATE = ("--devices", "16", "--closings", "4", "--first-device", "7001")
LATES = (("late-none", "0 s, expected 2 us", LATE), ("late-1us", "1 us, expected 2 us", (*LATE, "--late", "1e-6")),
         ("late-known", "0 s, known to be 0 s", (*LATE, "--trigger-delay", "0")),
         ("late-denied", "1 us, believed to be 0 s", (*LATE, "--late", "1e-6", "--trigger-delay", "0")))
RATIO = ("--devices", "40", "--closings", "8", "--first-device", "7001")
RATIOS = (("ratio-right", "as the scene", RATIO), ("ratio-wrong", "its contact gap alone is wider by 8 %", (*RATIO, "--model-set", "gap.contact=2.16 um")))
IN_TIME = ("in-time", "", ("--devices", "12", "--closings", "4", "--first-device", "9001", "--most-volts", "1.03", "--constrain",
                           "initial_contact_time < 33 us"))
DRIFT = ("drift", "", ("--devices", "12", "--closings", "6", "--drift-of-1000", "0.01", "--first-device", "4001"))


NICKEL_BRIDGE = """title = "Nickel bridge, ohmic contact at the centre"

[structure]
kind = "clamped-clamped"
length = "400 um"
width = "60 um"
plate_strain = true
poissons_ratio = 0.31
thickness = "2 um"
youngs_modulus = "190 GPa"
density = "8900 kg/m^3"
residual_stress = "20 MPa"
modes = 5

[gap]
electrode = "2.5 um"
contact = "1.5 um"

[electrode.main]
span = ["50 um", "350 um"]

[gas]
model = "strip"

[contact]
model = "asperity-uniform"
pad_length = "10 um"
asperity_radius = "100 nm"
asperity_density = "1e12 1/m^2"
asperity_height = "100 nm"
effective_modulus = "60 GPa"

[waveform.main]
family = "step"
level = "1.25 Vdp"

[driver.main]
max_voltage = "1.5 Vdp"

[spread]
"structure.thickness" = { distribution = "normal", cov = "3 %" }
"structure.youngs_modulus" = { distribution = "normal", cov = "3 %" }
"structure.residual_stress" = { distribution = "normal", standard_deviation = "5 MPa" }
gaps = { keys = ["gap.electrode", "gap.contact"], distribution = "normal", cov = "3 %" }
"""


def write_scenes(folder):
    """Writes scenes that are not shipped: a bridge, and the plate of two-electrodes.toml without its upper electrode."""
    (folder / "nickel-bridge.toml").write_text(NICKEL_BRIDGE, encoding="utf-8")
    shipped = pathlib.Path(__file__).parent.parent / "scenes" / "two-electrodes.toml"
    sections = re.split(r"(?m)^(?=\[)", shipped.read_text(encoding="utf-8"))
    kept = [one for one in sections if not re.match(r"\[(electrode|waveform|driver)\.upper\]", one)]
    (folder / "plate-switch.toml").write_text("".join(kept), encoding="utf-8")


def output(program, folder, case):
    name, _, arguments = case
    arguments = [str(folder / one) if one.endswith(".toml") and (folder / one).exists() else one for one in arguments]
    path = folder / f"{name}.txt"
    if not path.exists():
        done = subprocess.run([program, *arguments], capture_output=True, text=True, check=False)
        if done.returncode != 0:
            sys.exit(f"{name}: {done.stderr}")
        path.write_text(done.stdout, encoding="utf-8")
    return path.read_text(encoding="utf-8")


def table(text):
    """Returns the numbers of closings, and the rows by their names."""
    rows = [[cell.strip() for cell in line.strip("| ").split("|")] for line in text.splitlines() if line.startswith("|")]
    return [int(n) for n in rows[0][1:]], {row[0]: row[1:] for row in rows[1:]}


def after(values, marks, wanted):
    return " / ".join(values[marks.index(n)].removesuffix(" %") for n in wanted if n in marks)


def short_row(case, text):
    marks, rows = table(text)
    good, very_good, _, touch, way = rows.values()
    last = marks[-1]
    wanted = [n for n in (1, 2, 3, 6) if n in marks and n < last] + [last]
    seconds = re.search(r"median ([\d.]+), 95 % ([\d.]+)", text)
    broken, devices = re.search(r"said to be broken: (\d+) of (\d+)", text).groups()
    return (f"| {case[1]} | {devices} | {', '.join(map(str, wanted))} | {after(good, marks, wanted)} | {after(very_good, marks, wanted)} | "
            f"{way[marks.index(3)]} | {touch[-1]} | {seconds.group(1) if seconds else '-'} s | {broken} |")


def main():
    program, results, folder = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3]).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    write_scenes(folder)
    gold = output(program, folder, GOLD)
    marks, rows = table(gold)
    devices = re.search(r"said to be broken: (\d+) of (\d+)", gold)
    seconds = re.search(r"seconds per .*", gold).group(0)
    lines = ["# Tuning a waveform on a device by the state of its contact", "",
             "Devices that no search and no belief has seen, each simulated with one mode more than the belief has (plates have one) and a hundred times as accurately,",
             "spread of the scene (2 % thickness, 3 % modulus, 2 % gaps), gain of the source unknown to 0.5 % and scattering by 0.02 % from shot to shot, edges to 50 ns,",
             "openings below 100 ns unseen, unless something else is said. After N closings the waveform that `Tuner::kept` names is shot 20 more times on that device:",
             "the true motion counts, 95 % quantile of the highest rebound.", "",
             f"- made by `bench/run_tune.py BUILD/bench/bench_tune results FOLDER`, {datetime.date.today()}, revision {revision()}",
             f"- the first table: `bench_tune {' '.join(GOLD[2])}`",
             f"- machine: {machine()}; several others' work beside it, so that times are longer than they need be", "",
             f"## mem-gold, {devices.group(2)} devices", "",
             "| closings | " + " | ".join(map(str, marks)) + " |", "|---" * (len(marks) + 1) + "|"]
    lines += [f"| {name} | " + " | ".join(values) + " |" for name, values in rows.items()]
    for case in BASELINES:
        their_marks, theirs = table(output(program, folder, case))
        good, very_good = list(theirs.values())[:2]
        lines.append(f"| {case[1]}: below 10 / 1 nm, 40 devices | " + " | ".join(
            f"{a.removesuffix(' %')} / {b}" for a, b in zip(good, very_good)) + " |")
        assert their_marks == marks
    lines += ["", f"{seconds[0].upper()}{seconds[1:]}. Said to be broken: {devices.group(1)}. No shot leaves the limits of the driver: the simulated laboratory would refuse it.", "",
              "## Other devices and drives", "",
              "Shares in %. The belief knows nothing of what the device does otherwise.", "",
              "| case | devices | after closings | below 10 nm | below 1 nm | third shot, 95 %, nm | first touch over the step's at last, median / 95 % | proposal, median | said to be broken |",
              "|---|---|---|---|---|---|---|---|---|"]
    lines += [short_row(case, output(program, folder, case)) for case in CASES]
    lines += ["", "## What is said of right and of wrong devices", "",
              "40 devices of mem-gold each, eight closings: of how many `tune` says that they do not behave like the scene.", "",
              "| the device | said of | below 10 nm after 3 closings |", "|---|---|---|"]
    for case in RATIOS:
        text = output(program, folder, case)
        own_marks, own = table(text)
        lines.append(f"| {case[1]} | {' of '.join(re.search(r'said to be broken: (.*) of (.*)', text).groups())} | "
                     f"{after(list(own.values())[0], own_marks, [3])} % |")
    lines += ["", "## Triggers that are late", "",
              "| trigger delay | after closings | below 10 nm | below 1 nm | learned, median of what it is off by, us | said to be broken |", "|---|---|---|---|---|---|"]
    for case in LATES:
        text = output(program, folder, case)
        own_marks, own = table(text)
        late = float(case[2][case[2].index("--late") + 1]) if "--late" in case[2] else 0.0
        off = sorted(abs(float(one) - 1e6 * late) for one in re.findall(r"late (-?[\d.]+) \+-", text))
        good, very_good = list(own.values())[:2]
        lines.append(f"| {case[1]} | {', '.join(map(str, own_marks))} | {after(good, own_marks, own_marks)} | {after(very_good, own_marks, own_marks)} | "
                     f"{off[len(off) // 2]:.2f} | {' of '.join(re.search(r'said to be broken: (.*) of (.*)', text).groups())} |")
    in_time = output(program, folder, IN_TIME)
    own_marks, own = table(in_time)
    lines += ["", "## Touch within 33 us", "",
              f"`bench_tune {' '.join(IN_TIME[2])}`: devices whose pull-in voltage is at most 3 % above the scene's. Shares in %.", "",
              "| closings | " + " | ".join(map(str, own_marks)) + " |", "|---" * (len(own_marks) + 1) + "|"]
    lines += [f"| {name} | " + " | ".join(values) + " |" for name, values in list(own.items())[:5]]
    repeated = re.findall(r"repeated (\d+): (\d+) below 10 nm, (\d+) below 1 nm", output(program, folder, DRIFT))
    lines += ["", "## Drift", "",
              "Six closings, then 1000 more while all volts drift by 1 % in 1000 closings, up and down by turns; the touch times steer the volts.", "",
              "| device | closings | below 10 nm | below 1 nm |", "|---|---|---|---|"]
    lines += [f"| {k + 1} | {many} | {ten} | {one} |" for k, (many, ten, one) in enumerate(repeated)]
    (results / "tune.md").write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
