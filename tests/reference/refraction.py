"""Refraction by ray tracing through a standard atmosphere, for tests/sky/test_refraction.cpp.

International Standard Atmosphere to 86 km, dry air of refractivity 2.7785e-4 at 15 C and 1013.25 hPa (0.55 um), observer at
6371 km. A line an apparent zenith angle [deg]: refraction of a star, then how much less a body at 550 km
is lifted [arcsec]. For the body the geocentric angle is integrated along the ray, without any asymptote.
"""
import numpy as np
from scipy.integrate import quad
from scipy.optimize import brentq

R0, G, RM = 6371e3, 9.80665, 287.05287
LAYERS = [(0, 288.15, -6.5e-3), (11e3, 216.65, 0), (20e3, 216.65, 1e-3), (32e3, 228.65, 2.8e-3),
          (47e3, 270.65, 0), (51e3, 270.65, -2.8e-3), (71e3, 214.65, -2e-3)]
N0 = 2.7785e-4

bases, pressure = [], 101325.0
for i, (h, t, lapse) in enumerate(LAYERS):
    bases.append(pressure)
    top = LAYERS[i + 1][0] if i + 1 < len(LAYERS) else 86e3
    if lapse:
        pressure *= ((t + lapse * (top - h)) / t) ** (-G / (RM * lapse))
    else:
        pressure *= np.exp(-G * (top - h) / (RM * t))


def index(height):
    """n and dn/dr."""
    if height > 86e3:
        return 1.0, 0.0
    i = max(k for k, layer in enumerate(LAYERS) if height >= layer[0])
    h, t0, lapse = LAYERS[i]
    t = t0 + lapse * (height - h)
    p = bases[i] * ((t / t0) ** (-G / (RM * lapse)) if lapse else np.exp(-G * (height - h) / (RM * t0)))
    density = p / (RM * t)
    slope = -density / t * (G / RM + lapse)
    scale = N0 / (101325.0 / (RM * 288.15))
    return 1 + scale * density, scale * slope


def trace(z, top):
    """Bending and geocentric angle up to a height, by the height's square root to tame the horizon."""
    invariant = (1 + N0) * R0 * np.sin(z)

    def cosine(n, r):
        return np.sqrt(max(1 - (invariant / (n * r)) ** 2, 1e-30))

    def bending(q):
        n, slope = index(q * q)
        r = R0 + q * q
        return -slope / n * (invariant / (n * r)) / cosine(n, r) * 2 * q

    def turning(q):
        n, _ = index(q * q)
        r = R0 + q * q
        return (invariant / (n * r)) / cosine(n, r) / r * 2 * q

    edges = [np.sqrt(h) for h in [0, 1, 10, 100, 1e3, 5e3, 11e3, 20e3, 32e3, 47e3, 51e3, 71e3, 86e3, top]]
    total = [sum(quad(f, a, b, epsabs=1e-14, epsrel=1e-10, limit=200)[0] for a, b in zip(edges, edges[1:]))
             for f in (bending, turning)]
    return total


for degrees in (0.5, 20, 45, 60, 70, 75, 80, 85, 88, 89.99):
    z = np.radians(degrees)
    bend, theta = trace(z, 550e3)
    r = R0 + 550e3
    true = np.arctan2(r * np.sin(theta), r * np.cos(theta) - R0)
    lifted = true - z
    print(f"{{{degrees}, {np.degrees(bend) * 3600:.3f}, {np.degrees(bend - lifted) * 3600:.3f}}},")
