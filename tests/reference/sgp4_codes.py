#!/usr/bin/env python3
"""Rows of tests/orbit/sgp4_codes_reference.inc: error codes, radii and semi-major axes (Brouwer's) by python-sgp4 (WGS72, mode 'i') of
orbits that have no state. By the compiled wheel: in Python n = 0 divides by zero; all else is the same.

The reference has no code for a state at an absurd distance (python-sgp4, issue 137): it says 0."""

from math import hypot, pi

from sgp4.api import WGS72, Satrec

# e, i [deg], n [rev/day], B*
CASES = [
    (0.00038964643624496165, 46.867, 15.898067868749614, -0.1),  # 1 before its epoch, absurd after
    (0.7570503965358856, 44.5035, 2.006, 0.01),                  # 1
    (0.1, 50.0, 0.0, 1e-5),                                      # 2
    (0.998592213657801, 4.605253947990169, 2.006, -0.01),        # 3
    (0.994337686593955, 32.8384, 14.738075821202438, 0.0),       # 3
    (0.9978906391247446, 172.5586967535219, 1.0027, 0.3),        # 4
    (0.9835368806880995, 61.219740102445726, 14.083692228651, -0.1),  # 4
    (0.9333419896798227, 145.7577, 16.33370813592797, 0.01),     # 6
    (0.8107398613955288, 96.2347, 13.894943860326842, 0.0001),   # 6
    (1.0624191273215233e-05, 32.412, 16.122264177286027, -0.01), # absurd
    (0.0012, 51.6, 15.5, 1e-4),                                  # nothing wrong
]
deg = pi / 180
for e, i, n, bstar in CASES:
    sat = Satrec()
    sat.sgp4init(WGS72, "i", 1, 25000.75, bstar, 0.0, 0.0, e, 40 * deg, i * deg, 25 * deg,
                 n * 2 * pi / 1440.0, 310 * deg)
    for t in (-14400.0, 0.0, 1440.0, 14400.0):
        code, r, v = sat.sgp4_tsince(t)
        radius_km = hypot(*r) if code == 0 else 0.0
        a_km = sat.a * 6378.135 if n > 0 else 0.0
        print("{%r, %r, %r, %r, %r, %d, %.6f, %.1f}," % (e, i, n, bstar, t, code, radius_km, a_km))
