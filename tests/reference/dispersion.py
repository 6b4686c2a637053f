#!/usr/bin/env python3
"""Mean displacement and rms length of spectra by the air, for tests/sky/test_dispersion.cpp: ERFA's refco at every
wavelength of the band, weighted by the photons of a star behind the air of Cerro Tololo, with numpy: of the measured
Sun and Vega, and of stars whose spectrum is the table's that the simulator has (core/photometry). Run with the folder of
reference data. A line a case: band, spectrum, B-V, zenith distance [deg] at the band's mean wavelength, mean displacement
upwards and rms about it [arcsec].
"""
import pathlib
import re
import sys

import erfa
import numpy as np

DATA = sys.argv[1]
P_HPA, T_C, HUMIDITY = 780.0, 10.0, 0.3
K_NM = [320, 330, 340, 350, 360, 370, 380, 390, 400, 425, 450, 475, 500, 525, 550, 575, 600, 625, 650, 675, 700, 750, 800,
        850, 900, 950, 1000, 1050, 1100]
K_MAG = [1.050, .820, .700, .620, .561, .503, .451, .411, .388, .312, .263, .225, .190, .171, .146, .154, .153, .130, .103,
         .075, .068, .055, .052, .042, .036, .046, .041, .025, .037]  # Stone & Baldwin 1983
sun = np.loadtxt(DATA + "/solar/e490_00a.dat")
vega = np.loadtxt(DATA + "/solar/vega_galsim.txt")
table = (pathlib.Path(__file__).resolve().parents[2] / "core/photometry/star_spectrum_table.inc").read_text()
rows = [[float(x) for x in row.split(",")] for row in re.findall(r"\{([\d., ]+)\}", table)]


def star(bv):
    nodes, factors = rows[0], rows[1 + round((bv + 0.3) / 0.05)]
    kelvin = 4600 * (1 / (0.92 * bv + 1.7) + 1 / (0.92 * bv + 0.62))  # Ballesteros 2012
    nm = np.arange(300.0, 1000.0, 0.5)
    return nm, np.interp(nm, nodes, factors) * nm**-5 / np.expm1(1.438777e7 / nm / kelvin)


SPECTRA = {"Sun": (0.65, sun[:, 0] * 1e3, sun[:, 1]), "Vega": (0.0, vega[:, 0], vega[:, 1]),
           "blue": (-0.2, *star(-0.2)), "red": (1.5, *star(1.5))}


def curve(name):
    rows = [line.split() for line in open(f"{DATA}/filters/{name}.ecsv") if line[0].isdigit()]
    x, y = np.array(rows, float).T
    return x / 10, y / x  # to photons


def mean_nm(x, y):
    fine = np.arange(x[0], x[-1], 0.05)
    value = np.interp(fine, x, y)
    return (fine * value).sum() / value.sum()


def airmass(z_deg):  # Kasten & Young 1989
    return 1 / (np.cos(np.radians(z_deg)) + 0.50572 * (96.07995 - z_deg) ** -1.6364)


def observed(true_rad, a, b):
    z = np.full_like(a, true_rad)
    for _ in range(60):
        z = true_rad - a * np.tan(z) - b * np.tan(z) ** 3
    return z


bands = {name: curve("bessell-" + name) for name in "UBVRI"}
bands["open"] = (np.array([400.0, 900.0]), np.array([1.0, 1.0]))
for name, (x, y) in bands.items():
    fine = np.arange(x[0] + 0.125, x[-1], 0.25)
    a, b = np.array([erfa.refco(P_HPA, T_C, HUMIDITY, nm / 1e3) for nm in fine]).T
    a0, b0 = erfa.refco(P_HPA, T_C, HUMIDITY, mean_nm(x, y) / 1e3)
    for spectrum, (bv, wavelength, flux) in SPECTRA.items():
        for z_deg in (0, 30, 60, 75):
            z = np.radians(z_deg)
            true = z + a0 * np.tan(z) + b0 * np.tan(z) ** 3
            up = np.degrees(z - observed(true, a, b)) * 3600
            weight = (np.interp(fine, x, y) * np.interp(fine, wavelength, flux) * fine
                      * 10 ** (-0.4 * np.interp(fine, K_NM, K_MAG) * airmass(z_deg)))
            mean = (weight * up).sum() / weight.sum()
            rms = np.sqrt((weight * (up - mean) ** 2).sum() / weight.sum())
            print(f'{{"{name}", "{spectrum}", {bv}, {z_deg}, {mean:.4f}, {rms:.4f}}},')
