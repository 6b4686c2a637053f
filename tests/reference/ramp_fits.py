#!/usr/bin/env python3
"""Ramps of an infrared detector, read by read, by numpy: Poisson charge between reads, normal noise of each read and of the reset,
lines by numpy.polyfit or Fowler's means: the figures of tests/detector/test_ramp.cpp. Prints the variance of the signal over the
whole exposure, beside equation 1 of Rauscher et al. 2007 (m = 1) or Garnett & Forrest's closed form."""
import numpy as np

RAMPS = 400000
rng = np.random.default_rng(1)


def signals(reads, fowler, light_e, noise_e, reset_e):
    charge = np.cumsum(rng.poisson(light_e / (reads - 1), (reads - 1, RAMPS)), axis=0)
    ramp = np.vstack([np.zeros(RAMPS), charge]) + rng.normal(0, noise_e, (reads, RAMPS)) + rng.normal(0, reset_e, RAMPS)
    if fowler:
        return (ramp[-fowler:].mean(0) - ramp[:fowler].mean(0)) * (reads - 1) / (reads - fowler)
    return np.polyfit(np.arange(reads) / (reads - 1), ramp, 1)[0]


if __name__ == "__main__":
    for reads, fowler, light_e, noise_e in [(2, 0, 50, 10), (8, 0, 0, 10), (8, 0, 400, 10), (32, 0, 5, 10), (32, 0, 3000, 10),
                                            (32, 16, 0, 10), (64, 8, 200, 10)]:
        n = reads
        if fowler:
            closed = 2 * noise_e**2 / fowler * ((n - 1) / (n - fowler))**2
            part = f"read noise {closed:.3f}"
        else:
            closed = 12 * (n - 1) / (n * (n + 1)) * noise_e**2 + 6 * (n**2 + 1) / (5 * n * (n + 1)) * light_e
            part = f"{closed:.3f}"
        found = signals(reads, fowler, light_e, noise_e, 30)
        print(f"{{{reads}, {fowler}, {light_e}, {noise_e}, {found.var():.2f}}},  // mean {found.mean():.3f}, closed form {part}")
