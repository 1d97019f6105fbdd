"""documents_test.py CASE PROGRAM: what the documents say holds.

Cases: first_page, howtos, scenes, commands, statuses, members, results, headlines, published, links, citation. Prints every finding; exit status 1 when there is one.
"""

import csv
import functools
import json
import math
import re
import shlex
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
FIRST_PAGE_BYTES = 6144  # one screen, with its code
HOWTO_LINES = 80  # one task
CELL_CHARACTERS = 140  # one line of a wide window
FENCE = re.compile(r"^```(\w*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def read(path):
    return (ROOT / path).read_text(encoding="utf-8")


def documents():
    at_the_top = [ROOT / name for name in ("README.md", "CONTRIBUTING.md", "CHANGELOG.md")]
    return at_the_top + sorted(ROOT.glob("docs/**/*.md")) + sorted(ROOT.glob("results/*.md"))


def blocks(text, language):
    return [body for name, body in FENCE.findall(text) if name == language]


def run(program, *arguments, cwd=None):
    return subprocess.run([program, *arguments], cwd=cwd, capture_output=True, text=True, check=False)


# The first page: its size, its tables, the two commands that a newcomer types, and no sentence that it says twice or that another page says too.


def sentences(text):
    text = FENCE.sub("", text)
    for paragraph in re.split(r"\n\s*\n|\n(?=[-|#]|\d\. )", text):
        for sentence in re.split(r"(?<=[.:])\s+", " ".join(paragraph.split())):
            if len(sentence) >= 50:
                yield sentence.lstrip("- ")


def first_page(_):
    text = read("README.md")
    size = len(text.encode("utf-8"))
    if size > FIRST_PAGE_BYTES:
        yield f"README.md has {size} bytes, more than {FIRST_PAGE_BYTES}"
    if blocks(text, "sh")[0] != "./softland optimize --target bounce --actuator pzt\n./softland test\n":
        yield "README.md does not begin with the two commands"
    for line in text.splitlines():
        for cell in line.strip("|").split("|") if line.startswith("|") else []:
            if len(cell.strip()) > CELL_CHARACTERS:
                yield f"README.md: a cell is longer than a line: {cell.strip()}"
    said = {}
    for path in (ROOT / "README.md", ROOT / "CONTRIBUTING.md", ROOT / "results/README.md", *sorted(ROOT.glob("docs/**/*.md"))):
        prose = path.read_text(encoding="utf-8").split("\n## Verbs\n")[0]  # what follows is made from --help
        for sentence in sentences(prose):
            if sentence in said and "README.md" in (said[sentence].name, path.name):
                yield f"{path.relative_to(ROOT)} and {said[sentence].relative_to(ROOT)} both say: {sentence}"
            said.setdefault(sentence, path)


# A how-to has one task, and is not longer.


def howtos(_):
    pages = sorted(ROOT.glob("docs/howto/*.md"))
    if not pages:
        yield "docs/howto has no pages"
    for path in pages:
        lines = len(path.read_text(encoding="utf-8").splitlines())
        if lines > HOWTO_LINES:
            yield f"{path.relative_to(ROOT)} has {lines} lines, more than {HOWTO_LINES}"


# Scenes that a page of the manual tells its reader to save are taken by the program.

SAVED_SCENE = re.compile(r"^<!-- save: (\S+\.toml) -->\n```toml\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def scenes(program):
    found = 0
    with tempfile.TemporaryDirectory() as folder:
        for path in documents():
            for name, scene in SAVED_SCENE.findall(path.read_text(encoding="utf-8")):
                if not all(re.search(rf"^\[?{part}\b", scene, re.MULTILINE) for part in ("structure", "gap")):
                    continue  # a bench file, or a part of a scene
                found += 1
                (Path(folder) / name).write_text(scene, encoding="utf-8")
                said = run(program, "check", name, cwd=folder)
                if said.returncode != 0:
                    yield f"{path.relative_to(ROOT)}: its scene is refused: {said.stderr}"
    if found < 3:
        yield f"only {found} scenes are found in the documents"


# Verbs and options that documents tell people to type exist, and docs/commands.md is what the program says of itself.


def options_by_verb(program):
    def section(name, *words):
        return run(program, *words, "--help").stdout.split(f"\n{name}:\n")[1].split("\n\n")[0]

    verbs = re.findall(r"^  ([a-z][a-z-]*) ", section("Verbs"), re.MULTILINE)
    return {verb: set(re.findall(r"^  (?:-\w,)?(--[a-z][a-z-]*)", section("Options", verb), re.MULTILINE)) for verb in verbs}


def typed(text):
    """Verb, options and line of every command in blocks and in the text."""
    code = blocks(text, "sh") + blocks(text, "") + re.findall(r"`([^`\n]+)`", FENCE.sub("", text))
    for line in "\n".join(code).replace("\\\n", " ").splitlines():
        line = re.sub(r"\s#\s.*", "", line)
        # Quoted text is an argument, or a command that another one runs.
        quoted = [text for text in re.findall(r'"([^"]*)"', line) if text.startswith("softland ")]
        for command in re.split(r"&& |\| ", re.sub(r'"[^"]*"', '""', line)) + quoted:
            words = re.match(r"\s*(?:\./)?softland ([a-z][a-z-]*)\b(.*)", command)
            if words:
                yield words.group(1), re.findall(r"(?<!\S)--[a-z][a-z-]*", words.group(2)), line.strip()


def commands(program):
    options = options_by_verb(program)
    count = 0
    for path in documents():
        for verb, given, line in typed(path.read_text(encoding="utf-8")):
            count += 1
            if verb in ("test", "python", "manual") or path.name == "CHANGELOG.md":
                continue
            unknown = [option for option in given if option not in options.get(verb, ())]
            if verb not in options or unknown:
                yield f"{path.relative_to(ROOT)}: no {verb} {' '.join(unknown)} is there: {line}"
    if count < 50:
        yield f"only {count} commands are found in the documents"

    page = "docs/commands.md"
    made = run("sh", "cmake/commands_page.sh", program, page, cwd=ROOT)
    if made.returncode != 0 or made.stdout != read(page):
        again = f"sh cmake/commands_page.sh PROGRAM {page} > new && mv new {page}"
        yield f"{page} is not what the program says of itself; make it again: {again}\n{made.stderr}"
    for verb in options:
        if f"\n### {verb}\n" not in made.stdout:
            yield f"{page} has no section of {verb}"


# Every exit status of the program and of the launcher has a row in the table of apps/exit_status.h, which --help prints.


def statuses(program):
    ends = set(re.findall(r"inline constexpr int exit_\w+ = (\d+);", read("apps/exit_status.h")))
    launcher = set(re.findall(r"\bfail (\d+) ", read("softland")))
    helped = set(re.findall(r"^  (\d+) +[a-z]", run(program, "--help").stdout.split("\nExit status:\n")[1], re.MULTILINE))
    if len(ends) < 8 or not launcher:
        yield "the exit statuses are not found in apps/exit_status.h and softland"
    for status in sorted((ends | launcher) ^ helped, key=int):
        yield f"exit status {status} is not both in the program or launcher and in --help"


# docs/reference/json.md has every member of the JSON that the verbs print, and that they write with --out.

MEMBER = re.compile(r"^\| `([^`]+)` \| (.+?) \| ", re.MULTILINE)


def member_patterns(section, sections, before=""):
    """Yields a regular expression for the path of each member of a section of the page, and of the records to whose sections it links.

    A list may be empty. The name of a number may have dots, as a parameter of a waveform has.
    """
    for key, kind in MEMBER.findall(sections[section]):
        path = before + key
        pattern = re.escape(path).replace("FIGURE", figure_key()).replace(r"\.NAME", r"(?:\.[^.]+)?").replace(r"\[\]", r"(?:\[\])?")
        yield pattern + (r"(?:\.[^.]+)?" if path.endswith(".NAME") and "record" not in kind and "[" not in kind else "")
        linked = re.match(r"\[([^]]+)\]\(#", kind)
        if linked:
            yield from member_patterns(linked.group(1), sections, path + ".")


@functools.cache
def figure_key():
    return "(?:" + "|".join(re.findall(r"^\| [^|]+ \| [^|]+ \| `([a-z_A-Z0-9]+)` \|", read("docs/reference/figures.md"), re.MULTILINE)) + ")"


def member_paths(record, before=""):
    """Yields the path of each member of a record of JSON, with [] for the elements of a list of records. The scene has keys of its own."""
    for key, value in record.items():
        path = before + key
        elements = value if isinstance(value, list) else [value]
        if not any(isinstance(one, dict) for one in elements) or path == "scene":
            yield path
            continue
        path += "[]" if isinstance(value, list) else ""
        for one in elements:
            yield path
            yield from member_paths(one or {}, path + ".")


def members_of_page(verb, sections):
    """Regular expressions, by path on the page, of the members of a verb."""
    own = ["status", "read"]
    parts = [verb] if verb in own else ["Every verb", verb] if verb != "optimize" else ["Every verb", "simulate", verb]
    return [re.compile(one) for part in parts for one in member_patterns(part, sections)]


SCENE = "scenes/mem-gold.toml"
PRINTED = {
    "simulate": [f"simulate {SCENE} --certify --out OUT", "simulate scenes/two-electrodes.toml --out OUT"],
    "optimize": [
        f"optimize {SCENE} --robust none --budget 60 --out OUT",
        f"optimize {SCENE} --robust cvar:0.9 --budget 600 --samples 16 --out OUT",
    ],
    "check": [f"check {SCENE}", "check scenes/two-electrodes.toml"],
    "pull-in": [f"pull-in {SCENE} --sweep '0 V:20 V:5' --out OUT/sweep", "pull-in scenes/two-electrodes.toml"],
    "modes": [f"modes {SCENE}"],
    "explore": [
        f"explore {SCENE} --vary 'gap.contact=1.9 um:2.1 um:2' --out OUT/map.sqlite",
        f"explore {SCENE} --vary 'gap.contact=1.6 um:2.4 um' --pareto initial_contact_time,impact_velocity --sample nsga2:8 --out OUT/front.sqlite",
    ],
    "status": ["status OUT/map.sqlite"],
    "read": ["read OUT/scope.csv"],
}
WRITTEN_BY_HAND = ("explore", "status", "read")  # their members stand in reference_pages.cc


def members(program):
    sections = dict(re.findall(r"^## ([^\n]+)\n\n(.*?)(?=^## |\Z)", read("docs/reference/json.md"), re.MULTILINE | re.DOTALL))
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "scope.csv").write_text("time_s,CH1_V\n0,0\n1e-6,1\n2e-6,2\n", encoding="utf-8")
        for verb, commands_of_verb in PRINTED.items():
            known = members_of_page(verb, sections)
            paths = set()
            for command in commands_of_verb:
                words = shlex.split(command.replace("OUT", folder))
                done = run(program, *words, "--json", "-", cwd=ROOT)
                try:
                    records = [json.loads(done.stdout)]
                except ValueError:
                    yield f"{command} prints no JSON: {done.stderr}"
                    continue
                result = Path(folder) / "result.json"
                if command.endswith("--out OUT"):
                    records.append(json.loads(result.read_text(encoding="utf-8")))
                paths |= {path for record in records for path in member_paths(record)}
            for path in sorted(paths):
                if not any(one.fullmatch(path) for one in known):
                    yield f"docs/reference/json.md lacks {path} of {verb}"
            for one in known if verb in WRITTEN_BY_HAND else []:
                if not any(one.fullmatch(path) for path in paths) and not one.pattern.startswith("scene"):
                    yield f"docs/reference/json.md has {one.pattern}, which {verb} does not print"


# results/README.md has one line for every file beside it.


def results(_):
    lines = read("results/README.md").splitlines()
    for path in sorted((ROOT / "results").iterdir()):
        naming = [line for line in lines if f"({path.name})" in line]
        if path.name != "README.md" and len(naming) != 1:
            yield f"results/README.md has {len(naming)} lines on {path.name} instead of one"
    for line in lines:
        if line.startswith(" "):
            yield f"results/README.md: more than one line for a file: {line}"


# The numbers of the first page are those of the tables they come from.


def table(path, heading, after=""):
    """Rows, as dictionaries of text, of the first table of the file whose header begins with `heading`, behind the text `after`."""
    text = read(path)
    lines = text[text.index(after) :].splitlines()
    begin = next(k for k, line in enumerate(lines) if line.startswith(f"| {heading} |"))
    cells = [[cell.strip() for cell in line.strip().strip("|").split("|")] for line in lines[begin:]]
    end = next((k for k, line in enumerate(lines[begin:]) if not line.startswith("|")), None)
    return [list(row) for row in cells[2:end]]


def percent(text):
    return float(re.match(r"([+-]?[\d.]+) %", text).group(1))


def value(text, unit):
    number = re.match(rf"([\d.]+) {unit}\b", text)
    return float(number.group(1))


def of_measured_actuators():
    path = "results/measured-actuators.md"
    voltages = [percent(row[3]) for heading in ("overlap [um]", "spring width [um]") for row in table(path, heading)]
    times = []
    for after in ("## Closing times, overlap 76.5 um", "## Closing times, overlap 15.3 um"):
        times += [percent(row[4]) for row in table(path, "voltage [V]", after) if float(row[1]) >= 1.5]
    return min(voltages), max(voltages), 1.5, min(times), max(times)


def of_searches():
    path = "results/searches.md"
    rows = table(path, "scene", "## Electrostatic pulse") + table(path, "scene", "## PZT pulse")
    free = sum(row[8] == "0" and row[13] == "0" for row in rows)
    return free, len(rows), sum(row[11] == "0, 0" for row in rows)


def of_accuracy():
    rows = table("results/accuracy.md", "accuracy")
    asked, within = sum(int(row[2]) for row in rows), sum(int(row[3]) for row in rows)
    return asked, 100 * within / asked


def of_speed():
    rows = table("results/reference-closing-speed.md", "program")
    closing = {row[0]: row for row in rows}
    softland = next(row for name, row in closing.items() if name.startswith("softland"))
    return float(softland[7]), min(float(row[8].split()[0]) for name, row in closing.items() if name.startswith("SciPy"))


def of_devices():
    """What a nominal design's waveforms land at most."""
    winners = table("results/robustness.md", "drive", "## mem-gold.toml, electrostatic")[1:]
    return (max(percent(row[2]) for row in winners),)


def of_choices():
    """The 99th percentile of the impact velocity of both drives on the PZT switch, seed 1."""
    rows = table("results/quasi-static.md", "switch", "## Choices")
    impact = next(row[4] for row in rows if row[0] == "PZT switch, both" and row[1].startswith("default") and row[2] == "1")
    return (value(impact.split("(")[1], "mm/s"),)


NUMBER = r"(\d+(?:\.\d+)?)"
HEADLINES = {
    f"pull-in voltages are {NUMBER} to {NUMBER} % high and closing times from {NUMBER} times pull-in on {NUMBER} to {NUMBER} % long": of_measured_actuators,
    f"SciPy runs {NUMBER} of {NUMBER} searched waveforms without a rebound; with two more modes {NUMBER} stay so": of_searches,
    f"Of {NUMBER} figures on random scenes {NUMBER} % are within": of_accuracy,
    f"One closing takes {NUMBER} ms, {NUMBER} times less than SciPy": of_speed,
    f"close at most {NUMBER} % of the devices of `scenes/mem-gold.toml` bounce-free": of_devices,
    f"With `--actuator both` 99 % close at no more than {NUMBER} mm/s": of_choices,
}


def headlines(_):
    text = " ".join(read("README.md").split())
    for pattern, measured in HEADLINES.items():
        said = re.search(pattern, text)
        if not said:
            yield f"README.md no longer says: {pattern}"
            continue
        for number, true in zip(said.groups(), measured(), strict=True):
            digits = len(number.partition(".")[2])
            if number != f"{true:.{digits}f}":
                yield f"README.md: {number} should be {true:.{digits + 1}f} in: {said.group(0)}"


# Figures of published devices are those that results/published.md gives, and every scene of scenes/published has one.

UNITS = {"V": 1, "us": 1e-6, "kHz": 2e3 * math.pi, "MHz": 2e6 * math.pi}


def opened(trajectory, gap):
    """Time in s at which the contact gap first reaches `gap` in m, by straight lines between the rows of the file."""
    with open(trajectory, encoding="utf-8") as file:
        course = [(float(row["time_s"]), float(row["tip_gap_m"])) for row in csv.DictReader(file)]
    for (before, lower), (after, upper) in zip(course, course[1:]):
        if upper >= gap:
            return before + (gap - lower) / (upper - lower) * (after - before)
    return math.nan


def published(program):
    rows = table("results/published.md", "device", "## Figures")
    shown = {}
    for device, figure, said, found, difference, command, where in rows:
        with tempfile.TemporaryDirectory() as folder:
            if command not in shown:
                words = shlex.split(command.strip("`"))[1:]
                out = ["--out", folder] if where.startswith("first ") else []
                shown[command] = run(program, *words, *out, "--json", "-", "--quiet", cwd=ROOT)
            if shown[command].returncode != 0:
                yield f"results/published.md: {command} fails: {shown[command].stderr}"
                continue
            if where.startswith("first "):
                true = opened(Path(folder) / "trajectory.csv", 1e-6 * float(where.split()[1]))
            else:
                true = json.loads(shown[command].stdout)
                for key in where.strip("`").split("."):
                    true = true[int(key)] if key.isdigit() else true[key]
        number, unit = found.split()
        true /= UNITS[unit]
        digits = len(number.partition(".")[2])
        if not abs(true - float(number)) <= 0.6 * 10**-digits:
            yield f"results/published.md: {device}, {figure}: {found} should be {true:.{digits + 1}f} {unit}"
        off = 100 * (true / value(said, unit) - 1)
        if not abs(off - percent(difference)) <= 0.06:
            yield f"results/published.md: {device}, {figure}: {difference} should be {off:+.2f} %"
    for scene in sorted((ROOT / "scenes/published").glob("*.toml")):
        if f"`softland check scenes/published/{scene.name}`" not in shown:
            yield f"results/published.md has no figure that check prints of {scene.name}"


# Every link in a document leads to something: files, and headings as GitHub names them.


def anchors(text):
    found = set(re.findall(r'<a name="([^"]+)">', text))
    for heading in re.findall(r"^#+ (.*)$", FENCE.sub("", text), re.MULTILINE):
        slug = re.sub(r"[^\w\- ]", "", heading.lower().strip()).replace(" ", "-")
        known = [other for other in found if other == slug or re.fullmatch(re.escape(slug) + r"-\d+", other)]
        found.add(f"{slug}-{len(known)}" if known else slug)
    return found


def links(_):
    count = 0
    for path in documents():
        text = FENCE.sub("", path.read_text(encoding="utf-8"))
        for target in re.findall(r"\]\(([^)\s]+)\)", re.sub(r"`[^`\n]*`", "", text)):
            if target.startswith("https://"):
                continue
            count += 1
            name, _, anchor = target.partition("#")
            to = (path.parent / name).resolve() if name else path
            if not to.exists():
                yield f"{path.relative_to(ROOT)}: nothing is at {target}"
            elif anchor and anchor not in anchors(to.read_text(encoding="utf-8")):
                yield f"{path.relative_to(ROOT)}: no heading is at {target}"
    if count < 100:
        yield f"only {count} links are found in the documents"


# The files that an addition takes, by CONTRIBUTING.md, are there.


def additions(_):
    rows = read("CONTRIBUTING.md").split("| to add |")[1].split("\n\n")[0].splitlines()[2:]
    for row in rows:
        for name in re.findall(r"`([\w.]+/[\w./{},]*)`", row.split("|")[2]):
            stem, _, ends = name.partition("{")
            files = [stem + end for end in ends.rstrip("}").split(",")]
            if "NAME" not in name and not all((ROOT / file).exists() for file in files):
                yield f"CONTRIBUTING.md: nothing is at {name}"
    if len(rows) < 10:
        yield f"CONTRIBUTING.md tells only {len(rows)} things to add"


# CITATION.cff names this version, under its licence.


def citation(program):
    cited = dict(re.findall(r"^([a-z-]+): (\S.*)$", read("CITATION.cff"), re.MULTILINE))
    version = run(program, "--version").stdout.split()[-1]
    if cited.get("version") != version:
        yield f"CITATION.cff: version {cited.get('version')}, of the program {version}"
    if cited.get("license") != "BSD-3-Clause" or not read("LICENSE").startswith("BSD 3-Clause"):
        yield f"CITATION.cff: the licence {cited.get('license')} is not that of LICENSE"
    for key in ("cff-version", "message", "title"):
        if key not in cited:
            yield f"CITATION.cff has no {key}"


def main():
    case, program = sys.argv[1:]
    cases = (first_page, howtos, scenes, commands, statuses, members, results, headlines, published, links, additions, citation)
    findings = list({function.__name__: function for function in cases}[case](program))
    for finding in findings:
        print(finding)
    sys.exit(1 if findings else 0)


main()
