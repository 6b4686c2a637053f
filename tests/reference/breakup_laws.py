"""scipy judges what core/orbit/breakup draws against the laws of NASA's standard breakup model, restated here from the paper.

    breakup_laws.py BREAKUP_CASE

Johnson, Krisko, Liou & Anz-Meador 2001, Advances in Space Research 28, 1377. Kolmogorov-Smirnov, p > 0.01 each: lengths; log10 of
area-to-mass by its distribution at each piece's own length, below 8 cm and over 11 cm; log10 of speed by that at its own
area-to-mass; directions. Areas, masses and numbers are compared directly. Without scipy it exits 77.
"""
import subprocess
import sys

try:
    import numpy as np
    from scipy.stats import kstest, norm
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)

LEAST_P = 0.01
LEAST_M = 0.02
# Catastrophic: both masses, 900 kg and 556 kg.
NUMBER = {"explosion": 6 * 8 * LEAST_M ** -1.6, "collision": 0.1 * (900 + 556) ** 0.75 * LEAST_M ** -1.71}
POWER = {"explosion": 1.6, "collision": 1.71}
SPEED = {"explosion": (0.2, 1.85), "collision": (0.9, 2.9)}


def between(x, points):
    """Linear between the points of the paper's tables, level beyond them."""
    return np.interp(x, *zip(*points))


def upper_stage(x):
    """Equation 4: share, mean, sigma of the first normal; mean, sigma of the second."""
    return (between(x, [(-1.4, 1), (0, 0.5)]), between(x, [(-0.5, -0.45), (0, -0.9)]), 0.55, -0.9, between(x, [(-1, 0.28), (0.1, 0.1)]))


def spacecraft(x):
    """Equation 5."""
    return (between(x, [(-1.95, 0), (0.55, 1)]), between(x, [(-1.1, -0.6), (0, -0.95)]), between(x, [(-1.3, 0.1), (-0.3, 0.3)]),
            between(x, [(-0.7, -1.2), (-0.1, -2)]), between(x, [(-0.5, 0.5), (-0.3, 0.3)]))


def large(kind, x, chi):
    share, mean, sigma, other, other_sigma = (upper_stage if kind == "explosion" else spacecraft)(x)
    return share * norm.cdf(chi, mean, sigma) + (1 - share) * norm.cdf(chi, other, other_sigma)


def small(x, chi):
    """Equation 6."""
    return norm.cdf(chi, between(x, [(-1.75, -0.3), (-1.25, -1)]), 0.2 + 0.1333 * np.maximum(0, x + 3.5))


def judge(kind, case):
    lines = subprocess.run([case, kind], capture_output=True, text=True, check=True).stdout.split("\n", 1)
    too_heavy = int(lines[0])
    length, chi, area, mass, speed, *direction = np.array([line.split() for line in lines[1].splitlines()], float).T
    x = np.log10(length)
    if len(length) + too_heavy != int(NUMBER[kind]):
        sys.exit(f"{kind}: {len(length)} + {too_heavy} pieces, not {NUMBER[kind]:.1f}")
    if too_heavy > 0.002 * len(length):
        sys.exit(f"{kind}: {too_heavy} pieces are too heavy")
    np.testing.assert_allclose(area, 0.556945 * length ** 2.0047077, rtol=1e-12)
    np.testing.assert_allclose(mass, area / 10 ** chi, rtol=1e-12)
    slope, level = SPEED[kind]
    uniform = {
        "lengths": 1 - (length / LEAST_M) ** -POWER[kind],
        "area-to-mass below 8 cm": small(x, chi)[length < 0.08],
        "area-to-mass over 11 cm": large(kind, x, chi)[length > 0.11],
        "speeds": norm.cdf(speed, slope * chi + level, 0.4),
        **{f"directions along {axis}": 0.5 * (1 + part) for axis, part in zip("xyz", direction)},
    }
    failed = False
    for name, sample in uniform.items():
        p = kstest(sample, "uniform").pvalue
        failed |= p <= LEAST_P
        print(f"{kind}: {name}: {len(sample)} pieces, p = {p:.3f}")
    print(f"{kind}: {mass.sum():.0f} kg, {np.sum(length >= 0.1)} pieces of 10 cm or more")
    return failed


sys.exit(int(any([judge(kind, sys.argv[1]) for kind in NUMBER])))
