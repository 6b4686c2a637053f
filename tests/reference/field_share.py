"""Probability that a normal deviate of standard deviations 1 and 2 falls within a circle, by scipy's dblquad.

    field_share.py     what tests/fusion/test_scheduler.cpp compares with
"""
import math

from scipy.integrate import dblquad


def density(y, x):
    return math.exp(-(x * x + y * y / 4) / 2) / (4 * math.pi)


for radius in (0.5, 2.0, 4.0):
    share, error = dblquad(density, -radius, radius, lambda x: -math.sqrt(radius**2 - x * x), lambda x: math.sqrt(radius**2 - x * x),
                           epsabs=1e-12)
    print(f"radius {radius}: {share:.9f} (error {error:.0e})")
