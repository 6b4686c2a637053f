#!/usr/bin/env python3
"""Rows of `leap_second_states` in tests/orbit/test_sgp4_leap_seconds.cpp: python-sgp4 (WGS72, mode 'i') at the elapsed time that
ERFA's TAI gives, between UTC times with leap seconds between or beside them."""

from math import pi

import erfa
from sgp4.api import WGS72, Satrec

# epoch and time: year, month, day, hour, minute, second, UTC
CASES = [
    ((2016, 12, 30, 6, 0, 0.0), (2016, 12, 31, 12, 0, 0.0)),
    ((2016, 12, 30, 6, 0, 0.0), (2016, 12, 31, 23, 59, 60.5)),
    ((2016, 12, 30, 6, 0, 0.0), (2017, 1, 1, 12, 0, 0.0)),
    ((2016, 12, 31, 18, 0, 0.0), (2017, 1, 2, 0, 0, 0.0)),
    ((2012, 6, 30, 12, 0, 0.0), (2012, 7, 1, 12, 0, 0.0)),
    ((2008, 12, 30, 12, 0, 0.0), (2017, 1, 1, 0, 0, 0.0)),
    ((2017, 1, 3, 12, 0, 0.0), (2016, 12, 31, 12, 0, 0.0)),
    ((1971, 12, 30, 12, 0, 0.0), (1972, 1, 2, 0, 0, 0.0)),
]
deg = pi / 180
for epoch, time in CASES:
    utc0, utc = erfa.dtf2d("UTC", *epoch), erfa.dtf2d("UTC", *time)
    tai0, tai = erfa.utctai(*utc0), erfa.utctai(*utc)
    minutes = ((tai[0] - tai0[0]) + (tai[1] - tai0[1])) * 1440
    sat = Satrec()
    sat.sgp4init(WGS72, "i", 1, utc0[0] + utc0[1] - 2433281.5, 1e-5, 0.0, 0.0, 0.001, 40 * deg, 51.6 * deg, 25 * deg,
                 15.5 * 2 * pi / 1440.0, 310 * deg)
    code, r, v = sat.sgp4_tsince(minutes)
    assert code == 0
    print("    {{%r, %r}, {%r, %r}, {%.7f, %.7f, %.7f}}," % (*map(float, utc0), *map(float, utc), *r))
