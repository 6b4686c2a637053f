"""Apparent places of satellites by ERFA's eraAb and numpy, for tests/sky. Usage: apparent_satellites.py

A line a pair: the satellite's position [m] and velocity [m/s] on a circular orbit, the observer's position
and velocity, then light time [s], the direction with light time and the one with aberration too.
"""
import erfa
import numpy as np

LIGHT = 299792458.0
rng = np.random.default_rng(5)


def across(a, b, length):
    v = np.cross(a, b)
    return v * length / np.linalg.norm(v)


for i in range(24):
    radius = [6.93e6, 7.2e6, 2.66e7, 4.2164e7][i % 4]
    r, other = rng.normal(size=(2, 3))
    r *= radius / np.linalg.norm(r)
    v = across(r, other, np.sqrt(3.986004418e14 / radius))
    seat, other = rng.normal(size=(2, 3))
    seat *= (6.371e6 if i % 8 < 4 else 6.92e6) / np.linalg.norm(seat)
    move = np.cross([0, 0, 7.292115e-5], seat) if i % 8 < 4 else across(seat, other, 7.59e3)
    rate = np.linalg.norm(v) / radius
    tau = 0.0
    for _ in range(20):
        line = r * np.cos(rate * tau) - v / rate * np.sin(rate * tau) - seat
        tau = np.linalg.norm(line) / LIGHT
    astrometric = line / np.linalg.norm(line)
    beta = move / LIGHT
    seen = erfa.ab(astrometric, beta, 1.0, np.sqrt(1 - beta @ beta))
    print("{" + ", ".join("{" + ", ".join(f"{x:.17g}" for x in vector) + "}"
                          for vector in (r, v, seat, move))
          + f", {tau:.15g}, " + ", ".join("{" + ", ".join(f"{x:.17g}" for x in vector) + "}"
                                         for vector in (astrometric, seen)) + "},")
