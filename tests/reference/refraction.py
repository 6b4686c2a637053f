"""Refraction by tracing rays through standard atmospheres, for tests/sky/test_refraction.cpp and core/sky/air/refraction.cpp.

    refraction.py          tables of the tests
    refraction.py --fit    by how much rays are bent more than Bennett has it, as two falling exponentials

International Standard Atmosphere to 86 km, dry air of refractivity 2.7785e-4 at 15 C and 1013.25 hPa (0.55 um), observer at
6371 km. Of another temperature at the observer the lowest layer ends where it is as cold as the stratosphere, and all above it is
moved with it. For a body at 550 km the geocentric angle is integrated along the ray, without any asymptote.
"""
import itertools
import sys

import erfa
import numpy as np

EARTH_M, GRAVITY, GAS, LAPSE = 6371e3, 9.80665, 287.05287, -6.5e-3
REFRACTIVITY = 2.7785e-4
NODES, WEIGHTS = np.polynomial.legendre.leggauss(40)
# What is fitted: scales [deg] of the exponentials, and factors of each.
SCALES_DEG = 1.8, 4.0
FACTORS = "constant", "t", "tt", "p", "tp"


class Air:
    """Dry air over a site: layers of constant lapse rate; pressure [hPa] and temperature [C] at the observer."""

    def __init__(self, pressure_hpa=1013.25, temperature_c=15.0):
        ground_k = temperature_c + 273.15
        top = (216.65 - ground_k) / LAPSE
        self.layers = [(0.0, ground_k, LAPSE), (top, 216.65, 0.0), (top + 9e3, 216.65, 1e-3), (top + 21e3, 228.65, 2.8e-3),
                       (top + 36e3, 270.65, 0.0), (top + 40e3, 270.65, -2.8e-3), (top + 60e3, 214.65, -2e-3)]
        self.bases = [low for low, _, _ in self.layers] + [top + 75e3]
        self.pressures = [1.0]
        for i in range(len(self.layers)):
            self.pressures.append(self._density(i, self.bases[i + 1])[0])
        self.ground_k = ground_k
        self.refractivity = REFRACTIVITY * pressure_hpa / 1013.25 * 288.15 / ground_k

    def _density(self, i, height):
        """Pressure in that of the ground, temperature [K], lapse rate."""
        low, base_k, lapse = self.layers[i]
        kelvin = base_k + lapse * (height - low)
        fall = (kelvin / base_k) ** (-GRAVITY / (GAS * lapse)) if lapse else np.exp(-GRAVITY * (height - low) / (GAS * base_k))
        return self.pressures[i] * fall, kelvin, lapse

    def index(self, height):
        """n and dn/dr."""
        if height >= self.bases[-1]:
            return 1.0, 0.0
        pressure, kelvin, lapse = self._density(max(np.searchsorted(self.bases, height, side="right") - 1, 0), height)
        more = self.refractivity * pressure * self.ground_k / kelvin
        return 1.0 + more, -more / kelvin * (GRAVITY / GAS + lapse)

    def trace(self, zenith_deg, top_m):
        """Bending and geocentric angle [rad] of a ray that arrives at this apparent angle, up to a height: by the height's
        square root, to tame the horizon."""
        invariant = (1.0 + self.refractivity) * EARTH_M * np.sin(np.radians(zenith_deg))
        edges = sorted({0.0, 0.1, 1.0, 10.0, 50.0, 100.0, 300.0, 1e3, 2e3, 5e3, *self.bases, top_m})
        bending = turning = 0.0
        for low, high in itertools.pairwise(np.sqrt([edge for edge in edges if edge <= top_m])):
            for q, weight in zip((low + high) / 2 + (high - low) / 2 * NODES, (high - low) / 2 * WEIGHTS):
                n, slope = self.index(q * q)
                radius = EARTH_M + q * q
                sine = invariant / (n * radius)
                tangent = sine / np.sqrt(max(1.0 - sine * sine, 1e-30))
                bending += -slope / n * tangent * 2 * q * weight
                turning += tangent / radius * 2 * q * weight
        return bending, turning


def arcsec(radians):
    return np.degrees(radians) * 3600.0


def bennett(elevation_deg, pressure_hpa, temperature_c):
    """Bennett 1982 [rad], scaled to meet the series of eraRefco at 15 deg of elevation."""
    def formula(deg):
        first = 1.0 / np.tan(np.radians(deg + 7.31 / (deg + 4.4)))
        return first - 0.06 * np.sin(np.radians(14.7 * first + 13.0))
    a, b = erfa.refco(pressure_hpa, temperature_c, 0.0, 0.55)
    tangent = np.tan(np.radians(75.0))
    return formula(elevation_deg) / formula(15.0) * (a * tangent + b * tangent**3)


def tables():
    air = Air()
    for degrees in (20, 45, 60, 70, 75, 80, 85, 88, 89.99):
        bend, theta = air.trace(degrees, 550e3)
        radius = EARTH_M + 550e3
        lifted = np.arctan2(radius * np.sin(theta), radius * np.cos(theta) - EARTH_M) - np.radians(degrees)
        print(f"{{{degrees}, {arcsec(bend):.3f}, {arcsec(bend - lifted):.3f}}},")
    for pressure_hpa, temperature_c in ((1013.25, -15), (1013.25, 10), (1013.25, 30), (800, 5), (700, 0), (620, -5)):
        row = (f"{arcsec(Air(pressure_hpa, temperature_c).trace(90 - e, 90e3)[0]):.2f}" for e in (0.001, 0.3, 1, 3, 5, 10))
        print(f"{{{pressure_hpa}, {temperature_c}, {{{', '.join(row)}}}}},")


def fit():
    rows, more = [], []
    elevations = (0.001, 0.1, 0.2, 0.3, 0.5, 0.75, 1, 1.5, 2, 2.5, 3, 4, 5, 6, 7, 8, 9, 10)
    for temperature_c, pressure_hpa in itertools.product((-20, -10, 0, 10, 15, 25, 35), (620, 750, 880, 1013.25)):
        a, b = erfa.refco(pressure_hpa, temperature_c, 0.0, 0.55)
        air = Air(pressure_hpa, temperature_c)
        air.refractivity = 1.0 - np.sqrt(1.0 - 2.0 * (a - b))  # so that Bennett and rays have the same
        t, p = (temperature_c - 15.0) / 30.0, pressure_hpa / 1013.25 - 1.0
        for elevation in elevations:
            rows.append([np.exp(-elevation / scale) * factor for scale in SCALES_DEG for factor in (1.0, t, t * t, p, t * p)])
            more.append(air.trace(90 - elevation, 90e3)[0] / bennett(elevation, pressure_hpa, temperature_c) - 1.0)
    found = np.linalg.lstsq(np.array(rows), np.array(more), rcond=None)[0]
    for scale, factors in zip(SCALES_DEG, np.round(found, 4).reshape(2, -1)):
        print(f"{scale} deg:", ", ".join(f"{name} {value}" for name, value in zip(FACTORS, factors)))
    print(f"largest difference {100 * abs(np.array(rows) @ np.round(found, 4) - more).max():.2f} %")


if __name__ == "__main__":
    fit() if sys.argv[1:] == ["--fit"] else tables()
