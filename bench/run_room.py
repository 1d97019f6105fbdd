#!/usr/bin/env python3
"""Compares results of `softland optimize` with more room: higher limits, longer windows, more drives. The table of results/quasi-static.md (More room).

    bench/run_room.py PROGRAM FOLDER [--seeds 1,2] [--only NAME ...]

Searches with a result in FOLDER are not run again. Runs one search at a time, on all cores.
"""
import argparse
import pathlib

from run_choices import SPEED, TOUCH, searched
from run_race import quantity, table

GOLD, PZT = "mem-gold", "mem-gold-pzt"
ONE, THREE, TEN = ([f"driver.piezo.min_voltage=-{v} V", f"driver.piezo.max_voltage={v} V"] for v in (1, 3, 10))
# Name, and rows with increasing room: name of the row, scene, actuator, assignments of keys.
LADDERS = [
    ("limit of the piezo", [("1 V", PZT, "pzt", ONE), ("3 V", PZT, "pzt", THREE), ("10 V", PZT, "pzt", TEN)]),
    ("limit of the electrode", [("1.5 Vdp", GOLD, "electrostatic", ["driver.main.max_voltage=1.5 Vdp"]),
                                ("1.5 Vsp", GOLD, "electrostatic", ["driver.main.max_voltage=1.5 Vsp"]),
                                ("3 Vdp", GOLD, "electrostatic", ["driver.main.max_voltage=3 Vdp"]),
                                ("6 Vdp", GOLD, "electrostatic", ["driver.main.max_voltage=6 Vdp"])]),
    ("window", [("600 us", GOLD, "electrostatic", []), ("1800 us", GOLD, "electrostatic", ["simulate.duration=1800 us"])]),
    ("drives", [("piezo", PZT, "pzt", []), ("piezo and electrode", PZT, "both", [])]),
]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--seeds", default="1,2")
    parser.add_argument("--only", nargs="*")
    options = parser.parse_args()
    rows = []
    for ladder, steps in LADDERS:
        if options.only and ladder not in options.only:
            continue
        for seed in options.seeds.split(","):
            narrowest = None
            for room, scene, actuator, keys in steps:
                result, cost = searched(options.program, options.folder, (f"{ladder} {room}", scene, actuator, keys), seed)
                at = next(row for row in result["devices"]["rows"] if row["name"] == "for the devices")["quantile_95"]
                price = result["best"]["cost"]
                narrowest = narrowest or price
                rows.append([ladder, room, seed, quantity(at[SPEED], "m/s"), quantity(at[TOUCH], "s"), f"{price:.5f}", f"{price / narrowest:.3f}",
                             f"{cost['processor_s']:.0f}"])
    print("\n".join(table(["more of", "room", "seed", "impact", "first contact", "cost", "over the narrowest", "processor s"], rows)))


if __name__ == "__main__":
    main()
