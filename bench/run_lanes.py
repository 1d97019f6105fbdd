#!/usr/bin/python3
"""Compares the closings of an ensemble per second and core with those of SciPy's LSODA. All are measured by turns in one run.

    bench/run_lanes.py BUILD > results/lanes.md
    bench/run_lanes.py BUILD --kinds      # the table of kinds of scenes alone

BUILD is configured with SOFTLAND_BENCH=ON. Takes about five minutes on a machine that does nothing else. PYTHON names the interpreter that
has NumPy and SciPy.
"""
import datetime
import json
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

from tables import machine, prefixed, revision

HERE = pathlib.Path(__file__).resolve().parent
SCENE = HERE.parent / "scenes" / "mem-gold.toml"
PYTHON = os.environ.get("PYTHON", "/usr/bin/python3")
ROUNDS = 5
# Quadrature and tolerance: those of simulate for accuracy 1e-4, and the loosest with errors of B_H below 1e-4 on 95 % of the devices.
SETTINGS = (("1e-4", "1e-5"), ("1e-3", "3e-5"))
PATHS = ("none", "avx2", "avx512")
SPLINE = 'waveform.main={family="bspline", levels=["0 V", "12 V", "18 V", "16 V", "19 V", "17 V", "18 V", "17.8 V"], duration="120 us"}'
DRIVER = ("driver.main.sample_rate=25 MHz", "driver.main.bits=14", "driver.main.bandwidth=1 MHz", "driver.main.max_slew=20 V/us")
SECTIONS = 'structure.sections=[{length="60 um", width="15 um"}, {length="190 um", thickness="2.2 um"}]'
KINDS = (("a cantilever of four modes", "mem-gold.toml", ()),
         ("its step from a source of 25 MS/s, 14 bits, 1 MHz, 20 V/us", "mem-gold.toml", ("waveform.main.rise_time=1 us", *DRIVER)),
         ("a spline", "mem-gold.toml", (SPLINE,)),
         ("the spline from that source", "mem-gold.toml", (SPLINE, *DRIVER)),
         ("six modes", "mem-gold.toml", ("structure.modes=6",)),
         ("eight modes", "mem-gold.toml", ("structure.modes=8",)),
         ("a bridge that stretches, five modes", "new/clamped-clamped.toml", ()),
         ("van der Waals and Casimir force", "nem-tin.toml", ()),
         *((f"film {film}", "mem-gold.toml", (f"gas.model={film}",)) for film in ("veijola", "gallis-torczynski", "near-contact", "guo-alexeenko")),
         ("a beam of two sections", "mem-gold.toml", (SECTIONS,)),
         ("two damped contacts and a back stop", "new/two-contacts.toml", ()),
         ("a plate, an electrode on either side, damped contact", "two-electrodes.toml", ()),
         ("a plate, an electrode of two faces, two films over slits", "gap-closing-actuator.toml", ()))
ONE_THREAD = {**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}


def json_of(*words):
    return json.loads(subprocess.run(words, capture_output=True, text=True, check=True, env=ONE_THREAD).stdout)


def against_scipy(bench):
    """Returns the rounds of bench_fleet for each setting, and the time of one closing by odeint for each round [s]."""
    settings, odeint = [[] for _ in SETTINGS], []
    for _ in range(ROUNDS):
        odeint.append(json_of(PYTHON, HERE / "peers" / "closing_scipy.py", "--method", "odeint", "--rtol", "1e-6", "--runs", "5")["wall_s"])
        for rounds, (accuracy, tolerance) in zip(settings, SETTINGS):
            rounds.append(json_of(bench, SCENE, "2000", accuracy, tolerance))
    return settings, odeint


def timed(program, words, vectors):
    """Returns the time [s] and the peak memory [MB] of a run."""
    with tempfile.TemporaryDirectory() as folder:
        begin = time.monotonic()
        child = subprocess.Popen([program, *words, "--quiet", "--out", folder], stdout=subprocess.DEVNULL,
                                 env={**os.environ, "SOFTLAND_VECTORS": vectors})
        _, status, used = os.wait4(child.pid, 0)
        if os.waitstatus_to_exitcode(status) not in (0, 4):
            sys.exit(f"{words}: exit status {os.waitstatus_to_exitcode(status)}")
        return time.monotonic() - begin, used.ru_maxrss / 1024


