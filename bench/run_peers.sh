#!/bin/bash
# How much faster than SciPy's LSODA one closing is: both programs measured in turn, in one run, on one thread.
#
#   bench/run_peers.sh BUILD/bench/bench_closing > results/reference-closing-speed.md
#
# Builds nothing. Rounds alternate between the programs, so that whatever else the machine does meets both; the median of all
# rounds is given. PYTHON names the interpreter that has NumPy and SciPy, ROUNDS the number of rounds.
set -euo pipefail

if [[ $# -ne 1 || ! -x $1 ]]; then
  echo "usage: $0 BENCH_CLOSING (the benchmark program of a build with SOFTLAND_BENCH=ON)" >&2
  exit 2
fi
bench=$1
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
python=${PYTHON:-/usr/bin/python3}
rounds=${ROUNDS:-7}
export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 PYTHONDONTWRITEBYTECODE=1

measured=$(mktemp -d)
trap 'rm -r "$measured"' EXIT
for ((round = 1; round <= rounds; ++round)); do
  "$bench" --integrator lawson --tolerance 1e-6 --runs 101 --json > "$measured/softland.$round.json"
  for method in odeint LSODA; do
    "$python" "$here/peers/closing_scipy.py" --method "$method" --rtol 1e-6 --runs 3 > "$measured/$method.$round.json"
  done
done
revision=$(git -C "$here" describe --always --dirty 2> /dev/null || echo unknown)

"$python" - "$measured" "$rounds" "$revision" << 'PYTHON'
import datetime
import json
import pathlib
import platform
import statistics
import sys

import numpy
import scipy

folder, rounds, revision = pathlib.Path(sys.argv[1]), int(sys.argv[2]), sys.argv[3]


def load(name):
    return [json.loads((folder / f"{name}.{k}.json").read_text()) for k in range(1, rounds + 1)]


def processor():
    for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return platform.processor() or platform.machine()


runs = load("softland")
reference = runs[0]["reference"]
keys = ("initial_contact_time_s", "impact_velocity_m_s", "major_bounce_height_m")
rows = []


def row(name, closings, rhs):
    figures = closings[0]
    error = max(abs(figures[k] - reference[k]) / abs(reference[k]) for k in keys)
    rows.append({"name": name, "figures": figures, "error": error, "rhs": statistics.median(rhs),
                 "walls": [c["wall_s"] for c in closings]})


row("softland, Dormand-Prince", [r["closings"][0] for r in runs], [r["rhs_s"] for r in runs])
for method, name in (("odeint", "SciPy, LSODA through odeint"), ("LSODA", "SciPy, LSODA through solve_ivp")):
    closings = load(method)
    row(name, closings, [c["wall_per_rhs_s"] for c in closings])

print(f"""# Speed of the reference closing

Gold cantilever of `scenes/mem-gold.toml`, step of {runs[0]["drive"]} without rise time, window {runs[0]["window_s"] * 1e6:g} us,
{runs[0]["modes"]} modes, {runs[0]["quadrature_points"]} quadrature points, rtol 1e-6. Same equations, two programs, one thread each, measured in turn.
Times are medians of {rounds} rounds; "error" is the largest relative error of t_i, v_i and B_H against a run at 1e-11;
"times slower" is the median over the rounds, with its range.

| program | t_i [us] | v_i [m/s] | B_H [nm] | error | right-hand sides | one right-hand side [us] | one closing [ms] | times slower |
|---|---|---|---|---|---|---|---|---|""")
ratios = {}
for r in rows:
    f = r["figures"]
    each = [wall / base for wall, base in zip(r["walls"], rows[0]["walls"])]
    ratios[r["name"]] = statistics.median(each)
    slower = f"{ratios[r['name']]:.0f} ({min(each):.0f} to {max(each):.0f})" if r is not rows[0] else "1"
    print(f"| {r['name']} | {f[keys[0]] * 1e6:.4f} | {f[keys[1]]:.5f} | {f[keys[2]] * 1e9:.2f} | {r['error']:.1e} "
          f"| {f['rhs_evaluations']} | {r['rhs'] * 1e6:.3g} | {statistics.median(r['walls']) * 1e3:.3g} | {slower} |")
quickest = min(list(ratios.items())[1:], key=lambda item: item[1])
print(f"""
Against the quicker of the two ({quickest[0]}) softland is **{quickest[1]:.0f} times** faster.

- machine: {processor()}, {platform.system()} {platform.release()}
- date: {datetime.date.today().isoformat()}, revision {revision}
- SciPy {scipy.__version__}, NumPy {numpy.__version__}, Python {platform.python_version()}
- command: `bench/run_peers.sh BUILD/bench/bench_closing > results/reference-closing-speed.md`, with BUILD configured by
  `-DCMAKE_BUILD_TYPE=Release -DSOFTLAND_BENCH=ON`
- what it runs, in turn: `bench_closing --integrator lawson --tolerance 1e-6 --runs 101 --json`,
  `bench/peers/closing_scipy.py --method odeint --rtol 1e-6 --runs 3`, `... --method LSODA ...`""")
PYTHON
