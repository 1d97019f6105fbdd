"""What two runs of the same program may differ in: times, dates, and which program on which machine it was.

Each mask names the verb, or the kind of JSON, and the place; nothing else is left out. `record.py self-test` changes digits all over a
record and tells which of the changes the masks hide.
"""

import re

MASK = "…"  # what stands for a masked value

# (kind of the document, key path without indices): the value, and all below it.
JSON_MASKS = [(kind, re.compile(path)) for kind, path in [
    ("", r"(.+\.)?made_with"),
    ("", r"(.+\.)?work\.(wall_s|store_s)"),
    ("effects", r"(.+\.)?rhs_s"),
    # The clock decides how often a setting is run, and which is the quickest; its page is drawn over time.
    ("accuracy", r"(rows|modes|without_restart_at_contact)\[\]\.(cpu_s|runs)|reference\.(cpu_s|runs)"),
    ("accuracy", r"recommendations\[\]\.(setting|words)"),
    ("accuracy page", r"charts\[\]\.(marks|x\.(home|whole))|tables\..*"),
    ("status", r"stores\[\]\.(rate_1_s|sessions\[\]\.(began|last|process|host|processor|program|seconds))"),
]]

# Columns of the rows of a store.
STORE_MASKS = {"session": {"program", "processor", "host", "process", "began", "last"}}

_TIME = r"[-+0-9.e]+[\u00a0\u202f ](?:[nµm]?s|min|h|days)"

# (verb, file, expression): the groups are kept, what is between them is masked.
TEXT_MASKS = [(verb, file, re.compile(expression, re.M)) for verb, file, expression in [
    ("explore", "stdout", rf"(^\d[\d\u202f ,]* (?:of [\d\u202f ,]+ )?points? in .*: .*computed.*, ){_TIME}($)"),
    ("status", "stdout", r"(^  last run +[^ ]+ rows?)(?: in .*)?($)"),
    ("status", "stdout", r"(^ +until ).*(, run \d+$)"),
    ("status", "stdout", r"(^  program +)[0-9a-f]{40}($)"),
    ("optimize", "stderr", rf"(; simulating a closing takes ){_TIME}(, the whole search about ){_TIME}(.*$)"),
    ("simulate", "stderr", rf"(: one evaluation of the equations of motion takes ){_TIME}( instead of ){_TIME}(, ).*( less$)"),
    ("accuracy", "stdout", r"(\AA closing with [^.]*? takes )[\s\S]*?(\n\n)"),
    ("accuracy", "stdout", r"(^1e-\d+ ) +[a-z].*($)"),
    ("accuracy", ".html", rf"(</td><td>)(?:{_TIME}|—)(</td></tr>$)"),
    ("accuracy", ".html", r"(^<tr><th scope=\"row\">1e-\d+</th><td>)[a-z].*(</td></tr>$)"),
    ("accuracy", ".html", r"(^<h1>A closing with .* takes ).*(</h1>$)"),
    ("accuracy", ".html", r"(^<svg )[\s\S]*?(^</svg>)"),
    ("accuracy", ".svg", r"(^<svg )[\s\S]*(^</svg>)"),
    ("", ".html", r"(<dt>Computing time of this run</dt><dd[^>]*>).*?(</dd>)"),
    ("", ".html", r"(<p>Made with ).*?(\. The same program on the same kind of processor)"),
    ("", ".html", r"(<p class=\"below\">Computed by ).*(\.</p>)"),
]]

# Progress is reported after five seconds, and every ten from then on: whole lines.
PROGRESS = re.compile(r"^softland: .*, \d+ s(, about \d+ s left)?(, cost .* \(plain step .*\)|, no feasible waveform yet)?$")

# Columns of tables on standard output that hold times, by verb and heading.
COLUMN_MASKS = {"effects": {"rhs"}, "accuracy": {"time", "Time of a closing"}}


def masked_key(kind, path):
    return any((not of or of == kind) and mask.fullmatch(path) for of, mask in JSON_MASKS)


def _without_columns(text, headings):
    """Right-aligned columns under these headings hold times. The widths of columns follow their content, so blanks are made two."""
    lines, ends = [], []
    for line in text.split("\n"):
        found = [match.end() for heading in headings for match in re.finditer(rf"(?<=\s){heading}(?!\S)", line)]
        if found and "  " in line and not re.search(r"\d", line):  # a line of headings
            ends = sorted(found, reverse=True)
        elif not line.strip():
            ends = []
        for end in ends:
            cell = re.search(rf"(?<=\s)({_TIME}|—)$", line[:end])
            if cell:
                line = line[:cell.start()] + MASK + line[end:]
        lines.append(re.sub(r" {2,}", "  ", line) if ends else line)
    return "\n".join(lines)


def masked_text(verb, file, text):
    """A text file of a step of `verb`, called `file`, without what may differ."""
    for of, where, expression in TEXT_MASKS:
        if (not of or of == verb) and file.endswith(where):
            text = expression.sub(lambda m: MASK.join(m.groups()), text)
    if file == "stderr":
        text = "\n".join(line for line in text.split("\n") if not PROGRESS.match(line))
    if file == "stdout" and verb in COLUMN_MASKS:
        text = _without_columns(text, COLUMN_MASKS[verb])
    return text
