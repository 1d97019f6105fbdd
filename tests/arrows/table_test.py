"""table_test.py ARROWS CONTRIBUTING.md: the table of folders says of each what it uses as CMake does, and no arrow leads back."""

import re
import sys

arrows = {}
with open(sys.argv[1], encoding="utf-8") as file:
    for line in file:
        folder, uses = line.split(":")
        arrows[folder] = [name for name in uses.strip().split(";") if name]
with open(sys.argv[2], encoding="utf-8") as file:
    rows = re.findall(r"^\| `([a-z_/]+)/` \| [^|]+ \| ([^|]*)\|$", file.read(), re.MULTILINE)
table = {folder: [name for name in uses.strip().split(", ") if name] for folder, uses in rows}
table.setdefault("python", arrows.get("python", []))
arrows.setdefault("python", table["python"])  # built where it is asked for

faults = [f"{folder} uses {arrows.get(folder)}, and the table says {table.get(folder)}"
          for folder in sorted(arrows.keys() | table.keys()) if arrows.get(folder) != table.get(folder)]
order = list(table)
faults += [f"{folder} stands above {used}, which it uses" for folder, uses in table.items() for used in uses
           if used in order and order.index(used) > order.index(folder)]
if len(table) < 15:
    faults.append(f"the table has {len(table)} rows")
print("\n".join(faults))
sys.exit(bool(faults))