def kinds(bench):
    """Prints the closings per second of each kind of scene, one at a time and in lanes."""
    print(f"""## Kinds of scenes

The table has closings of 200 devices per second and core, one at a time and in lanes. They are medians of five rounds that take turns, so that their ratio
holds beside other work on the machine.

- made by `bench/run_lanes.py BUILD --kinds`, {datetime.date.today()}, revision {revision()}
- machine: {machine()}

| scene | one at a time | avx2 | avx512 | avx2, times | avx512, times |
|---|---|---|---|---|---|""")
    for words, scene, changes in KINDS:
        found = json_of(bench, HERE.parent / "scenes" / scene, "200", *SETTINGS[0], *changes)
        if found["not_in_lanes"]:
            sys.exit(f"{words}: {found['not_in_lanes']}")
        closing = {path["vectors"]: path["closing_s"] for path in found["paths"]}
        rates = [f"{1 / closing[path]:.0f}" if path in closing else "" for path in PATHS]
        times = [f"{closing['none'] / closing[path]:.1f}" if path in closing else "" for path in PATHS[1:]]
        print(f"| {words} | {' | '.join(rates + times)} |", flush=True)


def main():
    build = pathlib.Path(sys.argv[1]).resolve()
    bench, program = build / "bench" / "bench_fleet", build / "apps" / "softland"
    if "--kinds" in sys.argv:
        return kinds(bench)
    settings, odeint = against_scipy(bench)
    measured = [p for p in PATHS if any(p == found["vectors"] for found in settings[0][0]["paths"])]
    one = statistics.median(odeint)
    print(f"""# Closings of devices in lanes

The devices are of the process variation of `scenes/mem-gold.toml`, under a plain step to 1.25 Vdp, in the window that a search scores. A closing is that of one
device on one core, with building the device and sampling. Its error is that of B_H against a run at tolerance 1e-10 and quadrature of accuracy 1e-8, of 500
devices. SciPy is LSODA through odeint at rtol 1e-6, the loosest power of ten that delivers B_H to 1e-4: it takes {prefixed(one, "s")} for the same closing of the nominal
device. The table has medians of {ROUNDS} rounds that take the programs in turn, with the range over the rounds in brackets.

- made by `bench/run_lanes.py BUILD > results/lanes.md`, {datetime.date.today()}, revision {revision()}
- machine: {machine()}

| quadrature of accuracy | tolerance | instructions | building | closing | times odeint | error, median | 95 % | largest |
|---|---|---|---|---|---|---|---|---|""")
    for (accuracy, tolerance), rounds in zip(SETTINGS, settings):
        for name in measured:
            found = [next(p for p in r["paths"] if p["vectors"] == name) for r in rounds]
            built = statistics.median(r["building_s"] for r in rounds)
            closed = statistics.median(p["closing_s"] for p in found)
            ratios = [scipy / (r["building_s"] + p["closing_s"]) for scipy, r, p in zip(odeint, rounds, found)]
            errors = " | ".join(f"{found[0][key]:.1e}" for key in ("error_median", "error_95", "error_largest"))
            print(f"| {accuracy} | {tolerance} | {name} | {prefixed(built, 's')} | {prefixed(closed, 's')} | {statistics.median(ratios):.0f} "
                  f"({min(ratios):.0f} to {max(ratios):.0f}) | {errors} |", flush=True)
    print("""
## Reports and searches

Wall time on all cores.

| what | instructions | time | memory |
|---|---|---|---|""")
    search = ["optimize", SCENE, "--robust", "cvar:0.9", "--budget", "50000"]
    short = ["--set", "simulate.duration=100 us"]
    for name in measured:
        seconds, megabytes = timed(program, search, name)
        print(f"| robust search of 50 000 closings, verdict and report included | {name} | {seconds:.1f} s | {megabytes:.0f} MB |", flush=True)
    for devices, more, what in (("2000", short, "robustness of 2000 devices, window 100 us"),
                                ("100000", short, "of 100 000 devices"), ("100000", [], "of 100 000 devices, full window")):
        seconds, megabytes = timed(program, ["robustness", SCENE, "--samples", devices, *more], measured[-1])
        print(f"| {what} | {measured[-1]} | {seconds:.1f} s | {megabytes:.0f} MB |", flush=True)
    print(f"""
Commands: `softland {" ".join(str(w) if w != SCENE else "scenes/mem-gold.toml" for w in search)}` and
`softland robustness scenes/mem-gold.toml --samples N`, for the short window with `--set simulate.duration="100 us"`.
""")
    kinds(bench)


if __name__ == "__main__":
    main()
