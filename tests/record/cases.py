"""What the record runs: every verb on every shipped scene, and every choice that a verb offers on one scene.

A case is a list of steps in a folder of its own; a step is one run of the program. Lists of verbs, kinds, families, targets and so on
are those that the program itself tells, so that a new one is run without a line here. Budgets are small: what is recorded is what the
program says, not how good it is.
"""

import dataclasses
import pathlib
import re
import subprocess
import tomllib

LANES_OFF = {"SOFTLAND_VECTORS": "none"}


@dataclasses.dataclass
class Step:
    words: list[str]
    environment: dict[str, str] = dataclasses.field(default_factory=dict)
    told: str = ""  # on standard input
    needs: str = ""  # what an earlier step has left, unless it was refused: then this one is not run


@dataclasses.dataclass
class Case:
    name: str
    steps: list[Step]
    inputs: dict[str, str] = dataclasses.field(default_factory=dict)  # files beside scenes/
    leave_out: str = ""  # a file whose content depends on which thread was first
    brief: bool = False  # many short steps: all that they say in one file
    weight: float = 1  # begun first when it is heavy


class Program:
    """The program under record, asked for what it knows."""

    def __init__(self, path, environment):
        self.path, self.environment = path, environment

    def says(self, *words):
        done = subprocess.run([self.path, *words], env=self.environment, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=60)
        return done.stdout + done.stderr

    def verbs(self):
        help_text = self.says("--help")
        listed = re.search(r"^Verbs:\n(.*?)\n\n", help_text, re.M | re.S)
        verbs = re.findall(r"^  ([a-z][a-z-]*)  ", listed.group(1), re.M) if listed else []
        if not verbs:
            raise SystemExit("record: no list of verbs in what --help says")
        return verbs

    def choices(self, *words):
        """The names in the refusal of '?': "(known: a, b)", "choose one of a, b", "must be one of a, b or c, or ...", "there are a and b"."""
        said = self.says(*words)
        listed = re.search(r"\(known: ([^)]*)\)|choose one of (.*)|must be (?:one of )?(.*)|there are (.*)", said)
        if not listed:
            raise SystemExit(f"record: no list of choices in what '{' '.join(words)}' is told: {said.strip()}")
        text = next(group for group in listed.groups() if group)
        text = text.split(", or ")[0].strip()
        return [name for name in re.split(r", | or | and ", text) if name]


SHOT = '{"shot":1,"hold_s":1e-4,"drives":{"main":{"time_s":[0,1e-6],"V":[0,12]}}}\n'
# Stands for instruments: the same record of every shot.
INSTRUMENTS = 'n=1; while read -r line; do echo "{\\"shot\\":$n,\\"edges_s\\":[[3.6e-05,1],[3.8e-05,0],[4e-05,1]]}"; n=$((n+1)); done'

# Whatever the scene is, it has a resonance.
MEASURED = '[[measurement]]\nquantity = "frequency"\nvalue = "100 kHz"\nerror = "20 %"\n'


def quick(scene):
    """Few modes, a coarse accuracy and no compressible film."""
    words = ["--set", "simulate.accuracy=1e-3"]
    if scene.get("structure", {}).get("kind") != "plate":
        words += ["--set", "structure.modes=2"]
    if scene.get("gas", {}).get("model") == "reynolds":
        words += ["--set", "gas.model=strip"]
    return words


# These closings are long, and every setting of `accuracy` takes its time: what it cuts depends on the clock, so nothing may be cut.
SHORTER = {"mem-gold": "60 us", "mem-gold-pzt": "60 us", "nem-tin": "8 ns", "nem-casimir": "2 us", "two-electrodes": "60 us",
           "gap-closing-actuator": "80 us"}


