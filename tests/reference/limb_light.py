#!/usr/bin/env python3
"""Light of the Earth's limb for tests/sky/test_limb.cpp, with numpy and scipy, over a sphere of 6371 km.

limb_light.py airglow: integrals by scipy's quad of a shell that shines by (1 - x^2)^2, x = (height - middle) / half width,
along lines from observers at any height, over that of the zenith. A line a case: height of the observer [m], angle from the
nadir [rad], middle and half width of the shell [m], light.
limb_light.py air: sunlight that air scatters once into a line of sight, by sums of 2,000 places on it, each with its own 1,500
places on the way to the Sun; U.S. Standard Atmosphere of 1976, 300 DU of ozone. A line a case: tangent height [m], the Sun's
zenith angle at the tangent place [deg], cosine of its azimuth from the direction of sight, wavelength [nm], radiance over
irradiance and phase function [1/sr].
limb_light.py stars: how much of a star's light is left behind the limb, by rays traced through that air. A line a case:
height of the observer [m], tangent height of the straight line to the star [m], wavelength [nm], light.
"""
import sys
import numpy as np
from scipy.integrate import quad

R = 6371e3
BASES = np.array([0, 11e3, 20e3, 32e3, 47e3, 51e3, 71e3])
LAPSES = np.array([-6.5e-3, 0, 1e-3, 2.8e-3, 0, -2.8e-3, -2e-3])
G_OVER_R = 9.80665 / 287.053


def base_values():
    t, p = [288.15], [1.0]
    for i in range(6):
        dh, a = BASES[i + 1] - BASES[i], LAPSES[i]
        t.append(t[i] + a * dh)
        p.append(p[i] * (np.exp(-G_OVER_R * dh / t[i]) if a == 0 else (t[i + 1] / t[i]) ** (-G_OVER_R / a)))
    return np.array(t), np.array(p)


T, P = base_values()


def density(z):  # over that at the sea
    z = np.asarray(z, float)
    h = 6356766.0 * z / (6356766.0 + z)
    i = np.clip(np.searchsorted(BASES, h, side="right") - 1, 0, 6)
    a, dh = LAPSES[i], h - BASES[i]
    t = np.maximum(T[i] + a * dh, 150.0)
    steep = np.where(a == 0, 1.0, a)
    p = np.where(a == 0, np.exp(-G_OVER_R * dh / T[i]),
                 (np.maximum(T[i] + a * dh, 1.0) / T[i]) ** (-G_OVER_R / steep))
    return P[i] * p * 288.15 / t


def ozone(z):
    return 0.3 * np.exp(-0.5 * ((z - 22e3) / 5e3) ** 2) / (5e3 * np.sqrt(2 * np.pi))


TOP = 120e3
COLUMN = np.trapz(density(np.arange(0, TOP, 20.0)), dx=20.0)


def depths(nm):
    um2 = (nm / 1e3) ** -2
    rayleigh = 0.008569 * um2**2 * (1 + 0.0113 * um2 + 0.00013 * um2**2)
    chappuis = np.interp(nm, [440, 450, 480, 500, 530, 550, 570, 593, 610, 630, 656, 690, 740, 780],
                         [0, .003, .014, .03, .063, .085, .12, .119, .12, .09, .065, .028, .01, 0])
    return rayleigh, chappuis


def airglow():
    for height in (0.0, 60e3, 95e3, 200e3, 400e3, 1500e3, 35786e3):
        r = R + height
        tangents = [-6000e3, -2000e3, -300e3, -20e3, 0.5e3, 40e3, 70e3, 85e3, 88e3, 92e3, 95e3, 99e3, 105e3]
        nadirs = [np.pi - np.radians(x) for x in (0, 30, 60, 85)] if height < 100e3 else []
        nadirs += [np.arcsin((R + t) / r) for t in tangents if R + t < r]
        for nadir in nadirs:
            for middle, half in ((87e3, 7.944e3), (95e3, 7.944e3)):
                def shines(s):
                    h = np.sqrt(r * r + s * s - 2 * r * s * np.cos(nadir)) - R
                    x = (h - middle) / half
                    return (1 - x * x) ** 2 if abs(x) < 1 else 0.0
                b, lowest = r * np.sin(nadir), r * np.cos(nadir)
                ends = []
                for edge in (middle - half, middle, middle + half):
                    if R + edge > b:
                        ends += [lowest - np.sqrt((R + edge) ** 2 - b * b), lowest + np.sqrt((R + edge) ** 2 - b * b)]
                last = 2 * lowest + 6000e3 if lowest > 0 else 6000e3
                if b < R and lowest > 0:
                    last = lowest - np.sqrt(R * R - b * b)
                marks = sorted({0.0, last, *[e for e in ends if 0 < e < last], *([lowest] if 0 < lowest < last else [])})
                light = sum(quad(shines, a, e, epsabs=1e-7, epsrel=1e-10, limit=200)[0] for a, e in zip(marks, marks[1:]))
                print(f"{{{height:.0f}, {nadir:.12f}, {middle:.0f}, {half:.0f}, {light / (half * 16 / 15):.6f}}},")


