"""What differs between two records, by file and key."""

import collections
import csv
import difflib
import io
import json
import pathlib
import re

import masks

NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")


class Real(str):
    """A number of JSON as it is written: 3 is not 3.0, and every digit counts."""


def near(a, b, tolerance):
    """Two numbers as text, or texts whose numbers are near and whose rest is the same."""
    if a == b:
        return True
    if tolerance <= 0:
        return False
    if NUMBER.sub("0", a) != NUMBER.sub("0", b):
        return False
    for x, y in zip(NUMBER.findall(a), NUMBER.findall(b)):
        x, y = float(x), float(y)
        if abs(x - y) > tolerance * max(abs(x), abs(y)):
            return False
    return True


def short(a, b, width=60):
    """Two texts, cut about where they part."""
    at = next((i for i, (x, y) in enumerate(zip(a, b)) if x != y), min(len(a), len(b)))
    begin = max(0, at - width // 2) if max(len(a), len(b)) > 2 * width else 0

    def cut(text):
        piece = text[begin:begin + 2 * width]
        return ("…" if begin else "") + piece + ("…" if begin + 2 * width < len(text) else "")
    return cut(a), cut(b)


def parsed(text):
    return json.loads(text, parse_float=Real, parse_int=Real)


def document(text):
    if text.lstrip()[:1] not in ("{", "["):
        return None
    try:
        return parsed(text)
    except ValueError:
        return None


class Comparison:
    """The differences of two files. Each kind of file yields (where, where in general, what is in the first, what is in the second)."""

    def __init__(self, tolerance, masking=True):
        self.tolerance, self.masking = tolerance, masking

    def json(self, kind, a, b, path="", general=""):
        if self.masking and general and masks.masked_key(kind, general):
            return
        if isinstance(a, dict) and isinstance(b, dict):
            for key in [*a, *(key for key in b if key not in a)]:
                below, all_below = (f"{path}.{key}" if path else key), (f"{general}.{key}" if general else key)
                if key in a and key in b:
                    yield from self.json(kind, a[key], b[key], below, all_below)
                elif not (self.masking and masks.masked_key(kind, all_below)):
                    yield below, all_below, *(json.dumps(d[key], ensure_ascii=False) if key in d else "(none)" for d in (a, b))
            if a.keys() == b.keys() and list(a) != list(b):
                yield f"{path} (order of keys)", general, " ".join(a), " ".join(b)
        elif isinstance(a, list) and isinstance(b, list):
            if len(a) != len(b):
                yield f"{path} (length)", f"{general}[]", str(len(a)), str(len(b))
            for i, (x, y) in enumerate(zip(a, b)):
                yield from self.json(kind, x, y, f"{path}[{i}]", f"{general}[]")
        elif type(a) is not type(b) or a != b:
            texts = [str(x) if isinstance(x, Real) else json.dumps(x, ensure_ascii=False) for x in (a, b)]
            if not (type(a) is type(b) and isinstance(a, str) and near(a, b, self.tolerance)):
                yield path, general, *texts

    def documents(self, text_a, text_b, kind=None):
        a, b = document(text_a), document(text_b)
        if a is None or b is None:
            yield from self.lines(text_a, text_b)
            return
        if kind is None and isinstance(a, dict):
            kind = a.get("kind", "status" if "stores" in a else "")
        found = False
        for one in self.json(kind or "", a, b):
            found = True
            yield one
        if not found and kind != "accuracy" and layout(text_a) != layout(text_b):
            yield from ((f"layout, {where}", "layout", x, y) for where, _, x, y in self.lines(layout(text_a), layout(text_b)))

    def csv(self, text_a, text_b):
        a, b = (list(csv.reader(io.StringIO(text))) for text in (text_a, text_b))
        if not a or not b or a[0] != b[0] or len(a) != len(b):
            yield from self.lines(text_a, text_b)
            return
        found = False
        for number, (x, y) in enumerate(zip(a, b)):
            if len(x) != len(y):
                found = True
                yield f"row {number} (length)", "row", str(len(x)), str(len(y))
                continue
            for column, (p, q) in enumerate(zip(x, y)):
                if not near(p, q, self.tolerance):
                    found = True
                    name = a[0][column] if column < len(a[0]) else str(column)
                    yield f"row {number}, {name}", f"column {name}", *short(p, q)
        if not found and self.tolerance <= 0:  # quotes, or ends of lines
            yield from self.lines(text_a, text_b)

    def lines(self, text_a, text_b):
        a, b = text_a.split("\n"), text_b.split("\n")
        if len(a) == len(b):
            for number, (x, y) in enumerate(zip(a, b), 1):
                if not near(x, y, self.tolerance):
                    yield f"line {number}", f"line {words(x)}", *short(x, y)
            return
        for tag, i, i_end, j, j_end in difflib.SequenceMatcher(None, a, b, autojunk=False).get_opcodes():
            if tag == "equal":
                continue
            for k in range(max(i_end - i, j_end - j)):
                x = a[i + k] if i + k < i_end else None
                y = b[j + k] if j + k < j_end else None
                if x is not None and y is not None and near(x, y, self.tolerance):
                    continue
                pair = short(x or "", y or "")
                yield (f"line {i + k + 1}" if x is not None else f"after line {i_end}", f"line {words(y if x is None else x)}",
                       pair[0] if x is not None else "(none)", pair[1] if y is not None else "(none)")

    def store(self, text_a, text_b):
        def masked(text):
            lines = []
            for line in text.split("\n"):
                table, _, row = line.partition(" ")
                hidden = masks.STORE_MASKS.get(table) if self.masking else None
                if hidden:
                    row = {key: masks.MASK if key in hidden else value for key, value in json.loads(row).items()}
                    line = f"{table} {json.dumps(row, ensure_ascii=False)}"
                lines.append(line)
            return lines
        a, b = masked(text_a), masked(text_b)
        if len(a) != len(b):
            yield from self.lines("\n".join(a), "\n".join(b))
            return
        for number, (x, y) in enumerate(zip(a, b), 1):
            if x == y:
                continue
            (table, _, p), (other, _, q) = x.partition(" "), y.partition(" ")
            if table == other and p[:1] == q[:1] == "{":
                for path, general, u, v in self.json("store", parsed(p), parsed(q)):
                    yield f"line {number}, {table}.{path}", f"{table}.{general}", *short(u, v)
            elif not near(x, y, self.tolerance):
                yield f"line {number}", f"line {words(x)}", *short(x, y)

    def html(self, verb, name, text_a, text_b):
        script = re.compile(r'(<script type="application/json" id="data">)(.*?)(</script>)', re.S)
        data_a, data_b = script.search(text_a), script.search(text_b)
        if data_a and data_b:
            kind = "accuracy page" if verb == "accuracy" else "page"
            yield from ((f"data {path}", f"data {general}", x, y) for path, general, x, y in self.documents(data_a.group(2), data_b.group(2), kind))
            text_a, text_b = script.sub(r"\1\3", text_a), script.sub(r"\1\3", text_b)
        if self.masking:
            text_a, text_b = (masks.masked_text(verb, name, text) for text in (text_a, text_b))
        yield from self.lines(text_a, text_b)

    def file(self, verb, name, a, b):
        """The differences of two files of a step of `verb`."""
        if a == b:
            return
        try:
            text_a, text_b = a.decode(), b.decode()
        except UnicodeDecodeError:
            yield "bytes", "bytes", f"{len(a)} bytes", f"{len(b)} bytes"
            return
        if text_a.startswith("SQLite store\n"):
            yield from self.store(text_a, text_b)
        elif name.endswith(".json") or (name == "stdout" and document(text_a) is not None):
            yield from self.documents(text_a, text_b)
        elif name.endswith(".html"):
            yield from self.html(verb, name, text_a, text_b)
        elif name.endswith(".csv"):
            yield from self.csv(text_a, text_b)
        else:
            if self.masking:
                text_a, text_b = (masks.masked_text(verb, name, text) for text in (text_a, text_b))
            yield from self.lines(text_a, text_b)


def layout(text):
    """JSON without its values: keys, order, blanks."""
    tokens = r'"(?:\\.|[^"\\])*"(\s*:)?|[-+0-9.eE]+|true|false|null'
    return re.sub(tokens, lambda token: token[0] if token[1] else "_", text)


def words(line):
    """What a line is about, without its numbers."""
    return NUMBER.sub("#", line).strip()[:50]


def verb_of(path):
    """The verb of the step whose file this is: .../NN-VERB/..."""
    for part in path.parts:
        found = re.fullmatch(r"\d\d-(.*)", part)
        if found:
            return found.group(1)
    return ""


def compare(folder_a, folder_b, most=6, tolerance=0.0, masking=True, say=print):
    files = [{path.relative_to(folder) for path in folder.rglob("*") if path.is_file()} for folder in (folder_a, folder_b)]
    comparison = Comparison(tolerance, masking)
    keys, places, differing = collections.Counter(), 0, 0
    for path in sorted(files[0] & files[1]):
        a, b = ((folder / path).read_bytes() for folder in (folder_a, folder_b))
        if a == b:
            continue
        found = 0
        seen = set()
        for where, general, x, y in comparison.file(verb_of(path), path.name, a, b):
            found += 1
            seen.add(general)
            if found == 1:
                say(f"{path}")
            if found <= most:
                x, y = short(x, y)
                say(f"    {where}: {x} -> {y}")
        if found > most:
            say(f"    and {found - most} more")
        if found:
            differing += 1
            places += found
            keys.update(seen)
    for name, only in (("first", files[0] - files[1]), ("second", files[1] - files[0])):
        for path in sorted(only)[:50]:
            say(f"only in the {name}: {path}")
        if len(only) > 50:
            say(f"and {len(only) - 50} more only in the {name}")
    alone = len(files[0] ^ files[1])
    if keys:
        say("most often:")
        for key, count in keys.most_common(12):
            say(f"    {key}: in {count} files")
    say(f"{differing} of {len(files[0] & files[1])} files differ, in {places} places; {alone} are in one record only")
    return 1 if differing or alone else 0
