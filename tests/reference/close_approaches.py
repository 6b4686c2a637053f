#!/usr/bin/env python3
"""Prints close approaches of some objects of an element file to all others, by sgp4 of PyPI at every second and a parabola between.

    close_approaches.py FILE START HOURS WITHIN_KM NUMBER..        START: 2018-01-20T00:00:00

tests/conjunction compares with what it prints of launch/catalogues/demo.tle.
"""
import datetime
import pathlib
import sys

import numpy as np
from sgp4.api import SatrecArray, Satrec, jday


def element_sets(path):
    lines = [line for line in pathlib.Path(path).read_text().splitlines() if line[:2] in ("1 ", "2 ")]
    return [Satrec.twoline2rv(a, b) for a, b in zip(lines[::2], lines[1::2])]


def main():
    path, start, hours, within_km, *numbers = sys.argv[1:]
    sets = element_sets(path)
    begin = datetime.datetime.fromisoformat(start)
    jd, fraction = jday(begin.year, begin.month, begin.day, begin.hour, begin.minute, begin.second)
    ids = [s.satnum for s in sets]
    found = set()
    block = 1800
    for first in range(0, int(float(hours) * 3600), block):
        seconds = np.arange(first - 1, first + block + 2)
        codes, r, _ = SatrecArray(sets).sgp4(np.full(len(seconds), jd), fraction + seconds / 86400)
        for number in map(int, numbers):
            i = ids.index(number)
            d = np.linalg.norm(r - r[i], axis=2)
            d[codes != 0] = np.inf
            d[i] = np.inf
            low = (d[:, 1:-1] < d[:, :-2]) & (d[:, 1:-1] <= d[:, 2:]) & (d[:, 1:-1] < float(within_km) + 8)
            for j, k in zip(*np.nonzero(low)):
                a, b, c = d[j, k] ** 2, d[j, k + 1] ** 2, d[j, k + 2] ** 2
                off = 0.5 * (a - c) / (a - 2 * b + c)
                miss = max(0.0, b - 0.25 * (a - c) * off) ** 0.5
                time = seconds[k + 1] + off
                if miss < float(within_km) and first <= time < first + block:
                    found.add((round(float(time), 3), *((number, ids[j])), round(float(miss), 4)))
    for line in sorted(found):
        print(*line)


if __name__ == "__main__":
    main()
