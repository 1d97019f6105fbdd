"""evaluator.py PROGRAM compares the time of `Evaluator` in Python with that of the same loop in C++ (bench_evaluator_loop). Prints a table of results/python.md.

Times are processor times of all threads, which depend little on other work of the machine. Both loops take turns, and the least time of each counts.
"""

import re
import subprocess
import sys
import time

import numpy as np
import softland

PROGRAM = sys.argv[1]
JOBS = 2
KEYS = ["structure.thickness", "structure.youngs_modulus", "gap.electrode"]
FIGURES = ["initial_contact_time", "impact_velocity", "major_bounce_height"]


def least(work, times):
    """Returns the least processor time of several runs [s]."""
    took = []
    for _ in range(times):
        began = time.process_time()
        work()
        took.append(time.process_time() - began)
    return min(took)


def rows_of(evaluate, n):
    return evaluate.nominal * (1 + 0.02 * np.random.default_rng(1).standard_normal((n, len(evaluate.keys))))


scene = softland.shipped("mem-gold")
evaluate = scene.evaluator(KEYS, FIGURES, jobs=JOBS)
rows = rows_of(evaluate, 10_000)
one_thread = scene.evaluator(KEYS, FIGURES, jobs=1)
many = one = loop = loop_one = float("inf")
for _ in range(3):
    many = min(many, least(lambda: evaluate(rows), 1))
    one = min(one, least(lambda: one_thread(rows[0]), 100))
    native = subprocess.run([PROGRAM, "--jobs", str(JOBS)], capture_output=True, text=True, check=True).stdout
    now, now_one = map(float, re.findall(r"[\d.e+-]+", native)[:2])
    loop, loop_one = min(loop, now), min(loop_one, now_one)
four = least(lambda: one_thread(rows[:4]), 200)
single = least(lambda: scene.simulate(errors=False), 50)
length = scene.evaluator(["structure.length", *KEYS], FIGURES, jobs=JOBS)
rebuilt = least(lambda: length(rows_of(length, 1000)), 3)
each = scene.evaluator(KEYS, FIGURES, vdp="each", jobs=JOBS)
own_volts = least(lambda: each(rows[:200]), 3)
print("| what | time | beside |")
print("|---|---:|---:|")
print(f"| 10 000 rows, {JOBS} threads | {many:.3f} s | {many / loop:.3f} of the same loop in C++ ({loop:.3f} s) |")
print(f"| one row | {one * 1e3:.3f} ms | {one / loop_one:.2f} of one closing of that device in C++ ({loop_one * 1e3:.3f} ms) |")
print(f"| four rows, in lanes | {four * 1e3:.3f} ms | {four / one:.2f} of one row |")
print(f"| `scene.simulate(errors=False)` | {single * 1e3:.3f} ms | integrated to 1e-6 instead of 1e-5 |")
print(f"| 1000 rows of another length | {rebuilt:.3f} s | {rebuilt / 1000 / (many / 10_000):.2f} of a row without |")
print(f"| 200 rows with vdp=\"each\" | {own_volts:.3f} s | {own_volts / 200 / (many / 10_000):.1f} of a row with the volts of the scene |")
