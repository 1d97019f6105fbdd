"""A small record of the program twice, which has to be the same, and then mistakes in it, which compare has to see.

Every file of the record is changed in one digit at a time. What compare does not report has to be at a place that masks.py names: a
change inside the words that stand for a time, a date, or the machine.
"""

import pathlib
import random
import re
import tempfile

import differences

CASES = ("two-electrodes.simulate", "purdue-nickel.effects", "purdue-nickel.accuracy", "purdue-nickel.explore", "mistakes.words")
MOST_CHANGES = 40  # of each file



def digits(text):
    return [match.start() for match in re.finditer(r"\d", text)]


def changed(text, at):
    return text[:at] + str((int(text[at]) + 1) % 10) + text[at + 1:]


class Failed(Exception):
    pass


def expect(right, what):
    if not right:
        raise Failed(what)


def sees_planted_mistakes(record):
    """Mistakes as a bad change makes them: each is one line of the report, which names the file and the key."""
    def planted(file, pattern, replacement, *words, masked=False):
        path = next(iter(sorted(record.glob(file))), None)
        expect(path is not None, f"the record has no {file}")
        text = path.read_text(encoding="utf-8")
        new, count = re.subn(pattern, replacement, text, count=1)
        expect(count == 1 and new != text, f"{file} holds no {pattern}")
        lines = []
        with tempfile.TemporaryDirectory() as folder:
            for name, content in (("a", text), ("b", new)):
                to = pathlib.Path(folder) / name / path.relative_to(record)
                to.parent.mkdir(parents=True)
                to.write_text(content, encoding="utf-8")
            status = differences.compare(pathlib.Path(folder) / "a", pathlib.Path(folder) / "b", say=lines.append)
        said = "\n".join(lines)
        if masked:
            expect(status == 0, f"{file}: {pattern} is only a time, and is reported:\n{said}")
            return
        expect(status == 1, f"{file}: another {pattern} is not reported")
        for word in (str(path.relative_to(record)), *words):
            expect(word in said, f"{file}: the report does not name '{word}':\n{said}")

    step = "two-electrodes.simulate/01-simulate/"
    planted(step + "files/simulate.json", r'("impact_velocity_m_s": 0\.14\d*)\d', r"\g<1>7", "metrics.impact_velocity_m_s")
    planted(step + "files/out/report.html", r'("charts":.*?\d\.\d+)(\d)', lambda m: m[1] + str((int(m[2]) + 1) % 10), "data ")
    planted(step + "files/out/trajectory.csv", r"(\n[^,]+,[^,]*)(\d),", lambda m: m[1] + str((int(m[2]) + 1) % 10) + ",", "row 1, ")
    planted(step + "stdout", r"(Impact velocity .*\d)(\d)\.", lambda m: m[1] + str((int(m[2]) + 1) % 10) + ".", "Impact velocity")
    planted(step + "stdout", r"\n\n", "\n", "line ")
    planted(step + "stdout", r"$", "one more line\n", "one more line")
    planted(step + "run", "status 0", "status 3", "status")
    planted(step + "files/out/gap.svg", r"(<path d=\"M\d+\.)(\d)", lambda m: m[1] + str((int(m[2]) + 1) % 10), "line ")
    planted("purdue-nickel.explore/*/files/map.sqlite.txt", r'("initial_contact_time_s": \d\.\d*)(\d)', lambda m: m[1] + str((int(m[2]) + 1) % 10),
            "results.initial_contact_time_s")
    planted("purdue-nickel.effects/*/files/effects.json", r'"initial_contact_time_s": ', '"initial_contact_time_m": ', "initial_contact_time_m")
    planted("purdue-nickel.effects/*/stdout", r"(strip +)(\d)", lambda m: m[1] + str((int(m[2]) + 1) % 10), "strip")
    planted("mistakes.words/transcript", "unknown verb", "unknown word", "unknown word")
    planted(step + "files/simulate.json", r'("wall_s": )\S+\d', r"\g<1>7.5", masked=True)
    planted("purdue-nickel.effects/*/files/effects.json", r'("rhs_s": )[^,\s]+', r"\g<1>7.5", masked=True)


