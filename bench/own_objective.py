"""own_objective.py compares the time of a search for devices with an objective in Python and with the equal target of softland. Prints a table of results/python.md.

Times are processor times of all threads [s], which depend little on other work of the machine.
"""

import time

import softland


def gentle(closing, step):
    return closing["peak_contact_force"] / step["peak_contact_force"]


scene = softland.shipped("mem-gold")
for name, what in (("objective", {"objective": gentle}), ("target", {"target": "force"})):
    began = time.process_time()
    found = scene.optimize(robust="cvar:0.9", waveform="pulse", budget=4000, samples=64, jobs=2, **what)
    took = time.process_time() - began
    print(f"{name:10s} {took:6.2f} s, {found.evaluations} candidates, peak contact force {found.metrics.peak_contact_force:.6g} N")