def scene_cases(name, text):
    scene = tomllib.loads(text)
    file = f"scenes/{name}.toml"
    fast = quick(scene)
    piezo = "piezo" in scene
    film = scene.get("gas", {}).get("model") == "reynolds"

    def step(verb, *words, **more):
        return Step([verb, file, *words], **more)

    actuators = ["electrostatic", "pzt", "both"]
    yield Case(f"{name}.describe", [
        step("check"), step("check", "--quiet", *fast), step("modes", "--json", "modes.json"), step("modes", "--json", "-", *fast),
        step("pull-in", "--json", "pull-in.json"), step("pull-in", "--json", "-", *fast),
        step("export", "--format", "csv"), step("export", "--format", "spice-pwl"), step("export", "--signal", "output"),
        step("export", "--format", "codes"),
        *[step("export", "--format", kind, "--sample-rate", "25 MHz") for kind in ("keysight-arb", "tektronix-csv")]], weight=3 if film else 1)
    yield Case(f"{name}.simulate", [
        step("simulate", "--json", "simulate.json", "--out", "out"), Step(["report", "out", "--out", "again"]), Step(["export", "out"]),
        Step(["export", "out", "--format", "spice-pwl"]), Step(["export", "out", "--device-vdp", "20 V", "--device-frequency", "30 kHz"]),
        Step(["export", "out", "--measured", "frequency=30 kHz"]),
        *[Step(["export", "out", "--contact-record", kind]) for kind in ("csv", "vcd", "pwl") if name == "ohmic-gold"],
        step("simulate", "--quiet", "--json", "-", *fast),
        step("simulate", "--set", "simulate.effects=auto", *fast),
        step("simulate", "--set", "structure.modes=auto", "--set", "simulate.accuracy=1e-3", *(["--set", "gas.model=strip"] if film else []))],
        weight=4 if film else 1)
    yield Case(f"{name}.certify", [
        step("simulate", "--certify", "--jobs", "2", "--json", "certified.json", "--out", "out", *fast)], weight=2)
    yield Case(f"{name}.effects", [step("effects", "--json", "effects.json", *fast)], weight=3)
    shorter = ["--set", f"simulate.duration={SHORTER[name]}"] if name in SHORTER else []
    yield Case(f"{name}.accuracy", [step("accuracy", "--json", "accuracy.json", "--out", "out", *fast, *shorter)], weight=3)
    yield Case(f"{name}.limit", [
        step("limit", "--no-curves", "--json", "limit.json", "--out", "out", *fast),
        step("limit", "--no-curves", "--start", "out", "--impact-velocity", "2 mm/s", "--quiet", *fast, needs="out/best.toml"),
        Step(["simulate", "out/best.toml"], needs="out/best.toml"),
        Step(["calibrate", "out", "--samples", "16", "--jobs", "1", "--json", "calibrate.json"], needs="out/best.toml"),
        *[step("limit", "--no-curves", "--quiet", "--actuator", a, *fast) for a in actuators[1:] if piezo]], weight=8)
    yield Case(f"{name}.release", [
        step("release", "--budget", "200", "--jobs", "2", "--json", "release.json", "--out", "out", *fast),
        *[step("release", "--budget", "200", "--jobs", "1", "--quiet", "--actuator", a, *fast) for a in actuators[1:] if piezo]])
    yield Case(f"{name}.robustness", [
        step("robustness", "--samples", "20", "--jobs", "1", "--json", "robustness.json", "--out", "out", *fast),
        Step(["simulate", "out/worst-1.toml", "--quiet"], needs="out/worst-1.toml"),
        step("robustness", "--samples", "20", "--jobs", "2", "--quiet", "--json", "-", *fast, environment=LANES_OFF)])
    yield Case(f"{name}.calibrate", [step("calibrate", "--samples", "16", "--jobs", "1")])
    for actuator in actuators:
        yield Case(f"{name}.optimize-{actuator}", [
            step("optimize", "--robust", "none", "--budget", "200", "--jobs", "1", "--actuator", actuator, "--json", "optimize.json", "--out", "out", *fast),
            *[Step(words, needs="out/best.toml") for words in (
                ["simulate", "out/best.toml", "--quiet"], ["export", "out"], ["report", "out"],
                ["optimize", "--resume", "--out", "out", "--budget", "240", "--jobs", "1", "--quiet"])]], weight=2)
    yield Case(f"{name}.fit", [step("fit", "--data", "bench.toml", "--starts", "2", "--jobs", "1", "--json", "fit.json", "--out", "fitted", *fast)],
               inputs={"bench.toml": MEASURED})
    yield Case(f"{name}.tune", [
        step("device", "--seed", "3", *fast, told=SHOT),
        step("tune", "--device", INSTRUMENTS, "--effort", "0.05", "--closings", "2", "--jobs", "1", "--out", "tuned", *fast),
        Step(["simulate", "tuned/best.toml", "--quiet"], needs="tuned/best.toml")], weight=2)
    vary = ["--vary", "gap.contact=95 %:105 %:3"]
    yield Case(f"{name}.explore", [
        step("explore", *vary, "--jobs", "1", "--out", "map.sqlite", "--json", "map.json", *fast),
        Step(["table", "map.sqlite"]), Step(["table", "map.sqlite", "--csv"]), Step(["status", "map.sqlite"]),
        Step(["status", "map.sqlite", "--json", "-"]), Step(["report", "map.sqlite"]),
        Step(["explore", "map.sqlite", "--point", "1", "--out", "point.toml"]), Step(["simulate", "point.toml", "--quiet"]),
        step("explore", *vary, "--study", "pull-in", "--jobs", "1", "--quiet", "--out", "pull-in.sqlite", *fast),
        Step(["table", "pull-in.sqlite", "--csv"]),
        *[step("explore", *vary, "--shard", f"{part}/2", "--jobs", "1", "--quiet", "--out", f"part{part}.sqlite", *fast) for part in (1, 2)],
        Step(["merge", "part1.sqlite", "part2.sqlite", "--out", "merged.sqlite"]), Step(["status", "merged.sqlite", "part1.sqlite"]),
        Step(["slurm", "map.sqlite", "--tasks", "2", "--cpus", "3", "--out", "cluster.sqlite"])], weight=2)


