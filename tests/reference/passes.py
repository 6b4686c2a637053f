"""Passes of satellites over Atlanta by skyfield, for tests/visibility/test_passes.cpp.

Usage: passes.py launch/catalogues/demo.tle [--after-a-leap-second]. With it the elements are those of 2016-12-31T06:00:00, and the
day is the next: skyfield counts from their epoch in days of 86,400 s, so it is given one a second earlier. UT1 is taken for UTC, as without an Earth orientation file. Events are
skyfield's `find_events` at 10 deg of elevation over a day, each then found to 1 ms by bisection of skyfield's own
altitude. A row: catalogue number; rise, culmination and set [s from the start], elevation [rad], azimuth
[rad], range [m] and angular rate in the horizon's axes [rad/s, over half a second] at the culmination; when skyfield's `is_sunlit` (a point-like Sun, here by ERFA, and a
round Earth) changes within the pass [s], or -1; whether it is sunlit at its rise.
"""
import sys
from types import SimpleNamespace

import erfa
import numpy as np
from sgp4.api import WGS72, Satrec
from skyfield.api import EarthSatellite, load, wgs84
from skyfield.constants import AU_M

MASK_DEG = 10.0
NUMBERS = [25544, 20580, 27386, 27376, 27704, 17589, 41572, 36119, 42707, 42705, 42728, 43054]
LEAP = "--after-a-leap-second" in sys.argv

ts = load.timescale(delta_t=69.184, builtin=True)  # TT - UTC from 2017 on
site = wgs84.latlon(33.777, -84.398, elevation_m=300.0)
start = ts.utc(2017, 1, 1) if LEAP else ts.utc(2018, 1, 21)


class SunFromEarth:
    """What `is_sunlit` asks of an ephemeris: (sun - earth).at(t).position.m."""

    def __getitem__(self, name):
        return self

    def __sub__(self, other):
        return self

    def at(self, t):
        earth = erfa.epv00(t.whole, t.tt_fraction)[0]["p"]
        return SimpleNamespace(position=SimpleNamespace(m=-np.asarray(earth) * AU_M))


ephemeris = SunFromEarth()


def after(seconds):
    return ts.tt_jd(start.whole, start.tt_fraction + seconds / 86400.0)


def bisect(test, a, b):
    """Where test(seconds) turns between a and b."""
    at_a = test(a)
    if test(b) == at_a:
        return None
    while b - a > 1e-3:
        middle = 0.5 * (a + b)
        a, b = (middle, b) if test(middle) == at_a else (a, middle)
    return 0.5 * (a + b)


def before_the_leap(sat):
    """A satellite with these elements at 2016-12-31T06:00:00."""
    moved = Satrec()
    moved.sgp4init(WGS72, "i", sat.satnum, 2457753.75 - 1 / 86400 - 2433281.5, sat.bstar, sat.ndot, sat.nddot, sat.ecco, sat.argpo,
                   sat.inclo, sat.mo, sat.no_kozai, sat.nodeo)
    return EarthSatellite.from_satrec(moved, ts)


with open(sys.argv[1]) as catalogue:
    lines = [line.rstrip() for line in catalogue if not line.startswith("#")]
elements = {int(two[2:7]): (name, one, two) for name, one, two in zip(lines[::3], lines[1::3], lines[2::3])}

for number in NUMBERS[:3] if LEAP else NUMBERS:
    if number not in elements:
        sys.exit(f"no {number} in the catalogue")
    name, one, two = elements[number]
    satellite = EarthSatellite(one, two, name, ts)
    if LEAP:
        satellite = before_the_leap(satellite.model)
    pair = satellite - site
    times, events = satellite.find_events(site, start, after(86400), altitude_degrees=MASK_DEG)
    seconds = [((t.whole - start.whole) + (t.tt_fraction - start.tt_fraction)) * 86400 for t in times]

    def altitude(s):
        return pair.at(after(s)).altaz()[0].degrees

    def direction(s):
        up, round_ = (angle.radians for angle in pair.at(after(s)).altaz()[:2])
        return np.array([np.cos(up) * np.sin(round_), np.cos(up) * np.cos(round_), np.sin(up)])

    for k in range(len(events) - 2):
        if list(events[k:k + 3]) != [0, 1, 2]:
            continue
        rise = bisect(lambda s: altitude(s) > MASK_DEG, seconds[k] - 5.0, seconds[k + 1])
        fall = bisect(lambda s: altitude(s) > MASK_DEG, seconds[k + 1], seconds[k + 2] + 5.0)
        a, b = seconds[k + 1] - 2.0, seconds[k + 1] + 2.0
        top = bisect(lambda s: altitude(s + 0.05) < altitude(s - 0.05), a, b)
        high, azimuth, distance = pair.at(after(top)).altaz()
        rate = np.linalg.norm(direction(top + 0.25) - direction(top - 0.25)) / 0.5

        def lit(s):
            return bool(satellite.at(after(s)).is_sunlit(ephemeris))

        change = bisect(lit, rise, fall)
        print(f"    {{{number}, {rise:.3f}, {top:.3f}, {fall:.3f}, {high.radians:.9f}, {azimuth.radians:.9f}, "
              f"{distance.m:.1f}, {rate:.6e}, {-1 if change is None else change:.3f}, "
              f"{str(lit(rise)).lower()}}},  // {name}")
