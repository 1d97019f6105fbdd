#!/usr/bin/env python3
"""Compares the choices that `softland optimize` offers, on switches with and without a stable path: the tables of results/quasi-static.md.

    bench/run_choices.py PROGRAM FOLDER [--seeds 1,2,3] [--only NAME ...] [--scene FILE ...]

Searches with a result in FOLDER are not run again. Runs one search at a time, on all cores.
"""
import argparse
import json
import pathlib
import resource
import subprocess
import time

from run_race import SCENES, quantity, table

D31 = 'spread."piezo.d31"={ distribution = "normal", cov = "3 %" }'
# Name, scene, actuator, assignments of keys.
SWITCHES = [
    ("PZT switch, pzt", "mem-gold-pzt", "pzt", []),
    ("PZT switch, both", "mem-gold-pzt", "both", []),
    ("d31 3 %, pzt", "mem-gold-pzt", "pzt", [D31]),
    ("d31 3 %, both", "mem-gold-pzt", "both", [D31]),
    ("contact before the fold", "mem-gold", "electrostatic",
     ["gap.contact=1.4 um", "waveform.main.level=17.77 V", "driver.main.max_voltage=25 V", "simulate.duration=1800 us"]),
    ("mem-gold", "mem-gold", "electrostatic", []),
    ("two electrodes", "two-electrodes", "electrostatic", []),
    ("nem-tin", "nem-tin", "electrostatic", []),
]
SPEED, HEIGHT, FORCE = "largest_impact_velocity_m_s", "major_bounce_height_m", "peak_contact_force_N"
STEADY, TOUCH = "steady_force_time_s", "initial_contact_time_s"


def searched(program, folder, switch, seed):
    """Returns the result and its processor time [s]."""
    name, scene, actuator, keys = switch
    place = folder / f"{name.replace(' ', '-').replace(',', '').replace('%', '')}-{seed}"
    kept = place / "cost.json"
    if not kept.exists():
        before, begun = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
        sets = [word for key in keys for word in ("--set", key)]
        run = subprocess.run([program, "optimize", scene if scene.endswith(".toml") else SCENES / f"{scene}.toml", "--actuator", actuator, "--seed", str(seed), "--quiet",
                              "--out", place, *sets], capture_output=True, text=True, check=False)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        if run.returncode not in (0, 4):
            raise SystemExit(f"{place}: {run.stderr}")
        kept.write_text(json.dumps({"wall_s": time.monotonic() - begun, "processor_s": after.ru_utime - before.ru_utime}))
    return json.loads((place / "result.json").read_text()), json.loads(kept.read_text())


def cells(row):
    """Returns the cells for a row of devices: 95th and 99th percentiles."""
    at, far = row["quantile_95"], row["quantile_99"]
    yields = " / ".join(f"{100 * row['yield'][height]:.0f}" for height in ("1e-9", "1e-8", "1e-7"))
    return [f"{quantity(at[SPEED], 'm/s')} ({quantity(far[SPEED], 'm/s')})", f"{quantity(at[HEIGHT], 'm')} ({quantity(far[HEIGHT], 'm')})",
            quantity(at[FORCE], "N"), f"{quantity(at.get(STEADY), 's')} ({quantity(far.get(STEADY), 's')})", quantity(at[TOUCH], "s"), yields]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--seeds", default="1,2,3")
    parser.add_argument("--only", action="append", default=[], help="switches of these names alone")
    parser.add_argument("--scene", action="append", default=[], help="one more, of electrostatic drives")
    asked = parser.parse_args()
    asked.folder.mkdir(parents=True, exist_ok=True)
    lines, paths = [], []
    for switch in SWITCHES + [(pathlib.Path(scene).stem, scene, "electrostatic", []) for scene in asked.scene]:
        if asked.only and switch[0] not in asked.only:
            continue
        for seed in asked.seeds.split(","):
            result, cost = searched(asked.program, asked.folder, switch, int(seed))
            devices = result["devices"]
            rows = {row["name"]: row for row in devices["rows"]}
            if seed == asked.seeds.split(",")[0]:
                lines.append([switch[0], "plain step", "", ""] + cells(rows["plain step"]) + [""])
                path = devices["stable_path"]
                paths.append([switch[0], f"{path['drives'][0]}, {path['reaches_V']:.4g} V" if path else "none",
                              f"{100 * path['share_of_devices']:.1f} %" if path else ""])
            for choice in devices["choices"]:
                row = rows["for the devices" if choice["name"] == "default" else choice["name"]]
                tau = f"{choice['tau']:.2f}" if choice["tau"] is not None else ""
                last = f"{cost['processor_s']:.0f}, {cost['wall_s']:.0f}" if choice["name"] == "default" else ""
                lines.append([switch[0], f"{choice['name']}: {choice['waveform']}", seed, tau] + cells(row) + [last])
            if "electrode at t = 0" in rows:
                lines.append([switch[0], "electrode at t = 0", seed, ""] + cells(rows["electrode at t = 0"]) + [""])
    print("\n".join(table(["switch", "carried by", "share of devices with a path"], paths)))
    print("\n".join(table(["switch", "choice", "seed", "tau", "impact", "rebound", "force", "steady", "first contact",
                           "≤ 1 / 10 / 100 nm, %", "processor, wall s"], lines)))


if __name__ == "__main__":
    main()
