#!/usr/bin/env python3
"""Prints diffuse irradiance of a horizontal plane over the Sun's by SPECTRL2 (Bird & Riordan 1986) of pvlib, for
tests/sky/test_day_sky.cpp: haze of 0.15 at 550 nm, exponent 1.14, albedo 0.94, asymmetry 0.63 (the mean cosine of
core/sky/air/haze.h), 14.2 mm of water, ground 0.2, at the sea. Usage, after `pip install pvlib`: diffuse_sky.py"""
import numpy as np
from pvlib.atmosphere import get_relative_airmass
from pvlib.spectrum import spectrl2


def plane(sun, haze, exponent, albedo):
    """Wavelengths [nm], diffuse irradiance of the plane and direct irradiance above the air."""
    zenith = 90 - sun
    light = spectrl2(apparent_zenith=zenith, aoi=zenith, surface_tilt=0, ground_albedo=albedo, surface_pressure=101325,
                     relative_airmass=get_relative_airmass(zenith), precipitable_water=1.42, ozone=0.3,
                     aerosol_turbidity_500nm=haze * (0.5 / 0.55) ** -exponent, dayofyear=94, alpha=exponent,
                     scattering_albedo_400nm=0.94, wavelength_variation_factor=1e-9, aerosol_asymmetry_factor=0.63)
    return light["wavelength"], np.squeeze(light["dhi"]), np.squeeze(light["dni_extra"])


for sun in (60, 30, 20):
    wavelength_nm, diffuse, above = plane(sun, 0.15, 1.14, 0.2)
    for wavelength_um in (0.45, 0.55, 0.65, 0.87, 1.04, 1.63):
        print(f"{{{sun}, {wavelength_um}, {np.interp(1e3 * wavelength_um, wavelength_nm, diffuse / above):.5f}}},")
for sun in (10, 20, 35, 50, 70):
    wavelength_nm, diffuse, above = plane(sun, 0.151, 1.3, 0.15)
    seen = 1.019 * np.exp(-285.4 * (1e-3 * wavelength_nm - 0.559) ** 2) * np.gradient(wavelength_nm)
    print(f"{{{sun}, {(diffuse * seen).sum() / (above * seen).sum():.5f}}},")