# Parameters of a waveform, a contact or a gas law that need more than their name; one that is not here runs by its name, or is refused.
FAMILIES = {
    "step": "level=1.2 Vdp|rise_time=2 us",
    "harmonic": "base=1.2 Vdp|amplitude=10 %|frequency=60 kHz|start=5 us|end=70 us|fade=3 us|phase=30 deg",
    "pulse": 'levels=["1.3 Vdp", "0 V", "1.2 Vdp"]|times=["15 us", "30 us"]|edge=1 us',
    "table": 'times=["0 us", "1 us", "40 us"]|voltages=["0 V", "20 V", "21 V"]',
    "s-curve": 'levels=["1.3 Vdp", "0 V", "1.2 Vdp"]|times=["15 us", "30 us"]|edge=2 us',
    "chirp": "base=1.2 Vdp|amplitude=10 %|frequency=60 kHz|end=70 us|frequency_ratio=2|decay_time=30 us",
    "bspline": 'levels=["0 V", "21 V", "5 V", "21 V", "20 V"]|duration=60 us',
    "sines": 'base=1.2 Vdp|amplitudes=["10 %", "5 %"]|duration=60 us',
}
SUMMITS = "pad_length=5 um|asperity_radius=100 nm|asperity_density=1e11 1/m^2|asperity_height=100 nm|effective_modulus=48 GPa"
CONTACTS = {
    "linear": "pad_length=5 um|stiffness=2e4 N/m|damping=1 s/m",
    "asperity-uniform": SUMMITS + "|damping=1 s/m",
    "asperity-gaussian": SUMMITS.replace("asperity_height=100 nm", "asperity_deviation=30 nm"),
    "adhesive": SUMMITS + "|adhesion_energy=0.01 J/m^2",
    "hysteretic": "pad_length=5 um|stiffness=2e4 N/m|unloading_stiffness=4e4 N/m",
    "elastic-plastic": SUMMITS + "|hardness=1 GPa",
    "adhesive-repulsive": "pad_length=5 um|reach=600 nm",
    "rigid": "restitution=0.5",
}
GASES = {
    "strip-slit": "slit_height=1 um|slit_length=5 um",
    "linear": "damping=1e-3 N s/m^2",
}


def keys_of(section, assignments):
    return [f"{section}.{one}" for one in assignments.split("|")] if assignments else []


def without(text, section):
    """The scene without a section."""
    return re.sub(r"(?ms)^\[" + re.escape(section) + r"\].*?(?=^\[|\Z)", "", text)


def section_text(section, choice, name, assignments):
    lines = [f"[{section}]", f'{choice} = "{name}"']
    for one in assignments.split("|") if assignments else []:
        key, value = one.split("=", 1)
        plain = value.startswith("[") or re.fullmatch(r"[-+0-9.e]+", value)
        lines.append(f"{key} = {value}" if plain else f'{key} = "{value}"')
    return "\n".join(lines) + "\n"


