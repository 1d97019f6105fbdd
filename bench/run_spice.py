#!/usr/bin/env python3
"""Simulates switches of `softland export --format spice-bench` in ngspice: the tables of results/spice.md.

    bench/run_spice.py PROGRAM [FOLDER]

Each shipped scene closes under its own drives, in ngspice and in softland. A second table has a source resistance of 1 Mohm before the
electrode, and integrates the current of the source.
"""
import json
import pathlib
import re
import subprocess
import sys
import time

SCENES = pathlib.Path(__file__).parent.parent / "scenes"
WINDOWS = {"mem-gold": "100 us", "mem-gold-pzt": "60 us", "nem-tin": "3 ns", "two-electrodes": "60 us", "gap-closing-actuator": "80 us"}


def simulated(program, scene, *words):
    run = subprocess.run([program, "simulate", scene, "--quiet", "--json", "-", *words], capture_output=True, text=True, check=False)
    return json.loads(run.stdout)


def exported(program, scene, *words):
    return subprocess.run([program, "export", scene, "--format", "spice-bench", *words], capture_output=True, text=True, check=False)


def measured(deck, place):
    place.write_text(deck)
    begin = time.monotonic()
    text = subprocess.run(["ngspice", "-b", place], capture_output=True, text=True, check=False).stdout
    values = {name: float(value) for name, value in re.findall(r"^(\w+)\s*=\s*([-+0-9.e]+)", text, re.MULTILINE)}
    return values, time.monotonic() - begin


def off(value, right):
    return f"{abs(value / right - 1):.1e}"


def shortened(folder, name):
    """Returns the scene with a window that ends before the closing becomes chaotic."""
    text = (SCENES / f"{name}.toml").read_text()
    if name in WINDOWS:
        line = f'duration = "{WINDOWS[name]}"'
        text = re.sub(r'^duration = .*$', line, text, count=1, flags=re.MULTILINE) if re.search(r"^duration", text, re.MULTILINE) else \
            text.replace("[simulate]", "[simulate]\n" + line, 1)
    place = folder / f"{name}.toml"
    place.write_text(text)
    return place


def main():
    program, folder = sys.argv[1], pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else "spice-decks")
    folder.mkdir(exist_ok=True)
    print("| scene | t_i | v_i | B_H | peak force | ngspice, s |\n|---|---|---|---|---|---|")
    for name in sorted(p.stem for p in SCENES.glob("*.toml")):
        scene = shortened(folder, name)
        deck = exported(program, scene)
        if deck.returncode != 0:
            print(f"| {name} | {deck.stderr.strip().split(': it has ')[-1]} | | | | |")
            continue
        got, seconds = measured(deck.stdout, folder / f"{name}.cir")
        result = simulated(program, scene)
        right, error = result["metrics"], result["errors"]
        height = right.get("major_bounce_height_m")
        rebound = off(1e-6 * got["rebound"], height) if height and "rebound" in got else ""
        force = off(1e-6 * got["force"], right["peak_contact_force_N"]) if right.get("peak_contact_force_N") else ""
        print(f"| {name} | {off(got['t_i'], right['initial_contact_time_s'])} | {off(got['v_i'], right['impact_velocity_m_s'])} | "
              f"{rebound} | {force} | {seconds:.1f} |")

    scene = SCENES / "mem-gold.toml"  # with the whole window, at the end of which it has settled
    deck = exported(program, scene).stdout
    slow = deck.replace("Xdrive_main main 0 softland_main", "Xdrive_main told 0 softland_main\nRsource told main 1e6")
    charge = slow.replace("meas tran t_i", "meas tran charge integ i(V.Xdrive_main.Vdrive)\nmeas tran t_i", 1)
    got, _ = measured(charge, folder / "source.cir")
    print("\n| of mem-gold behind 1 Mohm | ngspice | softland |\n|---|---|---|")
    own = simulated(program, scene, "--set", "driver.main.source_resistance=1 Mohm")["metrics"]
    print(f"| first contact | {1e6 * got['t_i']:.5f} us | {1e6 * own['initial_contact_time_s']:.5f} us |")
    volts = float(re.search(r"\+ [-0-9.e]+ ([-0-9.e]+)\n\+ \)", deck).group(1))
    usual = exported(program, shortened(folder, "mem-gold")).stdout.replace("reltol=1e-6", "reltol=1e-3")
    force = simulated(program, shortened(folder, "mem-gold"))["metrics"]["peak_contact_force_N"]
    got_usual, _ = measured(usual, folder / "usual.cir")
    print(f"| charge at the end | {-1e15 * got['charge']:.4f} fC | {1e15 * own['capacitance_F'] * volts:.4f} fC |")
    print(f"\nWith ngspice's usual reltol=1e-3 the peak force of mem-gold is {100 * abs(1e-6 * got_usual['force'] / force - 1):.2g} % off.")


if __name__ == "__main__":
    main()
