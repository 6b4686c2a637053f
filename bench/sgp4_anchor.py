#!/usr/bin/env python3
"""Reference states and speed for `dmise bench sgp4`, by the Python package `sgp4`.

    sgp4_anchor.py DIRECTORY CATALOGUE.tle

Reads element sets in two lines from CATALOGUE.tle and makes a random catalogue of its own,
DIRECTORY/random.tle. For both (NAME = catalogue, random) writes to DIRECTORY, little endian, for N
objects at K times each within 7 days of its epoch:
    NAME.times   float64 [N][K][2]  UTC two-part Julian dates
    NAME.states  float64 [N][K][6]  TEME km and km/s
    NAME.codes   uint8   [N][K]
and prints one JSON object: what was used, and how many states a second the compiled package makes of
CATALOGUE.tle by SatrecArray on one thread, at one and at eight times a call. Debian's package is pure Python: it gives values and no speed.
"""

import array
import json
import math
import random
import sys
import time

from sgp4 import api

TIMES = 4


def read(path):
    sets, first = [], None
    with open(path) as lines:
        for line in lines:
            line = line.rstrip("\r\n")
            if line.startswith("1 "):
                first = line[:69]
            elif line.startswith("2 ") and first:
                sets.append((first, line[:69]))
                first = None
    return sets


def random_set(number, rng):
    """Orbits of every class, harder than a real catalogue: all inclinations, eccentricities, drags."""
    kind = rng.choice("lleeggmmhx")
    e = 10 ** rng.uniform(-6, -1.5)
    bstar = rng.choice((-1, 1, 1, 1)) * 10 ** rng.uniform(-6, -2.5)
    if kind == "l":  # low
        n = rng.uniform(11, 15.9)
    elif kind == "e":  # low, eccentric
        e = rng.uniform(0.0, 0.5)
        n = rng.uniform(8, 16.2) * (1 - e) ** 1.5
    elif kind == "g":  # synchronous
        n = rng.uniform(0.9, 1.1)
    elif kind == "m":  # half a day
        n = rng.uniform(1.89, 2.12)
        e = rng.choice((rng.uniform(0, 0.05), rng.uniform(0.5, 0.76)))
    elif kind == "h":  # transfer orbits
        n = rng.uniform(2, 6)
        e = min(0.9, max(0.0, 1 - 1.05 * (n / 17.0) ** (2 / 3)) * rng.uniform(0.7, 1))
    else:  # anything
        n = rng.uniform(0.05, 6.3)
        e = rng.uniform(0.0, 0.9)
    i = rng.choice((rng.uniform(0, 180), rng.uniform(0, 14), rng.uniform(62, 66), rng.uniform(96, 100)))
    day = rng.uniform(1, 365)
    exponent = math.floor(math.log10(abs(bstar))) + 1
    drag = "%s%05d%+d" % ("-" if bstar < 0 else " ", min(99999, abs(bstar) / 10.0**exponent * 1e5), exponent)
    first = "1 %05dU 19001A   %02d%012.8f  .00000000  00000-0 %8s 0  9990" % (
        number, rng.choice((57, 80, 99, 4, 18, 19, 24, 25)), day, drag)
    second = "2 %05d %8.4f %8.4f %07d %8.4f %8.4f %11.8f    10" % (
        number, i, rng.uniform(0, 360), int(e * 1e7), rng.uniform(0, 360), rng.uniform(0, 360), n)
    return first, second


def references(satellites, name, directory, rng):
    times, states, codes = array.array("d"), array.array("d"), array.array("B")
    for sat in satellites:
        for k in range(TIMES):
            days = rng.uniform(-7, 7) if k else rng.choice((-7.0, 0.0, 7.0))
            jd, fraction = sat.jdsatepoch + math.floor(days), sat.jdsatepochF + days - math.floor(days)
            code, r, v = sat.sgp4(jd, fraction)
            times.extend((jd, fraction))
            states.extend((*r, *v))
            codes.append(code)
    for suffix, values in (("times", times), ("states", states), ("codes", codes)):
        with open("%s/%s.%s" % (directory, name, suffix), "wb") as out:
            values.tofile(out)


def speed(satellites, times=1):
    """Millions of states a second, median of thread CPU time over calls at `times` ticks of 10 s each."""
    import numpy

    group = api.SatrecArray(satellites)
    rates = []
    for k in range(9):
        jd = numpy.full(times, 2458837.5 + k)
        fraction = 0.1 + numpy.arange(times) * (10 / 86400)
        start = time.thread_time()
        group.sgp4(jd, fraction)
        rates.append(times * len(satellites) / (time.thread_time() - start) * 1e-6)
    return sorted(rates)[len(rates) // 2]


def main():
    directory, catalogue = sys.argv[1:3]
    rng = random.Random(1)
    lines = {"catalogue": read(catalogue),
             "random": [random_set(10000 + k, rng) for k in range(20000 if api.accelerated else 2000)]}
    with open(directory + "/random.tle", "w") as out:
        for pair in lines["random"]:
            out.write("%s\n%s\n" % pair)
    satellites = {name: [api.Satrec.twoline2rv(*pair) for pair in sets] for name, sets in lines.items()}
    step = 1 if api.accelerated else 10
    references(satellites["random"], "random", directory, rng)
    references(satellites["catalogue"][::step], "catalogue", directory, rng)
    report = {"compiled": bool(api.accelerated), "times": TIMES, "catalogue_step": step}
    if api.accelerated:
        period = lambda s: 2 * math.pi / s.no_kozai
        near = [s for s in satellites["catalogue"] if period(s) < 225]
        report["near_m_per_s"] = speed(near)
        report["near_8_times_m_per_s"] = speed(near, 8)
        report["deep_m_per_s"] = speed([s for s in satellites["catalogue"] if period(s) >= 225])
    print(json.dumps(report))


main()