def choice_cases(program, scenes):
    """Every choice on one scene, the gold cantilever, or where it needs a piezo or a plate, on one that has it."""
    gold, pzt, plate = "scenes/mem-gold.toml", "scenes/mem-gold-pzt.toml", "scenes/two-electrodes.toml"
    fast = ["--set", "structure.modes=2", "--set", "simulate.accuracy=1e-3"]
    short = ["--set", "simulate.duration=100 us"]
    text = scenes["mem-gold"]
    where = str(program.scenes / "mem-gold.toml")

    def optimize(*words, scene=gold, out="out", budget="100"):
        nominal = [] if "--robust" in words else ["--robust", "none"]
        return Step(["optimize", scene, *nominal, "--budget", budget, "--jobs", "1", "--out", out, *fast, *words])

    for target in [*program.choices("optimize", where, "--target", "?"), "0.7 bounce + 0.3 energy"]:
        yield Case(f"target.{target.replace(' ', '')}", [optimize("--target", target)])
    for optimizer in program.choices("optimize", where, "--optimizer", "?"):
        yield Case(f"optimizer.{optimizer}", [optimize("--optimizer", optimizer, "--waveform", "pulse")])
    families = [f.replace(":N", ":6") for f in program.choices("optimize", where, "--waveform", "?")]
    for family in [*families, "knots+dual-pulse"]:
        yield Case(f"searched.{family}", [optimize("--waveform", family), Step(["simulate", "out/best.toml", "--quiet"])])
    yield Case("searched.both", [optimize("--actuator", "both", "--waveform", "main=step,piezo=pulse", scene=pzt),
                                 optimize("--actuator", "both", "--waveform", "main=step,pzt=pulse", scene=pzt)])
    yield Case("search.conditions", [
        optimize("--constrain", "initial_contact_time < 65 us", "--constrain", "impact_velocity < 60 mm/s"),
        optimize("--start", "out/best.toml", "--waveform", "pulse", "--seed", "7", out="again"),
        optimize("--start", "out", "--start", "again", "--quiet", "--json", "-", out="third")], weight=2)
    yield Case("search.limit", [optimize("--limit", "--json", "limit.json"),
                                Step(["optimize", plate, "--robust", "none", "--budget", "1000", "--jobs", "1", "--out", "plate", "--set", "simulate.accuracy=1e-3"])], weight=4)
    yield Case("search.jobs", [Step([word if word != "1" else "3" for word in optimize("--json", "optimize.json").words])],
               leave_out="evaluations.sqlite")  # which numbers its rows as they come
    yield Case("search.default-scene", [Step(["optimize", "--robust", "none", "--budget", "12", "--jobs", "1", "--out", "out", *fast])])
    yield Case("search.seeds", [optimize("--seeds", "3", "--json", "seeds.json"), Step(["table", "out/seeds.sqlite"]),
                                Step(["status", "out/seeds.sqlite", "out/evaluations.sqlite"]),
                                Step(["optimize", "--resume", "--out", "out", "--budget", "140", "--jobs", "1"])], weight=3)
    measures = program.choices("optimize", where, "--robust", "?")
    for measure in measures:
        measure = measure.replace('"', "")
        yield Case(f"robust.{re.sub('[^a-z0-9.+]', '', measure)}",
                   [optimize("--robust", measure, "--samples", "8", *short)], weight=6)
    yield Case("robust.calibrated", [
        optimize("--robust", "cvar:0.9", "--samples", "8", "--calibrate", "Vdp:1 %,frequency:0.5 %", "--json", "robust.json", *short),
        Step(["robustness", gold, "out", "--samples", "20", "--jobs", "1", "--calibrate", "Vdp:1 %", *fast]),
        Step(["calibrate", "out", "--samples", "16", "--error", "Vdp:1 %", "--steps", "1.2,1.4", "--jobs", "2"]),
        optimize("--robust", "cvar:0.9", "--samples", "8", "--calibrate", "Vdp in 2 classes", "--constrain",
                 "initial_contact_time < 65 us", *short, out="classes")], weight=9)
    yield Case("robust.lanes-off", [Step([*optimize("--robust", "worst", "--samples", "8", *short).words], environment=LANES_OFF)], weight=6)
    for points in program.choices("robustness", where, "--points", "?"):
        yield Case(f"robustness.{points}", [Step(["robustness", gold, "--samples", "24", "--points", points, "--seed", "3", "--jobs", "2",
                                                 "--json", "-", "--quiet", *fast])])
    yield Case("robustness.other-ways", [Step(["robustness", gold, "--samples", "20", "--other-ways", "--jobs", "2", "--out", "out",
                                               "--json", "robustness.json", *fast])], weight=4)
    yield Case("limit.curves", [Step(["limit", plate, "--out", "out", "--json", "limit.json"])], weight=4)
    yield Case("cycle.rates", [Step(["cycle", gold, "--samples", "4", "--cycles", "4", "--jobs", "1", "--json", "cycle.json", "--out", "out", "--set", "structure.modes=1", "--quiet"])])
    yield Case("cycle.search", [Step(["cycle", gold, "--rate", "1 kHz", "--search", "--budget", "60", "--cycles", "3", "--jobs", "1", "--out", "out", "--quiet"])])
    yield Case("cycle.rate", [Step(["cycle", pzt, "--rate", "2 kHz", "--no-scan", "--duty", "40 %", "--cycles", "3", "--quiet"])])
    yield Case("release.band", [Step(["release", pzt, "--actuator", "both", "--band", "2 %", "--budget", "80", "--seed", "5", "--jobs", "1",
                                      "--json", "-", "--quiet", *fast])])

    vary = ["--vary", "gap.contact=1.8 um:2.2 um:3", "--vary", "waveform.main.level=1.2 Vdp:1.3 Vdp:2"]
    box = ["--vary", "gap.contact=1.8 um:2.2 um", "--vary", "waveform.main.level=1.1 Vdp:1.5 Vdp"]

    def explore(out, *words):
        return Step(["explore", gold, "--jobs", "1", "--out", out, *fast, *short, *words])

    for study in program.choices("explore", where, "--vary", "gap.contact=95 %,105 %", "--study", "?"):
        small = {"optimize": ["--budget", "12"], "robustness": ["--samples", "12"]}.get(study, [])
        points = vary[:2] if study in ("optimize", "robustness") else vary
        yield Case(f"explore.{study}", [
            explore("map.sqlite", *points, "--study", study, *small, "--json", "map.json"), Step(["table", "map.sqlite"]),
            Step(["table", "map.sqlite", "--out", "map.csv"]), Step(["explore", "map.sqlite", "--point", "1"]),
            Step(["report", "map.sqlite", "--out", "page"])], weight=3)
    yield Case("explore.grids", [
        explore("map.sqlite", *vary, "--certify", "--quiet"),
        Step(["table", "map.sqlite", "--where", "bounce_count > 0", "--select", "point,gap.contact,content,extra"]),
        Step(["report", "map.sqlite", "--pareto", "initial_contact_time,impact_velocity", "--map", "impact_velocity", "--out", "page"]),
        explore("finer.sqlite", "--vary", "gap.contact=1.8 um:2.2 um:2", "--quiet"),
        explore("finer.sqlite", "--vary", "gap.contact=1.8 um:2.2 um:3", "--resume", "--json", "-"),
        explore("log.sqlite", "--vary", "gas.viscosity=1e-6 Pa s:1e-4 Pa s:3:log", "--vary", "electrode.main.fringing=none,linear", "--quiet"),
        explore("factor.sqlite", "--vary", "gap.electrode*gap.contact=0.9:1.1:3", "--vary", "electrode.main.span[2]=200 um,240 um", "--quiet"),
        Step(["table", "log.sqlite", "--csv"]), Step(["table", "factor.sqlite", "--csv"])], weight=3)
    yield Case("explore.samples", [
        explore("sobol.sqlite", *box, "--sample", "sobol:5", "--seed", "4"), Step(["table", "sobol.sqlite", "--csv"]),
        explore("sobol.sqlite", *box, "--sample", "sobol:8", "--seed", "4", "--resume"), Step(["table", "sobol.sqlite", "--csv"]),
        explore("lhs.sqlite", *box, "--sample", "lhs:5", "--seed", "4"), Step(["table", "lhs.sqlite", "--csv"]),
        explore("list.sqlite", "--list", "points.csv"), Step(["table", "list.sqlite", "--csv"])],
        inputs={"points.csv": "gap.contact [um],waveform.main.level [Vdp]\n1.9,1.2\n2,1.3\n9,1\n"})
    yield Case("explore.front", [
        explore("front.sqlite", *box, "--pareto", "initial_contact_time,impact_velocity,peak_voltage", "--sample", "nsga2:70", "--json", "front.json"),
        explore("front.sqlite", *box, "--pareto", "initial_contact_time,impact_velocity,peak_voltage", "--sample", "nsga2:130", "--resume", "--json", "-"),
        Step(["report", "front.sqlite", "--out", "page"]), Step(["table", "front.sqlite", "--csv"])], weight=3)
    plan = ('[plan]\nscene = "scenes/mem-gold.toml"\nset = ["structure.modes=2", "simulate.accuracy=1e-3", "simulate.duration=100 us"]\n'
            'vary = ["gap.contact=1.8 um:2.2 um:4"]\nseed = 2\n')
    parts = [Step(["explore", "plan.toml", "--shard", f"{part}/3", "--jobs", "1", "--quiet", "--out", f"part{part}.sqlite"]) for part in (1, 2, 3)]
    yield Case("explore.parts", [
        *parts[:2], Step(["merge", "part1.sqlite", "part2.sqlite", "--complete", "--out", "whole.sqlite"]), parts[2],
        Step(["merge", "part1.sqlite", "part2.sqlite", "part3.sqlite", "--complete", "--out", "whole.sqlite"]),
        Step(["merge", "part1.sqlite", "part2.sqlite", "--out", "whole.sqlite"]),
        Step(["status", "part1.sqlite", "part2.sqlite", "part3.sqlite", "--json", "status.json"]), Step(["table", "whole.sqlite", "--csv"]),
        Step(["slurm", "plan.toml", "--tasks", "3"]), Step(["slurm", "whole.sqlite", "--tasks", "2", "--cpus", "4", "--out", "x.sqlite"])],
        inputs={"plan.toml": plan})

    scope = "x-axis,1,2\nsecond,Volt,Volt\n" + "".join(f"{(i - 5) * 1e-6:+.3E},{0 if i < 5 else 20:+.2E},{i * 0.01:+.2E}\n" for i in range(60))
    driven = ["file=scope.csv|column=2", "file=scope.csv", "file=scope.csv|column=2|shift=first|scale=1.1", "file=samples.csv|interval=1 us", "file=drive.cir"]
    yield Case("files", [
        Step(["read", "scope.csv"]), Step(["read", "scope.csv", "--plot"]), Step(["read", "scope.csv", "--json", "read.json"]),
        Step(["read", "samples.csv"]), Step(["read", "samples.csv", "--set", "interval=1 us", "--json", "-"]), Step(["read", "drive.cir"]),
        Step(["read", "two.csv"]), Step(["read", "two.csv", "--set", "decimal=,"]), Step(["read", "spectrum.csv"]),
        *[Step(["simulate", f"by-file-{i}.toml", "--quiet", "--json", f"{i}.json", *fast, *short]) for i in range(len(driven))]],
        inputs={"scope.csv": scope, "samples.csv": "0.5\n1.5\n2.5\n", "two.csv": "0,5\n1,7\n", "drive.cir": "* drive\n0 0\n+1u 20 ; up\n+40u 20\n",
                "spectrum.csv": "Frequency (Hz),CH1 (dBV)\n0,1\n1,2\n",
                **{f"by-file-{i}.toml": without(text, "waveform.main") + "\n" + section_text("waveform.main", "family", "table", keys)
                   for i, keys in enumerate(driven)}})

    for kind in program.choices("new", "?"):
        yield Case(f"new.{kind}", [Step(["new", kind])])
    yield Case("new", [Step(["new"])])

    def variant(section, choice, names, known, base):
        inputs = {f"{name}.toml": without(base, section) + "\n" + section_text(section, choice, name, known.get(name, "")) for name in names}
        return [Step(["simulate", file, "--quiet", "--json", f"{file}.json", *fast, *short]) for file in inputs], inputs

    for section, choice, known in (("waveform.main", "family", FAMILIES), ("contact", "model", CONTACTS), ("gas", "model", GASES)):
        names = program.choices("simulate", where, "--set", f"{section}.{choice}=?")
        steps, inputs = variant(section, choice, names, known, text)
        yield Case(f"laws.{section}", steps, inputs)
    plate_contacts, inputs = variant("contact", "model", ["linear", "hysteretic", "rigid"],
                                     {name: CONTACTS[name].replace("pad_length=5 um|", "") for name in ("linear", "hysteretic", "rigid")},
                                     scenes["two-electrodes"])
    plate_contacts = [Step([word for word in step.words if word != "structure.modes=2"]) for step in plate_contacts]
    for step in plate_contacts:
        step.words.remove("--set")  # of the modes
    yield Case("laws.contact-of-a-plate", plate_contacts, inputs)
    fringing = program.choices("simulate", where, "--set", "electrode.main.fringing=?")
    yield Case("laws.fringing", [Step(["simulate", gold, "--quiet", "--json", f"{name}.json", "--set", f"electrode.main.fringing={name}",
                                       *fast, *short]) for name in fringing])
    drivers = [["driver.main.max_slew=20 V/us", "waveform.main.rise_time=2 us"], ["driver.main.max_slew=20 V/us"], ["driver.main.bandwidth=1 MHz"],
               ["driver.main.sample_rate=20 MHz", "driver.main.bits=8"], ["driver.main.source_resistance=1e6 ohm"],
               ["driver.main.source_resistance=1e6 ohm", "driver.main.parallel_capacitance=2 pF"]]
    yield Case("laws.drivers", [Step(["simulate", gold, "--json", f"{i}.json", *[word for one in some for word in ("--set", one)], *fast, *short])
                                for i, some in enumerate(drivers)])
    yield Case("laws.settings", [
        Step(["simulate", gold, "--quiet", "--json", f"{i}.json", "--set", one, *short]) for i, one in enumerate([
            "structure.modes=1", "structure.modes=6", "simulate.tolerance=1e-9", "simulate.accuracy=1e-2"])])


