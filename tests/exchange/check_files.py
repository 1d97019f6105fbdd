#!/usr/bin/env python3
"""check_files.py PROGRAM FOLDER: whether `softland read` finds in the files of a folder what its right-values.json says of them.

That file maps names of files to what another reader found: samples, first_time_s, last_time_s, interval_mean_s or true_interval_s,
repeated_times, and of each of "channels" first, last, min and max; or a "verdict" that holds "refuse". Files of modes and meshes must be
refused. Prints a line for each file; the exit status is 1 where one is wrong.
"""

import json
import pathlib
import subprocess
import sys

NO_RECORDS = ("comsol", "calculix", "ansys", "uff55")


def is_near(found, right):
    return found is not None and abs(found - right) <= 1e-9 * max(abs(found), abs(right))


def wrong_times(time, right):
    if "first_time_s" not in right:
        return []
    interval = right.get("true_interval_s", right.get("interval_mean_s", right.get("interval_s")))
    due = {"first_s": right["first_time_s"], "last_s": right["last_time_s"], "interval_s": interval, "repeated": right.get("repeated_times", 0)}
    return [f"{key} is {time[key]}, not {value}" for key, value in due.items() if not is_near(time[key], value)]


def wrong_channels(found, right):
    channels = right.get("channels") or {"": right}
    wrong = []
    for place, (heading, due) in enumerate(channels.items()):
        named = [c for c in found if c["name"] and (heading == c["name"] or heading.startswith(c["name"]))]
        if not named and place >= len(found):
            wrong.append(f"there is no channel {heading}")
            continue
        channel = max(named, key=lambda c: len(c["name"])) if named else found[place]
        values = {"samples": right["samples"], "first": due["first"], "last": due["last"], "minimum": due["min"], "maximum": due["max"]}
        wrong += [f"{key} of {heading} is {channel[key]}, not {value}" for key, value in values.items() if not is_near(channel[key], value)]
    return wrong


def wrong_in(program, path, right):
    done = subprocess.run([program, "read", path, "--json", "-"], capture_output=True, text=True)
    if path.name.startswith(NO_RECORDS) or "refuse" in right.get("verdict", ""):
        return [] if done.returncode == 2 else [f"exit status {done.returncode}; it must be refused"]
    if done.returncode != 0:
        return [done.stderr.strip()]
    data = json.loads(done.stdout)
    return wrong_times(data["time"], right) + wrong_channels(data["channels"], right)


def main():
    program, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    failed = False
    for name, right in json.loads((folder / "right-values.json").read_text()).items():
        wrong = wrong_in(program, folder / name, right)
        failed |= bool(wrong)
        print(f"{name}: {'; '.join(wrong) or 'right'}")
    sys.exit(failed)


main()
