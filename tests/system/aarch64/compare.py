#!/usr/bin/env python3
"""compare.py HERE THERE: what the programs of two processors made of the same input differs by no more than docs/install.md states.

Each directory holds states.csv (`dmise catalogue states`) and run/ (`dmise run`). Prints each difference beside its bound.
"""

import json
import pathlib
import sys

import numpy as np
from astropy.io import fits

here, there = (pathlib.Path(argument) for argument in sys.argv[1:])
failed = []


def judge(what, value, bound, unit):
    print(f"{'ok' if value <= bound else 'FAIL'}: {what}: {value:.3g} {unit}, bound {bound:g}")
    if not value <= bound:
        failed.append(what)


def states():
    """Positions and velocities of a catalogue at one time."""
    a, b = (np.loadtxt(side / "states.csv", delimiter=",", skiprows=1) for side in (here, there))
    judge("ids and codes of states", np.count_nonzero(a[:, :2] != b[:, :2]), 0, "differ")
    judge("share of coordinates that differ", np.mean(a[:, 2:] != b[:, 2:]), 1, "")
    judge("positions of SGP4", 1e3 * np.abs(a[:, 2:5] - b[:, 2:5]).max(), 1e-5, "m")
    judge("velocities of SGP4", 1e3 * np.abs(a[:, 5:] - b[:, 5:]).max(), 1e-8, "m/s")


def planes_of(path):
    with fits.open(path) as file:
        return [np.asarray(unit.data, np.float64) for unit in file if unit.is_image and unit.data is not None]


def frames():
    """Counts, and what they were drawn from: share of pixels that differ, and by how much."""
    names = [sorted(str(path.relative_to(side / "run")) for path in (side / "run").rglob("*.fits")) for side in (here, there)]
    judge("names of frames", names[0] != names[1], 0, "differ")
    differ = pixels = most_dn = expected = 0
    for name in names[0]:
        for a, b in zip(planes_of(here / "run" / name), planes_of(there / "run" / name), strict=True):
            apart = np.abs(a - b)
            if "-" in name.split("frame-")[1]:
                expected = max(expected, (apart / np.abs(a).max()).max())
            else:
                differ, pixels, most_dn = differ + np.count_nonzero(apart), pixels + apart.size, max(most_dn, apart.max())
    judge(f"share of {pixels} pixels whose counts differ", differ / pixels, 1e-4, "")
    judge("counts of those", most_dn, 1, "DN")
    judge("expected light and noise, of a frame's largest value", expected, 1e-6, "")


def numbers_apart(a, b, where):
    """The largest relative difference of numbers; all else is equal."""
    if isinstance(a, dict) and isinstance(b, dict) and a.keys() == b.keys():
        return max((numbers_apart(a[key], b[key], f"{where}.{key}") for key in a), default=0)
    if isinstance(a, list) and isinstance(b, list) and len(a) == len(b):
        return max((numbers_apart(x, y, where) for x, y in zip(a, b)), default=0)
    if isinstance(a, (int, float)) and isinstance(b, (int, float)) and not isinstance(a, bool):
        return abs(a - b) / max(abs(a), abs(b), 1e-3)
    if a != b:
        failed.append(where)
        print(f"FAIL: {where}: {a!r} and {b!r}")
    return 0


def lines():
    """Truth and detections."""
    for name, bound in (("truth.jsonl", 1e-6), ("detections.jsonl", 1e-3)):
        a, b = ([json.loads(line) for line in (side / "run" / name).read_text().splitlines()] for side in (here, there))
        judge(f"number of lines of {name}", abs(len(a) - len(b)), 0, "")
        judge(f"numbers of {name}, relative", max((numbers_apart(x, y, name) for x, y in zip(a, b)), default=0), bound, "")


states()
frames()
lines()
sys.exit(f"FAIL: {', '.join(failed)}" if failed else 0)
