#!/usr/bin/python3
"""mutants.py make|run BUILD FOLDER...: how many small faults, put into the sources at random places, the tests notice.

In a copy of the tree that is thrown away, for its sources are rewritten (`git worktree add --detach /tmp/mutants && cd /tmp/mutants`):

  cmake -S . -B build/mutants -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_UNITY_BUILD=ON -DCMAKE_CXX_FLAGS_RELEASE='-O1 -DNDEBUG' \
    -DCMAKE_CXX_FLAGS="-w -include $PWD/tests/mutants/mutant.h"
  tests/mutants/mutants.py make build/mutants model objectives waveforms --number 200 --seed 1
  ninja -C build/mutants test_model test_objectives test_waveforms test_studies
  tests/mutants/mutants.py run build/mutants model objectives waveforms studies

`make` finds the places by clang's syntax tree (Debian's python3-clang-16), draws some, and writes number K, at a + b, as
(::softland_mutant::is(K) ? (a - b) : (a + b)): one build has all mutants, and SOFTLAND_MUTANT=K runs one. The sources of FOLDER... and of their
tests are checked by the commands of the build, and what does not compile is drawn again. build/mutants/mutants.json lists them. A mutant is one of

  + - * /  += -= *= /=   its opposite           &&  ||    the other
  <  >  ==               <=  >=  !=, and back   -a        a
  if (a)                 if (!a)                1, 0.5    1 + 1, 2 * 0.5 (1.0 for 0.0)

in code that runs: not in constants, static_assert, arguments of templates, labels of cases, sizes of arrays or initial values of statics.

`run` runs every case of tests/FOLDER... once, but for those named _slow or slower than 60 s, to see which mutants it reaches. Each mutant then
meets the cases that reach it, the quickest first, until one fails, crashes or takes ten times as long: those of its own folder, then the others
in their order. build/mutants/mutants.jsonl gets a line for each; a run goes on from there.
"""
import argparse
import collections
import json
import os
import pathlib
import random
import re
import shlex
import subprocess
import sys
import tempfile
import time

from clang.cindex import CursorKind as Kind, Diagnostic, Index, StorageClass, TypeKind

OPPOSITE = {"+": "-", "*": "/", "+=": "-=", "*=": "/=", "&&": "||", "<": "<=", ">": ">=", "==": "!="}
OPPOSITE |= {new: old for old, new in OPPOSITE.items()}
NAMES = {each.value for each in (Kind.DECL_REF_EXPR, Kind.MEMBER_REF_EXPR, Kind.CALL_EXPR)}
NUMBER = re.compile(r"(\d[\d']*\.?[\d']*(?:[eE][-+]?\d+)?)[fuUlLzZ]*$")

# A place spans start to end of a file, offsets in bytes: there `old`, which stands at `at`, becomes `new`. A condition of an `if` is negated as a whole.
Place = collections.namedtuple("Place", "file start end kind at old new")


