"""Sunlit fraction by brute force, for tests/sky/test_shadow.cpp: rays to 400,000 points of the solar disc, each
tested against the ellipsoid WGS 84. A line a case: object [m], Sun [m], fraction (good to 1e-4).
"""
import numpy as np

A, B, SUN = 6378137.0, 6356752.314245179, 6.957e8
rng = np.random.default_rng(3)
n = 400_000
k = np.arange(n) + 0.5
rho, phi = np.sqrt(k / n), k * np.pi * (3 - np.sqrt(5))


def fraction(p, sun):
    line = sun - p
    d = np.linalg.norm(line)
    u = line / d
    e = np.cross(u, [0.3, -0.5, 0.8])
    e /= np.linalg.norm(e)
    f = np.cross(u, e)
    sine = rho * SUN / d  # equal areas of the disc as seen in projection
    rays = (np.sqrt(1 - sine**2)[:, None] * u + (sine * np.cos(phi))[:, None] * e
            + (sine * np.sin(phi))[:, None] * f)
    scale = np.array([1 / A, 1 / A, 1 / B])
    ps, rs = p * scale, rays * scale
    along = rs @ ps
    length = np.sum(rs * rs, axis=1)
    hit = (along < 0) & (along**2 > length * (ps @ ps - 1))
    return 1 - hit.mean()


for height in (550e3, 550e3, 2000e3, 20200e3, 35786e3, 3.8e8, 1.6e9):
    found = 0
    while found < 4:
        sun = rng.normal(size=3) * [1, 1, 0.2]
        sun *= rng.uniform(1.47e11, 1.52e11) / np.linalg.norm(sun)
        s = sun / np.linalg.norm(sun)
        side = np.cross(s, rng.normal(size=3))
        side /= np.linalg.norm(side)
        r = A + height
        off = rng.uniform(0, 12e6) if height > 1e9 else A + rng.uniform(-1, 1) * 0.0048 * r
        p = side * off - s * np.sqrt(r * r - off * off)
        lit = fraction(p, sun)
        if 0.01 < lit < 0.99:
            found += 1
            print("{{" + ", ".join(f"{x:.3f}" for x in p) + "}, {" + ", ".join(f"{x:.3f}" for x in sun)
                  + f"}}, {lit:.5f}}},")