def hidden_changes(record):
    """(file, line about the digit) of the changes that compare does not see."""
    chance = random.Random(1)
    comparison = differences.Comparison(0)
    changes = 0
    hidden = []
    for path in sorted(path for path in record.rglob("*") if path.is_file()):
        text = path.read_text(encoding="utf-8")
        places = digits(text)
        for at in chance.sample(places, min(MOST_CHANGES, len(places))):
            changes += 1
            verb = differences.verb_of(path.relative_to(record))
            seen = next(iter(comparison.file(verb, path.name, text.encode(), changed(text, at).encode())), None)
            if seen is None:
                begin, end = text.rfind("\n", 0, at) + 1, text.find("\n", at)
                line = text[begin:end if end >= 0 else len(text)]
                hidden.append((str(path.relative_to(record)), verb, text, at, line))
    return changes, hidden


def about_the_clock(name, verb, text, at, line):
    """Whether a digit that is masked belongs to a time, a date or the machine, by what stands around it; not asked of masks.py."""
    before = text[max(0, at - 400):at]
    if name.endswith(".json") or line.lstrip().startswith(('"', "{")):
        key = re.findall(r'"([a-z0-9_A-Z]+)": ?(?:"(?:[^"\\]|\\.)*|[-+0-9.e]*)$', before)
        volatile = {"wall_s", "store_s", "rhs_s", "cpu_s", "runs", "rate_1_s", "began", "last", "process", "host", "processor", "program",
                    "seconds", "c_library", "compiler", "instruction_set", "options", "vectors", "words"}
        return bool(key and key[0] in volatile) or (verb == "accuracy" and '"recommendations"' in text[:at])
    if name.endswith(".sqlite.txt"):
        return line.startswith("session ")
    after = text[at:at + 60]
    if verb == "accuracy":
        if name.endswith((".svg", ".html")):
            in_svg = before.rfind("<svg") > before.rfind("</svg>") or re.match(r"<(svg|style|rect|g|line|path|circle|text|title|polyline)\b", line)
            last_cell = re.match(r"[\d.]*\s[nµm]?s</td></tr>", after)
            if in_svg or last_cell or re.match(r'<h1>|<tr><th scope="row">1e-\d+</th><td>[a-z]|<script type="application/json"', line):
                return True
        else:
            return bool(re.match(r"[\d.]*\s[nµm]?s(\n|$)", after) or re.match(r"1e-\d+ +[a-z]", line) or (text.startswith("A closing with") and "\n\n" not in text[:at]))
    if name.endswith(".html"):
        return "Made with" in line or "Computed by" in line or "Computing time of this run" in line
    if verb == "effects":
        rhs = list(re.finditer(r"[\d.]+\s[nµm]s", line))
        begin = text.rfind("\n", 0, at) + 1
        return bool(rhs) and rhs[-1].start() <= at - begin < rhs[-1].end()
    if verb == "status":
        return bool(re.match(r" +(last run|until|program) ", line))
    return verb == "explore" and bool(re.match(r"[\d.]*\s[nµm]?s\n", after))


def run(make):
    try:
        with tempfile.TemporaryDirectory(prefix="record-test-") as folder:
            first, second = pathlib.Path(folder) / "first", pathlib.Path(folder) / "second"
            lines = []
            for record in (first, second):
                make(record, CASES, pathlib.Path(folder) / "place")
            status = differences.compare(first, second, say=lines.append)
            expect(status == 0, "two records of one program differ:\n" + "\n".join(lines))
            sees_planted_mistakes(first)
            changes, hidden = hidden_changes(first)
            wrong = [one for one in hidden if not about_the_clock(*one)]
            expect(not wrong, "hidden by a mask, and no time:\n" + "\n".join(f"{one[0]}: {one[4][:160]}" for one in wrong[:20]))
            expect(len(hidden) < changes / 5, f"{len(hidden)} of {changes} changes are hidden")
            gone = next(path for path in sorted(second.rglob("stdout")))
            gone.unlink()
            expect(differences.compare(first, second, say=lines.append) == 1 and any("only in the first" in line for line in lines),
                   "a file that one record lacks is not reported")
    except Failed as failed:
        print(f"record: self-test failed: {failed}")
        return 1
    print(f"record: self-test passed: {changes - len(hidden)} of {changes} changed digits are reported, the others are times")
    return 0