class Finder:
    """The texts of the files in some folders, and the places in them."""

    def __init__(self, root, folders):
        self.folders = tuple(str(root / folder) + "/" for folder in folders)
        self.texts, self.paths, self.places = {}, {}, set()

    def file_of(self, cursor):
        name = cursor.location.file.name if cursor.location.file else ""
        if name not in self.paths:
            self.paths[name] = os.path.realpath(name)
            if self.paths[name].startswith(self.folders):
                self.texts[self.paths[name]] = pathlib.Path(self.paths[name]).read_bytes()
        return self.paths[name]

    def add(self, file, start, end, kind, at, old, new):
        text, before, after = self.texts[file][start:end], self.texts[file][start - 1:start], self.texts[file][end:end + 1]
        if b"//" not in text and b"#" not in text and before != b"<" and after != b">":  # comparisons have blanks, templates have none
            self.places.add(Place(file, start, end, kind, at, old, new))

    def walk(self, cursor, above, runs):
        """This node, `above` which stands one of that kind, and those below it; `runs`: they are not worked out by the compiler."""
        try:
            kind = cursor.kind
        except ValueError:  # concepts, of which the bindings do not know
            return
        file, start, end = self.file_of(cursor), cursor.extent.start.offset, cursor.extent.end.offset
        if not file.startswith(self.folders) or kind in (Kind.STATIC_ASSERT, Kind.ENUM_DECL, Kind.TEMPLATE_NON_TYPE_PARAMETER, Kind.TYPE_ALIAS_DECL):
            return
        below = list(cursor.get_children())
        text = self.texts[file][start:end].decode()
        if kind == Kind.VAR_DECL:
            declared = self.texts[file][:start].rsplit(b"\n", 1)[-1][-40:].decode() + re.split("[={]", text)[0]
            type_of = cursor.type.get_canonical()
            whole = type_of.is_const_qualified() and TypeKind.BOOL.value <= type_of.kind.value <= TypeKind.INT128.value
            if not runs or cursor.storage_class == StorageClass.STATIC or "constexpr" in declared or \
                    whole and not any(each._kind_id in NAMES for each in cursor.walk_preorder()):
                return
        if kind == Kind.CASE_STMT or kind == Kind.IF_STMT and text.startswith("if constexpr"):
            below = below[1:]
        if runs and kind == Kind.IF_STMT and text.startswith("if (") and below[0].kind.is_expression():
            self.add(file, below[0].extent.start.offset, below[0].extent.end.offset, "if", below[0].extent.start.offset, "", "!")
        if runs and kind in (Kind.BINARY_OPERATOR, Kind.COMPOUND_ASSIGNMENT_OPERATOR, Kind.CALL_EXPR):
            self.add_operator(file, start, end, below)
        if runs and kind in (Kind.UNARY_OPERATOR, Kind.CALL_EXPR) and re.match("-[^-]", text) and \
                sum(child.extent.start.offset > start for child in below) == 1:
            self.add(file, start, end, "minus", start, "-", "")
        if runs and kind in (Kind.INTEGER_LITERAL, Kind.FLOATING_LITERAL):
            self.add_number(file, start, end, text, above)
        for child in below:
            self.walk(child, kind, runs or kind in (Kind.COMPOUND_STMT, Kind.CONSTRUCTOR, Kind.FIELD_DECL, Kind.PARM_DECL))

    def add_operator(self, file, start, end, below):
        sides = sorted((child.extent.start.offset, child.extent.end.offset) for child in below)
        sides = [(a, b) for a, b in sides if self.texts[file][a:b].decode() not in OPPOSITE]  # an overloaded operator is a child, too
        if len(sides) == 2 and sides[0][0] == start and sides[1][1] == end:
            between = self.texts[file][sides[0][1]:sides[1][0]].decode()
            if (old := between.strip()) in OPPOSITE:
                self.add(file, start, end, "operator", sides[0][1] + between.index(old), old, OPPOSITE[old])

    def add_number(self, file, start, end, text, above):
        value = NUMBER.match(text)
        before = self.texts[file][:start].rstrip()[-1:]
        of_a_type = above in (Kind.VAR_DECL, Kind.FIELD_DECL, Kind.PARM_DECL) and before not in (b"=", b"{", b"(")
        if value and not of_a_type and above not in (Kind.DECL_REF_EXPR, Kind.MEMBER_REF_EXPR, Kind.OVERLOADED_DECL_REF):
            whole = not re.search("[.eE]", value[1])
            new = f"{text} + 1" if whole else "1.0" if float(value[1].replace("'", "")) == 0 else f"2 * {text}"
            self.add(file, start, end, "number", start, text, new)


def commands(build, *folders):
    """How the build compiles the files of these folders."""
    for entry in json.loads((build / "compile_commands.json").read_text()):
        arguments = shlex.split(entry["command"])
        output = arguments.index("-o")
        if arguments[output + 1].startswith(tuple(f"{folder}/" for folder in folders)):
            yield [argument for argument in arguments[:output] + arguments[output + 2:] if not argument.endswith("ccache")]


def find(build, root, folders):
    finder = Finder(root, folders)
    sys.setrecursionlimit(10000)
    for arguments in commands(build, *folders):
        options = [each for before, each in zip(arguments, arguments[1:])
                   if re.match("-(D|I|std|march|isystem|include)", each) or before in ("-isystem", "-include")]
        unit = Index.create().parse(arguments[-1], options)
        for each in unit.diagnostics:
            if each.severity >= Diagnostic.Error:
                sys.exit(f"{arguments[-1]}: {each}")
        for child in unit.cursor.get_children():
            finder.walk(child, None, False)
    return finder


