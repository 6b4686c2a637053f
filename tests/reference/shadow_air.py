#!/usr/bin/env python3
"""Sunlight at the edge of the Earth's shadow through its air, for tests/sky/test_shadow_air.cpp, with numpy: rays traced
step by step through the U.S. Standard Atmosphere of 1976 over a sphere (index of refraction by density, Rayleigh
scattering, 300 DU of ozone), and a Sun of 60,000 points darkened towards its limb as mu^alpha, alpha = -0.023 + 0.292 / um
(Hestroffer & Magnan 1998). The light of a point is that of its ray times the area between rays before the Earth over that
at the object. A line a case: height [m], place across the axis [m], wavelength [nm], light over full sunlight with air,
without air, and without air of an even Sun.
"""
import numpy as np

R, SUN, AU = 6371e3, 6.957e8, 1.495978707e11
LAYERS = [(0, 288.15, -6.5e-3), (11e3, 216.65, 0.0), (20e3, 216.65, 1e-3), (32e3, 228.65, 2.8e-3), (47e3, 270.65, 0.0),
          (51e3, 270.65, -2.8e-3), (71e3, 214.65, -2e-3)]


def density(z):  # kg/m3 at geometric heights
    z = np.atleast_1d(z)
    geopotential = 6356766.0 * z / (6356766.0 + z)
    result = np.zeros_like(z)
    pressure = 101325.0
    for i, (base, t0, lapse) in enumerate(LAYERS):
        top = LAYERS[i + 1][0] if i + 1 < len(LAYERS) else 1e9
        inside = ((geopotential >= base) | (i == 0)) & (geopotential < top)
        def p_at(x):
            if lapse == 0:
                return pressure * np.exp(-0.0341632 * (x - base) / t0)
            return pressure * (np.maximum(t0 + lapse * (x - base), 1.0) / t0) ** (-0.0341632 / lapse)
        t = np.maximum(t0 + lapse * (geopotential - base), 150.0)
        result = np.where(inside, p_at(geopotential) / (287.053 * t), result)
        if top < 1e9:
            pressure = float(p_at(top))
    return result


def ozone(z):  # relative, 300 DU: 0.3 atm-cm over all heights
    return 0.3 * np.exp(-0.5 * ((z - 22e3) / 5e3) ** 2) / (5e3 * np.sqrt(2 * np.pi))


RHO0 = 1.225


def air_at(nm):
    um = nm / 1e3
    s = 1 / um**2
    n0 = 1e-8 * (8342.13 + 2406030 / (130 - s) + 15997 / (38.9 - s))  # Edlen, 15 C, 1013.25 hPa
    rayleigh = 0.008569 * um**-4 * (1 + 0.0113 * s + 0.00013 * s**2)  # Hansen & Travis 1974, zenith from the ground
    chappuis = np.interp(nm, [440, 450, 480, 500, 530, 550, 570, 593, 610, 630, 656, 690, 740, 780],
                         [0, .003, .014, .03, .063, .085, .12, .119, .12, .09, .065, .028, .01, 0])
    return n0, rayleigh, chappuis


heights = np.concatenate([np.arange(0, 30e3, 250.0), np.arange(30e3, 120e3, 1000.0)])
column0 = np.trapz(density(np.arange(0, 120e3, 50.0)), dx=50.0)


def trace(nm):
    """Bending and transmission of rays by their lowest height, in steps along the ray from there on."""
    n0, rayleigh, chappuis = air_at(nm)
    step = 1000.0
    bend, tau = [], []
    for h in heights:
        s = np.arange(step / 2, 1.6e6, step)
        # The ray is straight but for its bending, which changes its height by less than 1 %: followed.
        xs, ys = s, np.full_like(s, R + h)
        for _ in range(3):
            r = np.hypot(xs, ys)
            z = r - R
            gradient = n0 / RHO0 * (density(z + 5.0) - density(z - 5.0)) / 10.0
            n = 1 + n0 * density(z) / RHO0
            turn = -gradient / n * (ys / r) * step  # towards the Earth
            angles = np.cumsum(turn) - turn / 2
            xs = np.cumsum(np.cos(angles)) * step - np.cos(angles) * step / 2
            ys = R + h - np.cumsum(np.sin(angles)) * step + np.sin(angles) * step / 2
        bend.append(2 * turn.sum())
        depth = rayleigh * density(z) / column0 + chappuis * ozone(z)
        tau.append(2 * (depth * step).sum())
    return np.array(bend), np.exp(-np.array(tau))


n_points = 60_000
k = np.arange(n_points) + 0.5
rho, phi = np.sqrt(k / n_points), k * np.pi * (3 - np.sqrt(5))


def light(r, across, nm, bend, through):
    alpha = -0.023 + 0.292 / (nm / 1e3)
    weight = np.sqrt(1 - rho**2) ** alpha
    weight = weight / weight.sum()
    along = np.sqrt(r * r - across * across)
    p = np.array([across, 0.0, -along])
    sun = np.array([0.0, 0.0, AU])
    line = sun - p
    d = np.linalg.norm(line)
    u = line / d
    e = np.cross(u, [0.0, 1.0, 0.0])
    e /= np.linalg.norm(e)
    f = np.cross(u, e)
    sine = rho * SUN / d
    rays = (np.sqrt(1 - sine**2)[:, None] * u + (sine * np.cos(phi))[:, None] * e + (sine * np.sin(phi))[:, None] * f)
    cosine = rays @ (-p / r)  # towards the Earth's centre
    angle = np.arccos(cosine)
    # A ray of lowest height h leaves so that r sin(angle + bend) = n (R + h), which is the impact parameter.
    n_low = 1 + air_at(nm)[0] * density(heights) / RHO0
    impact = n_low * (R + heights)
    seen = np.arcsin(np.minimum(impact / r, 1)) - bend
    distance = r * np.sin(seen)  # distance of the undeviated ray from the Earth's centre
    dilution = impact * np.gradient(impact, heights) / (distance * np.gradient(distance, heights))
    gain = np.interp(angle, seen, through * dilution, left=0.0, right=1.0)
    bare = angle > np.arcsin(R / r)
    return (weight * gain).sum(), (weight * bare).sum(), bare.mean()


for nm in (450, 550, 850):
    bend, through = trace(nm)
    if nm == 550:
        import sys
        for h in (0, 10e3, 20e3, 30e3):
            i = np.searchsorted(heights, h)
            print(f"// {nm} nm: {h/1e3:.0f} km bends {np.degrees(bend[i])*60:.2f} arcmin, transmits {through[i]:.4f}", file=sys.stderr)
    for height in (550e3, 2000e3, 20200e3, 35786e3):
        r = R + height
        for step in np.linspace(-1.0, 1.2, 12):
            across = R + step * 0.0047 * np.sqrt(r * r - R * R) + 20e3
            if across >= r:
                continue
            air, limb, even = light(r, across, nm, bend, through)
            if air > 0.005 and air < 0.9999:
                print(f"{{{height:.0f}, {across:.1f}, {nm}, {air:.5f}, {limb:.5f}, {even:.5f}}},")