def air():
    for tangent in (0.2e3, 5e3, 12.3e3, 20e3, 30.7e3, 45e3, 61e3, 80e3, 95e3):
        far = np.sqrt((TOP - tangent) * (TOP + tangent + 2 * R))
        n = 2000
        s = (np.arange(n) + 0.5) / n * 2 * far - far
        ds = 2 * far / n
        h = np.hypot(R + tangent, s) - R
        rho, o3 = density(h), ozone(h)
        seen_air = (np.cumsum(rho) - rho / 2) * ds / COLUMN
        seen_o3 = (np.cumsum(o3) - o3 / 2) * ds
        for sun_deg in (20, 65, 80, 85.3, 88, 90, 92.2, 94, 96.3, 98, 101):
            for towards in (-1.0, -0.3, 0.0, 0.6, 1.0):
                up, ahead = np.cos(np.radians(sun_deg)), np.sin(np.radians(sun_deg)) * towards
                c = ((R + tangent) * up + s * ahead) / (R + h)
                out = np.sqrt(np.maximum(0, ((R + h) * c) ** 2 + (TOP - h) * (TOP + h + 2 * R))) - (R + h) * c
                lowest = np.where(c < 0, (R + h) * np.sqrt(1 - c * c) - R, h)
                # Steps are short where the way is low.
                m = 1500
                near = np.clip(-(R + h) * c / out, 0, 1)[:, None]
                u = ((np.arange(m) + 0.5) / m)[None, :] * (np.cbrt(1 - near) + np.cbrt(near)) - np.cbrt(near)
                at = out[:, None] * (near + u**3)
                step = out[:, None] * 3 * u**2 / m * (np.cbrt(1 - near) + np.cbrt(near))
                z = np.sqrt((R + h)[:, None] ** 2 + at**2 + 2 * (R + h)[:, None] * at * c[:, None]) - R
                z = np.maximum(z, -1e3)
                sun_air = (density(z) * step).sum(1) / COLUMN
                sun_o3 = (ozone(z) * step).sum(1)
                for nm in (450, 550, 850):
                    rayleigh, chappuis = depths(nm)
                    through = np.exp(-rayleigh * (seen_air + sun_air) - chappuis * (seen_o3 + sun_o3))
                    light = (np.where(lowest < 0, 0.0, rho * through) * ds).sum() * rayleigh / COLUMN / (4 * np.pi)
                    print(f"{{{tangent:.0f}, {sun_deg}, {towards}, {nm}, {light:.4e}}},")


def stars():
    for nm in (450, 550, 850):
        um2 = (nm / 1e3) ** -2
        n0 = 1e-8 * (8342.13 + 2406030 / (130 - um2) + 15997 / (38.9 - um2))  # Edlen, 15 C, 1013.25 hPa
        rayleigh, chappuis = depths(nm)
        low = np.concatenate([np.arange(0, 30e3, 100.0), np.arange(30e3, 100e3, 500.0)])
        step = 500.0
        s = np.arange(step / 2, 1.4e6, step)
        bent, through = [], []
        for h in low:
            xs, ys = s, np.full_like(s, R + h)
            for _ in range(3):
                r = np.hypot(xs, ys)
                z = r - R
                slope = n0 * (density(z + 5.0) - density(z - 5.0)) / 10.0
                turn = -slope / (1 + n0 * density(z)) * (ys / r) * step
                angles = np.cumsum(turn) - turn / 2
                xs = np.cumsum(np.cos(angles)) * step - np.cos(angles) * step / 2
                ys = R + h - np.cumsum(np.sin(angles)) * step + np.sin(angles) * step / 2
            bent.append(2 * turn.sum())
            through.append(np.exp(-2 * ((rayleigh * density(z) / COLUMN + chappuis * ozone(z)) * step).sum()))
        bent, through = np.array(bent), np.array(through)
        for height in (300e3, 800e3, 35786e3):
            r = R + height
            seen = np.arcsin((1 + n0 * density(low)) * (R + low) / r)  # from the nadir
            true = seen - bent
            spread = np.gradient(np.cos(seen)) / np.gradient(np.cos(true))  # solid angles: light per area
            straight = r * np.sin(true) - R
            for tangent in (5e3, 10e3, 15e3, 20e3, 25e3, 30e3, 40e3, 60e3):
                if straight[0] < tangent and np.all(np.diff(straight) > 0):
                    light = np.exp(np.interp(tangent, straight, np.log(through * spread)))
                    print(f"{{{height:.0f}, {tangent:.0f}, {nm}, {light:.5f}}},")


{"airglow": airglow, "air": air, "stars": stars}[sys.argv[1]]()
