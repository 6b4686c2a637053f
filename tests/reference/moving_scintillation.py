#!/usr/bin/env python3
"""Variance of scintillation of a source that moves over that of one that stands still, for
tests/sky/test_moving_scintillation.cpp: the whole integral, with numpy and scipy, over the heights of Hufnagel-Valley 5/7
and the spatial frequencies of weak scintillation through a round aperture, averaged over the exposure by each layer's
speed past the line of sight. Bufton's wind, 5 and 30 m/s, and the source's motion at right angles to it.
A line a case: aperture [m], exposure [s], airmass, rate [rad/s], ratio of variances.
"""
import numpy as np
from scipy.special import j1

WAVELENGTH = 0.55e-6
h = np.geomspace(5.0, 30e3, 400)
cn2 = (0.00594 * (21 / 27) ** 2 * (1e-5 * h) ** 10 * np.exp(-h / 1000) + 2.7e-16 * np.exp(-h / 1500)
       + 1.7e-14 * np.exp(-h / 100))
wind = 5 + 30 * np.exp(-(((h - 9400) / 4800) ** 2))
f = np.geomspace(1e-3, 300, 3000)
# Mean over directions of sinc^2(a cos phi), by a = speed x time x frequency.
a_nodes = np.concatenate([[0], np.geomspace(1e-4, 1e6, 800)])
steps = np.concatenate([np.geomspace(1e-9, np.pi / 2, 6000)])
mean_sinc2 = np.array([np.trapz(np.sinc(a * np.sin(steps)) ** 2, steps) / (np.pi / 2) for a in a_nodes])


def variance(diameter, exposure, airmass, speed):
    aperture = (2 * j1(np.pi * diameter * f) / (np.pi * diameter * f)) ** 2
    total = np.zeros_like(h)
    for i, height in enumerate(h):
        fresnel = np.sin(np.pi * WAVELENGTH * airmass * height * f**2) ** 2
        time = np.interp(speed[i] * exposure * f, a_nodes, mean_sinc2)
        total[i] = np.trapz(f ** (-8 / 3) * fresnel * aperture * time, f)
    return np.trapz(cn2 * total, h)


for diameter, exposure, airmass in ((0.3, 1.0, 1.0), (0.3, 1.0, 2.0), (1.0, 2.0, 1.0), (0.15, 0.5, 1.5)):
    still = variance(diameter, exposure, airmass, wind)
    for rate in (7.3e-5, 1e-3, 5e-3, 2e-2):
        moving = variance(diameter, exposure, airmass, np.hypot(wind, rate * airmass * h))
        print(f"{{{diameter}, {exposure}, {airmass}, {rate}, {moving / still:.4f}}},")
