#!/usr/bin/env python3
"""Extinction by water vapour and well-mixed gases in bands, for tests/sky/test_gas_absorption.cpp, with pvlib.

First SPECTRL2 as pvlib computes it (its direct light over that without air but for Rayleigh's scattering, which is
divided out): band, water [mm], airmass, magnitudes. Then ASTM G173-03 (SMARTS 2.9.2; 14.16 mm, airmass 1.5): direct light
over the extraterrestrial, Rayleigh's scattering, ozone and the aerosol of the standard (optical depth 0.084 at 0.5 um, by
the power -1.3) divided out: band, magnitudes.
"""
import numpy as np
import pvlib

BANDS = {"R": (610, 720), "I": (730, 880), "Y": (970, 1070), "J": (1170, 1330), "H": (1490, 1780), "K": (2030, 2370)}
g173 = np.genfromtxt(pvlib.__path__[0] + "/data/ASTMG173.csv", delimiter=",", skip_header=2)


def rayleigh(um, airmass):
    return np.exp(-airmass / (um**4 * (115.6406 - 1.335 / um**2)))


def mean_mag(nm, transmission, low, high):  # weighted by photons of the Sun
    fine = np.arange(low, high + 0.05, 0.1)
    photons = np.interp(fine, g173[:, 0], g173[:, 1]) * fine
    return -2.5 * np.log10((np.interp(fine, nm, transmission) * photons).sum() / photons.sum())


for water_mm in (0.0, 1.0, 2.5, 14.16, 40.0):
    for airmass in (1.0, 2.0):
        out = pvlib.spectrum.spectrl2(
            apparent_zenith=np.degrees(np.arccos(1 / airmass)), aoi=0, surface_tilt=0, ground_albedo=0,
            surface_pressure=101325, relative_airmass=airmass, precipitable_water=water_mm / 10, ozone=0,
            aerosol_turbidity_500nm=0, dayofyear=1)
        nm = out["wavelength"]
        ratio = np.squeeze(out["dni"]) / np.squeeze(out["dni_extra"]) / rayleigh(nm / 1e3, airmass)
        for name, (low, high) in BANDS.items():
            print(f'{{"{name}", {low}, {high}, {water_mm}, {airmass}, {mean_mag(nm, ratio, low, high):.4f}}},')
print()
nm, um = g173[:, 0], g173[:, 0] / 1e3
ozone = np.interp(um, [0.44, 0.5, 0.53, 0.575, 0.6, 0.625, 0.66, 0.7, 0.74],
                  [0.003, 0.03, 0.065, 0.12, 0.125, 0.10, 0.055, 0.021, 0.009], right=0) * 0.344 * 1.5
rest = rayleigh(um, 1.5) * np.exp(-1.5 * 0.084 * (um / 0.5) ** -1.3 - ozone)
for name, (low, high) in BANDS.items():
    print(f'{{"{name}", {low}, {high}, 14.16, 1.5, {mean_mag(nm, g173[:, 3] / g173[:, 1] / rest, low, high):.4f}}},')
