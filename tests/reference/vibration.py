#!/usr/bin/env python3
"""Displacement and blur of exposures by a camera's vibration, by scipy's quadrature of its spectrum and, independently, by numpy's
means and variances over exposures of one vibration in time: the figures of tests/instrument/test_vibration.cpp."""
import numpy as np
from scipy.integrate import quad

HZ, PSD = [0.1, 1.0, 10.0, 100.0], [4.0, 2.0, 0.05, 0.001]  # arcsec^2 / Hz
SINE_HZ, SINE_RMS = 25.0, 0.3


def split(exposure_s):
    share = lambda f: np.sinc(f * exposure_s) ** 2
    shift = blur = 0.0
    for a, b, p, q in zip(HZ, HZ[1:], PSD, PSD[1:]):
        density = lambda f: p + (q - p) * (f - a) / (b - a)
        for low in np.arange(a, b, (b - a) / max(1, int((b - a) * exposure_s))):
            high = min(b, low + (b - a) / max(1, int((b - a) * exposure_s)))
            shift += quad(lambda f: density(f) * share(f), low, high)[0]
            blur += quad(lambda f: density(f) * (1 - share(f)), low, high)[0]
    return np.sqrt(shift + SINE_RMS**2 * share(SINE_HZ)), np.sqrt(blur + SINE_RMS**2 * (1 - share(SINE_HZ)))


def in_time(exposure_s, exposures=4000):
    """Means and variances over exposures at random times of waves at random frequencies."""
    rng = np.random.default_rng(3)
    f = np.concatenate([np.linspace(a, b, 401)[:-1] + (b - a) / 800 for a, b in zip(HZ, HZ[1:])] + [[SINE_HZ]])
    power = np.concatenate([np.interp(np.linspace(a, b, 401)[:-1] + (b - a) / 800, HZ, PSD) * (b - a) / 400 for a, b in zip(HZ, HZ[1:])] + [[SINE_RMS**2]])
    t = exposure_s * (np.arange(200) + 0.5) / 200
    means, variances = [], []
    for _ in range(exposures):
        x = np.sqrt(2 * power) @ np.cos(2 * np.pi * (np.outer(f, t) + rng.random(len(f))[:, None]))
        means.append(x.mean())
        variances.append(x.var())
    return np.std(means), np.sqrt(np.mean(variances))


if __name__ == "__main__":
    for exposure_s in (0.01, 0.1, 1.0, 10.0):
        shift, blur = split(exposure_s)
        found = in_time(exposure_s, 600) if exposure_s <= 1.0 else (np.nan, np.nan)
        print(f"{{{exposure_s}, {shift:.6f}, {blur:.6f}}},  // in time {found[0]:.3f} {found[1]:.3f}")
