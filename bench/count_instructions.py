#!/usr/bin/python3
"""Measures the cost of effects: instructions of one right-hand side for each scene, and with one effect added or removed.

    bench/count_instructions.py BUILD/bench/bench_rhs [BEFORE/bench/bench_rhs] > results/instructions.md

Counts with callgrind (needs valgrind), as the difference of two runs of bench_rhs that differ only in their number of calls. The count does not
depend on other work of the machine. BEFORE is the program of an older revision without the later effects: scenes that
do not use these effects must cost the same there.
"""
import datetime
import pathlib
import platform
import re
import subprocess
import sys

from tables import revision

SCENES = pathlib.Path(__file__).resolve().parent.parent / "scenes"
FEW, MANY = 1000, 3000
# Give levels in volts, so that no pull-in voltage is computed: that takes minutes under callgrind and is not counted.
VOLTS = {name: ["waveform.main.level=20 V", "driver.main.max_voltage=60 V"] for name in ("mem-gold.toml", "nem-tin.toml")}
PAD = 'pad_length = "5 um"'
ROUGH = f'{PAD}, asperity_radius = "100 nm", asperity_density = "1e11 1/m^2", effective_modulus = "48 GPa"'
UNIFORM = f'{ROUGH}, asperity_height = "100 nm"'
CONTACTS = {
    "linear": f'{PAD}, stiffness = "1e4 N/m"',
    "hysteretic": f'{PAD}, stiffness = "1e4 N/m", unloading_stiffness = "2e4 N/m"',
    "asperity-gaussian": f'{ROUGH}, asperity_deviation = "30 nm"',
    "adhesive": f'{UNIFORM}, adhesion_energy = "0.05 J/m^2"',
    "elastic-plastic": f'{UNIFORM}, hardness = "1 GPa"',
    "adhesive-repulsive": PAD,
}


def gas_laws(without):
    """Returns the names of gas laws in the tables of docs/theory/gas.md, which a test compares with the names in the program."""
    part = (SCENES.parent / "docs" / "theory" / "gas.md").read_text().split("\n## ")[1]
    return [name for name in re.findall(r"^\| `([^`]+)` \|", part, re.MULTILINE) if name not in ("model", *without)]


def choices(section, key, without):
    """Returns the values that docs/reference/keys.md lists for a choice, without some of them."""
    part = (SCENES.parent / "docs" / "reference" / "keys.md").read_text().split(f"## [{section}]")[1].split("\n## ")[0]
    row = next(line for line in part.splitlines() if line.startswith(f"| `{key}` |"))
    return [name for name in re.findall("`([^`]+)`", row.split("|")[2]) if name not in without]


# Left out: the scene's own law, laws with keys of their own, and a law that is counted elsewhere.
OTHER_GAS = ("strip", "strip-slit", "linear", "reynolds")
# A scene, the change in words, and its arguments: key=value, or -SECTION to remove a section.
CHANGES = [("mem-gold.toml", words, assignments) for words, assignments in (
    ("no gas", ["-gas"]),
    *((f"gas {model}", [f"gas.model={model}"]) for model in gas_laws(without=OTHER_GAS)),
    ("a second film on the far side", ["gas.far_gap=3 um"]),
    *((f"fringing {law}", [f"electrode.main.fringing={law}"]) for law in choices("electrode.NAME", "fringing", without=("meijs-fokkema",))),
    *((f"contact {model}", [f'contact={{ model = "{model}", {keys} }}']) for model, keys in CONTACTS.items()),
    ("contact damping", ["contact.damping=1 s/m"]),
    ("contact along the pad", ["contact.distribution=pad"]),
    ("no contact", ["-contact"]),
    ("2 modes", ["structure.modes=2"]),
    ("8 modes", ["structure.modes=8"]),
    ("dispersion casimir", ["dispersion.model=casimir"]),
    ("dispersion casimir, gold", ["dispersion.model=casimir", "dispersion.conductor=gold"]),
    ("dispersion van-der-waals", ["dispersion.model=van-der-waals", "dispersion.hamaker_constant=4e-19 J"]),
    ("dispersion auto", ["dispersion.model=auto", "dispersion.hamaker_constant=4e-19 J"]),
    ("surface", ["surface.elastic_modulus=5 N/m"]),
    ("a second electrode", ['electrode.root.span=["10 um","50 um"]', "waveform.root.family=step", "waveform.root.level=5 V"]),
    ("a second electrode, on the far side", ['electrode.root.span=["10 um","50 um"]', "electrode.root.side=far", "electrode.root.gap=3 um",
                                             "waveform.root.family=step", "waveform.root.level=5 V"]),
)] + [
    ("mem-gold-pzt.toml", "no piezo layer", ["-piezo", "-waveform.piezo", "-driver.piezo"]),
    ("nem-tin.toml", "no dispersion", ["-dispersion"]),
    ("mem-gold.toml", "gas reynolds", ["gas.model=reynolds"]),
    ("hung-senturia.toml", "no gas", ["-gas"]),
    ("hung-senturia.toml", "stretching", ["structure.stretching=true"]),
]


def collected(program, calls, scene, assignments):
    run = subprocess.run(["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null",
                          "--toggle-collect=softland::Switch::accelerations*",
                          "--toggle-collect=softland::ReynoldsFilm::rates*", program, str(calls), scene, *assignments],
                         capture_output=True, text=True)
    found = re.search(r"Collected : (\d+)", run.stderr)
    if run.returncode != 0 or not found:
        return None
    return int(found.group(1))


def instructions(program, scene, assignments=()):
    """Returns the instructions of one right-hand side; None if the program cannot run the scene."""
    few, many = (collected(program, calls, scene, [*VOLTS.get(scene.name, []), *assignments]) for calls in (FEW, MANY))
    return None if few is None or many is None else (many - few) / (MANY - FEW)


def text(count, base=None):
    if count is None:
        return "-"
    return f"{count:.0f}" if base is None else f"{count:.0f} ({100 * (count / base - 1):+.1f} %)"


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit("usage: count_instructions.py BUILD/bench/bench_rhs [BEFORE/bench/bench_rhs] > results/instructions.md")
    program, before = sys.argv[1], sys.argv[2] if len(sys.argv) == 3 else None
    print(f"""# Instructions of one right-hand side

Contact closed, every drive at its peak. Counted by callgrind as the difference of {MANY} and {FEW} calls of `bench_rhs`.
Percentages are against the scene as shipped; in the last column against the count of today.

- made by `bench/count_instructions.py BUILD/bench/bench_rhs [BEFORE/bench/bench_rhs]`, {datetime.date.today().isoformat()}, revision {revision()}
- machine: {platform.machine()}, {platform.system()} {platform.release()}; the counts depend on compiler and instruction set only
""")
    print("| scene | change | instructions |" + (" before the effects existed |" if before else ""))
    print("|---|---|---|" + ("---|" if before else ""))
    bases = {}
    for scene in sorted(SCENES.glob("*.toml")):
        bases[scene.name] = count = instructions(program, scene)
        print(f"| {scene.name} | | {text(count)} |" + (f" {text(instructions(before, scene), count)} |" if before else ""), flush=True)
    for name, words, assignments in CHANGES:
        count = instructions(program, SCENES / name, assignments)
        print(f"| {name} | {words} | {text(count, bases[name])} |" + (" |" if before else ""), flush=True)


if __name__ == "__main__":
    main()
