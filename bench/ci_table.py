#!/usr/bin/env python3
"""Prints the tables of results/ci.md from the files that .ci/run writes.

    bench/ci_table.py build/release build/optimized.xml build/asan-ubsan build/sanitized.xml

Each build is followed by the file that `ctest --output-junit` wrote for it. Labels come from ctest, since its JUnit has none; a test with two labels
counts in both rows. Seconds are the sum over the tests, not wall time: two tests run at a time.
"""

import collections
import json
import os
import re
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree


def printable(name):
    """Returns the name without spaces and unprintable bytes, which JSON and XML write differently."""
    return re.sub(r"\[NON-UTF-8-BYTE-0x..\]|[^!-~]", "", name)


def labels_of(build):
    """Returns names and labels of all tests of the build. Keeps the log of its last run."""
    with tempfile.TemporaryDirectory() as here:
        with open(os.path.join(here, "CTestTestfile.cmake"), "w", encoding="utf-8") as file:
            file.write(f"subdirs([==[{os.path.abspath(build)}]==])\n")
        listed = subprocess.run(["ctest", "--test-dir", here, "--show-only=json-v1"], check=True, capture_output=True, text=True)
    labels = []
    for test in json.loads(listed.stdout)["tests"]:
        properties = {p["name"]: p["value"] for p in test.get("properties", [])}
        labels.append((printable(test["name"]), properties.get("LABELS", [])))
    return labels


def table(build, junit):
    all_labels = labels_of(build)
    labels = {name.rsplit("/", 1)[0]: of_one for name, of_one in all_labels} | dict(all_labels)
    suite = ElementTree.parse(junit).getroot()
    rows = collections.defaultdict(lambda: [0, 0, 0.0])  # number of tests, number of those that did not pass, seconds
    there = collections.Counter(label for _, of_one in all_labels for label in of_one)
    for case in suite.iter("testcase"):
        name = printable(case.get("name"))
        # ctest's JSON ends a name at an unprintable byte: take the labels from the test's other parameters.
        for label in (labels.get(name) or labels.get(name.rsplit("/", 1)[0], ["?"])) + ["all"]:
            row = rows[label]
            row[0] += 1
            row[1] += case.get("status") != "run"
            row[2] += float(case.get("time"))
    print(f"`{os.path.basename(os.path.normpath(build))}`, {suite.get('timestamp')}, {suite.get('time')} s by the clock; {len(all_labels)} tests in the build\n")
    print("| label | in the build | run | not passed | seconds |\n|---|---:|---:|---:|---:|")
    for label in sorted(set(there) | set(rows) - {"all"}) + ["all"]:
        count, bad, seconds = rows[label]
        print(f"| {label} | {there[label] if label != 'all' else len(all_labels)} | {count} | {bad} | {seconds:.0f} |")
    print()


def slowest(junit, most):
    cases = sorted(ElementTree.parse(junit).getroot().iter("testcase"), key=lambda case: -float(case.get("time")))
    for case in cases[:most]:
        print(f"{float(case.get('time')):8.1f} s  {case.get('name')}")


def main(words):
    if len(words) == 3 and words[0] == "--slowest":
        slowest(words[2], int(words[1]))
    elif words and len(words) % 2 == 0:
        for build, junit in zip(words[::2], words[1::2]):
            table(build, junit)
    else:
        sys.exit(__doc__ + "\nbench/ci_table.py --slowest N JUNIT names the N slowest tests.")


main(sys.argv[1:])
