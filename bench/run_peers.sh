#!/bin/bash
# How much faster than SciPy's integrators one closing is: all measured in turn, in one run, on one thread.
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

# Of each peer the loosest power of ten that, like every tighter one, delivers B_H to 1e-4.
peers=(odeint:1e-6 LSODA:1e-6 BDF:1e-7 Radau:1e-5)
accuracy=1e-4

measured=$(mktemp -d)
trap 'rm -r "$measured"' EXIT
for ((round = 1; round <= rounds; ++round)); do
  "$bench" --integrator lawson --accuracy "$accuracy" --runs 201 --json > "$measured/softland.$round.json"
  for peer in "${peers[@]}"; do
    "$python" "$here/peers/closing_scipy.py" --method "${peer%:*}" --rtol "${peer#*:}" --runs 1 > "$measured/${peer%:*}.$round.json"
  done
done
revision=$(git -C "$here" describe --always --dirty 2> /dev/null || echo unknown)

"$python" - "$measured" "$rounds" "$revision" "${peers[*]}" << 'PYTHON'
import datetime
import json
import pathlib
import platform
import statistics
import sys

import numpy
import scipy

folder, rounds, revision = pathlib.Path(sys.argv[1]), int(sys.argv[2]), sys.argv[3]
peers = dict(peer.split(":") for peer in sys.argv[4].split())


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


row(f"softland, accuracy {runs[0]['closings'][0]['tolerance'] * 10:.0e}", [r["closings"][0] for r in runs],
    [r["rhs_s"] for r in runs])
names = {"odeint": "LSODA through odeint", "LSODA": "LSODA through solve_ivp", "BDF": "BDF", "Radau": "Radau"}
for method, rtol in peers.items():
    closings = load(method)
    row(f"SciPy, {names[method]}, rtol {rtol}", closings, [c["wall_per_rhs_s"] for c in closings])

print(f"""# Speed of the reference closing

Gold cantilever of `scenes/mem-gold.toml`, step of {runs[0]["drive"]} without rise time, window {runs[0]["window_s"] * 1e6:g} us,
{runs[0]["modes"]} modes. Same equations, two programs, one thread each, measured in turn, every one at the loosest of its
tolerances (powers of ten) that, like every tighter one, delivers B_H to 1e-4; softland at `simulate.accuracy = 1e-4`, which means {runs[0]["quadrature_points"]} quadrature points
(SciPy has 30, which costs it little: its time is that of the interpreter). Times are medians of {rounds} rounds; "error" is the largest relative error of t_i, v_i and B_H
against a run at 1e-12 with 48 points per length; "times slower" is the median over the rounds, with its range.

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
Against the quickest of them ({quickest[0]}) softland is **{quickest[1]:.0f} times** faster.

- machine: {processor()}, {platform.system()} {platform.release()}
- date: {datetime.date.today().isoformat()}, revision {revision}
- SciPy {scipy.__version__}, NumPy {numpy.__version__}, Python {platform.python_version()}
- command: `bench/run_peers.sh BUILD/bench/bench_closing > results/reference-closing-speed.md`, with BUILD configured by
  `-DCMAKE_BUILD_TYPE=Release -DSOFTLAND_BENCH=ON`
- what it runs, in turn: `bench_closing --integrator lawson --accuracy 1e-4 --runs 201 --json`,
  `bench/peers/closing_scipy.py --method METHOD --rtol RTOL`""")
PYTHON
