#!/usr/bin/env python3
"""A record of what the program says, to see that a change changed only what it meant to.

  record.py make PROGRAM FOLDER [--jobs N] [--only WORD]...   run every case and keep what it says and writes
  record.py compare A B [--lines N] [--tolerance T]          what differs, by file and key
  record.py list PROGRAM [--only WORD]...                     the cases and their commands
  record.py self-test PROGRAM                                 a small record twice, and mistakes in it that compare has to see

Exit status: 0 done, no difference; 1 there are differences, or the self-test failed; 2 usage.
CONTRIBUTING.md tells how to build the program for it. What is not compared, as the clock or the machine decides it: masks.py.
"""

import argparse
import concurrent.futures
import contextlib
import fcntl
import hashlib
import json
import os
import pathlib
import resource
import shlex
import shutil
import sqlite3
import subprocess
import sys
import time

sys.dont_write_bytecode = True
import cases as all_the_cases  # noqa: E402
import differences  # noqa: E402
import self_test  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[2]
WORK = pathlib.Path("/tmp/softland-record")
MOST_SECONDS = 900  # of one step
MOST_MEMORY = 4 << 30  # address space of one step [bytes]: a fault in one case does not take the machine down

# These decide the bits of a result, beside the program. The C library takes its sin, exp and pow by the processor unless it is told
# which instructions not to use (names of glibc 2.33 and later, then of earlier ones). Lanes of devices decide, where there are several.
FIXED = {
    "LC_ALL": "C", "TZ": "UTC", "COLUMNS": "100", "PATH": "/usr/bin:/bin",
    "GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX2,-FMA,-FMA4,-AVX2_Usable,-FMA_Usable,-FMA4_Usable",
    "SOFTLAND_VECTORS": "avx2",
    "OPENBLAS_CORETYPE": "Prescott", "OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1",  # where BLAS is OpenBLAS
}


def environment(home):
    return {**FIXED, "HOME": str(home), "TMPDIR": str(home)}


def dump(path):
    """The tables of an SQLite store as text, a row a line, in an order that does not depend on who wrote first."""
    lines = ["SQLite store"]
    with sqlite3.connect(f"file:{path}?mode=ro", uri=True) as store:
        for pragma in ("application_id", "user_version"):
            lines.append(f"{pragma} {store.execute(f'PRAGMA {pragma}').fetchone()[0]}")
        for name, sql in sorted(store.execute("SELECT name, sql FROM sqlite_master").fetchall()):
            lines.append(f"schema {name} {sql}")
        for (name,) in sorted(store.execute("SELECT name FROM sqlite_master WHERE type = 'table'").fetchall()):
            cursor = store.execute(f'SELECT * FROM "{name}"')
            columns = [column[0] for column in cursor.description]
            rows = [{c: v.hex() if isinstance(v, bytes) else v for c, v in zip(columns, row)} for row in cursor]
            # Sort rows by what they are, never by what the clock put into them.
            order = [c for c in ("plan", "session", "position", "point", "status") if c in columns]
            rows.sort(key=lambda row: [(str(type(row[c])), row[c]) for c in order])
            lines += [f"{name} {json.dumps(row, ensure_ascii=False)}" for row in rows]
    store.close()
    return "\n".join(lines) + "\n"


def content_of(path):
    """(suffix, bytes) of a file as it is kept."""
    with open(path, "rb") as file:
        store = file.read(16) == b"SQLite format 3\0"
    return (".txt", dump(path).encode()) if store else ("", path.read_bytes())


def files_of(work):
    return {path.relative_to(work): path for path in sorted(work.rglob("*")) if path.is_file()}


def stamp(path):
    s = path.stat()
    return s.st_mtime_ns, s.st_size, s.st_ino


def beside_scenes():
    """The files that shipped scenes name, by their own names."""
    return {path.name: path.read_text(encoding="utf-8") for path in sorted((ROOT / "scenes").glob("*.csv"))}


