#!/usr/bin/env python3
"""Rows of tests/orbit/sgp4_branches_reference.inc: states by Debian's python3-sgp4 (2.15, WGS72, mode 'i')
at the edges of the model's branches. Run with /usr/bin/python3."""

from math import pi

from sgp4.api import WGS72, Satrec

# e, i [deg], n [rev/day], B*, name
CASES = [
    (0.0000001, 51.6, 15.5, 1e-4, "e below the floor of 1e-6"),
    (0.00009, 97.0, 14.9, 2e-5, "e below 1e-4: no drag terms in perigee"),
    (0.0011, 0.0, 15.0, 1e-5, "near Earth, i = 0"),
    (0.0011, 180.0, 15.0, 1e-5, "near Earth, i = 180"),
    (0.0003, 0.0, 1.0027, 0.0, "synchronous, i = 0"),
    (0.0003, 180.0, 1.0027, 0.0, "synchronous, i = 180"),
    (0.0003, 11.44, 1.0027, 0.0, "synchronous, below Lyddane's 0.2 rad"),
    (0.0003, 11.48, 1.0027, 0.0, "synchronous, above Lyddane's 0.2 rad"),
    (0.72, 11.459, 2.006, 1e-5, "half a day, at Lyddane's 0.2 rad"),
    (0.0003, 0.01, 1.3, 0.0, "deep, no resonance, inclination turns negative"),
    (0.93, 30.0, 0.3, 0.0, "e = 0.93"),
    (0.97, 62.0, 0.08, 0.0, "e = 0.97"),
    (0.52, 63.4, 2.0, 1e-6, "half a day, e = 0.52"),
    (0.0492, 70.0, 11.0, 1e-4, "short cuts of small e hold"),
    (0.0508, 70.0, 11.0, 1e-4, "short cuts of small e not taken"),
    (0.05, 30.0, 6.39, 1e-5, "just near Earth"),
    (0.05, 30.0, 6.41, 1e-5, "225 min"),
    (0.001, 51.6, 16.2, 1e-3, "perigee below 220 km"),
]
deg = pi / 180
for e, i, n, bstar, name in CASES:
    sat = Satrec()
    sat.sgp4init(WGS72, "i", 1, 25000.75, bstar, 0.0, 0.0, e, 40 * deg, i * deg, 25 * deg,
                 n * 2 * pi / 1440.0, 310 * deg)
    for t in (-1450.0, 0.0, 725.0, 10080.0):
        code, r, v = sat.sgp4_tsince(t)
        r = r if code == 0 else (0, 0, 0)
        print('{%r, %r, %r, %r, %r, %d, {%.10f, %.10f, %.10f}, "%s"},' % (e, i, n, bstar, t, code, *r, name))
