#!/usr/bin/env python3
"""Prints tests/sky/infrared_air_reference.inc: transmission and radiance of the air in bands by LOWTRAN 7 itself
(tests/reference/lowtran.py), integrated by numpy, for sites at the sea and at 4.2 km in the U.S. Standard Atmosphere.
"""
import numpy as np

from lowtran import Lowtran, airmass

PLANCK, LIGHT = 6.62607015e-34, 299792458.0
BANDS = {"L'": (3420, 4120), "M": (4500, 5100), "N": (8000, 13000)}

lowtran = Lowtran()
print("// Made by tests/reference/infrared_air.py")
for height_km, waters_mm in ((0.0, (4.0, 14.0)), (4.2, (0.8, 3.0))):
    pwv_mm, hpa, kelvin = lowtran.site(height_km)
    for water_mm in waters_mm:
        for zenith_deg in (0.0, 60.0):
            wavenumber, each, radiance = lowtran.run(height_km, zenith_deg, water_mm / pwv_mm)
            wavelength_m = 1e-2 / wavenumber[::-1]
            transmission = each[::-1, 8]
            photons = (radiance * 1e4 / (PLANCK * LIGHT * wavenumber * 100.0))[::-1]  # /s/m2/sr/cm-1
            by_wavelength = photons * 1e-2 / wavelength_m**2  # /s/m2/sr/m
            for band, (low_nm, high_nm) in BANDS.items():
                at = np.linspace(low_nm, high_nm, 4001) * 1e-9
                mean = np.interp(at, wavelength_m, transmission).mean()
                light = np.interp(at, wavelength_m, by_wavelength).mean() * (high_nm - low_nm) * 1e-9
                print(f'{{"{band}", {low_nm}, {high_nm}, {water_mm:g}, {hpa:.2f}, {kelvin:.2f}, '
                      f"{airmass(zenith_deg):.4f}, {mean:.4f}, {light:.4e}}},")
