"""notebooks.py OUT: the examples as notebooks, run where nbconvert is installed. A cell begins with `# %%`, one of text with `# %% [markdown]`."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path


def notebook(script: str) -> dict[str, object]:
    cells: list[dict[str, object]] = []
    for part in re.split(r"^# %%", script, flags=re.MULTILINE)[1:]:
        kind, _, body = part.partition("\n")
        text = body.strip("\n")
        if "[markdown]" in kind:
            text = re.sub(r"^# ?", "", text, flags=re.MULTILINE)
            cells.append({"cell_type": "markdown", "metadata": {}, "source": text.splitlines(keepends=True)})
        else:
            cells.append({"cell_type": "code", "metadata": {}, "source": text.splitlines(keepends=True), "outputs": [], "execution_count": None})
    kernel = {"display_name": "Python 3", "language": "python", "name": "python3"}
    return {"cells": cells, "metadata": {"kernelspec": kernel}, "nbformat": 4, "nbformat_minor": 4}


def main(out: Path) -> int:
    out.mkdir(parents=True, exist_ok=True)
    paths = []
    for script in sorted(Path(__file__).parent.glob("[0-9]*.py")):
        paths.append(out / f"{script.stem}.ipynb")
        paths[-1].write_text(json.dumps(notebook(script.read_text()), indent=1) + "\n")
    print("\n".join(map(str, paths)))
    try:
        import nbconvert  # noqa: F401
    except ImportError:
        print("nbconvert is not installed: the notebooks are not run", file=sys.stderr)
        return 0
    run = [sys.executable, "-m", "nbconvert", "--to", "notebook", "--execute", "--inplace"]
    environment = {"SOFTLAND_PROGRAM": str(Path(__file__).resolve().parents[2] / "softland"), **os.environ}
    return max(subprocess.run([*run, str(path)], check=False, env=environment).returncode for path in paths)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    sys.exit(main(Path(sys.argv[1])))