def mutants(text):
    """A scene with one mistake each: (what it is, text). Lines are taken as they stand, so that every new key has its mistakes."""
    lines = text.splitlines(keepends=True)
    section = ""
    for number, line in enumerate(lines):
        where = f"line {number + 1}"
        heading = re.match(r"\[([^]]+)\]", line)
        if heading:
            section = heading.group(1)
            yield f"without [{section}]", without(text, section)
            yield f"{where}: [{section}x]", "".join(lines[:number] + [line.replace("]", "x]", 1)] + lines[number + 1:])
            continue
        given = re.match(r'("[^"]*"|[a-z_0-9]+) = (.*?)(\s+#.*)?$', line.rstrip("\n"))
        if not given:
            continue
        key, value = given.group(1), given.group(2)

        def with_line(new):
            return "".join(lines[:number] + ([new + "\n"] if new else []) + lines[number + 1:])

        yield f"{where}: without {section}.{key}", with_line("")
        yield f"{where}: {section}.{key} misspelt", with_line(f"{key.rstrip(chr(34))}x{chr(34) if key.startswith(chr(34)) else ''} = {value}")
        yield f"{where}: {section}.{key} twice", with_line(line.rstrip("\n") + "\n" + line.rstrip("\n"))
        quantity = re.fullmatch(r'"([-+0-9.e]+) ([^"]+)"', value)
        if quantity:
            for new in (f'"{quantity.group(1)} cd"', f'"{quantity.group(1)}"', f'"-{quantity.group(1)} {quantity.group(2)}"',
                        f'"1e30 {quantity.group(2)}"', quantity.group(1), f'"nan {quantity.group(2)}"'):
                yield f"{where}: {section}.{key} = {new}", with_line(f"{key} = {new}")
        else:
            for new in ('"?"', "-1", "[]", "true"):
                yield f"{where}: {section}.{key} = {new}", with_line(f"{key} = {new}")