def run_case(program, case, scenes, folder, place):
    work, home = place / case.name / "work", place / case.name / "home"
    work.mkdir(parents=True)
    home.mkdir()

    try:
        beside = ((f"scenes/{n}", t) for n, t in beside_scenes().items())
        for name, text in [*((f"scenes/{n}.toml", t) for n, t in scenes.items()), *beside, *case.inputs.items()]:
            (work / name).parent.mkdir(parents=True, exist_ok=True)
            (work / name).write_text(text, encoding="utf-8")
        seen = {name: stamp(path) for name, path in files_of(work).items()}
        digests = {}
        transcript = b""
        for number, step in enumerate(case.steps, 1):
            if step.needs and not (work / step.needs).exists():
                continue
            kept = folder / case.name if case.brief else folder / case.name / f"{number:02}-{step.words[0]}"
            kept.mkdir(parents=True, exist_ok=True)
            command = " ".join([*(f"{k}={v}" for k, v in step.environment.items()), shlex.join(["softland", *step.words])])
            try:
                done = subprocess.run([program, *step.words], cwd=work, env={**environment(home), **step.environment},
                                      input=step.told.encode(), capture_output=True, timeout=MOST_SECONDS)
                status, out, err = done.returncode, done.stdout, done.stderr
            except subprocess.TimeoutExpired:
                status, out, err = f"none after {MOST_SECONDS} s", b"", b""
            head = f"$ {command}\nstatus {status}\n".encode()
            if case.brief:
                transcript += head + out + err + b"\n"
            else:
                for name, content in (("run", head), ("stdout", out), ("stderr", err)):
                    (kept / name).write_bytes(content)
            now = files_of(work)
            for name, path in now.items():
                if seen.get(name) == stamp(path):
                    continue
                seen[name] = stamp(path)
                if name.name == case.leave_out:
                    continue
                suffix, content = content_of(path)
                digest = hashlib.sha256(content).digest()
                if digests.get(name) == digest:  # written again, and the same
                    continue
                digests[name] = digest
                to = kept / "files" / (str(name) + suffix)
                to.parent.mkdir(parents=True, exist_ok=True)
                to.write_bytes(content)
            gone = sorted(seen.keys() - now.keys())
            for name in gone:
                del seen[name]
            if gone:
                (kept / "gone").write_text("".join(f"{name}\n" for name in gone), encoding="utf-8")
        if case.brief:
            (folder / case.name / "transcript").write_bytes(transcript)
    finally:
        shutil.rmtree(place / case.name, ignore_errors=True)


@contextlib.contextmanager
def workplace(place):
    """The folder in which cases run: always the same, since a search keeps the path of its scene, and a hash of that."""
    lock = open(f"{place}.lock", "w", encoding="utf-8")
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        raise SystemExit(f"record: another record is being made in {place}") from None
    try:
        shutil.rmtree(place, ignore_errors=True)
        place.mkdir(mode=0o700)
        yield
    finally:
        shutil.rmtree(place, ignore_errors=True)
        os.unlink(lock.name)
        lock.close()


def installed(program, scenes, place):
    """The program as if it were installed in that folder, beside its scenes: it tells these paths, never those of a tree."""
    at = place / "program" / "bin" / "softland"
    at.parent.mkdir(parents=True)
    shutil.copy(program.path, at)
    shipped = place / "program" / "share" / "softland" / "scenes"
    shipped.mkdir(parents=True)
    for name, text in scenes.items():
        (shipped / f"{name}.toml").write_text(text, encoding="utf-8")
    for name, text in beside_scenes().items():
        (shipped / name).write_text(text, encoding="utf-8")
    return at


def chosen(cases, only):
    some = [case for case in cases if not only or any(word in case.name for word in only)]
    if not some:
        raise SystemExit("record: no case of this name")
    return some


