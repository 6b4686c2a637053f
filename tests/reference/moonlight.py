#!/usr/bin/python3
"""Reference for tests/sky/test_sky_parts.cpp: Krisciunas & Schaefer 1991, PASP 103, 1033, written from the paper's
equations 3, 9, 15, 18, 20, 21 in its own units (degrees, nanolamberts)."""
from math import cos, exp, log, radians, sin, sqrt


def airmass(z):
    return 1 / sqrt(1 - 0.96 * sin(radians(z)) ** 2)


def moon_nl(phase, rho, z, z_moon, k):
    illuminance = 10 ** (-0.4 * (3.84 + 0.026 * abs(phase) + 4e-9 * phase**4))
    mie = 10 ** (6.15 - rho / 40) if rho >= 10 else 6.2e7 / rho**2
    f = 10**5.36 * (1.06 + cos(radians(rho)) ** 2) + mie
    return f * illuminance * 10 ** (-0.4 * k * airmass(z_moon)) * (1 - 10 ** (-0.4 * k * airmass(z)))


for case in () if __name__ != "__main__" else ((0, 60, 0, 60, 0.172), (30, 30, 45, 30, 0.172), (90, 100, 70, 80, 0.3), (0, 5, 40, 45, 0.172)):
    b = moon_nl(*case)
    print("{%g, %g, %g, %g, %g, %.6g, %.5f}," % (*case, b, (20.7233 - log(b / 34.08)) / 0.92104))
