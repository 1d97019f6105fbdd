"""includes_test.py ARROWS ROOT: every file includes headers of its own folder and of folders to which arrows lead from it.

A compiler that compiles several folders as one unit finds the headers of all of them, so the includes are read here."""

import pathlib
import re
import sys

root = pathlib.Path(sys.argv[2])
uses = {}
with open(sys.argv[1], encoding="utf-8") as file:
    for line in file:
        folder, names = line.split(":")
        uses[folder] = [name for name in names.strip().split(";") if name]


def visible_from(folder):
    seen = {folder}
    waiting = [folder]
    while waiting:
        for name in uses.get(waiting.pop(), []):
            if name not in seen:
                seen.add(name)
                waiting.append(name)
    return seen


def owner(path):
    """Returns the folder of the arrows that has the file; the innermost one."""
    return max((folder for folder in uses if path.startswith(folder + "/")), key=len, default=None)


faults = []
count = 0
for folder in uses:
    visible = visible_from(folder)
    for path in sorted((root / folder).rglob("*")):
        name = path.relative_to(root).as_posix()
        if path.suffix not in (".h", ".cc") or owner(name) != folder:
            continue
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
            included = re.match(r'\s*#\s*include "([^"]+)"', line)
            target = included and owner(included.group(1))
            count += bool(target)
            if target and target not in visible:
                faults.append(f"{name}:{number}: includes {included.group(1)}, against the arrows")
if count < 1000:
    faults.append(f"only {count} includes were found")
print("\n".join(faults))
sys.exit(bool(faults))
