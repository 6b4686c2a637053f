#!/usr/bin/env python3
"""Values of tests/optics/test_air_turbulence.cpp.

    turbulence_values.py     numpy and GalSim, run now, give the test's figures (1 % of each)

Image motion: variance of the mean slope of a frozen layer's wavefront over a circular aperture D, along the wind and
across it, after L apertures of air in N equal steps, over that of an instant: the spectrum 0.0229 r0^(-5/3) f^(-11/3)
(Roddier 1981, Progress in Optics 19, 281), filtered by the aperture, (2 J1(pi D f) / (pi D f))^2, and by the mean over
the steps (Martin 1987, PASP 99, 1360). Scattered light: GalSim's Kolmogorov profile beyond so many of its widths.
Without them it says so and exits 77, with DMISE_DATA set 1.
"""
import math
import os
import sys

try:
    import galsim
    import numpy as np
except ImportError:
    print("GalSim is not there (./dmise setup --tests)")
    sys.exit(1 if os.environ.get("DMISE_DATA") else 77)

MOTION = {(1, 1000): (0.895, 0.959), (3, 1000): (0.683, 0.836), (10, 1000): (0.460, 0.632), (30, 1000): (0.311, 0.456),
          (100, 1000): (0.199, 0.305), (300, 1000): (0.130, 0.206), (2, 2): (0.801, 0.910), (8, 2): (0.671, 0.762),
          (32, 2): (0.602, 0.660), (32, 8): (0.345, 0.466), (100, 32): (0.207, 0.309)}
BEYOND = {3: 0.01594, 4: 0.00948, 6: 0.00468, 10: 0.00197}


def bessel_j1(x):
    t = np.linspace(0, math.pi, 65)
    y = np.cos(t - x[:, None] * np.sin(t))
    return np.sum(0.5 * (y[:, 1:] + y[:, :-1]), axis=1) / 64


def motion(length, steps):
    f = np.exp(np.linspace(math.log(1e-5), math.log(19), 1500))
    filtered = f ** (1 / 3) * (2 * bessel_j1(math.pi * f) / (math.pi * f)) ** 2
    angle = (np.arange(400) + 0.5) / 800 * math.pi
    turn = math.pi * f[:, None] * np.cos(angle) * length
    mean = (np.sin(turn) / (steps * np.sin(turn / steps))) ** 2 if length else np.ones_like(turn)
    return [np.sum(filtered[:, None] * mean * axis(angle) ** 2) for axis in (np.cos, np.sin)]


def beyond(widths):
    r = (np.arange(4000) + 0.5) / 4000 * widths
    profile = galsim.Kolmogorov(fwhm=1.0)
    return 1 - sum(2 * math.pi * x * profile.xValue(x, 0) for x in r) * widths / 4000


failed = 0
instant = motion(0, 1)
for (length, steps), expected in MOTION.items():
    got = [a / b for a, b in zip(motion(length, steps), instant)]
    good = all(abs(a / b - 1) < 0.01 for a, b in zip(got, expected))
    failed += not good
    print(f"{length} apertures in {steps} steps: {got[0]:.3f} {got[1]:.3f}" + ("" if good else f", not {expected}"))
for widths, expected in BEYOND.items():
    got = beyond(widths)
    failed += abs(got / expected - 1) > 0.01
    print(f"beyond {widths} widths: {got:.5f}")
sys.exit(1 if failed else 0)
