"""Values of tests/score: matched filters summed over pixels, Cramer-Rao bounds from Fisher matrices over pixels, and
intervals from scipy.

    score_values.py
"""
import math

import numpy as np
from scipy import special, stats


def trail(sigma, length, x, y, nodes=400):
    """Pixel-integrated light of a uniform horizontal trail through the Gaussian, sum 1."""
    half = 0.5 * np.polynomial.legendre.leggauss(nodes)[0] * length if length else np.zeros(1)
    weight = 0.5 * np.polynomial.legendre.leggauss(nodes)[1] if length else np.ones(1)
    box = lambda d: 0.5 * (special.erf((d + 0.5) / sigma / 2**0.5) - special.erf((d - 0.5) / sigma / 2**0.5))
    columns = np.arange(-60 - length // 2, 61 + length // 2)
    rows = np.arange(-30, 31)
    across = box(rows - y)
    along = sum(w * box(columns - x - h) for w, h in zip(weight, half))
    return np.outer(across, along)


def phases(function):
    """Mean over places within a pixel."""
    return np.mean([function(x, y) for x in np.arange(8) / 8 for y in np.arange(8) / 8])


for sigma, length in ((0.8, 0), (2.0, 0), (0.8, 5), (0.8, 100), (2.0, 20)):
    snr = phases(lambda x, y: math.sqrt((trail(sigma, length, x, y) ** 2).sum())) * 1000 / 10
    print(f"snr of 1000 e- over 10 e-, sigma {sigma}, length {length}: {snr:.4f}")


def bound(signal, noise, sigma, length, x, y, step=1e-4):
    light = signal * trail(sigma, length, x, y)
    by_y = signal * (trail(sigma, length, x, y + step) - trail(sigma, length, x, y - step)) / (2 * step)
    return 1 / math.sqrt((by_y**2 / (noise**2 + light)).sum())


for signal, noise, sigma, length in ((1e3, 10, 1.5, 0), (1e6, 10, 1.5, 0), (1e4, 10, 1.5, 50), (1e7, 10, 1.5, 50)):
    value = phases(lambda x, y: bound(signal, noise, sigma, length, x, y))
    print(f"bound of {signal:g} e- over {noise} e-, sigma {sigma}, length {length}: {value:.6f} px")

for successes, trials in ((0, 10), (10, 10), (8, 10), (81, 263)):
    interval = stats.binomtest(successes, trials).proportion_ci(method="wilson")
    print(f"Wilson {successes} of {trials}: {interval.low:.6f} {interval.high:.6f}")
for count in (1, 4, 61, 500, 5000):
    print(f"NEES / 2 of {count}:", *(f"{q:.6f}" for q in stats.chi2.ppf([0.025, 0.975], 2 * count) / (2 * count)))