def mistake_cases(program, verbs, scenes):
    """What the program refuses: status and message."""
    for name, text in scenes.items():
        all_mutants = dict(enumerate(mutants(text)))
        verb = "check" if name == "mem-gold" else "modes"  # a check finds pull-in voltages, which take seconds for some
        inputs = {f"m{number:03}.toml": f"# {what}\n{mutant}" for number, (what, mutant) in all_mutants.items()}
        yield Case(f"mistakes.{name}", [Step([verb, file]) for file in inputs], inputs, brief=True, weight=2)
    gold = "scenes/mem-gold.toml"

    def each(*lines):
        return [Step(list(words)) for words in lines]

    for verb in verbs:
        alone = [] if "[SCENE]" in program.says(verb, "--help") else [[verb]]  # or it works, and for long
        yield Case(f"mistakes.verb-{verb}", each(
            *alone, [verb, "--help"], [verb, "none"], [verb, "none.toml"], [verb, "--frob"], [verb, gold, "--frob"], [verb, gold, "extra", "more"],
            [verb, gold, "--json"], [verb, gold, "--json", "nowhere/x.json"], [verb, gold, "--out", gold], [verb, gold, "--set", "gap.contact"],
            [verb, gold, "--set", "gap.contct=1 um"], [verb, gold, "--set", "gap.contact=9 um"], [verb, gold, "--seed", "-1"],
            [verb, gold, "--jobs", "0"], [verb, gold, "--budget", "0"], [verb, gold, "--samples", "0"], [verb, gold, "--actuator", "magnetic"],
            [verb, "broken.toml"], [verb, "empty.toml"], [verb, "empty.json"], [verb, "folder"], [verb, ""], [verb, "text.sqlite"]),
            inputs={"broken.toml": "[structure\n", "empty.toml": "", "empty.json": "{}", "folder/kept": "kept\n", "text.sqlite": "no store\n"},
            brief=True)
    yield Case("mistakes.words", each([], ["--version"], ["--help"], ["-h"], ["frobnicate"], ["--frob"], ["check", "--help"], ["x" * 5000],
                                      ["check", gold, "--set", "title=" + "y" * 3000], ["check", gold, "--set", "title=a\tb\x1b[0m"]), brief=True)
    sets = ["gap.contact=-1", "gap.contact=-1 um", "gap.contact=1 V", "=3", "structure.modes=0", "structure.modes=1.5", "structure.modes=99",
            "structure.kind=?", "simulate.accuracy=1", "simulate.accuracy=x", "simulate.duration=2 us", "waveform.main.level=9 Vdp",
            "waveform.main.level=0.5 Vdp", "waveform.piezo.level=1 V", "electrode.main.span=1 um", "electrode.main.span[3]=1 um",
            'electrode.main.span=["240 um", "60 um"]', "contact.model=linear", "gas.model=linear", "gas.pressure=0 Pa", "driver.main.bits=99",
            "driver.main.max_voltage=1 V", "metrics.significant_rebound=1 m", "spread.gaps.cov=200 %", "spread.gaps.keys=[]", "title=",
            "nowhere.key=1", "structure=1", "structure.length=1e400 um", "structure.residual_stress=1 TPa"]
    yield Case("mistakes.sets", [Step(["simulate", gold, "--quiet", "--set", one]) for one in sets], brief=True, weight=2)
    options = [
        ["optimize", gold, "--target", "softness"], ["optimize", gold, "--target", "0.7 bounce + x"], ["optimize", gold, "--budget", "1.5"],
        ["optimize", gold, "--budget", "90 m"], ["optimize", gold, "--waveform", "knots+"], ["optimize", gold, "--waveform", "table"],
        ["optimize", gold, "--constrain", "t_i < 3 V"], ["optimize", gold, "--robust", "cvar:2"], ["optimize", gold, "--samples", "3"],
        ["optimize", gold, "--robust", "worst", "--calibrate", "Vsp"], ["optimize", gold, "--robust", "worst", "--optimizer", "bobyqa"],
        ["optimize", gold, "--seeds", "0"], ["optimize", gold, "--seeds", "2", "--budget", "1 s"], ["optimize", gold, "--start", "none.toml"],
        ["optimize", "--resume", "--out", "folder"], ["limit", gold, "--impact-velocity", "1 V"], ["release", gold, "--band", "90"],
        ["explore", gold, "--vary", "gap.contact"], ["explore", gold, "--vary", "gap.contact=2 um:1 V:3"], ["explore", gold],
        ["explore", gold, "--vary", "gap.contct=1 um,2 um"], ["explore", gold, "--vary", "gap.contact=1 um,2 um", "--shard", "3/2"],
        ["explore", gold, "--vary", "gap.contact=1 um:2 um", "--sample", "halton:3"], ["explore", gold, "--vary", "gap.contact=1 um:2 um:2",
        "--pareto", "softness"], ["explore", "none.sqlite", "--resume"], ["robustness", gold, "--calibrate", "Vdp:99 %"],
        ["calibrate", gold, "--error", "mass:1 %"], ["calibrate", gold, "--steps", "1.2,1.1"], ["export", gold, "--format", "wav"],
        ["export", gold, "--contact-record", "wav"], ["export", gold, "--contact-record", "csv", "--devices", "2"],
        ["export", gold, "--device-vdp", "3 A"], ["new", "magnet"], ["merge", "none.sqlite", "--out", "x.sqlite"], ["status", "none.sqlite"],
        ["slurm", gold, "--tasks", "0"], ["table", "none.sqlite", "--where", "1"]]
    yield Case("mistakes.options", each(*options), inputs={"folder/kept": "kept\n"}, brief=True, weight=2)


def all_cases(program, scenes_folder):
    scenes = {path.stem: path.read_text(encoding="utf-8") for path in sorted(pathlib.Path(scenes_folder).glob("*.toml"))}
    if not scenes:
        raise SystemExit(f"record: no scenes in {scenes_folder}")
    program.scenes = pathlib.Path(scenes_folder)
    verbs = program.verbs()
    cases = []
    for name, text in scenes.items():
        cases += scene_cases(name, text)
    cases += choice_cases(program, scenes)
    run = {step.words[0] for case in cases for step in case.steps}
    missed = [verb for verb in verbs if verb not in run]
    if missed:
        raise SystemExit(f"record: no case runs {', '.join(missed)}: add some to tests/record/cases.py")
    cases += mistake_cases(program, verbs, scenes)
    names = [case.name for case in cases]
    assert len(set(names)) == len(names), "two cases of one name"
    return cases, scenes