def rewritten(text, mutants):
    """The text with all of these (number, place), of which some stand inside others."""

    def render(start, end, within):
        parts = []
        while within:
            number, place = within[0]
            inner = [mutant for mutant in within[1:] if mutant[1].end <= place.end]
            within = within[1 + len(inner):]
            parts += [text[start:place.start], one(number, place, inner)]
            start = place.end
        return b"".join(parts) + text[start:end]

    def one(number, place, inner):
        original = render(place.start, place.end, inner)
        if place.kind == "if":
            return b"(::softland_mutant::is(%d) != static_cast<bool>(%s))" % (number, original)
        after = place.at + len(place.old)
        changed = render(place.start, place.at, [mutant for mutant in inner if mutant[1].end <= place.at]) + place.new.encode() + \
            render(after, place.end, [mutant for mutant in inner if mutant[1].start >= after])
        return b"(::softland_mutant::is(%d) ? (%s) : (%s))" % (number, changed.replace(b"\n", b" "), original)  # lines keep their numbers

    return render(0, len(text), sorted(mutants, key=lambda mutant: (mutant[1].start, -mutant[1].end, mutant[1].kind != "if")))


def lines_of(place, texts):
    first = texts[place.file].count(b"\n", 0, place.start) + 1
    return range(first, first + texts[place.file].count(b"\n", place.start, place.end) + 1)


def not_compiled(build, folders, mutants, texts):
    """Those on whose lines the compiler finds errors, or on the last line of ours that led it to one."""
    on = collections.defaultdict(set)
    for mutant in mutants:
        for line in lines_of(mutant[1], texts):
            on[mutant[1].file, line].add(mutant)
    bad = set()
    for arguments in commands(build, *folders, *(f"tests/{folder}" for folder in folders)):
        done = subprocess.run([*arguments, "-fsyntax-only", "-fmax-errors=0"], cwd=build, capture_output=True, text=True)
        led, found = [], set()
        for line in done.stderr.splitlines():
            place = re.match(r"\s*([^\s:]+):(\d+)", line)
            led += [on[os.path.realpath(place[1]), int(place[2])]] if place else []
            if " error: " in line:
                found |= next((each for each in reversed(led) if each), set())
                led = []
        if done.returncode != 0 and not found:
            sys.exit(f"{arguments[-1]} does not compile for another reason:\n{done.stderr[:3000]}")
        bad |= found
    return bad


def make(build, folders, count, seed):
    root = pathlib.Path(re.search(r"CMAKE_HOME_DIRECTORY:INTERNAL=(.*)", (build / "CMakeCache.txt").read_text())[1])
    finder = find(build, root, folders)
    drawn = sorted(finder.places)
    random.Random(seed).shuffle(drawn)
    waiting, mutants = list(enumerate(drawn, 1)), set()

    def write():
        for file, text in finder.texts.items():
            new = rewritten(text, [mutant for mutant in mutants if mutant[1].file == file])
            if pathlib.Path(file).read_bytes() != new:
                pathlib.Path(file).write_bytes(new)

    while len(mutants) < count and waiting:
        more = (count - len(mutants)) * 5 // 4 + 5  # one in twenty does not compile
        mutants, waiting, bad = mutants | set(waiting[:more]), waiting[more:], True
        while bad:
            write()
            bad = not_compiled(build, folders, mutants, finder.texts)
            mutants -= bad
    mutants = sorted(mutants)[:count]
    write()
    told = [{"mutant": number, "file": str(pathlib.Path(place.file).relative_to(root)), "line": lines_of(place, finder.texts)[0], "kind": place.kind,
             "old": place.old, "new": place.new, "text": finder.texts[place.file][place.start:place.end].decode()} for number, place in mutants]
    (build / "mutants.json").write_text(json.dumps(told, indent=1))
    print(f"{len(told)} mutants at {len(drawn)} places")


