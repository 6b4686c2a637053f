#!/usr/bin/env python3
"""Measures what building costs, in a fresh clone and without a compiler cache.

    build.py [--json] [--only NAME]..

build_processor_s       processor time to build what ./dmise demo runs [s]
demo_from_clone_s       from a clone to the end of ./dmise demo, the packages being installed [s]
test_build_processor_s  processor time to build all the rest: tests, benchmarks, other programs [s]
tests_s                 from the demonstration's end: set-up, build and tests of ./dmise test [s]
incremental_s           preset debug: a change of one source of core/ to a test that has run [s]

The clone is of the last commit. It needs 6 GB of disk and, on two cores, some 40 minutes.
"""

import argparse
import json
import os
import pathlib
import resource
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
TARGETS = {"build_processor_s": 480, "demo_from_clone_s": 300, "test_build_processor_s": None, "tests_s": 1200, "incremental_s": 20}
SOURCE, TEST, FILTER = "core/detection/light/psf_growth.cpp", "test_detection", "MeasuredPsf.*"


def run(clone, *command):
    """Runs a command in the clone. Returns wall and processor time [s]; exits with its last lines if it fails."""
    before, began = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
    done = subprocess.run(command, cwd=clone, env=os.environ | {"CCACHE_DISABLE": "1"}, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode:
        sys.exit(f"build: {' '.join(command)} failed:\n" + "\n".join(done.stdout.splitlines()[-15:]))
    return time.monotonic() - began, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def from_clone(clone):
    wall_s, processor_s = run(clone, "./dmise", "build", "demo_programs")
    yield "build_processor_s", processor_s
    yield "demo_from_clone_s", wall_s + run(clone, "./dmise", "demo")[0]


def rest(clone):
    wall_s, processor_s = run(clone, "./dmise", "build", "all")
    yield "test_build_processor_s", processor_s
    yield "tests_s", wall_s + run(clone, "./dmise", "test")[0]


def incremental(clone):
    run(clone, "cmake", "--preset", "debug")
    build = ("ninja", "-C", "build/debug", TEST)
    run(clone, *build)
    source = clone / SOURCE
    source.write_text(source.read_text() + "// changed\n")
    yield "incremental_s", run(clone, *build)[0] + run(clone, f"build/debug/bin/{TEST}", f"--gtest_filter={FILTER}")[0]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--json", action="store_true", help="one object a line")
    parser.add_argument("--only", action="append", choices=("demo", "rest", "incremental"), help="part to measure")
    options = parser.parse_args()
    parts = {"demo": from_clone, "rest": rest, "incremental": incremental}
    with tempfile.TemporaryDirectory(prefix="dmise-build-") as directory:
        pathlib.Path(directory).chmod(0o755)  # tests run programs as a user without rights
        clone = pathlib.Path(directory) / "dmise"
        subprocess.run(["git", "clone", "-q", ROOT, clone], check=True)
        for part in options.only or parts:
            for name, value in parts[part](clone):
                target = TARGETS[name]
                met = value <= target if target else None
                if options.json:
                    print(json.dumps({"name": name, "value": round(value, 1), "unit": "s", "anchor": None, "anchor_value": None,
                                      "ratio": None, "target": target, "met": met}), flush=True)
                else:
                    note = "" if met is None else f"  {'reaches' if met else 'misses'} {target}"
                    print(f"{name:24} {value:8.1f} s{note}", flush=True)


if __name__ == "__main__":
    main()
