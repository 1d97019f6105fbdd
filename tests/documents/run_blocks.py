"""run_blocks.py PROGRAM PAGE|FOLDER... [--quick] [--pictures] [--folder FOLDER]: run the blocks of the pages of the manual.

The blocks of a page run in their order, in one folder a page that begins with the links `scenes` and `examples`:

- ```sh: by bash -e, with softland on the path. ```python: all of a page in one interpreter.
- ```text after such a block: the block prints each of its lines; numbers may differ by 5 %, as on another processor. A line of dots stands for others.
- A comment before a block: <!-- save: FILE --> writes it to a file; <!-- not run: WHY --> leaves it out, and it is counted;
  <!-- quick: COMMAND --> is run in its place with --quick, and what it prints is not compared.
- <!-- picture: FILE --> before a picture: the file of the folder that it shows; --pictures copies it there.

A folder stands for the pages in its folders tutorial, howto, explanation and theory. Prints every fault and the number of blocks; exit status 1 when there
is a fault, or when more than 5 % of the blocks are left out. --quick leaves Python out.
"""

import argparse
import contextlib
import io
import os
import re
import shutil
import subprocess
import sys
import tempfile
import traceback
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PART = re.compile(
    r"^<!-- (?P<note>[a-z ]+): (?P<value>.*?) -->\n(?=```|!\[)|^```(?P<language>\w*)\n(?P<body>.*?)^```$|^!\[[^\]]*\]\((?P<image>[^)]+)\)",
    re.MULTILINE | re.DOTALL,
)
NUMBER = re.compile(r"\d+(?:\.\d+)?")
MOST_LEFT_OUT = 0.05  # share of the blocks, over all pages
KINDS = ("tutorial", "howto", "explanation", "theory")
NOTES = {"save", "not run", "quick", "picture"}


def alike(written, printed):
    """Whether two lines are the same but for spaces and 5 % of their numbers."""

    def skeleton(line):
        return re.sub(r"[\s#]+", " ", NUMBER.sub("#", line)).strip()

    a, b = NUMBER.findall(written), NUMBER.findall(printed)
    if skeleton(written) != skeleton(printed) or len(a) != len(b):
        return False
    return all(abs(float(x) - float(y)) <= max(0.05 * abs(float(x)), 0.2) for x, y in zip(a, b))


class Page:
    def __init__(self, path, folder, environment, options):
        self.path, self.folder, self.environment, self.options = path, folder, environment, options
        self.printed = None  # lines of the last block that ran; None where its output is not compared
        self.names = {"__name__": "__main__"}
        self.faults, self.ran, self.left_out = [], 0, 0

    def fault(self, text):
        self.faults.append(f"{self.path.relative_to(ROOT)}: {text}")

    def run(self):
        note = {}
        for part in PART.finditer(self.path.read_text(encoding="utf-8")):
            if part["note"]:
                if part["note"] not in NOTES:
                    self.fault(f"unknown comment: {part[0].strip()}")
                note[part["note"]] = part["value"]
                continue
            if part["image"]:
                self.picture(part["image"], note.get("picture"))
            else:
                self.block(part["language"], part["body"], note)
            note = {}

    def block(self, language, body, note):
        if "save" in note:
            path = self.folder / note["save"]
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(body, encoding="utf-8")
        elif language in ("sh", "python") and "not run" in note:
            self.left_out += 1
            self.printed = None
        elif language == "sh":
            quick = self.options.quick and "quick" in note
            self.shell(note["quick"] if quick else body)
            if quick:
                self.printed = None
        elif language == "python":
            self.printed = None
            if not self.options.quick:
                self.python(body)
        elif language == "text" and self.printed is not None:
            for line in body.splitlines():
                if line.strip(" .…") and not any(alike(line, printed) for printed in self.printed):
                    self.fault(f"not printed: {line}")

    def shell(self, body):
        done = subprocess.run(["bash", "-e", "-c", body], cwd=self.folder, env=self.environment, stdin=subprocess.DEVNULL,
                              capture_output=True, text=True, check=False)
        self.ran += 1
        self.printed = (done.stdout + done.stderr).splitlines()
        if done.returncode != 0:
            self.fault(f"exit status {done.returncode}: {body}{done.stderr}")

    def python(self, body):
        told = io.StringIO()
        before = os.getcwd()
        os.chdir(self.folder)
        try:
            with contextlib.redirect_stdout(told):
                exec(compile(body, str(self.path), "exec"), self.names)
        except Exception:  # a fault of the page, told with its place
            self.fault(f"{traceback.format_exc(limit=-1)}in: {body}")
        finally:
            os.chdir(before)
        self.ran += 1
        self.printed = told.getvalue().splitlines()

    def picture(self, image, made):
        if not made:
            return
        path = self.folder / made
        if not path.exists():
            if not self.options.quick:
                self.fault(f"no picture {made}")
        elif self.options.pictures:
            shutil.copyfile(path, self.path.parent / image)


def pages_of(folder):
    return [page for kind in KINDS for page in sorted((folder / kind).glob("*.md"))]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=Path)
    parser.add_argument("pages", type=Path, nargs="+")
    parser.add_argument("--quick", action="store_true", help="small budgets, no Python")
    parser.add_argument("--pictures", action="store_true", help="make the pictures of the pages again")
    parser.add_argument("--folder", type=Path, help="where the pages run, and what they write stays")
    options = parser.parse_args()
    faults, ran, left_out = [], 0, 0
    with tempfile.TemporaryDirectory() as scratch:
        base = options.folder or Path(scratch)
        tools = Path(scratch) / "path"
        tools.mkdir()
        (tools / "softland").symlink_to(options.program.resolve())
        environment = {**os.environ, "PATH": f"{tools}:{os.environ['PATH']}", "COLUMNS": "100"}
        os.environ.update(environment)
        pages = [page for path in options.pages for page in ([path] if path.is_file() else pages_of(path))]
        for path in pages:
            folder = base.resolve() / path.stem
            folder.mkdir(parents=True, exist_ok=True)
            for name in ("scenes", "examples"):
                if not (folder / name).exists():
                    (folder / name).symlink_to(ROOT / name)
            page = Page(path.resolve(), folder, environment, options)
            page.run()
            print("\n".join(page.faults), end="\n" if page.faults else "")
            print(f"{path}: {page.ran} blocks run, {page.left_out} left out, {len(page.faults)} faults")
            faults, ran, left_out = faults + page.faults, ran + page.ran, left_out + page.left_out
    if left_out > MOST_LEFT_OUT * (ran + left_out) and len(pages) > 1:
        faults.append(f"more than {MOST_LEFT_OUT:.0%} of the blocks are left out")
        print(faults[-1])
    print(f"{ran} blocks run, {left_out} left out, {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