def run_cases(program, cases, seconds, **environment):
    """"passed", the name of a case that failed, "crash" or "timeout"."""
    with tempfile.TemporaryDirectory() as folder:
        try:
            done = subprocess.run([program, "--gtest_brief=1", "--gtest_fail_fast", f"--gtest_filter={':'.join(cases)}"],
                                  env={**os.environ, "OMP_NUM_THREADS": "1", "RC_PARAMS": "seed=1", **environment},
                                  cwd=folder, timeout=seconds, capture_output=True, text=True, errors="replace")
        except subprocess.TimeoutExpired:
            return "timeout"
    failed = re.search(r"\[  FAILED  \] ([^\s,]+)", done.stdout)
    return failed[1] if failed else "crash" if done.returncode != 0 else "passed"


def cases_of(program):
    """The cases that pass, the quickest first: (name, seconds, mutants it reaches)."""
    kept = program.with_suffix(".reached.json")
    if kept.exists():
        return json.loads(kept.read_text())
    suite, cases = "", []
    for line in subprocess.run([program, "--gtest_list_tests"], capture_output=True, text=True, check=True).stdout.splitlines():
        name = line.split("#")[0].rstrip()
        if not name.startswith(" "):
            suite = name if name.endswith(".") else ""
        elif suite and not re.search("_slow(/|$)", name):
            begin = time.monotonic()
            with tempfile.NamedTemporaryFile("r") as file:
                end = run_cases(program, [suite + name.strip()], 60, SOFTLAND_MUTANTS_REACHED=file.name)
                cases.append((suite + name.strip(), time.monotonic() - begin, sorted({int(number) for number in file.read().split()})))
            if end != "passed":
                print(f"{program.name}: {cases.pop()[0]} does not pass in 60 s without a mutant, and is left out", flush=True)
    cases.sort(key=lambda case: case[1])
    kept.write_text(json.dumps(cases))
    print(f"{program.name}: {len(cases)} cases, {sum(case[1] for case in cases):.0f} s", flush=True)
    return cases


def meet(program, number):
    """What of the program catches the mutant, "lives" or "not reached"."""
    reaching = [case for case in cases_of(program) if number in case[2]]
    end = "lives" if reaching else "not reached"
    while reaching and end == "lives":
        some = [reaching.pop(0)]
        while reaching and len(some) < 300 and sum(case[1] for case in some) < 3:
            some.append(reaching.pop(0))
        end = run_cases(program, [case[0] for case in some], 10 + 10 * sum(case[1] for case in some), SOFTLAND_MUTANT=str(number))
        end = "lives" if end == "passed" else f"{end} from {some[0][0]} on" if end in ("crash", "timeout") else end
    return end


def run(build, folders):
    results, done = build / "mutants.jsonl", {}
    for line in results.read_text().splitlines() if results.exists() else []:
        done[json.loads(line)["mutant"]] = json.loads(line)
    for mutant in json.loads((build / "mutants.json").read_text()):
        mutant = done.setdefault(mutant["mutant"], {**mutant, "met": {}, "caught_by": ""})
        before = len(mutant["met"])
        for folder in sorted(folders, key=lambda folder: folder != mutant["file"].split("/")[0]):
            if not mutant["caught_by"] and folder not in mutant["met"]:
                mutant["met"][folder] = meet(build / "tests" / folder / f"test_{folder}", mutant["mutant"])
                mutant["caught_by"] = "" if mutant["met"][folder] in ("lives", "not reached") else folder
        if len(mutant["met"]) > before:
            with results.open("a") as file:
                file.write(json.dumps(mutant) + "\n")
    caught = collections.Counter(mutant["caught_by"] for mutant in done.values())
    own = sum(mutant["caught_by"] == mutant["file"].split("/")[0] for mutant in done.values())
    print(f"{len(done)} mutants: {own} caught by the tests of their own folder, {len(done) - caught['']} by any")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=("make", "run"))
    parser.add_argument("build", type=lambda name: pathlib.Path(name).resolve())
    parser.add_argument("folders", nargs="+", help="of sources, for make; of tests, for run")
    parser.add_argument("--number", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    told = parser.parse_args()
    make(told.build, told.folders, told.number, told.seed) if told.what == "make" else run(told.build, told.folders)


if __name__ == "__main__":
    main()