def program_at(path):
    path = pathlib.Path(path).resolve()
    if not os.access(path, os.X_OK) or path.is_dir():
        raise SystemExit(f"record: {path} is no program")
    return all_the_cases.Program(path, environment("/nonexistent"))


def make(program, folder, only=(), jobs=1, quiet=False, place=WORK):
    begin = time.monotonic()
    folder = pathlib.Path(folder).resolve()
    if folder.exists() and any(folder.iterdir()):
        raise SystemExit(f"record: {folder} is not empty")
    folder.mkdir(parents=True, exist_ok=True)
    cases, scenes = all_the_cases.all_cases(program, ROOT / "scenes")
    cases = sorted(chosen(cases, only), key=lambda case: -case.weight)
    taken = {}
    with workplace(place):
        copy = installed(program, scenes, place)

        def one(case):
            start = time.monotonic()
            run_case(copy, case, scenes, folder, place)
            return case, time.monotonic() - start

        with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
            for number, done in enumerate(concurrent.futures.as_completed([pool.submit(one, case) for case in cases]), 1):
                case, seconds = done.result()
                taken[case.name] = seconds
                if not quiet:
                    print(f"{number} of {len(cases)}  {time.monotonic() - begin:6.0f} s  {case.name}, {seconds:.1f} s", flush=True)
    files = [path for path in folder.rglob("*") if path.is_file()]
    size = sum(path.stat().st_size for path in files)
    if not quiet:
        slowest = sorted(taken, key=taken.get, reverse=True)[:8]
        print("slowest: " + ", ".join(f"{name} {taken[name]:.0f} s" for name in slowest))
        print(f"{len(cases)} cases of {sum(len(case.steps) for case in cases)} runs, {len(files)} files, {size} bytes, "
              f"{time.monotonic() - begin:.0f} s with {jobs} at a time ({sum(taken.values()):.0f} s in all)")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    verbs = parser.add_subparsers(dest="verb", required=True)
    for verb in ("make", "list"):
        of = verbs.add_parser(verb)
        of.add_argument("program")
        if verb == "make":
            of.add_argument("folder")
            of.add_argument("--jobs", type=int, default=os.cpu_count() or 1, help="cases at a time (default: one per core)")
        of.add_argument("--only", action="append", default=[], metavar="WORD", help="cases whose name holds it")
    of = verbs.add_parser("compare")
    of.add_argument("a")
    of.add_argument("b")
    of.add_argument("--lines", type=int, default=6, help="of each file (default: 6)")
    of.add_argument("--tolerance", type=float, default=0, help="numbers this near, relatively, are the same")
    of.add_argument("--unmasked", action="store_true", help="also what the clock and the machine decide")
    of = verbs.add_parser("self-test")
    of.add_argument("program")
    asked = parser.parse_args()
    try:
        if asked.verb == "make":
            resource.setrlimit(resource.RLIMIT_AS, (MOST_MEMORY, MOST_MEMORY))
            make(program_at(asked.program), asked.folder, asked.only, max(1, asked.jobs))
            return 0
        if asked.verb == "list":
            for case in chosen(all_the_cases.all_cases(program_at(asked.program), ROOT / "scenes")[0], asked.only):
                print(case.name)
                for step in case.steps:
                    print("   ", shlex.join(["softland", *step.words])[:300])
            return 0
        if asked.verb == "self-test":
            return self_test.run(lambda folder, only, place: make(program_at(asked.program), folder, only, 1, True, place))
        for folder in (asked.a, asked.b):
            if not pathlib.Path(folder).is_dir():
                raise SystemExit(f"record: {folder} is no folder")
        return differences.compare(pathlib.Path(asked.a), pathlib.Path(asked.b), asked.lines, asked.tolerance, not asked.unmasked)
    except SystemExit as end:
        if isinstance(end.code, str):
            print(end.code, file=sys.stderr)
            return 2
        raise


if __name__ == "__main__":
    sys.exit(main())
