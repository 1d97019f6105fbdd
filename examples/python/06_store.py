# %% [markdown]
# # The store of an exploration, in NumPy, pandas and SQL
# `softland explore` writes its results into one SQLite file, which can be read at any time.

# %%
import os
import sqlite3
import subprocess
import tempfile
from pathlib import Path

import softland

folder = Path(tempfile.mkdtemp())
store = folder / "map.sqlite"
program = os.environ.get("SOFTLAND_PROGRAM", "./softland")  # in the folder of softland
scene = folder / "gold.toml"
softland.shipped("mem-gold").save(scene)
plan = ["--vary", "gap.contact=1.8 um:2.2 um:5", "--vary", "structure.thickness=1.9 um:2.1 um:3"]
subprocess.run([program, "explore", str(scene), *plan, "--out", str(store)], check=True, capture_output=True)

# %% [markdown]
# The rows are a structured array of NumPy, from which pandas makes a table:

# %%
found = softland.open(store)
assert isinstance(found, softland.Store)
rows = found.rows()
print(found, rows["impact_velocity_m_s"].max())

# %%
try:
    table = found.table()
    print(table.groupby("gap_contact_m")["impact_velocity_m_s"].mean())
except ImportError:
    print("pandas is not installed")

# %% [markdown]
# Any program that speaks SQL reads the file, too:

# %%
with sqlite3.connect(f"file:{store}?mode=ro", uri=True) as database:
    (fastest,) = database.execute('SELECT max("impact_velocity_m_s") FROM results').fetchone()
print(f"fastest touch {fastest * 1e3:.1f} mm/s of {len(found)} points")
