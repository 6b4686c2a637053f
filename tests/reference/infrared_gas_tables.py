#!/usr/bin/env python3
"""Prints core/sky/air/infrared_gas_tables.inc: absorption of the air by 10 cm-1, fitted to LOWTRAN 7 (tests/reference/lowtran.py)
in the U.S. Standard Atmosphere at heights of 0, 2 and 4.2 km with 0.1 to 1.8 times its water, from the
zenith to an airmass of 7. The form is explained in core/sky/air/infrared_gases.h.
"""
import numpy as np
from scipy.optimize import nnls

from lowtran import Lowtran, airmass, planck

WATER_POWER, OZONE_POWER, LAPSE_K_PER_KM = 0.55, 0.73, 6.5
# Over a low site more ozone is in warm air, and the lower gases shine from a little higher.
OZONE_K, OZONE_AT, OZONE_K_PER_ATMOSPHERE, HEIGHT_POWER = 225.0, 0.593, 22.0, 0.08


def least_squares(depth, amount, weight):
    return (weight**2 * depth * amount).sum(0) / (weight**2 * amount**2).sum(0)


lowtran = Lowtran()
cases = []
for height_km in (0.0, 2.0, 4.2):
    pwv_mm, hpa, kelvin = lowtran.site(height_km)
    for scale in (0.1, 0.4, 1.0, 1.8):
        for zenith_deg in (0.0, 60.0, 75.0, 83.0):
            wavenumber, each, radiance = lowtran.run(height_km, zenith_deg, scale)
            cases.append((pwv_mm * scale, hpa / 1013.25, kelvin, airmass(zenith_deg), each.clip(1e-30, 1.0), radiance))
pwv, pressure, kelvin, x = (np.array([c[i] for c in cases])[:, None] for i in range(4))
each, radiance = np.array([c[4] for c in cases]), np.array([c[5] for c in cases])
total, continuum, water, ozone = (each[:, :, k - 1] for k in (9, 5, 17, 31))
mixed = (total / np.maximum(water * continuum * ozone, 1e-20)).clip(1e-30, 1.0)
depth = {k: -np.log(t) for k, t in dict(water=water, continuum=continuum, ozone=ozone, mixed=mixed).items()}
weight = {k: np.exp(-np.minimum(d, 5.0)) for k, d in depth.items()}

warm = kelvin / 288.15
c_water = least_squares(depth["water"], (pwv * x * pressure**0.9 * warm**2) ** WATER_POWER, weight["water"])
c_ozone = least_squares(depth["ozone"], x**OZONE_POWER, weight["ozone"])
c_self, c_foreign = np.zeros_like(c_water), np.zeros_like(c_water)
for k in range(len(wavenumber)):
    w = weight["continuum"][:, k]
    terms = np.stack([(pwv**2 * x / warm**2)[:, 0] * w, (pwv * x * pressure)[:, 0] * w], 1)
    c_self[k], c_foreign[k] = nnls(terms, depth["continuum"][:, k] * w)[0]
mixed_amount = x * pressure**1.76
power = np.ones_like(c_water)
for k in range(len(wavenumber)):
    ok = (depth["mixed"][:, k] > 1e-5) & (depth["mixed"][:, k] < 20.0)
    if ok.sum() > 6:
        w = (weight["mixed"] * depth["mixed"])[ok, k]
        power[k] = np.polyfit(np.log(mixed_amount[ok, 0]), np.log(depth["mixed"][ok, k]), 1, w=w)[0]
power = power.clip(0.5, 1.0).round(2)
c_mixed = least_squares(depth["mixed"], mixed_amount**power, weight["mixed"])

lower = (c_water * (pwv * x * pressure**0.9 * warm**2) ** WATER_POWER + c_self * pwv**2 * x / warm**2 +
         c_foreign * pwv * x * pressure + c_mixed * mixed_amount**power)
above = np.exp(-lower) * -np.expm1(-c_ozone * x**OZONE_POWER) * planck(wavenumber, OZONE_K + OZONE_K_PER_ATMOSPHERE * (pressure - OZONE_AT))
heights_km = np.linspace(0.1, 5.0, 50)
near = (x < 2.5)[:, 0]
error = [np.mean(((-np.expm1(-lower) * planck(wavenumber, kelvin - LAPSE_K_PER_KM * h * pressure**HEIGHT_POWER) + above) / radiance - 1.0)[near] ** 2, 0)
         for h in heights_km]
height_km = heights_km[np.argmin(error, 0)]

print("// Made by tests/reference/infrared_gas_tables.py of LOWTRAN 7, every 10 cm-1 from 400 to 4000 cm-1.")
print("// {water lines, water by itself, water in air, mixed gases, their power, ozone, height [km]}")
print("constexpr InfraredGas infrared_gases[] = {")
figures = lambda c: f"{c:.2e}".replace("e-0", "e-").replace("e+00", "") if c >= 5e-6 else "0"
for k in range(0, len(wavenumber), 2):
    row = [*map(figures, (c_water[k], c_self[k], c_foreign[k], c_mixed[k])), f"{power[k]:g}", figures(c_ozone[k]),
           f"{height_km[k]:.1f}"]
    print("    {" + ", ".join(row) + "},")
print("};")
